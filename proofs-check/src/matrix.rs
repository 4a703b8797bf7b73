//! Definiteness of symmetric matrices of intervals.

use crate::interval::Interval;

/// Whether a symmetric matrix is positive definite, by the pivots of LDL'; only the lower triangle is read.
///
/// `Some(true)`: every symmetric matrix with entries in the intervals is. `Some(false)`: none is even
/// semidefinite, since a pivot is negative after positive ones. `None`: not decided.
pub fn positive_definite(mut rows: Vec<Vec<Interval>>) -> Option<bool> {
    for k in 0..rows.len() {
        let pivot = rows[k][k].clone();
        if !pivot.is_positive() {
            return (-pivot).is_positive().then_some(false);
        }
        let column: Vec<Interval> = rows[k + 1..].iter().map(|row| row[k].clone()).collect();
        for (i, row) in rows[k + 1..].iter_mut().enumerate() {
            let factor = &column[i] / &pivot;
            for (entry, other) in row[k + 1..].iter_mut().zip(&column) {
                *entry = &*entry - &factor * other;
            }
        }
    }
    Some(true)
}
