//! What a claim about a sampled regulator says besides: the law, and its sampling period exactly (docs/mathematics.md, section 12).

use super::law::RULE;
use crate::actuator;
use crate::constant::Constant;
use crate::input_gain;
use crate::json::Fields;
use crate::period;
use crate::spec::{Specification, samples};
use crate::verdict::{Outcome, bad, demand};
use rug::Rational;

/// `n_o` of such a claim.
pub const N_O: &str = "every n_o < samples/2";

/// The law that is claimed, with the texts of its numbers.
pub struct Regulator<'a> {
    pub sigma: Rational,
    /// K.
    pub gain: Rational,
    /// N_s.
    pub samples: u32,
    sampling: Constant,
    pointer: String,
    texts: [&'a str; 2],
}

impl<'a> Regulator<'a> {
    /// Takes its fields out of a claim, if that has a field `regulator`.
    pub fn read(fields: &mut Fields<'a>) -> Outcome<Option<Regulator<'a>>> {
        let Some(kind) = fields.optional("regulator") else { return Ok(None) };
        if kind.text()? != "digital" {
            return bad(&kind.pointer, "expected `digital`, or no such field");
        }
        let (sigma, gain) = (fields.required("sigma")?, fields.required("gain")?);
        let sampling = fields.required("sampling_period")?;
        let samples = fields.required("samples")?;
        let count = samples.whole()?;
        demand(Some(count >= 2), RULE, &samples.pointer, "there are two samples or more in a period")?;
        Ok(Some(Regulator {
            sigma: sigma.rational()?,
            gain: gain.rational()?,
            samples: count,
            sampling: Constant::read(&sampling)?,
            pointer: sampling.pointer,
            texts: [sigma.numeral()?, gain.numeral()?],
        }))
    }

    /// `T = samples * sampling_period` exactly, and the specification, where it has a sampling period, has this one.
    pub fn check(&self, spec: &Specification) -> Outcome<()> {
        let period = spec.period.demand_exact(&self.pointer, "a claim at samples")?;
        let exactly = samples(period, &self.sampling, &self.pointer)?;
        demand(Some(exactly == self.samples), RULE, &self.pointer, "period = samples * sampling_period")?;
        let asked = spec.samples.as_ref().is_none_or(|asked| *asked == self.samples);
        demand(Some(asked), RULE, &self.pointer, "it is the sampling period of the specification")
    }

    /// The beginning of the claim in words.
    pub fn in_words(&self, spec: &Specification) -> String {
        let (samples, [sigma, gain]) = (self.samples, self.texts);
        format!(
            "For the digital regulator with the gain sigma = {sigma}, the sampling period h = {} ({samples} samples a period) and \
             K = {gain}, for every number of oscillators n_o < {samples}/2 and every phase of the sampling grid{}{}, with {}, \
             mu = {} and base frequency {}",
            self.sampling.text,
            input_gain::in_words(spec.input_gain.as_ref()),
            actuator::in_words(spec.actuator.as_ref()),
            period::in_words(&spec.period),
            spec.mu.text,
            spec.base_frequency.text,
        )
    }

    /// What the claim takes for granted of the regulator; `saturates`: the saturation of the actuator is in the claim.
    pub fn assumed(saturates: bool) -> Vec<String> {
        let saturation = if saturates { "" } else { "no saturation, " };
        vec![
            "the regulator is the sampled law u_k = -sigma e_k + K v_k, v_k = M'N R (z_k - M e_k), z_(k+1) = R (z_k - M e_k) + \
             (1 - h sigma) M e_k, R = e^(Phi h), with exactly this sigma, h and K, the weights stated and base_frequency exactly \
             2 pi/period; between samples the plant runs continuously and u is held"
                .to_owned(),
            format!(
                "no computation delay, no rounding of the regulator's arithmetic or of R, no quantisation, {saturation}no noise, no jitter \
                 of the samples"
            ),
        ]
    }
}
