//! What a trial holds against the bounds of a claim.

use super::claim::TriedClaim;
use super::finding::{Finding, Trial, Violation};
use super::frame::OwnPlant;
use crate::simulate::{IntegrationFailure, SteadyStateError};

/// What a bound may be exceeded by before it counts: integration and rounding.
const TOLERANCE: f64 = 1e-6;
/// What a bound may always be exceeded by before it counts, as an absolute size.
const ROOM: f64 = 1e-9;
/// The share of a state by which a period of it may be off.
const ROUNDING: f64 = 1e-12;

/// By what factor a size may differ at a gain that is [`ABOVE`](super::frame::ABOVE) times that of its bound.
const NEARLY: f64 = 1.0 + 1e-5;

/// Periods from the initial condition that are compared with the periodic solution.
pub(super) const PERIODS: usize = 12;

/// Collects shares of bounds, and the first violation.
pub(super) struct Checks {
    shares: Vec<(&'static str, f64)>,
    violation: Option<Violation>,
    /// What a found value may be above a bound by rounding and integration alone.
    room: f64,
}

impl Default for Checks {
    fn default() -> Checks {
        Checks { shares: Vec::new(), violation: None, room: ROOM }
    }
}

impl Checks {
    /// With the room that a periodic solution needs whose components are known to rounding, and to what is left of its
    /// residual, which the slowest multiplier makes larger.
    pub(super) fn around(claim: &TriedClaim, start: &[f64], residual: f64, multiplier: f64) -> Checks {
        let size = start.iter().fold(1.0, |size: f64, value| size.max(value.abs()));
        let spread = claim.own.as_ref().map_or(1.0, OwnPlant::spread).max(1.0);
        let inaccuracy = (residual + ROUNDING * size) / (1.0 - multiplier).max(ROUNDING.sqrt());
        Checks { room: (inaccuracy * spread).max(ROOM), ..Checks::default() }
    }

    pub(super) fn at_most(&mut self, quantity: &'static str, found: f64, bound: f64) {
        self.shares.push((quantity, if bound > 0.0 { found / bound } else { 0.0 }));
        // NaN is no value that a bound allows; and room above a large bound may be infinite, which what is found is not to be.
        let holds = found <= bound || (found.is_finite() && found <= bound * (1.0 + TOLERANCE) + self.room);
        if !holds && self.violation.is_none() {
            self.violation = Some(Violation { quantity, bound, found });
        }
    }

    /// Each of these, found at a gain a little above that of the bounds.
    pub(super) fn all_at_most<const N: usize>(
        &mut self,
        quantities: [&'static str; N],
        found: [f64; N],
        bounds: [f64; N],
    ) {
        for ((quantity, found), bound) in quantities.into_iter().zip(found).zip(bounds) {
            self.at_most(quantity, found, bound * NEARLY);
        }
    }

    /// Whether a bound does not hold.
    pub(super) fn are_broken(&self) -> bool {
        self.violation.is_some()
    }

    /// What became of the trial.
    pub(super) fn finding(self, trial: Trial) -> Finding {
        match self.violation {
            Some(violation) => Finding::Violated(Box::new(trial), violation),
            None => Finding::Holds { trial: Box::new(trial), shares: self.shares },
        }
    }
}

/// Why there is no periodic solution to compare with; without the time and the size, so that trials with the same reason are
/// told together.
pub(super) fn why_none(error: &SteadyStateError) -> String {
    match error {
        SteadyStateError::Integration(failure) => why(failure),
        SteadyStateError::Newton { .. } => {
            "the run from the initial set stays within bounds, and Newton's method finds no periodic solution from its states"
                .to_owned()
        }
    }
}

/// A trial whose simulation the machine could not finish.
pub(super) fn unfinished(failure: &IntegrationFailure) -> Finding {
    Finding::Unfinished(why(failure))
}

fn why(failure: &IntegrationFailure) -> String {
    match failure {
        IntegrationFailure::Escaped { .. } | IntegrationFailure::Saturated { .. } => failure.to_string(),
        IntegrationFailure::TooMuchWork { .. } => "the simulation of the closed loop takes too much work".to_owned(),
        IntegrationFailure::Stiff { .. } | IntegrationFailure::StepTooLong { .. } => {
            "what the simulation of the closed loop gives depends on its tolerance".to_owned()
        }
    }
}

impl TriedClaim {
    /// |x| of a state at t = s T, from the orbit where the claim is about one plant.
    pub(super) fn distance(&self, s: f64, x: &[f64]) -> f64 {
        self.own.as_ref().map_or_else(|| norm(x), |own| own.distance(s, x))
    }

    /// |x| of a difference of two states.
    pub(super) fn norm(&self, difference: &[f64]) -> f64 {
        self.own.as_ref().map_or_else(|| norm(difference), |own| own.norm(difference))
    }
}

pub(super) fn norm(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use sigmastar_lang::spec::Specification;

    #[test]
    fn bounds_are_exceeded_by_more_than_the_tolerance() {
        for (found, holds) in [(0.5, true), (1.0 + 1e-7, true), (1.0 + 2e-6, false), (f64::NAN, false)] {
            let mut checks = Checks::default();
            checks.at_most("quantity", found, 1.0);
            assert_eq!(checks.violation.is_none(), holds, "{found}");
        }
        let mut checks = Checks::default();
        checks.at_most("no number", f64::INFINITY, f64::MAX);
        assert!(checks.are_broken());
    }

    /// A slow state around 400 is known to rounding times 1/(1 - multiplier), and no better.
    #[test]
    fn rounding_of_large_states_is_no_violation() {
        let spec = Specification::from_json("linear", include_str!("../../../../specs/linear.json")).unwrap();
        let claim = TriedClaim::for_tests(spec, [3.0, 3.0]);
        let broken = |size: f64, multiplier: f64, found: f64| {
            let mut checks = Checks::around(&claim, &[size], 0.0, multiplier);
            checks.at_most("quantity", found, 0.0);
            checks.are_broken()
        };
        assert!(!broken(412.0, 0.976, 2.4e-9) && broken(412.0, 0.976, 1e-6));
        assert!(broken(1.0, 0.5, 2.4e-9) && !broken(1.0, 0.5, 1e-10));
    }
}
