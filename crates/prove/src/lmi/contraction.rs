//! C3 with weights and as a matrix inequality: the enclosed spectral radius, and the diagonal Stein inequality.

use rug::Rational;
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_matrix::{AffineMatrix, is_positive_definite};
use sigmastar_propose::semidefinite::{SolverFailure, margin, propose};

/// Digits of proposed weights.
const DIGITS: u32 = 12;

/// Bounds of the spectral radius of a nonnegative square matrix from positive weights p (Collatz-Wielandt):
/// `min_i (M p)_i/p_i <= rho(M) <= max_i (M p)_i/p_i`, exactly.
///
/// `None` for the empty matrix, another shape, a negative entry or a weight that is not positive.
#[must_use]
pub fn spectral_radius(matrix: &[Vec<Rational>], weights: &[Rational]) -> Option<[Rational; 2]> {
    let shaped = weights.len() == matrix.len() && matrix.iter().all(|row| row.len() == matrix.len());
    let nonnegative = matrix.iter().flatten().all(|entry| *entry >= 0) && weights.iter().all(|weight| *weight > 0);
    if !(shaped && nonnegative) {
        return None;
    }
    let ratio = |(row, weight): (&Vec<Rational>, &Rational)| {
        let image: Rational = row.iter().zip(weights).map(|(entry, weight)| Rational::from(entry * weight)).sum();
        image / weight
    };
    let ratios: Vec<Rational> = matrix.iter().zip(weights).map(ratio).collect();
    Some([ratios.iter().min()?.clone(), ratios.iter().max()?.clone()])
}

/// Whether `D - M' D M` is positive definite for D = diag(d) with d > 0, exactly; then the spectral radius of M is below 1, for
/// `M' D M < D` makes M a contraction in the norm of D.
#[must_use]
pub fn stein_holds(matrix: &[Vec<Rational>], d: &[Rational]) -> bool {
    let order = matrix.len();
    let shaped = d.len() == order && matrix.iter().all(|row| row.len() == order);
    if !shaped || !d.iter().all(|entry| *entry > 0) {
        return false;
    }
    let entry = |i: usize, j: usize| {
        let sum: Rational = (0..order).map(|k| Rational::from(&matrix[k][i] * &d[k]) * &matrix[k][j]).sum();
        if i == j { &d[i] - sum } else { -sum }
    };
    is_positive_definite(&(0..order).map(|i| (0..order).map(|j| entry(i, j)).collect()).collect::<Vec<_>>())
}

/// d >= 1 with `D - M' D M > 0` and the least sum. A proposal, to be decided by [`stein_holds`].
///
/// # Errors
/// What the solver did instead of solving.
pub fn propose_stein(matrix: &[Vec<Rational>]) -> Result<Vec<Rational>, SolverFailure> {
    let order = matrix.len();
    let at = |i: usize, j: usize| matrix[i][j].to_f64();
    let term = |k: usize, i: usize, j: usize| f64::from(u8::from(i == k && j == k)) - at(k, i) * at(k, j);
    let mut constraints = vec![AffineMatrix::from_fn(order, order, |_, _| 0.0, term).with_margin(margin(1.0, order))];
    constraints.extend(
        (0..order).map(|i| AffineMatrix::from_fn(1, order, |_, _| -1.0, |k, _, _| f64::from(u8::from(i == k)))),
    );
    rationals(&propose(&vec![1.0; order], &constraints)?.x)
}

fn rationals(values: &[f64]) -> Result<Vec<Rational>, SolverFailure> {
    let rounded: Option<Vec<Rational>> = values.iter().map(|x| round_f64(*x, DIGITS, Direction::Nearest)).collect();
    rounded.ok_or(SolverFailure::Unusable)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn exact(rows: &[&[i32]], denominator: i32) -> Vec<Vec<Rational>> {
        rows.iter().map(|row| row.iter().map(|entry| Rational::from((*entry, denominator))).collect()).collect()
    }

    /// Weights p > 0 with M p < p for a nonnegative matrix, by the linear program "minimise sum p subject to p - M p >= 1". A
    /// proposal, to be decided by [`spectral_radius`].
    ///
    /// There are such weights if and only if the spectral radius is below 1.
    fn propose_weights(matrix: &[Vec<Rational>]) -> Result<Vec<Rational>, SolverFailure> {
        let entry = |i: usize, k: usize| f64::from(u8::from(i == k)) - matrix[i][k].to_f64();
        let constraints: Vec<AffineMatrix<f64>> = (0..matrix.len())
            .map(|i| AffineMatrix::from_fn(1, matrix.len(), |_, _| -1.0, |k, _, _| entry(i, k)))
            .collect();
        rationals(&propose(&vec![1.0; matrix.len()], &constraints)?.x)
    }

    #[test]
    fn a_matrix_made_by_hand() {
        // Spectral radius 3/10 + 2/10 = 1/2 with the Perron vector (1, 1).
        let matrix = exact(&[&[3, 2], &[2, 3]], 10);
        let half = Rational::from((1, 2));
        assert_eq!(spectral_radius(&matrix, &[Rational::from(1), Rational::from(1)]), Some([half.clone(), half]));
        let [low, up] = spectral_radius(&matrix, &[Rational::from(1), Rational::from(2)]).unwrap();
        assert_eq!([low, up], [Rational::from((4, 10)), Rational::from((7, 10))]);
        for weights in [&[1, 0][..], &[1, -1], &[1]] {
            let weights: Vec<Rational> = weights.iter().map(|weight| Rational::from(*weight)).collect();
            assert_eq!(spectral_radius(&matrix, &weights), None);
        }
        assert_eq!(spectral_radius(&exact(&[&[-1]], 2), &[Rational::from(1)]), None);
        assert_eq!(spectral_radius(&[], &[]), None);
        let ones = [Rational::from(1), Rational::from(1)];
        assert!(stein_holds(&matrix, &ones));
        assert!(!stein_holds(&exact(&[&[1, 0], &[0, 0]], 1), &ones));
        assert!(!stein_holds(&matrix, &[Rational::from(1), Rational::from(-1)]));
        assert!(!stein_holds(&matrix, &ones[..1]));
        // E5 of the errata: it passes the printed test, and its spectral radius is 2.1.
        let printed = exact(&[&[20, 1], &[1, 20]], 10);
        assert!(propose_weights(&printed).is_err() && propose_stein(&printed).is_err());
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 100, ..ProptestConfig::default() })]

        /// Scaled to a spectral radius on either side of 1: both inequalities find it, and what is proved is true.
        #[test]
        fn both_inequalities_find_the_side_of_1(
            order in 1..=5usize, entries in prop::collection::vec(1..=50i32, 25), inside in any::<bool>(),
        ) {
            let plain: Vec<Vec<Rational>> =
                (0..order).map(|i| (0..order).map(|j| Rational::from(entries[5 * i + j])).collect()).collect();
            // The power method, in floating point, for the scale only.
            let mut p = vec![1.0; order];
            let mut radius = 1.0;
            for _ in 0..200 {
                let image: Vec<f64> =
                    plain.iter().map(|row| row.iter().zip(&p).map(|(a, b)| a.to_f64() * b).sum()).collect();
                radius = image.iter().sum::<f64>();
                p = image.iter().map(|x| x / radius).collect();
            }
            let scale = Rational::from_f64(if inside { 0.97 } else { 1.03 } / radius).unwrap();
            let matrix: Vec<Vec<Rational>> =
                plain.iter().map(|row| row.iter().map(|entry| Rational::from(entry * &scale)).collect()).collect();
            let weights = propose_weights(&matrix);
            let proved = weights.is_ok_and(|p| spectral_radius(&matrix, &p).is_some_and(|[_, up]| up < 1));
            prop_assert_eq!(proved, inside);
            let proved = propose_stein(&matrix).is_ok_and(|d| stein_holds(&matrix, &d));
            prop_assert_eq!(proved, inside);
        }
    }
}
