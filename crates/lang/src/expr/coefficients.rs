//! Expressions that are polynomials with rational coefficients.

use super::Expr;
use super::syntax::{Algebra, Argument, Binary, Unary, evaluate};
use rug::Rational;
use rug::ops::NegAssign;
use std::collections::BTreeMap;

/// The highest total degree.
const MAX_DEGREE: u32 = 8;

/// The largest numerator or denominator of a coefficient, in bits: nested powers would grow without end.
const MAX_BITS: u32 = 4096;

/// The coefficients of X^i E^j that are not 0, by (i, j).
type Polynomial = BTreeMap<(u32, u32), Rational>;

/// Evaluation as a polynomial; `None` where the expression is none, or a large one.
struct Polynomials;

fn constant(value: Rational) -> Polynomial {
    [((0, 0), value)].into_iter().filter(|(_, value)| *value != 0).collect()
}

fn small(polynomial: Polynomial) -> Option<Polynomial> {
    let small = |((i, j), value): (&(u32, u32), &Rational)| {
        i + j <= MAX_DEGREE && value.numer().significant_bits().max(value.denom().significant_bits()) <= MAX_BITS
    };
    polynomial.iter().all(small).then_some(polynomial)
}

fn sum(mut a: Polynomial, b: Polynomial) -> Polynomial {
    for (power, value) in b {
        *a.entry(power).or_default() += value;
    }
    a.retain(|_, value| *value != 0);
    a
}

fn product(a: &Polynomial, b: &Polynomial) -> Polynomial {
    let mut product = Polynomial::new();
    for ((i, j), value) in a {
        for ((k, l), other) in b {
            *product.entry((i + k, j + l)).or_default() += Rational::from(value * other);
        }
    }
    product.retain(|_, value| *value != 0);
    product
}

fn negated(mut a: Polynomial) -> Polynomial {
    a.values_mut().for_each(NegAssign::neg_assign);
    a
}

/// The value of a constant polynomial.
fn value(a: &Polynomial) -> Option<Rational> {
    match a.first_key_value() {
        None => Some(Rational::new()),
        Some(((0, 0), value)) if a.len() == 1 => Some(value.clone()),
        Some(_) => None,
    }
}

impl Algebra for Polynomials {
    type Value = Option<Polynomial>;

    fn number(&mut self, value: &Rational) -> Option<Polynomial> {
        small(constant(value.clone()))
    }

    fn pi(&mut self) -> Option<Polynomial> {
        None
    }

    fn variable(&mut self, variable: Argument) -> Option<Polynomial> {
        let power = match variable {
            Argument::X => (1, 0),
            Argument::E => (0, 1),
        };
        Some([(power, Rational::from(1))].into())
    }

    fn unary(&mut self, operation: Unary, a: Option<Polynomial>) -> Option<Polynomial> {
        if operation == Unary::Neg { a.map(negated) } else { None }
    }

    fn binary(&mut self, operation: Binary, a: Option<Polynomial>, b: Option<Polynomial>) -> Option<Polynomial> {
        let (a, b) = (a?, b?);
        small(match operation {
            Binary::Add => sum(a, b),
            Binary::Sub => sum(a, negated(b)),
            Binary::Mul => product(&a, &b),
            Binary::Div => product(&a, &constant(value(&b).filter(|b| *b != 0)?.recip())),
            Binary::Pow | Binary::Min | Binary::Max => return None,
        })
    }

    fn power(&mut self, base: Option<Polynomial>, exponent: i32) -> Option<Polynomial> {
        let base = base?;
        if !(0..=MAX_DEGREE as i32).contains(&exponent) {
            return None;
        }
        (0..exponent).try_fold(constant(Rational::from(1)), |power, _| small(product(&power, &base)))
    }
}

impl Expr {
    /// Whether the expression is a polynomial in X and E with rational coefficients none of which is negative, decided
    /// exactly; then it is not negative for any X, E >= 0. False says nothing.
    #[must_use]
    pub fn has_no_negative_coefficient(&self) -> bool {
        evaluate(&self.nodes, &mut Polynomials).is_some_and(|all| all.values().all(|value| *value > 0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::Variables;

    #[test]
    fn coefficients_are_exact() {
        for (text, answer) in [
            ("X/3 + E/7 - (X*(1/3) + 1/7*E)", true),
            ("X/3 - 0.333333333*X", true),
            ("X/3 - 0.333333334*X", false),
            ("(20*X + 2000*E) - ((20)*X + E*((2000.0) + (0.0)*X) + (0.0)*X^2/2)", true),
            ("(X + E)^2 - X^2 - 2*X*E", true),
            ("(X - E)^2", false),
            ("X^0 - 1", true),
            ("-(-X)", true),
            // No polynomials, or none that is followed.
            ("X/X", false),
            ("X/0", false),
            ("pi - 3", false),
            ("sqrt(4)", false),
            ("abs(X)", false),
            ("X^-1", false),
            ("X^9", false),
            ("((((2^8)^8)^8)^8)^8", false),
        ] {
            assert_eq!(Expr::parse(text, Variables::XAndE).unwrap().has_no_negative_coefficient(), answer, "{text}");
        }
    }
}
