//! Rules of section 10: existence by mean squares, one-sided dq/de, rates, the harmonics of q(t,0,0). The certificates are made
//! here, from one that leaves room.

use crate::common::{assert_refused, certificate, edited, open, parsed, rehash};
use proofs_check::verdict::Verdict::{self, BadInput, Invalid, Undecided};
use proofs_check::{Report, check};
use serde_json::{Value, json};

/// A certificate whose gain and boxes leave room, so that each condition can be broken by itself.
fn made() -> Value {
    let mut made = parsed("roomy", "paper-example-rms-at-rest");
    // Larger than they need be, which is true.
    made["claim"]["periodic_solution"] = json!({ "x": "1", "e": "1", "zeta": "10", "z": "12" });
    made["specification"]["initial_set"] = json!({ "kind": "at-rest", "X0": "0.26201994", "E0": "0.36930028" });
    made
}

/// With kap = 3, which needs a larger E_p, and a larger gain.
fn damped() -> Value {
    let mut made = made();
    let values = [("r_x", "0.0918"), ("r_e", "0.12936"), ("r_d", "3.2339"), ("kap", "3"), ("E_p", "0.7")];
    values.into_iter().for_each(|(name, value)| made["witness"][name] = value.into());
    made["claim"]["sigma_star"] = "19".into();
    made
}

/// With root mean squares of the solution itself: at sigma = 17.6523 those of the witness, at 19 smaller ones.
fn refined(mut made: Value) -> Value {
    let small = json!({ "r_x": "0.07709", "r_e": "0.10864", "r_d": "0.6826" });
    let large = json!({ "r_x": "0.0786", "r_e": "0.11078", "r_d": "0.69603" });
    made["witness"]["refined"] = if made["witness"]["kap"] == "0" { small } else { large };
    made
}

fn harmonics() -> Value {
    json!({ "harmonics": ["1.8756", "0.79156", "0.49414", "0.12493", "0.062502"], "rest_rms": "1e-5", "rest_t_rms": "1e-3" })
}

/// The answer after the changes, with the digest made right.
fn answer(made: Value, changes: &[(&str, Value)]) -> Report {
    let mut made = edited(made, changes);
    rehash(&mut made);
    check(made.to_string().as_bytes())
}

#[track_caller]
fn holds(made: Value, changes: &[(&str, Value)]) {
    let report = answer(made, changes);
    assert_eq!(report.verdict, Verdict::Valid, "{changes:?}: {}", shown(&report));
}

fn shown(report: &Report) -> String {
    let lines: String = report.lines.iter().filter(|line| line.contains("FAILS")).cloned().collect();
    format!("{}{lines}", report.text(false))
}

/// It is invalid for these conditions, and for no other.
#[track_caller]
fn fails(made: Value, changes: &[(&str, Value)], conditions: &[&str]) {
    let report = answer(made, changes);
    assert_eq!(report.verdict, Invalid, "{changes:?}: {}", shown(&report));
    assert_eq!(open(&report), conditions, "{changes:?}: {}", shown(&report));
}

#[track_caller]
fn refuses(made: Value, changes: &[(&str, Value)], verdict: Verdict, rule: &str, pointer: &str) {
    assert_refused(&answer(made, changes), verdict, rule, pointer);
}

#[test]
fn witnesses_of_section_10() {
    holds(made(), &[]);
    holds(refined(made()), &[]);
    holds(damped(), &[]);
    holds(refined(damped()), &[]);
}

#[test]
fn each_condition_of_existence() {
    fails(made(), &[("/witness/r_x", json!("0.07698"))], &["S1c"]);
    fails(made(), &[("/witness/r_e", json!("0.1085"))], &["S2b"]);
    fails(made(), &[("/witness/r_d", json!("0.6818"))], &["S2c"]);
    fails(made(), &[("/witness/E_p", json!("0.1743"))], &["S2"]);
    fails(made(), &[("/witness/E_p", json!("0.4")), ("/witness/r_e", json!("0.19"))], &["S1b", "S1c", "S2c"]);
    // E_p beyond X_p/((c/a_1) b_fe), and only the bound by rms(e) is left.
    holds(made(), &[("/claim/sigma_star", json!("19")), ("/witness/E_p", json!("0.4"))]);
    let report = answer(made(), &[("/specification/lyapunov/alpha", json!("0.018"))]);
    assert!(report.verdict == Invalid && open(&report)[0] == "S1", "{}", shown(&report));
}

#[test]
fn each_condition_of_damped_existence() {
    fails(damped(), &[("/witness/r_x", json!("0.0917"))], &["S1c"]);
    fails(damped(), &[("/witness/r_e", json!("0.1292"))], &["S2b"]);
    fails(damped(), &[("/witness/r_d", json!("3.23"))], &["S2c"]);
    fails(damped(), &[("/witness/E_p", json!("0.646"))], &["S2"]);
    // kap > 0 is all or nothing: what suffices without it does not.
    fails(made(), &[("/witness/kap", json!("1/1000"))], &["S2", "S2b", "S2c"]);
    fails(damped(), &[("/witness/kap", json!("18"))], &["S2c"]);
    fails(damped(), &[("/witness/kap", json!("25"))], &["S2b", "S2c"]);
}

#[test]
fn each_refined_mean_square() {
    let at = |name: &str| format!("/witness/refined/{name}");
    for (name, value, id) in [("r_x", "0.07698", "S3"), ("r_e", "0.1085", "S3b"), ("r_d", "0.6818", "S3c")] {
        fails(refined(made()), &[(&at(name), json!(value))], &[id]);
    }
    for (name, value, id) in [("r_x", "0.0785", "S3"), ("r_e", "0.1106", "S3b"), ("r_d", "0.695", "S3c")] {
        fails(refined(damped()), &[(&at(name), json!(value))], &[id]);
    }
    // What existence needs of r is not asked of r' again.
    holds(refined(damped()), &[("/witness/refined", json!({ "r_x": "0.0919", "r_e": "0.1294", "r_d": "3.24" }))]);
    // A larger kap bounds them too.
    let stiff = [("/witness/kap", json!("19")), ("/witness/r_e", json!("1")), ("/witness/r_d", json!("30"))];
    assert_eq!(open(&answer(refined(damped()), &stiff))[..2], ["S1b", "S1c"]);
}

#[test]
fn signs_and_fields_of_the_witness() {
    for name in ["r_x", "r_e", "r_d", "refined/r_x", "refined/r_e", "refined/r_d", "X_p", "D_e"] {
        for value in ["0", "-1"] {
            let pointer = format!("/witness/{name}");
            refuses(refined(made()), &[(&pointer, json!(value))], Invalid, "signs", &pointer);
        }
    }
    refuses(made(), &[("/witness/kap", json!("-1/10"))], Invalid, "signs", "/witness/kap");
    for name in ["r_e", "r_d", "kap", "X_p", "transfer"] {
        refuses(made(), &[(&format!("/witness/{name}"), Value::Null)], BadInput, "format", "/witness");
    }
    refuses(made(), &[("/witness/r_x", Value::Null)], BadInput, "format", "/witness");
    let older =
        answer(made(), &[("/witness/r_x", Value::Null), ("/witness/p_x", json!("1")), ("/witness/p_e", json!("1"))]);
    assert!(shown(&older).contains("of an older form: certify again"), "{}", shown(&older));
    for name in ["p_x", "p_e", "lyapunov", "lyapunov_existence", "refined/kap", "rate"] {
        let pointer = format!("/witness/{name}");
        refuses(refined(made()), &[(&pointer, json!("1"))], BadInput, "format", &pointer);
    }
    refuses(refined(made()), &[("/witness/refined/r_d", Value::Null)], BadInput, "format", "/witness/refined");
    refuses(made(), &[("/witness/r_e", json!("0.1 + 0.01"))], BadInput, "format", "/witness/r_e");
}

#[test]
fn stability_in_the_form_of_section_10() {
    // Damping is not harm: dq/de <= 0 saves what a larger b_qe costs.
    let harm = ("/specification/bounds/q_e", json!("X + 0.189 + 10*tanh(10*E)"));
    fails(made(), &[harm, ("/witness/exact_regulation", Value::Null)], &["S2", "S2b", "S2c", "C4", "C5b"]);
    let large = [("/witness/h", json!("0.5")), ("/witness/exact_regulation", Value::Null)];
    fails(made(), &large, &["C4", "C5b"]);
    for (name, value, ids) in [
        ("D_x", "0.6", &["C4"][..]),
        ("D_e", "1.2", &["C4"]),
        ("w_x", "0.1", &["C4", "C5", "C5b"]),
        ("w_x", "40", &["C4", "C5b"]),
        ("h", "0.01", &["C5b"]),
    ] {
        let changes = [(&*format!("/witness/{name}"), json!(value)), ("/witness/exact_regulation", Value::Null)];
        fails(made(), &changes, ids);
    }
}

#[test]
fn the_upper_bound_of_dq_de() {
    let most = |value: &str| ("/specification/bounds/q_e_max", json!(value));
    let sigma = |value: &str| [("/claim/sigma_star", json!(value)), ("/witness/exact_regulation", Value::Null)];
    let with = |changes: [(&'static str, Value); 2], value: &str| [&changes[..], &[most(value)]].concat();
    // m = 0: D = 1, and the threshold is smaller; m above b_qe is not used.
    holds(made(), &[most("X + 5")]);
    let wider =
        [("/witness/r_x", json!("0.0848")), ("/witness/r_e", json!("0.11945")), ("/witness/r_d", json!("0.751"))];
    let wide = [&sigma("16")[..], &wider, &[("/witness/E_p", json!("0.21"))]].concat();
    fails(made(), &wide, &["C5b"]);
    let with_m = |m: &str| open(&answer(made(), &[&wide[..], &[most(m)]].concat()));
    assert_eq!(with_m("0"), [""; 0]);
    assert_eq!(with_m("X"), ["C5b"]);
    // Below -b_qe nothing is left between the two bounds.
    fails(made(), &with(sigma("17.6523"), "-2"), &["M"]);
    holds(made(), &with(sigma("17.6523"), "-1"));
    let report = answer(made(), &[most("-1")]);
    assert!(open(&report) == ["M"] && report.finding.as_ref().unwrap().rule == "exact regulation");
    holds(damped(), &[most("-0.3")]);
    fails(damped(), &[most("-0.4")], &["M"]);
    holds(made(), &[most("-0.4")]);
    // The larger of m + kap and b_qe - kap counts.
    let less =
        [("/witness/r_x", json!("0.0902")), ("/witness/r_e", json!("0.12709")), ("/witness/r_d", json!("3.178"))];
    holds(damped(), &[&less[..], &[most("0")]].concat());
    holds(damped(), &[&less[..], &[most("-0.1")]].concat());
    fails(damped(), &less, &["S2b", "S2c"]);
    // Proved like the others, with any sign.
    let pointer = "/specification/bounds/q_e_max";
    refuses(made(), &[most("1 - X")], Invalid, "bounding functions", pointer);
    refuses(made(), &[most("-1 - E")], Invalid, "bounding functions", pointer);
    refuses(made(), &[most("1/(X - 20) + log(X - 5)")], Undecided, "bounding functions", pointer);
    refuses(made(), &[most("t")], BadInput, "format", pointer);
}

#[test]
fn rates() {
    let at = "/specification/lyapunov/rate";
    let weak = ("/specification/lyapunov/alpha", json!("0.3"));
    let report = answer(made(), std::slice::from_ref(&weak));
    assert!(report.verdict == Invalid && open(&report).contains(&"S1c".to_owned()), "{}", shown(&report));
    // The larger of the two rates is used, for existence, stability and exact regulation.
    holds(made(), &[weak.clone(), (at, json!("0.57 - X/100 - E/100"))]);
    holds(made(), &[(at, json!("-5 - X"))]);
    fails(
        made(),
        &[weak.clone(), (at, json!("0.606 - X/3 - E")), ("/witness/exact_regulation", Value::Null)],
        &["C5b"],
    );
    fails(made(), &[weak.clone(), (at, json!("0.56 - X/100"))], &["S1c"]);
    for wrong in ["0.5 + X/1000", "0.5 + E/1000", "1 - X*(1 - X)"] {
        refuses(made(), &[(at, json!(wrong))], Invalid, "bounding functions", at);
    }
    refuses(made(), &[(at, json!("1/X"))], Undecided, "bounding functions", at);
    refuses(made(), &[(at, json!("t"))], BadInput, "format", at);
    // A rate is for the P of a triple that is given.
    let mut jacobian = certificate("paper-example-jacobian.sharp");
    jacobian["specification"]["lyapunov"]["rate"] = json!("0.1");
    rehash(&mut jacobian);
    assert_refused(&check(jacobian.to_string().as_bytes()), BadInput, "format", at);
    let assumed = answer(made(), &[(at, json!("0.1"))]).subject.unwrap().assumed;
    assert!(assumed.iter().any(|line| line.contains("rate")), "{assumed:?}");
}

#[test]
fn harmonics_of_q() {
    let q_0 = |value: Value| ("/specification/q_0", value);
    let narrow = ("/witness/E_p", json!("0.168"));
    fails(made(), std::slice::from_ref(&narrow), &["S2"]);
    holds(made(), &[narrow.clone(), q_0(harmonics())]);
    // They bound the answer to q itself: kap > 0 does not mix with them.
    holds(damped(), &[q_0(harmonics())]);
    fails(damped(), &[q_0(harmonics()), ("/witness/E_p", json!("0.64"))], &["S2"]);
    let mut edges = Vec::new();
    for (k, more) in [(1, "0.9"), (2, "0.6"), (3, "0.3"), (4, "0.3")] {
        let mut larger = harmonics();
        larger["harmonics"][k] = json!(more);
        edges.push(larger);
    }
    let mut rest = harmonics();
    rest["rest_rms"] = json!("1");
    rest["rest_t_rms"] = json!("10");
    edges.push(rest);
    for larger in edges {
        fails(made(), &[narrow.clone(), q_0(larger)], &["S2"]);
    }
    // The mean of q has no part in e.
    let mut mean = harmonics();
    mean["harmonics"][0] = json!("1000");
    holds(made(), &[narrow.clone(), q_0(mean)]);
    let mut without = harmonics();
    without.as_object_mut().unwrap().remove("rest_t_rms");
    holds(made(), &[narrow, q_0(without)]);
    let at = "/specification/q_0";
    for (wrong, verdict) in [
        (json!({ "harmonics": [], "rest_rms": "0" }), BadInput),
        (json!({ "harmonics": ["1"] }), BadInput),
        (json!({ "rest_rms": "1" }), BadInput),
        (json!({ "harmonics": ["1"], "rest_rms": "0", "rest": "0" }), BadInput),
        (json!({ "harmonics": ["1", "-1"], "rest_rms": "0" }), Invalid),
        (json!({ "harmonics": ["1"], "rest_rms": "-1" }), Invalid),
        (json!({ "harmonics": ["1"], "rest_rms": "1", "rest_t_rms": "-1" }), Invalid),
        (json!({ "harmonics": vec!["1"; 1001], "rest_rms": "1" }), BadInput),
    ] {
        let rule = if verdict == Invalid { "specification" } else { "format" };
        refuses(made(), &[q_0(wrong)], verdict, rule, at);
    }
}

#[test]
fn other_bounds() {
    // They are used where they are less than what stands in for them, and proved like the others.
    let tight = [("/witness/r_d", json!("0.679"))];
    fails(made(), &tight, &["S2c"]);
    let f_x = |value: &str| ("/specification/bounds/f_x", json!(value));
    holds(made(), &[&tight[..], &[f_x("1")]].concat());
    fails(made(), &[&tight[..], &[f_x("100")]].concat(), &["S2c"]);
    let given = [("/specification/bounds/q_tx", json!("0")), ("/specification/bounds/q_te", json!("2.106"))];
    let with_q_0 = [("/specification/q_0", harmonics())];
    let less = [("/witness/r_d", json!("0.6729"))];
    fails(made(), &[&less[..], &with_q_0].concat(), &["S2c"]);
    holds(made(), &[&less[..], &with_q_0, &given].concat());
    fails(made(), &[&less[..], &with_q_0, &given[..1]].concat(), &["S2c"]);
    fails(made(), &[&less[..], &given].concat(), &["S2c"]);
    for name in ["f_x", "q_tx", "q_te"] {
        let pointer = format!("/specification/bounds/{name}");
        for wrong in ["1 - X", "1 - E", "X - 1"] {
            refuses(made(), &[(&pointer, json!(wrong))], Invalid, "bounding functions", &pointer);
        }
    }
}

#[test]
fn a_second_triple_for_existence() {
    let mut made = certificate("paper-example-jacobian.sharp");
    let witness = made["witness"].as_object_mut().unwrap();
    witness.insert("lyapunov_existence".to_owned(), witness["lyapunov"].clone());
    let answer = |made: &Value| check(made.to_string().as_bytes());
    let report = answer(&made);
    assert_eq!(report.verdict, Verdict::Valid, "{}", shown(&report));
    let triples = |report: &Report| report.lines.iter().filter(|line| line.starts_with("Lyapunov triple")).count();
    assert_eq!(triples(&report), 2);
    let mut without = made.clone();
    without["witness"].as_object_mut().unwrap().remove("lyapunov_existence");
    assert!(answer(&without).verdict == Verdict::Valid && triples(&answer(&without)) == 1);
    // It is proved, and it is what existence uses; stability goes on with the first.
    let mut false_one = made.clone();
    false_one["witness"]["lyapunov_existence"]["alpha"] = json!("0.9");
    assert_refused(&answer(&false_one), Invalid, "Lyapunov triple", "/witness/lyapunov_existence");
    let mut weak = made.clone();
    weak["witness"]["lyapunov_existence"]["alpha"] = json!("0.1");
    assert!(open(&answer(&weak)).iter().all(|id| id.starts_with('S')) && !open(&answer(&weak)).is_empty());
    let mut weak = made.clone();
    weak["witness"]["lyapunov"]["alpha"] = json!("0.1");
    assert!(open(&answer(&weak)).iter().all(|id| id.starts_with('C')) && !open(&answer(&weak)).is_empty());
    made["witness"]["lyapunov_existence"]["beta"] = json!("0");
    assert_refused(&answer(&made), BadInput, "format", "/witness/lyapunov_existence/beta");
}
