//! Trials in short rationals.

use super::{FloatTrial, TrialLoop};
use crate::orbit::FloatSeries;
use rug::{Integer, Rational};
use sigmastar_lang::plant::CurveTerm;
use sigmastar_lang::spec::{TrigonometricVector, Wave};

/// Coefficients that are smaller than this share of the size of a solution are left out, and others rounded to it.
const GRAIN: f64 = 1e-16;

/// The shares of q, and of what of it drives the error, that may be left out: each harmonic of ehat makes all that is evaluated around the trial
/// slower. The bounds of |zeta|, and with them those of peaks, are many times what is left out.
const LEFT_OUT: [f64; 2] = [1e-10, 1e-5];

impl TrialLoop<'_> {
    /// The term with these powers, whose product is at most `scale` for all members: ehat has neither a mean nor harmonics of oscillators, and uhat is what the
    /// regulator answers it with at the others.
    #[must_use]
    pub fn term(&self, trial: &FloatTrial, powers: Vec<u32>, scale: f64) -> CurveTerm {
        let FloatTrial { series, sizes } = trial;
        let n = sizes.len() - 2;
        let own = |series: &FloatSeries, i: usize| component(series, i, sizes[i] / scale);
        let mut error = own(series, n);
        error.mean = Rational::new();
        for (_, pair) in (1..).zip(&mut error.harmonics).filter(|(k, _)| self.oscillators.meets(*k)) {
            *pair = Default::default();
        }
        if self.or_more {
            error.harmonics.clear();
        }
        self.leave_out(&mut error, series);
        // (re + i im)(a - i b) = (a re + b im) - i (b re - a im).
        let period = self.plant.period.nominal().to_f64();
        let mut answered = series.clone();
        for (k, pair) in answered.harmonics.iter_mut().enumerate().filter(|(k, _)| !self.oscillators.meets(k + 1)) {
            let [a, b] = error.harmonics.get(k).map_or([0.0; 2], |pair| pair.each_ref().map(Rational::to_f64));
            let [re, im] = self.answer(k + 1, period);
            (pair[0][n + 1], pair[1][n + 1]) = (-(a * re + b * im), a * im - b * re);
        }
        let waves: Vec<Wave> = (0..n).map(|i| own(series, i)).collect();
        let degree = waves.iter().map(|wave| wave.harmonics.len()).max().unwrap_or(0);
        let part = |k: usize, which: usize| {
            let of = |wave: &Wave| wave.harmonics.get(k).map_or_else(Rational::new, |pair| pair[which].clone());
            waves.iter().map(of).collect()
        };
        let states = TrigonometricVector {
            mean: waves.iter().map(|wave| wave.mean.clone()).collect(),
            harmonics: (0..degree).map(|k| [part(k, 0), part(k, 1)]).collect(),
        };
        CurveTerm { powers, states, error, control: own(&answered, n + 1) }
    }
}

impl TrialLoop<'_> {
    /// Leaves out the harmonics of ehat that little of q belongs to.
    fn leave_out(&self, error: &mut Wave, series: &FloatSeries) {
        let period = self.plant.period.nominal().to_f64();
        let of_q = |(k, [cos, sin]): (usize, &[Rational; 2])| {
            let [re, im] = self.inverse_answer(k, period);
            (k, libm::hypot(cos.to_f64(), sin.to_f64()) * libm::hypot(re, im))
        };
        let mut sizes: Vec<_> =
            (1..).zip(&error.harmonics).filter(|(k, _)| !self.oscillators.meets(*k)).map(of_q).collect();
        sizes.sort_by(|(_, a), (_, b)| a.total_cmp(b));
        let control = series.mean.len() - 1;
        let all = series.harmonics.iter().map(|[cos, sin]| libm::hypot(cos[control], sin[control])).sum::<f64>();
        let of_error = sizes.iter().map(|(_, size)| size).sum::<f64>();
        let enough = (LEFT_OUT[0] * all).min(LEFT_OUT[1] * of_error);
        let mut left_out = 0.0;
        for (k, size) in sizes {
            left_out += size;
            if left_out > enough {
                break;
            }
            error.harmonics[k - 1] = Default::default();
        }
        drop_last_zeros(&mut error.harmonics);
    }
}

/// A component, rounded to the largest power of ten that is at most [`GRAIN`] of a size; without the last harmonics that are 0 then.
fn component(series: &FloatSeries, i: usize, size: f64) -> Wave {
    let places = if size > 0.0 { -libm::log10(size * GRAIN).floor() } else { 0.0 };
    let power = Rational::from(Integer::from(Integer::u_pow_u(10, places.abs().min(330.0) as u32)));
    let power = if places >= 0.0 { power } else { power.recip() };
    let short = |value: f64| {
        let exact = Rational::from_f64(value);
        exact.map_or_else(Rational::new, |value| Rational::from(&value * &power).round() / &power)
    };
    let pair = |[a, b]: &[Vec<f64>; 2]| [short(a[i]), short(b[i])];
    let mut harmonics: Vec<[Rational; 2]> = series.harmonics.iter().map(pair).collect();
    drop_last_zeros(&mut harmonics);
    Wave { mean: short(series.mean[i]), harmonics }
}

fn drop_last_zeros(harmonics: &mut Vec<[Rational; 2]>) {
    while harmonics.last().is_some_and(|[cos, sin]| *cos == 0 && *sin == 0) {
        harmonics.pop();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sigmastar_lang::plant::Plant;
    use sigmastar_lang::spec::Document;

    const PLANT: &str = r#"{
        "format": "sigmastar/plant", "version": 1, "name": "no state", "period": 1, "states": [], "f": [], "q": "-e + sin(phase)",
        "internal_model": {
            "mu": 1, "base_frequency": "2*pi", "matched": true, "weights": { "family": "power", "n0": 2, "epsilon": "1/2" }
        }
    }"#;

    /// Which harmonics of an error are left that belong to these sizes of q, where q has this size; without oscillators.
    fn left(of_q: [f64; 4], all: f64) -> Vec<bool> {
        let plant = Plant::from_value(&Document::parse("no state", PLANT).unwrap().root()).unwrap();
        let own = TrialLoop {
            plant: &plant,
            gain: 1.0,
            sigma: 3.0,
            samples: None,
            mu: 1.0,
            oscillators: 0.into(),
            weights: vec![2.0],
            resolved: 1e-15,
            or_more: false,
        };
        let of_error = |(k, size): (usize, f64)| {
            let [re, im] = own.inverse_answer(k, 1.0);
            [Rational::new(), Rational::from_f64(size / libm::hypot(re, im)).unwrap()]
        };
        let mut error = Wave { mean: Rational::new(), harmonics: (1..).zip(of_q).map(of_error).collect() };
        // e and u; of u half in each of two harmonics.
        let half = [vec![0.0, 0.0], vec![0.0, all / 2.0]];
        let series = FloatSeries { mean: vec![0.0, 0.0], harmonics: vec![half.clone(), half] };
        own.leave_out(&mut error, &series);
        error.harmonics.iter().map(|[_, sin]| *sin != 0).collect()
    }

    #[test]
    fn harmonics_are_left_out_from_the_smallest_on_while_their_sum_is_small() {
        // At most 1e-10 of q, where that is less than a hundred-thousandth of what drives the error.
        let most = 2e-10;
        assert_eq!(left([1.0, 0.59 * most, 0.40 * most, 0.5], 2.0), [true, false, false, true]);
        assert_eq!(left([1.0, 0.59 * most, 0.42 * most, 0.5], 2.0), [true, true, false, true]);
        assert_eq!(left([1.0, 1.01 * most, 1.02 * most, 0.5], 2.0), [true; 4]);
        // The last ones are dropped.
        assert_eq!(left([1.0, 0.5, 0.59 * most, 0.40 * most], 2.0), [true, true]);
        assert_eq!(left([1.0, 0.5, 0.42 * most, 0.59 * most], 2.0), [true, true, false, true]);
        // Else at most a hundred-thousandth of what drives the error, 1.5.
        let most = 1.5e-5;
        assert_eq!(left([1.0, 0.59 * most, 0.40 * most, 0.5], 1e9), [true, false, false, true]);
        assert_eq!(left([1.0, 0.59 * most, 0.42 * most, 0.5], 1e9), [true, true, false, true]);
    }
}
