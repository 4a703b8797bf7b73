//! Symmetric matrices that are affine in decision variables: `C + x_1 A_1 + ... + x_k A_k`.

use super::symmetric::Symmetric;
use rug::Rational;

/// `C + x_1 A_1 + ... + x_k A_k` with symmetric matrices of one order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AffineMatrix<T> {
    constant: Symmetric<T>,
    terms: Vec<Symmetric<T>>,
}

impl<T> AffineMatrix<T> {
    /// The matrix with the constant `constant(row, column)` and the coefficients `term(variable, row, column)`, each
    /// asked for row <= column only.
    #[must_use]
    pub fn from_fn(
        order: usize,
        variables: usize,
        constant: impl Fn(usize, usize) -> T,
        term: impl Fn(usize, usize, usize) -> T,
    ) -> AffineMatrix<T> {
        AffineMatrix {
            constant: Symmetric::from_fn(order, constant),
            terms: (0..variables)
                .map(|variable| Symmetric::from_fn(order, |row, column| term(variable, row, column)))
                .collect(),
        }
    }

    /// The number of rows.
    #[must_use]
    pub fn order(&self) -> usize {
        self.constant.order
    }

    /// C.
    #[must_use]
    pub fn constant(&self) -> &Symmetric<T> {
        &self.constant
    }

    /// The A_k, one per variable.
    #[must_use]
    pub fn terms(&self) -> &[Symmetric<T>] {
        &self.terms
    }
}

impl AffineMatrix<Rational> {
    /// Substitutes numbers for the leading variables; the rest stay. Numbers in excess of the variables are ignored.
    #[must_use]
    pub fn substitute(&self, values: &[Rational]) -> AffineMatrix<Rational> {
        let mut constant = self.constant.clone();
        for (value, term) in values.iter().zip(&self.terms) {
            for (entry, coefficient) in constant.entries.iter_mut().zip(&term.entries) {
                *entry += Rational::from(value * coefficient);
            }
        }
        AffineMatrix { constant, terms: self.terms.iter().skip(values.len()).cloned().collect() }
    }

    /// `M(centre + y)` as a matrix affine in y; what `centre` does not name counts as 0.
    #[must_use]
    pub fn about(&self, centre: &[Rational]) -> AffineMatrix<Rational> {
        AffineMatrix { constant: self.substitute(centre).constant, terms: self.terms.clone() }
    }

    /// `D M(x) D` with D = diag(1/roots) and x_k = units_k y_k, as a matrix affine in y, in floating point.
    ///
    /// A congruence with D > 0 does not change definiteness. Rounding errors are of the order of one unit in the last
    /// place of each entry; entries beyond the range of doubles become infinite, which the solver refuses.
    /// Precondition: one root per row and one unit per variable; what is missing counts as NaN and is refused too.
    #[must_use]
    pub fn scaled(&self, roots: &[f64], units: &[f64]) -> AffineMatrix<f64> {
        let root = |index: usize| roots.get(index).copied().unwrap_or(f64::NAN);
        let scale = |matrix: &Symmetric<Rational>, unit: f64| {
            matrix.map(|row, column, value| match value.to_f64() {
                // An exact zero stays one, whatever the scales.
                0.0 => 0.0,
                value => value / root(row) * unit / root(column),
            })
        };
        let units = units.iter().copied().chain(std::iter::repeat(f64::NAN));
        AffineMatrix {
            constant: scale(&self.constant, 1.0),
            terms: self.terms.iter().zip(units).map(|(term, unit)| scale(term, unit)).collect(),
        }
    }
}

impl AffineMatrix<f64> {
    /// `P - I` and `r I - P` for the P with these entries of each variable but the last one, which is r.
    #[must_use]
    pub fn between_identities(
        order: usize,
        variables: usize,
        p: impl Fn(usize, usize, usize) -> f64,
    ) -> [AffineMatrix<f64>; 2] {
        let (last, identity) = (variables - 1, |row: usize, column: usize| f64::from(row == column));
        let above = |variable: usize, row: usize, column: usize| match variable == last {
            true => 0.0,
            false => p(variable, row, column),
        };
        let below = |variable: usize, row: usize, column: usize| match variable == last {
            true => identity(row, column),
            false => -p(variable, row, column),
        };
        [
            AffineMatrix::from_fn(order, variables, |row, column| -identity(row, column), above),
            AffineMatrix::from_fn(order, variables, |_, _| 0.0, below),
        ]
    }

    /// `M(x) - t I` with t as a further, last variable.
    #[must_use]
    pub fn minus_identity(mut self) -> AffineMatrix<f64> {
        self.terms.push(Symmetric::from_fn(self.order(), |row, column| if row == column { -1.0 } else { 0.0 }));
        self
    }

    /// `M(x) - epsilon I`.
    #[must_use]
    pub fn with_margin(mut self, epsilon: f64) -> AffineMatrix<f64> {
        self.constant = self.constant.map(|row, column, value| if row == column { value - epsilon } else { *value });
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rational(value: i32) -> Rational {
        Rational::from(value)
    }

    /// [[1, 2], [2, 5]] + x [[1, 0], [0, 0]] + y [[0, 1], [1, 3]].
    fn two_terms() -> AffineMatrix<Rational> {
        let constant = [[1, 2], [2, 5]];
        let terms = [[[1, 0], [0, 0]], [[0, 1], [1, 3]]];
        AffineMatrix::from_fn(2, 2, |i, j| rational(constant[i][j]), |k, i, j| rational(terms[k][i][j]))
    }

    #[test]
    fn substitution_leaves_the_other_variables() {
        let partly = two_terms().substitute(&[rational(10)]);
        assert_eq!(partly.constant().rows(), [[rational(11), rational(2)], [rational(2), rational(5)]]);
        assert_eq!(partly.terms(), &two_terms().terms()[1..]);
        let fully = two_terms().substitute(&[rational(10), rational(-2)]);
        assert_eq!(fully.constant().rows(), [[rational(11), rational(0)], [rational(0), rational(-1)]]);
        assert!(fully.terms().is_empty());
    }

    #[test]
    fn a_shift_moves_the_constant_only() {
        let shifted = two_terms().about(&[rational(10)]);
        assert_eq!(shifted.constant().rows(), [[rational(11), rational(2)], [rational(2), rational(5)]]);
        assert_eq!(shifted.terms(), two_terms().terms());
    }

    #[test]
    fn scaling_divides_rows_and_columns_and_multiplies_units() {
        let scaled = two_terms().scaled(&[2.0, 4.0], &[8.0, 16.0]);
        assert_eq!(scaled.constant().entries(), [0.25, 0.25, 0.3125]);
        assert_eq!(scaled.terms()[0].entries(), [2.0, 0.0, 0.0]);
        assert_eq!(scaled.terms()[1].entries(), [0.0, 2.0, 3.0]);
        assert!(two_terms().scaled(&[2.0], &[8.0, 16.0]).constant().entries()[1].is_nan());
        assert!(two_terms().scaled(&[2.0, 4.0], &[8.0]).terms()[1].entries()[2].is_nan());
    }

    #[test]
    fn the_margin_and_the_identity_are_taken_from_the_diagonal() {
        let plain = two_terms().scaled(&[1.0, 1.0], &[1.0, 1.0]);
        assert_eq!(plain.clone().with_margin(0.5).constant().entries(), [0.5, 2.0, 4.5]);
        assert_eq!(plain.minus_identity().terms()[2].entries(), [-1.0, 0.0, -1.0]);
    }
}
