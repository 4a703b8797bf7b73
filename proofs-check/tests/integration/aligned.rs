//! Certificates of a regulator that sets z = M e at its first instant, and of two paths: what is valid, and what no edit makes so.

use crate::common::{assert_refused, assert_valid, certificate, names, rehash, said, text, with};
use crate::plant_certificates;
use proofs_check::verdict::Verdict::{BadInput, Invalid, Undecided, Valid};
use proofs_check::{Report, check};
use serde_json::{Value, json};

const ALIGNED: &str = "paper-example-aligned.sharp";

/// The stored certificate after changes, with the digest made right.
fn edited(edit: impl FnOnce(&mut Value)) -> Report {
    let mut made = certificate(ALIGNED);
    edit(&mut made);
    rehash(&mut made);
    check(made.to_string().as_bytes())
}

/// The conditions that fail, by their lines.
fn failing(report: &Report) -> Vec<String> {
    let failing = report.lines.iter().filter(|line| line.contains(" FAILS: ") || line.contains(" undecided: "));
    failing.map(|line| line.split_whitespace().next().unwrap().to_owned()).collect()
}

/// The claim at rest.
fn claim_at_rest(made: &mut Value) {
    made["claim"]["initial_set"]["kind"] = json!("at-rest");
    made["claim"]["initial_set"]["Z0"] = json!("0");
}

/// The claim that is true; it names no Z0.
#[test]
fn the_claim_is_valid() {
    let report = edited(|_| ());
    assert_valid(&report);
    let claim = &certificate(ALIGNED)["claim"];
    assert!(claim["initial_set"].get("Z0").is_none());
    assert!(said(&report).contains("|e| <= 0.50092652, z = M e, at any initial time"));
}

/// What the specification asks for and what is claimed are the same start: neither set contains the other.
#[test]
fn the_kinds_must_agree() {
    let refused = |report: &Report| {
        assert_refused(report, Invalid, "sharp", "/witness");
        assert!(failing(report).contains(&"set".to_owned()), "{}", report.text(false));
    };
    let report = edited(|made| made["specification"]["initial_set"] = json!({ "kind": "at-rest" }));
    refused(&report);
    assert_eq!(failing(&report), ["set"], "of a smaller start nothing else fails");
    refused(&edited(claim_at_rest));
    // And a set at rest that is claimed to start aligned: of a stored certificate about one.
    let mut made = certificate("paper-example-at-rest.sharp");
    assert_valid(&check(made.to_string().as_bytes()));
    made["claim"]["initial_set"]["kind"] = json!("aligned");
    made["claim"]["initial_set"].as_object_mut().unwrap().remove("Z0");
    let report = check(made.to_string().as_bytes());
    refused(&report);
    assert_eq!(failing(&report), ["set"]);
}

/// An aligned claim has no Z0, one of another kind has one.
#[test]
fn only_other_kinds_have_a_z0() {
    let refused = |edit: fn(&mut Value)| assert_refused(&edited(edit), BadInput, "format", "/claim/initial_set");
    refused(|made| made["claim"]["initial_set"]["Z0"] = json!("0"));
    refused(|made| made["claim"]["initial_set"]["kind"] = json!("at-rest"));
    let report = edited(|made| made["specification"]["initial_set"]["Z0"] = json!("0"));
    assert_refused(&report, BadInput, "format", "/specification/initial_set/Z0");
}

/// A witness of an aligned start does not prove the claim at rest: zeta starts at -M e then, and C4 fails, nothing else.
#[test]
fn at_rest_the_same_witness_proves_nothing() {
    let report = edited(|made| {
        made["specification"]["initial_set"] = json!({ "kind": "at-rest" });
        claim_at_rest(made);
        // Without this part: its level condition is about another box.
        made["witness"].as_object_mut().unwrap().remove("exact_regulation");
    });
    assert_refused(&report, Invalid, "sharp", "/witness");
    assert_eq!(failing(&report), ["C4"], "{}", report.text(false));
}

/// The paths are those for which the gain is proved: with others, or none, the numbers that it rests on are larger.
#[test]
fn other_paths_prove_less() {
    let paths = |f: &str, q: &str| json!({ "f": f, "q": q });
    for (part, rule) in [("/witness", "sharp"), ("/witness/exact_regulation", "exact regulation")] {
        assert_eq!(certificate(ALIGNED).pointer(part).unwrap()["paths"], paths("x-first", "x-first"));
        for (f, q) in [
            ("x-first", "straight"),
            ("x-first", "e-first"),
            ("straight", "x-first"),
            ("e-first", "x-first"),
            ("straight", "straight"),
        ] {
            let report = with(ALIGNED, part, "paths", paths(f, q));
            assert_refused(&report, Invalid, rule, part);
            let found = failing(&report);
            assert!(
                !found.is_empty() && found.iter().all(|id| ["C5", "C5b"].contains(&id.as_str())),
                "{f} {q}: {found:?}"
            );
        }
        // As it was before there were paths: f x first, q straight.
        let report = edited(|made| drop(made.pointer_mut(part).unwrap().as_object_mut().unwrap().remove("paths")));
        assert_refused(&report, Invalid, rule, part);
        let named = with(ALIGNED, part, "paths", paths("x-first", "straight"));
        assert_eq!((report.lines, report.verdict), (named.lines, named.verdict));
    }
}

/// What is no path is not read as one.
#[test]
fn unknown_paths_are_no_paths() {
    for part in ["/witness", "/witness/exact_regulation"] {
        for (paths, at) in [
            (json!({ "f": "X-first", "q": "x-first" }), "/f"),
            (json!({ "f": "x-first", "q": "shortest" }), "/q"),
            (json!({ "f": "x-first", "q": null }), "/q"),
            (json!({ "f": "x-first" }), ""),
            (json!({ "f": "x-first", "q": "x-first", "g": "x-first" }), "/g"),
            (json!("x-first"), ""),
        ] {
            let place = format!("{part}/paths{at}");
            let report = with(ALIGNED, part, "paths", paths);
            assert_refused(&report, BadInput, "format", &place);
        }
    }
}

/// Certificates from before there were paths name none, and are valid as they are; that they are split straight is what they mean.
#[test]
fn older_certificates_stay_valid() {
    let older: Vec<String> = names("certificates").into_iter().filter(|name| name != ALIGNED).collect();
    assert!(older.len() >= 22);
    for name in older {
        let text = text("certificates", &name);
        assert!(!text.contains("\"paths\""), "{name}");
        assert_valid(&check(text.as_bytes()));
        assert_valid(&with(&name, "/witness", "paths", json!({ "f": "x-first", "q": "straight" })));
    }
}

/// Of a plant each bound is one of the list, at arguments that are no smaller: without q_x at (X_b, e_per) the x-first path of q has
/// no k_x, and the list has no other path's.
#[test]
fn a_plant_needs_the_bounds_of_its_paths() {
    let (stored, changed) = (plant_certificates::stored, plant_certificates::changed);
    let name = "paper-example-aligned";
    assert_eq!(changed(name, &[]).verdict, Valid);
    let list = stored(name)["witness"]["bounds"].as_array().unwrap().clone();
    let largest = |bound: &str| {
        let size = |entry: &Value| entry["X"].as_str().unwrap().parse::<f64>().unwrap();
        let of = list.iter().enumerate().filter(|(_, entry)| entry["bound"] == bound);
        of.max_by(|a, b| size(a.1).total_cmp(&size(b.1))).unwrap().0
    };
    for bound in ["q_x", "q_e", "f_e", "rate"] {
        let at = format!("/witness/bounds/{}", largest(bound));
        let report = changed(name, &[(&at, Value::Null)]);
        let finding = report.finding.as_ref().expect("it must be refused");
        assert!([Invalid, Undecided].contains(&report.verdict), "{bound}: {finding:?}");
    }
    for paths in [json!({ "f": "x-first", "q": "straight" }), json!({ "f": "e-first", "q": "x-first" })] {
        let report = changed(name, &[("/witness/paths", paths)]);
        assert!(report.finding.is_some() && [Invalid, Undecided].contains(&report.verdict), "{}", report.text(false));
    }
}
