//! Steady states: the T-periodic solution by Newton shooting.

use super::ClosedLoop;
use super::adaptive::{IntegrationFailure, Span, Tolerance, flow, is_stiff};
use super::period::Period;
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

/// Implicit steps of a period at most.
const MOST_STEPS: usize = 1 << 14;

/// Steps and steps of half their length agree to this share: what is shown has six digits.
const AGREED: f64 = 1e-8;

/// A share that is accepted where the steps are as many as allowed.
const ENOUGH_DIGITS: f64 = 1e-6;

/// A T-periodic solution of the closed loop, as a point of it and what happens around it.
#[derive(Clone, Debug)]
pub struct SteadyState {
    /// y(0).
    pub start: Vec<f64>,
    /// max|y(T) - y(0)|.
    pub residual: f64,
    /// The moduli of the Floquet multipliers, largest first: below 1 the solution attracts its neighbours.
    pub multipliers: Vec<f64>,
    /// How far the derivative that they are of changes with steps of half the length, relative to its largest entry.
    pub uncertainty: f64,
    /// The implicit steps of a period whose periodic solution it is; `None` for the one of explicit steps with control.
    pub(super) implicit_steps: Option<usize>,
}

impl SteadyState {
    /// The name of the method that it is periodic by.
    #[must_use]
    pub fn method(&self) -> &'static str {
        if self.implicit_steps.is_some() { "radau-13" } else { "dormand-prince-8" }
    }
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
    fn is_too_much_work(&self) -> bool {
        matches!(self, SteadyStateError::Integration(IntegrationFailure::TooMuchWork { .. }))
    }

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
    let one_period = Span { t: 0.0, unit: closed_loop.period, units: 1 };
    let shoot = |y: &[f64]| match is_stiff(closed_loop, one_period, y, Tolerance::TIGHT)? {
        false => shoot_explicitly(closed_loop, y),
        true => shoot_implicitly(closed_loop, y),
    };
    search(start, approach, shoot, progress)
}

/// Newton's method with explicit flows at the tightest tolerance; only the derivative is by implicit steps.
fn shoot_explicitly(closed_loop: &ClosedLoop, y: &[f64]) -> Result<SteadyState, SteadyStateError> {
    let mut steps = Period::fewest_steps(closed_loop);
    let shot = shoot(
        y,
        |y| flow(closed_loop, 0.0, closed_loop.period, y, Tolerance::TIGHT),
        |y| {
            loop {
                match passed(closed_loop, steps, y) {
                    Err(IntegrationFailure::Escaped { .. }) if steps < MOST_STEPS => steps *= 2,
                    other => return other,
                }
            }
        },
    )?;
    let mut coarse = shot.monodromy;
    loop {
        steps *= 2;
        let fine = passed(closed_loop, steps, &shot.start)?;
        let uncertainty = distance(&coarse, &fine);
        if uncertainty <= AGREED || steps >= MOST_STEPS {
            let multipliers = multipliers(&fine);
            let (start, residual) = (shot.start, shot.residual);
            return Ok(SteadyState { start, residual, multipliers, uncertainty, implicit_steps: None });
        }
        coarse = fine;
    }
}

/// The periodic solution of the implicit method with ever shorter steps, until two of them agree.
fn shoot_implicitly(closed_loop: &ClosedLoop, y: &[f64]) -> Result<SteadyState, SteadyStateError> {
    let mut coarse: Option<Shot> = None;
    let mut steps = Period::fewest_steps(closed_loop);
    loop {
        let mut period = Period::new(closed_loop, steps);
        let guess = coarse.as_ref().map_or(y, |shot| &shot.start).to_vec();
        let shot = shoot(&guess, |y| Ok(period.pass(y, false)?.end), |y| passed(closed_loop, steps, y));
        let fine = match shot {
            Ok(shot) => shot,
            // Steps that are too long for the iteration, or for the solution to stay where it is.
            Err(error) if error.is_too_much_work() || steps >= MOST_STEPS => return Err(error),
            Err(_) => {
                steps *= 2;
                continue;
            }
        };
        if let Some(coarse) = &coarse {
            let size = period.pass(&fine.start, false)?.largest_error;
            let difference = start_difference(closed_loop, &coarse.start, &fine.start, size);
            let uncertainty = distance(&coarse.monodromy, &fine.monodromy);
            if difference.max(uncertainty) <= AGREED || (steps >= MOST_STEPS && difference <= ENOUGH_DIGITS) {
                let (start, residual) = (fine.start, fine.residual);
                let multipliers = multipliers(&fine.monodromy);
                return Ok(SteadyState { start, residual, multipliers, uncertainty, implicit_steps: Some(steps) });
            }
            if steps >= MOST_STEPS {
                return Err(IntegrationFailure::Stiff { t: closed_loop.period, difference }.into());
            }
        }
        coarse = Some(fine);
        steps *= 2;
    }
}

/// dy(T)/dy(0) by implicit steps of a number.
fn passed(closed_loop: &ClosedLoop, steps: usize, y: &[f64]) -> Result<DMatrix<f64>, IntegrationFailure> {
    let passed = Period::new(closed_loop, steps).pass(y, true)?;
    Ok(passed.derivative.unwrap_or_default())
}

/// The difference of two starts, relative to the largest component in natural sizes; of e, whose sizes over the period is
/// given, relative to that.
fn start_difference(closed_loop: &ClosedLoop, a: &[f64], b: &[f64], size_of_e: f64) -> f64 {
    let largest = b.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
    let components = a.iter().zip(b).enumerate();
    components.fold(0.0, |most, (component, (a, b))| {
        let size = if component == closed_loop.states() { size_of_e } else { largest };
        let share = if a == b { 0.0 } else { (a - b).abs() / size };
        most.max(share)
    })
}

/// The largest difference of two derivatives, relative to their largest entry.
pub(super) fn distance(a: &DMatrix<f64>, b: &DMatrix<f64>) -> f64 {
    (a - b).amax() / b.amax().max(f64::MIN_POSITIVE)
}

/// The moduli of the eigenvalues, largest first.
pub(super) fn multipliers(monodromy: &DMatrix<f64>) -> Vec<f64> {
    let mut multipliers: Vec<f64> = monodromy.complex_eigenvalues().iter().map(|value| value.norm()).collect();
    multipliers.sort_by(|a, b| b.total_cmp(a));
    multipliers
}

/// Approaches by simulation and then shoots, again from further along where that fails.
pub(super) fn search<S>(
    start: &[f64],
    mut approach: impl FnMut(u32, &[f64]) -> Result<Vec<f64>, IntegrationFailure>,
    shoot: impl Fn(&[f64]) -> Result<S, SteadyStateError>,
    progress: &dyn Progress,
) -> Result<S, SteadyStateError> {
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
pub(super) fn shoot(
    guess: &[f64],
    mut end: impl FnMut(&[f64]) -> Result<Vec<f64>, IntegrationFailure>,
    mut derivative: impl FnMut(&[f64]) -> Result<DMatrix<f64>, IntegrationFailure>,
) -> Result<Shot, SteadyStateError> {
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
            Ok(Shot { start: y.as_slice().to_vec(), residual, monodromy })
        }
        other => {
            let residual = other.map_or(f64::INFINITY, |(residual, ..)| residual);
            Err(SteadyStateError::NoConvergence { residual })
        }
    }
}

/// What Newton's method arrived at.
pub(super) struct Shot {
    pub(super) start: Vec<f64>,
    pub(super) residual: f64,
    pub(super) monodromy: DMatrix<f64>,
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
