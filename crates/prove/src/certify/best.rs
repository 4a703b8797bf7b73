//! The sharp derivation with the transfer proof, and the candidate, that give the smallest sigma.

use super::options::{Options, TransferChoice};
use super::proof::{Outcome, SharpProof};
use super::round::{TransferKind, round_sharp};
use crate::search::{Failing, FloatModel, Obstacle, SharpProposal, search_sharp, search_sharp_at, search_sharp_near};
use rug::Rational;
use sigmastar_theory::data::Data;
use sigmastar_theory::transfer::TradeOff;

/// What is asked of a search.
#[derive(Clone, Copy, Default)]
pub(super) struct Wanted<'w> {
    /// Free numbers that are known to be near.
    pub(super) start: Option<&'w SharpProposal>,
    /// The gain, where it is not to be found.
    pub(super) gain: Option<&'w Rational>,
}

/// The outcome, with the model and the proposal that it came from.
pub(super) struct BestSharp {
    pub(super) model: FloatModel,
    pub(super) proposal: Option<SharpProposal>,
    pub(super) outcome: Outcome<SharpProof>,
}

impl BestSharp {
    fn new(data: &Data<'_>, options: Options, kind: TransferKind, wanted: Wanted<'_>) -> BestSharp {
        let model = model(data, kind);
        let Wanted { start, gain } = wanted;
        let proposal = match gain {
            None => {
                let near = start.and_then(|known| search_sharp_near(&model, known).ok());
                near.map_or_else(|| search_sharp(&model), Ok)
            }
            Some(gain) => search_sharp_at(&model, gain.to_f64(), start)
                .map_err(|obstacle| below_the_smallest(&model, gain.to_f64(), start).unwrap_or(obstacle)),
        };
        let outcome = match &proposal {
            Err(obstacle) => Outcome::NotFound(*obstacle),
            Ok(proposal) => round_sharp(data, &model, proposal, (kind, gain), options.ladder).into(),
        };
        BestSharp { model, proposal: proposal.ok(), outcome }
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

/// That a gain is below the smallest one that is found, where it is.
fn below_the_smallest(model: &FloatModel, given: f64, start: Option<&SharpProposal>) -> Option<Obstacle> {
    let near = start.and_then(|known| search_sharp_near(model, known).ok());
    let smallest = near.or_else(|| search_sharp(model).ok())?;
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
