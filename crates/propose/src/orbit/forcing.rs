//! The harmonics of q(t, x_0, 0) (derivation, 11.4) and the size of their rest, sampled in doubles: proposals.

use super::field::Field;
use super::round::to_grain;
use super::sampled::doubles;
use super::series::FloatSeries;
use rug::Rational;
use sigmastar_exact::number::Portable;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{OrbitCurve, ProvedForcing, TrigonometricVector, Wave};
use std::f64::consts::TAU;

/// The most harmonics of qb that are proposed, and the points of the transform.
const PROPOSED_HARMONICS: usize = 128;
const POINTS: usize = 1024;

/// What is left out and rounded, relative to the root mean square of q(t,x_0,0) and of its derivative.
const WANTED_REST: f64 = 1e-8;

/// The least size of the derivative (per period) relative to that of q: what varies less is rounding.
const LEAST_SLOPE: f64 = 1e-2;

/// The least rest that is looked for, as a share of the size: below it cells are not made smaller for it.
const NEGLIGIBLE_REST: f64 = 1e-12;

/// The harmonics of q along a curve.
fn harmonics_of(plant: &Plant, orbit: &TrigonometricVector) -> FloatSeries {
    let mut field = Field::new(plant);
    let curve = field.own(&doubles(orbit));
    let sample = |j: usize| {
        let s = j as f64 / POINTS as f64;
        field.set(s, &curve.at(s).0, 0.0);
        vec![field.q()]
    };
    let samples: Vec<Vec<f64>> = (0..POINTS).map(sample).collect();
    FloatSeries::from_samples(&samples, PROPOSED_HARMONICS)
}

/// qb in doubles, rounded: the harmonics that matter, with short coefficients, and how they change with the parameters of which
/// intervals are known, by quotients of differences. `None` where q is not finite.
#[must_use]
pub fn propose_forcing(plant: &Plant, orbit: &OrbitCurve) -> Option<(Wave, Vec<Wave>)> {
    let nominal = plant.parameters.nominal();
    let of_member =
        |values: &[Rational]| harmonics_of(&plant.member(values), &orbit.at(&plant.parameters.deviations(values)));
    let series = of_member(&nominal);
    let pairs: Vec<[f64; 2]> = series.harmonics.iter().map(|[a, b]| [a[0], b[0]]).collect();
    let mean = series.mean[0];
    let amplitude = |[a, b]: [f64; 2]| libm::hypot(a, b);
    let square = |weight: &dyn Fn(usize) -> f64| -> f64 {
        pairs.iter().enumerate().map(|(at, pair)| (weight(at + 1) * amplitude(*pair)).portable_powi(2) / 2.0).sum()
    };
    let size = (mean * mean + square(&|_| 1.0)).sqrt();
    let slope = square(&|k| TAU * k as f64).sqrt().max(LEAST_SLOPE * size);
    if !(size.is_finite() && slope.is_finite()) {
        return None;
    }
    // From the highest harmonic down, those are left out that do not matter together.
    let (mut count, mut left_out, mut left_out_slope) = (pairs.len(), 0.0, 0.0);
    while let Some(pair) = count.checked_sub(1).and_then(|last| pairs.get(last)) {
        left_out += amplitude(*pair);
        left_out_slope += TAU * count as f64 * amplitude(*pair);
        if left_out > WANTED_REST * size || left_out_slope > WANTED_REST * slope {
            break;
        }
        count -= 1;
    }
    let number = (2 * count + 1) as f64;
    let unit = |k: usize| -> f64 {
        let of_slope = if k == 0 { f64::INFINITY } else { WANTED_REST * slope / (TAU * k as f64) };
        (WANTED_REST * size).min(of_slope) / number.sqrt()
    };
    let round = |value: f64, k: usize| match value == 0.0 {
        true => Some(Rational::new()),
        false => to_grain(value, unit(k).max(f64::MIN_POSITIVE)),
    };
    let rounded = |mean: f64, pairs: &[[f64; 2]]| -> Option<Wave> {
        let pairs = pairs.iter().enumerate().map(|(at, [a, b])| Some([round(*a, at + 1)?, round(*b, at + 1)?]));
        Some(Wave { mean: round(mean, 0)?, harmonics: pairs.collect::<Option<_>>()? })
    };
    let sensitivities = plant.parameters.intervals().enumerate().map(|(i, interval)| {
        let at = |end: &Rational| {
            let mut values = nominal.clone();
            values[i] = end.clone();
            of_member(&values)
        };
        let width = Rational::from(&interval.high - &interval.low).to_f64();
        let change = at(&interval.high).slope_from(&at(&interval.low), 1.0);
        let pairs: Vec<[f64; 2]> = change.harmonics.iter().map(|[a, b]| [a[0], b[0]]).collect();
        // Rounded as what is added, and not as the quotient.
        let wave = rounded(change.mean[0], &pairs[..count])?;
        let width = Rational::from_f64(width)?;
        Some(wave.map(|value| Rational::from(value / &width)))
    });
    let sensitivities = sensitivities.collect::<Option<_>>()?;
    Some((rounded(mean, &pairs[..count])?, sensitivities))
}

/// The largest rests of all members that are looked at.
#[must_use]
pub fn sampled_rests(plant: &Plant, orbit: &OrbitCurve, forcing: &ProvedForcing) -> [f64; 2] {
    let members = plant.parameters.looked_at();
    members.iter().fold([0.0; 2], |largest, values| {
        let deviations = plant.parameters.deviations(values);
        let found = rests_of_member(&plant.member(values), &orbit.at(&deviations), &forcing.at(&deviations));
        [0, 1].map(|i| f64::max(largest[i], found[i]))
    })
}

/// The largest rests at sampled times, in doubles, but no less than what is negligible.
fn rests_of_member(plant: &Plant, orbit: &TrigonometricVector, forcing: &Wave) -> [f64; 2] {
    let mut field = Field::new(plant);
    let curve = field.own(&doubles(orbit));
    let vector = |value: &Rational| vec![value.to_f64()];
    let harmonics = forcing.harmonics.iter().map(|pair| pair.each_ref().map(vector)).collect();
    let qb = FloatSeries { mean: vector(&forcing.mean), harmonics };
    let samples = (0..POINTS).map(|j| {
        let s = (j as f64 + 0.5) / POINTS as f64;
        field.set(s, &curve.at(s).0, 0.0);
        (field.q(), qb.at(s).0[0])
    });
    let (mut rest, mut rest_t, mut size, mut last) = (0.0_f64, 0.0_f64, 0.0_f64, None);
    for (q, qb) in samples {
        let difference = q - qb;
        rest = rest.max(difference.abs());
        size = size.max(q.abs());
        // A quotient of differences is close enough for an estimate.
        rest_t = rest_t.max(last.map_or(0.0, |last: f64| (difference - last).abs() * POINTS as f64));
        last = Some(difference);
    }
    let period = field.period;
    let least = NEGLIGIBLE_REST * size;
    [rest.max(least), rest_t.max(least * TAU) / period]
}
