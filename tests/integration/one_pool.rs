//! One pool of proofs: what is asked in several ways has one answer, and no answer is worse than one that was given already.
//!
//! `SIGMASTAR_CASES=0..200 cargo test --release --test integration one_pool -- --include-ignored` takes more random plants.

use crate::plants_random::saturating_plant;
use crate::support::{self, answer, cases, every, files, json, number, program, stored};
use serde_json::Value;
use tempfile::TempDir;

/// The multiples of a certified gain that are asked for: the last two stand in the table of larger gains.
const MULTIPLES: [f64; 5] = [1.0, 1.001, 1.05, 1.5, 3.0];

/// A bound that is rounded for print may be larger by this share.
const PRINTED: f64 = 1e-6;

/// What may lie between the witnesses of two searches at one gain and one sampling period.
const AT_SAMPLES: f64 = 1e-3;

fn certified(path: &str, flags: &[&str]) -> Option<Value> {
    let output = program().args(["certify", path, "--quiet", "--format", "json"]).args(flags).output().unwrap();
    (output.status.code() == Some(0)).then(|| json(&output.stdout))
}

fn peak(report: &Value) -> f64 {
    number(&report["gains"][0]["peak_error"])
}

/// The row of a report at a gain.
fn row(report: &Value, gain: f64) -> Option<&Value> {
    let rows = report["gains"].as_array()?;
    rows.iter().find(|row| (number(&row["sigma"]) / gain - 1.0).abs() < 1e-5)
}

/// Asserts that at the certified gain, and at larger ones, the loop is certified, with bounds of |e| that are not worse than those for the smaller
/// gains, whose claims are about every larger one, nor than the row of the table.
fn assert_one_answer(path: &str, report: &Value) {
    let gain = &report["sigma_star"];
    let mut proved = peak(report);
    // Sizes of the set that are open are those of the periodic solution at each gain, which shrinks.
    for multiple in MULTIPLES {
        let exact = if multiple == 1.0 {
            gain.as_str().unwrap().to_owned()
        } else {
            format!("{:.6e}", multiple * number(gain))
        };
        let asked = row(report, multiple * number(gain)).map_or(exact, |row| row["sigma"].as_str().unwrap().to_owned());
        let found = certified(path, &["--sigma", &asked]).unwrap_or_else(|| panic!("{path}: {asked} is refused"));
        let own = peak(&found);
        assert!(own <= proved * (1.0 + PRINTED), "{path} at {asked}: {own}, and {proved} for every larger gain");
        if let Some(row) = row(report, multiple * number(gain)) {
            let of_row = number(&row["peak_error"]);
            assert!(own <= of_row * (1.0 + PRINTED), "{path} at {asked}: {own}, and {of_row} in the table");
        }
        proved = proved.min(own);
    }
}

/// Asserts it of every one of these files with a smallest gain and a table of larger ones: how many these are.
fn assert_one_answer_each(paths: &[&str]) -> usize {
    let mut tried = 0;
    for path in paths {
        let report = json(&answer(&["certify", path, "--quiet", "--format", "json"]).stdout);
        let is_smallest =
            report["verdict"] == "certified" && report.get("gains").is_some() && report.get("sigma_star").is_some();
        if is_smallest && report["gains"].as_array().is_some_and(|rows| rows.len() > 1) {
            assert_one_answer(path, &report);
            tried += 1;
        }
    }
    tried
}

#[test]
fn a_certified_gain_is_certified_when_it_is_given() {
    let few = ["specs/paper-example.json", "specs/paper-example-jacobian.json", "specs/short-period.json"];
    assert_eq!(assert_one_answer_each(&few), few.len());
}

/// Plants have more proofs in the pool. In a night all that ships.
#[test]
#[ignore = "search tier"]
fn a_certified_gain_of_a_plant_is_certified_when_it_is_given() {
    let all: Vec<_> = files("specs").into_iter().chain(files("specs/plants")).collect();
    let paths: Vec<&str> =
        all.iter().map(|path| path.strip_prefix(support::ROOT).unwrap_or(path).to_str().unwrap()).collect();
    let some = ["specs/damped.json", "specs/plants/chain.json", "specs/plants/paper-example.json"];
    let chosen = if every(2) == 1 { &paths[..] } else { &some };
    assert!(assert_one_answer_each(chosen) >= 2);
}

#[test]
#[ignore = "search tier"]
fn gains_of_random_plants_are_certified_when_they_are_given() {
    let folder = TempDir::new().unwrap();
    let mut tried = 0;
    for seed in cases(1, 200) {
        let path = stored(folder.path(), "plant.json", &saturating_plant(seed));
        let path = path.to_str().unwrap();
        let certificate = folder.path().join(format!("{seed}.json"));
        let Some(report) = certified(path, &[]) else { continue };
        // What is certified is so with a certificate, too.
        assert!(certified(path, &["-o", certificate.to_str().unwrap()]).is_some(), "{seed}");
        support::assert_valid(&certificate);
        assert_one_answer(path, &report);
        tried += 1;
    }
    assert!(tried > 0);
}

/// At samples the gain that is found is certified when it is given, and stands in the table of `sampling`.
#[test]
#[ignore = "search tier"]
fn a_gain_at_samples_is_one_in_every_answer() {
    let plants = [("specs/plants/paper-example.json", "1/200"), ("specs/plants/duffing.json", "1/100")];
    for (path, step) in plants.into_iter().step_by(every(2)) {
        let found = certified(path, &["--sampling-period", step]).unwrap();
        let gain = found["sigma"].as_str().unwrap();
        let given = certified(path, &["--sampling-period", step, "--sigma", gain])
            .unwrap_or_else(|| panic!("{path}: {gain} is refused"));
        assert_eq!(given["sigma"], found["sigma"], "{path}");
        // A matrix inequality is proved at one gain, and the two searches come to witnesses that differ a little.
        assert!(peak(&given) <= peak(&found) * (1.0 + AT_SAMPLES), "{path}: {} and {}", peak(&given), peak(&found));
        let study = program()
            .args(["sampling", path, "--quiet", "--format", "json", "--sampling-period", step, "--sigma", gain])
            .output()
            .unwrap();
        let study = json(&study.stdout);
        for table in ["by_sampling_period", "by_sigma"] {
            assert_eq!(study[table][0]["sigma"], gain, "{path}: {table} of {study:#}");
        }
    }
}

/// Asserts of an input on which one answer was worse than another, or was taken back, that its gain and its bound of |e| are no larger than these.
fn assert_not_forgotten(name: &str, flags: &[&str], sigma: f64, bound: f64) {
    let path = format!("tests/integration/inputs/{name}.json");
    let report = certified(&path, flags).unwrap_or_else(|| panic!("{name} is refused"));
    let gain = number(report.get("sigma_star").unwrap_or(&report["sigma"]));
    assert!(gain <= sigma, "{name}: {gain}");
    assert!(peak(&report) <= bound, "{name}: {}", peak(&report));
}

#[test]
fn what_was_proved_is_not_forgotten() {
    assert_not_forgotten("cascade-0", &["--sigma", "10"], 10.0, 1.3);
    assert_not_forgotten("cascade", &["--sigma", "10"], 10.0, 1.3);
}

#[test]
#[ignore = "search tier"]
fn what_was_proved_with_more_effort_is_not_forgotten() {
    assert_not_forgotten("boost", &[], 16150.0, f64::INFINITY);
    assert_not_forgotten("tanh-min", &["--sampling-period", "1/10000"], 27.0, f64::INFINITY);
}
