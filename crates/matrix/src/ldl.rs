//! Exact definiteness by the factorisation L D L' in rational arithmetic.

use rug::Rational;

/// Whether the matrix is symmetric and positive definite, exactly.
///
/// Symmetric elimination without pivoting: the pivots are the diagonal D of `M = L D L'` with L unit lower triangular.
/// If all are positive, `x'M x = sum d_i (L'x)_i^2 > 0` for x != 0. If one is not, say `d_k <= 0` after positive
/// d_1, ..., d_(k-1), then the x with `L_k' x = e_k` on the leading k rows has `x'M x = d_k <= 0`. So the answer is
/// decided both ways: a zero pivot is not definite, and no rounding is involved.
///
/// A matrix that is not square or not symmetric is not positive definite. The empty matrix is. The cost is n^3/6
/// operations on rationals whose length grows linearly with the step: meant for n <= 20.
#[must_use]
pub fn is_positive_definite(matrix: &[Vec<Rational>]) -> bool {
    is_symmetric(matrix, matrix.len()) && all_pivots_positive(matrix.to_vec())
}

/// Whether a matrix by rows is symmetric, and of this order.
#[must_use]
pub fn is_symmetric(rows: &[Vec<Rational>], order: usize) -> bool {
    rows.len() == order
        && rows.iter().all(|row| row.len() == order)
        && (0..order).all(|i| (0..i).all(|j| rows[i][j] == rows[j][i]))
}

/// Whether every pivot of a square matrix, of which the lower triangle is read, is positive.
fn all_pivots_positive(lower: Vec<Vec<Rational>>) -> bool {
    let order = lower.len();
    let pivots = pivots(lower);
    pivots.len() == order && pivots.iter().all(|pivot| *pivot > 0)
}

/// The pivots of elimination in the lower triangle, up to the first that is not positive.
fn pivots(mut lower: Vec<Vec<Rational>>) -> Vec<Rational> {
    let mut pivots = Vec::with_capacity(lower.len());
    for k in 0..lower.len() {
        pivots.push(lower[k][k].clone());
        if lower[k][k] <= 0 {
            break;
        }
        let (done, rest) = lower.split_at_mut(k + 1);
        let pivot = &done[k][k];
        let column: Vec<Rational> = rest.iter().map(|row| row[k].clone()).collect();
        for (i, row) in rest.iter_mut().enumerate().filter(|(i, _)| !column[*i].is_zero()) {
            let factor = Rational::from(&column[i] / pivot);
            for (j, entry) in column.iter().take(i + 1).enumerate() {
                row[k + 1 + j] -= Rational::from(&factor * entry);
            }
        }
    }
    pivots
}

/// The leading principal minors of a symmetric matrix, exactly, up to and including the first that is not positive:
/// by Sylvester the matrix is positive definite if and only if all are there and all are positive.
///
/// The k-th minor is the product of the first k pivots of `M = L D L'`. Only the lower triangle is read; a row that is too
/// short gives no minors at all. Meant for n <= 20, as [`is_positive_definite`].
#[must_use]
pub fn leading_minors(matrix: &[Vec<Rational>]) -> Vec<Rational> {
    if matrix.iter().any(|row| row.len() != matrix.len()) {
        return Vec::new();
    }
    let mut minor = Rational::from(1);
    let times = |pivot| {
        minor *= pivot;
        minor.clone()
    };
    pivots(matrix.to_vec()).into_iter().map(times).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn exact<const N: usize>(entries: [[i32; N]; N]) -> Vec<Vec<Rational>> {
        entries.iter().map(|row| row.iter().map(|entry| Rational::from(*entry)).collect()).collect()
    }

    #[test]
    fn matrices_made_by_hand() {
        assert!(is_positive_definite(&[]));
        assert!(is_positive_definite(&exact([[2, -1, 0], [-1, 2, -1], [0, -1, 2]])));
        for not_definite in [[[1, 1], [1, 1]], [[0, 0], [0, 1]], [[1, 2], [2, 1]], [[-1, 0], [0, -1]], [[0, 1], [1, 0]]]
        {
            assert!(!is_positive_definite(&exact(not_definite)), "{not_definite:?}");
        }
        // The last pivot is the one that is not positive: 2 - 4/3 - 2/3 = 0.
        assert!(!is_positive_definite(&exact([[2, -1, -1], [-1, 2, -1], [-1, -1, 2]])));
    }

    #[test]
    fn what_is_not_a_symmetric_matrix_is_not_definite() {
        assert!(!is_positive_definite(&exact([[2, 1], [0, 2]])));
        assert!(!is_positive_definite(&[vec![Rational::from(1), Rational::new()]]));
        assert!(!is_positive_definite(&[vec![Rational::from(1)], vec![Rational::new()]]));
        assert!(leading_minors(&[vec![Rational::from(1), Rational::new()]]).is_empty());
    }

    /// The Hilbert matrix of order 20: definite, with a condition number of 10^28.
    #[test]
    fn a_margin_far_below_double_precision_is_decided() {
        let mut hilbert: Vec<Vec<Rational>> =
            (1..=20).map(|i| (0..20).map(|j| Rational::from((1, i + j))).collect()).collect();
        assert!(is_positive_definite(&hilbert));
        hilbert[19][19] -= Rational::from((1, 10_u64.pow(18)));
        assert!(!is_positive_definite(&hilbert));
    }

    /// Laplace's expansion along the first row: slow, and nothing like the elimination.
    fn determinant(matrix: &[Vec<i64>]) -> i64 {
        let Some((first, rest)) = matrix.split_first() else { return 1 };
        let minor = |skip: usize| -> Vec<Vec<i64>> {
            rest.iter()
                .map(|row| row.iter().enumerate().filter(|(j, _)| *j != skip).map(|(_, x)| *x).collect())
                .collect()
        };
        let signed = |j: usize| if j.is_multiple_of(2) { first[j] } else { -first[j] };
        (0..first.len()).map(|j| signed(j) * determinant(&minor(j))).sum()
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]

        /// Sylvester: definite if and only if all leading minors are positive.
        #[test]
        fn the_answer_is_sylvesters(order in 1..=5usize, shift in 0..8i64, entries in prop::collection::vec(-3..=3i64, 25)) {
            let entry = |i: usize, j: usize| entries[5 * i.min(j) + i.max(j)] + if i == j { shift } else { 0 };
            let matrix: Vec<Vec<i64>> = (0..order).map(|i| (0..order).map(|j| entry(i, j)).collect()).collect();
            let leading = |n: usize| -> Vec<Vec<i64>> { matrix[..n].iter().map(|row| row[..n].to_vec()).collect() };
            let sylvester = (1..=order).all(|n| determinant(&leading(n)) > 0);
            let rational: Vec<Vec<Rational>> =
                matrix.iter().map(|row| row.iter().map(|x| Rational::from(*x)).collect()).collect();
            prop_assert_eq!(is_positive_definite(&rational), sylvester);
            // The minors are those of Laplace, up to the first that is not positive.
            let laplace: Vec<i64> = (1..=order).map(|n| determinant(&leading(n))).collect();
            let shown = laplace.iter().position(|minor| *minor <= 0).map_or(order, |first| first + 1);
            prop_assert_eq!(leading_minors(&rational), laplace[..shown].to_vec());
        }
    }
}
