//! Steady states: the T-periodic solution by Newton shooting.

use super::adaptive::{IntegrationFailure, Tolerance, flow, flow_with_derivative};
use super::fixed::{FixedStep, fixed_flow, fixed_flow_with_derivative};
use super::{ClosedLoop, Progress};
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

impl SteadyStateError {
    /// What to try, where that is known; `flag` is the flag that sets the steps per period.
    #[must_use]
    pub fn way_out(&self, flag: &str) -> Option<String> {
        match self {
            SteadyStateError::Integration(failure) => Some(failure.way_out(flag)),
            SteadyStateError::NoConvergence { .. } => None,
        }
    }
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
    let approach = |period: u32, y: &[f64]| {
        flow(closed_loop, f64::from(period) * closed_loop.period, closed_loop.period, y, Tolerance::ORDINARY)
    };
    let shoot = |y: &[f64]| shoot(closed_loop, y, &|y| flow_with_derivative(closed_loop, y, Tolerance::TIGHT));
    search(start, approach, shoot, progress)
}

/// The same by fixed steps, for loops that are too stiff for steps with control: the periodic solution of the method,
/// which differs from the one of the loop by its error of order 4.
///
/// # Errors
/// [`SteadyStateError`], as above; and steps that are too long for the loop.
pub fn fixed_steady_state(
    closed_loop: &ClosedLoop,
    start: &[f64],
    steps: usize,
    progress: &dyn Progress,
) -> Result<SteadyState, SteadyStateError> {
    let mut method = FixedStep::new(closed_loop, steps);
    let shoot = |y: &[f64]| shoot(closed_loop, y, &|y| fixed_flow_with_derivative(closed_loop, steps, y));
    search(start, |_, y| fixed_flow(&mut method, y), shoot, progress)
}

/// Approaches by simulation and then shoots, again from further along where that fails.
fn search(
    start: &[f64],
    mut approach: impl FnMut(u32, &[f64]) -> Result<Vec<f64>, IntegrationFailure>,
    shoot: impl Fn(&[f64]) -> Result<SteadyState, SteadyStateError>,
    progress: &dyn Progress,
) -> Result<SteadyState, SteadyStateError> {
    let mut y = start.to_vec();
    let mut periods = 0;
    let mut outcome = Err(SteadyStateError::NoConvergence { residual: f64::INFINITY });
    for more in APPROACHES {
        for _ in 0..more {
            y = approach(periods, &y)?;
            periods += 1;
            progress.advance();
        }
        outcome = shoot(&y);
        if outcome.is_ok() {
            break;
        }
    }
    outcome
}

/// The flow over a period with its derivative.
type Flow<'f> = dyn Fn(&[f64]) -> Result<(Vec<f64>, DMatrix<f64>), IntegrationFailure> + 'f;

/// Newton's method for y(T; y0) - y0 = 0.
fn shoot(closed_loop: &ClosedLoop, guess: &[f64], flow: &Flow<'_>) -> Result<SteadyState, SteadyStateError> {
    let d = closed_loop.dimension();
    let mut y = DVector::from_column_slice(guess);
    let mut best: Option<(f64, DVector<f64>, DMatrix<f64>)> = None;
    for _ in 0..MAX_ITERATIONS {
        let (end, monodromy) = flow(y.as_slice())?;
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
