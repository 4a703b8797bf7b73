//! Rates for given oscillators in a certificate: what is claimed, and what proves it (derivation, 13.6).

use super::by_count::place_of;
use super::json::{exact, object, rows};
use crate::rate::bound::{ByForm, ByMatrices, RateBound};
use crate::rate::found::{ForCount, RateForCount, SampledRateForCount};
use crate::rate::noise::{NoiseBound, NoiseByForm};
use crate::rate::sampled::noise::SampledNoise;
use crate::rate::sampled::rounding::RoundingWitness;
use rug::Rational;
use serde_json::{Value, json};
use sigmastar_decide::rates::at_samples::{Inputs, OfX, SampledRateWitness};
use sigmastar_decide::rates::inequality::RateWitness;
use sigmastar_exact::number::write_exact;
use sigmastar_theory::evidence::{Part, Slopes};

/// The name of both parts.
const FOR_N_O: &str = "for_n_o";

/// The part of the claim: n_o or the harmonics, rate and factor, and bounds under noise; none where no rate is proved.
pub(super) fn claimed_rates<P, Q>(found: &[ForCount<P, Q>]) -> Option<(&'static str, Value)> {
    part(found, |RateBound { oscillators, rate, factor, .. }, noise| {
        let numbers = [("rate", rate), ("factor", factor)].map(|(name, number)| (name, exact(number)));
        let mut value = object([place_of(oscillators)].into_iter().chain(numbers));
        if let Some(NoiseBound { limit, peak, .. }) = noise {
            value["noise"] = json!({ "limit": write_exact(limit), "peak": write_exact(peak) });
        }
        value
    })
}

/// The part of the witness: w and l where x counts, Pi by the rows of its lower triangle, and its bounds; by matrices Q, G and H; the same for noise.
pub(super) fn rate_witnesses(found: &[RateForCount]) -> Option<(&'static str, Value)> {
    part(found, |RateBound { oscillators, proof, e_low, upper: [e_up, z_up], .. }, noise| {
        let ByForm { witness, has_x, by } = proof;
        let bounds = [("e_low", e_low), ("e_up", e_up), ("z_up", z_up)].map(|(name, number)| (name, exact(number)));
        let parts = [place_of(oscillators), ("Pi", json!(rows(&witness.pi)))];
        let mut value = object(parts.into_iter().chain(bounds));
        if let Some(ByMatrices { slopes, x_up }) = by {
            value["slopes"] = of_slopes(slopes);
            if let Some(x_up) = x_up {
                value["x_up"] = write_exact(x_up).into();
            }
        }
        of_x(&mut value, witness, *has_x);
        if let Some(NoiseBound { proof: NoiseByForm { witness, has_x }, e_low, .. }) = noise {
            let mut part = json!({
                "Pi": rows(&witness.pi), "lambda": write_exact(&witness.rate), "e_low": write_exact(e_low),
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

/// Q, G and H of all first derivatives, or of those by x and by e apart.
fn of_slopes(slopes: &[Slopes]) -> Value {
    let mut parts = Value::Null;
    for Slopes { part, q, g, h } in slopes {
        let known = json!({ "Q": lower(q), "G": rows(g), "H": lower(h) });
        match part {
            Part::All => parts = known,
            Part::States => parts["states"] = known,
            Part::Error => parts["error"] = known,
        }
    }
    parts
}

/// The lower triangle of a matrix.
fn lower(matrix: &[Vec<Rational>]) -> Vec<Vec<String>> {
    matrix.iter().enumerate().map(|(i, row)| row[..=i].iter().map(write_exact).collect()).collect()
}

fn of_x(value: &mut Value, witness: &RateWitness, has_x: bool) {
    if has_x {
        (value["w"], value["l"]) = (write_exact(&witness.w).into(), write_exact(&witness.l).into());
    }
}

fn part<P, Q>(
    found: &[ForCount<P, Q>],
    of: impl Fn(&RateBound<P>, Option<&NoiseBound<Q>>) -> Value,
) -> Option<(&'static str, Value)> {
    let one = |found: &ForCount<P, Q>| found.bound.as_ref().map(|bound| of(bound, found.proved_noise()));
    let all: Vec<Value> = found.iter().filter_map(one).collect();
    (!all.is_empty()).then_some((FOR_N_O, Value::Array(all)))
}

/// The part of the witness at samples: Pi and its bounds, c and the multipliers, and w with the multipliers of x where x counts; what
/// proves the bounds of noise besides.
pub(super) fn sampled_rate_witnesses(found: &[SampledRateForCount]) -> Option<(&'static str, Value)> {
    part(found, |RateBound { oscillators, proof: witness, e_low, upper: [e_up, z_up], .. }, noise| {
        let mut value = at_samples(witness, e_low);
        let (name, place) = place_of(oscillators);
        value[name] = place;
        (value["e_up"], value["z_up"]) = (write_exact(e_up).into(), write_exact(z_up).into());
        if let Some(NoiseBound { proof: SampledNoise { witness, rounding }, e_low, .. }) = noise {
            let mut part = at_samples(witness, e_low);
            if let Some(RoundingWitness { z_low, z_up, z_noise, level }) = rounding {
                for (name, number) in [("z_low", z_low), ("z_up", z_up), ("z_noise", z_noise), ("level", level)] {
                    part[name] = write_exact(number).into();
                }
            }
            value["noise"] = part;
        }
        value
    })
}

fn at_samples(witness: &SampledRateWitness, e_low: &Rational) -> Value {
    let SampledRateWitness { pi, c, l_slope, l_hold, of_x, inputs: Inputs { g_d, g_v, g_r } } = witness;
    let mut value = json!({ "Pi": rows(pi) });
    let of_x = of_x.as_ref().map(|OfX { w, l_x, l_e, l_y }| [("w", w), ("l_x", l_x), ("l_e", l_e), ("l_y", l_y)]);
    let inputs = [("g_d", g_d), ("g_v", g_v), ("g_r", g_r)];
    let numbers = [("e_low", e_low), ("c", c), ("l_slope", l_slope), ("l_hold", l_hold)].into_iter();
    let numbers = numbers.chain(of_x.into_iter().flatten());
    for (name, number) in numbers.chain(inputs.into_iter().filter_map(|(name, weight)| Some((name, weight.as_ref()?))))
    {
        value[name] = write_exact(number).into();
    }
    value
}
