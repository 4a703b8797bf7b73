//! What larger gains bring: certified bounds at multiples of the gain of a claim.

use rug::Rational;
use serde_json::{Value, json};
use sigmastar_document::number::{exact, full, upper};
use sigmastar_document::{Block, Table};
use sigmastar_exact::number::{Direction, write_exact};
use sigmastar_prove::certify::{Certification, GainRow, SHOWN_N_O, SampledCertification};

/// The share of the bound of |e| that a larger gain has to leave to be named.
const WORTH: f64 = 0.5;

/// The table of a claim in continuous time; nothing where there are no rows but that of the claim.
pub(super) fn section(run: &Certification<'_>) -> Vec<Block> {
    let steady = SHOWN_N_O.map(|n_o| format!("steady $`|e|`$, {n_o}"));
    let says = "Steady is along the periodic solution, of the error with 0 and with 10 oscillators; largest is in the transient from $`|e| <= E0`$ and the rest \
                of the initial set, of which a size that the file does not state goes with the gain: it is at least twice the bound of the periodic solution there. \
                Each row is proved, for every $`n_o`$ but where one is named, with a witness of its own that no independent program checks: \
                `certify --sigma V -o FILE` writes a certificate, and `sampling` lists the longest sampling periods of such gains.";
    table(&run.gains, &steady, says)
}

/// The table of a claim at samples; nothing where there are no rows but that of the claim.
pub(super) fn sampled_section(run: &SampledCertification<'_>) -> Vec<Block> {
    let says = "At the same samples; steady is along the periodic solution, largest in the transient from $`|e| <= E0`$ and the rest of the initial set, of which a \
                size that the file does not state goes with the gain: it is at least twice the bound of the periodic solution there. Each row is proved, for every $`n_o`$ below half of \
                the samples but where one is named, and for that gain alone; no independent program checks it: `certify --sigma V -o FILE` writes a certificate.";
    table(&run.gains, &["steady $`|e|`$".to_owned()], says)
}

fn table(rows: &[GainRow], steady: &[String], says: &str) -> Vec<Block> {
    let [first, _, ..] = rows else { return Vec::new() };
    let rates: Vec<String> = first.rates.iter().map(|(n_o, _)| format!("rate, {n_o}")).collect();
    let titles: Vec<&str> = std::iter::once("$`sigma`$")
        .chain(steady.iter().map(String::as_str))
        .chain(["$`E0`$", "largest $`|e|`$", "steady $`|u|`$", "largest $`|u|`$"])
        .chain(rates.iter().map(String::as_str))
        .collect();
    let mut table = Table::new(&titles);
    for GainRow { sigma, e0, steady, peak, control, rates, .. } in rows {
        let largest = &control.steady + &control.transient;
        let rate = |(_, rate): &(u32, Option<Rational>)| {
            rate.as_ref().map_or_else(|| "not proved".to_owned(), |rate| exact(rate, Direction::Down))
        };
        let cells = std::iter::once(write_exact(sigma))
            .chain(steady.iter().map(upper))
            .chain([exact(e0, Direction::Down), upper(peak), upper(&control.steady), upper(&largest)])
            .chain(rates.iter().map(rate));
        table.push(cells);
    }
    vec![Block::heading("What larger gains bring"), Block::says(says), Block::Table(table)]
}

/// The rows as JSON.
pub(super) fn rows_json(rows: &[GainRow]) -> Value {
    let row = |GainRow { sigma, e0, steady, peak, control, rates, .. }: &GainRow| {
        // At samples it is one bound for every n_o.
        let steady: Value = match steady.as_slice() {
            [all] => json!([{ "sup": full(all) }]),
            named => {
                SHOWN_N_O.iter().zip(named).map(|(n_o, bound)| json!({ "n_o": n_o, "sup": full(bound) })).collect()
            }
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

/// That the bound of |e| in the transient is far above the initial set, with a gain that is better where there is one.
pub(super) fn remark(run: &Certification<'_>) -> Option<String> {
    let (set, own) = (run.claimed_set()?, run.gains.first()?);
    if !own.goes_far() {
        return None;
    }
    let peak = own.peak.upper_f64();
    let better = run.gains.iter().skip(1).find(|row| row.peak.upper_f64() <= WORTH * peak);
    let better = better.map_or_else(String::new, |row| {
        let e0 = exact(&row.e0, Direction::Down);
        format!(": at $`sigma = {}`$ it is {}, from {e0}", write_exact(&row.sigma), upper(&row.peak))
    });
    Some(format!(
        "Remark: in the transient $`|e|`$ is proved to be at most {}, from at most {} at the start. A larger gain may help{better}; `--peak-error V` \
         seeks one.",
        upper(&own.peak),
        exact(&set.e0, Direction::Down)
    ))
}
