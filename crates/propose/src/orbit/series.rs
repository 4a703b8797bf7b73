//! Fourier series of vectors in doubles, with the unit of time one period. They propose; nothing here decides.

use rug::Rational;
use sigmastar_lang::spec::TrigonometricVector;
use std::f64::consts::TAU;

/// `mean + sum_k (cos_k cos(2 pi k s) + sin_k sin(2 pi k s))` with s = t/T.
#[derive(Clone, Debug, PartialEq)]
pub struct FloatSeries {
    /// The mean.
    pub mean: Vec<f64>,
    /// (cos_k, sin_k) for k = 1, 2, ...
    pub harmonics: Vec<[Vec<f64>; 2]>,
}

/// The cosines and sines of whole parts of a turn, each computed once.
pub(super) struct Turn {
    table: Vec<(f64, f64)>,
}

impl Turn {
    /// A turn cut into `parts` (at least 1) parts.
    pub(super) fn new(parts: usize) -> Turn {
        let entry = |j: usize| {
            let (sin, cos) = libm::sincos(TAU * j as f64 / parts as f64);
            (cos, sin)
        };
        Turn { table: (0..parts.max(1)).map(entry).collect() }
    }

    pub(super) fn parts(&self) -> usize {
        self.table.len()
    }

    /// Cosine and sine of `j` parts.
    pub(super) fn at(&self, j: usize) -> (f64, f64) {
        self.table[j % self.table.len()]
    }
}

impl From<&TrigonometricVector> for FloatSeries {
    fn from(curve: &TrigonometricVector) -> FloatSeries {
        let doubles = |vector: &Vec<Rational>| vector.iter().map(Rational::to_f64).collect();
        let harmonics = curve.harmonics.iter().map(|pair| pair.each_ref().map(doubles)).collect();
        FloatSeries { mean: doubles(&curve.mean), harmonics }
    }
}

impl FloatSeries {
    /// The zero series of a dimension.
    pub(super) fn zero(dimension: usize) -> FloatSeries {
        FloatSeries { mean: vec![0.0; dimension], harmonics: Vec::new() }
    }

    /// The series with each component times a factor.
    pub(crate) fn scaled(&self, factor: impl Fn(usize) -> f64) -> FloatSeries {
        let scale = |values: &Vec<f64>| values.iter().enumerate().map(|(i, value)| value * factor(i)).collect();
        let harmonics = self.harmonics.iter().map(|pair| pair.each_ref().map(scale)).collect();
        FloatSeries { mean: scale(&self.mean), harmonics }
    }

    /// The sum of series of one dimension, each with its weight; without any it has no components.
    pub(crate) fn combined(all: &[&FloatSeries], weights: &[f64]) -> FloatSeries {
        let dimension = all.first().map_or(0, |series| series.dimension());
        let count = all.iter().map(|series| series.harmonics.len()).max().unwrap_or(0);
        let sum = |of: &dyn Fn(&FloatSeries, usize) -> f64| {
            (0..dimension)
                .map(|i| all.iter().zip(weights).map(|(series, weight)| of(series, i) * weight).sum())
                .collect()
        };
        let harmonic =
            |k: usize| [0, 1].map(|which| sum(&|series, i| series.harmonics.get(k).map_or(0.0, |pair| pair[which][i])));
        FloatSeries { mean: sum(&|series, i| series.mean[i]), harmonics: (0..count).map(harmonic).collect() }
    }

    /// A series that is constant.
    pub(super) fn constant(mean: &[f64]) -> FloatSeries {
        FloatSeries { mean: mean.to_vec(), harmonics: Vec::new() }
    }

    /// The difference from another series over a number.
    pub(super) fn slope_from(&self, other: &FloatSeries, by: f64) -> FloatSeries {
        let n = self.dimension();
        let part = |own: Option<&Vec<f64>>, other: Option<&Vec<f64>>| -> Vec<f64> {
            let entry =
                |values: Option<&Vec<f64>>, i: usize| values.and_then(|values| values.get(i)).copied().unwrap_or(0.0);
            (0..n).map(|i| (entry(own, i) - entry(other, i)) / by).collect()
        };
        let count = self.harmonics.len().max(other.harmonics.len());
        let pair =
            |series: &FloatSeries, k: usize, which: usize| series.harmonics.get(k).map(|pair| pair[which].clone());
        let harmonics = (0..count)
            .map(|k| [0, 1].map(|which| part(pair(self, k, which).as_ref(), pair(other, k, which).as_ref())))
            .collect();
        FloatSeries { mean: part(Some(&self.mean), Some(&other.mean)), harmonics }
    }

    /// The number of components.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.mean.len()
    }

    /// The first `degree` harmonics of samples that are spread evenly over the period, `2 degree + 1` of them or more.
    pub(crate) fn from_samples(samples: &[Vec<f64>], degree: usize) -> FloatSeries {
        let count = samples.len();
        let dimension = samples.first().map_or(0, Vec::len);
        let turn = Turn::new(count);
        let sum = |wave: &dyn Fn(usize) -> f64, scale: f64| -> Vec<f64> {
            let weights: Vec<f64> = (0..count).map(|j| wave(j) * scale / count as f64).collect();
            let component = |i: usize| samples.iter().zip(&weights).map(|(sample, weight)| sample[i] * weight).sum();
            (0..dimension).map(component).collect()
        };
        let harmonics =
            (1..=degree).map(|k| [sum(&|j| turn.at(k * j).0, 2.0), sum(&|j| turn.at(k * j).1, 2.0)]).collect();
        FloatSeries { mean: sum(&|_| 1.0, 1.0), harmonics }
    }

    /// Value and derivative with respect to s = t/T, from the cosine and sine of each harmonic.
    fn with(&self, wave: impl Fn(usize) -> (f64, f64)) -> (Vec<f64>, Vec<f64>) {
        let (mut value, mut slope) = (self.mean.clone(), vec![0.0; self.dimension()]);
        for (index, [a, b]) in self.harmonics.iter().enumerate() {
            let k = index + 1;
            let (cos, sin) = wave(k);
            let factor = TAU * k as f64;
            for i in 0..value.len() {
                value[i] += a[i] * cos + b[i] * sin;
                slope[i] += factor * (b[i] * cos - a[i] * sin);
            }
        }
        (value, slope)
    }

    /// Value and derivative with respect to s = t/T at s.
    #[must_use]
    pub fn at(&self, s: f64) -> (Vec<f64>, Vec<f64>) {
        self.with(|k| {
            // Reduced, so that a high harmonic keeps its digits.
            let (sin, cos) = libm::sincos(TAU * (k as f64 * s).fract());
            (cos, sin)
        })
    }

    /// Value and derivative with respect to s at `s = j/parts`.
    pub(super) fn at_part(&self, turn: &Turn, j: usize) -> (Vec<f64>, Vec<f64>) {
        self.with(|k| turn.at(k * (j % turn.parts())))
    }

    /// Values at `count` points that are spread evenly.
    #[must_use]
    pub fn samples(&self, count: usize) -> Vec<Vec<f64>> {
        let turn = Turn::new(count);
        (0..count).map(|j| self.at_part(&turn, j).0).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_and_coefficients_belong_together() {
        let series = FloatSeries {
            mean: vec![0.5, -1.0],
            harmonics: vec![[vec![1.0, 0.0], vec![-2.0, 0.25]], [vec![0.0, 3.0], vec![0.125, 0.0]]],
        };
        for count in [5, 8, 11] {
            let again = FloatSeries::from_samples(&series.samples(count), 2);
            let flat = |series: &FloatSeries| -> Vec<f64> {
                series.mean.iter().chain(series.harmonics.iter().flatten().flatten()).copied().collect()
            };
            for (a, b) in flat(&series).iter().zip(flat(&again)) {
                assert!((a - b).abs() < 1e-14, "{count}: {a} {b}");
            }
        }
        let (value, slope) = series.at(0.3);
        let (before, after) = (series.at(0.3 - 1e-6).0, series.at(0.3 + 1e-6).0);
        for i in 0..2 {
            assert!(((after[i] - before[i]) / 2e-6 - slope[i]).abs() < 1e-8 * (1.0 + value[i].abs()) * 100.0);
        }
    }
}
