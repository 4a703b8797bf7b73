//! Expressions of a plant as one graph: equal parts once, constants folded, exact derivatives.

use super::PlantVariable;
use super::float::{binary, unary};
use super::syntax::{Algebra, Binary, Unary, evaluate};
use super::{PlantExpr, syntax::Node};
use crate::enclosure::Enclosure;
use rug::Rational;
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
    /// 1 where the operand is at least 0, 0 where it is negative: the derivative of max(u, 0).
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

    /// Adds an expression and returns its node.
    pub(super) fn insert(&mut self, expr: &PlantExpr) -> Id {
        let nodes: &[Node<PlantVariable>] = &expr.nodes;
        evaluate(nodes, self)
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

    /// The partial derivatives of some nodes with respect to a variable.
    ///
    /// They are those of the expressions wherever these are differentiable; where min, max or abs have a corner, that
    /// of one side.
    pub(super) fn derivatives(&mut self, outputs: &[Id], variable: PlantVariable) -> Vec<Id> {
        let zero = self.constant(0.0);
        let needed = reachable(&self.terms, outputs);
        let mut derivative = vec![zero; needed.len()];
        for id in (0..needed.len()).filter(|&id| needed[id]) {
            derivative[id] = self.derivative(id, variable, &derivative, zero);
        }
        outputs.iter().map(|&output| derivative[output]).collect()
    }

    fn derivative(&mut self, id: Id, variable: PlantVariable, known: &[Id], zero: Id) -> Id {
        match self.terms[id] {
            Term::Number(_) | Term::Step(_) => zero,
            Term::Variable(this) => self.constant(if this == variable { 1.0 } else { 0.0 }),
            Term::Unary(operation, a) => {
                let da = known[a];
                if da == zero {
                    return zero;
                }
                let factor = self.slope(operation, a, id);
                self.product(factor, da)
            }
            Term::Binary(operation, a, b) => {
                let (da, db) = (known[a], known[b]);
                if da == zero && db == zero {
                    return zero;
                }
                self.binary_derivative(operation, [a, b], [da, db], id)
            }
        }
    }

    /// The derivative of a function of one argument at `a`, where its value is `value`.
    fn slope(&mut self, operation: Unary, a: Id, value: Id) -> Id {
        let one = self.constant(1.0);
        match operation {
            Unary::Neg => self.constant(-1.0),
            Unary::Sqrt => {
                let half = self.constant(0.5);
                self.combine(Binary::Div, half, value)
            }
            Unary::Exp => value,
            Unary::Log => self.combine(Binary::Div, one, a),
            Unary::Sin => self.apply(Unary::Cos, a),
            Unary::Cos => {
                let sine = self.apply(Unary::Sin, a);
                self.apply(Unary::Neg, sine)
            }
            Unary::Tan => {
                let square = self.combine(Binary::Mul, value, value);
                self.combine(Binary::Add, one, square)
            }
            Unary::Atan => {
                let square = self.combine(Binary::Mul, a, a);
                let sum = self.combine(Binary::Add, one, square);
                self.combine(Binary::Div, one, sum)
            }
            Unary::Tanh => {
                let square = self.combine(Binary::Mul, value, value);
                self.combine(Binary::Sub, one, square)
            }
            Unary::Abs => {
                let (step, two) = (self.term(Term::Step(a)), self.constant(2.0));
                let doubled = self.combine(Binary::Mul, two, step);
                self.combine(Binary::Sub, doubled, one)
            }
        }
    }

    fn binary_derivative(&mut self, operation: Binary, [a, b]: [Id; 2], [da, db]: [Id; 2], value: Id) -> Id {
        match operation {
            Binary::Add => self.sum(da, db),
            Binary::Sub => {
                let minus = self.constant(-1.0);
                let negative = self.product(minus, db);
                self.sum(da, negative)
            }
            Binary::Mul => {
                let (left, right) = (self.product(da, b), self.product(a, db));
                self.sum(left, right)
            }
            Binary::Div => {
                // (a/b)' = (a' - (a/b) b')/b
                let minus = self.constant(-1.0);
                let change = self.product(value, db);
                let change = self.product(minus, change);
                let numerator = self.sum(da, change);
                self.combine(Binary::Div, numerator, b)
            }
            Binary::Pow => {
                // (a^b)' = b a^(b-1) a' + a^b log(a) b'
                let (one, logarithm) = (self.constant(1.0), self.apply(Unary::Log, a));
                let less = self.combine(Binary::Sub, b, one);
                let power = self.combine(Binary::Pow, a, less);
                let left = self.product(b, power);
                let left = self.product(left, da);
                let right = self.product(value, logarithm);
                let right = self.product(right, db);
                self.sum(left, right)
            }
            Binary::Min | Binary::Max => {
                let difference = match operation {
                    Binary::Max => self.combine(Binary::Sub, a, b),
                    _ => self.combine(Binary::Sub, b, a),
                };
                let first = self.term(Term::Step(difference));
                let one = self.constant(1.0);
                let second = self.combine(Binary::Sub, one, first);
                let (left, right) = (self.product(first, da), self.product(second, db));
                self.sum(left, right)
            }
        }
    }

    /// The sum, without additions of 0.
    fn sum(&mut self, a: Id, b: Id) -> Id {
        match (self.value(a), self.value(b)) {
            (Some(0.0), _) => b,
            (_, Some(0.0)) => a,
            _ => self.combine(Binary::Add, a, b),
        }
    }

    /// The product, without factors 0 and 1. A derivative that is 0 is 0 whatever it is multiplied with.
    fn product(&mut self, a: Id, b: Id) -> Id {
        match (self.value(a), self.value(b)) {
            (Some(0.0), _) | (_, Some(1.0)) => a,
            (_, Some(0.0)) | (Some(1.0), _) => b,
            (Some(-1.0), None) => self.apply(Unary::Neg, b),
            _ => self.combine(Binary::Mul, a, b),
        }
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

/// Marks everything that a node needs.
fn mark(terms: &[Term], needed: &mut [bool], id: Id) {
    let mut open = vec![id];
    while let Some(id) = open.pop() {
        for operand in operands(terms[id]) {
            if !std::mem::replace(&mut needed[operand], true) {
                open.push(operand);
            }
        }
    }
}

/// Everything that some nodes need, themselves included.
pub(super) fn reachable(terms: &[Term], outputs: &[Id]) -> Vec<bool> {
    let mut needed = vec![false; terms.len()];
    for &output in outputs {
        needed[output] = true;
        mark(terms, &mut needed, output);
    }
    needed
}

impl Algebra<PlantVariable> for Graph {
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

    fn unary(&mut self, operation: Unary, a: Id) -> Id {
        self.apply(operation, a)
    }

    fn binary(&mut self, operation: Binary, a: Id, b: Id) -> Id {
        self.combine(operation, a, b)
    }

    fn power(&mut self, base: Id, exponent: i32) -> Id {
        let power = self.integer_power(base, exponent.unsigned_abs());
        if exponent >= 0 {
            return power;
        }
        let one = self.constant(1.0);
        self.combine(Binary::Div, one, power)
    }
}
