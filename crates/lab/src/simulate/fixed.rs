//! The classical Runge-Kutta method with a fixed step: fast, and what noise that is held over a step needs.

use super::integration::IntegrationFailure;
use super::stiffness::{enough_steps, is_stable};
use super::{ClosedLoop, Disturbance};
use sigmastar_lang::expr::Evaluator;

/// The largest number of time values that are tabulated; beyond it they are computed at each step.
const LARGEST_TABLE: usize = 1 << 24;

/// The classical fourth-order Runge-Kutta method with a whole number of steps per period.
///
/// What f and q compute from the time alone is tabulated over one period at the start: after that a step evaluates
/// only what depends on x and e. The k-th period starts at t = k T.
#[derive(Clone, Debug)]
pub struct FixedStep<'l> {
    closed_loop: &'l ClosedLoop,
    steps_per_period: usize,
    step: f64,
    evaluator: Evaluator,
    /// The half step whose time values the evaluator holds: two stages share one, and so do two steps.
    loaded: Option<usize>,
    /// The time values at t = 0, h/2, h, ..., T - h/2, one row each; empty where there are too many.
    table: Vec<f64>,
    /// Four slopes and a point between.
    stages: [Vec<f64>; 5],
}

impl<'l> FixedStep<'l> {
    /// Prepares steps of T/`steps_per_period`, which is at least 1.
    #[must_use]
    pub fn new(closed_loop: &'l ClosedLoop, steps_per_period: usize) -> FixedStep<'l> {
        let steps_per_period = steps_per_period.max(1);
        let step = closed_loop.period / steps_per_period as f64;
        let mut evaluator = closed_loop.evaluator();
        let mut table = Vec::new();
        if 2 * steps_per_period * closed_loop.time_values() <= LARGEST_TABLE {
            for half in 0..2 * steps_per_period {
                evaluator.set_time(half as f64 * 0.5 * step);
                evaluator.time_values(&mut table);
            }
        }
        let stages = std::array::from_fn(|_| vec![0.0; closed_loop.dimension()]);
        FixedStep { closed_loop, steps_per_period, step, evaluator, loaded: None, table, stages }
    }

    /// The length h of a step.
    #[must_use]
    pub fn step_length(&self) -> f64 {
        self.step
    }

    /// One step from the time `index` h, with the noise held over it.
    #[inline]
    pub fn step(&mut self, index: usize, y: &mut [f64], noise: Disturbance) {
        let h = self.step;
        let half = 2 * (index % self.steps_per_period);
        let [k1, k2, k3, k4, between] = &mut self.stages;
        let closed_loop = self.closed_loop;
        let width = closed_loop.time_values();
        let mut slope = |half: usize, y: &[f64], dy: &mut [f64]| {
            let evaluator = &mut self.evaluator;
            let half = if half == 2 * self.steps_per_period { 0 } else { half };
            if self.loaded != Some(half) {
                self.loaded = Some(half);
                match self.table.get(half * width..(half + 1) * width) {
                    Some(row) => evaluator.load_time_values(row),
                    None => evaluator.set_time(half as f64 * 0.5 * h),
                }
            }
            closed_loop.right_side(evaluator, y, noise, dy);
        };
        slope(half, y, k1);
        advance(between, y, 0.5 * h, k1);
        slope(half + 1, between, k2);
        advance(between, y, 0.5 * h, k2);
        slope(half + 1, between, k3);
        advance(between, y, h, k3);
        slope(half + 2, between, k4);
        combine(y, h, [k1, k2, k3, k4]);
    }
}

/// Whether a period of fixed steps from `y` to `end` counts.
///
/// # Errors
/// Steps beyond the stability of the method for the Jacobian at either end, whatever came out; an end that is not finite.
pub fn checked(
    closed_loop: &ClosedLoop,
    steps: usize,
    t: f64,
    y: &[f64],
    end: &[f64],
) -> Result<(), IntegrationFailure> {
    if [y, end].iter().any(|state| !is_stable(closed_loop, steps, t, state)) {
        return Err(IntegrationFailure::StepTooLong { steps, fixed_steps: enough_steps(closed_loop, t, [y, end]) });
    }
    if end.iter().all(|value| value.is_finite()) { Ok(()) } else { Err(IntegrationFailure::Escaped { t }) }
}

/// `y += h/6 (k1 + 2 k2 + 2 k3 + k4)`.
#[inline]
fn combine(y: &mut [f64], h: f64, [k1, k2, k3, k4]: [&[f64]; 4]) {
    let sixth = h / 6.0;
    for ((y, (k1, k2)), (k3, k4)) in y.iter_mut().zip(k1.iter().zip(k2.iter())).zip(k3.iter().zip(k4.iter())) {
        *y += sixth * (k1 + 2.0 * (k2 + k3) + k4);
    }
}

/// `target = y + h k`.
#[inline]
fn advance(target: &mut [f64], y: &[f64], h: f64, k: &[f64]) {
    for ((target, y), k) in target.iter_mut().zip(y).zip(k) {
        *target = y + h * k;
    }
}
