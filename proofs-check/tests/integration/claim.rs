//! Rules on the claim, the stored conditions and the table of constants; the program itself.

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
    // The claim stands; that the figure is not the one that is computed is said apart.
    let report = changed(PAPER, "/claim/periodic_solution/x", "0.0927");
    assert_figures_differ(&report, &["/claim/periodic_solution/x"]);
}

#[test]
fn stored_conditions_and_constants() {
    let at = |pointer: &str, value: serde_json::Value, place: &str| {
        assert_figures_differ(&changed(PAPER, pointer, value), &[place]);
    };
    at("/conditions/7/margin", json!("5.0078e-8"), "/conditions/7/margin");
    at("/conditions/7/lhs/0", json!("0.04941773392132"), "/conditions/7/lhs/0");
    at("/conditions/7/lhs/1", json!("1"), "/conditions/7/lhs/1");
    at("/conditions/13/relation", json!("<="), "/conditions/13/relation");
    at("/conditions", json!([]), "/conditions");
    at("/conditions", json!("none"), "/conditions");
    at("/constants", json!([]), "/constants");
    at("/constants/K_alpha/sharp/value", json!(["1", "2"]), "/constants/K_alpha/sharp/value/0");
    at("/constants/K_alpha/evaluated_at", json!("somewhere"), "/constants/K_alpha/evaluated_at");
    at("/constants/kappa_0/printed/status", json!("printed, unsound"), "/constants/kappa_0/printed/status");
    at("/constants/psi_2/printed/status", json!("printed, unsound"), "/constants/psi_2/printed/status");
    at("/constants/sigma_p*/repaired/value/0", json!("2137.6617043"), "/constants/sigma_p*/repaired/value");
    assert_figures_differ(&with(PAPER, "/constants", "K_beta", json!({})), &["/constants/K_beta"]);
    assert_figures_differ(&with(PAPER, "/constants/tau", "printed", json!({})), &["/constants/tau/printed"]);
}

#[test]
fn a_table_that_is_missing_is_missed() {
    for part in ["conditions", "constants"] {
        let mut certificate = certificate(PAPER);
        certificate.as_object_mut().unwrap().remove(part);
        let report = proofs_check::check(certificate.to_string().as_bytes());
        assert_figures_differ(&report, &[&format!("/{part}")]);
    }
}

#[test]
fn the_other_derivation_is_proved_too() {
    // A constant of a derivation whose witness is not in the file, or is not proved, cannot be believed.
    let behind = |report: proofs_check::Report, place: &str| {
        let figures = report.proved.expect("the claim does not rest on it").figures;
        let places: Vec<_> = figures.findings.iter().map(|finding| finding.pointer.as_str()).collect();
        assert!(places.contains(&place) && places.contains(&"/constants/rho_11"), "{places:?}");
        assert!(places.contains(&"/constants/X_b/repaired") && !places.contains(&"/constants/X_b/sharp"), "{places:?}");
    };
    behind(changed(PAPER, "/comparison/repaired/sigma_star", "2000"), "/comparison/repaired/witness");
    let mut certificate = certificate(PAPER);
    certificate.as_object_mut().unwrap().remove("comparison");
    behind(proofs_check::check(certificate.to_string().as_bytes()), "/constants/rho_0");
}

#[test]
fn what_a_certificate_is_about() {
    let report = proofs_check::check(text("certificates", PAPER).as_bytes());
    let subject = &report.proved.as_ref().unwrap().subject;
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
    assert!(json["statement"].as_str().unwrap().starts_with("For every") && json["figures"]["verdict"] == "agree");
    assert!(json["assumed"].as_array().unwrap().len() == 4 && json["free_texts"]["name"] == "Example of the paper");
    let proved = proofs_check::check(text("certificates", "periodic-jacobian.sharp").as_bytes()).text(false);
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
    assert!(code == Some(0) && text.starts_with("valid; figures: all ") && error.is_empty(), "{text}");
    let (code, verbose, _) = run(&["--verbose", &valid]);
    assert!(code == Some(0) && verbose.contains("C5b holds") && verbose.contains("\nvalid; "), "{verbose}");
    let figures = written("figures.json", "/witness/lmi/l_e", "0.25");
    let (code, text, _) = run(&[&figures]);
    assert!(
        code == Some(0) && text.starts_with("valid; figures: 1 differs\n") && text.contains("/witness/lmi"),
        "{text}"
    );
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

#[test]
fn a_figure_that_is_not_known_settles_nothing() {
    // Exactly 0.58, but at 128 bits no more than a number below 1e22 in magnitude: more bits are needed before a figure is
    // compared, and then a wrong one is seen.
    let alpha = "(1e60+0.58)-1e60";
    let mut certificate = certificate(PAPER);
    certificate["specification"]["lyapunov"]["alpha"] = alpha.into();
    rehash(&mut certificate);
    assert_valid(&proofs_check::check(certificate.to_string().as_bytes()));
    for wrong in [json!(["2", "2"]), json!(["undefined", "undefined"])] {
        let mut forged = certificate.clone();
        forged["constants"]["K_alpha"]["repaired"]["value"] = wrong;
        let report = proofs_check::check(forged.to_string().as_bytes());
        let figures = report.proved.expect("the claim stands").figures;
        assert!(figures.word() == "differ" && figures.findings.len() == 1, "{figures}");
        assert!(figures.findings[0].pointer.starts_with("/constants/K_alpha/repaired"), "{figures}");
    }
}
