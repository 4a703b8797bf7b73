//! Forged certificates: each breaks exactly the condition that it is named after. (Those of existence are in `mean_squares`.)

use crate::common::{BOXES, PAPER, assert_refused, certificate, rehash};
use proofs_check::json::decimal;
use proofs_check::verdict::Verdict;
use proofs_check::{Report, check};
use rug::Rational;
use serde_json::{Value, json};

/// What is changed: a number by a factor, or a field to what is given.
enum Change {
    Times(f64),
    To(Value),
}

use Change::{Times, To};

/// The answer after the changes, with the digest made right.
fn forged(base: &str, changes: &[(&str, Change)]) -> Report {
    let mut made = certificate(base);
    for (pointer, change) in changes {
        let place = made.pointer_mut(pointer).unwrap_or_else(|| panic!("{pointer} exists"));
        let before = place.clone();
        *place = match change {
            To(value) => value.clone(),
            Times(factor) => {
                let exact = decimal(before.as_str().unwrap()).unwrap() * Rational::from_f64(*factor).unwrap();
                json!(exact.to_string())
            }
        };
    }
    rehash(&mut made);
    check(made.to_string().as_bytes())
}

/// Just beyond what holds.
const LESS: Change = Times(1.0 - 1e-6);

/// The conditions, each with what breaks it and nothing else.
fn forgeries() -> Vec<(&'static str, Vec<(&'static str, Change)>)> {
    let kink = |at: &str| ("/specification/bounds/f_xx", To(json!(format!("0.2237 + 10*max(0, X - {at})"))));
    vec![
        ("set", vec![("/claim/initial_set/X0", LESS)]),
        ("set", vec![("/claim/initial_set/E0", LESS)]),
        ("set", vec![("/claim/initial_set/Z0", LESS)]),
        ("domain", vec![("/specification/domain/X", To(json!("0.76")))]),
        ("domain", vec![("/specification/domain/E", To(json!("2.8")))]),
        ("T", vec![("/witness/k0", LESS)]),
        ("T", vec![("/witness/k1", LESS)]),
        ("C4", vec![("/witness/D_e", LESS)]),
        ("C5", vec![kink("0.1")]),
        ("C5b", vec![("/witness/h", Times(0.99))]),
        ("C4", vec![("/witness/exact_regulation/D_e", LESS)]),
        ("C5", vec![kink("0.8"), ("/witness/exact_regulation/D_x", To(json!("5")))]),
        ("C5b", vec![("/witness/exact_regulation/sigma_star_oo", Times(0.9999))]),
    ]
}

#[test]
fn each_is_refused_for_its_condition_alone() {
    for (id, changes) in forgeries() {
        let report = forged(PAPER, &changes);
        let name = format!("{id} by {}", changes[0].0);
        assert_eq!(report.verdict, Verdict::Invalid, "{name}");
        let finding = report.finding.as_ref().unwrap();
        assert!(finding.message.contains(&format!(": {id}, ")), "{name}: {}", finding.message);
        assert!(finding.sides.is_some(), "{name}: both sides and the gap");
        for line in report.lines.iter().filter(|line| line.contains(" FAILS: ")) {
            assert!(line.trim_start().starts_with(&format!("{id} ")), "{name} also breaks {line}");
        }
        // Where C5 fails, the threshold of C5b has no meaning; nothing else may be left open.
        for line in report.lines.iter().filter(|line| line.contains(" undecided: ")) {
            assert!(id == "C5" && line.trim_start().starts_with("C5b "), "{name}: {line}");
        }
    }
}

#[test]
fn triples_that_are_not_those_of_the_jacobian() {
    for base in ["paper-example-jacobian.sharp", "periodic-jacobian.sharp"] {
        for (name, factor) in [("alpha", 1.01), ("p_low", 1.01), ("p_up", 0.99)] {
            let report = forged(base, &[(&format!("/witness/lyapunov/{name}"), Times(factor))]);
            assert_refused(&report, Verdict::Invalid, "Lyapunov triple", "/witness/lyapunov");
        }
    }
}

#[test]
fn boxes_that_leave_a_place_out_or_are_too_coarse() {
    let boxes = |edit: fn(&mut Vec<Value>)| {
        let mut rows = certificate(BOXES)["witness"]["transfer"]["boxes"].as_array().unwrap().clone();
        edit(&mut rows);
        forged(BOXES, &[("/witness/transfer/boxes", To(rows.into()))])
    };
    let refused = |report: &Report, verdict| assert_refused(report, verdict, "transfer bound", "/witness/transfer");
    refused(&boxes(|rows| rows[0][0] = json!("1/1000")), Verdict::Invalid);
    refused(&boxes(|rows| drop(rows.remove(1))), Verdict::Invalid);
    refused(&boxes(|rows| drop(rows[1].as_array_mut().unwrap().pop())), Verdict::Invalid);
    refused(&forged(BOXES, &[("/witness/k1", Times(0.9))]), Verdict::Invalid);
    // A box that is too coarse is not proved; that refutes nothing.
    let ends = |rows: &mut Vec<Value>| rows[0] = json!([rows[0][0], "1/2", "3/2", "5/2"]);
    refused(&boxes(ends), Verdict::Undecided);
}
