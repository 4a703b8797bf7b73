//! One pool of proofs: what is asked in several ways has one answer, and no answer is worse than one that was given already.
//!
//! `SIGMASTAR_CASES=0..200 cargo test --release --test integration one_pool` takes more random plants than an ordinary run.

use crate::plants_random::saturating_plant;
use crate::support::{self, answer, cases, every, files, json, number, program, stem, stored};
use serde_json::Value;
use std::path::Path;
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

/// Specifications and plants that ship, each in an ordinary run by a few.
#[test]
fn a_certified_gain_is_certified_when_it_is_given() {
    let all: Vec<_> = files("specs").into_iter().chain(files("specs/plants")).collect();
    let mut tried = 0;
    for path in all.iter().step_by(every(9)) {
        let path = path.strip_prefix(support::ROOT).unwrap_or(path).to_str().unwrap();
        let report = json(&answer(&["certify", path, "--quiet", "--format", "json"]).stdout);
        let is_smallest =
            report["verdict"] == "certified" && report.get("gains").is_some() && report.get("sigma_star").is_some();
        if is_smallest && report["gains"].as_array().is_some_and(|rows| rows.len() > 1) {
            assert_one_answer(path, &report);
            tried += 1;
        }
    }
    assert!(tried >= 2, "{tried}");
}

#[test]
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

/// Inputs on which one answer was worse than another, or was taken back: name, flags, the largest gain and the largest bound of |e|.
#[test]
fn what_was_proved_is_not_forgotten() {
    let folder = Path::new("tests/integration/inputs");
    for (name, flags, sigma, bound) in [
        ("cascade-0", vec!["--sigma", "10"], 10.0, 1.3),
        ("cascade", vec!["--sigma", "10"], 10.0, 1.3),
        ("boost", vec![], 16150.0, f64::INFINITY),
        ("tanh-min", vec!["--sampling-period", "1/10000"], 27.0, f64::INFINITY),
    ] {
        let path = folder.join(format!("{name}.json"));
        let report = certified(path.to_str().unwrap(), &flags).unwrap_or_else(|| panic!("{name} is refused"));
        let gain = number(report.get("sigma_star").unwrap_or(&report["sigma"]));
        assert!(gain <= sigma, "{name}: {gain}");
        assert!(peak(&report) <= bound, "{name}: {}", peak(&report));
        assert_eq!(stem(&path), name);
    }
}
