//! From a decay at samples to a bound of the error there: `|e(t) - e_per(t)| <= C exp(-rate (t - t_0))` at the sampling instants t, for every
//! start in a set at the sampling instant t_0, with given oscillators at one gain and one sampling period (derivation, 13.6).

use crate::rate::bound::{Loop, Place, RateBound, best};
use rug::Rational;
use sigmastar_decide::rates::OscillatorMatrix;
use sigmastar_decide::rates::at_samples::{SampledDynamics, SampledRateWitness};
use sigmastar_decide::rates::inequality::LoopBounds;
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_lang::spec::Oscillators;
use sigmastar_propose::rates::SampledCondition;
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::sampled::SampledLaw;

/// The best bound that is found; `None` where nothing is proved.
///
/// Guarantee: for every solution that is in the error box of `place` and starts within its distances at a sampling instant t_0, at its gain,
/// with these oscillators, the law and every input gain of the data, `|e(t) - e_per(t)| <= factor exp(-rate (t - t_0))` at every
/// sampling instant t >= t_0, whoever the plant is of which the bounds of the error box hold.
#[must_use]
pub fn bound(
    data: &Data<'_>,
    law: &SampledLaw<Enclosure>,
    place: &Place<'_>,
    oscillators: &Oscillators,
) -> Option<RateBound<SampledRateWitness>> {
    let bounds = LoopBounds::of_error(data, place.error_box)?;
    let matrix = OscillatorMatrix::new(data, oscillators);
    let dynamics = SampledDynamics::new(data, (&matrix, law), place.sigma, &bounds)?;
    best(data, place, oscillators, &dynamics)
}

impl Loop for SampledDynamics<'_> {
    type Witness = SampledRateWitness;
    type Condition = SampledCondition;

    fn condition(&self) -> Option<SampledCondition> {
        SampledCondition::new(self)
    }

    fn proves(&self, witness: &SampledRateWitness) -> bool {
        SampledDynamics::proves(self, witness)
    }

    /// A positive rate with exp(2 h rate) <= 1 + c, to six digits.
    fn rate(&self, witness: &SampledRateWitness) -> Option<Rational> {
        let step = &self.law.step;
        let kept = Enclosure::from_rational(&witness.c, step.precision()) + Enclosure::one(step.precision());
        let rate = round_f64((kept.log() / (step * 2)).lower_f64(), 6, Direction::Down)?;
        let of_rate = (step * 2 * Enclosure::from_rational(&rate, step.precision())).exp();
        (rate > 0 && of_rate.le(&kept) == Truth::True).then_some(rate)
    }

    fn parts<'w>(&self, witness: &'w SampledRateWitness) -> (&'w [Vec<Rational>], Option<&'w Rational>) {
        (&witness.pi, witness.of_x.as_ref().map(|of_x| &of_x.w))
    }
}
