//! Steady states: the T-periodic solution by Newton shooting.

use super::ClosedLoop;
use super::adaptive::{flow, is_stiff};
use super::integration::{IntegrationFailure, Span, Tolerance};
use super::newton::{NewtonFailure, Shot, shoot};
use super::period::Period;
use nalgebra::DMatrix;
use sigmastar_document::progress::Progress;
use thiserror::Error;

/// Periods that are simulated before Newton's method is tried, and then again before the second and third try.
const APPROACHES: [usize; 3] = [10, 30, 90];

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
    /// The run from the initial condition, or an integration on the way, did not come to its end.
    #[error(transparent)]
    Integration(#[from] IntegrationFailure),
    /// The run stays within bounds, and Newton's method came to no periodic solution from any of its states that were tried.
    #[error("the run stays within bounds, but Newton's method from its state after {periods} periods {failure}")]
    Newton {
        /// The periods of the run before the last try.
        periods: u32,
        /// What became of that try.
        failure: NewtonFailure,
    },
}

impl SteadyStateError {
    /// What to try, where that is known; `flag` is the flag that sets the steps per period.
    #[must_use]
    pub fn way_out(&self, flag: &str) -> String {
        match self {
            SteadyStateError::Integration(failure) => failure.way_out(flag),
            SteadyStateError::Newton { .. } => {
                "an `initial` of the plant file that is nearer to the periodic solution may help; the run below says whether \
                 the loop settles"
                    .to_owned()
            }
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
    search(start, approach, |y| steady_state_near(closed_loop, y), progress)
}

/// The T-periodic solution that Newton's method comes to from a state at t = 0, without any simulation before.
///
/// # Errors
/// [`NewtonFailure`].
pub(super) fn steady_state_near(closed_loop: &ClosedLoop, y: &[f64]) -> Result<SteadyState, NewtonFailure> {
    let one_period = Span { t: 0.0, unit: closed_loop.period, units: 1 };
    match is_stiff(closed_loop, one_period, y, Tolerance::TIGHT)? {
        false => shoot_explicitly(closed_loop, y),
        true => shoot_implicitly(closed_loop, y),
    }
}

/// Newton's method with explicit flows at the tightest tolerance; only the derivative is by implicit steps.
fn shoot_explicitly(closed_loop: &ClosedLoop, y: &[f64]) -> Result<SteadyState, NewtonFailure> {
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
fn shoot_implicitly(closed_loop: &ClosedLoop, y: &[f64]) -> Result<SteadyState, NewtonFailure> {
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
    shoot: impl Fn(&[f64]) -> Result<S, NewtonFailure>,
    progress: &dyn Progress,
) -> Result<S, SteadyStateError> {
    let mut y = start.to_vec();
    let mut periods = 0;
    let mut failure = NewtonFailure::NoConvergence { residual: f64::INFINITY };
    for more in APPROACHES {
        for _ in 0..more {
            y = approach(periods, &y)?;
            periods += 1;
            progress.advance();
        }
        match shoot(&y) {
            Ok(found) => return Ok(found),
            Err(error) => failure = error,
        }
    }
    Err(match failure {
        NewtonFailure::NoConvergence { .. } | NewtonFailure::Integration(IntegrationFailure::Escaped { .. }) => {
            SteadyStateError::Newton { periods, failure }
        }
        // What is too much work, or stiff, is that whatever asks for it.
        NewtonFailure::Integration(other) => SteadyStateError::Integration(other),
    })
}
