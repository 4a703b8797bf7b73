//! Certificates as they are written today, read by the independent checker; and the command `check`.

use crate::agreement::assert_agrees;
use crate::support::{program, refuted_witness, specification, specification_text};
use predicates::prelude::*;
use predicates::str::{contains, ends_with, is_empty, starts_with};
use serde_json::Value;
use sigmastar_lang::spec::Specification;
use sigmastar_prove::certificate::certificate_json;
use sigmastar_prove::certify::{Options, TransferChoice, certify};

/// The certificate of a shipped specification.
fn certificate(name: &str, options: Options) -> Value {
    certificate_json(&certify(&specification(name), options).unwrap()).expect("it certifies")
}

fn is_valid(name: &str, options: Options) {
    let certificate = certificate(name, options);
    let report = proofs_check::check(certificate.to_string().as_bytes());
    assert!(report.is_valid(), "{name}: {}", report.text(false));
    assert_agrees(&certificate);
}

#[test]
fn fresh_certificates_are_valid() {
    for name in
        ["linear", "no-x", "explicit-weights", "short-period", "pendulum", "pendulum-modal", "relative-degree-2"]
    {
        is_valid(name, Options::default());
    }
    let with = |transfer| Options { transfer, compare: false, ..Options::default() };
    is_valid("linear", with(TransferChoice::Boxes));
    is_valid("ill-conditioned", with(TransferChoice::ClosedForm));
}

#[test]
fn numbers_reach_the_checker_as_they_are_written() {
    let text =
        specification_text("linear").replace("\"q_x\": 1", "\"q_x\": 1E0").replace("\"f_xx\": 0", "\"f_xx\": 0.0e+05");
    assert!(text.contains("1E0") && text.contains("0.0e+05"));
    let spec = Specification::from_json("test", &text).unwrap();
    let options = Options { compare: false, ..Options::default() };
    let certificate = certificate_json(&certify(&spec, options).unwrap()).unwrap().to_string();
    assert!(certificate.contains("1E0") && certificate.contains("0.0e+05"));
    let report = proofs_check::check(certificate.as_bytes());
    assert!(report.is_valid(), "{}", report.text(false));
}

#[test]
fn bounds_that_all_but_vanish_are_written_so_that_they_are_read() {
    let spec: serde_json::Value = serde_json::from_str(&specification_text("paper-example")).unwrap();
    for small in ["exp(-1e12)", "exp(-1e4)", "exp(-2e3)*X"] {
        let mut spec = spec.clone();
        spec["bounds"]["f_e"] = small.into();
        let spec = Specification::from_json("test", &spec.to_string()).unwrap();
        let options = Options { compare: false, ..Options::default() };
        let certificate = certificate_json(&certify(&spec, options).unwrap()).expect("it certifies").to_string();
        let report = proofs_check::check(certificate.as_bytes());
        assert!(report.is_valid(), "{small}: {}", report.text(false));
    }
}

#[test]
fn the_command() {
    let valid = "proofs-check/tests/certificates/paper-example.sharp.json";
    let forged = refuted_witness();
    program().args(["check", valid]).assert().code(0).stdout(starts_with("valid\n")).stderr(is_empty());
    let own = ["check", valid, "--spec", "specs/paper-example.json"];
    program().args(own).assert().code(0).stdout(contains("proved:  For every"));
    let other = ["check", valid, "--spec", "specs/paper-example-rms.json"];
    program().args(other).assert().code(1).stdout(contains("/specification/bounds/q_rms"));
    program().args(["check", valid, "--spec", "nowhere.json"]).assert().code(2).stderr(contains("nowhere.json"));
    program().args(["check", valid, "--verbose"]).assert().code(0).stdout(contains("C5b holds"));
    program().args(["check", forged]).assert().code(1).stdout(contains("invalid")).stdout(contains("C4"));
    program().args(["check", forged, "--format", "json"]).assert().code(1).stdout(contains("\"field\": \"/witness\""));
    let markdown = ["check", forged, "--format", "markdown"];
    program().args(markdown).assert().code(1).stdout(starts_with("```text\ninvalid").and(ends_with("\n```\n")));
    program().args(["check", "specs/linear.json"]).assert().code(2).stdout(contains("bad-input"));
    program().args(["check", "-"]).write_stdin("{").assert().code(2).stdout(contains("not JSON"));
    program().args(["check", "nowhere.json"]).assert().code(2).stdout(is_empty()).stderr(contains("nowhere.json"));
}

/// A sampling period that came from a flag of `certify` is given to `check` in the same way.
#[test]
fn the_sampling_period_of_a_flag_is_compared() {
    const SPEC: &str = "specs/paper-example-rms-at-rest.json";
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("certificate.json");
    let certify = ["certify", "-q", SPEC, "--sampling-period", "1/1000", "--sigma", "25", "-o"];
    program().args(certify).arg(&file).assert().success();
    let check = |more: &[&str]| {
        let mut command = program();
        command.arg("check").arg(&file).args(more).assert()
    };
    check(&["--spec", SPEC, "--sampling-period", "1/1000"]).code(0);
    // The same number in other words is another text, and no flag is no sampling period.
    let hint = || contains("about the sampling period 1/1000").and(contains("certify --sampling-period 1/1000"));
    for other in [&["--spec", SPEC][..], &["--spec", SPEC, "--sampling-period", "1/500"]] {
        check(other).code(1).stderr(hint());
    }
    // Where the specification itself is another one, nothing is said of samples.
    let other = ["--spec", "specs/linear.json", "--sampling-period", "1/1000"];
    check(&other).code(1).stderr(contains("sampling period").not());
    check(&["--spec", SPEC, "--sampling-period", "-1"]).code(2).stderr(contains("must be positive"));
    check(&["--sampling-period", "1/1000"]).code(2).stderr(contains("--spec"));
}
