//! Rates for given numbers of oscillators in a certificate: what is claimed, and what proves it (derivation, 13.6).

use crate::certify::Certification;
use crate::rate::bound::RateBound;
use crate::rate::found::RateForCount;
use crate::rate::inequality::RateWitness;
use crate::rate::noise::NoiseBound;
use serde_json::{Value, json};
use sigmastar_exact::number::write_exact;

/// The name of both parts.
const FOR_N_O: &str = "for_n_o";

/// The part of the claim: n_o, rate and factor, and bounds under noise; none where no rate is proved.
pub(super) fn claimed_rates(run: &Certification<'_>) -> Option<(&'static str, Value)> {
    part(run, |RateBound { n_o, witness, factor, .. }, noise| {
        let mut value = json!({ "n_o": n_o, "rate": write_exact(&witness.rate), "factor": write_exact(factor) });
        if let Some(NoiseBound { limit, peak, .. }) = noise {
            value["noise"] = json!({ "limit": write_exact(limit), "peak": write_exact(peak) });
        }
        value
    })
}

/// The part of the witness: w and l where x counts, Pi by the rows of its lower triangle, and its bounds; the same for noise.
pub(super) fn rate_witnesses(run: &Certification<'_>) -> Option<(&'static str, Value)> {
    part(run, |RateBound { n_o, witness, has_x, e_low, upper: [e_up, z_up], .. }, noise| {
        let mut value = json!({
            "n_o": n_o,
            "Pi": rows(witness),
            "e_low": write_exact(e_low), "e_up": write_exact(e_up), "z_up": write_exact(z_up),
        });
        of_x(&mut value, witness, *has_x);
        if let Some(NoiseBound { witness, has_x, e_low, .. }) = noise {
            let mut part = json!({
                "Pi": rows(witness), "lambda": write_exact(&witness.rate), "e_low": write_exact(e_low),
            });
            of_x(&mut part, witness, *has_x);
            for (name, weight) in ["g_d", "g_v"].into_iter().zip(&witness.inputs) {
                if let Some(weight) = weight {
                    part[name] = write_exact(weight).into();
                }
            }
            value["noise"] = part;
        }
        value
    })
}

fn rows(witness: &RateWitness) -> Vec<Vec<String>> {
    witness.pi.iter().map(|row| row.iter().map(write_exact).collect()).collect()
}

fn of_x(value: &mut Value, witness: &RateWitness, has_x: bool) {
    if has_x {
        (value["w"], value["l"]) = (write_exact(&witness.w).into(), write_exact(&witness.l).into());
    }
}

fn part(
    run: &Certification<'_>,
    of: impl Fn(&RateBound, Option<&NoiseBound>) -> Value,
) -> Option<(&'static str, Value)> {
    let one = |found: &RateForCount| {
        let noise = found.noise.as_ref().and_then(|noise| noise.as_ref().ok());
        found.bound.as_ref().map(|bound| of(bound, noise))
    };
    let all: Vec<Value> = run.for_n_o.iter().filter_map(one).collect();
    (!all.is_empty()).then_some((FOR_N_O, Value::Array(all)))
}
