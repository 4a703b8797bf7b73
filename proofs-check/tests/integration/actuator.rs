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
            assert_eq!(judged(&rehashed(forged)).verdict, BadInput, "{name}");
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
