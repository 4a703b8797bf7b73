//! One plant, one initial condition, one number of oscillators: simulated and checked.

use super::checks::{Checks, PERIODS, unfinished, why_none};
use super::claim::TriedClaim;
use super::finding::{
    CONTROL, Falsification, Finding, LARGEST_BY_COUNT, LYAPUNOV, MULTIPLIER, SATURATION, STEADY_BY_COUNT,
    STEADY_CONTROL, Trial, TrialSettings, TriedPlant,
};
use super::frame::{ABOVE, OwnPlant};
use super::random::Random;
use super::start::{boundary, drawn_plant, file, no_member, regulator};
use super::{disturbed, run, sampled_trial};
use crate::simulate::{
    ClosedLoop, Disturbance, IntegrationFailure, Orbit, SteadyState, SteadyStateError, Tolerance, flow, rms,
    steady_state, sup, trajectory,
};
use sigmastar_decide::conditions::no_plant;
use sigmastar_document::progress::{Progress, Silent};
use sigmastar_exact::enclosure::DEFAULT_PRECISION;
use sigmastar_exact::number::Portable;
use sigmastar_exact::parallel;
use sigmastar_theory::data::Data;

/// Samples of a period in that comparison.
const SAMPLES: usize = 4096;

/// Runs the trials, in parallel; what they find does not depend on how many at a time. None is run where no plant with a
/// state satisfies data that speak of one.
#[must_use]
pub fn falsify(claim: &TriedClaim, settings: TrialSettings, progress: &dyn Progress) -> Falsification {
    let no_plant = |data: &Data<'_>, reach| if claim.own.is_none() { no_plant(data, reach) } else { None };
    if let Some(reason) = no_plant(&Data::new(&claim.spec, DEFAULT_PRECISION), Some(&claim.reach)) {
        // A plant without x would show nothing about such data.
        let findings = settings.numbers().iter().map(|_| Finding::Unfinished(reason.to_string())).collect();
        return Falsification { settings, findings };
    }
    let findings = parallel::map(&settings.numbers(), |&number| {
        let finding = run_trial(claim, settings.seed, number);
        progress.advance();
        finding
    });
    Falsification { settings, findings }
}

fn run_trial(claim: &TriedClaim, seed: u64, number: u64) -> Finding {
    let mut random = Random::new(seed, number);
    if let Some(sampled) = &claim.sampled {
        return sampled_trial::run(claim, sampled, random, number);
    }
    if let Some(own) = &claim.own {
        return run_own(claim, own, random, number);
    }
    let period = claim.period(number, &mut random);
    // Plants are drawn for the one period: what the data say holds for each.
    let drawing = period.clone().map(|period| {
        let mut drawing = claim.clone();
        drawing.spec.period = period.into();
        drawing
    });
    let Some(plant) = drawn_plant(drawing.as_ref().unwrap_or(claim), number, &mut random) else {
        return Finding::Unfinished(no_member(claim).to_owned());
    };
    let oscillators = claim.oscillators(number, &mut random);
    let sigma = claim.sigma * claim.gain_of(ABOVE);
    let regulator = regulator(claim, sigma, &oscillators);
    let start = boundary(claim, plant.states(), &regulator, &mut random);
    let input_gain = claim.member(number, &mut random).input_gain;
    let plant = TriedPlant::Drawn(Box::new(plant));
    let trial =
        Trial { number, plant, sigma, oscillators, start, input_gain, period, parameters: Vec::new(), phase: None };
    let file = match file(claim, &trial) {
        Ok(file) => file,
        Err(unfinished) => return unfinished,
    };
    let closed_loop = with_gain(ClosedLoop::new(&file, regulator), input_gain);
    check(claim, trial, &closed_loop)
}

/// A trial of the plant that the claim is about, or of a member of its family.
fn run_own(claim: &TriedClaim, own: &OwnPlant, mut random: Random, number: u64) -> Finding {
    let oscillators = claim.oscillators(number, &mut random);
    let sigma = claim.sigma * claim.gain_of(OwnPlant::gain(number));
    let regulator = regulator(claim, sigma, &oscillators);
    let mut start = boundary(claim, own.plant.states(), &regulator, &mut random);
    let member = claim.member(number, &mut random);
    let (parameters, input_gain) = (claim.named(&member), member.input_gain);
    let claim = claim.about(&member);
    let own = claim.own.as_ref().unwrap_or(own);
    let period = claim.spec.period.interval().map(|_| own.plant.period.nominal().clone());
    own.bring_within(0.0, &mut start);
    let closed_loop = with_gain(ClosedLoop::new(&own.plant, regulator), input_gain);
    let plant = TriedPlant::Own(Box::new(own.plant.clone()));
    check(
        &claim,
        Trial { number, plant, sigma, oscillators, start, input_gain, period, parameters, phase: None },
        &closed_loop,
    )
}

/// What is put out is told, not cut off: the first time that the actuator does not take it the claim is broken.
fn with_gain(closed_loop: ClosedLoop, gain: Option<f64>) -> ClosedLoop {
    let closed_loop = closed_loop.without_limit();
    match gain {
        Some(gain) => closed_loop.with_input_gain(gain),
        None => closed_loop,
    }
}

pub(super) fn check(claim: &TriedClaim, trial: Trial, closed_loop: &ClosedLoop) -> Finding {
    let steady = match periodic_solution(claim, &trial, closed_loop) {
        Ok(steady) => steady,
        // That no periodic solution is found says nothing about the claim; the run itself may.
        Err(error) => return run::alone(claim, trial, closed_loop, why_none(&error)),
    };
    let orbit = match Orbit::new(closed_loop, &steady) {
        Ok(orbit) => orbit,
        Err(failure) => return unfinished(&failure),
    };
    let multiplier = steady.multipliers.first().copied().unwrap_or(0.0);
    let mut checks = Checks::around(claim, &steady.start, steady.residual, multiplier);
    check_orbit(claim, &trial, closed_loop, &steady, &orbit, &mut checks);
    if checks.are_broken() {
        closed_loop.renew_effort();
        let pass = |index: usize, y: &[f64]| {
            flow(closed_loop, index as f64 * closed_loop.period, closed_loop.period, y, Tolerance::ORDINARY)
        };
        if !run::comes_to(&trial.start, &steady.start, pass) {
            return run::alone(claim, trial, closed_loop, run::ELSEWHERE.to_owned());
        }
    }
    match check_approach(claim, &trial, closed_loop, &orbit, &mut checks) {
        Ok(()) => {
            disturbed::check(claim, &trial, closed_loop, &steady.start, &mut checks);
            checks.finding(trial)
        }
        Err(failure @ IntegrationFailure::Escaped { .. }) => run::alone(claim, trial, closed_loop, failure.to_string()),
        Err(failure) => unfinished(&failure),
    }
}

/// The periodic solution that the run of a trial approaches; where none is found, of the plant of the claim the one near its
/// orbit, which is in every initial set.
fn periodic_solution(
    claim: &TriedClaim,
    trial: &Trial,
    closed_loop: &ClosedLoop,
) -> Result<SteadyState, SteadyStateError> {
    let found = steady_state(closed_loop, &trial.start, &Silent);
    match (found, &claim.own) {
        (Err(error @ SteadyStateError::Newton { .. }), Some(own)) => {
            let on_the_orbit = closed_loop.start(&own.state(0.0, &vec![0.0; own.plant.states()]), 0.0);
            steady_state(closed_loop, &on_the_orbit, &Silent).map_err(|_| error)
        }
        (found, _) => found,
    }
}

fn check_orbit(
    claim: &TriedClaim,
    trial: &Trial,
    closed_loop: &ClosedLoop,
    steady: &SteadyState,
    orbit: &Orbit,
    checks: &mut Checks,
) {
    let n = closed_loop.states();
    let largest = |of: &dyn Fn(&[f64]) -> f64| orbit.samples.iter().fold(0.0_f64, |size, y| size.max(of(y)));
    let count = orbit.samples.len() as f64;
    let distances = orbit.samples.iter().enumerate().map(|(at, y)| claim.distance(at as f64 / count, &y[..n]));
    let x = distances.fold(0.0, f64::max);
    let error = orbit.error();
    let e = sup(&error);
    let m = closed_loop.regulator.m();
    let zeta = largest(&|y| {
        let zeta: Vec<f64> = y[n + 1..].iter().zip(&m).map(|(z, m)| z - m * y[n]).collect();
        closed_loop.regulator.weighted_norm(&zeta)
    });
    checks.at_most(MULTIPLIER, steady.multipliers.first().copied().unwrap_or(0.0), 1.0);
    checks.at_most("$`sup|x|`$ of the periodic solution", x, claim.periodic[0]);
    checks.at_most("$`sup|e|`$ of the periodic solution", e, claim.periodic[1]);
    checks.at_most("$`sup|zeta|_N`$ of the periodic solution", zeta, claim.periodic[2]);
    let z = largest(&|y| closed_loop.regulator.weighted_norm(&y[n + 1..]));
    checks.at_most("$`sup|z|_N`$ of the periodic solution", z, claim.periodic_z);
    if let Some([steady, _]) = claim.control_at(trial.sigma) {
        let u = largest(&|y| closed_loop.demanded(y, Disturbance::default()).abs());
        checks.at_most(STEADY_CONTROL, u, steady * ABOVE);
    }
    if let Some(psi) = claim.psi {
        checks.at_most("$`sup|e|`$ against $`psi_1/sigma`$", e, psi[0] / trial.sigma);
        checks.at_most("$`sup|x|`$ against $`psi_x/sigma`$", x, psi[1] / trial.sigma);
    }
    if let Some(bounds) = claim.bounds_at(trial) {
        let u = largest(&|y| closed_loop.demanded(y, Disturbance::default()).abs());
        checks.all_at_most(STEADY_BY_COUNT, [e, rms(&error), u], bounds.steady);
    }
    let of_count = trial.oscillators.n_o().and_then(|n_o| claim.error_bounds(trial.sigma, n_o));
    if let Some([by_rms, by_sup]) = of_count {
        checks.at_most("$`rms(e)`$ against its bound for this $`n_o`$", rms(&error), by_rms);
        checks.at_most("$`sup|e|`$ against its bound for this $`n_o`$", e, by_sup);
    }
}

/// The first periods from the initial condition: within the error box around the periodic solution, and the Lyapunov
/// function never above its start. P_x is not known here, so at the start its upper bound counts, later the lower; joint metrics are.
///
/// # Errors
/// An integration that did not come to its end.
fn check_approach(
    claim: &TriedClaim,
    trial: &Trial,
    closed_loop: &ClosedLoop,
    orbit: &Orbit,
    checks: &mut Checks,
) -> Result<(), IntegrationFailure> {
    let n = closed_loop.states();
    let m = closed_loop.regulator.m();
    let (mut y, mut away, mut level, mut control) = (trial.start.clone(), [0.0_f64; 2], [0.0_f64; 2], [0.0_f64; 2]);
    let mut error = 0.0_f64;
    let period = closed_loop.period;
    let share_of_h = claim.share_of_h(trial);
    for index in 0..PERIODS {
        let t = index as f64 * period;
        let samples = trajectory(closed_loop, t, period, SAMPLES, &y, Tolerance::ORDINARY)?;
        for (at, (sample, point)) in samples.iter().zip(&orbit.samples).enumerate() {
            let difference: Vec<f64> = sample.iter().zip(point).map(|(a, b)| a - b).collect();
            let (x, e) = (claim.norm(&difference[..n]), difference[n]);
            away = [away[0].max(x), away[1].max(e.abs())];
            error = error.max(sample[n].abs());
            // u is linear in (e, z).
            let of = |y: &[f64]| closed_loop.demanded(y, Disturbance::default()).abs();
            control = [control[0].max(of(&difference)), control[1].max(of(sample))];
            let zeta: Vec<f64> = difference[n + 1..].iter().zip(&m).map(|(z, m)| z - m * e).collect();
            let zeta = closed_loop.regulator.weighted_norm(&zeta);
            if let Some((joint, own)) = claim.joint.as_ref().zip(claim.own.as_ref()) {
                let value = joint.at(trial.sigma, &own.deviation(&difference[..n]), e, zeta);
                if index == 0 && at == 0 {
                    level[0] = value;
                }
                level[1] = level[1].max(value);
            }
            if let Some([low, up, h]) = claim.lyapunov {
                let rest = e * e + h * share_of_h * zeta.portable_powi(2);
                if index == 0 && at == 0 {
                    level[0] = up * x * x + rest;
                }
                level[1] = level[1].max(low * x * x + rest);
            }
        }
        y = samples.last().cloned().unwrap_or(y);
    }
    let [d_x, d_e] = claim.error_box;
    checks.at_most("$`|x - x_p|`$ in the transient, against $`D_x`$", away[0], d_x);
    checks.at_most("$`|e - e_p|`$ in the transient, against $`D_e`$", away[1], d_e);
    if let Some([_, transient]) = claim.control_at(trial.sigma) {
        checks.at_most(CONTROL, control[0], transient * ABOVE);
    }
    if let Some(max) = claim.actuator() {
        checks.at_most(SATURATION, control[1], max);
    }
    if let Some(bounds) = claim.bounds_at(trial).and_then(|bounds| bounds.largest) {
        checks.all_at_most(LARGEST_BY_COUNT, [error, control[1]], bounds);
    }
    if claim.lyapunov.is_some() || claim.joint.is_some() {
        checks.at_most(LYAPUNOV, level[1], level[0]);
    }
    Ok(())
}
