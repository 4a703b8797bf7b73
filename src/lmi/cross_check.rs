//! The matrix inequality of C5 against its closed form, on a certificate.

use super::decay::{DecayData, verify_decay};
use super::propose::{propose_multipliers, propose_sigma};
use super::solve::SolverFailure;
use crate::constants::sharp::{SharpEvaluation, SharpWitness};
use crate::data::Data;
use crate::enclosure::Enclosure;
use thiserror::Error;

/// Two independent answers to the same question.
#[derive(Clone, Debug)]
pub struct CrossCheck {
    /// The threshold of sigma by the closed form, rigorously.
    pub closed_form: Enclosure,
    /// The smallest sigma of the matrix inequality, by the solver.
    pub solver_sigma: f64,
    /// |solver_sigma - closed_form| / closed_form, in floating point.
    pub relative_difference: f64,
    /// Whether multipliers were found with which the matrix at the witness's sigma is proved positive definite: C5 then
    /// holds by the matrix inequality too, whatever the closed form says.
    pub verified_at_sigma: bool,
}

/// Why there is nothing to compare.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum CrossCheckError {
    /// C5 has no bounded data or no threshold for this witness.
    #[error("C5 has no bounded data for this witness")]
    Unbounded,
    /// The solver has no answer.
    #[error(transparent)]
    Solver(#[from] SolverFailure),
}

/// Holds the matrix inequality of C5 against the closed form, for the numbers of an evaluated witness.
///
/// Guarantee: `verified_at_sigma` is proved in exact arithmetic. `solver_sigma` and `relative_difference` are floating
/// point: a large difference points to an error in one of the two, a small one proves nothing.
///
/// # Errors
/// Data without bounds, and a solver without an answer.
pub fn cross_check(
    evaluation: &SharpEvaluation,
    witness: &SharpWitness,
    data: &Data<'_>,
) -> Result<CrossCheck, CrossCheckError> {
    let closed_form = evaluation.decay.sigma_threshold.clone();
    let decay =
        DecayData::new(data, &evaluation.error_box, &witness.w_x, &witness.h).ok_or(CrossCheckError::Unbounded)?;
    if !closed_form.is_bounded() {
        return Err(CrossCheckError::Unbounded);
    }
    let smallest = propose_sigma(&decay)?;
    let threshold = closed_form.midpoint_f64();
    let at_sigma = propose_multipliers(&decay, &witness.sigma)?;
    let verified_at_sigma =
        at_sigma.exact_multipliers().is_some_and(|multipliers| verify_decay(&decay, &witness.sigma, &multipliers));
    Ok(CrossCheck {
        relative_difference: ((smallest.sigma - threshold) / threshold).abs(),
        closed_form,
        solver_sigma: smallest.sigma,
        verified_at_sigma,
    })
}
