//! What a certificate shows beside its claim, against plain 400-bit arithmetic with formulas of its own: the table of constants, the
//! repaired derivation, and the multipliers with which C5 is proved a second time.

use crate::plain::{BITS, Cell, R, Spec, parse, r};
use crate::support::{options, specification, specification_text};
use crate::witness::{SPECS, holds};
use rayon::prelude::*;
use rug::{Float, Rational};
use serde_json::{Value, json};
use sigmastar_lang::spec::Specification;
use sigmastar_prove::certificate::certificate_json;
use sigmastar_prove::certify::{Options, certify};
use std::collections::BTreeSet;

/// How wide an enclosure of 17 digits may be, relatively, and how far from a number one of six digits in words.
const DIGITS: f64 = 1e-15;
const WORDS: f64 = 1e-5;

fn stored(value: &Value) -> R {
    R::rational(&parse(value.as_str().expect("a text")))
}

fn times(value: &R, factor: f64) -> R {
    value * (r(1.0) + r(factor))
}

/// Whether an end lies on its side of a number, and no further from it than its digits make it.
fn is_end(end: &R, value: &R, below: bool) -> bool {
    let [near, far] = [&times(value, 1e-60), &times(value, -1e-60)].map(Clone::clone);
    let (least, most) = (near.min(&far), near.max(&far));
    let room = R(Float::with_val(BITS, value.0.abs_ref())) * R(Float::with_val(BITS, DIGITS));
    if below { *end <= most && least - end <= room } else { *end >= least && end - most <= room }
}

/// Whether a cell of the table holds what it should.
fn agrees(stored_cell: &Value, cell: &Cell<'_>) -> bool {
    let value = &stored_cell["value"];
    let ends = || [0, 1].map(|end| stored(&value[end]));
    match cell {
        Cell::Number(expected) => {
            value.is_array() && is_end(&ends()[0], expected, true) && is_end(&ends()[1], expected, false)
        }
        Cell::Span(low, high) => value.is_array() && is_end(&ends()[0], low, true) && is_end(&ends()[1], high, false),
        Cell::Largest(holds, limit) => {
            let words = match limit {
                Some(limit) if holds(limit) => "the whole domain",
                None if holds(&r(1e60)) => "unbounded",
                _ if holds(&r(1e-60)) => return value.is_array() && changes(ends(), &|at| holds(at)),
                _ => "no positive value",
            };
            stored_cell["reason"] == words
        }
        Cell::Least(holds) => changes(ends(), &|at| !holds(at)),
        Cell::Reason(expected) => {
            let words = stored_cell["reason"].as_str().unwrap_or_default();
            let numbers =
                words.split(|c: char| !c.is_ascii_digit() && c != '.').filter_map(|word| word.parse::<f64>().ok());
            let expected = expected.0.to_f64();
            numbers.into_iter().any(|number| (number / expected - 1.0).abs() < WORDS)
        }
    }
}

/// Whether a property holds just below two ends, which are as near as their digits let them be, and not just above.
fn changes([low, high]: [R; 2], holds: &dyn Fn(&R) -> bool) -> bool {
    let near = high <= times(&low, DIGITS);
    near && (low <= r(0.0) || holds(&times(&low, -DIGITS))) && !holds(&times(&high, DIGITS))
}

/// What of a table is not as it is computed here.
fn differing(spec: &Specification, certificate: &Value) -> Vec<String> {
    let plain = Spec::new(spec);
    let table = plain.table(certificate);
    let mut wrong = Vec::new();
    let mut found = BTreeSet::new();
    for (name, row) in certificate["constants"].as_object().expect("an object") {
        for (derivation, cell) in row.as_object().expect("an object").iter().filter(|(key, _)| *key != "evaluated_at") {
            let Some(((_, known), (expected, is_sound))) =
                table.iter().find(|((row, of), _)| row == name && of == derivation)
            else {
                wrong.push(format!("{name}, {derivation}: nothing gives it"));
                continue;
            };
            found.insert((name.clone(), *known));
            let unsound = if matches!(expected, Cell::Reason(_)) { "printed, infeasible" } else { "printed, unsound" };
            let is_status = match is_sound {
                Some(is_sound) => cell["status"] == if *is_sound { "sound" } else { unsound },
                None => cell["status"] == "sound" || cell["status"] == unsound,
            };
            if !is_status || !agrees(cell, expected) {
                wrong.push(format!("{name}, {derivation}: {cell}"));
            }
        }
    }
    wrong.extend(table.keys().filter(|key| !found.contains(*key)).map(|(name, of)| format!("{name}, {of} is missing")));
    wrong
}

#[test]
fn every_constant_agrees_with_a_second_computation() {
    let wrong = |name: &&str| {
        let spec = specification(name);
        let run = certify(&spec, Options::default()).unwrap();
        let certificate = certificate_json(&run).expect("certified");
        assert!(certificate["constants"].as_object().unwrap().len() > 40, "{name}");
        let mut wrong = differing(&spec, &certificate);
        // The repaired derivation, whose column is among them.
        let plain = Spec::new(&spec);
        let repaired = plain.repaired(&certificate).expect("it is proved");
        let fails = repaired.conditions.iter().filter(|condition| !holds(condition));
        wrong.extend(fails.map(|condition| format!("repaired: {}", condition.id)));
        // A little less of its gain is not enough for one of its conditions.
        let mut less = certificate.clone();
        let gain = &mut less["comparison"]["repaired"]["sigma_star"];
        *gain = (parse(gain.as_str().unwrap()) * Rational::from((999, 1000))).to_string().into();
        let enough = plain.repaired(&less).unwrap().conditions.iter().all(holds) || differing(&spec, &less).is_empty();
        wrong.extend(enough.then(|| "less of the gain is enough".to_owned()));
        wrong.into_iter().map(|what| format!("{name}: {what}")).collect::<Vec<String>>()
    };
    let wrong: Vec<String> = SPECS.par_iter().flat_map_iter(wrong).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// What is wrong is seen: in a value, a status, a reason, and what nothing gives.
#[test]
fn wrong_constants_are_seen() {
    let spec = specification("paper-example");
    let certificate = certificate_json(&certify(&spec, Options::default()).unwrap()).expect("certified");
    let with = |pointer: &str, value: Value| {
        let mut made = certificate.clone();
        let (parent, name) = pointer.rsplit_once('/').unwrap();
        made.pointer_mut(parent).expect("it exists")[name] = value;
        differing(&spec, &made).len()
    };
    let own = |pointer: &str| certificate.pointer(pointer).unwrap().as_str().unwrap().to_owned();
    let tau =
        parse(&own("/constants/tau/sharp/value/0")) * Rational::from((10_000_000_000_001_i64, 10_000_000_000_000_i64));
    assert_eq!(with("/constants/tau/sharp/value", json!([tau.to_string(), tau.to_string()])), 1);
    assert_eq!(with("/constants/K_alpha/sharp/value", json!(["1", "2"])), 1);
    assert_eq!(with("/constants/kappa_0/printed/status", json!("printed, unsound")), 1);
    let [low, high] = [0, 1].map(|end| own(&format!("/constants/sigma_p*/repaired/value/{end}")));
    assert_eq!(with("/constants/sigma_p*/repaired/value", json!([low.replacen('2', "1", 1), high])), 1);
    assert_eq!(with("/constants/sigma*/printed/reason", json!("it is at most 12.5")), 1);
    assert_eq!(with("/constants/K_beta", json!({ "sharp": {} })), 1);
    assert_eq!(with("/constants/tau", json!({})), 1);
}

/// The multipliers prove C5, and with a tenth or ten times of one of them they do not.
#[test]
fn multipliers_prove_c5_a_second_time() {
    let one_sided = |most: &str, less: &str| {
        let mut document: Value = serde_json::from_str(&specification_text("linear")).unwrap();
        (document["bounds"]["q_e"], document["bounds"]["q_e_max"]) = (less.into(), most.into());
        Specification::from_json("linear", &document.to_string()).unwrap()
    };
    let shipped = SPECS.iter().map(|name| (specification(name), true));
    // dq/de between two numbers that are not opposite, and one number.
    let changed = [(one_sided("-1/4", "1/2"), true), (one_sided("-1/2", "1/2"), false)];
    let mut moved = 0;
    for (spec, has_sector) in shipped.chain(changed) {
        let certificate = certificate_json(&certify(&spec, options()).unwrap()).expect("certified");
        let name = &spec.name;
        if certificate["witness"].get("lmi").is_none() {
            continue;
        }
        let plain = Spec::new(&spec);
        assert!(plain.multipliers_hold(&certificate), "{name}");
        assert_eq!(certificate["witness"]["lmi"]["l_e"] != "0", has_sector, "{name}");
        for multiplier in ["l_x", "l_e", "l_f"] {
            let value = parse(certificate["witness"]["lmi"][multiplier].as_str().unwrap());
            for factor in [(1, 1000), (1000, 1)] {
                let mut made = certificate.clone();
                let other = if value == 0 { Rational::from(1) } else { &value * Rational::from(factor) };
                made["witness"]["lmi"][multiplier] = other.to_string().into();
                assert!(!plain.multipliers_hold(&made), "{name}: {multiplier} times {factor:?}");
                moved += 1;
            }
        }
    }
    assert!(moved > 40, "{moved}");
}
