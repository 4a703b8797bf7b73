//! What a first user runs into: how wrong calls and wrong files are told.

use crate::support::{EXAMPLE, EXAMPLE_TEXT, PLANT, ROOT, json, number, sigmastar, utf8};
use predicates::prelude::*;
use predicates::str::{contains, is_empty};
use serde_json::Value;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// The example with other text in the place of some of its text.
fn example(changes: &[(&str, &str)]) -> String {
    changes.iter().fold(EXAMPLE_TEXT.to_owned(), |text, (old, new)| {
        assert!(text.contains(old), "{old}");
        text.replace(old, new)
    })
}

#[test]
fn a_flag_is_shown_as_it_was_typed() {
    for (value, shown, help) in [
        ("-1", "1 | --sigma -1\n  |         ^^ expected a positive number", "must be positive"),
        ("2 s", "1 | --sigma 2 s\n  |           ^", "numbers have no units: leave `s` out"),
        ("1/0", "1 | --sigma 1/0\n  |         ^^^", "a division by 0"),
        ("\"\\", "1 | --sigma \"\\\n  |         ^", "no meaning in an expression"),
    ] {
        let call =
            sigmastar(&["controller", EXAMPLE, "--n-o", "2", "--sigma", value]).assert().code(2).stdout(is_empty());
        call.stderr(contains(shown).and(contains(help)).and(contains("{").not()).and(contains("note: at").not()));
    }
}

#[test]
fn a_negative_number_is_a_wrong_value_and_no_flag() {
    for (arguments, part) in [
        (&["controller", EXAMPLE, "--sigma", "1", "--n-o", "-1"][..], "-1 is not in 0..=1000"),
        (&["simulate", PLANT, "--sigma", "1", "--n-o", "-1"], "-1 is not in 0..=200"),
        (&["certify", EXAMPLE, "--precision-limit", "-1"], "-1 is not in 128..=4096"),
        (&["controller", EXAMPLE, "--sigma", "1", "--n-o", "0..9"], "call it for each of them"),
        (&["simulate", PLANT, "--sigma", "1", "--n-o", "0,1"], "call it for each of them"),
        (&["certify", EXAMPLE, "--n-o", "0..9/0"], "`0..100/10` in steps of 10"),
        (&["certify", EXAMPLE, "--n-o", "-1"], "`-1` in --n-o is no number of oscillators"),
        (&["transfer", EXAMPLE, "--n-o", "-1..2"], "`-1..2` in --n-o is no number of oscillators"),
    ] {
        sigmastar(arguments).assert().code(2).stderr(contains(part).and(contains("-- -").not()));
    }
}

#[test]
fn time_and_units_in_an_expression_are_explained() {
    let q = "\"4.822 + X + atan(E*(X + 0.189))\"";
    for (change, help) in [
        ((q, "\"3*cos(2*pi*t) + X\""), "take the supremum over t, or give the plant itself (`sigmastar/plant`)"),
        ((q, "\"3 m/s\""), "numbers have no units: leave `m/s` out"),
        (("\"period\": \"1\"", "\"period\": \"1 s\""), "numbers have no units: leave `s` out"),
    ] {
        let call = sigmastar(&["certify", "-"]).write_stdin(example(&[change])).assert();
        call.code(2).stdout(is_empty()).stderr(contains(help));
    }
}

/// The point of the counterexample has more than 100 digits: few of them in the text, all in the JSON.
#[test]
fn a_counterexample_is_short_in_the_text_and_whole_in_the_json() {
    let long = format!("1.{}1", "0".repeat(100));
    let spec =
        example(&[("4.822 + X + atan(E*(X + 0.189))", "4 - X"), ("\"X\": \"10\"", &format!("\"X\": \"{long}\""))]);
    let text = sigmastar(&["certify", "-"]).write_stdin(spec.clone()).assert().code(2);
    let text = String::from_utf8_lossy(&text.get_output().stderr).into_owned();
    let first = text.lines().next().expect("a line");
    assert!(first.contains("not nondecreasing in X") && first.contains("X about 0.125,"), "{first}");
    assert!(first.len() < 250, "{first}");
    let output = sigmastar(&["certify", "-", "--format", "json", "-q"]).write_stdin(spec).assert().code(2);
    let report = json(&output.get_output().stdout);
    let message = report["errors"][0]["message"].as_str().expect("text");
    // The edge of the domain is rounded up to a binary number, of which the counterexample is an eighth.
    let point = message.rsplit("X = ").next().and_then(|rest| rest.split(',').next()).expect("a point");
    assert!(point.starts_with("0.125000000000") && point.len() > 100, "{message}");
}

#[test]
fn a_byte_order_mark_changes_nothing() {
    let digest = |text: String| {
        let output =
            sigmastar(&["certify", "-", "--no-alternatives", "--format", "json"]).write_stdin(text).assert().code(0);
        let report = json(&output.get_output().stdout);
        report["specification"]["sha256"].as_str().expect("a digest").to_owned()
    };
    assert_eq!(digest(format!("\u{feff}{}", example(&[]))), digest(example(&[])));
    let utf_16: Vec<u8> = "\u{feff}{}".encode_utf16().flat_map(u16::to_le_bytes).collect();
    sigmastar(&["certify", "-"]).write_stdin(utf_16).assert().code(2).stderr(contains("the file is UTF-16, not UTF-8"));
}

#[test]
fn a_file_in_the_place_of_a_folder_is_named_as_such() {
    let simulate =
        |folder: &str| sigmastar(&["simulate", PLANT, "--sigma", "2", "--n-o", "1", "--plots", folder]).assert();
    let plain = contains("it is a file, not a folder").and(contains("os error").not());
    simulate(EXAMPLE).code(2).stdout(is_empty()).stderr(plain);
    let inside = contains("a part of the path is a file").and(contains("os error").not());
    simulate(&format!("{EXAMPLE}/figures")).code(2).stdout(is_empty()).stderr(inside);
}

#[test]
fn the_input_that_would_be_replaced_has_its_own_name() {
    let folder = TempDir::new().expect("a folder");
    let copy = |path: &str| {
        let target = folder.path().join(Path::new(path).file_name().expect("a name"));
        fs::copy(Path::new(ROOT).join(path), &target).expect("copied");
        target.to_str().expect("a plain name").to_owned()
    };
    let (spec, plant) = (copy(EXAMPLE), copy("specs/plants/linear.json"));
    let certificate = copy("proofs-check/tests/certificates/linear.sharp.json");
    for (arguments, word) in [
        (vec!["certify", &spec, "-o", &spec], "the specification itself"),
        (vec!["simulate", &plant, "--sigma", "2", "--n-o", "1", "--csv", &plant], "the plant file itself"),
        (vec!["falsify", &certificate, "-o", &certificate], "the certificate itself"),
    ] {
        sigmastar(&arguments).assert().code(2).stdout(is_empty()).stderr(contains(word));
    }
}

/// The size that is suggested is one that is certified.
#[test]
fn a_smaller_initial_set_has_a_size() {
    let domain = ("\"X\": \"10\", \"E\": \"10\"", "\"X\": \"1\", \"E\": \"1\"");
    let set = |set: &str| example(&[domain, ("{ \"kind\": \"paper\" }", set)]);
    let run = |text: String| {
        let output = sigmastar(&["certify", "-", "--no-alternatives", "--format", "json"]).write_stdin(text).output();
        let output = output.expect("it runs");
        let report = json(&output.stdout);
        (output.status.code(), report)
    };
    let (code, report) = run(set(r#"{ "kind": "box", "X0": "1", "E0": "4", "Z0": "0" }"#));
    assert_eq!(code, Some(3));
    let advice = report["advice"].as_array().expect("advice");
    let said =
        advice.iter().filter_map(Value::as_str).find(|text| text.contains("a smaller initial set")).expect("a size");
    let (suggested, more) =
        said.split_once("\"initial_set\": ").and_then(|(_, rest)| rest.split_once('`')).expect("a field");
    let (code, certified) = run(set(suggested));
    assert_eq!(code, Some(0), "{suggested}");
    // The gain is that of the file with this set, and the share that of what was asked for, rounded down.
    let sigma = certified["sigma_star"].as_str().expect("a gain");
    assert!(more.starts_with(&format!(" is certified, with sigma* = {sigma}; it is 0.")), "{said}");
    let suggestion = json(suggested.as_bytes());
    let number = |name: &str| number(&suggestion[name]);
    let share = more.split_once("; it is ").and_then(|(_, rest)| rest.split_once(" of the one")).expect("a share").0;
    let share: f64 = share.parse().expect("a number");
    let least = number("X0").min(number("E0") / 4.0);
    assert!(share <= least && share > 0.99 * least, "{share} {least}");
    // A set that is 3 % larger is not certified.
    let [x0, e0] = [1.03 * number("X0"), 1.03 * number("E0")];
    let larger = format!(r#"{{ "kind": "box", "X0": "{x0}", "E0": "{e0}", "Z0": "0" }}"#);
    assert_eq!(run(set(&larger)).0, Some(3), "{larger}");
}

/// The stages are told where they are asked for, in the order of the call, and change nothing else.
#[test]
fn the_stages_of_a_call_are_told() {
    let call = |arguments: &[&str]| {
        let output = sigmastar(&[&["certify"], arguments].concat()).assert().code(0).get_output().clone();
        (utf8(output.stdout), utf8(output.stderr))
    };
    for (arguments, of, told) in [
        (
            &["specs/plants/linear.json", "--n-o", "1"][..],
            6,
            &["orbit", "coordinates", "bounds", "conditions", "rates", "checker"][..],
        ),
        (&["specs/linear.json"], 1, &["conditions"]),
        (&["specs/paper-example-jacobian.json", "--no-alternatives"], 2, &["triple of the Jacobian", "conditions"]),
        (&["specs/linear.json", "--witness", "proofs-check/tests/certificates/linear.sharp.json"], 1, &["deciding"]),
        (&["specs/linear.json", "--format", "html"], 2, &["conditions", "figures"]),
    ] {
        let (plain, _) = call(&[arguments, &["-q"]].concat());
        let (report, said) = call(&[arguments, &["--progress"]].concat());
        assert_eq!(report, plain, "{arguments:?}");
        let lines: Vec<&str> = said.lines().filter(|line| line.contains(": stage ")).collect();
        for (number, word) in (1..).zip(told) {
            let start = format!("sigmastar: stage {number} of {of}: ");
            assert!(lines.iter().any(|line| line.starts_with(&start) && line.contains(word)), "{start}{word}: {said}");
        }
        let (_, silent) = call(arguments);
        assert!(!silent.contains("stage"), "{silent}");
    }
    sigmastar(&["certify", EXAMPLE, "--progress", "-q"]).assert().code(2).stderr(contains("cannot be used with"));
}

/// What a Jacobian costs is said where it takes long, never on standard output, and not with `--quiet`.
#[test]
fn quiet_is_quiet_with_a_jacobian() {
    let arguments = ["certify", "specs/paper-example-jacobian.json", "--no-alternatives", "--quiet", "--full"];
    sigmastar(&arguments).assert().code(0).stderr(is_empty()).stdout(contains("finding and proving").not());
}

/// What `check` and `controller` remark is left out with `-q`.
#[test]
fn quiet_is_quiet_beside_a_certificate() {
    let controller = ["controller", "specs/linear.json", "--sigma", "2", "--n-o", "1", "--discretise", "0.03"];
    for (call, code, said) in
        [(&controller[..], 0, "not a whole number"), (&["check", "specs/plants/linear.json"], 2, "is a plant, not")]
    {
        sigmastar(call).assert().code(code).stderr(contains(said));
        let quiet = sigmastar(call).arg("-q").assert().code(code);
        assert!(!utf8(quiet.get_output().stderr.clone()).contains(said), "{call:?}");
    }
}
