//! Exact real constants of the form `c sqrt(r) pi^k`.

use rug::{Integer, Rational};
use sigmastar_exact::enclosure::{Enclosure, Truth};
use std::cmp::Ordering;

/// The real number `coefficient * sqrt(radicand) * pi^pi_power`, exactly.
///
/// Products, quotients, square roots and some sums of the constants that users write (`3/7`, `2*pi`, `sqrt(3)`) have
/// this form, so that statements such as "base_frequency = 2 pi / period" can be decided exactly rather than left
/// undecided by enclosures. Invariant: the radicand is positive, 1 if it is a rational square, and the coefficient 0
/// comes with radicand 1 and `pi_power` 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Monomial {
    coefficient: Rational,
    radicand: Rational,
    pi_power: i32,
}

/// Bits beyond which exact arithmetic on a constant is given up (enclosures take over).
const MAX_BITS: u32 = 1 << 17;

/// The rational square root, if there is one.
fn rational_sqrt(value: &Rational) -> Option<Rational> {
    let root = |n: &Integer| n.is_perfect_square().then(|| Integer::from(n.sqrt_ref()));
    Some(Rational::from((root(value.numer())?, root(value.denom())?)))
}

impl Monomial {
    /// The rational number itself.
    #[must_use]
    pub fn rational(value: Rational) -> Monomial {
        Monomial { coefficient: value, radicand: Rational::from(1), pi_power: 0 }
    }

    /// The constant pi.
    #[must_use]
    pub fn pi() -> Monomial {
        Monomial { coefficient: Rational::from(1), radicand: Rational::from(1), pi_power: 1 }
    }

    fn normalised(mut coefficient: Rational, mut radicand: Rational, mut pi_power: i32) -> Option<Monomial> {
        if coefficient.is_zero() {
            radicand = Rational::from(1);
            pi_power = 0;
        }
        if let Some(root) = rational_sqrt(&radicand) {
            coefficient *= root;
            radicand = Rational::from(1);
        }
        let bits = [coefficient.numer(), coefficient.denom(), radicand.numer(), radicand.denom()]
            .iter()
            .map(|n| n.significant_bits())
            .max();
        (bits < Some(MAX_BITS)).then_some(Monomial { coefficient, radicand, pi_power })
    }

    /// The rational value, if the number is rational (pi is not, nor is the root of a non-square).
    #[must_use]
    pub fn as_rational(&self) -> Option<&Rational> {
        (self.pi_power == 0 && self.radicand == 1).then_some(&self.coefficient)
    }

    /// The product, or `None` when the exact form grows too large.
    #[must_use]
    pub fn mul(&self, other: &Monomial) -> Option<Monomial> {
        Monomial::normalised(
            Rational::from(&self.coefficient * &other.coefficient),
            Rational::from(&self.radicand * &other.radicand),
            self.pi_power.checked_add(other.pi_power)?,
        )
    }

    /// The quotient; `None` for a zero divisor or when the exact form grows too large.
    #[must_use]
    pub fn div(&self, other: &Monomial) -> Option<Monomial> {
        if other.coefficient.is_zero() {
            return None;
        }
        Monomial::normalised(
            Rational::from(&self.coefficient / &other.coefficient),
            Rational::from(&self.radicand / &other.radicand),
            self.pi_power.checked_sub(other.pi_power)?,
        )
    }

    /// The sum, where both have the same irrational part (or one is 0); `None` otherwise.
    #[must_use]
    pub fn add(&self, other: &Monomial) -> Option<Monomial> {
        if self.coefficient.is_zero() {
            return Some(other.clone());
        }
        if other.coefficient.is_zero() {
            return Some(self.clone());
        }
        if self.pi_power != other.pi_power {
            return None;
        }
        let ratio = rational_sqrt(&Rational::from(&other.radicand / &self.radicand))?;
        Monomial::normalised(&self.coefficient + ratio * &other.coefficient, self.radicand.clone(), self.pi_power)
    }

    /// The opposite.
    #[must_use]
    pub fn neg(&self) -> Monomial {
        Monomial { coefficient: Rational::from(-&self.coefficient), ..self.clone() }
    }

    /// The square root, where it has this form again; `None` otherwise (a negative number included).
    #[must_use]
    pub fn sqrt(&self) -> Option<Monomial> {
        if self.coefficient.is_zero() {
            return Some(self.clone());
        }
        let representable = self.coefficient > 0 && self.radicand == 1 && self.pi_power % 2 == 0;
        representable
            .then(|| Monomial::normalised(Rational::from(1), self.coefficient.clone(), self.pi_power / 2))
            .flatten()
    }

    /// The integer power; `None` for 0 to a negative power or when the exact form grows too large.
    #[must_use]
    pub fn pow(&self, exponent: i32) -> Option<Monomial> {
        let mut result = Monomial::rational(Rational::from(1));
        let base = if exponent < 0 { result.div(self)? } else { self.clone() };
        // Binary powering; sizes are bounded by `normalised`, so hostile exponents end at once.
        for bit in (0..u32::BITS - exponent.unsigned_abs().leading_zeros()).rev() {
            result = result.mul(&result)?;
            if exponent.unsigned_abs() >> bit & 1 == 1 {
                result = result.mul(&base)?;
            }
        }
        Some(result)
    }

    /// Exact comparison where the two have the same power of pi: by signs, then by squares. `None` otherwise.
    #[must_use]
    pub fn compare(&self, other: &Monomial) -> Option<Ordering> {
        let (a, b) = (self.coefficient.cmp0(), other.coefficient.cmp0());
        if a != b || a == Ordering::Equal {
            return Some(a.cmp(&b));
        }
        if self.pi_power != other.pi_power {
            return None;
        }
        let square = |m: &Monomial| Rational::from(m.coefficient.square_ref()) * &m.radicand;
        let by_squares = square(self).cmp(&square(other));
        Some(if a == Ordering::Less { by_squares.reverse() } else { by_squares })
    }

    /// Whether the two numbers are equal: always decided, because different powers of pi with nonzero coefficients
    /// are never equal (pi is transcendental, and the other factors are algebraic).
    #[must_use]
    pub fn equals(&self, other: &Monomial) -> Truth {
        Truth::exact(self.compare(other) == Some(Ordering::Equal))
    }

    /// An enclosure at the given precision.
    #[must_use]
    pub fn enclose(&self, precision: u32) -> Enclosure {
        let mut value = Enclosure::from_rational(&self.coefficient, precision);
        if self.radicand != 1 {
            value = value * Enclosure::from_rational(&self.radicand, precision).sqrt();
        }
        if self.pi_power != 0 {
            value = value * Enclosure::pi(precision).pow_integer(&Integer::from(self.pi_power));
        }
        value
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn rational(numerator: i32, denominator: i32) -> Monomial {
        Monomial::rational(Rational::from((numerator, denominator)))
    }

    #[test]
    fn two_pi_over_the_period_is_exact() {
        let two_pi = rational(2, 1).mul(&Monomial::pi()).unwrap();
        let period = rational(1, 3);
        let six_pi = Monomial::pi().mul(&rational(6, 1)).unwrap();
        assert_eq!(two_pi.div(&period).unwrap().equals(&six_pi), Truth::True);
        assert_eq!(two_pi.equals(&six_pi), Truth::False);
        assert_eq!(two_pi.equals(&rational(44, 7)), Truth::False);
        assert_eq!(two_pi.div(&two_pi).unwrap().as_rational(), Some(&Rational::from(1)));
    }

    #[test]
    fn roots_are_exact() {
        let root3 = rational(3, 1).sqrt().unwrap();
        assert_eq!(root3.mul(&root3).unwrap(), rational(3, 1));
        assert_eq!(rational(9, 4).sqrt().unwrap(), rational(3, 2));
        let root12 = rational(12, 1).sqrt().unwrap();
        assert_eq!(root3.add(&root3).unwrap().equals(&root12), Truth::True);
        assert_eq!(root3.add(&root12.neg()).unwrap().equals(&root3.neg()), Truth::True);
        assert_eq!(root3.compare(&rational(7, 4)), Some(Ordering::Less));
        assert_eq!(root3.neg().compare(&rational(-7, 4)), Some(Ordering::Greater));
        assert_eq!(root3.add(&rational(1, 1)), None);
        assert_eq!(rational(-1, 1).sqrt(), None);
        assert_eq!(root3.sqrt(), None);
    }

    #[test]
    fn powers_and_limits() {
        assert_eq!(rational(2, 3).pow(-3).unwrap(), rational(27, 8));
        assert_eq!(rational(0, 1).pow(-1), None);
        assert_eq!(rational(5, 1).pow(0).unwrap(), rational(1, 1));
        assert_eq!(rational(3, 1).pow(i32::MAX), None);
        assert_eq!(rational(1, 1).div(&rational(0, 1)), None);
    }

    #[test]
    fn enclosures_contain_the_number() {
        let x = rational(-3, 2).mul(&rational(2, 1).sqrt().unwrap()).unwrap().mul(&Monomial::pi()).unwrap();
        let e = x.enclose(128);
        assert!(e.upper_f64() < -6.66 && e.lower_f64() > -6.67);
        assert!(e.lower() < e.upper());
        assert_eq!(rational(1, 4).enclose(64).lower_f64(), 0.25);
    }

    /// Monomials with many coincidences: equal radicands up to squares, equal powers of pi, both signs, zero.
    fn monomial() -> impl Strategy<Value = Monomial> {
        (-6_i32..7, 1_i32..5, 1_i32..13, 1_i32..4, -2_i32..3).prop_map(|(n, d, r, s, k)| {
            let root = rational(r, s).sqrt().expect("a positive number has a root");
            let product = rational(n, d).mul(&root).expect("small numbers");
            product.mul(&Monomial::pi().pow(k).expect("a small power")).expect("small numbers")
        })
    }

    proptest! {
        #[test]
        fn exact_operations_agree_with_enclosures(a in monomial(), b in monomial(), n in -4_i32..5) {
            let (x, y) = (a.enclose(128), b.enclose(128));
            let agrees = |exact: Option<Monomial>, value: Enclosure| match exact {
                Some(exact) => exact.enclose(200).intersect(&value).is_defined(),
                None => true,
            };
            prop_assert!(agrees(a.mul(&b), &x * &y) && agrees(a.add(&b), &x + &y) && agrees(Some(a.neg()), x.negate()));
            prop_assert!(agrees(a.div(&b), &x / &y) && agrees(a.pow(n), x.pow_integer(&Integer::from(n))));
            prop_assert!(agrees(a.sqrt(), x.sqrt()) || a.coefficient.is_zero());
            // Different numbers of these sizes are told apart at 128 bits.
            let apart = x.lt(&y).or(y.lt(&x)).is_true();
            prop_assert_eq!(a.equals(&b), Truth::exact(!apart));
            match a.compare(&b) {
                Some(Ordering::Less) => prop_assert!(x.lt(&y).is_true()),
                Some(Ordering::Equal) => prop_assert!(!apart),
                Some(Ordering::Greater) => prop_assert!(y.lt(&x).is_true()),
                None => prop_assert!(apart && a.pi_power != b.pi_power),
            }
            prop_assert_eq!(a.as_rational().is_some(), a.pi_power == 0 && rational_sqrt(&a.radicand).is_some());
            prop_assert!(a.as_rational().is_none_or(|r| x.contains(r)));
        }
    }
}
