//! What a claim about a sampled regulator says, and forgeries: one kind of certificate as the other, fields of the other kind.

use crate::common::{PAPER, assert_refused, assert_words_are_ignored, certificate, edited, judged, rehash, said};
use crate::sampled_support::{answer, made, refuses, words};
use proofs_check::check;
use proofs_check::verdict::Verdict::{BadInput, Invalid};
use serde_json::{Value, json};

#[test]
fn what_is_proved_and_what_is_assumed() {
    let report = answer(made(), &[]);
    let subject = report.subject.as_ref().unwrap();
    for part in [
        "digital regulator with the gain sigma = 60, the sampling period h = 1/200 (200 samples a period)",
        "every number of oscillators n_o < 200/2",
        "every phase of the sampling grid",
        "at any sampling instant",
    ] {
        assert!(subject.statement.contains(part), "{part} in {}", subject.statement);
    }
    assert!(!subject.statement.contains("every gain") && subject.also.is_none());
    let assumed = subject.assumed.join("\n");
    for part in [
        "u is held",
        "the plant runs continuously",
        "no computation delay",
        "no rounding of the regulator's arithmetic",
        "no quantisation",
        "no saturation",
    ] {
        assert!(assumed.contains(part), "{part} in {assumed}");
    }
    assert!(!assumed.contains("continuous time"), "{assumed}");
    assert!(report.text(false).contains("proved:  For the digital regulator"));
}

#[test]
fn words_are_fixed() {
    for (pointer, value) in [
        ("/claim/n_o", "every n_o >= 0"),
        ("/claim/n_o", "every n_o < 100"),
        ("/claim/n_o", "every n_o <= samples/2"),
        ("/claim/verdict", "refuted"),
        ("/claim/mu", "2"),
        ("/claim/initial_set/kind", "at-rest"),
    ] {
        refuses(made(), &[(pointer, json!(value))], Invalid, "claim", pointer);
    }
    let mut certificate = made();
    rehash(&mut certificate);
    let right = words(&certificate);
    assert_eq!(said(&judged(&certificate)), right);
    for (part, instead) in [
        ("sigma = 60", "sigma >= 60"),
        ("n_o < 200/2", "n_o >= 0"),
        ("sampling instant", "initial time"),
        ("K = 0.98", "K = 0.99"),
        ("200 samples", "20 samples"),
    ] {
        assert!(right.contains(part));
        assert_words_are_ignored(&certificate, &right.replacen(part, instead, 1));
    }
}

#[test]
fn only_the_fields_of_a_sampled_certificate() {
    for name in ["regulator", "sigma", "sampling_period", "samples", "gain", "mu", "n_o", "derivation", "statement"] {
        let mut made = made();
        made["claim"].as_object_mut().unwrap().remove(name);
        rehash(&mut made);
        assert_refused(&check(made.to_string().as_bytes()), BadInput, "format", "/claim");
    }
    for name in ["X_p", "E_p", "r_x", "r_e", "r_d", "D_x", "D_e", "w_x", "h", "k0", "k1", "transfer", "weight_sum"] {
        refuses(made(), &[(&format!("/witness/{name}"), Value::Null)], BadInput, "format", "/witness");
    }
    for (place, value) in [
        ("/claim/sigma_star", json!("60")),
        ("/claim/n", json!("1")),
        ("/witness/kap", json!("0")),
        ("/witness/refined", json!({ "r_x": "1", "r_e": "1", "r_d": "1" })),
        ("/witness/lmi", json!({ "l_x": "1", "l_e": "1", "l_f": "1" })),
        ("/witness/p_x", json!("1")),
        ("/witness/exact_regulation", certificate(PAPER)["witness"]["exact_regulation"].clone()),
        ("/constants", json!({})),
        ("/comparison", certificate(PAPER)["comparison"].clone()),
        ("/no_plant", json!({})),
        ("/claim/regulator", json!("analog")),
        ("/claim/regulator", json!(true)),
        ("/claim/derivation", json!("repaired")),
        ("/claim/derivation", json!("printed")),
        ("/claim/sigma", json!("2*30")),
        ("/claim/gain", json!("1 - 0.0114")),
        ("/witness/weight_sum", json!("zeta")),
    ] {
        refuses(made(), &[(place, value)], BadInput, "format", place);
    }
    refuses(
        made(),
        &[("/specification/internal_model/matched", json!(false))],
        Invalid,
        "specification",
        "/specification",
    );
    let unmatched = [
        ("/specification/internal_model/matched", Value::Null),
        ("/specification/internal_model/sampling_period", Value::Null),
    ];
    refuses(made(), &unmatched, Invalid, "sampled regulator", "/claim");
}

#[test]
fn one_kind_is_not_the_other() {
    // A continuous certificate with the word `digital`, and with all the fields that one has.
    let continuous = certificate("paper-example.means");
    let word = edited(continuous.clone(), &[("/claim/regulator", json!("digital"))]);
    assert_refused(&check(word.to_string().as_bytes()), BadInput, "format", "/claim");
    let law = made()["claim"].clone();
    let mut changes = vec![("/claim/sigma_star", Value::Null)];
    for name in ["regulator", "sigma", "sampling_period", "samples", "gain", "n_o"] {
        let place: &str = ["/claim/", name].concat().leak();
        changes.push((place, law[name].clone()));
    }
    refuses(continuous.clone(), &changes, BadInput, "format", "/witness");
    for name in ["/witness/kap", "/witness/exact_regulation", "/witness/lmi", "/constants", "/comparison", "/no_plant"]
    {
        changes.push((name, Value::Null));
    }
    changes.push(("/witness/transfer", json!({ "proof": "sampled" })));
    changes.push(("/witness/weight_sum", json!("4.6123753533")));
    // What is left is the truth about the numbers: the continuous witness at 60 is too tight for 200 samples.
    refuses(continuous, &changes, Invalid, "sampled regulator", "/witness/k0");
    // A sampled certificate as one for every gain above 60.
    let mut forged = edited(made(), &[("/claim/regulator", Value::Null)]);
    rehash(&mut forged);
    assert_refused(&check(forged.to_string().as_bytes()), BadInput, "format", "/claim");
    let claim = forged["claim"].as_object_mut().unwrap();
    for name in ["sigma", "sampling_period", "samples", "gain"] {
        claim.remove(name);
    }
    forged["claim"]["sigma_star"] = json!("60");
    assert_refused(&check(forged.to_string().as_bytes()), BadInput, "format", "/witness");
    forged["witness"]["kap"] = json!("0");
    assert_refused(&check(forged.to_string().as_bytes()), BadInput, "format", "/witness/transfer");
}
