//! A proposal for the law at samples with values that are proved in the place of sampled ones.

use super::proofs::{Near, PRECISION};
use crate::certify::sampled_model;
use sigmastar_lang::spec::{self, Specification};
use sigmastar_propose::search::{Extreme, Failing, Obstacle, SampledProposal, SampledSearch};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::sampled::SampledLaw;

/// A specification whose data were proved from a plant's formulas, and where the search for a witness may start.
pub struct ReducedSampled {
    /// The specification.
    pub spec: Specification,
    /// Free numbers for it, in floating point.
    pub proposal: SampledProposal,
    /// The choice that it was proved of, for a family and by matrix inequalities.
    pub(super) near: Option<Box<Near>>,
    /// Other data at a gain that is given, and where the search for a witness may start: one of them may say more.
    pub others: Vec<(Specification, SampledProposal)>,
}

/// That the law has no numbers for this sampling period.
pub(super) fn beyond(sampling: &spec::Sampling) -> Obstacle {
    Failing::Magnitude(Extreme::Number("the sampling period", sampling.step.to_f64())).into()
}

/// The proposal with proved bounds in the place of sampled ones.
pub(super) fn found_again(
    spec: &Specification,
    sampling: &spec::Sampling,
    proposal: &SampledProposal,
    gain: Option<f64>,
) -> Result<SampledProposal, Obstacle> {
    let law = spec.internal_model.sampled_gain(&sampling.step).ok_or_else(|| beyond(sampling))?;
    let data = Data::new(spec, PRECISION);
    let model = sampled_model(&data, sampling, &law);
    SampledSearch::new(&model, SampledLaw::new(&data, sampling, &law).to_f64()).near(proposal, gain)
}
