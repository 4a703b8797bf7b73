//! Rates for given numbers of oscillators in a certificate: what is claimed, and what proves it (derivation, 13.6).

use crate::certify::Certification;
use crate::rate::bound::RateBound;
use crate::rate::by_matrices::ByMatrices;
use rug::Rational;
use serde_json::{Value, json};
use sigmastar_exact::number::write_exact;
use sigmastar_plants::bounds::Slopes;

/// The name of both parts.
const FOR_N_O: &str = "for_n_o";

/// The part of the claim: n_o, rate and factor; none where no rate is proved.
pub(super) fn claimed_rates(run: &Certification<'_>) -> Option<(&'static str, Value)> {
    part(
        run,
        |RateBound { n_o, witness, factor, .. }| json!({ "n_o": n_o, "rate": write_exact(&witness.rate), "factor": write_exact(factor) }),
    )
}

/// The part of the witness: w and l where x counts, Pi by the rows of its lower triangle, and its bounds; by matrices Q, G and H.
pub(super) fn rate_witnesses(run: &Certification<'_>) -> Option<(&'static str, Value)> {
    part(run, |RateBound { n_o, witness, has_x, by, e_low, upper: [e_up, z_up], .. }| {
        let row = |row: &[Rational]| row.iter().map(write_exact).collect::<Vec<String>>();
        let triangle = |of: &[Vec<Rational>]| of.iter().enumerate().map(|(i, all)| row(&all[..=i])).collect::<Vec<_>>();
        let mut value = json!({
            "n_o": n_o,
            "Pi": triangle(&witness.pi),
            "e_low": write_exact(e_low), "e_up": write_exact(e_up), "z_up": write_exact(z_up),
        });
        if let Some(ByMatrices { slopes: Slopes { q, g, h }, x_up }) = by {
            let full: Vec<_> = g.iter().map(|all| row(all)).collect();
            value["slopes"] = json!({ "Q": triangle(q), "G": full, "H": triangle(h) });
            if let Some(x_up) = x_up {
                value["x_up"] = write_exact(x_up).into();
            }
        }
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
