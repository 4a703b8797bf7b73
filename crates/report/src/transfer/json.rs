//! The report on the transfer bound as JSON.

use super::sets;
use serde_json::{Value, json};
use sigmastar_exact::number::write_exact;
use sigmastar_prove::certify::Verdict;
use sigmastar_theory::data::Data;
use sigmastar_theory::transfer::{
    CertifiedPair, OscillatorCount, PairError, PairStatus, PrintedCheck, PrintedChecks, TransferStudy, Uniformity,
    lambda_interval,
};

pub(super) fn report(study: &TransferStudy<'_>) -> Value {
    let (data, pair) = (&study.data, &study.pair);
    let [kappa_0, kappa_1] = data.kappas(&data.rational(&pair.k0), &data.rational(&pair.k1));
    let per_n_o = |Uniformity { sup, decay }: &Uniformity| {
        json!({
            "n_o": count_json(sup.n_o), "ratio": sup.ratio.decimals(), "x": write_exact(&sup.x),
            "slowest_decay": decay.as_ref().map(|decay| decay.decimals()),
        })
    };
    let obstacle = pair.binding.as_ref().map(|point| {
        json!({
            "n_o": point.n_o, "x": write_exact(&point.x), "value": point.value.decimals(),
            "least_k1": point.least_k1.decimals(),
        })
    });
    let matched = study.matched.as_ref().map(
        |matched| json!({ "k0": write_exact(&matched.k0), "k1": write_exact(&matched.k1), "K": matched.first_of_tail }),
    );
    json!({
        "format": "sigmastar/transfer", "version": 1, "verdict": "certified", "independent_check": "none",
        "specification": { "name": data.spec.name, "sha256": data.spec.sha256 },
        "statement": "T_N(x) <= k0 + k1 x^2 for every N >= 0 and every x >= 0",
        "nu": data.nu.decimals(),
        "k0": write_exact(&pair.k0), "k1": write_exact(&pair.k1),
        "kappa_0": kappa_0.decimals(), "kappa_1": kappa_1.decimals(),
        "m0": pair.proof.m0, "N0": pair.proof.n0, "boxes": pair.proof.boxes(),
        "obstacle": obstacle,
        "per_n_o": study.uniformity.iter().map(per_n_o).collect::<Vec<_>>(),
        "trade_off": study.trade_off.iter().map(|pair| pair_json(data, pair)).collect::<Vec<_>>(),
        "matched": matched,
        "every_set": study.every_set.as_ref().map(|sets| sets::json(study, sets)),
        "printed": printed(&study.printed),
        "repaired": { "k0": study.printed.repaired.0.decimals(), "k1": study.printed.repaired.1.decimals() },
    })
}

/// The report object of a call that came to no pair.
#[must_use]
pub fn pair_failure_json(verdict: Verdict, error: &PairError) -> Value {
    json!({
        "format": "sigmastar/transfer", "version": 1, "verdict": verdict.to_string(),
        "reason": error.to_string(), "help": error.way_out(),
    })
}

/// A number, or the word for all oscillators.
fn count_json(n_o: OscillatorCount) -> Value {
    match n_o {
        OscillatorCount::Finite(n) => json!(n),
        OscillatorCount::Infinite => json!(n_o.to_string()),
    }
}

fn pair_json(data: &Data<'_>, pair: &CertifiedPair) -> Value {
    json!({
        "k0": write_exact(&pair.k0), "k1": write_exact(&pair.k1),
        "excess": pair.excess(data).map(|excess| excess.upper_decimal(6)),
        "m0": pair.proof.m0, "N0": pair.proof.n0, "boxes": pair.proof.boxes(),
    })
}

fn printed(printed: &PrintedChecks) -> Value {
    let constants = &printed.constants;
    let lambda: Vec<Value> = (1..=3)
        .filter_map(|m| lambda_interval(constants, m).map(|(low, high)| json!([low.decimals(), high.decimals()])))
        .collect();
    let check = |check: &PrintedCheck| {
        json!({
            "what": check.what, "printed": check.printed.decimals(), "needed": check.needed.decimals(),
            "holds": check.holds.to_string(),
        })
    };
    let status = match &printed.status {
        PairStatus::Proved => json!({ "truth": "true" }),
        PairStatus::Undecided => json!({ "truth": "undecided" }),
        PairStatus::Refuted(point) => json!({
            "truth": "false", "n_o": point.n_o, "x": write_exact(&point.x),
            "value": point.value.decimals(), "bound": point.bound.decimals(),
        }),
    };
    json!({
        "S": constants.s.decimals(), "a": constants.a.decimals(), "varpi": constants.varpi.decimals(),
        "kappa_0": constants.kappa_0.decimals(), "kappa_1": constants.kappa_1.decimals(),
        "lambda_from_m_1": lambda, "checks": printed.checks.each_ref().map(check), "pair": status,
    })
}
