//! Rules on the claim, what no claim rests on, and the program itself.

use crate::common::*;
use proofs_check::verdict::Verdict::{BadInput, Invalid};
use serde_json::json;
use std::process::Command;

#[test]
fn a_claim_says_what_is_proved() {
    for (pointer, value) in [
        ("/claim/verdict", "refuted"),
        ("/claim/n_o", "every n_o >= 1"),
        ("/claim/mu", "2"),
        ("/claim/initial_set/kind", "box"),
        ("/claim/periodic_solution/x", "0.0494177339"),
        ("/claim/periodic_solution/e", "0.160310073"),
        ("/claim/periodic_solution/zeta", "6.87824584"),
        ("/claim/periodic_solution/z", "7.22"),
    ] {
        assert_refused(&changed(PAPER, pointer, value), Invalid, "claim", "/claim");
    }
    assert_refused(&changed(PAPER, "/claim/derivation", "printed"), BadInput, "format", "/claim/derivation");
    assert_refused(&changed(PAPER, "/claim/derivation", "repaired"), BadInput, "format", "/claim/derivation");
    assert_refused(&changed(PAPER, "/claim/initial_set/Z0", "-1"), Invalid, "initial set", "/claim/initial_set/Z0");
    assert_valid(&changed(PAPER, "/claim/mu", "3/3"));
}

#[test]
fn signs_of_the_witness() {
    for field in ["X_p", "E_p", "D_x", "D_e", "r_x", "r_e", "r_d", "w_x", "h"] {
        for value in ["0", "-1"] {
            assert_refused(
                &changed(PAPER, &format!("/witness/{field}"), value),
                Invalid,
                "signs",
                &format!("/witness/{field}"),
            );
        }
    }
    assert_refused(&changed(PAPER, "/claim/sigma_star", "0"), Invalid, "signs", "/witness/sigma");
    assert_refused(
        &changed(PAPER, "/witness/exact_regulation/w_x", "0"),
        Invalid,
        "signs",
        "/witness/exact_regulation",
    );
}

#[test]
fn exact_regulation_needs_a_matched_frequency() {
    // Boxes serve every frequency, so the rest of the certificate stands.
    let report = changed(BOXES, "/specification/internal_model/matched", false);
    assert_refused(&report, Invalid, "exact regulation", "/witness/exact_regulation");
}

#[test]
fn a_bound_that_is_larger_than_it_need_be_is_true() {
    assert_valid(&changed(PAPER, "/claim/periodic_solution/x", "0.0927"));
}

/// The answer is the same, line by line, whatever stands there, and where nothing does.
#[test]
fn figures_are_not_looked_at() {
    let own = judged(&certificate(PAPER));
    assert_valid(&own);
    for part in ["/conditions", "/constants", "/comparison", "/witness/lmi"] {
        assert!(certificate(PAPER).pointer(part).is_some(), "{part}");
        for other in [json!(null), json!([]), json!("none"), json!({ "C5": { "margin": "-1" } })] {
            let report = judged(&edited(certificate(PAPER), &[(part, other.clone())]));
            assert_valid(&report);
            assert_eq!((report.text(true), report.json()), (own.text(true), own.json()), "{part}: {other}");
        }
    }
}

#[test]
fn what_a_certificate_is_about() {
    let report = proofs_check::check(text("certificates", PAPER).as_bytes());
    let subject = report.subject.as_ref().unwrap();
    assert!(subject.statement.contains("period T = 1") && subject.statement.contains("(given, not proved)"));
    assert!(subject.also.as_ref().unwrap().contains("infinitely many"));
    let shown = report.text(false);
    for part in [
        "proved:  For every",
        "assumed: the bounding functions (f, f_e",
        "assumed: the Lyapunov triple",
        "SHA-256 8f15",
        "name (free text): Example of the paper",
        "tool (free text): sigmastar 0.1.0",
    ] {
        assert!(shown.contains(part), "{part} in {shown}");
    }
    let json = report.json();
    assert!(json["statement"].as_str().unwrap().starts_with("For every"));
    assert!(json.get("figures").is_none());
    assert!(json["assumed"].as_array().unwrap().len() == 4 && json["free_texts"]["name"] == "Example of the paper");
    let proved = proofs_check::check(text("certificates", "periodic-jacobian.sharp").as_bytes()).text(false);
    let proved = proved.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        proved.contains("(its Lyapunov triple is proved)") && proved.contains("matrices of `jacobian`"),
        "{proved}"
    );
    assert!(proved.contains("no domain is stated"), "{proved}");
    // Nothing that stands in a file reaches a terminal as a command.
    let hostile = changed(PAPER, "/specification/name", "\u{1b}[2Jgood\nvalid").text(false);
    assert!(hostile.contains("\\u{1b}[2Jgood\\nvalid"), "{hostile}");
}

#[test]
fn a_specification_to_compare_with() {
    let certificate = text("certificates", PAPER);
    let spec: serde_json::Value = serde_json::from_str(&certificate).unwrap();
    let spec = &spec["specification"];
    let against = |spec: &serde_json::Value| {
        proofs_check::check_against(certificate.as_bytes(), Some(spec.to_string().as_bytes()))
    };
    assert_valid(&against(spec));
    // Words, the order of fields and the way of writing a number are no data.
    let mut same = json!({ "initial_set": spec["initial_set"].clone() });
    for (key, value) in spec.as_object().unwrap() {
        same[key] = value.clone();
    }
    (same["name"], same["period"]) = (json!("another name"), json!(1.0));
    same.as_object_mut().unwrap().remove("description");
    assert_valid(&against(&same));
    let rule = "the specification that was asked for";
    for (pointer, value) in [
        ("/bounds/q", json!("1 + X")),
        ("/period", json!("2")),
        ("/internal_model/matched", json!(false)),
        ("/lyapunov/alpha", json!("0.58000000001")),
        ("/bounds/q_rms", json!("1")),
        ("/domain", json!({ "X": "10" })),
        ("/initial_set", json!([])),
    ] {
        let mut other = spec.clone();
        let (parent, key) = pointer.rsplit_once('/').unwrap();
        other.pointer_mut(parent).unwrap()[key] = value;
        assert_refused(&against(&other), Invalid, rule, &format!("/specification{pointer}"));
    }
    let broken = proofs_check::check_against(certificate.as_bytes(), Some(b"{"));
    assert_refused(&broken, BadInput, "format", "");
    let marked = format!("\u{feff}{spec}");
    assert_valid(&proofs_check::check_against(certificate.as_bytes(), Some(marked.as_bytes())));
}

#[test]
fn the_program() {
    let run = |arguments: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_proofs-check")).args(arguments).output().unwrap();
        (output.status.code(), String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap())
    };
    let valid = folder("certificates").join("paper-example.sharp.json").display().to_string();
    let written = |name: &str, pointer: &str, value: &str| {
        let mut made = certificate(PAPER);
        *made.pointer_mut(pointer).unwrap() = json!(value);
        let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        std::fs::write(&path, made.to_string()).unwrap();
        path.display().to_string()
    };
    let forged = written("forged.json", "/witness/D_e", "2.6");
    let (code, text, error) = run(&[&valid]);
    assert!(code == Some(0) && text.starts_with("valid\n") && error.is_empty(), "{text}");
    let (code, verbose, _) = run(&["--verbose", &valid]);
    assert!(code == Some(0) && verbose.contains("C5b holds") && verbose.contains("\nvalid\n"), "{verbose}");
    let (code, text, _) = run(&[&valid, "--spec", &valid]);
    assert!(code == Some(1) && text.contains("field: /specification/"), "{text}");
    let (code, text, _) = run(&[&forged]);
    assert!(code == Some(1) && text.starts_with("invalid\n") && text.contains("gap:"), "{text}");
    let (code, json, _) = run(&[&forged, "--format", "json"]);
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!((code, &json["verdict"], &json["finding"]["field"]), (Some(1), &json!("invalid"), &json!("/witness")));
    for wrong in [
        &["--format", "xml"][..],
        &[],
        &["--nonsense"],
        &["--spec"],
        &["nowhere.json"],
        &[&valid, "--spec", "nowhere.json"],
        &[&valid, &valid],
    ] {
        let (code, out, error) = run(wrong);
        assert!(code == Some(2) && out.is_empty() && error.contains("usage"), "{wrong:?}");
    }
}

/// What is no certificate is told as what it is: a file in another notation with the command that makes JSON of it, a report with where its certificate is.
#[test]
fn files_of_other_kinds_are_told_apart() {
    let written = |name: &str, text: &str| {
        let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        std::fs::write(&path, text).unwrap();
        path.display().to_string()
    };
    let run = |arguments: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_proofs-check")).args(arguments).output().unwrap();
        let [out, error] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
        (output.status.code(), out, error)
    };
    const TOML: &str = "format = \"sigmastar/plant\"\nversion = 1\n";
    let valid = folder("certificates").join("paper-example.sharp.json").display().to_string();
    let toml = written("other.toml", TOML);
    for call in [&[&toml[..]][..], &[&valid, "--spec", &toml]] {
        let (code, out, error) = run(call);
        assert!(code == Some(2) && out.contains("not JSON"), "{out}");
        assert!(error.contains(&format!("`sigmastar convert {toml} -o FILE.json`")), "{error}");
    }
    // Under the name of JSON it is no more than no JSON, and a certificate under another name is read.
    let (code, out, error) = run(&[&written("other.json", TOML)]);
    assert!(code == Some(2) && out.contains("not JSON") && error.is_empty(), "{error}");
    let copy = written("copy.jsonc", &std::fs::read_to_string(&valid).unwrap());
    let (code, _, error) = run(&[&copy]);
    assert!(code == Some(0) && error.is_empty(), "{error}");
    let with = |format: &str| run(&[&written("table.json", &json!({ "format": format, "version": 1 }).to_string())]).1;
    for (format, said) in [("sigmastar/design", true), ("sigmastar/report", true), ("sigmastar/controller", false)] {
        let text = with(format);
        assert!(text.contains("expected `sigmastar/certificate`"), "{text}");
        assert_eq!(text.contains("its certificate is the file that `-o` writes"), said, "{format}: {text}");
    }
}
