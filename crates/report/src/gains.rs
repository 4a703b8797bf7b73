//! What larger gains bring: certified bounds at multiples of the gain of a claim.

use serde_json::{Value, json};
use sigmastar_document::number::{full, upper};
use sigmastar_document::{Block, Table};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::write_exact;
use sigmastar_prove::certify::{Certification, GainRow, SHOWN_N_O};

/// By so much more than at the start |e| is remarked to be on the way.
const FAR: f64 = 10.0;

/// The share of the bound of |e| that a larger gain has to leave to be named.
const WORTH: f64 = 0.5;

/// The table; nothing where there are no rows but that of the claim.
pub(super) fn section(run: &Certification<'_>) -> Vec<Block> {
    if run.gains.len() < 2 {
        return Vec::new();
    }
    let [none, some] = SHOWN_N_O.map(|n_o| format!("sup|e| at most, n_o = {n_o}"));
    let titles = ["sigma", &none, &some, "|e| on the way", "|u| along it", "|u| on the way"];
    let mut table = Table::new(&titles);
    for GainRow { sigma, steady: [first, second], peak, control } in &run.gains {
        let largest = &control.steady + &control.transient;
        let sizes = [first, second, peak, &control.steady, &largest].map(upper);
        table.push(std::iter::once(write_exact(sigma)).chain(sizes));
    }
    vec![
        Block::heading("What larger gains bring"),
        Block::says(
            "Along the periodic solution and on the way to it from the initial set of the claim. Each row is proved for every n_o (but \
             where one is named), by a witness of its own that has no independent check: `certify --sigma V -o FILE` writes one that has.",
        ),
        Block::Table(table),
    ]
}

/// The rows as JSON.
pub(super) fn rows_json(run: &Certification<'_>) -> Value {
    let row = |GainRow { sigma, steady, peak, control }: &GainRow| {
        let named = SHOWN_N_O.iter().zip(steady).map(|(n_o, bound)| json!({ "n_o": n_o, "sup": full(bound) }));
        json!({
            "sigma": write_exact(sigma), "steady_error": named.collect::<Vec<_>>(), "peak_error": full(peak),
            "control": { "steady": full(&control.steady), "transient": full(&control.transient) },
        })
    };
    run.gains.iter().map(row).collect()
}

/// That the bound of |e| on the way is far above the initial set, with a gain that is better where there is one.
pub(super) fn remark(run: &Certification<'_>) -> Option<String> {
    let (set, own) = (run.claimed_set()?, run.gains.first()?);
    let e0 = Enclosure::from_rational(&set.e0, run.precision);
    let start = e0.upper_f64().max(own.steady[0].upper_f64());
    let peak = own.peak.upper_f64();
    if peak.is_nan() || peak <= FAR * start {
        return None;
    }
    let better = run.gains.iter().skip(1).find(|row| row.peak.upper_f64() <= WORTH * peak);
    let better = better.map_or_else(String::new, |row| {
        format!(": at sigma = {} it is {}", write_exact(&row.sigma), upper(&row.peak))
    });
    Some(format!(
        "Remark: on the way |e| is proved to be at most {}, from at most {} at the start. A larger gain may help{better}; `--peak-error V` \
         seeks one.",
        upper(&own.peak),
        write_exact(&set.e0)
    ))
}
