//! Constant P for a list of matrices, in floating point: the roundest P of a given rate, by a semidefinite program.

use crate::matrix::AffineMatrix;
use crate::semidefinite::{margin, propose};
use nalgebra::DMatrix;

/// Shares of the largest rate at which the roundest P is sought.
const SHARES: [f64; 11] = [0.9995, 0.99, 0.97, 0.94, 0.9, 0.85, 0.78, 0.7, 0.6, 0.45, 0.3];

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
    (MAX_COST / (BISECTIONS + SHARES.len()) / (row * triangle.max(1))).clamp(4, MAX_MATRICES)
}

/// The P with the smallest ratio of its eigenvalues and `P J + J^T P <= -2 alpha P` for every J, P >= I; `None` where the solver
/// has none.
///
/// Minimise r subject to `I <= P <= r I` and `-(P J + J^T P) - 2 alpha P >= eps I` in units of |J|, with eps = 1e-6 r + the
/// solver's own margin.
fn roundest(matrices: &[DMatrix<f64>], size: f64, alpha: f64) -> Option<DMatrix<f64>> {
    let n = matrices.first()?.nrows();
    let triangle: Vec<(usize, usize)> = (0..n).flat_map(|j| (0..=j).map(move |i| (i, j))).collect();
    let last = triangle.len();
    let unknowns = last + 1;
    let identity = |i: usize, j: usize| f64::from(u8::from(i == j));
    let unit = |variable: usize, i: usize, j: usize| {
        let (a, b) = triangle[variable];
        f64::from(u8::from((a, b) == (i, j) || (a, b) == (j, i)))
    };
    let tolerance = margin(0.0, n);
    let mut constraints = vec![
        AffineMatrix::from_fn(
            n,
            unknowns,
            |i, j| -identity(i, j),
            |variable, i, j| if variable == last { 0.0 } else { unit(variable, i, j) },
        ),
        AffineMatrix::from_fn(
            n,
            unknowns,
            |_, _| 0.0,
            |variable, i, j| if variable == last { identity(i, j) } else { -unit(variable, i, j) },
        ),
    ];
    for matrix in matrices {
        let decay = |variable: usize, i: usize, j: usize| {
            if variable == last {
                return -1e-6 * identity(i, j);
            }
            let (a, b) = triangle[variable];
            // (E J)_ij for the unit matrix E of (a, b).
            let half = |i: usize, j: usize| {
                let first = if i == a { matrix[(b, j)] } else { 0.0 };
                first + if i == b && a != b { matrix[(a, j)] } else { 0.0 }
            };
            -(half(i, j) + half(j, i) + 2.0 * alpha * unit(variable, i, j)) / size
        };
        constraints.push(AffineMatrix::from_fn(n, unknowns, |i, j| -tolerance * identity(i, j), decay));
    }
    let mut cost = vec![0.0; unknowns];
    cost[last] = 1.0;
    let point = propose(&cost, &constraints).ok()?;
    let mut p = DMatrix::zeros(n, n);
    for ((i, j), value) in triangle.iter().zip(&point.x) {
        p[(*i, *j)] = *value;
        p[(*j, *i)] = *value;
    }
    (rate(matrices, &p)? > 0.0).then_some(p)
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

/// Constant P from the largest rate for all matrices down to rounder ones; none where no constant P has a rate above 0, or
/// where none was found. `limit` bounds every rate.
pub(super) fn shapes(matrices: &[DMatrix<f64>], limit: f64) -> Vec<DMatrix<f64>> {
    let Some(first) = matrices.first() else { return Vec::new() };
    if first.nrows() <= 1 {
        return vec![DMatrix::identity(first.nrows(), first.nrows())];
    }
    let size = matrices.iter().map(DMatrix::norm).fold(f64::MIN_POSITIVE, f64::max);
    let (mut low, mut high) = (0.0, limit);
    for _ in 0..BISECTIONS {
        let middle = (low + high) / 2.0;
        match roundest(matrices, size, middle).and_then(|p| rate(matrices, &p)) {
            Some(reached) => low = reached.max(middle).min(high),
            None => high = middle,
        }
    }
    if low == 0.0 {
        return Vec::new();
    }
    SHARES.iter().filter_map(|share| roundest(matrices, size, share * low)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// [[-1, 10], [0, -2]]: P = I has no rate, and the largest rate is 1.
    #[test]
    fn rate_and_roundness_are_traded() {
        let matrices = [DMatrix::from_row_slice(2, 2, &[-1.0, 10.0, 0.0, -2.0])];
        assert!(rate(&matrices, &DMatrix::identity(2, 2)).unwrap() < 0.0);
        let found = shapes(&matrices, 1.0);
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
}
