//! Intervals with MPFR ends, or with doubles at 53 bits, rounded outward.
//!
//! An interval contains the true value, or is *undefined* (both ends NaN): then nothing is known, and nothing that is
//! computed from it decides anything. What must be believed here: which end is rounded which way.

mod doubles;

use crate::effort;
use rug::float::{Constant, Round, Special};
use rug::ops::{DivAssignRound, Pow};
use rug::{Float, Rational};
use std::borrow::Cow;
use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A closed interval of reals; an infinite end is a bound, never a member.
#[derive(Clone, Debug)]
pub struct Interval(Ends);

#[derive(Clone, Debug)]
enum Ends {
    /// Both have 53 bits.
    Short(doubles::Ends),
    Long(Float, Float),
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

/// The largest exponent of a power that is multiplied out in doubles.
const SHORT_POWER: i32 = 8;

/// The largest binary exponent, in magnitude, of a number from which a rational is formed.
const MAX_RATIONAL: i32 = 1 << 20;

/// The value as a rational; `None` for what is not finite, or would fill the memory.
fn exactly(x: &Float) -> Option<Rational> {
    let moderate = x.get_exp().is_none_or(|exponent| exponent.abs() <= MAX_RATIONAL);
    if moderate { x.to_rational() } else { None }
}

/// One of two ends, with all its bits. (`Float::min` would round it to the precision of the first.)
#[derive(Clone, Copy)]
enum Which {
    Lesser,
    Greater,
}

impl Which {
    fn of<T: PartialOrd>(self, a: T, b: T) -> T {
        let other = match self {
            Which::Lesser => b < a,
            Which::Greater => b > a,
        };
        if other { b } else { a }
    }
}

/// A rational number rounded up.
pub fn above(value: &Rational, precision: u32) -> Float {
    Interval::rational(value, precision).hi().into_owned()
}

impl Interval {
    /// The interval between two ends; undefined if they are not in order.
    pub fn new(lo: Float, hi: Float) -> Interval {
        if lo > hi || lo.is_nan() || hi.is_nan() {
            return Interval::undefined(hi.prec());
        }
        Interval::of_ends(lo, hi)
    }

    /// Between two ends in order.
    fn of_ends(lo: Float, hi: Float) -> Interval {
        // What is too small or too large for a double is none.
        let exactly = |x: &Float| Some(x.to_f64()).filter(|double| x.prec() == doubles::BITS && x == double);
        let short = exactly(&lo).zip(exactly(&hi)).and_then(|(lo, hi)| doubles::ends(lo, hi));
        short.map_or_else(|| Interval(Ends::Long(lo, hi)), |ends| Interval(Ends::Short(ends)))
    }

    /// Both ends, where they are doubles.
    fn short(&self) -> Option<doubles::Ends> {
        match self.0 {
            Ends::Short(ends) => Some(ends),
            Ends::Long(..) => None,
        }
    }

    /// What was computed from doubles in so many steps, where these are paid for.
    fn near(ends: Option<doubles::Ends>, steps: u64) -> Option<Interval> {
        ends.filter(|_| effort::spend(steps)).map(|ends| Interval(Ends::Short(ends)))
    }

    /// x^n, n > 0, of doubles, where it increases.
    fn short_power(&self, n: i32) -> Option<Interval> {
        let ends = self.short().filter(|_| (1..=SHORT_POWER).contains(&n)).and_then(|ends| doubles::power(ends, n));
        // Products for each end.
        Interval::near(ends, 4 * u64::from(n.unsigned_abs() - 1))
    }

    /// One number.
    pub fn point(value: &Float) -> Interval {
        Interval::new(value.clone(), value.clone())
    }

    /// 1 or -1, where the sign is certain.
    pub fn sign(&self) -> Interval {
        match (self.is_positive(), self.is_negative()) {
            (true, _) => Interval::int(1, self.precision()),
            (_, true) => Interval::int(-1, self.precision()),
            _ => Interval::undefined(self.precision()),
        }
    }

    /// Nothing known.
    pub fn undefined(precision: u32) -> Interval {
        let nan = || Float::with_val(precision, Special::Nan);
        Interval(Ends::Long(nan(), nan()))
    }

    /// The real line.
    pub fn entire(precision: u32) -> Interval {
        let end = |special| Float::with_val(precision, special);
        Interval(Ends::Long(end(Special::NegInfinity), end(Special::Infinity)))
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
        if precision == doubles::BITS
            && let Ok(value) = i32::try_from(value)
        {
            return Interval(Ends::Short([f64::from(value); 2]));
        }
        Interval::new(rounded(precision, value, Round::Down), rounded(precision, value, Round::Up))
    }

    /// The number pi.
    pub fn pi(precision: u32) -> Interval {
        Interval::new(rounded(precision, Constant::Pi, Round::Down), rounded(precision, Constant::Pi, Round::Up))
    }

    /// The precision of the ends, in bits.
    pub fn precision(&self) -> u32 {
        match &self.0 {
            Ends::Short(_) => doubles::BITS,
            Ends::Long(lo, hi) => lo.prec().max(hi.prec()),
        }
    }

    /// Whether anything is known.
    pub fn is_defined(&self) -> bool {
        matches!(&self.0, Ends::Short(_)) || !self.lo().is_nan() && !self.hi().is_nan()
    }

    /// Whether both ends are finite.
    pub fn is_bounded(&self) -> bool {
        matches!(&self.0, Ends::Short(_)) || self.lo().is_finite() && self.hi().is_finite()
    }

    /// The lower end.
    pub fn lo(&self) -> Cow<'_, Float> {
        match &self.0 {
            Ends::Short([lo, _]) => Cow::Owned(Float::with_val(doubles::BITS, lo)),
            Ends::Long(lo, _) => Cow::Borrowed(lo),
        }
    }

    /// The upper end.
    pub fn hi(&self) -> Cow<'_, Float> {
        match &self.0 {
            Ends::Short([_, hi]) => Cow::Owned(Float::with_val(doubles::BITS, hi)),
            Ends::Long(_, hi) => Cow::Borrowed(hi),
        }
    }

    /// The upper end as an exact rational, if it is finite and of moderate size.
    pub fn upper(&self) -> Option<Rational> {
        exactly(&self.hi())
    }

    /// The lower end as an exact rational, if it is finite and of moderate size.
    pub fn lower(&self) -> Option<Rational> {
        exactly(&self.lo())
    }

    /// The upper end alone, for values of which only an upper bound is meant.
    pub fn ceiling(&self) -> Interval {
        match &self.0 {
            Ends::Short([_, hi]) => Interval(Ends::Short([*hi, *hi])),
            Ends::Long(_, hi) => Interval(Ends::Long(hi.clone(), hi.clone())),
        }
    }

    /// The lower end alone.
    pub fn floor(&self) -> Interval {
        match &self.0 {
            Ends::Short([lo, _]) => Interval(Ends::Short([*lo, *lo])),
            Ends::Long(lo, _) => Interval(Ends::Long(lo.clone(), lo.clone())),
        }
    }

    /// A number of it about half way between its ends; undefined where one is infinite.
    pub fn middle(&self) -> Interval {
        let short = self.short().and_then(|[lo, hi]| doubles::ends((lo + hi) / 2.0, (lo + hi) / 2.0));
        if let Some(ends) = short {
            return Interval(Ends::Short(ends));
        }
        let middle = Float::with_val(self.precision(), &*self.lo() + &*self.hi()) / 2u32;
        Interval::point(&middle)
    }

    /// That number in floating point, for what decides nothing.
    pub fn to_f64(&self) -> f64 {
        self.short().map_or_else(|| self.middle().lo().to_f64(), |[lo, hi]| (lo + hi) / 2.0)
    }

    /// What is below that number, and what is above it, with it.
    pub fn halves(&self) -> [Interval; 2] {
        let middle = self.middle();
        [self.floor().hull(&middle), middle.hull(&self.ceiling())]
    }

    /// At least half of the width: no number of it is farther from the middle.
    pub fn half_width(&self) -> Interval {
        let middle = self.middle();
        (self.ceiling() - &middle).max(&(&middle - self.floor())).ceiling()
    }

    /// The same with ends of fewer bits.
    pub fn round(&self, precision: u32) -> Interval {
        Interval::new(rounded(precision, &*self.lo(), Round::Down), rounded(precision, &*self.hi(), Round::Up))
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
        let (lo, hi, other_lo, other_hi) = (self.lo(), self.hi(), other.lo(), other.hi());
        if hi < other_lo && finite(&hi, &other_lo) {
            Some(true)
        } else if lo >= other_hi && finite(&lo, &other_hi) {
            Some(false)
        } else {
            None
        }
    }

    /// `self <= other`: certain, certainly not, or unknown.
    pub fn le(&self, other: &Interval) -> Option<bool> {
        other.lt(self).map(|less| !less)
    }

    /// How the ends lie to 0; `None` for NaN.
    fn signs(&self) -> [Option<Ordering>; 2] {
        match &self.0 {
            Ends::Short(ends) => ends.map(|end| end.partial_cmp(&0.0)),
            Ends::Long(lo, hi) => [lo.cmp0(), hi.cmp0()],
        }
    }

    /// Certainly > 0.
    pub fn is_positive(&self) -> bool {
        self.signs()[0].is_some_and(Ordering::is_gt)
    }

    /// Certainly < 0.
    fn is_negative(&self) -> bool {
        self.signs()[1].is_some_and(Ordering::is_lt)
    }

    /// Certainly >= 0.
    pub fn is_nonnegative(&self) -> bool {
        self.signs()[0].is_some_and(Ordering::is_ge)
    }

    /// Certainly <= 0.
    pub fn is_nonpositive(&self) -> bool {
        self.signs()[1].is_some_and(Ordering::is_le)
    }

    /// Exactly 0.
    pub fn is_zero(&self) -> bool {
        self.signs() == [Some(Ordering::Equal); 2]
    }

    /// A single number.
    pub fn is_point(&self) -> bool {
        self.lo() == self.hi()
    }

    /// The interval with one of both lower ends and one of both upper ends; undefined if these are not in order.
    fn of_both(&self, other: &Interval, lo: Which, hi: Which) -> Interval {
        if let (Some([a, b]), Some([c, d])) = (self.short(), other.short()) {
            let ends = [lo.of(a, c), hi.of(b, d)];
            return if ends[0] <= ends[1] { Interval(Ends::Short(ends)) } else { Interval::undefined(doubles::BITS) };
        }
        if !self.is_defined() || !other.is_defined() {
            return Interval::undefined(self.precision());
        }
        let [lo, hi] = [lo.of(self.lo(), other.lo()), hi.of(self.hi(), other.hi())];
        Interval::new(lo.into_owned(), hi.into_owned())
    }

    /// Whether all numbers of another one certainly are in it.
    pub fn contains(&self, other: &Interval) -> bool {
        *self.lo() <= *other.lo() && *other.hi() <= *self.hi()
    }

    /// The smallest interval that contains both.
    pub fn hull(&self, other: &Interval) -> Interval {
        self.of_both(other, Which::Lesser, Which::Greater)
    }

    /// What both contain; undefined if that is nothing.
    pub fn intersect(&self, other: &Interval) -> Interval {
        self.of_both(other, Which::Greater, Which::Lesser)
    }

    /// The smaller of two numbers.
    pub fn min(&self, other: &Interval) -> Interval {
        self.of_both(other, Which::Lesser, Which::Lesser)
    }

    /// The larger of two numbers.
    pub fn max(&self, other: &Interval) -> Interval {
        self.of_both(other, Which::Greater, Which::Greater)
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
        match (self.is_nonnegative(), self.is_nonpositive()) {
            (true, _) => self.clone(),
            (_, true) => -self,
            // Of a NaN too.
            _ => self.max(&-self).max(&Interval::int(0, self.precision())),
        }
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
