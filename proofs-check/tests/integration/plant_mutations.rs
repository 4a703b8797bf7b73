//! Leaves of a certificate of a plant, altered in every way that a forger or an accident might.
//!
//! The checker proves whatever the witness says, so another witness, or another plant under its own digest, may pass where all
//! of it is true. What may never pass: another claim for the same witness, a number that is certainly too good, and anything that
//! is not read.

use super::mutations::{of_claim, pointers, replacements};
use crate::common::{deleted, every, folder, rehash};
use proofs_check::check;
use proofs_check::verdict::Verdict;
use serde_json::Value;
use std::collections::BTreeMap;

fn stored(name: &str) -> Value {
    let text = std::fs::read_to_string(folder("").join(format!("{name}.json"))).unwrap();
    serde_json::from_str(&text).unwrap()
}

/// Numbers of the witness that are too good whatever the rest is: a defect, a rest or a bound that is no more than 0, a rate that
/// is no damping, a tube without room.
fn too_good(original: &Value, pointer: &str, kind: &str) -> bool {
    let sizes = ["/witness/orbit/defect", "/witness/orbit/radius", "/witness/orbit/tube"];
    let forcing = ["/witness/forcing/rest", "/witness/forcing/rest_t"];
    let vanishes = ["zero", "negated"].contains(&kind);
    let value = pointer.strip_suffix("/value").filter(|entry| entry.starts_with("/witness/bounds/"));
    let is_norm = value.is_some_and(|entry| {
        let bound = original.pointer(entry).and_then(|entry| entry["bound"].as_str()).unwrap_or_default();
        !["rate", "q_e_max"].contains(&bound)
    });
    let positive = original.pointer(pointer).is_some_and(|value| value != "0");
    vanishes && positive && (sizes.contains(&pointer) || forcing.contains(&pointer) || is_norm)
}

/// Why an accepted mutant is true, or `None`: then it is a hole in the checker.
fn harmless(original: &Value, pointer: &str, kind: &str) -> Option<&'static str> {
    let below = |prefix: &str| pointer.starts_with(prefix);
    match pointer {
        _ if too_good(original, pointer, kind) => None,
        "/precision_bits" => Some("where the checker starts; it proves the claim at whatever precision it takes"),
        "/tool/name" | "/tool/version" => Some("free text"),
        "/claim/mu" if kind.starts_with("appended") => Some("white space after an expression"),
        _ if (below("/claim/input_gain/") || below("/claim/period/")) && kind.starts_with("appended") => {
            Some("white space after an expression")
        }
        _ if below("/constants") || below("/conditions") => Some("figures: no claim rests on them"),
        _ if below("/witness/lmi") => Some("the multipliers prove C5 a second time"),
        _ if below("/plant/") && kind.ends_with("re-hashed") => {
            Some("another plant under its own digest, proved wholly")
        }
        _ if below("/witness/") => Some("another witness, with which everything is proved"),
        // A bound may be larger than what is proved, never smaller.
        _ if ["/claim/periodic_solution/", "/claim/control/"].into_iter().any(below) && kind.starts_with("up") => {
            Some("a bound larger than it need be")
        }
        _ if below("/claim/by_n_o/") && pointer.ends_with("/or_more") && kind == "deleted" => {
            Some("less is claimed, as the sentence says")
        }
        _ => None,
    }
}

#[test]
fn leaves_of_a_certificate_of_a_plant() {
    mutate("plants/motor-axis.certificate", every(7));
}

/// One whose stability rests on a matrix inequality.
#[test]
fn leaves_of_a_certificate_by_a_matrix_inequality() {
    mutate("plants/pendulum.certificate", every(13));
    mutate("plants/splitting.certificate", every(9));
}

/// Two with an input gain, one of them with an inequality of existence besides: all that is said of the gain, and some of the rest.
#[test]
fn leaves_of_certificates_with_an_input_gain() {
    mutate("gain/converter", every(19));
    mutate("gain/splitting", every(29));
}

/// What a certificate says of intervals.
const INTERVALS: [&str; 3] = ["/input_gain", "/parameters", "/period/"];

/// Of a stored certificate that is valid.
pub fn mutate(name: &str, stride: usize) {
    mutate_in(&stored(name), stride, &INTERVALS);
}

/// Of a certificate that is valid, all that is below some names and some of the rest.
pub fn mutate_in(original: &Value, stride: usize, names: &[&str]) {
    assert_eq!(check(original.to_string().as_bytes()).verdict, Verdict::Valid);
    let mut all = Vec::new();
    pointers(original, String::new(), &mut all);
    let (mut made, mut holes) = (0, Vec::new());
    let mut accepted: BTreeMap<&str, usize> = BTreeMap::new();
    let mut judge = |pointer: &str, kind: &str, mutant: &Value| {
        made += 1;
        let report = check(mutant.to_string().as_bytes());
        if report.verdict != Verdict::Valid {
            return;
        }
        match harmless(original, pointer, kind).or_else(|| of_claim(pointer, mutant, &report)) {
            Some(class) => *accepted.entry(class).or_default() += 1,
            None => holes.push(format!("{pointer}: {kind}")),
        }
    };
    // The figures are not looked at.
    let places = all.iter().skip(1).filter(|place| !place.starts_with("/con"));
    let is_named = |place: &str| names.iter().any(|part| place.contains(part));
    let named = all.iter().filter(|place| is_named(place));
    for (place, pointer) in places.step_by(stride).chain(named).enumerate() {
        let value = original.pointer(pointer).unwrap();
        if value.is_object() || value.is_array() {
            continue;
        }
        // What is named is altered everywhere, by turns in one half of the ways or the other.
        let (turn, each) = if is_named(pointer) { (place % every(2), every(2)) } else { (0, 1) };
        let all = replacements(value).into_iter().filter(|(_, new)| new != value);
        for (kind, replacement) in all.skip(turn).step_by(each) {
            let mut mutant = original.clone();
            *mutant.pointer_mut(pointer).unwrap() = replacement;
            judge(pointer, kind, &mutant);
            if pointer.starts_with("/plant/") {
                rehash(&mut mutant);
                judge(pointer, &format!("{kind}, re-hashed"), &mutant);
            }
        }
        judge(pointer, "deleted", &deleted(original, pointer));
    }
    println!("{made} mutants, {} accepted", accepted.values().sum::<usize>());
    accepted.iter().for_each(|(class, count)| println!("  {count:5}  {class}"));
    assert!(holes.is_empty(), "accepted and not known to be true:\n{}", holes.join("\n"));
    assert!(made * stride > 1000);
}
