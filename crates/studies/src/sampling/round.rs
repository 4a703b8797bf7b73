//! Round sampling periods: what is easily set on a timer.

use rug::{Integer, Rational};
use sigmastar_lang::spec::{Constant, MAX_SAMPLES, Sampling};

/// What is 1, 2 or 5 times a power of ten.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RoundForm {
    /// The sampling period, of which the period is a whole multiple.
    Period,
    /// The number of samples in a period, where no such sampling period is short enough.
    Samples,
}

/// The round sampling periods with at least so many samples in a period, the longest first. The period is a whole multiple of each,
/// exactly.
pub(super) fn round_samplings(period: &Constant, least: u32) -> (RoundForm, Vec<Sampling>) {
    let samples = least..=MAX_SAMPLES;
    let at = |step: Constant| Sampling::new(period, step).filter(|sampling| samples.contains(&sampling.samples));
    let steps: Vec<Sampling> =
        period.as_rational().into_iter().flat_map(|period| steps(period, least)).filter_map(at).collect();
    if !steps.is_empty() {
        return (RoundForm::Period, steps);
    }
    let counts = (0..10).flat_map(|k| [1, 2, 5].map(|digit| digit * 10_u64.pow(k)));
    let counts = counts.filter_map(|count| u32::try_from(count).ok()).filter(|count| samples.contains(count));
    (RoundForm::Samples, counts.filter_map(|count| at(period.divided_by(count)?)).collect())
}

/// 1, 2 or 5 times powers of ten, the largest first: all from about T/least down to T/MAX_SAMPLES.
fn steps(period: &Rational, least: u32) -> Vec<Constant> {
    let longest = Rational::from(period / least.max(1));
    let shortest = Rational::from(period / MAX_SAMPLES);
    // The power of ten above it, by the number of digits; one more is filtered out again.
    let digits = |integer: &Integer| integer.to_string().len() as i64;
    let top = digits(longest.numer()) - digits(longest.denom()) + 1;
    let power = |exponent: i64| {
        let power =
            Rational::from(Integer::from(Integer::u_pow_u(10, u32::try_from(exponent.unsigned_abs()).unwrap_or(0))));
        if exponent < 0 { power.recip() } else { power }
    };
    let all = (0..).flat_map(|down| [5, 2, 1].map(|digit| digit * power(top - down)));
    all.skip_while(|step| *step > longest)
        .take_while(|step| *step >= shortest)
        .map(|step| Constant::rational(&step))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use sigmastar_lang::spec::{Document, Errors, positive_constant};

    fn of(period: &str, least: u32) -> (RoundForm, Vec<u32>, String) {
        let document = Document::flag("T", period);
        let mut errors = Errors::new();
        let constant = positive_constant(&document.at("/T").unwrap(), &mut errors).unwrap();
        let (form, all) = round_samplings(&constant, least);
        assert!(all.windows(2).all(|pair| pair[0].samples < pair[1].samples));
        let first = all.first().map(Sampling::text).unwrap_or_default();
        (form, all.iter().map(|sampling| sampling.samples).take(4).collect(), first)
    }

    #[test]
    fn the_period_is_a_whole_multiple_of_each() {
        assert_eq!(of("1", 437), (RoundForm::Period, vec![500, 1000, 2000, 5000], "0.002".to_owned()));
        assert_eq!(of("1", 500), (RoundForm::Period, vec![500, 1000, 2000, 5000], "0.002".to_owned()));
        assert_eq!(of("1/50", 21), (RoundForm::Period, vec![40, 100, 200, 400], "0.0005".to_owned()));
        assert_eq!(of("3", 2), (RoundForm::Period, vec![3, 6, 15, 30], "1".to_owned()));
        assert_eq!(of("7e9", 2), (RoundForm::Period, vec![7, 14, 35, 70], "1000000000".to_owned()));
        assert_eq!(of("7e-9", 60_000).1, Vec::<u32>::new());
    }

    #[test]
    fn where_there_is_none_the_samples_are_round() {
        assert_eq!(of("1/3", 99), (RoundForm::Samples, vec![100, 200, 500, 1000], "1/300".to_owned()));
        let (form, samples, first) = of("2*pi", 100);
        assert_eq!((form, samples), (RoundForm::Samples, vec![100, 200, 500, 1000]));
        assert!(first.contains("pi"), "{first}");
        assert_eq!(of("1/3", 60_000).1, Vec::<u32>::new());
    }
}
