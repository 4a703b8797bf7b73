//! What is known of oscillators that were asked about.

use super::bound::{ByForm, RateBound};
use super::noise::{NoNoiseBound, NoiseBound, NoiseByForm};
use super::sampled::noise::SampledNoise;
use rug::Rational;
use sigmastar_decide::rates::at_samples::SampledRateWitness;
use sigmastar_lang::spec::Oscillators;

/// What was found for oscillators that were asked about: a rate that is proved by a P, and what noise does by a Q.
#[derive(Clone, Debug)]
pub struct ForCount<P, Q> {
    /// The oscillators.
    pub oscillators: Oscillators,
    /// The bound; `None` where none was proved, which says nothing either way.
    pub bound: Option<RateBound<P>>,
    /// Bounds of what noise and disturbances do; `None` where the document has none.
    pub noise: Option<Result<NoiseBound<Q>, NoNoiseBound>>,
}

/// Of the regulator in continuous time.
pub type RateForCount = ForCount<ByForm, NoiseByForm>;

/// Of the regulator at samples.
pub type SampledRateForCount = ForCount<SampledRateWitness, SampledNoise>;

impl<P, Q> ForCount<P, Q> {
    /// The oscillators and the rate.
    pub(crate) fn rate(&self) -> (&Oscillators, Option<&Rational>) {
        (&self.oscillators, self.bound.as_ref().map(|bound| &bound.rate))
    }

    /// The bounds under noise, where they are proved.
    pub(crate) fn proved_noise(&self) -> Option<&NoiseBound<Q>> {
        self.noise.as_ref()?.as_ref().ok()
    }
}
