//! Rates for given numbers of oscillators in a certificate: what is claimed, and what proves it (derivation, 13.6).

use crate::certify::{Certification, SampledCertification};
use crate::rate::bound::RateBound;
use crate::rate::sampled::bound::SampledRateBound;
use crate::rate::sampled::form::OfX;
use rug::Rational;
use serde_json::{Value, json};
use sigmastar_exact::number::write_exact;

/// The name of both parts.
const FOR_N_O: &str = "for_n_o";

/// The part of the claim: n_o, rate and factor; none where no rate is proved.
pub(super) fn claimed_rates(run: &Certification<'_>) -> Option<(&'static str, Value)> {
    part(
        run,
        |RateBound { n_o, witness, factor, .. }| json!({ "n_o": n_o, "rate": write_exact(&witness.rate), "factor": write_exact(factor) }),
    )
}

/// The part of the witness: w and l where x counts, Pi by the rows of its lower triangle, and its bounds.
pub(super) fn rate_witnesses(run: &Certification<'_>) -> Option<(&'static str, Value)> {
    part(run, |RateBound { n_o, witness, has_x, e_low, upper: [e_up, z_up], .. }| {
        let row = |row: &Vec<rug::Rational>| row.iter().map(write_exact).collect::<Vec<String>>();
        let mut value = json!({
            "n_o": n_o,
            "Pi": witness.pi.iter().map(row).collect::<Vec<_>>(),
            "e_low": write_exact(e_low), "e_up": write_exact(e_up), "z_up": write_exact(z_up),
        });
        if *has_x {
            (value["w"], value["l"]) = (write_exact(&witness.w).into(), write_exact(&witness.l).into());
        }
        value
    })
}

fn part(run: &Certification<'_>, of: impl Fn(&RateBound) -> Value) -> Option<(&'static str, Value)> {
    let all: Vec<Value> = run.for_n_o.iter().filter_map(|found| found.bound.as_ref()).map(of).collect();
    (!all.is_empty()).then_some((FOR_N_O, Value::Array(all)))
}

/// The same part of a claim at samples.
pub(super) fn claimed_sampled_rates(run: &SampledCertification<'_>) -> Option<(&'static str, Value)> {
    sampled_part(run, |SampledRateBound { n_o, rate, factor, .. }| {
        json!({ "n_o": n_o, "rate": write_exact(rate), "factor": write_exact(factor) })
    })
}

/// The same part of a witness at samples: Pi and its bounds, c and the multipliers, with w those of x where x counts.
pub(super) fn sampled_rate_witnesses(run: &SampledCertification<'_>) -> Option<(&'static str, Value)> {
    sampled_part(run, |SampledRateBound { n_o, witness, e_low, upper: [e_up, z_up], .. }| {
        let row = |row: &Vec<Rational>| row.iter().map(write_exact).collect::<Vec<String>>();
        let mut value = json!({
            "n_o": n_o,
            "Pi": witness.pi.iter().map(row).collect::<Vec<_>>(),
            "e_low": write_exact(e_low), "e_up": write_exact(e_up), "z_up": write_exact(z_up),
            "c": write_exact(&witness.c),
            "l_slope": write_exact(&witness.l_slope), "l_hold": write_exact(&witness.l_hold),
        });
        if let Some(OfX { w, l_x, l_e, l_y }) = &witness.of_x {
            for (name, number) in [("w", w), ("l_x", l_x), ("l_e", l_e), ("l_y", l_y)] {
                value[name] = write_exact(number).into();
            }
        }
        value
    })
}

fn sampled_part(
    run: &SampledCertification<'_>,
    of: impl Fn(&SampledRateBound) -> Value,
) -> Option<(&'static str, Value)> {
    let all: Vec<Value> = run.for_n_o.iter().filter_map(|found| found.bound.as_ref()).map(of).collect();
    (!all.is_empty()).then_some((FOR_N_O, Value::Array(all)))
}
