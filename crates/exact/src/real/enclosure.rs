//! Enclosures as reals.

use super::Real;
use super::series::COEFFICIENTS;
use crate::enclosure::Enclosure;
use rug::Rational;

/// Bits of a number that carries no precision of its own: an operation takes the larger one of its operands.
const LEAST: u32 = 64;

impl Real for Enclosure {
    fn int(value: i64) -> Enclosure {
        Enclosure::from_integer(value, LEAST)
    }

    fn unknown() -> Enclosure {
        Enclosure::undefined(LEAST)
    }

    fn sqr(&self) -> Enclosure {
        Enclosure::sqr(self)
    }

    fn sqrt(&self) -> Enclosure {
        Enclosure::sqrt(self)
    }

    fn exp(&self) -> Enclosure {
        Enclosure::exp(self)
    }

    fn coth(&self) -> Enclosure {
        Enclosure::coth(self)
    }

    fn min(&self, other: &Enclosure) -> Enclosure {
        Enclosure::min(self, other)
    }

    fn max(&self, other: &Enclosure) -> Enclosure {
        Enclosure::max(self, other)
    }

    fn is_unknown(&self) -> bool {
        !self.is_defined()
    }

    fn is_zero(&self) -> bool {
        *self == Enclosure::zero(2)
    }

    fn is_certainly_positive(&self) -> bool {
        self.is_positive().is_true()
    }

    fn coth_ratio_inverse(&self) -> Enclosure {
        if !self.is_certainly_positive() {
            return Enclosure::undefined(self.precision());
        }
        // 1/u <= coth(u)/u <= (1 + 1/u)/u.
        let first = self.recip();
        let last = (1 + (1 + 4 * self).sqrt()) / (2 * self);
        decreasing_root(&first, &last, |u| u.coth() / u, self)
    }

    /// The closed form cancels for small y, where the alternating series takes over; both are enclosures, so their
    /// intersection is one.
    fn oscillator_sum(&self) -> Enclosure {
        let (y, p) = (self, self.precision());
        let twelfth = Enclosure::from_rational(&Rational::from((1, 12)), p);
        // Dropping y^2 enlarges every term.
        let trivial = Enclosure::zero(p).hull(&Enclosure::from_rational(&Rational::from((1, 720)), p));
        let half = (y / 2).coth() / (2 * y);
        // The sum is nonnegative, so a negative lower end is only rounding.
        let closed = (twelfth - half + y.sqr().recip()).max(&Enclosure::zero(p)) / y.sqr();
        let ratio = trivial.intersect(&closed);
        if y.lt(&Enclosure::one(p)).is_true() { ratio.intersect(&alternating(y)) } else { ratio }
    }

    /// Both forms are enclosures, and so is their intersection; one or the other is narrow.
    fn zero_mean_sum(&self) -> Enclosure {
        let (y, p) = (self, self.precision());
        let twelfth = Enclosure::from_rational(&Rational::from((1, 12)), p);
        let trivial = Enclosure::zero(p).hull(&twelfth);
        let direct = (y / 2).coth() / (2 * y) - y.sqr().recip();
        let by_series = twelfth - y.sqr() * y.oscillator_sum();
        trivial.intersect(&direct).intersect(&by_series)
    }

    fn above(&self) -> String {
        self.upper_decimal(6)
    }
}

/// The sum for 0 < y < 1: its terms alternate and decrease, so it lies between consecutive partial sums.
fn alternating(y: &Enclosure) -> Enclosure {
    let p = y.precision();
    let square = y.sqr();
    let mut power = Enclosure::one(p);
    let mut partial = Enclosure::zero(p);
    let mut previous = partial.clone();
    for coefficient in COEFFICIENTS {
        previous = partial.clone();
        partial = partial + Enclosure::from_rational(&Rational::from(coefficient), p) * &power;
        power = power * &square;
    }
    previous.hull(&partial)
}

/// Encloses the root of `f(u) = target` for a decreasing f on `[first, last]`, where f(first) >= target >= f(last),
/// by bisection: a half is dropped only on a certain comparison.
fn decreasing_root(
    first: &Enclosure,
    last: &Enclosure,
    f: impl Fn(&Enclosure) -> Enclosure,
    target: &Enclosure,
) -> Enclosure {
    let p = target.precision();
    let (Some(mut low), Some(mut high)) = (first.lower_rational(), last.upper_rational()) else {
        return Enclosure::undefined(p);
    };
    if low <= 0 || low > high {
        return Enclosure::undefined(p);
    }
    for _ in 0..2 * p {
        // The middle, rounded to the working precision so that the rationals stay short.
        let middle = Rational::from(&low + &high) / 2u32;
        let middle = Enclosure::from_rational(&middle, p);
        let Some(exact) = middle.lower_rational() else { break };
        if exact <= low || exact >= high {
            break;
        }
        let value = f(&Enclosure::from_rational(&exact, p));
        if value.ge(target).is_true() {
            low = exact;
        } else if value.le(target).is_true() {
            high = exact;
        } else {
            break;
        }
    }
    Enclosure::between(&low, &high, p)
}
