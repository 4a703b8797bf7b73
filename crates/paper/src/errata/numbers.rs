//! Short names for the numbers that the evidence is made of.

use rug::{Integer, Rational};
use sigmastar_exact::enclosure::{DEFAULT_PRECISION, Enclosure};

/// The working precision of the evidence, in bits.
pub(super) const PRECISION: u32 = DEFAULT_PRECISION;

/// The rational `numerator / denominator`; the denominator is a nonzero literal at every call.
pub(super) fn ratio(numerator: i64, denominator: i64) -> Rational {
    Rational::from((numerator, denominator))
}

/// The tightest enclosure of a rational.
pub(super) fn rational(value: &Rational) -> Enclosure {
    Enclosure::from_rational(value, PRECISION)
}

/// The tightest enclosure of `numerator / denominator`.
pub(super) fn quotient(numerator: i64, denominator: i64) -> Enclosure {
    rational(&ratio(numerator, denominator))
}

/// An integer.
pub(super) fn integer(value: i64) -> Enclosure {
    Enclosure::from_integer(value, PRECISION)
}

/// The square root of an integer.
pub(super) fn root(value: i64) -> Enclosure {
    integer(value).sqrt()
}

/// Pi.
pub(super) fn pi() -> Enclosure {
    Enclosure::pi(PRECISION)
}

/// `base^exponent` for a rational base.
pub(super) fn power(base: &Rational, exponent: u32) -> Rational {
    let mut result = Rational::from(1);
    for _ in 0..exponent {
        result *= base;
    }
    result
}

/// The binomial coefficient `n` over `k`.
pub(super) fn binomial(n: u32, k: u32) -> Rational {
    Rational::from(Integer::from(n).binomial(k))
}
