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

/// The same for positive semidefinite: a pivot that may be 0 is left out where nothing stands beside it.
///
/// `Some(true)`: every symmetric matrix with entries in the intervals is. `Some(false)`: none is. `None`: not decided.
pub fn semidefinite(mut rows: Vec<Vec<Interval>>) -> Option<bool> {
    for k in 0..rows.len() {
        let pivot = rows[k][k].clone();
        let column: Vec<Interval> = rows[k + 1..].iter().map(|row| row[k].clone()).collect();
        if !pivot.is_positive() {
            if (-&pivot).is_positive() {
                return Some(false);
            }
            if pivot.is_nonnegative() && column.iter().all(Interval::is_zero) {
                continue;
            }
            return None;
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
