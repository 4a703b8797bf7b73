//! `sigmastar rate` and `sigmastar lyapunov`: what is proved stands next to what floating point says.

use crate::support::{EXAMPLE_TEXT, in_one_line, number, program, read, specification_text};
use serde_json::Value;

fn run(arguments: &[&str]) -> (i32, Value, String) {
    let output = program().args(arguments).args(["--format", "json"]).output().expect("it runs");
    let value = serde_json::from_slice(&output.stdout).unwrap_or(Value::Null);
    (output.status.code().unwrap_or(-1), value, String::from_utf8_lossy(&output.stderr).into_owned())
}

/// The rates fall with n_o, stay below the spectral abscissa and come close to it; sigma* is the same for all.
#[test]
fn rates_fall_with_the_number_of_oscillators() {
    let (code, report, _) = run(&["rate", "specs/paper-example.json", "--n-o", "0,1,3,10,40", "--sigma", "60"]);
    assert_eq!(code, 0);
    assert_eq!(report["sigma"], "60");
    let rates = report["rates"].as_array().expect("a list");
    assert_eq!(rates.iter().map(|r| r["n_o"].as_u64().unwrap()).collect::<Vec<_>>(), [0, 1, 3, 10, 40]);
    // n_o = 0: the matrix is -mu n_0 = -2, so P = 1/4 has P A + A'P = -1 exactly and Lemma 1 gives the rate 2.
    assert!((number(&rates[0]["spectral_abscissa_estimate"]) + 2.0).abs() < 1e-12);
    let mut before = [f64::INFINITY; 3];
    for rate in rates {
        let spectral = -number(&rate["spectral_abscissa_estimate"]);
        let oscillators = number(&rate["oscillators"]);
        assert!(oscillators <= spectral && oscillators >= 0.98 * spectral, "{rate}");
        let lemma = &rate["lemma_1"];
        assert!(number(&lemma["rate"]) <= spectral && number(&lemma["rate"]) * number(&lemma["p"]) <= 0.5, "{rate}");
        let closed_loop = number(&rate["closed_loop"]);
        assert!(closed_loop > 0.0 && closed_loop <= spectral, "{rate}");
        assert!(rate["closed_loop_by"] == "riccati" && number(&rate["closed_loop_by_kappa"]) < closed_loop, "{rate}");
        let now = [oscillators, number(&lemma["rate"]), closed_loop];
        assert!(now.iter().zip(before).all(|(now, before)| *now <= before), "{rate}");
        before = now;
    }
}

/// At sigma* the rate by c and kappa is next to nothing, and that of a Lyapunov function of its own is near the internal model's,
/// unless that is faster than the zero dynamics (0.58). A larger gain leaves a larger rate.
#[test]
fn at_the_certified_gain_the_rate_is_of_use() {
    let (code, at_star, _) = run(&["rate", "specs/paper-example.json", "--n-o", "0,1,10,40"]);
    assert_eq!(code, 0);
    let (_, above, _) = run(&["rate", "specs/paper-example.json", "--n-o", "0,1,10,40", "--sigma", "80"]);
    let pairs = at_star["rates"].as_array().unwrap().iter().zip(above["rates"].as_array().unwrap());
    for ((rate, above), share) in pairs.zip([0.07, 0.3, 0.75, 0.9]) {
        let closed_loop = number(&rate["closed_loop"]);
        assert!(closed_loop > -share * number(&rate["spectral_abscissa_estimate"]), "{rate}");
        assert!(closed_loop < number(&above["closed_loop"]) && closed_loop < 0.58, "{rate} {above}");
        assert!(number(&rate["closed_loop_by_kappa"]) < 1e-6 && rate["closed_loop_by"] == "riccati", "{rate}");
    }
}

/// A plant without x is not held back by the alpha = 1 that stands in for it.
/// The plant of the paper with its certified gain: over a period (T = 1) its slowest mode shrinks by no less than proved.
#[test]
fn the_plant_converges_no_slower_than_proved() {
    let gain = ["--sigma", "47.2233"];
    let (code, report, _) = run(&[&["rate", "specs/paper-example.json", "--n-o", "0,1,2,4"], &gain[..]].concat());
    assert_eq!(code, 0);
    for rate in report["rates"].as_array().expect("a list") {
        let n_o = rate["n_o"].to_string();
        let plant = ["simulate", "specs/plants/paper-example.json", "--n-o", &n_o];
        let (code, simulated, _) = run(&[&plant, &gain[..]].concat());
        assert_eq!(code, 0);
        let multiplier = simulated["steady_state"]["multipliers"][0].as_f64().expect("a multiplier");
        let proved = (-number(&rate["closed_loop"])).exp();
        assert!(multiplier <= proved && multiplier > 0.6 * proved, "{n_o}: {multiplier} {proved}");
    }
}

#[test]
fn without_x_the_rate_is_that_of_error_and_internal_model() {
    let (code, report, _) = run(&["rate", "specs/no-x.json", "--n-o", "0,3"]);
    assert_eq!(code, 0);
    let rate = |index: usize| number(&report["rates"][index]["closed_loop"]);
    assert!(rate(0) > 1.0 && rate(1) > 0.0, "{report}");
}

#[test]
fn two_hundred_oscillators_are_within_reach() {
    let (code, report, _) = run(&["rate", "specs/paper-example.json", "--n-o", "200"]);
    assert_eq!(code, 0);
    let rate = &report["rates"][0];
    let spectral = -number(&rate["spectral_abscissa_estimate"]);
    assert!(spectral > 0.0 && number(&rate["oscillators"]) >= 0.9 * spectral, "{rate}");
    assert!(number(&rate["closed_loop"]) >= 0.95 * spectral, "{rate}");
}

#[test]
fn a_wrong_call_of_rate_is_bad_input() {
    for (arguments, part) in [
        (&["rate", "specs/paper-example.json", "--sigma", "39"][..], "below the certified"),
        (&["rate", "specs/paper-example.json", "--sigma", "20*pi"], "rational"),
        (&["rate", "specs/paper-example.json", "--sigma", "-1"], "positive"),
        (&["lyapunov", "specs/paper-example.json"], "no Jacobian"),
    ] {
        let (code, report, _) = run(arguments);
        assert_eq!((code, &report["verdict"]), (2, &Value::from("bad-input")), "{arguments:?}");
        assert!(report["errors"][0]["message"].as_str().is_some_and(|m| m.contains(part)), "{report}");
    }
    for (list, part) in
        [("201", "200"), ("0..201", "200"), ("inf", "200"), ("-1", "`-1`"), ("3..1", "`3..1`"), ("", "``")]
    {
        let (code, report, _) = run(&["rate", "specs/paper-example.json", "--n-o", list]);
        assert_eq!(code, 2, "{list}");
        assert!(report["errors"][0]["message"].as_str().is_some_and(|m| m.contains(part)), "{report}");
    }
}

/// The list is read as that of `transfer`. No certificate carries a rate, so nothing in the report calls one certified.
#[test]
fn ranges_are_read_and_rates_are_not_called_certified() {
    let (code, report, _) = run(&["rate", "specs/no-x.json", "--n-o", "3,0..1"]);
    assert_eq!((code, &report["verdict"]), (0, &Value::from("certified")));
    assert_eq!(report["independent_check"], "none");
    let counts: Vec<_> = report["rates"].as_array().expect("rates").iter().map(|rate| rate["n_o"].as_u64()).collect();
    assert_eq!(counts, [Some(3), Some(0), Some(1)]);
    let output = program().args(["rate", "specs/no-x.json", "--n-o", "0..1"]).output().expect("it runs");
    let text = in_one_line(&String::from_utf8_lossy(&output.stdout));
    assert!(text.contains("no independent program checks them") && !text.contains("certified"), "{text}");
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
    let (code, report, _) = run(&["certify", spec, "--no-compare", "-o", name]);
    assert_eq!(code, 0);
    // No larger than with the triple that paper-example.json ships.
    let (_, shipped, _) = run(&["certify", "specs/paper-example.json", "--no-compare"]);
    assert!(number(&report["sigma_star"]) <= number(&shipped["sigma_star"]));
    let mut certificate = read(&file);
    assert!(certificate["witness"]["lmi"]["l_x"].is_string());
    assert_eq!(certificate["specification"]["lyapunov"]["jacobian"].as_array().map(Vec::len), Some(2));
    let (code, again, _) = run(&["certify", spec, "--no-compare", "--witness", name]);
    assert_eq!((code, &again["sigma_star"]), (0, &report["sigma_star"]));

    let honest = certificate.clone();
    let decided = |certificate: &Value| {
        std::fs::write(&file, certificate.to_string()).unwrap();
        run(&["certify", spec, "--no-compare", "--witness", name])
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

/// A filter with the pole -1/1000 is far slower than the loop, and f and q do not depend on xi_1: the report says that xi_1 is
/// then not part of the rate. One that is not
/// stable is refused as by `certify`.
#[test]
fn the_states_behind_a_filter_are_not_claimed() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = specification_text("relative-degree-4");
    let coefficients = r#"["6", "11", "6"]"#;
    assert!(text.contains(coefficients));
    let with = |a: &str| {
        let file = folder.path().join("spec.json");
        std::fs::write(&file, text.replace(coefficients, a)).expect("written");
        let file = file.to_str().expect("a plain name").to_owned();
        let (code, report, _) = run(&["rate", &file, "--n-o", "0"]);
        let output = program().args(["rate", &file, "--n-o", "0"]).output().expect("it runs");
        (code, report, in_one_line(&String::from_utf8_lossy(&output.stdout)))
    };
    let (code, report, text) = with(r#"["1/1000"]"#);
    assert_eq!((code, &report["state"]), (0, &Value::from("(x, e, z)")));
    assert!(number(&report["rates"][0]["closed_loop"]) > 0.1, "{report}");
    assert!(text.contains("at which (x, e, z) is proved") && text.contains("its rate is not in this table"), "{text}");
    let (code, report, _) = with(r#"["-1"]"#);
    assert_eq!((code, &report["errors"][0]["pointer"]), (2, &Value::from("/relative_degree/a")), "{report}");
}

/// The rate holds for the gain that is given, so the report names that one, with all its digits.
#[test]
fn the_gain_is_written_exactly() {
    let sigma = "123.123456789123456789123456789";
    let output = program().args(["rate", "specs/no-x.json", "--n-o", "0", "--sigma", sigma]).output();
    let text = String::from_utf8_lossy(&output.expect("it runs").stdout).into_owned();
    assert!(text.lines().next().is_some_and(|title| title.ends_with(sigma)), "{text}");
}
