//! Numbers as they are printed: claims rounded outward, estimates marked as such by their section.

use crate::enclosure::Enclosure;
use crate::number::{Direction, round_f64, round_rational, write_exact};
use rug::Rational;

/// Significant digits of a number in a report.
pub const DIGITS: usize = 6;

/// An upper bound, rounded up.
#[must_use]
pub fn upper(value: &Enclosure) -> String {
    value.upper_decimal(DIGITS)
}

/// A lower bound, rounded down, in few digits.
#[must_use]
pub fn margin(value: &Enclosure) -> String {
    value.lower_decimal(3)
}

/// An enclosure, rounded outward; one number when that is exact.
#[must_use]
pub fn pair(value: &Enclosure) -> String {
    let (lower, upper) = (value.lower_decimal(DIGITS), value.upper_decimal(DIGITS));
    if lower == upper { lower } else { format!("[{lower}, {upper}]") }
}

/// One number, the upper end rounded up, where the enclosure is narrower than the digits printed; else the enclosure.
#[must_use]
pub fn compact(value: &Enclosure) -> String {
    let width = value.upper_f64() - value.lower_f64();
    let narrow = width <= 1e-8 * value.midpoint_f64().abs();
    if narrow { upper(value) } else { pair(value) }
}

/// A rational exactly where that is short, else rounded in the given direction.
#[must_use]
pub fn exact(value: &Rational, direction: Direction) -> String {
    const LONGEST: usize = 16;
    let written = write_exact(value);
    if written.len() <= LONGEST { written } else { write_exact(&round_rational(value, 9, direction)) }
}

/// A floating-point estimate to three digits.
#[must_use]
pub fn estimate(value: f64) -> String {
    let size = value.abs();
    match round_f64(value, 3, Direction::Nearest) {
        Some(rounded) if size == 0.0 || (1e-4..1e6).contains(&size) => write_exact(&rounded),
        Some(_) => format!("{value:.2e}"),
        None => "unknown".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn claims_are_rounded_outward() {
        let third = Enclosure::from_rational(&Rational::from((1, 3)), 128);
        assert_eq!(upper(&third), "0.333334");
        assert_eq!(margin(&third), "0.333");
        assert_eq!(pair(&third), "[0.333333, 0.333334]");
        assert_eq!(compact(&third), "0.333334");
        assert_eq!(compact(&Enclosure::from_integer(2, 64)), "2");
        assert_eq!(compact(&Enclosure::undefined(64)), "undefined");
        assert_eq!(exact(&Rational::from((1, 3)), Direction::Down), "1/3");
        let long = Rational::from((1_000_000_007, 3_000_000_019_i64));
        assert_eq!(exact(&long, Direction::Down), "0.333333333");
        assert_eq!(exact(&long, Direction::Up), "0.333333334");
    }

    #[test]
    fn estimates_are_short() {
        for (value, text) in
            [(0.0, "0"), (45.26789, "45.3"), (3.17e10, "3.17e10"), (1.2345e-9, "1.23e-9"), (f64::NAN, "unknown")]
        {
            assert_eq!(estimate(value), text);
        }
    }
}
