//! Mistakes that a first user makes with numbers, files and words of the command line: each with its answer, and beside it what is none.

use crate::support::{document, in_one_line, program, utf8};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

const CERTIFY: [&str; 3] = ["certify", "--no-alternatives", "--quiet"];

/// Like [`CERTIFY`], with remarks on standard error.
const TOLD: [&str; 2] = ["certify", "--no-alternatives"];

/// A file of this name and content, in a folder that is removed with the first part.
pub fn file(name: &str, content: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, content).unwrap();
    (folder, path)
}

/// The exit code and both streams of a call, in one line each.
fn streams(words: &[&str], path: Option<&Path>, more: &[&str]) -> (i32, [String; 2]) {
    let output = program().args(words).args(path).args(more).output().expect("the program runs");
    let told = [utf8(output.stdout), utf8(output.stderr)].map(|text| in_one_line(&text));
    (output.status.code().expect("a code"), told)
}

/// The exit code and both streams, as one text.
pub fn told(words: &[&str], path: Option<&Path>, more: &[&str]) -> (i32, String) {
    let (code, [data, remarks]) = streams(words, path, more);
    (code, format!("{data} {remarks}"))
}

/// The plant without states, with these fields in the place of its own.
pub fn changed(fields: &[(&str, Value)]) -> String {
    let mut plant = document("plants/linear");
    for (place, value) in fields {
        match plant.pointer_mut(place) {
            Some(field) => *field = value.clone(),
            None => plant[place.trim_start_matches('/')] = value.clone(),
        }
    }
    plant.to_string()
}

/// What is said about this plant with these flags.
pub fn of(fields: &[(&str, Value)], flags: &[&str]) -> (i32, String) {
    let (_folder, path) = file("plant.json", &changed(fields));
    told(&TOLD, Some(&path), flags)
}

#[test]
fn c_code_is_no_plant() {
    const C: &str = "this looks like C code, which is not read";
    for (content, said) in [
        ("#include <math.h>\nvoid f(void) { }\n", true),
        ("/* a plant */\nstatic double x[2];\n", true),
        ("// a plant\n\nvoid f(double t, const double *x, double *dx)\n{\n}\n", true),
        ("# include of nothing\nformat: 1\n", false),
        ("{ // double x;\n}", false),
        ("{ \"name\": double }", false),
        ("int = 3\n", false),
    ] {
        let (_folder, path) = file("plant.c", content);
        let (code, text) = told(&CERTIFY, Some(&path), &[]);
        assert!(code == 2 && text.contains(C) == said, "{content}: {text}");
        assert_eq!(text.contains("`sigmastar new plant -o plant.jsonc`"), said, "{content}: {text}");
    }
    // The name alone is no mistake.
    let (_folder, path) = file("plant.c", &changed(&[]));
    assert_eq!(told(&CERTIFY, Some(&path), &[]).0, 0);
}

#[test]
fn a_base_frequency_in_hertz_is_told_in_radians() {
    const HERTZ: &str = "a frequency in cycles per unit of time (Hz)";
    let base = "/internal_model/base_frequency";
    let (code, text) = of(&[(base, "1".into())], &[]);
    assert!(code == 2 && text.contains(HERTZ) && text.contains("2*pi/period, which is `2*pi`"), "{text}");
    assert!(!text.contains("`matched` to false"), "{text}");
    // Another number is no frequency in Hz.
    let (code, text) = of(&[(base, "3".into())], &[]);
    assert!(code == 2 && !text.contains(HERTZ) && text.contains("set `matched` to false"), "{text}");
    // Where nothing is asserted it is certified, with a remark on each stream.
    for (frequency, said) in [("1", true), ("6", false)] {
        let changes = [(base, frequency.into()), ("/internal_model/matched", false.into())];
        let (_folder, path) = file("plant.json", &changed(&changes));
        let (code, both) = streams(&TOLD, Some(&path), &[]);
        assert!(code == 0 && both.iter().all(|text| text.contains(HERTZ) == said), "{frequency}: {both:?}");
        assert_eq!(both[0].contains("it is 2*pi, with `matched`"), said, "{both:?}");
        assert!(!streams(&CERTIFY, Some(&path), &[]).1[1].contains(HERTZ));
    }
}

/// Revolutions per minute and degrees are told as what they are, in the file and in formulas.
#[test]
fn other_units_of_angles_and_frequencies_are_told() {
    let base = "/internal_model/base_frequency";
    for (frequency, said) in [("60", "revolutions per minute"), ("360", "degrees per unit of time")] {
        let (code, text) = of(&[(base, frequency.into())], &[]);
        assert!(code == 2 && text.contains(said) && !text.contains("`matched` to false"), "{text}");
    }
    for (q, said) in [("sin(360*t)", true), ("sin(350*t)", false)] {
        let (code, text) = of(&[("/q", q.into())], &[]);
        assert!(code == 2 && text.contains("angles are in radians") == said, "{q}: {text}");
    }
    let (code, text) = of(&[("/internal_model/weights", json!([2, 1, 1]))], &[]);
    assert!(code == 2 && text.contains("\"family\": \"power\""), "{text}");
}

#[test]
fn an_input_gain_of_two_units_is_a_wide_interval() {
    const WIDE: &str = "the input gain is known to a factor of ";
    let gain = |low: &str, high: &str| {
        let gain = json!({ "nominal": "1/0.4", "low": low, "high": high });
        let (_folder, path) = file("plant.json", &changed(&[("/input_gain", gain)]));
        streams(&TOLD, Some(&path), &[]).1
    };
    let both = gain("0.9", "1.1/0.4");
    assert!(both.iter().all(|text| text.contains(&format!("{WIDE}3.06 only, from 0.9 to 1.1/0.4"))), "{both:?}");
    assert!(both[1].contains("as 1/C, 0.9/C and 1.1/C"), "{both:?}");
    let both = gain("0.9/0.4", "1.1/0.4");
    assert!(both.iter().all(|text| !text.contains(WIDE)), "{both:?}");
}

#[test]
fn the_nominal_gain_is_shown_as_a_number() {
    for (nominal, shown) in [("1/0.4", "the nominal gain 2.5"), ("10/7000000007", "the nominal gain about 1.43e-9")] {
        let gain = json!({ "nominal": nominal, "low": format!("0.9*{nominal}"), "high": format!("1.1*{nominal}") });
        let (code, text) = of(&[("/input_gain", gain)], &[]);
        assert!(
            code == 0 && text.contains(&format!("the regulator divides its control by {shown}")),
            "{nominal}: {text}"
        );
    }
}

#[test]
fn a_rounded_period_may_be_written_exactly() {
    let with = |period: &str| {
        let frequency =
            format!("2*pi/{}", if period.contains('/') { format!("({period})") } else { period.to_owned() });
        of(
            &[
                ("/period", period.into()),
                ("/q", "sin(phase)".into()),
                ("/internal_model/base_frequency", frequency.into()),
                ("/internal_model/mu", "6".into()),
            ],
            &[],
        )
    };
    let (code, text) = with("0.333");
    assert!(code == 0 && text.contains("if 1/3 is meant, write \"1/3\""), "{text}");
    for period in ["1/3", "0.125", "0.3"] {
        let (code, text) = with(period);
        assert!(code == 0 && !text.contains("is meant, write"), "{period}: {text}");
    }
    // Where the formulas have the exact one.
    let (code, text) = of(&[("/period", "0.333".into()), ("/q", "sin(6*pi*t)".into())], &[]);
    assert!(
        code == 2
            && text.contains("not periodic")
            && text.contains("state the period `\"1/3\"`, if that is meant: 0.333"),
        "{text}"
    );
    let (code, text) = of(&[("/period", "0.3".into()), ("/q", "sin(6*pi*t)".into())], &[]);
    assert!(code == 2 && text.contains("not periodic") && !text.contains("if that is meant"), "{text}");
}

#[test]
fn ends_that_are_exchanged_are_named_both() {
    let ends = |nominal: &str, low: &str, high: &str| json!({ "nominal": nominal, "low": low, "high": high });
    let advice = "exchange the two: `low` is the smaller end, 0.5, and `high` the larger one, 2";
    for (place, more) in [
        ("/input_gain", vec![]),
        ("/parameters", vec![("/q", "k*sin(2*pi*t)".into())]),
        ("/period", vec![("/q", "sin(phase)".into()), ("/internal_model/matched", false.into())]),
    ] {
        let put = |value: Value| if place == "/parameters" { json!({ "k": value }) } else { value };
        let told = |value: Value| {
            let fields: Vec<_> = more.iter().cloned().chain([(place, put(value))]).collect();
            let (_folder, path) = file("plant.json", &changed(&fields));
            told(&CERTIFY, Some(&path), &[])
        };
        let (code, text) = told(ends("1", "2", "0.5"));
        assert!(
            code == 2 && text.contains("`low` = 2 is above `high` = 0.5") && text.contains(advice),
            "{place}: {text}"
        );
        assert_eq!(text.matches("error[").count(), 1, "{place}: {text}");
        // A nominal value that is not between them.
        let (code, text) = told(ends("3", "0.5", "2"));
        assert!(code == 2 && !text.contains("exchange") && text.contains('3') && text.contains('2'), "{place}: {text}");
    }
}

#[test]
fn a_plant_is_certified_before_it_is_checked() {
    let plant = changed(&[]);
    for (name, content, what) in [
        ("plant.json", plant.clone(), Some("a plant")),
        ("plant.jsonc", format!("// a plant\n{plant}"), Some("a plant")),
        ("spec.toml", "format = \"sigmastar/bounding-spec\"\n".to_owned(), Some("a specification")),
        ("study.toml", "format = \"sigmastar/study\"\n".to_owned(), None),
    ] {
        let (_folder, path) = file(name, &content);
        let (code, text) = told(&["check"], Some(&path), &[]);
        let said = |what: &str| text.contains(&format!("is {what}, not a certificate: `sigmastar certify "));
        assert_eq!(code, 2, "{name}: {text}");
        assert!(what.map_or(!said("a plant") && !said("a specification"), said), "{name}: {text}");
    }
}

#[test]
fn too_many_numbers_of_oscillators_are_told_with_a_list() {
    let (code, text) = of(&[], &["--n-o", "0..60"]);
    assert!(code == 2 && text.contains("at most 8") && text.contains("as `0..60/10`"), "{text}");
    let (code, text) = of(&[], &["--n-o", "0-60"]);
    assert!(code == 2 && text.contains("such as `0,1,2,10..20`"), "{text}");
    // What is advised is taken.
    let (code, text) = of(&[], &["--n-o", "0..60/10"]);
    assert!(code == 0 && !text.contains("at most 8"), "{text}");
}

#[test]
fn a_percentage_is_told_as_a_number() {
    let share = "write 0.15 or 3/20 for 15%";
    let (code, text) = of(&[("/internal_model/mu", "15%".into())], &[]);
    assert!(code == 2 && text.contains(share), "{text}");
    let (code, text) = of(&[("/q", "e*15% + sin(2*pi*t)".into())], &[]);
    assert!(code == 2 && text.contains(share), "{text}");
    for flag in ["--target-sup", "--sigma"] {
        let (code, text) = of(&[], &[flag, "15%"]);
        assert!(code == 2 && text.contains(share), "{flag}: {text}");
    }
    let (_folder, path) = file("plant.json", &changed(&[]).replace("\"1\"", "15%"));
    let (code, text) = told(&CERTIFY, Some(&path), &[]);
    assert!(code == 2 && text.contains(share), "{text}");
    let (code, text) = of(&[("/internal_model/mu", "200%".into())], &[]);
    assert!(code == 2 && text.contains("write 2 for 200%"), "{text}");
    let (code, text) = of(&[("/q", "(e)% + sin(2*pi*t)".into())], &[]);
    assert!(code == 2 && text.contains("there are no percentages"), "{text}");
    let (code, text) = of(&[("/q", "e $ 2".into())], &[]);
    assert!(code == 2 && !text.contains("percentages"), "{text}");
}

/// An end of an interval that is a percentage is told as the number that it means.
#[test]
fn a_percentage_as_an_end_is_told_as_that_end() {
    let interval = json!({ "nominal": "2", "low": "-10%", "high": "+5%" });
    for pointer in ["/input_gain", "/period"] {
        let (code, text) = of(&[(pointer, interval.clone())], &[]);
        for said in
            [r#"for 10 % below `nominal` write `"low": "1.8"`"#, r#"for 5 % above `nominal` write `"high": "2.1"`"#]
        {
            assert!(code == 2 && text.contains(said) && !text.contains("no percentages"), "{pointer}: {text}");
        }
    }
    let (code, text) = of(&[("/parameters", json!({ "k": interval }))], &[]);
    assert!(code == 2 && text.contains(r#"write `"low": "1.8"`"#), "{text}");
}

/// One number in the place of the interval of the input gain is told with the interval of that one number.
#[test]
fn an_input_gain_that_is_one_number_is_told_as_an_interval() {
    for (gain, kind) in [(json!(2000), "a number"), (json!("2000"), "a string")] {
        let (code, text) = of(&[("/input_gain", gain)], &[]);
        let said = r#"write `"input_gain": { "nominal": "2000", "low": "2000", "high": "2000" }`"#;
        let kind = format!("`input_gain` is {kind}, and an interval is expected");
        assert!(code == 2 && text.contains(said) && text.contains(&kind), "{text}");
    }
}

/// What a box and a domain need is named with what it says.
#[test]
fn a_size_that_is_missing_is_told_with_what_it_bounds() {
    let states = [("/states", json!(["x"])), ("/f", json!(["-x"]))];
    let with = |field| of(&[&states[..], &[field]].concat(), &[]);
    let (code, text) = with(("/initial_set", json!({ "kind": "box", "E0": 1 })));
    for said in [
        "the field `ball` is missing",
        r#"`"ball": "1/10"` is |x - x_0| <= 1/10 in the units of the file"#,
        "the field `Z0` is missing",
        r#"`"Z0": "0"` is a regulator at rest"#,
    ] {
        assert!(code == 2 && text.contains(said), "{said}: {text}");
    }
    let (code, text) = with(("/domain", json!({ "e": 1 })));
    assert!(code == 2 && text.contains("how far from the orbit the formulas hold: |x - x_0| <= x"), "{text}");
}

#[test]
fn verify_is_check() {
    let (code, text) = told(&["verify", "certificate.json"], None, &[]);
    assert!(code == 2 && text.contains("did you mean `check`?") && !text.contains("exists: 'certify'"), "{text}");
    let (code, text) = told(&["certfy", "plant.json"], None, &[]);
    assert!(code == 2 && text.contains("'certify'") && !text.contains("did you mean `check`?"), "{text}");
}

#[test]
fn a_target_of_thousands_of_oscillators_is_remarked() {
    const MANY: &str = "So many oscillators are hardly practical";
    for (target, said) in [("1e-9", true), ("1/100", false)] {
        let (code, [text, _]) = streams(&CERTIFY, Some(Path::new("specs/linear.json")), &["--target-sup", target]);
        assert!(code == 0 && text.contains("the least for these bounds"), "{text}");
        assert_eq!(text.contains(MANY), said, "{target}: {text}");
    }
}

#[test]
fn sampling_periods_that_divide_the_period_are_offered() {
    let third = [
        ("/period", "1/3".into()),
        ("/q", "sin(6*pi*t)".into()),
        ("/internal_model/base_frequency", "6*pi".into()),
        ("/internal_model/mu", "6".into()),
    ];
    let (code, text) = of(&third, &["--sampling-period", "1/1000"]);
    let offered = "such as `1/900` (300 samples in a period), `1/999` (333), `1/1002` (334) or `1/1200` (400)";
    assert!(code == 2 && text.contains("is 1000/3, not a whole number") && text.contains(offered), "{text}");
    let (code, text) = of(&third, &["--sampling-period", "1/1200"]);
    assert!(code == 0 && !text.contains("samples in a period), `"), "{text}");
}

/// The limits of an actuator in another form than that of the file are told with the numbers that stand there.
#[test]
fn the_limits_of_an_actuator_in_another_form() {
    const MEANT: &str = r#"write `"actuator": { "min": "0", "max": "4" }`"#;
    let actuator = |value: Value| of(&[("/actuator", value)], &[]);
    for (value, said) in [
        (json!([0, 4]), "the limits of an actuator are no list"),
        (json!({ "low": 0, "high": "4" }), "called `min` and `max`, not `low` and `high`"),
    ] {
        let (code, text) = actuator(value);
        assert!(code == 2 && text.contains(said) && text.contains(MEANT), "{text}");
    }
    let (code, text) = actuator(json!({ "min": -2 }));
    let both = r#"state both limits, as `"actuator": { "min": "-2", "max": "..." }`"#;
    assert!(code == 2 && text.contains("the upper limit, is missing") && text.contains(both), "{text}");
    // Three numbers are no limits, and the form that is meant is none.
    let (code, text) = actuator(json!([0, 1, 4]));
    assert!(code == 2 && text.contains("expected an object") && !text.contains("are no list"), "{text}");
    assert!(!actuator(json!({ "min": "0", "max": "400" })).1.contains("actuator are"));
}

/// A name without an argument is no misspelt function: a parameter is missing, or misspelt.
#[test]
fn a_parameter_that_is_not_there() {
    let q = |text: &str, parameters: Value| of(&[("/q", text.into()), ("/parameters", parameters)], &[]);
    let (code, text) = q("Pmax*sin(2*pi*t)", json!({}));
    let add = r#"give it a value in the field `parameters` of the file, as `"parameters": { "Pmax": "1" }`"#;
    assert!(code == 2 && text.contains("`Pmax` is not a known name") && text.contains(add), "{text}");
    assert!(!text.contains("did you mean max?"), "{text}");
    for name in ["Pmx", "pmax"] {
        let (code, text) = q(&format!("{name}*sin(2*pi*t)"), json!({ "Pmax": "3" }));
        assert!(code == 2 && (text.contains("did you mean Pmax?") || text.contains("write Pmax")), "{text}");
    }
    let (code, text) = q("maxx(1, sin(2*pi*t))", json!({}));
    assert!(code == 2 && text.contains("did you mean max?") && !text.contains("give it a value"), "{text}");
}

/// Why no interval of the input gain contains 0, and what to write.
#[test]
fn an_input_gain_that_may_be_0() {
    for (value, from) in [
        (json!({ "nominal": 1, "low": 0, "high": 2 }), "from 0 to 2"),
        (json!({ "nominal": "1", "low": "-1", "high": "2" }), "from -1 to 2"),
        (json!([-1, 1]), "from -1 to 1"),
    ] {
        let (code, text) = of(&[("/input_gain", value)], &[]);
        assert!(code == 2 && text.contains(&format!("the input gain may be 0: its interval is {from}")), "{text}");
        assert!(text.contains("the control does nothing") && text.contains("the smallest positive gain"), "{text}");
    }
    // A negative one has another sign.
    let negative = json!({ "nominal": -1, "low": -2, "high": "-1/2" });
    let (code, text) = of(&[("/input_gain", negative)], &[]);
    assert!(
        code == 2 && text.contains("count the control with the other sign") && !text.contains("may be 0"),
        "{text}"
    );
}

#[test]
fn a_steady_error_of_0_is_told_what_to_ask_for() {
    let (_folder, path) = file("plant.json", &changed(&[]));
    for command in ["design", "certify"] {
        let (code, text) = told(&[command], Some(&path), &["--steady-error", "0"]);
        assert!(code == 2 && text.contains("`--steady-error` must be positive, but it is 0"), "{text}");
        assert!(text.contains("ask for a small positive bound, such as `1e-6`"), "{text}");
    }
    let (code, text) = told(&["design"], Some(&path), &["--steady-error", "-1"]);
    assert!(code == 2 && text.contains("must be positive, but it is -1") && !text.contains("1e-6"), "{text}");
}
