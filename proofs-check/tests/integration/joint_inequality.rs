//! A certificate that rests on joint metrics, for existence and for stability, far below the gain of one metric without p: each of its
//! parts and each of its conditions forged.

use super::matrix_inequality::{stored, times};
use crate::common::{PAPER, accepted, assert_refused, certificate, fails, judged, open, parsed};
use proofs_check::verdict::Verdict;
use serde_json::{Value, json};

const RULE: &str = "joint inequality";
pub const PLACE: &str = "/witness/joint_inequality";
const EXISTENCE_RULE: &str = "existence inequality";
pub const EXISTENCE: &str = "/witness/existence_inequality";
/// The places with their rules.
pub const PARTS: [(&str, &str); 2] = [(PLACE, RULE), (EXISTENCE, EXISTENCE_RULE)];

fn with(at: &str, value: Value) -> Value {
    let mut made = stored("joint");
    *made.pointer_mut(at).unwrap_or_else(|| panic!("{at}")) = value;
    made
}

fn scaled(at: &str, factor: f64) -> Value {
    let mut made = stored("joint");
    times(&mut made, at, factor);
    made
}

#[test]
fn a_certificate_with_both() {
    let report = accepted(&stored("joint"));
    let conditions = report.lines.iter().filter_map(|line| line.strip_prefix("  ")?.split_whitespace().next());
    let conditions: Vec<&str> = conditions.collect();
    let expected = ["E3", "S1", "S1b", "S1c", "S2", "S2b", "S2c", "C4", "C4f", "C5x", "C5e", "C5s"];
    assert!(conditions.ends_with(&expected), "{conditions:?}");
    for of in ["F of the near metric", "G of the far metric"] {
        let by = |rule: &str| report.lines.iter().any(|line| line.starts_with(&format!("{rule}: {of}")));
        assert!(by(RULE) && by(EXISTENCE_RULE), "{:?}", report.lines);
    }
}

/// Neither can be left out at this gain, and one metric by itself serves neither.
#[test]
fn what_norms_do_not_give() {
    for (name, missing) in [("joint_inequality", "C5b"), ("existence_inequality", "S2b")] {
        let mut made = stored("joint");
        made["witness"].as_object_mut().unwrap().remove(name);
        let report = judged(&made);
        assert!(
            report.verdict != Verdict::Valid && open(&report).iter().any(|id| id == missing),
            "{:?}",
            open(&report)
        );
    }
    for (place, rule) in PARTS {
        assert_refused(&judged(&with(&format!("{place}/near/p"), json!(["0", "0"]))), Verdict::Invalid, rule, place);
        for name in ["near", "far"] {
            let mut made = stored("joint");
            made.pointer_mut(place).unwrap().as_object_mut().unwrap().remove(name);
            assert_refused(&judged(&made), Verdict::BadInput, "format", place);
        }
    }
}

/// w_x, h and the paths are those of U, which decides nothing here.
#[test]
fn the_metric_of_norms_decides_nothing() {
    for (name, value) in [("w_x", "1/1000"), ("w_x", "1e9"), ("h", "1/1000"), ("h", "1e9")] {
        accepted(&with(&format!("/witness/{name}"), json!(value)));
        let mut made = with(&format!("/witness/{name}"), json!(value));
        made["witness"]["D_e"] = "1".into();
        fails(&made, &["C4", "C4f"]);
    }
    for (f, q) in [("x-first", "e-first"), ("e-first", "straight")] {
        accepted(&with("/witness/paths", json!({ "f": f, "q": q })));
    }
}

/// Each condition alone, by numbers that are just too small or too large, and just not.
#[test]
fn each_condition() {
    let place = |name: &str| format!("{PLACE}/{name}");
    for (at, condition) in [(place("X"), "C5x"), (place("E"), "C5e")] {
        accepted(&scaled(&at, 0.9992));
        fails(&scaled(&at, 0.998), &[condition]);
    }
    // The thresholds may be the gain itself.
    for (at, condition) in [(place("sigma"), "C5s"), (format!("{EXISTENCE}/sigma"), "E3")] {
        accepted(&with(&at, json!("4")));
        fails(&with(&at, json!("4.000001")), &[condition]);
        accepted(&with(&at, json!("3.98")));
    }
    for (name, of, condition) in [("X", "X_p", "E1"), ("E", "E_p", "E2")] {
        let at = format!("{EXISTENCE}/{name}");
        accepted(&with(&at, stored("joint")["witness"][of].clone()));
        fails(&scaled(&at, 0.98), &[condition]);
    }
    for (at, conditions) in [("X_p", "S1b"), ("r_x", "S1c"), ("E_p", "S2"), ("r_d", "S2c")] {
        fails(&scaled(&format!("/witness/{at}"), 0.9998), &[conditions]);
    }
    fails(&scaled("/witness/r_e", 0.9998), &["S2b"]);
    // The far metric counts in the bounds of existence too.
    fails(&scaled(&format!("{EXISTENCE}/far/c_y"), 0.4), &["S2", "S2b", "S2c"]);
    fails(&scaled(&format!("{EXISTENCE}/far/c_x"), 0.1), &["S1c"]);
    // The level of each metric by itself.
    for (metric, condition) in [("near", "C4"), ("far", "C4f")] {
        let at = |name: &str| place(&format!("{metric}/{name}"));
        for (name, enough, beyond) in [("P_up", 1.001, 1.3), ("x_low", 0.9999, 0.5), ("e_low", 0.9999, 0.5)] {
            accepted(&scaled(&at(name), enough));
            fails(&scaled(&at(name), beyond), &[condition]);
        }
    }
    for radius in ["D_x", "D_e"] {
        let report = judged(&scaled(&format!("/witness/{radius}"), 0.99));
        assert_eq!(open(&report), ["C4"]);
        let report = judged(&scaled(&format!("/witness/{radius}"), 0.6));
        assert_eq!(open(&report), ["C4", "C4f"]);
    }
    // The larger the set, the larger the level.
    for size in ["X0", "E0"] {
        let report = judged(&with(&format!("/claim/initial_set/{size}"), json!("3")));
        assert_eq!(open(&report)[0], "C4", "{size}");
    }
}

/// `P <= P_up I`, `Pi >= diag(x_low I, 0)` and `Pi >= diag(0, e_low)`, each decided exactly.
#[test]
fn extents_are_those_of_the_metrics() {
    for metric in ["near", "far"] {
        for (name, factor) in [("P_up", 0.999), ("P_up", 0.5), ("x_low", 1.001), ("x_low", 2.0), ("e_low", 1.001)] {
            let at = format!("{PLACE}/{metric}/{name}");
            assert_refused(&judged(&scaled(&at, factor)), Verdict::Invalid, RULE, &at);
        }
    }
    // Equality is enough: P = I/2, w = 1 of the far metric.
    let mut made = stored("joint");
    for (name, value) in [("P", json!([["1/2", "0"], ["0", "1/2"]])), ("P_up", json!("1/2")), ("x_low", json!("1/2"))] {
        made.pointer_mut(&format!("{PLACE}/far")).unwrap()[name] = value;
    }
    made.pointer_mut(&format!("{PLACE}/far")).unwrap()["w"] = "1".into();
    made.pointer_mut(&format!("{PLACE}/far")).unwrap()["e_low"] = "1".into();
    let report = judged(&made);
    assert!(report.finding.as_ref().is_none_or(|finding| !finding.pointer.contains("/far/")), "{:?}", report.finding);
    for (name, value) in [("P_up", "0.49999999999"), ("x_low", "0.50000000001"), ("e_low", "1.0000000001")] {
        let mut made = made.clone();
        let at = format!("{PLACE}/far/{name}");
        *made.pointer_mut(&at).unwrap() = value.into();
        assert_refused(&judged(&made), Verdict::Invalid, RULE, &at);
    }
}

/// P or Pi that is not positive definite: V says nothing of where the error is.
#[test]
fn a_metric_that_is_none() {
    for (at, value) in [
        ("near/p", json!(["5", "0"])),
        ("near/p", json!(["0", "-5"])),
        ("near/w", json!("0")),
        ("near/w", json!("-1")),
        ("near/P", json!([["-0.47428", "0"], ["0", "0.49394"]])),
        ("near/P", json!([["0.47428", "1"], ["1", "0.49394"]])),
        ("far/P", json!([["0.83629", "0.9"], ["0.9", "0.81128"]])),
        ("far/w", json!("0")),
    ] {
        let report = judged(&with(&format!("{PLACE}/{at}"), value.clone()));
        assert_eq!(report.verdict, Verdict::Invalid, "{at} {value}");
        let finding = report.finding.unwrap();
        let metric = at.split('/').next().unwrap();
        assert_eq!(finding.rule, RULE, "{at} {value}: {finding:?}");
        assert!(finding.pointer.starts_with(&format!("{PLACE}/{metric}")), "{at} {value}: {finding:?}");
    }
}

/// Every number of a metric a little too good, in either part.
#[test]
fn forged_metrics_are_refused() {
    for (place, rule) in PARTS {
        for (at, factor, what) in [
            ("near/c_y", 1.3, "F of the near metric"),
            ("near/c_x", 400.0, "F of the near metric"),
            ("near/c_e", 300.0, "F of the near metric"),
            ("near/k_p", 0.8, "F of the near metric"),
            ("near/p/0", 0.8, "F of the near metric"),
            ("near/p/0", -1.0, "F of the near metric"),
            ("near/w", 0.8, "F of the near metric"),
            ("sigma", 0.6, "F of the near metric"),
            ("far/c_y", 2000.0, "G of the far metric"),
            ("far/c_x", 4000.0, "G of the far metric"),
            ("far/c_e", 2000.0, "G of the far metric"),
            ("far/k_p", 0.4, "G of the far metric"),
        ] {
            let mut made = scaled(&format!("{place}/{at}"), factor);
            // Of the joint part those of the extents are to be no hindrance.
            if place == PLACE && at != "sigma" {
                let metric = format!("{PLACE}/{}", at.split('/').next().unwrap());
                for name in ["x_low", "e_low"] {
                    made.pointer_mut(&metric).unwrap()[name] = "1e-9".into();
                }
                (made["witness"]["D_x"], made["witness"]["D_e"]) = ("1e7".into(), "1e7".into());
                for (name, end) in [("X", "1e8"), ("E", "1e8")] {
                    made.pointer_mut(PLACE).unwrap()[name] = end.into();
                }
            }
            let report = judged(&made);
            let finding = report.finding.unwrap_or_else(|| panic!("{place}/{at} by {factor} is accepted"));
            assert!(finding.message.contains(what), "{place}/{at} by {factor}: {finding:?}");
            assert_refused(&judged(&made), Verdict::Invalid, rule, place);
        }
    }
}

/// What cannot be read.
#[test]
fn parts_that_are_none() {
    let bad = |made: &Value, at: &str| assert_refused(&judged(made), Verdict::BadInput, "format", at);
    for (place, _) in PARTS {
        for metric in ["near", "far"] {
            for name in ["k_p", "c_x", "c_e", "c_y"] {
                for value in ["0", "-1", "x", ""] {
                    let at = format!("{place}/{metric}/{name}");
                    bad(&with(&at, json!(value)), &at);
                }
            }
            for matrix in [
                json!([]),
                json!([["1"]]),
                json!([["1", "0", "0"], ["0", "1", "0"], ["0", "0", "1"]]),
                json!([["1", "0.1"], ["0.2", "1"]]),
                json!([["1", "0"], ["0"]]),
                json!("1"),
            ] {
                let report = judged(&with(&format!("{place}/{metric}/P"), matrix));
                assert_eq!(report.verdict, Verdict::BadInput);
                assert!(report.finding.unwrap().pointer.starts_with(&format!("{place}/{metric}")));
            }
            for name in ["P", "w", "k_p", "c_x", "c_e", "c_y"] {
                let mut made = stored("joint");
                made.pointer_mut(&format!("{place}/{metric}")).unwrap().as_object_mut().unwrap().remove(name);
                bad(&made, &format!("{place}/{metric}"));
            }
            let mut made = stored("joint");
            made.pointer_mut(&format!("{place}/{metric}")).unwrap()["q"] = "1".into();
            bad(&made, &format!("{place}/{metric}"));
        }
        for p in [json!([]), json!(["1"]), json!(["1", "1", "1"]), json!([["1", "1"]]), json!("1"), json!(["1", "x"])] {
            let report = judged(&with(&format!("{place}/near/p"), p));
            assert_eq!(report.verdict, Verdict::BadInput);
            assert!(report.finding.unwrap().pointer.starts_with(&format!("{place}/near/p")));
        }
        let mut made = stored("joint");
        made.pointer_mut(&format!("{place}/far")).unwrap()["p"] = json!(["0", "0"]);
        bad(&made, &format!("{place}/far"));
        bad(&with(&format!("{place}/far/w"), json!("-1e-9")), &format!("{place}/far/w"));
        for (name, value) in [("X", "-1"), ("E", "-1"), ("sigma", "0"), ("sigma", "-4")] {
            bad(&with(&format!("{place}/{name}"), json!(value)), &format!("{place}/{name}"));
        }
        for name in ["X", "E", "sigma"] {
            let mut made = stored("joint");
            made.pointer_mut(place).unwrap().as_object_mut().unwrap().remove(name);
            bad(&made, place);
        }
        for name in ["rate", "splitting", "P", "c_x"] {
            let mut made = stored("joint");
            made.pointer_mut(place).unwrap()[name] = "1".into();
            bad(&made, place);
        }
    }
    for name in ["P_up", "x_low", "e_low"] {
        for metric in ["near", "far"] {
            for value in ["0", "-1", "x"] {
                let at = format!("{PLACE}/{metric}/{name}");
                bad(&with(&at, json!(value)), &at);
            }
            let mut made = stored("joint");
            made.pointer_mut(&format!("{EXISTENCE}/{metric}")).unwrap()[name] = "1".into();
            bad(&made, &format!("{EXISTENCE}/{metric}"));
        }
    }
    // A near w below 0 is one that can be read, and that a matrix may have.
    assert_refused(
        &judged(&with(&format!("{EXISTENCE}/near/w"), json!("-1"))),
        Verdict::Invalid,
        EXISTENCE_RULE,
        EXISTENCE,
    );
}

/// Beside a matrix inequality, of data that are no plant, at samples, within exact regulation.
#[test]
fn where_it_has_no_place() {
    let part = stored("joint")["witness"]["joint_inequality"].clone();
    let bad = |made: &Value, at: &str| assert_refused(&judged(made), Verdict::BadInput, "format", at);
    let mut both = stored("joint");
    both["witness"]["matrix_inequality"] = json!({ "X": "41", "E": "21", "rate": "1e-7", "sigma": "3.98" });
    bad(&both, PLACE);
    let mut other = certificate(PAPER);
    other["witness"]["joint_inequality"] = part.clone();
    bad(&other, PLACE);
    let mut sampled = parsed("sampled", "plant-motor-axis");
    sampled["witness"]["joint_inequality"] = part.clone();
    bad(&sampled, "/witness");
    let mut regulation = stored("linear");
    regulation["witness"]["exact_regulation"]["joint_inequality"] = part;
    bad(&regulation, "/witness/exact_regulation");
}

/// `x' = -x + e`, `q = x`, with metrics by hand.
fn linear() -> Value {
    let mut made = stored("linear");
    let metric = json!({
        "P": [["1"]], "w": "1", "k_p": "1", "c_x": "1/10", "c_e": "1/10", "c_y": "1/10", "P_up": "1", "x_low": "99/100", "e_low": "99/100",
    });
    let mut near = metric.clone();
    near["p"] = json!(["1/100"]);
    made["witness"]["joint_inequality"] = json!({ "X": "3", "E": "3", "sigma": "20", "near": near, "far": metric });
    (made["witness"]["D_x"], made["witness"]["D_e"]) = ("2".into(), "2".into());
    made
}

/// Exact regulation beside it stands on the conditions by norms that it has by itself, where they hold.
#[test]
fn exact_regulation_has_conditions_of_its_own() {
    let report = accepted(&linear());
    assert!(
        report.lines.iter().any(|line| line.contains(RULE))
            && report.lines.iter().any(|line| line.contains("sigma_oo"))
    );
    let mut made = linear();
    made["witness"]["exact_regulation"]["sigma_star_oo"] = "1.5".into();
    assert_refused(&judged(&made), Verdict::Invalid, "exact regulation", "/witness/exact_regulation");
    let mut made = linear();
    made["witness"]["exact_regulation"]["D_x"] = "0.5".into();
    assert_refused(&judged(&made), Verdict::Invalid, "exact regulation", "/witness/exact_regulation");
    // Nor does it make up for what the metrics do not prove.
    let mut made = linear();
    made["witness"]["joint_inequality"]["far"]["c_y"] = "1".into();
    assert_refused(&judged(&made), Verdict::Invalid, RULE, PLACE);
}

/// Where norms do not prove exact regulation the metrics of the claim do, around 0: with their threshold, their region and their level.
#[test]
fn exact_regulation_by_the_metrics_of_the_claim() {
    let with = |field: &str, value: Value| {
        let mut made = stored("joint");
        let witness = made["witness"].clone();
        made["witness"]["exact_regulation"] = json!({
            "sigma_star_oo": "4", "D_x": witness["D_x"], "D_e": witness["D_e"], "w_x": witness["w_x"], "h": witness["h"],
        });
        made["witness"]["exact_regulation"][field] = value;
        made
    };
    let report = accepted(&with("sigma_star_oo", "4".into()));
    assert!(report.text(false).contains("With infinitely many oscillators and any gain sigma >= 4"));
    for (field, value, condition) in [
        ("sigma_star_oo", "3.97", "C5s"),
        ("D_x", "41", "C5x"),
        ("D_e", "21", "C5e"),
        ("D_x", "0.1", "C4"),
        ("D_e", "0.1", "C4"),
    ] {
        let report = judged(&with(field, value.into()));
        assert_refused(&report, Verdict::Invalid, "exact regulation", "/witness/exact_regulation");
        let failing = open(&report);
        assert!(failing.iter().all(|id| id.starts_with(condition)) && !failing.is_empty(), "{field}: {failing:?}");
    }
}

/// Without states P and p have no rows, and P_up is a number above 0 all the same.
#[test]
fn without_states() {
    let mut made = stored("no-states");
    made["witness"].as_object_mut().unwrap().remove("exact_regulation");
    let metric = json!({
        "P": [], "w": "1", "k_p": "1", "c_x": "1", "c_e": "1/10", "c_y": "1/10", "P_up": "1/1000000", "x_low": "1", "e_low": "1",
    });
    let mut near = metric.clone();
    near["p"] = json!([]);
    let sigma = made["claim"]["sigma_star"].clone();
    made["witness"]["joint_inequality"] =
        json!({ "X": "1000", "E": "1000", "sigma": sigma, "near": near, "far": metric });
    for radius in ["D_x", "D_e"] {
        made["witness"][radius] = "100".into();
    }
    accepted(&made);
    for (at, value, verdict) in [
        ("far/P_up", json!("-1"), Verdict::BadInput),
        ("far/P", json!([["1"]]), Verdict::BadInput),
        ("near/p", json!(["0"]), Verdict::BadInput),
        ("far/e_low", json!("1.0001"), Verdict::Invalid),
        ("near/c_y", json!("1.1"), Verdict::Invalid),
    ] {
        let mut forged = made.clone();
        *forged.pointer_mut(&format!("{PLACE}/{at}")).unwrap() = value;
        assert_eq!(judged(&forged).verdict, verdict, "{at}");
    }
}
