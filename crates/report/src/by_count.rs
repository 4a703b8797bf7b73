//! Bounds for each number of oscillators.

use super::words;
use serde_json::{Value, json};
use sigmastar_document::number::{full, upper};
use sigmastar_document::{Block, Table};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::Specification;
use sigmastar_prove::certify::{ByCount, CountBounds, Largest};

/// The numbers of oscillators of which the report has a row, with those that are asked about, and the last one, from which on nothing changes.
const SHOWN: [u64; 6] = [0, 1, 2, 3, 5, 10];

/// The table, with the numbers of oscillators that are asked about; nothing where there are no such bounds.
pub(super) fn section(spec: &Specification, found: Option<&ByCount>, asked: &[u32]) -> Vec<Block> {
    let Some(ByCount { counts, checked, .. }) = found else { return Vec::new() };
    let mut table = Table::new(&["n_o", "steady |e|", "largest |e|", "steady |u|", "largest |u|"]);
    let is_asked = |n_o: u64| asked.iter().any(|asked| u64::from(*asked) == n_o);
    let is_shown =
        |bounds: &&CountBounds| bounds.or_more || bounds.n_o().is_none_or(|n_o| SHOWN.contains(&n_o) || is_asked(n_o));
    for bounds in counts.iter().filter(is_shown) {
        let CountBounds { oscillators, or_more, steady_error, steady_control, largest, .. } = bounds;
        let name = match oscillators.n_o() {
            Some(n_o) if *or_more => format!("{n_o} or more"),
            Some(n_o) => n_o.to_string(),
            None => words::row_of(oscillators),
        };
        let shown = |value: Option<&Enclosure>| value.map_or_else(|| "not proved".to_owned(), upper);
        let largest_error = shown(largest.as_ref().map(|largest| &largest.error));
        let largest_control = shown(bounds.largest_control().as_ref());
        table.push([name, upper(steady_error), largest_error, upper(steady_control), largest_control]);
    }
    let is_family = spec.plant().is_some_and(|plant| plant.parameters.intervals().next().is_some());
    let all = is_family || spec.input_gain.is_some();
    let of = if all { ", and for every plant and gain of the actuator of the claim" } else { "" };
    let who = match checked {
        true => "The certificate states them up to 0.01 % larger.",
        false => "No independent program checks them.",
    };
    let undisturbed = match spec.disturbances.disturb(spec.internal_model.sampling.is_some()) {
        true => ", without noise, disturbance and rounding",
        false => "",
    };
    let says = format!(
        "Proved at this gain for each number of oscillators{of}{undisturbed}. Steady values hold along the periodic solution, largest values at all times \
         from the initial set. {who}"
    );
    vec![Block::says(says), Block::Table(table)]
}

/// All of them as JSON, and `null` where there are none.
pub(super) fn counts_json(found: Option<&ByCount>) -> Value {
    let one =
        |CountBounds { oscillators, or_more, steady_error, mean_square, steady_control, largest, .. }: &CountBounds| {
            let [peak, transient] = match largest {
                Some(Largest { error, transient }) => [full(error), full(transient)].map(Value::String),
                None => [Value::Null, Value::Null],
            };
            let harmonics = oscillators.n_o().is_none().then(|| oscillators.all().collect::<Vec<u32>>());
            json!({
                "n_o": oscillators.n_o(), "harmonics": harmonics, "or_more": or_more, "steady_error": full(steady_error), "mean_square": full(mean_square), "peak_error": peak,
                "control": { "steady": full(steady_control), "transient": transient },
            })
        };
    found.map_or(Value::Null, |found| found.counts.iter().map(one).collect())
}
