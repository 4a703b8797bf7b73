//! Rates for given numbers of oscillators (docs/mathematics.md, section 13.6): accepted as they are written, and refused where anything
//! of them is not what it is.

use crate::common::{accepted, assert_refused, assert_words_are_ignored, edited, judged, names, parsed, rehash, said};
use proofs_check::verdict::Verdict;
use rug::Rational;
use serde_json::{Value, json};

/// One of a specification with x, for n_o = 0 and 2.
const PAPER: &str = "paper-example-at-rest";

fn stored(name: &str) -> Value {
    parsed("rates", name)
}

/// What the part `for_n_o` of a claim says, in words.
pub fn rates_in_words(certificate: &Value) -> String {
    let claim = &certificate["claim"];
    let sigma = ["sigma_star", "sigma"].iter().find_map(|name| claim[*name].as_str()).unwrap();
    let instants = if claim["regulator"].is_null() { "" } else { " at the sampling instants t" };
    let starts = if claim["initial_set"]["kind"] == "aligned" { " (z = M e of the measured e)" } else { "" };
    let text = |value: &Value| {
        let text = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
        if text.contains('/') { format!("({text})") } else { text }
    };
    let document = &certificate[if certificate["plant"].is_null() { "specification" } else { "plant" }];
    let parts = [
        (&document["measurement"]["noise"], "noise of at most ", " on the measurement of e"),
        (&document["measurement"]["quantum"], "a measurement of e in steps of ", ""),
        (&document["disturbance"], "a disturbance of at most ", " added to q"),
    ];
    let given = |value: &Value| !value.is_null() && text(value) != "0";
    let words =
        |(value, before, after): &(&Value, &str, &str)| given(value).then(|| format!("{before}{}{after}", text(value)));
    let mut noise: Vec<String> = parts.iter().filter_map(words).collect();
    if !claim["regulator"].is_null() && document["arithmetic"] == "double" {
        noise.push("computed in double precision as exported".to_owned());
    }
    let sentence = |entry: &Value| {
        let about = match entry["harmonics"].as_array() {
            None => format!("n_o = {}", entry["n_o"]),
            Some(all) => {
                let all: Vec<String> = all.iter().map(Value::to_string).collect();
                format!("oscillators at the harmonics {}", all.join(", "))
            }
        };
        let rate = format!(
            " With {about} and sigma = {sigma} exactly, |e(t) - e_per(t)| <= {} exp(-{} (t - t_0)){instants} for these solutions, where e_per is the e of the periodic solution and t_0 the initial time.",
            text(&entry["factor"]),
            text(&entry["rate"])
        );
        let limits = &entry["noise"];
        if limits.is_null() {
            return rate;
        }
        format!(
            "{rate} With {about} and sigma = {sigma} exactly, {}: |e(t) - e_per(t)| <= {} for these starts{starts} and all t >= t_0, \
             and its limit superior is at most {}.",
            noise.join(", "),
            text(&limits["peak"]),
            text(&limits["limit"])
        )
    };
    certificate["claim"]["for_n_o"].as_array().into_iter().flatten().map(sentence).collect()
}

/// A number of the certificate times a factor.
pub fn times(certificate: &Value, pointer: &str, factor: f64) -> Value {
    let before = certificate.pointer(pointer).unwrap().as_str().unwrap();
    let (numerator, denominator) = before.split_once('/').unwrap_or((before, "1"));
    let number = |text| proofs_check::json::decimal(text).unwrap();
    let value = number(numerator) / number(denominator) * Rational::from_f64(factor).unwrap();
    json!(value.to_string())
}

/// Refused as soon as a number, here times a factor, is another one: at these places.
#[track_caller]
pub fn each_refused(certificate: &Value, changes: &[(String, f64, String)]) {
    for (pointer, factor, place) in changes {
        let made = edited(certificate.clone(), &[(pointer, times(certificate, pointer, *factor))]);
        let report = judged(&made);
        assert_eq!(report.verdict, Verdict::Invalid, "{pointer} {factor}");
        assert_refused(&report, Verdict::Invalid, "rates", place);
    }
}

/// Refused with 0 or its opposite in the place of each of these numbers.
#[track_caller]
pub fn signs_are_demanded_at(certificate: &Value, pointers: impl IntoIterator<Item = String>) {
    for pointer in pointers {
        for value in [json!("0"), times(certificate, &pointer, -1.0)] {
            refused(edited(certificate.clone(), &[(&pointer, value)]), Verdict::Invalid, "rates", &pointer);
        }
    }
}

#[track_caller]
pub fn refused(certificate: Value, verdict: Verdict, rule: &str, pointer: &str) {
    assert_refused(&judged(&certificate), verdict, rule, pointer);
}

#[test]
fn stored_ones_are_accepted() {
    for name in names("rates") {
        let certificate = stored(&name);
        let report = accepted(&certificate);
        assert!(report.is_valid(), "{name}: {}", report.text(false));
        let statement = &report.subject.as_ref().unwrap().statement;
        for rate in certificate["claim"]["for_n_o"].as_array().unwrap() {
            assert!(statement.contains(&format!(" With n_o = {} and ", rate["n_o"])), "{name}: {statement}");
        }
    }
}

/// `exp(-1/1000 (t - t_0))` could be read in two ways.
#[test]
fn a_fraction_stands_in_parentheses() {
    let mut slower = stored(PAPER);
    let before = slower["claim"]["for_n_o"][0]["rate"].as_str().unwrap().to_owned();
    slower["claim"]["for_n_o"][0]["rate"] = times(&slower, "/claim/for_n_o/0/rate", 0.5);
    let rate = slower["claim"]["for_n_o"][0]["rate"].as_str().unwrap().to_owned();
    assert!(rate.contains('/') && !before.contains('/'), "{before} {rate}");
    accepted(&slower);
    assert!(said(&judged(&slower)).contains(&format!("exp(-({rate}) (t - t_0))")), "{rate}");
}

#[test]
fn each_number_matters() {
    for name in names("rates") {
        let certificate = stored(&name);
        let count = certificate["claim"]["for_n_o"].as_array().unwrap().len();
        for i in 0..count {
            let (claim, witness) = (format!("/claim/for_n_o/{i}"), format!("/witness/for_n_o/{i}"));
            let mut changes = vec![
                // Twice is beyond the largest rate that can be proved, or the factor would not do.
                (format!("{claim}/rate"), 2.0, format!("{witness}/Pi")),
                (format!("{claim}/factor"), 1.0 - 1e-4, format!("{claim}/factor")),
                (format!("{witness}/e_low"), 1.02, format!("{witness}/e_low")),
                (format!("{witness}/e_low"), 1.0 - 1e-3, format!("{claim}/factor")),
                (format!("{witness}/e_up"), 1.01, format!("{claim}/factor")),
                (format!("{witness}/e_up"), 0.5, format!("{witness}/z_up")),
                (format!("{witness}/z_up"), 0.5, format!("{witness}/z_up")),
                (format!("{witness}/Pi/0/0"), 3.0, witness.clone()),
                (format!("{witness}/Pi/1/1"), 3.0, witness.clone()),
                (format!("{witness}/Pi/1/1"), -1.0, format!("{witness}/e_low")),
            ];
            if certificate["witness"]["for_n_o"][i]["w"].is_string() {
                changes.extend(
                    [("w", 10.0), ("w", 0.1), ("l", 10.0), ("l", 0.1)]
                        .map(|(name, factor)| (format!("{witness}/{name}"), factor, format!("{witness}/Pi"))),
                );
            }
            each_refused(&certificate, &changes);
        }
    }
}

#[test]
fn signs_are_demanded() {
    let certificate = stored(PAPER);
    for (pointer, names) in
        [("/claim/for_n_o/0", &["rate", "factor"][..]), ("/witness/for_n_o/0", &["e_low", "w", "l"])]
    {
        signs_are_demanded_at(&certificate, names.iter().map(|name| format!("{pointer}/{name}")));
    }
}

/// What proves one n_o proves no other, and a rate stands beside what proves it.
#[test]
fn a_rate_is_that_of_its_own_number() {
    let certificate = stored(PAPER);
    let [claim, witness] = ["claim", "witness"].map(|part| certificate[part]["for_n_o"].clone());
    let with = |changes: &[(&str, Value)]| edited(certificate.clone(), changes);
    // Another n_o for both: Pi is of another order.
    let other = with(&[("/claim/for_n_o/1/n_o", json!(3)), ("/witness/for_n_o/1/n_o", json!(3))]);
    refused(other, Verdict::BadInput, "format", "/witness/for_n_o/1/Pi");
    refused(with(&[("/claim/for_n_o/1/n_o", json!(3))]), Verdict::BadInput, "format", "/witness/for_n_o/1/n_o");
    // In another order, twice, without one, with one too many.
    let both = |claim: Value, witness: Value| with(&[("/claim/for_n_o", claim), ("/witness/for_n_o", witness)]);
    let swapped = |list: &Value| json!([list[1], list[0]]);
    refused(both(swapped(&claim), swapped(&witness)), Verdict::BadInput, "format", "/claim/for_n_o/1/n_o");
    refused(
        both(json!([claim[0], claim[0]]), json!([witness[0], witness[0]])),
        Verdict::BadInput,
        "format",
        "/claim/for_n_o/1",
    );
    refused(both(claim.clone(), json!([witness[0]])), Verdict::BadInput, "format", "/witness/for_n_o");
    refused(both(json!([claim[0]]), witness.clone()), Verdict::BadInput, "format", "/witness/for_n_o");
    refused(with(&[("/witness/for_n_o", Value::Null)]), Verdict::BadInput, "format", "/witness/for_n_o");
    refused(with(&[("/claim/for_n_o", Value::Null)]), Verdict::BadInput, "format", "/witness/for_n_o");
    // Of one of them alone nothing is missing.
    accepted(&both(json!([claim[1]]), json!([witness[1]])));
    // The rate of another n_o.
    let lent = with(&[("/claim/for_n_o/1/rate", claim[0]["rate"].clone())]);
    refused(lent, Verdict::Invalid, "rates", "/witness/for_n_o/1/Pi");
}

/// A rate is proved at the gain of the claim, and of no other.
#[test]
fn a_rate_is_that_of_the_gain_of_the_claim() {
    let certificate = stored(PAPER);
    // The main claim holds at a larger gain too.
    let larger = times(&certificate, "/claim/sigma_star", 1.5);
    let moved = edited(certificate, &[("/claim/sigma_star", larger), ("/claim/control", Value::Null)]);
    let alone = edited(moved.clone(), &[("/claim/for_n_o", Value::Null), ("/witness/for_n_o", Value::Null)]);
    accepted(&alone);
    refused(moved, Verdict::Invalid, "rates", "/witness/for_n_o/0/Pi");
}

#[test]
fn the_words_are_those_of_the_numbers() {
    let certificate = stored(PAPER);
    assert!(said(&judged(&certificate)).ends_with(&rates_in_words(&certificate)));
    let statement = certificate["claim"]["statement"].as_str().unwrap().to_owned();
    for changed in [
        statement.split(" With n_o = ").next().unwrap().to_owned(),
        statement.replace("exactly", "or any larger"),
        statement.replace("With n_o = 0", "With n_o = 1"),
    ] {
        assert_words_are_ignored(&certificate, &changed);
    }
}

/// Without w and l only where x has no part in e.
#[test]
fn x_is_left_out_where_it_has_no_part() {
    let certificate = stored(PAPER);
    let without = [("/witness/for_n_o/0/w", Value::Null), ("/witness/for_n_o/0/l", Value::Null)];
    refused(edited(certificate.clone(), &without), Verdict::Invalid, "rates", "/witness/for_n_o/0");
    refused(edited(certificate.clone(), &without[..1]), Verdict::BadInput, "format", "/witness/for_n_o/0");
    // With more of q_x than was proved.
    let no_x = stored("no-x");
    assert!(no_x["witness"]["for_n_o"][0].get("w").is_none());
}

#[test]
fn data_that_say_less_prove_less() {
    let certificate = stored(PAPER);
    for (bound, more) in [("q_x", "sqrt(1 + E^2) + 3"), ("f_e", "X + 9"), ("q_e", "X + 9")] {
        let mut changed = edited(certificate.clone(), &[(&format!("/specification/bounds/{bound}"), json!(more))]);
        rehash(&mut changed);
        assert_eq!(judged(&changed).verdict, Verdict::Invalid, "{bound}");
    }
}

#[test]
fn what_cannot_be_read_is_named() {
    let certificate = stored(PAPER);
    let count = "/witness/for_n_o/0/n_o";
    let row = certificate["witness"]["for_n_o"][1]["Pi"][1].clone();
    for (pointer, value, place) in [
        ("/claim/for_n_o", json!({}), "/claim/for_n_o"),
        ("/claim/for_n_o/0/n_o", json!("0"), "/claim/for_n_o/0/n_o"),
        ("/claim/for_n_o/1/n_o", json!(101), "/claim/for_n_o/1/n_o"),
        (count, json!(1), "/witness/for_n_o/0/Pi"),
        ("/claim/for_n_o/0/rate", json!("inf"), "/claim/for_n_o/0/rate"),
        ("/claim/for_n_o/0/noise", json!("1"), "/claim/for_n_o/0/noise"),
        ("/claim/for_n_o/0/noise", json!({ "limit": "1", "peak": "2" }), "/witness/for_n_o/0"),
        ("/witness/for_n_o/0/k", json!("1"), "/witness/for_n_o/0/k"),
        ("/witness/for_n_o", json!([]), "/witness/for_n_o"),
        ("/witness/for_n_o/0/Pi/0", json!([]), "/witness/for_n_o/0/Pi/0"),
        ("/witness/for_n_o/1/Pi/2", row, "/witness/for_n_o/1/Pi/2"),
        ("/witness/for_n_o/0/e_up", json!("sqrt(2)"), "/witness/for_n_o/0/e_up"),
    ] {
        let report = judged(&edited(certificate.clone(), &[(pointer, value)]));
        assert_refused(&report, Verdict::BadInput, "format", place);
    }
}

/// Certificates with a delay have none, those at samples none of continuous time, and those of a matrix inequality or of joint metrics none by norms.
#[test]
fn other_claims_have_no_rates_by_norms() {
    let part =
        |certificate: &Value| [certificate["claim"]["for_n_o"].clone(), certificate["witness"]["for_n_o"].clone()];
    let [claim, witness] = part(&stored(PAPER));
    for (folder, name, place) in [
        ("sampled", "paper-example", "/witness/for_n_o/0"),
        ("sampled", "paper-example-delay", "/claim/for_n_o"),
        ("plants", "joint.certificate", "/witness/for_n_o/0/w"),
        ("plants", "splitting.certificate", "/witness/for_n_o/0/w"),
    ] {
        let other = parsed(folder, name);
        let made = edited(other, &[("/claim/for_n_o", claim.clone()), ("/witness/for_n_o", witness.clone())]);
        assert_refused(&judged(&made), Verdict::BadInput, "format", place);
    }
}
