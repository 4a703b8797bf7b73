//! The Dormand-Prince method of order 8(5,3) with step control (library `ode_solvers`).

use super::effort::{MAX_NUMBERS, MAX_OPERATIONS};
use super::stiffness::{MAX_FIXED_STEPS, enough_steps};
use super::{ClosedLoop, Disturbance};
use crate::expr::Evaluator;
use nalgebra::{DMatrix, DVector};
use ode_solvers::OutputType;
use ode_solvers::dop_shared::{IntegrationError, System};
use ode_solvers::dop853::Dop853;
use std::cell::{Cell, RefCell};
use thiserror::Error;

/// The most steps of one integration.
const MAX_STEPS: u32 = 40_000;

/// Evaluations of the right side in a step.
const STAGES: u64 = 12;

/// Numbers in the states of one integration of variational equations, which are cut into blocks of columns: the library
/// keeps the states of all steps, some thousands.
const BLOCK_NUMBERS: usize = 4096;

/// The most columns of a block.
const BLOCK_COLUMNS: usize = 32;

/// Whether the integrator ends where stability and not accuracy limits its steps (Hairer's estimate of h |lambda|, at
/// every accepted step): then the error estimate is the only guard, and the integration is done again to see whether it
/// is one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum StiffnessTest {
    EveryStep,
    Never,
}

/// Two tolerances agree on a component of size s where they differ by no more than this many relative tolerances of s,
/// and a tenth of one of the largest component: about five digits of an ordinary run.
const AGREEMENT: f64 = 1e4;

/// No agreement is asked for below this share of the largest component, which is rounding.
const ROUNDING: f64 = 1e-12;

/// Beyond this size a solution counts as escaped.
const ESCAPE: f64 = 1e100;

/// The accuracy of one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Relative to the size of each component.
    pub relative: f64,
    /// Absolute.
    pub absolute: f64,
}

impl Tolerance {
    /// For steady states: at rounding, which is then all that is left of the harmonics that oscillators block.
    pub const TIGHT: Tolerance = Tolerance { relative: 1e-15, absolute: 1e-16 };
    /// For long runs.
    pub const ORDINARY: Tolerance = Tolerance { relative: 1e-9, absolute: 1e-11 };
    /// For derivatives, which Newton's method only needs to converge, and Floquet multipliers to be read.
    pub const DERIVATIVE: Tolerance = Tolerance { relative: 1e-12, absolute: 1e-13 };

    /// Half of this tolerance, or twice where half is below rounding: what a repeated integration is done with.
    fn other(self) -> Tolerance {
        let factor = if self.relative > 1e-14 { 0.5 } else { 2.0 };
        Tolerance { relative: factor * self.relative, absolute: factor * self.absolute }
    }
}

/// Why an integration did not reach its end.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum IntegrationFailure {
    /// The solution left all bounds, or a right side is undefined on its way.
    #[error("the solution escapes, or a right side is undefined, near t = {t:.6}")]
    Escaped {
        /// The last time that was reached.
        t: f64,
    },
    /// Too many steps were needed.
    #[error("more than {MAX_STEPS} steps are needed; stopped at t = {t:.6}")]
    TooManySteps {
        /// The last time that was reached.
        t: f64,
        /// Fixed steps per period that resolve the loop, if there is such a number.
        fixed_steps: Option<u32>,
    },
    /// The loop is stiff, and the step control does not hold its tolerance.
    #[error(
        "the loop is stiff (stability limits the steps), and another tolerance gives another solution near t = {t:.6}: \
         they differ by {difference:.1e}"
    )]
    Stiff {
        /// The end of the integration.
        t: f64,
        /// The largest difference of a component.
        difference: f64,
        /// Fixed steps per period that resolve the loop, if there is such a number.
        fixed_steps: Option<u32>,
    },
    /// More operations than a simulation may take.
    #[error(
        "it takes more than {MAX_OPERATIONS} operations or {MAX_NUMBERS} numbers to keep, which grow with the oscillators, \
         the states, the right sides and the steps; stopped at t = {t:.6}"
    )]
    TooMuchWork {
        /// The last time that was reached.
        t: f64,
    },
    /// A fixed step beyond the stability of its method.
    #[error("{steps} steps per period are too few for this loop: the method is not stable with them")]
    StepTooLong {
        /// The steps per period.
        steps: usize,
        /// Fixed steps per period that resolve the loop, if there is such a number.
        fixed_steps: Option<u32>,
    },
}

impl IntegrationFailure {
    /// What to try; `flag` is the flag that sets the steps per period.
    #[must_use]
    pub fn way_out(&self, flag: &str) -> String {
        match self {
            IntegrationFailure::Escaped { .. } => "check the plant, or take a larger gain".to_owned(),
            IntegrationFailure::TooMuchWork { .. } => {
                "take fewer oscillators, periods or samples, or a plant with fewer states or shorter right sides"
                    .to_owned()
            }
            IntegrationFailure::TooManySteps { fixed_steps, .. }
            | IntegrationFailure::Stiff { fixed_steps, .. }
            | IntegrationFailure::StepTooLong { fixed_steps, .. } => match fixed_steps {
                Some(steps) => format!("{flag} {steps} resolves the fastest mode of the loop"),
                None => format!(
                    "the fastest mode of the loop needs more than the {MAX_FIXED_STEPS} steps per period that {flag} \
                     takes; take a smaller gain"
                ),
            },
        }
    }
}

/// The closed loop alone, or with its variational equations: t, then y, then the columns of Y with Y' = J(t, y) Y.
///
/// The time is a state with t' = 1: version 0.6.2 of the library evaluates the twelfth stage of a step at its start
/// instead of its end (its table of nodes has 0 there), which ruins the order unless the equations are autonomous.
struct Equations<'l> {
    closed_loop: &'l ClosedLoop,
    evaluator: RefCell<Evaluator>,
    variational: bool,
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
        if self.variational {
            self.closed_loop.variational(&mut evaluator, t, state, slope);
        } else {
            evaluator.set_time(t);
            self.closed_loop.right_side(&mut evaluator, state, Disturbance::default(), slope);
        }
        *dy *= self.unit;
    }

    fn solout(&mut self, _t: f64, y: &DVector<f64>, _dy: &DVector<f64>) -> bool {
        !y.iter().all(|value| value.abs() < ESCAPE)
    }
}

/// From where to where, and what is put out: the state at the end, or samples at every unit.
#[derive(Clone, Copy)]
struct Span {
    t: f64,
    unit: f64,
    units: usize,
}

impl Span {
    fn end(self) -> f64 {
        self.t + self.unit * self.units as f64
    }
}

/// Why one attempt ended.
enum Stop {
    Failed(IntegrationFailure),
    Stiff,
}

/// Integrates y over a span: the states at t, t + unit, ..., the end, or with one unit the state at the end alone.
///
/// Where stability limits the steps, it is done again with this tolerance and another one, and what is returned is what
/// both agree on.
fn integrate(
    closed_loop: &ClosedLoop,
    variational: bool,
    span: Span,
    y: &[f64],
    tolerance: Tolerance,
) -> Result<Vec<Vec<f64>>, IntegrationFailure> {
    let run = |tolerance, test| attempt(closed_loop, variational, span, y, tolerance, test);
    // Nothing ends for stiffness where it is not tested.
    let untested = |tolerance| {
        run(tolerance, StiffnessTest::Never).map_err(|stop| match stop {
            Stop::Failed(failure) => failure,
            Stop::Stiff => IntegrationFailure::Escaped { t: span.t },
        })
    };
    match run(tolerance, StiffnessTest::EveryStep) {
        Ok(states) => Ok(states),
        Err(Stop::Failed(failure)) => Err(failure),
        Err(Stop::Stiff) => {
            let (states, others) = (untested(tolerance)?, untested(tolerance.other())?);
            match disagreement(&states, &others, tolerance) {
                None => Ok(states),
                Some(difference) => {
                    let fixed_steps = enough_steps(closed_loop, span.t, [y, last(&others)]);
                    Err(IntegrationFailure::Stiff { t: span.end(), difference, fixed_steps })
                }
            }
        }
    }
}

/// The largest difference of two solutions in a component in which they do not agree; `None` where they do in all.
fn disagreement(states: &[Vec<f64>], others: &[Vec<f64>], tolerance: Tolerance) -> Option<f64> {
    let components = last(states).len();
    let largest = |i: usize| states.iter().chain(others).fold(0.0_f64, |size, y| size.max(y[i].abs()));
    let sizes: Vec<f64> = (0..components).map(largest).collect();
    let floor = (0.1 * tolerance.relative).max(ROUNDING) * sizes.iter().fold(1.0_f64, |size, other| size.max(*other));
    let difference = |i: usize| states.iter().zip(others).fold(0.0_f64, |most, (a, b)| most.max((a[i] - b[i]).abs()));
    (0..components)
        .map(|i| (difference(i), AGREEMENT * tolerance.relative * sizes[i] + floor))
        .filter(|(difference, allowed)| difference > allowed)
        .map(|(difference, _)| difference)
        .max_by(f64::total_cmp)
}

fn last(states: &[Vec<f64>]) -> &[f64] {
    states.last().map_or(&[], Vec::as_slice)
}

/// One integration.
fn attempt(
    closed_loop: &ClosedLoop,
    variational: bool,
    span: Span,
    y: &[f64],
    tolerance: Tolerance,
    test: StiffnessTest,
) -> Result<Vec<Vec<f64>>, Stop> {
    let evaluator = if variational { closed_loop.derivative_evaluator() } else { closed_loop.evaluator() };
    let equations = Equations {
        closed_loop,
        evaluator: RefCell::new(evaluator),
        variational,
        unit: span.unit,
        evaluations: Cell::new(0),
    };
    // What is left to be spent, and what the library may keep: the states of all steps.
    let columns = y.len() / closed_loop.dimension() - 1;
    let kept = MAX_NUMBERS as u64 / y.len() as u64;
    let affordable = (closed_loop.stages_left(columns) / STAGES).min(kept).min(u64::from(MAX_STEPS)) as u32;
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
        if test == StiffnessTest::EveryStep { 1 } else { u32::MAX },
        kind,
    );
    let outcome = method.integrate();
    closed_loop.count_stages(equations.evaluations.get(), columns);
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
        Err(IntegrationError::MaxNumStepReached { x, .. }) => {
            let here = states.last().map_or(y, |state| &state.as_slice()[1..]);
            let fixed_steps = enough_steps(closed_loop, span.t, [y, here]);
            return Err(Stop::Failed(IntegrationFailure::TooManySteps { t: span.t + span.unit * x, fixed_steps }));
        }
        Err(IntegrationError::StepSizeUnderflow { x }) => return Err(escaped(x)),
    }
    Ok(states.iter().map(|state| state.as_slice()[1..].to_vec()).collect())
}

fn is_escaping(y: &DVector<f64>) -> bool {
    !y.iter().all(|value| value.abs() < ESCAPE)
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
    let mut states = integrate(closed_loop, false, Span { t, unit: duration, units: 1 }, y, tolerance)?;
    Ok(states.pop().unwrap_or_default())
}

/// The derivative dy(T)/dy(0) at y(0), from the variational equations; block by block of its columns.
///
/// # Errors
/// [`IntegrationFailure`].
pub fn derivative(
    closed_loop: &ClosedLoop,
    y: &[f64],
    tolerance: Tolerance,
) -> Result<DMatrix<f64>, IntegrationFailure> {
    let d = closed_loop.dimension();
    let columns = (BLOCK_NUMBERS / d).saturating_sub(1).clamp(1, BLOCK_COLUMNS);
    let span = Span { t: 0.0, unit: closed_loop.period, units: 1 };
    let mut entries = Vec::with_capacity(d * d);
    for block in DMatrix::<f64>::identity(d, d).as_slice().chunks(columns * d) {
        let start = [y, block].concat();
        let states = integrate(closed_loop, true, span, &start, tolerance)?;
        entries.extend_from_slice(&last(&states)[d..]);
    }
    Ok(DMatrix::from_vec(d, d, entries))
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
    integrate(closed_loop, false, Span { t, unit: duration / samples as f64, units: samples }, y, tolerance)
}
