//! Reading and writing exact decimals.

use rug::ops::Pow;
use rug::{Integer, Rational};
use std::ops::RangeInclusive;
use thiserror::Error;

/// The longest numeral accepted, in bytes.
pub const MAX_LENGTH: usize = 1000;

/// The largest magnitude of a decimal exponent accepted.
pub const MAX_EXPONENT: u32 = 4000;

/// Why a numeral was refused.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum DecimalError {
    /// The text is not a numeral.
    #[error(
        "`{text}` is not a decimal number; expected digits with an optional fraction and exponent, as in 12, 0.5 or 1.5e-3"
    )]
    Malformed {
        /// The offending text, shortened for display.
        text: String,
    },
    /// The numeral has too many characters.
    #[error("a number of {length} characters; at most {MAX_LENGTH} are read")]
    TooLong {
        /// The length that was found.
        length: usize,
    },
    /// The decimal exponent is out of range.
    #[error("the exponent of `{text}` is out of range; at most {MAX_EXPONENT} in magnitude is read")]
    Exponent {
        /// The offending text, shortened for display.
        text: String,
    },
}

fn shortened(text: &str) -> String {
    if text.chars().count() <= 40 { text.to_owned() } else { text.chars().take(37).collect::<String>() + "..." }
}

/// Reads a decimal numeral (`-12`, `0.5`, `1.5e-3`) as the exact rational that is written.
///
/// # Errors
/// [`DecimalError`] when the text is not a numeral, is longer than [`MAX_LENGTH`] or has an exponent beyond
/// [`MAX_EXPONENT`].
pub fn parse_decimal(text: &str) -> Result<Rational, DecimalError> {
    if text.len() > MAX_LENGTH {
        return Err(DecimalError::TooLong { length: text.len() });
    }
    let malformed = || DecimalError::Malformed { text: shortened(text) };
    let (mantissa, exponent) = match text.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, Some(exponent)),
        None => (text, None),
    };
    let (negative, mantissa) = match mantissa.strip_prefix('-') {
        Some(rest) => (true, rest),
        None => (false, mantissa.strip_prefix('+').unwrap_or(mantissa)),
    };
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let all_digits = |digits: &str| digits.bytes().all(|b| b.is_ascii_digit());
    if !all_digits(whole) || !all_digits(fraction) || (whole.is_empty() && fraction.is_empty()) {
        return Err(malformed());
    }
    let exponent = match exponent {
        None => 0,
        Some(exponent) => {
            let digits = exponent.strip_prefix(['+', '-']).unwrap_or(exponent);
            if digits.is_empty() || !all_digits(digits) {
                return Err(malformed());
            }
            exponent
                .parse::<i64>()
                .ok()
                .filter(|e| e.unsigned_abs() <= u64::from(MAX_EXPONENT))
                .ok_or_else(|| DecimalError::Exponent { text: shortened(text) })?
        }
    };
    let digits = format!("0{whole}{fraction}");
    let mut value = Rational::from(digits.parse::<Integer>().map_err(|_| malformed())?);
    // Both terms are bounded by the checks above, so the scale fits and the power is cheap.
    let scale = exponent - fraction.len() as i64;
    let power = Integer::from(10).pow(scale.unsigned_abs() as u32);
    if scale >= 0 {
        value *= power;
    } else {
        value /= power;
    }
    Ok(if negative { -value } else { value })
}

/// Reads a number as JSON writes one (`-12`, `0.5`, `1.5e-3`), or a fraction `p/q` of whole numbers, of which p alone may have a sign: as
/// certificates have their numbers, which words repeat. `None` for any other text, also one that [`parse_decimal`] takes, as `.5`, `5.` or `+1`.
#[must_use]
pub fn parse_rational(text: &str) -> Option<Rational> {
    let whole = |text: &str| {
        !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit()) && (text == "0" || !text.starts_with('0'))
    };
    let unsigned = text.strip_prefix('-').unwrap_or(text);
    if let Some((numerator, denominator)) = unsigned.split_once('/') {
        let written = whole(numerator) && whole(denominator);
        let (p, q) = (parse_decimal(numerator).ok()?, parse_decimal(denominator).ok()?);
        let quotient = (written && q != 0).then(|| p / q)?;
        return Some(if text.starts_with('-') { -quotient } else { quotient });
    }
    let mantissa = unsigned.split(['e', 'E']).next().unwrap_or(unsigned);
    let (before, after) = mantissa.split_once('.').map_or((mantissa, None), |(before, after)| (before, Some(after)));
    if !whole(before) || after.is_some_and(str::is_empty) {
        return None;
    }
    parse_decimal(text).ok()
}

/// Writes a rational exactly: as a terminating decimal where the denominator allows a short one, as `p/q` otherwise.
/// The result is read back to the same rational by [`parse_decimal`] or as a constant expression.
#[must_use]
pub fn write_exact(value: &Rational) -> String {
    let Some((digits, places)) = terminating(value) else {
        return value.to_string();
    };
    if digits.is_zero() {
        return "0".to_owned();
    }
    let sign = if digits < 0 { "-" } else { "" };
    let text = Integer::from(digits.abs_ref()).to_string();
    let significant = text.trim_end_matches('0');
    // value = 0.text * 10^point
    let point = text.len() as i64 - places;
    positional(sign, significant, point, -6..=15)
}

/// `0.significant * 10^point` in decimal notation: plain while `point` lies in `plain`, with an exponent otherwise.
///
/// Precondition: `significant` are digits, at least one, the first not 0.
pub fn positional(sign: &str, significant: &str, point: i64, plain: RangeInclusive<i64>) -> String {
    let count = significant.len() as i64;
    if !plain.contains(&point) {
        let (first, rest) = significant.split_at(1);
        let dot = if rest.is_empty() { "" } else { "." };
        format!("{sign}{first}{dot}{rest}e{}", point - 1)
    } else if point <= 0 {
        format!("{sign}0.{}{significant}", "0".repeat((-point) as usize))
    } else if count <= point {
        format!("{sign}{significant}{}", "0".repeat((point - count) as usize))
    } else {
        let (whole, fraction) = significant.split_at(point as usize);
        format!("{sign}{whole}.{fraction}")
    }
}

/// `value = digits / 10^places`, if the denominator has only the prime factors 2 and 5.
fn terminating(value: &Rational) -> Option<(Integer, i64)> {
    let (numerator, denominator) = (value.numer(), value.denom());
    let twos = denominator.find_one(0).unwrap_or(0);
    let mut rest = Integer::from(denominator >> twos);
    let fives = rest.remove_factor_mut(&Integer::from(5));
    if rest != 1 {
        return None;
    }
    let places = twos.max(fives);
    let scaled = numerator * Integer::from(10).pow(places) / denominator;
    Some((scaled, i64::from(places)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn decimals_are_taken_as_written() {
        for (text, value) in [
            ("0.1", (1, 10)),
            ("-12", (-12, 1)),
            ("1.5e-3", (3, 2000)),
            ("2E2", (200, 1)),
            (".5", (1, 2)),
            ("5.", (5, 1)),
            ("-0.0", (0, 1)),
        ] {
            assert_eq!(parse_decimal(text).unwrap(), Rational::from(value), "{text}");
        }
    }

    #[test]
    fn nonsense_is_refused() {
        for text in ["", ".", "-", "e5", "1e", "1e+", "0x10", "NaN", "inf", "1_000", "1 ", "--1", "1.2.3", "١"] {
            assert!(matches!(parse_decimal(text), Err(DecimalError::Malformed { .. })), "{text}");
        }
        for text in ["1e999999999", "1e-4001", "1e99999999999999999999"] {
            assert!(matches!(parse_decimal(text), Err(DecimalError::Exponent { .. })), "{text}");
        }
        assert!(matches!(parse_decimal(&"9".repeat(1001)), Err(DecimalError::TooLong { length: 1001 })));
    }

    #[test]
    fn rationals_are_written_in_one_way() {
        for (text, value) in [
            ("12", (12, 1)),
            ("-0.5", (-1, 2)),
            ("1.5e-3", (3, 2000)),
            ("2E+2", (200, 1)),
            ("0", (0, 1)),
            ("3/7", (3, 7)),
            ("-30/70", (-3, 7)),
            ("0/7", (0, 1)),
        ] {
            assert_eq!(parse_rational(text), Some(Rational::from(value)), "{text}");
        }
        for text in [
            "", "-", ".", ".5", "5.", "-.5", "+1", "007", "00.5", "1e", "1 ", " 1", "1/0", "1/-2", "-1/-2", "1/+2",
            "--1", "1/2/3", "1/3e2", "1e2/3", "0.5/3", "1/", "/2", "01/2", "1/02", "2*3", "pi", "1 / 2", "٣",
        ] {
            assert_eq!(parse_rational(text), None, "{text}");
        }
    }

    #[test]
    fn writing_is_short() {
        for (value, text) in [
            ((1, 10), "0.1"),
            ((487, 10), "48.7"),
            ((1, 3), "1/3"),
            ((-5, 2), "-2.5"),
            ((0, 1), "0"),
            ((1_000_000, 1), "1000000"),
        ] {
            assert_eq!(write_exact(&Rational::from(value)), text);
        }
        assert_eq!(write_exact(&parse_decimal("1.25e-30").unwrap()), "1.25e-30");
        assert_eq!(write_exact(&parse_decimal("1.25e30").unwrap()), "1.25e30");
    }

    proptest! {
        #[test]
        fn decimals_survive_a_round_trip(digits in -10_000_000_000_i64..10_000_000_000, exponent in -60_i32..60) {
            let value = parse_decimal(&format!("{digits}e{exponent}")).unwrap();
            prop_assert_eq!(parse_decimal(&write_exact(&value)).unwrap(), value);
        }
    }
}
