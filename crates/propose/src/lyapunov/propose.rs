//! Proposals for P(t), in floating point.

use super::float::{FloatFamily, waves};
use crate::semidefinite::{margin, propose};
use faer::Mat;
use sigmastar_matrix::symmetric::{triangle, unit_entry};
use sigmastar_matrix::{AffineMatrix, Symmetric};
use std::f64::consts::TAU;

/// The most unknowns and the most entries of all constraints together for which a semidefinite program is solved.
const MAX_UNKNOWNS: u64 = 120;
const MAX_ROWS: u64 = 6_000;

/// What a row costs besides the factorisation, in the same unit.
const ROW_OVERHEAD: u64 = 1_000;

/// The sizes of the semidefinite program of a degree.
struct Sizes {
    /// Entries of a symmetric matrix of the order.
    triangle: u64,
    unknowns: u64,
    samples: u64,
    /// Entries of all constraints.
    rows: u64,
}

impl Sizes {
    /// `None` where the program is too large to be solved.
    fn new(family: &FloatFamily, degree: usize) -> Option<Sizes> {
        let triangle = (family.order * (family.order + 1) / 2) as u64;
        let unknowns = (2 * degree as u64 + 1) * triangle + 1;
        let together = (degree + family.degree()) as u64;
        let samples = if together == 0 { 1 } else { 8 * together };
        let rows = samples * (family.vertices.len() as u64 + 2) * triangle;
        (unknowns <= MAX_UNKNOWNS && rows <= MAX_ROWS).then_some(Sizes { triangle, unknowns, samples, rows })
    }
}

/// What one semidefinite program of a degree costs, in entries that its factorisation touches: every row of a constraint
/// meets the rows of its own block and all unknowns. `None` where it is too large to be solved.
pub(super) fn program_cost(family: &FloatFamily, degree: usize) -> Option<u64> {
    let Sizes { triangle, unknowns, rows, .. } = Sizes::new(family, degree)?;
    Some(rows * (triangle * triangle + triangle * unknowns + unknowns * unknowns + ROW_OVERHEAD))
}

/// The P(t) of a degree with the smallest ratio p_up/p_low for a given rate, by a semidefinite program: the coefficients of
/// 1, cos, sin, ...; `None` where the solver has none, or the program is too large.
///
/// Minimise r subject to `I <= P <= r I` and `-(P' + P F + F'P) - 2 alpha P >= eps I` at sampled angles and at the vertices, in
/// units of |F|, with eps = 1e-6 r + the solver's own margin: |P| is at most r.
pub(super) fn smallest_ratio(family: &FloatFamily, degree: usize, alpha: f64) -> Option<Vec<Mat<f64>>> {
    let n = family.order;
    let triangle: Vec<(usize, usize)> = triangle(n).collect();
    let slots = 2 * degree + 1;
    let sizes = Sizes::new(family, degree)?;
    let (unknowns, samples) = (sizes.unknowns as usize, sizes.samples as usize);
    let last = unknowns - 1;
    // What is demanded is relative to the size of the equation, so that the unit of time does not matter.
    let size = family.size + family.frequency * degree as f64;
    let tolerance = margin(0.0, n);
    let mut constraints = Vec::new();
    for sample in 0..samples {
        let angle = TAU * sample as f64 / samples as f64;
        let waves = waves(angle, degree);
        let basis = |variable: usize| (triangle[variable % triangle.len()], waves[variable / triangle.len()]);
        let identity = |i: usize, j: usize| f64::from(i == j);
        constraints.extend(AffineMatrix::between_identities(n, unknowns, |variable, i, j| {
            let (at, (wave, _)) = basis(variable);
            wave * unit_entry(at, i, j)
        }));
        let centre = family.centre(angle);
        for vertex in &family.vertices {
            let f = &centre + vertex;
            let decay = |variable: usize, i: usize, j: usize| {
                if variable == last {
                    return -identity(i, j) * (1e-6 + 2.0 * family.ball / size);
                }
                let (at, (wave, slope)) = basis(variable);
                let decay = decay_entry(|i, j| f[(i, j)], alpha, at, (i, j));
                (wave * decay - family.frequency * slope * unit_entry(at, i, j)) / size
            };
            constraints.push(AffineMatrix::from_fn(n, unknowns, |i, j| -tolerance * identity(i, j), decay));
        }
    }
    let mut cost = vec![0.0; unknowns];
    cost[last] = 1.0;
    let candidate = propose(&cost, &constraints).ok()?;
    let matrix = |slot: usize| {
        let matrix = Symmetric::from_entries(n, &candidate.x[slot * triangle.len()..]);
        Mat::from_fn(n, n, |i, j| *matrix.at(i, j))
    };
    Some((0..slots).map(matrix).collect())
}

/// The entry (i, j) of `-(P J + J^T P) - 2 alpha P` for the symmetric P that has 1 at (a, b) alone.
pub fn decay_entry(
    matrix: impl Fn(usize, usize) -> f64,
    alpha: f64,
    (a, b): (usize, usize),
    (i, j): (usize, usize),
) -> f64 {
    // (P J)_ij.
    let half = |i: usize, j: usize| {
        let first = if i == a { matrix(b, j) } else { 0.0 };
        first + if i == b && a != b { matrix(a, j) } else { 0.0 }
    };
    -(half(i, j) + half(j, i) + 2.0 * alpha * unit_entry((a, b), i, j))
}

/// The P(t) of the periodic Lyapunov equation `P' + P F + F'P + 2 alpha P = -I` for the centre, as samples over one period.
///
/// With the transition matrices S of the shifted system, `P_k = S_k' P_{k+1} S_k + W_k` exactly, where W_k is the integral of
/// S'S over the step (here by the trapezoidal rule); over a period that is a Stein equation, solved by doubling.
pub(super) fn lyapunov_samples(family: &FloatFamily, alpha: f64) -> Option<Vec<Mat<f64>>> {
    let n = family.order;
    let (steps, h) = family.steps(alpha);
    let local: Vec<Mat<f64>> = steps
        .iter()
        .map(|step| {
            let square = step.transpose() * step;
            Mat::from_fn(n, n, |i, j| h / 2.0 * (square[(i, j)] + f64::from(u8::from(i == j))))
        })
        .collect();
    let back = |step: &Mat<f64>, p: &Mat<f64>| step.transpose() * p * step;
    let (mut monodromy, mut whole) = (Mat::<f64>::identity(n, n), Mat::<f64>::zeros(n, n));
    for (step, own) in steps.iter().zip(&local).rev() {
        whole = back(step, &whole) + own;
    }
    for step in &steps {
        monodromy = step * &monodromy;
    }
    let mut p = whole;
    // 2^60 periods; a matrix that is not stable overflows and is refused.
    for _ in 0..60 {
        let more = back(&monodromy, &p);
        p = &p + &more;
        monodromy = &monodromy * &monodromy;
        let left = (0..n).flat_map(|j| (0..n).map(move |i| (i, j))).map(|at| monodromy[at].abs()).fold(0.0, f64::max);
        if !left.is_finite() {
            return None;
        }
        if left < 1e-12 {
            break;
        }
    }
    let mut samples = vec![p];
    for (step, own) in steps.iter().zip(&local).rev() {
        let earlier = back(step, &samples[samples.len() - 1]) + own;
        samples.push(earlier);
    }
    // The last one is that of the start again.
    samples.reverse();
    samples.pop();
    let finite = |p: &Mat<f64>| (0..n).all(|j| (0..n).all(|i| p[(i, j)].is_finite()));
    samples.iter().all(finite).then_some(samples)
}

/// The leading Fourier coefficients of samples over one period: of 1, cos, sin, ...
pub(super) fn fourier(samples: &[Mat<f64>], degree: usize) -> Vec<Mat<f64>> {
    let n = samples[0].nrows();
    let count = samples.len();
    (0..2 * degree + 1)
        .map(|slot| {
            let factors = (0..count).map(|s| {
                // Reduced, so that a high harmonic keeps its digits.
                let turn = ((slot.div_ceil(2) * s) % count) as f64 / count as f64;
                let wave = waves(TAU * turn, 1);
                let factor = if slot == 0 { 1.0 } else { 2.0 * wave[1 + (slot + 1) % 2].0 };
                factor / count as f64
            });
            let sum = super::float::combine(n, samples, factors);
            Mat::from_fn(n, n, |i, j| (sum[(i, j)] + sum[(j, i)]) / 2.0)
        })
        .collect()
}
