//! An input gain that is known to an interval: certificates with one, with each of its parts forged, and where it is not available.
//! The one of a specification is made here, from one that leaves room, with a larger gain.

use super::coq_support::written;
use super::matrix_inequality::{stored, times};
use crate::common::{
    PAPER, assert_refused, assert_valid, assert_words_are_ignored, certificate, edited, judged, open, parsed, rehash,
    said,
};
use proofs_check::verdict::Verdict::{self, BadInput, Invalid, Undecided};
use proofs_check::{Report, check_against};
use serde_json::{Value, json};

const RULE: &str = "input gain";

/// What is said of the gain that the claim is about: as the file writes it.
pub fn words(gain: &Value) -> String {
    let [low, high, nominal] = ["low", "high", "nominal"].map(|name| gain[name].as_str().unwrap_or_default());
    format!(
        " and every input gain in [{low}, {high}] (one constant; the regulator divides its control by the nominal gain {nominal})"
    )
}

/// The gain of the file and of the claim.
pub fn set_gain(made: &mut Value, [nominal, low, high]: [&str; 3]) {
    let about = if made.get("plant").is_some() { "plant" } else { "specification" };
    let gain = json!({ "nominal": nominal, "low": low, "high": high });
    made[about]["input_gain"] = gain.clone();
    made["claim"]["input_gain"] = gain;
}

/// b in [0.8, 1.25].
pub fn made() -> Value {
    let mut made = parsed("roomy", "paper-example-rms-at-rest");
    ["constants", "comparison", "conditions"].iter().for_each(|part| drop(made.as_object_mut().unwrap().remove(*part)));
    let values = [("k0", "30.842515"), ("k1", "92.527543"), ("D_x", "0.85"), ("w_x", "4.2"), ("D_e", "1.75")];
    values.into_iter().for_each(|(name, value)| made["witness"][name] = value.into());
    made["witness"]["exact_regulation"]["sigma_star_oo"] = "14".into();
    made["claim"]["sigma_star"] = "28".into();
    // Larger than they need be, which is true.
    made["claim"]["periodic_solution"] = json!({ "x": "1", "e": "1", "zeta": "30", "z": "32" });
    set_gain(&mut made, ["2", "1.6", "2.5"]);
    rehash(&mut made);
    made
}

/// The answer after the changes; nothing for a field that is taken out.
fn answer(made: Value, changes: &[(&str, Value)]) -> Report {
    let mut made = edited(made, changes);
    rehash(&mut made);
    judged(&made)
}

#[track_caller]
fn assert_holds(report: &Report) {
    assert_eq!(report.verdict, Verdict::Valid, "{:?} {}", report.lines, report.text(false));
}

#[test]
fn a_claim_about_every_gain() {
    let report = judged(&made());
    assert_holds(&report);
    assert!(report.lines.iter().any(|line| line.contains("b_hi h dZ^2")), "{:?}", report.lines);
    let subject = report.subject.as_ref().unwrap();
    let said = "every input gain in [1.6, 2.5] (one constant; the regulator divides its control by the nominal gain 2)";
    assert!(subject.statement.contains(said), "{}", subject.statement);
    for said in ["e' = q(t,x,e) + g v", "v = u/2; g is one constant in [1.6, 2.5]"] {
        assert!(subject.assumed.iter().any(|line| line.contains(said)), "{:?}", subject.assumed);
    }
    // Other words for the same numbers, and a narrower interval.
    let same = json!({ "nominal": 2, "low": "1.60", "high": "sqrt(25/4)" });
    assert_holds(&answer(made(), &[("/claim/input_gain", same)]));
    let mut narrow = made();
    set_gain(&mut narrow, ["2", "1.7", "2.1"]);
    rehash(&mut narrow);
    assert_holds(&judged(&narrow));
}

/// A gain that is known: the same numbers as without one.
#[test]
fn a_gain_that_is_its_nominal_one() {
    let mut one = certificate(PAPER);
    set_gain(&mut one, ["1.5", "3/2", "1.5"]);
    rehash(&mut one);
    assert_valid(&judged(&one));
    // A little beside it, and it is a gain.
    set_gain(&mut one, ["1.5", "1.5", "1.5000001"]);
    rehash(&mut one);
    let report = judged(&one);
    assert!(report.lines.iter().any(|line| line.contains("C4 FAILS") && line.contains("b_hi h")), "{:?}", report.lines);
}

/// Each of its uses has a condition that fails without it.
#[test]
fn what_holds_at_the_nominal_gain_alone() {
    let wide = |gain: [&str; 3]| {
        let mut made = made();
        set_gain(&mut made, gain);
        rehash(&mut made);
        judged(&made)
    };
    // The level holds with h in the place of b_hi h.
    assert_eq!(open(&answer(made(), &[("/witness/D_e", json!("1.65"))])), ["C4"]);
    // A larger gain has the larger weight of zeta; a smaller one the transfer constants and all bounds of e.
    assert_eq!(open(&wide(["2", "1.6", "2.9"])), ["C4"]);
    assert_refused(&wide(["2", "1.599", "2.5"]), Invalid, "transfer bound", "/witness/transfer");
    for constant in [("/witness/k0", json!("19.739209")), ("/witness/k1", json!("59.217627"))] {
        assert_refused(&answer(made(), &[constant]), Invalid, "transfer bound", "/witness/transfer");
    }
    let looser = [("/witness/k0", json!("200")), ("/witness/k1", json!("600")), ("/witness/h", json!("0.001"))];
    let mut low = made();
    set_gain(&mut low, ["2", "1.2", "2.5"]);
    let failing = answer(low, &looser);
    assert!(["S2b", "S2c", "C5b"].iter().all(|id| open(&failing).iter().any(|open| open == id)), "{:?}", failing.lines);
    // C5b, by the largest and by the least slope.
    assert_eq!(open(&answer(made(), &[("/witness/h", json!("0.019"))])), ["C5b"]);
    assert_refused(
        &answer(made(), &[("/witness/exact_regulation/sigma_star_oo", json!("12"))]),
        Invalid,
        "exact regulation",
        "/witness/exact_regulation",
    );
}

#[test]
fn the_gain_of_the_claim_is_that_of_the_file() {
    for (name, value) in [("high", "2.51"), ("high", "2.49"), ("low", "1.59"), ("low", "1.61"), ("nominal", "1.9")] {
        let pointer = format!("/claim/input_gain/{name}");
        assert_refused(&answer(made(), &[(pointer.as_str(), json!(value))]), Invalid, RULE, &pointer);
        let of_file = format!("/specification/input_gain/{name}");
        let report = answer(made(), &[(of_file.as_str(), json!(value))]);
        assert_ne!(report.verdict, Verdict::Valid, "{of_file}: {}", report.text(false));
    }
    assert_refused(&answer(made(), &[("/claim/input_gain", Value::Null)]), Invalid, RULE, "/claim");
    let none = answer(made(), &[("/specification/input_gain", Value::Null)]);
    assert_refused(&none, Invalid, RULE, "/claim/input_gain");
    for part in ["/claim", "/specification"] {
        for name in ["nominal", "low", "high"] {
            let missing = answer(made(), &[(format!("{part}/input_gain/{name}").as_str(), Value::Null)]);
            assert_eq!(missing.verdict, BadInput, "{}", missing.text(false));
        }
        let unknown = answer(made(), &[(format!("{part}/input_gain/middle").as_str(), json!("2"))]);
        assert_eq!(unknown.verdict, BadInput, "{}", unknown.text(false));
    }
    // The words are those of the gain, whatever the file says.
    let statement = said(&judged(&made())).replace("[1.6, 2.5]", "[1.5, 2.5]");
    assert_words_are_ignored(&made(), &statement);
}

#[test]
fn what_is_no_interval_around_the_nominal_gain() {
    for (gain, verdict, pointer) in [
        (["2", "2.1", "2.5"], Invalid, "/specification/input_gain"),
        (["2", "1.6", "1.9"], Invalid, "/specification/input_gain"),
        (["2", "0", "2.5"], Invalid, "/specification/input_gain/low"),
        (["2", "-1", "2.5"], Invalid, "/specification/input_gain/low"),
        (["0", "0", "0"], Invalid, "/specification/input_gain/nominal"),
        (["2", "x", "2.5"], BadInput, "/specification/input_gain/low"),
    ] {
        let mut made = made();
        set_gain(&mut made, gain);
        rehash(&mut made);
        let report = judged(&made);
        let finding = report.finding.as_ref().expect("it is refused");
        assert_eq!((finding.verdict, finding.pointer.as_str()), (verdict, pointer), "{}", report.text(false));
    }
}

#[test]
fn the_specification_that_was_asked_for() {
    let made = made();
    let asked = |gain: Value| {
        let mut spec = made["specification"].clone();
        spec["input_gain"] = gain;
        check_against(made.to_string().as_bytes(), Some(spec.to_string().as_bytes()))
    };
    assert_holds(&asked(json!({ "high": "5/2", "low": "1.6", "nominal": 2 })));
    let rule = "the specification that was asked for";
    let wider = asked(json!({ "high": "2.6", "low": "1.6", "nominal": "2" }));
    assert_refused(&wider, Invalid, rule, "/specification/input_gain/high");
    let mut spec = made["specification"].clone();
    spec.as_object_mut().unwrap().remove("input_gain");
    let without = check_against(made.to_string().as_bytes(), Some(spec.to_string().as_bytes()));
    assert_refused(&without, Invalid, rule, "/specification/input_gain");
}

/// With two metrics nothing is proved.
#[test]
fn where_it_is_not_available() {
    let mut joint = stored("joint");
    set_gain(&mut joint, ["1", "0.99", "1.01"]);
    rehash(&mut joint);
    assert_refused(&judged(&joint), Undecided, RULE, "/witness/joint_inequality");
    joint["witness"].as_object_mut().unwrap().remove("joint_inequality");
    joint["witness"].as_object_mut().unwrap().remove("exact_regulation");
    assert!(joint["witness"]["existence_inequality"].get("near").is_some());
    assert_refused(&judged(&joint), Undecided, RULE, "/witness/existence_inequality");
}

/// In a theorem b_lo and b_hi are what the file says of the actuator; where there is nothing to say, there is none.
#[test]
fn the_gain_of_a_theorem() {
    let gain = "  gain := Some ({| low := (1.6 / 2); high := (2.5 / 2); half := true |});\n";
    assert!(written(&made()).contains(gain));
    let mut wide = made();
    set_gain(&mut wide, ["2", "0.9", "2.5"]);
    assert!(written(&wide).contains("low := (0.9 / 2); high := (2.5 / 2); half := false |}"));
    set_gain(&mut wide, ["2", "2", "2"]);
    assert!(written(&wide).contains("  gain := None;\n"));
}

fn of_plant(name: &str) -> Value {
    parsed("gain", name)
}

/// A converter with both inequalities, and the paper's example with a splitting matrix.
#[test]
fn plants() {
    for (name, questions) in [
        ("converter", &["matrix inequality: F >= 0, at b_", "existence inequality: F >= diag(c_x, 0, c_y), at b_"][..]),
        ("splitting", &["matrix inequality: S with e >= 0, at b_"]),
    ] {
        let report = judged(&of_plant(name));
        assert!(report.is_valid(), "{}", report.text(false));
        let count = |start: &str| report.lines.iter().filter(|line| line.trim_start().starts_with(start)).count();
        assert!(questions.iter().all(|start| count(start) == 2), "{:?}", report.lines);
        // That of exact regulation besides.
        assert_eq!(count("C5B "), 2);
        assert_eq!(count("E4 "), usize::from(name == "converter"));
        assert_eq!(count("matrix inequality: F without e >= S"), usize::from(name == "splitting"));
    }
}

/// Each part of both inequalities, a little too good, and a gain that is wider than what was proved.
#[test]
fn forged_parts_of_plants() {
    for (name, part, factor, rule, message) in [
        ("converter", "existence_inequality/sigma", 0.97, "existence inequality", "F >= diag"),
        ("converter", "existence_inequality/c_y", 1.1, "existence inequality", "F >= diag"),
        ("converter", "existence_inequality/c_x", 1.2, "existence inequality", "F >= diag"),
        ("converter", "matrix_inequality/sigma", 0.98, "matrix inequality", "F >= 0, at b_"),
        ("splitting", "matrix_inequality/sigma", 0.98, "matrix inequality", "S with e >= 0, at b_"),
        ("splitting", "h", 8.0, "sharp", ": C4, "),
    ] {
        let mut made = of_plant(name);
        times(&mut made, &format!("/witness/{part}"), factor);
        let report = judged(&made);
        let finding = report.finding.as_ref().unwrap_or_else(|| panic!("{name}: {part} by {factor} is accepted"));
        assert_eq!((finding.verdict, finding.rule), (Invalid, rule), "{name}: {part} by {factor}: {finding:?}");
        assert!(finding.message.contains(message), "{name}: {part} by {factor}: {}", finding.message);
    }
    for (name, gain) in [("converter", ["1", "0.9", "1.2"]), ("converter", ["1", "0.85", "1.1"])] {
        let mut made = of_plant(name);
        set_gain(&mut made, gain);
        rehash(&mut made);
        assert_eq!(judged(&made).verdict, Invalid, "{name} {gain:?}: {}", judged(&made).text(false));
    }
}
