//! What a number is likely to mean that is written in another unit, or rounded. For messages alone: no claim rests on it.

use super::parts::Constant;
use super::period::Period;
use rug::Rational;
use sigmastar_exact::number::{parse_decimal, write_exact};

/// Other units of a frequency: what stands over the period; by how much of it a number may be off, as of a period that is rounded, short of what may be a
/// harmonic or half of one (57 times 2 pi is 358.1, 19/2 times 2 pi is 59.7); and what that is.
const UNITS: [(f64, f64, &str); 3] = [
    (1.0, 0.01, "1/period, a frequency in cycles per unit of time (Hz)"),
    (60.0, 0.004, "60/period, a frequency in revolutions per minute if time is in seconds"),
    (360.0, 0.004, "360/period, a frequency in degrees per unit of time"),
];

/// What a base frequency is that is about 2 pi/period in another unit.
#[must_use]
pub fn in_another_unit(frequency: &Constant, period: &Constant) -> Option<&'static str> {
    let turns = frequency.to_f64() * period.to_f64();
    UNITS.iter().find(|(turn, near, _)| (turns / turn - 1.0).abs() < *near).map(|(_, _, unit)| *unit)
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
    fn a_base_frequency_in_another_unit_is_told_apart_from_others() {
        let period = constant("1/50");
        let unit = |frequency: &str| in_another_unit(&constant(frequency), &period);
        for (frequencies, meant) in [
            (["50", "49.9"], Some("(Hz)")),
            (["3000", "2990"], Some("revolutions per minute")),
            (["18000", "18050"], Some("degrees")),
            (["100*pi", "314"], None),
            (["25", "51"], None),
            (["2900", "9000"], None),
            // Harmonics, and half of one.
            (["57*100*pi", "19*50*pi"], None),
        ] {
            for frequency in frequencies {
                let found = unit(frequency);
                let is =
                    found.zip(meant).map_or(found.is_none() && meant.is_none(), |(found, meant)| found.contains(meant));
                assert!(is, "{frequency}: {found:?}");
            }
        }
        assert_eq!([&period, &constant("2"), &constant("pi")].map(matched_frequency), ["100*pi", "pi", "2*pi/(pi)"]);
    }
}
