//! Intervals with MPFR ends, rounded outward.
//!
//! An interval contains the true value, or is *undefined* (both ends NaN): then nothing is known, and nothing that is
//! computed from it decides anything. What must be believed here: which end is rounded which way.

use crate::effort;
use rug::float::{Constant, Round, Special};
use rug::ops::{DivAssignRound, Pow};
use rug::{Float, Rational};
use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A closed interval of reals; an infinite end is a bound, never a member.
#[derive(Clone, Debug)]
pub struct Interval {
    lo: Float,
    hi: Float,
}

fn rounded<T>(precision: u32, value: T, round: Round) -> Float
where
    Float: rug::ops::AssignRound<T, Round = Round, Ordering = Ordering>,
{
    Float::with_val_round(precision, value, round).0
}

/// One of MPFR's correctly rounded functions.
fn by(f: fn(&mut Float, Round) -> Ordering) -> impl Fn(Float, Round) -> Float {
    move |mut x, round| {
        f(&mut x, round);
        x
    }
}

/// The largest binary exponent, in magnitude, of a number from which a rational is formed.
const MAX_RATIONAL: i32 = 1 << 20;

/// The value as a rational; `None` for what is not finite, or would fill the memory.
fn exactly(x: &Float) -> Option<Rational> {
    let moderate = x.get_exp().is_none_or(|exponent| exponent.abs() <= MAX_RATIONAL);
    if moderate { x.to_rational() } else { None }
}

/// The smaller of two ends, with all its bits. (`Float::min` would round it to the precision of the first.)
fn lesser<'a>(a: &'a Float, b: &'a Float) -> &'a Float {
    if b < a { b } else { a }
}

/// The larger of two ends, with all its bits.
fn greater<'a>(a: &'a Float, b: &'a Float) -> &'a Float {
    if b > a { b } else { a }
}

/// A rational number rounded up.
pub fn above(value: &Rational, precision: u32) -> Float {
    Interval::rational(value, precision).hi().clone()
}

impl Interval {
    /// The interval between two ends; undefined if they are not in order.
    pub fn new(lo: Float, hi: Float) -> Interval {
        if lo <= hi { Interval { lo, hi } } else { Interval::undefined(hi.prec()) }
    }

    /// One number.
    pub fn point(value: &Float) -> Interval {
        Interval::new(value.clone(), value.clone())
    }

    /// 1 or -1, where the sign is certain.
    pub fn sign(&self) -> Interval {
        match (self.is_positive(), (-self).is_positive()) {
            (true, _) => Interval::int(1, self.precision()),
            (_, true) => Interval::int(-1, self.precision()),
            _ => Interval::undefined(self.precision()),
        }
    }

    /// Nothing known.
    pub fn undefined(precision: u32) -> Interval {
        let nan = || Float::with_val(precision, Special::Nan);
        Interval { lo: nan(), hi: nan() }
    }

    /// The real line.
    pub fn entire(precision: u32) -> Interval {
        let end = |special| Float::with_val(precision, special);
        Interval { lo: end(Special::NegInfinity), hi: end(Special::Infinity) }
    }

    /// A rational number.
    pub fn rational(value: &Rational, precision: u32) -> Interval {
        Interval::between(value, value, precision)
    }

    /// All numbers from `lo` to `hi`.
    pub fn between(lo: &Rational, hi: &Rational, precision: u32) -> Interval {
        Interval::new(rounded(precision, lo, Round::Down), rounded(precision, hi, Round::Up))
    }

    /// A decimal numeral of at most a thousand characters, whatever its exponent; `None` if it is none.
    pub fn decimal(text: &str, precision: u32) -> Option<Interval> {
        let plain = |b: u8| b.is_ascii_digit() || matches!(b, b'.' | b'-' | b'+' | b'e' | b'E');
        let begins = text.trim_start_matches('-').starts_with(|c: char| c.is_ascii_digit());
        if text.len() > 1000 || !begins || !text.bytes().all(plain) {
            return None;
        }
        let end = |round| Some(Float::with_val_round(precision, Float::parse(text).ok()?, round).0);
        Some(Interval::new(end(Round::Down)?, end(Round::Up)?))
    }

    /// An integer.
    pub fn int(value: i64, precision: u32) -> Interval {
        Interval::new(rounded(precision, value, Round::Down), rounded(precision, value, Round::Up))
    }

    /// The number pi.
    pub fn pi(precision: u32) -> Interval {
        Interval::new(rounded(precision, Constant::Pi, Round::Down), rounded(precision, Constant::Pi, Round::Up))
    }

    /// The precision of the ends, in bits.
    pub fn precision(&self) -> u32 {
        self.lo.prec().max(self.hi.prec())
    }

    /// Whether anything is known.
    pub fn is_defined(&self) -> bool {
        !self.lo.is_nan() && !self.hi.is_nan()
    }

    /// Whether both ends are finite.
    pub fn is_bounded(&self) -> bool {
        self.lo.is_finite() && self.hi.is_finite()
    }

    /// The lower end.
    pub fn lo(&self) -> &Float {
        &self.lo
    }

    /// The upper end.
    pub fn hi(&self) -> &Float {
        &self.hi
    }

    /// The upper end as an exact rational, if it is finite and of moderate size.
    pub fn upper(&self) -> Option<Rational> {
        exactly(&self.hi)
    }

    /// The lower end as an exact rational, if it is finite and of moderate size.
    pub fn lower(&self) -> Option<Rational> {
        exactly(&self.lo)
    }

    /// The upper end alone, for values of which only an upper bound is meant.
    pub fn ceiling(&self) -> Interval {
        Interval { lo: self.hi.clone(), hi: self.hi.clone() }
    }

    /// The same with ends of fewer bits.
    pub fn round(&self, precision: u32) -> Interval {
        Interval::new(rounded(precision, &self.lo, Round::Down), rounded(precision, &self.hi, Round::Up))
    }

    /// `self < other`: certain, certainly not, or unknown.
    ///
    /// | ends                                        | answer        |
    /// |---------------------------------------------|---------------|
    /// | self.hi < other.lo, both finite             | certain       |
    /// | self.lo >= other.hi, both finite            | certainly not |
    /// | one of these infinite: it has no members    | unknown       |
    /// | anything else, or undefined                 | unknown       |
    pub fn lt(&self, other: &Interval) -> Option<bool> {
        let finite = |a: &Float, b: &Float| a.is_finite() && b.is_finite();
        if self.hi < other.lo && finite(&self.hi, &other.lo) {
            Some(true)
        } else if self.lo >= other.hi && finite(&self.lo, &other.hi) {
            Some(false)
        } else {
            None
        }
    }

    /// `self <= other`: certain, certainly not, or unknown.
    pub fn le(&self, other: &Interval) -> Option<bool> {
        other.lt(self).map(|less| !less)
    }

    /// Certainly > 0.
    pub fn is_positive(&self) -> bool {
        self.lo > 0
    }

    /// Certainly >= 0.
    pub fn is_nonnegative(&self) -> bool {
        self.lo >= 0
    }

    /// Certainly <= 0.
    pub fn is_nonpositive(&self) -> bool {
        self.hi <= 0
    }

    /// Exactly 0.
    pub fn is_zero(&self) -> bool {
        self.lo.is_zero() && self.hi.is_zero()
    }

    /// A single number.
    pub fn is_point(&self) -> bool {
        self.lo == self.hi
    }

    /// The smallest interval that contains both.
    pub fn hull(&self, other: &Interval) -> Interval {
        if !self.is_defined() || !other.is_defined() {
            return Interval::undefined(self.precision());
        }
        Interval { lo: lesser(&self.lo, &other.lo).clone(), hi: greater(&self.hi, &other.hi).clone() }
    }

    /// What both contain; undefined if that is nothing.
    pub fn intersect(&self, other: &Interval) -> Interval {
        if !self.is_defined() || !other.is_defined() {
            return Interval::undefined(self.precision());
        }
        Interval::new(greater(&self.lo, &other.lo).clone(), lesser(&self.hi, &other.hi).clone())
    }

    /// The smaller of two numbers.
    pub fn min(&self, other: &Interval) -> Interval {
        if !self.is_defined() || !other.is_defined() {
            return Interval::undefined(self.precision());
        }
        Interval { lo: lesser(&self.lo, &other.lo).clone(), hi: lesser(&self.hi, &other.hi).clone() }
    }

    /// The larger of two numbers.
    pub fn max(&self, other: &Interval) -> Interval {
        -&(-self).min(&-other)
    }

    /// The smaller of two upper bounds of the same thing, of which one need not be known.
    pub fn least(&self, other: &Interval) -> Interval {
        match (self.is_defined(), other.is_defined()) {
            (false, true) => other.clone(),
            (true, false) => self.clone(),
            _ => self.min(other),
        }
    }

    /// The larger of two lower bounds of the same thing, of which one need not be known.
    pub fn greatest(&self, other: &Interval) -> Interval {
        -&(-self).least(&-other)
    }

    /// |x|.
    pub fn abs(&self) -> Interval {
        let zero = Interval::int(0, self.precision());
        if self.is_defined() { self.max(&-self).max(&zero) } else { self.clone() }
    }

    /// A function that increases on the interval, by its correctly rounded values at the ends.
    fn increasing(&self, f: impl Fn(Float, Round) -> Float) -> Interval {
        if effort::elementary(self.precision()) { self.rising(f) } else { Interval::undefined(self.precision()) }
    }

    /// The same for a function that decreases.
    fn decreasing(&self, f: impl Fn(Float, Round) -> Float) -> Interval {
        if !effort::elementary(self.precision()) {
            return Interval::undefined(self.precision());
        }
        Interval::new(f(self.hi.clone(), Round::Down), f(self.lo.clone(), Round::Up))
    }

    /// [`Interval::increasing`] for functions that cost no more than a product.
    fn cheaply_increasing(&self, f: impl Fn(Float, Round) -> Float) -> Interval {
        if effort::arithmetic(self.precision()) { self.rising(f) } else { Interval::undefined(self.precision()) }
    }

    fn rising(&self, f: impl Fn(Float, Round) -> Float) -> Interval {
        Interval::new(f(self.lo.clone(), Round::Down), f(self.hi.clone(), Round::Up))
    }

    /// x^2.
    pub fn sqr(&self) -> Interval {
        self.abs().cheaply_increasing(by(Float::square_round))
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
        self.cheaply_increasing(by(Float::sqrt_round))
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
        if self.lo > 1 && self.is_bounded() && effort::zeta(self.precision()) {
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
        let (first, last) = (q.lo.clone().floor(), q.hi.clone().floor());
        let near = |x: &Float| x.clone().abs() <= 1u64 << 32;
        if !near(&self.lo) || !near(&self.hi) || last.clone() - &first > 1 {
            return all;
        }
        let at = |end: &Float| Interval { lo: end.clone(), hi: end.clone() }.increasing(by(f));
        let ends = at(&self.lo).hull(&at(&self.hi));
        let odd = last.to_integer().is_none_or(|m| m.is_odd());
        match first == last {
            true => ends,
            false => ends.hull(&Interval::int(if odd { -1 } else { 1 }, p)),
        }
    }

    /// tan x; undefined where cos x may be 0.
    pub fn tan(&self) -> Interval {
        let cos = self.cos();
        if !cos.is_positive() && !(-&cos).is_positive() {
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
        base.increasing(|x, round| rounded(x.prec(), Pow::pow(&x, n), round))
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
        let (at_lo, at_hi) = (&exponent.lo, &exponent.hi);
        let left = corner(&self.lo, at_lo).hull(&corner(&self.lo, at_hi));
        left.hull(&corner(&self.hi, at_lo)).hull(&corner(&self.hi, at_hi))
    }
}

fn add(a: &Interval, b: &Interval) -> Interval {
    let p = a.precision().max(b.precision());
    if !effort::arithmetic(p) {
        return Interval::undefined(p);
    }
    Interval::new(rounded(p, &a.lo + &b.lo, Round::Down), rounded(p, &a.hi + &b.hi, Round::Up))
}

fn sub(a: &Interval, b: &Interval) -> Interval {
    let p = a.precision().max(b.precision());
    if !effort::arithmetic(p) {
        return Interval::undefined(p);
    }
    Interval::new(rounded(p, &a.lo - &b.hi, Round::Down), rounded(p, &a.hi - &b.lo, Round::Up))
}

fn mul(a: &Interval, b: &Interval) -> Interval {
    let p = a.precision().max(b.precision());
    if !effort::arithmetic(p) {
        return Interval::undefined(p);
    }
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
        (Sign::Plus, Sign::Plus) => between([&a.lo, &b.lo], [&a.hi, &b.hi]),
        (Sign::Plus, Sign::Minus) => between([&a.hi, &b.lo], [&a.lo, &b.hi]),
        (Sign::Plus, Sign::Both) => between([&a.hi, &b.lo], [&a.hi, &b.hi]),
        (Sign::Minus, Sign::Plus) => between([&a.lo, &b.hi], [&a.hi, &b.lo]),
        (Sign::Minus, Sign::Minus) => between([&a.hi, &b.hi], [&a.lo, &b.lo]),
        (Sign::Minus, Sign::Both) => between([&a.lo, &b.hi], [&a.lo, &b.lo]),
        (Sign::Both, Sign::Plus) => between([&a.lo, &b.hi], [&a.hi, &b.hi]),
        (Sign::Both, Sign::Minus) => between([&a.hi, &b.lo], [&a.lo, &b.lo]),
        (Sign::Both, Sign::Both) => {
            between([&a.lo, &b.hi], [&a.lo, &b.lo]).hull(&between([&a.hi, &b.lo], [&a.hi, &b.hi]))
        }
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
    let p = a.precision().max(b.precision());
    if !effort::arithmetic(p) {
        return Interval::undefined(p);
    }
    if !b.is_positive() {
        // Undefined where the divisor may be 0.
        return if b.hi < 0 { div(&-a, &-b) } else { Interval::undefined(p) };
    }
    let quotient = |x: &Float, y: &Float, round| {
        let mut value = rounded(p, x, round);
        value.div_assign_round(y, round);
        value
    };
    let low = if a.lo < 0 { &b.lo } else { &b.hi };
    let high = if a.hi < 0 { &b.hi } else { &b.lo };
    Interval::new(quotient(&a.lo, low, Round::Down), quotient(&a.hi, high, Round::Up))
}

impl Neg for &Interval {
    type Output = Interval;
    fn neg(self) -> Interval {
        Interval { lo: Float::with_val(self.hi.prec(), -&self.hi), hi: Float::with_val(self.lo.prec(), -&self.lo) }
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
