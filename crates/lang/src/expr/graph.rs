//! Formulas in doubles as one graph: equal parts once, constants folded. It is what a program is compiled from.

use super::PlantVariable;
use super::float::{binary, unary};
use super::formulas::Operations;
use super::syntax::{Binary, Unary};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use std::collections::HashMap;

/// Precision at which constants are enclosed before they are rounded to doubles.
const CONSTANT_PRECISION: u32 = 64;

/// A node of the graph; larger numbers depend on smaller ones only.
pub(super) type Id = usize;

/// What a node is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Term {
    /// The bits of a double.
    Number(u64),
    Variable(PlantVariable),
    Unary(Unary, Id),
    Binary(Binary, Id, Id),
    /// 1 where the operand is at least 0, 0 where it is negative: the derivative of max(u, 0), from one side at 0.
    Step(Id),
}

/// The value of [`Term::Step`]; an undefined operand makes it undefined.
pub(super) fn step(value: f64) -> f64 {
    if value >= 0.0 {
        1.0
    } else if value < 0.0 {
        0.0
    } else {
        f64::NAN
    }
}

/// Terms in an order in which each follows its operands.
#[derive(Clone, Debug, Default)]
pub(super) struct Graph {
    terms: Vec<Term>,
    known: HashMap<Term, Id>,
}

impl Graph {
    /// The terms.
    pub(super) fn terms(&self) -> &[Term] {
        &self.terms
    }

    fn term(&mut self, term: Term) -> Id {
        let next = self.terms.len();
        let id = *self.known.entry(term).or_insert(next);
        if id == next {
            self.terms.push(term);
        }
        id
    }

    fn constant(&mut self, value: f64) -> Id {
        self.term(Term::Number(value.to_bits()))
    }

    fn value(&self, id: Id) -> Option<f64> {
        match self.terms[id] {
            Term::Number(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    fn apply(&mut self, operation: Unary, a: Id) -> Id {
        match self.value(a) {
            Some(value) => self.constant(unary(operation, value)),
            None => self.term(Term::Unary(operation, a)),
        }
    }

    fn combine(&mut self, operation: Binary, a: Id, b: Id) -> Id {
        match (self.value(a), self.value(b)) {
            (Some(left), Some(right)) => self.constant(binary(operation, left, right)),
            _ => self.term(Term::Binary(operation, a, b)),
        }
    }

    /// The integer power by repeated squaring.
    fn integer_power(&mut self, base: Id, exponent: u32) -> Id {
        let mut result = None;
        let mut square = base;
        let mut rest = exponent;
        while rest > 0 {
            if rest & 1 == 1 {
                result = Some(match result {
                    None => square,
                    Some(product) => self.combine(Binary::Mul, product, square),
                });
            }
            rest >>= 1;
            if rest > 0 {
                square = self.combine(Binary::Mul, square, square);
            }
        }
        result.unwrap_or_else(|| self.constant(1.0))
    }
}

/// The operands of a term.
pub(super) fn operands(term: Term) -> impl Iterator<Item = Id> {
    let (first, second) = match term {
        Term::Number(_) | Term::Variable(_) => (None, None),
        Term::Unary(_, a) | Term::Step(a) => (Some(a), None),
        Term::Binary(_, a, b) => (Some(a), Some(b)),
    };
    first.into_iter().chain(second)
}

impl Operations for Graph {
    type Value = Id;

    fn number(&mut self, value: &Rational) -> Id {
        self.constant(Enclosure::from_rational(value, CONSTANT_PRECISION).midpoint_f64())
    }

    fn pi(&mut self) -> Id {
        self.constant(std::f64::consts::PI)
    }

    fn variable(&mut self, variable: PlantVariable) -> Id {
        self.term(Term::Variable(variable))
    }

    fn unary(&mut self, operation: Unary, a: &Id) -> Id {
        self.apply(operation, *a)
    }

    fn binary(&mut self, operation: Binary, a: &Id, b: &Id) -> Id {
        self.combine(operation, *a, *b)
    }

    fn power(&mut self, base: &Id, exponent: i32) -> Id {
        let power = self.integer_power(*base, exponent.unsigned_abs());
        if exponent >= 0 {
            return power;
        }
        let one = self.constant(1.0);
        self.combine(Binary::Div, one, power)
    }

    fn step(&mut self, a: &Id) -> Id {
        match self.value(*a) {
            Some(value) => self.constant(step(value)),
            None => self.term(Term::Step(*a)),
        }
    }
}
