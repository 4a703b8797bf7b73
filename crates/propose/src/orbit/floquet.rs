//! Floquet exponents of the variational equation along a curve, in doubles; they are certified by nothing.
//!
//! Magnus' expansion to fourth order: over a step h with the Jacobians J1, J2 at the two Gauss points,
//! `exp(h (J1 + J2)/2 + sqrt(3) h^2/12 [J2, J1])` (Iserles and Norsett, 1999). An exponential stays bounded where the zero
//! dynamics are stiff.

use super::field::Field;
use super::series::FloatSeries;
use nalgebra::{DMatrix, Schur};

/// Steps over one period: so many at least, and so many for each harmonic of the curve.
const LEAST_STEPS: usize = 512;
const STEPS_PER_HARMONIC: usize = 16;

/// Terms of the exponential series, for a norm of at most 1/4: the rest is below 1e-17.
const TERMS: u32 = 12;

/// Multipliers below this share of the largest are lost in rounding.
const RESOLVED: f64 = 1e-13;

/// The exponential of a square matrix with finite entries.
fn exponential(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let n = matrix.nrows();
    let norm = matrix.row_iter().map(|row| row.iter().map(|entry| entry.abs()).sum::<f64>()).fold(0.0, f64::max);
    let halvings = (libm::frexp(norm).1 + 2).max(0);
    let scaled = matrix * libm::ldexp(1.0, -halvings);
    let mut sum = DMatrix::identity(n, n);
    for k in (1..=TERMS).rev() {
        sum = DMatrix::identity(n, n) + &scaled * sum / f64::from(k);
    }
    for _ in 0..halvings {
        sum = &sum * &sum;
    }
    sum
}

/// The Floquet exponents (real, imaginary) in 1/time along a curve, the largest real part first; the imaginary part up to
/// multiples of 2 pi/T. Exponents whose multipliers are lost in the rounding of the largest are left out. `None` if they
/// could not be computed.
pub(super) fn floquet_exponents(field: &mut Field, curve: &FloatSeries) -> Option<Vec<[f64; 2]>> {
    let n = field.states();
    let steps = LEAST_STEPS.max(STEPS_PER_HARMONIC * curve.harmonics.len());
    let h = 1.0 / steps as f64;
    let offset = 3.0_f64.sqrt() / 6.0;
    let mut product = DMatrix::<f64>::identity(n, n);
    // The product is kept near 1 and its size apart, as a logarithm.
    let mut logarithm = 0.0;
    for step in 0..steps {
        let [first, second] = [0.5 - offset, 0.5 + offset].map(|part| {
            let s = (step as f64 + part) * h;
            field.set(s, &curve.at(s).0, 0.0);
            field.jacobian() * field.period
        });
        // The mean of the diagonal apart, so that the exponential neither overflows nor vanishes.
        let mut mean = (&first + &second) * (h / 2.0);
        let trace = mean.trace() / n as f64;
        (0..n).for_each(|i| mean[(i, i)] -= trace);
        logarithm += trace;
        let commutator = (&second * &first - &first * &second) * (h * h * 3.0_f64.sqrt() / 12.0);
        let generator = mean + commutator;
        if !generator.iter().all(|entry| entry.is_finite()) {
            return None;
        }
        product = exponential(&generator) * product;
        let size = product.amax();
        if !(size.is_finite() && size > 0.0) {
            return None;
        }
        product /= size;
        logarithm += libm::log(size);
    }
    let multipliers = Schur::try_new(product, f64::EPSILON, 1000)?.complex_eigenvalues();
    let largest = multipliers.iter().map(|value| libm::hypot(value.re, value.im)).fold(0.0, f64::max);
    let mut exponents: Vec<[f64; 2]> = multipliers
        .iter()
        .filter(|value| libm::hypot(value.re, value.im) >= RESOLVED * largest)
        .map(|value| {
            let real = libm::log(libm::hypot(value.re, value.im)) + logarithm;
            [real / field.period, libm::atan2(value.im, value.re) / field.period]
        })
        .collect();
    let finite = exponents.iter().flatten().all(|part| part.is_finite());
    exponents.sort_by(|a, b| b[0].total_cmp(&a[0]).then(b[1].total_cmp(&a[1])));
    (finite && !exponents.is_empty()).then_some(exponents)
}

/// The largest real part that is told from 0, times the period: below it is the rounding of the product.
const ROUNDING: f64 = 1e-9;

/// Whether the largest real part of the exponents is negative, as far as doubles can tell.
pub(super) fn is_stable(exponents: &[[f64; 2]], period: f64) -> bool {
    exponents.first().is_some_and(|first| first[0] * period < -ROUNDING)
}

/// A multiplier of several states that add each other up is known to the root of that.
const NEUTRAL: f64 = 1e-4;

/// Whether that is 0, as far as doubles can tell.
pub(super) fn is_neutral(exponents: &[[f64; 2]], period: f64) -> bool {
    exponents.first().is_some_and(|first| (first[0] * period).abs() <= NEUTRAL)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponentials_of_matrices_made_by_hand() {
        let turn = DMatrix::from_row_slice(2, 2, &[0.0, 20.0, -20.0, 0.0]);
        let value = exponential(&turn);
        for (entry, expected) in
            [(value[(0, 0)], 20.0_f64.cos()), (value[(0, 1)], 20.0_f64.sin()), (value[(1, 0)], -20.0_f64.sin())]
        {
            assert!((entry - expected).abs() < 1e-13);
        }
        let stiff = exponential(&DMatrix::from_row_slice(2, 2, &[-3000.0, 1.0, 0.0, -1.0]));
        assert!(stiff[(0, 0)].abs() < 1e-300 && (stiff[(1, 1)] - (-1.0_f64).exp()).abs() < 1e-11);
        assert_eq!(exponential(&DMatrix::zeros(3, 3)), DMatrix::identity(3, 3));
    }
}
