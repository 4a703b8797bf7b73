//! What a number is likely to mean that is written in another unit, or rounded. For messages alone: no claim rests on it.

use super::parts::Constant;
use super::period::Period;
use rug::Rational;
use sigmastar_exact::number::{parse_decimal, write_exact};

/// By how much a base frequency in Hz may be off 1/period, as of a period that is rounded.
const NEAR: f64 = 0.01;

/// Whether a base frequency is about 1/period, in the place of 2 pi/period.
#[must_use]
pub fn is_in_hertz(frequency: &Constant, period: &Constant) -> bool {
    (frequency.to_f64() * period.to_f64() - 1.0).abs() < NEAR
}

/// 2 pi/period as it is written.
#[must_use]
pub fn matched_frequency(period: &Constant) -> String {
    match period.as_rational().map(|period| Rational::from(2) / period) {
        Some(ratio) if ratio == 1 => "pi".to_owned(),
        Some(ratio) => format!("{}*pi", write_exact(&ratio)),
        None => format!("2*pi/({})", period.text),
    }
}

/// The largest denominator of a fraction that is sought.
const LARGEST: u32 = 1000;

/// The longest decimal of which a fraction is sought.
const LONGEST: usize = 20;

/// The square of a denominator times the last place of a decimal, above which that is no sign of the fraction: the larger one for 1/10, 1/20, 1/30 and so on.
const SIGNS: [f64; 2] = [0.05, 0.5];

/// The fraction that the decimal of a period is likely to be rounded from, such as 1/3 for 0.333; `None` where it is none, or a decimal itself.
#[must_use]
pub fn rounded_from(period: &Period) -> Option<String> {
    let text = period.nominal().text.trim_matches(['(', ')', ' ']);
    let (_, places) = text.split_once('.')?;
    let digits = |text: &str| text.chars().all(|c| c.is_ascii_digit() || c == '.');
    if text.len() > LONGEST || !digits(text) {
        return None;
    }
    let value = parse_decimal(text).ok().filter(|value| *value > 0)?;
    let half = Rational::from((1, 2)) / places.chars().fold(Rational::from(1), |power, _| power * 10);
    // The simplest fraction that is rounded to this decimal.
    let (over, under) = (1..=LARGEST).find_map(|under| {
        let over = Rational::from(&value * under).round();
        let distance = (&over / Rational::from(under)) - &value;
        (over > 0 && distance.abs() <= half).then_some((over, under))
    })?;
    let without = |mut number: u32, factor: u32| {
        while number.is_multiple_of(factor) {
            number /= factor;
        }
        number
    };
    if without(without(under, 2), 5) == 1 {
        return None;
    }
    let [sign, of_tens] = SIGNS;
    let limit = if over == 1 && under.is_multiple_of(10) { of_tens } else { sign };
    (f64::from(under) * f64::from(under) * 2.0 * half.to_f64() <= limit).then(|| format!("{over}/{under}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{Expr, Variables};

    fn constant(text: &str) -> Constant {
        let expr = Expr::parse(text, Variables::None).unwrap();
        Constant { text: text.to_owned(), exact: expr.exact(), expr }
    }

    #[test]
    fn a_rounded_fraction_is_seen_and_a_decimal_is_none() {
        for (period, meant) in [
            ("0.333", Some("1/3")),
            ("(0.6667)", Some("2/3")),
            ("1.3333", Some("4/3")),
            ("0.0167", Some("1/60")),
            ("0.016667", Some("1/60")),
            ("0.143", Some("1/7")),
            ("0.33", None),
            ("0.3", None),
            ("0.02", None),
            ("0.125", None),
            ("0.017", None),
            ("0.347", None),
            ("24", None),
            ("24.0", None),
            ("1/3", None),
            ("0.3e0", None),
            ("1e-3", None),
        ] {
            assert_eq!(rounded_from(&constant(period).into()).as_deref(), meant, "{period}");
        }
    }

    #[test]
    fn a_base_frequency_in_hertz_is_told_apart_from_others() {
        let period = constant("1/50");
        let is = |frequency: &str| is_in_hertz(&constant(frequency), &period);
        assert!(is("50") && is("49.9") && !is("100*pi") && !is("314") && !is("25") && !is("51"));
        assert_eq!([&period, &constant("2"), &constant("pi")].map(matched_frequency), ["100*pi", "pi", "2*pi/(pi)"]);
    }
}
