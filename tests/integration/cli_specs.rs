//! Every file of `specs/` with the verdict of `sigmastar certify` on it.

use crate::support::{every, files, json, program, stem};
use std::path::Path;

/// Specifications in which a condition can be neither proved nor refuted.
const UNDECIDED: [&str; 3] = ["matched-undecided", "undecided-sign", "weights-undecided"];

/// The verdict in the JSON report agrees with the exit code, and with what is expected.
fn verdict_is(path: &Path, word: &str, code: i32) {
    let output =
        program().args(["certify", "--format", "json", "--quiet"]).arg(path).output().expect("the program runs");
    let path = path.display();
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

/// Of the others `support::certified` says that they are certified.
#[test]
fn the_valid_ones_are_certified() {
    files("specs").iter().step_by(every(4)).for_each(|path| verdict_is(path, "certified", 0));
}

/// Which ones there are, and what is wrong with each, stands in `spec_examples.rs`.
#[test]
fn the_invalid_ones_are_refused_or_claim_nothing() {
    let invalid = files("specs/invalid");
    assert!(UNDECIDED.iter().all(|name| invalid.iter().any(|path| stem(path) == *name)));
    for path in &invalid {
        let (word, code) = if UNDECIDED.contains(&stem(path)) { ("undecided", 3) } else { ("bad-input", 2) };
        verdict_is(path, word, code);
    }
}
