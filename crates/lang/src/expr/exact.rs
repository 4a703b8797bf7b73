//! Exact values, where they have the form c sqrt(r) pi^k.

use super::Expr;
use super::monomial::Monomial;
use super::syntax::{Algebra, Argument, Binary, Unary, evaluate};
use rug::Rational;
use std::cmp::Ordering;

/// Exact evaluation; `None` stands for "not known exactly", which includes undefined values.
pub(super) struct Exact {
    pub(super) x: Option<Monomial>,
    pub(super) e: Option<Monomial>,
}

impl Lookup<Argument> for Exact {
    fn lookup(&self, variable: Argument) -> Option<Monomial> {
        match variable {
            Argument::X => self.x.clone(),
            Argument::E => self.e.clone(),
        }
    }
}

/// Exact evaluation that knows no variable, of any kind.
pub(super) struct Constants;

impl<V> Lookup<V> for Constants {
    fn lookup(&self, _variable: V) -> Option<Monomial> {
        None
    }
}

/// The exact values of variables, where they are known.
pub(super) trait Lookup<V> {
    fn lookup(&self, variable: V) -> Option<Monomial>;
}

impl<V, L: Lookup<V>> Algebra<V> for L {
    type Value = Option<Monomial>;

    fn number(&mut self, value: &Rational) -> Option<Monomial> {
        Some(Monomial::rational(value.clone()))
    }

    fn pi(&mut self) -> Option<Monomial> {
        Some(Monomial::pi())
    }

    fn variable(&mut self, variable: V) -> Option<Monomial> {
        self.lookup(variable)
    }

    fn unary(&mut self, operation: Unary, a: Option<Monomial>) -> Option<Monomial> {
        let a = a?;
        match operation {
            Unary::Neg => Some(a.neg()),
            Unary::Sqrt => a.sqrt(),
            Unary::Abs => match sign(&a)? {
                Ordering::Less => Some(a.neg()),
                _ => Some(a),
            },
            Unary::Exp | Unary::Log | Unary::Sin | Unary::Cos | Unary::Tan | Unary::Atan | Unary::Tanh => None,
            Unary::Exprelr(_) | Unary::Sinc(_) => None,
        }
    }

    fn binary(&mut self, operation: Binary, a: Option<Monomial>, b: Option<Monomial>) -> Option<Monomial> {
        let (a, b) = (a?, b?);
        match operation {
            Binary::Add => a.add(&b),
            Binary::Sub => a.add(&b.neg()),
            Binary::Mul => a.mul(&b),
            Binary::Div => a.div(&b),
            Binary::Pow => None,
            Binary::Min => Some(if a.compare(&b)? == Ordering::Less { a } else { b }),
            Binary::Max => Some(if a.compare(&b)? == Ordering::Less { b } else { a }),
        }
    }

    fn power(&mut self, base: Option<Monomial>, exponent: i32) -> Option<Monomial> {
        base?.pow(exponent)
    }
}

/// The sign of an exactly known number.
pub(super) fn sign(value: &Monomial) -> Option<Ordering> {
    value.compare(&Monomial::rational(Rational::new()))
}

impl Expr {
    /// The exact value of a constant expression, where the exact operations of [`Monomial`] reach it: + - * /,
    /// integer powers, sqrt, abs, min and max of comparable numbers, pi.
    ///
    /// `None` for expressions with variables, for undefined ones, and where the value has no such form or the form
    /// grows too large; it says nothing about the value.
    #[must_use]
    pub fn exact(&self) -> Option<Monomial> {
        evaluate(&self.nodes, &mut Constants)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::Variables;

    fn exact(text: &str) -> Option<Monomial> {
        Expr::parse(text, Variables::XAndE).unwrap().exact()
    }

    #[test]
    fn exact_values() {
        for (text, value) in [
            ("3/7", (3, 7)),
            ("-2^2", (-4, 1)),
            ("2^3^2", (512, 1)),
            ("2^-1", (1, 2)),
            ("1.5e-3", (3, 2000)),
            ("sqrt(2)*sqrt(8)", (4, 1)),
            ("pi/(2*pi)", (1, 2)),
            ("abs(-3/2)", (3, 2)),
            ("min(3, 2, 5/2)", (2, 1)),
            ("max(3, 2, 5/2)", (3, 1)),
            ("max(pi, -1)/pi", (1, 1)),
            ("0^0", (1, 1)),
            ("2^(1/2+1/2)", (2, 1)),
            ("sqrt(4)^sqrt(9)", (8, 1)),
        ] {
            assert_eq!(exact(text), Some(Monomial::rational(Rational::from(value))), "{text}");
        }
        assert!(exact("2*pi").unwrap().equals(&exact("pi/(1/2)").unwrap()).is_true());
    }

    #[test]
    fn what_is_not_exact() {
        for text in ["exp(1)", "1/0", "0^-1", "sqrt(-1)", "X", "0*X", "1+pi", "2^(1/2)", "max(pi, 3)", "10^1000^2^0/0"]
        {
            assert_eq!(exact(text), None, "{text}");
        }
    }
}
