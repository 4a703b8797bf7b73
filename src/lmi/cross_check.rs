//! The matrix inequality of C5 against its closed form, on a certificate.

use super::decay::{DecayData, verify_decay};
use super::propose::{propose_multipliers, propose_sigma};
use super::solve::SolverFailure;
use crate::constants::sharp::{SharpEvaluation, SharpWitness};
use crate::data::Data;
use crate::enclosure::Enclosure;
use crate::number::{Direction, round_f64};
use rug::Rational;
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
    /// Multipliers (l_x, l_e, l_f) with which the matrix at the witness's sigma is proved positive definite, where they were
    /// found: C5 then holds by the matrix inequality too, whatever the closed form says.
    pub multipliers: Option<[Rational; 3]>,
}

/// The largest relative difference that the solver's tolerance explains; on trial data over many orders of magnitude it
/// stays below 1e-6.
pub const AGREEMENT: f64 = 1e-5;

impl CrossCheck {
    /// Whether the two answers agree to the solver's tolerance.
    #[must_use]
    pub fn agrees(&self) -> bool {
        self.relative_difference <= AGREEMENT
    }
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
/// Guarantee: what `multipliers` prove is proved in exact arithmetic. `solver_sigma` and `relative_difference` are floating
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
    let proves = |multipliers: &[Rational; 3]| verify_decay(&decay, &witness.sigma, multipliers);
    // Short numbers where they do, the solver's own doubles otherwise.
    let short = at_sigma.multipliers.map(|value| round_f64(value, 9, Direction::Nearest));
    let [l_x, l_e, l_f] = short;
    let short = l_x.zip(l_e).zip(l_f).map(|((l_x, l_e), l_f)| [l_x, l_e, l_f]);
    let multipliers = short.filter(proves).or_else(|| at_sigma.exact_multipliers().filter(proves));
    Ok(CrossCheck {
        relative_difference: ((smallest.sigma - threshold) / threshold).abs(),
        closed_form,
        solver_sigma: smallest.sigma,
        multipliers,
    })
}
