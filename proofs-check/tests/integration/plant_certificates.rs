//! Whole certificates of plants: a linear one, one without states, the paper's example; and what must not pass.

use crate::common::{assert_words_are_ignored, parsed, rehash, said};
use proofs_check::verdict::Verdict;
use proofs_check::{Report, check, check_against};
use serde_json::{Value, json};

const ALL: [&str; 3] = ["linear", "no-states", "paper-example"];

pub fn stored(name: &str) -> Value {
    parsed("plants", &format!("{name}.certificate"))
}

/// The answer after changes at places, which need not be there yet, with the digest made right again; `null` takes away.
pub fn changed(name: &str, changes: &[(&str, Value)]) -> Report {
    let mut certificate = stored(name);
    for (at, value) in changes {
        let (object, key) = at.rsplit_once('/').unwrap();
        let object = certificate.pointer_mut(object).unwrap();
        match (key.parse::<usize>(), value) {
            (Ok(index), Value::Null) => drop(object.as_array_mut().unwrap().remove(index)),
            (Ok(index), _) => object[index] = value.clone(),
            (Err(_), Value::Null) => drop(object.as_object_mut().unwrap().remove(key)),
            (Err(_), _) => object[key] = value.clone(),
        }
    }
    rehash(&mut certificate);
    check(certificate.to_string().as_bytes())
}

#[track_caller]
fn refused(report: &Report, verdict: Verdict, rule: &str) {
    let finding = report.finding.as_ref().expect("it must be refused");
    assert_eq!((report.verdict, finding.rule), (verdict, rule), "{}", report.text(false));
}

/// The place of the entry with this bound at the smallest X, and with this E.
fn entry(certificate: &Value, bound: &str, smallest: bool) -> usize {
    let size = |entry: &Value| entry["X"].as_str().unwrap().parse::<f64>().unwrap();
    let list = certificate["witness"]["bounds"].as_array().unwrap();
    let of = list.iter().enumerate().filter(|(_, entry)| entry["bound"] == bound);
    let order = |a: &(usize, &Value), b: &(usize, &Value)| size(a.1).total_cmp(&size(b.1));
    if smallest { of.min_by(order).unwrap().0 } else { of.max_by(order).unwrap().0 }
}

#[test]
fn certificates_are_valid_and_take_little_for_granted() {
    for name in ALL {
        let report = check(stored(name).to_string().as_bytes());
        assert_eq!(report.verdict, Verdict::Valid, "{}", report.text(false));
        let subject = report.subject.as_ref().unwrap();
        assert!(subject.assumed.len() == 2 && subject.also.is_some() && subject.about == "plant", "{subject:?}");
        assert_eq!(report.json()["plant_sha256"], stored(name)["plant_sha256"]);
        assert!(report.text(false).contains("  plant: SHA-256 "));
    }
}

/// With infinitely many oscillators it is x - x_0(t) that vanishes, not x, which is as large as the orbit; and of states that
/// are not there nothing is said.
#[test]
fn exact_regulation_is_of_the_deviation_from_the_orbit() {
    for (name, vanishes) in [
        ("linear", "x - x_0(t) and e tend to 0."),
        ("motor-axis", "x - x_0(t) and e tend to 0."),
        ("no-states", "are bounded, and e tends to 0."),
    ] {
        let report = check(stored(name).to_string().as_bytes());
        let also = report.subject.as_ref().and_then(|subject| subject.also.clone()).unwrap();
        assert!(also.ends_with(vanishes) && !also.contains("x and e"), "{name}: {also}");
        assert!(report.text(false).contains(vanishes) && report.json()["also_proved"] == json!(also), "{name}");
    }
    let text = check(stored("no-states").to_string().as_bytes()).text(false);
    for state in ["x_0", "x'", "|x", "x,"] {
        assert!(!text.contains(state), "{state}: {text}");
    }
}

#[test]
fn a_domain_without_states_is_one_of_e() {
    let domain = ("/plant/domain", json!({ "x": "1", "e": "5000" }));
    let report = changed("no-states", &[domain]);
    assert!(
        said(&report).contains("the plant of these formulas (a model that holds for |e| <= 5000) has"),
        "{}",
        report.text(false)
    );
}

#[test]
fn the_claim_says_what_is_proved() {
    let statement = |name: &str| stored(name)["claim"]["statement"].as_str().unwrap().to_owned();
    for name in ALL {
        assert_words_are_ignored(&stored(name), &statement(name).replace("sigma >= ", "sigma >= 1"));
        refused(&changed(name, &[("/claim/sigma_star", json!("0.1"))]), Verdict::Invalid, "sharp");
        refused(&changed(name, &[("/claim/derivation", json!("repaired"))]), Verdict::BadInput, "format");
        refused(&changed(name, &[("/specification", json!({}))]), Verdict::BadInput, "format");
        refused(&changed(name, &[("/witness/orbit", Value::Null)]), Verdict::BadInput, "format");
        let without =
            changed(name, &[("/witness/r_x", Value::Null), ("/witness/p_x", json!("1")), ("/witness/p_e", json!("1"))]);
        assert_eq!(without.verdict, Verdict::BadInput);
    }
    let mut forged = stored("linear");
    forged["plant_sha256"] = "0".repeat(64).into();
    refused(&check(forged.to_string().as_bytes()), Verdict::Invalid, "digest");
}

#[test]
fn the_ball_and_the_domain_are_decided_exactly() {
    let with_ball = |ball: &str| vec![("/claim/initial_set/ball", json!(ball))];
    // L = 1: the ball is the set.
    assert_eq!(changed("linear", &with_ball("0.08252114")).verdict, Verdict::Valid);
    refused(&changed("linear", &with_ball("0.08252115")), Verdict::Invalid, "coordinates");
    refused(&changed("linear", &with_ball("-0.01")), Verdict::Invalid, "coordinates");
    refused(&changed("linear", &[("/claim/initial_set/ball", Value::Null)]), Verdict::BadInput, "format");
    refused(&changed("no-states", &[("/claim/initial_set/ball", json!("0"))]), Verdict::BadInput, "format");
    for (asked, verdict) in [("0.0825", Verdict::Valid), ("0.0826", Verdict::Invalid)] {
        let set = json!({ "kind": "at-rest", "ball": asked });
        assert_eq!(changed("linear", &[("/plant/initial_set", set)]).verdict, verdict);
    }
    for (x, e, verdict) in
        [("1.16", "1.1", Verdict::Valid), ("1.1", "1.1", Verdict::Invalid), ("1.16", "0.9", Verdict::Invalid)]
    {
        let report = changed("linear", &[("/plant/domain", json!({ "x": x, "e": e }))]);
        assert_eq!(report.verdict, verdict, "{x}, {e}: {}", report.text(false));
    }
}

#[test]
fn a_condition_needs_an_entry_at_its_arguments() {
    let linear = stored("linear");
    for (bound, smallest) in [
        ("f_x", true),
        ("rate", true),
        ("f_e", false),
        ("q_x", false),
        ("q_e", false),
        ("rate", false),
        ("q_tx", true),
        ("q_te", true),
    ] {
        let index = entry(&linear, bound, smallest);
        let at = format!("/witness/bounds/{index}");
        let x: f64 = linear["witness"]["bounds"][index]["X"].as_str().unwrap().parse().unwrap();
        let smaller = changed("linear", &[(&format!("{at}/X"), json!(format!("{}", x * 0.999)))]);
        // Where a larger entry answers as well the certificate stays valid, for all values are the same here.
        let others =
            linear["witness"]["bounds"].as_array().unwrap().iter().filter(|other| other["bound"] == bound).count();
        let valid = smallest && others > 1;
        assert_eq!(smaller.verdict == Verdict::Valid, valid, "{bound}: {}", smaller.text(false));
        if !valid {
            assert_ne!(changed("linear", &[(&at, Value::Null)]).verdict, Verdict::Valid, "{bound}");
        }
    }
    let at = format!("/witness/bounds/{}/value", entry(&linear, "f_e", false));
    refused(&changed("linear", &[(&at, json!("0.5"))]), Verdict::Invalid, "bounds of the plant");
}

#[test]
fn a_second_matrix_has_rates_of_its_own() {
    let second = json!({ "P": [["2"]], "p_low": "2", "p_up": "2", "alpha": "1" });
    refused(&changed("linear", &[("/witness/lyapunov_existence", second.clone())]), Verdict::Undecided, "sharp");
    let index = entry(&stored("linear"), "rate", true);
    let name = format!("/witness/bounds/{index}/bound");
    let both = [("/witness/lyapunov_existence", second), (name.as_str(), json!("rate_existence"))];
    assert_eq!(changed("linear", &both).verdict, Verdict::Valid);
    let mut wrong = both.to_vec();
    let value = format!("/witness/bounds/{index}/value");
    wrong.push((&value, json!("1.01")));
    refused(&changed("linear", &wrong), Verdict::Invalid, "bounds of the plant");
}

/// What section 11.2 demands of the second P, each broken alone: its sizes, constant and in t, and its rate in the tube.
#[test]
fn a_second_matrix_lies_between_its_bounds() {
    let index = entry(&stored("linear"), "rate", true);
    let name = format!("/witness/bounds/{index}/bound");
    let wave = json!([{ "cos": [["1/100"]], "sin": [["0"]] }]);
    // With p_low = p_up every condition of existence holds as it did, whatever they are.
    let second = |size: &str, alpha: &str, in_t: bool| {
        let mut second = json!({ "P": [["2"]], "p_low": size, "p_up": size, "alpha": alpha });
        if in_t {
            second["harmonics"] = wave.clone();
        }
        changed("linear", &[("/witness/lyapunov_existence", second), (name.as_str(), json!("rate_existence"))])
    };
    assert_eq!(second("2", "1", false).verdict, Verdict::Valid);
    for (size, alpha, in_t, broken) in [
        ("2.0001", "1", false, "p_low I <= P"),
        ("1.9999", "1", false, "P <= p_up I"),
        ("2", "1.01", false, "alpha"),
        ("2.02", "0.9", true, "p_low I <= P"),
        ("1.98", "0.9", true, "P <= p_up I"),
    ] {
        let report = second(size, alpha, in_t);
        refused(&report, Verdict::Invalid, "orbit");
        let finding = report.finding.unwrap();
        assert!(finding.message.contains(broken) && finding.pointer.contains("lyapunov_existence"), "{finding:?}");
    }
}

#[test]
fn it_is_about_the_plant_that_is_asked_for() {
    let certificate = stored("paper-example");
    let asked = |plant: &Value| check_against(certificate.to_string().as_bytes(), Some(plant.to_string().as_bytes()));
    let mut plant = certificate["plant"].clone();
    assert_eq!(asked(&plant).verdict, Verdict::Valid);
    plant["initial"]["e"] = "5".into();
    plant["name"] = "another name".into();
    assert_eq!(asked(&plant).verdict, Verdict::Valid);
    plant["q"] = "x1".into();
    let report = asked(&plant);
    refused(&report, Verdict::Invalid, "the specification that was asked for");
    assert_eq!(report.finding.unwrap().pointer, "/plant/q");
}
