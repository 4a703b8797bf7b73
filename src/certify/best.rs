//! The sharp derivation with the transfer proof, and the candidate, that give the smallest sigma.

use super::decide::decide;
use super::options::{Options, TransferChoice};
use super::proof::{Outcome, SharpProof};
use super::round::{TransferKind, round_sharp, sharp_from_repaired};
use crate::data::Data;
use crate::derivation::repaired::RepairedWitness;
use crate::search::{FloatModel, RepairedProposal, SharpParameters, SharpProposal, search_sharp};
use crate::transfer::TradeOff;

/// The outcome, with the model and the proposal that it came from.
pub(super) struct BestSharp {
    pub(super) model: FloatModel,
    pub(super) proposal: Option<SharpProposal>,
    pub(super) outcome: Outcome<SharpProof>,
}

impl BestSharp {
    fn new(data: &Data<'_>, options: Options, kind: TransferKind, known: &[SharpParameters]) -> BestSharp {
        let model = model(data, kind);
        let proposal = search_sharp(&model, known);
        let outcome = match &proposal {
            Err(obstacle) => Outcome::NotFound(*obstacle),
            Ok(proposal) => round_sharp(data, &model, proposal, kind, options.ladder).into(),
        };
        BestSharp { model, proposal: proposal.ok(), outcome }
    }

    /// The better one of two: that with a proof, and with the smaller sigma.
    fn or(self, other: BestSharp) -> BestSharp {
        match (self.outcome.proved(), other.outcome.proved()) {
            (Some(first), Some(second)) if second.witness.sigma < first.witness.sigma => other,
            (None, Some(_)) => other,
            _ => self,
        }
    }
}

pub(super) fn model(data: &Data<'_>, kind: TransferKind) -> FloatModel {
    let trade_off = match kind {
        TransferKind::Matched => TradeOff::matched(data),
        TransferKind::Boxes => TradeOff::curve(data),
        TransferKind::ClosedForm => TradeOff::closed_form(data),
    };
    FloatModel::new(data, trade_off)
}

/// Searches and decides the sharp derivation.
///
/// The free numbers of the repaired derivation and of a search with the closed form are starting points of every other
/// search, since a local search alone may miss what another transfer proof has led to; and where no base frequency is
/// matched, the smaller one of what the closed form and the boxes prove is taken.
pub(super) fn best_sharp(data: &Data<'_>, options: Options, repaired: Option<&RepairedProposal>) -> BestSharp {
    let matched = data.spec.internal_model.matched;
    let mut known: Vec<SharpParameters> = repaired.map(RepairedProposal::as_sharp).into_iter().collect();
    let with = |kind, known: &[SharpParameters]| BestSharp::new(data, options, kind, known);
    if options.transfer == TransferChoice::Best {
        let closed_form = with(TransferKind::ClosedForm, &known);
        known.extend(closed_form.proposal.map(|proposal| proposal.parameters));
        let kind = if matched { TransferKind::Matched } else { TransferKind::Boxes };
        return with(kind, &known).or(closed_form);
    }
    if options.transfer == TransferChoice::Boxes {
        let boxes = with(TransferKind::Boxes, &known);
        if boxes.outcome.proved().is_some() {
            return boxes;
        }
    }
    // Where no proof by boxes is found within its effort, the closed form still proves something.
    with(TransferKind::ClosedForm, &known)
}

/// A sharp proof with the free numbers of a repaired one, where it has the smaller sigma.
pub(super) fn not_above(
    data: &Data<'_>,
    options: Options,
    sharp: Outcome<SharpProof>,
    repaired: &RepairedWitness,
) -> Outcome<SharpProof> {
    if sharp.proved().is_some_and(|proof| proof.witness.sigma <= repaired.sigma) {
        return sharp;
    }
    let Some(witness) = sharp_from_repaired(data, repaired) else { return sharp };
    let again = decide(data.spec, witness, options.ladder);
    if again.truth().is_true() { Outcome::Proved(Box::new(again)) } else { sharp }
}
