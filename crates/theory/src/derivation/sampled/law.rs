//! The numbers of the law at samples (derivation, 12): h, K, theta, and the sines of its harmonics.

use crate::data::{Data, Numbers, Problem};
use crate::derivation::control::Answer;
use crate::input_gain::InputGain;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::real::{Operand, Real};
use sigmastar_lang::spec::{SampledGain, Sampling};
use std::sync::Arc;

/// With more samples than these 1 + theta, which is then nearly 1, stands for every Sb_j.
pub const SHARP_SAMPLES: u32 = 8192;

/// The law at samples h apart, N_s of them in a period, with the gain K.
#[derive(Clone, Debug)]
pub struct SampledLaw<R> {
    /// h.
    pub step: R,
    /// N_s = T/h.
    pub samples: u32,
    /// K.
    pub gain: R,
    /// Nb2, at least the sum of all weights.
    pub weight_sum: R,
    /// 1 + theta := 1/(1 - K h Nb2/2); meaningful where K h Nb2 < 2. With an input gain that of b_hi K, the largest one.
    pub enlarged: R,
    /// mu := K (1 + theta), the mu of every formula of section 12; with an input gain that of b_lo K.
    pub mu: R,
    /// K (1 + theta) of K itself, which is the mu that is asked for.
    pub nominal_mu: R,
    /// Whether a control takes the sample after its measurement to be computed (derivation, 13.4).
    pub delayed: bool,
    /// Whether it is to be for every set of harmonics below N_s/2 that contains 0 (derivation, 14.7), not for the first n_o alone.
    pub every_set: bool,
    /// The interval of the input gain; none where it is 1 (derivation, 13.1).
    pub input_gain: Option<InputGain<R>>,
    /// pi.
    pub pi: R,
    /// sin^2(pi j/N_s) for j = 1, ..., floor(N_s/2).
    pub sines: Arc<Vec<R>>,
}

/// The samples of a law: h, N_s, whether it has a delay, and whether it is for every set of harmonics.
struct Samples<R> {
    step: R,
    samples: u32,
    delayed: bool,
    every_set: bool,
}

impl SampledLaw<Enclosure> {
    /// Encloses the numbers at the precision of the data.
    #[must_use]
    pub fn new(data: &Data<'_>, sampling: &Sampling, gain: &SampledGain) -> SampledLaw<Enclosure> {
        let pi = Enclosure::pi(data.precision);
        let samples = Enclosure::from_integer(i64::from(sampling.samples), data.precision);
        let unit = &pi / &samples;
        let sine = |j: u32| (i64::from(j) * &unit).sin().sqr();
        let sines = (1..=sampling.samples / 2).map(sine).collect();
        let [step, gain, weight_sum] =
            [sampling.step.enclose(data.precision), data.rational(&gain.gain), data.rational(&gain.weight_sum)];
        let of = Samples {
            step,
            samples: sampling.samples,
            delayed: sampling.delayed,
            every_set: data.spec.internal_model.asks_every_set(),
        };
        SampledLaw::with(of, [gain, weight_sum], data.input_gain.clone(), (pi, sines))
    }

    /// This law in doubles, for a search.
    #[must_use]
    pub fn to_f64(&self) -> SampledLaw<f64> {
        let [step, gain, weight_sum, pi] =
            [&self.step, &self.gain, &self.weight_sum, &self.pi].map(Enclosure::midpoint_f64);
        let sines = self.sines.iter().map(Enclosure::midpoint_f64).collect();
        let input_gain = self.input_gain.as_ref().map(InputGain::midpoints);
        let of = Samples { step, samples: self.samples, delayed: self.delayed, every_set: self.every_set };
        SampledLaw::with(of, [gain, weight_sum], input_gain, (pi, sines))
    }
}

impl<R: Real> SampledLaw<R>
where
    for<'a> &'a R: Operand<R>,
{
    fn with(
        Samples { step, samples, delayed, every_set }: Samples<R>,
        [gain, weight_sum]: [R; 2],
        input_gain: Option<InputGain<R>>,
        (pi, sines): (R, Vec<R>),
    ) -> SampledLaw<R> {
        let enlarged = |gain: &R| R::int(1) / (R::int(1) - gain * &step * &weight_sum / R::int(2));
        let nominal = enlarged(&gain);
        let nominal_mu = &gain * &nominal;
        let (enlarged, mu) = match &input_gain {
            None => (nominal, nominal_mu.clone()),
            Some(InputGain { low, high }) => {
                let least = low * &gain;
                (enlarged(&(high * &gain)), enlarged(&least) * least)
            }
        };
        let sines = Arc::new(sines);
        SampledLaw {
            step,
            samples,
            gain,
            weight_sum,
            enlarged,
            mu,
            nominal_mu,
            delayed,
            every_set,
            input_gain,
            pi,
            sines,
        }
    }

    /// K h Nb2, to be below 2; with an input gain that of b_hi K.
    #[must_use]
    pub fn load(&self) -> R {
        let load = &self.gain * &self.step * &self.weight_sum;
        self.input_gain.as_ref().map_or_else(|| load.clone(), |gain| &gain.high * &load)
    }

    /// |y_j| is at most so many times |qb_j|, without an input gain: 1 + theta; with a delay 1 + th1 := 1/(1 - 3 K h Nb2/2), meaningful
    /// where 3 K h Nb2 < 2 (that of b_hi K where there is a gain).
    #[must_use]
    pub fn of_y(&self) -> R {
        if self.delayed { R::int(1) / (R::int(1) - self.lost() * R::int(3)) } else { self.enlarged.clone() }
    }

    /// Whether (S3) sharpens the bounds of the harmonics of y (derivation, 12.1): it is proved for the first n_o harmonics, not with a delay, and taken
    /// up to 8192 samples.
    #[must_use]
    pub fn is_sharp(&self) -> bool {
        !self.delayed && !self.every_set && self.samples <= SHARP_SAMPLES
    }

    /// 1 + h sigma with a delay, 1 without: e_j = (1 + h sigma E^-1) y_j/D_j, E = e^{i om h}.
    #[must_use]
    pub fn of_delay(&self, sigma: &R) -> R {
        if self.delayed { R::int(1) + &self.step * sigma } else { R::int(1) }
    }

    /// theta/(1 + theta) = K h Nb2/2.
    #[must_use]
    pub fn lost(&self) -> R {
        self.load() / R::int(2)
    }

    /// nu = mu/w.
    #[must_use]
    pub fn nu(&self, problem: &impl Problem<R>) -> R {
        let Numbers { base_frequency, .. } = problem.numbers();
        &self.mu / base_frequency
    }

    /// What the control makes of the harmonics of the means of q (derivation, 13.5): with g = 2 Y/(2 - h sigma), Y = `of_means` the bound of
    /// |y|_s over |qb|_s, 1 + theta without an input gain, F is 2/sqrt(4 - g) up to g = 3 and g - 1 above, with an input gain
    /// `(1 + g)/b_lo`, with a delay 1 + g with (1 + h sigma) Y for Y; and the sum of all |u_j| is at most `F sqrt((T^2 - h^2)/12)` times rms(q').
    ///
    /// u_j = (P Y_j - 1) q_j where P = (E - 1)/(E - a), E = e^{i om h}, is on the circle over [0, 2/(2 - h sigma)] and Y_j on that over
    /// [0, 1 + theta]; with an input gain b u_j = (E - 1) e_j/h - q_j, e_j = h y_j/(E - a).
    #[must_use]
    pub fn answer(&self, sigma: &R, period: &R, of_means: &R) -> Answer<R> {
        let most = R::int(2) * of_means / (R::int(2) - &self.step * sigma);
        let (mean, harmonic) = match &self.input_gain {
            Some(gain) => (R::int(1) / &gain.low, (R::int(1) + most) / &gain.low),
            None if self.delayed => (R::int(1), R::int(1) + most),
            None if (R::int(3) - &most).is_certainly_positive() => (R::int(1), R::int(2) / (R::int(4) - most).sqrt()),
            None => (R::int(1), R::int(2).max(&(most - R::int(1)))),
        };
        let by_rate = &harmonic * ((period.sqr() - self.step.sqr()) / R::int(12)).sqrt();
        Answer { mean, harmonic, by_rate }
    }

    /// om_j^2 = (4/h^2) sin^2(pi j/N_s) of one of the sines.
    #[must_use]
    pub fn frequency_squared(&self, sine: &R) -> R {
        R::int(4) * sine / self.step.sqr()
    }

    /// om_1^2.
    #[must_use]
    pub fn first_frequency_squared(&self) -> R {
        // There are at least two samples, so at least one sine.
        self.sines.first().map_or_else(R::unknown, |sine| self.frequency_squared(sine))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::derivation::sampled::examples::{example, law};
    use serde_json::json;

    /// theta of the largest gain, mu of the smallest one, and the mu that is asked for as without an interval.
    #[test]
    fn an_input_gain_moves_theta_and_mu() {
        let of = |gain: Option<[&str; 3]>| {
            let spec = example(50, "3", |file| {
                if let Some([nominal, low, high]) = gain {
                    file["input_gain"] = json!({ "nominal": nominal, "low": low, "high": high });
                }
            });
            law(&Data::new(&spec, 128)).to_f64()
        };
        let plain = of(None);
        let close = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-14;
        assert!(close(plain.load(), plain.gain * 0.02 * plain.weight_sum) && close(plain.mu, plain.nominal_mu));
        let known = of(Some(["2", "2", "2"]));
        assert!(close(known.mu, plain.mu) && close(known.enlarged, plain.enlarged) && known.input_gain.is_none());
        // b from 1/2 to 3/2.
        let wide = of(Some(["2", "1", "3"]));
        assert!(close(wide.gain, plain.gain) && close(wide.nominal_mu, plain.nominal_mu));
        assert!(close(wide.load(), 1.5 * plain.load()) && close(wide.lost(), 0.75 * plain.load()));
        assert!(close(wide.enlarged, 1.0 / (1.0 - 0.75 * plain.load())));
        assert!(close(wide.mu, 0.5 * plain.gain / (1.0 - 0.25 * plain.load())));
    }
}
