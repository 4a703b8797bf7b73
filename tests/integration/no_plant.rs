//! Data that no plant with a state can have are named wherever they are met.

use crate::support::{program, utf8};
use proofs_check::verdict::Verdict as CheckVerdict;
use serde_json::Value;
use std::path::Path;

/// A specification with p_low = p_up = 1 and q that needs little.
pub fn write(folder: &Path, lyapunov: &str, f: &str, f_xx: &str) -> String {
    let text = format!(
        r#"{{ "format": "sigmastar/bounding-spec", "version": 1, "name": "none", "period": "1", "lyapunov": {lyapunov},
        "bounds": {{ "f": "{f}", "f_e": "0", "f_xx": "{f_xx}", "f_ex": "0", "q": "1 + X/10", "q_e": "0.1",
          "q_x": "0.1", "q_t": "1" }}, "domain": {{ "X": "1e6", "E": "1e6" }},
        "internal_model": {{ "mu": "1", "base_frequency": "2*pi", "matched": true,
          "weights": {{ "family": "power", "n0": "2", "epsilon": "1/2" }} }}, "initial_set": {{ "kind": "paper" }} }}"#
    );
    let path = folder.join("spec.json");
    std::fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

/// The exit code and both streams.
fn run(args: &[&str]) -> (Option<i32>, String, String) {
    let output = program().args(args).output().unwrap();
    (output.status.code(), utf8(output.stdout), utf8(output.stderr))
}

const TRIPLE: &str = r#"{ "p_low": "1", "p_up": "1", "alpha": "50" }"#;
const RATE: &str = r#"{ "p_low": "1", "p_up": "1", "alpha": "1/100", "rate": "50 - X/1e6" }"#;
pub const JACOBIAN: &str = r#"{ "jacobian": [["-2", "1"], ["-1", "-2"]] }"#;

#[test]
fn reports_and_certificates_say_so() {
    let folder = tempfile::tempdir().unwrap();
    let certificate = folder.path().join("certificate.json");
    let certificate = certificate.to_str().unwrap();
    for (lyapunov, f, by) in [
        (TRIPLE, "0.01*X", "alpha"),
        (RATE, "2*X", "rate"),
        (JACOBIAN, "0", "alpha"),
        (JACOBIAN, "2.1*X", "jacobian"),
        // f_x alone says it: what f allows is more.
        (TRIPLE, r#"60*X", "f_x": "0.01"#, "alpha"),
    ] {
        let path = write(folder.path(), lyapunov, f, "0");
        let (code, text, _) = run(&["certify", &path, "-o", certificate, "--force"]);
        assert_eq!(code, Some(0), "{text}");
        let words: Vec<&str> = text.split_whitespace().collect();
        assert!(words.join(" ").contains("no plant with a state x satisfies these data"), "{text}");
        let (_, markdown, _) = run(&["certify", &path, "--format", "markdown"]);
        assert!(markdown.contains("no plant with a state x satisfies these data"), "{markdown}");
        let (_, json, _) = run(&["certify", &path, "--format", "json"]);
        let report: Value = serde_json::from_str(&json).unwrap();
        let written: Value = serde_json::from_str(&std::fs::read_to_string(certificate).unwrap()).unwrap();
        assert_eq!(report["no_plant"], written["no_plant"]);
        // There may be one about the gain besides.
        let says = |remark: &&Value| remark.as_str().is_some_and(|remark| remark.contains("no plant with a state x"));
        assert_eq!(report["remarks"].as_array().unwrap().iter().filter(says).count(), 1, "{}", report["remarks"]);
        if by == "rate" {
            let (_, table, _) = run(&["design", &path, "-q", "--n-o", "0", "--sigma", "5"]);
            assert!(
                table.split_whitespace().collect::<Vec<_>>().join(" ").contains("no plant with a state x"),
                "{table}"
            );
        }
        let reason = &written["no_plant"];
        assert_eq!(reason["exceeded_by"], by);
        assert!(reason["X"].is_string() && reason["rate_at_most"].as_array().unwrap().len() == 2);
        if by == "jacobian" {
            assert_eq!((reason["t"].as_str(), reason["column"].as_u64()), (Some("0"), Some(0)));
        }
        // The checker decides the remark too.
        let check = |certificate: &Value| proofs_check::check(certificate.to_string().as_bytes());
        assert!(check(&written).is_valid(), "{}", check(&written).text(false));
        for (field, value, verdict) in [
            ("X", "1e9", CheckVerdict::Invalid),
            ("X", "-1", CheckVerdict::Invalid),
            ("exceeded_by", "nothing", CheckVerdict::BadInput),
            ("more", "1", CheckVerdict::BadInput),
        ] {
            let mut forged = written.clone();
            forged["no_plant"][field] = value.into();
            let report = check(&forged);
            let finding = report.finding.as_ref().expect("it is refused");
            assert!(report.verdict == verdict && finding.pointer.starts_with("/no_plant"), "{}", report.text(false));
        }
        // The certificate can be read again.
        let (code, _, errors) = run(&["certify", &path, "--witness", certificate]);
        assert_eq!(code, Some(0), "{errors}");
        // There is nothing to try.
        let (code, text, _) = run(&["falsify", certificate, "--trials", "3", "--quiet"]);
        assert_eq!(code, Some(3), "{text}");
        assert!(text.contains("0 keep every bound") && text.contains("no plant with a state x"), "{text}");
    }
}

#[test]
fn data_of_plants_are_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    for spec in ["specs/paper-example.json", "specs/no-x.json"] {
        let (code, json, _) = run(&["certify", spec, "--format", "json"]);
        let report: Value = serde_json::from_str(&json).unwrap();
        assert_eq!((code, &report["no_plant"]), (Some(0), &Value::Null), "{spec}");
        assert!(report["remarks"].as_array().unwrap().is_empty(), "{spec}");
    }
    // A domain whose E is out of range still limits X: within X <= 10 this |f| <= 1 allows alpha = 0.05.
    let path = write(folder.path(), r#"{ "p_low": "1", "p_up": "1", "alpha": "0.05" }"#, "1", "0");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, text.replace(r#""X": "1e6", "E": "1e6""#, r#""X": "10", "E": "exp(1e5)""#)).unwrap();
    let (_, json, _) = run(&["certify", &path, "--format", "json"]);
    let report: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(report["no_plant"], Value::Null);
    // f(0,0) > 0 is no error, and a hint.
    let path = write(folder.path(), r#"{ "p_low": "1", "p_up": "1", "alpha": "1" }"#, "0.01 + 2*X", "0.001");
    let (code, json, _) = run(&["certify", &path, "--format", "json"]);
    let report: Value = serde_json::from_str(&json).unwrap();
    assert_eq!((code, &report["no_plant"]), (Some(0), &Value::Null));
    assert!(report["remarks"][0].as_str().unwrap().contains("shift by x_0(t)"), "{json}");
}
