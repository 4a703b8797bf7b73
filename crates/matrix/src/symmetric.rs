//! Symmetric matrices, of which one triangle is stored.

use std::f64::consts::SQRT_2;

/// The positions (row, column), row <= column, of the upper triangle, column by column: Clarabel's order, and that of the unknown
/// entries of a symmetric matrix.
///
/// Only this module knows the order: everything else stores and reads entries through its functions.
pub fn triangle(order: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..order).flat_map(|column| (0..=column).map(move |row| (row, column)))
}

/// The entry (row, column) of the symmetric matrix that has 1 at this position of a triangle, and 0 at the others.
#[must_use]
pub fn unit_entry((a, b): (usize, usize), row: usize, column: usize) -> f64 {
    f64::from((a, b) == (row, column) || (a, b) == (column, row))
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

    /// The matrix with these entries, in the order of [`triangle`]; what follows them is not looked at.
    ///
    /// # Panics
    /// Where there are fewer.
    #[must_use]
    pub fn from_entries(order: usize, entries: &[T]) -> Symmetric<T>
    where
        T: Clone,
    {
        Symmetric { order, entries: entries[..order * (order + 1) / 2].to_vec() }
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

    /// All rows in full.
    #[must_use]
    pub fn rows(&self) -> Vec<Vec<T>>
    where
        T: Clone,
    {
        let row = |row: usize| (0..self.order).map(|column| self.at(row, column).clone()).collect();
        (0..self.order).map(row).collect()
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
    use rug::Rational;

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
        assert_eq!(Symmetric::from_entries(2, &[1, 3, 4, 9]).rows(), [[1, 3], [3, 4]]);
    }

    /// A matrix is the sum of its entries times the unit matrices.
    #[test]
    fn unit_matrices_make_up_a_matrix() {
        let all = by_hand();
        let sum = |i: usize, j: usize| {
            triangle(3).zip(all.entries()).map(|(at, value)| value * unit_entry(at, i, j)).sum::<f64>()
        };
        assert_eq!(all.rows(), (0..3).map(|i| (0..3).map(|j| sum(i, j)).collect()).collect::<Vec<Vec<f64>>>());
    }
}
