//! A certificate in the place of the specification or plant that it embeds.

use crate::support::{ROOT, json, program, sigmastar, utf8};
use predicates::prelude::*;
use predicates::str::{contains, is_empty};
use serde_json::Value;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const SPECIFICATION: &str = "specs/linear.json";
const OF_SPECIFICATION: &str = "proofs-check/tests/certificates/linear.sharp.json";

/// The certificate of a shipped plant, made once for a test.
fn of_plant(folder: &TempDir, name: &str, flags: &[&str]) -> (String, Value) {
    let path = folder.path().join(format!("{name}.certificate.json"));
    let path = path.to_str().expect("a plain name").to_owned();
    let plant = format!("specs/plants/{name}.json");
    sigmastar(&["certify", "-q", "--no-alternatives", "--force", "-o", &path, &plant]).args(flags).assert().code(0);
    let certificate = json(&fs::read(&path).expect("written"));
    (path, certificate)
}

/// A number of oscillators of which the certificate says nothing besides its claim for every one is told; of one with a rate, or with bounds for so many or
/// more, nothing is.
#[test]
fn a_number_of_oscillators_without_a_rate_and_bounds_is_told() {
    for (file, n_o, is_told) in [
        ("certificates/linear.sharp", "3", true),
        ("rates/paper-example-at-rest", "2", false),
        ("rates/paper-example-at-rest", "3", true),
        ("rates/by-n-o-trials", "7", false),
    ] {
        let file = format!("proofs-check/tests/{file}.json");
        let call = sigmastar(&["controller", &file, "--n-o", n_o]).assert().code(0);
        let told = utf8(call.get_output().stderr.clone());
        let said =
            format!("covers n_o = {n_o}, but the certificate has no rate and no bounds for this number of oscillators");
        assert_eq!(told.contains(&said), is_told, "{file} {n_o}: {told}");
        assert!(!is_told || told.contains(&format!("`certify --n-o {n_o}` seeks them")), "{told}");
    }
    sigmastar(&["controller", OF_SPECIFICATION, "--n-o", "3", "-q"]).assert().code(0).stderr(is_empty());
}

fn stdout(arguments: &[&str]) -> String {
    utf8(sigmastar(arguments).assert().code(0).get_output().stdout.clone())
}

/// What is worked out is what the document itself gives, byte for byte.
#[test]
fn a_certificate_stands_for_its_specification() {
    for command in [
        &["certify", "--no-alternatives", "--full"][..],
        &["transfer", "--n-o", "0,1"],
        &["sampling", "--sampling-period", "1/100"],
        &["tune", "--over", "mu", "--tries", "3"],
        &["errata"],
        &["constants"],
    ] {
        let of = |file: &str| stdout(&[command, &[file]].concat());
        assert_eq!(of(OF_SPECIFICATION), of(SPECIFICATION), "{command:?}");
    }
    let remark = contains(
        "makes a new claim about the specification in the certificate, with the smallest gain that is found; `--sigma ",
    )
    .and(contains("`check` decides the claim of the certificate itself"));
    sigmastar(&["certify", OF_SPECIFICATION]).assert().code(0).stderr(remark);
    let with_a_gain = contains("makes a new claim about the specification in the certificate, with this gain; `check`");
    sigmastar(&["certify", OF_SPECIFICATION, "--sigma", "3"]).assert().code(0).stderr(with_a_gain);
    // Its own numbers, decided again, without a copy of the document beside.
    sigmastar(&["certify", OF_SPECIFICATION, "--witness", OF_SPECIFICATION, "-q"]).assert().code(0).stderr(is_empty());
    sigmastar(&["certify", "-", "--witness", "-"]).assert().code(2).stderr(contains("standard input is read once"));
    // From standard input too, and as what a study varies.
    let text = fs::read(Path::new(ROOT).join(OF_SPECIFICATION)).expect("kept");
    let piped = sigmastar(&["certify", "-", "--no-alternatives", "--full"]).write_stdin(text).assert().code(0);
    assert_eq!(
        utf8(piped.get_output().stdout.clone()),
        stdout(&["certify", "--no-alternatives", "--full", SPECIFICATION])
    );
    let folder = TempDir::new().expect("a folder");
    let results = |subject: &str| {
        let subject = Path::new(ROOT).join(subject);
        let study = format!(
            r#"{{ "format": "sigmastar/study", "version": 1, "name": "n", "subject": {subject:?}, "design": "grid",
               "parameters": [{{ "pointer": "/lyapunov/alpha", "values": ["1/2", "1"] }}] }}"#
        );
        let file = folder.path().join("study.json");
        let results = folder.path().join("results.csv");
        fs::write(&file, study).expect("written");
        program().args(["sweep", "-q"]).arg(&file).arg("-o").arg(&results).assert().code(0);
        let text = fs::read_to_string(&results).expect("written");
        fs::remove_file(&results).expect("removed");
        text
    };
    assert_eq!(results(OF_SPECIFICATION), results(SPECIFICATION));
}

#[test]
fn what_makes_no_sense_of_a_certificate_is_refused() {
    let folder = TempDir::new().expect("a folder");
    let output = folder.path().join("x.csv");
    let output = output.to_str().expect("a plain name");
    for (arguments, said) in [
        (&["simulate", OF_SPECIFICATION, "--n-o", "1"][..], "`simulate` needs formulas"),
        (&["bound", OF_SPECIFICATION], "`bound` needs formulas"),
        (&["sweep", OF_SPECIFICATION, "-o", output], "expected `sigmastar/study`"),
        (&["certify", OF_SPECIFICATION, "-o", OF_SPECIFICATION, "--force"], "itself"),
        (&["falsify", SPECIFICATION], "is to be certified first"),
        (&["simulate", "specs/plants/linear.json", "--n-o", "1"], "no gain is given"),
    ] {
        sigmastar(arguments).assert().code(2).stdout(is_empty()).stderr(contains(said));
    }
    let other = sigmastar(&["check", OF_SPECIFICATION, "--spec", OF_SPECIFICATION]).assert().code(1);
    other.stderr(contains("--spec takes the specification or plant that you have yourself"));
    // What was changed is not the document that was certified, nor is one without any.
    let kept = json(&fs::read(Path::new(ROOT).join(OF_SPECIFICATION)).expect("kept"));
    let mut changed = kept.clone();
    changed["specification"]["lyapunov"]["alpha"] = "1".into();
    let mut empty = kept;
    empty.as_object_mut().expect("an object").remove("specification");
    for (certificate, said) in [(changed, "is not the one that its digest is of"), (empty, "embeds neither")] {
        for command in ["certify", "transfer", "sampling", "tune", "errata", "lyapunov", "bound"] {
            let call = sigmastar(&[command, "-"]).write_stdin(certificate.to_string()).assert().code(2);
            call.stdout(is_empty()).stderr(contains(said));
        }
    }
}

#[test]
fn a_simulation_takes_the_gain_of_a_certificate() {
    let folder = TempDir::new().expect("a folder");
    let (file, certificate) = of_plant(&folder, "linear", &[]);
    let sigma = certificate["claim"]["sigma_star"].as_str().expect("a gain");
    let plant = "specs/plants/linear.json";
    let (short, other) = (["--n-o", "1", "--periods", "3"], ["--sigma", "3"]);
    let run = |file: &str, more: &[&str]| stdout(&[&["simulate", file][..], &short, more].concat());
    assert_eq!(run(&file, &[]), run(plant, &["--sigma", sigma]));
    assert_eq!(run(&file, &other), run(plant, &other));
    let told = format!("sigma = {sigma}, from the certificate\n");
    sigmastar(&["simulate", &file]).args(short).assert().code(0).stderr(contains(told));
    let quiet = sigmastar(&["simulate", &file, "-q"]).args(short).args(other).assert().code(0);
    quiet.stderr(is_empty());
    // The high gain alone, and a bounding specification, from the plant in it.
    sigmastar(&["simulate", &file, "--high-gain", "--periods", "3"]).assert().code(0);
    assert_eq!(stdout(&["bound", &file]), stdout(&["bound", plant]));
    sigmastar(&["errata", &file]).assert().code(2).stderr(contains("needs a bounding specification"));
}

#[test]
fn a_simulation_takes_the_samples_of_a_certificate() {
    let folder = TempDir::new().expect("a folder");
    let (file, certificate) = of_plant(&folder, "linear", &["--sampling-period", "1/100"]);
    let sigma = certificate["claim"]["sigma"].as_str().expect("a gain");
    let plant = "specs/plants/linear.json";
    let short = ["--n-o", "1", "--periods", "3"];
    let run = |arguments: &[&str]| stdout(&[&["simulate"], arguments, &short].concat());
    assert_eq!(run(&[&file]), run(&[plant, "--sigma", sigma, "--sampled", "1/100"]));
    assert_eq!(run(&[&file, "--sampled", "1/50"]), run(&[plant, "--sigma", sigma, "--sampled", "1/50"]));
    for flag in [&["--high-gain"][..], &["--fixed", "100", "--n-o", "1"], &["--noise-power", "1", "--n-o", "1"]] {
        let call = sigmastar(&["simulate", &file]).args(flag).assert().code(2);
        call.stdout(is_empty()).stderr(contains(format!("{} is of continuous time", flag[0])));
    }
}
