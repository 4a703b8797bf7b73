//! Real numbers of the form s sqrt(q) pi^k with a sign s, a rational q >= 0 and an integer k, exactly.
//!
//! They decide what no enclosure can: equalities, as "base_frequency = 2 pi / period".

use rug::ops::Pow;
use rug::{Integer, Rational};
use std::cmp::Ordering;

/// Sizes beyond which exact arithmetic is given up.
const MAX_BITS: u32 = 1 << 17;

/// `sign * sqrt(square) * pi^power`; 0 has the sign 0 and the power 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exact {
    sign: i32,
    square: Rational,
    power: i32,
}

fn root(q: &Rational) -> Option<Rational> {
    let root = |n: &Integer| n.is_perfect_square().then(|| Integer::from(n.sqrt_ref()));
    Some(Rational::from((root(q.numer())?, root(q.denom())?)))
}

impl Exact {
    fn new(sign: i32, square: Rational, power: i32) -> Option<Exact> {
        if sign == 0 {
            return Some(Exact { sign: 0, square: Rational::new(), power: 0 });
        }
        let small = square.numer().significant_bits().max(square.denom().significant_bits()) < MAX_BITS;
        small.then_some(Exact { sign, square, power })
    }

    /// A rational number.
    pub fn rational(value: &Rational) -> Option<Exact> {
        Exact::new(value.cmp0() as i32, Rational::from(value.square_ref()), 0)
    }

    /// The number pi.
    pub fn pi() -> Exact {
        Exact { sign: 1, square: Rational::from(1), power: 1 }
    }

    /// The rational value, if it is rational.
    pub fn as_rational(&self) -> Option<Rational> {
        let root = (self.power == 0).then(|| root(&self.square)).flatten()?;
        Some(if self.sign < 0 { -root } else { root })
    }

    /// The sign: -1, 0 or 1.
    pub fn sign(&self) -> i32 {
        self.sign
    }

    /// The opposite number.
    pub fn neg(&self) -> Exact {
        Exact { sign: -self.sign, ..self.clone() }
    }

    /// The product.
    pub fn mul(&self, other: &Exact) -> Option<Exact> {
        let square = Rational::from(&self.square * &other.square);
        Exact::new(self.sign * other.sign, square, self.power.checked_add(other.power)?)
    }

    /// The inverse, of a number other than 0.
    pub fn recip(&self) -> Option<Exact> {
        if self.sign == 0 {
            return None;
        }
        Exact::new(self.sign, Rational::from(self.square.recip_ref()), self.power.checked_neg()?)
    }

    /// The sum, where the two have the same irrational part.
    pub fn add(&self, other: &Exact) -> Option<Exact> {
        if self.sign == 0 || other.sign == 0 {
            return Some(if self.sign == 0 { other } else { self }.clone());
        }
        if self.power != other.power {
            return None;
        }
        // other = ratio * |self|
        let ratio = root(&Rational::from(&other.square / &self.square))? * other.sign + self.sign;
        let square = Rational::from(ratio.square_ref()) * &self.square;
        Exact::new(ratio.cmp0() as i32, square, self.power)
    }

    /// The square root, of a nonnegative number.
    pub fn sqrt(&self) -> Option<Exact> {
        if self.sign < 0 || self.power % 2 != 0 {
            return None;
        }
        Exact::new(self.sign, root(&self.square)?, self.power / 2)
    }

    /// An integer power.
    pub fn pow(&self, n: i32) -> Option<Exact> {
        if n < 0 {
            return self.recip()?.pow(n.checked_neg()?);
        }
        let bits = self.square.numer().significant_bits().max(self.square.denom().significant_bits());
        let n = n.unsigned_abs();
        // Refused before it is formed.
        if bits.checked_mul(n)? > MAX_BITS {
            return None;
        }
        let sign = if n == 0 { 1 } else { self.sign.pow(n % 2 + 2) };
        Exact::new(sign, (&self.square).pow(n).into(), self.power.checked_mul(n as i32)?)
    }

    /// The order, where the two have the same power of pi or different signs.
    pub fn compare(&self, other: &Exact) -> Option<Ordering> {
        if self.sign != other.sign || self.sign == 0 {
            return Some(self.sign.cmp(&other.sign));
        }
        let magnitude = (self.power == other.power).then(|| self.square.cmp(&other.square))?;
        Some(if self.sign < 0 { magnitude.reverse() } else { magnitude })
    }

    /// Whether the two are the same number; pi is transcendental, so different powers of it never agree.
    pub fn equals(&self, other: &Exact) -> bool {
        self == other
    }
}
