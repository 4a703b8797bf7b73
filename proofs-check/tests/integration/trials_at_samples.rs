//! A certificate with trials at samples (docs/mathematics.md, section 14.6): 40 samples a period, one entry about one oscillator and one about five or more.

use super::plant_mutations::mutate;
use crate::common::{accepted, deleted, edited, every, parsed};
use crate::rates::refused;
use proofs_check::json::decimal;
use proofs_check::verdict::Verdict::{BadInput, Invalid};
use serde_json::{Value, json};

const RULE: &str = "by n_o";
const CLAIM: &str = "/claim/by_n_o";
const TRIALS: &str = "/witness/by_n_o/trials";

fn stored() -> Value {
    parsed("by-n-o", "trials-at-samples")
}

/// With the number at a place times a factor.
fn scaled(at: &str, factor: f64) -> Value {
    let number = decimal(stored().pointer(at).unwrap().as_str().unwrap()).unwrap().to_f64();
    edited(stored(), &[(at, format!("{:e}", number * factor).into())])
}

#[test]
fn a_stored_one_is_accepted() {
    let report = accepted(&stored());
    let statement = &report.subject.as_ref().unwrap().statement;
    for about in ["n_o = 1", "every n_o >= 5 below 40/2"] {
        let line = format!("by n_o: {about}: the periodic solution near the trial, by ");
        assert!(report.lines.iter().any(|found| found.starts_with(&line)), "{:?}", report.lines);
        assert!(statement.contains(&format!(" With {about} and sigma = 4 exactly, |e| <= ")), "{statement}");
    }
}

#[test]
fn smaller_numbers_are_refused() {
    for entry in 0..2 {
        for name in ["steady/e", "steady/e_rms", "steady/u", "largest/e", "largest/u"] {
            let at = format!("{CLAIM}/{entry}/{name}");
            refused(scaled(&at, 0.9998), Invalid, RULE, &at);
        }
        for name in ["x", "zeta"] {
            let at = format!("{TRIALS}/{entry}/sizes/{name}");
            refused(scaled(&at, 0.9), Invalid, RULE, &at);
        }
    }
}

/// What is known of the formulas and of the curves.
#[test]
fn defects_and_slopes_are_those_of_the_formulas() {
    for entry in 0..2 {
        for (name, factor) in [("defect_x", 1e-3), ("defect_q", 1e-3), ("q_x", 0.99), ("q_e", 0.99)] {
            let at = format!("{TRIALS}/{entry}/{name}");
            refused(scaled(&at, factor), Invalid, RULE, &at);
        }
    }
    // A coefficient that is off by a ten-millionth of itself leaves a defect.
    for (curve, what) in [("x/harmonics/0/cos/0", "defect_x"), ("u/harmonics/0/sin", "defect_q")] {
        refused(scaled(&format!("{TRIALS}/1/{curve}"), 1.0000001), Invalid, RULE, &format!("{TRIALS}/1/{what}"));
    }
    // With another ehat there is another zeta.
    refused(scaled(&format!("{TRIALS}/0/e/harmonics/1/cos"), 1.5), Invalid, RULE, &format!("{TRIALS}/0/sizes/zeta"));
    let without = edited(stored(), &[(&format!("{TRIALS}/0/e/harmonics/0/cos"), "1e-30".into())]);
    refused(without, Invalid, RULE, &format!("{TRIALS}/0/e"));
}

/// (14.6b) of each form, with lambda for what moves within a sample and gamma for the defect of q.
#[test]
fn each_form_has_its_inequality() {
    for entry in 0..2 {
        let forms = format!("{TRIALS}/{entry}/forms");
        for (place, name, factor) in [
            (0, "gamma", 0.02),
            (0, "c_y", 4.0),
            (0, "c_e", 1e4),
            (0, "c_x", 1e4),
            (0, "lambda", 1e-4),
            (0, "k_p", 4.0),
            (1, "gamma", 1e-4),
            (1, "lambda", 1e-4),
            (2, "gamma", 1e-4),
        ] {
            let at = format!("{forms}/{place}/{name}");
            refused(scaled(&at, factor), Invalid, RULE, &format!("{forms}/{place}"));
        }
        // With h/pi for 3/2 h/pi it would hold with 28 times the lambda.
        refused(scaled(&format!("{forms}/1/lambda"), 26.0), Invalid, RULE, &format!("{forms}/1"));
        for (name, factor) in [("P_up", 0.99), ("x_low", 1.01), ("e_low", 1.01)] {
            let at = format!("{forms}/1/{name}");
            refused(scaled(&at, factor), Invalid, RULE, &at);
        }
        for name in ["lambda", "gamma"] {
            let at = format!("{forms}/0/{name}");
            refused(deleted(&stored(), &at), BadInput, "format", &format!("{forms}/0"));
            for value in ["0", "-1"] {
                refused(edited(stored(), &[(&at, value.into())]), BadInput, "format", &at);
            }
        }
        // A larger lambda costs more of what the control moves within a sample.
        let more = scaled(&format!("{forms}/0/lambda"), 4.0);
        refused(more, Invalid, RULE, &format!("{TRIALS}/{entry}/sizes/x"));
        // Metrics that join x and e are of continuous time.
        let at = format!("{forms}/1/p");
        refused(edited(stored(), &[(&at, json!(["1e-9"]))]), BadInput, "format", &at);
    }
}

/// The tube is in its box, and the box is one that solutions from the set do not leave, or the solution is not known to be that of the claim.
#[test]
fn the_box_holds_what_is_said_to_be_in_it() {
    for (name, factor) in [("x", 1e-6), ("e", 1e-3)] {
        let at = format!("{TRIALS}/0/box/{name}");
        refused(scaled(&at, factor), Invalid, RULE, &at);
    }
    // Solutions from the set may leave a smaller one; the function of the claim says less.
    let smaller = scaled(&format!("{TRIALS}/0/box/x"), 1e-3);
    refused(smaller, Invalid, RULE, &format!("{CLAIM}/0/largest/e"));
    let large = format!("{TRIALS}/0/box/e");
    refused(scaled(&large, 50.0), Invalid, RULE, &format!("{TRIALS}/0/forms/1"));
}

/// What a trial of five or more has is not enough for fewer, and the numbers of continuous time have no place.
#[test]
fn so_many_oscillators_or_more() {
    let [entry, trial] = [CLAIM, TRIALS].map(|list| json!([stored().pointer(&format!("{list}/1")).unwrap()]));
    let alone = edited(stored(), &[(CLAIM, entry), (TRIALS, trial)]);
    accepted(&alone);
    refused(edited(alone, &[(&format!("{CLAIM}/0/n_o"), 1.into())]), Invalid, RULE, &format!("{TRIALS}/0/u"));
    for (name, value) in [("defect_q_t", json!("1")), ("x_first", json!({})), ("f_e", json!("1"))] {
        let mut forged = stored();
        forged["witness"]["by_n_o"]["trials"][1][name] = value;
        refused(forged, BadInput, "format", &format!("{TRIALS}/1/{name}"));
    }
    // What stands of every larger number rests on the least weight below half of the samples: without `or_more` the same trial says more.
    let one = deleted(&stored(), &format!("{CLAIM}/1/or_more"));
    accepted(&one);
}

/// Another law, or other samples, have another loop; and harmonics that samples do not tell apart are refused.
#[test]
fn the_law_is_that_of_the_claim() {
    for (at, value) in
        [("/claim/sampling_period", json!("1/10")), ("/claim/samples", json!(20)), ("/claim/sigma", json!("3.9"))]
    {
        let report = proofs_check::check(edited(stored(), &[(at, value)]).to_string().as_bytes());
        assert!(report.verdict != proofs_check::verdict::Verdict::Valid, "{at}");
    }
    let mut forged = stored();
    let harmonics = forged.pointer_mut(&format!("{TRIALS}/0/x/harmonics")).unwrap().as_array_mut().unwrap();
    while harmonics.len() < 20 {
        harmonics.push(json!({ "cos": ["0"], "sin": ["0"] }));
    }
    refused(forged, Invalid, RULE, &format!("{TRIALS}/0"));
}

#[test]
fn leaves_of_it() {
    mutate("by-n-o/trials-at-samples", every(31));
}
