//! Claims at samples with an input gain that is known to an interval, and of families: each of their parts forged. The certificates were
//! written by the other program, with numbers that just hold.

use super::input_gain::set_gain;
use super::matrix_inequality::{PLACE, RULE, times};
use crate::common::{
    accepted, assert_refused, assert_valid, assert_words_are_ignored, edited, judged, open, parsed, rehash,
};
use proofs_check::Report;
use proofs_check::verdict::Verdict::{BadInput, Invalid, Valid};
use serde_json::{Value, json};

const EXISTENCE_PLACE: &str = "/witness/existence_inequality";

fn stored(name: &str) -> Value {
    parsed("sampled", name)
}

/// A specification, with b in [0.8, 1.25].
fn made() -> Value {
    stored("gain")
}

/// A plant with two parameters in intervals, and b in [0.95, 1.05]; both inequalities.
fn family() -> Value {
    stored("gain-inequalities")
}

fn answer(made: Value, changes: &[(&str, Value)]) -> Report {
    let mut made = edited(made, changes);
    rehash(&mut made);
    judged(&made)
}

fn with_gain(mut made: Value, gain: [&str; 3]) -> Report {
    set_gain(&mut made, gain);
    rehash(&mut made);
    judged(&made)
}

/// Another interval of a parameter in the file, and in the claim.
fn with_parameter(mut made: Value, name: &str, [low, high]: [&str; 2]) -> Report {
    let mut range = made["plant"]["parameters"][name].clone();
    (range["low"], range["high"]) = (low.into(), high.into());
    ["plant", "claim"].iter().for_each(|part| made[*part]["parameters"][name] = range.clone());
    rehash(&mut made);
    judged(&made)
}

#[test]
fn what_is_claimed() {
    let report = judged(&made());
    assert_valid(&report);
    for condition in ["S0c holds: b_hi K h weight_sum < 2", "b_hi h dZ^2"] {
        assert!(report.lines.iter().any(|line| line.contains(condition)), "{:?}", report.lines);
    }
    let subject = report.subject.as_ref().unwrap();
    let said = "every phase of the sampling grid and every input gain in [1.6, 2.5] (one constant; the regulator divides its control by the nominal gain 2), with period";
    assert!(subject.statement.contains(said), "{}", subject.statement);
    for said in ["e' = q(t,x,e) + g v", "the regulator puts out v = u/2; g is one constant in [1.6, 2.5]"] {
        assert!(subject.assumed.iter().any(|line| line.contains(said)), "{:?}", subject.assumed);
    }

    let report = judged(&family());
    assert_valid(&report);
    for (start, count) in [("matrix inequality: F_h,", 4), ("existence inequality: F_h,", 4)] {
        let found = report.lines.iter().filter(|line| line.starts_with(start) && line.contains(", at b_")).count();
        assert_eq!(found, count, "{start}: {:?}", report.lines);
    }
    let subject = report.subject.as_ref().unwrap();
    let said = "every plant of these formulas with a constant 'R' of the file in [590, 615] and a constant 's' of the file in [98, 102] has";
    assert!(subject.statement.contains(said) && subject.assumed.len() == 4, "{subject:?}");
}

/// A gain that is its nominal one leaves the numbers as they are; what is put out is divided all the same.
#[test]
fn a_gain_that_is_its_nominal_one() {
    for name in ["paper-example", "plant-motor-axis"] {
        assert_valid(&with_gain(stored(name), ["1.5", "3/2", "1.5"]));
    }
    for (factor, verdict) in [(0.5 + 1e-9, Valid), (0.5 - 1e-9, Invalid)] {
        for (name, bound) in [("steady", 13.340_741_624), ("transient", 129.312_492_593)] {
            let mut one = stored("paper-example");
            one["claim"]["control"] = json!({ "steady": "1000", "transient": "1000" });
            one["claim"]["control"][name] = format!("{:.12}", bound * factor).into();
            assert_eq!(with_gain(one, ["2", "2", "2"]).verdict, verdict, "{name} by {factor}");
        }
    }
}

/// Every number of the specification's claim that a gain changes has to be what it is, and not what it would be at b = 1.
#[test]
fn what_holds_at_the_nominal_gain_alone() {
    accepted(&made());
    for (name, value) in [("k0", "19.739209"), ("k1", "59.222498")] {
        let report = answer(made(), &[(&format!("/witness/{name}"), json!(value))]);
        assert_refused(&report, Invalid, "sampled regulator", "/witness/k0");
    }
    for (name, condition) in [("E_p", "S2"), ("r_e", "S2b"), ("r_d", "S2c"), ("D_e", "C4")] {
        let mut less = made();
        times(&mut less, &format!("/witness/{name}"), 1.0 - 1e-5);
        assert!(open(&judged(&less)).iter().any(|open| open == condition), "{name}");
    }
    for (factor, condition) in [(1.01, "C4"), (0.99, "C5h")] {
        let mut other = made();
        times(&mut other, "/witness/h", factor);
        assert_eq!(open(&judged(&other)), [condition]);
    }
    for (part, name) in
        [("periodic_solution", "e"), ("periodic_solution", "zeta"), ("control", "steady"), ("control", "transient")]
    {
        let place = format!("/claim/{part}/{name}");
        let mut less = made();
        times(&mut less, &place, 1.0 - 1e-9);
        assert_refused(&judged(&less), Invalid, "claim", &place);
    }
    // K h weight_sum is 0.0228.
    let report = with_gain(made(), ["2", "1.6", "180"]);
    assert_refused(&report, Invalid, "sampled regulator", "/claim");
    assert!(report.finding.unwrap().message.contains("b_hi K h weight_sum < 2"));
    // At h sigma = 3/4 a gain of 3 is too much for the loop without q, and nothing is known of its answers.
    let steep = edited(made(), &[("/claim/sigma", json!("150"))]);
    assert!(!open(&with_gain(steep.clone(), ["2", "1.6", "4"])).contains(&"S2b".to_owned()));
    let report = with_gain(steep, ["2", "1.6", "6"]);
    assert!(report.verdict == Invalid && open(&report).contains(&"S2b".to_owned()), "{}", report.text(false));
    assert!(report.lines.iter().any(|line| line.contains("S2b undecided")), "{:?}", report.lines);
}

/// Wider on either side than what is proved, narrower, and other words for the same.
#[test]
fn the_interval_of_the_gain() {
    for gain in [["2", "1.599", "2.5"], ["2", "1.6", "2.501"], ["1.99", "1.6", "2.5"], ["2.01", "1.6", "2.5"]] {
        assert_eq!(with_gain(made(), gain).verdict, Invalid, "{gain:?}");
    }
    for gain in [["1", "0.9499", "1.05"], ["1", "0.95", "1.0501"]] {
        assert_eq!(with_gain(family(), gain).verdict, Invalid, "{gain:?}");
    }
    assert_eq!(with_gain(made(), ["2", "1.601", "2.499"]).verdict, Valid);
    assert_eq!(with_gain(family(), ["1", "0.951", "1.049"]).verdict, Valid);
    let same = json!({ "nominal": 2, "low": "1.60", "high": "sqrt(25/4)" });
    assert_eq!(answer(made(), &[("/claim/input_gain", same)]).verdict, Valid);

    let place = "/claim/input_gain";
    for (name, value) in [("high", "2.51"), ("low", "1.61"), ("nominal", "1.9")] {
        let of_claim = format!("{place}/{name}");
        assert_refused(&answer(made(), &[(&of_claim, json!(value))]), Invalid, "input gain", &of_claim);
    }
    for name in ["nominal", "low", "high"] {
        for part in ["claim", "specification"] {
            let missing = answer(made(), &[(&format!("/{part}/input_gain/{name}"), Value::Null)]);
            assert_refused(&missing, BadInput, "format", &format!("/{part}/input_gain"));
        }
    }
    assert_refused(&answer(made(), &[(place, Value::Null)]), Invalid, "input gain", "/claim");
    assert_refused(&answer(made(), &[("/specification/input_gain", Value::Null)]), Invalid, "input gain", place);
}

/// Nothing of the gain, of another one, and of it where a claim in continuous time has it.
#[test]
fn the_gain_in_words() {
    let said = made()["claim"]["statement"].as_str().unwrap().to_owned();
    let (before, after) = said.split_once(" and every input gain in [1.6, 2.5]").unwrap();
    let (words, after) = after.split_once(", with").unwrap();
    for forged in [
        format!("{before}, with{after}"),
        said.replace("[1.6, 2.5]", "[1.5, 2.5]"),
        said.replace("the nominal 2", "the nominal 1"),
        format!("{before}, with{after}")
            .replace("= 20.0304", &format!("= 20.0304 and every input gain in [1.6, 2.5]{words}")),
    ] {
        assert_words_are_ignored(&made(), &forged);
    }
}

/// The proofs are of the box of the file: at either end of either parameter it ends.
#[test]
fn a_family_that_is_wider_than_its_proof() {
    for (name, range) in [("R", ["585", "615"]), ("R", ["590", "650"]), ("s", ["95", "102"]), ("s", ["98", "105"])] {
        let report = with_parameter(family(), name, range);
        assert_ne!(report.verdict, Valid, "{name} in {range:?}: {}", report.text(false));
    }
    assert_eq!(with_parameter(family(), "R", ["595", "610"]).verdict, Valid);
    let small = || stored("gain-family");
    for (name, range) in [("a", ["0.79", "1.25"]), ("a", ["0.8", "1.27"]), ("g", ["0.5", "1.51"])] {
        assert_ne!(with_parameter(small(), name, range).verdict, Valid, "{name} in {range:?}");
    }
    assert_eq!(with_parameter(small(), "g", ["0.6", "1.4"]).verdict, Valid);
    // In the claim, or in the file, alone.
    for part in ["claim", "plant"] {
        let narrow = format!("/{part}/parameters/R/low");
        assert_refused(&answer(family(), &[(&narrow, json!("595"))]), Invalid, "parameters", "/claim/parameters/R/low");
    }
    assert_refused(&answer(family(), &[("/claim/parameters", Value::Null)]), Invalid, "parameters", "/claim");
    let statement = family()["claim"]["statement"].as_str().unwrap().to_owned();
    assert_words_are_ignored(
        &family(),
        &statement.replace("every plant of these formulas", "the plant of these formulas"),
    );
    for (place, value) in [("/witness/orbit/sensitivities", Value::Null), ("/witness/forcing/sensitivities", json!([]))]
    {
        assert_refused(&answer(family(), &[(place, value)]), BadInput, "format", "/witness");
    }
}

/// Every number of both inequalities a little too good: at one end of b, or of the box, it is.
#[test]
fn forged_inequalities() {
    for (place, name, factor, rule) in [
        (PLACE, "lambda", 0.2, RULE),
        (PLACE, "lambda", 5.0, RULE),
        (PLACE, "c_e", 1e6, RULE),
        (PLACE, "c_y", 1e5, RULE),
        (EXISTENCE_PLACE, "c_x", 1.5, "existence inequality"),
        (EXISTENCE_PLACE, "c_e", 1.5, "existence inequality"),
        (EXISTENCE_PLACE, "c_y", 1.5, "existence inequality"),
        (EXISTENCE_PLACE, "gamma", 0.9, "existence inequality"),
        (EXISTENCE_PLACE, "k_p", 1.2, "existence inequality"),
    ] {
        let mut forged = family();
        times(&mut forged, &format!("{place}/{name}"), factor);
        assert_refused(&judged(&forged), Invalid, rule, place);
    }
}
