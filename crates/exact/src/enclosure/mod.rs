//! Rigorous real arithmetic: closed intervals with MPFR end points and directed rounding.
//!
//! An [`Enclosure`] of a real quantity is an interval proved to contain it. Every operation returns an interval that
//! contains the result for every choice of reals in the operands (the inclusion property), at the larger of the two
//! precisions. End points may be infinite, and then say "no bound known on this side".
//!
//! An operation that may be applied outside its domain (a division by an interval containing 0, the square root of
//! an interval with a negative part, ...) returns the *undefined* enclosure, which is contagious. So a bounded result
//! of a composite expression proves two things at once: that the expression is defined for all arguments in the
//! operands, and where its values lie.

mod arithmetic;
mod decimal;
mod elementary;
#[cfg(test)]
mod tests;
mod trigonometric;
mod truth;

pub use decimal::DIGITS;
pub use truth::Truth;

use arithmetic::{larger, smaller};
use rug::float::{Round, Special};
use rug::{Float, Integer, Rational};

/// Working precision in bits where the caller does not choose one.
pub const DEFAULT_PRECISION: u32 = 128;

/// The precision in bits at which raising it further is given up and the answer stays undecided.
pub const MAX_PRECISION: u32 = 1024;

/// The largest binary exponent, in magnitude, of an end point that is made an exact rational.
///
/// An MPFR number reaches 2^(2^30) in a few words, but its rational needs as many bits as its exponent says: `exp(7e8)`
/// would become 128 MB, and a bisection over such numbers would never end. The limit is about 10^19728, far beyond every
/// numeral that is read (10^4000).
pub const MAX_EXACT_EXPONENT: i32 = 1 << 16;

/// A closed interval proved to contain a real quantity, or the undefined enclosure.
///
/// Invariant: either both ends are NaN (undefined), or `lower <= upper`, the lower end is not `+inf` and the upper
/// end is not `-inf`.
#[derive(Clone, Debug)]
pub struct Enclosure {
    lower: Float,
    upper: Float,
}

impl Enclosure {
    /// The interval `[lower, upper]`; undefined when the ends are NaN or in the wrong order.
    #[must_use]
    pub fn new(lower: Float, upper: Float) -> Enclosure {
        // A wrong order can only come from a caller's mistake; answering "undefined" keeps it from being believed.
        if lower <= upper
            && !(lower.is_infinite() && lower.is_sign_positive())
            && !(upper.is_infinite() && upper.is_sign_negative())
        {
            Enclosure { lower, upper }
        } else {
            Enclosure::undefined(lower.prec().max(upper.prec()))
        }
    }

    /// The undefined enclosure: nothing is known, not even that the quantity exists.
    #[must_use]
    pub fn undefined(precision: u32) -> Enclosure {
        Enclosure { lower: Float::with_val(precision, Special::Nan), upper: Float::with_val(precision, Special::Nan) }
    }

    /// The whole real line: the quantity exists and no bound is known.
    #[must_use]
    pub fn entire(precision: u32) -> Enclosure {
        Enclosure {
            lower: Float::with_val(precision, Special::NegInfinity),
            upper: Float::with_val(precision, Special::Infinity),
        }
    }

    /// The tightest enclosure at `precision` bits of an exact rational number.
    #[must_use]
    pub fn from_rational(value: &Rational, precision: u32) -> Enclosure {
        Enclosure {
            lower: Float::with_val_round(precision, value, Round::Down).0,
            upper: Float::with_val_round(precision, value, Round::Up).0,
        }
    }

    /// The interval between two exact rationals, rounded outward; undefined when `lower > upper`.
    #[must_use]
    pub fn between(lower: &Rational, upper: &Rational, precision: u32) -> Enclosure {
        Enclosure::new(
            Float::with_val_round(precision, lower, Round::Down).0,
            Float::with_val_round(precision, upper, Round::Up).0,
        )
    }

    /// The tightest enclosure at `precision` bits of an integer.
    #[must_use]
    pub fn from_integer(value: i64, precision: u32) -> Enclosure {
        Enclosure {
            lower: Float::with_val_round(precision, value, Round::Down).0,
            upper: Float::with_val_round(precision, value, Round::Up).0,
        }
    }

    /// Exactly 0.
    #[must_use]
    pub fn zero(precision: u32) -> Enclosure {
        Enclosure::from_integer(0, precision)
    }

    /// Exactly 1.
    #[must_use]
    pub fn one(precision: u32) -> Enclosure {
        Enclosure::from_integer(1, precision)
    }

    /// The lower end: NaN when undefined, possibly `-inf`.
    #[must_use]
    pub fn lower(&self) -> &Float {
        &self.lower
    }

    /// The upper end: NaN when undefined, possibly `+inf`.
    #[must_use]
    pub fn upper(&self) -> &Float {
        &self.upper
    }

    /// A rational that is not below the quantity: the upper end exactly, where its exponent is at most
    /// [`MAX_EXACT_EXPONENT`] in magnitude. A smaller end is rounded up to 0 or to the smallest power of 2 in range;
    /// `None` when undefined, unbounded above or beyond the range.
    #[must_use]
    pub fn upper_rational(&self) -> Option<Rational> {
        exact(&self.upper, Round::Up)
    }

    /// A rational that is not above the quantity, in the same way; `None` when undefined, unbounded below or beyond the
    /// range.
    #[must_use]
    pub fn lower_rational(&self) -> Option<Rational> {
        exact(&self.lower, Round::Down)
    }

    /// The precision in bits of the end points.
    #[must_use]
    pub fn precision(&self) -> u32 {
        self.lower.prec().max(self.upper.prec())
    }

    /// Whether the quantity is proved to exist.
    #[must_use]
    pub fn is_defined(&self) -> bool {
        !self.lower.is_nan()
    }

    /// Whether the quantity is proved to exist and to lie between two finite numbers.
    #[must_use]
    pub fn is_bounded(&self) -> bool {
        self.lower.is_finite() && self.upper.is_finite()
    }

    /// Whether both ends are the same finite number, so that the quantity is known exactly.
    #[must_use]
    pub fn is_exact(&self) -> bool {
        self.is_bounded() && self.lower == self.upper
    }

    /// Whether the interval contains the rational (false for the undefined enclosure).
    #[must_use]
    pub fn contains(&self, value: &Rational) -> bool {
        self.lower <= *value && self.upper >= *value
    }

    /// Whether 0 lies in the interval (false for the undefined enclosure).
    #[must_use]
    pub fn contains_zero(&self) -> bool {
        self.lower <= 0 && self.upper >= 0
    }

    /// The smallest interval containing both; undefined if one of them is.
    #[must_use]
    pub fn hull(&self, other: &Enclosure) -> Enclosure {
        let p = self.precision().max(other.precision());
        if !self.is_defined() || !other.is_defined() {
            return Enclosure::undefined(p);
        }
        Enclosure { lower: smaller(&self.lower, &other.lower, p), upper: larger(&self.upper, &other.upper, p) }
    }

    /// The common part of two enclosures of the *same* quantity.
    ///
    /// Undefined if either is undefined or if they are disjoint (which would mean that one of them is wrong).
    #[must_use]
    pub fn intersect(&self, other: &Enclosure) -> Enclosure {
        let p = self.precision().max(other.precision());
        if !self.is_defined() || !other.is_defined() {
            return Enclosure::undefined(p);
        }
        Enclosure::new(larger(&self.lower, &other.lower, p), smaller(&self.upper, &other.upper, p))
    }

    /// The upper end as a degenerate enclosure: for quantities of which only an upper bound is used.
    #[must_use]
    pub fn ceiling(&self) -> Enclosure {
        Enclosure::new(self.upper.clone(), self.upper.clone())
    }

    /// A double near the middle, for display and as a starting point of searches; never for a claim.
    #[must_use]
    pub fn midpoint_f64(&self) -> f64 {
        let (lower, upper) = (self.lower.to_f64(), self.upper.to_f64());
        let middle = lower / 2.0 + upper / 2.0;
        if middle == 0.0 && lower == upper { lower } else { middle }
    }

    /// The largest double that is certainly not above the quantity (NaN when undefined).
    #[must_use]
    pub fn lower_f64(&self) -> f64 {
        self.lower.to_f64_round(Round::Down)
    }

    /// The smallest double that is certainly not below the quantity (NaN when undefined).
    #[must_use]
    pub fn upper_f64(&self) -> f64 {
        self.upper.to_f64_round(Round::Up)
    }

    /// Whether this quantity is certainly less than the other.
    #[must_use]
    pub fn lt(&self, other: &Enclosure) -> Truth {
        if self.upper < other.lower {
            Truth::True
        } else if self.lower >= other.upper {
            Truth::False
        } else {
            Truth::Undecided
        }
    }

    /// Whether this quantity is certainly less than or equal to the other.
    #[must_use]
    pub fn le(&self, other: &Enclosure) -> Truth {
        if self.upper <= other.lower {
            Truth::True
        } else if self.lower > other.upper {
            Truth::False
        } else {
            Truth::Undecided
        }
    }

    /// Whether this quantity is certainly greater than the other.
    #[must_use]
    pub fn gt(&self, other: &Enclosure) -> Truth {
        other.lt(self)
    }

    /// Whether this quantity is certainly greater than or equal to the other.
    #[must_use]
    pub fn ge(&self, other: &Enclosure) -> Truth {
        other.le(self)
    }

    /// Whether the quantity is certainly positive.
    #[must_use]
    pub fn is_positive(&self) -> Truth {
        Enclosure::zero(2).lt(self)
    }

    /// Whether the quantity is certainly nonnegative.
    #[must_use]
    pub fn is_nonnegative(&self) -> Truth {
        Enclosure::zero(2).le(self)
    }

    /// The set of integers that may lie in the interval, as its least and greatest member; `None` if there is
    /// certainly none. Undefined and unbounded enclosures have none to name and must be handled by the caller.
    pub fn integers(&self) -> Option<(Integer, Integer)> {
        let least = self.lower.to_integer_round(Round::Up)?.0;
        let greatest = self.upper.to_integer_round(Round::Down)?.0;
        (least <= greatest).then_some((least, greatest))
    }
}

/// An end point as a rational of bounded size, rounded in the given direction where it is too close to 0.
fn exact(end: &Float, round: Round) -> Option<Rational> {
    let Some(exponent) = end.get_exp() else { return end.to_rational() };
    if exponent > MAX_EXACT_EXPONENT {
        return None;
    }
    if exponent >= -MAX_EXACT_EXPONENT {
        return end.to_rational();
    }
    let least = || Rational::from(1) >> (MAX_EXACT_EXPONENT as u32);
    Some(match (round, end.is_sign_negative()) {
        (Round::Up, false) => least(),
        (Round::Down, true) => -least(),
        _ => Rational::new(),
    })
}

/// Enclosures compare as sets: equal when both ends agree (the undefined enclosure equals itself).
impl PartialEq for Enclosure {
    fn eq(&self, other: &Enclosure) -> bool {
        if !self.is_defined() || !other.is_defined() {
            return self.is_defined() == other.is_defined();
        }
        self.lower == other.lower && self.upper == other.upper
    }
}
