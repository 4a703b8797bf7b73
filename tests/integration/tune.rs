//! `sigmastar tune`.

use crate::support::{EXAMPLE, EXAMPLE_TEXT, ROOT, json, number, program, specification_text, utf8};
use predicates::str::{contains, is_empty};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Runs it with a specification on standard input.
fn tune(spec: &str, arguments: &[&str], code: i32) -> Value {
    let mut command = program();
    command.args(["tune", "-", "-q", "--format", "json"]).args(arguments).write_stdin(spec);
    json(&command.assert().code(code).get_output().stdout)
}

/// The certified gain of a specification.
fn certified(spec: &Path) -> Value {
    let output = program().args(["certify", "-q", "--no-alternatives", "--format", "json"]).arg(spec).assert().code(0);
    json(&output.get_output().stdout)
}

/// 39.8018 with mu = 1 and n0 = 2.
#[test]
fn the_example_of_the_paper_is_improved_and_what_is_written_certifies() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("tuned.json");
    let mut command = program();
    command.args(["tune", EXAMPLE, "--over", "mu,n0", "--tries", "60", "--format", "json", "-o"]).arg(&file);
    let output = command.assert().code(0).stderr(contains("the tuned specification is in"));
    let report = json(&output.get_output().stdout);
    let (before, after) = (&report["before"], &report["after"]);
    assert_eq!(before["sigma_star"], "39.8018");
    assert!(number(&after["sigma_star"]) < 36.0, "{after}");
    // It is paid for: mu Nbar^2 grows.
    assert!(number(&after["feedback"]) > number(&before["feedback"]), "{after}");
    assert!(!report["remarks"].to_string().contains("at an end of its range"), "{report}");
    // The written file is the old one but for the two numbers, and certifies with what was said.
    let certificate = certified(&file);
    assert_eq!(certificate["sigma_star"], after["sigma_star"]);
    assert_eq!(certificate["specification"]["sha256"], after["sha256"]);
    for (key, name) in [("X0", "X0"), ("E0", "E0"), ("Z0", "Z0")] {
        assert_eq!(certificate["initial_set"][key], after["initial_set"][name]);
    }
    let mut expected = EXAMPLE_TEXT.to_owned();
    for (parameter, old) in report["parameters"].as_array().unwrap().iter().zip(["\"mu\": \"1\"", "\"n0\": \"2\""]) {
        let new = format!("\"{}\": {}", parameter["name"].as_str().unwrap(), parameter["after"]);
        assert!(EXAMPLE_TEXT.contains(old));
        expected = expected.replace(old, &new);
    }
    assert_eq!(fs::read_to_string(&file).unwrap(), expected);
    // Written twice only with --force.
    program().args(["tune", EXAMPLE, "-o"]).arg(&file).assert().code(2).stderr(contains("exists already"));
}

/// sigma* + mu Nbar^2 is smallest inside of the ranges: at mu = 1/10 and at mu = 10 it is larger.
#[test]
fn what_multiplies_the_error_is_smallest_inside() {
    let report = tune(EXAMPLE_TEXT, &["--over", "mu", "--minimise", "feedback", "--tries", "40"], 0);
    let feedback = number(&report["after"]["feedback"]);
    assert!(feedback < number(&report["before"]["feedback"]), "{report}");
    let mu = number(&report["parameters"][0]["after"]);
    assert!(0.3 < mu && mu < 3.0, "{mu}");
    // The figure is the one that it is called: Nbar^2 = 2 + zeta(3/2).
    let expected = number(&report["after"]["sigma_star"]) + mu * (2.0 + 2.612_375_348_685_488);
    assert!((feedback - expected).abs() < 1e-9 * expected, "{feedback} {expected}");
    for other in ["0.1", "10"] {
        let spec = EXAMPLE_TEXT.replace("\"mu\": \"1\"", &format!("\"mu\": \"{other}\""));
        let there = number(&tune(&spec, &["--over", "mu=1/20..20", "--tries", "2"], 0)["before"]["feedback"]);
        assert!(there > feedback, "{other}: {there}");
    }
}

/// Sampled so slowly the law has no certified gain with mu = 1000, and one with a smaller mu.
#[test]
fn values_that_are_not_certified_are_left_behind() {
    let spec = at_rest_at_samples("1/50").replace("\"mu\": \"1\"", "\"mu\": \"1000\"");
    let report = tune(&spec, &["--over", "mu=1/10..1000", "--tries", "14"], 0);
    assert_eq!(report["before"], serde_json::json!({ "verdict": "undecided" }));
    assert!(number(&report["after"]["sigma_star"]) < 18.0, "{report}");
    // What only the regulator in continuous time has.
    assert!(report["after"]["feedback"].is_null() && report["after"]["error"].is_null(), "{report}");
    assert!(report["sentence"].as_str().unwrap().contains("With the values of the file the verdict is undecided"));
    assert!(report["tries"]["without_claim"]["undecided"].as_u64() > Some(0), "{report}");
}

/// A gain of some millions, for a mu that is far too small on so small a domain.
#[test]
fn bad_values_to_start_from_are_left_behind() {
    let spec = EXAMPLE_TEXT
        .replace(r#""X": "10", "E": "10""#, r#""X": "1/10", "E": "1/10""#)
        .replace("\"mu\": \"1\"", "\"mu\": \"1/1000\"");
    let report = tune(&spec, &["--over", "mu=1/1000..100", "--tries", "30"], 0);
    assert_eq!(report["before"]["sigma_star"], "7616930");
    assert!(number(&report["after"]["sigma_star"]) < 4000.0, "{report}");
    // Not "100 % less".
    assert!(
        report["sentence"].as_str().unwrap().contains("about 0.0388 % of what it was, down from 7617000"),
        "{report}"
    );
}

/// Points at which nothing is certified are counted, and are never the best: n0 <= n1 is refused.
#[test]
fn refused_proposals_are_infinitely_bad() {
    let report = tune(EXAMPLE_TEXT, &["--over", "n0=1/10..10", "--tries", "24"], 0);
    let refused = report["tries"]["without_claim"]["bad-input"].as_u64().expect("some are refused");
    assert!(refused > 2, "{report}");
    let after = &report["parameters"][0]["after"];
    assert!(after.is_null() || number(after) > 1.0, "{report}");
    let counted = refused + report["tries"]["certified"].as_u64().unwrap();
    assert!(counted < 24, "{report}");
}

#[test]
fn a_value_at_an_end_of_its_range_is_told() {
    let report = tune(EXAMPLE_TEXT, &["--over", "mu=1/2..2", "--tries", "16"], 0);
    assert_eq!(report["parameters"][0]["after"], "2", "{report}");
    assert!(report["remarks"].to_string().contains("at an end of its range, which may decide more"), "{report}");
}

#[test]
fn nothing_better_is_said_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("tuned.json");
    let spec = EXAMPLE_TEXT.replace("\"mu\": \"1\"", "\"mu\": \"2\"");
    let mut command = program();
    // In this range sigma* only grows.
    command.args(["tune", "-", "--over", "mu=1/10..2", "--tries", "20", "-o"]).arg(&file).write_stdin(spec);
    let output =
        command.assert().code(0).stdout(contains("Nothing better was found than the values of the file, mu = 2,"));
    output.stderr(contains("was not written: nothing better was found"));
    assert!(!file.exists());
}

#[test]
fn the_bound_of_the_error_is_a_goal_with_a_warning() {
    let arguments = ["--over", "mu", "--error-at", "3", "--tries", "16"];
    let report = tune(EXAMPLE_TEXT, &arguments, 0);
    let sup = |of: &str| number(&report[of]["error"]["sup"]);
    assert!(sup("after") < sup("before"), "{report}");
    // Through the gain alone.
    assert!(number(&report["after"]["sigma_star"]) > number(&report["before"]["sigma_star"]));
    assert!(report["remarks"].to_string().contains("at one gain"), "{report}");
    let free = EXAMPLE_TEXT.replace("\"matched\": true", "\"matched\": false");
    let mut command = program();
    command.args(["tune", "-", "--error-at", "3"]).write_stdin(free);
    command.assert().code(2).stderr(contains("no error is certified"));
}

#[test]
fn wrong_names_and_ranges_are_told() {
    for (over, said) in [
        ("mi", "did you mean `mu`?"),
        ("mu,epsilonn", "did you mean `epsilon`?"),
        ("alpha", "the free numbers are mu, n0, epsilon"),
        ("base_frequency=5..7", "the base frequency is not free"),
        ("mu=1..1", "is no range for `mu`"),
    ] {
        let call = ["tune", EXAMPLE, "--over", over];
        program().args(call).assert().code(2).stdout(is_empty()).stderr(contains(said));
    }
    program().args(["tune", EXAMPLE, "--tries", "1"]).assert().code(2).stderr(contains("2..=10000"));
    let both = ["tune", EXAMPLE, "--minimise", "feedback", "--error-at", "1"];
    program().args(both).assert().code(2).stderr(contains("cannot be used with"));
    let call = ["tune", "-", "--minimise", "feedback"];
    program()
        .args(call)
        .write_stdin(at_rest_at_samples("1/1000"))
        .assert()
        .code(2)
        .stderr(contains("only the gain itself is tuned"));
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let written = |threads: &str| {
        let mut command = program();
        command.env("RAYON_NUM_THREADS", threads);
        command.args(["tune", EXAMPLE, "-q", "--over", "mu,n0,epsilon", "--tries", "40", "--format", "json"]);
        utf8(command.assert().code(0).get_output().stdout.clone())
    };
    assert_eq!(written("1"), written("2"));
}

/// The shipped specification of the law at samples this far apart.
fn at_rest_at_samples(step: &str) -> String {
    let sampled = format!("\"matched\": true, \"sampling_period\": \"{step}\",");
    specification_text("paper-example-rms-at-rest").replace("\"matched\": true,", &sampled)
}

#[test]
fn a_plant_is_tuned_too() {
    let plant = fs::read_to_string(Path::new(ROOT).join("specs/plants/linear.json")).unwrap();
    let report = tune(&plant, &["--over", "mu", "--minimise", "feedback", "--tries", "6"], 0);
    let [before, after] = ["before", "after"].map(|name| number(&report[name]["feedback"]));
    assert!(after < before, "{report}");
}
