//! Rigorous real arithmetic: closed intervals with directed rounding, whose end points are MPFR numbers, or doubles where these
//! give the same bits.
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
mod ends;
#[cfg(test)]
mod tests;
mod trigonometric;
mod truth;

pub use decimal::DIGITS;
pub use truth::Truth;

use ends::{SHORT, fits};
use rug::float::{Round, Special};
use rug::{Float, Integer, Rational};
use std::borrow::Cow;
use std::cmp::Ordering;

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
    ends: Ends,
}

/// The ends, lower and upper.
#[derive(Clone, Debug)]
enum Ends {
    /// Two ends of 53 bits that [`fits`] holds of: always these, where both are such numbers.
    Short([f64; 2]),
    /// Any others.
    Long([Float; 2]),
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
            // A number that is not 0 may be one that doubles round to 0.
            let is_short = |end: &Float| end.prec() == SHORT && (end.is_zero() || end.to_f64() != 0.0);
            let short = [&lower, &upper].map(|end| if is_short(end) { end.to_f64() } else { f64::NAN });
            let ends = if short.into_iter().all(fits) { Ends::Short(short) } else { Ends::Long([lower, upper]) };
            Enclosure { ends }
        } else {
            Enclosure::undefined(lower.prec().max(upper.prec()))
        }
    }

    /// The undefined enclosure: nothing is known, not even that the quantity exists.
    #[must_use]
    pub fn undefined(precision: u32) -> Enclosure {
        Enclosure { ends: Ends::Long([Special::Nan; 2].map(|special| Float::with_val(precision, special))) }
    }

    /// The whole real line: the quantity exists and no bound is known.
    #[must_use]
    pub fn entire(precision: u32) -> Enclosure {
        let ends = [Special::NegInfinity, Special::Infinity].map(|special| Float::with_val(precision, special));
        Enclosure { ends: Ends::Long(ends) }
    }

    /// Exactly a double; undefined for what is no number.
    #[must_use]
    pub fn exactly(value: f64) -> Enclosure {
        if fits(value) {
            return Enclosure { ends: Ends::Short([value; 2]) };
        }
        let value = Float::with_val(SHORT, value);
        Enclosure::new(value.clone(), value)
    }

    /// Exactly this number; undefined for what is no number or infinite.
    #[must_use]
    pub fn point(value: &Float) -> Enclosure {
        Enclosure::new(value.clone(), value.clone())
    }

    /// The tightest enclosure at `precision` bits of an exact rational number.
    #[must_use]
    pub fn from_rational(value: &Rational, precision: u32) -> Enclosure {
        let short = |integer: &Integer| integer.to_i64().filter(|integer| integer.unsigned_abs() <= 1 << SHORT);
        match (short(value.numer()), short(value.denom())) {
            (Some(numerator), Some(denominator)) if precision == SHORT => {
                Enclosure::from_integer(numerator, SHORT) / Enclosure::from_integer(denominator, SHORT)
            }
            _ => Enclosure::between(value, value, precision),
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
        if precision == SHORT && value.unsigned_abs() <= 1 << SHORT {
            return Enclosure { ends: Ends::Short([value as f64; 2]) };
        }
        Enclosure::new(
            Float::with_val_round(precision, value, Round::Down).0,
            Float::with_val_round(precision, value, Round::Up).0,
        )
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

    /// This enclosure at another precision, rounded outward: it contains the numbers that it contained.
    #[must_use]
    pub fn at_precision(&self, precision: u32) -> Enclosure {
        Enclosure::new(
            Float::with_val_round(precision, self.lower(), Round::Down).0,
            Float::with_val_round(precision, self.upper(), Round::Up).0,
        )
    }

    /// Both ends as MPFR numbers.
    fn long(&self) -> [Cow<'_, Float>; 2] {
        match &self.ends {
            Ends::Short(ends) => ends.map(|end| Cow::Owned(Float::with_val(SHORT, end))),
            Ends::Long(ends) => ends.each_ref().map(Cow::Borrowed),
        }
    }

    /// The signs of the ends: -1, 0 or 1; none when undefined.
    #[inline]
    fn signs(&self) -> Option<[i32; 2]> {
        match &self.ends {
            Ends::Short(ends) => Some(ends.map(|end| i32::from(end > 0.0) - i32::from(end < 0.0))),
            Ends::Long(ends) => {
                let [lower, upper] = ends.each_ref().map(|end| end.cmp0().map(|order| order as i32));
                Some([lower?, upper?])
            }
        }
    }

    /// The lower end: NaN when undefined, possibly `-inf`.
    #[must_use]
    pub fn lower(&self) -> Float {
        let [lower, _] = self.long();
        lower.into_owned()
    }

    /// The upper end: NaN when undefined, possibly `+inf`.
    #[must_use]
    pub fn upper(&self) -> Float {
        let [_, upper] = self.long();
        upper.into_owned()
    }

    /// A rational that is not below the quantity: the upper end exactly, where its exponent is at most
    /// [`MAX_EXACT_EXPONENT`] in magnitude. A smaller end is rounded up to 0 or to the smallest power of 2 in range;
    /// `None` when undefined, unbounded above or beyond the range.
    #[must_use]
    pub fn upper_rational(&self) -> Option<Rational> {
        exact(&self.long()[1], Round::Up)
    }

    /// A rational that is not above the quantity, in the same way; `None` when undefined, unbounded below or beyond the
    /// range.
    #[must_use]
    pub fn lower_rational(&self) -> Option<Rational> {
        exact(&self.long()[0], Round::Down)
    }

    /// The precision in bits of the end points.
    #[must_use]
    pub fn precision(&self) -> u32 {
        match &self.ends {
            Ends::Short(_) => SHORT,
            Ends::Long([lower, upper]) => lower.prec().max(upper.prec()),
        }
    }

    /// Whether the quantity is proved to exist.
    #[must_use]
    pub fn is_defined(&self) -> bool {
        match &self.ends {
            Ends::Short(_) => true,
            Ends::Long([lower, _]) => !lower.is_nan(),
        }
    }

    /// Whether the quantity is proved to exist and to lie between two finite numbers.
    #[must_use]
    pub fn is_bounded(&self) -> bool {
        match &self.ends {
            Ends::Short(_) => true,
            Ends::Long(ends) => ends.iter().all(Float::is_finite),
        }
    }

    /// Whether both ends are the same finite number, so that the quantity is known exactly.
    #[must_use]
    pub fn is_exact(&self) -> bool {
        match &self.ends {
            Ends::Short([lower, upper]) => lower == upper,
            Ends::Long([lower, upper]) => lower.is_finite() && lower == upper,
        }
    }

    /// Whether the interval contains the rational (false for the undefined enclosure).
    #[must_use]
    pub fn contains(&self, value: &Rational) -> bool {
        let [lower, upper] = self.long();
        *lower <= *value && *upper >= *value
    }

    /// Whether 0 lies in the interval (false for the undefined enclosure).
    #[must_use]
    pub fn contains_zero(&self) -> bool {
        self.signs().is_some_and(|[lower, upper]| lower <= 0 && upper >= 0)
    }

    /// The upper end as a degenerate enclosure: for quantities of which only an upper bound is used.
    #[must_use]
    pub fn ceiling(&self) -> Enclosure {
        let upper = self.upper();
        Enclosure::new(upper.clone(), upper)
    }

    /// The lower end in the same way.
    #[must_use]
    pub fn floor(&self) -> Enclosure {
        match &self.ends {
            Ends::Short([lower, _]) => Enclosure { ends: Ends::Short([*lower; 2]) },
            Ends::Long([lower, _]) => Enclosure::new(lower.clone(), lower.clone()),
        }
    }

    /// A double near the middle, for display and as a starting point of searches; never for a claim.
    #[must_use]
    pub fn midpoint_f64(&self) -> f64 {
        let [lower, upper] = match &self.ends {
            Ends::Short(ends) => *ends,
            Ends::Long(ends) => ends.each_ref().map(Float::to_f64),
        };
        let middle = lower / 2.0 + upper / 2.0;
        if middle == 0.0 && lower == upper { lower } else { middle }
    }

    /// The largest double that is certainly not above the quantity (NaN when undefined).
    #[must_use]
    pub fn lower_f64(&self) -> f64 {
        match &self.ends {
            Ends::Short([lower, _]) => *lower,
            Ends::Long([lower, _]) => lower.to_f64_round(Round::Down),
        }
    }

    /// The smallest double that is certainly not below the quantity (NaN when undefined).
    #[must_use]
    pub fn upper_f64(&self) -> f64 {
        match &self.ends {
            Ends::Short([_, upper]) => *upper,
            Ends::Long([_, upper]) => upper.to_f64_round(Round::Up),
        }
    }

    /// How the ends compare: the upper one with the lower one of the other, and the lower one with its upper one; none when undefined.
    #[inline]
    fn orders(&self, other: &Enclosure) -> [Option<Ordering>; 2] {
        match (&self.ends, &other.ends) {
            (Ends::Short([a1, a2]), Ends::Short([b1, b2])) => [a2.partial_cmp(b1), a1.partial_cmp(b2)],
            _ => {
                let ([a1, a2], [b1, b2]) = (self.long(), other.long());
                [(*a2).partial_cmp(&*b1), (*a1).partial_cmp(&*b2)]
            }
        }
    }

    /// Whether this quantity is certainly less than the other.
    #[must_use]
    pub fn lt(&self, other: &Enclosure) -> Truth {
        match self.orders(other) {
            [Some(Ordering::Less), _] => Truth::True,
            [_, Some(Ordering::Greater | Ordering::Equal)] => Truth::False,
            _ => Truth::Undecided,
        }
    }

    /// Whether this quantity is certainly less than or equal to the other.
    #[must_use]
    pub fn le(&self, other: &Enclosure) -> Truth {
        match self.orders(other) {
            [Some(Ordering::Less | Ordering::Equal), _] => Truth::True,
            [_, Some(Ordering::Greater)] => Truth::False,
            _ => Truth::Undecided,
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
        match self.signs() {
            Some([1, _]) => Truth::True,
            Some([_, -1 | 0]) => Truth::False,
            _ => Truth::Undecided,
        }
    }

    /// Whether the quantity is certainly nonnegative.
    #[must_use]
    pub fn is_nonnegative(&self) -> Truth {
        match self.signs() {
            Some([0 | 1, _]) => Truth::True,
            Some([_, -1]) => Truth::False,
            _ => Truth::Undecided,
        }
    }

    /// The set of integers that may lie in the interval, as its least and greatest member; `None` if there is
    /// certainly none. Undefined and unbounded enclosures have none to name and must be handled by the caller.
    pub fn integers(&self) -> Option<(Integer, Integer)> {
        let [lower, upper] = self.long();
        let least = lower.to_integer_round(Round::Up)?.0;
        let greatest = upper.to_integer_round(Round::Down)?.0;
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
        self.long() == other.long()
    }
}
