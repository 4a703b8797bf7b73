//! `sigmastar certify`: exit codes, streams, flags and files.

use crate::support::{EXAMPLE, EXAMPLE_TEXT, json, process, program, refuted_witness, specification_text};
use assert_cmd::Command;
use predicates::prelude::*;
use predicates::str::{contains, is_empty, starts_with};
use serde_json::Value;
use std::fs;
use tempfile::TempDir;

fn certify(args: &[&str]) -> Command {
    let mut command = program();
    command.arg("certify").args(args);
    command
}

/// The example with one line replaced.
fn example_with(field: &str, line: &str) -> String {
    let start = format!("\"{field}\":");
    assert!(EXAMPLE_TEXT.lines().any(|l| l.trim_start().starts_with(&start)), "{field}");
    EXAMPLE_TEXT
        .lines()
        .map(|l| if l.trim_start().starts_with(&start) { line } else { l })
        .collect::<Vec<_>>()
        .join("\n")
}

#[test]
fn certified_is_0_with_data_on_standard_output_only() {
    certify(&[EXAMPLE])
        .assert()
        .code(0)
        .stdout(starts_with("Example of the paper: certified\n").and(contains("Certified: with sigma = ")))
        .stdout(contains('\u{1b}').not())
        .stderr("sigmastar: this is the short form; `--full` shows the whole report\n");
    certify(&[EXAMPLE, "--full"]).assert().code(0).stdout(contains("Exact regulation")).stderr(is_empty());
}

#[test]
fn a_witness_that_breaks_a_condition_is_refuted() {
    certify(&[EXAMPLE, "--witness", refuted_witness()])
        .assert()
        .code(1)
        .stdout(contains("Refuted: no sigma is certified here; condition C4 is refuted for this witness"));
}

#[test]
fn what_the_paper_prints_is_refuted_beside_the_claim() {
    certify(&[EXAMPLE, "--full"]).assert().code(0).stdout(contains("P:eq:boundx_bounde_1").and(contains("81 <= ")));
}

#[test]
fn a_refuted_bounding_function_is_shown_in_its_place() {
    certify(&["specs/invalid/decreasing-bound.json"])
        .assert()
        .code(2)
        .stdout(is_empty())
        .stderr(contains("--> specs/invalid/decreasing-bound.json:12:").and(contains("X = 0, E = ")));
}

#[test]
fn an_undecided_bounding_function_claims_nothing() {
    let input = example_with("f_ex", r#""f_ex": "sin(X)^2 + cos(X)^2","#);
    let assert = certify(&["-", "--target-sup", "1"]).write_stdin(input.clone()).assert().code(3);
    assert
        .stdout(contains("Undecided: ").and(contains("f_ex")).and(contains("The targets are not answered")))
        .stderr(contains("error[undecided]").and(contains("<stdin>:")));
    let output = certify(&["-", "--format", "json"]).write_stdin(input).assert().code(3).stderr(is_empty());
    let report = json(&output.get_output().stdout);
    assert_eq!(report["errors"][0]["pointer"], "/bounds/f_ex");
    assert_eq!(report["sigma_star"], Value::Null);
}

#[test]
fn an_initial_set_that_is_too_large_is_undecided() {
    let input = example_with("initial_set", r#""initial_set": { "kind": "box", "X0": "100", "E0": "1", "Z0": "1" }"#);
    certify(&["-"])
        .write_stdin(input)
        .assert()
        .code(3)
        .stdout(contains("What to try:").and(contains("a larger domain than X = 10, E = 10")));
}

#[test]
fn an_unstable_filter_is_bad_input() {
    let text = specification_text("relative-degree-4");
    let start = text.find("\"relative_degree\"").expect("it has one");
    let input = format!("{}\"relative_degree\": {{ \"a\": [10, 1, 1] }}\n}}", &text[..start]);
    certify(&["-"]).write_stdin(input).assert().code(2).stderr(contains("not Hurwitz").and(contains("Routh")));
}

#[test]
fn files_that_cannot_be_read() {
    certify(&["no-such-file.json"])
        .assert()
        .code(2)
        .stdout(is_empty())
        .stderr(contains("cannot read `no-such-file.json`: there is no such file").and(contains("help")));
    certify(&["specs"]).assert().code(2).stderr(contains("cannot read `specs`: it is a folder"));
    certify(&[EXAMPLE, "--witness", "no-such-file.json"]).assert().code(2).stderr(contains("no-such-file.json"));
    let output = certify(&["no-such-file.json", "--format", "json"]).assert().code(2);
    let report = json(&output.get_output().stdout);
    assert_eq!(report["verdict"], "bad-input");
    assert!(report["errors"][0]["message"].as_str().is_some_and(|m| m.contains("no-such-file.json")));
    assert!(report["errors"][0]["help"].is_string());
}

#[test]
fn standard_input_is_read() {
    certify(&["-"]).write_stdin(EXAMPLE_TEXT).assert().code(0).stdout(contains("Certified"));
    certify(&["-"]).write_stdin("").assert().code(2).stderr(contains("<stdin>"));
    certify(&["-"]).write_stdin(vec![0xff, 0xfe]).assert().code(2).stderr(contains("UTF-8"));
}

#[test]
fn wrong_calls_are_2_with_a_suggestion() {
    certify(&[EXAMPLE, "--transfer", "boxs"]).assert().code(2).stderr(contains("'boxes'"));
    certify(&[EXAMPLE, "--fromat", "json"]).assert().code(2).stderr(contains("'--format'"));
    program().arg("certfy").assert().code(2).stderr(contains("'certify'"));
    program().assert().code(2);
    certify(&[]).assert().code(2);
    for bits in ["127", "4097", "-1", "many"] {
        certify(&[EXAMPLE, &format!("--precision-limit={bits}")]).assert().code(2).stdout(is_empty());
    }
    certify(&[EXAMPLE, "--witness", EXAMPLE, "--transfer", "best"]).assert().code(2);
    certify(&[EXAMPLE, "--witness", EXAMPLE]).assert().code(2).stderr(contains("cannot be the same file"));
}

#[test]
fn targets_are_exact_constants() {
    certify(&[EXAMPLE, "--target-sup", "1e-3", "--target-rms", "1/1000"])
        .assert()
        .code(0)
        .stdout(contains("Target sup|e| <= 1e-3: certified with n_o = "))
        .stdout(contains("Target rms(e) <= 1/1000: certified with n_o = "));
    for (value, reason) in [("-1", "must be positive"), ("0", "must be positive"), ("1//2", "unexpected"), ("", "")] {
        certify(&[EXAMPLE, &format!("--target-sup={value}")]).assert().code(2).stderr(contains(reason));
    }
    certify(&[EXAMPLE, "--target-rms", "sin(pi)"]).assert().code(3);
    let report = certify(&[EXAMPLE, "--target-sup", "1e-40", "--format", "json", "--no-alternatives"]).assert().code(0);
    assert_eq!(json(&report.get_output().stdout)["consequences"]["targets"][0]["answer"], "not reached");
}

#[test]
fn unmatched_frequencies_are_told_honestly() {
    let input = EXAMPLE_TEXT.replace("\"matched\": true", "\"matched\": false").replace("\"2*pi\"", "\"2*pi*1.01\"");
    let words = "not certified with any number of oscillators";
    certify(&["-", "--target-sup", "1e-3", "--full"]).write_stdin(input).assert().code(0).stdout(
        contains(words).and(contains("An oscillator pays up to")).and(contains("Not used: that the base frequency")),
    );
}

#[test]
fn the_certificate_is_written_and_its_witness_decided_again() {
    let folder = TempDir::new().expect("a temporary folder");
    let path = folder.path().join("certificate.json");
    let name = path.to_str().expect("plain");
    certify(&[EXAMPLE, "-o", name]).assert().code(0).stderr(contains(format!("the certificate is in `{name}`")));
    let text = fs::read_to_string(&path).expect("written");
    let certificate = json(text.as_bytes());
    assert_eq!(certificate["format"], "sigmastar/certificate");
    assert_eq!(certificate["claim"]["verdict"], "certified");
    assert!(!text.contains(name) && !text.contains(EXAMPLE), "no paths");
    assert_eq!(fs::read_dir(folder.path()).expect("readable").count(), 1, "no temporary file stays");

    certify(&[EXAMPLE, "-o", name, "--quiet", "--force"]).assert().code(0).stderr(is_empty());
    assert_eq!(fs::read_to_string(&path).expect("written"), text, "the same bytes");

    let again = certify(&[EXAMPLE, "--witness", name, "--format", "json"]).assert().code(0);
    assert_eq!(json(&again.get_output().stdout)["sigma_star"], certificate["claim"]["sigma_star"]);

    let other = certify(&["specs/paper-example-rms.json", "--witness", name]).assert();
    other.stderr(contains("made for another specification"));

    // A smaller sigma than the certified one is not believed.
    let sigma = certificate["claim"]["sigma_star"].as_str().expect("a string").to_owned();
    fs::write(&path, text.replace(&format!("\"sigma_star\": \"{sigma}\""), "\"sigma_star\": \"1\"")).expect("written");
    certify(&[EXAMPLE, "--witness", name]).assert().code(predicate::in_iter([1, 3])).stdout(contains("is refuted"));
    fs::write(&path, "{}").expect("written");
    certify(&[EXAMPLE, "--witness", name]).assert().code(2).stderr(contains("missing"));
}

#[test]
fn nothing_is_written_without_a_certificate() {
    let folder = TempDir::new().expect("a temporary folder");
    let path = folder.path().join("certificate.json");
    let name = path.to_str().expect("plain");
    certify(&[EXAMPLE, "--witness", refuted_witness(), "-o", name])
        .assert()
        .code(1)
        .stderr(contains("was not written: the verdict is refuted"));
    certify(&["specs/invalid/empty.json", "-o", name]).assert().code(2);
    assert!(!path.exists());
    let nowhere = folder.path().join("nowhere/certificate.json");
    certify(&[EXAMPLE, "-o", nowhere.to_str().expect("plain")])
        .assert()
        .code(2)
        .stdout(is_empty())
        .stderr(contains("there is no folder"));
    certify(&[EXAMPLE, "-o", folder.path().to_str().expect("plain")]).assert().code(2).stderr(contains("a folder"));
    certify(&[EXAMPLE, "-o", "-"]).assert().code(2).stderr(contains("standard output"));
    fs::write(&path, EXAMPLE_TEXT).expect("written");
    certify(&[name, "-o", name]).assert().code(2).stderr(contains("the specification itself"));
    assert_eq!(fs::read_to_string(&path).expect("kept"), EXAMPLE_TEXT);
}

#[test]
fn the_same_bytes_with_any_number_of_threads() {
    let folder = TempDir::new().expect("a temporary folder");
    let file = folder.path().join("certificate.json");
    let run = |spec: &str, threads: &str, format: &str| {
        let mut call = certify(&[spec, "--format", format, "--force", "-o"]);
        let report = call.arg(&file).env("RAYON_NUM_THREADS", threads).assert().code(0).get_output().stdout.clone();
        (report, fs::read(&file).expect("written"))
    };
    for format in ["text", "markdown", "json"] {
        assert_eq!(run(EXAMPLE, "1", format), run(EXAMPLE, "2", format), "{format}");
    }
    assert_eq!(run(EXAMPLE, "2", "json"), run(EXAMPLE, "2", "json"));
    assert_eq!(run("specs/linear.json", "1", "json"), run("specs/linear.json", "5", "json"));
}

#[cfg(unix)]
#[test]
fn a_closed_pipe_is_no_failure() {
    use std::process::Stdio;
    let mut child = process()
        .args(["certify", EXAMPLE, "--no-alternatives"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(0));
    let remark = "sigmastar: this is the short form; `--full` shows the whole report\n";
    assert_eq!(String::from_utf8_lossy(&output.stderr), remark);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told() {
    let full = fs::OpenOptions::new().write(true).open("/dev/full").expect("Linux has it");
    let output =
        process().args(["certify", EXAMPLE, "--no-alternatives"]).stdout(full).output().expect("the program runs");
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("no space is left"));
}

#[test]
fn errata_are_listed() {
    program().arg("errata").assert().code(0).stdout(contains("E1 [A]")).stderr(is_empty());
    let assert = program().args(["errata", EXAMPLE, "--format", "json"]).assert().code(0);
    assert!(json(&assert.get_output().stdout)["errata"][0]["for_data"].is_object());
    program().args(["errata", "specs/invalid/empty.json"]).assert().code(2).stdout(is_empty());
}

#[test]
fn pages_are_made_from_the_flags() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = program().args(["completions", shell]).assert().code(0).stderr(is_empty());
        script.stdout(contains("target-rms"));
    }
    program().args(["completions", "csh"]).assert().code(2);
    program().arg("man").assert().code(0).stdout(contains(".TH sigmastar 1").and(contains("precision\\-limit")));
    for flag in ["--help", "-h", "--version"] {
        program().arg(flag).assert().code(0).stderr(is_empty());
    }
    program().args(["certify", "--help"]).assert().code(0).stdout(contains("Exit codes:"));
}
