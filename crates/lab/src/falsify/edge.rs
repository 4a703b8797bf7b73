//! What a claim looks like: runs from the edge of its set with a few numbers of oscillators, beside the bounds that are proved.
//!
//! The runs are floating point and of one plant and one start each; they decide nothing, and no claim depends on them.

use super::claim::TriedClaim;
use super::finding::{Trial, TriedPlant};
use super::random::Random;
use super::start::{boundary, drawn_plant, file, no_member, regulator};
use crate::simulate::figures::{control_axis, number_short};
use crate::simulate::{ClosedLoop, Disturbance, IntegrationFailure, SampledLoop, SampledRun, Tolerance, trajectory};
use sigmastar_document::plot::{Curve, Figure, Scale, Style};
use sigmastar_exact::number::{Direction, round_f64, write_exact};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::Oscillators;
use sigmastar_regulator::Regulator;

/// A number of oscillators that is shown, and a bound of |e| along its periodic solution where one is proved.
pub type Shown = (u32, Option<f64>);

/// The operations that each run may take: about a second.
const EFFORT: u64 = 1_000_000_000;

/// The periods of a run, at least, and at most: with many oscillators it takes long to settle. The control is shown over the first of
/// them alone.
const PERIODS: [usize; 2] = [5, 80];

/// Points of a period.
const POINTS: usize = 80;

/// Points of a curve of the largest |e|, about.
const DRAWN: usize = 400;

/// A run is settled where the largest |e| of a period is below its bound by this share, or below it and falls by less than this from one
/// period to the next.
const SETTLED: [f64; 2] = [0.8, 0.01];

/// The share of the smallest |e| that happens below which a bound is not drawn; how far below the smallest one that is the axis goes at most, where a run
/// ends there.
const NEAR: f64 = 0.1;
const BELOW_AT_MOST: f64 = 1e-4;

/// How far below what happens a logarithmic axis of |u| goes; how much larger than that a bound may be to be drawn on a linear one.
const BELOW: f64 = 0.03;
const FAR: f64 = 25.0;

/// (t, e) and (t, u) of a run.
#[derive(Clone, Debug, Default)]
struct EdgeRun {
    n_o: u32,
    /// The bound of |e| in the limit, where one for this n_o is known.
    limit: Option<f64>,
    error: Vec<(f64, f64)>,
    control: Vec<(f64, f64)>,
    /// How many points there are at the end of each period.
    ends: Vec<usize>,
}

/// Runs from the edge of the set of a claim.
#[derive(Clone, Debug)]
pub struct Edge {
    runs: Vec<EdgeRun>,
    period: f64,
    /// What the regulator divides the control by.
    nominal: Option<f64>,
    /// Which plant is simulated, and from where.
    pub words: String,
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

/// Runs the plant of a claim, or of a claim about data the linear member with the largest gains, with these numbers of oscillators, in rising order.
///
/// # Errors
/// In words: why there is nothing to be shown.
pub fn from_the_edge(claim: &TriedClaim, numbers: &[Shown]) -> Result<Edge, String> {
    let (plant, words) = match &claim.own {
        Some(own) => (own.plant.clone(), "of the plant"),
        None => (member(claim)?, "of the linear plant with the largest gains that the data allow"),
    };
    let mut runs = Vec::new();
    let mut why = "no regulator is in double precision".to_owned();
    let mut periods = None;
    // The most oscillators take longest; the others run as long.
    for shown in numbers.iter().rev() {
        match one(claim, &plant, *shown, periods) {
            Ok(Some(run)) => {
                periods = periods.or(Some(run.ends.len()));
                runs.push(run);
            }
            // The law at samples has fewer oscillators than that.
            Ok(None) => {}
            Err(failure) => why = failure.to_string(),
        }
    }
    runs.reverse();
    let period = plant.period.nominal().to_f64();
    if runs.is_empty() {
        Err(why)
    } else {
        let nominal = plant.input_gain.as_ref().map(|gain| gain.nominal.to_f64());
        Ok(Edge { runs, period, nominal, words: format!("{words}, from the edge of the set") })
    }
}

/// A plant that the data of a claim describe.
fn member(claim: &TriedClaim) -> Result<Plant, String> {
    let drawn = drawn_plant(claim, 1, &mut Random::new(0, 1)).ok_or_else(|| no_member(claim).to_owned())?;
    let states = drawn.states();
    let trial = Trial {
        number: 1,
        plant: TriedPlant::Drawn(Box::new(drawn)),
        sigma: claim.sigma,
        oscillators: Oscillators::first(0),
        start: vec![0.0; states + 2],
        input_gain: None,
        period: None,
        parameters: Vec::new(),
        phase: None,
    };
    file(claim, &trial).map_err(|_| "the plant that is drawn is in no file".to_owned())
}

/// A point of the edge, the same x and e for every n_o.
fn start(claim: &TriedClaim, states: usize, regulator: &Regulator) -> Vec<f64> {
    let mut start = boundary(claim, states, regulator, &mut Random::new(0, 1));
    if let Some(own) = &claim.own {
        own.bring_within(0.0, &mut start);
    }
    start
}

/// A run of so many periods, or until it is settled.
fn one(
    claim: &TriedClaim,
    plant: &Plant,
    (n_o, proved): Shown,
    periods: Option<usize>,
) -> Result<Option<EdgeRun>, IntegrationFailure> {
    let by_formulas = claim.error_bounds(claim.sigma, n_o).map(|[_, sup]| sup).filter(|sup| sup.is_finite());
    let limit = by_formulas.into_iter().chain(proved).reduce(f64::min);
    let run = EdgeRun { n_o, limit, ..EdgeRun::default() };
    let bound = limit.unwrap_or(claim.periodic[1]);
    if let Some(law) = &claim.sampled {
        let small = 2 * n_o < law.samples;
        let Some((regulator, discrete)) = small.then(|| law.regulator(&claim.spec, &n_o.into())).flatten() else {
            return Ok(None);
        };
        let begins = start(claim, plant.states(), &regulator);
        let sampled = SampledLoop::new(plant, regulator, discrete);
        sampled.plant().leave(EFFORT);
        let begins = sampled.starting(begins, claim.initial.z0.is_none());
        let Some(mut steps) = SampledRun::new(&sampled, 0, &begins) else { return Ok(None) };
        return run.over(bound, periods, |run| run.period_at_samples(&sampled, &mut steps)).map(Some);
    }
    let regulator = regulator(claim, claim.sigma, &n_o.into());
    let mut y = start(claim, plant.states(), &regulator);
    let closed_loop = ClosedLoop::new(plant, regulator);
    closed_loop.leave(EFFORT);
    run.over(bound, periods, |run| run.period_in_time(&closed_loop, &mut y)).map(Some)
}

impl EdgeRun {
    /// Period by period. Where the effort is spent, or a period fails, the run ends with those before, if they are enough.
    fn over(
        mut self,
        bound: f64,
        periods: Option<usize>,
        mut period: impl FnMut(&mut EdgeRun) -> Result<(), IntegrationFailure>,
    ) -> Result<EdgeRun, IntegrationFailure> {
        let mut before = f64::INFINITY;
        for index in 0..periods.unwrap_or(PERIODS[1]) {
            let from = self.error.len();
            match period(&mut self) {
                Ok(()) => {}
                Err(_) if index >= PERIODS[0] => {
                    self.error.truncate(from);
                    break;
                }
                Err(failure) => return Err(failure),
            }
            self.ends.push(self.error.len());
            let sup = self.error[from..].iter().fold(0.0_f64, |most, (_, e)| most.max(e.abs()));
            let settled = sup <= SETTLED[0] * bound || sup <= bound && (before - sup).abs() <= SETTLED[1] * sup;
            if periods.is_none() && settled && index >= PERIODS[0] {
                break;
            }
            before = sup;
        }
        Ok(self)
    }

    fn period_in_time(&mut self, closed_loop: &ClosedLoop, y: &mut Vec<f64>) -> Result<(), IntegrationFailure> {
        let (n, period) = (closed_loop.states(), closed_loop.period);
        let t = self.ends.len() as f64 * period;
        let states = trajectory(closed_loop, t, period, POINTS, y, Tolerance::ORDINARY)?;
        for (at, y) in states.iter().take(POINTS).enumerate() {
            let t = t + period * at as f64 / POINTS as f64;
            self.error.push((t, y[n]));
            self.control.push((t, closed_loop.control(y, Disturbance::default())));
        }
        if let Some(end) = states.last() {
            y.clone_from(end);
        }
        Ok(())
    }

    fn period_at_samples(
        &mut self,
        sampled: &SampledLoop,
        steps: &mut SampledRun<'_>,
    ) -> Result<(), IntegrationFailure> {
        let samples = sampled.samples_rounded_up();
        let every = (samples / POINTS).max(1);
        for sample in 0..samples {
            let (t, e) = (steps.time(), steps.plant_state().last().copied().unwrap_or_default());
            let pieces = steps.advance(1, Tolerance::ORDINARY)?;
            if sample % every == 0 {
                self.error.push((t, e));
                self.control.extend(pieces.first().map(|piece| (piece.t, piece.u)));
            }
        }
        Ok(())
    }

    /// For each time the largest |e| within a period from then on; the last period is left out.
    fn largest(&self) -> Vec<(f64, f64)> {
        let window = self.ends.first().copied().unwrap_or(1);
        let largest = |part: &[(f64, f64)]| part.iter().fold(0.0_f64, |most, (_, e)| most.max(e.abs()));
        let windows = self.error.windows(window + 1);
        windows.filter_map(|part| Some((part.first()?.0, largest(part)))).collect()
    }
}

impl Edge {
    /// |e| and u over time. What is proved holds for every solution from the set; what is simulated is floating point.
    #[must_use]
    pub fn figures(&self, proved: &ProvedBounds) -> [Figure; 2] {
        [self.error(proved), self.control(proved)]
    }

    fn error(&self, proved: &ProvedBounds) -> Figure {
        let bounds: Vec<f64> = self.runs.iter().map(|run| run.limit.unwrap_or(proved.steady)).collect();
        let ends = self.runs.iter().filter_map(|run| run.largest().last().map(|(_, e)| *e));
        let last = ends.fold(f64::INFINITY, f64::min);
        // A bound far below all that happens in this time would leave a line of the curves: its number is told.
        let near = bounds.iter().copied().filter(|bound| *bound > 0.0 && *bound >= NEAR * last);
        let least = near.fold(proved.error, f64::min);
        // A run that goes on below the axis ends at it, and its name says so.
        let floor = (0.5 * least.min(last)).max(BELOW_AT_MOST * least);
        let end = self.runs.iter().map(|run| run.ends.len()).max().unwrap_or(1).saturating_sub(1) as f64 * self.period;
        let mut curves = vec![line(format!("proved: at most {} at all times", up(proved.error)), end, proved.error)];
        let one = self.runs.iter().all(|run| run.limit.is_none());
        for (index, (run, bound)) in self.runs.iter().zip(&bounds).enumerate() {
            // What is proved of the limit belongs to the end of the run.
            if *bound >= floor && !(one && index > 0) {
                let whose = if one { "every n_o".to_owned() } else { format!("n_o = {}", run.n_o) };
                curves.push(Curve {
                    label: format!("proved, {whose}: in the limit at most {}", up(*bound)),
                    points: vec![(0.5 * end, *bound), (end, *bound)],
                    style: Style::Limit,
                });
            }
            let points = run.largest();
            let stride = (points.len() / DRAWN).max(1);
            let unseen = if *bound < floor && !one {
                format!(" (in the limit proved: at most {})", up(*bound))
            } else {
                String::new()
            };
            let mut label = format!("simulated, n_o = {}{unseen}", run.n_o);
            match points.last() {
                Some((_, last)) if *last < floor => label += &format!(", to {}", number_short(*last)),
                Some((_, last)) if last > bound => label += ", not settled yet",
                _ => {}
            }
            let points = points.into_iter().step_by(stride).take_while(|(_, e)| *e >= floor).collect();
            curves.push(Curve { label, points, style: Style::Line });
        }
        Figure {
            title: "The largest error within a period from t on: proved, and simulated from the edge of the set"
                .to_owned(),
            x: format!("time t [unit of time; period {}]", number_short(self.period)),
            y: "|e| [unit of e]".to_owned(),
            scale: Scale::LogY,
            floor,
            curves,
        }
    }

    /// Over the first periods.
    fn control(&self, proved: &ProvedBounds) -> Figure {
        let [steady, largest] = proved.control;
        let end = PERIODS[0] as f64 * self.period;
        let shown = |run: &EdgeRun| run.control.iter().copied().filter(|(t, _)| *t <= end).collect::<Vec<_>>();
        let happens = self.runs.iter().flat_map(shown).fold(0.0_f64, |most, (_, u)| most.max(u.abs()));
        // A bound that is far away would leave a line of the curves.
        let far = largest > FAR * happens;
        let (size, floor): (fn(f64) -> f64, f64) =
            if far { (f64::abs, BELOW * steady.min(happens)) } else { (|u| u, 0.0) };
        let lower = if far { floor } else { -steady };
        let half = 0.5 * end;
        let band = [(half, lower), (half, steady), (end, steady), (end, lower), (half, lower)];
        let mut curves = vec![line(format!("proved: |u| at most {} at all times", up(largest)), end, largest)];
        if !far {
            curves.push(line(String::new(), end, -largest));
        }
        curves.push(Curve {
            label: format!("proved: |u| in the limit at most {}", up(steady)),
            points: band.to_vec(),
            style: Style::Band,
        });
        for run in &self.runs {
            let points = shown(run).into_iter().map(|(t, u)| (t, size(u))).collect();
            curves.push(Curve { label: format!("simulated, n_o = {}", run.n_o), points, style: Style::Line });
        }
        Figure {
            title: "The control: proved, and simulated".to_owned(),
            x: format!("time t [unit of time; period {}]", number_short(self.period)),
            y: control_axis(if far { "|u|" } else { "u" }, self.nominal),
            scale: if far { Scale::LogY } else { Scale::Linear },
            floor,
            curves,
        }
    }
}

fn line(label: String, end: f64, value: f64) -> Curve {
    Curve { label, points: vec![(0.0, value), (end, value)], style: Style::Bound }
}

/// Four digits of a bound, rounded up.
fn up(value: f64) -> String {
    round_f64(value, 4, Direction::Up).map_or_else(|| value.to_string(), |value| write_exact(&value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use sigmastar_lang::spec::Document;

    fn claim(text: &str) -> TriedClaim {
        TriedClaim::from_document(&Document::parse("certificate", text).unwrap()).unwrap()
    }

    #[test]
    fn runs_start_at_the_edge_and_come_below_what_is_proved() {
        for text in [
            include_str!("../../../../proofs-check/tests/certificates/paper-example.sharp.json"),
            include_str!("../../../../proofs-check/tests/plants/paper-example.certificate.json"),
        ] {
            let claim = claim(text);
            let edge = from_the_edge(&claim, &[(0, None), (3, None), (10, None)]).unwrap();
            assert_eq!(edge.runs.iter().map(|run| run.n_o).collect::<Vec<_>>(), [0, 3, 10]);
            // The smaller of two bounds is the one that counts.
            let least = from_the_edge(&claim, &[(0, Some(1e-3))]).unwrap().runs[0].limit;
            assert_eq!(least, Some(1e-3));
            let periods = edge.runs[0].ends.len();
            for run in &edge.runs {
                assert_eq!(run.error[0].1.abs(), claim.initial.e0);
                assert!(run.ends.len() == periods && periods > PERIODS[0]);
                let largest = run.largest();
                assert_eq!(largest.len(), run.error.len() - POINTS);
                assert!(largest.iter().all(|(_, e)| *e <= claim.periodic[1] + claim.error_box[1]));
                // What comes last is below what is proved of the limit.
                let (_, last) = largest[largest.len() - 1];
                assert!(last <= run.limit.unwrap_or(claim.periodic[1]), "{}: {last} {:?}", run.n_o, run.limit);
            }
            let proved = ProvedBounds { error: 10.0, control: [10.0, 1e6], steady: 1.0 };
            let [error, control] = edge.figures(&proved);
            // A bound at all times, and for each n_o one in the limit, or one for all.
            let limits = edge.runs.iter().filter(|run| run.limit.is_some()).count().max(1);
            assert_eq!((error.curves.len(), error.scale), (1 + limits + edge.runs.len(), Scale::LogY));
            assert!(error.curves.iter().all(|curve| curve.style != Style::Band), "areas would lie over each other");
            assert_eq!((control.curves.len(), control.scale), (5, Scale::LogY));
            let near = ProvedBounds { control: [10.0, 20.0], ..proved };
            assert_eq!(edge.figures(&near)[1].scale, Scale::Linear);
            // What an actuator with a gain is given has a unit of its own.
            assert_eq!(edge.figures(&near)[1].y, "u [unit of e per unit of time]");
            let edge = Edge { nominal: Some(2.0), ..edge };
            assert_eq!(edge.figures(&near)[1].y, "u [unit of the actuator]");
        }
    }

    #[test]
    fn a_run_says_where_it_ends_if_the_figure_does_not() {
        let run = |last: f64| EdgeRun {
            limit: Some(0.1),
            error: vec![(0.0, 1.0), (1.0, 1.0), (2.0, last), (3.0, last), (4.0, last)],
            ends: vec![1, 2, 3, 4, 5],
            ..EdgeRun::default()
        };
        let proved = ProvedBounds { error: 10.0, control: [10.0, 10.0], steady: 0.1 };
        for (last, says, floor) in [
            (0.05, "simulated, n_o = 0", 0.025),
            (0.11, "simulated, n_o = 0, not settled yet", 0.05),
            (1e-3, "simulated, n_o = 0", 5e-4),
            (1e-9, "simulated, n_o = 0, to 1e-9", 1e-5),
        ] {
            let edge = Edge { runs: vec![run(last)], period: 1.0, nominal: None, words: String::new() };
            let figure = edge.error(&proved);
            let curve = &figure.curves[2];
            assert_eq!(curve.label, says);
            assert!((figure.floor / floor - 1.0).abs() < 1e-9, "{}", figure.floor);
            // Nothing is drawn at the floor in the place of what is below it.
            assert!(curve.points.iter().all(|(_, e)| *e == 1.0 || *e == last && last > floor));
        }
    }
}
