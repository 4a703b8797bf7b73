//! Numbers by the number of oscillators of a plant that is linear in x and e (docs/mathematics.md, sections 14.3 and 14.5): a stored certificate, and
//! what is refused where anything of its parts is not what it is.

use super::plant_mutations::mutate;
use crate::common::{
    accepted, assert_refused, assert_words_are_ignored, certificate, deleted, edited, every, judged, parsed, rehash,
};
use crate::rates::{refused, times};
use proofs_check::json::decimal;
use proofs_check::verdict::Verdict::{self, BadInput, Invalid, Undecided};
use serde_json::{Value, json};

const RULE: &str = "by n_o";
const CLAIM: &str = "/claim/by_n_o";
const LINEAR: &str = "/witness/by_n_o/linear";

fn stored() -> Value {
    parsed("by-n-o", "family-gain")
}

/// Another value at a place, or none.
fn with(pointer: &str, value: Value) -> Value {
    edited(stored(), &[(pointer, value)])
}

#[track_caller]
fn is_refused(pointer: &str, value: Value, verdict: Verdict, rule: &str, place: &str) {
    refused(with(pointer, value), verdict, rule, place);
}

#[test]
fn a_stored_one_is_accepted() {
    let stored = stored();
    let report = accepted(&stored);
    let statement = &report.subject.as_ref().unwrap().statement;
    for (place, about) in ["n_o = 0", "n_o = 1", "every n_o >= 2"].into_iter().enumerate() {
        let text = |of: &str| stored.pointer(&format!("{CLAIM}/{place}{of}")).unwrap().as_str().unwrap();
        let [e, rms, u] = ["/steady/e", "/steady/e_rms", "/steady/u"].map(text);
        let [most_e, most_u] = ["/largest/e", "/largest/u"].map(text);
        let sentence = format!(
            " With {about} and sigma = 0.185552 exactly, |e| <= {e} (root mean square <= {rms}) and |u/2| <= {u} along the T-periodic solution, and \
             |e| <= {most_e} and |u/2| <= {most_u} at all times for these solutions."
        );
        assert!(statement.contains(&sentence), "{sentence}\n{statement}");
        assert!(report.lines.iter().any(|line| line.contains(&format!("by n_o: {about}: "))));
    }
    assert_words_are_ignored(&stored, "With n_o = 0 the error is 0.");
}

/// What is proved is sharp: a number that is a little smaller is not. What bounds the periodic solution exactly is refuted, what is computed of it
/// is not.
#[test]
fn smaller_numbers_are_refused() {
    let stored = stored();
    for (place, factor, verdict) in [
        ("claim/by_n_o/0/steady/e", 0.997, Invalid),
        ("claim/by_n_o/0/steady/e_rms", 0.998, Invalid),
        ("claim/by_n_o/0/steady/u", 0.98, Invalid),
        ("claim/by_n_o/1/steady/e", 0.997, Invalid),
        ("claim/by_n_o/1/steady/e_rms", 0.998, Invalid),
        ("claim/by_n_o/1/steady/u", 0.99, Invalid),
        ("claim/by_n_o/2/steady/u", 0.99, Invalid),
        ("claim/by_n_o/0/largest/e", 0.999_999, Invalid),
        ("claim/by_n_o/0/largest/u", 0.999_999, Invalid),
        ("claim/by_n_o/1/largest/e", 0.999_999, Invalid),
        ("claim/by_n_o/1/largest/u", 0.999_999, Invalid),
        ("claim/by_n_o/2/largest/e", 0.999_999, Invalid),
        ("claim/by_n_o/2/largest/u", 0.999_999, Invalid),
        ("witness/by_n_o/linear/sizes/0/x", 0.95, Invalid),
        ("witness/by_n_o/linear/sizes/0/zeta", 0.98, Undecided),
        ("witness/by_n_o/linear/sizes/1/x", 0.997, Invalid),
        ("witness/by_n_o/linear/sizes/1/zeta", 0.98, Undecided),
        ("witness/by_n_o/linear/sizes/2/zeta", 0.98, Undecided),
    ] {
        let place = format!("/{place}");
        refused(edited(stored.clone(), &[(&place, times(&stored, &place, factor))]), verdict, RULE, &place);
        // With room on the other side, where what rests on it does not use all of its own.
        let ends_in = |end: &str| place.ends_with(end);
        if ends_in("/e_rms") || place.contains("/largest/") {
            accepted(&edited(stored.clone(), &[(&place, times(&stored, &place, 1.01))]));
        }
    }
}

/// The numbers of one n_o are not those of another.
#[test]
fn numbers_of_another_n_o_are_refused() {
    let stored = stored();
    let of = |place: usize| {
        ["/steady", "/largest"].map(|part| stored.pointer(&format!("{CLAIM}/{place}{part}")).unwrap().clone())
    };
    let sizes = |place: usize| stored.pointer(&format!("{LINEAR}/sizes/{place}")).unwrap().clone();
    for (at, from, place) in
        [(0, 1, "/claim/by_n_o/0"), (0, 2, "/claim/by_n_o/0/steady/e"), (1, 2, "/claim/by_n_o/1/steady/e")]
    {
        let [steady, largest] = of(from);
        let changes = [
            (format!("{CLAIM}/{at}/steady"), steady),
            (format!("{CLAIM}/{at}/largest"), largest),
            (format!("{LINEAR}/sizes/{at}"), sizes(from)),
        ];
        let report = judged(&edited(stored.clone(), &changes));
        assert_refused(&report, Invalid, RULE, place);
    }
    // Those of n_o = 1 are too small for 0, and its u is too small for 2 or more.
    let [steady, _] = of(1);
    refused(
        edited(stored.clone(), &[(format!("{CLAIM}/2/steady/u"), steady["u"].clone())]),
        Invalid,
        RULE,
        "/claim/by_n_o/2/steady/u",
    );
}

#[test]
fn what_is_said_of_every_larger_number() {
    // Two harmonics of the forcing: with one oscillator one of them is left.
    let mut two = deleted(&deleted(&stored(), "/claim/by_n_o/2"), "/witness/by_n_o/linear/sizes/2");
    two["claim"]["by_n_o"][1]["or_more"] = true.into();
    refused(two, Undecided, RULE, "/claim/by_n_o/1/or_more");
    is_refused("/claim/by_n_o/2/or_more", false.into(), BadInput, "format", "/claim/by_n_o/2/or_more");
    is_refused("/claim/by_n_o/2/or_more", "true".into(), BadInput, "format", "/claim/by_n_o/2/or_more");
    is_refused("/claim/by_n_o/1/or_more", true.into(), BadInput, "format", "/claim/by_n_o/1/or_more");
    // Of the one number it may be said alone, and of every number from a later one on.
    accepted(&deleted(&stored(), "/claim/by_n_o/2/or_more"));
    accepted(&with("/claim/by_n_o/2/n_o", 7.into()));
}

#[test]
fn entries_have_a_form() {
    for (pointer, value, place) in [
        ("/claim/by_n_o/1/n_o", json!(0), "/claim/by_n_o/1/n_o"),
        ("/claim/by_n_o/2/n_o", json!(1), "/claim/by_n_o/2/n_o"),
        ("/claim/by_n_o/2/n_o", json!(101), "/claim/by_n_o/2/n_o"),
        ("/claim/by_n_o/2/n_o", json!("2"), "/claim/by_n_o/2/n_o"),
        ("/claim/by_n_o/2/n_o", json!(-2), "/claim/by_n_o/2/n_o"),
        ("/claim/by_n_o", json!([]), CLAIM),
        ("/claim/by_n_o", json!({}), CLAIM),
        ("/claim/by_n_o/0/more", json!("1"), "/claim/by_n_o/0/more"),
        ("/claim/by_n_o/0/steady/x", json!("1"), "/claim/by_n_o/0/steady/x"),
        ("/claim/by_n_o/0/largest/e_rms", json!("1"), "/claim/by_n_o/0/largest/e_rms"),
        ("/claim/by_n_o/0/steady/e", json!("one"), "/claim/by_n_o/0/steady/e"),
    ] {
        is_refused(pointer, value, BadInput, "format", place);
    }
    for field in ["n_o", "steady", "steady/e", "steady/e_rms", "steady/u", "largest", "largest/e", "largest/u"] {
        let report = judged(&deleted(&stored(), &format!("{CLAIM}/0/{field}")));
        assert_refused(&report, BadInput, "format", CLAIM);
    }
    for field in ["steady/e", "steady/e_rms", "steady/u", "largest/e", "largest/u"] {
        let place = format!("{CLAIM}/0/{field}");
        is_refused(&place, "-1e-9".into(), Invalid, RULE, &place);
    }
    let entry = stored()["claim"]["by_n_o"][0].clone();
    let many: Vec<Value> = (0..65).map(|n_o| edited(entry.clone(), &[("/n_o", n_o.into())])).collect();
    is_refused("/claim/by_n_o", many.into(), BadInput, "format", CLAIM);
}

#[test]
fn claim_and_witness_have_it_together() {
    let place = "/witness/by_n_o";
    refused(deleted(&stored(), place), BadInput, "format", place);
    refused(deleted(&stored(), CLAIM), BadInput, "format", place);
    accepted(&deleted(&deleted(&stored(), CLAIM), place));
    is_refused(place, json!({}), BadInput, "format", place);
    is_refused(place, json!([]), BadInput, "format", place);
    is_refused(&format!("{place}/more"), json!([]), BadInput, "format", &format!("{place}/more"));
    is_refused(&format!("{LINEAR}/more"), json!([]), BadInput, "format", &format!("{LINEAR}/more"));
}

#[test]
fn witnesses_have_a_form() {
    let (stored, forms, sizes) = (stored(), format!("{LINEAR}/forms"), format!("{LINEAR}/sizes"));
    let form = stored.pointer(&format!("{forms}/0")).unwrap();
    for (pointer, value) in [
        (&forms, json!([])),
        (&forms, json!([form, form, form])),
        (&format!("{forms}/0/P"), json!([])),
        (&format!("{forms}/0/P"), json!([["1", "0"], ["0", "1"]])),
        (&format!("{forms}/0/P"), json!([["1", "0"]])),
        (&format!("{forms}/0/p"), json!(["0"])),
        (&format!("{sizes}/0/e"), json!("1")),
        (&sizes, json!([])),
    ] {
        is_refused(pointer, value, BadInput, "format", pointer);
    }
    refused(deleted(&stored, &format!("{sizes}/2")), BadInput, "format", &sizes);
    for field in
        ["forms", "forms/0/P", "forms/0/p_up", "forms/0/w", "forms/0/k_p", "sizes", "sizes/0/x", "sizes/0/zeta"]
    {
        refused(deleted(&stored, &format!("{LINEAR}/{field}")), BadInput, "format", LINEAR);
    }
    for field in ["sizes/0/x", "sizes/2/x", "sizes/0/zeta"] {
        is_refused(&format!("{LINEAR}/{field}"), "-1".into(), Invalid, RULE, &format!("{LINEAR}/{field}"));
    }
    // Each form alone proves less.
    for (place, which) in [(0, "largest/e"), (1, "largest/u")] {
        let report = judged(&deleted(&stored, &format!("{forms}/{place}")));
        assert_refused(&report, Invalid, RULE, &format!("{CLAIM}/0/{which}"));
    }
}

/// P > 0, P <= p_up I, w and k_p > 0, and (14.3a) at both ends of the gain and of the parameter.
#[test]
fn forms_that_do_not_fall_are_refused() {
    let stored = stored();
    for field in ["p_up", "w", "k_p"] {
        for value in ["0", "-1"] {
            let place = format!("{LINEAR}/forms/1/{field}");
            is_refused(&place, value.into(), Invalid, "signs", &place);
        }
    }
    let place = format!("{LINEAR}/forms/1/P");
    for value in ["0", "-43"] {
        is_refused(&place, json!([[value]]), Invalid, RULE, &place);
    }
    let p = stored.pointer(&format!("{place}/0/0")).unwrap();
    let p_up = format!("{LINEAR}/forms/1/p_up");
    accepted(&with(&p_up, p.clone()));
    refused(
        edited(stored.clone(), &[(&p_up, times(&stored, &format!("{place}/0/0"), 1.0 - 1e-12))]),
        Invalid,
        RULE,
        &p_up,
    );
    // A little more or less of one of them, and the form of the proof is not definite.
    for (field, factor) in [("P/0/0", 0.8), ("P/0/0", 1.4), ("w", 0.8), ("w", 1.3), ("k_p", 0.8), ("k_p", 1.3)] {
        let place = format!("{LINEAR}/forms/1/{field}");
        let mut changes = vec![(place.clone(), times(&stored, &place, factor)), (p_up.clone(), json!("1000"))];
        changes.extend((0..3).map(|entry| (format!("{CLAIM}/{entry}/largest"), json!({ "e": "1000", "u": "1000" }))));
        let report = judged(&edited(stored.clone(), &changes));
        assert_refused(&report, Invalid, RULE, LINEAR);
    }
}

fn number(certificate: &Value, pointer: &str) -> f64 {
    let text = certificate.pointer(pointer).unwrap_or_else(|| panic!("{pointer} exists")).as_str().unwrap();
    decimal(text).unwrap().to_f64()
}

/// The bounds at all times by the formulas of section 14.5; `aligned`: z = M e at the start.
fn peaks(certificate: &Value, entry: usize, aligned: bool) -> [f64; 2] {
    let (sigma, mu, n_bar_squared, nominal) = (0.185_552, 1.0, 2.0 + 2.612_375_348_685_488, 2.0);
    let of_set = |name: &str| number(certificate, &format!("/claim/initial_set/{name}"));
    let steady = |name: &str| number(certificate, &format!("{CLAIM}/{entry}/steady/{name}"));
    let size = |name: &str| number(certificate, &format!("{LINEAR}/sizes/{entry}/{name}"));
    let start = if aligned { 0.0 } else { of_set("Z0") + f64::sqrt(n_bar_squared) * of_set("E0") };
    let [x, e, zeta] = [of_set("X0") + size("x"), of_set("E0") + steady("e"), start + size("zeta")];
    let mut least = [f64::INFINITY; 2];
    for form in 0..2 {
        let [p_up, w, k_p] =
            ["p_up", "w", "k_p"].map(|name| number(certificate, &format!("{LINEAR}/forms/{form}/{name}")));
        let level = |b: f64| p_up * x * x + w * e * e + b * mu * k_p / 2.0 * zeta * zeta;
        let moved = |b: f64| level(b) * (sigma * sigma / w + 2.0 * mu * n_bar_squared / (b * k_p));
        let of_u = moved(0.9).max(moved(1.1)).sqrt() / nominal;
        least = [least[0].min(steady("e") + (level(1.1) / w).sqrt()), least[1].min(steady("u") + of_u)];
    }
    least
}

/// `largest` is what the formulas say of the set, the forms and the periodic solution, and nothing less.
#[test]
fn the_largest_values_are_those_of_the_corollary() {
    let mut aligned = deleted(&stored(), "/claim/initial_set/Z0");
    aligned["claim"]["initial_set"]["kind"] = "aligned".into();
    aligned["plant"]["initial_set"]["kind"] = "aligned".into();
    rehash(&mut aligned);
    for (certificate, is_aligned) in [(stored(), false), (aligned, true)] {
        for entry in 0..3 {
            let exact = peaks(&certificate, entry, is_aligned);
            let with = |factors: [f64; 2]| {
                let [e, u] = [0, 1].map(|i| json!(format!("{:.15}", exact[i] * factors[i])));
                // The others have room.
                let mut changes: Vec<(String, Value)> =
                    (0..3).map(|other| (format!("{CLAIM}/{other}/largest"), json!({ "e": "9", "u": "9" }))).collect();
                changes[entry].1 = json!({ "e": e, "u": u });
                edited(certificate.clone(), &changes)
            };
            accepted(&with([1.0 + 1e-9; 2]));
            for (factors, name) in [([1.0 - 1e-9, 2.0], "e"), ([2.0, 1.0 - 1e-9], "u")] {
                refused(with(factors), Invalid, RULE, &format!("{CLAIM}/{entry}/largest/{name}"));
            }
        }
    }
}

/// Of other files nothing is proved by n_o.
#[test]
fn of_what_it_is_proved() {
    let parts = |mut certificate: Value, states: usize| {
        let entry =
            json!({ "n_o": 0, "steady": { "e": "9", "e_rms": "9", "u": "9" }, "largest": { "e": "9", "u": "9" } });
        let p: Vec<Vec<&str>> =
            (0..states).map(|i| (0..states).map(|j| if i == j { "1" } else { "0" }).collect()).collect();
        let size = if states > 0 { json!({ "x": "1e9", "zeta": "1e9" }) } else { json!({ "zeta": "1e9" }) };
        certificate["claim"]["by_n_o"] = json!([entry]);
        certificate["witness"]["by_n_o"] =
            json!({ "linear": { "forms": [{ "P": p, "p_up": "1", "w": "1", "k_p": "1" }], "sizes": [size] } });
        certificate
    };
    let mut unmatched = stored();
    unmatched["plant"]["internal_model"]["matched"] = false.into();
    rehash(&mut unmatched);
    for (certificate, cause) in [
        (parts(certificate("linear.sharp"), 0), "formulas"),
        (parts(parsed("plants", "family-gain.certificate"), 1), "`cells`"),
        (parts(parsed("periods", "motor-axis"), 1), "a period that is one number"),
        (unmatched, "a `matched` base frequency"),
    ] {
        let report = judged(&certificate);
        assert_refused(&report, Undecided, RULE, CLAIM);
        assert!(report.finding.unwrap().message.contains(cause), "{cause}");
    }
    // A form at samples has more.
    refused(parts(parsed("plants", "converter-samples.certificate"), 2), BadInput, "format", LINEAR);
}

#[test]
fn leaves_of_it() {
    mutate("by-n-o/family-gain", every(11));
}
