//! Intervals with MPFR ends, or with doubles at 53 bits, rounded outward.
//!
//! An interval contains the true value, or is *undefined* (both ends NaN): then nothing is known, and nothing that is
//! computed from it decides anything. What must be believed here: which end is rounded which way.

mod arithmetic;
mod doubles;
mod functions;
pub mod removable;

use crate::effort;
use rug::float::{Constant, Round, Special};
use rug::{Float, Rational};
use std::borrow::Cow;
use std::cmp::Ordering;

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

    /// An interval with ends of fewer bits, rounded outward, that contains this one.
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
}
