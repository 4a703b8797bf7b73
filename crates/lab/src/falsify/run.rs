//! The run from the initial set by itself: only that contradicts a claim. A search for the periodic solution that fails says
//! nothing about the claim, nor does a periodic solution that the run does not come to.

use super::checks::Checks;
use super::claim::TriedClaim;
use super::finding::{Finding, Trial};
use crate::simulate::{ClosedLoop, IntegrationFailure, Tolerance, flow, trajectory};
use sigmastar_exact::number::Portable;

/// Periods of a run whose sizes are looked at, as many as a search for the steady state simulates; and samples of each.
const PERIODS: usize = 130;
const SAMPLES: usize = 256;

/// Periods after which a run has come to a periodic solution, at most.
pub(super) const MOST_PERIODS: usize = 1000;

/// How near, relative to 1 + max|y|, it has come then.
const NEAR: f64 = 1e-4;

/// A solution that escapes is looked at until this power of 1/2 of the time is left.
const LAST: i32 = 40;

/// What the claim says of every solution from the initial set: it stays in the error box around the periodic solution.
const SIZES: [&str; 2] =
    ["$`|x|`$ of the solution from the initial set", "$`|e|`$ of the solution from the initial set"];

/// Why a periodic solution that breaks a bound is not held against the claim.
pub(super) const ELSEWHERE: &str = "the periodic solution that was found breaks a bound, and the run from the initial set is \
                                    not seen to come to it";

/// The largest |x| and |e| of a run.
#[derive(Default)]
pub(super) struct Largest([f64; 2]);

impl Largest {
    /// Takes a state (x, e) at t = s T into account.
    pub(super) fn take(&mut self, claim: &TriedClaim, s: f64, state: &[f64]) {
        let Some((e, x)) = state.split_last() else { return };
        for (largest, size) in self.0.iter_mut().zip([claim.distance(s, x), e.abs()]) {
            // What is not a number is no size.
            *largest = largest.max(size);
        }
    }

    /// A violation, where a size is beyond what the claim allows anywhere on the way; else why nothing was found out.
    pub(super) fn finding(self, claim: &TriedClaim, trial: Trial, why: String) -> Finding {
        let mut checks = Checks::default();
        for (((quantity, size), per), radius) in SIZES.into_iter().zip(self.0).zip(claim.periodic).zip(claim.error_box)
        {
            checks.at_most(quantity, size, per + radius);
        }
        match checks.finding(trial) {
            Finding::Holds { .. } => Finding::Unfinished(why),
            violated => violated,
        }
    }
}

/// The finding of a trial for which there is no periodic solution to compare with.
pub(super) fn alone(claim: &TriedClaim, trial: Trial, closed_loop: &ClosedLoop, why: String) -> Finding {
    let (mut largest, mut y) = (Largest::default(), trial.start.clone());
    let (period, of_plant) = (closed_loop.period, closed_loop.states() + 1);
    closed_loop.renew_effort();
    for index in 0..PERIODS {
        let t = index as f64 * period;
        match trajectory(closed_loop, t, period, SAMPLES, &y, Tolerance::ORDINARY) {
            Ok(samples) => {
                for (at, sample) in samples.iter().enumerate() {
                    largest.take(claim, at as f64 / SAMPLES as f64, &sample[..of_plant]);
                }
                y = samples.last().cloned().unwrap_or(y);
            }
            Err(IntegrationFailure::Escaped { t: end }) => {
                for k in 1..=LAST {
                    let length = (end - t) * (1.0 - 2f64.portable_powi(-k));
                    let Ok(state) = flow(closed_loop, t, length, &y, Tolerance::ORDINARY) else { break };
                    largest.take(claim, length / period, &state[..of_plant]);
                }
                break;
            }
            Err(_) => break,
        }
    }
    largest.finding(claim, trial, why)
}

/// Whether the run of a trial comes to the periodic solution through a state, each time over a period by `pass`.
pub(super) fn comes_to(
    start: &[f64],
    periodic: &[f64],
    mut pass: impl FnMut(usize, &[f64]) -> Result<Vec<f64>, IntegrationFailure>,
) -> bool {
    let size = periodic.iter().fold(1.0, |size: f64, value| size.max(1.0 + value.abs()));
    let mut y = start.to_vec();
    for index in 0..MOST_PERIODS {
        let Ok(next) = pass(index, &y) else { return false };
        y = next;
        if y.iter().zip(periodic).all(|(a, b)| (a - b).abs() <= NEAR * size) {
            return true;
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::falsify::trial::check;
    use crate::falsify::{Finding, TriedPlant};
    use sigmastar_lang::plant::Plant;
    use sigmastar_lang::spec::{Oscillators, Specification};
    use sigmastar_regulator::Regulator;

    /// The finding of a trial of a plant with one state from x = 1, e = 0, for a claim with these sizes of an error box.
    fn finding(f: &str, q: &str, error_box: [f64; 2]) -> Finding {
        let spec = Specification::from_json("linear", include_str!("../../../../specs/linear.json")).unwrap();
        let mut claim = TriedClaim::for_tests(spec, [3.0, 3.0]);
        claim.error_box = error_box;
        let text = format!(
            r#"{{"format": "sigmastar/plant", "version": 1, "name": "n", "period": 1, "states": ["x1"], "f": ["{f}"],
            "q": "{q}", "internal_model": {{"mu": 1, "base_frequency": "2*pi",
            "weights": {{"family": "power", "n0": 2, "epsilon": 1}}}}}}"#
        );
        let plant = Plant::from_json("test", &text).unwrap();
        let closed_loop = ClosedLoop::new(&plant, Regulator::high_gain(1.0));
        let start = closed_loop.start(&[1.0], 0.0);
        let plant = TriedPlant::Own(Box::new(plant));
        check(
            &claim,
            Trial {
                number: 1,
                plant,
                sigma: 1.0,
                oscillators: Oscillators::first(0),
                start,
                input_gain: None,
                period: None,
                parameters: Vec::new(),
                phase: None,
            },
            &closed_loop,
        )
    }

    fn violation(finding: &Finding) -> Option<(&'static str, f64, f64)> {
        match finding {
            Finding::Violated(_, violation) => Some((violation.quantity, violation.found, violation.bound)),
            _ => None,
        }
    }

    /// No steady state is found for any of these; what contradicts the claim is the run alone, with finite numbers.
    #[test]
    fn only_the_run_contradicts_a_claim() {
        // It escapes at t = 1, and passes the bound before.
        let (quantity, found, bound) = violation(&finding("x1^2", "0", [50.0, 9.0])).unwrap();
        assert!(
            quantity == SIZES[0] && found > 50.0 && found.is_finite() && bound == 50.0,
            "{quantity} {found} {bound}"
        );
        // It drifts to 131, and there is no periodic solution.
        let (quantity, found, _) = violation(&finding("1", "0", [50.0, 9.0])).unwrap();
        assert!(quantity == SIZES[0] && (found - 131.0).abs() < 1e-3, "{found}");
        // The same within the bounds.
        let Finding::Unfinished(why) = finding("1", "0", [140.0, 9.0]) else { panic!("it does not contradict") };
        assert!(why.contains("stays within bounds"), "{why}");
        // A right side that has no value at the end, in the middle of what the claim allows.
        let Finding::Unfinished(why) = finding("-1", "sqrt(x1 + 1)", [50.0, 9.0]) else {
            panic!("it does not contradict")
        };
        assert!(why.contains("undefined"), "{why}");
    }

    #[test]
    fn a_run_comes_to_a_periodic_solution_or_does_not() {
        assert!(comes_to(&[0.0], &[2.0], |_, y| Ok(vec![y[0] + 0.5 * (2.0 - y[0])])));
        assert!(!comes_to(&[0.0], &[2.0], |_, y| Ok(y.to_vec())));
        assert!(!comes_to(&[0.0], &[2.0], |_, _| Err(IntegrationFailure::Escaped { t: 0.0 })));
    }
}
