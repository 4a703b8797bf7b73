//! Numbers as they are printed: claims rounded outward, estimates marked as such by their section.

use rug::Rational;
use sigmastar_exact::enclosure::{self, Enclosure};
use sigmastar_exact::number::{Direction, round_f64, round_rational, write_exact};
use std::ops::Range;

/// Significant digits of a number in a report; certificates and JSON have all of them.
const DIGITS: usize = 4;

/// Estimates that are written as plain decimals: beyond these, plain digits would claim far more than the significant ones.
const PLAIN: Range<f64> = 1e-3..1e5;

/// A decimal, with an exponent where it starts with many zeros, or ends with so many that they would look like digits.
fn shorter(text: String) -> String {
    let size = text.strip_prefix('-').unwrap_or(&text);
    let is_long = size.len() > DIGITS + 3 && size.bytes().all(|c| c.is_ascii_digit());
    if is_long || size.starts_with("0.000") { scientific(&text) } else { text }
}

/// A number with one digit before the point and an exponent, of the same value; 0 stays 0.
fn scientific(number: &str) -> String {
    if number.contains('e') {
        return number.to_owned();
    }
    let (sign, size) = number.strip_prefix('-').map_or(("", number), |size| ("-", size));
    let (whole, fraction) = size.split_once('.').unwrap_or((size, ""));
    let all = format!("{whole}{fraction}");
    let zeros = all.len() - all.trim_start_matches('0').len();
    let mut digits = &all[zeros..];
    if fraction.is_empty() {
        digits = digits.trim_end_matches('0');
    }
    let Some(first) = digits.get(..1) else { return number.to_owned() };
    let exponent = whole.len() as i64 - 1 - zeros as i64;
    let dot = if digits.len() > 1 { "." } else { "" };
    format!("{sign}{first}{dot}{}e{exponent}", &digits[1..])
}

/// An upper bound, rounded up.
#[must_use]
pub fn upper(value: &Enclosure) -> String {
    shorter(value.upper_decimal(DIGITS))
}

/// A lower bound, rounded down.
#[must_use]
pub fn lower(value: &Enclosure) -> String {
    shorter(value.lower_decimal(DIGITS))
}

/// An upper bound for JSON: the upper end with all its digits.
#[must_use]
pub fn full(value: &Enclosure) -> String {
    value.upper_decimal(enclosure::DIGITS)
}

/// A lower bound, rounded down, in few digits.
#[must_use]
pub fn margin(value: &Enclosure) -> String {
    shorter(value.lower_decimal(3))
}

/// An enclosure, rounded outward; one number when that is exact.
#[must_use]
pub fn pair(value: &Enclosure) -> String {
    let (lower, upper) = (shorter(value.lower_decimal(DIGITS)), shorter(value.upper_decimal(DIGITS)));
    if lower == upper { lower } else { format!("[{lower}, {upper}]") }
}

/// The nearest number of few digits, where the enclosure is far narrower than these digits; else the enclosure.
#[must_use]
pub fn compact(value: &Enclosure) -> String {
    if value.lower() < 0 && value.upper() > 0 {
        // Perhaps 0: no digit is known.
        return format!("[{}, {}]", shorter(value.lower_decimal(2)), shorter(value.upper_decimal(2)));
    }
    let width = value.upper_f64() - value.lower_f64();
    let middle = value.midpoint_f64();
    if width > 1e-12 * middle.abs() || !middle.is_finite() {
        return pair(value);
    }
    match round_f64(middle, DIGITS as u32, Direction::Nearest) {
        Some(rounded) => short(&rounded, middle, DIGITS),
        None => pair(value),
    }
}

/// A rounded number as a decimal, with an exponent where the plain form would be long.
fn short(rounded: &Rational, value: f64, digits: usize) -> String {
    if value == 0.0 || PLAIN.contains(&value.abs()) {
        return write_exact(rounded);
    }
    let text = format!("{value:.*e}", digits - 1);
    match text.split_once('e') {
        Some((mantissa, exponent)) if mantissa.contains('.') => {
            format!("{}e{exponent}", mantissa.trim_end_matches('0').trim_end_matches('.'))
        }
        _ => text,
    }
}

/// A rational number of few digits, rounded in the given direction: exactly itself where it has no more of them.
#[must_use]
pub fn exact(value: &Rational, direction: Direction) -> String {
    shorter(write_exact(&round_rational(value, DIGITS as u32, direction)))
}

/// A floating-point estimate to three digits.
#[must_use]
pub fn estimate(value: f64) -> String {
    match round_f64(value, 3, Direction::Nearest) {
        Some(rounded) => short(&rounded, value, 3),
        None => "unknown".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn claims_are_rounded_outward() {
        let third = Enclosure::from_rational(&Rational::from((1, 3)), 128);
        assert_eq!(upper(&third), "0.3334");
        assert_eq!(margin(&third), "0.333");
        assert_eq!(pair(&third), "[0.3333, 0.3334]");
        assert_eq!(compact(&third), "0.3333");
        assert_eq!(compact(&third.hull(&Enclosure::one(128))), "[0.3333, 1]");
        assert_eq!(compact(&Enclosure::from_rational(&Rational::from((472_233, 10_000)), 128)), "47.22");
        assert_eq!(compact(&Enclosure::from_integer(1_499_714_004_546, 64)), "1.5e12");
        assert_eq!(compact(&Enclosure::from_integer(2, 64)), "2");
        assert_eq!(compact(&Enclosure::undefined(64)), "undefined");
        let around_0 = Enclosure::between(&Rational::from((-1, 3)), &Rational::from((1, 3)), 64);
        assert_eq!(compact(&around_0), "[-0.34, 0.34]");
        for (value, down, up) in [
            ((1, 3), "0.3333", "0.3334"),
            ((-1, 3), "-0.3334", "-0.3333"),
            ((5, 4), "1.25", "1.25"),
            ((0, 1), "0", "0"),
            ((233_112_i64, 1_000_000_000_000_i64), "2.331e-7", "2.332e-7"),
            ((7_236_227, 1), "7236000", "7237000"),
            ((16_987_651, 1), "1.698e7", "1.699e7"),
            ((-20_000_000, 1), "-2e7", "-2e7"),
        ] {
            let value = Rational::from(value);
            assert_eq!([exact(&value, Direction::Down), exact(&value, Direction::Up)], [down, up]);
        }
    }

    #[test]
    fn many_zeros_become_an_exponent() {
        for (plain, short) in [
            ("0.00006897218", "6.897218e-5"),
            ("-0.0002", "-2e-4"),
            ("0.00123", "0.00123"),
            ("0.0009999", "9.999e-4"),
            ("0.00012300", "1.2300e-4"),
            ("0.000", "0.000"),
            ("1.000001", "1.000001"),
            ("-7236000", "-7236000"),
            ("72360000", "7.236e7"),
            ("10000000", "1e7"),
            ("undefined", "undefined"),
        ] {
            assert_eq!(shorter(plain.to_owned()), short);
        }
    }

    #[test]
    fn estimates_are_short() {
        for (value, text) in [
            (0.0, "0"),
            (45.26789, "45.3"),
            (48_812.0, "48800"),
            (99_960.0, "100000"),
            (1e5, "1e5"),
            (0.001_234, "0.00123"),
            (9.994e-4, "9.99e-4"),
            (3.17e10, "3.17e10"),
            (1.2345e-9, "1.23e-9"),
            (f64::NAN, "unknown"),
        ] {
            assert_eq!(estimate(value), text);
        }
    }
}
