//! The periodic solution of the loop at samples, by Newton's method.

use super::derivative::{DISPLACEMENT, period_derivative};
use super::sampled_loop::{BEGIN, SampledLoop, SampledRun};
use crate::simulate::integration::{IntegrationFailure, Tolerance};
use crate::simulate::limits::MAX_OPERATIONS;
use crate::simulate::newton::shoot;
use crate::simulate::steady::{SteadyStateError, distance, multipliers, search};
use sigmastar_document::progress::Progress;
use thiserror::Error;

/// Periods of a loop without a derivative, and the distance from one to the next at which it has settled, relative to
/// 1 + max|y|.
const MOST_PERIODS: usize = 1000;
const SETTLED: f64 = 1e-9;

/// A solution that has the period T at the samples.
#[derive(Clone, Debug)]
pub struct SampledSteady {
    /// The state at the first sample.
    pub start: Vec<f64>,
    /// max|y(T) - y(0)|.
    pub residual: f64,
    /// The moduli of the multipliers of a period, largest first; `None` for a loop without a derivative.
    pub multipliers: Option<Vec<f64>>,
    /// How far the derivative that they are of changes with other displacements, relative to its largest entry.
    pub uncertainty: f64,
}

impl SampledSteady {
    /// The largest of the multipliers.
    #[must_use]
    pub fn largest_multiplier(&self) -> Option<f64> {
        self.multipliers.as_ref().and_then(|multipliers| multipliers.first().copied())
    }
}

/// Why there is no steady state.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SampledSteadyError {
    /// A period has no whole number of samples.
    #[error("a period has {samples:.6} samples, not a whole number: no solution has the period of the plant")]
    Uneven {
        /// T/h.
        samples: f64,
    },
    /// The periodic solution repels its neighbours, or as far as can be told neither repels nor attracts them.
    #[error(
        "the loop is unstable: its periodic solution does not attract its neighbours, whose distance grows by a factor of \
             {multiplier:.6} in each period"
    )]
    Unstable {
        /// The largest multiplier.
        multiplier: f64,
    },
    /// The simulation ended early, or Newton's method did not converge.
    #[error(transparent)]
    Search(#[from] SteadyStateError),
    /// A loop that quantises did not settle.
    #[error(
        "it does not settle: after {periods} periods the state still differs by {distance:.1e} from that a period before"
    )]
    Restless {
        /// The periods.
        periods: usize,
        /// The last distance.
        distance: f64,
    },
}

impl SampledSteadyError {
    /// Whether the run from the initial condition was seen to leave all bounds.
    #[must_use]
    pub fn is_escape(&self) -> bool {
        matches!(self, SampledSteadyError::Search(SteadyStateError::Integration(IntegrationFailure::Escaped { .. })))
    }

    /// What to try.
    #[must_use]
    pub fn way_out(&self) -> String {
        match self {
            SampledSteadyError::Uneven { .. } => {
                "take a whole part of the period; the run below says what it does".to_owned()
            }
            SampledSteadyError::Unstable { .. } => {
                "take a shorter sampling time, a shorter delay, or other gains".to_owned()
            }
            SampledSteadyError::Restless { .. } => {
                "a loop that quantises may go around forever; the run below says how large it stays".to_owned()
            }
            SampledSteadyError::Search(SteadyStateError::Integration(failure)) => run_way_out(failure),
            SampledSteadyError::Search(SteadyStateError::Newton { .. }) => {
                "start elsewhere, or see in the run below whether it settles".to_owned()
            }
        }
    }
}

impl From<IntegrationFailure> for SampledSteadyError {
    fn from(failure: IntegrationFailure) -> SampledSteadyError {
        SampledSteadyError::Search(failure.into())
    }
}

/// What to try where a run of the loop at samples ended early.
pub(super) fn run_way_out(failure: &IntegrationFailure) -> String {
    match failure {
        IntegrationFailure::Escaped { .. } => {
            "the loop is unstable, or the plant is undefined there: take a shorter sampling time, a shorter delay, or other gains"
                .to_owned()
        }
        // No flag sets the steps here.
        failure => failure.way_out("--sampled"),
    }
}

/// The periodic solution that a run from `start` approaches.
///
/// # Errors
/// Those of [`sampled_periodic_solution`]; one that repels its neighbours is an error too.
pub fn sampled_steady_state(
    sampled: &SampledLoop,
    start: &[f64],
    progress: &dyn Progress,
) -> Result<SampledSteady, SampledSteadyError> {
    let steady = sampled_periodic_solution(sampled, start, progress)?;
    match steady.largest_multiplier() {
        Some(multiplier) if multiplier >= 1.0 => Err(SampledSteadyError::Unstable { multiplier }),
        _ => Ok(steady),
    }
}

/// The periodic solution near a run from `start`, whether it attracts its neighbours or not.
///
/// # Errors
/// [`SampledSteadyError`].
pub fn sampled_periodic_solution(
    sampled: &SampledLoop,
    start: &[f64],
    progress: &dyn Progress,
) -> Result<SampledSteady, SampledSteadyError> {
    if sampled.samples().is_none() {
        return Err(SampledSteadyError::Uneven { samples: sampled.period() / sampled.discrete.step });
    }
    sampled.plant().renew_effort();
    // Told before a minute is spent on the first period.
    if BEGIN.saturating_mul(sampled.samples_rounded_up() as u64) > MAX_OPERATIONS {
        return Err(IntegrationFailure::TooMuchWork { t: sampled.time(0) }.into());
    }
    if !sampled.converters.are_smooth() {
        return settle(sampled, start);
    }
    let approach = |period: u32, y: &[f64]| pass_period(sampled, period as usize, y, Tolerance::ORDINARY);
    let derivative =
        |y: &[f64], displacement: f64| Ok(period_derivative(sampled, y, displacement)?.unwrap_or_default());
    let shot = search(
        start,
        approach,
        |y| shoot(y, |y| pass_period(sampled, 0, y, Tolerance::TIGHT), |y| derivative(y, DISPLACEMENT)),
        progress,
    )?;
    let other = derivative(&shot.start, 4.0 * DISPLACEMENT)?;
    let uncertainty = distance(&shot.monodromy, &other);
    let multipliers = multipliers(&shot.monodromy);
    Ok(SampledSteady { start: shot.start, residual: shot.residual, multipliers: Some(multipliers), uncertainty })
}

/// The state after a period, which is one of so many, from one at its start.
pub(crate) fn pass_period(
    sampled: &SampledLoop,
    period: usize,
    y: &[f64],
    tolerance: Tolerance,
) -> Result<Vec<f64>, IntegrationFailure> {
    let samples = sampled.samples_rounded_up();
    let escaped = IntegrationFailure::Escaped { t: sampled.time(period * samples) };
    let mut run = SampledRun::new(sampled, period * samples, y).ok_or(escaped)?;
    for _ in 0..samples {
        run.advance(1, tolerance)?;
    }
    Ok(run.whole_state())
}

/// Periods until two of them agree.
fn settle(sampled: &SampledLoop, start: &[f64]) -> Result<SampledSteady, SampledSteadyError> {
    let mut y = start.to_vec();
    let mut last = f64::INFINITY;
    for _ in 0..MOST_PERIODS {
        let next = pass_period(sampled, 0, &y, Tolerance::ORDINARY)?;
        last = max_distance(&next, &y);
        let size = next.iter().fold(1.0, |size: f64, value| size.max(1.0 + value.abs()));
        y = next;
        if last <= SETTLED * size {
            return Ok(SampledSteady { start: y, residual: last, multipliers: None, uncertainty: 0.0 });
        }
    }
    Err(SampledSteadyError::Restless { periods: MOST_PERIODS, distance: last })
}

/// The largest difference of components.
pub(super) fn max_distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()))
}
