//! Definiteness of symmetric matrices, of intervals and of rational numbers.

use crate::interval::Interval;
use rug::Rational;

/// The rows of a matrix.
pub type Matrix = Vec<Vec<Rational>>;

/// `factor A - shift I`.
pub fn shifted(matrix: &Matrix, factor: &Rational, shift: &Rational) -> Matrix {
    let row = |(i, row): (usize, &Vec<Rational>)| {
        let mut row: Vec<Rational> = row.iter().map(|value| Rational::from(value * factor)).collect();
        row[i] -= shift;
        row
    };
    matrix.iter().enumerate().map(row).collect()
}

/// Whether a square matrix is symmetric.
pub fn is_symmetric(rows: &Matrix) -> bool {
    (0..rows.len()).all(|i| (0..i).all(|j| rows[i][j] == rows[j][i]))
}

/// Whether a symmetric rational matrix is positive semidefinite: by its pivots, where a pivot of 0 stands alone.
pub fn is_semidefinite(rows: Matrix) -> bool {
    by_exact_pivots(rows, true)
}

/// Whether a symmetric rational matrix is positive definite: by its pivots.
pub fn is_definite(rows: Matrix) -> bool {
    by_exact_pivots(rows, false)
}

fn by_exact_pivots(mut rows: Matrix, zero_may_stand: bool) -> bool {
    for k in 0..rows.len() {
        let above = rows[k].clone();
        let pivot = &above[k];
        let stands_alone = || zero_may_stand && above[k + 1..].iter().all(|entry| *entry == 0);
        if *pivot < 0 || (*pivot == 0 && !stands_alone()) {
            return false;
        }
        for row in rows[k + 1..].iter_mut().filter(|_| *pivot != 0) {
            let factor = Rational::from(&row[k] / pivot);
            row.iter_mut().zip(&above).for_each(|(entry, other)| *entry -= Rational::from(&factor * other));
        }
    }
    true
}

/// Whether a symmetric matrix is positive definite, by the pivots of LDL'; only the lower triangle is read.
///
/// `Some(true)`: every symmetric matrix with entries in the intervals is. `Some(false)`: none is even
/// semidefinite, since a pivot is negative after positive ones. `None`: not decided.
pub fn positive_definite(rows: Vec<Vec<Interval>>) -> Option<bool> {
    by_pivots(rows, false)
}

/// Whether a symmetric matrix is positive semidefinite, by the pivots of LDL': one that may be 0 is left out where nothing stands beside it.
///
/// `Some(true)`: every symmetric matrix with entries in the intervals is. `Some(false)`: none is. `None`: not decided.
pub fn semidefinite(rows: Vec<Vec<Interval>>) -> Option<bool> {
    by_pivots(rows, true)
}

fn by_pivots(mut rows: Vec<Vec<Interval>>, zero_may_stand: bool) -> Option<bool> {
    for k in 0..rows.len() {
        let pivot = rows[k][k].clone();
        let column: Vec<Interval> = rows[k + 1..].iter().map(|row| row[k].clone()).collect();
        if !pivot.is_positive() {
            if zero_may_stand && pivot.is_nonnegative() && column.iter().all(Interval::is_zero) {
                continue;
            }
            return (-pivot).is_positive().then_some(false);
        }
        for (i, row) in rows[k + 1..].iter_mut().enumerate() {
            let factor = &column[i] / &pivot;
            for (entry, other) in row[k + 1..].iter_mut().zip(&column) {
                *entry = &*entry - &factor * other;
            }
        }
    }
    Some(true)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(rows: &[&[i64]]) -> Vec<Vec<Interval>> {
        rows.iter().map(|row| row.iter().map(|value| Interval::int(*value, 64)).collect()).collect()
    }

    #[test]
    fn a_pivot_of_0_is_semidefinite_alone_and_never_definite() {
        for (matrix, definite, half) in [
            (rows(&[&[2], &[1, 1]]), Some(true), Some(true)),
            (rows(&[&[0], &[0, 1]]), None, Some(true)),
            (rows(&[&[1], &[1, 1]]), None, Some(true)),
            (rows(&[&[0], &[1, 5]]), None, None),
            (rows(&[&[1], &[2, 1]]), Some(false), Some(false)),
            (rows(&[&[-1], &[0, 1]]), Some(false), Some(false)),
        ] {
            assert_eq!(positive_definite(matrix.clone()), definite, "{matrix:?}");
            assert_eq!(semidefinite(matrix.clone()), half, "{matrix:?}");
        }
    }

    #[test]
    fn a_matrix_is_symmetric_entry_by_entry() {
        let with =
            |last: i32| [[1, 2, 3], [2, 5, 6], [3, last, 9]].map(|row| row.map(Rational::from).to_vec()).to_vec();
        assert!(is_symmetric(&with(6)) && !is_symmetric(&with(7)));
    }
}
