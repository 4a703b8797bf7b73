//! Which sampling times cannot work, decided with exact numbers or outward rounding.

use super::Design;
use super::design::PRECISION;
use rug::{Float, Rational};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::expr::Monomial;
use sigmastar_lang::spec::Constant;
use std::cmp::Ordering;
use thiserror::Error;

/// Why a regulator is known to work badly, or not at all, at a sampling time.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum SamplingError {
    /// h sigma is not proved to be at most 1.
    #[error("h sigma = {product:.6} with the sampling time h: above 1 the error changes its sign from sample to sample{}",
        if *.product < 2.0 { "" } else { ", and from 2 on it grows" })]
    TooSlowForSigma {
        /// h sigma.
        product: f64,
        /// 1/sigma, rounded down.
        below: f64,
    },
    /// The fastest oscillator is not proved to turn by less than half a turn in a sample.
    #[error(
        "the oscillator of harmonic {harmonic} turns by {turns:.6} of a turn in a sample: from 1/2 on (2*{harmonic} h >= T, with \
         T = 2 pi/base_frequency) the samples cannot tell it from a slower one"
    )]
    Aliasing {
        /// The largest harmonic l.
        harmonic: u32,
        /// l w h/(2 pi).
        turns: f64,
        /// pi/(l w), rounded down.
        below: f64,
        /// The largest harmonic that this sampling time serves.
        served: u32,
    },
    /// 3 K h Nb2/2 is not proved to be below 1, which the law with a delay needs.
    #[error(
        "3 K h Nb2/2 = {share:.6} with the sampling time h, where Nb2 is the sum of all weights: the law with a delay needs it below 1"
    )]
    TooSlowForDelay {
        /// 3 K h Nb2/2.
        share: f64,
        /// The sampling time below which it is less than 1, rounded down.
        below: f64,
    },
}

impl SamplingError {
    /// What to try.
    #[must_use]
    pub fn way_out(&self) -> String {
        match self {
            SamplingError::TooSlowForSigma { below, .. } => {
                format!("take a sampling time well below 1/sigma = {below:.6e}, or a smaller sigma")
            }
            SamplingError::Aliasing { below, served, .. } => {
                format!("take a sampling time well below {below:.6e}, or no harmonic above {served}")
            }
            SamplingError::TooSlowForDelay { below, .. } => {
                format!("take a sampling time well below {below:.6e}, or a smaller mu")
            }
        }
    }
}

impl Design<'_> {
    /// What is bad about a sampling time h; empty where l w h < pi for the largest harmonic l and h sigma <= 1 are proved, with a delay also 3 K h Nb2 < 2.
    #[must_use]
    pub fn sampling_errors(&self, step: &Constant) -> Vec<SamplingError> {
        self.too_slow(step).into_iter().chain(self.aliasing(step)).chain(self.too_slow_for_delay(step)).collect()
    }

    /// Whether the sampled loop on e' = u is proved to converge, in exact arithmetic (derivation, section 12): without input
    /// e is multiplied by 1 - h sigma, and the energy of zeta falls as long as no two modes turn alike, since K h Nb2 < 2; with a delay
    /// that of zeta and of the last y, since 3 K h Nb2 < 2 (13.4).
    #[must_use]
    pub fn converges(&self, step: &Constant) -> bool {
        let product = self.sigma.enclose(PRECISION) * step.enclose(PRECISION);
        let slow = product.lt(&Enclosure::from_integer(2, PRECISION)).is_true();
        slow && self.aliasing(step).is_none() && self.too_slow_for_delay(step).is_none()
    }

    /// The number of samples in the period T = 2 pi/base_frequency, where it is not a whole one (as far as that can be told).
    #[must_use]
    pub fn uneven_samples(&self, step: &Constant) -> Option<f64> {
        let base = &self.model.base_frequency;
        let turn = Monomial::pi().mul(&Monomial::rational(Rational::from(2)));
        let exact = base.exact.as_ref().zip(step.exact.as_ref()).zip(turn);
        let samples = match exact.and_then(|((base, step), turn)| turn.div(base)?.div(step)) {
            Some(samples) if samples.as_rational().is_some_and(|samples| *samples.denom() == 1) => return None,
            Some(samples) => samples.enclose(PRECISION),
            None => {
                let samples = Enclosure::pi(PRECISION) * 2 / (base.enclose(PRECISION) * step.enclose(PRECISION));
                let nearest = Rational::try_from(Float::with_val(PRECISION, samples.lower()).round()).ok()?;
                if samples.contains(&nearest) {
                    return None;
                }
                samples
            }
        };
        Some(samples.midpoint_f64())
    }

    /// Whether the fastest oscillator turns by nearly a quarter of a turn in a sample, or more: the largest harmonic is near N_s/4 or above.
    #[must_use]
    pub fn turns_far(&self, step: &Constant) -> bool {
        let base = self.model.base_frequency.enclose(PRECISION) * step.enclose(PRECISION);
        let angle = i64::from(self.oscillators.largest()) * &base;
        !angle.lt(&(Enclosure::pi(PRECISION) * 9 / 20)).is_true()
    }

    fn too_slow(&self, step: &Constant) -> Option<SamplingError> {
        let exact = self.sigma.exact.as_ref().zip(step.exact.as_ref()).and_then(|(sigma, step)| sigma.mul(step));
        let one = Monomial::rational(Rational::from(1));
        let sigma = self.sigma.enclose(PRECISION);
        let product = &sigma * step.enclose(PRECISION);
        let fast = match exact.and_then(|product| product.compare(&one)) {
            Some(ordering) => ordering != Ordering::Greater,
            None => product.le(&Enclosure::one(PRECISION)).is_true(),
        };
        let below = (Enclosure::one(PRECISION) / sigma).lower_f64();
        (!fast).then(|| SamplingError::TooSlowForSigma { product: product.midpoint_f64(), below })
    }

    fn too_slow_for_delay(&self, step: &Constant) -> Option<SamplingError> {
        if !self.delayed {
            return None;
        }
        let h = step.enclose(PRECISION);
        let total = self.model.weights.total(PRECISION);
        // Without K in double precision h mu Nb2 is far beyond 1, and 3 K h Nb2/2 near 3.
        let share = self.model.sampled_gain(step).map_or_else(
            || Enclosure::from_integer(3, PRECISION),
            |law| {
                let [gain, sum] = [&law.gain, &law.weight_sum].map(|value| Enclosure::from_rational(value, PRECISION));
                3 * (gain * sum * &h) / 2
            },
        );
        // K h Nb2 = 2/3 where h mu Nb2 = 1.
        let below = (Enclosure::one(PRECISION) / (self.model.mu.enclose(PRECISION) * total)).lower_f64();
        let slow = !share.lt(&Enclosure::one(PRECISION)).is_true();
        slow.then(|| SamplingError::TooSlowForDelay { share: share.midpoint_f64(), below })
    }

    fn aliasing(&self, step: &Constant) -> Option<SamplingError> {
        let (base, step) = (self.model.base_frequency.enclose(PRECISION), step.enclose(PRECISION));
        let (harmonic, pi) = (self.oscillators.largest(), Enclosure::pi(PRECISION));
        let angle = &(i64::from(harmonic) * &base) * &step;
        if angle.lt(&pi).is_true() {
            return None;
        }
        // It is at least 1 here: the angle 0 is below pi.
        let most = (&pi / &(&base * &step)).lower_f64();
        let served = (most.ceil() - 1.0).clamp(0.0, f64::from(harmonic - 1)) as u32;
        let turns = (&angle / &(&pi * 2)).midpoint_f64();
        let below = (pi / (i64::from(harmonic) * &base)).lower_f64();
        Some(SamplingError::Aliasing { harmonic, turns, below, served })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sigmastar_lang::spec::Specification;

    fn constant(numerator: i64, denominator: i64) -> Constant {
        Constant::rational(&Rational::from((numerator, denominator)))
    }

    fn example() -> Specification {
        Specification::from_json("example", include_str!("../../../specs/paper-example.json")).unwrap()
    }

    #[test]
    fn sampling_times_that_cannot_work() {
        let spec = example();
        let check = |sigma: i64, n_o: u32, step: (i64, i64)| {
            let (sigma, step) = (constant(sigma, 1), constant(step.0, step.1));
            let design = Design::new(&spec.internal_model, &sigma, n_o);
            (design.sampling_errors(&step), design.converges(&step))
        };
        assert_eq!(check(2, 4, (1, 10)), (vec![], true));
        // h sigma = 1 is allowed, 2 n_o h = T is not.
        assert_eq!(check(10, 4, (1, 10)), (vec![], true));
        assert!(
            matches!(check(11, 4, (1, 10)), (errors, true) if matches!(errors[..], [SamplingError::TooSlowForSigma { .. }]))
        );
        assert!(
            matches!(check(20, 4, (1, 10)), (errors, false) if errors.len() == 1 && errors[0].to_string().contains("grows"))
        );
        for n_o in [5, 9] {
            let (errors, converges) = check(2, n_o, (1, 10));
            assert!(matches!(errors[..], [SamplingError::Aliasing { served: 4, .. }]) && !converges, "{n_o}");
        }
        assert_eq!(check(58, 9, (1, 10)).0.len(), 2);
        assert_eq!(check(2, 5, (99, 1000)), (vec![], true));
    }

    #[test]
    fn whole_numbers_of_samples() {
        let (spec, sigma) = (example(), constant(1, 1));
        let uneven = |numerator, denominator| {
            Design::new(&spec.internal_model, &sigma, 1).uneven_samples(&constant(numerator, denominator))
        };
        assert_eq!((uneven(1, 50), uneven(1, 101), uneven(2, 1)), (None, None, Some(0.5)));
        assert!(uneven(3, 100).is_some_and(|samples| (samples - 100.0 / 3.0).abs() < 1e-12));
    }
}
