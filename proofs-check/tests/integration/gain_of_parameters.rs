//! A gain of the actuator that is an expression of parameters with intervals: its range is found again, and each part of it forged.

use super::plant_certificates::{changed, stored};
use proofs_check::verdict::Verdict::{BadInput, Invalid, Valid};
use serde_json::{Value, json};

const NAME: &str = "family-gain";

/// Both in the plant and in the claim.
fn stating(end: &str, text: &str) -> [(String, Value); 2] {
    ["plant", "claim"].map(|part| (format!("/{part}/input_gain/{end}"), json!(text)))
}

#[track_caller]
fn verdict(changes: &[(String, Value)]) -> proofs_check::verdict::Verdict {
    let changes: Vec<(&str, Value)> = changes.iter().map(|(at, value)| (at.as_str(), value.clone())).collect();
    changed(NAME, &changes).verdict
}

#[test]
fn the_range_over_the_box_is_what_is_proved() {
    assert_eq!(changed(NAME, &[]).verdict, Valid);
    assert_eq!(stored(NAME)["claim"]["input_gain"]["low"], "0.9/J");
    // J is from 0.7 to 1.3: 0.9/1.3 is 0.6923, 1.1/0.7 is 1.5714.
    for (end, text) in [("low", "0.88/J"), ("high", "1.13/J"), ("low", "0.9/J^2"), ("high", "1.1/J^2")] {
        assert_eq!(verdict(&stating(end, text)), Invalid, "{end} {text}");
    }
}

#[test]
fn the_claim_says_what_the_plant_says() {
    for (end, text) in [("low", "0.9"), ("high", "11/7"), ("nominal", "2")] {
        let claimed = [(format!("/claim/input_gain/{end}"), json!(text))];
        assert_eq!(verdict(&claimed), Invalid, "{end} {text}");
    }
    // A text that is not that of the plant is read as a number.
    assert_eq!(verdict(&[("/claim/input_gain/low".to_owned(), json!("0.9*1/J"))]), BadInput);
    assert_eq!(verdict(&[("/claim/input_gain".to_owned(), Value::Null)]), Invalid);
    // A box that is larger than that of the claim, or than that of the proof.
    assert_eq!(verdict(&[("/plant/parameters/J/low".to_owned(), json!("0.6"))]), Invalid);
}

#[test]
fn an_expression_needs_a_positive_range_in_order() {
    for (end, text) in [
        ("low", "J - 0.7"),
        ("low", "0.9/(J - 1)"),
        ("high", "1.1/(J - 1)"),
        ("low", "t/J"),
        ("low", "e/J"),
        ("low", "i/J"),
        ("low", "0.9/K + J"),
    ] {
        assert_eq!(verdict(&stating(end, text)), BadInput, "{end} {text}");
    }
    for (end, text) in [("high", "0.5/J"), ("low", "2/J"), ("nominal", "3/J"), ("nominal", "(J - 1)/2")] {
        assert_ne!(verdict(&stating(end, text)), Valid, "{end} {text}");
    }
}
