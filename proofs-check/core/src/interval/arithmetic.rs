//! Sums, products and quotients of intervals: of doubles where these give the same, and of MPFR's otherwise.

use super::{Ends, Interval, doubles, rounded};
use crate::effort;
use rug::Float;
use rug::float::Round;
use rug::ops::DivAssignRound;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// What doubles give, where both have them for ends.
fn by_doubles(
    a: &Interval,
    b: &Interval,
    f: fn(doubles::Ends, doubles::Ends) -> Option<doubles::Ends>,
    steps: u64,
) -> Option<Interval> {
    Interval::near(f(a.short()?, b.short()?), steps)
}

/// What MPFR gives from ends `[a.lo, a.hi, b.lo, b.hi]`, where that is paid for.
fn by_floats(a: &Interval, b: &Interval, f: impl FnOnce(u32, [&Float; 4]) -> Interval) -> Interval {
    let p = a.precision().max(b.precision());
    let paid = effort::arithmetic(p);
    if paid { f(p, [&*a.lo(), &*a.hi(), &*b.lo(), &*b.hi()]) } else { Interval::undefined(p) }
}

fn add(a: &Interval, b: &Interval) -> Interval {
    let sum = |p: u32, [lo, hi, other_lo, other_hi]: [&Float; 4]| {
        Interval::new(rounded(p, lo + other_lo, Round::Down), rounded(p, hi + other_hi, Round::Up))
    };
    by_doubles(a, b, doubles::sum, 1).unwrap_or_else(|| by_floats(a, b, sum))
}

fn sub(a: &Interval, b: &Interval) -> Interval {
    let difference = |p: u32, [lo, hi, other_lo, other_hi]: [&Float; 4]| {
        Interval::new(rounded(p, lo - other_hi, Round::Down), rounded(p, hi - other_lo, Round::Up))
    };
    by_doubles(a, b, |a, b| doubles::sum(a, doubles::opposite(b)), 1).unwrap_or_else(|| by_floats(a, b, difference))
}

fn mul(a: &Interval, b: &Interval) -> Interval {
    by_doubles(a, b, doubles::product, 2).unwrap_or_else(|| by_floats(a, b, |p, ends| product(p, a, b, ends)))
}

impl Interval {
    /// It, and the sum of the products of pairs, in which 0 counts for nothing.
    pub fn plus_products<'i>(&self, pairs: impl Iterator<Item = (&'i Interval, &'i Interval)> + Clone) -> Interval {
        let steps = 3 * pairs.clone().count() as u64;
        let short = doubles::sum_of_products(pairs.clone().map(|(a, b)| Some([a.short()?, b.short()?])));
        match Interval::near(short, steps) {
            Some(sum) => self + sum,
            None => pairs.filter(|(a, _)| !a.is_zero()).fold(self.clone(), |sum, (a, b)| sum + a * b),
        }
    }
}

fn product(p: u32, a: &Interval, b: &Interval, [a_lo, a_hi, b_lo, b_hi]: [&Float; 4]) -> Interval {
    if !a.is_defined() || !b.is_defined() {
        return Interval::undefined(p);
    }
    // An infinite end is a bound of finite numbers, so 0 times it is 0.
    let product = |x: &Float, y: &Float, round| {
        if x.is_zero() || y.is_zero() { Float::new(p) } else { rounded(p, x * y, round) }
    };
    let between =
        |[x, y]: [&Float; 2], [z, w]: [&Float; 2]| Interval::new(product(x, y, Round::Down), product(z, w, Round::Up));
    // The sign of each factor says which ends make the extremes: + where it is nonnegative, - where it is nonpositive.
    match (Sign::of(a), Sign::of(b)) {
        (Sign::Plus, Sign::Plus) => between([a_lo, b_lo], [a_hi, b_hi]),
        (Sign::Plus, Sign::Minus) => between([a_hi, b_lo], [a_lo, b_hi]),
        (Sign::Plus, Sign::Both) => between([a_hi, b_lo], [a_hi, b_hi]),
        (Sign::Minus, Sign::Plus) => between([a_lo, b_hi], [a_hi, b_lo]),
        (Sign::Minus, Sign::Minus) => between([a_hi, b_hi], [a_lo, b_lo]),
        (Sign::Minus, Sign::Both) => between([a_lo, b_hi], [a_lo, b_lo]),
        (Sign::Both, Sign::Plus) => between([a_lo, b_hi], [a_hi, b_hi]),
        (Sign::Both, Sign::Minus) => between([a_hi, b_lo], [a_lo, b_lo]),
        (Sign::Both, Sign::Both) => between([a_lo, b_hi], [a_lo, b_lo]).hull(&between([a_hi, b_lo], [a_hi, b_hi])),
    }
}

/// Which signs the numbers of an interval have.
enum Sign {
    Plus,
    Minus,
    Both,
}

impl Sign {
    fn of(x: &Interval) -> Sign {
        match (x.is_nonnegative(), x.is_nonpositive()) {
            (true, _) => Sign::Plus,
            (_, true) => Sign::Minus,
            _ => Sign::Both,
        }
    }
}

fn div(a: &Interval, b: &Interval) -> Interval {
    by_doubles(a, b, doubles::quotient, 2).unwrap_or_else(|| by_floats(a, b, |p, _| quotient(p, a, b)))
}

fn quotient(p: u32, a: &Interval, b: &Interval) -> Interval {
    if !b.is_positive() {
        // Undefined where the divisor may be 0.
        return if b.is_negative() { quotient(p, &-a, &-b) } else { Interval::undefined(p) };
    }
    let quotient = |x: &Float, y: &Float, round| {
        let mut value = rounded(p, x, round);
        value.div_assign_round(y, round);
        value
    };
    let (lo, hi, least, most) = (a.lo(), a.hi(), b.lo(), b.hi());
    let low = if *lo < 0 { &least } else { &most };
    let high = if *hi < 0 { &most } else { &least };
    Interval::new(quotient(&lo, low, Round::Down), quotient(&hi, high, Round::Up))
}

impl Neg for &Interval {
    type Output = Interval;
    fn neg(self) -> Interval {
        match &self.0 {
            Ends::Short(ends) => Interval(Ends::Short(doubles::opposite(*ends))),
            Ends::Long(lo, hi) => {
                Interval(Ends::Long(Float::with_val(hi.prec(), -hi), Float::with_val(lo.prec(), -lo)))
            }
        }
    }
}

impl Neg for Interval {
    type Output = Interval;
    fn neg(self) -> Interval {
        -&self
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident, $function:ident) => {
        operator!(@ $trait $method $function; Interval, Interval; Interval, &Interval; &Interval, Interval; &Interval, &Interval);
        impl $trait<i64> for &Interval {
            type Output = Interval;
            fn $method(self, other: i64) -> Interval {
                $function(self, &Interval::int(other, self.precision()))
            }
        }
        impl $trait<i64> for Interval {
            type Output = Interval;
            fn $method(self, other: i64) -> Interval {
                $trait::$method(&self, other)
            }
        }
        impl $trait<&Interval> for i64 {
            type Output = Interval;
            fn $method(self, other: &Interval) -> Interval {
                $function(&Interval::int(self, other.precision()), other)
            }
        }
        impl $trait<Interval> for i64 {
            type Output = Interval;
            fn $method(self, other: Interval) -> Interval {
                $trait::$method(self, &other)
            }
        }
    };
    (@ $trait:ident $method:ident $function:ident; $($left:ty, $right:ty);*) => {
        $(impl $trait<$right> for $left {
            type Output = Interval;
            #[allow(clippy::needless_borrow, reason = "one text for values and references")]
            fn $method(self, other: $right) -> Interval {
                $function(&self, &other)
            }
        })*
    };
}

operator!(Add, add, add);
operator!(Sub, sub, sub);
operator!(Mul, mul, mul);
operator!(Div, div, div);
