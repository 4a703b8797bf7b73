//! Rigorous evaluation at one exact point, which can also prove that the expression is undefined there.

use super::Expr;
use super::enclose::{binary, power, unary};
use super::exact::{Exact, sign};
use super::monomial::Monomial;
use super::syntax::{Algebra, Argument, Binary, Node, Unary, evaluate};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use std::cmp::Ordering;
use std::ops::Range;

/// Bits of a rational beyond which exact evaluation is given up: many points are evaluated, and enclosures decide
/// nearly all of them.
const MAX_BITS: u32 = 1 << 13;

/// A value at an exact point: exactly where possible, and enclosed.
pub(super) struct PointValue {
    pub(super) exact: Option<Monomial>,
    pub(super) value: Enclosure,
}

impl PointValue {
    fn is_zero(&self) -> bool {
        self.value.is_exact() && self.value.contains_zero()
    }

    fn is_negative(&self) -> bool {
        self.value.is_nonnegative().is_false()
    }

    fn is_not_positive(&self) -> bool {
        self.value.is_positive().is_false()
    }

    /// The sign, where it is certain.
    pub(super) fn sign(&self) -> Option<Ordering> {
        if self.is_negative() {
            Some(Ordering::Less)
        } else if self.value.is_positive().is_true() {
            Some(Ordering::Greater)
        } else {
            self.exact.as_ref().and_then(sign)
        }
    }
}

/// The value of a transcendental function at the rational argument where it is rational: many bounding functions vanish
/// at the origin by such values.
fn at_special(operation: Unary, argument: &Monomial) -> Option<Monomial> {
    let argument = argument.as_rational()?;
    let value = match operation {
        Unary::Exp | Unary::Cos | Unary::Exprelr(0) | Unary::Sinc(0) if *argument == 0 => 1,
        Unary::Sin | Unary::Tan | Unary::Atan | Unary::Tanh if *argument == 0 => 0,
        Unary::Log if *argument == 1 => 0,
        _ => return None,
    };
    Some(Monomial::rational(Rational::from(value)))
}

struct PointAlgebra {
    exact: Exact,
    precision: u32,
    /// Whether the operation just evaluated is certainly outside its domain.
    outside: bool,
    undefined: Option<Range<usize>>,
}

impl PointAlgebra {
    /// Prefers the exact value, whose enclosure is the tightest there is; it only exists where the operation is
    /// defined.
    fn settle(&self, exact: Option<Monomial>, value: impl FnOnce() -> Enclosure) -> PointValue {
        let bits = |r: &Rational| r.numer().significant_bits().max(r.denom().significant_bits());
        let exact = exact.filter(|exact| exact.as_rational().is_none_or(|rational| bits(rational) <= MAX_BITS));
        let value = exact.as_ref().map_or_else(value, |exact| exact.enclose(self.precision));
        PointValue { exact, value }
    }
}

impl Algebra for PointAlgebra {
    type Value = PointValue;

    fn number(&mut self, value: &Rational) -> PointValue {
        let exact = self.exact.number(value);
        self.settle(exact, || Enclosure::from_rational(value, self.precision))
    }

    fn pi(&mut self) -> PointValue {
        let exact = self.exact.pi();
        self.settle(exact, || Enclosure::pi(self.precision))
    }

    fn variable(&mut self, variable: Argument) -> PointValue {
        let exact = self.exact.variable(variable);
        self.settle(exact, || Enclosure::undefined(self.precision))
    }

    fn unary(&mut self, operation: Unary, a: PointValue) -> PointValue {
        self.outside = match operation {
            Unary::Sqrt => a.is_negative(),
            Unary::Log => a.is_not_positive(),
            _ => false,
        };
        let special = a.exact.as_ref().and_then(|argument| at_special(operation, argument));
        let exact = special.or_else(|| self.exact.unary(operation, a.exact));
        self.settle(exact, || unary(operation, &a.value))
    }

    fn binary(&mut self, operation: Binary, a: PointValue, b: PointValue) -> PointValue {
        self.outside = match operation {
            Binary::Div => b.is_zero(),
            Binary::Pow => a.is_negative() || (a.is_zero() && b.is_not_positive()),
            _ => false,
        };
        let exact = self.exact.binary(operation, a.exact, b.exact);
        self.settle(exact, || binary(operation, &a.value, &b.value))
    }

    fn power(&mut self, base: PointValue, exponent: i32) -> PointValue {
        self.outside = exponent < 0 && base.is_zero();
        let exact = self.exact.power(base.exact, exponent);
        self.settle(exact, || power(&base.value, exponent))
    }

    fn note(&mut self, node: &Node, _value: &PointValue) {
        if std::mem::take(&mut self.outside) && self.undefined.is_none() {
            self.undefined = Some(node.span.clone());
        }
    }
}

impl Expr {
    /// The value at an exact point: exact, up to the precision, where it is a rational number that exact arithmetic finds.
    ///
    /// Guarantee: as for [`Expr::enclose`].
    #[must_use]
    pub fn enclose_at(&self, x: &Rational, e: &Rational, precision: u32) -> Enclosure {
        self.at_point(x, e, precision).0.value
    }

    /// The value at an exact point, and the bytes of the first operation that is certainly undefined there, if any.
    pub(super) fn at_point(&self, x: &Rational, e: &Rational, precision: u32) -> (PointValue, Option<Range<usize>>) {
        let exact = Exact { x: Some(Monomial::rational(x.clone())), e: Some(Monomial::rational(e.clone())) };
        let mut algebra = PointAlgebra { exact, precision, outside: false, undefined: None };
        let value = evaluate(&self.nodes, &mut algebra);
        (value, algebra.undefined)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::Variables;

    fn at(text: &str, x: (i32, i32), e: (i32, i32)) -> (PointValue, Option<&str>) {
        let expr = Expr::parse(text, Variables::XAndE).unwrap();
        let (value, span) = expr.at_point(&Rational::from(x), &Rational::from(e), 128);
        (value, span.map(|span| &text[span]))
    }

    #[test]
    fn certainly_undefined() {
        for (text, blamed) in [
            ("1 + 1/(X - 1/3)", "1/(X - 1/3)"),
            ("0*sqrt(X - 1)", "sqrt(X - 1)"),
            ("log(3*X - 1)", "log(3*X - 1)"),
            ("log(-X)", "log(-X)"),
            ("(3*X - 1)^-1", "(3*X - 1)^-1"),
            ("(X - 1)^(1/2)", "(X - 1)^(1/2)"),
            ("(3*X - 1)^(E - 2)", "(3*X - 1)^(E - 2)"),
            ("1/(sqrt(2)*sqrt(8) - 4)", "1/(sqrt(2)*sqrt(8) - 4)"),
            ("1/sin(0)", "1/sin(0)"),
        ] {
            let (value, span) = at(text, (1, 3), (2, 1));
            assert_eq!((span, value.value.is_defined()), (Some(blamed), false), "{text}");
        }
    }

    #[test]
    fn not_certainly_undefined() {
        // The last ones are undefined, but no enclosure can tell them from their neighbours.
        for text in ["1/X", "sqrt(3*X - 1)", "(3*X - 1)^E", "X^-1", "tan(pi/2)", "log(exp(1) - exp(1))"] {
            assert_eq!(at(text, (1, 3), (2, 1)).1, None, "{text}");
        }
    }

    #[test]
    fn signs_are_exact_where_the_value_is() {
        for (text, sign) in [
            ("X - 1/3", Some(Ordering::Equal)),
            ("X*sqrt(2)*sqrt(2) - 2/3", Some(Ordering::Equal)),
            ("exp(X) - 1", Some(Ordering::Greater)),
            ("sin(X) - 1", Some(Ordering::Less)),
            ("log(exp(X)) - X", None),
            ("X + 0.1*exp(X - 1/3) - 0.1 - cos(0)/3", Some(Ordering::Equal)),
            ("log(3*X) + sin(3*X - 1) + tan(0) + atan(0) + tanh(0)", Some(Ordering::Equal)),
        ] {
            assert_eq!(at(text, (1, 3), (2, 1)).0.sign(), sign, "{text}");
        }
    }
}
