//! Oscillators at random sets of harmonics, as C code in closed loop: what a certificate at samples says of the set bounds what the loop does.
//!
//! `SIGMASTAR_CASES=0..80 cargo test --release --test integration exported_laws_with_random_sets -- --include-ignored --nocapture` is a campaign.

use crate::controller::installed;
use crate::linear_case::{Case, Looped, Start};
use crate::support::{assert_valid, cases, json, number, program, read, stored, utf8};
use nalgebra::DVector;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use serde_json::{Value, json};
use std::path::Path;

/// The largest harmonic of a set.
const LARGEST: u32 = 9;

/// What doubles, and a loop that has settled to them alone, may add to a bound: a share of it, and of errors that are 1 at the start.
const ROUNDING: [f64; 2] = [1e-7, 1e-9];

/// A loop of the campaign.
struct Drawn {
    case: Case,
    samples: u32,
    delayed: bool,
    /// Low and high ends of the gain of the actuator over 1.
    gain: Option<[f64; 2]>,
    set: Vec<u32>,
    starts: Vec<Start>,
}

impl Drawn {
    fn new(index: u64) -> Drawn {
        let mut random = StdRng::seed_from_u64(0x5e75 + index);
        let (n, m) = (random.random_range(0..=2), random.random_range(1..=6));
        let case = Case::random(&mut random, n, m);
        let samples = random.random_range(40..=120);
        let delayed = random.random::<bool>();
        let gain = random.random::<bool>().then_some([0.875, 1.125]);
        let set = std::iter::once(0).chain((1..=LARGEST).filter(|_| random.random::<bool>())).collect();
        // On the edge of the set: |x - x_0| = 1, |e| = 1.
        let starts = (0..3).map(|_| {
            let away = DVector::from_fn(n, |_, _| random.random::<f64>() - 0.5);
            let error = if random.random::<bool>() { 1.0 } else { -1.0 };
            Start { phase: random.random(), away: away.clone() / away.norm().max(1e-9), error }
        });
        let starts = starts.collect();
        Drawn { case, samples, delayed, gain, set, starts }
    }

    fn document(&self) -> Value {
        let mut document = self.case.document();
        let model = &mut document["internal_model"];
        model["sampling_period"] = json!(format!("1/{}", self.samples));
        model["delay_samples"] = json!(u32::from(self.delayed));
        if let Some([low, high]) = self.gain {
            document["input_gain"] = json!({ "nominal": 1, "low": low.to_string(), "high": high.to_string() });
        }
        document
    }
}

/// Sizes of a loop with a set of harmonics: the error and the control along the periodic solution, and at all times.
#[derive(Clone, Copy, Debug, Default)]
struct Sizes {
    steady: f64,
    rms: f64,
    peak: f64,
    steady_control: f64,
    control: f64,
}

impl Sizes {
    /// What a certificate claims of a set: its own numbers. Oscillators at the first harmonics have those of their number, or of a smaller one "or more".
    fn of_set(claim: &Value, set: &[u32]) -> Option<Sizes> {
        let entries = claim["by_n_o"].as_array()?;
        let n_o = (0..).zip(set).all(|(k, l)| k == *l).then(|| set.len() as u64 - 1);
        let is_own = |entry: &&Value| {
            let of_count = |n_o: u64| {
                let least = entry["n_o"].as_u64();
                least == Some(n_o) || entry["or_more"] == true && least.is_some_and(|least| least < n_o)
            };
            entry["harmonics"] == json!(set) || n_o.is_some_and(of_count)
        };
        let own = entries.iter().find(is_own).unwrap_or_else(|| panic!("{set:?}: {entries:?}"));
        let of = |part: &str, name: &str| number(&own[part][name]);
        Some(Sizes {
            steady: of("steady", "e"),
            rms: of("steady", "e_rms"),
            peak: of("largest", "e"),
            steady_control: of("steady", "u"),
            control: of("largest", "u"),
        })
    }

    /// What it claims of every set.
    fn of_all(certificate: &Value) -> Sizes {
        let of = |pointer: &str| number(certificate.pointer(pointer).unwrap_or_else(|| panic!("no {pointer}")));
        let [steady, steady_control] = ["/claim/periodic_solution/e", "/claim/control/steady"].map(of);
        Sizes {
            steady,
            rms: steady,
            peak: steady + of("/witness/D_e"),
            steady_control,
            control: steady_control + of("/claim/control/transient"),
        }
    }

    /// Both, size by size.
    fn with(self, other: Sizes, of: impl Fn(f64, f64) -> f64) -> Sizes {
        Sizes {
            steady: of(self.steady, other.steady),
            rms: of(self.rms, other.rms),
            peak: of(self.peak, other.peak),
            steady_control: of(self.steady_control, other.steady_control),
            control: of(self.control, other.control),
        }
    }

    /// What a loop reaches of these bounds; one that it exceeds ends the test.
    fn reached(self, seen: &Looped, what: &str) -> Sizes {
        let Looped { peak, control, settled, .. } = *seen;
        // What has not settled is not near its periodic solution.
        let of_last = |size: f64| if settled { size } else { 0.0 };
        let [steady, steady_control, rms] = [seen.steady, seen.steady_control, seen.rms].map(of_last);
        Sizes { steady, rms, peak, steady_control, control }.with(self, |seen, bound| {
            let [relative, absolute] = ROUNDING;
            assert!(seen <= bound * (1.0 + relative) + absolute, "{what}: {seen:?} is above {bound:?} of {self:?}");
            // A bound of 0 is met by what doubles leave.
            if bound > 1e-6 { seen / bound } else { 0.0 }
        })
    }
}

/// The law of a certificate with the oscillators of a set, as C code.
fn exported(certificate: &Path, set: &str) -> std::path::PathBuf {
    let code = certificate.with_file_name("law.c");
    let flags = ["--harmonics", set, "--format", "c", "--prefix", "law", "--force", "-o"];
    let output = program().arg("controller").arg(certificate).args(flags).arg(&code).output().unwrap();
    assert!(output.status.success(), "{}", utf8(output.stderr));
    code
}

/// What the loops of a case reach of the bounds of its set, with whether all of them have settled, or where it has none of its own of those of every set:
/// the most of all starts and gains.
enum Reached {
    OfSet(Sizes, bool),
    OfAll(Sizes),
    NoGain,
}

fn tried(index: u64) -> Reached {
    let drawn = Drawn::new(index);
    let folder = tempfile::tempdir().unwrap();
    let (input, certificate) =
        (stored(folder.path(), "input.json", &drawn.document()), folder.path().join("certificate.json"));
    let set = drawn.set.iter().map(u32::to_string).collect::<Vec<_>>().join(",");
    let flags = ["--harmonics", &set, "--quiet", "--format", "json", "-o"];
    let output = program().arg("certify").arg(input).args(flags).arg(&certificate).output().unwrap();
    if output.status.code() == Some(3) {
        println!("{index}: {set}: {}", json(&output.stdout)["verdict"]);
        return Reached::NoGain;
    }
    assert_eq!(output.status.code(), Some(0), "{index}: {}", utf8(output.stderr));
    assert_valid(&certificate);
    let code = exported(&certificate, &set);
    let certificate = read(&certificate);
    let own = Sizes::of_set(&certificate["claim"], &drawn.set);
    let bounds = own.unwrap_or_else(|| Sizes::of_all(&certificate));
    let (mut reached, mut settled) = (Sizes::default(), true);
    for b in drawn.gain.map_or(vec![1.0], |[low, high]| vec![low, 1.0, high]) {
        for start in &drawn.starts {
            let seen = drawn.case.looped(&code, drawn.samples, start, b);
            settled &= seen.settled;
            reached = reached.with(bounds.reached(&seen, &format!("{index}, {set}, b = {b}")), f64::max);
        }
    }
    let whose = if own.is_some() { "of the set" } else { "of every set" };
    let Drawn { samples, delayed, gain, .. } = drawn;
    println!("{index}: {set}, {samples} samples, delay {delayed}, {gain:?}, {whose}, settled {settled}: {reached:?}");
    if own.is_some() { Reached::OfSet(reached, settled) } else { Reached::OfAll(reached) }
}

/// 80 laws in a night, of which 60 have bounds of their own.
#[test]
#[ignore = "search tier"]
fn exported_laws_with_random_sets_keep_to_what_is_claimed_of_them() {
    if !installed("gcc", &["--version"]) {
        return;
    }
    let indices = cases(6, 80);
    let count = indices.end - indices.start;
    let ([mut of_set, mut of_all], mut settled) = ([(0, Sizes::default()); 2], 0);
    for reached in indices.map(tried) {
        let (kind, reached) = match reached {
            Reached::OfSet(reached, all_settled) => {
                settled += u64::from(all_settled);
                (&mut of_set, reached)
            }
            Reached::OfAll(reached) => (&mut of_all, reached),
            Reached::NoGain => continue,
        };
        *kind = (kind.0 + 1, kind.1.with(reached, f64::max));
    }
    println!("of {count}, {} with bounds of the set, {settled} of these settled: {:?}", of_set.0, of_set.1);
    println!("{} with those of every set alone: {:?}", of_all.0, of_all.1);
    assert!(2 * of_set.0 > count && of_set.0 + of_all.0 == count, "{} {} of {count}", of_set.0, of_all.0);
    assert!(5 * settled > 4 * of_set.0, "{settled} of {}", of_set.0);
    // The bounds of a set are close to what some loop does.
    let most = of_set.1;
    assert!(most.steady > 0.95 && most.rms > 0.95 && most.steady_control > 0.95, "{most:?}");
    assert!(most.peak > 0.5 && most.control > 0.2, "{most:?}");
}
