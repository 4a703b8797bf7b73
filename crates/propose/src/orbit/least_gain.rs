//! Constant P with which the matrix inequality (M) of stability (derivation, 13.7) asks for the least gain along an orbit, in
//! floating point, by semidefinite programs. The initial set has no part in them: for a linear plant it needs none.

use super::shape::{Channel, rate, size, symmetric};
use crate::lyapunov::decay_entry;
use crate::semidefinite::{margin, propose};
use nalgebra::{DMatrix, DVector};
use sigmastar_matrix::AffineMatrix;
use sigmastar_matrix::symmetric::{triangle, unit_entry};

/// Shares of the largest rate that the states keep: the existence of the periodic solution needs more of it than stability.
const SHARES: [f64; 5] = [0.02, 0.3, 0.45, 0.6, 0.75];

/// What keeps P open: its least eigenvalue, and the weight of its trace.
const LEAST: f64 = 1e-6;
const TRACE: f64 = 1e-7;

/// P for each of the shares; none where no constant P has a rate, and none for a plant that e does not reach or that q does not see.
pub(super) fn least_gain_shapes(matrices: &[DMatrix<f64>], channel: &Channel, largest: f64) -> Vec<DMatrix<f64>> {
    if largest <= 0.0 || matrices.first().is_none_or(|matrix| matrix.nrows() < 2) {
        return Vec::new();
    }
    SHARES.iter().filter_map(|share| least_gain(matrices, channel, share * largest)).collect()
}

/// Minimise sigma subject to `[[-(P J + J'P) - 2 alpha P, -P g, -(kp/2) r'], [., 2 sigma, -1 - (kp/2) d], [., ., kp]] >= 0` for every
/// J, each with (g, r, d) of one time in turn; P, kp and sigma are unknown. In units of `|J|` and of `s = |d| + |g| |r|/|J|`.
fn least_gain(matrices: &[DMatrix<f64>], channel: &Channel, alpha: f64) -> Option<DMatrix<f64>> {
    let n = matrices.first()?.nrows();
    let unit = size(matrices);
    let largest = |vectors: &[DVector<f64>]| vectors.iter().map(DVector::norm).fold(0.0, f64::max);
    let (input, output) = (largest(&channel.inputs), largest(&channel.outputs));
    let gain = input * output / unit;
    let gain = gain + channel.slopes.iter().fold(0.0, |most: f64, slope| most.max(slope.abs()));
    if !(input > 0.0 && output > 0.0 && gain.is_finite()) {
        return None;
    }
    // x in a unit in which g and r are of one size; then y in that of 1/e.
    let [by_input, by_output] = {
        let of_x = (input / (unit * output)).sqrt();
        [1.0 / (unit * of_x * gain.sqrt()), of_x / gain.sqrt()]
    };
    let triangle: Vec<(usize, usize)> = triangle(n).collect();
    let (k_p, sigma) = (triangle.len(), triangle.len() + 1);
    let unknowns = triangle.len() + 2;
    let (e, y) = (n, n + 1);
    let tolerance = margin(0.0, n);
    let times = channel.inputs.len();
    let inequality = |at: usize| {
        let matrix = &matrices[at % matrices.len()];
        let (g, r, d) = (&channel.inputs[at % times], &channel.outputs[at % times], channel.slopes[at % times]);
        let constant = |i: usize, j: usize| match (i, j) {
            _ if i == j && i < n => -tolerance,
            _ if (i.min(j), i.max(j)) == (e, y) => -1.0,
            _ => 0.0,
        };
        let term = |variable: usize, i: usize, j: usize| {
            let (i, j) = (i.min(j), i.max(j));
            match (triangle.get(variable), i, j) {
                (Some(&place), ..) if j < n => decay_entry(|i, j| matrix[(i, j)], alpha, place, (i, j)) / unit,
                (Some(&(a, b)), ..) if i < n && j == e => {
                    let moved = if i == a { g[b] } else { 0.0 } + if i == b && a != b { g[a] } else { 0.0 };
                    -moved * by_input
                }
                (None, ..) if variable == k_p && j == y => match i {
                    _ if i < n => -r[i] / 2.0 * by_output,
                    _ if i == e => -d / (2.0 * gain),
                    _ => 1.0,
                },
                (None, ..) if variable == sigma && (i, j) == (e, e) => 2.0,
                _ => 0.0,
            }
        };
        AffineMatrix::from_fn(n + 2, unknowns, constant, term)
    };
    let identity = |i: usize, j: usize| f64::from(u8::from(i == j));
    let own = |variable: usize, i: usize, j: usize| triangle.get(variable).map_or(0.0, |at| unit_entry(*at, i, j));
    let mut constraints = vec![AffineMatrix::from_fn(n, unknowns, |i, j| -LEAST * identity(i, j), own)];
    constraints.extend((0..matrices.len().max(times)).map(inequality));
    let mut cost: Vec<f64> = triangle.iter().map(|(i, j)| TRACE * identity(*i, *j)).collect();
    cost.extend([0.0, 1.0]);
    let p = symmetric(n, &propose(&cost, &constraints).ok()?.x);
    (rate(matrices, &p)? > 0.0).then_some(p)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALPHA: f64 = 0.05;

    /// The least sigma with a multiple of P and some kp on a grid: `b'G^-1 b/2` with G the block of x and y, b the column of e.
    fn least_sigma(matrix: &DMatrix<f64>, channel: &Channel, p: &DMatrix<f64>) -> f64 {
        let n = matrix.nrows();
        let (g, r, d) = (&channel.inputs[0], &channel.outputs[0], channel.slopes[0]);
        let steps = || (-120..=120).map(|step| 10f64.powf(f64::from(step) / 20.0));
        let mut least = f64::INFINITY;
        for (w, k_p) in steps().flat_map(|w| steps().map(move |k_p| (w, k_p))) {
            let p = p * w;
            let mut block = DMatrix::from_diagonal_element(n + 1, n + 1, k_p);
            block.view_mut((0, 0), (n, n)).copy_from(&-(&p * matrix + matrix.transpose() * &p));
            block.view_mut((0, n), (n, 1)).copy_from(&(r * (-k_p / 2.0)));
            block.view_mut((n, 0), (1, n)).copy_from(&(r.transpose() * (-k_p / 2.0)));
            let mut column = DVector::from_element(n + 1, -1.0 - k_p / 2.0 * d);
            column.rows_mut(0, n).copy_from(&-(&p * g));
            let Some(cholesky) = block.cholesky() else { continue };
            least = least.min(column.dot(&cholesky.solve(&column)) / 2.0);
        }
        least
    }

    /// Three plants: the P that is found asks for the least gain of all that are tried, in any units of the states.
    #[test]
    fn no_matrix_nearby_asks_for_less() {
        let triangular = DMatrix::from_row_slice(2, 2, &[-1.0, 10.0, 0.0, -2.0]);
        let light = DMatrix::from_row_slice(2, 2, &[-0.1, 3.0, -3.0, -0.1]);
        for (matrix, inputs, outputs, slope) in [
            (triangular.clone(), DVector::from_vec(vec![0.0, 1.0]), DVector::from_vec(vec![2.0, 1.0]), 0.3),
            (triangular, DVector::from_vec(vec![1e4, 1.0]), DVector::from_vec(vec![1e-4, 1.0]), -0.2),
            (light, DVector::from_vec(vec![1.0, 0.0]), DVector::from_vec(vec![0.5, 1.0]), 0.0),
        ] {
            let channel = Channel { inputs: vec![inputs], outputs: vec![outputs], slopes: vec![slope] };
            let matrices = [matrix];
            let found = least_gain(&matrices, &channel, ALPHA).expect("solved");
            assert!(rate(&matrices, &found).expect("positive") >= ALPHA);
            let own = least_sigma(&matrices[0], &channel, &found);
            for (i, j) in [(0, 0), (0, 1), (1, 1)] {
                for sign in [-1.0, 1.0] {
                    let mut other = found.clone();
                    let step = sign * 0.2 * (found[(i, i)] * found[(j, j)]).sqrt();
                    other[(i, j)] += step;
                    if i != j {
                        other[(j, i)] += step;
                    }
                    // A P of a smaller rate may ask for less.
                    if rate(&matrices, &other).is_some_and(|rate| rate >= ALPHA) {
                        let least = least_sigma(&matrices[0], &channel, &other);
                        assert!(own <= least * (1.0 + 2e-3), "{own} {least}");
                    }
                }
            }
            let identity = least_sigma(&matrices[0], &channel, &DMatrix::identity(2, 2));
            assert!(own <= identity, "{own} {identity}");
        }
    }

    #[test]
    fn without_a_rate_or_a_channel_there_is_none() {
        let matrices = [DMatrix::from_row_slice(2, 2, &[-1.0, 10.0, 0.0, -2.0])];
        let channel = |r: f64| Channel {
            inputs: vec![DVector::from_vec(vec![0.0, 1.0])],
            outputs: vec![DVector::from_vec(vec![r, r])],
            slopes: vec![0.0],
        };
        assert_eq!(least_gain_shapes(&matrices, &channel(1.0), 0.9).len(), SHARES.len());
        assert!(least_gain_shapes(&matrices, &channel(1.0), 0.0).is_empty());
        assert!(least_gain_shapes(&matrices, &channel(0.0), 0.9).is_empty());
    }
}
