//! Sums of leaves times numbers: one term a leaf, in one order (docs/mathematics.md, section 11.3).
//!
//! With `x = xb(t) + L v` a state is such a sum, and what a formula adds up of several states is one again. Intervals of
//! `a x_1 + b x_2` forget that both move with the same v; those of one term for each v_j do not.

use super::formula::{Formulas, Id, Kind};
use proofs_core::expr::Op;
use rug::Rational;

/// `constant + sum_i factor_i leaf_i`, no factor 0, the leaves by their places.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Linear {
    constant: Rational,
    terms: Vec<(Id, Rational)>,
}

impl Linear {
    /// A number.
    pub fn number(value: &Rational) -> Linear {
        Linear { constant: value.clone(), terms: Vec::new() }
    }

    /// A leaf.
    pub fn leaf(id: Id) -> Linear {
        Linear { constant: Rational::new(), terms: vec![(id, Rational::from(1))] }
    }

    fn as_number(&self) -> Option<&Rational> {
        self.terms.is_empty().then_some(&self.constant)
    }

    fn times(&self, factor: &Rational) -> Linear {
        if *factor == 0 {
            return Linear::default();
        }
        let terms = self.terms.iter().map(|(id, own)| (*id, Rational::from(own * factor)));
        Linear { constant: Rational::from(&self.constant * factor), terms: terms.collect() }
    }

    fn plus(&self, other: &Linear) -> Linear {
        let mut terms = self.terms.clone();
        for (id, factor) in &other.terms {
            match terms.binary_search_by_key(id, |term| term.0) {
                Ok(place) => terms[place].1 += factor,
                Err(place) => terms.insert(place, (*id, factor.clone())),
            }
        }
        terms.retain(|(_, factor)| *factor != 0);
        Linear { constant: Rational::from(&self.constant + &other.constant), terms }
    }

    /// What an operation makes of such sums, if that is one again. A divisor 0 makes none.
    pub fn apply(op: &Op, a: Option<&Linear>, b: Option<&Linear>) -> Option<Linear> {
        let a = a?;
        match op {
            Op::Neg => Some(a.times(&Rational::from(-1))),
            Op::Add => Some(a.plus(b?)),
            Op::Sub => Some(a.plus(&b?.times(&Rational::from(-1)))),
            Op::Mul => match (a.as_number(), b?.as_number()) {
                (Some(factor), _) => Some(b?.times(factor)),
                (_, Some(factor)) => Some(a.times(factor)),
                _ => None,
            },
            Op::Div => b?.as_number().filter(|divisor| **divisor != 0).map(|divisor| a.times(&divisor.clone().recip())),
            _ => None,
        }
    }
}

impl Formulas {
    /// The node of such a sum.
    pub(super) fn sum(&mut self, linear: Linear) -> Id {
        let mut sum = None;
        for (leaf, factor) in &linear.terms {
            let term = match *factor == 1 || *factor == -1 {
                true => *leaf,
                false => {
                    let size = self.number(&factor.clone().abs());
                    self.insert_operation(Op::Mul, [size, *leaf])
                }
            };
            sum = Some(match (sum, *factor > 0) {
                (None, true) => term,
                (None, false) => self.insert_operation(Op::Neg, [term, 0]),
                (Some(sum), true) => self.insert_operation(Op::Add, [sum, term]),
                (Some(sum), false) => self.insert_operation(Op::Sub, [sum, term]),
            });
        }
        let Some(sum) = sum else { return self.number(&linear.constant) };
        let sum = match linear.constant == 0 {
            true => sum,
            false => {
                let constant = self.number(&linear.constant);
                self.insert_operation(Op::Add, [sum, constant])
            }
        };
        self.linear.insert(sum, linear);
        sum
    }

    fn insert_operation(&mut self, op: Op, operands: [Id; 2]) -> Id {
        let depends =
            operands.into_iter().take(super::formula::operands(&op)).fold(0, |all, id| all | self.depends(id));
        self.insert(Kind::Apply(op, operands), depends, None)
    }
}

#[cfg(test)]
mod tests {
    use super::super::formula::Leaf;
    use super::*;

    /// The same sum in two orders is one node, with one term for each leaf, whatever was added on the way.
    #[test]
    fn one_term_for_each_leaf() {
        let mut formulas = Formulas::default();
        let [x, y] = [Leaf::State(0), Leaf::State(1)].map(|leaf| formulas.leaf(leaf));
        let [two, three] = [2, 3].map(|value| formulas.int(value));
        let double = formulas.mul(two, x);
        let first = formulas.add(double, y);
        let second = formulas.sub(y, x);
        let triple = formulas.mul(x, three);
        let second = formulas.add(triple, second);
        assert_eq!(first, second);
        let rest = formulas.sub(first, double);
        assert_eq!(rest, y);
        let none = formulas.sub(second, first);
        assert!(formulas.is_zero(none));
        let other = formulas.sub(first, y);
        assert_ne!(other, x, "2 x is not x");
        let half = formulas.apply(&Op::Div, [double, two]);
        assert_eq!(half, x);
        // With a constant, and a factor that is not rational.
        let shifted = formulas.add(x, three);
        let back = formulas.sub(shifted, three);
        assert_eq!(back, x);
        let pi = formulas.apply(&Op::Pi, [0, 0]);
        let turned = formulas.mul(pi, x);
        let apart = formulas.sub(turned, x);
        assert_ne!(apart, turned);
    }

    /// What is no such sum stays what it is: a product, and a quotient by 0.
    #[test]
    fn products_and_quotients_by_zero_are_left() {
        let mut formulas = Formulas::default();
        let [x, y] = [Leaf::State(0), Leaf::State(1)].map(|leaf| formulas.leaf(leaf));
        let zero = formulas.int(0);
        for id in [formulas.mul(x, y), formulas.apply(&Op::Div, [x, zero])] {
            assert!(!formulas.linear.contains_key(&id), "{:?}", formulas.node(id));
        }
        let product = formulas.mul(x, y);
        let twice = formulas.add(product, product);
        assert!(!formulas.is_zero(twice) && twice != product);
    }
}
