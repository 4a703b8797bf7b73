//! Every file of `specs/` with the verdict of `sigmastar certify` on it.

use crate::support::{files, json, program, stem};
use std::collections::BTreeSet;

const CERTIFIED: [&str; 19] = [
    "damped",
    "explicit-weights",
    "ill-conditioned",
    "linear",
    "motor-axis",
    "motor-axis-friction",
    "no-x",
    "paper-example",
    "paper-example-at-rest",
    "paper-example-harmonics-at-rest",
    "paper-example-jacobian",
    "paper-example-rms",
    "paper-example-rms-at-rest",
    "pendulum",
    "pendulum-modal",
    "pendulum-scaled",
    "relative-degree-2",
    "relative-degree-4",
    "short-period",
];

const BAD_INPUT: [&str; 42] = [
    "bad-expression",
    "bad-family",
    "bad-kind",
    "decreasing-bound",
    "decreasing-one-sided",
    "duplicate-key",
    "empty",
    "escaped-text",
    "exponent-too-large",
    "foreign-field",
    "half-a-domain",
    "increasing-rate",
    "irrational-coefficient",
    "jacobian",
    "many-errors",
    "missing-field",
    "misspelt-field",
    "negative-bound",
    "negative-harmonic",
    "negative-initial-set",
    "negative-period",
    "no-tail",
    "no-value",
    "not-json",
    "not-matched",
    "p-order",
    "rate-beside-jacobian",
    "too-deep",
    "trailing-comma",
    "unknown-field",
    "unknown-function",
    "unquoted-escape",
    "variable-in-constant",
    "weights-epsilon",
    "weights-junction",
    "weights-n0",
    "weights-w2",
    "weights-w3",
    "wrong-format",
    "wrong-type",
    "wrong-version",
    "zero-alpha",
];

/// Specifications in which a condition can be neither proved nor refuted.
const UNDECIDED: [&str; 3] = ["matched-undecided", "undecided-sign", "weights-undecided"];

fn listed(names: &[&str]) -> BTreeSet<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

fn present(folder: &str) -> BTreeSet<String> {
    files(folder).iter().map(|path| stem(path).to_owned()).collect()
}

/// The verdict in the JSON report agrees with the exit code, and with what is expected.
fn verdict_is(path: &str, word: &str, code: i32) {
    let output = program().args(["certify", path, "--format", "json", "--quiet"]).output().expect("the program runs");
    assert_eq!(output.status.code(), Some(code), "{path}");
    let report = json(&output.stdout);
    assert_eq!(report["verdict"], word, "{path}");
    assert_eq!(report["format"], "sigmastar/report", "{path}");
    assert_eq!(report["version"], 1, "{path}");
    assert!(output.stderr.is_empty(), "{path}: {}", String::from_utf8_lossy(&output.stderr));
    if code != 0 {
        let first = &report["errors"][0];
        assert!(first["message"].as_str().is_some_and(|message| !message.is_empty()), "{path}");
        assert!(first["line"].as_u64() >= Some(1) && first["column"].as_u64() >= Some(1), "{path}");
    }
}

#[test]
fn every_specification_is_listed_with_its_verdict() {
    assert_eq!(present("specs"), listed(&CERTIFIED));
    assert_eq!(present("specs/invalid"), &listed(&BAD_INPUT) | &listed(&UNDECIDED));
}

#[test]
fn the_valid_ones_are_certified() {
    CERTIFIED.iter().for_each(|name| verdict_is(&format!("specs/{name}.json"), "certified", 0));
}

#[test]
fn the_invalid_ones_are_refused() {
    BAD_INPUT.iter().for_each(|name| verdict_is(&format!("specs/invalid/{name}.json"), "bad-input", 2));
}

#[test]
fn the_undecided_ones_claim_nothing() {
    UNDECIDED.iter().for_each(|name| verdict_is(&format!("specs/invalid/{name}.json"), "undecided", 3));
}
