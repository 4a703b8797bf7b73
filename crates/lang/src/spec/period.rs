//! The period of a plant or a specification, known exactly or to an interval (derivation, 13.3).

use super::constant::{positive_constant_in, whole};
use super::document::Value;
use super::error::{ErrorKind, Errors, Reported};
use super::input_gain::read_ordered;
use super::interval::no_list;
use super::parameters::Interval;
use super::parts::Constant;
use super::quantity::Quantity;
use crate::expr::{Definitions, Phase};
use rug::Rational;

/// Bits of the ends of a clock that are no ratio of exact numbers.
const PRECISION: u32 = 128;

/// The period T > 0: one number, or one constant in an interval around what it is nominally.
///
/// Who needs one number of it has to say which: [`Period::nominal`] is what documents, exports, figures and the oscillators are about;
/// a claim takes the end at which its bounds are largest.
#[derive(Clone, Debug)]
pub struct Period {
    nominal: Constant,
    /// The shortest and the longest period, which differ.
    ends: Option<Box<[Constant; 2]>>,
}

impl From<Constant> for Period {
    fn from(nominal: Constant) -> Period {
        Period { nominal, ends: None }
    }
}

impl Period {
    /// The period where it is known exactly, else its nominal value.
    #[must_use]
    pub fn nominal(&self) -> &Constant {
        &self.nominal
    }

    /// The shortest and the longest period, where only an interval is known.
    #[must_use]
    pub fn interval(&self) -> Option<&[Constant; 2]> {
        self.ends.as_deref()
    }

    /// The shortest period, T_lo.
    #[must_use]
    pub fn shortest(&self) -> &Constant {
        self.interval().map_or(&self.nominal, |[shortest, _]| shortest)
    }

    /// The longest period, T_hi.
    #[must_use]
    pub fn longest(&self) -> &Constant {
        self.interval().map_or(&self.nominal, |[_, longest]| longest)
    }

    /// The clock v = T_nom/T, where only an interval is known: time runs v times as fast as it does nominally. Its ends are outside of
    /// those of `[T_nom/T_hi, T_nom/T_lo]`, or these where they are rational.
    #[must_use]
    pub fn clock(&self) -> Option<Interval> {
        let [shortest, longest] = self.interval()?;
        let one = || Rational::from(1);
        let ([low, _], [_, high]) = (self.over(longest)?, self.over(shortest)?);
        Some(Interval { nominal: one(), low: low.min(one()), high: high.max(one()) })
    }

    /// Rational numbers around T_nom over a period; both are that number where it is rational. `None` beyond the range of exponents, which no
    /// period that was read comes near.
    fn over(&self, period: &Constant) -> Option<[Rational; 2]> {
        let exact = self.nominal.exact.as_ref().zip(period.exact.as_ref()).and_then(|(a, b)| a.div(b));
        if let Some(exact) = exact.as_ref().and_then(|ratio| ratio.as_rational()) {
            return Some([exact.clone(), exact.clone()]);
        }
        let enclosed = self.nominal.enclose(PRECISION) / period.enclose(PRECISION);
        Some([enclosed.lower_rational()?, enclosed.upper_rational()?])
    }

    /// The clock at another period, for simulations: it is rounded where it is not rational.
    #[must_use]
    pub fn clock_at(&self, period: &Constant) -> Option<Rational> {
        self.over(period).map(|[clock, _]| clock)
    }

    /// What `phase` and `t` are in formulas with this period.
    #[must_use]
    pub fn phase(&self) -> Phase {
        Phase::new(&self.nominal.expr, self.ends.is_none())
    }

    /// Whether the other one is certainly the same in all numbers, however they are written.
    #[must_use]
    pub fn is(&self, other: &Period) -> bool {
        let pairs =
            [(&self.nominal, &other.nominal), (self.shortest(), other.shortest()), (self.longest(), other.longest())];
        pairs
            .into_iter()
            .all(|(a, b)| a.text == b.text || Quantity::constant(a).equals(&Quantity::constant(b)).is_true())
    }
}

/// Reads a period: a positive constant, or three of them in order, in which the names may stand. An interval of one point is a period that
/// is known exactly.
///
/// # Errors
/// Reports numbers that are not positive, fields that are missing or unknown, and an order that fails or is not decided.
pub fn read_period(value: &Value<'_>, names: &Definitions, errors: &mut Errors) -> Result<Period, Reported> {
    no_list(value, errors)?;
    if value.type_name() != "an object" {
        return positive_constant_in(value, names, errors).map(Period::from);
    }
    let help = "the true period is one constant in [low, high], and the oscillators are set for `nominal`";
    let [nominal, low, high] = read_ordered(value, names, help, errors)?;
    let point = Quantity::constant(&low).equals(&Quantity::constant(&high)).is_true();
    Ok(Period { nominal, ends: (!point).then(|| Box::new([low, high])) })
}

/// That a field which needs a period that is known exactly does not stand beside an interval.
pub(super) fn needs_exact_period(
    period: &Period,
    value: &Value<'_>,
    what: &str,
    help: &str,
    errors: &mut Errors,
) -> Result<(), Reported> {
    let Some([low, high]) = period.interval() else { return Ok(()) };
    let message =
        format!("{what}, and of the period only is known that it lies between {} and {}", low.text, high.text);
    Err(errors.report(whole(value, ErrorKind::Matched, message).help(help)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::{Document, SpecErrors};

    fn read(text: &str) -> Result<Period, SpecErrors> {
        let document = Document::parse("period", text)?;
        let mut errors = Errors::new();
        let outcome = read_period(&document.root(), Definitions::none(), &mut errors);
        errors.conclude(&document, outcome)
    }

    #[test]
    fn the_clock_encloses_what_the_interval_says() {
        let exact = read(r#"{ "nominal": "1/50", "low": "1/50.2", "high": "1/49.8" }"#).unwrap().clock().unwrap();
        let hundredths = |n: i32| Rational::from((n, 1000));
        assert_eq!(exact, Interval { nominal: Rational::from(1), low: hundredths(996), high: hundredths(1004) });
        let turns = read(r#"{ "nominal": "2*pi", "low": "1.9*pi", "high": "2*pi" }"#).unwrap().clock().unwrap();
        assert_eq!([turns.low, turns.high], [Rational::from(1), Rational::from((20, 19))]);
        let mixed = read(r#"{ "nominal": "pi", "low": "3", "high": "10/3" }"#).unwrap().clock().unwrap();
        let [low, high] = [mixed.low.to_f64(), mixed.high.to_f64()];
        let pi = std::f64::consts::PI;
        assert!((low - pi * 0.3).abs() < 1e-15 && (high - pi / 3.0).abs() < 1e-15);
        for text in ["2", r#"{ "nominal": "1/2", "low": 0.5, "high": "2/4" }"#] {
            let point = read(text).unwrap();
            assert!(point.interval().is_none() && point.clock().is_none(), "{text}");
        }
        let turn = read("\"pi\"").unwrap();
        let faster = turn.nominal().over(&Rational::from((5, 4))).unwrap();
        assert!((faster.to_f64() - pi * 0.8).abs() < 1e-15 && faster.exact.is_some());
        assert_eq!(turn.clock_at(&faster), Some(Rational::from((5, 4))));
    }

    #[test]
    fn what_is_no_period_is_told() {
        for (text, told) in [
            ("0", "must be positive"),
            (r#"{ "nominal": 1, "low": 2, "high": 3 }"#, "low <= nominal fails"),
            (r#"{ "nominal": 1, "low": "1/2", "high": "pi/4" }"#, "high >= nominal fails"),
            (r#"{ "nominal": 1, "low": "1/2" }"#, "high"),
            (r#"{ "nominal": 1, "low": -1, "high": 2 }"#, "positive"),
            (r#"{ "nominal": 1, "low": 1, "high": 2, "width": 1 }"#, "width"),
        ] {
            let error = read(text).map(|_| ()).unwrap_err().to_string();
            assert!(error.contains(told), "{text}: {error}");
        }
    }
}
