//! A trial with noise of the measurement and a disturbance of q, against what a claim says of them for its n_o at its gain.

use super::checks::Checks;
use super::claim::TriedClaim;
use super::finding::{DISTURBED, Trial};
use super::random::Random;
use crate::simulate::{ClosedLoop, Disturbance, FixedStep, enough_steps};

/// Periods of a run.
const PERIODS: usize = 12;

/// Steps of a period, at least; the most, beyond which nothing is tried; and so many for each that would be stable.
const STEPS: usize = 256;
const MOST: usize = 40_000;
const FINER: usize = 8;

/// Steps over which a random value is held, at most.
const HELD: u32 = 64;

/// How the inputs are chosen, each at its bound.
#[derive(Clone, Copy)]
enum Inputs {
    /// They push the error away from 0.
    Outwards,
    /// They push it the way that it goes.
    Onwards,
    /// Of random signs.
    Random,
}

/// Runs from the periodic solution and from the start of the trial, at the gain of the claim, beside one without inputs from the periodic
/// solution. Of the first the bound in the limit is asked for: the same inputs after a long pause meet the same state, nearly.
pub(super) fn check(
    claim: &TriedClaim,
    trial: &Trial,
    closed_loop: &ClosedLoop,
    periodic: &[f64],
    checks: &mut Checks,
) {
    let Some(stated) = claim.noise.iter().find(|stated| trial.oscillators == stated.oscillators) else { return };
    let mut closed_loop = closed_loop.clone();
    closed_loop.regulator.sigma = claim.sigma;
    let Some(steps) = enough_steps(&closed_loop, 0.0, [periodic, &trial.start]) else { return };
    let steps = (steps as usize * FINER).max(STEPS);
    if steps > MOST {
        return;
    }
    let [d, v] = [claim.spec.d_bar(), claim.spec.v_bar()].map(|bound| bound.to_f64());
    let inputs = [Inputs::Outwards, Inputs::Onwards, Inputs::Random][(trial.number % 3) as usize];
    let mut start = trial.start.clone();
    if claim.initial.z0.is_none() {
        // The regulator sets z = M (e + v).
        let e = start[closed_loop.states()];
        let m = closed_loop.regulator.m();
        start[closed_loop.states() + 1..].iter_mut().zip(m).for_each(|(z, m)| *z = m * (e + v));
    }
    for ((quantity, bound), start) in DISTURBED.into_iter().zip([stated.limit, stated.peak]).zip([periodic, &start]) {
        let random = Random::new(trial.number, u64::from(stated.oscillators.largest()));
        let found = largest(&closed_loop, steps, [periodic, start], (inputs, [d, v]), random);
        checks.at_most(quantity, found, bound);
    }
}

/// The largest |e - e_p| of a run from a start.
fn largest(
    closed_loop: &ClosedLoop,
    steps: usize,
    [periodic, start]: [&[f64]; 2],
    (inputs, [d, v]): (Inputs, [f64; 2]),
    mut random: Random,
) -> f64 {
    let e = closed_loop.states();
    let [mut undisturbed, mut disturbed] = [(); 2].map(|()| FixedStep::new(closed_loop, steps));
    let (mut y_p, mut y) = (periodic.to_vec(), start.to_vec());
    let (mut signs, mut left) = ([1.0; 2], 0);
    let mut before = y[e] - y_p[e];
    let mut found = before.abs();
    for index in 0..PERIODS * steps {
        let error = y[e] - y_p[e];
        let outwards = |value: f64| if value < 0.0 { -1.0 } else { 1.0 };
        signs = match inputs {
            // What is measured too large is pushed down.
            Inputs::Outwards => [outwards(error), -outwards(error)],
            Inputs::Onwards => [outwards(error - before), -outwards(error - before)],
            Inputs::Random if left == 0 => {
                left = random.whole(1, HELD);
                [(); 2].map(|()| if random.chance(0.5) { 1.0 } else { -1.0 })
            }
            Inputs::Random => signs,
        };
        left = left.saturating_sub(1);
        before = error;
        let [of_d, of_v] = signs;
        undisturbed.step(index, &mut y_p, Disturbance::default());
        disturbed.step(index, &mut y, Disturbance { model: of_v * v, feedback: of_v * v, q: of_d * d });
        let error = (y[e] - y_p[e]).abs();
        if !error.is_finite() {
            return error;
        }
        found = found.max(error);
    }
    found
}
