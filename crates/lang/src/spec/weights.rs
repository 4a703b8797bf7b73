//! The weights n_0 > n_1 > ... of the internal model: values and sum.

use super::parts::Constant;
use super::power_tail::power_tail;
use super::quantity::Quantity;
use crate::expr::Monomial;
use rug::{Integer, Rational};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::Portable;

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
        self.weight_at(l, precision.saturating_add(GUARD_BITS)).at_precision(precision)
    }

    /// A double near n_l: for searches and display only.
    #[must_use]
    pub fn weight_f64(&self, l: u64) -> f64 {
        let power = |exponent: f64| (l as f64).portable_pow(-exponent);
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
        total.at_precision(precision)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{Expr, Variables};
    use rug::{Float, float::Round};

    fn constant(text: &str) -> Constant {
        let expr = Expr::parse(text, Variables::None).unwrap();
        Constant { text: text.to_owned(), exact: expr.exact(), expr }
    }

    fn power(n0: &str, epsilon: &str) -> Weights {
        Weights::Power { n0: constant(n0), epsilon: constant(epsilon) }
    }

    fn explicit(values: &[&str], coefficient: &str, exponent: &str) -> Weights {
        Weights::Explicit {
            values: values.iter().map(|text| constant(text)).collect(),
            coefficient: constant(coefficient),
            exponent: constant(exponent),
        }
    }

    fn relative_width(x: &Enclosure) -> f64 {
        let width = Float::with_val_round(64, x.upper() - x.lower(), Round::Up).0;
        Float::with_val_round(64, &width / x.lower(), Round::Up).0.to_f64()
    }

    #[test]
    fn weights_are_what_the_family_says() {
        let family = power("2", "1/2");
        assert_eq!(family.weight(0, 64).decimals(), ["2", "2"]);
        assert_eq!(family.weight(1, 64).decimals(), ["1", "1"]);
        assert!(family.weight(9, 128).intersect(&(Enclosure::one(128) / 27)).is_defined());
        let list = explicit(&["2", "1", "1/3"], "5", "2");
        assert_eq!(list.weight(2, 64).decimals(), ["0.33333333333333333", "0.33333333333333334"]);
        // Exact in the tail: 5/100.
        let tenth = list.weight(10, 64);
        assert!(tenth.contains(&Rational::from((1, 20))) && relative_width(&tenth) < 2f64.powi(-62));
        assert!(list.exact_tail(10).is_some_and(|n| n.as_rational() == Some(&Rational::from((1, 20)))));
        // 7 * 4^-(3/2) = 7/8 and 2^-(3/2) = sqrt(2)/4.
        let halves = explicit(&["2"], "7", "3/2");
        assert!(halves.exact_tail(4).is_some_and(|n| n.as_rational() == Some(&Rational::from((7, 8)))));
        assert!(halves.exact_tail(2).is_some() && explicit(&["2"], "7", "4/3").exact_tail(2).is_none());
        assert!(
            explicit(&["2"], "7", "4/3").exact_tail(1).is_some_and(|n| n.as_rational() == Some(&Rational::from(7)))
        );
    }

    #[test]
    fn doubles_lie_in_the_enclosures() {
        for family in [power("2", "1/2"), power("pi", "1"), explicit(&["2", "1", "0.3"], "1.1", "5/3")] {
            for l in [0, 1, 2, 3, 4, 100, 1_000_000, u64::MAX] {
                let (value, double) = (family.weight(l, 64), family.weight_f64(l));
                assert!((value.lower_f64() / double - 1.0).abs() < 1e-13, "{l}");
                assert!(relative_width(&value) < 2f64.powi(-61));
            }
        }
    }

    #[test]
    fn totals_are_narrow_for_every_allowed_exponent() {
        for epsilon in ["1/2", "1e-6", "1", "0.05", "pi - 3", "1e-12"] {
            let total = power("2", epsilon).total(128);
            assert!(relative_width(&total) < 1e-36, "{epsilon} {}", relative_width(&total));
            let zeta = |round| {
                let p = constant(epsilon).enclose(256) + 1;
                Float::with_val_round(192, p.lower().zeta_ref(), round).0 + 2u32
            };
            assert!(total.lower() <= zeta(Round::Up) && total.upper() >= zeta(Round::Down), "{epsilon}");
        }
        // n_0 + zeta(2) = 2 + pi^2/6.
        let total = power("2", "1").total(128);
        let expected = Enclosure::pi(300).sqr() / 6 + 2;
        assert!(total.lower() <= expected.lower() && expected.upper() <= total.upper());
    }

    #[test]
    fn a_listed_prefix_of_the_family_changes_nothing() {
        let family = power("2", "1/2").total(128);
        for values in [&["2"][..], &["2", "1"], &["2", "1", "1/sqrt(8)"], &["2", "1", "1/sqrt(8)", "1/sqrt(27)"]] {
            let list = explicit(values, "1", "3/2");
            assert!(list.prove().is_ok());
            let total = list.total(128);
            assert!(total.intersect(&family).is_defined() && relative_width(&total) < 1e-36, "{values:?}");
        }
        let scaled = explicit(&["3", "2", "1"], "2", "2").total(128);
        // 6 + 2 (pi^2/6 - 1 - 1/4).
        let expected = Enclosure::pi(300).sqr() / 3 + Enclosure::from_rational(&Rational::from((7, 2)), 300);
        assert!(scaled.lower() <= expected.lower() && expected.upper() <= scaled.upper());
    }
}
