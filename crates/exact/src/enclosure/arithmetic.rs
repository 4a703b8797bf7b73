//! Addition, subtraction, multiplication, division, absolute value, minimum and maximum.

use super::ends::{End, SHORT, fits};
use super::{Enclosure, Ends};
use rug::Float;
use rug::float::Round;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Two ends.
type Pair<'a, E> = [&'a E; 2];

#[inline]
fn sum<E: End>([a1, a2]: Pair<'_, E>, [b1, b2]: Pair<'_, E>, p: u32) -> [E; 2] {
    [a1.add(b1, p, Round::Down), a2.add(b2, p, Round::Up)]
}

#[inline]
fn difference<E: End>([a1, a2]: Pair<'_, E>, [b1, b2]: Pair<'_, E>, p: u32) -> [E; 2] {
    [a1.sub(b2, p, Round::Down), a2.sub(b1, p, Round::Up)]
}

// Which end points give the product, with a = [a1, a2] and b = [b1, b2]:
//
//              b1 >= 0          b2 <= 0          b1 < 0 < b2
// a1 >= 0      a1 b1, a2 b2     a2 b1, a1 b2     a2 b1, a2 b2
// a2 <= 0      a1 b2, a2 b1     a2 b2, a1 b1     a1 b2, a1 b1
// a1 < 0 < a2  a1 b2, a2 b2     a2 b1, a1 b1     min(a1 b2, a2 b1), max(a1 b1, a2 b2)
#[inline]
fn product<E: End>([a1, a2]: Pair<'_, E>, [b1, b2]: Pair<'_, E>, p: u32) -> [E; 2] {
    let down = |x: &E, y: &E| x.mul(y, p, Round::Down);
    let up = |x: &E, y: &E| x.mul(y, p, Round::Up);
    if a1.is_nonnegative() {
        if b1.is_nonnegative() {
            [down(a1, b1), up(a2, b2)]
        } else if b2.is_nonpositive() {
            [down(a2, b1), up(a1, b2)]
        } else {
            [down(a2, b1), up(a2, b2)]
        }
    } else if a2.is_nonpositive() {
        if b1.is_nonnegative() {
            [down(a1, b2), up(a2, b1)]
        } else if b2.is_nonpositive() {
            [down(a2, b2), up(a1, b1)]
        } else {
            [down(a1, b2), up(a1, b1)]
        }
    } else if b1.is_nonnegative() {
        [down(a1, b2), up(a2, b2)]
    } else if b2.is_nonpositive() {
        [down(a2, b1), up(a1, b1)]
    } else {
        [down(a1, b2).smaller(&down(a2, b1), p), up(a1, b1).larger(&up(a2, b2), p)]
    }
}

// Which end points give the quotient, with a = [a1, a2] and b = [b1, b2], 0 not in b:
//
//              b1 > 0           b2 < 0
// a1 >= 0      a1/b2, a2/b1     a2/b2, a1/b1
// a2 <= 0      a1/b1, a2/b2     a2/b1, a1/b2
// a1 < 0 < a2  a1/b1, a2/b1     a2/b2, a1/b2
#[inline]
fn quotient<E: End>([a1, a2]: Pair<'_, E>, [b1, b2]: Pair<'_, E>, p: u32) -> [E; 2] {
    let down = |x: &E, y: &E| x.div(y, p, Round::Down);
    let up = |x: &E, y: &E| x.div(y, p, Round::Up);
    if b1.is_nonnegative() {
        if a1.is_nonnegative() {
            [down(a1, b2), up(a2, b1)]
        } else if a2.is_nonpositive() {
            [down(a1, b1), up(a2, b2)]
        } else {
            [down(a1, b1), up(a2, b1)]
        }
    } else if a1.is_nonnegative() {
        [down(a2, b2), up(a1, b1)]
    } else if a2.is_nonpositive() {
        [down(a2, b1), up(a1, b2)]
    } else {
        [down(a2, b2), up(a1, b2)]
    }
}

#[inline]
fn both_smaller<E: End>([a1, a2]: Pair<'_, E>, [b1, b2]: Pair<'_, E>, p: u32) -> [E; 2] {
    [a1.smaller(b1, p), a2.smaller(b2, p)]
}

#[inline]
fn both_larger<E: End>([a1, a2]: Pair<'_, E>, [b1, b2]: Pair<'_, E>, p: u32) -> [E; 2] {
    [a1.larger(b1, p), a2.larger(b2, p)]
}

#[inline]
fn outer<E: End>([a1, a2]: Pair<'_, E>, [b1, b2]: Pair<'_, E>, p: u32) -> [E; 2] {
    [a1.smaller(b1, p), a2.larger(b2, p)]
}

#[inline]
fn inner<E: End>([a1, a2]: Pair<'_, E>, [b1, b2]: Pair<'_, E>, p: u32) -> [E; 2] {
    [a1.larger(b1, p), a2.smaller(b2, p)]
}

impl Enclosure {
    /// The operation on the ends, at the larger of the two precisions; undefined if one of both is.
    #[inline]
    fn with(
        &self,
        other: &Enclosure,
        short: impl Fn(Pair<'_, f64>, Pair<'_, f64>, u32) -> [f64; 2],
        long: impl Fn(Pair<'_, Float>, Pair<'_, Float>, u32) -> [Float; 2],
    ) -> Enclosure {
        if let (Ends::Short([a1, a2]), Ends::Short([b1, b2])) = (&self.ends, &other.ends) {
            let ends @ [lower, upper] = short([a1, a2], [b1, b2], SHORT);
            if fits(lower) && fits(upper) && lower <= upper {
                return Enclosure { ends: Ends::Short(ends) };
            }
        }
        let p = self.precision().max(other.precision());
        if !self.is_defined() || !other.is_defined() {
            return Enclosure::undefined(p);
        }
        let ([a1, a2], [b1, b2]) = (self.long(), other.long());
        let [lower, upper] = long([&a1, &a2], [&b1, &b2], p);
        Enclosure::new(lower, upper)
    }

    fn add_enclosure(&self, other: &Enclosure) -> Enclosure {
        self.with(other, sum, sum)
    }

    fn sub_enclosure(&self, other: &Enclosure) -> Enclosure {
        self.with(other, difference, difference)
    }

    fn mul_enclosure(&self, other: &Enclosure) -> Enclosure {
        self.with(other, product, product)
    }

    fn div_enclosure(&self, other: &Enclosure) -> Enclosure {
        if other.contains_zero() {
            return Enclosure::undefined(self.precision().max(other.precision()));
        }
        self.with(other, quotient, quotient)
    }

    /// The opposite.
    #[must_use]
    pub fn negate(&self) -> Enclosure {
        match &self.ends {
            Ends::Short([lower, upper]) => Enclosure { ends: Ends::Short([upper.opposite(), lower.opposite()]) },
            Ends::Long([lower, upper]) => Enclosure { ends: Ends::Long([upper.opposite(), lower.opposite()]) },
        }
    }

    /// The reciprocal; undefined if 0 lies in the interval.
    #[must_use]
    pub fn recip(&self) -> Enclosure {
        Enclosure::one(self.precision()).div_enclosure(self)
    }

    /// The absolute value.
    #[must_use]
    pub fn abs(&self) -> Enclosure {
        if !self.is_defined() || self.is_nonnegative().is_true() {
            return self.clone();
        }
        let opposite = self.negate();
        if opposite.is_nonnegative().is_true() {
            opposite
        } else {
            self.max(&opposite).max(&Enclosure::zero(self.precision()))
        }
    }

    /// The smaller of two quantities.
    #[must_use]
    pub fn min(&self, other: &Enclosure) -> Enclosure {
        self.with(other, both_smaller, both_smaller)
    }

    /// The larger of two quantities.
    #[must_use]
    pub fn max(&self, other: &Enclosure) -> Enclosure {
        self.with(other, both_larger, both_larger)
    }

    /// The smallest interval containing both; undefined if one of them is.
    #[must_use]
    pub fn hull(&self, other: &Enclosure) -> Enclosure {
        self.with(other, outer, outer)
    }

    /// The common part of two enclosures of the *same* quantity.
    ///
    /// Undefined if either is undefined or if they are disjoint (which would mean that one of them is wrong).
    #[must_use]
    pub fn intersect(&self, other: &Enclosure) -> Enclosure {
        self.with(other, inner, inner)
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
                self.$implementation(&Enclosure::from_integer(other, self.precision().max(SHORT)))
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
                Enclosure::from_integer(self, other.precision().max(SHORT)).$implementation(other)
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
