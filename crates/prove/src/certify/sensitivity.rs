//! Which datum of the file would lower sigma* most. Floating point: an explanation, not a claim.

use super::pool::model as model_of;
use super::round::TransferKind;
use sigmastar_decide::conditions::SharpProof;
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_lang::spec::Specification;
use sigmastar_lang::spec::model::Constant;
use sigmastar_propose::search::{Datum, FloatModel, SharpProposal, search_sharp_near, sensitivities};
use sigmastar_theory::data::Data;

/// The relative change of each datum.
const STEP: f64 = 0.01;

/// Bits at which what belongs to another mu is enclosed before it is rounded to doubles.
const PRECISION: u32 = 64;

/// The data that lower sigma* when they are one per cent better, by how much (relatively), the best first. Compared is what
/// the file states, but for the weights: bounding functions, triple, harmonics, initial set, domain and mu; of a plant the
/// initial set and mu, with the bounds that are proved.
pub(super) fn ranked(
    spec: &Specification,
    model: &FloatModel,
    proposal: &SharpProposal,
    proof: &SharpProof,
) -> Vec<(Datum, f64)> {
    let stated = model.data(spec.plant().is_some()).map(|datum| (datum, model.improved(datum, STEP)));
    let all: Vec<(Datum, FloatModel)> = stated.chain(with_other_mu(spec, model, proof)).collect();
    let mut found = sensitivities(model, proposal, &all);
    found.retain(|(_, gain)| *gain > 0.0);
    found.sort_by(|a, b| b.1.total_cmp(&a.1));
    found
}

/// sigma* with the controller aligned, which costs nothing, where it is not and that lowers sigma* by a share that matters; of a
/// plant with the bounds that are proved, so that it may come out smaller still.
pub(super) fn aligned(model: &FloatModel, proposal: &SharpProposal) -> Option<f64> {
    if model.set.is_aligned() {
        return None;
    }
    let found = search_sharp_near(&model.with_set(model.set.aligned()), proposal).ok()?;
    (found.sigma < proposal.sigma * (1.0 - STEP)).then_some(found.sigma)
}

/// sigma* with the input gain known to be the nominal one, where it is uncertain; none where a matrix inequality of the uncertain gain
/// stands in the place of C5, which says nothing of the other.
pub(super) fn with_nominal_gain(
    spec: &Specification,
    model: &FloatModel,
    proposal: &SharpProposal,
    proof: &SharpProof,
) -> Option<f64> {
    if model.input_gain.is_none() || model.by_matrix.is_some() {
        return None;
    }
    let kind = TransferKind::of(&proof.witness.transfer);
    let known = Specification { input_gain: None, ..spec.clone() };
    let found = search_sharp_near(&model_of(&Data::new(&known, PRECISION), kind), proposal).ok()?;
    (found.sigma < proposal.sigma).then_some(found.sigma)
}

/// The models of a smaller and of a larger mu, with the transfer bound that belongs to it. None where that bound is proved by
/// boxes, which take long to find.
fn with_other_mu(spec: &Specification, model: &FloatModel, proof: &SharpProof) -> Vec<(Datum, FloatModel)> {
    let kind = TransferKind::of(&proof.witness.transfer);
    if kind == TransferKind::Boxes {
        return Vec::new();
    }
    let with = |larger: bool| {
        let factor = if larger { 1.0 + STEP } else { 1.0 - STEP };
        let mu = round_f64(model.mu * factor, 12, Direction::Nearest)?;
        let mut other = spec.clone();
        other.internal_model.mu = Constant::rational(&mu);
        Some((Datum::Mu { larger }, model_of(&Data::new(&other, PRECISION), kind)))
    };
    [true, false].into_iter().filter_map(with).collect()
}
