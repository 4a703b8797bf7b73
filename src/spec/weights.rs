//! The weights n_0 > n_1 > ... of the internal model: values and sum.

use super::model::Constant;
use super::power_tail::power_tail;
use super::quantity::Quantity;
use crate::enclosure::Enclosure;
use crate::number::Monomial;
use rug::{Float, Integer, Rational, float::Round};

/// The two families of weights that are read.
///
/// A value inside a [`Specification`](super::Specification) was proved, when it was read, to satisfy
/// (W1) sum n_l is finite, (W2) l n_l is nonincreasing for l >= 1, (W3) l^2 n_l is nondecreasing for l >= 1, and
/// n_0 > n_1 > n_2 > ... > 0. Weights have no unit.
#[derive(Clone, Debug)]
pub enum Weights {
    /// n_0 given, n_l = l^-(1 + epsilon) for l >= 1, with n_0 > 1 and 0 < epsilon <= 1.
    Power {
        /// n_0.
        n0: Constant,
        /// epsilon.
        epsilon: Constant,
    },
    /// n_0, ..., n_L listed; n_l = coefficient * l^-exponent for l > L, with coefficient > 0, 1 < exponent <= 2.
    Explicit {
        /// n_0, ..., n_L; at least one.
        values: Vec<Constant>,
        /// The coefficient of the tail.
        coefficient: Constant,
        /// The exponent of the tail.
        exponent: Constant,
    },
}

/// Bits carried beyond those asked for, so that the rounding of a few operations does not show.
const GUARD_BITS: u32 = 32;

impl Weights {
    /// An enclosure of n_l, rounded outward to `precision` bits; exact up to that rounding where n_l has an exact form.
    #[must_use]
    pub fn weight(&self, l: u64, precision: u32) -> Enclosure {
        round_outward(&self.weight_at(l, precision.saturating_add(GUARD_BITS)), precision)
    }

    /// A double near n_l: for searches and display only.
    #[must_use]
    pub fn weight_f64(&self, l: u64) -> f64 {
        let power = |exponent: f64| (l as f64).powf(-exponent);
        match self {
            Weights::Power { n0, .. } if l == 0 => n0.to_f64(),
            Weights::Power { epsilon, .. } => power(1.0 + epsilon.to_f64()),
            Weights::Explicit { values, coefficient, exponent } => match listed(values, l) {
                Some(value) => value.to_f64(),
                None => coefficient.to_f64() * power(exponent.to_f64()),
            },
        }
    }

    /// An enclosure of Nbar^2 = n_0 + n_1 + n_2 + ..., rounded outward to `precision` bits; the relative width is about
    /// 2^-precision. See [`power_tail`] for the infinite part.
    #[must_use]
    pub fn total(&self, precision: u32) -> Enclosure {
        // The sum of l^-p over l changes by 1/(p - 1)^2 times a change of p: more bits than usual for the exponent.
        let work = precision.saturating_add(2 * GUARD_BITS);
        let total = match self {
            Weights::Power { n0, epsilon } => n0.enclose(work) + power_tail(1, &(epsilon.enclose(work) + 1), work),
            Weights::Explicit { values, coefficient, exponent } => {
                let tail = power_tail(values.len() as u64, &exponent.enclose(work), work);
                values.iter().fold(coefficient.enclose(work) * tail, |sum, value| sum + value.enclose(work))
            }
        };
        round_outward(&total, precision)
    }

    /// n_l in its exact form, where there is one, and by enclosures.
    pub(super) fn quantity(&self, l: u64) -> Quantity<'_> {
        let given = match self {
            Weights::Power { n0, .. } => (l == 0).then_some(n0),
            Weights::Explicit { values, .. } => listed(values, l),
        };
        match given {
            Some(constant) => Quantity::constant(constant),
            None => Quantity::new(self.exact_tail(l), move |precision| self.weight_at(l, precision)),
        }
    }

    fn weight_at(&self, l: u64, precision: u32) -> Enclosure {
        let power = |exponent: &Enclosure| Enclosure::from_rational(&Rational::from(l), precision).pow(&-exponent);
        match self {
            Weights::Power { n0, .. } if l == 0 => n0.enclose(precision),
            Weights::Power { epsilon, .. } => power(&(epsilon.enclose(precision) + 1)),
            Weights::Explicit { values, coefficient, exponent } => match listed(values, l) {
                Some(value) => value.enclose(precision),
                None => match self.exact_tail(l) {
                    Some(exact) => exact.enclose(precision),
                    None => coefficient.enclose(precision) * power(&exponent.enclose(precision)),
                },
            },
        }
    }

    /// coefficient * l^-exponent exactly: for l = 1, and where twice the exponent is an integer.
    fn exact_tail(&self, l: u64) -> Option<Monomial> {
        let Weights::Explicit { coefficient, exponent, .. } = self else { return None };
        let coefficient = coefficient.exact.as_ref()?;
        if l == 1 {
            return Some(coefficient.clone());
        }
        let doubled = Rational::from(exponent.as_rational()? * 2u32);
        if *doubled.denom() != 1 || l == 0 {
            return None;
        }
        let halves = doubled.numer().to_i32()?;
        let root = Monomial::rational(Rational::from(Integer::from(l))).sqrt()?;
        coefficient.div(&root.pow(halves)?)
    }
}

/// The listed value n_l, if l is in the list.
fn listed(values: &[Constant], l: u64) -> Option<&Constant> {
    usize::try_from(l).ok().and_then(|l| values.get(l))
}

fn round_outward(value: &Enclosure, precision: u32) -> Enclosure {
    Enclosure::new(
        Float::with_val_round(precision, value.lower(), Round::Down).0,
        Float::with_val_round(precision, value.upper(), Round::Up).0,
    )
}
