//! An actuator that saturates: certificates of each kind of claim with one, with each part of it forged. They are those of the paper's example
//! with an `actuator` (and with a sampling period of 1/1000).

use super::mutations::replacements;
use crate::common::{about, assert_words_are_ignored, edited, judged, open, parsed, rehash, text};
use proofs_check::Report;
use proofs_check::verdict::Verdict::{self, BadInput, Invalid, Undecided, Valid};
use serde_json::{Value, json};

const STORED: [&str; 4] = ["specification", "samples", "plant", "gain"];

fn stored(name: &str) -> Value {
    parsed("actuator", name)
}

/// The max of the file and of the claim, with the digest made right.
fn with_max(mut made: Value, max: &str) -> Value {
    let about = about(&made);
    made[about]["actuator"]["max"] = max.into();
    made["claim"]["actuator"]["max"] = max.into();
    rehashed(made)
}

fn rehashed(mut made: Value) -> Value {
    rehash(&mut made);
    made
}

/// Whether it is of a plant and its actuator has two limits.
fn odd_of_plant(made: &Value) -> bool {
    made.get("plant").is_some_and(|plant| plant["actuator"].get("min").is_some())
}

#[track_caller]
fn refused(report: &Report, verdict: Verdict, pointer: &str) {
    let finding = report.finding.as_ref().unwrap_or_else(|| panic!("{}", report.text(false)));
    assert_eq!((report.verdict, finding.pointer.as_str()), (verdict, pointer), "{}", report.text(false));
}

#[test]
fn a_claim_with_an_actuator() {
    for name in STORED {
        let made = stored(name);
        let report = judged(&made);
        assert!(report.is_valid(), "{name}: {}", report.text(false));
        assert!(
            report.lines.iter().any(|line| line.contains("C6 holds: steady + transient <= max")),
            "{:?}",
            report.lines
        );
        let subject = report.subject.as_ref().unwrap();
        assert!(
            subject.statement.contains("sigma = ") && !subject.statement.contains("sigma >= "),
            "{}",
            subject.statement
        );
        assert!(subject.assumed.iter().all(|line| !line.contains("saturation")), "{:?}", subject.assumed);
        // A larger one does as well.
        assert_eq!(judged(&with_max(made, "1e6")).verdict, Verdict::Valid, "{name}");
    }
}

/// Just below what the claim needs, every other condition holds.
#[test]
fn an_actuator_that_takes_less_is_refused() {
    for name in STORED {
        let made = stored(name);
        let of = |bound: &str| made["claim"]["control"][bound].as_str().unwrap().parse::<f64>().unwrap();
        let needed = of("steady") + of("transient");
        assert_eq!(judged(&with_max(made.clone(), &format!("{:.12}", needed * (1.0 + 1e-9)))).verdict, Verdict::Valid);
        let report = judged(&with_max(made, &format!("{:.12}", needed * (1.0 - 1e-9))));
        assert_eq!((report.verdict, open(&report)), (Invalid, vec!["C6".to_owned()]), "{name}: {}", report.text(false));
    }
}

/// A claim names the actuator of its file, and one gain; without an actuator it says sigma* and no `actuator`.
#[test]
fn what_is_claimed_fits_the_file() {
    for name in STORED {
        let made = stored(name);
        let of_file = format!("/{}/actuator", about(&made));
        let lone_claim = rehashed(edited(made.clone(), &[(&of_file, Value::Null)]));
        refused(&judged(&lone_claim), Invalid, "/claim/actuator");
        if name != "samples" {
            let lone_file = edited(made.clone(), &[("/claim/actuator", Value::Null)]);
            refused(&judged(&lone_file), BadInput, "/claim");
            let sigma = made["claim"]["sigma"].clone();
            let every_gain = edited(lone_file, &[("/claim/sigma", Value::Null), ("/claim/sigma_star", sigma.clone())]);
            refused(&judged(&every_gain), Invalid, "/claim");
            let both = edited(made.clone(), &[("/claim/sigma_star", sigma)]);
            assert_eq!(judged(&both).verdict, BadInput);
        } else {
            refused(&judged(&edited(made.clone(), &[("/claim/actuator", Value::Null)])), Invalid, "/claim");
        }
        let statement = made["claim"]["statement"].as_str().unwrap().replace("sigma = ", "sigma >= ");
        assert_words_are_ignored(&made, &statement);
    }
}

#[test]
fn another_number_anywhere() {
    for name in STORED {
        let made = stored(name);
        let of_file = format!("/{}/actuator/max", about(&made));
        for (kind, new) in replacements(&made["claim"]["actuator"]["max"]) {
            let report = judged(&edited(made.clone(), &[("/claim/actuator/max", new.clone())]));
            // White space after a constant means nothing.
            assert_eq!(report.verdict == Verdict::Valid, kind == "appended", "{name} {kind}: {}", report.text(false));
            let report = judged(&rehashed(edited(made.clone(), &[(&of_file, new)])));
            assert_eq!(report.verdict == Verdict::Valid, kind == "appended", "{name} {kind}: {}", report.text(false));
        }
        for odd in [json!({}), json!({ "max": "30", "min": "1" }), json!("30"), json!(null)] {
            let both = [(&*format!("/{}/actuator", about(&made)), odd.clone()), ("/claim/actuator", odd)];
            let mut forged = made.clone();
            for (pointer, value) in both {
                *forged.pointer_mut(pointer).unwrap() = value;
            }
            let two_limits = odd_of_plant(&forged);
            let verdict = judged(&rehashed(forged)).verdict;
            // Of a plant two limits may be stated: it then is another plant.
            assert!(if two_limits { verdict != Verdict::Valid } else { verdict == BadInput }, "{name}: {verdict:?}");
        }
    }
}

/// A larger gain needs more, and the claim is about one.
#[test]
fn of_infinitely_many_oscillators_nothing_is_claimed() {
    let made = stored("specification");
    let mut donor = parsed("certificates", "paper-example-rms-at-rest.sharp");
    let regulation = donor["witness"]["exact_regulation"].take();
    assert!(regulation.is_object());
    let report = judged(&edited(made, &[("/witness/exact_regulation", regulation)]));
    refused(&report, Undecided, "/witness/exact_regulation");
}

#[test]
fn no_theorem_is_written() {
    let answer = proofs_check::coq::theorem(text("actuator", "specification").as_bytes());
    let finding = answer.unwrap_err();
    assert_eq!((finding.verdict, finding.pointer.as_str()), (Undecided, "/specification/actuator"));
}

/// (M) at a gain above its threshold tau: at a gain b of the actuator what falls has `b h tau/sigma` beside zeta (section 13.1, Theorem G3). The file
/// was made with `b h`, which is not proved to fall, and says a max that only this would allow.
#[test]
fn with_an_uncertain_gain_the_weight_is_that_of_the_threshold() {
    let mut made = stored("uncertain");
    let report = judged(&made);
    let finding = report.finding.as_ref().expect("it must be refused");
    assert_eq!(report.verdict, Invalid);
    assert!(finding.message.contains("C6"), "{}", finding.message);
    made["claim"]["control"]["transient"] = "145".into();
    assert_eq!(judged(&with_max(made.clone(), "148.6")).verdict, Invalid);
    assert_eq!(judged(&with_max(made, "151")).verdict, Valid);
}

/// A bath whose heater takes 2.9 to 5.1, and whose claim keeps to that by what it says of every number of oscillators.
fn one_sided() -> Value {
    parsed("actuator", "one-sided")
}

#[test]
fn limits_to_both_sides_kept_by_the_number_of_oscillators() {
    let made = one_sided();
    let report = judged(&made);
    assert!(report.is_valid(), "{}", report.text(false));
    let said = "actuator: with every n_o what is put out is at most its max, by what is said by n_o";
    assert!(report.lines.iter().any(|line| line == said), "{:?}", report.lines);
    let subject = report.subject.as_ref().unwrap();
    assert!(
        subject
            .statement
            .contains("limits what is put out to the range from 2.9 to 5.1 (u is measured from its middle"),
        "{}",
        subject.statement
    );
    assert!(
        subject.assumed.iter().any(|line| line.contains("puts out v = (2.9 + 5.1)/2 + u/2")),
        "{:?}",
        subject.assumed
    );
    // Around the same middle with more room it is true as well, and a little below what is put out it is not.
    let with = |min: &str, max: &str| {
        let mut other = made.clone();
        for part in ["plant", "claim"] {
            other[part]["actuator"]["min"] = min.into();
            other[part]["actuator"]["max"] = max.into();
        }
        judged(&rehashed(other))
    };
    assert_eq!(with("29/10", "5.1").verdict, Valid);
    assert_eq!(with("-4", "12").verdict, Valid);
    let entries = made["claim"]["by_n_o"].as_array().unwrap();
    let largest: f64 = entries.last().unwrap()["largest"]["u"].as_str().unwrap().parse().unwrap();
    assert_eq!(
        with(&format!("{:.9}", 3.999_999_99 - largest), &format!("{:.9}", 4.000_000_01 + largest)).verdict,
        Valid
    );
    let below = with(&format!("{:.9}", 4.000_000_01 - largest), &format!("{:.9}", 3.999_999_99 + largest));
    refused(&below, Invalid, &format!("/claim/by_n_o/{}", entries.len() - 1));
    // With another middle it is another plant.
    assert_ne!(with("2.9", "5.2").verdict, Valid);
    refused(&with("5.1", "2.9"), Invalid, "/plant/actuator");
    refused(&with("sqrt(8)", "5.1"), BadInput, "/plant/actuator/min");
}

#[test]
fn what_is_said_by_n_o_is_of_every_number() {
    let made = one_sided();
    let last = made["claim"]["by_n_o"].as_array().unwrap().len() - 1;
    let forged = |edits: &[(&str, Value)]| judged(&edited(made.clone(), edits));
    let place = |field: &str| format!("/claim/by_n_o/{last}/{field}");
    assert_eq!(forged(&[("/claim/actuator/kept_by", Value::Null)]).verdict, Invalid);
    refused(&forged(&[("/claim/actuator/kept_by", "C6".into())]), BadInput, "/claim/actuator/kept_by");
    assert_ne!(forged(&[(&place("or_more"), Value::Null)]).verdict, Valid);
    assert_ne!(forged(&[(&place("largest"), Value::Null)]).verdict, Valid);
    let every_set = forged(&[("/claim/harmonics", "every finite set that contains 0".into())]);
    refused(&every_set, Invalid, "/claim/actuator/kept_by");
    // No file says it.
    refused(
        &judged(&rehashed(edited(made.clone(), &[("/plant/actuator/kept_by", "by_n_o".into())]))),
        BadInput,
        "/plant/actuator/kept_by",
    );
}

/// The gain acts on the middle as it does on u: of one of which only ends are known nothing is decided.
#[test]
fn the_gain_of_the_middle_is_one_expression() {
    let mut made = one_sided();
    for part in ["plant", "claim"] {
        made[part]["input_gain"] = json!({ "nominal": "2", "low": "1.9", "high": "2.1" });
    }
    refused(&judged(&rehashed(made)), BadInput, "/plant/input_gain");
}
