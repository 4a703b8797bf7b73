//! What a claim about the law at samples is about.

use sigmastar_lang::spec::{Constant, Oscillators, SampledGain, Specification};
use sigmastar_regulator::{Design, Discrete, Regulator};
use sigmastar_theory::derivation::sampled::SampledWitness;

/// Exactly one gain, one sampling time, and K.
#[derive(Clone, Debug)]
pub struct SampledClaim {
    /// The gain sigma.
    pub sigma: Constant,
    /// The sampling time h.
    pub step: Constant,
    /// T/h.
    pub samples: u32,
    /// K, with the sum of weights that it rests on.
    pub law: SampledGain,
    /// gm, where a control takes a sample to be computed.
    pub gm: Option<f64>,
}

impl SampledClaim {
    pub(super) fn new(witness: &SampledWitness) -> SampledClaim {
        SampledClaim {
            sigma: Constant::rational(&witness.sigma),
            step: witness.sampling.step.clone(),
            samples: witness.sampling.samples,
            law: witness.law.clone(),
            gm: witness.delay.as_ref().map(|delay| delay.gm.to_f64()),
        }
    }

    /// The regulator with these oscillators and its law; `None` where a number is beyond double precision.
    #[must_use]
    pub fn regulator(&self, spec: &Specification, oscillators: &Oscillators) -> Option<(Regulator, Discrete)> {
        let design =
            Design::new(&spec.internal_model, &self.sigma, oscillators.clone()).for_actuator(spec.input_gain.as_ref());
        let design = design.with_delay(self.gm.is_some());
        let (regulator, discrete) = (design.regulator(), design.discretise_with(&self.step, &self.law)?);
        (regulator.is_representable() && discrete.is_representable()).then_some((regulator, discrete))
    }

    /// The numbers of oscillators that are tried: few, a quarter of the samples, and the most below half of them that are
    /// affordable.
    #[must_use]
    pub fn tried_n_o(&self) -> Vec<u32> {
        const AFFORDABLE: u32 = 150;
        let most = self.samples.saturating_sub(1) / 2;
        let mut tried: Vec<u32> = [0, most.min(AFFORDABLE), 1, 2, 3, 5, 8, (most / 2).min(AFFORDABLE)]
            .into_iter()
            .filter(|n_o| *n_o <= most)
            .collect();
        let mut seen = std::collections::BTreeSet::new();
        tried.retain(|n_o| seen.insert(*n_o));
        tried
    }
}
