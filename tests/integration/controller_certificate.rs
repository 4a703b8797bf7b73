//! `controller` with a certificate: the gain it certifies, its claim in the export, and what it does not cover.

use crate::controller::controller;
use crate::support::{json, program, specification, utf8};
use predicates::prelude::*;
use sigmastar_lang::spec::Document;
use std::path::{Path, PathBuf};

fn certificate(folder: &Path, spec: &str) -> PathBuf {
    let file = folder.join("certificate.json");
    program().args(["certify", spec, "--no-alternatives", "-q", "-o"]).arg(&file).assert().success();
    file
}

#[test]
fn a_certificate_says_everything_but_the_oscillators() {
    let folder = tempfile::tempdir().unwrap();
    let file = certificate(folder.path(), "specs/linear.json");
    let text = std::fs::read_to_string(&file).unwrap();
    let document = Document::parse("certificate", &text).unwrap();
    let (digest, held) = (document.root().sha256(), json(text.as_bytes()));
    let call = ["--n-o", "2", "--discretise", "1/100"];
    let path = file.to_str().unwrap();
    let remark = "does not cover sampling; `certify --sampling-period 1/100` makes one";
    let assert = controller(&[path]).args(call).assert().success().stderr(predicate::str::contains(remark));
    controller(&[path, "--n-o", "2", "-q"]).assert().success().stderr("");
    let export = json(&assert.get_output().stdout);
    assert_eq!(export["name"].as_str().unwrap(), specification("linear").name);
    assert_eq!(export["certificate"]["sha256"].as_str(), Some(digest.as_str()));
    assert_eq!(export["certificate"]["covers_sigma"].as_bool(), Some(true));
    for field in ["sigma_star", "statement"] {
        assert_eq!(export["certificate"][field], held["claim"][field]);
    }
    // The gain is sigma* or the next double above.
    let sigma = rug::Rational::from_f64(export["sigma"].as_f64().unwrap()).unwrap();
    let star = sigmastar_exact::number::parse_decimal(held["claim"]["sigma_star"].as_str().unwrap()).unwrap();
    assert!(sigma >= star && rug::Rational::from(&sigma - &star) < rug::Rational::from((1, 1_u64 << 50)));
    // The same regulator as from the specification.
    let from_spec =
        controller(&["specs/linear.json", "--certificate", path, "--sigma", &sigma.to_string()]).args(call).assert();
    assert_eq!(json(&from_spec.success().get_output().stdout), export);
    // Standard input, and a gain of one's own.
    let assert = controller(&["-", "--sigma", "3"]).args(call).write_stdin(text.clone()).assert().success();
    assert_eq!(json(&assert.get_output().stdout)["sigma"].as_f64(), Some(3.0));

    let statement = held["claim"]["statement"].as_str().unwrap();
    let sampling = "The certificate is about the continuous-time law. It does not cover sampling.";
    let told = |text: &str, mark: &str| {
        let text: Vec<&str> = text.lines().map(|line| line.trim().trim_start_matches(mark).trim()).collect();
        let text = text.join(" ");
        assert!([statement, sampling, &digest].iter().all(|words| text.contains(words)), "{text}");
    };
    let matlab = controller(&[path, "--format", "matlab"]).args(call).assert().success();
    told(&utf8(matlab.get_output().stdout.clone()), "%");
    let source = folder.path().join("regulator.c");
    controller(&[path, "--format", "c", "-o"]).arg(&source).args(call).assert().success();
    told(&std::fs::read_to_string(source.with_extension("h")).unwrap(), "*");
    let archive = folder.path().join("regulator.npz");
    controller(&[path, "--format", "npz", "-o"]).arg(&archive).args(call).assert().success();
    told(&utf8(crate::controller::array(&archive, "notice").2), "");
    // It is no file that may be overwritten.
    controller(&[path, "-o", path]).args(call).assert().code(2);
    assert_eq!(std::fs::read_to_string(&file).unwrap(), text);
}

#[test]
fn a_gain_below_the_certificate_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = certificate(folder.path(), "specs/linear.json");
    let file = file.to_str().unwrap();
    let call = |spec: &str, sigma: &str, more: &[&str]| {
        controller(&[&[spec, "--sigma", sigma, "--n-o", "1", "--certificate", file], more].concat()).assert()
    };
    let low = "sigma is below sigma* = 1.32";
    call("specs/linear.json", "13/10", &[])
        .code(2)
        .stderr(predicate::str::contains(low).and(predicate::str::contains("--uncertified")));
    let assert = controller(&[file, "--sigma", "13/10", "--n-o", "1"]).assert();
    assert.code(2).stdout("").stderr(predicate::str::contains(low));
    let assert = call("specs/linear.json", "13/10", &["--uncertified"]).success().stderr(predicate::str::contains(low));
    let export = json(&assert.get_output().stdout);
    assert_eq!(export["certificate"]["covers_sigma"].as_bool(), Some(false));
    let notice = export["notice"].to_string();
    assert!(notice.contains("says nothing about this regulator") && !notice.contains("Its claim"), "{notice}");
    call("specs/linear.json", "3/2", &["-q"]).success().stderr("");
    // One that is about something else is refused, or left out.
    let other = "made for another specification: it says nothing about this regulator";
    call("specs/no-x.json", "13/10", &[]).code(2).stdout("").stderr(predicate::str::contains(other));
    let assert = call("specs/no-x.json", "13/10", &["--uncertified"]).success();
    let assert = assert.stderr(predicate::str::contains(other));
    assert!(json(&assert.get_output().stdout)["certificate"].is_null());
}

#[test]
fn certificates_that_do_not_hold_together_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = certificate(folder.path(), "specs/linear.json");
    let text = std::fs::read_to_string(&file).unwrap();
    let path = file.to_str().unwrap();
    let assert = controller(&[path, "--certificate", path, "--n-o", "1"]).assert();
    assert.code(2).stderr(predicate::str::contains("two certificates"));
    let changed = |from: &str, to: &str, message: &str| {
        let changed = text.replacen(from, to, 1);
        assert_ne!(changed, text);
        let assert = controller(&["-", "--n-o", "1"]).write_stdin(changed).assert();
        assert.code(2).stdout("").stderr(predicate::str::contains(message));
    };
    changed("\"specification\":", "\"no_plant\":", "embeds neither");
    let spec_mu = "\"internal_model\": {";
    changed(spec_mu, &format!("{spec_mu} \"surplus\": 1,"), "surplus");
    changed("Linear zero dynamics", "Other dynamics", "not the one that its digest is of");
}
