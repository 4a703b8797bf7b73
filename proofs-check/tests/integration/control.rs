//! The bounds of the control: no smaller than what is proved, of each kind of claim.

use proofs_check::check;
use proofs_check::verdict::Verdict;
use serde_json::{Value, json};

/// Certificates that were written without them, and what the other program says of the same witness.
const STORED: [(&str, &str, [f64; 2]); 6] = [
    ("C5 by norms", include_str!("../certificates/paper-example.sharp.json"), [13.1590861501, 120.594748871]),
    (
        "an aligned start",
        include_str!("../certificates/paper-example-aligned.sharp.json"),
        [13.3801559536, 45.1513445225],
    ),
    ("q_0", include_str!("../certificates/two-matrices.means.json"), [12.3008220725, 216.722216607]),
    ("at samples", include_str!("../sampled/paper-example.json"), [13.340741624, 129.312492593]),
    ("joint metrics", include_str!("../plants/joint.certificate.json"), [118.850020955, 178.912929661]),
    (
        "a plant at samples",
        include_str!("../plants/converter-samples.certificate.json"),
        [8444047.62724, 21873977.2331],
    ),
];

fn with(stored: &str, control: &Value) -> Value {
    let mut made: Value = serde_json::from_str(stored).expect("JSON");
    made["claim"]["control"] = control.clone();
    made
}

#[test]
fn a_bound_of_the_control_is_no_smaller_than_what_is_proved() {
    for (name, stored, bounds) in STORED {
        for factors in [[1.0 + 1e-9; 2], [1.0 - 1e-9, 2.0], [2.0, 1.0 - 1e-9]] {
            let [steady, transient] = [0, 1].map(|i| format!("{:.15e}", bounds[i] * factors[i]));
            let report =
                check(with(stored, &json!({ "steady": steady, "transient": transient })).to_string().as_bytes());
            let is_true = factors.iter().all(|factor| *factor > 1.0);
            if is_true {
                assert_eq!(report.verdict, Verdict::Valid, "{name}: {}", report.text(false));
                continue;
            }
            let finding = report.finding.as_ref().expect("it is too small");
            let field = if factors[0] < 1.0 { "/claim/control/steady" } else { "/claim/control/transient" };
            assert_eq!(
                (report.verdict, finding.rule, finding.pointer.as_str()),
                (Verdict::Invalid, "claim", field),
                "{name}"
            );
        }
    }
}

#[test]
fn both_bounds_are_there_and_nothing_else() {
    let good = json!({ "steady": "1e9", "transient": "1e9" });
    let stored = STORED[0].1;
    assert_eq!(check(with(stored, &good).to_string().as_bytes()).verdict, Verdict::Valid);
    for odd in [
        json!({ "steady": "1e9" }),
        json!({ "steady": "1e9", "transient": "inf" }),
        json!({ "steady": "1e9", "transient": "1e9", "all": "2e9" }),
        json!("1e9"),
    ] {
        let report = check(with(stored, &odd).to_string().as_bytes());
        assert_eq!(report.verdict, Verdict::BadInput, "{odd}: {}", report.text(false));
    }
}
