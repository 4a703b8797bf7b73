//! Addition, subtraction, multiplication, division, absolute value, minimum and maximum.

use super::Enclosure;
use rug::Float;
use rug::float::Round;
use std::ops::{Add, Div, Mul, Neg, Sub};

fn add(a: &Float, b: &Float, precision: u32, round: Round) -> Float {
    Float::with_val_round(precision, a + b, round).0
}

fn sub(a: &Float, b: &Float, precision: u32, round: Round) -> Float {
    Float::with_val_round(precision, a - b, round).0
}

/// End-point product. An infinite end is a bound, not a value, so `0 * inf` is 0 here.
fn mul(a: &Float, b: &Float, precision: u32, round: Round) -> Float {
    if a.is_zero() || b.is_zero() {
        return Float::new(precision);
    }
    Float::with_val_round(precision, a * b, round).0
}

/// End-point quotient with `b != 0`. `inf / inf` only meets as "bound over bound" and gives the trivial bound,
/// which for the lower end of a nonnegative quotient is 0 and for the upper end infinity.
fn div(a: &Float, b: &Float, precision: u32, round: Round) -> Float {
    if a.is_zero() {
        return Float::new(precision);
    }
    if a.is_infinite() && b.is_infinite() {
        let positive = a.is_sign_positive() == b.is_sign_positive();
        let trivial = match (positive, round) {
            (true, Round::Down) | (false, Round::Up) => rug::float::Special::Zero,
            (true, _) => rug::float::Special::Infinity,
            (false, _) => rug::float::Special::NegInfinity,
        };
        return Float::with_val(precision, trivial);
    }
    Float::with_val_round(precision, a / b, round).0
}

/// The smaller of two end points, exactly: the precision is at least that of either. (`Float::min` rounds to nearest at
/// the precision of its receiver, which need not be outward.)
pub(super) fn smaller(a: &Float, b: &Float, precision: u32) -> Float {
    Float::with_val(precision, if a <= b { a } else { b })
}

/// The larger of two end points, exactly, in the same way.
pub(super) fn larger(a: &Float, b: &Float, precision: u32) -> Float {
    Float::with_val(precision, if a >= b { a } else { b })
}

impl Enclosure {
    fn add_enclosure(&self, other: &Enclosure) -> Enclosure {
        let p = self.precision().max(other.precision());
        if !self.is_defined() || !other.is_defined() {
            return Enclosure::undefined(p);
        }
        Enclosure {
            lower: add(&self.lower, &other.lower, p, Round::Down),
            upper: add(&self.upper, &other.upper, p, Round::Up),
        }
    }

    fn sub_enclosure(&self, other: &Enclosure) -> Enclosure {
        let p = self.precision().max(other.precision());
        if !self.is_defined() || !other.is_defined() {
            return Enclosure::undefined(p);
        }
        Enclosure {
            lower: sub(&self.lower, &other.upper, p, Round::Down),
            upper: sub(&self.upper, &other.lower, p, Round::Up),
        }
    }

    // Which end points give the product, with a = [a1, a2] and b = [b1, b2]:
    //
    //              b1 >= 0          b2 <= 0          b1 < 0 < b2
    // a1 >= 0      a1 b1, a2 b2     a2 b1, a1 b2     a2 b1, a2 b2
    // a2 <= 0      a1 b2, a2 b1     a2 b2, a1 b1     a1 b2, a1 b1
    // a1 < 0 < a2  a1 b2, a2 b2     a2 b1, a1 b1     min(a1 b2, a2 b1), max(a1 b1, a2 b2)
    fn mul_enclosure(&self, other: &Enclosure) -> Enclosure {
        let p = self.precision().max(other.precision());
        if !self.is_defined() || !other.is_defined() {
            return Enclosure::undefined(p);
        }
        let (a1, a2, b1, b2) = (&self.lower, &self.upper, &other.lower, &other.upper);
        let down = |x: &Float, y: &Float| mul(x, y, p, Round::Down);
        let up = |x: &Float, y: &Float| mul(x, y, p, Round::Up);
        let (lower, upper) = if *a1 >= 0 {
            if *b1 >= 0 {
                (down(a1, b1), up(a2, b2))
            } else if *b2 <= 0 {
                (down(a2, b1), up(a1, b2))
            } else {
                (down(a2, b1), up(a2, b2))
            }
        } else if *a2 <= 0 {
            if *b1 >= 0 {
                (down(a1, b2), up(a2, b1))
            } else if *b2 <= 0 {
                (down(a2, b2), up(a1, b1))
            } else {
                (down(a1, b2), up(a1, b1))
            }
        } else if *b1 >= 0 {
            (down(a1, b2), up(a2, b2))
        } else if *b2 <= 0 {
            (down(a2, b1), up(a1, b1))
        } else {
            (smaller(&down(a1, b2), &down(a2, b1), p), larger(&up(a1, b1), &up(a2, b2), p))
        };
        Enclosure { lower, upper }
    }

    // Which end points give the quotient, with a = [a1, a2] and b = [b1, b2], 0 not in b:
    //
    //              b1 > 0           b2 < 0
    // a1 >= 0      a1/b2, a2/b1     a2/b2, a1/b1
    // a2 <= 0      a1/b1, a2/b2     a2/b1, a1/b2
    // a1 < 0 < a2  a1/b1, a2/b1     a2/b2, a1/b2
    fn div_enclosure(&self, other: &Enclosure) -> Enclosure {
        let p = self.precision().max(other.precision());
        if !self.is_defined() || !other.is_defined() || other.contains_zero() {
            return Enclosure::undefined(p);
        }
        let (a1, a2, b1, b2) = (&self.lower, &self.upper, &other.lower, &other.upper);
        let down = |x: &Float, y: &Float| div(x, y, p, Round::Down);
        let up = |x: &Float, y: &Float| div(x, y, p, Round::Up);
        let (lower, upper) = if *b1 > 0 {
            if *a1 >= 0 {
                (down(a1, b2), up(a2, b1))
            } else if *a2 <= 0 {
                (down(a1, b1), up(a2, b2))
            } else {
                (down(a1, b1), up(a2, b1))
            }
        } else if *a1 >= 0 {
            (down(a2, b2), up(a1, b1))
        } else if *a2 <= 0 {
            (down(a2, b1), up(a1, b2))
        } else {
            (down(a2, b2), up(a1, b2))
        };
        Enclosure { lower, upper }
    }

    /// The opposite.
    #[must_use]
    pub fn negate(&self) -> Enclosure {
        Enclosure { lower: -self.upper.clone(), upper: -self.lower.clone() }
    }

    /// The reciprocal; undefined if 0 lies in the interval.
    #[must_use]
    pub fn recip(&self) -> Enclosure {
        Enclosure::one(self.precision()).div_enclosure(self)
    }

    /// The absolute value.
    #[must_use]
    pub fn abs(&self) -> Enclosure {
        if !self.is_defined() || self.lower >= 0 {
            self.clone()
        } else if self.upper <= 0 {
            self.negate()
        } else {
            let (p, opposite) = (self.precision(), self.negate());
            Enclosure { lower: Float::new(p), upper: larger(&self.upper, &opposite.upper, p) }
        }
    }

    /// The smaller of two quantities.
    #[must_use]
    pub fn min(&self, other: &Enclosure) -> Enclosure {
        let p = self.precision().max(other.precision());
        if !self.is_defined() || !other.is_defined() {
            return Enclosure::undefined(p);
        }
        Enclosure { lower: smaller(&self.lower, &other.lower, p), upper: smaller(&self.upper, &other.upper, p) }
    }

    /// The larger of two quantities.
    #[must_use]
    pub fn max(&self, other: &Enclosure) -> Enclosure {
        let p = self.precision().max(other.precision());
        if !self.is_defined() || !other.is_defined() {
            return Enclosure::undefined(p);
        }
        Enclosure { lower: larger(&self.lower, &other.lower, p), upper: larger(&self.upper, &other.upper, p) }
    }
}

macro_rules! binary_operator {
    ($trait:ident, $method:ident, $implementation:ident) => {
        impl $trait<&Enclosure> for &Enclosure {
            type Output = Enclosure;
            fn $method(self, other: &Enclosure) -> Enclosure {
                self.$implementation(other)
            }
        }
        impl $trait<Enclosure> for &Enclosure {
            type Output = Enclosure;
            fn $method(self, other: Enclosure) -> Enclosure {
                self.$implementation(&other)
            }
        }
        impl $trait<&Enclosure> for Enclosure {
            type Output = Enclosure;
            fn $method(self, other: &Enclosure) -> Enclosure {
                self.$implementation(other)
            }
        }
        impl $trait<Enclosure> for Enclosure {
            type Output = Enclosure;
            fn $method(self, other: Enclosure) -> Enclosure {
                self.$implementation(&other)
            }
        }
        impl $trait<i64> for &Enclosure {
            type Output = Enclosure;
            fn $method(self, other: i64) -> Enclosure {
                self.$implementation(&Enclosure::from_integer(other, self.precision().max(64)))
            }
        }
        impl $trait<i64> for Enclosure {
            type Output = Enclosure;
            fn $method(self, other: i64) -> Enclosure {
                (&self).$method(other)
            }
        }
        impl $trait<&Enclosure> for i64 {
            type Output = Enclosure;
            fn $method(self, other: &Enclosure) -> Enclosure {
                Enclosure::from_integer(self, other.precision().max(64)).$implementation(other)
            }
        }
        impl $trait<Enclosure> for i64 {
            type Output = Enclosure;
            fn $method(self, other: Enclosure) -> Enclosure {
                self.$method(&other)
            }
        }
    };
}

binary_operator!(Add, add, add_enclosure);
binary_operator!(Sub, sub, sub_enclosure);
binary_operator!(Mul, mul, mul_enclosure);
binary_operator!(Div, div, div_enclosure);

impl Neg for &Enclosure {
    type Output = Enclosure;
    fn neg(self) -> Enclosure {
        self.negate()
    }
}

impl Neg for Enclosure {
    type Output = Enclosure;
    fn neg(self) -> Enclosure {
        self.negate()
    }
}
