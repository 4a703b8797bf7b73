//! The samples of a computer that runs the regulator (derivation, 12): a whole number of them in a period, proved.

use super::constant::{positive_constant_in, whole};
use super::document::Value;
use super::error::{ErrorKind, Errors, Reported};
use super::parts::Constant;
use super::quantity::Quantity;
use crate::expr::Definitions;
use rug::{Float, Rational};
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_exact::number::write_exact;

/// The most samples in a period that are read: every harmonic of them is looked at one by one.
pub const MAX_SAMPLES: u32 = 1 << 16;

/// Bits at which K and Nb2 are enclosed before they are rounded.
pub(super) const PRECISION: u32 = 512;

/// The sampling period h, with T/h samples in a period T.
#[derive(Clone, Debug)]
pub struct Sampling {
    /// h > 0, a time.
    pub step: Constant,
    /// T/h, proved: at least 2, at most [`MAX_SAMPLES`].
    pub samples: u32,
    /// Whether a control takes the sample after its measurement to be computed, `delay_samples` 1 (derivation, 13.4).
    pub delayed: bool,
}

/// K and Nb2 of the law at samples, both doubles, exactly: what an exported regulator runs with.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SampledGain {
    /// K, near mu/(1 + theta) with theta = h mu Nbar^2/2.
    pub gain: Rational,
    /// Nb2, not below the sum of all weights.
    pub weight_sum: Rational,
}

/// Reads `delay_samples`: whether it is 1.
///
/// # Errors
/// What is neither 0 nor 1.
pub fn read_delay(value: &Value<'_>, errors: &mut Errors) -> Result<bool, Reported> {
    match value.integer(errors)? {
        0 => Ok(false),
        1 => Ok(true),
        more => {
            let error = whole(value, ErrorKind::Range, format!("a control takes {more} samples to be computed"));
            let help = "where it takes longer than a sample, take a longer sampling period";
            Err(errors.report(error.expected("expected 0 or 1").help(help)))
        }
    }
}

/// Reads h and proves that T/h is a whole number of at least 2; `matched` says whether the base frequency is 2 pi/T.
///
/// # Errors
/// A constant that is not positive; a base frequency that is not matched; a number of samples that is not whole, below 2, above
/// [`MAX_SAMPLES`], or not known exactly.
pub(super) fn read(
    (value, delayed): (&Value<'_>, bool),
    period: &Constant,
    matched: Result<bool, Reported>,
    names: &Definitions,
    errors: &mut Errors,
) -> Result<Sampling, Reported> {
    let step = positive_constant_in(value, names, errors)?;
    if !matched? {
        let message = "the regulator at samples needs a base frequency of 2 pi / period";
        let error = whole(value, ErrorKind::Matched, message).expected("expected `\"matched\": true` beside it");
        return Err(
            errors.report(error.help("or leave `sampling_period` out: the continuous-time regulator does without"))
        );
    }
    match samples(period, &step) {
        Ok(samples) => Ok(Sampling { step, samples, delayed }),
        Err(problem) => {
            let (kind, message) = problem.describe(period);
            let expected = format!("expected period / sampling_period to be a whole number from 2 to {MAX_SAMPLES}");
            Err(errors.report(whole(value, kind, message).expected(expected).help(problem.way_out(period, &step))))
        }
    }
}

/// Why there is no whole number of samples in a period.
enum Problem {
    /// It is this number, about the second one.
    NotWhole(String, f64),
    /// It is whole, and out of range.
    Range(String),
    /// It is not known exactly.
    Undecided,
}

impl Problem {
    fn describe(&self, period: &Constant) -> (ErrorKind, String) {
        let ratio = format!("period / sampling_period, with the period {},", period.text);
        match self {
            Problem::NotWhole(shown, _) => (ErrorKind::Range, format!("{ratio} is {shown}, not a whole number")),
            Problem::Range(shown) => (ErrorKind::Range, format!("{ratio} is {shown}")),
            Problem::Undecided => (ErrorKind::Undecided, format!("{ratio} is not known exactly")),
        }
    }

    fn way_out(&self, period: &Constant, step: &Constant) -> String {
        if let Some(time) = self.of_a_rate(period, step) {
            return format!(
                "it is the time between two samples: for {} samples in a unit of time write `{time}`",
                step.text
            );
        }
        let share = |count: u32| period.divided_by(count).map_or_else(String::new, |share| share.text);
        match self {
            Problem::NotWhole(_, ratio) => {
                let near: Vec<String> = near(*ratio)
                    .into_iter()
                    .enumerate()
                    .map(|(at, count)| {
                        let of_what = if at == 0 { " samples in a period" } else { "" };
                        format!("`{}` ({count}{of_what})", share(count))
                    })
                    .collect();
                match near.split_last() {
                    None => "take another sampling period".to_owned(),
                    Some((only, [])) => format!("such as {only}"),
                    Some((last, others)) => format!("such as {} or {last}", others.join(", ")),
                }
            }
            Problem::Range(_) => "take another sampling period".to_owned(),
            Problem::Undecided => format!("write it as a fraction of the period, as `{}`", share(100)),
        }
    }

    /// The sampling period of a number that is longer than the period and would be right as samples in a unit of time.
    fn of_a_rate(&self, period: &Constant, step: &Constant) -> Option<String> {
        let rate = step.as_rational().filter(|rate| rate.to_f64() > period.to_f64())?;
        let time = Constant::rational(&Rational::from(rate.recip_ref()));
        let text = if rate.is_integer() { format!("1/{rate}") } else { time.text.clone() };
        samples(period, &time).is_ok().then_some(text)
    }
}

/// The whole numbers of samples around a number that is not whole, and those around it with one digit beside zeros, in order.
fn near(ratio: f64) -> Vec<u32> {
    let mut ten = 1.0;
    while ten * 10.0 <= ratio && ten < f64::from(MAX_SAMPLES) {
        ten *= 10.0;
    }
    let mut all: Vec<u32> = [ratio.floor(), ratio.ceil(), (ratio / ten).floor() * ten, (ratio / ten).ceil() * ten]
        .into_iter()
        .filter(|count| *count >= 2.0 && *count <= f64::from(MAX_SAMPLES))
        .map(|count| count as u32)
        .collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// T/h, decided exactly.
fn samples(period: &Constant, step: &Constant) -> Result<u32, Problem> {
    let ratio = period.exact.as_ref().zip(step.exact.as_ref()).and_then(|(period, step)| period.div(step));
    let Some(ratio) = ratio else {
        // Without exact forms two numbers can be told apart, and not be proved equal.
        let ratio = period.enclose(PRECISION) / step.enclose(PRECISION);
        let nearest = Rational::try_from(Float::with_val(PRECISION, ratio.lower()).ceil());
        return Err(match nearest {
            Ok(nearest) if !ratio.contains(&nearest) && ratio.is_bounded() => {
                let value = ratio.midpoint_f64();
                Problem::NotWhole(format!("about {value:.6}"), value)
            }
            _ => Problem::Undecided,
        });
    };
    let shown = Quantity::exact(ratio.clone()).shown();
    match ratio.as_rational() {
        Some(whole) if *whole.denom() == 1 => match whole.numer().to_u32() {
            Some(samples) if (2..=MAX_SAMPLES).contains(&samples) => Ok(samples),
            _ => Err(Problem::Range(shown)),
        },
        _ => Err(Problem::NotWhole(shown, ratio.enclose(PRECISION).midpoint_f64())),
    }
}

impl Sampling {
    /// The samples h apart in a period, where there is a whole number of them in range; without a delay.
    #[must_use]
    pub fn new(period: &Constant, step: Constant) -> Option<Sampling> {
        samples(period, &step).ok().map(|samples| Sampling { step, samples, delayed: false })
    }

    /// These samples, with a delay or without one.
    #[must_use]
    pub fn with_delay(self, delayed: bool) -> Sampling {
        Sampling { delayed, ..self }
    }

    /// Whether two sampling periods are the same number, as far as that is known exactly.
    #[must_use]
    pub fn is(&self, step: &Constant) -> bool {
        let exact = self.step.exact.as_ref().zip(step.exact.as_ref());
        exact.is_some_and(|(own, other)| own.equals(other).is_true())
    }

    /// h as a certificate writes it: the rational number, else the text of the file.
    #[must_use]
    pub fn text(&self) -> String {
        self.step.as_rational().map_or_else(|| self.step.text.clone(), write_exact)
    }

    /// Whether h sigma <= 1, exactly where h is rational.
    #[must_use]
    pub fn fits(&self, sigma: &Rational) -> Truth {
        match self.step.as_rational() {
            Some(step) => Truth::exact(Rational::from(step * sigma) <= 1),
            None => {
                let product = Enclosure::from_rational(sigma, PRECISION) * self.step.enclose(PRECISION);
                product.le(&Enclosure::one(PRECISION))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sampling_periods_on_both_sides_are_offered() {
        let told = |period: (i32, i32), step: (i32, i32)| {
            let [period, step] = [period, step].map(|ratio| Constant::rational(&Rational::from(ratio)));
            samples(&period, &step).unwrap_err().way_out(&period, &step)
        };
        assert_eq!(
            told((1, 3), (1, 1000)),
            "such as `1/900` (300 samples in a period), `1/999` (333), `1/1002` (334) or `1/1200` (400)"
        );
        assert_eq!(told((1, 1), (2, 3)), "such as `0.5` (2 samples in a period)");
        assert_eq!(told((1, 1), (9, 10)), "such as `0.5` (2 samples in a period)");
        assert_eq!(told((1, 1), (1, 999_999)), "take another sampling period");
    }

    /// Where samples in a unit of time stand in the place of the time between two: also such that are no whole number.
    #[test]
    fn a_rate_is_told_as_the_time_between_two_samples() {
        let constant = |p: i32, q: i32| Constant::rational(&Rational::from((p, q)));
        let told = |period: Constant, step: Constant| Problem::Undecided.of_a_rate(&period, &step);
        assert_eq!(told(constant(1, 1), constant(500, 1)).as_deref(), Some("1/500"));
        let time = told(constant(6, 1), constant(7, 1)).zip(told(constant(6, 7), constant(7, 3)));
        assert_eq!(time.as_ref().map(|(whole, part)| (whole.as_str(), part.as_str())), Some(("1/7", "3/7")));
        // Neither is one of these a rate of a whole number of samples, nor longer than the period.
        assert_eq!((told(constant(1, 1), constant(3, 2)), told(constant(1, 1), constant(2, 7))), (None, None));
    }
}
