//! Certificates about sampled regulators as the program writes them: all of it is right, and every leaf altered in every way.

use crate::common::{about, every, folder, names, parsed, rehash, text};
use crate::mutations::{of_claim, pointers, replacements};
use proofs_check::verdict::Verdict;
use proofs_check::{check, check_against};
use serde_json::{Value, json};
use std::collections::BTreeMap;

fn stored(name: &str) -> Value {
    parsed("sampled", name)
}

#[test]
fn every_stored_certificate_is_right() {
    for name in names("sampled") {
        let report = check(text("sampled", &name).as_bytes());
        assert!(report.is_valid(), "{name}: {}", report.text(false));
        let certificate = stored(&name);
        let asked = certificate[about(&certificate)].clone();
        let against = |asked: &Value| {
            check_against(certificate.to_string().as_bytes(), Some(asked.to_string().as_bytes())).verdict
        };
        assert_eq!(against(&asked), Verdict::Valid);
        let mut other = asked.clone();
        other["internal_model"]["sampling_period"] = json!("1/100000");
        assert_eq!(against(&other), Verdict::Invalid, "{name}");
        other["internal_model"].as_object_mut().unwrap().remove("sampling_period");
        assert_eq!(against(&other), Verdict::Invalid, "{name}");
    }
    assert!(folder("sampled").exists());
}

/// Each free number a little too good, alone: what its condition has to see.
#[test]
fn no_number_of_a_witness_may_be_too_good() {
    for name in names("sampled") {
        for (at, factor) in [
            ("/witness/r_e", 0.99),
            ("/witness/r_d", 0.99),
            ("/witness/E_p", 0.9),
            ("/witness/k0", 0.9),
            ("/witness/k1", 0.5),
            ("/witness/D_e", 0.99),
            ("/witness/weight_sum", 0.999_999),
            ("/claim/gain", 1.000_01),
            ("/claim/gain", 0.999_99),
            ("/claim/sigma", 0.9),
            ("/claim/periodic_solution/e", 0.999_999),
            ("/claim/periodic_solution/zeta", 0.999_999),
            ("/claim/periodic_solution/z", 0.999_999),
        ] {
            let mut forged = stored(&name);
            let field = forged.pointer_mut(at).unwrap();
            let value: f64 = field.as_str().unwrap().parse().unwrap();
            let better = format!("{:.17e}", value * factor);
            *field = better.into();
            assert_eq!(check(forged.to_string().as_bytes()).verdict, Verdict::Invalid, "{name}: {at} times {factor}");
        }
    }
}

#[test]
fn the_conditions_that_are_decided() {
    for (name, [level, form]) in [("paper-example", ["C4", "C5h"]), ("paper-example-delay", ["C4d", "C5d"])] {
        let report = check(text("sampled", name).as_bytes());
        for id in ["S0", "S0b", "S0c", "S0d", "T", "S1", "S2", "S2b", "S2c", level, form] {
            let holds = format!("  {id} holds: ");
            assert!(report.lines.iter().any(|line| line.starts_with(&holds)), "{name}: {id} in {}", report.text(true));
        }
    }
}

/// Why an accepted mutant is harmless, or `None`: then it is a hole.
fn harmless(pointer: &str, kind: &str) -> Option<&'static str> {
    let below = |prefix: &str| pointer.starts_with(prefix);
    match pointer {
        "/precision_bits" => Some("where the checker starts; it proves the claim at whatever precision it takes"),
        "/tool/name" | "/tool/version" => Some("free text"),
        _ if kind.starts_with("appended")
            && (["/claim/mu", "/claim/sampling_period"].contains(&pointer) || below("/claim/input_gain/")) =>
        {
            Some("white space after an expression")
        }
        _ if (below("/specification/") || below("/plant/")) && kind.ends_with("re-hashed") => {
            Some("other data, named by their digest, for which every condition is proved")
        }
        "/witness/D_x" | "/witness/D_e" if kind.starts_with("up") => {
            Some("the radius that is not the smaller part of C4, with which every condition is proved")
        }
        _ if below("/witness/forcing") => Some("another proof of what the formulas say"),
        _ if below("/witness/lyapunov")
            || below("/witness/coordinates")
            || below("/witness/orbit")
            || below("/witness/bounds") =>
        {
            Some("another proof of what the formulas say")
        }
        "/claim/periodic_solution/z" | "/claim/control" if kind == "deleted" => Some("nothing is said of z, or of u"),
        "/conditions" => Some("figures: no claim rests on them"),
        _ if below("/witness/") => Some("another witness, with which every condition is proved"),
        _ if (below("/claim/periodic_solution/") || below("/claim/control/"))
            && (kind.starts_with("up") || kind.starts_with("one")) =>
        {
            Some("a bound larger than it need be")
        }
        _ => None,
    }
}

/// Every `stride`-th place of a certificate.
fn mutate(name: &str, stride: usize) {
    let original = stored(name);
    let (mut all, mut made, mut holes) = (Vec::new(), 0, Vec::new());
    pointers(&original, String::new(), &mut all);
    let mut accepted: BTreeMap<&str, usize> = BTreeMap::new();
    let mut judge = |pointer: &str, kind: &str, text: &str| {
        made += 1;
        let report = check(text.as_bytes());
        if report.verdict != Verdict::Valid {
            return;
        }
        let class = harmless(pointer, kind);
        match class.or_else(|| of_claim(pointer, &serde_json::from_str(text).ok()?, &report)) {
            Some(class) => *accepted.entry(class).or_default() += 1,
            None => holes.push(format!("{pointer}: {kind}")),
        }
    };
    // The figures are not looked at.
    let places = all.iter().skip(1).filter(|place| !place.starts_with("/conditions/"));
    for pointer in places.step_by(stride) {
        let value = original.pointer(pointer).unwrap();
        let (parent, last) = pointer.rsplit_once('/').unwrap();
        let mut mutant = original.clone();
        match mutant.pointer_mut(parent).unwrap() {
            Value::Object(map) => {
                let removed = map.remove(last).unwrap();
                judge(pointer, "deleted", &mutant.to_string());
                let field = format!("{}:{removed}", Value::String(last.to_owned()));
                let text = original.to_string();
                let position = text.find(&field).unwrap();
                judge(pointer, "doubled", &format!("{}{field},{}", &text[..position], &text[position..]));
            }
            Value::Array(list) => {
                list.remove(last.parse::<usize>().unwrap());
                judge(pointer, "deleted", &mutant.to_string());
            }
            _ => unreachable!("a parent is an object or an array"),
        }
        if value.is_object() || value.is_array() {
            continue;
        }
        for (kind, replacement) in replacements(value).into_iter().filter(|(_, new)| new != value) {
            let mut mutant = original.clone();
            *mutant.pointer_mut(pointer).unwrap() = replacement;
            judge(pointer, kind, &mutant.to_string());
            if pointer.starts_with("/specification/") || pointer.starts_with("/plant/") {
                rehash(&mut mutant);
                judge(pointer, &format!("{kind}, re-hashed"), &mutant.to_string());
            }
        }
    }
    println!("{name}: {made} mutants, {} accepted", accepted.values().sum::<usize>());
    accepted.iter().for_each(|(class, count)| println!("  {count:5}  {class}"));
    assert!(holes.is_empty(), "{name}: accepted and not known to be harmless:\n{}", holes.join("\n"));
    assert!(made * stride > 300);
}

#[test]
fn places_of_a_specification() {
    mutate("paper-example", every(7));
}

#[test]
fn places_of_a_plant() {
    mutate("plant-motor-axis", 3 * every(7));
}

#[test]
fn places_of_every_other() {
    for name in names("sampled").iter().filter(|name| !["paper-example", "plant-motor-axis"].contains(&name.as_str())) {
        mutate(name, 7 * every(5));
    }
}
