//! Constant P for a list of matrices, in floating point: the roundest P of a given rate, and the one in which e acts least on q
//! through the states, by semidefinite programs.

use crate::lyapunov::decay_entry;
use crate::semidefinite::{margin, propose};
use nalgebra::{DMatrix, DVector};
use sigmastar_matrix::symmetric::{triangle, unit_entry};
use sigmastar_matrix::{AffineMatrix, Symmetric};

/// Shares of the largest rate at which the roundest P is sought.
const SHARES: [f64; 11] = [0.9995, 0.99, 0.97, 0.94, 0.9, 0.85, 0.78, 0.7, 0.6, 0.45, 0.3];

/// Those at which the narrowest P is sought.
const NARROW: [f64; 8] = [0.9995, 0.98, 0.94, 0.88, 0.8, 0.65, 0.5, 0.3];

/// What keeps a narrow P open: its least eigenvalue, and the weight of its trace, where |f_e| and |q_x| are 1.
const LEAST: f64 = 1e-6;
const TRACE: f64 = 1e-6;

/// Where the bounds of the largest rate are that close, it is known.
const ENOUGH: f64 = 0.9999;

/// Bisections for the largest rate.
const BISECTIONS: usize = 14;

/// What all programs may cost together, in entries that their factorisations touch, and what a row costs besides.
const MAX_COST: usize = 60_000_000;
const ROW_OVERHEAD: usize = 1_000;

/// The most matrices that one program holds.
const MAX_MATRICES: usize = 48;

/// How many matrices the programs of an order can be asked for.
pub(super) fn most_matrices(order: usize) -> usize {
    let triangle = order * (order + 1) / 2;
    let row = 3 * triangle * triangle + ROW_OVERHEAD;
    (MAX_COST / (BISECTIONS + SHARES.len() + NARROW.len()) / (row * triangle.max(1))).clamp(4, MAX_MATRICES)
}

/// The P with the smallest ratio of its eigenvalues and `P J + J^T P <= -2 alpha P` for every J, P >= I; `None` where the solver
/// has none.
///
/// Minimise r subject to `I <= P <= r I` and `-(P J + J^T P) - 2 alpha P >= eps I` in units of |J|, with eps = 1e-6 r + the
/// solver's own margin.
fn roundest(matrices: &[DMatrix<f64>], size: f64, alpha: f64) -> Option<DMatrix<f64>> {
    let n = matrices.first()?.nrows();
    let triangle: Vec<(usize, usize)> = triangle(n).collect();
    let last = triangle.len();
    let unknowns = last + 1;
    let unit = |variable: usize, i: usize, j: usize| unit_entry(triangle[variable], i, j);
    let mut constraints = AffineMatrix::between_identities(n, unknowns, unit).to_vec();
    constraints.extend(decays(matrices, &triangle, unknowns, size, alpha, 1.0));
    let mut cost = vec![0.0; unknowns];
    cost[last] = 1.0;
    let point = propose(&cost, &constraints).ok()?;
    let p = symmetric(n, &point.x);
    (rate(matrices, &p)? > 0.0).then_some(p)
}

/// How e acts on the states, and the states on q.
pub(super) struct Channel {
    /// f_e at a few times.
    pub(super) inputs: Vec<DVector<f64>>,
    /// q_x at the same times.
    pub(super) outputs: Vec<DVector<f64>>,
    /// q_e at the same times.
    pub(super) slopes: Vec<f64>,
}

impl Channel {
    /// The largest `|f_e|` times the largest `|q_x|` in coordinates L.
    pub(super) fn product_in(&self, l: &DMatrix<f64>, inverse: &DMatrix<f64>) -> f64 {
        let input = self.inputs.iter().map(|vector| (inverse * vector).norm()).fold(0.0, f64::max);
        let output = self.outputs.iter().map(|vector| (l.transpose() * vector).norm()).fold(0.0, f64::max);
        input * output
    }
}

/// The P of a rate with the least product of `|f_e|` and `|q_x|` in its norm: minimise the largest `f_e^T P f_e` subject to
/// `q_x^T q_x <= P` and `-(P J + J^T P) - 2 alpha P >= 0` for every J. For a linear plant it is what the gain grows with.
fn narrowest(matrices: &[DMatrix<f64>], channel: &Channel, size: f64, alpha: f64) -> Option<DMatrix<f64>> {
    let n = matrices.first()?.nrows();
    let largest = |vectors: &[DVector<f64>]| vectors.iter().map(DVector::norm).fold(0.0, f64::max);
    let (input, output) = (largest(&channel.inputs), largest(&channel.outputs));
    if !(input > 0.0 && output > 0.0) {
        return None;
    }
    let triangle: Vec<(usize, usize)> = triangle(n).collect();
    let last = triangle.len();
    let unknowns = last + 1;
    let identity = |i: usize, j: usize| f64::from(u8::from(i == j));
    // The unit matrix of a variable.
    let unit = |variable: usize, i: usize, j: usize| triangle.get(variable).map_or(0.0, |at| unit_entry(*at, i, j));
    let mut constraints = vec![AffineMatrix::from_fn(n, unknowns, |i, j| -LEAST * identity(i, j), unit)];
    for vector in &channel.outputs {
        let constant = |i: usize, j: usize| -vector[i] * vector[j] / (output * output);
        constraints.push(AffineMatrix::from_fn(n, unknowns, constant, unit));
    }
    for vector in &channel.inputs {
        let form = |variable: usize, _: usize, _: usize| match triangle.get(variable) {
            None => 1.0,
            Some(&(a, b)) => -(if a == b { 1.0 } else { 2.0 }) * vector[a] * vector[b] / (input * input),
        };
        constraints.push(AffineMatrix::from_fn(1, unknowns, |_, _| 0.0, form));
    }
    constraints.extend(decays(matrices, &triangle, unknowns, size, alpha, 0.0));
    let mut cost: Vec<f64> = triangle.iter().map(|(i, j)| if i == j { TRACE } else { 0.0 }).collect();
    cost.push(1.0);
    let p = symmetric(n, &propose(&cost, &constraints).ok()?.x);
    (rate(matrices, &p)? > 0.0).then_some(p)
}

/// `-(P J + J^T P) - 2 alpha P >= margin + 1e-6 r round` for every J, in units of |J|; r is the last variable.
fn decays(
    matrices: &[DMatrix<f64>],
    triangle: &[(usize, usize)],
    unknowns: usize,
    size: f64,
    alpha: f64,
    round: f64,
) -> Vec<AffineMatrix<f64>> {
    let n = matrices.first().map_or(0, DMatrix::nrows);
    let identity = |i: usize, j: usize| f64::from(u8::from(i == j));
    let tolerance = margin(0.0, n);
    let decay = |matrix: &DMatrix<f64>| {
        let term = |variable: usize, i: usize, j: usize| match triangle.get(variable) {
            Some(&at) => decay_entry(|i, j| matrix[(i, j)], alpha, at, (i, j)) / size,
            None => -1e-6 * round * identity(i, j),
        };
        AffineMatrix::from_fn(n, unknowns, |i, j| -tolerance * identity(i, j), term)
    };
    matrices.iter().map(decay).collect()
}

/// The matrix with these entries of its upper triangle.
pub(super) fn symmetric(n: usize, entries: &[f64]) -> DMatrix<f64> {
    let p = Symmetric::from_entries(n, entries);
    DMatrix::from_fn(n, n, |i, j| *p.at(i, j))
}

/// The largest alpha with `P J + J^T P <= -2 alpha P` for every J; `None` if P is not positive definite.
pub(super) fn rate(matrices: &[DMatrix<f64>], p: &DMatrix<f64>) -> Option<f64> {
    let root = p.clone().cholesky()?.l();
    let inverse = root.clone().try_inverse()?;
    let mut least = f64::INFINITY;
    for matrix in matrices {
        // With P = R R^T the coordinates R^T x have the norm of P.
        let own = root.transpose() * matrix * inverse.transpose();
        least = least.min(decay(&own)?);
    }
    Some(least)
}

/// Minus the largest eigenvalue of the symmetric part.
pub(super) fn decay(matrix: &DMatrix<f64>) -> Option<f64> {
    let symmetric = (matrix + matrix.transpose()) * -0.5;
    if !symmetric.iter().all(|entry| entry.is_finite()) {
        return None;
    }
    let values = nalgebra::SymmetricEigen::try_new(symmetric, f64::EPSILON, 10_000)?.eigenvalues;
    values.iter().copied().min_by(f64::total_cmp)
}

/// The largest rate that a constant P was found to have for all matrices; 0 where none has one. `limit` bounds every rate.
pub(super) fn largest_rate(matrices: &[DMatrix<f64>], limit: f64) -> f64 {
    let Some(n) = matrices.first().map(DMatrix::nrows) else { return 0.0 };
    let own = rate(matrices, &DMatrix::identity(n, n)).unwrap_or(0.0).max(0.0);
    if n <= 1 {
        return own;
    }
    let size = size(matrices);
    let (mut low, mut high) = (own.min(limit), limit);
    for _ in 0..BISECTIONS {
        if low >= ENOUGH * high {
            break;
        }
        let middle = (low + high) / 2.0;
        match roundest(matrices, size, middle).and_then(|p| rate(matrices, &p)) {
            Some(reached) => low = reached.max(middle).min(high),
            None => high = middle,
        }
    }
    low
}

/// The size of the matrices, as a unit.
pub(super) fn size(matrices: &[DMatrix<f64>]) -> f64 {
    matrices.iter().map(DMatrix::norm).fold(f64::MIN_POSITIVE, f64::max)
}

/// Constant P from the largest rate for all matrices down to rounder ones; none where there is no rate above 0, or where none
/// was found.
pub(super) fn round_shapes(matrices: &[DMatrix<f64>], largest: f64) -> Vec<DMatrix<f64>> {
    let Some(n) = matrices.first().map(DMatrix::nrows) else { return Vec::new() };
    if n <= 1 {
        return vec![DMatrix::identity(n, n)];
    }
    if largest == 0.0 {
        return Vec::new();
    }
    SHARES.iter().filter_map(|share| roundest(matrices, size(matrices), share * largest)).collect()
}

/// Narrow ones. The identity comes first where it has a rate: in the axes of the modes of a linear plant it has the largest.
pub(super) fn narrow_shapes(matrices: &[DMatrix<f64>], channel: &Channel, largest: f64) -> Vec<DMatrix<f64>> {
    let Some(n) = matrices.first().map(DMatrix::nrows) else { return Vec::new() };
    let identity = DMatrix::identity(n, n);
    let own = rate(matrices, &identity).filter(|rate| *rate > 0.0).map(|_| identity);
    let shares = NARROW.iter().filter(|_| n > 1 && largest > 0.0);
    let narrow = shares.filter_map(|share| narrowest(matrices, channel, size(matrices), share * largest));
    own.into_iter().chain(narrow).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// [[-1, 10], [0, -2]]: P = I has no rate, and the largest rate is 1.
    #[test]
    fn rate_and_roundness_are_traded() {
        let matrices = [DMatrix::from_row_slice(2, 2, &[-1.0, 10.0, 0.0, -2.0])];
        assert!(rate(&matrices, &DMatrix::identity(2, 2)).unwrap() < 0.0);
        let found = round_shapes(&matrices, largest_rate(&matrices, 1.0));
        let rates: Vec<f64> = found.iter().map(|p| rate(&matrices, p).unwrap()).collect();
        assert!(rates[0] > 0.99 && rates.windows(2).all(|pair| pair[0] > pair[1]), "{rates:?}");
        let ratios: Vec<f64> = found
            .iter()
            .map(|p| {
                let values = p.clone().symmetric_eigenvalues();
                values.max() / values.min()
            })
            .collect();
        assert!(ratios.windows(2).all(|pair| pair[0] > pair[1]), "{ratios:?}");
    }
    /// [[-1, 10], [0, -2]] with f_e = (0, 1), q_x = (0, 1): the narrowest P goes with what e and q see, the second state.
    #[test]
    fn the_narrowest_matrix_sees_what_the_channel_sees() {
        let matrices = [DMatrix::from_row_slice(2, 2, &[-1.0, 10.0, 0.0, -2.0])];
        let vector = || DVector::from_vec(vec![0.0, 1.0]);
        let channel = Channel { inputs: vec![vector()], outputs: vec![vector()], slopes: vec![0.0] };
        let product = |p: &DMatrix<f64>| {
            let inverse = p.clone().try_inverse().unwrap();
            (p[(1, 1)] * inverse[(1, 1)]).sqrt()
        };
        let narrow = narrowest(&matrices, &channel, 10.0, 0.9).unwrap();
        let round = roundest(&matrices, 10.0, 0.9).unwrap();
        assert!(product(&narrow) < 1.01 && product(&round) > 1.02, "{} {}", product(&narrow), product(&round));
    }
}
