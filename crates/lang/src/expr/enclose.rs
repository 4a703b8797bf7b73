//! Interval evaluation.

use super::Expr;
use super::syntax::{Algebra, Argument, Binary, Node, Unary, evaluate};
use rug::{Integer, Rational};
use sigmastar_exact::enclosure::Enclosure;
use std::ops::Range;

/// The meaning of a function of one argument on enclosures.
pub(super) fn unary(operation: Unary, a: &Enclosure) -> Enclosure {
    match operation {
        Unary::Neg => a.negate(),
        Unary::Sqrt => a.sqrt(),
        Unary::Exp => a.exp(),
        Unary::Log => a.log(),
        Unary::Sin => a.sin(),
        Unary::Cos => a.cos(),
        Unary::Tan => a.tan(),
        Unary::Atan => a.atan(),
        Unary::Tanh => a.tanh(),
        Unary::Abs => a.abs(),
        Unary::Exprelr(order) => a.exprelr(order),
        Unary::Sinc(order) => a.sinc(order),
    }
}

/// The meaning of an operation on two enclosures.
pub(super) fn binary(operation: Binary, a: &Enclosure, b: &Enclosure) -> Enclosure {
    match operation {
        Binary::Add => a + b,
        Binary::Sub => a - b,
        Binary::Mul => a * b,
        Binary::Div => a / b,
        Binary::Pow => a.pow(b),
        Binary::Min => a.min(b),
        Binary::Max => a.max(b),
    }
}

/// The integer power of an enclosure.
pub(super) fn power(base: &Enclosure, exponent: i32) -> Enclosure {
    base.pow_integer(&Integer::from(exponent))
}

/// Natural interval evaluation, remembering the first operation that may be undefined.
struct Natural<'a> {
    x: &'a Enclosure,
    e: &'a Enclosure,
    precision: u32,
    undefined: Option<Range<usize>>,
}

impl Algebra for Natural<'_> {
    type Value = Enclosure;

    fn number(&mut self, value: &Rational) -> Enclosure {
        Enclosure::from_rational(value, self.precision)
    }

    fn pi(&mut self) -> Enclosure {
        Enclosure::pi(self.precision)
    }

    fn variable(&mut self, variable: Argument) -> Enclosure {
        match variable {
            Argument::X => self.x.clone(),
            Argument::E => self.e.clone(),
        }
    }

    fn unary(&mut self, operation: Unary, a: Enclosure) -> Enclosure {
        unary(operation, &a)
    }

    fn binary(&mut self, operation: Binary, a: Enclosure, b: Enclosure) -> Enclosure {
        binary(operation, &a, &b)
    }

    fn power(&mut self, base: Enclosure, exponent: i32) -> Enclosure {
        power(&base, exponent)
    }

    fn note(&mut self, node: &Node, value: &Enclosure) {
        if self.undefined.is_none() && !value.is_defined() {
            self.undefined = Some(node.span.clone());
        }
    }
}

impl Expr {
    /// An interval containing the value at every point of the box `x` times `e`, at the larger of the two precisions.
    ///
    /// Undefined if the expression may be undefined somewhere in the box (or if a variable it uses is undefined); a
    /// defined result proves that the expression is defined on the whole box.
    #[must_use]
    pub fn enclose(&self, x: &Enclosure, e: &Enclosure) -> Enclosure {
        self.enclose_blaming(x, e).0
    }

    /// [`Expr::enclose`], with the bytes of the first operation that may be undefined.
    pub(super) fn enclose_blaming(&self, x: &Enclosure, e: &Enclosure) -> (Enclosure, Option<Range<usize>>) {
        let mut algebra = Natural { x, e, precision: x.precision().max(e.precision()), undefined: None };
        let value = evaluate(&self.nodes, &mut algebra);
        (value, algebra.undefined)
    }

    /// An enclosure of a constant expression; undefined if it is undefined at this precision or has variables.
    #[must_use]
    pub fn enclose_constant(&self, precision: u32) -> Enclosure {
        let none = Enclosure::undefined(precision);
        self.enclose(&none, &none)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::Variables;

    fn parse(text: &str) -> Expr {
        Expr::parse(text, Variables::XAndE).unwrap()
    }

    fn interval(lower: i32, upper: i32) -> Enclosure {
        Enclosure::between(&Rational::from(lower), &Rational::from(upper), 96)
    }

    #[test]
    fn boxes_and_their_images() {
        let (x, e) = (interval(-1, 2), interval(1, 3));
        for (text, lower, upper) in [
            ("X + E", 0, 5),
            ("X*E", -3, 6),
            ("X^2", 0, 4),
            ("X^2^0", -1, 2),
            ("-X^2", -4, 0),
            ("X - X", -3, 3),
            ("E^-1*6", 2, 6),
            ("abs(X)", 0, 2),
            ("min(X, E, 1)", -1, 1),
            ("max(X, E, 0)", 1, 3),
            ("sqrt(E + 1)^2", 2, 4),
        ] {
            let value = parse(text).enclose(&x, &e);
            assert!(value.contains(&Rational::from(lower)) && value.contains(&Rational::from(upper)), "{text}");
            let slack = Rational::from((1, 1 << 30));
            assert!(!value.contains(&(Rational::from(lower) - &slack)), "{text}");
            assert!(!value.contains(&(Rational::from(upper) + &slack)), "{text}");
        }
    }

    #[test]
    fn what_may_be_undefined_is_undefined_and_blamed() {
        let (x, e) = (interval(-1, 2), interval(1, 3));
        for (text, blamed) in [
            ("1 + E/X", "E/X"),
            ("sqrt(X) + 1/X", "sqrt(X)"),
            ("log(X + 1)", "log(X + 1)"),
            ("2*X^-1", "X^-1"),
            ("X^(1/2)", "X^(1/2)"),
            ("0*tan(E)", "tan(E)"),
        ] {
            let expr = parse(text);
            let (value, span) = expr.enclose_blaming(&x, &e);
            assert!(!value.is_defined(), "{text}");
            assert_eq!(&text[span.unwrap()], blamed);
        }
        assert!(parse("E").enclose(&Enclosure::undefined(64), &e).is_defined());
        assert!(!parse("X").enclose_constant(64).is_defined());
        assert!(parse("atan(1)*4 - pi").enclose_constant(128).contains_zero());
    }
}
