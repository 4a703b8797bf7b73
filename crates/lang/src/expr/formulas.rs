//! Formulas of a plant as one graph: equal parts once, constants exact, exact derivatives.
//!
//! Nothing in it is rounded: numbers are rational, and pi, sqrt(3) and the like stay what they are until an algebra
//! ([`Operations`]) gives them a meaning. Doubles, enclosures, jets and Taylor series are such algebras, and the
//! derivative rules are written for all of them here, once.

use super::PlantExpr;
use super::PlantVariable;
use super::syntax::{Algebra, Binary, Node, NodeKind, Unary, evaluate};
use rug::Rational;
use std::collections::HashMap;
use std::ops::Range;

/// Bits of a rational beyond which constants are not folded any more; they then stand as operations.
const MAX_FOLDED_BITS: u32 = 4096;

/// The most roots, and the largest power of a root, in the place of a power.
const MAX_ROOTS: u32 = 4;
const MAX_OF_ROOT: u32 = 64;

/// The number of a formula; larger numbers depend on smaller ones only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Formula(pub(super) usize);

/// What a formula is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Term {
    /// An index into the exact numbers.
    Number(usize),
    Pi,
    Variable(PlantVariable),
    Unary(Unary, Formula),
    Binary(Binary, Formula, Formula),
    /// The power with a constant integer exponent.
    Power(Formula, i32),
    /// The derivative of max(u, 0).
    Step(Formula),
}

/// A meaning of the operations.
pub trait Operations {
    /// A value of the algebra.
    type Value: Clone;
    /// An exact number.
    fn number(&mut self, value: &Rational) -> Self::Value;
    /// The constant pi.
    fn pi(&mut self) -> Self::Value;
    /// A variable.
    fn variable(&mut self, variable: PlantVariable) -> Self::Value;
    /// A function of one argument.
    fn unary(&mut self, operation: Unary, a: &Self::Value) -> Self::Value;
    /// An operation on two values.
    fn binary(&mut self, operation: Binary, a: &Self::Value, b: &Self::Value) -> Self::Value;
    /// The power with a constant integer exponent; `u^0 = 1`, and a negative power of 0 is undefined.
    fn power(&mut self, base: &Self::Value, exponent: i32) -> Self::Value;
    /// 1 where `a > 0`, 0 where `a < 0`: the derivative of max(u, 0), which does not exist at 0. A rigorous algebra answers
    /// "undefined" where `a` may be 0.
    fn step(&mut self, a: &Self::Value) -> Self::Value;
}

/// What an operation of a right side needs of its operands to be smooth (derivation, 11.1).
#[derive(Clone, Debug)]
pub struct Demand {
    /// The bytes of the operation in the text of its expression.
    pub span: Range<usize>,
    /// What is demanded, in words.
    pub what: &'static str,
    /// The dividend of a quotient: where it vanishes with the divisor, the quotient is 0/0.
    pub dividend: Option<Formula>,
    /// The formula of which it is demanded ...
    pub of: Formula,
    /// ... to be positive, or else not to vanish.
    pub positive: bool,
}

/// Formulas over exact constants, each after its operands.
#[derive(Clone, Debug, Default)]
pub struct Formulas {
    terms: Vec<Term>,
    known: HashMap<Term, Formula>,
    numbers: Vec<Rational>,
    places: HashMap<Rational, usize>,
}

impl Formulas {
    /// No formulas.
    #[must_use]
    pub fn new() -> Formulas {
        Formulas::default()
    }

    pub(super) fn terms(&self) -> &[Term] {
        &self.terms
    }

    pub(super) fn numbers(&self) -> &[Rational] {
        &self.numbers
    }

    /// Adds an expression.
    pub fn insert(&mut self, expr: &PlantExpr) -> Formula {
        evaluate(&expr.nodes, &mut Insertion { formulas: self, demands: &mut Vec::new(), operands: Vec::new() })
    }

    /// Adds an expression, and says what its operations need to be smooth, in the order of evaluation.
    ///
    /// Guarantee: where all demands hold, the expression is defined and infinitely often differentiable.
    pub fn insert_with_demands(&mut self, expr: &PlantExpr) -> (Formula, Vec<Demand>) {
        let mut demands = Vec::new();
        let formula =
            evaluate(&expr.nodes, &mut Insertion { formulas: self, demands: &mut demands, operands: Vec::new() });
        (formula, demands)
    }

    /// An exact number.
    pub fn number(&mut self, value: Rational) -> Formula {
        let next = self.numbers.len();
        let index = *self.places.entry(value).or_insert_with_key(|value| {
            self.numbers.push(value.clone());
            next
        });
        self.term(Term::Number(index))
    }

    /// A variable.
    pub fn variable(&mut self, variable: PlantVariable) -> Formula {
        self.term(Term::Variable(variable))
    }

    fn integer(&mut self, value: i32) -> Formula {
        self.number(Rational::from(value))
    }

    /// The rational number that a formula is, where it is written as one.
    #[must_use]
    pub fn value(&self, formula: Formula) -> Option<&Rational> {
        match self.terms[formula.0] {
            Term::Number(index) => Some(&self.numbers[index]),
            _ => None,
        }
    }

    /// Whether the formula is the number 0.
    #[must_use]
    pub fn is_zero(&self, formula: Formula) -> bool {
        self.value(formula).is_some_and(Rational::is_zero)
    }

    fn term(&mut self, term: Term) -> Formula {
        let next = Formula(self.terms.len());
        let formula = *self.known.entry(term).or_insert(next);
        if formula == next {
            self.terms.push(term);
        }
        formula
    }

    fn apply(&mut self, operation: Unary, a: Formula) -> Formula {
        let folded = self.value(a).and_then(|value| match operation {
            Unary::Neg => Some(Rational::from(-value)),
            Unary::Abs => Some(Rational::from(value.abs_ref())),
            _ => None,
        });
        match folded {
            Some(value) => self.number(value),
            None => self.term(Term::Unary(operation, a)),
        }
    }

    /// `a^(k/2^m)` as `sqrt(... sqrt(a))^k`, which is the same function: undefined below 0 and, for negative k, at 0. Roots are correctly rounded
    /// and cheap, and other powers are neither. `None` of other exponents.
    fn by_roots(&mut self, a: Formula, b: Formula) -> Option<Formula> {
        let exponent = self.value(b)?;
        let roots = exponent.denom().find_one(0)?;
        let is_root = (1..=MAX_ROOTS).contains(&roots) && exponent.denom().is_power_of_two();
        let numerator = exponent.numer().to_i32().filter(|k| is_root && k.unsigned_abs() <= MAX_OF_ROOT)?;
        let root = (0..roots).fold(a, |root, _| self.apply(Unary::Sqrt, root));
        Some(self.raise(root, numerator))
    }

    fn combine(&mut self, operation: Binary, a: Formula, b: Formula) -> Formula {
        if let (Binary::Pow, Some(power)) = (operation, self.by_roots(a, b)) {
            return power;
        }
        let folded = self.value(a).zip(self.value(b)).and_then(|(a, b)| {
            (bits(a).saturating_add(bits(b)) <= MAX_FOLDED_BITS).then(|| fold(operation, a, b)).flatten()
        });
        match folded {
            Some(value) => self.number(value),
            None => self.term(Term::Binary(operation, a, b)),
        }
    }

    fn raise(&mut self, base: Formula, exponent: i32) -> Formula {
        match exponent {
            1 => return base,
            // u^0 is 1 for every u, but an undefined u stays undefined: the term is kept.
            0 => {}
            _ => {
                let small = |value: &&Rational| bits(value).saturating_mul(exponent.unsigned_abs()) <= MAX_FOLDED_BITS;
                let zero_below = |value: &&Rational| !(exponent < 0 && value.is_zero());
                let folded = self.value(base).filter(small).filter(zero_below).map(|value| {
                    use rug::ops::Pow;
                    Rational::from(value.pow(exponent))
                });
                if let Some(value) = folded {
                    return self.number(value);
                }
            }
        }
        self.term(Term::Power(base, exponent))
    }

    /// The partial derivatives of some formulas with respect to a variable, which are formulas again.
    ///
    /// They are those of the formulas wherever all [`Demand`]s hold; where min, max or abs have a corner they are undefined
    /// ([`Operations::step`]).
    pub fn derivatives(&mut self, outputs: &[Formula], variable: PlantVariable) -> Vec<Formula> {
        let zero = self.integer(0);
        let needed = self.reachable(outputs);
        let mut derivative = vec![zero; needed.len()];
        for id in (0..needed.len()).filter(|&id| needed[id]) {
            derivative[id] = self.derivative(Formula(id), variable, &derivative, zero);
        }
        outputs.iter().map(|output| derivative[output.0]).collect()
    }

    fn derivative(&mut self, id: Formula, variable: PlantVariable, known: &[Formula], zero: Formula) -> Formula {
        match self.terms[id.0] {
            Term::Number(_) | Term::Pi | Term::Step(_) => zero,
            Term::Variable(this) => self.integer(i32::from(this == variable)),
            Term::Unary(operation, a) => {
                let da = known[a.0];
                if da == zero {
                    return zero;
                }
                let factor = self.slope(operation, a, id);
                self.product(factor, da)
            }
            Term::Binary(operation, a, b) => {
                let (da, db) = (known[a.0], known[b.0]);
                if da == zero && db == zero {
                    return zero;
                }
                self.binary_derivative(operation, [a, b], [da, db], id)
            }
            Term::Power(base, exponent) => {
                let da = known[base.0];
                if da == zero || exponent == 0 {
                    return zero;
                }
                // (u^n)' = n u^(n-1) u'
                let (n, power) = (self.integer(exponent), self.raise(base, exponent - 1));
                let factor = self.product(n, power);
                self.product(factor, da)
            }
        }
    }

    /// The derivative of a function of one argument at `a`, where its value is `value`.
    fn slope(&mut self, operation: Unary, a: Formula, value: Formula) -> Formula {
        let one = self.integer(1);
        match operation {
            Unary::Neg => self.integer(-1),
            Unary::Sqrt => {
                let half = self.number(Rational::from((1, 2)));
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
                let square = self.raise(value, 2);
                self.combine(Binary::Add, one, square)
            }
            Unary::Atan => {
                let square = self.raise(a, 2);
                let sum = self.combine(Binary::Add, one, square);
                self.combine(Binary::Div, one, sum)
            }
            Unary::Tanh => {
                let square = self.raise(value, 2);
                self.combine(Binary::Sub, one, square)
            }
            Unary::Exprelr(order) => self.apply(Unary::Exprelr(order + 1), a),
            Unary::Sinc(order) => self.apply(Unary::Sinc(order + 1), a),
            Unary::Abs => {
                let (step, two) = (self.term(Term::Step(a)), self.integer(2));
                let doubled = self.combine(Binary::Mul, two, step);
                self.combine(Binary::Sub, doubled, one)
            }
        }
    }

    fn binary_derivative(
        &mut self,
        operation: Binary,
        [a, b]: [Formula; 2],
        [da, db]: [Formula; 2],
        value: Formula,
    ) -> Formula {
        match operation {
            Binary::Add => self.sum(da, db),
            Binary::Sub => self.difference(da, db),
            Binary::Mul => {
                let (left, right) = (self.product(da, b), self.product(a, db));
                self.sum(left, right)
            }
            Binary::Div => {
                // (a/b)' = (a' - (a/b) b')/b
                let change = self.product(value, db);
                let numerator = self.difference(da, change);
                self.combine(Binary::Div, numerator, b)
            }
            Binary::Pow => {
                // (a^b)' = b a^(b-1) a' + a^b log(a) b'
                let one = self.integer(1);
                let less = self.combine(Binary::Sub, b, one);
                let power = self.combine(Binary::Pow, a, less);
                let left = self.product(b, power);
                let left = self.product(left, da);
                let logarithm = self.apply(Unary::Log, a);
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
                let one = self.integer(1);
                let second = self.combine(Binary::Sub, one, first);
                let (left, right) = (self.product(first, da), self.product(second, db));
                self.sum(left, right)
            }
        }
    }

    /// The sum, without additions of 0.
    pub fn sum(&mut self, a: Formula, b: Formula) -> Formula {
        if self.is_zero(a) {
            return b;
        }
        if self.is_zero(b) { a } else { self.combine(Binary::Add, a, b) }
    }

    /// The difference, without subtractions of 0.
    pub fn difference(&mut self, a: Formula, b: Formula) -> Formula {
        if self.is_zero(b) {
            return a;
        }
        if self.is_zero(a) { self.apply(Unary::Neg, b) } else { self.combine(Binary::Sub, a, b) }
    }

    /// The product, without factors 0, 1 and -1. A derivative that is 0 is 0 whatever it is multiplied with, where the
    /// [`Demand`]s hold.
    pub fn product(&mut self, a: Formula, b: Formula) -> Formula {
        let is = |this: &Formulas, formula: Formula, number: i32| this.value(formula).is_some_and(|v| *v == number);
        if is(self, a, 0) || is(self, b, 1) {
            return a;
        }
        if is(self, b, 0) || is(self, a, 1) {
            return b;
        }
        if is(self, a, -1) { self.apply(Unary::Neg, b) } else { self.combine(Binary::Mul, a, b) }
    }

    /// Everything that some formulas need, themselves included.
    pub(super) fn reachable(&self, outputs: &[Formula]) -> Vec<bool> {
        let mut needed = vec![false; self.terms.len()];
        for output in outputs {
            needed[output.0] = true;
        }
        // Operands come before what they are operands of.
        for id in (0..needed.len()).rev().filter(|&id| self.terms[id].operands()[0].is_some()) {
            if needed[id] {
                for operand in self.terms[id].operands().into_iter().flatten() {
                    needed[operand.0] = true;
                }
            }
        }
        needed
    }
}

impl Term {
    /// The operands of a term, the first first.
    pub(super) fn operands(self) -> [Option<Formula>; 2] {
        match self {
            Term::Number(_) | Term::Pi | Term::Variable(_) => [None, None],
            Term::Unary(_, a) | Term::Step(a) | Term::Power(a, _) => [Some(a), None],
            Term::Binary(_, a, b) => [Some(a), Some(b)],
        }
    }
}

fn bits(value: &Rational) -> u32 {
    value.numer().significant_bits().max(value.denom().significant_bits())
}

/// The exact value of an operation on two rationals, where it is rational and defined.
fn fold(operation: Binary, a: &Rational, b: &Rational) -> Option<Rational> {
    match operation {
        Binary::Add => Some(Rational::from(a + b)),
        Binary::Sub => Some(Rational::from(a - b)),
        Binary::Mul => Some(Rational::from(a * b)),
        Binary::Div if !b.is_zero() => Some(Rational::from(a / b)),
        Binary::Div | Binary::Pow => None,
        Binary::Min => Some(if a <= b { a.clone() } else { b.clone() }),
        Binary::Max => Some(if a >= b { a.clone() } else { b.clone() }),
    }
}

/// Inserts an expression, and notes what its operations demand.
struct Insertion<'a> {
    formulas: &'a mut Formulas,
    demands: &'a mut Vec<Demand>,
    /// The operands of the operation that was inserted last.
    operands: Vec<Formula>,
}

impl Algebra<PlantVariable> for Insertion<'_> {
    type Value = Formula;

    fn number(&mut self, value: &Rational) -> Formula {
        self.formulas.number(value.clone())
    }

    fn pi(&mut self) -> Formula {
        self.formulas.term(Term::Pi)
    }

    fn variable(&mut self, variable: PlantVariable) -> Formula {
        self.formulas.variable(variable)
    }

    fn unary(&mut self, operation: Unary, a: Formula) -> Formula {
        self.operands = vec![a];
        self.formulas.apply(operation, a)
    }

    fn binary(&mut self, operation: Binary, a: Formula, b: Formula) -> Formula {
        self.operands = vec![a, b];
        self.formulas.combine(operation, a, b)
    }

    fn power(&mut self, base: Formula, exponent: i32) -> Formula {
        self.operands = vec![base];
        self.formulas.raise(base, exponent)
    }

    fn note(&mut self, node: &Node<PlantVariable>, _value: &Formula) {
        let operand = |index: usize| self.operands.get(index).copied();
        let (what, of, positive) = match &node.kind {
            NodeKind::Unary(Unary::Sqrt) => ("the argument of sqrt is positive", operand(0), true),
            NodeKind::Unary(Unary::Log) => ("the argument of log is positive", operand(0), true),
            NodeKind::Unary(Unary::Abs) => ("the argument of abs does not vanish", operand(0), false),
            NodeKind::Unary(Unary::Tan) => {
                let cosine = operand(0).map(|a| self.formulas.apply(Unary::Cos, a));
                ("the argument of tan has a cosine that does not vanish", cosine, false)
            }
            NodeKind::Binary(Binary::Div) => ("the divisor does not vanish", operand(1), false),
            NodeKind::Binary(Binary::Pow) => ("the base of this power is positive", operand(0), true),
            NodeKind::Binary(Binary::Min | Binary::Max) => {
                let pair = operand(0).zip(operand(1));
                let difference = pair.map(|(a, b)| self.formulas.combine(Binary::Sub, a, b));
                ("the two arguments differ", difference, false)
            }
            NodeKind::Power(exponent) if *exponent < 0 => {
                ("the base of this negative power does not vanish", operand(0), false)
            }
            _ => return,
        };
        let Some(of) = of else { return };
        let constant = self.formulas.value(of);
        let met = constant.is_some_and(|value| if positive { *value > 0 } else { !value.is_zero() });
        if !met {
            let is_quotient = matches!(node.kind, NodeKind::Binary(Binary::Div));
            let dividend = if is_quotient { operand(0) } else { None };
            self.demands.push(Demand { span: node.span.clone(), what, dividend, of, positive });
        }
    }
}
