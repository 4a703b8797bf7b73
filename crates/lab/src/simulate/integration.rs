//! What is asked of an integration, and why one does not reach its end.

use super::limits::{MAX_FIXED_STEPS, MAX_NUMBERS, MAX_OPERATIONS};
use thiserror::Error;

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

    /// A tolerance for implicit steps of order 13, whose estimates of errors end above rounding: this one, but not below what they reach.
    pub(super) fn for_implicit(self) -> Tolerance {
        Tolerance { relative: self.relative.max(1e-11), absolute: self.absolute.max(1e-13) }
    }

    /// What a repeated integration is done with: far enough below to make most of the steps shorter.
    pub(super) fn tighter(self) -> Tolerance {
        Tolerance { relative: 1e-2 * self.relative, absolute: 1e-2 * self.absolute }
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
    /// The loop is stiff, and what implicit steps make of it depends on their tolerance.
    #[error(
        "the loop is stiff, and another tolerance gives another solution near t = {t:.6}: a component differs by \
         {difference:.1e} of its size"
    )]
    Stiff {
        /// The end of the integration.
        t: f64,
        /// The largest difference of a component, relative to its size.
        difference: f64,
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
    /// The loop is stiff, and its actuator saturates: implicit steps are those of the linear law.
    #[error("the loop is stiff, and its actuator saturates near t = {t:.6}: this is not simulated in continuous time")]
    Saturated {
        /// When it does.
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
            IntegrationFailure::Saturated { .. } => {
                "simulate the regulator at samples (`--sampled`), or start nearer to the periodic solution".to_owned()
            }
            IntegrationFailure::TooMuchWork { .. } => {
                "take fewer oscillators, periods or samples, or a plant with fewer states or shorter right sides"
                    .to_owned()
            }
            IntegrationFailure::Stiff { .. } => {
                "look for jumps and kinks in the right sides, or take a smaller gain".to_owned()
            }
            IntegrationFailure::StepTooLong { fixed_steps, .. } => match fixed_steps {
                Some(steps) => format!("{flag} {steps} resolves the fastest mode of the loop"),
                None => format!(
                    "the fastest mode of the loop needs more than the {MAX_FIXED_STEPS} steps per period that {flag} \
                     takes; take a smaller gain"
                ),
            },
        }
    }
}

/// From where to where, and what is put out: the state at the end, or samples at every unit.
#[derive(Clone, Copy)]
pub(super) struct Span {
    pub(super) t: f64,
    pub(super) unit: f64,
    pub(super) units: usize,
}

impl Span {
    pub(super) fn length(self) -> f64 {
        self.unit * self.units as f64
    }

    pub(super) fn end(self) -> f64 {
        self.t + self.length()
    }
}

/// Whether a state is a number that has not escaped.
pub(super) fn is_bounded(y: &[f64]) -> bool {
    y.iter().all(|value| value.abs() < ESCAPE)
}
