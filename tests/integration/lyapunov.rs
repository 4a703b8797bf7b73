//! `sigmastar lyapunov`: which triple is chosen among those that a Jacobian admits, and that it is proved.

use crate::support::{EXAMPLE_TEXT, json, number, program, read, specification_text};
use serde_json::Value;

fn maybe(value: &Value) -> Option<f64> {
    value.as_str()?.parse().ok()
}

fn run(arguments: &[&str]) -> (i32, Value, String) {
    let output = program().args(arguments).args(["--format", "json"]).output().expect("it runs");
    let value = serde_json::from_slice(&output.stdout).unwrap_or(Value::Null);
    (output.status.code().unwrap_or(-1), value, String::from_utf8_lossy(&output.stderr).into_owned())
}

/// For a Jordan block the ratio p_up/p_low grows without bound as alpha nears its largest value: the smallest sigma* is in
/// between, and the steps around it are finer than elsewhere.
#[test]
fn rate_is_traded_against_the_ratio() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("spec.json");
    let text = specification_text("paper-example-rms-at-rest");
    let triple = r#"{ "p_low": "1", "p_up": "1.5512", "alpha": "0.58" }"#;
    assert!(text.contains(triple));
    std::fs::write(&file, text.replace(triple, r#"{ "jacobian": [["-1", "3"], ["0", "-1"]] }"#)).expect("written");
    let output = program().args(["lyapunov", file.to_str().expect("a plain name"), "--format", "json"]).output();
    let report = json(&output.expect("it runs").stdout);
    let candidates: Vec<(f64, f64, f64)> = report["candidates_estimates"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|one| {
            let sigma = maybe(&one["sigma_star"]).unwrap_or(f64::INFINITY);
            (number(&one["alpha"]), number(&one["ratio"]), sigma)
        })
        .collect();
    assert!(candidates.windows(2).all(|pair| pair[0].0 >= pair[1].0 && pair[0].1 >= pair[1].1), "{candidates:?}");
    // The figures have three digits, and the proof gives up less than one percent.
    let proved = ["alpha", "p_up"].map(|name| number(&report[name]));
    let apart = |at: &usize| (candidates[*at].0 / proved[0] - 1.0).abs();
    let chosen = (0..candidates.len()).min_by(|a, b| apart(a).total_cmp(&apart(b))).expect("some");
    let (alpha, ratio, sigma) = candidates[chosen];
    assert!(apart(&chosen) < 0.01 && (proved[1] / ratio - 1.0).abs() < 0.01, "{proved:?} {candidates:?}");
    assert!(candidates.iter().all(|other| other.2 >= sigma), "{proved:?} {candidates:?}");
    assert!(chosen > 0 && chosen + 1 < candidates.len(), "{proved:?} {candidates:?}");
    // Neither neighbour is far in rate or better by more than one percent would be.
    for (beside, _, other) in [candidates[chosen - 1], candidates[chosen + 1]] {
        assert!((beside / alpha - 1.0).abs() < 0.12 && other < 1.02 * sigma, "{candidates:?}");
    }
}

/// The shipped triple has alpha = 0.58 and p_up/p_low = 1.5512; the best constant P gives 0.58077 along x_0(t).
#[test]
fn the_triple_of_the_example_is_found() {
    let (code, report, _) = run(&["lyapunov", "specs/paper-example-jacobian.json"]);
    assert_eq!(code, 0);
    let (alpha, ratio) = (number(&report["alpha"]), number(&report["p_up"]) / number(&report["p_low"]));
    assert!((0.55..0.59).contains(&alpha) && (1.3..1.6).contains(&ratio), "{alpha} {ratio}");
    let floquet = number(&report["floquet_exponents_not_certified"][0][0]);
    assert!((-floquet - 0.6).abs() < 0.01 && alpha < -floquet, "{floquet}");
    assert_eq!(report["P"].as_array().map(Vec::len), Some(2));
}

/// The certificate carries P; it is decided again from the file, and a P that was tampered with proves nothing.
#[test]
fn the_certificate_carries_p_and_is_decided_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("certificate.json");
    let name = file.to_str().expect("a plain name");
    let spec = "specs/paper-example-jacobian.json";
    let (code, report, _) = run(&["certify", spec, "--no-alternatives", "-o", name]);
    assert_eq!(code, 0);
    // No larger than with the triple that paper-example.json ships.
    let (_, shipped, _) = run(&["certify", "specs/paper-example.json", "--no-alternatives"]);
    assert!(number(&report["sigma_star"]) <= number(&shipped["sigma_star"]));
    let mut certificate = read(&file);
    assert!(certificate["witness"]["lmi"]["l_x"].is_string());
    assert_eq!(certificate["specification"]["lyapunov"]["jacobian"].as_array().map(Vec::len), Some(2));
    let (code, again, _) = run(&["certify", spec, "--no-alternatives", "--witness", name]);
    assert_eq!((code, &again["sigma_star"]), (0, &report["sigma_star"]));

    let honest = certificate.clone();
    let decided = |certificate: &Value| {
        std::fs::write(&file, certificate.to_string()).unwrap();
        run(&["certify", spec, "--no-alternatives", "--witness", name])
    };
    certificate["witness"]["lyapunov"]["alpha"] = Value::from("0.6");
    let (code, report, _) = decided(&certificate);
    assert_eq!((code, &report["verdict"]), (3, &Value::from("undecided")));
    certificate = honest.clone();
    certificate["witness"]["lyapunov"]["P"][0][1] = Value::from("0.9");
    assert_eq!(decided(&certificate).0, 3);
    certificate = honest.clone();
    certificate["witness"]["lyapunov"]["P"][0] = Value::Array(vec![Value::from("1")]);
    assert_eq!(decided(&certificate).0, 3);
    certificate = honest;
    certificate["witness"].as_object_mut().unwrap().remove("lyapunov");
    assert_eq!(decided(&certificate).0, 2);
}

/// An unstable Jacobian, one with a P(t) that must vary, and one that no P serves.
#[test]
fn jacobians_of_all_kinds_on_the_command_line() {
    let folder = tempfile::tempdir().expect("a folder");
    let triple = r#"{ "p_low": "1", "p_up": "1.5512", "alpha": "0.58" }"#;
    let decide = |jacobian: &str| {
        let file = folder.path().join("spec.json");
        std::fs::write(&file, EXAMPLE_TEXT.replace(triple, &format!(r#"{{ "jacobian": {jacobian} }}"#))).unwrap();
        run(&["lyapunov", file.to_str().unwrap()])
    };
    let (code, report, _) = decide(r#"[["1/10"]]"#);
    assert_eq!((code, &report["verdict"]), (3, &Value::from("undecided")));
    let (code, report, _) = decide(r#"[["-1 + 3*cos(2*pi*t)"]]"#);
    assert_eq!(code, 0, "{report}");
    assert!(report["harmonics"].as_array().is_some_and(|list| !list.is_empty()));
    assert!(number(&report["alpha"]) > 0.8);
    // The interval reaches instability at one end.
    assert_eq!(decide(r#"[[["-1", "1/2"]]]"#).0, 3);
    let (code, report, _) = decide(r#"[[["-1", "-1/2"]]]"#);
    assert_eq!(code, 0);
    assert!((0.49..=0.5).contains(&number(&report["alpha"])));
    // More interval entries than vertices are looked at: a ball.
    let row = r#"["-1/10", "1/10"]"#;
    let many = format!(r#"[["-1", {row}, {row}], [{row}, "-2", {row}], [{row}, {row}, ["-2", "-1"]]]"#);
    let (code, report, _) = decide(&many);
    assert_eq!(code, 0);
    assert!((0.1..1.0).contains(&number(&report["alpha"])));
    for wrong in [r#"[]"#, r#"[["-1", "0"]]"#, r#"[["-1"], ["0"]]"#, r#"[[["-1", "0", "1"]]]"#, r#"[["X"]]"#, r#""-1""#]
    {
        assert_eq!(decide(wrong).0, 2, "{wrong}");
    }
}

#[test]
fn without_a_jacobian_there_is_nothing_to_choose() {
    let (code, report, _) = run(&["lyapunov", "specs/paper-example.json"]);
    assert_eq!((code, &report["verdict"]), (2, &Value::from("bad-input")));
    assert!(report["errors"][0]["message"].as_str().is_some_and(|message| message.contains("no Jacobian")), "{report}");
}
