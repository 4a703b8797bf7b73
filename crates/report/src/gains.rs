//! What larger gains bring: certified bounds at multiples of the gain of a claim.

use serde_json::{Value, json};
use sigmastar_document::number::{exact, full, upper};
use sigmastar_document::{Block, Table};
use sigmastar_exact::number::{Direction, write_exact};
use sigmastar_prove::certify::{Certification, GainRow, SHOWN_N_O};

/// The share of the bound of |e| that a larger gain has to leave to be named.
const WORTH: f64 = 0.5;

/// The table; nothing where there are no rows but that of the claim.
pub(super) fn section(run: &Certification<'_>) -> Vec<Block> {
    if run.gains.len() < 2 {
        return Vec::new();
    }
    let [none, some] = SHOWN_N_O.map(|n_o| format!("steady |e|, {n_o}"));
    let titles = ["sigma", &none, &some, "E0", "largest |e|", "steady |u|", "largest |u|"];
    let mut table = Table::new(&titles);
    for GainRow { sigma, e0, steady: [first, second], peak, control } in &run.gains {
        let largest = &control.steady + &control.transient;
        let [peak, along, largest] = [peak, &control.steady, &largest].map(upper);
        table.push([write_exact(sigma), upper(first), upper(second), exact(e0, Direction::Down), peak, along, largest]);
    }
    vec![
        Block::heading("What larger gains bring"),
        Block::says(
            "Steady is along the periodic solution, of the error with 0 and with 10 oscillators; largest is on the way from |e| <= E0 and the \
             rest of the initial set: where the file states no sizes of the set they are twice those of the periodic solution at that gain. \
             Each row is proved, for every n_o but where one is named, with a witness of its own that no independent program checks: \
             `certify --sigma V -o FILE` writes a certificate.",
        ),
        Block::Table(table),
    ]
}

/// The rows as JSON.
pub(super) fn rows_json(run: &Certification<'_>) -> Value {
    let row = |GainRow { sigma, e0, steady, peak, control }: &GainRow| {
        let named = SHOWN_N_O.iter().zip(steady).map(|(n_o, bound)| json!({ "n_o": n_o, "sup": full(bound) }));
        json!({
            "sigma": write_exact(sigma), "E0": write_exact(e0), "steady_error": named.collect::<Vec<_>>(), "peak_error": full(peak),
            "control": { "steady": full(&control.steady), "transient": full(&control.transient) },
        })
    };
    run.gains.iter().map(row).collect()
}

/// That the bound of |e| on the way is far above the initial set, with a gain that is better where there is one.
pub(super) fn remark(run: &Certification<'_>) -> Option<String> {
    let (set, own) = (run.claimed_set()?, run.gains.first()?);
    if !own.goes_far() {
        return None;
    }
    let peak = own.peak.upper_f64();
    let better = run.gains.iter().skip(1).find(|row| row.peak.upper_f64() <= WORTH * peak);
    let better = better.map_or_else(String::new, |row| {
        let e0 = exact(&row.e0, Direction::Down);
        format!(": at sigma = {} it is {}, from {e0}", write_exact(&row.sigma), upper(&row.peak))
    });
    Some(format!(
        "Remark: on the way |e| is proved to be at most {}, from at most {} at the start. A larger gain may help{better}; `--peak-error V` \
         seeks one.",
        upper(&own.peak),
        exact(&set.e0, Direction::Down)
    ))
}
