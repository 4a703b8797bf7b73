//! What a claim about a sampled regulator says besides: the law, and its sampling period exactly (docs/mathematics.md, section 12).

use super::law::RULE;
use crate::constant::Constant;
use crate::json::Fields;
use crate::scope::Scope;
use crate::spec::{Specification, read_delay, samples};
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
    /// Whether a control is computed in the sample before it acts.
    pub delayed: bool,
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
            delayed: fields.optional("delay_samples").map_or(Ok(false), |field| read_delay(&field))?,
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
        let asked = spec.regulator.samples.as_ref().is_none_or(|asked| *asked == self.samples);
        demand(Some(asked), RULE, &self.pointer, "it is the sampling period of the specification")?;
        let asked = spec.regulator.samples.is_none() || self.delayed == spec.regulator.delayed;
        demand(Some(asked), RULE, &self.pointer, "`delay_samples` is that of the specification")
    }

    /// sigma as it is written.
    pub fn sigma_text(&self) -> &'a str {
        self.texts[0]
    }

    /// The beginning of the claim in words.
    pub fn in_words(&self, spec: &Specification, scope: Scope) -> String {
        let (samples, [sigma, gain]) = (self.samples, self.texts);
        format!(
            "For the digital regulator {}with the gain sigma = {sigma}, the sampling period h = {} ({samples} samples a period) and \
             K = {gain}, for {} and every phase of the sampling grid{}",
            if self.delayed { "whose control is computed in the sample before it acts, " } else { "" },
            self.sampling.words,
            scope.in_words(Some(samples)),
            spec.in_words(),
        )
    }

    /// What the claim takes for granted of the regulator; `saturates`: the saturation of the actuator is in the claim, `noisy`: something is said
    /// of noise and quantisation, `rounded`: and of its arithmetic.
    pub fn assumed(&self, [saturates, noisy, rounded]: [bool; 3]) -> Vec<String> {
        let saturation = if saturates { "" } else { "no saturation, " };
        let [but, but_rounded] = [noisy, rounded].map(|said| if said { " except where the claim says so" } else { "" });
        let (law, late) = match self.delayed {
            false => (
                "u_k = -sigma e_k + K v_k, v_k = M'N R (z_k - M e_k), z_(k+1) = R (z_k - M e_k) + (1 - h sigma) M e_k",
                "no computation delay",
            ),
            true => (
                "et_(k+1) = e_k - h sigma et_k, z_(k+1) = R (z_k - M e_k) + M et_(k+1), u_(k+1) = -sigma et_(k+1) + K M'N R \
                 (z_(k+1) - M et_(k+1)), put out exactly at the sample k+1; u_0 is that of the law too, or -sigma et_0 where z_0 = M e_0 \
                 is set",
                "no computation that takes more than a sample",
            ),
        };
        vec![
            format!(
                "the regulator is the sampled law {law}, R = e^(Phi h), with exactly this sigma, h and K, the weights stated and \
                 base_frequency exactly 2 pi/period; between samples the plant runs continuously and u is held"
            ),
            format!(
                "{late}, no rounding of the regulator's arithmetic or of R{but_rounded}, no quantisation{but}, {saturation}no \
                 noise{but}, no jitter of the samples"
            ),
        ]
    }
}
