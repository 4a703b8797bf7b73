//! What reports say of states, of what vanishes, of the data that lower the gain, and with how many digits.

use crate::support::{every, in_one_line, number, program, utf8};
use serde_json::Value;

fn certify(args: &[&str]) -> String {
    let output = program().arg("certify").args(args).output().expect("the program runs");
    assert_eq!(output.status.code(), Some(0), "{args:?}: {}", utf8(output.stderr));
    utf8(output.stdout)
}

/// Of a plant it is x - x_0(t) that vanishes; within bounding functions x is that deviation; without states there is e alone.
#[test]
fn what_vanishes_with_infinitely_many_oscillators() {
    for (file, says) in [
        ("specs/paper-example.json", "is bounded, and x and e tend to 0."),
        ("specs/plants/motor-axis.json", "is bounded, and x - x_0(t) and e tend to 0, x_0 the T-periodic solution"),
        ("specs/plants/linear.json", "is bounded, and e tends to 0."),
    ] {
        let text = in_one_line(&certify(&[file, "--full", "--no-alternatives"]));
        assert!(text.contains(says), "{file}: {text}");
        assert_eq!(text.contains("x and e tend"), file == "specs/paper-example.json", "{file}");
    }
}

#[test]
fn of_a_plant_without_states_nothing_is_said_of_states() {
    let of_states = ["|y|", "|x|", "L^-1", "x_0", "y stays", "rate along it", "alpha lowers", "f_e", "q_x"];
    let text = certify(&["specs/plants/linear.json", "--full"]);
    let claims = text.split("\nConditions\n").next().unwrap();
    for words in of_states {
        assert!(!claims.contains(words), "{words}: {claims}");
    }
    assert!(!text.contains("sup|x|") && !text.contains("sup|y|"), "{text}");
    let other = |args: &[&str]| utf8(program().args(args).output().expect("the program runs").stdout);
    let lyapunov = other(&["lyapunov", "specs/plants/linear.json", "--full"]);
    assert!(lyapunov.contains("no state") && !lyapunov.contains("x_0"), "{lyapunov}");
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("certificate.json");
    let name = file.to_str().expect("a plain name");
    certify(&["specs/plants/linear.json", "--no-alternatives", "-o", name]);
    let falsified = other(&["falsify", name, "--trials", "1", "--full"]);
    assert!(falsified.contains("sup|e| of the periodic") && !falsified.contains("|x"), "{falsified}");
    // One with a state has all of it.
    let text = certify(&["specs/plants/motor-axis.json", "--full"]);
    for words in ["|y|", "L^-1", "x_0", "y stays", "rate along it", "sup|y|"] {
        assert!(text.contains(words), "{words}: {text}");
    }
    assert!(!text.contains("sup|x|"), "{text}");
}

fn sensitivities(args: &[&str]) -> (Vec<String>, Vec<f64>, f64) {
    let report: Value =
        serde_json::from_str(&certify(&[args, &["--format", "json", "--no-alternatives"]].concat())).unwrap();
    let list = report["sensitivities"].as_array().unwrap();
    let names = list.iter().map(|entry| entry["datum"].as_str().unwrap().to_owned()).collect();
    let gains = list.iter().map(|entry| number(&entry["estimate"])).collect();
    (names, gains, number(&report["sigma_star"]))
}

/// What is said to lower sigma* most is the first of all that the file states, the initial set among it; and it does.
#[test]
fn the_initial_set_is_among_the_data_that_are_compared() {
    let text = std::fs::read_to_string("specs/paper-example.json").unwrap();
    let with = |set: &str| {
        let mut spec: Value = serde_json::from_str(&text).unwrap();
        spec["initial_set"] = serde_json::from_str(set).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("spec.json");
        std::fs::write(&path, spec.to_string()).unwrap();
        sensitivities(&[path.to_str().unwrap()])
    };
    let (names, gains, sigma) = with(r#"{ "kind": "box", "X0": "1", "E0": "4", "Z0": "0" }"#);
    assert!(names.iter().any(|name| name == "E0") && names.iter().any(|name| name.starts_with("mu (")), "{names:?}");
    assert!(names.iter().any(|name| name == "alpha"), "{names:?}");
    assert!(!names.iter().any(|name| name == "Z0"), "0 cannot be smaller: {names:?}");
    assert!(gains.is_sorted_by(|a, b| a >= b), "{gains:?}");
    let gain = gains[names.iter().position(|name| name == "E0").unwrap()];
    let (_, _, smaller) = with(r#"{ "kind": "box", "X0": "1", "E0": "3.96", "Z0": "0" }"#);
    let found = 1.0 - smaller / sigma;
    assert!((found / gain - 1.0).abs() < 0.05, "stated {gain}, found {found}");
    // A set that is a multiple of the periodic solution has no sizes of its own.
    let (names, _, _) = sensitivities(&["specs/paper-example.json"]);
    assert!(!names.is_empty() && !names.iter().any(|name| name == "E0" || name == "X0"), "{names:?}");
}

/// A plant whose stability is proved by norms: with a matrix inequality the proved threshold stays, and nothing is compared.
const BY_NORMS: &str = r#"{ "format": "sigmastar/plant", "version": 1, "name": "by norms", "period": "1", "states": ["x"],
    "f": ["-2*x + x*e + 3*e + sin(2*pi*t)"], "q": "2*x + e/4 + cos(2*pi*t)",
    "initial_set": { "kind": "box", "ball": "1", "E0": "1", "Z0": "0" },
    "internal_model": { "mu": "2", "base_frequency": "2*pi", "matched": true,
        "weights": { "family": "power", "n0": "2", "epsilon": "1/2" } } }"#;

#[test]
fn of_a_plant_only_what_its_file_states_is_compared() {
    let folder = tempfile::tempdir().unwrap();
    let by_norms = folder.path().join("plant.json");
    std::fs::write(&by_norms, BY_NORMS).unwrap();
    for (file, sizes) in [
        (by_norms.to_str().unwrap(), &["ball", "E0"][..]),
        ("specs/plants/motor-axis.json", &[]),
        ("specs/plants/linear.json", &[]),
    ]
    .into_iter()
    .step_by(every(2))
    {
        let (names, _, _) = sensitivities(&[file]);
        for name in &names {
            assert!(sizes.contains(&name.as_str()) || name.starts_with("mu ("), "{file}: {names:?}");
        }
        assert!(sizes.iter().all(|size| names.iter().any(|name| name == size)), "{file}: {names:?}");
        let text = certify(&[file, "--full"]);
        assert!(!text.contains("better f_e") && !text.contains("q_rms, q_t_rms"), "{text}");
    }
}

/// The numbers of oscillators that are asked for are those whose steady error is said.
#[test]
fn the_steady_error_is_said_of_the_numbers_that_are_asked_for() {
    let said = |flags: &[&str]| {
        let text = in_one_line(&certify(&[&["specs/paper-example.json", "--no-alternatives"], flags].concat()));
        text.split_once("steady error: ")
            .and_then(|(_, rest)| rest.split_once(" - convergence: "))
            .expect("a line")
            .0
            .to_owned()
    };
    assert!(
        said(&["--n-o", "0,7"]).ends_with(" with n_o = 7") && said(&["--n-o", "0,7"]).matches(" with ").count() == 2
    );
    assert!(said(&[]).ends_with(" with n_o = 100"));
}

/// The significant digits of a word, if it is a number.
fn significant(word: &str) -> Option<usize> {
    let word = word.trim_matches(|c: char| "[](),;:".contains(c)).trim_end_matches('.');
    let _: f64 = word.parse().ok()?;
    let mantissa = word.split('e').next()?.trim_start_matches('-').replace('.', "");
    let digits = mantissa.trim_start_matches('0');
    Some(if word.contains('.') { digits.len() } else { digits.trim_end_matches('0').len() })
}

/// Four digits, and once the exact gain; the numbers that are rounded are on the safe side.
#[test]
fn a_report_has_four_digits_and_the_exact_gain_once() {
    let text = certify(&["specs/paper-example.json", "--full"]);
    let claims = text.split("Constants in the three derivations").next().unwrap();
    let long: Vec<&str> = claims.split_whitespace().filter(|word| significant(word).is_some_and(|n| n > 4)).collect();
    assert_eq!(long.iter().filter(|word| **word == "39.8018").count(), 1, "{long:?}");
    // What the solver says is compared to five digits.
    assert!(long.iter().all(|word| *word == "39.8018" || *word == "39.802" || word.ends_with("39.802,")), "{long:?}");
    for (shown, above) in [("sigma = 39.81 (or any larger)", true), ("|x| <= 0.1042,", true), ("|x| <= 0.1043,", false)]
    {
        assert_eq!(in_one_line(&text).contains(shown), above, "{shown}");
    }
}

/// A rate is part of a claim for the numbers of oscillators of which one is proved, and only there.
#[test]
fn what_is_said_of_the_rate_is_what_was_asked_for() {
    let said = "The rate of convergence depends on n_o and is ";
    for (flags, expected) in [
        (&["--n-o", "1"][..], "part of the claim only for the numbers that were asked for. sigma is"),
        (&[], "not part of the claim. sigma is"),
    ] {
        let flags = [&["specs/paper-example.json", "--full", "--no-alternatives", "--sigma", "60"], flags].concat();
        let text = in_one_line(&certify(&flags));
        let (_, rest) = text.split_once(said).unwrap_or_else(|| panic!("{text}"));
        assert!(rest.starts_with(expected), "{rest}");
    }
}
