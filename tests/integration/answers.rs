//! Answers that first users read without finding out what to do: each now says what to write, and beside it stands what has another answer.

use crate::mistakes::{changed, file, of, told};
use crate::support::{PLANT, document, program, utf8};
use serde_json::{Value, json};
use std::path::Path;

/// A flag that counts periods is told as such where a time is given, and one that has a unit is told what the number without it is.
#[test]
fn units_at_flags_are_told_by_what_the_flag_means() {
    let (_folder, path) = file("plant.json", &changed(&[]));
    let design = |flags: &[&str]| told(&["design", "--quiet"], Some(&path), flags);
    let periods = "--settle counts periods and has no unit: divide a time by the period, which is 1";
    for time in ["2s", "2 ms", "200ms/2"] {
        let (code, text) = design(&["--steady-error", "1", "--settle", time]);
        assert!(code == 2 && text.contains(periods) && !text.contains("leave `s` out"), "{time}: {text}");
    }
    let (code, text) = design(&["--steady-error", "1", "--settle", "-2"]);
    assert!(code == 2 && text.contains("must be positive") && !text.contains("counts periods"), "{text}");
    for (flag, value, said) in [
        ("--steady-error", "5mV", "with V as the unit of all data of this kind, write 5/1000"),
        ("--max-control", "2 kN", "write 1000*2"),
        ("--sigma", "10 Hz", "2*pi*10 as an angular frequency such as `base_frequency`, or as a gain or a rate in 1/s"),
        ("--sampling-period", "1 ms", "with the second as the unit of time, write 1/1000"),
        ("--peak-error", "3 V", "leave `V` out"),
    ] {
        let (code, text) = design(&[flag, value]);
        assert!(code == 2 && text.contains(said), "{flag} {value}: {text}");
    }
    for (mu, unit) in [("12 1/s", "leave `1/s` out"), ("12/s", "leave `/s` out"), ("12 rad/s", "leave `rad/s` out")] {
        let (code, text) = of(&[("/internal_model/mu", mu.into())], &[]);
        assert!(code == 2 && text.contains(unit) && !text.contains("12*"), "{mu}: {text}");
    }
    // No unit: an operator is missing, and a name is not known.
    let (_, text) = of(&[("/internal_model/mu", "12 (3)".into())], &[]);
    assert!(text.contains("write 12*(") && !text.contains("no units"), "{text}");
    let (_, text) = of(&[("/internal_model/mu", "12/gain".into())], &[]);
    assert!(text.contains("`gain` is not a known name") && !text.contains("no units"), "{text}");
}

/// A sampling period of a flag that does not go with the period is told at the flag, by every command that takes one.
#[test]
fn a_sampling_period_of_a_flag_is_told_at_the_flag() {
    let (_folder, path) = file("plant.json", &changed(&[]));
    let flags = ["--sampling-period", "0.3"];
    for command in ["certify", "design"] {
        let (code, text) = told(&[command, "--quiet"], Some(&path), &flags);
        assert!(code == 2 && text.contains("1 | --sampling-period 0.3"), "{command}: {text}");
        assert!(text.contains("such as `1/3`") && !text.contains("plant.json"), "{command}: {text}");
    }
    let (code, text) = told(&["sampling", "--quiet"], Some(&path), &flags);
    assert!(code == 2 && text.contains("--sampling-period: the period 1 is no whole multiple"), "{text}");
    // What is wrong in the file is told there, also with such a flag.
    let (_folder, path) = file("plant.json", &changed(&[("/internal_model/mu", "-1".into())]));
    let (code, text) = told(&["design", "--quiet"], Some(&path), &flags);
    assert!(code == 2 && text.contains("plant.json") && text.contains("must be positive"), "{text}");
    let mut model = document("plants/linear")["internal_model"].clone();
    model["sampling_period"] = "0.3".into();
    let (code, text) = of(&[("/internal_model", model)], &[]);
    assert!(code == 2 && text.contains("plant.json") && text.contains("not a whole number"), "{text}");
}

/// A period that is a rounded fraction is the mistake where formulas and base frequency have the exact one: that fraction is the first remedy.
#[test]
fn a_rounded_period_is_told_before_the_base_frequency() {
    let with = |period: &str, frequency: &str| {
        of(
            &[
                ("/period", period.into()),
                ("/q", "sin(phase)".into()),
                ("/internal_model/base_frequency", frequency.into()),
                ("/internal_model/mu", "9".into()),
            ],
            &[],
        )
    };
    let (code, text) = with("0.333", "6*pi");
    let first = "help: state the period `1/3`, of which 0.333 is a rounded value; or keep this period, with the base frequency `2000/333*pi`";
    assert!(code == 2 && text.contains(first) && !text.contains("would be right"), "{text}");
    // Another fraction than that of the base frequency, and a period that is no rounded one.
    for (period, right) in [("0.143", "2000/143*pi"), ("0.3", "20/3*pi"), ("3", "2/3*pi")] {
        let (code, text) = with(period, "6*pi");
        assert!(code == 2 && text.contains(&format!("`{right}` would be right")), "{text}");
        assert!(!text.contains("rounded value"), "{text}");
    }
}

/// What has quotes too many, or too few, is told with what to write; so is what stands in the place of an object.
#[test]
fn quotes_and_objects_are_told_with_what_to_write() {
    for (place, value, said) in [
        ("/name", json!(3), "a text stands in quotes: write `\"3\"`"),
        ("/version", json!("1"), "write `1`, without quotes"),
        ("/domain", json!(3), "write `{ \"x\": \"10\", \"e\": \"10\" }`"),
        ("/measurement", json!("1/10"), "write `{ \"noise\": \"1/100\" }`"),
    ] {
        let (code, text) = of(&[(place, value)], &[]);
        assert!(code == 2 && text.contains(said), "{place}: {text}");
    }
    let mut model = document("plants/linear")["internal_model"].clone();
    model["matched"] = "true".into();
    let (code, text) = of(&[("/internal_model", model.clone())], &[]);
    assert!(code == 2 && text.contains("write `true`, without quotes"), "{text}");
    // Another word is none of these, and another text no whole number.
    model["matched"] = "yes".into();
    let (_, text) = of(&[("/internal_model", model)], &[]);
    assert!(text.contains("expected true or false") && !text.contains("without quotes"), "{text}");
    let (_, text) = of(&[("/version", "1.0".into())], &[]);
    assert!(text.contains("expected a whole number") && !text.contains("without quotes"), "{text}");
}

/// In TOML a decimal comma and a text without quotes are syntax errors, which say what to write.
#[test]
fn what_is_no_toml_is_told_with_what_to_write() {
    const RIGHT: &str =
        "format = \"sigmastar/plant\"\nperiod = \"1\"\nparameters = { a = { nominal = 5, low = 4, high = 6 } }\n";
    for (right, wrong, said) in [
        ("period = \"1\"", "period = 9,5", "decimals have a point: write `9.5`"),
        ("nominal = 5,", "nominal = 5,0,", "decimals have a point: write `5.0`"),
        ("high = 6 }", "high = 6,25 }", "decimals have a point: write `6.25`"),
        ("period = \"1\"", "period = 1/3", "texts, formulas and fractions stand in quotes: `\"1/3\"`"),
        ("period = \"1\"", "period = 2*pi # turns", "stand in quotes: `\"2*pi\"`"),
        ("nominal = 5", "nominal 5", "so it is read as TOML"),
        ("nominal = 5,", "nominal = 5,,", "so it is read as TOML"),
    ] {
        assert!(RIGHT.contains(right), "{right}");
        let (_folder, path) = file("plant.toml", &RIGHT.replace(right, wrong));
        let (code, text) = told(&["certify"], Some(&path), &[]);
        assert!(code == 2 && text.contains("not valid TOML") && text.contains(said), "{wrong}: {text}");
    }
    let (_folder, path) = file("plant.toml", RIGHT);
    assert!(!told(&["certify"], Some(&path), &[]).1.contains("not valid TOML"));
}

/// A name that is struck twice, and a state with the name of what every plant has.
#[test]
fn names_are_told_with_the_one_that_is_meant() {
    let (code, text) = of(&[("/q", "rr*sin(2*pi*t)".into()), ("/parameters", json!({ "r": "2" }))], &[]);
    assert!(code == 2 && text.contains("did you mean r? The product is written r*r"), "{text}");
    let (_, text) = of(&[("/q", "rs*sin(2*pi*t)".into()), ("/parameters", json!({ "r": "2", "s": "1" }))], &[]);
    assert!(text.contains("write r*s") && !text.contains("did you mean"), "{text}");
    for (name, said) in [
        ("e", "`e` is the error and no state: its derivative is `q` plus the control"),
        ("t", "`t` is the time and no state"),
        ("phase", "`phase` is 2 pi t / period and no state"),
    ] {
        let (code, text) = of(&[("/states", json!([name])), ("/f", json!(["-e"]))], &[]);
        assert!(code == 2 && text.contains(said) && text.contains(&format!("as `{name}1`")), "{text}");
    }
    let (code, text) = of(&[("/states", json!(["sin"])), ("/f", json!(["-e"]))], &[]);
    assert!(code == 2 && text.contains("has another meaning") && !text.contains("no state"), "{text}");
}

/// A magnitude in a formula is told with what is smooth, by its sign or by its name.
#[test]
fn a_magnitude_is_told_with_a_smooth_function() {
    let (code, text) = of(&[("/q", "|e| + sin(2*pi*t)".into())], &[]);
    assert!(code == 2 && text.contains("|v| has a corner, and formulas are smooth: write sqrt(v^2 + 1/100)"), "{text}");
    let (code, text) = of(&[("/q", "abs(2*e)/9 + sin(2*pi*t)".into())], &[]);
    assert!(code == 3 && text.contains("|2*e| is not smooth where 2*e = 0: write sqrt((2*e)^2 + 1/100)"), "{text}");
    assert!(text.contains("drag, dry friction and dead zones"), "{text}");
    let (_, text) = of(&[("/q", "sqrt(e)/9 + sin(2*pi*t)".into())], &[]);
    assert!(text.contains("write sqrt(u + 1/100)") && !text.contains("dead zones"), "{text}");
}

/// A tolerance is no field of an interval: the ends that it may mean are told.
#[test]
fn a_tolerance_is_told_as_two_ends() {
    for place in ["/input_gain", "/parameters"] {
        let interval = |reach: Value| {
            let interval = json!({ "nominal": "5", "tolerance": reach });
            let value = if place == "/parameters" { json!({ "a": interval }) } else { interval };
            of(&[(place, value)], &[])
        };
        let (code, text) = interval(json!(1));
        assert!(code == 2 && text.contains("an interval has no `tolerance`"), "{text}");
        assert!(
            text.contains("\"high\": \"6\"` for 5 to within 1, or `\"low\": \"0\"") && text.contains("100 %"),
            "{text}"
        );
        assert_eq!(text.matches("error[").count(), 1, "{text}");
    }
    let with_ends = json!({ "nominal": 5, "low": 4, "high": 6, "tolerance": 1 });
    let (code, text) = of(&[("/input_gain", with_ends)], &[]);
    assert!(code == 2 && text.contains("unknown field `tolerance`") && !text.contains("an interval has no"), "{text}");
}

/// Flags that another one needs are told with what they are for.
#[test]
fn a_flag_that_another_one_needs_is_told_with_its_reason() {
    let (_folder, path) = file("plant.json", &changed(&[]));
    let (code, text) = told(&["design"], Some(&path), &["--settle", "3"]);
    assert!(code == 2 && text.contains("add `--steady-error V` with that error"), "{text}");
    let (code, text) = told(&["certify"], Some(&path), &["--rate", "3"]);
    assert!(code == 2 && text.contains("add them, as `--n-o 0,4`") && !text.contains("steady-error"), "{text}");
    let (code, text) = told(&["controller"], Some(&path), &["--sigma", "3"]);
    assert!(code == 2 && text.contains("--n-o <N>") && !text.contains("--rate"), "{text}");
}

/// What a command told is no input of another one: it is named, with the file that is meant.
#[test]
fn a_report_in_the_place_of_a_file_is_named() {
    let (_folder, path) = file("plant.json", &changed(&[]));
    let design = ["design", "--quiet", "--no-simulation", "--n-o", "0", "--sigma", "9", "--format", "json"];
    let output = program().args(design).arg(&path).output().expect("the program runs");
    let (_folder, table) = file("table.json", &utf8(output.stdout));
    for (command, meant) in [
        (&["certify"][..], "name the plant or the specification that it is about"),
        (&["simulate", "--sigma", "1", "--n-o", "0"], "name the plant that it is about"),
        (&["falsify"], "name the certificate, which `sigmastar certify FILE -o CERTIFICATE` writes"),
    ] {
        let (code, text) = told(command, Some(&table), &[]);
        let named = "this is a table of `design --format json`, which no command reads again";
        assert!(code == 2 && text.contains(named) && text.contains(meant), "{command:?}: {text}");
    }
    let (code, text) = told(&["check"], Some(&table), &[]);
    assert!(code == 2 && text.contains("is a table of `design --format json`, not a certificate"), "{text}");
    assert!(text.contains("its certificate is the file that `-o` writes"), "{text}");
    let (_folder, other) = file("other.json", "{ \"format\": \"sigmastar/nothing\", \"version\": 1 }");
    let (_, text) = told(&["certify"], Some(&other), &[]);
    assert!(
        text.contains("this is a file of format `sigmastar/nothing`") && !text.contains("no command reads"),
        "{text}"
    );
    let (_, text) = told(&["check"], Some(&other), &[]);
    assert!(text.contains("is no certificate:") && !text.contains("`-o` writes"), "{text}");
}

/// Every report says what u is, in words that go with the file, and the table of `design` what y is.
#[test]
fn the_letters_of_a_report_are_explained() {
    let gain = json!({ "nominal": "2", "low": "1.8", "high": "2.2" });
    let range = json!({ "min": "-98", "max": "102" });
    const PLAIN: &str = "the regulator puts out u, and e' = q + u.";
    for (fields, said) in [
        (&[][..], PLAIN),
        (&[("/input_gain", gain)], "the regulator puts out u, its control divided by the nominal gain 2."),
        (&[("/actuator", range)], "the regulator puts out 2 + u, 2 the middle of the range of the actuator."),
        (&[("/actuator", json!({ "max": "100" }))], PLAIN),
    ] {
        let (_folder, path) = file("plant.json", &changed(fields));
        let design = ["design", "--n-o", "0", "--no-simulation", "--sigma", "9"];
        for command in [&["certify", "--no-alternatives"][..], &design] {
            let (code, text) = told(command, Some(&path), &["--quiet"]);
            assert!([0, 3].contains(&code) && text.contains(said), "{command:?}: {text}");
            // A plant without states has no y.
            assert_eq!(
                (text.matches("the regulator puts out").count(), text.contains("y = L^-1")),
                (1, false),
                "{text}"
            );
        }
    }
    let flags = ["--n-o", "0", "--no-simulation", "--sigma", "9", "--quiet"];
    let (_, text) = told(&["design"], Some(Path::new(PLANT)), &flags);
    assert!(text.contains("y = L^-1 (x - x_0(t)) with orbit x_0 and matrix L; the regulator puts out u"), "{text}");
}

/// What is written already is not advised to be written.
#[test]
fn a_report_does_not_advise_what_was_done() {
    let (folder, path) = file("plant.json", &changed(&[]));
    let certificate = folder.path().join("c.json");
    let call = |more: &[&str]| told(&["certify", "--no-alternatives", "--quiet"], Some(&path), more).1;
    assert!(call(&[]).contains("`-o FILE` writes the certificate, `check FILE` decides it again"));
    let text = call(&["-o", certificate.to_str().expect("a plain name")]);
    assert!(text.contains("`check FILE` decides the certificate again") && !text.contains("`-o FILE`"), "{text}");
}
