//! Periodic curves and matrices in doubles, for sampling: nothing rests on them.

use super::pointwise::MatrixAt;
use rug::Rational;
use sigmastar_lang::spec::{OrbitCurve, PeriodicMatrix, TrigonometricVector};
use sigmastar_matrix::doubles::roots;
use std::sync::Arc;

/// `mean + sum_k (a_k cos(k w t) + b_k sin(k w t))` in doubles.
#[derive(Clone, Debug)]
pub struct FloatCurve {
    /// The mean.
    pub mean: Vec<f64>,
    /// (a_k, b_k) for k = 1, 2, ...
    pub harmonics: Vec<[Vec<f64>; 2]>,
    /// What is added times `p_i - p_i^0`, for each parameter of which an interval is known.
    pub sensitivities: Vec<FloatCurve>,
}

impl From<&OrbitCurve> for FloatCurve {
    fn from(orbit: &OrbitCurve) -> FloatCurve {
        FloatCurve {
            sensitivities: orbit.sensitivities.iter().map(FloatCurve::from).collect(),
            ..FloatCurve::from(&orbit.centre)
        }
    }
}

impl From<&TrigonometricVector> for FloatCurve {
    fn from(orbit: &TrigonometricVector) -> FloatCurve {
        let doubles = |vector: &Vec<Rational>| vector.iter().map(Rational::to_f64).collect::<Vec<f64>>();
        let harmonics = orbit.harmonics.iter().map(|pair| pair.each_ref().map(doubles)).collect();
        FloatCurve { mean: doubles(&orbit.mean), harmonics, sensitivities: Vec::new() }
    }
}

impl FloatCurve {
    /// The curve of a member, time in periods.
    pub(super) fn at(&self, time: f64, deviations: &[f64]) -> Vec<f64> {
        let of_parts = self.sensitivities.iter().map(|part| part.harmonics.len());
        let last = of_parts.fold(self.harmonics.len(), usize::max);
        let turn = |k: usize| libm::sincos(std::f64::consts::TAU * time * k as f64);
        self.turned(&(1..=last).map(turn).collect::<Vec<_>>(), deviations)
    }

    /// The same from the sines and cosines of the harmonics.
    fn turned(&self, turns: &[(f64, f64)], deviations: &[f64]) -> Vec<f64> {
        let mut x = self.mean.clone();
        for (part, deviation) in self.sensitivities.iter().zip(deviations) {
            x.iter_mut().zip(part.turned(turns, &[])).for_each(|(x, part)| *x += deviation * part);
        }
        for ([a, b], (sin, cos)) in self.harmonics.iter().zip(turns) {
            for ((x, a), b) in x.iter_mut().zip(a).zip(b) {
                *x += a * cos + b * sin;
            }
        }
        x
    }
}

/// P(t).
#[derive(Clone, Debug)]
pub(super) struct FloatMatrix {
    mean: Vec<Vec<f64>>,
    harmonics: Vec<[Vec<Vec<f64>>; 2]>,
    /// What serves at every time, where P is constant.
    pub(super) steady: Option<MatrixAt>,
}

impl FloatMatrix {
    /// From exact numbers.
    pub(super) fn new(matrix: &PeriodicMatrix) -> FloatMatrix {
        let doubles = |rows: &Vec<Vec<Rational>>| -> Vec<Vec<f64>> {
            rows.iter().map(|row| row.iter().map(Rational::to_f64).collect()).collect()
        };
        let unit =
            |(i, row): (usize, &Vec<Rational>)| row.iter().enumerate().all(|(j, entry)| *entry == i32::from(i == j));
        let mean = doubles(&matrix.mean);
        let steady = match matrix.harmonics.is_empty() {
            false => None,
            true if matrix.mean.iter().enumerate().all(unit) => Some(MatrixAt::Identity),
            true => Some(MatrixAt::Constant(Arc::new(roots(&mean).map(|root| root.concat())))),
        };
        let harmonics = matrix.harmonics.iter().map(|pair| pair.each_ref().map(doubles)).collect();
        FloatMatrix { mean, harmonics, steady }
    }

    /// P and dP/dt, time in periods.
    pub(super) fn at(&self, time: f64, period: f64) -> [Vec<Vec<f64>>; 2] {
        let n = self.mean.len();
        let (mut value, mut derivative) = (self.mean.clone(), vec![vec![0.0; n]; n]);
        for ([a, b], k) in self.harmonics.iter().zip(1..) {
            let frequency = std::f64::consts::TAU * f64::from(k);
            let (sin, cos) = libm::sincos(frequency * time);
            for i in 0..n {
                for j in 0..n {
                    value[i][j] += a[i][j] * cos + b[i][j] * sin;
                    derivative[i][j] += (b[i][j] * cos - a[i][j] * sin) * frequency / period;
                }
            }
        }
        [value, derivative]
    }
}
