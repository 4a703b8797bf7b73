//! One plant, one initial condition, one number of oscillators: simulated and checked.

use super::claim::Claim;
use super::counterexample::counterexample_plant;
use super::draw::{DrawnPlant, draw};
use super::finding::{Falsification, Finding, LYAPUNOV, MULTIPLIER, Trial, TrialSettings, TriedPlant, Violation};
use super::frame::OwnPlant;
use super::limits::SectorEnd;
use super::linear::linear_member;
use super::membership::MAX_OPERATIONS;
use super::random::Random;
use super::{run, sampled_trial};
use crate::certify::no_plant;
use crate::data::{Bound, Data};
use crate::enclosure::DEFAULT_PRECISION;
use crate::number::Portable;
use crate::plant::Plant;
use crate::progress::{Progress, Silent};
use crate::regulator::Regulator;
use crate::simulate::{
    ClosedLoop, IntegrationFailure, Orbit, SteadyState, SteadyStateError, Tolerance, flow, rms, steady_state, sup,
    trajectory,
};
use rayon::prelude::*;

/// The numbers of oscillators that are tried.
const TRIED_N_O: [u32; 6] = [0, 1, 2, 3, 5, 8];
/// Draws before a trial is given up.
const DRAWS: usize = 30;
/// How far above sigma* a trial is.
pub(super) const ABOVE: f64 = 1.0 + 1e-6;
/// What a bound may be exceeded by before it counts: integration and rounding.
const TOLERANCE: f64 = 1e-6;
/// The same, absolute, at least.
const ROOM: f64 = 1e-9;
/// The share of a state by which a period of it may be off.
const ROUNDING: f64 = 1e-12;
/// Periods from the initial condition that are compared with the periodic solution.
pub(super) const PERIODS: usize = 12;
/// Samples of a period in that comparison.
const SAMPLES: usize = 4096;

/// Runs the trials, in parallel; what they find does not depend on how many at a time. None is run where no plant with a
/// state satisfies data that speak of one.
#[must_use]
pub fn falsify(claim: &Claim, settings: TrialSettings, progress: &dyn Progress) -> Falsification {
    let no_plant = |data: &Data<'_>, reach| if claim.own.is_none() { no_plant(data, reach) } else { None };
    if let Some(reason) = no_plant(&Data::new(&claim.spec, DEFAULT_PRECISION), Some(&claim.reach)) {
        // A plant without x would show nothing about such data.
        let findings = settings.numbers().iter().map(|_| Finding::Unfinished(reason.to_string())).collect();
        return Falsification { settings, findings };
    }
    let findings = settings
        .numbers()
        .into_par_iter()
        .map(|number| {
            let finding = run_trial(claim, settings.seed, number);
            progress.advance();
            finding
        })
        .collect();
    Falsification { settings, findings }
}

fn run_trial(claim: &Claim, seed: u64, number: u64) -> Finding {
    let mut random = Random::new(seed, number);
    if let Some(sampled) = &claim.sampled {
        return sampled_trial::run(claim, sampled, random, number);
    }
    if let Some(own) = &claim.own {
        return run_own(claim, own, random, number);
    }
    let Some(plant) = drawn_plant(claim, number, &mut random) else {
        return Finding::Unfinished(no_member(claim).to_owned());
    };
    let n_o = TRIED_N_O[random.whole(0, TRIED_N_O.len() as u32 - 1) as usize];
    let sigma = claim.sigma * ABOVE;
    let regulator = regulator(claim, sigma, n_o);
    let start = boundary(claim, plant.family.states(), &regulator, &mut random);
    let trial = Trial { number, plant: TriedPlant::Drawn(Box::new(plant)), sigma, n_o, start, phase: None };
    let file = match file(claim, &trial) {
        Ok(file) => file,
        Err(unfinished) => return unfinished,
    };
    let closed_loop = ClosedLoop::new(&file, regulator);
    check(claim, trial, &closed_loop)
}

/// The plant of a trial as a plant file has it.
pub(super) fn file(claim: &Claim, trial: &Trial) -> Result<Plant, Finding> {
    let file = counterexample_plant(claim, trial, None).and_then(|document| Plant::from_value(&document.root()));
    file.map_err(|errors| Finding::Unfinished(errors.to_string()))
}

/// Draws the plant of a trial.
pub(super) fn drawn_plant(claim: &Claim, number: u64, random: &mut Random) -> Option<DrawnPlant> {
    // The first trial is the linear member with the largest gains. A drawn matrix F may leave no room; another one may,
    // and where none does the linear member is left.
    let linear = |end, random: &mut Random| linear_member(claim, end, random, &mut { MAX_OPERATIONS });
    let first = if number == 1 { linear(SectorEnd::Upper, random) } else { None };
    let mut left = MAX_OPERATIONS;
    let drawn = first.or_else(|| (0..DRAWS).find_map(|_| draw(claim, random, &mut left)));
    drawn.or_else(|| {
        // With one bound on both sides the adverse end is the upper one.
        let one_sided = claim.spec.bounds.own(Bound::QeMax).is_some();
        let end = if one_sided && random.chance(0.5) { SectorEnd::Lower } else { SectorEnd::Upper };
        linear(end, random)
    })
}

/// A trial of the plant that the claim is about.
fn run_own(claim: &Claim, own: &OwnPlant, mut random: Random, number: u64) -> Finding {
    let n_o = TRIED_N_O[random.whole(0, TRIED_N_O.len() as u32 - 1) as usize];
    let sigma = claim.sigma * OwnPlant::gain(number);
    let regulator = regulator(claim, sigma, n_o);
    let n = own.plant.states();
    let mut start = boundary(claim, n, &regulator, &mut random);
    let x = own.state(0.0, &start[..n]);
    start[..n].copy_from_slice(&x);
    let closed_loop = ClosedLoop::new(&own.plant, regulator);
    let plant = TriedPlant::Own(Box::new(own.plant.clone()));
    check(claim, Trial { number, plant, sigma, n_o, start, phase: None }, &closed_loop)
}

/// Why there is no plant to try.
pub(super) fn no_member(claim: &Claim) -> &'static str {
    match claim.spec.bounds.own(Bound::Rate) {
        None => "no plant of the drawn kind is proved to lie within the families",
        Some(_) => {
            "no plant of the drawn kind, whose df/dx depends on t only, is proved to have the contraction rate and to lie \
             within the families"
        }
    }
}

/// The regulator of the claim in double precision.
fn regulator(claim: &Claim, sigma: f64, n_o: u32) -> Regulator {
    let model = &claim.spec.internal_model;
    let weights = (0..=u64::from(n_o)).map(|l| model.weights.weight_f64(l)).collect();
    Regulator::new(sigma, model.mu.to_f64(), model.base_frequency.to_f64(), weights)
}

/// A point of the boundary, for n states: |x| = X0, |e| = E0, |z|_N = Z0.
pub(super) fn boundary(claim: &Claim, n: usize, regulator: &Regulator, random: &mut Random) -> Vec<f64> {
    let [x_0, e_0, z_0] = claim.initial;
    let mut start: Vec<f64> = random.direction(n).iter().map(|part| x_0 * part.value()).collect();
    start.push(if random.chance(0.5) { e_0 } else { -e_0 });
    let mut z: Vec<f64> = (0..regulator.dimension()).map(|_| 2.0 * random.uniform() - 1.0).collect();
    let size = regulator.weighted_norm(&z);
    z.iter_mut().for_each(|part| *part *= if size > 0.0 { z_0 / size } else { 0.0 });
    start.extend(z);
    start
}

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
    pub(super) fn around(claim: &Claim, start: &[f64], residual: f64, multiplier: f64) -> Checks {
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

pub(super) fn check(claim: &Claim, trial: Trial, closed_loop: &ClosedLoop) -> Finding {
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
        if !run::comes_to(&trial, &steady.start, pass) {
            return run::alone(claim, trial, closed_loop, run::ELSEWHERE.to_owned());
        }
    }
    match check_approach(claim, &trial, closed_loop, &orbit, &mut checks) {
        Ok(()) => checks.finding(trial),
        Err(failure @ IntegrationFailure::Escaped { .. }) => run::alone(claim, trial, closed_loop, failure.to_string()),
        Err(failure) => unfinished(&failure),
    }
}

/// The periodic solution that the run of a trial approaches; where none is found, of the plant of the claim the one near its
/// orbit, which is in every initial set.
fn periodic_solution(claim: &Claim, trial: &Trial, closed_loop: &ClosedLoop) -> Result<SteadyState, SteadyStateError> {
    let found = steady_state(closed_loop, &trial.start, &Silent);
    match (found, &claim.own) {
        (Err(error @ SteadyStateError::Newton { .. }), Some(own)) => {
            let on_the_orbit = closed_loop.start(&own.state(0.0, &vec![0.0; own.plant.states()]), 0.0);
            steady_state(closed_loop, &on_the_orbit, &Silent).map_err(|_| error)
        }
        (found, _) => found,
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
        IntegrationFailure::Escaped { .. } => failure.to_string(),
        IntegrationFailure::TooMuchWork { .. } => "the simulation of the closed loop takes too much work".to_owned(),
        IntegrationFailure::Stiff { .. } | IntegrationFailure::StepTooLong { .. } => {
            "what the simulation of the closed loop gives depends on its tolerance".to_owned()
        }
    }
}

pub(super) fn norm(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}

fn check_orbit(
    claim: &Claim,
    trial: &Trial,
    closed_loop: &ClosedLoop,
    steady: &SteadyState,
    orbit: &Orbit,
    checks: &mut Checks,
) {
    let n = closed_loop.states();
    let largest = |of: &dyn Fn(&[f64]) -> f64| orbit.samples.iter().fold(0.0_f64, |size, y| size.max(of(y)));
    let count = orbit.samples.len() as f64;
    let x = match &claim.own {
        None => largest(&|y| norm(&y[..n])),
        Some(own) => {
            let distances = orbit.samples.iter().enumerate().map(|(at, y)| own.distance(at as f64 / count, &y[..n]));
            distances.fold(0.0, f64::max)
        }
    };
    let error = orbit.error();
    let e = sup(&error);
    let m = closed_loop.regulator.m();
    let zeta = largest(&|y| {
        let zeta: Vec<f64> = y[n + 1..].iter().zip(&m).map(|(z, m)| z - m * y[n]).collect();
        closed_loop.regulator.weighted_norm(&zeta)
    });
    checks.at_most(MULTIPLIER, steady.multipliers.first().copied().unwrap_or(0.0), 1.0);
    checks.at_most("sup|x| of the periodic solution", x, claim.periodic[0]);
    checks.at_most("sup|e| of the periodic solution", e, claim.periodic[1]);
    checks.at_most("sup|zeta|_N of the periodic solution", zeta, claim.periodic[2]);
    let z = largest(&|y| closed_loop.regulator.weighted_norm(&y[n + 1..]));
    checks.at_most("sup|z|_N of the periodic solution", z, claim.periodic_z);
    if let Some(psi) = claim.psi {
        checks.at_most("sup|e| against psi_1/sigma", e, psi[0] / trial.sigma);
        checks.at_most("sup|x| against psi_x/sigma", x, psi[1] / trial.sigma);
    }
    if let Some([by_rms, by_sup]) = claim.matched_bounds(trial.sigma, trial.n_o) {
        checks.at_most("rms(e) against its bound for this n_o", rms(&error), by_rms);
        checks.at_most("sup|e| against its bound for this n_o", e, by_sup);
    }
}

/// The first periods from the initial condition: within the error box around the periodic solution, and the Lyapunov
/// function never above its start. P_x is not known here, so at the start its upper bound counts, later the lower.
///
/// # Errors
/// An integration that did not come to its end.
fn check_approach(
    claim: &Claim,
    trial: &Trial,
    closed_loop: &ClosedLoop,
    orbit: &Orbit,
    checks: &mut Checks,
) -> Result<(), IntegrationFailure> {
    let n = closed_loop.states();
    let m = closed_loop.regulator.m();
    let (mut y, mut away, mut level) = (trial.start.clone(), [0.0_f64; 2], [0.0_f64; 2]);
    let period = closed_loop.period;
    for index in 0..PERIODS {
        let t = index as f64 * period;
        let samples = trajectory(closed_loop, t, period, SAMPLES, &y, Tolerance::ORDINARY)?;
        for (at, (sample, point)) in samples.iter().zip(&orbit.samples).enumerate() {
            let difference: Vec<f64> = sample.iter().zip(point).map(|(a, b)| a - b).collect();
            let own = |own: &OwnPlant| own.norm(&difference[..n]);
            let (x, e) = (claim.own.as_ref().map_or_else(|| norm(&difference[..n]), own), difference[n]);
            away = [away[0].max(x), away[1].max(e.abs())];
            if let Some([low, up, h]) = claim.lyapunov {
                let zeta: Vec<f64> = difference[n + 1..].iter().zip(&m).map(|(z, m)| z - m * e).collect();
                let rest = e * e + h * closed_loop.regulator.weighted_norm(&zeta).portable_powi(2);
                if index == 0 && at == 0 {
                    level[0] = up * x * x + rest;
                }
                level[1] = level[1].max(low * x * x + rest);
            }
        }
        y = samples.last().cloned().unwrap_or(y);
    }
    let [d_x, d_e] = claim.error_box;
    checks.at_most("|x - x_p| on the way, against D_x", away[0], d_x);
    checks.at_most("|e - e_p| on the way, against D_e", away[1], d_e);
    if claim.lyapunov.is_some() {
        checks.at_most(LYAPUNOV, level[1], level[0]);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::Specification;

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
        let spec = Specification::from_json("linear", include_str!("../../specs/linear.json")).unwrap();
        let claim = Claim::for_tests(spec, [3.0, 3.0]);
        let broken = |size: f64, multiplier: f64, found: f64| {
            let mut checks = Checks::around(&claim, &[size], 0.0, multiplier);
            checks.at_most("quantity", found, 0.0);
            checks.are_broken()
        };
        assert!(!broken(412.0, 0.976, 2.4e-9) && broken(412.0, 0.976, 1e-6));
        assert!(broken(1.0, 0.5, 2.4e-9) && !broken(1.0, 0.5, 1e-10));
    }

    #[test]
    fn trials_start_on_the_boundary() {
        let spec = Specification::from_json("linear", include_str!("../../specs/linear.json")).unwrap();
        let mut claim = Claim::for_tests(spec, [3.0, 3.0]);
        claim.initial = [2.0, 0.5, 7.0];
        let mut random = Random::new(3, 4);
        let plant = draw(&claim, &mut random, &mut { MAX_OPERATIONS }).unwrap();
        let regulator = regulator(&claim, claim.sigma, 3);
        let n = plant.family.states();
        let start = boundary(&claim, n, &regulator, &mut random);
        assert!((norm(&start[..n]) - 2.0).abs() < 1e-5 && start[n].abs() == 0.5);
        assert!((regulator.weighted_norm(&start[n + 1..]) - 7.0).abs() < 1e-12);
        assert_eq!(start.len(), n + 1 + 7);
    }
}
