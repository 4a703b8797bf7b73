//! Rules on the claim, the stored conditions and the table of constants; the program itself.

mod common;

use common::*;
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
        ("/claim/periodic_solution/x", "0.0926996163"),
        ("/claim/periodic_solution/e", "0.15"),
        ("/claim/periodic_solution/zeta", "7.110508522"),
        ("/claim/statement", "Everything is stable."),
    ] {
        assert_refused(&changed(PAPER, pointer, value), Invalid, "stored values", "/claim");
    }
    assert_refused(&changed(PAPER, "/claim/derivation", "printed"), BadInput, "format", "/claim/derivation");
    assert_refused(&changed(PAPER, "/claim/derivation", "repaired"), BadInput, "format", "/witness");
    assert_refused(&changed(PAPER, "/claim/initial_set/Z0", "-1"), Invalid, "initial set", "/claim/initial_set/Z0");
    assert_valid(&changed(PAPER, "/claim/mu", "3/3"));
}

#[test]
fn signs_of_the_witness() {
    for field in ["X_p", "E_p", "D_x", "D_e", "p_x", "p_e", "w_x", "h"] {
        for value in ["0", "-1"] {
            assert_refused(
                &changed(PAPER, &format!("/witness/{field}"), value),
                Invalid,
                "signs",
                &format!("/witness/{field}"),
            );
        }
    }
    for field in ["X", "E", "L", "h", "p_x", "p_e"] {
        assert_refused(
            &changed(REPAIRED, &format!("/witness/{field}"), "-1"),
            Invalid,
            "signs",
            &format!("/witness/{field}"),
        );
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
fn stored_conditions_and_constants() {
    let at = |report: proofs_check::Report, pointer: &str| assert_refused(&report, Invalid, "stored values", pointer);
    at(changed(PAPER, "/conditions/6/margin", "2.57606088988835e-11"), "/conditions/6/margin");
    at(changed(PAPER, "/conditions/6/lhs/0", "0.0926997619742392"), "/conditions/6/lhs/0");
    at(changed(PAPER, "/conditions/6/lhs/1", "1"), "/conditions/6/lhs/1");
    at(changed(PAPER, "/conditions/7/relation", "<="), "/conditions/7/relation");
    at(changed(PAPER, "/conditions", json!([])), "/conditions");
    at(changed(PAPER, "/constants/K_alpha/sharp/value", json!(["1", "2"])), "/constants/K_alpha/sharp/value");
    at(changed(PAPER, "/constants/kappa_0/printed/status", "printed, unsound"), "/constants/kappa_0/printed/status");
    at(changed(PAPER, "/constants/psi_2/printed/status", "sound"), "/constants/psi_2/printed/status");
    let report = changed(PAPER, "/constants/sigma_p*/sharp/value/0", "47.2232205780584");
    assert_eq!(report.verdict, Invalid, "{}", report.text(false));
    // A constant of a derivation whose witness is not in the file cannot be believed.
    let mut certificate = certificate(PAPER);
    certificate.as_object_mut().unwrap().remove("comparison");
    assert_refused(&proofs_check::check(certificate.to_string().as_bytes()), BadInput, "format", "/constants");
}

#[test]
fn the_other_derivation_is_proved_too() {
    let report = changed(PAPER, "/comparison/repaired/sigma_star", "2000");
    assert_refused(&report, Invalid, "repaired", "/comparison/repaired/witness");
    assert_refused(
        &changed(REPAIRED, "/comparison/sharp/sigma_star", "47"),
        Invalid,
        "sharp",
        "/comparison/sharp/witness",
    );
}

#[test]
fn the_program() {
    let run = |arguments: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_proofs-check")).args(arguments).output().unwrap();
        (output.status.code(), String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap())
    };
    let valid = folder("certificates").join("paper-example.sharp.json").display().to_string();
    let forged = folder("forged").join("sharp-C4.json").display().to_string();
    assert_eq!(run(&[&valid]), (Some(0), "valid\n".to_owned(), String::new()));
    let (code, verbose, _) = run(&["--verbose", &valid]);
    assert!(code == Some(0) && verbose.contains("C5b holds") && verbose.ends_with("\nvalid\n"), "{verbose}");
    let (code, text, _) = run(&[&forged]);
    assert!(code == Some(1) && text.starts_with("invalid\n") && text.contains("gap:"), "{text}");
    let (code, json, _) = run(&[&forged, "--format", "json"]);
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!((code, &json["verdict"], &json["finding"]["field"]), (Some(1), &json!("invalid"), &json!("/witness")));
    for wrong in [&["--format", "xml"][..], &[], &["--nonsense"], &["nowhere.json"], &[&valid, &valid]] {
        let (code, out, error) = run(wrong);
        assert!(code == Some(2) && out.is_empty() && error.contains("usage"), "{wrong:?}");
    }
}
