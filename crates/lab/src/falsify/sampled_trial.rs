//! A trial of a claim about the law at samples: exactly its gain, its sampling time and its K, at some phase of the grid.

use super::checks::{Checks, PERIODS, unfinished, why_none};
use super::claim::TriedClaim;
use super::finding::{
    CONTROL, Finding, LARGEST_BY_COUNT, LYAPUNOV, MULTIPLIER, SATURATION, STEADY_BY_COUNT, STEADY_CONTROL, Trial,
    TriedPlant,
};
use super::random::Random;
use super::run::{self, Largest};
use super::sampled_claim::SampledClaim;
use super::start::{boundary, drawn_plant, file, no_member};
use crate::simulate::{
    IntegrationFailure, Piece, SampledLoop, SampledRun, SampledSteady, SampledSteadyError, Tolerance, pass_period,
    sampled_periodic_solution,
};
use sigmastar_document::progress::Silent;
use sigmastar_exact::number::Portable;

/// States of a period that are looked at, at least, and in a sampling interval.
const STATES: usize = 1024;
const BETWEEN: usize = 2;

/// Runs a trial.
pub(super) fn run(claim: &TriedClaim, law: &SampledClaim, mut random: Random, number: u64) -> Finding {
    let oscillators = claim.oscillators_at_samples(law, number);
    let Some((regulator, discrete)) = law.regulator(&claim.spec, &oscillators) else {
        return Finding::Unfinished("a number of the law at samples is beyond double precision".to_owned());
    };
    // On the grid itself, then anywhere: a claim is about every phase.
    let phase = if number == 1 { 0.0 } else { random.uniform() * claim.spec.period.nominal().to_f64() };
    let member = claim.member(number, &mut random);
    let (parameters, input_gain) = (claim.named(&member), member.input_gain);
    let claim = &*claim.about(&member);
    let (plant, mut start) = match &claim.own {
        Some(own) => {
            let mut start = boundary(claim, own.plant.states(), &regulator, &mut random);
            own.bring_within(phase / claim.spec.period.nominal().to_f64(), &mut start);
            (TriedPlant::Own(Box::new(own.plant.clone())), start)
        }
        None => {
            let Some(plant) = drawn_plant(claim, number, &mut random) else {
                return Finding::Unfinished(no_member(claim).to_owned());
            };
            let start = boundary(claim, plant.states(), &regulator, &mut random);
            (TriedPlant::Drawn(Box::new(plant)), start)
        }
    };
    start.shrink_to_fit();
    let trial = Trial {
        number,
        plant,
        sigma: law.sigma.to_f64(),
        oscillators,
        start,
        input_gain,
        period: None,
        parameters,
        phase: Some(phase),
    };
    let mut sampled = match &claim.own {
        Some(own) => SampledLoop::new(&own.plant, regulator, discrete),
        None => match file(claim, &trial) {
            Ok(file) => SampledLoop::new(&file, regulator, discrete),
            Err(unfinished) => return unfinished,
        },
    };
    sampled.phase = phase;
    if let Some(gain) = input_gain {
        sampled = sampled.with_input_gain(gain);
    }
    if sampled.samples() != Some(law.samples as usize) {
        // A certificate that was tampered with: its samples are not those of its period.
        return Finding::Unfinished(format!("{} samples of the claimed length are not a period", law.samples));
    }
    check(claim, (trial, law.gm), &sampled)
}

/// A period of the loop: for each sampling interval zeta and z at its start, u and the plant on it, and of the law with a delay by how
/// much e at its end is off its prediction, which is h y.
struct Interval {
    zeta: Vec<f64>,
    z: Vec<f64>,
    u: f64,
    pieces: Vec<Piece>,
    off: f64,
}

/// The whole state at the first sample of a trial.
fn start_of(claim: &TriedClaim, sampled: &SampledLoop, trial: &Trial) -> Vec<f64> {
    sampled.starting(trial.start.clone(), claim.initial.z0.is_none())
}

fn period(
    sampled: &SampledLoop,
    run: &mut SampledRun<'_>,
    tolerance: Tolerance,
) -> Result<Vec<Interval>, IntegrationFailure> {
    let samples = sampled.samples_rounded_up();
    let each = STATES.div_ceil(samples).max(BETWEEN);
    let m = sampled.regulator.m();
    let mut intervals = Vec::with_capacity(samples);
    for _ in 0..samples {
        let e = run.plant_state().last().copied().unwrap_or_default();
        let z = run.regulator_state().to_vec();
        let zeta = z.iter().zip(&m).map(|(z, m)| z - m * e).collect();
        // s of the law with a delay.
        let ahead = run.whole_state().get(sampled.states() + 1 + m.len()).copied().unwrap_or_default();
        let pieces = run.advance(each, tolerance)?;
        // What acts first; without a delay that is all that acts.
        let u = pieces.first().map_or_else(|| run.put_out(), |piece| piece.u);
        let off = run.plant_state().last().copied().unwrap_or_default() - (e + ahead);
        intervals.push(Interval { zeta, z, u, pieces, off });
    }
    Ok(intervals)
}

fn check(claim: &TriedClaim, (trial, gm): (Trial, Option<f64>), sampled: &SampledLoop) -> Finding {
    let start = start_of(claim, sampled, &trial);
    let steady = match sampled_periodic_solution(sampled, &start, &Silent) {
        Ok(steady) => steady,
        // That no periodic solution is found says nothing about the claim; the run itself may.
        Err(SampledSteadyError::Search(error)) => return alone(claim, trial, sampled, why_none(&error)),
        Err(error) => return Finding::Unfinished(error.to_string()),
    };
    let orbit = SampledRun::new(sampled, 0, &steady.start).map(|mut run| period(sampled, &mut run, Tolerance::TIGHT));
    let orbit = match orbit {
        Some(Ok(orbit)) => orbit,
        Some(Err(failure)) => return unfinished(&failure),
        None => return Finding::Unfinished("the periodic solution has another dimension".to_owned()),
    };
    let multiplier = steady.largest_multiplier().unwrap_or(0.0);
    let mut checks = Checks::around(claim, &steady.start, steady.residual, multiplier);
    check_orbit(claim, &trial, sampled, &steady, &orbit, &mut checks);
    let pass = |_, y: &[f64]| pass_period(sampled, 0, y, Tolerance::ORDINARY);
    if checks.are_broken() && !run::comes_to(&start, &steady.start, pass) {
        return alone(claim, trial, sampled, run::ELSEWHERE.to_owned());
    }
    match check_approach(claim, (&trial, gm), sampled, &orbit, &mut checks) {
        Ok(()) => checks.finding(trial),
        Err(failure @ IntegrationFailure::Escaped { .. }) => alone(claim, trial, sampled, failure.to_string()),
        Err(failure) => unfinished(&failure),
    }
}

/// The finding of a trial for which there is no periodic solution to compare with.
fn alone(claim: &TriedClaim, trial: Trial, sampled: &SampledLoop, why: String) -> Finding {
    let mut largest = Largest::default();
    if let Some(mut run) = SampledRun::new(sampled, 0, &start_of(claim, sampled, &trial)) {
        // What happens within a sample after which it has escaped is not looked at.
        let intervals =
            (0..PERIODS * sampled.samples_rounded_up()).map_while(|_| run.advance(BETWEEN, Tolerance::ORDINARY).ok());
        for piece in intervals.flatten() {
            for (at, state) in piece.states.iter().enumerate() {
                largest.take(claim, (piece.t + piece.unit * at as f64) / sampled.period(), state);
            }
        }
    }
    largest.finding(claim, trial, why)
}

fn check_orbit(
    claim: &TriedClaim,
    trial: &Trial,
    sampled: &SampledLoop,
    steady: &SampledSteady,
    orbit: &[Interval],
    checks: &mut Checks,
) {
    let n = sampled.states();
    let (mut x, mut e, mut zeta, mut z) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
    let u = orbit.iter().fold(0.0_f64, |u, interval| u.max(interval.u.abs()));
    for interval in orbit {
        zeta = zeta.max(sampled.regulator.weighted_norm(&interval.zeta));
        z = z.max(sampled.regulator.weighted_norm(&interval.z));
        for piece in &interval.pieces {
            for (at, state) in piece.states.iter().enumerate() {
                let s = (piece.t + piece.unit * at as f64) / sampled.period();
                x = x.max(claim.distance(s, &state[..n]));
                e = e.max(state[n].abs());
            }
        }
    }
    checks.at_most(MULTIPLIER, steady.largest_multiplier().unwrap_or(0.0), 1.0);
    checks.at_most("$`sup|x|`$ of the periodic solution", x, claim.periodic[0]);
    checks.at_most("$`sup|e|`$ of the periodic solution", e, claim.periodic[1]);
    checks.at_most("$`sup|zeta|_N`$ of the periodic solution, at samples", zeta, claim.periodic[2]);
    checks.at_most("$`sup|z|_N`$ of the periodic solution, at samples", z, claim.periodic_z);
    if let Some([steady, _]) = claim.control {
        checks.at_most(STEADY_CONTROL, u, steady);
    }
    if let Some(bounds) = claim.bounds_at(trial) {
        // Of each share of a sample the mean square is bounded, and so it is of all of them.
        let states = || orbit.iter().flat_map(|interval| &interval.pieces).flat_map(|piece| &piece.states);
        let squares: f64 = states().map(|state| state[n] * state[n]).sum();
        let rms = (squares / states().count().max(1) as f64).sqrt();
        checks.all_at_most(STEADY_BY_COUNT, [e, rms, u], bounds.steady);
    }
}

/// The first periods from the initial condition: within the error box around the periodic solution all the time, and the
/// Lyapunov function never above its start; between samples what it has of x and e. P_x is not known here, so at the start its
/// upper bound counts, later the lower.
///
/// # Errors
/// An integration that did not come to its end.
fn check_approach(
    claim: &TriedClaim,
    (trial, gm): (&Trial, Option<f64>),
    sampled: &SampledLoop,
    orbit: &[Interval],
    checks: &mut Checks,
) -> Result<(), IntegrationFailure> {
    let n = sampled.states();
    let start = start_of(claim, sampled, trial);
    let Some(mut run) = SampledRun::new(sampled, 0, &start) else { return Ok(()) };
    // gm h y^2 of the last y, of which both that of e and that of zeta count at an aligned start; nothing is predicted there.
    let stored = gm.map_or(0.0, |gm| {
        let of_orbit = orbit.last().map_or(0.0, |interval| interval.off);
        let e = start.get(n).copied().unwrap_or_default();
        let off = (e - of_orbit).abs().max(of_orbit.abs());
        gm / sampled.step() * off * off
    });
    let (mut away, mut level, mut control) = ([0.0_f64; 2], [0.0_f64; 2], [0.0_f64; 2]);
    let mut error = 0.0_f64;
    let [low, up, eta] = claim.lyapunov.unwrap_or_default();
    // At the gain b the weight of zeta is b eta.
    let eta = eta * claim.share_of_h(trial);
    for index in 0..PERIODS {
        let intervals = period(sampled, &mut run, Tolerance::ORDINARY)?;
        for (sample, (interval, of_orbit)) in intervals.iter().zip(orbit).enumerate() {
            control = [control[0].max((interval.u - of_orbit.u).abs()), control[1].max(interval.u.abs())];
            let difference: Vec<f64> = interval.zeta.iter().zip(&of_orbit.zeta).map(|(a, b)| a - b).collect();
            let zeta = eta * sampled.regulator.weighted_norm(&difference).portable_powi(2);
            for (piece, point) in interval.pieces.iter().zip(&of_orbit.pieces) {
                for (at, (state, point)) in piece.states.iter().zip(&point.states).enumerate() {
                    let difference: Vec<f64> = state.iter().zip(point).map(|(a, b)| a - b).collect();
                    let (x, e) = (claim.norm(&difference[..n]), difference[n]);
                    away = [away[0].max(x), away[1].max(e.abs())];
                    error = error.max(state[n].abs());
                    // Between samples z is not that of this moment, and its part of the function is at least 0.
                    let rest = e * e + if at == 0 { zeta } else { 0.0 };
                    if index + sample + at == 0 {
                        level[0] = up * x * x + rest + stored;
                    }
                    level[1] = level[1].max(low * x * x + rest);
                }
            }
        }
    }
    let [d_x, d_e] = claim.error_box;
    checks.at_most("$`|x - x_p|`$ in the transient, against $`D_x`$", away[0], d_x);
    checks.at_most("$`|e - e_p|`$ in the transient, against $`D_e`$", away[1], d_e);
    if let Some([_, transient]) = claim.control {
        checks.at_most(CONTROL, control[0], transient);
    }
    // The law of a trial does not clip, so that this is what it asks for.
    if let Some(max) = claim.actuator() {
        checks.at_most(SATURATION, control[1], max);
    }
    if let Some(bounds) = claim.bounds_at(trial).and_then(|bounds| bounds.largest) {
        checks.all_at_most(LARGEST_BY_COUNT, [error, control[1]], bounds);
    }
    checks.at_most(LYAPUNOV, level[1], level[0]);
    Ok(())
}
