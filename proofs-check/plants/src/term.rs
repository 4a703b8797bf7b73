//! Formulas written as arithmetic: of `a * (b - c)` a term says what has to be made, and [`Formulas::make`] makes it.

use super::formula::{Formulas, Id};
use proofs_core::expr::Op;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A node, or an operation on terms.
pub enum Term {
    Node(Id),
    Apply(Op, Box<[Term; 2]>),
}

impl Term {
    /// An operation with one operand.
    pub fn of(op: Op, operand: impl Into<Term>) -> Term {
        Term::Apply(op, Box::new([operand.into(), Id::NONE.into()]))
    }
}

impl From<Id> for Term {
    fn from(id: Id) -> Term {
        Term::Node(id)
    }
}

macro_rules! operators {
    ($($of:ident: $($op:ident $method:ident),*;)*) => {$(
        $(impl<T: Into<Term>> $op<T> for $of {
            type Output = Term;

            fn $method(self, other: T) -> Term {
                Term::Apply(Op::$op, Box::new([self.into(), other.into()]))
            }
        })*

        impl Neg for $of {
            type Output = Term;

            fn neg(self) -> Term {
                Term::of(Op::Neg, self)
            }
        }
    )*};
}

operators! {
    Id: Add add, Sub sub, Mul mul, Div div;
    Term: Add add, Sub sub, Mul mul, Div div;
}

impl Formulas {
    /// The node of a term; those of operands come into being first, from the left.
    pub fn make(&mut self, term: impl Into<Term>) -> Id {
        match term.into() {
            Term::Node(id) => id,
            Term::Apply(op, operands) => {
                let operands = operands.map(|operand| self.make(operand));
                self.apply(&op, operands)
            }
        }
    }
}
