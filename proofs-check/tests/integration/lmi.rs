//! Rule: C5 as a matrix inequality.

use crate::common::{PAPER, assert_valid, certificate, changed, with};
use proofs_check::interval::Interval;
use proofs_check::json::decimal;
use proofs_check::matrix::positive_definite;
use proofs_check::verdict::Verdict::{self, BadInput, Invalid};
use serde_json::json;

const RULE: &str = "matrix inequality of C5";
const LINEAR: &str = "linear.sharp";
const NO_X: &str = "no-x.sharp";

fn matrix(rows: &[&[i64]]) -> Vec<Vec<Interval>> {
    rows.iter().map(|row| row.iter().map(|entry| Interval::int(*entry, 64)).collect()).collect()
}

#[test]
fn definite_matrices() {
    for (rows, truth) in [
        (&[&[1_i64][..]][..], Some(true)),
        (&[&[-1]], Some(false)),
        (&[&[0]], None),
        (&[&[2], &[1, 1]], Some(true)),
        (&[&[1], &[1, 1]], None),
        (&[&[1], &[2, 3]], Some(false)),
        (&[&[1], &[-2, 3]], Some(false)),
        (&[&[4], &[2, 2], &[0, 1, 2]], Some(true)),
        (&[&[4], &[2, 2], &[2, 3, 3]], Some(false)),
        (&[&[4], &[2, 2], &[2, 3, 5]], None),
        (&[&[4], &[2, 2], &[2, -1, 9]], Some(true)),
        (&[&[4], &[2, 2], &[2, -1, 4]], Some(false)),
        (&[&[1], &[0, 1], &[0, 0, 1], &[1, 1, 1, 4]], Some(true)),
        (&[&[1], &[0, 1], &[0, 0, 1], &[1, 1, 1, 3]], None),
        (&[&[1], &[0, 1], &[0, 0, 1], &[1, 1, 1, 2]], Some(false)),
    ] {
        assert_eq!(positive_definite(matrix(rows)), truth, "{rows:?}");
    }
    // Wide entries: every member counts.
    let side = |lo: i64, hi: i64| Interval::int(lo, 64).hull(&Interval::int(hi, 64));
    let with = |off: Interval| vec![vec![Interval::int(1, 64)], vec![off, Interval::int(4, 64)]];
    assert_eq!(positive_definite(with(side(-1, 1))), Some(true));
    assert_eq!(positive_definite(with(side(1, 3))), None);
    assert_eq!(positive_definite(with(side(3, 4))), Some(false));
    let undefined = with(Interval::undefined(64));
    assert_eq!(positive_definite(undefined), None);
}

#[test]
fn shipped_multipliers_are_right_and_may_be_left_out() {
    for name in [PAPER, LINEAR, NO_X] {
        let mut certificate = certificate(name);
        assert!(certificate["witness"]["lmi"].is_object(), "{name}");
        let figures = |certificate: &serde_json::Value| {
            let report = proofs_check::check(certificate.to_string().as_bytes());
            assert_valid(&report);
            report.proved.expect("it is valid").figures.checked
        };
        let with = figures(&certificate);
        certificate["witness"].as_object_mut().unwrap().remove("lmi");
        assert_eq!(figures(&certificate), with - 1, "{name}: the matrix inequality is one figure");
    }
}

#[test]
fn each_multiplier_is_bounded_on_both_sides() {
    for name in [PAPER, LINEAR] {
        for multiplier in ["l_x", "l_e", "l_f"] {
            let pointer = format!("/witness/lmi/{multiplier}");
            for factor in ["0", "-1", "1/10", "10", "1e9"] {
                let value = certificate(name).pointer(&pointer).unwrap().as_str().map(decimal).unwrap().unwrap();
                let (n, d) = factor.split_once('/').unwrap_or((factor, "1"));
                let value = value * decimal(n).unwrap() / decimal(d).unwrap();
                let report = changed(name, &pointer, value.to_string());
                second_proof_fails(&report, Invalid, RULE, "/witness/lmi");
            }
        }
    }
}

#[test]
fn a_signal_that_vanishes_has_no_multiplier() {
    for multiplier in ["l_x", "l_f"] {
        let pointer = format!("/witness/lmi/{multiplier}");
        assert_eq!(certificate(NO_X).pointer(&pointer), Some(&json!("0")));
        second_proof_fails(&changed(NO_X, &pointer, "1"), Invalid, RULE, &pointer);
    }
}

#[test]
fn fields() {
    let at = "/witness/lmi";
    second_proof_fails(&with(PAPER, at, "l_z", "1"), BadInput, "format", "/witness/lmi/l_z");
    second_proof_fails(&with(PAPER, "/witness", "lmi", json!({"l_x": "1"})), BadInput, "format", at);
}

/// The claim stands by the closed form of C5; the multipliers are a figure that differs, and the only one.
#[track_caller]
fn second_proof_fails(report: &proofs_check::Report, verdict: Verdict, rule: &str, pointer: &str) {
    let proved = report.proved.as_ref().unwrap_or_else(|| panic!("{}", report.text(false)));
    let [finding] = &proved.figures.findings[..] else { panic!("{}", report.text(false)) };
    assert_eq!((finding.verdict, finding.rule), (verdict, rule), "{}", finding.message);
    assert!(finding.pointer.starts_with(pointer), "{}", finding.pointer);
}
