//! The law whose control is computed in the sample before it acts (docs/mathematics.md, section 13.4): each new field of a certificate,
//! and what a forger would do with it.

use crate::common::parsed;
use crate::sampled_support::{answer, fails, holds, made, open, refuses};
use proofs_check::verdict::Verdict::{BadInput, Invalid, Valid};
use serde_json::{Value, json};

const LAW: &str = "sampled regulator";

/// The paper's example with sigma = 75 at 200 samples a period.
fn delayed() -> Value {
    parsed("sampled", "paper-example-delay")
}

fn number(certificate: &Value, pointer: &str) -> f64 {
    let text = certificate.pointer(pointer).unwrap().as_str().unwrap();
    text.split('/').map(|part| part.parse::<f64>().unwrap()).reduce(|a, b| a / b).unwrap()
}

/// One number times a factor.
fn scaled(pointer: &str, factor: f64) -> (&str, Value) {
    (pointer, json!(format!("{:.17e}", number(&delayed(), pointer) * factor)))
}

#[test]
fn a_true_claim() {
    holds(delayed(), &[]);
    let report = answer(delayed(), &[]);
    assert!(report.is_valid(), "{}", report.text(false));
    let text = report.text(false).split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(text.contains("put out exactly at the sample k+1") && text.contains("more than a sample"), "{text}");
    // A start that is further off is another claim, and true as long as the level has room for it.
    holds(delayed(), &[scaled("/witness/Y_0", 1.000_000_000_01)]);
}

/// The delay is in the claim and in the specification alike; a claim about one law is none about the other.
#[test]
fn the_delay_is_no_detail() {
    let (claim, spec) = ("/claim/delay_samples", "/specification/internal_model/delay_samples");
    let place = "/claim/sampling_period";
    // Left out of the claim, with what goes with it; or of the specification.
    let without = [(claim, Value::Null), ("/witness/gm", Value::Null), ("/witness/Y_0", Value::Null)];
    refuses(delayed(), &without, Invalid, LAW, place);
    refuses(delayed(), &[(spec, Value::Null)], Invalid, LAW, place);
    refuses(delayed(), &[(spec, json!(0))], Invalid, LAW, place);
    // Of both: it is read as the law without a delay, whose conditions these numbers do satisfy; the words then say so.
    let neither = answer(delayed(), &[&without[..], &[(spec, Value::Null)]].concat());
    assert!(neither.verdict == Valid && !neither.text(false).contains("sample before it acts"));
    // The fields of the witness alone are too many, or too few.
    refuses(delayed(), &[(claim, Value::Null)], BadInput, "format", "/witness/");
    refuses(delayed(), &[(claim, json!(0))], BadInput, "format", "/witness/");
    for name in ["/witness/gm", "/witness/Y_0"] {
        refuses(delayed(), &[(name, Value::Null)], BadInput, "format", "/witness");
    }
    // A claim without a delay that is passed off as one with it: numbers have to be made up, and none does.
    let added = |gm: &str, y_0: &str| {
        let delay = [(claim, json!(1)), (spec, json!(1))];
        answer(made(), &[&delay[..], &[("/witness/gm", json!(gm)), ("/witness/Y_0", json!(y_0))]].concat())
    };
    for gm in ["1e-9", "1e-6", "1e-4", "1e-3", "0.01", "0.1", "1", "100"] {
        for y_0 in ["0", "1", "46.03", "1000"] {
            assert_eq!(added(gm, y_0).verdict, Invalid, "{gm} {y_0}");
        }
    }
    refuses(made(), &[(claim, json!(1))], BadInput, "format", "/witness");
    for value in [json!(2), json!(-1), json!("1"), json!(true), json!(1.5), json!([1])] {
        refuses(delayed(), &[(claim, value.clone())], BadInput, "format", claim);
        refuses(delayed(), &[(spec, value)], BadInput, "format", spec);
    }
    // Without a sampling period it means nothing.
    let alone = [("/specification/internal_model/sampling_period", Value::Null)];
    refuses(delayed(), &alone, BadInput, "format", spec);
}

#[test]
fn the_weight_of_the_last_y_and_the_start() {
    for value in ["0", "-1"] {
        refuses(delayed(), &[("/witness/gm", json!(value))], Invalid, "signs", "/witness/gm");
    }
    fails(delayed(), &[scaled("/witness/Y_0", 0.999_999)], &["set FAILS: 0 <= h Y_0 - E_0"]);
    fails(delayed(), &[("/witness/Y_0", json!("-1"))], &["set FAILS: 0 <= h Y_0 - E_0"]);
    fails(delayed(), &[scaled("/witness/Y_0", 1.01)], &["C4d"]);
    fails(delayed(), &[scaled("/witness/D_e", 0.9999)], &["C4d"]);
    // Too large a weight leaves the level, or takes too much of Y; too small a one holds nothing.
    fails(delayed(), &[scaled("/witness/gm", 1.01)], &["C4d"]);
    let small = open(&answer(delayed(), &[scaled("/witness/gm", 0.01)]));
    assert!(small.iter().any(|line| line.starts_with("C5d FAILS: 0 < minor 4 of Q_h")), "{small:?}");
    let large = open(&answer(delayed(), &[scaled("/witness/gm", 1e4)]));
    assert!(large.iter().any(|line| line.starts_with("C5d FAILS: 0 < minor 3 of Q_0")), "{large:?}");
    let steep = open(&answer(delayed(), &[("/specification/bounds/q_e", json!("700 + X"))]));
    assert!(steep.iter().any(|line| line.contains("C5d FAILS: 0 < 1 - h k_e/pi")), "{steep:?}");
}

#[test]
fn bounds_that_are_too_small() {
    for name in ["x", "e", "zeta", "z"] {
        let pointer = format!("/claim/periodic_solution/{name}");
        refuses(delayed(), &[scaled(&pointer, 0.999)], Invalid, "claim", &pointer);
    }
    for name in ["steady", "transient"] {
        let pointer = format!("/claim/control/{name}");
        refuses(delayed(), &[scaled(&pointer, 0.999)], Invalid, "claim", &pointer);
    }
    // What the law without a delay would do with the same numbers is less.
    for (pointer, id) in [("/witness/r_e", "S2b"), ("/witness/r_d", "S2c")] {
        fails(delayed(), &[scaled(pointer, 0.99)], &[id]);
    }
}

/// 3 K h Nb2 < 2.
#[test]
fn the_load() {
    let asked = |mu: f64| {
        let theta = mu * 4.612_375_348_7 / 400.0;
        let gain = format!("{:.12}", mu / (1.0 + theta));
        answer(delayed(), &[("/claim/gain", json!(gain)), ("/specification/internal_model/mu", json!(mu.to_string()))])
    };
    // h mu Nb2 = 1 at mu = 43.36.
    let over = asked(43.4).finding.unwrap();
    assert!(over.rule == LAW && over.message.contains("S0c, 3 K h weight_sum < 2"), "{}", over.message);
    let under = asked(43.3);
    assert!(under.verdict == Invalid && under.finding.unwrap().rule != LAW);
}

#[test]
fn matrix_inequalities_are_of_another_law() {
    let none = json!({ "X": "1", "E": "1", "lambda": "1", "rate": "1", "c_e": "1", "c_y": "1" });
    refuses(delayed(), &[("/witness/matrix_inequality", none)], BadInput, "format", "/witness/matrix_inequality");
}
