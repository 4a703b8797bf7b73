//! What a claim looks like: runs from the edge of its set with 0, 3 and 10 oscillators, beside the bounds that are proved.
//!
//! The runs are floating point and of one plant and one start each; they decide nothing, and no claim depends on them.

use super::claim::TriedClaim;
use super::finding::{Trial, TriedPlant};
use super::random::Random;
use super::start::{boundary, drawn_plant, file, no_member, regulator};
use crate::simulate::{
    ClosedLoop, Disturbance, IntegrationFailure, SampledLoop, SampledRun, Tolerance, trajectory,
};
use sigmastar_document::plot::{Curve, Figure, Scale, Style};
use sigmastar_lang::plant::Plant;

/// The numbers of oscillators.
const SHOWN_N_O: [u32; 3] = [0, 3, 10];

/// The operations that each run may take: about a second.
const EFFORT: u64 = 1_000_000_000;

/// The length of a run: so many times 1/sigma, and between so many periods.
const DECAYS: f64 = 12.0;
const PERIODS: [f64; 2] = [5.0, 40.0];

/// Points of a curve, about, and at least in a period.
const POINTS: usize = 600;
const POINTS_OF_PERIOD: usize = 60;

/// How far below the smallest bound the axis of |e| goes, as a share; how much larger than what happens a bound may be to be drawn
/// on a linear axis.
const BELOW: f64 = 0.03;
const FAR: f64 = 12.0;

/// (t, e) and (t, u) of a run.
#[derive(Clone, Debug, Default)]
struct EdgeRun {
    n_o: u32,
    error: Vec<(f64, f64)>,
    control: Vec<(f64, f64)>,
}

/// Runs from the edge of the set of a claim.
#[derive(Clone, Debug)]
pub struct Edge {
    runs: Vec<EdgeRun>,
    end: f64,
    /// Which plant is simulated, and from where.
    pub words: String,
    steady: Vec<Option<f64>>,
}

/// What is proved of every solution from the set, at all times.
#[derive(Clone, Copy, Debug)]
pub struct ProvedBounds {
    /// Of |e|.
    pub error: f64,
    /// Of |u| along the periodic solution, and at all times.
    pub control: [f64; 2],
    /// Of |e| along the periodic solution, for every n_o.
    pub steady: f64,
}

/// Runs the plant of a claim, or of a claim about data the linear member with the largest gains.
///
/// # Errors
/// In words: why there is nothing to be shown.
pub fn from_the_edge(claim: &TriedClaim) -> Result<Edge, String> {
    let (plant, words) = match &claim.own {
        Some(own) => (own.plant.clone(), "of the plant"),
        None => (member(claim)?, "of the linear plant with the largest gains that the data allow"),
    };
    let words = format!("{words}, from the edge of the set");
    let sigma = claim.sigma;
    let period = plant.period.nominal().to_f64();
    let periods = (DECAYS / (sigma * period)).clamp(PERIODS[0], PERIODS[1]).ceil() as usize;
    let end = periods as f64 * period;
    let points = (POINTS / periods).max(POINTS_OF_PERIOD);
    let mut runs = Vec::new();
    let mut failed = None;
    for n_o in SHOWN_N_O {
        match one(claim, &plant, n_o, [periods, points]) {
            Ok(Some(run)) => runs.push(run),
            // The law at samples has fewer oscillators than that.
            Ok(None) => {}
            Err(failure) => failed = Some(failure),
        }
    }
    if runs.is_empty() {
        return Err(failed.map_or_else(|| "no regulator is in double precision".to_owned(), |failure| failure.to_string()));
    }
    let steady = runs.iter().map(|run| claim.error_bounds(sigma, run.n_o).map(|[_, sup]| sup)).collect();
    Ok(Edge { runs, end, words, steady })
}

/// A plant that the data of a claim describe.
fn member(claim: &TriedClaim) -> Result<Plant, String> {
    let drawn = drawn_plant(claim, 1, &mut Random::new(0, 1)).ok_or_else(|| no_member(claim).to_owned())?;
    let states = drawn.family.states();
    let trial = Trial {
        number: 1,
        plant: TriedPlant::Drawn(Box::new(drawn)),
        sigma: claim.sigma,
        n_o: 0,
        start: vec![0.0; states + 2],
        input_gain: None,
        period: None,
        parameters: Vec::new(),
        phase: None,
    };
    file(claim, &trial).map_err(|_| "the plant that is drawn is in no file".to_owned())
}

/// A point of the edge, the same x and e for every n_o.
fn start(claim: &TriedClaim, states: usize, regulator: &sigmastar_regulator::Regulator) -> Vec<f64> {
    let mut start = boundary(claim, states, regulator, &mut Random::new(0, 1));
    if let Some(own) = &claim.own {
        let x = own.state(0.0, &start[..states]);
        start[..states].copy_from_slice(&x);
    }
    start
}

fn one(
    claim: &TriedClaim,
    plant: &Plant,
    n_o: u32,
    [periods, points]: [usize; 2],
) -> Result<Option<EdgeRun>, IntegrationFailure> {
    if let Some(law) = &claim.sampled {
        let small = 2 * n_o < law.samples;
        let Some((regulator, discrete)) = small.then(|| law.regulator(&claim.spec, n_o)).flatten() else { return Ok(None) };
        let begins = start(claim, plant.states(), &regulator);
        let sampled = SampledLoop::new(plant, regulator, discrete);
        return at_samples(&sampled, &sampled.starting(begins, claim.initial.z0.is_none()), n_o, periods, points);
    }
    let regulator = regulator(claim, claim.sigma, n_o);
    let mut y = start(claim, plant.states(), &regulator);
    let closed_loop = ClosedLoop::new(plant, regulator);
    closed_loop.leave(EFFORT);
    let n = closed_loop.states();
    let mut run = EdgeRun { n_o, ..EdgeRun::default() };
    for index in 0..periods {
        let t = index as f64 * closed_loop.period;
        let states = trajectory(&closed_loop, t, closed_loop.period, points, &y, Tolerance::ORDINARY)?;
        for (at, y) in states.iter().enumerate().skip(usize::from(index > 0)) {
            let t = t + closed_loop.period * at as f64 / points as f64;
            run.error.push((t, y[n]));
            run.control.push((t, closed_loop.control(y, Disturbance::default())));
        }
        y = states.last().cloned().unwrap_or(y);
    }
    Ok(Some(run))
}

fn at_samples(
    sampled: &SampledLoop,
    start: &[f64],
    n_o: u32,
    periods: usize,
    points: usize,
) -> Result<Option<EdgeRun>, IntegrationFailure> {
    sampled.plant().leave(EFFORT);
    let Some(mut steps) = SampledRun::new(sampled, 0, start) else { return Ok(None) };
    let samples = sampled.samples_rounded_up();
    let every = (samples / points).max(1);
    let mut run = EdgeRun { n_o, ..EdgeRun::default() };
    for sample in 0..periods * samples {
        let e = steps.plant_state().last().copied().unwrap_or_default();
        let t = steps.time();
        let pieces = steps.advance(1, Tolerance::ORDINARY)?;
        if sample % every == 0 {
            run.error.push((t, e));
            let held = pieces.iter().map(|piece| (piece.t, piece.u));
            run.control.extend(held.take(1));
        }
    }
    Ok(Some(run))
}

impl Edge {
    /// |e| and u over time. What is proved holds for every solution from the set; what is simulated is floating point.
    #[must_use]
    pub fn figures(&self, proved: &ProvedBounds) -> [Figure; 2] {
        [self.error(proved), self.control(proved)]
    }

    fn error(&self, proved: &ProvedBounds) -> Figure {
        let bound = |run: usize| self.steady.get(run).copied().flatten().unwrap_or(proved.steady);
        let bounds: Vec<f64> = (0..self.runs.len()).map(bound).collect();
        let least = bounds.iter().copied().filter(|bound| *bound > 0.0).fold(proved.error, f64::min);
        let floor = BELOW * least;
        let mut curves = vec![line(
            format!("proved: |e| at most {} at all times", up(proved.error)),
            [0.0, self.end],
            proved.error,
        )];
        let one = self.steady.iter().all(Option::is_none);
        for (run, bound) in self.runs.iter().zip(&bounds) {
            // What is proved of the limit belongs to the end of the run.
            if *bound > 0.0 && !(one && run.n_o > 0) {
                let half = 0.5 * self.end;
                let corners = [(half, floor), (half, *bound), (self.end, *bound), (self.end, floor)];
                let whose = if one { "every n_o".to_owned() } else { format!("n_o = {}", run.n_o) };
                curves.push(Curve {
                    label: format!("proved, {whose}: in the limit at most {}", up(*bound)),
                    points: corners.to_vec(),
                    style: Style::Band,
                });
            }
            let points = run.error.iter().map(|(t, e)| (*t, e.abs())).collect();
            curves.push(Curve { label: format!("simulated, n_o = {}", run.n_o), points, style: Style::Line });
        }
        Figure {
            title: "The error: what is proved, and a simulation from the edge of the set".to_owned(),
            x: "time t [unit of time]".to_owned(),
            y: "|e| [unit of e]".to_owned(),
            scale: Scale::LogY,
            floor,
            curves,
        }
    }

    fn control(&self, proved: &ProvedBounds) -> Figure {
        let [steady, largest] = proved.control;
        let happens = self.runs.iter().flat_map(|run| &run.control).fold(0.0_f64, |most, (_, u)| most.max(u.abs()));
        // A bound that is far away would leave a line of the curves.
        let far = largest > FAR * happens;
        let (size, floor): (fn(f64) -> f64, f64) =
            if far { (f64::abs, BELOW * steady.min(happens)) } else { (|u| u, 0.0) };
        let lower = |bound: f64| if far { floor } else { -bound };
        let half = 0.5 * self.end;
        let band = [(half, lower(steady)), (half, steady), (self.end, steady), (self.end, lower(steady)), (half, lower(steady))];
        let mut curves = vec![line(format!("proved: |u| at most {} at all times", up(largest)), [0.0, self.end], largest)];
        if !far {
            curves.push(line(String::new(), [0.0, self.end], -largest));
        }
        curves.push(Curve {
            label: format!("proved: |u| in the limit at most {}", up(steady)),
            points: band.to_vec(),
            style: Style::Band,
        });
        for run in &self.runs {
            let points = run.control.iter().map(|(t, u)| (*t, size(*u))).collect();
            curves.push(Curve { label: format!("simulated, n_o = {}", run.n_o), points, style: Style::Line });
        }
        Figure {
            title: "The control: what is proved, and the same simulation".to_owned(),
            x: "time t [unit of time]".to_owned(),
            y: format!("{} [unit of e per unit of time]", if far { "|u|" } else { "u" }),
            scale: if far { Scale::LogY } else { Scale::Linear },
            floor,
            curves,
        }
    }
}

fn line(label: String, [from, to]: [f64; 2], value: f64) -> Curve {
    Curve { label, points: vec![(from, value), (to, value)], style: Style::Bound }
}

/// Four digits of a bound, rounded up.
fn up(value: f64) -> String {
    use sigmastar_exact::number::{Direction, round_f64, write_exact};
    round_f64(value, 4, Direction::Up).map_or_else(|| value.to_string(), |value| write_exact(&value))
}
