//! What is proved of the loop with the noise, the disturbance and the rounding of a document, beside that of the loop without (derivation, 13.6).
//!
//! By Proposition N, and at samples N_h or A, the difference to the periodic solution is the sum of a part from the start and one from the inputs, which
//! is at most S. With the rate the first one is at most `C exp(-rate (t - t_0))`, and of an aligned start, which aligns to the e that is measured, as
//! much more as [`NoiseBound::misled`] times the same exponential. What bounds u by the conditions of a claim is U, which does not grow along the part from
//! the start either. Of a plant that is linear in x and e the periodic solution and the part from the start are a solution without noise from the same set,
//! but for what misleads that start.

use super::certification::Certification;
use super::gain_row::ByCount;
use super::kept::BoundsOfCount;
use super::sampled::SampledCertification;
use crate::rate::found::ForCount;
use crate::rate::noise::NoiseBound;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::Oscillators;

/// What is proved with given oscillators in the loop with all that a document states of noise, for every solution from the initial set.
#[derive(Clone, Debug)]
pub struct UnderNoise {
    /// Of the limit superior of |e - e_per|: S.
    pub limit: Rational,
    /// What an aligned start adds to the factor: |e - e_per| is at most `S + (factor + misled) exp(-rate (t - t_0))`, at samples at the sampling instants.
    pub misled: Rational,
    /// Of the limit superior of |e|.
    pub steady_error: Enclosure,
    /// Of |e| at all times.
    pub peak_error: Enclosure,
    /// Of what is put out at all times, where that is proved.
    pub control: Option<Enclosure>,
}

/// From what is proved without noise and of it.
fn under_noise<P, Q>(
    found: &[ForCount<P, Q>],
    oscillators: &Oscillators,
    (without, by_count): (&BoundsOfCount, Option<&ByCount>),
) -> Option<UnderNoise> {
    let NoiseBound { limit, peak, misled, control: added, .. } =
        found.iter().find(|found| found.oscillators == *oscillators)?.proved_noise()?;
    let BoundsOfCount { steady_error, peak_error, control, steady_control, transient } = without;
    let with = |bound: &Enclosure, more: &[&Rational]| {
        more.iter().fold(bound.clone(), |sum, more| sum + Enclosure::from_rational(more, bound.precision()))
    };
    let from_the_box = with(&steady_error.bound, &[peak]);
    let is_linear = by_count.is_some_and(ByCount::is_of_set);
    // Of a plant that is not linear the part from the start is no solution, of which trials speak; the function of the claim does.
    let (peak_error, control) = match is_linear {
        true => (from_the_box.min(&with(&peak_error.bound, &[misled, limit])), control.clone()),
        false => (from_the_box, steady_control + transient),
    };
    let steady_error = with(&steady_error.bound, &[limit]);
    let control = added.as_ref().map(|added| with(&control, &[added]));
    Some(UnderNoise { limit: limit.clone(), misled: misled.clone(), steady_error, peak_error, control })
}

impl Certification<'_> {
    /// What is proved of the loop with noise with given oscillators; `None` where nothing is, or the document has none.
    #[must_use]
    pub fn under_noise(&self, oscillators: &Oscillators) -> Option<UnderNoise> {
        under_noise(&self.for_n_o, oscillators, (&self.bounds_of(oscillators)?, self.by_count.as_ref()))
    }
}

impl SampledCertification<'_> {
    /// The same at samples; it is about all times, between samples too.
    #[must_use]
    pub fn under_noise(&self, oscillators: &Oscillators) -> Option<UnderNoise> {
        under_noise(&self.for_n_o, oscillators, (&self.bounds_of(oscillators)?, self.by_count.as_ref()))
    }
}
