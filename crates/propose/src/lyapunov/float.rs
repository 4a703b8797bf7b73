//! The family in floating point: samples, Floquet exponents, and what a P(t) gives. Nothing here decides a claim.

use faer::linalg::solvers::Llt;
use faer::{Mat, Side};
use sigmastar_exact::number::Portable;
use sigmastar_theory::jacobian::{Deviation, Family};
use std::f64::consts::TAU;

/// A family in doubles.
pub(super) struct FloatFamily {
    pub(super) order: usize,
    /// w.
    pub(super) frequency: f64,
    /// The coefficients of 1, cos a, sin a, cos 2a, ...
    centre: Vec<Mat<f64>>,
    /// The deviations at the vertices; one zero matrix where there are none.
    pub(super) vertices: Vec<Mat<f64>>,
    /// The radius of the ball of deviations.
    pub(super) ball: f64,
    /// A bound of |F|, not 0.
    pub(super) size: f64,
}

/// The factors of the coefficients at an angle, and their derivatives: (1, 0), (cos a, -sin a), (sin a, cos a), ...
pub(super) fn waves(angle: f64, degree: usize) -> Vec<(f64, f64)> {
    let pair = |k: usize| {
        let (k, a) = (k as f64, k as f64 * angle);
        let (sin, cos) = libm::sincos(a);
        [(cos, -k * sin), (sin, k * cos)]
    };
    std::iter::once((1.0, 0.0)).chain((1..=degree).flat_map(pair)).collect()
}

/// The sum of matrices with factors.
pub(super) fn combine(order: usize, matrices: &[Mat<f64>], factors: impl Iterator<Item = f64>) -> Mat<f64> {
    let mut sum = Mat::zeros(order, order);
    for (matrix, factor) in matrices.iter().zip(factors) {
        for j in 0..order {
            for i in 0..order {
                sum[(i, j)] += factor * matrix[(i, j)];
            }
        }
    }
    sum
}

/// The Frobenius norm, relative to the largest entry so that no square overflows.
fn norm(matrix: &Mat<f64>) -> f64 {
    let entries = || (0..matrix.ncols()).flat_map(|j| (0..matrix.nrows()).map(move |i| matrix[(i, j)].abs()));
    let largest = entries().fold(0.0, f64::max);
    if largest == 0.0 {
        0.0
    } else {
        largest * entries().map(|entry| (entry / largest).portable_powi(2)).sum::<f64>().sqrt()
    }
}

impl FloatFamily {
    pub(super) fn new(family: &Family) -> FloatFamily {
        let order = family.order();
        let entry = |slot: usize, i: usize, j: usize| {
            let entry = &family.centre[i][j];
            match slot.checked_sub(1) {
                None => entry.mean.midpoint_f64(),
                Some(slot) => entry.harmonics.get(slot / 2).map_or(0.0, |pair| pair[slot % 2].midpoint_f64()),
            }
        };
        let slots = 2 * family.degree() + 1;
        let centre: Vec<Mat<f64>> =
            (0..slots).map(|slot| Mat::from_fn(order, order, |i, j| entry(slot, i, j))).collect();
        let (vertices, ball) = match &family.deviation {
            Deviation::Vertices(vertices) => {
                let dense = |vertex: &Vec<(usize, usize, sigmastar_exact::enclosure::Enclosure)>| {
                    let mut dense = Mat::zeros(order, order);
                    for (i, j, offset) in vertex {
                        dense[(*i, *j)] = offset.midpoint_f64();
                    }
                    dense
                };
                (vertices.iter().map(dense).collect(), 0.0)
            }
            Deviation::Ball(radius) => (vec![Mat::zeros(order, order)], radius.midpoint_f64()),
        };
        let largest = vertices.iter().map(norm).fold(0.0, f64::max);
        let size = centre.iter().map(norm).sum::<f64>() + largest + ball;
        let frequency = family.frequency.midpoint_f64();
        FloatFamily { order, frequency, centre, vertices, ball, size: size.max(f64::MIN_POSITIVE) }
    }

    /// The highest harmonic of the centre.
    pub(super) fn degree(&self) -> usize {
        self.centre.len() / 2
    }

    /// The centre of the family at an angle.
    pub(super) fn centre(&self, angle: f64) -> Mat<f64> {
        let factors = waves(angle, self.degree()).into_iter().map(|wave| wave.0);
        combine(self.order, &self.centre, factors)
    }

    /// The transition matrices of `x' = (F + shift I) x` for the centre over the steps of one period (of the time 1/|F| where F
    /// is constant), by the classical Runge-Kutta rule; and the length of a step.
    pub(super) fn steps(&self, shift: f64) -> (Vec<Mat<f64>>, f64) {
        let duration = if self.degree() == 0 { 1.0 / self.size } else { TAU / self.frequency };
        // |F| h about 1/20: the rule's error is then far below what a proposal needs.
        let count = (20.0 * duration * self.size).ceil().clamp(256.0, 16_384.0) as usize;
        let h = duration / count as f64;
        let n = self.order;
        let identity = Mat::<f64>::identity(n, n);
        let at = |fraction: f64| {
            let mut f = self.centre(fraction * if self.degree() == 0 { 0.0 } else { TAU });
            (0..n).for_each(|i| f[(i, i)] += shift);
            f
        };
        let one = |step: usize| {
            let time = step as f64;
            let [start, middle, end] = [time, time + 0.5, time + 1.0].map(|time| at(time / count as f64));
            let k1 = start;
            let k2 = &middle * (&identity + faer::Scale(h / 2.0) * &k1);
            let k3 = &middle * (&identity + faer::Scale(h / 2.0) * &k2);
            let k4 = &end * (&identity + faer::Scale(h) * &k3);
            &identity + faer::Scale(h / 6.0) * (k1 + faer::Scale(2.0) * k2 + faer::Scale(2.0) * k3 + k4)
        };
        ((0..count).map(one).collect(), h)
    }

    /// The Floquet exponents of the centre, (real, imaginary) parts in 1/time, the largest real part first; the imaginary
    /// part up to multiples of w where F varies. `None` if they could not be computed.
    pub(super) fn floquet_exponents(&self) -> Option<Vec<[f64; 2]>> {
        let eigenvalues = |matrix: &Mat<f64>| -> Option<Vec<[f64; 2]>> {
            let values = matrix.eigenvalues().ok()?;
            Some(values.iter().map(|value| [value.re, value.im]).collect())
        };
        let mut exponents = if self.degree() == 0 {
            eigenvalues(&self.centre(0.0))?
        } else {
            let (steps, h) = self.steps(0.0);
            let duration = h * steps.len() as f64;
            let monodromy = steps.iter().fold(Mat::identity(self.order, self.order), |product, step| step * product);
            let exponent =
                |[re, im]: [f64; 2]| [libm::hypot(re, im).portable_ln() / duration, libm::atan2(im, re) / duration];
            eigenvalues(&monodromy)?.into_iter().map(exponent).collect()
        };
        exponents.sort_by(|a, b| b[0].total_cmp(&a[0]).then(b[1].total_cmp(&a[1])));
        exponents.iter().flatten().all(|value| !value.is_nan()).then_some(exponents)
    }

    /// What P(t) (coefficients of 1, cos, sin, ...) gives at sampled angles: its least and largest eigenvalue, and the rate.
    pub(super) fn assess(&self, p: &[Mat<f64>]) -> Option<Assessment> {
        let n = self.order;
        let degree = p.len() / 2;
        let samples = match degree + self.degree() {
            0 => 1,
            together => 32 * (together + 1),
        };
        let angles: Vec<f64> = (0..samples).map(|s| TAU * s as f64 / samples as f64).collect();
        let mut values = Vec::with_capacity(samples);
        let (mut p_low, mut p_up) = (f64::INFINITY, 0.0_f64);
        for angle in &angles {
            let waves = waves(*angle, degree);
            let value = combine(n, p, waves.iter().map(|wave| wave.0));
            let derivative = combine(n, p, waves.iter().map(|wave| wave.1 * self.frequency));
            let eigenvalues = value.self_adjoint_eigenvalues(Side::Lower).ok()?;
            p_low = p_low.min(*eigenvalues.first()?);
            p_up = p_up.max(*eigenvalues.last()?);
            values.push((value, derivative));
        }
        if !(p_low > 0.0 && p_up.is_finite()) {
            return None;
        }
        let mut alpha = f64::INFINITY;
        for (angle, (value, derivative)) in angles.iter().zip(&values) {
            let factor = Llt::new(value.as_ref(), Side::Lower).ok()?;
            let centre = self.centre(*angle);
            for vertex in &self.vertices {
                let f = &centre + vertex;
                let product = value * &f;
                // -(P' + P F + F'P), in the coordinates in which P is I.
                let mut decay = Mat::from_fn(n, n, |i, j| {
                    let ball = if i == j { 2.0 * p_up * self.ball } else { 0.0 };
                    -(derivative[(i, j)] + product[(i, j)] + product[(j, i)] + ball)
                });
                for _ in 0..2 {
                    faer::linalg::triangular_solve::solve_lower_triangular_in_place(
                        factor.L(),
                        decay.as_mut(),
                        faer::Par::Seq,
                    );
                    decay = decay.transpose().to_owned();
                }
                alpha = alpha.min(*decay.self_adjoint_eigenvalues(Side::Lower).ok()?.first()? / 2.0);
            }
        }
        (alpha > 0.0 && alpha.is_finite()).then_some(Assessment { p_low, p_up, alpha })
    }
}

/// What a P(t) gives, in floating point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Assessment {
    pub(super) p_low: f64,
    pub(super) p_up: f64,
    pub(super) alpha: f64,
}

impl Assessment {
    /// p_up/p_low.
    pub(super) fn ratio(&self) -> f64 {
        self.p_up / self.p_low
    }
}
