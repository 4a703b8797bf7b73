//! Symmetric matrices, of which one triangle is stored.

use rug::Rational;
use std::f64::consts::SQRT_2;

/// The positions (row, column), row <= column, of the upper triangle, column by column: Clarabel's order.
///
/// Only this module knows the order: everything else stores and reads entries through its functions.
fn triangle(order: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..order).flat_map(|column| (0..=column).map(move |row| (row, column)))
}

/// A symmetric matrix, stored as its upper triangle.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Symmetric<T> {
    pub(super) order: usize,
    pub(super) entries: Vec<T>,
}

impl<T> Symmetric<T> {
    /// The matrix with these entries; `entry(row, column)` is asked for row <= column only.
    #[must_use]
    pub fn from_fn(order: usize, entry: impl Fn(usize, usize) -> T) -> Symmetric<T> {
        Symmetric { order, entries: triangle(order).map(|(row, column)| entry(row, column)).collect() }
    }

    /// The number of rows.
    #[must_use]
    pub fn order(&self) -> usize {
        self.order
    }

    /// The entry (row, column), whichever triangle it is in.
    ///
    /// # Panics
    /// Outside the matrix, as an index of a slice.
    #[must_use]
    pub fn at(&self, row: usize, column: usize) -> &T {
        let (row, column) = (row.min(column), row.max(column));
        // The position in the order of `triangle`, which goes column by column.
        &self.entries[column * (column + 1) / 2 + row]
    }

    /// The entries of the upper triangle.
    #[must_use]
    pub fn entries(&self) -> &[T] {
        &self.entries
    }

    /// The matrix whose entries are functions of position and entry.
    #[must_use]
    pub fn map<U>(&self, image: impl Fn(usize, usize, &T) -> U) -> Symmetric<U> {
        let entries = triangle(self.order).zip(&self.entries).map(|((row, column), value)| image(row, column, value));
        Symmetric { order: self.order, entries: entries.collect() }
    }
}

impl Symmetric<Rational> {
    /// All rows in full.
    #[must_use]
    pub fn rows(&self) -> Vec<Vec<Rational>> {
        let mut rows = vec![vec![Rational::new(); self.order]; self.order];
        for ((row, column), value) in triangle(self.order).zip(&self.entries) {
            rows[row][column].clone_from(value);
            rows[column][row].clone_from(value);
        }
        rows
    }
}

impl Symmetric<f64> {
    /// The vector of Clarabel's cone of positive semidefinite matrices: the upper triangle, off-diagonal entries
    /// times the root of 2, so that inner products of vectors are those of matrices.
    #[must_use]
    pub fn cone_vector(&self) -> Vec<f64> {
        self.map(|row, column, value| if row == column { *value } else { SQRT_2 * value }).entries
    }

    /// The matrix of a vector of that cone; what is missing counts as NaN.
    #[must_use]
    pub fn from_cone_vector(order: usize, vector: &[f64]) -> Symmetric<f64> {
        let values = vector.iter().copied().chain(std::iter::repeat(f64::NAN));
        let entry = |((row, column), value): ((usize, usize), f64)| if row == column { value } else { value / SQRT_2 };
        Symmetric { order, entries: triangle(order).zip(values).map(entry).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// [[1, 2, 4], [2, 3, 5], [4, 5, 6]]: in Clarabel's order the entries count up.
    fn by_hand() -> Symmetric<f64> {
        let entries = [[1.0, 2.0, 4.0], [2.0, 3.0, 5.0], [4.0, 5.0, 6.0]];
        Symmetric::from_fn(3, |row, column| entries[row][column])
    }

    fn rational(value: i32) -> Rational {
        Rational::from(value)
    }

    #[test]
    fn the_cone_vector_of_a_matrix_made_by_hand() {
        assert_eq!(by_hand().entries(), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        assert_eq!(by_hand().cone_vector(), [1.0, 2.0 * SQRT_2, 3.0, 4.0 * SQRT_2, 5.0 * SQRT_2, 6.0]);
        assert_eq!(Symmetric::from_cone_vector(3, &by_hand().cone_vector()), by_hand());
        assert!(Symmetric::from_cone_vector(2, &[1.0]).entries()[2].is_nan());
        let all = [[1.0, 2.0, 4.0], [2.0, 3.0, 5.0], [4.0, 5.0, 6.0]];
        for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
            assert_eq!(*by_hand().at(i, j), all[i][j]);
        }
    }

    #[test]
    fn rows_are_both_triangles() {
        let rows = Symmetric::from_fn(2, |row, column| rational((1 + row + 2 * column) as i32)).rows();
        assert_eq!(rows, [[rational(1), rational(3)], [rational(3), rational(4)]]);
    }
}
