//! Elementary functions of intervals: by MPFR's correctly rounded values at the ends, and at extremes between them.

use super::{Interval, doubles, rounded};
use crate::effort;
use rug::float::{Round, Special};
use rug::ops::Pow;
use rug::{Float, Rational};
use std::cmp::Ordering;

/// The largest exponent of a power that is multiplied out in doubles.
const SHORT_POWER: i32 = 8;

/// One of MPFR's correctly rounded functions.
fn by(f: fn(&mut Float, Round) -> Ordering) -> impl Fn(Float, Round) -> Float {
    move |mut x, round| {
        f(&mut x, round);
        x
    }
}

impl Interval {
    /// x^n, n > 0, of doubles, where it increases.
    fn short_power(&self, n: i32) -> Option<Interval> {
        let ends = self.short().filter(|_| (1..=SHORT_POWER).contains(&n)).and_then(|ends| doubles::power(ends, n));
        // Products for each end.
        Interval::near(ends, 4 * u64::from(n.unsigned_abs() - 1))
    }

    /// A function that increases on the interval, by its correctly rounded values at the ends.
    fn increasing(&self, f: impl Fn(Float, Round) -> Float) -> Interval {
        if effort::elementary(self.precision()) { self.rising(f) } else { Interval::undefined(self.precision()) }
    }

    /// A function that decreases on the interval, by its correctly rounded values at the ends.
    fn decreasing(&self, f: impl Fn(Float, Round) -> Float) -> Interval {
        if !effort::elementary(self.precision()) {
            return Interval::undefined(self.precision());
        }
        Interval::new(f(self.hi().into_owned(), Round::Down), f(self.lo().into_owned(), Round::Up))
    }

    /// [`Interval::increasing`] for functions that cost no more than a product.
    fn cheaply_increasing(&self, f: impl Fn(Float, Round) -> Float) -> Interval {
        if effort::arithmetic(self.precision()) { self.rising(f) } else { Interval::undefined(self.precision()) }
    }

    fn rising(&self, f: impl Fn(Float, Round) -> Float) -> Interval {
        Interval::new(f(self.lo().into_owned(), Round::Down), f(self.hi().into_owned(), Round::Up))
    }

    /// x^2.
    pub fn sqr(&self) -> Interval {
        let size = self.abs();
        size.short_power(2).unwrap_or_else(|| size.cheaply_increasing(by(Float::square_round)))
    }

    /// e^x. Beyond 2^32 in magnitude the ends are moved outward, so that nothing enormous is evaluated.
    pub fn exp(&self) -> Interval {
        self.increasing(|mut x, round| {
            let far = Float::with_val(x.prec(), 1u64 << 32);
            if x > far && round == Round::Up {
                return Float::with_val(x.prec(), Special::Infinity);
            }
            if Float::with_val(x.prec(), -&x) > far && round == Round::Down {
                return Float::new(x.prec());
            }
            x = if x > far { far } else { x };
            x = if x < -(1i64 << 32) { Float::with_val(x.prec(), -(1i64 << 32)) } else { x };
            x.exp_round(round);
            x
        })
    }

    /// The natural logarithm; undefined where the number may not be positive.
    pub fn log(&self) -> Interval {
        if self.is_positive() { self.increasing(by(Float::ln_round)) } else { Interval::undefined(self.precision()) }
    }

    /// The square root; undefined where the number may be negative.
    pub fn sqrt(&self) -> Interval {
        let near = self.short().filter(|_| self.is_nonnegative()).and_then(doubles::root);
        Interval::near(near, 2).unwrap_or_else(|| self.cheaply_increasing(by(Float::sqrt_round)))
    }

    /// arctan x.
    pub fn atan(&self) -> Interval {
        self.increasing(by(Float::atan_round))
    }

    /// tanh x.
    pub fn tanh(&self) -> Interval {
        self.increasing(by(Float::tanh_round))
    }

    /// coth x for x > 0, where it decreases; undefined otherwise.
    pub fn coth(&self) -> Interval {
        if self.is_positive() { self.decreasing(by(Float::coth_round)) } else { Interval::undefined(self.precision()) }
    }

    /// The Riemann zeta function for s > 1, where it decreases; undefined otherwise.
    pub fn zeta(&self) -> Interval {
        if *self.lo() > 1 && self.is_bounded() && effort::zeta(self.precision()) {
            self.decreasing(by(Float::zeta_round))
        } else {
            Interval::undefined(self.precision())
        }
    }

    /// cos x = cos(pi q) with q = x/pi: by its values at the ends, and the extremes between them.
    pub fn cos(&self) -> Interval {
        self.wave(Float::cos_round, self / &Interval::pi(self.precision()))
    }

    /// sin x = cos(pi q) with q = x/pi - 1/2, in the same way.
    pub fn sin(&self) -> Interval {
        let p = self.precision();
        let half = Interval::rational(&Rational::from((1, 2)), p);
        self.wave(Float::sin_round, self / &Interval::pi(p) - half)
    }

    /// f(x) = cos(pi q), which has its extremes (-1)^m at the integers q = m.
    ///
    /// | integers m that q may pass | enclosure                                    |
    /// |----------------------------|----------------------------------------------|
    /// | none: floors of q agree    | from one end's value to the other's          |
    /// | one, m                     | the same, and (-1)^m                         |
    /// | more, or x beyond 2^32     | [-1, 1] (enormous arguments are not reduced) |
    fn wave(&self, f: fn(&mut Float, Round) -> Ordering, q: Interval) -> Interval {
        let p = self.precision();
        let all = Interval::int(-1, p).hull(&Interval::int(1, p));
        if !self.is_defined() || !q.is_defined() {
            return Interval::undefined(p);
        }
        let (first, last) = (q.lo().into_owned().floor(), q.hi().into_owned().floor());
        let near = |x: &Float| x.clone().abs() <= 1u64 << 32;
        if !near(&self.lo()) || !near(&self.hi()) || last.clone() - &first > 1 {
            return all;
        }
        let at = |end: &Float| Interval::point(end).increasing(by(f));
        let ends = at(&self.lo()).hull(&at(&self.hi()));
        let odd = last.to_integer().is_none_or(|m| m.is_odd());
        match first == last {
            true => ends,
            false => ends.hull(&Interval::int(if odd { -1 } else { 1 }, p)),
        }
    }

    /// tan x; undefined where cos x may be 0.
    pub fn tan(&self) -> Interval {
        let cos = self.cos();
        if !cos.is_positive() && !cos.is_negative() {
            return Interval::undefined(self.precision());
        }
        self.increasing(by(Float::tan_round))
    }

    /// 1/x; undefined where x may be 0.
    pub fn recip(&self) -> Interval {
        Interval::int(1, self.precision()) / self
    }

    /// x^n for an integer n; undefined for n < 0 where x may be 0.
    pub fn powi(&self, n: i32) -> Interval {
        if n < 0 {
            return self.powi(-n).recip();
        }
        if !self.is_defined() {
            return self.clone();
        }
        if n == 0 {
            return Interval::int(1, self.precision());
        }
        let base = if n % 2 == 0 { self.abs() } else { self.clone() };
        let by_mpfr = || base.increasing(|x, round| rounded(x.prec(), Pow::pow(&x, n), round));
        base.short_power(n).unwrap_or_else(by_mpfr)
    }

    /// x^y for x > 0, or for x >= 0 and y > 0; undefined otherwise. x^y is monotone in x and in y, so its extremes are
    /// at corners.
    pub fn pow(&self, exponent: &Interval) -> Interval {
        let p = self.precision().max(exponent.precision());
        let defined = self.is_positive() || (self.is_nonnegative() && exponent.is_positive());
        // Four corners, each rounded both ways.
        let paid = (0..4).all(|_| effort::elementary(p));
        if !paid || !defined || !self.is_bounded() || !exponent.is_bounded() {
            return Interval::undefined(p);
        }
        let corner = |x: &Float, y: &Float| {
            Interval::new(rounded(p, Pow::pow(x, y), Round::Down), rounded(p, Pow::pow(x, y), Round::Up))
        };
        let (lo, hi, at_lo, at_hi) = (self.lo(), self.hi(), exponent.lo(), exponent.hi());
        let left = corner(&lo, &at_lo).hull(&corner(&lo, &at_hi));
        left.hull(&corner(&hi, &at_lo)).hull(&corner(&hi, &at_hi))
    }
}
