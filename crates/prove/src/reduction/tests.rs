//! The values in certificates of the shipped plants, against random points.

use super::closer::closer;
use super::{
    Beside, Checked, PlantRefusal, Prepared, Reduced, Run, Stage, Subject, Unwatched, Watch, bounds_around, reduce,
};
use crate::attempt::bound_tests::random_points::random_points;
use crate::certify::{Limits, Options, Outcome, Wanted, certify_for};
use rayon::prelude::*;
use rug::Rational;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Document, ProvedValue, Specification};
use sigmastar_propose::search::{Failing, Obstacle, SharpProposal};
use std::cell::RefCell;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A value may exceed what random points reach by this part of it; one of the error box beside a matrix inequality, which no
/// condition uses, by as much as a proof tries.
const SLACK: f64 = 0.05;
const SLACK_BESIDE: f64 = 0.11;

/// What no relative comparison can see: q_tx and q_te where they vanish but for the radius of the orbit.
const NOTHING: f64 = 1e-5;

fn shipped(name: &str) -> Plant {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../specs/plants");
    Plant::from_json(name, &std::fs::read_to_string(folder.join(name).with_extension("json")).unwrap()).unwrap()
}

/// No value is below what 20,000 points reach (with `SIGMASTAR_CASES=all` 100,000, and of every plant), and none is more than 5 % above, but for those
/// that vanish on the orbit, and those that no condition uses.
#[test]
fn values_are_above_random_points_and_near_them() {
    let all = std::env::var_os("SIGMASTAR_CASES").is_some_and(|cases| cases == "all");
    let names = [
        "chain",
        "converter",
        "duffing",
        "linear",
        "motor-axis",
        "paper-example",
        "paper-example-ball",
        "pendulum",
        "relative-degree-2-domain",
    ];
    names.par_iter().step_by(if all { 1 } else { 3 }).for_each(|name| {
        let plant = shipped(name);
        let reduced = reduce(&plant, Beside::Nothing, &Unwatched).unwrap();
        let (_, samples) = bounds_around(&plant, reduced.spec.plant().unwrap()).unwrap();
        let radius = reduced.spec.plant().unwrap().largest(|cell| &cell.orbit.radius).to_f64();
        let points = random_points(plant.states(), if all { 100_000 } else { 20_000 });
        let values = reduced.spec.bounds.proved_values();
        for ProvedValue { bound, x, e, value, .. } in &values.entries {
            let place = format!("{name}: {} at ({}, {})", bound.field(), x.to_f64(), e.to_f64());
            if plant.states() == 0 && bound.is_rate() {
                continue;
            }
            let found = samples.largest_at(*bound, [x.to_f64() + radius, e.to_f64()], &points);
            let value = if bound.is_rate() { -value.to_f64() } else { value.to_f64() };
            assert!(value >= found, "{place}: {value} is below {found}");
            let joint = values.joint_stability.as_ref().map(|joint| &joint.inequality.e);
            let ends = values.inequality.as_ref().map(|inequality| &inequality.e).or(joint);
            let is_beside = ends == Some(e);
            let slack = if is_beside { SLACK_BESIDE } else { SLACK };
            let near = value - found <= slack * found.abs() || value.abs() < NOTHING;
            assert!(near, "{place}: {value} for {found}");
        }
    });
}

/// Hears how many candidates are tried, of how many parts each stage is, and how far whole searches are.
#[derive(Default)]
struct Heard {
    tried: AtomicUsize,
    searched: Mutex<Vec<[usize; 3]>>,
    parts: Mutex<Parts>,
}

/// The stage that it is in, and each part that was heard: its stage, and of how many.
type Parts = (Option<Stage>, Vec<(Stage, usize)>);

impl Watch for Heard {
    fn enter(&self, stage: Stage) {
        self.parts.lock().unwrap().0 = Some(stage);
    }

    fn part(&self, done: usize, of: usize) {
        let (at, heard) = &mut *self.parts.lock().unwrap();
        assert!(1 <= done && done <= of, "{done} of {of}");
        heard.extend(at.map(|stage| (stage, of)));
    }

    fn tried(&self, count: usize) {
        self.tried.fetch_max(count, Ordering::Relaxed);
    }

    fn searched(&self, done: usize, of: usize, steps: usize) {
        assert_eq!(self.parts.lock().unwrap().0, Some(Stage::Comparison));
        self.searched.lock().unwrap().push([done, of, steps]);
    }
}

/// Coordinates, of which a state alone has none to choose, take most of the time: who waits hears that it goes on.
#[test]
fn candidates_are_counted() {
    let tried = |name: &str| {
        let heard = Heard::default();
        reduce(&shipped(name), Beside::Nothing, &heard).unwrap();
        heard.tried.into_inner()
    };
    let (few, many) = (tried("linear"), tried("duffing"));
    assert!(few >= 1 && many > 50, "{few} {many}");
}

/// Of a family at samples: the cells, the gains of the scan, the intervals that are closed in turn.
#[test]
fn cells_gains_and_comparisons_are_counted() {
    let text = r#"{
        "format": "sigmastar/plant", "version": 1, "name": "One state", "period": "1", "states": ["x"],
        "parameters": { "a": { "nominal": "2", "low": "1.7", "high": "2.3" } },
        "f": ["-a*x - x^3/20 + e/5 + 2 + sin(2*pi*t)"], "q": "x + sin(2*pi*t)",
        "internal_model": { "mu": "1", "base_frequency": "2*pi", "matched": true, "sampling_period": "1/1000",
            "weights": { "family": "power", "n0": "2", "epsilon": "1/2" } } }"#;
    let subject = Subject::read(&Document::parse("family", text).unwrap()).unwrap();
    let heard = Heard::default();
    let prepared = Prepared::watched(subject, None, &heard).unwrap();
    let tried = heard.tried.load(Ordering::Relaxed);
    assert!(tried > 0, "{tried}");
    prepared.certify_checked(Options::default(), &|_| Checked::Decided, &heard).unwrap();
    let (_, parts) = heard.parts.into_inner().unwrap();
    assert!(parts.iter().any(|(stage, of)| *stage == Stage::Orbit && *of > 2), "{parts:?}");
    let mut searched = heard.searched.into_inner().unwrap();
    searched.sort_unstable();
    // The first of them is heard of long before it is done.
    assert!(searched.starts_with(&[[0, 1, 1], [0, 1, 2]]) && searched.len() > 10, "{searched:?}");
    assert_eq!(searched.last(), Some(&[1, 1, searched.len() - 1]));
}

/// The gain that data lead to, and the proved bound of |e| on the way with it; of the gain that is given, where one is.
fn gain_and_peak(data: &(Specification, SharpProposal), gain: Option<&Rational>, limits: &Limits) -> Option<[f64; 2]> {
    let (spec, proposal) = data;
    let wanted = Wanted { start: Some(proposal), gain, limits: Some(limits) };
    let run = certify_for(spec, Options::default(), wanted).unwrap();
    let (_, peak, _) = run.bounds()?;
    Some([run.sigma_star()?.to_f64(), peak.upper().to_f64()])
}

/// The data for a gain that is given, or those without joint metrics, which are those of the least gain.
fn data_for(plant: &Plant, gain: Option<&Rational>) -> (Specification, SharpProposal) {
    let beside = gain.map_or(Beside::Nothing, Beside::Gain);
    let Reduced { spec, proposal, others, .. } = reduce(plant, beside, &Unwatched).unwrap();
    others.into_iter().last().unwrap_or((spec, proposal))
}

/// The values for the least gain say of a larger one less than those for its own sets.
#[test]
fn a_given_gain_is_proved_with_values_for_its_own_sets() {
    let plant = shipped("relative-degree-2");
    let gain = Rational::from(8);
    let [least, own] = [None, Some(&gain)].map(|asked| {
        let [sigma, peak] = gain_and_peak(&data_for(&plant, asked), Some(&gain), &Limits::default()).unwrap();
        assert_eq!(sigma, 8.0);
        peak
    });
    assert!(own < 0.6 * least, "{own} {least}");
    // A gain that is too small has no sets: there are no data beside those of the table.
    let small = Rational::from((1, 2));
    let [of_small, of_rows] = [Beside::Gain(&small), Beside::Rows]
        .map(|beside| reduce(&plant, beside, &Unwatched).unwrap().others.into_iter().map(|(_, found)| found.sigma));
    assert!(of_small.eq(of_rows));
}

/// A limit of |e| is kept with a smaller gain by values for the sets of that gain; nothing is found between gains that are the same.
#[test]
fn a_limit_is_kept_with_a_smaller_gain_by_values_of_its_own() {
    let plant = shipped("relative-degree-2");
    let limits = Limits { peak_error: Some(Rational::from(4)), ..Limits::default() };
    let least = data_for(&plant, None);
    let [found, _] = gain_and_peak(&least, None, &limits).unwrap();
    let within = |data: &(Specification, SharpProposal)| gain_and_peak(data, None, &limits).map(|[sigma, _]| sigma);
    let smaller = closer(&plant, [least.1.sigma, found], within, &Unwatched).unwrap();
    let [sigma, peak] = gain_and_peak(&smaller, None, &limits).unwrap();
    assert!(sigma < 0.98 * found && peak <= 4.0, "{sigma} {found} {peak}");
    assert!(closer(&plant, [sigma, sigma], within, &Unwatched).is_none());
}

/// What is proved by the number of oscillators keeps a limit where the independent checker decides it, and where it does not that is the reason.
#[test]
fn a_limit_rests_on_what_the_checker_decides() {
    let document = Document::parse("plant", &plant_with(r#""initial_set":{"kind":"aligned","X0":"1/2","E0":"1/2"},"#));
    let subject = Subject::read(&document.unwrap()).unwrap();
    let options = Options { compare: false, ..Options::default() };
    let prepared = |limits: &Limits| Prepared::seeking(&subject, None, (limits, &[]), options, &Unwatched).unwrap();
    // One that the conditions of the smallest gain do not keep, and its table does.
    let none = Limits { peak_error: Some(Rational::from(1000)), ..Limits::default() };
    let all = prepared(&none);
    let Run::Continuous(run) = all.certify(options).unwrap() else { panic!("in continuous time") };
    let (_, of_conditions, _) = run.bounds().unwrap();
    let [_, of_all, _] = run.bounds_with(&[]).unwrap();
    assert!(of_all.upper_f64() < 0.9 * of_conditions.upper_f64(), "{of_all:?} {of_conditions:?}");
    let limits = Limits { peak_error: of_all.upper_rational().map(|most| most * Rational::from((101, 100))), ..none };

    let prepared = prepared(&limits);
    let asked = |gives_up: bool| {
        let check = |run: &Run<'_>| match run {
            Run::Continuous(run) if gives_up && run.by_count.as_ref().is_some_and(|found| found.checked) => {
                Checked::GivenUp
            }
            _ => Checked::Decided,
        };
        let mut run = prepared.certify_checked(options, &check, &Unwatched).unwrap();
        run.prove_rates(&[]).unwrap();
        let Run::Continuous(run) = run else { panic!("in continuous time") };
        (run.claim().is_some(), run.sharp)
    };
    assert!(asked(false).0);
    let (certified, outcome) = asked(true);
    let Outcome::NotFound(Obstacle { failing, .. }) = outcome else { panic!("a claim is left") };
    assert!(!certified && matches!(failing, Failing::NotDecidedAgain { refused: false, .. }), "{failing:?}");
}

/// What takes long is sought for a claim that the checker decides alone, and is left out of the certificate where it gives up on that.
#[test]
fn bounds_by_the_number_of_oscillators_are_added_to_a_decided_claim() {
    let document = Document::parse("plant", &plant_with(r#""initial_set":{"kind":"aligned","X0":"1/2","E0":"1/2"},"#));
    let subject = Subject::read(&document.unwrap()).unwrap();
    let options = Options::default();
    let prepared = Prepared::seeking(&subject, None, (&Limits::default(), &[]), options, &Unwatched).unwrap();
    // The checks in turn, whether each was of a claim with such bounds; and whether there is a claim, with bounds that are decided.
    let with = |gives_up: fn(bool) -> bool| {
        let seen = RefCell::new(Vec::new());
        let check = |run: &Run<'_>| {
            seen.borrow_mut().push(run.says_by_count());
            if gives_up(run.says_by_count()) { Checked::GivenUp } else { Checked::Decided }
        };
        let run = prepared.certify_checked(options, &check, &Unwatched).unwrap();
        let Run::Continuous(run) = run else { panic!("in continuous time") };
        (seen.into_inner(), run.claim().is_some(), run.by_count.as_ref().map(|found| found.checked))
    };
    assert_eq!(with(|_| false), (vec![false, true], true, Some(true)));
    assert_eq!(with(|says_by_count| says_by_count), (vec![false, true], true, Some(false)));
    let (seen, is_certified, found) = with(|_| true);
    assert!(!seen.is_empty() && !seen.contains(&true) && !is_certified && found.is_none(), "{seen:?} {found:?}");
}

/// What is in the way of an initial set is told at it; of a set whose sizes are open, which is the smallest, nothing smaller is asked for.
#[test]
fn a_set_in_the_way_is_told_at_its_place() {
    let told = |set: &str, failing: Failing| {
        let text = plant_with(set);
        let plant = Plant::from_json("plant", &text).unwrap();
        let [errors] = &PlantRefusal::NoGain(failing.into()).errors(&plant)[..] else { panic!("{set}") };
        let error = errors.errors()[0].clone();
        (error.pointer, error.help.unwrap())
    };
    let sized = r#""initial_set":{"kind":"box","ball":"1","E0":"1","Z0":"0"},"#;
    let smallest = "smallest of its kind already";
    let (pointer, help) = told(sized, Failing::Curvature);
    assert!(pointer == "/initial_set" && !help.contains(smallest), "{pointer}: {help}");
    for set in [r#""initial_set":{"kind":"at-rest"},"#, r#""initial_set":{"kind":"aligned"},"#] {
        for failing in [Failing::Curvature, Failing::DomainE] {
            let (pointer, help) = told(set, failing);
            assert!(pointer == "/initial_set" && help.contains(smallest), "{pointer}: {help}");
            assert_eq!(help.contains("`domain`"), failing == Failing::DomainE, "{help}");
        }
    }
    // Where nothing is stated there is no such place, and what is no matter of the set is not told there.
    let (pointer, help) = told("", Failing::Curvature);
    assert!(pointer.is_empty() && help.contains(smallest), "{pointer}: {help}");
    let (pointer, _) = told(sized, Failing::NotFinite(None));
    assert_eq!(pointer, "");
}

fn plant_with(set: &str) -> String {
    format!(
        r#"{{"format":"sigmastar/plant","version":1,"name":"p","period":"1","states":["x"],"f":["-x + e"],"q":"x + cos(2*pi*t)",{set}
        "internal_model":{{"mu":"1","base_frequency":"2*pi","matched":true,"weights":{{"family":"power","n0":"2","epsilon":"1/2"}}}}}}"#
    )
}
