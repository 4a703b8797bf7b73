//! What the tests of the files beside it share.

use crate::PRECISION;
use proofs_core::interval::Interval;
use rug::Rational;

/// Exactly this number.
pub fn number(value: f64) -> Interval {
    Interval::rational(&Rational::from_f64(value).unwrap(), PRECISION)
}
