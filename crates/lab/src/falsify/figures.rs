//! What simulations of the nominal plant of a certificate come to, beside what is proved of it: no claim.
//!
//! The start of the largest error, and that of the largest control, is foretold from runs of which each moves one component of the start: for a loop that
//! is linear they are the worst ones of the set at the phases that are tried. What counts is what the runs from these starts come to.

use super::claim::TriedClaim;
use super::frame::OwnPlant;
use super::sampled_claim::SampledClaim;
use super::start::regulator;
use crate::simulate::{
    ClosedLoop, Disturbance, Orbit, SampledLoop, SampledRun, Tolerance, sampled_periodic_solution, steady_state, sup,
    trajectory,
};
use sigmastar_document::progress::Silent;
use sigmastar_regulator::Regulator;

/// The phases of a period at which runs start.
const PHASES: [f64; 4] = [0.0, 0.25, 0.5, 0.75];

/// Periods of a run; samples of each, and of what is between two samples of the regulator.
const PERIODS: usize = 2;
const SAMPLES: usize = 256;
const BETWEEN: usize = 2;

/// The most components of a start that are moved, each in a run of its own.
const MOST_MOVED: usize = 24;

/// Figures of simulations of one loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopFigures {
    /// sup|e| of the periodic solution.
    pub steady_error: f64,
    /// The largest |e| and |u| of the runs; none where one was not finished, or the start has too many components for a run of each.
    pub largest: Option<[f64; 2]>,
}

/// e and u at the times of a run.
type Series = Vec<[f64; 2]>;

/// The figures of the nominal plant that a claim is about, with its gain, its samples where it has some, and so many oscillators, from starts in its initial
/// set. `None` where the claim is not about one plant, and where no periodic solution is found.
#[must_use]
pub fn nominal_figures(claim: &TriedClaim, n_o: u32) -> Option<LoopFigures> {
    let own = claim.own.as_ref()?;
    match &claim.sampled {
        None => in_continuous_time(claim, own, n_o),
        Some(law) => at_samples(claim, own, law, n_o),
    }
}

fn in_continuous_time(claim: &TriedClaim, own: &OwnPlant, n_o: u32) -> Option<LoopFigures> {
    let closed_loop = ClosedLoop::new(&own.plant, regulator(claim, claim.sigma, n_o)).without_limit();
    let (n, period) = (closed_loop.states(), closed_loop.period);
    let set = Set { claim, own, regulator: &closed_loop.regulator };
    let steady = steady_state(&closed_loop, &set.start(0.0, &set.middle()), &Silent).ok()?;
    let steady_error = sup(&Orbit::new(&closed_loop, &steady).ok()?.error());
    let run = |phase: f64, start: &[f64]| {
        closed_loop.renew_effort();
        let (mut y, mut series) = (start.to_vec(), Series::new());
        for index in 0..PERIODS {
            let t = (phase + index as f64) * period;
            let samples = trajectory(&closed_loop, t, period, SAMPLES, &y, Tolerance::ORDINARY).ok()?;
            series.extend(samples.iter().map(|y| [y[n], closed_loop.control(y, Disturbance::default())]));
            y.clone_from(samples.last()?);
        }
        Some(series)
    };
    Some(LoopFigures { steady_error, largest: set.largest(run) })
}

fn at_samples(claim: &TriedClaim, own: &OwnPlant, law: &SampledClaim, n_o: u32) -> Option<LoopFigures> {
    let (regulator, discrete) = law.regulator(&claim.spec, n_o)?;
    let sampled = SampledLoop::new(&own.plant, regulator, discrete);
    let samples = sampled.samples().filter(|samples| *samples == law.samples as usize)?;
    let n = sampled.states();
    let set = Set { claim, own, regulator: &sampled.regulator };
    let series = |sampled: &SampledLoop, start: &[f64], periods: usize, tolerance: Tolerance| {
        let (mut run, mut series) = (SampledRun::new(sampled, 0, start)?, Series::new());
        for _ in 0..periods * samples {
            for piece in run.advance(BETWEEN, tolerance).ok()? {
                series.extend(piece.states.iter().map(|state| [state[n], piece.u]));
            }
        }
        Some(series)
    };
    let whole = |start: Vec<f64>| sampled.starting(start, claim.initial.z0.is_none());
    let steady = sampled_periodic_solution(&sampled, &whole(set.start(0.0, &set.middle())), &Silent).ok()?;
    let [steady_error, _] = sizes(&series(&sampled, &steady.start, 1, Tolerance::TIGHT)?);
    let run = |phase: f64, start: &[f64]| {
        let mut at_phase = sampled.clone();
        at_phase.phase = phase * sampled.period();
        series(&at_phase, &whole(start.to_vec()), PERIODS, Tolerance::ORDINARY)
    };
    Some(LoopFigures { steady_error, largest: set.largest(run) })
}

/// The largest |e| and |u|.
fn sizes(series: &Series) -> [f64; 2] {
    series.iter().fold([0.0; 2], |[e, u], sizes| [e.max(sizes[0].abs()), u.max(sizes[1].abs())])
}

/// The initial set of a claim, in shares of its sizes: of y, of e and, where it is not aligned, of z in the norm of N.
struct Set<'c> {
    claim: &'c TriedClaim,
    own: &'c OwnPlant,
    regulator: &'c Regulator,
}

impl Set<'_> {
    /// Components of y, of e and of z.
    fn parts(&self) -> [usize; 3] {
        // A start at rest, or with z = M e, has no z of its own.
        let moves = self.claim.initial.z0.is_some_and(|z0| z0 > 0.0);
        let z = if moves { self.regulator.dimension() } else { 0 };
        [self.own.plant.states(), 1, z]
    }

    fn middle(&self) -> Vec<f64> {
        vec![0.0; self.parts().iter().sum()]
    }

    /// x, e and z of a start with these shares, at a phase.
    fn start(&self, phase: f64, shares: &[f64]) -> Vec<f64> {
        let [n, ..] = self.parts();
        let initial = &self.claim.initial;
        let mut start: Vec<f64> = shares[..n].iter().map(|share| share * initial.x0).collect();
        let e = shares[n] * initial.e0;
        start.push(e);
        self.own.bring_within(phase, &mut start);
        match initial.z0 {
            None => start.extend(self.regulator.m().iter().map(|m| m * e)),
            Some(z0) => {
                let mut unit = vec![0.0; self.regulator.dimension()];
                for (index, share) in shares[n + 1..].iter().enumerate() {
                    unit[index] = 1.0;
                    let size = self.regulator.weighted_norm(&unit);
                    unit[index] = 0.0;
                    start.push(share * z0 / size);
                }
                start.resize(n + 1 + unit.len(), 0.0);
            }
        }
        start
    }

    /// The largest |e| and |u| of all runs; `None` where one does not come to its end.
    fn largest(&self, run: impl Fn(f64, &[f64]) -> Option<Series>) -> Option<[f64; 2]> {
        let middle = self.middle();
        if middle.len() > MOST_MOVED {
            return None;
        }
        let mut largest = [0.0_f64; 2];
        for phase in PHASES {
            let run = |shares: &[f64]| run(phase, &self.start(phase, shares));
            let base = run(&middle)?;
            let moved = |component: usize| {
                let mut shares = middle.clone();
                shares[component] = 1.0;
                run(&shares)
            };
            let moved: Vec<Series> = (0..middle.len()).map(moved).collect::<Option<_>>()?;
            for quantity in [0, 1] {
                let found = sizes(&run(&self.worst(quantity, &base, &moved))?);
                largest = [largest[0].max(found[0]), largest[1].max(found[1])];
            }
        }
        Some(largest)
    }

    /// The shares of the start of which a quantity is the largest at some time, where it depends on the start as the runs say.
    fn worst(&self, quantity: usize, base: &Series, moved: &[Series]) -> Vec<f64> {
        let [n, e, _] = self.parts();
        let at = |time: usize| {
            let middle = base[time][quantity];
            let sign = if middle < 0.0 { -1.0 } else { 1.0 };
            let mut shares: Vec<f64> = moved.iter().map(|run| sign * (run[time][quantity] - middle)).collect();
            let mut reached = middle.abs();
            let (x, rest) = shares.split_at_mut(n);
            let (of_e, z) = rest.split_at_mut(e);
            for part in [x, of_e, z] {
                let size = part.iter().map(|share| share * share).sum::<f64>().sqrt();
                reached += size;
                part.iter_mut().for_each(|share| *share = if size > 0.0 { *share / size } else { 0.0 });
            }
            (reached, shares)
        };
        let all = (0..base.len()).map(at);
        all.reduce(|a, b| if b.0 > a.0 { b } else { a }).map_or_else(|| self.middle(), |(_, shares)| shares)
    }
}
