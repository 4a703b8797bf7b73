//! What larger gains bring: certified bounds at multiples of the gain of a claim.

use rug::Rational;
use serde_json::{Value, json};
use sigmastar_document::number::{exact, full, upper};
use sigmastar_document::{Block, Table};
use sigmastar_exact::number::{Direction, write_exact};
use sigmastar_lang::spec::Specification;
use sigmastar_prove::certify::{ByCount, Certification, CountProof, GainRow, SampledCertification};

/// The table of a claim in continuous time; nothing where there are no rows but that of the claim.
pub(super) fn section(run: &Certification<'_>) -> Vec<Block> {
    let of_first = run.gains.first().map_or(&[][..], |row| &row.steady_with);
    let steady: Vec<String> = of_first.iter().map(|(n_o, _)| format!("steady $`|e|`$, $`n_o = {n_o}`$")).collect();
    let says = "Steady values hold along the periodic solution. Largest values hold in the \
                transient from the initial set, where $`|e| <= E0`$.";
    let proved = "Each row is proved, for every $`n_o`$ unless the title names one. No independent program checks the rows: `certify --sigma V -o FILE` writes a \
                  certificate of one, and `sampling` lists the longest sampling periods of such gains.";
    let sizes = sizes(run.spec);
    let own = match &run.by_count {
        Some(ByCount { proof: CountProof::Trials { .. }, .. }) => {
            " Only the first row uses the bounds by the number of oscillators. At the other gains such bounds may be far smaller than the row says: \
             `certify --sigma V` shows them."
        }
        _ => "",
    };
    table(&run.gains, &steady, &format!("{says}{sizes} {proved}{own}"))
}

/// The table of a claim at samples; nothing where there are no rows but that of the claim.
pub(super) fn sampled_section(run: &SampledCertification<'_>) -> Vec<Block> {
    let says = "The sampling period is the same in all rows. Steady values hold along the periodic solution. Largest values hold in the transient from the initial set, where $`|e| <= E0`$.";
    let proved = "Each row is proved for its gain alone, for every $`n_o`$ below half of the samples unless the title names one. No independent program checks the \
                  rows: `certify --sigma V -o FILE` writes a certificate of one.";
    let sizes = sizes(run.spec);
    table(&run.gains, &["steady $`|e|`$".to_owned()], &format!("{says}{sizes} {proved}"))
}

/// Which sizes of the initial set differ from row to row; nothing where the document states all of them.
fn sizes(spec: &Specification) -> &'static str {
    match spec.initial_set.given() {
        [x0, e0] if e0.is_none() || (x0.is_none() && spec.state_name().is_some()) => {
            " The file leaves sizes of this set open: at each gain they are at least twice the bound of the periodic solution there."
        }
        _ => "",
    }
}

fn table(rows: &[GainRow], steady: &[String], says: &str) -> Vec<Block> {
    let [first, _, ..] = rows else { return Vec::new() };
    let rates: Vec<String> = first.rates.iter().map(|(n_o, _)| format!("rate, $`n_o = {n_o}`$")).collect();
    let titles: Vec<&str> = std::iter::once("$`sigma`$")
        .chain(steady.iter().map(String::as_str))
        .chain(["$`E0`$", "largest $`|e|`$", "steady $`|u|`$", "largest $`|u|`$"])
        .chain(rates.iter().map(String::as_str))
        .collect();
    let mut table = Table::new(&titles);
    for GainRow { sigma, e0, steady, steady_with, peak, control, rates, .. } in rows {
        let steady =
            if steady_with.is_empty() { vec![steady] } else { steady_with.iter().map(|(_, own)| own).collect() };
        let largest = &control.steady + &control.transient;
        let rate = |(_, rate): &(u32, Option<Rational>)| {
            rate.as_ref().map_or_else(|| "not proved".to_owned(), |rate| exact(rate, Direction::Down))
        };
        let cells = std::iter::once(write_exact(sigma))
            .chain(steady.into_iter().map(upper))
            .chain([exact(e0, Direction::Down), upper(peak), upper(&control.steady), upper(&largest)])
            .chain(rates.iter().map(rate));
        table.push(cells);
    }
    vec![Block::heading("What larger gains bring"), Block::says(says), Block::Table(table)]
}

/// The rows as JSON.
pub(super) fn rows_json(rows: &[GainRow]) -> Value {
    let row = |GainRow { sigma, e0, steady, steady_with, peak, control, rates, .. }: &GainRow| {
        // At samples it is one bound for every n_o.
        let steady: Value = match steady_with.is_empty() {
            true => json!([{ "sup": full(steady) }]),
            false => steady_with.iter().map(|(n_o, bound)| json!({ "n_o": n_o, "sup": full(bound) })).collect(),
        };
        let mut value = json!({
            "sigma": write_exact(sigma), "E0": write_exact(e0), "steady_error": steady, "peak_error": full(peak),
            "control": { "steady": full(&control.steady), "transient": full(&control.transient) },
        });
        if !rates.is_empty() {
            let rate =
                |(n_o, rate): &(u32, Option<Rational>)| json!({ "n_o": n_o, "rate": rate.as_ref().map(write_exact) });
            value["rates"] = rates.iter().map(rate).collect();
        }
        value
    };
    rows.iter().map(row).collect()
}

/// The gain to use where nothing is required, as JSON: of the rows, that of the claim among them; null without rows.
pub(super) fn to_use_json(rows: &[GainRow]) -> Value {
    GainRow::to_use(rows)
        .map_or(Value::Null, |(row, keeps)| json!({ "sigma": write_exact(&row.sigma), "keeps_rule": keeps }))
}

/// The gain to use where nothing is required, where that is a larger one than that of the claim, under its name in the report.
pub(super) fn to_use(rows: &[GainRow]) -> Option<(&'static str, String)> {
    let (own, (row, keeps)) = rows.first().zip(GainRow::to_use(rows))?;
    if row.sigma == own.sigma {
        return None;
    }
    // A set whose sizes the file does not state has other ones at another gain.
    let set = match row.e0 == own.e0 {
        true => String::new(),
        false => format!("; its initial set has $`|e| <= {}`$", exact(&row.e0, Direction::Down)),
    };
    let said = format!(
        "$`sigma = {}`$ keeps $`|e| <= {}`$ and $`|u| <= {}`$ at all times, with every $`n_o`${set}",
        write_exact(&row.sigma),
        upper(&row.peak),
        upper(&(&row.control.steady + &row.control.transient)),
    );
    Some((if keeps { "gain to use" } else { "larger gain" }, said))
}
