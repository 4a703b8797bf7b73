//! The report on the transfer bound as JSON.

use super::TransferReport;
use crate::number::write_exact;
use crate::report::json::interval;
use crate::transfer::{CertifiedPair, OscillatorCount, PairStatus, lambda_interval};
use serde_json::{Value, json};

/// The format of this report.
const FORMAT: &str = "sigmastar/transfer";
/// Its version.
const VERSION: u64 = 1;

pub(super) fn report(report: &TransferReport<'_>) -> Value {
    let data = &report.data;
    let (pair, w) = (&report.pair, &data.base_frequency);
    let per_n_o: Vec<Value> = report
        .rows
        .iter()
        .map(|row| {
            json!({
                "n_o": count_json(row.ratio.n_o), "ratio": interval(&row.ratio.ratio), "x": write_exact(&row.ratio.x),
                "slowest_decay": row.decay.as_ref().map(interval),
            })
        })
        .collect();
    let trade_off: Vec<Value> = report.trade_off.iter().map(|pair| pair_json(report, pair)).collect();
    let obstacle = pair.obstacle.as_ref().map(|obstacle| {
        json!({
            "n_o": obstacle.n_o, "x": write_exact(&obstacle.x), "value": interval(&obstacle.value),
            "least_k1": interval(&obstacle.least_k1),
        })
    });
    let matched = report.matched.as_ref().map(
        |matched| json!({ "k0": write_exact(&matched.k0), "k1": write_exact(&matched.k1), "K": matched.first_of_tail }),
    );
    json!({
        "format": FORMAT, "version": VERSION, "verdict": "certified", "independent_check": "none",
        "specification": { "name": data.spec.name, "sha256": data.spec.sha256 },
        "statement": "T_N(x) <= k0 + k1 x^2 for every N >= 0 and every x >= 0",
        "nu": interval(&data.nu),
        "k0": write_exact(&pair.k0), "k1": write_exact(&pair.k1),
        "kappa_0": interval(&(data.rational(&pair.k0) / w.sqr())),
        "kappa_1": interval(&(data.rational(&pair.k1) / w.sqr().sqr())),
        "m0": pair.proof.m0, "N0": pair.proof.n0, "boxes": pair.proof.boxes(),
        "obstacle": obstacle,
        "per_n_o": per_n_o,
        "trade_off": trade_off,
        "matched": matched,
        "printed": printed(report),
        "repaired": { "k0": interval(&report.printed.repaired.0), "k1": interval(&report.printed.repaired.1) },
    })
}

/// A number, or the word for all oscillators.
fn count_json(n_o: OscillatorCount) -> Value {
    match n_o {
        OscillatorCount::Finite(n) => json!(n),
        OscillatorCount::Infinite => json!(n_o.to_string()),
    }
}

fn pair_json(report: &TransferReport<'_>, pair: &CertifiedPair) -> Value {
    json!({
        "k0": write_exact(&pair.k0), "k1": write_exact(&pair.k1),
        "excess": pair.excess(&report.data).map(|excess| excess.upper_decimal(6)),
        "m0": pair.proof.m0, "N0": pair.proof.n0, "boxes": pair.proof.boxes(),
    })
}

fn printed(report: &TransferReport<'_>) -> Value {
    let verdict = &report.printed;
    let constants = &verdict.constants;
    let lambda: Vec<Value> = (1..=3)
        .filter_map(|m| lambda_interval(constants, m).map(|(low, high)| json!([interval(&low), interval(&high)])))
        .collect();
    let checks: Vec<Value> = verdict
        .checks
        .iter()
        .map(|check| {
            json!({
                "what": check.what, "printed": interval(&check.printed), "needed": interval(&check.needed),
                "holds": check.holds.to_string(),
            })
        })
        .collect();
    let status = match &verdict.status {
        PairStatus::Proved => json!({ "truth": "true" }),
        PairStatus::Undecided => json!({ "truth": "undecided" }),
        PairStatus::Refuted(point) => json!({
            "truth": "false", "n_o": point.n_o, "x": write_exact(&point.x),
            "value": interval(&point.value), "bound": interval(&point.bound),
        }),
    };
    json!({
        "S": interval(&constants.s), "a": interval(&constants.a), "varpi": interval(&constants.varpi),
        "kappa_0": interval(&constants.kappa_0), "kappa_1": interval(&constants.kappa_1),
        "lambda_from_m_1": lambda, "checks": checks, "pair": status,
    })
}
