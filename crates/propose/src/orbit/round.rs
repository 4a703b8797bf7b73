//! Short rational coefficients for a curve in doubles.

use super::field::Field;
use super::find::FloatOrbit;
use super::series::FloatSeries;
use rug::{Integer, Rational};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{OrbitCurve, TrigonometricVector};
use std::f64::consts::TAU;

/// A defect that is small enough, relative to the size of the terms: no digit is spent on a smaller one.
const WANTED_DEFECT: f64 = 1e-9;

/// The share of the defect that rounding all coefficients may add.
const SHARE: f64 = 0.5;

/// Decimal places beyond which nothing is rounded: doubles end at about 324.
const MAX_PLACES: f64 = 330.0;

/// The value rounded to the largest power of ten that is at most `unit`; `None` unless both are finite and the unit positive.
pub(super) fn to_grain(value: f64, unit: f64) -> Option<Rational> {
    if !(unit > 0.0 && unit.is_finite()) {
        return None;
    }
    let places = (-libm::log10(unit)).ceil().clamp(-MAX_PLACES, MAX_PLACES) as i32;
    let power = Rational::from(Integer::from(Integer::u_pow_u(10, places.unsigned_abs())));
    let scaled = Rational::from_f64(value)?;
    let scaled = if places >= 0 { scaled * &power } else { scaled / &power };
    let whole = scaled.round();
    Some(if places >= 0 { whole / power } else { whole * power })
}

/// Drops the last harmonics that are 0.
pub(super) fn shorten(vector: &mut TrigonometricVector) {
    while vector.harmonics.last().is_some_and(|pair| pair.iter().flatten().all(Rational::is_zero)) {
        vector.harmonics.pop();
    }
}

/// The curve with short rational coefficients: an error in the harmonic k of state j changes the right side i by at most
/// `T |J_ij|` times it, and its own derivative by `2 pi k`; all of them together stay about below half of
/// the defect, or of the defect that is small enough. Harmonics that do not matter at this accuracy are 0, and the last of them left out. `None` where
/// a number is not finite.
#[must_use]
pub fn round_orbit(plant: &Plant, orbit: &FloatOrbit) -> Option<OrbitCurve> {
    let centre = round_part(plant, orbit, &orbit.series, 1.0)?;
    let reaches = plant.parameters.intervals().map(|interval| interval.reach().to_f64());
    let parts = orbit.sensitivities.iter().zip(reaches);
    let sensitivities = parts.map(|(part, reach)| round_part(plant, orbit, part, reach)).collect::<Option<_>>()?;
    Some(OrbitCurve { centre, sensitivities })
}

/// A curve that is added to others `reach` times at most.
fn round_part(plant: &Plant, orbit: &FloatOrbit, part: &FloatSeries, reach: f64) -> Option<TrigonometricVector> {
    let mut field = Field::new(plant);
    let (n, series) = (field.states(), &field.own(&orbit.series));
    let count = 4 * series.harmonics.len() + 16;
    let (mut sizes, mut slopes) = (vec![0.0_f64; n], vec![vec![0.0_f64; n]; n]);
    for j in 0..count {
        let s = j as f64 / count as f64;
        let (x, slope) = series.at(s);
        field.set(s, &x, 0.0);
        let (f, jacobian) = (field.f() * field.period, field.jacobian() * field.period);
        for i in 0..n {
            sizes[i] = sizes[i].max(f[i].abs()).max(slope[i].abs());
            for l in 0..n {
                sizes[i] = sizes[i].max((jacobian[(i, l)] * x[l]).abs());
                slopes[i][l] = slopes[i][l].max(jacobian[(i, l)].abs());
            }
        }
    }
    // The defect is relative to the largest of the sizes.
    let largest = sizes.iter().copied().fold(0.0, f64::max);
    let coefficients = (2 * series.harmonics.len() + 1) as f64 * n as f64;
    let unit = |state: usize, k: usize| -> f64 {
        let allowed = |i: usize| {
            let own = if i == state { TAU * k as f64 } else { 0.0 };
            let effect = slopes[i][state] + own;
            let goal = (WANTED_DEFECT * sizes[i]).max(2.0 * orbit.defect * largest);
            if effect > 0.0 { goal * SHARE / effect / coefficients.sqrt() } else { f64::INFINITY }
        };
        (0..n).map(allowed).fold(f64::INFINITY, f64::min)
    };
    let written = field.units().to_vec();
    let round = |state: usize, k: usize, value: f64| {
        let unit = unit(state, k);
        match value == 0.0 || largest == 0.0 || !unit.is_finite() {
            true => Some(Rational::new()),
            // A state that is 0 up to rounding has no size of its own.
            false => to_grain(value * written[state], (unit / reach * written[state]).max(f64::MIN_POSITIVE)),
        }
    };
    let vector = |k: usize, values: &[f64]| -> Option<Vec<Rational>> {
        values.iter().enumerate().map(|(state, value)| round(state, k, *value)).collect()
    };
    let FloatSeries { mean, harmonics } = &field.own(part);
    let harmonics: Option<Vec<[Vec<Rational>; 2]>> = harmonics
        .iter()
        .enumerate()
        .map(|(index, [a, b])| Some([vector(index + 1, a)?, vector(index + 1, b)?]))
        .collect();
    let mut rounded = TrigonometricVector { mean: vector(0, mean)?, harmonics: harmonics? };
    shorten(&mut rounded);
    Some(rounded)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grains_are_powers_of_ten() {
        for (value, unit, expected) in [
            (0.123_456, 1e-3, (123, 1000)),
            (0.123_456, 2e-3, (123, 1000)),
            (-0.123_456, 0.9e-2, (-123, 1000)),
            (1234.5, 10.0, (1230, 1)),
            (4e-9, 1e-6, (0, 1)),
        ] {
            assert_eq!(to_grain(value, unit), Some(Rational::from(expected)), "{value} {unit}");
        }
        assert_eq!(to_grain(1.0, 0.0), None);
        assert_eq!(to_grain(f64::NAN, 1.0), None);
    }
}
