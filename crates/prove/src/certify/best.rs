//! The sharp derivation with the transfer proof, and the candidate, that give the smallest sigma.

use super::limits::{FloatLimits, NEAR, ROOMS};
use super::options::{Limits, Options, TransferChoice};
use super::proof::{Outcome, SharpProof};
use super::round::{TransferKind, round_sharp};
use crate::search::{
    Failing, FloatModel, Goal, Obstacle, SharpProposal, largest_at, search_sharp, search_sharp_at, search_sharp_near,
};
use rug::Rational;
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::sharp::SharpEvaluation;
use sigmastar_theory::transfer::TradeOff;

/// What is asked of a search.
#[derive(Clone, Copy, Default)]
pub struct Wanted<'w> {
    /// Free numbers that are known to be near.
    pub start: Option<&'w SharpProposal>,
    /// The gain, where it is not to be found.
    pub gain: Option<&'w Rational>,
    /// What is to be kept at the gain.
    pub limits: Option<&'w Limits>,
}

/// The outcome, with the model and the proposal that it came from.
pub(super) struct BestSharp {
    pub(super) model: FloatModel,
    pub(super) proposal: Option<SharpProposal>,
    pub(super) outcome: Outcome<SharpProof>,
    /// About the smallest gain, where another one was sought.
    pub(super) smallest_gain: Option<f64>,
}

impl BestSharp {
    fn new(data: &Data<'_>, options: Options, kind: TransferKind, wanted: Wanted<'_>) -> BestSharp {
        let model = model(data, kind);
        let Wanted { start, gain, limits } = wanted;
        if let Some(limits) = FloatLimits::new(data.spec, limits.unwrap_or(&Limits::default())) {
            return BestSharp::within(data, options, (kind, model), (wanted, limits));
        }
        let proposal = match gain {
            None => smallest(&model, start),
            Some(gain) => at_gain(&model, gain.to_f64(), start),
        };
        let outcome = match &proposal {
            Err(obstacle) => Outcome::NotFound(*obstacle),
            Ok(proposal) => round_sharp(data, &model, proposal, (kind, gain), options.ladder).into(),
        };
        BestSharp { model, proposal: proposal.ok(), outcome, smallest_gain: None }
    }

    /// At the smallest gain with which the limits are kept, or at the one that is given.
    fn within(
        data: &Data<'_>,
        options: Options,
        (kind, model): (TransferKind, FloatModel),
        (Wanted { start, gain, limits: asked }, limits): (Wanted<'_>, FloatLimits),
    ) -> BestSharp {
        let refused = |obstacle, model, smallest_gain| BestSharp {
            model,
            proposal: None,
            outcome: Outcome::NotFound(obstacle),
            smallest_gain,
        };
        let least = match gain {
            Some(gain) => at_gain(&model, gain.to_f64(), start),
            None => smallest(&model, start),
        };
        let least = match least {
            Ok(least) => least,
            Err(obstacle) => return refused(obstacle, model, None),
        };
        let smallest_gain = gain.is_none().then_some(least.sigma);
        let kept = |proof: &SharpProof| {
            let SharpEvaluation { periodic, peak, control, .. } = &proof.evaluation;
            asked.is_none_or(|limits| limits.kept([&periodic.e_per, peak], control))
        };
        // The smallest gain itself may do, but for rounding.
        let is_it = |proof: &SharpProof| gain.is_some() || proof.witness.sigma <= least.sigma * NEAR;
        let proof = round_sharp(data, &model, &least, (kind, gain), options.ladder);
        if let Some(proof) = proof.filter(|proof| proof.truth().is_true() && is_it(proof) && kept(proof)) {
            let outcome = Some(proof).into();
            return BestSharp { model, proposal: Some(least), outcome, smallest_gain };
        }
        let at = |goal: Goal, sigma: f64| {
            let model = model.with_goal(goal);
            let proposal = search_sharp_at(&model, sigma, start)?;
            largest_at(&model, &proposal).map(|largest| (proposal, largest))
        };
        let mut attempt = None;
        for room in ROOMS {
            let found = match limits.smallest([least.sigma, f64::INFINITY], (gain.is_some(), room), at) {
                Ok(found) => found,
                Err(obstacle) => return attempt.unwrap_or_else(|| refused(obstacle, model, smallest_gain)),
            };
            let sigma = gain.cloned().or_else(|| found.sigma());
            let with = model.with_goal(found.goal);
            let proof = round_sharp(data, &with, &found.proposal, (kind, sigma.as_ref()), options.ladder);
            let outcome: Outcome<SharpProof> = match proof {
                // Nothing is claimed that does not keep to what was asked for.
                Some(proof) if !kept(&proof) => Outcome::NotFound(found.failing().into()),
                proof => proof.into(),
            };
            let proved = outcome.proved().is_some();
            attempt = Some(BestSharp { model: with, proposal: Some(found.proposal), outcome, smallest_gain });
            if proved {
                break;
            }
        }
        attempt.unwrap_or_else(|| refused(Failing::NotFinite(None).into(), model, smallest_gain))
    }

    /// The better one of two: that with a proof, and with the smaller sigma; of two at a given gain the first.
    fn or(self, other: BestSharp) -> BestSharp {
        match (self.outcome.proved(), other.outcome.proved()) {
            (Some(first), Some(second)) if second.witness.sigma < first.witness.sigma => other,
            (None, Some(_)) => other,
            _ => self,
        }
    }
}

/// The proposal with the smallest gain; near a known one where there is one there.
fn smallest(model: &FloatModel, start: Option<&SharpProposal>) -> Result<SharpProposal, Obstacle> {
    let near = start.and_then(|known| search_sharp_near(model, known).ok());
    near.map_or_else(|| search_sharp(model), Ok)
}

/// The proposal at a gain that is given.
fn at_gain(model: &FloatModel, gain: f64, start: Option<&SharpProposal>) -> Result<SharpProposal, Obstacle> {
    search_sharp_at(model, gain, start).map_err(|obstacle| below_the_smallest(model, gain, start).unwrap_or(obstacle))
}

/// That a gain is below the smallest one that is found, where it is.
fn below_the_smallest(model: &FloatModel, given: f64, start: Option<&SharpProposal>) -> Option<Obstacle> {
    let smallest = smallest(model, start).ok()?;
    let smallest = (given < smallest.sigma).then_some((smallest.sigma, smallest.binding));
    smallest.map(|smallest| Failing::Gain { given, smallest: Some(smallest) }.into())
}

pub(super) fn model(data: &Data<'_>, kind: TransferKind) -> FloatModel {
    let trade_off = match kind {
        TransferKind::Matched => TradeOff::matched(data),
        TransferKind::Boxes => TradeOff::curve(data),
        TransferKind::ClosedForm => TradeOff::closed_form(data),
    };
    FloatModel::new(data, trade_off)
}

/// Searches, near `start` where there is one, and decides the sharp derivation; the smaller one of what the closed form and
/// the sharper proof of the transfer bound lead to is taken.
pub(super) fn best_sharp(data: &Data<'_>, options: Options, wanted: Wanted<'_>) -> BestSharp {
    let with = |kind| BestSharp::new(data, options, kind, wanted);
    if options.transfer == TransferChoice::Best {
        let sharper = if data.matched { TransferKind::Matched } else { TransferKind::Boxes };
        return with(sharper).or(with(TransferKind::ClosedForm));
    }
    if options.transfer == TransferChoice::Boxes {
        let boxes = with(TransferKind::Boxes);
        if boxes.outcome.proved().is_some() {
            return boxes;
        }
    }
    // Where no proof by boxes is found within its effort, the closed form still proves something.
    with(TransferKind::ClosedForm)
}
