//! The Dormand-Prince method of order 8(5,3) with step control (library `ode_solvers`).

use super::{ClosedLoop, Disturbance};
use crate::expr::Evaluator;
use nalgebra::{DMatrix, DVector};
use ode_solvers::OutputType;
use ode_solvers::dop_shared::{IntegrationError, System};
use ode_solvers::dop853::Dop853;
use std::cell::RefCell;
use thiserror::Error;

/// The most steps of one integration.
const MAX_STEPS: u32 = 100_000;

/// Steps after which the integrator tests for stiffness; a closed loop with a large gain is a little stiff, which
/// costs steps and nothing else.
const STIFFNESS_TEST: u32 = u32::MAX;

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
    },
}

/// The closed loop alone, or with its variational equations: t, then y, then the columns of Y with Y' = J(t, y) Y.
///
/// The time is a state with t' = 1: version 0.6.2 of the library evaluates the twelfth stage of a step at its start
/// instead of its end (its table of nodes has 0 there), which ruins the order unless the equations are autonomous.
struct Equations<'l> {
    closed_loop: &'l ClosedLoop,
    evaluator: RefCell<Evaluator>,
    variational: bool,
}

impl System<f64, DVector<f64>> for &Equations<'_> {
    fn system(&self, _: f64, y: &DVector<f64>, dy: &mut DVector<f64>) {
        let mut evaluator = self.evaluator.borrow_mut();
        let d = self.closed_loop.dimension();
        dy[0] = 1.0;
        let (t, y, dy) = (y[0], &y.as_slice()[1..], &mut dy.as_mut_slice()[1..]);
        if !self.variational {
            evaluator.set_time(t);
            self.closed_loop.right_side(&mut evaluator, y, Disturbance::default(), dy);
            return;
        }
        let (values, jacobian) = self.closed_loop.linearise(&mut evaluator, t, &y[..d]);
        dy[..d].copy_from_slice(&values);
        // Most rows have two entries, so they are picked out once for all columns.
        let rows = jacobian.chunks_exact(d).enumerate();
        let entries: Vec<(usize, usize, f64)> = rows
            .flat_map(|(i, row)| row.iter().enumerate().filter(|(_, j)| **j != 0.0).map(move |(k, j)| (i, k, *j)))
            .collect();
        for (column, derivative) in y[d..].chunks_exact(d).zip(dy[d..].chunks_exact_mut(d)) {
            derivative.fill(0.0);
            for (i, k, entry) in &entries {
                derivative[*i] += entry * column[*k];
            }
        }
    }

    fn solout(&mut self, _t: f64, y: &DVector<f64>, _dy: &DVector<f64>) -> bool {
        !y.iter().all(|value| value.abs() < ESCAPE)
    }
}

/// Where and how finely a solution is put out.
struct Output {
    kind: OutputType,
    spacing: f64,
    largest_step: f64,
}

/// Integrates y from t to `end` and returns the states that were put out, the one at the end among them.
fn integrate(
    equations: &Equations<'_>,
    t: f64,
    end: f64,
    y: &[f64],
    tolerance: Tolerance,
    output: Output,
) -> Result<Vec<Vec<f64>>, IntegrationFailure> {
    let start = DVector::from_iterator(1 + y.len(), [t].into_iter().chain(y.iter().copied()));
    let mut method = Dop853::from_param(
        equations,
        t,
        end,
        output.spacing,
        start,
        tolerance.relative,
        tolerance.absolute,
        0.9,
        0.0,
        0.333,
        6.0,
        output.largest_step,
        0.0,
        MAX_STEPS,
        STIFFNESS_TEST,
        output.kind,
    );
    let outcome = method.integrate();
    let (times, states) = method.results().get();
    match outcome {
        Ok(_) => {}
        Err(IntegrationError::MaxNumStepReached { x, .. }) if !states.last().is_none_or(is_escaping) => {
            return Err(IntegrationFailure::TooManySteps { t: x });
        }
        Err(
            IntegrationError::MaxNumStepReached { x, .. }
            | IntegrationError::StepSizeUnderflow { x }
            | IntegrationError::StiffnessDetected { x },
        ) => return Err(IntegrationFailure::Escaped { t: x }),
    }
    if states.last().is_none_or(is_escaping) || times.last().is_none_or(|last| (last - end).abs() > 1e-9 * (end - t)) {
        return Err(IntegrationFailure::Escaped { t: times.last().copied().unwrap_or(t) });
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
    let equations = Equations { closed_loop, evaluator: RefCell::new(closed_loop.evaluator()), variational: false };
    let output = Output { kind: OutputType::Sparse, spacing: duration, largest_step: duration };
    let mut states = integrate(&equations, t, t + duration, y, tolerance, output)?;
    Ok(states.pop().unwrap_or_default())
}

/// y(T) from y(0), with the derivative dy(T)/dy(0) from the variational equations.
///
/// # Errors
/// [`IntegrationFailure`].
pub fn flow_with_derivative(
    closed_loop: &ClosedLoop,
    y: &[f64],
    tolerance: Tolerance,
) -> Result<(Vec<f64>, DMatrix<f64>), IntegrationFailure> {
    let d = closed_loop.dimension();
    let equations =
        Equations { closed_loop, evaluator: RefCell::new(closed_loop.derivative_evaluator()), variational: true };
    let mut start = y.to_vec();
    start.extend(DMatrix::<f64>::identity(d, d).as_slice());
    let period = closed_loop.period;
    let output = Output { kind: OutputType::Sparse, spacing: period, largest_step: period };
    let mut states = integrate(&equations, 0.0, period, &start, tolerance, output)?;
    let end = states.pop().unwrap_or_default();
    Ok((end[..d].to_vec(), DMatrix::from_column_slice(d, d, &end[d..])))
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
    let equations = Equations { closed_loop, evaluator: RefCell::new(closed_loop.evaluator()), variational: false };
    let samples = samples.max(1);
    let spacing = duration / samples as f64;
    let output = Output { kind: OutputType::Dense, spacing, largest_step: (8.0 * spacing).min(duration) };
    let mut states = integrate(&equations, t, t + duration, y, tolerance, output)?;
    // Accumulated rounding of the times may put the last sample out twice or just before the end.
    if states.len() > samples + 1 {
        states.drain(samples..states.len() - 1);
    }
    Ok(states)
}
