//! From a decay at samples to a bound of the error there: `|e(t) - e_per(t)| <= C exp(-rate (t - t_0))` at the sampling instants t, for every
//! start in a set at the sampling instant t_0, at one n_o, one gain and one sampling period (derivation, 13.6).

use super::condition::SampledCondition;
use crate::rate::bound::{Place, RateBound, diagonal_bounds, factor, lies_between};
use crate::rate::riccati::in_digits;
use faer::Mat;
use rug::Rational;
use sigmastar_decide::rates::OscillatorMatrix;
use sigmastar_decide::rates::at_samples::{Inputs, OfX, SampledDynamics, SampledRateWitness};
use sigmastar_decide::rates::inequality::LoopBounds;
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::sampled::SampledLaw;

/// Shares of the largest rate that are claimed, in this order; nearer to it C would be large and the numbers long.
const SHARES: [f64; 4] = [0.95, 0.8, 0.5, 0.2];

/// Digits of Pi that are tried.
pub(super) const DIGITS: [u32; 4] = [6, 9, 12, 16];

/// The best bound that is found; `None` where nothing is proved.
///
/// Guarantee: for every solution that is in the error box of `place` and starts within its distances at a sampling instant t_0, at its gain,
/// with n_o oscillators, the law and every input gain of the data, `|e(t) - e_per(t)| <= factor exp(-rate (t - t_0))` at every
/// sampling instant t >= t_0, whoever the plant is of which the bounds of the error box hold.
#[must_use]
pub fn bound(
    data: &Data<'_>,
    law: &SampledLaw<Enclosure>,
    place: &Place<'_>,
    n_o: u32,
) -> Option<RateBound<SampledRateWitness>> {
    let bounds = LoopBounds::of_error(data, place.error_box)?;
    let oscillators = OscillatorMatrix::new(data, n_o);
    let dynamics = SampledDynamics::new(data, (&oscillators, law), place.sigma, &bounds)?;
    let condition = SampledCondition::new(&dynamics)?;
    let largest = condition.largest_rate()?;
    SHARES.iter().find_map(|share| {
        let proposal = Proposal::new(&condition, largest, *share)?;
        DIGITS.iter().find_map(|digits| {
            let witness = proposal.in_digits(*digits)?;
            let rate = rate_of(&witness.c, &law.step)?;
            if !dynamics.proves(&witness) {
                return None;
            }
            let [e_low, upper @ ..] = diagonal_bounds(&proposal.pi, place.distances)?;
            let [e_up, z_up] = &upper;
            if !lies_between(&witness.pi, 0, &e_low, [&Rational::new(), e_up, z_up], data.precision) {
                return None;
            }
            let of_x = witness.of_x.as_ref().map_or_else(|| data.zero(), |of_x| data.rational(&of_x.w) * &data.p_up);
            let factor = factor(data, [of_x, data.rational(e_up), data.rational(z_up)], place.distances, &e_low)?;
            Some(RateBound { n_o, rate, proof: witness, e_low, upper, factor, limit: condition.limit() })
        })
    })
}

/// The numbers of a proof in doubles.
pub(super) struct Proposal {
    pub(super) c: f64,
    pub(super) pi: Mat<f64>,
    pub(super) l_slope: f64,
    pub(super) l_hold: f64,
    pub(super) of_x: Option<OfX<f64>>,
}

impl Proposal {
    /// For a share of the largest rate; Pi and the multipliers are those of a rate between them.
    fn new(condition: &SampledCondition, largest: f64, share: f64) -> Option<Proposal> {
        let multipliers = condition.multipliers(largest * f64::midpoint(1.0, share), 0.5)?;
        let pi = multipliers.system.least()?;
        let (l_slope, l_hold, of_x) = (multipliers.l_slope, multipliers.l_hold, multipliers.of_x);
        Some(Proposal { c: condition.c(largest * share), pi, l_slope, l_hold, of_x })
    }

    /// The witness to so many digits, entries of Pi that are far beyond those of their diagonals as 0; without inputs.
    pub(super) fn in_digits(&self, digits: u32) -> Option<SampledRateWitness> {
        let round = |value: f64| round_f64(value, digits, Direction::Nearest);
        let pi = in_digits(&self.pi, digits)?;
        let of_x = match &self.of_x {
            None => None,
            Some(OfX { w, l_x, l_e, l_y }) => {
                Some(OfX { w: round(*w)?, l_x: round(*l_x)?, l_e: round(*l_e)?, l_y: round(*l_y)? })
            }
        };
        let c = round_f64(self.c, 9, Direction::Down)?;
        let [l_slope, l_hold] = [round(self.l_slope)?, round(self.l_hold)?];
        Some(SampledRateWitness { pi, c, l_slope, l_hold, of_x, inputs: Inputs::default() })
    }
}

/// A positive rate with exp(2 h rate) <= 1 + c, to six digits.
fn rate_of(c: &Rational, step: &Enclosure) -> Option<Rational> {
    let kept = Enclosure::from_rational(c, step.precision()) + Enclosure::one(step.precision());
    let rate = round_f64((kept.log() / (step * 2)).lower_f64(), 6, Direction::Down)?;
    let of_rate = (step * 2 * Enclosure::from_rational(&rate, step.precision())).exp();
    (rate > 0 && of_rate.le(&kept) == Truth::True).then_some(rate)
}
