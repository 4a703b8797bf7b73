//! `sigmastar falsify` from the command line.

use crate::support::{certified_in, document, every, json, made, number, read, sigmastar, stored, told};
use crate::trials_support;
use predicates::prelude::*;
use serde_json::Value;
use std::path::Path;

/// The certificate that the program writes for a shipped specification, made once.
fn certificate(name: &str) -> Value {
    json(&made(&["certify", &format!("specs/{name}.json"), "--no-alternatives", "-q"]).1)
}

/// Runs `falsify` on a certificate and returns the exit code, the report and the counterexample, if one was written.
fn falsify(certificate: &Value, folder: &Path, trials: &str, more: &[&str]) -> (i32, Value, Option<String>) {
    let file = stored(folder, "tried.json", certificate);
    let counterexample = folder.join("counterexample.json");
    let _ = std::fs::remove_file(&counterexample);
    let mut command = sigmastar(&["falsify", "--trials", trials, "--format", "json", "--quiet", "-o"]);
    let output = command.arg(&counterexample).arg(&file).args(more).output().unwrap();
    let report = json(&output.stdout);
    (output.status.code().unwrap(), report, std::fs::read_to_string(counterexample).ok())
}

#[test]
fn shipped_certificates_withstand_the_trials() {
    for name in ["paper-example", "linear", "no-x", "paper-example-jacobian"] {
        let folder = tempfile::tempdir().unwrap();
        let (code, report, counterexample) = falsify(&certificate(name), folder.path(), "4", &[]);
        assert_eq!((code, counterexample), (0, None), "{name}: {report}");
        let trials = report["trials"].as_array().unwrap();
        assert!(trials.len() == 4 && trials.iter().all(|trial| trial["finding"] == "holds"), "{name}: {report}");
    }
}

/// Only F = -20 has the rate 20 within |f| <= 20 X: no other plant fits.
fn tight() -> Value {
    let mut spec = document("linear");
    spec["lyapunov"] = serde_json::json!({ "p_low": "1", "p_up": "1", "alpha": "20" });
    for (field, text) in [("f", "20*X + 2000*E"), ("f_e", "2000"), ("q", "1 + X/1000 + E/4"), ("q_x", "1/1000")] {
        spec["bounds"][field] = Value::String(text.to_owned());
    }
    spec
}

fn certified(spec: &Value, folder: &Path) -> Value {
    read(certified_in(folder, spec, &["--no-alternatives"]).0)
}

#[test]
fn a_tight_f_leaves_its_linear_member() {
    let folder = tempfile::tempdir().unwrap();
    let mut certificate = certified(&tight(), folder.path());
    let (code, report, _) = falsify(&certificate, folder.path(), "3", &[]);
    let trials = report["trials"].as_array().unwrap();
    assert!(code == 0 && trials.iter().all(|trial| trial["finding"] == "holds"), "{report}");
    // What it is, from a claim that is false.
    certificate["claim"]["periodic_solution"]["z"] = Value::String("1/1000".to_owned());
    let (code, report, counterexample) = falsify(&certificate, folder.path(), "1", &[]);
    assert_eq!(code, 1, "{report}");
    let plant: Value = serde_json::from_str(&counterexample.unwrap()).unwrap();
    let (f, q) = (plant["f"][0].as_str().unwrap(), plant["q"].as_str().unwrap());
    assert!(f.starts_with("(-(20))*x1 + e*1*((2000.0)"), "{f}");
    assert!(q.contains("(0.25)*1*e") && q.contains("((0.001)"), "{q}");
}

/// Loops at gains of millions are simulated too.
#[test]
fn stiff_trials_come_to_their_end() {
    let folder = tempfile::tempdir().unwrap();
    let mut spec = document("linear");
    spec["bounds"]["f"] = Value::String("20*X + 2e6*E".to_owned());
    spec["bounds"]["f_e"] = Value::String("2e6".to_owned());
    let (code, report, counterexample) = falsify(&certified(&spec, folder.path()), folder.path(), "2", &[]);
    assert_eq!((code, counterexample), (0, None), "{report}");
    let trials = report["trials"].as_array().unwrap();
    assert!(trials.iter().all(|trial| trial["finding"] == "holds"), "{report}");
}

#[test]
fn other_base_frequencies_are_certified_and_tried() {
    let folder = tempfile::tempdir().unwrap();
    let more = ["--base-frequency", "19*pi/10,2*pi"];
    let (code, report, _) = falsify(&certificate("no-x"), folder.path(), "3", &more);
    assert_eq!(code, 0, "{report}");
    let others = report["other_base_frequencies"].as_array().unwrap();
    assert_eq!(others.len(), 2);
    for other in others {
        let shares = other["trials"][0]["shares"].as_array().unwrap();
        let by_n_o = shares.iter().find(|share| share["quantity"] == "rms(e) against its bound for this n_o");
        assert!(by_n_o.is_some_and(|share| share["share"].as_f64().unwrap() < 1.0), "{other}");
    }
    assert!(others[0]["sigma_star"].as_f64().unwrap() > others[1]["sigma_star"].as_f64().unwrap());
    for (frequencies, message) in [("0", "must be positive"), ("2*pi,", "is empty"), ("pi+", "more is needed")] {
        let file = folder.path().join("tried.json");
        let arguments = ["falsify", "--base-frequency", frequencies];
        sigmastar(&arguments).arg(&file).assert().code(2).stdout("").stderr(predicate::str::contains(message));
    }
}

/// The simulation that the description of a counterexample names.
fn simulated_again(counterexample: &str, more: &[&str]) -> Value {
    let plant: Value = serde_json::from_str(counterexample).unwrap();
    let description = plant["description"].as_str().unwrap();
    let words: Vec<&str> = description.split_whitespace().collect();
    let after = |flag: &str| words[words.iter().position(|word| *word == flag).unwrap() + 1].trim_end_matches('.');
    let arguments = ["simulate", "-", "--sigma", after("--sigma"), "--n-o", after("--n-o"), "--format", "json", "-q"];
    let output = sigmastar(&arguments).args(more).write_stdin(counterexample).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{counterexample}");
    json(&output.stdout)
}

#[test]
fn false_certificates_are_refuted_with_a_counterexample() {
    for (name, pointer, value, quantity) in [
        // A gain that is far too small, and nothing else wrong: sigma*/50 and less.
        ("paper-example", "/claim/sigma_star", "9/10", "|e - e_p| in the transient, against D_e"),
        ("no-x", "/claim/sigma_star", "1/230", "|e - e_p| in the transient, against D_e"),
        ("linear", "/claim/sigma_star", "1/50", "Lyapunov function in the transient, against its start"),
        // A periodic solution far smaller than it is.
        ("no-x", "/witness/E_p", "0.002", "sup|e| of the periodic solution"),
        ("no-x", "/claim/periodic_solution/zeta", "1/10", "sup|zeta|_N of the periodic solution"),
        ("no-x", "/claim/periodic_solution/z", "1/10", "sup|z|_N of the periodic solution"),
        // An initial set that the error box does not hold.
        ("linear", "/claim/initial_set/X0", "99", "against D_x"),
        // An error box that solutions leave.
        ("no-x", "/witness/D_e", "1/100", "against D_e"),
    ]
    .into_iter()
    .step_by(every(3))
    {
        let folder = tempfile::tempdir().unwrap();
        let mut altered = certificate(name);
        *altered.pointer_mut(pointer).unwrap() = Value::String(value.to_owned());
        let (code, report, counterexample) = falsify(&altered, folder.path(), "8", &[]);
        assert_eq!(code, 1, "{pointer}: {report}");
        assert_eq!(report["refuted"], true);
        let counterexample = counterexample.expect(pointer);
        assert!(counterexample.contains(quantity), "{pointer}: {counterexample}");
        let again = simulated_again(&counterexample, &["--periods", "2"]);
        let steady = again["steady_state"]["sup_e"].as_f64().unwrap();
        assert!(pointer != "/witness/E_p" || steady > 0.002, "{again}");
    }
}

/// Optional data: no plant that they exclude is held against a certificate, and too small a gain is still found.
#[test]
fn certificates_with_optional_data_withstand_the_trials_and_false_ones_do_not() {
    for (name, too_small, quantity) in [
        ("motor-axis-friction", "200", "Lyapunov function in the transient, against its start"),
        ("paper-example-harmonics-at-rest", "1/4", "Lyapunov function in the transient, against its start"),
    ]
    .into_iter()
    .step_by(every(2))
    {
        let folder = tempfile::tempdir().unwrap();
        let mut certificate = certificate(name);
        let (code, report, counterexample) = falsify(&certificate, folder.path(), "12", &[]);
        let trials = report["trials"].as_array().unwrap();
        assert_eq!((code, counterexample), (0, None), "{name}: {report}");
        assert!(trials.iter().all(|trial| trial["finding"] == "holds"), "{name}: {report}");
        certificate["claim"]["sigma_star"] = Value::String(too_small.to_owned());
        let (code, report, counterexample) = falsify(&certificate, folder.path(), "20", &[]);
        assert_eq!(code, 1, "{name}: {report}");
        assert!(counterexample.unwrap().contains(quantity), "{name}: {report}");
    }
}

#[test]
fn a_fast_plant_breaks_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let (code, report, counterexample) = falsify(&certificate("motor-axis"), folder.path(), "20", &[]);
    assert_eq!((code, counterexample), (0, None), "{report}");
    assert!(report["trials"].as_array().unwrap().iter().all(|trial| trial["finding"] == "holds"), "{report}");
}

/// The worst plant is in the report, `--trial` writes the same, and its simulation is that of the trial.
#[test]
fn the_worst_plant_is_named_and_can_be_simulated_again() {
    let folder = tempfile::tempdir().unwrap();
    let certificate = certificate("linear");
    let (code, report, _) = falsify(&certificate, folder.path(), "6", &["--seed", "3"]);
    assert_eq!(code, 0, "{report}");
    let worst = &report["worst"];
    let trial = worst["trial"].as_u64().unwrap();
    let trials = report["trials"].as_array().unwrap();
    for closest in report["closest"].as_array().unwrap() {
        let share = |trial: &Value| {
            let shares = trial["shares"].as_array().unwrap();
            shares.iter().find(|share| share["quantity"] == closest["quantity"]).unwrap()["share"].as_f64().unwrap()
        };
        let largest = trials.iter().map(share).fold(0.0, f64::max);
        assert_eq!(share(&trials[closest["trial"].as_u64().unwrap() as usize - 1]), largest);
        assert_eq!(closest["share"], largest);
        let general = ["largest Floquet multiplier", "Lyapunov function in the transient, against its start"];
        assert!(general.iter().any(|name| closest["quantity"] == *name) || worst["share"].as_f64().unwrap() >= largest);
    }
    let (tried, plant) = (folder.path().join("tried.json"), folder.path().join("plant.json"));
    let mut command = sigmastar(&["falsify", "--seed", "3", "--trial", &trial.to_string(), "-o"]);
    let output = command.arg(&plant).arg(&tried).output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    let (text, remark) = (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap());
    assert!(text.contains(&format!("Trial {trial}, sigma = ")) && text.contains("The worst plant"), "{text}");
    assert!(remark.contains("the plant is in"), "{remark}");
    let written = std::fs::read_to_string(plant).unwrap();
    assert_eq!(json(written.as_bytes()), worst["plant"]);
    let again = simulated_again(&written, &["--periods", "2"]);
    let bound = number(&certificate["claim"]["periodic_solution"]["e"]);
    let by_trial = trials[trial as usize - 1]["shares"].as_array().unwrap();
    let of = by_trial.iter().find(|share| share["quantity"] == "sup|e| of the periodic solution").unwrap();
    let [again, then] = [again["steady_state"]["sup_e"].as_f64().unwrap() / bound, of["share"].as_f64().unwrap()];
    assert!((again - then).abs() <= 1e-3 * then + 1e-9 && then <= 1.0, "{again} {then}");
    // Only one of these makes sense.
    let both = ["falsify", "--trial", "1", "--trials", "2"];
    sigmastar(&both).arg(&tried).assert().code(2).stdout("");
}

/// What the guide tells a user to do: the samples of a counterexample show the violation.
#[test]
fn a_counterexample_can_be_seen_in_its_samples() {
    let folder = tempfile::tempdir().unwrap();
    let mut altered = certificate("no-x");
    altered["claim"]["sigma_star"] = Value::String("1/230".to_owned());
    let radius = number(&altered["witness"]["D_e"]);
    let (_, report, counterexample) = falsify(&altered, folder.path(), "8", &[]);
    let found = report["trials"].as_array().unwrap().iter().find(|trial| trial["finding"] == "violated").unwrap();
    let csv = folder.path().join("samples.csv");
    let again = simulated_again(
        &counterexample.unwrap(),
        &["--periods", "12", "--samples", "4096", "--csv", csv.to_str().unwrap()],
    );
    let text = std::fs::read_to_string(csv).unwrap();
    let e = text.lines().skip(1).map(|line| line.split(',').nth(1).unwrap().parse::<f64>().unwrap().abs());
    let largest = e.fold(0.0, f64::max);
    let periodic = again["steady_state"]["sup_e"].as_f64().unwrap();
    let distance = found["found"].as_f64().unwrap();
    assert!(
        radius < distance && (largest - distance).abs() <= periodic * 1.001 + 1e-12 * distance,
        "{largest} {distance} {periodic}"
    );
}

#[test]
fn a_triple_that_is_not_proved_draws_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let mut altered = certificate("paper-example-jacobian");
    altered["witness"]["lyapunov"]["alpha"] = Value::String("2".to_owned());
    let file = stored(folder.path(), "altered.json", &altered);
    let assert = sigmastar(&["falsify", "--trials", "1"]).arg(&file).assert();
    assert.code(2).stdout("").stderr(predicate::str::contains("this triple is not proved"));
}

#[test]
fn what_is_no_certificate_is_refused() {
    sigmastar(&["falsify", "specs/linear.json"])
        .assert()
        .code(2)
        .stdout("")
        .stderr(predicate::str::contains("this is a file of format `sigmastar/bounding-spec`"));
}

/// A claim about every set of harmonics is tried with the sets that are chosen, in turn, and a false one is contradicted by a loop with such a set, which
/// `simulate` shows again.
#[test]
fn sets_of_harmonics_are_tried_in_turn() {
    let folder = tempfile::tempdir().unwrap();
    let mut claim = certified(&trials_support::document(), folder.path());
    let sets = ["--harmonics", "0,2", "--harmonics", "3,0,1", "--harmonics", "0..2"];
    let (code, report, counterexample) = falsify(&claim, folder.path(), "4", &sets);
    assert_eq!((code, counterexample), (0, None), "{report}");
    let trials = report["trials"].as_array().unwrap();
    let of = |which: &Value| (which["harmonics"].clone(), which["n_o"].clone());
    let list = |harmonics: &[u32]| (serde_json::json!(harmonics), Value::Null);
    let expected = [list(&[0, 2]), list(&[0, 1, 3]), (Value::Null, 2.into()), list(&[0, 2])];
    assert_eq!(trials.iter().map(of).collect::<Vec<_>>(), expected, "{report}");
    assert!(trials.iter().all(|trial| trial["finding"] == "holds"), "{report}");

    // What the report says repeats a trial.
    let file = stored(folder.path(), "tried.json", &claim);
    let (_, text) = told(sigmastar(&["falsify", "--trials", "2"]).args(sets).arg(&file));
    assert!(text.contains("`--seed 1 --harmonics 0,2 --harmonics 0,1,3 --harmonics 0,1,2 --trial"), "{text}");

    claim["claim"]["periodic_solution"]["e"] = "1/1000".into();
    let (code, report, counterexample) = falsify(&claim, folder.path(), "1", &["--harmonics", "0,2,5"]);
    let trial = &report["trials"][0];
    assert!(code == 1 && of(trial) == list(&[0, 2, 5]), "{report}");
    let counterexample = counterexample.unwrap();
    let plant = json(counterexample.as_bytes());
    let (_, call) = plant["description"].as_str().unwrap().split_once("Simulate it with ").unwrap();
    assert!(call.contains("--harmonics 0,2,5"), "{call}");
    let mut again = sigmastar(&["simulate", "-", "--format", "json", "-q"]);
    again.args(call.trim_end_matches('.').split_whitespace());
    let again = json(&again.write_stdin(counterexample).output().unwrap().stdout);
    let steady = again["steady_state"]["sup_e"].as_f64().unwrap();
    assert!((steady / trial["found"].as_f64().unwrap() - 1.0).abs() < 1e-3, "{steady} {trial}");
}

/// What a certificate says of a set, and by the number of oscillators, is tried with these oscillators: it is nearly reached, and what is half as large
/// is contradicted.
#[test]
fn what_is_said_of_a_set_is_tried_with_it() {
    let folder = tempfile::tempdir().unwrap();
    let at_samples = |document: &Value| {
        let mut document = document.clone();
        document["f"][0] = "-2*v + e + cos(phase)".into();
        document["q"] = "v/2 - e + sin(phase) + sin(2*phase)/2".into();
        document["internal_model"]["sampling_period"] = "1/20".into();
        document
    };
    for document in [trials_support::document(), at_samples(&trials_support::document())] {
        let claim = read(certified_in(folder.path(), &document, &["--harmonics", "0,2"]).0);
        let tried = |claim: &Value, set: &str| {
            let (code, report, _) = falsify(claim, folder.path(), "1", &["--harmonics", set]);
            (code, report)
        };
        let (code, report) = tried(&claim, "0,2");
        let shares = report["trials"][0]["shares"].as_array().unwrap();
        let of = |what: &str| {
            let own = shares.iter().find(|share| share["quantity"] == format!("{what}, with these oscillators"));
            own.unwrap_or_else(|| panic!("{what}: {report}"))["share"].as_f64().unwrap()
        };
        let steady = ["sup|e|", "rms(e)", "sup|u|"].map(|what| of(&format!("{what} of the periodic solution")));
        assert!(code == 0 && steady.iter().all(|share| *share > 0.97), "{steady:?}");
        assert!(of("|e| at all times") > 0.3 && of("|u| at all times") > 0.1, "{report}");

        let place =
            claim["claim"]["by_n_o"].as_array().unwrap().iter().position(|entry| entry.get("harmonics").is_some());
        for (part, name) in [("steady", "e"), ("steady", "e_rms"), ("steady", "u"), ("largest", "e"), ("largest", "u")]
        {
            let mut forged = claim.clone();
            let value = &mut forged["claim"]["by_n_o"][place.unwrap()][part][name];
            let factor = if part == "steady" { 0.5 } else { 0.05 };
            *value = (number(value) * factor).to_string().into();
            let (code, report) = tried(&forged, "0,2");
            let quantity = report["trials"][0]["quantity"].as_str().unwrap_or_default();
            assert!(code == 1 && quantity.ends_with("with these oscillators"), "{part} {name}: {report}");
            // It says nothing of other sets.
            assert_eq!(tried(&forged, "0,1,3").0, 0, "{part} {name}");
        }
    }
}

/// Sets that a claim is not about are refused.
#[test]
fn sets_without_a_claim_are_not_tried() {
    let folder = tempfile::tempdir().unwrap();
    let of = |harmonics: &str, sampling: Option<&str>| {
        let mut document = trials_support::document();
        document["internal_model"]["harmonics"] = harmonics.into();
        if let Some(step) = sampling {
            document["internal_model"]["sampling_period"] = step.into();
        }
        stored(folder.path(), "tried.json", &certified(&document, folder.path()))
    };
    for (harmonics, sampling, set, said) in [
        (
            "first",
            None,
            "0,2",
            "the claim is about oscillators at the first n_o harmonics, and says nothing of oscillators at the harmonics 0, 2",
        ),
        (
            "every-set",
            Some("1/10"),
            "0,10",
            "the claim is about harmonics below 20/2, half of the samples in a period, and 10 is not",
        ),
        ("every-set", None, "1,2", "write `0,1,2`"),
    ] {
        let file = of(harmonics, sampling);
        let (code, text) = told(sigmastar(&["falsify", "--trials", "1", "--harmonics", set]).arg(file));
        assert!(code == 2 && text.contains(said), "{set}: {code} {text}");
    }
    let first = of("first", None);
    sigmastar(&["falsify", "--trials", "1", "--harmonics", "0,1,2"]).arg(first).assert().code(0);
}
