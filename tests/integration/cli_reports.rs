//! Reports as users see them, held against reviewed copies in `tests/integration/snapshots`.

use crate::support::{program, utf8};
use insta::assert_snapshot;

/// What `sigmastar certify` writes to both streams, and its exit code.
fn shown(args: &[&str]) -> String {
    let output = program().arg("certify").args(args).output().expect("the program runs");
    format!(
        "exit code {}\n--- standard output\n{}--- standard error\n{}",
        output.status.code().map_or_else(|| "none".to_owned(), |code| code.to_string()),
        utf8(output.stdout),
        utf8(output.stderr)
    )
}

/// Tables and sentences fit a terminal of 100 columns.
fn fits(report: &str) {
    for line in report.lines() {
        assert!(line.chars().count() <= 100, "{line}");
    }
}

#[test]
fn paper_example() {
    let report = shown(&["specs/paper-example.json", "--target-sup", "1e-3", "--target-rms", "1/1000"]);
    fits(&report);
    assert_snapshot!("text-paper-example", report);
    assert_snapshot!("markdown-paper-example", shown(&["specs/paper-example.json", "--format", "markdown"]));
}

#[test]
fn other_derivations() {
    let report = shown(&["specs/paper-example.json", "--derivation", "printed"]);
    fits(&report);
    assert_snapshot!("text-paper-example-printed", report);
    let report = shown(&["specs/paper-example-at-rest.json", "--derivation", "repaired", "--no-compare"]);
    fits(&report);
    assert_snapshot!("text-at-rest-repaired", report);
}

#[test]
fn other_plants() {
    for (name, snapshot) in
        [("no-x", "text-no-x"), ("linear", "text-linear"), ("ill-conditioned", "text-ill-conditioned")]
    {
        let report = shown(&[&format!("specs/{name}.json")]);
        fits(&report);
        assert_snapshot!(snapshot, report);
    }
}

#[test]
fn refusals() {
    for name in ["decreasing-bound", "negative-bound", "matched-undecided", "misspelt-field"] {
        let path = format!("specs/invalid/{name}.json");
        assert_snapshot!(format!("refused-{name}"), shown(&[&path]));
    }
    assert_snapshot!("refused-json", shown(&["specs/invalid/decreasing-bound.json", "--format", "json"]));
    assert_snapshot!("refused-missing-file", shown(&["specs/papr-example.json"]));
    assert_snapshot!("refused-target", shown(&["specs/paper-example.json", "--target-sup", "1/0"]));
}
