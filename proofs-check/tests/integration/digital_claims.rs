//! What a claim about a digital regulator says, and forgeries: one kind of certificate as the other, fields of the other kind.

use crate::common::{PAPER, assert_refused, certificate, rehash};
use crate::digital_support::{answer, edited, made, refuses, words};
use crate::mutations::{pointers, replacements};
use proofs_check::check;
use proofs_check::verdict::Verdict::{BadInput, Invalid, Valid};
use serde_json::{Value, json};
use std::collections::BTreeMap;

#[test]
fn what_is_proved_and_what_is_assumed() {
    let report = answer(made(), &[]);
    let subject = &report.proved.as_ref().unwrap().subject;
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
    let right = words(&made());
    for (part, instead) in [
        ("sigma = 60", "sigma >= 60"),
        ("n_o < 200/2", "n_o >= 0"),
        ("sampling instant", "initial time"),
        ("K = 0.98", "K = 0.99"),
        ("200 samples", "20 samples"),
    ] {
        let mut forged = made();
        assert!(right.contains(part));
        forged["claim"]["statement"] = right.replacen(part, instead, 1).into();
        rehash(&mut forged);
        assert_refused(&check(forged.to_string().as_bytes()), Invalid, "claim", "/claim/statement");
    }
}

#[test]
fn only_the_fields_of_a_digital_certificate() {
    for name in ["regulator", "sigma", "sampling_period", "samples", "gain", "mu", "n_o", "derivation", "statement"] {
        let mut made = edited(made(), &[]);
        made["claim"]["statement"] = words(&made).into();
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
    refuses(made(), &unmatched, Invalid, "digital regulator", "/claim");
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
    refuses(continuous, &changes, Invalid, "digital regulator", "/witness/k0");
    // A digital certificate as one for every gain above 60.
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

/// Why an accepted change of a leaf leaves a true claim, or `None`: then it is a hole.
fn harmless(pointer: &str, kind: &str) -> Option<&'static str> {
    let below = |prefix: &str| pointer.starts_with(prefix);
    match pointer {
        "/precision_bits" => Some("where the checker starts"),
        "/tool/name" | "/tool/version" => Some("free text"),
        "/claim/mu" | "/claim/sampling_period" if kind.starts_with("appended") => {
            Some("white space after an expression")
        }
        "/conditions" if kind == "deleted" => Some("figures: no claim rests on them"),
        _ if below("/specification/") && kind.ends_with("re-hashed") => {
            Some("other data, named by their digest, for which every condition is proved")
        }
        _ if below("/claim/periodic_solution/")
            && (kind.starts_with("up") || kind == "deleted" && pointer.ends_with("/z")) =>
        {
            Some("a bound larger than it need be, or none of z")
        }
        "/claim/sigma" | "/claim/gain" if kind.ends_with(", said") => Some("another law, and the words say which"),
        _ if below("/claim/initial_set/") && kind.ends_with("1e-9, said") => {
            Some("another set, and the words say which")
        }
        _ if below("/witness/") && (kind.starts_with("up") || kind.starts_with("down")) => {
            Some("another free number, with which every condition is proved")
        }
        _ => None,
    }
}

#[test]
fn every_leaf() {
    let mut original = made();
    original["claim"]["statement"] = words(&original).into();
    rehash(&mut original);
    assert_eq!(check(original.to_string().as_bytes()).verdict, Valid);
    let (mut all, mut made, mut holes) = (Vec::new(), 0, Vec::new());
    pointers(&original, String::new(), &mut all);
    let mut accepted: BTreeMap<&str, usize> = BTreeMap::new();
    let mut judge = |pointer: &str, kind: &str, mutant: &Value| {
        made += 1;
        if check(mutant.to_string().as_bytes()).verdict != Valid {
            return;
        }
        match harmless(pointer, kind) {
            Some(class) => *accepted.entry(class).or_default() += 1,
            None => holes.push(format!("{pointer}: {kind}")),
        }
    };
    for pointer in all.iter().skip(1) {
        let value = original.pointer(pointer).unwrap();
        let (parent, last) = pointer.rsplit_once('/').unwrap();
        if let Some(Value::Object(map)) = original.pointer(parent) {
            let mut mutant = original.clone();
            let mut fields = map.clone();
            fields.remove(last);
            *mutant.pointer_mut(parent).unwrap() = fields.into();
            judge(pointer, "deleted", &mutant);
        }
        if value.is_object() || value.is_array() {
            continue;
        }
        for (kind, replacement) in replacements(value).into_iter().filter(|(_, new)| new != value) {
            let mut mutant = original.clone();
            *mutant.pointer_mut(pointer).unwrap() = replacement;
            judge(pointer, kind, &mutant);
            // The words made to fit: what a careful forger does.
            if pointer.starts_with("/claim/") && pointer != "/claim/statement" {
                mutant["claim"]["statement"] = words(&mutant).into();
                judge(pointer, &format!("{kind}, said"), &mutant);
            }
            if pointer.starts_with("/specification/") {
                mutant["claim"]["statement"] = words(&mutant).into();
                rehash(&mut mutant);
                judge(pointer, &format!("{kind}, re-hashed"), &mutant);
            }
        }
    }
    println!("{made} mutants, {} accepted", accepted.values().sum::<usize>());
    accepted.iter().for_each(|(class, count)| println!("  {count:5}  {class}"));
    assert!(made > 600);
    assert!(holes.is_empty(), "accepted and not known to be harmless:\n{}", holes.join("\n"));
}
