//! Steady states: the T-periodic solution by Newton shooting.

use super::ClosedLoop;
use super::adaptive::{IntegrationFailure, Tolerance, flow, flow_with_derivative};
use crate::progress::Progress;
use nalgebra::{DMatrix, DVector};
use thiserror::Error;

/// Periods that are simulated before Newton's method is tried, and then again before the second and third try.
const APPROACHES: [usize; 3] = [10, 30, 90];

/// Steps of Newton's method in one try.
const MAX_ITERATIONS: usize = 12;

/// A residual at which Newton's method has nothing left to do, relative to 1 + max|y|. It is below rounding: as the
/// slowest multiplier comes close to 1 the residual understates the error, so steps go on while they help.
const CONVERGED: f64 = 1e-16;

/// A residual that is accepted where rounding allows no smaller one.
const ACCEPTED: f64 = 1e-11;

/// A T-periodic solution of the closed loop, as a point of it and what happens around it.
#[derive(Clone, Debug)]
pub struct SteadyState {
    /// y(0).
    pub start: Vec<f64>,
    /// max|y(T) - y(0)|.
    pub residual: f64,
    /// The moduli of the Floquet multipliers, largest first: below 1 the solution attracts its neighbours.
    pub multipliers: Vec<f64>,
}

/// Why no steady state was found.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SteadyStateError {
    /// The simulation did not get there.
    #[error(transparent)]
    Integration(#[from] IntegrationFailure),
    /// Newton's method did not converge.
    #[error("Newton's method did not converge; the last residual is {residual:.3e}")]
    NoConvergence {
        /// The last residual.
        residual: f64,
    },
}

/// Finds the T-periodic solution that a simulation from `start` approaches: y(T; y0) = y0 by Newton's method with the
/// variational equations. The time to simulate until it shows would be set by the slowest multiplier; this is not.
///
/// # Errors
/// [`SteadyStateError`]: the solution escapes, or three tries from points further along it do not converge.
pub fn steady_state(
    closed_loop: &ClosedLoop,
    start: &[f64],
    progress: &dyn Progress,
) -> Result<SteadyState, SteadyStateError> {
    let mut y = start.to_vec();
    let mut periods = 0;
    let mut outcome = Err(SteadyStateError::NoConvergence { residual: f64::INFINITY });
    for more in APPROACHES {
        for _ in 0..more {
            let t = f64::from(periods) * closed_loop.period;
            y = flow(closed_loop, t, closed_loop.period, &y, Tolerance::ORDINARY)?;
            periods += 1;
            progress.advance();
        }
        outcome = shoot(closed_loop, &y);
        if outcome.is_ok() {
            break;
        }
    }
    outcome
}

/// Newton's method for y(T; y0) - y0 = 0.
fn shoot(closed_loop: &ClosedLoop, guess: &[f64]) -> Result<SteadyState, SteadyStateError> {
    let d = closed_loop.dimension();
    let mut y = DVector::from_column_slice(guess);
    let mut best: Option<(f64, DVector<f64>, DMatrix<f64>)> = None;
    for _ in 0..MAX_ITERATIONS {
        let (end, monodromy) = flow_with_derivative(closed_loop, y.as_slice(), Tolerance::TIGHT)?;
        let defect = DVector::from_vec(end) - &y;
        let residual = defect.amax();
        let worse = best.as_ref().is_some_and(|(smallest, ..)| residual >= *smallest);
        let done = residual <= CONVERGED * (1.0 + y.amax());
        if !worse {
            best = Some((residual, y.clone(), monodromy.clone()));
        }
        // Once rounding is all that is left, further steps only move about.
        if done || (worse && best.as_ref().is_some_and(|(residual, y, _)| *residual <= ACCEPTED * (1.0 + y.amax()))) {
            break;
        }
        let Some(step) = (DMatrix::identity(d, d) - monodromy).lu().solve(&defect) else { break };
        y += step;
        if !y.iter().all(|value| value.is_finite()) {
            break;
        }
    }
    match best {
        Some((residual, y, monodromy)) if residual <= ACCEPTED * (1.0 + y.amax()) => {
            let mut multipliers: Vec<f64> =
                monodromy.complex_eigenvalues().iter().map(|multiplier| multiplier.norm()).collect();
            multipliers.sort_by(|a, b| b.total_cmp(a));
            Ok(SteadyState { start: y.as_slice().to_vec(), residual, multipliers })
        }
        other => {
            let residual = other.map_or(f64::INFINITY, |(residual, ..)| residual);
            Err(SteadyStateError::NoConvergence { residual })
        }
    }
}
