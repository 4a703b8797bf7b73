//! Bounds for each number of oscillators, of plants that are linear in x and e.

use serde_json::{Value, json};
use sigmastar_document::number::{full, upper};
use sigmastar_document::{Block, Table};
use sigmastar_prove::certify::{ByCount, Certification, CountBounds};

/// The numbers of oscillators of which the short report has a row, with the last one, from which on nothing changes.
const SHOWN: [u64; 6] = [0, 1, 2, 3, 5, 10];

/// The table; nothing where there are no such bounds.
pub(super) fn section(run: &Certification<'_>) -> Vec<Block> {
    let Some(ByCount { counts, checked, .. }) = &run.by_count else { return Vec::new() };
    let mut table = Table::new(&["n_o", "steady |e|", "largest |e|", "steady |u|", "largest |u|"]);
    for bounds in counts.iter().filter(|bounds| bounds.or_more || SHOWN.contains(&bounds.n_o)) {
        let CountBounds { n_o, or_more, steady_error, peak_error, control, .. } = bounds;
        let name = if *or_more { format!("{n_o} or more") } else { n_o.to_string() };
        let largest = &control.steady + &control.transient;
        table.push([name, upper(steady_error), upper(peak_error), upper(&control.steady), upper(&largest)]);
    }
    let says = "At this gain, by the number of oscillators. Steady is along the periodic solution, largest is at all times from the initial set. \
                Both are proved, for every plant and gain of the actuator of the claim";
    let who = if *checked { "; they are in the certificate." } else { "; no independent program checks them." };
    vec![Block::says(format!("{says}{who}")), Block::Table(table)]
}

/// All of them as JSON, and `null` where there are none.
pub(super) fn counts_json(run: &Certification<'_>) -> Value {
    let one = |CountBounds { n_o, or_more, steady_error, mean_square, peak_error, control }: &CountBounds| {
        json!({
            "n_o": n_o, "or_more": or_more, "steady_error": full(steady_error), "mean_square": full(mean_square), "peak_error": full(peak_error),
            "control": { "steady": full(&control.steady), "transient": full(&control.transient) },
        })
    };
    run.by_count.as_ref().map_or(Value::Null, |found| found.counts.iter().map(one).collect())
}
