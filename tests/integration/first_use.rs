//! What a first use runs into at the command line; beside each the case that nearly does.

use crate::support::{EXAMPLE, program, utf8};
use serde_json::{Value, json};
use tempfile::TempDir;

/// A call, with a shipped file in another form at its end: the exit code, and both streams in one line.
fn told(command: &[&str], name: &str, change: impl FnOnce(&mut Value)) -> (i32, String) {
    let folder = TempDir::new().expect("a folder");
    let path = folder.path().join("file.json");
    let mut value: Value = serde_json::from_str(&std::fs::read_to_string(name).expect("shipped")).expect("JSON");
    change(&mut value);
    std::fs::write(&path, value.to_string()).expect("written");
    let output = program().args(command).arg(&path).output().expect("the program runs");
    let text = utf8(output.stdout) + &utf8(output.stderr);
    (output.status.code().expect("a code"), text.split_whitespace().collect::<Vec<_>>().join(" "))
}

const LINEAR: &str = "specs/plants/linear.json";
const PENDULUM: &str = "specs/plants/pendulum.json";
const CERTIFY: [&str; 2] = ["certify", "--no-compare"];

/// The states and right sides of a plant.
fn states(plant: &mut Value, states: &[&str], f: &[&str]) {
    (plant["states"], plant["f"]) = (json!(states), json!(f));
    plant.as_object_mut().expect("a plant").remove("initial");
}

#[test]
fn states_that_only_add_up_are_named() {
    let with = |names: &[&str], f: &[&str]| told(&CERTIFY, LINEAR, |plant| states(plant, names, f));
    for (names, f, sum, mean) in [
        (&["x"][..], &["e"][..], "x", None),
        (&["x"], &["e + 1 + cos(2*pi*t)"], "x", Some("1")),
        // Harmonics have no mean.
        (&["x"], &["e + cos(64*pi*t)"], "x", None),
        (&["v", "x"], &["-2*v + e - 3", "v"], "0.5*v + x", Some("-1.5")),
        (&["v", "x"], &["-2*v + e", "v"], "0.5*v + x", None),
        (&["v", "x"], &["e", "v"], "v", None),
    ] {
        let (code, text) = with(names, f);
        assert!(code == 3 && text.contains(&format!("no state acts on {sum}, which only adds up")), "{f:?}: {text}");
        let said = mean.map(|mean| format!("the mean of that over a period is {mean}, not 0"));
        assert_eq!(text.contains("the mean of that"), said.is_some(), "{f:?}: {text}");
        assert!(said.is_none_or(|said| text.contains(&said) && text.contains("stands in q")), "{f:?}: {text}");
        assert!(!text.contains("`initial`") && text.contains("at /f/"), "{f:?}: {text}");
    }
    // One that is pulled back, one that is pushed away, one whose pull depends on the state, a pair that oscillates.
    for (names, f, expected) in [
        (&["x"][..], &["-x/10 + e + 1"][..], 0),
        (&["x"], &["x/10 + e + 1"], 3),
        (&["x"], &["x^2 + e + 1"], 3),
        (&["v", "x"], &["-x + e", "v"], 3),
    ] {
        let (code, text) = with(names, f);
        assert!(code == expected && !text.contains("adds up"), "{f:?}: {text}");
    }
}

#[test]
fn an_initial_set_that_is_too_large_is_told_with_one_that_is_not() {
    let set =
        |share: u32| json!({ "kind": "box", "ball": format!("10/{share}"), "E0": format!("1/{share}"), "Z0": "0" });
    let with = |flags: &[&str], set: Value| {
        told(&[&["certify"], flags].concat(), PENDULUM, |plant| plant["initial_set"] = set)
    };
    let (code, text) = with(&[], set(1));
    assert!(code == 3 && text.contains("at /initial_set") && text.contains("with twice them none was found"), "{text}");
    let share: u32 = text
        .split_once("with all sizes divided by ")
        .and_then(|(_, rest)| rest.split_once(" (`ball` "))
        .map(|(share, _)| share.parse().expect("a number"))
        .unwrap_or_else(|| panic!("{text}"));
    let sigma = text.split_once("the gain ").and_then(|(_, rest)| rest.split_once(" is certified")).expect("a gain").0;
    let (code, text) = with(&["--no-compare"], set(share));
    let found = text.split_once("sigma* = ").and_then(|(_, rest)| rest.split_once(" in 1/time")).expect("a gain").0;
    let [found, sigma] = [found, sigma].map(|text| text.parse::<f64>().expect("a number"));
    // The search for a share goes without joint metrics.
    assert!(code == 0 && found <= sigma, "{sigma}: {text}");
    let (code, text) = with(&["--no-compare"], set(share / 2));
    assert!(code == 3 && text.contains("at /initial_set") && !text.contains("divided by"), "{text}");
    // A gain that is too small for a set says nothing about the set.
    let (code, text) = with(&["--sigma", "1/100"], set(share));
    assert!(code == 3 && !text.contains("at /initial_set") && !text.contains("divided by"), "{text}");
}

#[test]
fn a_start_that_no_file_states_is_not_told() {
    let with = |initial: Option<Value>| {
        told(&CERTIFY, LINEAR, |plant| {
            states(plant, &["x"], &["-x + e + 100"]);
            plant["initial_set"] = json!({ "kind": "at-rest", "ball": "1", "E0": "1" });
            plant["q"] = "sin(2*pi*t)".into();
            if let Some(initial) = initial {
                plant["initial"] = initial;
            }
        })
    };
    let (code, text) = with(None);
    assert!(code == 0 && !text.contains("`simulate` starts"), "{text}");
    let (code, text) = with(Some(json!({ "x": ["0"], "e": "0" })));
    assert!(code == 0 && text.contains("`simulate` starts at x = (0)"), "{text}");
}

#[test]
fn words_of_other_programs_lead_to_those_of_this_one() {
    let said = |arguments: &[&str]| {
        let output = program().args(arguments).output().expect("the program runs");
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        utf8(output.stderr)
    };
    for (arguments, meant) in [
        (&["certify", EXAMPLE, "--gain", "3"][..], true),
        (&["--color", "never", "rate", EXAMPLE, "--gain=3"], true),
        // `check` has no such flag, and another word is not that one.
        (&["check", EXAMPLE, "--gain", "3"], false),
        (&["certify", EXAMPLE, "--again", "3"], false),
    ] {
        let text = said(arguments);
        assert_eq!(text.contains("'--sigma'"), meant, "{arguments:?}: {text}");
        assert!(!meant || !text.contains("-- --gain"), "{arguments:?}: {text}");
    }
    let text = said(&["report", EXAMPLE]);
    assert!(text.contains("`certify` shows a report") && !text.contains("reproduce"), "{text}");
    let text = said(&["reproduc"]);
    assert!(text.contains("'reproduce'") && !text.contains("shows a report"), "{text}");
}

#[test]
fn the_term_without_the_period_is_named() {
    for (q, part) in [
        ("1 + t/10 + cos(2*pi*t)", Some("t/10")),
        ("1 + cos(2*pi*t) + sin(3*t)", Some("sin(3*t)")),
        ("1 + cos(2*pi*t) + sin(6*pi*t)", None),
    ] {
        let (code, text) = told(&CERTIFY, LINEAR, |plant| plant["q"] = q.into());
        let said = part.map(|part| format!("the first part that is not seen to have it is `{part}`: "));
        assert_eq!(code, if part.is_some() { 2 } else { 0 }, "{text}");
        assert!(said.is_none_or(|said| text.contains(&said)), "{text}");
        // Not the whole of the formula.
        let marks = part.map(|part| " ".to_owned() + &"^".repeat(part.len()) + " ");
        assert!(marks.is_none_or(|marks| text.contains(&marks)), "{text}");
    }
}

#[test]
fn what_rates_at_samples_cost_is_told() {
    const REMARK: &str = "with `--n-o` the claim rests on norms, from which rates at samples are proved";
    let with = |flags: &[&str]| {
        let call = [&CERTIFY, &["--sampling-period", "1/10000"][..], flags].concat();
        told(&call, "specs/plants/motor-axis.json", |_| {})
    };
    let (code, text) = with(&["--n-o", "0"]);
    assert!(code == 0 && text.contains(REMARK), "{text}");
    for flags in [&[][..], &["--n-o", "0", "--sigma", "500"]] {
        let (code, text) = with(flags);
        assert!(code == 0 && !text.contains(REMARK), "{flags:?}: {text}");
    }
}

#[test]
fn a_place_that_a_study_does_not_find_is_told_with_those_there_are() {
    let with = |place: &str, name: &str| {
        told(&["sweep", "--case", "0"], "specs/studies/linear.json", |study| {
            let mut plant: Value = serde_json::from_str(&std::fs::read_to_string(LINEAR).unwrap()).unwrap();
            plant["parameters"] = json!({ "k": "1", "c": "2" });
            study["subject"] = plant;
            study["parameters"] = json!([{ place: name, "values": ["1", "2"] }]);
        })
    };
    for (place, name, said) in [
        ("parameter", "K", "in /parameters there are k, c;"),
        ("pointer", "/internal_model/mue", "in /internal_model there are mu, base_frequency, matched, weights;"),
        ("pointer", "/internal_modle/mu", "in it there are"),
        ("pointer", "/q/mean", "in it there are"),
    ] {
        let (code, text) = with(place, name);
        assert!(code == 2 && text.contains("names nothing in the subject") && text.contains(said), "{name}: {text}");
    }
    let (code, text) = with("parameter", "k");
    assert!(code == 0 && !text.contains("there are"), "{text}");
}

#[test]
fn a_mu_of_another_scale_is_told_on_both_streams() {
    let with = |mu: &str| told(&CERTIFY, LINEAR, |plant| plant["internal_model"]["mu"] = mu.into());
    for (mu, said) in [("1/1000", "mu times the period T is 0.001: "), ("1000", "mu times the period T is 1000: ")] {
        let (code, text) = with(mu);
        assert!(code == 0 && text.matches(said).count() == 2 && text.contains(&format!("Remark: {said}")), "{text}");
    }
    let (code, text) = with("1/10");
    assert!(code == 0 && !text.contains("mu times the period"), "{text}");
}

#[test]
fn oscillators_that_lower_no_bound_are_told() {
    const REMARK: &str = "the bound of the steady error hardly falls with the number of oscillators";
    let with = |frequency: &str, matched: bool| {
        told(&CERTIFY, "specs/linear.json", |spec| {
            spec["internal_model"]["base_frequency"] = frequency.into();
            spec["internal_model"]["matched"] = matched.into();
        })
    };
    let (code, text) = with("3", false);
    assert!(code == 0 && text.contains(REMARK) && text.contains("`matched` is false"), "{text}");
    let (code, text) = with("2*pi", true);
    assert!(code == 0 && !text.contains(REMARK), "{text}");
}
