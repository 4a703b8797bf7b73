//! Rational matrices as enclosures, and Euclidean norms of enclosures.

use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;

/// The matrix in enclosures.
pub(super) fn enclosed(matrix: &[Vec<Rational>], precision: u32) -> Vec<Vec<Enclosure>> {
    matrix.iter().map(|row| row.iter().map(|entry| Enclosure::from_rational(entry, precision)).collect()).collect()
}

/// The Euclidean norm, as an upper bound.
pub(super) fn norm(components: impl Iterator<Item = Enclosure>, precision: u32) -> Enclosure {
    components.fold(Enclosure::zero(precision), |sum, component| sum + component.sqr()).sqrt().ceiling()
}
