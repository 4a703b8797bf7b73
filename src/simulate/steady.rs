//! Steady states: the T-periodic solution by Newton shooting.

use super::ClosedLoop;
use super::adaptive::{IntegrationFailure, Tolerance, derivative, flow};
use super::fixed::{FixedStep, fixed_derivative, fixed_flow};
use crate::progress::Progress;
use nalgebra::{DMatrix, DVector, Dyn, LU};
use thiserror::Error;

/// Periods that are simulated before Newton's method is tried, and then again before the second and third try.
const APPROACHES: [usize; 3] = [10, 30, 90];

/// Derivatives that Newton's method takes in one try, and steps.
const MAX_DERIVATIVES: usize = 12;
const MAX_STEPS: usize = 60;

/// A step that leaves at most this share of the residual was worth it: the next one uses the same derivative.
const ENOUGH: f64 = 0.1;

/// Relative to 1 + max|y|, the derivatives at two points this close to each other have the same multipliers, to the digits
/// that are shown.
const CLOSE_BY: f64 = 1e-9;

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
    closed_loop.renew_effort();
    let shoot = |y: &[f64]| {
        let end = |y: &[f64]| flow(closed_loop, 0.0, closed_loop.period, y, Tolerance::TIGHT);
        shoot(y, end, |y| derivative(closed_loop, y, Tolerance::DERIVATIVE))
    };
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
    closed_loop.renew_effort();
    let shoot = |y: &[f64]| {
        let mut method = FixedStep::new(closed_loop, steps);
        shoot(y, |y| fixed_flow(&mut method, y), |y| fixed_derivative(closed_loop, steps, y))
    };
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

/// Newton's method for y(T; y0) - y0 = 0, with `end` for y(T; y0) and `derivative` for dy(T)/dy0.
///
/// The derivative costs as much as all flows together, so a step uses the last one again while that helps
/// ([`ENOUGH`]); the one at the solution gives the multipliers.
fn shoot(
    guess: &[f64],
    mut end: impl FnMut(&[f64]) -> Result<Vec<f64>, IntegrationFailure>,
    derivative: impl Fn(&[f64]) -> Result<DMatrix<f64>, IntegrationFailure>,
) -> Result<SteadyState, SteadyStateError> {
    let mut y = DVector::from_column_slice(guess);
    let mut best: Option<(f64, DVector<f64>)> = None;
    let mut known: Option<Known> = None;
    let mut derivatives = 0;
    for _ in 0..MAX_STEPS {
        let defect = DVector::from_vec(end(y.as_slice())?) - &y;
        let residual = defect.amax();
        let scale = 1.0 + y.amax();
        let previous = best.as_ref().map(|(smallest, _)| *smallest);
        let worse = previous.is_some_and(|smallest| residual >= smallest);
        let accepted = previous.is_some_and(|smallest| smallest <= ACCEPTED * scale);
        if !worse {
            best = Some((residual, y.clone()));
        }
        // Once rounding is all that is left, further steps only move about.
        if residual <= CONVERGED * scale || (worse && accepted) {
            break;
        }
        let near = known.as_ref().is_some_and(|known| known.is_near(&y));
        let helped =
            previous.is_none_or(|smallest| residual <= ENOUGH * smallest) || (residual <= ACCEPTED * scale && near);
        if !helped || known.is_none() {
            if derivatives == MAX_DERIVATIVES {
                break;
            }
            derivatives += 1;
            known = Some(Known::new(&y, derivative(y.as_slice())?));
        }
        let Some(step) = known.as_ref().and_then(|known| known.factors.solve(&defect)) else { break };
        y += step;
        if !y.iter().all(|value| value.is_finite()) {
            break;
        }
    }
    match best {
        Some((residual, y)) if residual <= ACCEPTED * (1.0 + y.amax()) => {
            // A derivative from close by is the one here.
            let monodromy = match known.filter(|known| known.is_near(&y)) {
                Some(known) => known.monodromy,
                None => derivative(y.as_slice())?,
            };
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

/// A derivative that was computed, and where.
struct Known {
    at: DVector<f64>,
    monodromy: DMatrix<f64>,
    /// Of I - monodromy.
    factors: LU<f64, Dyn, Dyn>,
}

impl Known {
    fn new(at: &DVector<f64>, monodromy: DMatrix<f64>) -> Known {
        let d = monodromy.nrows();
        Known { at: at.clone(), factors: (DMatrix::identity(d, d) - &monodromy).lu(), monodromy }
    }

    fn is_near(&self, y: &DVector<f64>) -> bool {
        (&self.at - y).amax() <= CLOSE_BY * (1.0 + y.amax())
    }
}
