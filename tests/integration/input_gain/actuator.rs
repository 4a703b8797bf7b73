//! What reaches the plant: every export divides by the nominal gain, and the true gain acts in simulations and in trials.

use super::{gain, text, with, written};
use crate::controller::{array, constant, controller, installed, signal};
use crate::controller_c::outputs;
use crate::support::{certified_in, checked, claim, count, json, number, program, read, tried, utf8};
use serde_json::Value;
use sigmastar_lab::falsify::Finding;
use sigmastar_lab::simulate::{ClosedLoop, Tolerance, flow};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Document, Specification};
use sigmastar_regulator::{Design, Stepper, read_regulator};
use std::path::Path;

const NOMINAL: &str = "2.5";

fn interval() -> Value {
    gain(NOMINAL, "2", "3")
}

/// The regulator of a file with a gain, exported.
fn exported(folder: &Path, form: &[&str], file: &str) -> Vec<u8> {
    let spec = written(folder, "paper-example", &interval());
    let call = ["--sigma", "40", "--n-o", "3", "--discretise", "1/100"];
    let path = folder.join(file);
    controller(&[&spec]).args(call).args(form).args(["--force", "-o"]).arg(&path).assert().success();
    std::fs::read(path).unwrap()
}

#[test]
fn every_export_divides_by_the_nominal_gain() {
    let folder = tempfile::tempdir().unwrap();
    let spec = Specification::from_json("spec", &text("paper-example", &interval())).unwrap();
    let (sigma, step) = (constant("40"), constant("1/100"));
    let plain = Design::new(&spec.internal_model, &sigma, 3);
    let divided = plain.clone().for_actuator(spec.input_gain.as_ref());
    let [plain, law] = [&plain, &divided].map(|design| design.discretise(&step).unwrap());
    let close = |a: f64, b: f64| (a - b).abs() <= 1e-15 * b.abs();
    assert!(close(law.feedthrough, plain.feedthrough / 2.5));
    assert!(law.output.iter().zip(&plain.output).all(|(a, b)| close(*a, b / 2.5)));
    assert_eq!((&law.input, law.gain, law.decay), (&plain.input, plain.gain, plain.decay));

    let file = json(&exported(folder.path(), &["--format", "json"], "regulator.json"));
    assert_eq!(file["input_gain"]["nominal"], 2.5);
    assert!(file["law"].as_str().unwrap().ends_with("u = (-sigma e + mu M'N(z - M e))/nominal"));
    assert!(file["discrete"]["law"].as_str().unwrap().contains("u = (-sigma e + K v)/nominal"));
    assert_eq!(file["discrete"]["D"], law.feedthrough);
    assert!(file["notice"].to_string().contains("divided by the nominal input gain 2.5"));
    let read = read_regulator(&Document::parse("regulator", &file.to_string()).unwrap()).unwrap();
    assert_eq!(read, divided.regulator());

    let script = utf8(exported(folder.path(), &["--format", "matlab"], "regulator.m"));
    assert!(script.contains("nominal = 2.5;") && script.contains("u = (-sigma*e + mu*M'*N*(z - M*e))/nominal"));
    assert!(script.contains(&format!("D_d = {:?};", law.feedthrough)), "{script}");
    exported(folder.path(), &["--format", "npz"], "regulator.npz");
    let (_, _, bytes) = array(&folder.path().join("regulator.npz"), "nominal");
    assert_eq!(f64::from_le_bytes(bytes.try_into().unwrap()), 2.5);

    // Without the field nothing speaks of it.
    let call = ["specs/paper-example.json", "--sigma", "40", "--n-o", "3", "--format", "json"];
    let without = json(&controller(&call).assert().success().get_output().stdout);
    assert!(without.get("input_gain").is_none() && !without.to_string().contains("nominal"));
    // Of the library.
    let subject = sigmastar::Specification::from_json(&text("paper-example", &interval())).unwrap();
    let matrices = sigmastar::regulator_matrices(&subject, "40", 3).unwrap();
    let z = vec![0.3; 7];
    let undivided = sigmastar::regulator_matrices(
        sigmastar::Specification::from_json(&crate::support::specification_text("paper-example")).unwrap(),
        "40",
        3,
    );
    let undivided = undivided.unwrap().control(&z, 0.2).unwrap();
    assert!(close(matrices.control(&z, 0.2).unwrap(), undivided / 2.5) && matrices.nominal == Some(2.5));
}

#[test]
fn c_code_with_a_nominal_gain_agrees_with_the_stepper() {
    if !installed("gcc", &["--version"]) {
        return;
    }
    let spec = Specification::from_json("spec", &text("paper-example", &interval())).unwrap();
    let sigma = constant("40");
    for limit in [None, Some("4")] {
        let folder = tempfile::tempdir().unwrap();
        let limited: Vec<&str> = limit.into_iter().flat_map(|limit| ["--saturation", limit]).collect();
        let form: Vec<&str> = ["--format", "c"].into_iter().chain(limited).collect();
        let source = utf8(exported(folder.path(), &form, "regulator.c"));
        assert!(source.contains("static const double nominal = "), "{source}");
        let printed = outputs(&folder.path().join("regulator.c"), 1000);
        let design = Design::new(&spec.internal_model, &sigma, 3).for_actuator(spec.input_gain.as_ref());
        let limit = limit.map(|text| constant(text).to_f64());
        let law = design.discretise(&constant("1/100")).unwrap().saturated(limit);
        let mut stepper = Stepper::new(design.regulator(), law);
        let controls: Vec<f64> = (0..1000).map(|k| stepper.step(signal(k))).collect();
        assert!(controls.iter().map(|u| u.to_bits()).eq(printed), "{limit:?}");
        if let Some(limit) = limit {
            assert!(controls.iter().all(|u| u.abs() <= limit) && controls.contains(&limit));
        }
    }
}

/// The loop with the gain `factor nominal` is that of `e' = q + factor u` with the law undivided.
#[test]
fn the_true_gain_acts_in_simulations() {
    let with = Plant::from_json("plant", &text("plants/paper-example", &interval())).unwrap();
    let plain = crate::support::specification_text("plants/paper-example");
    let plain = Plant::from_json("plain", &plain).unwrap();
    let sigma = constant("8");
    let regulator = Design::new(&plain.internal_model, &sigma, 2).regulator();
    let divided = Design::new(&with.internal_model, &sigma, 2).for_actuator(with.input_gain.as_ref()).regulator();
    let run = |closed_loop: &ClosedLoop| {
        let start = closed_loop.start(&[0.3, -0.2], 0.5);
        flow(closed_loop, 0.0, 2.0, &start, Tolerance::TIGHT).unwrap()
    };
    let close = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9);
    // The nominal gain is the default, and makes the loop without a gain.
    let nominal = run(&ClosedLoop::new(&with, divided.clone()));
    assert!(close(&nominal, &run(&ClosedLoop::new(&plain, regulator.clone()))));
    // b = 6/5: as a plant with that gain of an undivided control.
    let larger = run(&ClosedLoop::new(&with, divided).with_input_gain(3.0));
    assert!(close(&larger, &run(&ClosedLoop::new(&plain, regulator).with_input_gain(1.2))));
    assert!(!close(&larger, &nominal));

    let folder = tempfile::tempdir().unwrap();
    let file = written(folder.path(), "plants/paper-example", &interval());
    let simulated = |more: &[&str]| {
        let call = ["simulate", &file, "--sigma", "8", "--n-o", "2", "--periods", "5", "--format", "json"];
        program().args(call).args(more).assert().success().get_output().clone()
    };
    let steady = |more: &[&str]| json(&simulated(more).stdout)["steady_state"].clone();
    assert_eq!(steady(&[]), steady(&["--input-gain", "5/2"]));
    assert_ne!(steady(&[]), steady(&["--input-gain", "2"]));
    for (call, said) in [
        (&["--input-gain", "2.5"][..], ""),
        (&["--input-gain", "3.5"], "is outside of `input_gain`, from 2 to 3: no claim covers it"),
        (&["--sampled", "1/100", "--input-gain", "1"], "is outside of `input_gain`"),
    ] {
        assert!(utf8(simulated(call).stderr).contains(said), "{call:?}");
    }
    program().args(["simulate", &file, "--sigma", "8", "--n-o", "2", "--input-gain", "0"]).assert().code(2);
}

/// What is put out is bounded: in other units of the actuator the same claim, with the bounds of u in these units, as the trials find.
#[test]
fn the_control_is_that_of_the_actuator() {
    let folder = tempfile::tempdir().unwrap();
    let found = |nominal: f64| {
        let sizes = [nominal, 0.8 * nominal, 1.25 * nominal].map(|gain| gain.to_string());
        let file = with("no-x", &gain(&sizes[0], &sizes[1], &sizes[2]));
        let (certificate, _) = certified_in(folder.path(), &file, &["--no-alternatives"]);
        let answer = checked(&certificate);
        assert_eq!(answer["verdict"], "valid", "{answer}");
        let certificate = read(certificate);
        let (claim, outcome) = (claim(&certificate), tried(&certificate, 6, 3));
        let share = |part: &str| {
            let all = outcome.closest();
            all.iter().find(|closest| closest.quantity.contains(part)).map(|closest| closest.share).expect("tried")
        };
        (claim.control.expect("claimed"), [share("sup|u|"), share("|u - u_p|")])
    };
    let (plain, shares) = found(1.0);
    assert!(shares.iter().all(|share| *share > 0.05 && *share < 1.0), "{shares:?}");
    for nominal in [0.25, 2.0] {
        let (control, of_trials) = found(nominal);
        let close = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-6;
        assert!(
            (0..2).all(|i| close(control[i] * nominal, plain[i]) && close(of_trials[i], shares[i])),
            "{nominal}: {control:?} {of_trials:?}"
        );
    }
}

/// The ends first, then inside; what is tried can be simulated again.
#[test]
fn trials_take_the_ends_first() {
    let folder = tempfile::tempdir().unwrap();
    for (name, sizes) in [("no-x", gain("2", "1.8", "2.2")), ("plants/paper-example", interval())] {
        let (certificate, _) = certified_in(folder.path(), &with(name, &sizes), &["--no-alternatives"]);
        let found = tried(&read(&certificate), count(4, 8).into(), 3);
        let end = |name: &str| number(&sizes[name]);
        let mut gains = Vec::new();
        for finding in &found.findings {
            let Finding::Holds { trial, shares } = finding else { panic!("{name}: {finding:?}") };
            assert!(shares.iter().all(|(_, share)| *share <= 1.0 + 1e-6), "{name}: {shares:?}");
            gains.push(trial.input_gain.unwrap());
        }
        assert_eq!(gains[..2], [end("low"), end("high")]);
        assert!(gains[2..].iter().all(|gain| (end("low")..end("high")).contains(gain)), "{gains:?}");
        let plant = folder.path().join("trial.json");
        let call =
            program().args(["falsify", "-q", "--trial", "2", "--force", "-o"]).arg(&plant).arg(&certificate).assert();
        call.code(0);
        let plant = read(&plant);
        assert_eq!(plant["input_gain"], sizes);
        assert!(plant["description"].as_str().unwrap().contains(&format!("--input-gain {:?}", end("high"))));
    }
}
