//! The Dormand-Prince method of order 8(5,3) with step control (library `ode_solvers`), and where stability limits its steps
//! an implicit one.

use super::implicit::implicit;
use super::integration::{IntegrationFailure, Span, Tolerance, is_bounded};
use super::limits::MAX_NUMBERS;
use super::{ClosedLoop, Disturbance};
use nalgebra::DVector;
use ode_solvers::OutputType;
use ode_solvers::dop_shared::{IntegrationError, System};
use ode_solvers::dop853::Dop853;
use sigmastar_lang::expr::Evaluator;
use std::cell::{Cell, RefCell};

/// The most explicit steps of one integration.
const MAX_STEPS: u32 = 40_000;

/// Evaluations of the right side in a step.
const STAGES: u64 = 12;

/// The closed loop: t, then y.
///
/// The time is a state with t' = 1: version 0.6.2 of the library evaluates the twelfth stage of a step at its start
/// instead of its end (its table of nodes has 0 there), which ruins the order unless the equations are autonomous.
struct Equations<'l> {
    closed_loop: &'l ClosedLoop,
    evaluator: RefCell<Evaluator>,
    /// The unit of the independent variable: the library adds it up, and tests its end with an absolute tolerance.
    unit: f64,
    /// How often the right side was evaluated.
    evaluations: Cell<u64>,
}

impl System<f64, DVector<f64>> for &Equations<'_> {
    fn system(&self, _: f64, y: &DVector<f64>, dy: &mut DVector<f64>) {
        let mut evaluator = self.evaluator.borrow_mut();
        self.evaluations.set(self.evaluations.get() + 1);
        dy[0] = 1.0;
        let (t, state) = (y[0], &y.as_slice()[1..]);
        let slope = &mut dy.as_mut_slice()[1..];
        evaluator.set_time(t);
        self.closed_loop.right_side(&mut evaluator, state, Disturbance::default(), slope);
        *dy *= self.unit;
    }

    fn solout(&mut self, _t: f64, y: &DVector<f64>, _dy: &DVector<f64>) -> bool {
        is_escaping(y)
    }
}

/// Why one attempt ended.
enum Stop {
    Failed(IntegrationFailure),
    Stiff,
}

/// Integrates y over a span: the states at t, t + unit, ..., the end, or with one unit the state at the end alone.
///
/// Where stability and not accuracy limits the explicit steps (Hairer's estimate of h |lambda|, at every accepted step),
/// or where they are too many, implicit ones are taken.
fn integrate(
    closed_loop: &ClosedLoop,
    span: Span,
    y: &[f64],
    tolerance: Tolerance,
) -> Result<Vec<Vec<f64>>, IntegrationFailure> {
    match explicit(closed_loop, span, y, tolerance) {
        Ok(states) => Ok(states),
        Err(Stop::Failed(failure)) => Err(failure),
        Err(Stop::Stiff) => {
            let mut states = implicit(closed_loop, span, y, tolerance)?;
            Ok(if span.units > 1 { states } else { states.split_off(1) })
        }
    }
}

/// Whether explicit steps get through a span.
///
/// # Errors
/// [`IntegrationFailure`], where neither kind of steps would.
pub(super) fn is_stiff(
    closed_loop: &ClosedLoop,
    span: Span,
    y: &[f64],
    tolerance: Tolerance,
) -> Result<bool, IntegrationFailure> {
    match explicit(closed_loop, span, y, tolerance) {
        Ok(_) => Ok(false),
        Err(Stop::Stiff) => Ok(true),
        Err(Stop::Failed(failure)) => Err(failure),
    }
}

/// One integration in explicit steps.
fn explicit(closed_loop: &ClosedLoop, span: Span, y: &[f64], tolerance: Tolerance) -> Result<Vec<Vec<f64>>, Stop> {
    let equations = Equations {
        closed_loop,
        evaluator: RefCell::new(closed_loop.evaluator()),
        unit: span.unit,
        evaluations: Cell::new(0),
    };
    // What is left to be spent, and what the library may keep: the states of all steps.
    let kept = MAX_NUMBERS as u64 / y.len() as u64;
    let affordable = (closed_loop.stages_left() / STAGES).min(kept).min(u64::from(MAX_STEPS)) as u32;
    let start = DVector::from_iterator(1 + y.len(), [span.t].into_iter().chain(y.iter().copied()));
    let dense = span.units > 1;
    // Once the last sample before the end is out, version 0.6.2 of the library puts the end out too, extrapolated from
    // whatever step it is in. So the integration goes on for one sample more, and that one is dropped.
    let length = if dense { span.units + 1 } else { 1 };
    let (kind, largest_step) = if dense { (OutputType::Dense, 8.0) } else { (OutputType::Sparse, 1.0) };
    let mut method = Dop853::from_param(
        &equations,
        0.0,
        length as f64,
        1.0,
        start,
        tolerance.relative,
        tolerance.absolute,
        0.9,
        0.0,
        0.333,
        6.0,
        largest_step,
        0.0,
        affordable,
        1,
        kind,
    );
    let outcome = method.integrate();
    closed_loop.count_stages(equations.evaluations.get());
    let (times, states) = method.results().get();
    let escaped = |x: f64| Stop::Failed(IntegrationFailure::Escaped { t: span.t + span.unit * x });
    // What happens after the end does not matter.
    let states =
        if dense { &states[..states.len().min(span.units + 1)] } else { &states[states.len().saturating_sub(1)..] };
    let reached = if dense { states.len() > span.units } else { times.last().is_some_and(|x| (x - 1.0).abs() < 1e-9) };
    if states.iter().any(is_escaping) {
        return Err(escaped(times.last().copied().unwrap_or(0.0)));
    }
    match outcome {
        Err(IntegrationError::StiffnessDetected { .. }) => return Err(Stop::Stiff),
        _ if reached => {}
        Ok(_) => return Err(escaped(times.last().copied().unwrap_or(0.0))),
        Err(IntegrationError::MaxNumStepReached { x, .. }) if affordable < MAX_STEPS => {
            return Err(Stop::Failed(IntegrationFailure::TooMuchWork { t: span.t + span.unit * x }));
        }
        Err(IntegrationError::MaxNumStepReached { .. }) => return Err(Stop::Stiff),
        Err(IntegrationError::StepSizeUnderflow { x }) => return Err(escaped(x)),
    }
    Ok(states.iter().map(|state| state.as_slice()[1..].to_vec()).collect())
}

fn is_escaping(y: &DVector<f64>) -> bool {
    !is_bounded(y.as_slice())
}

/// y(t + duration) from y(t).
///
/// # Errors
/// [`IntegrationFailure`].
pub fn flow(
    closed_loop: &ClosedLoop,
    t: f64,
    duration: f64,
    y: &[f64],
    tolerance: Tolerance,
) -> Result<Vec<f64>, IntegrationFailure> {
    let mut states = integrate(closed_loop, Span { t, unit: duration, units: 1 }, y, tolerance)?;
    Ok(states.pop().unwrap_or_default())
}

/// States at t, t + duration/samples, ..., t + duration: `samples` + 1 of them.
///
/// The spacing also bounds the steps to eight samples, so that the interpolation of order 7 between steps adds
/// nothing visible.
///
/// # Errors
/// [`IntegrationFailure`].
pub fn trajectory(
    closed_loop: &ClosedLoop,
    t: f64,
    duration: f64,
    samples: usize,
    y: &[f64],
    tolerance: Tolerance,
) -> Result<Vec<Vec<f64>>, IntegrationFailure> {
    if samples <= 1 {
        return Ok(vec![y.to_vec(), flow(closed_loop, t, duration, y, tolerance)?]);
    }
    integrate(closed_loop, Span { t, unit: duration / samples as f64, units: samples }, y, tolerance)
}
