//! Drawing A(t) = q(t,0,0).

use super::claim::TriedClaim;
use super::family::{Family, Harmonic};
use super::limits::{Limits, SHARE};
use super::random::Random;
use super::shape::{Factor, Number};
use sigmastar_exact::enclosure::{DEFAULT_PRECISION, Enclosure};
use sigmastar_exact::number::Portable;
use sigmastar_lang::spec::model::{Constant, KnownForcing};
use sigmastar_theory::data::Bound;
use std::f64::consts::{SQRT_2, TAU};

/// The most of the listed harmonics that one A has.
const MOST_LISTED: usize = 12;

/// Harmonics of relative sizes, in orders that are multiples of a number: where q_0 is given those that it lists, each a
/// `share` of its bound, and one or two of the rest; otherwise one to four of neighbouring orders, now and then with a
/// constant.
pub(super) fn harmonics(
    claim: &TriedClaim,
    multiple: u32,
    share: fn(&mut Random) -> f64,
    random: &mut Random,
) -> Vec<Harmonic> {
    if let Some(known) = &claim.spec.q_0 {
        return listed(known, claim.spec.period.nominal().to_f64(), multiple, share, random);
    }
    let mut harmonics = Vec::new();
    if random.chance(0.3) {
        harmonics.push(Harmonic { amplitude: Number::new(random.uniform()), factor: Factor::ONE });
    }
    let (first, count) = (random.whole(1, 3), random.whole(1, 4));
    for order in first..first + count {
        let factor = factor(multiple * order, random);
        harmonics.push(Harmonic { amplitude: Number::new(random.uniform() + 1e-3), factor });
    }
    harmonics
}

/// cos(k Om t + phase) with any phase, or 1.
fn factor(order: u32, random: &mut Random) -> Factor {
    if order == 0 { Factor::ONE } else { Factor { order, phase: Number::new(TAU * random.uniform()) } }
}

fn listed(
    known: &KnownForcing,
    period: f64,
    multiple: u32,
    share: fn(&mut Random) -> f64,
    random: &mut Random,
) -> Vec<Harmonic> {
    let orders = (0..).step_by(multiple as usize);
    let mut bounds: Vec<(u32, f64)> = known
        .harmonics
        .iter()
        .step_by(multiple as usize)
        .zip(orders)
        .map(|(bound, order)| (order, largest_amplitude(order) * bound.to_f64()))
        .filter(|(_, bound)| *bound > 0.0)
        .collect();
    if bounds.len() > MOST_LISTED {
        let first = random.whole(0, (bounds.len() - MOST_LISTED) as u32) as usize;
        bounds = bounds[first..first + MOST_LISTED].to_vec();
    }
    let count = random.whole(1, 2);
    let above = (known.harmonics.len() as u32).div_ceil(multiple);
    for order in (above..above + count).map(|order| multiple * order) {
        let speed = f64::from(order) * TAU / period;
        let by_derivative = known.rest_t_rms.as_ref().map_or(f64::INFINITY, |bound| bound.to_f64() / speed);
        let rms = known.rest_rms.to_f64().min(by_derivative);
        if rms > 0.0 {
            bounds.push((order, SQRT_2 * rms / f64::from(count).sqrt()));
        }
    }
    let draw = |(order, bound): (u32, f64)| {
        let amplitude = Number::new(bound * share(random));
        Harmonic { amplitude, factor: factor(order, random) }
    };
    bounds.into_iter().map(draw).collect()
}

/// The amplitude of a harmonic with |c_k| = 1: a cos has the coefficients a/2 of the orders k and -k.
fn largest_amplitude(order: u32) -> f64 {
    if order == 0 { 1.0 } else { 2.0 }
}

/// The mean square of a harmonic of amplitude 1.
fn mean_square(order: u32) -> f64 {
    if order == 0 { 1.0 } else { 0.5 }
}

/// Scales A so that the first of its bounds is reached, up to what is kept of one: those of q(t,0,0) and its derivative,
/// and where q_0 is given those of the harmonics and of the rest.
pub(super) fn fill(family: &mut Family, claim: &TriedClaim) {
    let limits = Limits::new(claim);
    let period = claim.spec.period.nominal().to_f64();
    let speed = |harmonic: &Harmonic| f64::from(harmonic.factor.order) * TAU / period;
    let amplitude = |harmonic: &Harmonic| harmonic.amplitude.value();
    let sum = |weight: &dyn Fn(&Harmonic) -> f64| family.harmonics.iter().map(weight).sum::<f64>();
    let rms = |weight: &dyn Fn(&Harmonic) -> f64| {
        sum(&|harmonic| weight(harmonic).portable_powi(2) * mean_square(harmonic.factor.order)).sqrt()
    };
    let mut room = vec![
        limits.at_zero(Bound::Q) / sum(&amplitude),
        limits.at_zero(Bound::Qt) / sum(&|harmonic| amplitude(harmonic) * speed(harmonic)),
        limits.at_zero(Bound::QRms) / rms(&amplitude),
        limits.at_zero(Bound::QtRms) / rms(&|harmonic| amplitude(harmonic) * speed(harmonic)),
    ];
    if let Some(known) = &claim.spec.q_0 {
        let bound_of = |harmonic: &Harmonic| known.harmonics.get(harmonic.factor.order as usize);
        room.extend(family.harmonics.iter().filter_map(|harmonic| {
            let allowed = largest_amplitude(harmonic.factor.order) * bound_of(harmonic)?.to_f64();
            Some(SHARE * allowed / amplitude(harmonic))
        }));
        let of_rest = |harmonic: &Harmonic| if bound_of(harmonic).is_none() { amplitude(harmonic) } else { 0.0 };
        room.push(SHARE * known.rest_rms.to_f64() / rms(&of_rest));
        if let Some(bound) = &known.rest_t_rms {
            room.push(SHARE * bound.to_f64() / rms(&|harmonic| of_rest(harmonic) * speed(harmonic)));
        }
    }
    // Nothing against nothing is no limit.
    let factor = room.into_iter().filter(|factor| !factor.is_nan()).fold(f64::INFINITY, f64::min);
    let factor = if factor.is_finite() { factor } else { 0.0 };
    family.harmonics.iter_mut().for_each(|harmonic| harmonic.amplitude = harmonic.amplitude.times(factor));
}

/// Whether A, whose harmonics have different orders, is proved to be as q_0 says, where it is given: the coefficients of
/// the listed orders are within their bounds, and the mean squares of the others and of their derivative are too.
pub(super) fn is_within(family: &Family, claim: &TriedClaim) -> bool {
    let Some(known) = &claim.spec.q_0 else { return true };
    let enclose = |constant: &Constant| constant.enclose(DEFAULT_PRECISION);
    let fundamental = Enclosure::pi(DEFAULT_PRECISION) * 2 / enclose(claim.spec.period.nominal());
    let mut rest = [(); 2].map(|()| Enclosure::zero(DEFAULT_PRECISION));
    for Harmonic { amplitude, factor } in &family.harmonics {
        let Some(amplitude) = amplitude.exact() else { return false };
        let amplitude = Enclosure::from_rational(&amplitude, DEFAULT_PRECISION);
        match known.harmonics.get(factor.order as usize) {
            Some(bound) => {
                let coefficient = if factor.order == 0 { amplitude } else { amplitude / 2 };
                if !coefficient.le(&enclose(bound)).is_true() {
                    return false;
                }
            }
            // q_0 lists the constant, so the mean square of what it does not list is a^2/2.
            None => {
                let drift = &amplitude * &fundamental * i64::from(factor.order);
                let [size, speed] = [amplitude, drift].map(|size| size.sqr() / 2);
                rest = [&rest[0] + size, &rest[1] + speed];
            }
        }
    }
    let [rms, rms_of_derivative] = rest.map(|square| square.sqrt());
    let by_derivative = known.rest_t_rms.as_ref().is_none_or(|bound| rms_of_derivative.le(&enclose(bound)).is_true());
    rms.le(&enclose(&known.rest_rms)).is_true() && by_derivative
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::falsify::draw::draw;
    use crate::falsify::limits::SectorEnd;
    use crate::falsify::linear::linear_member;
    use crate::falsify::membership::MAX_OPERATIONS;
    use sigmastar_lang::expr::{Expr, Variables};
    use sigmastar_lang::spec::Specification;

    const SAMPLES: usize = 256;

    /// The magnitudes of the Fourier coefficients c_0, ..., c_K of A, and the rms of what is left and of its derivative.
    fn spectrum(family: &Family, listed: usize) -> (Vec<f64>, [f64; 2]) {
        let text = |Harmonic { amplitude, factor }: &Harmonic| format!("{amplitude}*{}", factor.text(&family.period));
        let terms: Vec<String> = family.harmonics.iter().map(text).collect();
        let a = Expr::parse(&terms.join(" + "), Variables::Time).unwrap().to_float();
        let values: Vec<f64> = (0..SAMPLES).map(|i| a.eval(i as f64 / SAMPLES as f64, 0.0)).collect();
        let coefficient = |k: usize| {
            let part = |of: fn(f64) -> f64| {
                let term = |(i, value): (usize, &f64)| value * of(TAU * (k * i) as f64 / SAMPLES as f64);
                values.iter().enumerate().map(term).sum::<f64>() / SAMPLES as f64
            };
            part(f64::cos).hypot(part(f64::sin))
        };
        let left = |weight: &dyn Fn(usize) -> f64| {
            (listed..SAMPLES / 2).map(|k| 2.0 * (weight(k) * coefficient(k)).powi(2)).sum::<f64>().sqrt()
        };
        ((0..listed).map(coefficient).collect(), [left(&|_| 1.0), left(&|k| TAU * k as f64)])
    }

    #[test]
    fn harmonics_are_those_of_q_0() {
        let shipped = include_str!("../../../../specs/paper-example-harmonics-at-rest.json");
        let mut unlisted: serde_json::Value = serde_json::from_str(shipped).unwrap();
        // All of it in the rest, and more than q_rms allows.
        unlisted["q_0"] = serde_json::json!({ "harmonics": ["0"], "rest_rms": "1", "rest_t_rms": "5" });
        let mut large = unlisted.clone();
        large["q_0"] = serde_json::json!({ "harmonics": ["9", "9", "0", "9"], "rest_rms": "0" });
        for text in [shipped.to_owned(), unlisted.to_string(), large.to_string()] {
            let spec = Specification::from_json("harmonics", &text).unwrap();
            let claim = TriedClaim::for_tests(spec, [3.0, 4.0]);
            let known = claim.spec.q_0.as_ref().unwrap();
            let mut random = Random::new(11, 12);
            let first = linear_member(&claim, SectorEnd::Upper, &mut random, &mut { MAX_OPERATIONS });
            let others = (0..60).filter_map(|_| draw(&claim, &mut random, &mut { MAX_OPERATIONS })).take(6);
            let plants: Vec<Family> = first.into_iter().chain(others).collect();
            assert_eq!(plants.len(), 7);
            let mut used = 0.0_f64;
            for family in &plants {
                let (coefficients, [rest, drift]) = spectrum(family, known.harmonics.len());
                let bounds = known.harmonics.iter().map(Constant::to_f64);
                for (found, bound) in coefficients.iter().zip(bounds) {
                    assert!(*found <= bound + 1e-12, "{found} {bound}");
                    used = used.max(if bound > 0.0 { found / bound } else { 0.0 });
                }
                let [rms, rms_of_derivative] = [Some(&known.rest_rms), known.rest_t_rms.as_ref()]
                    .map(|bound| bound.map_or(f64::INFINITY, Constant::to_f64));
                assert!(rest <= rms + 1e-12 && drift <= rms_of_derivative + 1e-9, "{rest} {drift}");
                used = used.max(if rms > 1e-3 { (rest / rms).max(drift / rms_of_derivative) } else { 0.0 });
                let q_rms = (coefficients[0].powi(2) + 2.0 * coefficients[1..].iter().map(|c| c * c).sum::<f64>())
                    .sqrt()
                    .hypot(rest);
                used = used.max(q_rms / 2.302);
            }
            assert!(used > 0.97, "{used}");
        }
    }

    #[test]
    fn what_q_0_does_not_allow_is_seen() {
        let text = include_str!("../../../../specs/paper-example-harmonics-at-rest.json");
        let claim = TriedClaim::for_tests(Specification::from_json("harmonics", text).unwrap(), [3.0, 4.0]);
        let family = linear_member(&claim, SectorEnd::Upper, &mut Random::new(1, 1), &mut { MAX_OPERATIONS }).unwrap();
        assert!(is_within(&family, &claim));
        for (order, amplitude, within) in [
            (0, 1.8755, true),
            (0, 1.8757, false),
            (1, 1.58311, true),
            (1, 1.58313, false),
            (5, 1.41e-5, true),
            (5, 1.42e-5, false),
        ] {
            let mut other = family.clone();
            let factor = Factor { order, phase: Number::new(1.0) };
            other.harmonics = vec![Harmonic { amplitude: Number::new(amplitude), factor }];
            assert_eq!(is_within(&other, &claim), within, "{order} {amplitude}");
        }
    }
}
