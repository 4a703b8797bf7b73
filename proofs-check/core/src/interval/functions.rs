//! Elementary functions of intervals: by MPFR's correctly rounded values at the ends, and at extremes between them.

use super::{Interval, doubles, rounded};
use crate::effort;
use rug::float::{Round, Special};
use rug::ops::Pow;
use rug::{Float, Rational};
use std::cmp::Ordering;

/// The largest exponent of a power that is multiplied out in doubles.
const SHORT_POWER: i32 = 8;

/// The largest exponent, times four, of a power that is taken by square roots and an integer power.
const LARGEST_QUARTERS: f64 = 32.0;

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
    ///
    /// | y                                                | how                                              |
    /// |--------------------------------------------------|--------------------------------------------------|
    /// | n, n/2 or n/4 up to 8, with no more bits than x  | x^n, sqrt(x)^n or sqrt(sqrt(x))^n: x is not < 0  |
    /// | another number below 0                           | from hi^y to lo^y                                |
    /// | another number                                   | from lo^y to hi^y                                |
    /// | an interval                                      | the hull of the four corners                     |
    pub fn pow(&self, exponent: &Interval) -> Interval {
        let p = self.precision().max(exponent.precision());
        let defined = self.is_positive() || (self.is_nonnegative() && exponent.is_positive());
        if !defined || !self.is_bounded() || !exponent.is_bounded() {
            return Interval::undefined(p);
        }
        // What is multiplied is no less precise than what is asked for.
        if let Some((root, n)) = exponent.as_quarters().filter(|_| self.precision() >= exponent.precision()) {
            let base = (0..root).fold(self.clone(), |base, _| base.sqrt());
            return base.powi(n);
        }
        let end = |x: &Float, y: &Float, round: Round| rounded(p, Pow::pow(x, y), round);
        let (lo, hi, at_lo, at_hi) = (self.lo(), self.hi(), exponent.lo(), exponent.hi());
        if exponent.is_point() {
            let falls = exponent.is_negative();
            let (least, largest) = if falls { (&hi, &lo) } else { (&lo, &hi) };
            return match effort::elementary(p) && effort::elementary(p) {
                true => Interval::new(end(least, &at_lo, Round::Down), end(largest, &at_lo, Round::Up)),
                false => Interval::undefined(p),
            };
        }
        // Four corners, each rounded both ways.
        if !(0..4).all(|_| effort::elementary(p)) {
            return Interval::undefined(p);
        }
        let corner = |x: &Float, y: &Float| Interval::new(end(x, y, Round::Down), end(x, y, Round::Up));
        let left = corner(&lo, &at_lo).hull(&corner(&lo, &at_hi));
        left.hull(&corner(&hi, &at_lo)).hull(&corner(&hi, &at_hi))
    }

    /// The number as `n/2^root` with root 0, 1 or 2, where it is one, and n is not large.
    fn as_quarters(&self) -> Option<(u32, i32)> {
        let value = self.lo().to_f64();
        let quarters = 4.0 * value;
        // The end itself, and not what a double makes of it.
        if !self.is_point() || *self.lo() != value || quarters.fract() != 0.0 || quarters.abs() > LARGEST_QUARTERS {
            return None;
        }
        let mut n = quarters as i32;
        let mut root = 2;
        while root > 0 && n % 2 == 0 {
            (root, n) = (root - 1, n / 2);
        }
        Some((root, n))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rug::Rational;

    /// An interval with these ends.
    fn between(lo: f64, hi: f64, precision: u32) -> Interval {
        let end = |value: f64| Interval::point(&Float::with_val(precision, value));
        end(lo).hull(&end(hi))
    }

    /// The values at the corners, at 300 bits, lie in the interval, and it has little room beside them.
    #[test]
    fn powers_enclose_their_values_and_little_besides() {
        let bases = [[0.3, 0.3], [0.3, 0.75], [1.0, 1.0], [0.9, 1.2], [2.0, 1e6], [1e-9, 3.0]];
        let exponents =
            [-8.0, -1.75, -1.5, -1.0, -0.25, 0.0, 0.25, 0.5, 0.75, 1.0, 2.0, 2.25, 3.5, 7.75, 0.3, -2.2, 9.125];
        for precision in [53, 96, 200] {
            for [lo, hi] in bases {
                for y in exponents {
                    let found = between(lo, hi, precision).pow(&between(y, y, precision));
                    let value =
                        |x: f64| Float::with_val(300, Pow::pow(Float::with_val(300, x), Float::with_val(300, y)));
                    let [least, largest] = if y < 0.0 { [value(hi), value(lo)] } else { [value(lo), value(hi)] };
                    assert!(*found.lo() <= least && largest <= *found.hi(), "{lo}..{hi} ^ {y} at {precision}");
                    let room = |end: &Float, value: &Float| Float::with_val(300, end - value).abs() / value;
                    let few = Float::with_val(300, 1) >> (precision as i32 - 8);
                    assert!(room(&found.lo(), &least) <= few, "{lo}..{hi} ^ {y} at {precision}: {found:?}");
                    assert!(room(&found.hi(), &largest) <= few, "{lo}..{hi} ^ {y} at {precision}: {found:?}");
                }
                // An interval of exponents has the corners of both.
                let all = between(lo, hi, precision).pow(&between(-0.5, 2.25, precision));
                for (x, y) in [(lo, -0.5), (lo, 2.25), (hi, -0.5), (hi, 2.25)] {
                    let value = Float::with_val(300, Pow::pow(Float::with_val(300, x), Float::with_val(300, y)));
                    assert!(*all.lo() <= value && value <= *all.hi(), "{x}^{y}");
                }
            }
        }
    }

    #[test]
    fn powers_of_what_may_be_negative_or_0() {
        let zero = Interval::int(0, 53);
        let unit = between(0.0, 1.0, 53);
        assert!(zero.pow(&between(0.25, 0.25, 53)).is_zero() && zero.pow(&between(0.3, 0.3, 53)).is_zero());
        let root = unit.pow(&between(0.5, 0.5, 53));
        assert!(*root.lo() == 0 && *root.hi() == 1, "{root:?}");
        for y in [-1.75, -0.3, 0.0] {
            assert!(!unit.pow(&between(y, y, 53)).is_defined(), "{y}");
        }
        for y in [-1.0, 0.25, 0.3, 1.0, 2.0] {
            assert!(!between(-1e-300, 1.0, 53).pow(&between(y, y, 53)).is_defined(), "{y}");
        }
    }

    /// A number with more bits than a double has is not taken for a quarter; one of more bits than the base has does not lose its bits.
    #[test]
    fn quarters_are_those_alone() {
        let near =
            Interval::rational(&Rational::from((1, 4)), 200) + Interval::point(&(Float::with_val(200, 1) >> 150));
        assert_eq!(near.as_quarters(), None);
        for (value, expected) in [(0.25, Some((2, 1))), (-1.5, Some((1, -3))), (8.0, Some((0, 8))), (0.0, Some((0, 0)))]
        {
            assert_eq!(between(value, value, 53).as_quarters(), expected);
        }
        for value in [8.25, -9.0, 0.125, 0.3, f64::INFINITY] {
            assert_eq!(between(value, value, 53).as_quarters(), None, "{value}");
        }
        assert_eq!(between(0.25, 0.5, 53).as_quarters(), None);
        let found = between(2.0, 2.0, 53).pow(&between(0.5, 0.5, 200));
        let exact = Float::with_val(300, 2).sqrt();
        assert!(*found.lo() <= exact && exact <= *found.hi() && found.precision() == 200);
        assert!(Float::with_val(300, &*found.hi() - &*found.lo()) < 1e-50);
    }
}
