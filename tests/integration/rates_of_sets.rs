//! Rates, and bounds under noise, with oscillators at a set of harmonics (derivation, 13.6 and 14.7), through the program: against loops with exactly these
//! oscillators, of which all is written out here.

use crate::sampled_rates::exponential;
use crate::support::{json, sigmastar, utf8};
use faer::Mat;
use serde_json::{Value, json};
use std::f64::consts::TAU;
use std::path::Path;

/// Of the file `specs/no-x.json`: mu, and the bound of |dq/de|, up to which a plant `e' = slope e + q(t) + d + u` is one of those that are claimed.
const MU: f64 = 1.0;
const STEEPEST: f64 = 1.0;

const SIGMA: f64 = 40.0;
const STEP: f64 = 1.0 / 400.0;
const NOISE: f64 = 0.0003;
const DISTURBANCE: f64 = 0.01;

/// The sets that are asked about, and a number of oscillators.
const SETS: [&str; 2] = ["0,1,4", "0,3"];

/// That file with noise, a disturbance and other fields: its path.
fn document(name: &str, internal_model: &[(&str, Value)], fields: &[(&str, Value)]) -> String {
    let mut document = json(&std::fs::read("specs/no-x.json").expect("shipped"));
    document["measurement"] = json!({ "noise": NOISE.to_string() });
    document["disturbance"] = DISTURBANCE.to_string().into();
    fields.iter().for_each(|(name, value)| document[*name] = value.clone());
    internal_model.iter().for_each(|(name, value)| document["internal_model"][*name] = value.clone());
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("rates-of-sets-{name}.json"));
    std::fs::write(&path, document.to_string()).expect("a folder for tests");
    path.to_str().expect("a plain name").to_owned()
}

/// The report as JSON, and the certificate.
fn certified(path: &str, more: &[&str]) -> [Value; 2] {
    let file = path.replace(".json", ".certificate.json");
    let arguments = ["certify", path, "--no-alternatives", "--format", "json", "--force", "-o", &file];
    let output = sigmastar(&[&arguments, more].concat()).output().expect("the program runs");
    assert!(output.status.success(), "{}", utf8(output.stderr));
    [json(&output.stdout), json(&std::fs::read(&file).expect("a certificate"))]
}

/// The harmonics of an entry.
fn harmonics(entry: &Value) -> Vec<u32> {
    let number = |value: &Value| value.as_u64().expect("a number") as u32;
    entry["harmonics"]
        .as_array()
        .map_or_else(|| (0..=number(&entry["n_o"])).collect(), |all| all.iter().map(number).collect())
}

fn number(value: &Value) -> f64 {
    value.as_str().expect("an exact number").parse().expect("a decimal")
}

/// A linear loop in (e, z): from a time, or a sample, to the next, with what v and d add, and how e and u at rest of all else.
struct Loop {
    matrix: Mat<f64>,
    inputs: [Vec<f64>; 2],
}

/// n_l and the angle of each oscillator in a time of 1/w: of the states of z.
fn weight(l: u32) -> f64 {
    if l == 0 { 2.0 } else { f64::from(l).powf(-1.5) }
}

/// Of each state of z its harmonic, and whether it is in M.
fn states(harmonics: &[u32]) -> Vec<(u32, bool)> {
    harmonics.iter().flat_map(|l| [(*l, true), (*l, false)].into_iter().take(if *l == 0 { 1 } else { 2 })).collect()
}

/// In continuous time: `e' = slope e + d + u`, `u = -sigma (e + v) + mu M'N (z - M (e + v))`, `z' = Phi z - (Phi + sigma) M (e + v)`.
fn continuous(harmonics: &[u32], slope: f64) -> Loop {
    let states = states(harmonics);
    let total: f64 = harmonics.iter().map(|l| weight(*l)).sum();
    let turn = |l: u32| TAU * f64::from(l);
    // What e + v adds to z': Phi turns (1, 0) into (0, -l w).
    let of_measured: Vec<f64> = states.iter().map(|(l, in_m)| if *in_m { -SIGMA } else { turn(*l) }).collect();
    let matrix = Mat::from_fn(states.len() + 1, states.len() + 1, |i, j| match (i, j) {
        (0, 0) => slope - SIGMA - MU * total,
        (0, j) => {
            if states[j - 1].1 {
                MU * weight(states[j - 1].0)
            } else {
                0.0
            }
        }
        (i, 0) => of_measured[i - 1],
        (i, j) => match (states[i - 1], states[j - 1]) {
            ((l, true), (k, false)) if l == k => turn(l),
            ((l, false), (k, true)) if l == k => -turn(l),
            _ => 0.0,
        },
    });
    let of_v = std::iter::once(-SIGMA - MU * total).chain(of_measured.iter().copied()).collect();
    let of_d = (0..=states.len()).map(|i| f64::from(u8::from(i == 0))).collect();
    Loop { matrix, inputs: [of_v, of_d] }
}

/// At samples, with v and d constant in each: `z+ = R (z - M m) + (1 - h sigma) M m`, `u = -sigma m + K M'N R (z - M m)`, m = e + v.
fn at_samples(harmonics: &[u32], slope: f64, gain: f64) -> Loop {
    let states = states(harmonics);
    let turned = |i: usize, j: usize| {
        let ((l, first), (k, other)) = (states[i], states[j]);
        let (sin, cos) = (TAU * f64::from(l) * STEP).sin_cos();
        match (l == k, first, other) {
            (false, ..) => 0.0,
            (true, true, true) | (true, false, false) => cos,
            (true, true, false) => sin,
            (true, false, true) => -sin,
        }
    };
    let in_m = |i: usize| f64::from(u8::from(states[i].1));
    let seen: Vec<f64> = (0..states.len())
        .map(|j| (0..states.len()).map(|i| in_m(i) * weight(states[i].0) * turned(i, j)).sum())
        .collect();
    let of_m: Vec<f64> = (0..states.len()).map(|i| (0..states.len()).map(|j| turned(i, j) * in_m(j)).sum()).collect();
    // u of e + v, and e at the next sample of u + d.
    let through = -SIGMA - gain * seen.iter().enumerate().map(|(j, seen)| seen * in_m(j)).sum::<f64>();
    let (kept, held) = ((slope * STEP).exp(), if slope == 0.0 { STEP } else { ((slope * STEP).exp() - 1.0) / slope });
    let of_measured: Vec<f64> = (0..states.len()).map(|i| (1.0 - STEP * SIGMA) * in_m(i) - of_m[i]).collect();
    let matrix = Mat::from_fn(states.len() + 1, states.len() + 1, |i, j| match (i, j) {
        (0, 0) => kept + held * through,
        (0, j) => held * gain * seen[j - 1],
        (i, 0) => of_measured[i - 1],
        (i, j) => turned(i - 1, j - 1),
    });
    let of_v = std::iter::once(held * through).chain(of_measured.iter().copied()).collect();
    let of_d = (0..=states.len()).map(|i| if i == 0 { held } else { 0.0 }).collect();
    Loop { matrix, inputs: [of_v, of_d] }
}

impl Loop {
    /// e of the response to an input in the first step alone, summed up by its size over so many steps.
    fn response(&self, matrix: &Mat<f64>, input: &[f64], steps: usize) -> f64 {
        let mut state = Mat::from_fn(input.len(), 1, |i, _| input[i]);
        let mut sum = 0.0;
        for _ in 0..steps {
            sum += state[(0, 0)].abs();
            state = matrix * &state;
        }
        sum
    }
}

/// Of every entry of a report: its rate is not above that of the slowest loop of those that are claimed with exactly these oscillators, and its limit not below
/// what the worst signals do there; and neither is idle.
fn within_the_loops(report: &Value, made: impl Fn(&[u32], f64) -> Loop, is_sampled: bool) {
    let entries = report["for_n_o"].as_array().expect("rates");
    assert_eq!(entries.iter().map(harmonics).collect::<Vec<_>>(), [vec![0, 1], vec![0, 1, 4], vec![0, 3]]);
    for entry in entries {
        let own = harmonics(entry);
        let loops = [-STEEPEST, 0.0, STEEPEST].map(|slope| made(&own, slope));
        let rate_of = |of: &Loop| {
            let values = of.matrix.eigenvalues().expect("finite");
            let rate = |size: f64, re: f64| if is_sampled { -size.ln() / STEP } else { -re };
            values.iter().map(|value| rate(value.norm(), value.re)).fold(f64::INFINITY, f64::min)
        };
        let slowest = loops.iter().map(rate_of).fold(f64::INFINITY, f64::min);
        let rate = number(&entry["rate"]);
        assert!(rate <= slowest * (1.0 + 1e-9) && rate >= 0.5 * slowest, "{own:?}: {rate} {slowest}");
        let farthest = |of: &Loop| {
            let step = if is_sampled { 1.0 } else { 0.05 / SIGMA };
            let matrix = if is_sampled {
                of.matrix.clone()
            } else {
                exponential(&Mat::from_fn(of.matrix.nrows(), of.matrix.ncols(), |i, j| of.matrix[(i, j)] * step))
            };
            let steps = (15.0 / slowest / if is_sampled { STEP } else { step }) as usize;
            let [of_v, of_d] = of.inputs.each_ref().map(|input| step * of.response(&matrix, input, steps));
            NOISE * of_v + DISTURBANCE * of_d
        };
        let worst = loops.iter().map(farthest).fold(0.0_f64, f64::max);
        let [limit, peak] = ["limit", "peak"].map(|name| number(&entry["noise"][name]));
        println!("{own:?}: rate {rate} of {slowest}, limit {limit} over {worst}, factor {}", entry["factor"]);
        // The integral is one of a sum.
        assert!(limit >= worst * 0.99 && limit < 8.0 * worst && peak > limit, "{own:?}: {limit} {peak} {worst}");
    }
}

fn asked() -> Vec<&'static str> {
    vec!["--sigma", "40", "--n-o", "1", "--harmonics", SETS[1], "--harmonics", SETS[0]]
}

#[test]
fn rates_and_limits_of_sets_in_continuous_time() {
    let path = document("continuous", &[], &[]);
    let [report, certificate] = certified(&path, &asked());
    within_the_loops(&report, continuous, false);
    is_said_by_both(&report, &certificate);
    starts_decay(&report, &certificate);
}

#[test]
fn rates_and_limits_of_sets_at_samples() {
    for (name, arithmetic, start) in [("samples", "exact", "at-rest"), ("rounded", "double", "aligned")] {
        let fields = [("arithmetic", arithmetic.into()), ("initial_set", json!({ "kind": start }))];
        let path = document(name, &[("sampling_period", "1/400".into())], &fields);
        let [report, certificate] = certified(&path, &asked());
        let gain = number(&certificate["claim"]["gain"]);
        within_the_loops(&report, |own, slope| at_samples(own, slope, gain), true);
        is_said_by_both(&report, &certificate);
    }
}

/// What the certificate has is what the report says, and the independent checker says the same in the same words, of the numbers and of what is stated.
fn is_said_by_both(report: &Value, certificate: &Value) {
    let found = proofs_check::check(certificate.to_string().as_bytes());
    assert!(found.is_valid(), "{}", found.text(false));
    let statement = certificate["claim"]["statement"].as_str().expect("a text");
    assert_eq!(found.subject.expect("valid").statement, statement);
    for part in ["claim", "witness"] {
        let entries = certificate[part]["for_n_o"].as_array().expect("rates");
        assert_eq!(entries.len(), report["for_n_o"].as_array().expect("rates").len());
        for (entry, told) in entries.iter().zip(report["for_n_o"].as_array().expect("rates")) {
            assert_eq!([&entry["n_o"], &entry["harmonics"]], [&told["n_o"], &told["harmonics"]]);
            assert!(entry["n_o"].is_null() != entry["harmonics"].is_null(), "{entry}");
            assert_eq!(entry["Pi"].as_array().map_or(2 * harmonics(entry).len(), Vec::len), 2 * harmonics(entry).len());
            if part == "claim" {
                assert_eq!(
                    ["rate", "factor", "noise"].map(|name| &entry[name]),
                    ["rate", "factor", "noise"].map(|name| &told[name])
                );
            }
        }
    }
    for set in SETS {
        let words = format!(
            " With oscillators at the harmonics {} and sigma = 40 exactly, |e(t) - e_per(t)| <= ",
            set.replace(',', ", ")
        );
        assert!(statement.contains(&words), "{statement}");
    }
}

/// Solutions from the set, of plants with a periodic q, come as near to the periodic one as the factor and the rate say.
fn starts_decay(report: &Value, certificate: &Value) {
    let set = &certificate["claim"]["initial_set"];
    let [e0, z0] = ["E0", "Z0"].map(|name| number(&set[name]));
    let steps = 20_000;
    let dt = 1.0 / f64::from(steps);
    for entry in report["for_n_o"].as_array().expect("rates") {
        let own = harmonics(entry);
        let [rate, factor] = ["rate", "factor"].map(|name| number(&entry[name]));
        let states = states(&own);
        for slope in [-STEEPEST, STEEPEST] {
            let of = continuous(&own, slope);
            let matrix =
                exponential(&Mat::from_fn(of.matrix.nrows(), of.matrix.ncols(), |i, j| of.matrix[(i, j)] * dt));
            // q of the data: |q| <= 4.822 and |q'| <= 24.18.
            let q = |k: i32| 1.0 + 3.5 * (TAU * dt * (f64::from(k) + 0.5)).cos();
            let next = |state: &Mat<f64>, k: i32| {
                let pushed =
                    Mat::from_fn(state.nrows(), 1, |i, _| state[(i, 0)] + if i == 0 { dt * q(k) } else { 0.0 });
                &matrix * &pushed
            };
            let order = of.matrix.nrows();
            // The periodic solution: what a long run comes to.
            let mut periodic = Mat::<f64>::zeros(order, 1);
            let periods = (16.0 / rate).ceil() as i32;
            let monodromy = exponential(&of.matrix);
            let offset = (0..steps).fold(Mat::<f64>::zeros(order, 1), |state, k| next(&state, k));
            (0..periods).for_each(|_| periodic = &monodromy * &periodic + &offset);
            for sign in [-1.0, 1.0] {
                // e at an end, and z in one state, as far as it may be.
                for (far, (l, _)) in states.iter().enumerate() {
                    let start = |i: usize| match i {
                        0 => sign * e0,
                        i if i - 1 == far => -sign * z0 / weight(*l).sqrt(),
                        _ => 0.0,
                    };
                    let (mut state, mut beside) = (Mat::from_fn(order, 1, |i, _| start(i)), periodic.clone());
                    for k in 0..3 * steps {
                        let time = dt * f64::from(k);
                        let apart = (state[(0, 0)] - beside[(0, 0)]).abs();
                        assert!(
                            apart <= factor * (-rate * time).exp(),
                            "{own:?} {far} {time}: {apart} {factor} {rate}"
                        );
                        (state, beside) = (next(&state, k % steps), next(&beside, k % steps));
                    }
                }
            }
        }
    }
}

/// The first harmonics, named one by one, are a number of oscillators.
#[test]
fn a_set_without_a_gap_is_a_number() {
    let path = document("first", &[], &[]);
    let [named, of_named] = certified(&path, &["--sigma", "40", "--harmonics", "3,1,0,2", "--harmonics", "0,3"]);
    let [counted, of_counted] = certified(&path, &["--sigma", "40", "--n-o", "3", "--harmonics", "0,3"]);
    assert_eq!(named["for_n_o"], counted["for_n_o"]);
    assert_eq!(named["for_n_o"][0]["n_o"], 3);
    for part in ["claim", "witness"] {
        assert_eq!(of_named[part], of_counted[part]);
    }
}

/// With a delay there are no rates, and a claim about every set is certified all the same.
#[test]
fn with_a_delay_sets_have_no_rates() {
    let fields = [("sampling_period", "1/400".into()), ("delay_samples", 1.into())];
    let path = document("delayed", &fields, &[]);
    let [report, certificate] = certified(&path, &["--sigma", "20", "--harmonics", "0,3"]);
    assert!(report.get("for_n_o").is_none() && certificate["claim"].get("for_n_o").is_none());
    assert!(certificate["claim"]["harmonics"].is_string());
}

/// What does not fit into a certificate is said before anything is written.
#[test]
fn sets_have_a_limit() {
    let path = document("many", &[], &[]);
    let mut arguments = vec!["certify".to_owned(), path, "--n-o".to_owned(), "0,1".to_owned()];
    (2..9).for_each(|k| arguments.extend(["--harmonics".to_owned(), format!("0,{k}")]));
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let output = sigmastar(&arguments).output().expect("the program runs");
    let message = utf8(output.stderr);
    assert!(!output.status.success() && message.contains("--n-o and --harmonics: 9 numbers"), "{message}");
}
