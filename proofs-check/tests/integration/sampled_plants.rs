//! Claims about a plant by its formulas under a sampled regulator: all of section 11 is proved as for a continuous one.

use crate::common::{edited, parsed, rehash};
use proofs_check::verdict::Verdict::{self, BadInput, Invalid, Undecided, Valid};
use proofs_check::{Report, check};
use serde_json::{Value, json};

/// The plant without states with sigma = 20 and 50 samples a period, from its certificate in continuous time.
fn made() -> Value {
    let mut made = parsed("plants", "no-states.certificate");
    let parts = made.as_object_mut().unwrap();
    ["constants", "comparison", "no_plant"].iter().for_each(|part| drop(parts.remove(*part)));
    made["conditions"] = json!([]);
    made["plant"]["internal_model"]["sampling_period"] = json!("1/50");
    made["claim"] = json!({
        "verdict": "certified", "derivation": "sharp", "regulator": "digital", "sigma": "20", "sampling_period": "1/50",
        "samples": 50, "gain": "0.955909849693", "n_o": "every n_o < samples/2", "mu": "1",
        "initial_set": { "kind": "at-rest", "X0": "0.0002000000004", "E0": "0.188057129", "Z0": "0" },
        "periodic_solution": { "x": "0.01", "e": "0.09399", "zeta": "1.9992" },
        "statement": "For the digital regulator with the gain sigma = 20, the sampling period h = 1/50 (50 samples a period) and K = \
            0.955909849693, for every number of oscillators n_o < 50/2 and every phase of the sampling grid, with period T = 1, mu = 1 \
            and base frequency 2*pi, the plant of these formulas has a T-periodic solution of the closed loop to which every solution \
            from |e| <= 0.188057129, sqrt(z'Nz) <= 0, at any sampling instant, converges exponentially.",
    });
    let witness = made["witness"].as_object_mut().unwrap();
    ["kap", "exact_regulation", "lmi"].iter().for_each(|part| drop(witness.remove(*part)));
    for (name, value) in [
        ("X_p", "0.0001000000001"),
        ("E_p", "0.09402856347"),
        ("r_x", "0.001000000001"),
        ("r_e", "0.05473708566"),
        ("r_d", "0.3448209826"),
        ("D_x", "0.00201347589399817"),
        ("D_e", "29.8479837349582"),
        ("w_x", "219756391.953726"),
        ("h", "2.0446275693176"),
        ("k0", "19.73920886"),
        ("k1", "59.29567458"),
        ("weight_sum", "4.6123753533"),
    ] {
        witness.insert(name.to_owned(), value.into());
    }
    made["witness"]["transfer"] = json!({ "proof": "sampled" });
    for entry in made["witness"]["bounds"].as_array_mut().unwrap() {
        entry["E"] = json!("40");
    }
    made
}

fn answer(changes: &[(&str, Value)]) -> Report {
    let mut made = edited(made(), changes);
    rehash(&mut made);
    check(made.to_string().as_bytes())
}

#[track_caller]
fn refused(changes: &[(&str, Value)], verdict: Verdict, rule: &str) {
    let report = answer(changes);
    let Some(finding) = report.finding.as_ref() else { panic!("{changes:?} is accepted") };
    assert_eq!((report.verdict, finding.rule), (verdict, rule), "{changes:?}: {}", report.text(false));
}

#[test]
fn a_plant_with_a_sampled_regulator() {
    let report = answer(&[]);
    assert_eq!(report.verdict, Valid, "{}", report.text(false));
    let subject = report.subject.as_ref().unwrap();
    assert!(subject.about == "plant" && subject.assumed.len() == 3 && subject.also.is_none(), "{subject:?}");
    assert!(subject.assumed[0].contains("exactly these formulas") && subject.assumed[1].contains("sampled law"));
}

#[test]
fn what_must_not_pass() {
    let at = |place: &'static str, value: &str| [(place, json!(value))];
    refused(&at("/plant/internal_model/sampling_period", "1/51"), Invalid, "sampled regulator");
    refused(&at("/plant/internal_model/sampling_period", "0.3"), Invalid, "specification");
    refused(&[("/plant/internal_model/matched", json!(false))], Invalid, "specification");
    refused(&at("/claim/sigma", "50.01"), Invalid, "sampled regulator");
    refused(&at("/claim/gain", "0.9559"), Invalid, "sampled regulator");
    refused(&at("/witness/r_d", "0.3448"), Invalid, "sampled");
    refused(&at("/witness/E_p", "0.0939"), Invalid, "sampled");
    refused(&at("/claim/periodic_solution/e", "0.09398"), Invalid, "claim");
    // Without an entry at its arguments a condition is not decided, and a false entry is refuted.
    let narrow = |index: usize| format!("/witness/bounds/{index}/E");
    let narrow: Vec<_> = (0..7).map(|index| (narrow(index), json!("29"))).collect();
    let narrow: Vec<_> = narrow.iter().map(|(place, value)| (place.as_str(), value.clone())).collect();
    refused(&narrow, Undecided, "sampled");
    refused(&at("/plant/q", "1 + tanh(3*sin(2*pi*t)) + e/100"), Invalid, "bounds of the plant");
    refused(&at("/witness/forcing/mean", "0.99"), Invalid, "forcing");
    refused(&[("/claim/initial_set/ball", json!("0"))], BadInput, "format");
    refused(&[("/witness/p_x", json!("1"))], BadInput, "format");
}

/// Without states the inequalities have a P of no rows, and the forms have four variables and five.
#[test]
fn inequalities_without_states() {
    let stability = json!({ "X": "1", "E": "40", "lambda": "1000", "rate": "1", "c_e": "0.5", "c_y": "0.1" });
    let existence = json!({
        "X": "1", "E": "1", "P": [], "lambda": "1000", "k_p": "1", "c_x": "1", "c_e": "0.5", "c_y": "0.3", "gamma": "20",
    });
    let with = |stability: &Value, existence: &Value| {
        let parts = [("matrix_inequality", stability), ("existence_inequality", existence)];
        parts.map(|(name, part)| (format!("/witness/{name}"), part.clone()))
    };
    let answer = |parts: &[(String, Value)]| {
        let parts: Vec<_> = parts.iter().map(|(place, part)| (place.as_str(), part.clone())).collect();
        answer(&parts)
    };
    let report = answer(&with(&stability, &existence));
    assert_eq!(report.verdict, Valid, "{}", report.text(false));
    for (name, value) in [("c_e", "60"), ("c_y", "5")] {
        let mut forged = stability.clone();
        forged[name] = value.into();
        let report = answer(&with(&forged, &existence));
        assert_eq!((report.verdict, report.finding.unwrap().rule), (Invalid, "matrix inequality"), "{name}");
    }
    for (name, value) in [("lambda", "0.001"), ("c_e", "60"), ("c_y", "5"), ("gamma", "0.1"), ("k_p", "0.1")] {
        let mut forged = existence.clone();
        forged[name] = value.into();
        let report = answer(&with(&stability, &forged));
        assert_eq!((report.verdict, report.finding.unwrap().rule), (Invalid, "existence inequality"), "{name}");
    }
}
