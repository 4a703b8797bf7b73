//! The remark that no plant has the data: where a certificate has it, it is decided like a claim.

use crate::common::{PAPER, assert_refused, assert_valid, certificate, edited, judged};
use proofs_check::verdict::Verdict::{BadInput, Invalid};
use serde_json::{Value, json};

/// By a column of the Jacobian at half a period.
const BY_JACOBIAN: &str = "periodic-jacobian.sharp";

fn forged(changes: &[(&str, Value)]) -> proofs_check::Report {
    judged(&edited(certificate(BY_JACOBIAN), changes))
}

#[test]
fn a_true_remark_is_proved_and_may_be_left_out() {
    let said =
        |report: &proofs_check::Report| report.lines.iter().any(|line| line.starts_with("no plant: no plant with"));
    let report = judged(&certificate(BY_JACOBIAN));
    assert_valid(&report);
    assert!(said(&report), "{}", report.text(true));
    let report = forged(&[("/no_plant", Value::Null)]);
    assert_valid(&report);
    assert!(!said(&report), "{}", report.text(true));
    // Another time that shows it; what the data allow is a figure.
    assert_valid(&forged(&[("/no_plant/t", json!("0.49")), ("/no_plant/rate_at_most", json!(["1", "1"]))]));
}

#[test]
fn a_false_remark_is_refused() {
    let exceeded = "/no_plant";
    for (place, value, at) in [
        ("/no_plant/X", "0", "/no_plant/X"),
        ("/no_plant/X", "-1", "/no_plant/X"),
        // The norm of the column there is no larger than what is allowed.
        ("/no_plant/t", "0", exceeded),
    ] {
        assert_refused(&forged(&[(place, json!(value))]), Invalid, "no plant", at);
    }
    // Of alpha it is not true, and it names no column then.
    let by_alpha =
        [("/no_plant/exceeded_by", json!("alpha")), ("/no_plant/t", Value::Null), ("/no_plant/column", Value::Null)];
    assert_refused(&forged(&by_alpha), Invalid, "no plant", exceeded);
    assert_refused(&forged(&by_alpha[..1]), BadInput, "format", "/no_plant");
    // Of the paper's example there are plants; and X has to lie in the domain.
    let remark = json!({ "X": "1/10", "rate_at_most": ["0", "0"], "exceeded_by": "alpha" });
    let of_paper = |remark: &Value| judged(&edited(certificate(PAPER), &[("/no_plant", remark.clone())]));
    assert_refused(&of_paper(&remark), Invalid, "no plant", exceeded);
    let far = edited(remark, &[("/X", json!("1e9"))]);
    assert_refused(&of_paper(&far), Invalid, "no plant", "/no_plant/X");
}

#[test]
fn fields() {
    for (place, value) in [
        ("/no_plant/X", json!("one")),
        ("/no_plant/rate_at_most", Value::Null),
        ("/no_plant/exceeded_by", json!("nothing")),
        ("/no_plant/exceeded_by", json!("rate")),
        ("/no_plant/column", json!(7)),
        ("/no_plant/column", json!("0")),
        ("/no_plant/t", Value::Null),
        ("/no_plant/more", json!("1")),
    ] {
        assert_refused(&forged(&[(place, value)]), BadInput, "format", "/no_plant");
    }
}
