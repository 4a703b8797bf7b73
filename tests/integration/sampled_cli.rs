//! `simulate --sampled` from the command line.

use crate::support::{self, PLANT, program, utf8};
use predicates::prelude::*;
use serde_json::Value;

const SHORT: [&str; 6] = ["simulate", PLANT, "-q", "--periods", "3", "--coefficients"];

fn json(arguments: &[&str], code: i32) -> Value {
    let output = program().args(SHORT).arg("3").args(arguments).args(["--format", "json"]).assert().code(code);
    support::json(&output.get_output().stdout)
}

#[test]
fn a_simulation_at_samples_reports_writes_samples_and_draws() {
    let folder = tempfile::tempdir().unwrap();
    let (csv, plots) = (folder.path().join("run.csv"), folder.path().join("figures"));
    let arguments = ["--sigma", "2", "--n-o", "2", "--sampled", "1/100", "--samples", "300"];
    let mut call = program();
    call.args(SHORT).arg("3").args(arguments).arg("--csv").arg(&csv).arg("--plots").arg(&plots);
    let words = predicate::str::contains("sup|e| = 0.01829 (0.01814 at the samples)")
        .and(predicate::str::contains("at samples h = 0.01000"))
        .and(predicate::str::contains("100 samples a period"))
        .and(predicate::str::contains("multiplier is 0.848528"));
    call.assert().success().stdout(words);
    let text = std::fs::read_to_string(csv).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], "t,x1,x2,e,u,z0,z1c,z1s,z2c,z2s");
    // Four states in each interval, an even number of at least three.
    assert_eq!(lines.len(), 1 + 3 * 100 * 4 + 1);
    let row = |at: usize| -> Vec<f64> { lines[at].split(',').map(|value| value.parse().unwrap()).collect() };
    assert_eq!(row(1)[..4], [0.0, 1.0, -2.0, 4.0]);
    assert!((row(1201)[0] - 3.0).abs() < 1e-12);
    // Within an interval u and z are held, from one to the next they are not.
    assert!(row(1)[4..] == row(4)[4..] && row(4)[4] != row(5)[4] && row(4)[5] != row(5)[5]);
    for name in ["response.svg", "states.svg", "control.svg", "spectrum.svg"] {
        let svg = std::fs::read_to_string(plots.join(name)).unwrap();
        assert!(svg.starts_with("<svg") && svg.matches("<polyline").count() >= 1, "{name}");
    }
}

#[test]
fn an_exported_law_gives_the_same_simulation() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("controller.json");
    let sigma = ["--sigma", "2", "--n-o", "3"];
    program()
        .args(["controller", PLANT, "--discretise", "1/40", "--saturation", "6", "-o"])
        .arg(&file)
        .args(sigma)
        .assert()
        .success();
    let file = file.to_str().unwrap();
    let direct = json(&[&sigma[..], &["--sampled", "1/40", "--saturation", "6"]].concat(), 0);
    assert_eq!(direct, json(&["--controller", file, "--sampled", "1/40"], 0));
    assert_eq!(direct["sampled"]["saturation"], 6.0);
    assert!(direct["long_run"]["sup_u"].as_f64().unwrap() <= 6.0);
    let refused = |arguments: &[&str], words: &str| {
        let output = program().args(["simulate", PLANT]).args(arguments).assert().code(2);
        let told = utf8(output.get_output().stderr.clone());
        assert!(told.contains(words), "{told}");
    };
    refused(&["--controller", file, "--sampled", "1/50"], "is for the sampling time 0.025, not 0.02");
    let bare = folder.path().join("bare.json");
    program().args(["controller", PLANT, "-o"]).arg(&bare).args(sigma).assert().success();
    refused(&["--controller", bare.to_str().unwrap(), "--sampled", "1/40"], "has no law at samples");
    // A matrix of another dimension, and a law of version 1.
    let text = std::fs::read_to_string(file).unwrap();
    let mut document: Value = serde_json::from_str(&text).unwrap();
    document["discrete"]["Phi"] = serde_json::json!([[1.0]]);
    std::fs::write(&bare, document.to_string()).unwrap();
    refused(&["--controller", bare.to_str().unwrap(), "--sampled", "1/40"], "of different dimensions");
    document["version"] = 1.into();
    std::fs::write(&bare, document.to_string()).unwrap();
    refused(&["--controller", bare.to_str().unwrap(), "--sampled", "1/40"], "has no law at samples");
}

#[test]
fn what_stands_between_the_law_and_the_plant() {
    let base = ["--sigma", "4", "--n-o", "1", "--sampled", "1/50"];
    let with = |more: &[&str]| json(&[&base[..], more].concat(), 0);
    let plain = with(&[]);
    let sup = |value: &Value| value["steady_state"]["sup_e"].as_f64().unwrap();
    assert_eq!(plain, with(&["--delay", "0", "--phase", "0"]));
    let delayed = with(&["--delay", "1/100"]);
    assert!(sup(&delayed) > sup(&plain) && delayed["sampled"]["delay"] == 0.01);
    // x, e, z of one oscillator, and the control that still acts.
    assert_eq!(delayed["steady_state"]["start"].as_array().unwrap().len(), 7);
    // Another phase of the sampling grid has another periodic solution, a little.
    let shifted = with(&["--phase", "1/90"]);
    let off = (sup(&shifted) / sup(&plain) - 1.0).abs();
    assert!(off > 1e-9 && off < 0.05, "{off}");
    let quantised = json(&[&base[..], &["--quantise", "1e-3,1e-2"]].concat(), 3);
    assert_eq!((&quantised["sampled"]["quantum_e"], &quantised["sampled"]["quantum_u"]), (&1e-3.into(), &1e-2.into()));
    assert!(quantised["steady_state"]["error"].as_str().unwrap().contains("does not settle"));
    assert!(quantised["long_run"]["sup_e_last_period"].is_number());
}

#[test]
fn unstable_loops_are_told() {
    // 1 - h sigma = -1.5.
    let report = json(&["--sigma", "25", "--n-o", "1", "--sampled", "1/10"], 3);
    for part in ["steady_state", "long_run"] {
        let told = report[part]["error"].as_str().unwrap();
        assert!(told.contains("unstable") || told.contains("escapes"), "{part}: {told}");
        assert!(report[part]["help"].as_str().unwrap().contains("sampling time"), "{part}");
        assert!(report[part].get("sup_e").is_none() && report[part].get("sup_e_last_period").is_none());
    }
    let mut call = program();
    call.args(["simulate", PLANT, "--sigma", "25", "--n-o", "1", "--sampled", "1/10"]);
    let told = predicate::str::contains("h sigma")
        .or(predicate::str::contains("sigma"))
        .and(predicate::str::contains("undecided"));
    call.assert().code(3).stderr(told).stdout(predicate::str::contains("unstable"));
}

#[test]
fn calls_that_cannot_be() {
    let base = ["simulate", PLANT, "--sigma", "4", "--n-o", "1"];
    for (more, words) in [
        (&["--sampled", "0"][..], "positive"),
        (&["--sampled", "1/50", "--delay", "1/40"], "is longer than the sampling time"),
        (&["--sampled", "1/50", "--delay", "-1"], "negative"),
        (&["--sampled", "1/50", "--quantise", "1,1,1"], "more than two"),
        (&["--sampled", "1/50", "--quantise", "0"], "positive"),
        (&["--sampled", "1/50", "--fixed", "100"], "cannot be used with"),
        (&["--delay", "1/50"], "--sampled"),
        (&["--saturation", "1"], "--sampled"),
    ] {
        let output = program().args(base).args(more).assert().code(2);
        let told = utf8(output.get_output().stderr.clone());
        assert!(told.contains(words), "{more:?}: {told}");
    }
    let high_gain = ["simulate", PLANT, "--sigma", "4", "--high-gain", "--sampled", "1/50"];
    program().args(high_gain).assert().code(2).stderr(predicate::str::contains("cannot be used with"));
}
