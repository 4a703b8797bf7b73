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
use sigmastar_lang::spec::Oscillators;
use sigmastar_regulator::Regulator;

/// The phases of a period at which runs start.
const PHASES: [f64; 4] = [0.0, 0.25, 0.5, 0.75];

/// Periods of a run; samples of each, and of what is between two samples of the regulator.
const PERIODS: usize = 2;

/// The phases of runs that settle, and their periods in turn: longer ones where the last part of them, of this share, is not below the limit.
const SETTLING_PHASES: [f64; 2] = [0.0, 0.5];
const SETTLING_PERIODS: [usize; 3] = [4, 16, 64];
const LAST: f64 = 0.3;
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
    /// After how many periods |e| is below a limit for good in the runs that take longest; none without a limit, and where a run was not finished or
    /// took too long.
    pub settling: Option<f64>,
}

/// e and u at the times of a run.
type Series = Vec<[f64; 2]>;

/// The figures of the nominal plant that a claim is about, with its gain, its samples where it has some, and these oscillators, from starts in its initial
/// set, which are to settle below a limit of |e|. `None` where the claim is not about one plant, and where no periodic solution is found.
#[must_use]
pub fn nominal_figures(claim: &TriedClaim, oscillators: &Oscillators, limit: Option<f64>) -> Option<LoopFigures> {
    let own = claim.own.as_ref()?;
    match &claim.sampled {
        None => in_continuous_time((claim, own), oscillators, limit),
        Some(law) => at_samples((claim, own), law, oscillators, limit),
    }
}

fn in_continuous_time(
    (claim, own): (&TriedClaim, &OwnPlant),
    oscillators: &Oscillators,
    limit: Option<f64>,
) -> Option<LoopFigures> {
    let closed_loop = ClosedLoop::new(&own.plant, regulator(claim, claim.sigma, oscillators)).without_limit();
    let (n, period) = (closed_loop.states(), closed_loop.period);
    let set = Set { claim, own, regulator: &closed_loop.regulator };
    let steady = steady_state(&closed_loop, &set.start(0.0, &set.middle()), &Silent).ok()?;
    let steady_error = sup(&Orbit::new(&closed_loop, &steady).ok()?.error());
    let run = |phase: f64, start: &[f64], periods: usize| {
        closed_loop.renew_effort();
        let (mut y, mut series) = (start.to_vec(), Series::new());
        for index in 0..periods {
            let t = (phase + index as f64) * period;
            let samples = trajectory(&closed_loop, t, period, SAMPLES, &y, Tolerance::ORDINARY).ok()?;
            series.extend(samples.iter().map(|y| [y[n], closed_loop.control(y, Disturbance::default())]));
            y.clone_from(samples.last()?);
        }
        Some(series)
    };
    Some(set.figures(steady_error, limit, run))
}

fn at_samples(
    (claim, own): (&TriedClaim, &OwnPlant),
    law: &SampledClaim,
    oscillators: &Oscillators,
    limit: Option<f64>,
) -> Option<LoopFigures> {
    let (regulator, discrete) = law.regulator(&claim.spec, oscillators)?;
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
    let run = |phase: f64, start: &[f64], periods: usize| {
        let mut at_phase = sampled.clone();
        at_phase.phase = phase * sampled.period();
        series(&at_phase, &whole(start.to_vec()), periods, Tolerance::ORDINARY)
    };
    Some(set.figures(steady_error, limit, run))
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

    fn figures(
        &self,
        steady_error: f64,
        limit: Option<f64>,
        run: impl Fn(f64, &[f64], usize) -> Option<Series>,
    ) -> LoopFigures {
        let is_small = self.middle().len() <= MOST_MOVED;
        let largest = if is_small { self.largest(&run) } else { None };
        // A loop that stays above the limit never settles.
        let limit = limit.filter(|limit| is_small && steady_error < *limit);
        LoopFigures { steady_error, largest, settling: limit.and_then(|limit| self.settling(limit, &run)) }
    }

    /// The largest |e| and |u| of all runs; `None` where one does not come to its end.
    fn largest(&self, run: impl Fn(f64, &[f64], usize) -> Option<Series>) -> Option<[f64; 2]> {
        let mut largest = [0.0_f64; 2];
        for phase in PHASES {
            let runs = self.runs(|shares| run(phase, &self.start(phase, shares), PERIODS))?;
            for quantity in [0, 1] {
                let shares = runs.worst(quantity);
                let found = sizes(&run(phase, &self.start(phase, &shares), PERIODS)?);
                largest = [largest[0].max(found[0]), largest[1].max(found[1])];
            }
        }
        Some(largest)
    }

    /// After how many periods |e| is below a limit for good; `None` where a run does not come to its end, or not below the limit.
    fn settling(&self, limit: f64, run: impl Fn(f64, &[f64], usize) -> Option<Series>) -> Option<f64> {
        let mut longest = 0.0_f64;
        for phase in SETTLING_PHASES {
            let settled = SETTLING_PERIODS.into_iter().find_map(|periods| {
                let last = |series: &Series| series.iter().rposition(|sizes| sizes[0].abs() > limit);
                let runs = self.runs(|shares| run(phase, &self.start(phase, shares), periods))?;
                // That of the start from which |e| is above the limit at the latest time.
                let shares = runs.latest(limit);
                let series = run(phase, &self.start(phase, &shares), periods)?;
                let settled = last(&series).map_or(0.0, |last| (last + 1) as f64 / series.len() as f64);
                (settled < 1.0 - LAST).then_some(settled * periods as f64)
            });
            longest = longest.max(settled?);
        }
        Some(longest)
    }

    /// A run from the middle of the set, and one for each component of the start that is moved.
    fn runs(&self, run: impl Fn(&[f64]) -> Option<Series>) -> Option<Runs> {
        let middle = self.middle();
        let moved = |component: usize| {
            let mut shares = middle.clone();
            shares[component] = 1.0;
            run(&shares)
        };
        let moved = (0..middle.len()).map(moved).collect::<Option<_>>()?;
        Some(Runs { parts: self.parts(), base: run(&middle)?, moved })
    }
}

/// Runs from which those from other starts are foretold.
struct Runs {
    parts: [usize; 3],
    base: Series,
    moved: Vec<Series>,
}

impl Runs {
    /// The largest that a quantity is at a time from some start of the set, where it depends on the start as the runs say, and the shares of that start.
    fn at(&self, time: usize, quantity: usize) -> (f64, Vec<f64>) {
        let [n, e, _] = self.parts;
        let middle = self.base[time][quantity];
        let sign = if middle < 0.0 { -1.0 } else { 1.0 };
        let mut shares: Vec<f64> = self.moved.iter().map(|run| sign * (run[time][quantity] - middle)).collect();
        let mut reached = middle.abs();
        let (x, rest) = shares.split_at_mut(n);
        let (of_e, z) = rest.split_at_mut(e);
        for part in [x, of_e, z] {
            let size = part.iter().map(|share| share * share).sum::<f64>().sqrt();
            reached += size;
            part.iter_mut().for_each(|share| *share = if size > 0.0 { *share / size } else { 0.0 });
        }
        (reached, shares)
    }

    /// The shares of the start of which a quantity is the largest at some time.
    fn worst(&self, quantity: usize) -> Vec<f64> {
        let all = (0..self.base.len()).map(|time| self.at(time, quantity));
        all.reduce(|a, b| if b.0 > a.0 { b } else { a }).map_or_else(Vec::new, |(_, shares)| shares)
    }

    /// Those of the start of which |e| is above a limit at the latest time.
    fn latest(&self, limit: f64) -> Vec<f64> {
        let above = |time: usize| Some(self.at(time, 0)).filter(|(reached, _)| *reached > limit);
        let found = (0..self.base.len()).rev().find_map(above);
        found.map_or_else(|| self.worst(0), |(_, shares)| shares)
    }
}
