//! Outward-rounded decimals: how enclosures are written in reports and certificates.

use super::Enclosure;
use crate::number::positional;
use rug::Float;
use rug::float::Round;

/// Significant digits in reports and certificates.
pub const DIGITS: usize = 17;

fn decimal(value: &Float, digits: usize, round: Round) -> String {
    if value.is_nan() {
        return "undefined".to_owned();
    }
    if value.is_infinite() {
        return if value.is_sign_positive() { "inf" } else { "-inf" }.to_owned();
    }
    tidy(&value.to_string_radix_round(10, Some(digits), round))
}

/// Drops trailing zeros of the mantissa and writes small exponents as plain decimals.
fn tidy(text: &str) -> String {
    let (mantissa, exponent) = match text.split_once('e') {
        Some((mantissa, exponent)) => (mantissa, exponent.parse::<i64>().unwrap_or(0)),
        None => (text, 0),
    };
    let (sign, mantissa) = match mantissa.strip_prefix('-') {
        Some(rest) => ("-", rest),
        None => ("", mantissa),
    };
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits = format!("{whole}{fraction}");
    let leading = digits.len() - digits.trim_start_matches('0').len();
    let significant = digits[leading..].trim_end_matches('0');
    if significant.is_empty() {
        return "0".to_owned();
    }
    // The value is 0.significant * 10^point.
    let point = whole.len() as i64 + exponent - leading as i64;
    positional(sign, significant, point, -5..=17)
}

impl Enclosure {
    /// The lower end as a decimal with `digits` significant digits, rounded down.
    #[must_use]
    pub fn lower_decimal(&self, digits: usize) -> String {
        decimal(&self.long()[0], digits, Round::Down)
    }

    /// The upper end as a decimal with `digits` significant digits, rounded up.
    #[must_use]
    pub fn upper_decimal(&self, digits: usize) -> String {
        decimal(&self.long()[1], digits, Round::Up)
    }

    /// Both ends as outward-rounded decimals with [`DIGITS`] significant digits.
    #[must_use]
    pub fn decimals(&self) -> [String; 2] {
        [self.lower_decimal(DIGITS), self.upper_decimal(DIGITS)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rug::Rational;

    #[test]
    fn decimals_are_outward_and_tidy() {
        let third = Enclosure::from_rational(&Rational::from((1, 3)), 128);
        assert_eq!(third.lower_decimal(5), "0.33333");
        assert_eq!(third.upper_decimal(5), "0.33334");
        let minus = -&third;
        assert_eq!(minus.lower_decimal(5), "-0.33334");
        assert_eq!(minus.upper_decimal(5), "-0.33333");
        for (value, text) in
            [((1, 1), "1"), ((0, 1), "0"), ((1250, 1), "1250"), ((1, 512), "0.001953125"), ((-49, 2), "-24.5")]
        {
            let exact = Enclosure::from_rational(&Rational::from(value), 64);
            assert_eq!(exact.lower_decimal(8), text);
            assert_eq!(exact.upper_decimal(8), text);
        }
        let tiny = Enclosure::from_rational(&Rational::from((1, 1 << 30)), 64);
        assert_eq!(tiny.lower_decimal(3), "9.31e-10");
        assert_eq!(tiny.upper_decimal(3), "9.32e-10");
        let huge = Enclosure::from_integer(1 << 62, 64);
        assert_eq!(huge.lower_decimal(4), "4.611e18");
        assert_eq!(Enclosure::entire(64).decimals(), ["-inf", "inf"]);
        assert_eq!(Enclosure::undefined(64).decimals(), ["undefined", "undefined"]);
    }
}
