//! From exact numbers to doubles, each rounded once.

use super::{Discrete, Regulator};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::{Constant, InputGain, InternalModel, Oscillators, SampledGain};

/// The most oscillators that are exported: the matrices are written out in full.
pub const MAX_EXPORTED_OSCILLATORS: u32 = 1000;

/// Bits at which the entries are enclosed before they are rounded. An entry such as 1 - cos(l w dt) loses twice as
/// many bits as l w dt has leading zeros, and none of that may show in 53.
pub(super) const PRECISION: u32 = 512;

/// The double next to the exact number. What is not told from 0 at so many bits is 0, as the cosine of a quarter of a turn.
fn entry(value: &Enclosure) -> f64 {
    if value.contains_zero() { 0.0 } else { value.midpoint_f64() }
}

/// A regulator with its numbers exact: an internal model, a gain, its oscillators.
#[derive(Clone, Debug)]
pub struct Design<'m> {
    pub(super) model: &'m InternalModel,
    pub(super) sigma: &'m Constant,
    pub(super) oscillators: Oscillators,
    pub(super) delayed: bool,
    nominal: Option<&'m Constant>,
}

impl<'m> Design<'m> {
    /// The regulator of an internal model with the gain sigma and these oscillators, or so many; at samples the law with a delay, where the model
    /// asks for that.
    #[must_use]
    pub fn new(model: &'m InternalModel, sigma: &'m Constant, oscillators: impl Into<Oscillators>) -> Design<'m> {
        let delayed = model.sampling.as_ref().is_some_and(|sampling| sampling.delayed);
        Design { model, sigma, oscillators: oscillators.into(), delayed, nominal: None }
    }

    /// This regulator with or without a delay, whatever the model asks for.
    #[must_use]
    pub fn with_delay(self, delayed: bool) -> Design<'m> {
        Design { delayed, ..self }
    }

    /// Its oscillators.
    #[must_use]
    pub fn oscillators(&self) -> &Oscillators {
        &self.oscillators
    }

    /// Whether a control of its law at samples has a sample to be computed (derivation, 13.4).
    #[must_use]
    pub fn is_delayed(&self) -> bool {
        self.delayed
    }

    /// This regulator for an actuator with this input gain: the control is divided by its nominal value (derivation, 13.1).
    #[must_use]
    pub fn for_actuator(self, gain: Option<&'m InputGain>) -> Design<'m> {
        Design { nominal: gain.map(|gain| &gain.nominal), ..self }
    }

    /// The regulator in double precision.
    ///
    /// Guarantee: each parameter is the exact one rounded once (up to a double rounding of 2^-450).
    #[must_use]
    pub fn regulator(&self) -> Regulator {
        Regulator {
            sigma: self.sigma.enclose(PRECISION).midpoint_f64(),
            mu: self.model.mu.enclose(PRECISION).midpoint_f64(),
            frequencies: self.frequencies().iter().map(Enclosure::midpoint_f64).collect(),
            weights: self.weights().iter().map(Enclosure::midpoint_f64).collect(),
            nominal: self.nominal.map(|nominal| nominal.enclose(PRECISION).midpoint_f64()),
        }
    }

    /// The law of section 12 of the derivation for a sampling time h > 0, e measured at the samples and u held between
    /// them. [`Discrete`] states it.
    ///
    /// With a = l w h: R = e^(Phi h) has the blocks [[cos a, sin a], [-sin a, cos a]], so that R M = (cos a, -sin a) in
    /// block l, and 1 in the integrator. Guarantee: K is the double itself, with K h Nb2 < 2 proved for the double Nb2,
    /// which is not below the sum of all weights; each other entry is the exact one for that K, rounded once. With a delay
    /// (section 13.4) the last state is what e moves by until the next sample, and C has R^2 for R.
    ///
    /// `None` where that is not to be had in double precision: h mu times the sum of the weights is beyond 2^50.
    #[must_use]
    pub fn discretise(&self, step: &Constant) -> Option<Discrete> {
        self.discretise_with(step, &self.model.sampled_gain(step)?)
    }

    /// The law at samples with a K and Nb2 that are given and taken as they are: nothing is proved of them here. `None` where they are beyond
    /// double precision.
    #[must_use]
    pub fn discretise_with(&self, step: &Constant, law: &SampledGain) -> Option<Discrete> {
        let (gain, weight_sum) = (law.gain.to_f64(), law.weight_sum.to_f64());
        let exact_gain = Enclosure::from_rational(&Rational::from_f64(gain)?, PRECISION);
        let step = step.enclose(PRECISION);
        let sigma = self.sigma.enclose(PRECISION);
        let product = &sigma * &step;
        let weights = self.weights();
        // Without a delay what e keeps goes to z at once; with one it is added at the next sample.
        let kept = if self.delayed { Enclosure::from_integer(0, PRECISION) } else { product.clone() };
        let (mut rotations, mut input) = (Vec::new(), vec![(-&kept).midpoint_f64() + 0.0]);
        // What is put out is over the nominal gain of the actuator.
        let nominal = self.nominal.map(|nominal| nominal.enclose(PRECISION));
        let put_out =
            |value: Enclosure| entry(&nominal.as_ref().map_or_else(|| value.clone(), |nominal| &value / nominal));
        let mut output = vec![put_out(&exact_gain * &weights[0])];
        let mut direct = weights[0].clone();
        for (frequency, weight) in self.frequencies().iter().zip(&weights[1..]) {
            let angle = frequency * &step;
            let (sine, cosine) = (angle.sin(), angle.cos());
            // 1 - cos a = 2 sin^2(a/2), which cancels nothing.
            let versine = 2 * (angle / 2).sin().sqr();
            input.extend([entry(&(&versine - &kept)), entry(&sine)]);
            let scaled = &exact_gain * weight;
            let [turned_cosine, turned_sine] = match self.delayed {
                true => [1 - 2 * sine.sqr(), 2 * &sine * &cosine],
                false => [cosine.clone(), sine.clone()],
            };
            output.extend([put_out(&scaled * &turned_cosine), put_out(&scaled * &turned_sine)]);
            direct = &direct + &(weight * &turned_cosine);
            rotations.push([entry(&cosine), entry(&sine)]);
        }
        if self.delayed {
            input.push((-&product).midpoint_f64());
            output.push(put_out(-&sigma));
        }
        Some(Discrete {
            step: step.midpoint_f64(),
            gain,
            weight_sum,
            prediction: self.delayed.then(|| product.midpoint_f64()),
            decay: entry(&(Enclosure::one(PRECISION) - product)),
            rotations,
            input,
            output,
            feedthrough: put_out(-(sigma + exact_gain * direct)),
            saturation: None,
        })
    }

    fn weights(&self) -> Vec<Enclosure> {
        self.oscillators.all().map(|l| self.model.weights.weight(u64::from(l), PRECISION)).collect()
    }

    pub(super) fn frequencies(&self) -> Vec<Enclosure> {
        let base = self.model.base_frequency.enclose(PRECISION);
        self.oscillators.beyond_mean().iter().map(|l| i64::from(*l) * &base).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sigmastar_lang::spec::Specification;

    #[test]
    fn a_quarter_and_a_half_turn_have_exact_zeros() {
        let spec = Specification::from_json("example", include_str!("../../../specs/paper-example.json")).unwrap();
        let constant = |numerator: i64, denominator: i64| Constant::rational(&Rational::from((numerator, denominator)));
        let sigma = constant(8, 1);
        let law = Design::new(&spec.internal_model, &sigma, 3).discretise(&constant(1, 8)).unwrap();
        assert_eq!(law.rotations[1], [0.0, 1.0]);
        assert_eq!(law.rotations[0], [0.5f64.sqrt(); 2]);
        assert_eq!(law.rotations[2], [-(0.5f64.sqrt()), 0.5f64.sqrt()]);
        // 1 - h sigma.
        assert_eq!(law.decay, 0.0);
    }
}
