//! Sums of leaves times numbers: one term a leaf, in one order (docs/mathematics.md, section 11.3).
//!
//! With `x = xb(t) + L v` a state is such a sum, and what a formula adds up of several states is one again. Intervals of
//! `a x_1 + b x_2` forget that both move with the same v; those of one term for each v_j do not.

use proofs_core::expr::Op;
use rug::Rational;

/// The most bits of a number in a sum: what is longer is no sum, but an operation like another. A numeral has about half of that.
const MAX_BITS: u32 = 1 << 15;

/// `constant + sum_i factor_i leaf_i`, no factor 0, the leaves by their places.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Linear {
    constant: Rational,
    terms: Vec<(usize, Rational)>,
}

impl Linear {
    /// A number.
    pub fn number(value: &Rational) -> Linear {
        Linear { constant: value.clone(), terms: Vec::new() }
    }

    /// A leaf.
    pub fn leaf(id: usize) -> Linear {
        Linear { constant: Rational::new(), terms: vec![(id, Rational::from(1))] }
    }

    /// The leaves with their factors.
    pub fn terms(&self) -> &[(usize, Rational)] {
        &self.terms
    }

    /// What stands beside them.
    pub fn constant(&self) -> &Rational {
        &self.constant
    }

    fn is_moderate(&self) -> bool {
        let bits = |x: &Rational| x.numer().significant_bits().max(x.denom().significant_bits());
        self.terms.iter().map(|(_, factor)| factor).chain([&self.constant]).all(|number| bits(number) <= MAX_BITS)
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

    /// What an operation makes of such sums, if that is one again. A divisor 0 makes none, and numbers that are too long make none.
    pub fn apply(op: &Op, a: Option<&Linear>, b: Option<&Linear>) -> Option<Linear> {
        Linear::applied(op, a, b).filter(Linear::is_moderate)
    }

    fn applied(op: &Op, a: Option<&Linear>, b: Option<&Linear>) -> Option<Linear> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use rug::Integer;

    /// A chain of divisions by 1e4000 would fill the memory with the numbers between.
    #[test]
    fn numbers_that_are_too_long_make_no_sum() {
        let number = |digits: u32| Linear::number(&Rational::from(Integer::from(Integer::u_pow_u(10, digits))));
        let (leaf, long, longer) = (Linear::leaf(3), number(4000), number(9000));
        let over = |a: &Linear, b: &Linear| Linear::apply(&Op::Div, Some(a), Some(b));
        let once = over(&leaf, &long).unwrap();
        let twice = over(&once, &long).unwrap();
        assert_eq!(twice.terms().len(), 1);
        assert_eq!(over(&twice, &long), None);
        assert_eq!(over(&over(&leaf, &longer).unwrap(), &long), None);
        // What grows shorter again is one.
        assert_eq!(Linear::apply(&Op::Mul, Some(&twice), Some(&long)), Some(once));
    }
}
