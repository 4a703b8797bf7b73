//! What a first use runs into at the command line; beside each the case that nearly does.

use crate::support::{self, EXAMPLE, every, json as parsed, number, program, read, stored, utf8};
use serde_json::{Value, json};
use tempfile::TempDir;

/// A call, with a shipped file in another form at its end: the exit code, and both streams in one line.
fn told(command: &[&str], name: &str, change: impl FnOnce(&mut Value)) -> (i32, String) {
    let folder = TempDir::new().expect("a folder");
    let mut value = read(name);
    change(&mut value);
    support::told(program().args(command).arg(stored(folder.path(), "file.json", &value)))
}

const LINEAR: &str = "specs/plants/linear.json";
const PENDULUM: &str = "specs/plants/pendulum.json";
const CERTIFY: [&str; 2] = ["certify", "--no-alternatives"];

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
        let quoted = |sum: &str| sum.replace('v', "'v'").replace('x', "'x'");
        let (code, text) = with(names, f);
        assert!(
            code == 3 && text.contains(&format!("no state acts on {}, which only adds up", quoted(sum))),
            "{f:?}: {text}"
        );
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
    let (code, text) = with(&["--no-alternatives"], set(share));
    let found = text.split_once("sigma* = ").and_then(|(_, rest)| rest.split_once(" in 1/time")).expect("a gain").0;
    let [found, sigma] = [found, sigma].map(|text| text.parse::<f64>().expect("a number"));
    // The search for a share goes without joint metrics.
    assert!(code == 0 && found <= sigma, "{sigma}: {text}");
    let (code, text) = with(&["--no-alternatives"], set(share / 2));
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
        (&["--color", "never", "certify", EXAMPLE, "--gain=3"], true),
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
    const REMARK: &str = "with `--n-o` the claim rests on norms, because rates at samples are proved from norms";
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
            let mut plant = read(LINEAR);
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

/// A pressure loop, whose smallest gain is far below the rates that one asks for.
const PUMP: &str = r#"
format = "sigmastar/plant"
version = 1
name = "Pressure loop"
period = "1/60"
states = ["Q"]
f = ["(60 + e - R*Q^2)/L"]
q = "(Qp*(1 + 0.14*cos(120*pi*t) + 0.05*cos(240*pi*t)) - Q)/C"
initial_set = { kind = "aligned" }
parameters = { R = 240, L = 2, C = 0.004, Qp = 0.55 }
internal_model = { mu = 100, base_frequency = "120*pi", matched = true, weights = { family = "power", n0 = 2, epsilon = "1/2" } }
"#;

/// A call with the text of a file at its end: the exit code, and both streams in one line.
fn of_text(command: &[&str], name: &str, text: &str) -> (i32, String) {
    let folder = TempDir::new().expect("a folder");
    let path = folder.path().join(name);
    std::fs::write(&path, text).expect("written");
    support::told(program().args(command).arg(&path))
}

#[test]
#[ignore = "search tier"]
fn rates_far_above_the_smallest_gain_are_found() {
    let at = |flags: &[&str]| of_text(&[&["certify", "--no-alternatives"], flags].concat(), "pump.toml", PUMP);
    let (code, text) = at(&["--rate", "5", "--n-o", "2"]);
    assert!(code == 0 && text.contains("a rate of at least 5 for n_o = 2"), "{text}");
    if every(2) == 1 {
        // Faster than the zero dynamics no loop is.
        let (code, text) = at(&["--rate", "1e5", "--n-o", "2"]);
        assert!(code == 3 && text.contains("the largest one found is about"), "{text}");
    }
}

#[test]
#[ignore = "search tier"]
fn the_smallest_gain_beside_a_limit_is_that_of_the_plant() {
    let report = |flags: &[&str]| -> Value {
        let (code, text) =
            of_text(&[&["certify", "--no-alternatives", "-q", "--format", "json"], flags].concat(), "pump.toml", PUMP);
        assert_eq!(code, 0, "{text}");
        parsed(text.as_bytes())
    };
    let smallest = number(&report(&[])["sigma_star"]);
    for limit in [["--peak-error", "0.01"], ["--steady-error", "0.01"]] {
        let limited = report(&limit);
        let estimate = number(&limited["sigma_star_estimate"]);
        assert!((estimate / smallest - 1.0).abs() < 0.01, "{limit:?}: {estimate}, {smallest}");
        assert!(number(&limited["sigma_star"]) > 10.0 * smallest, "{limited}");
    }
}

/// Of each size of the set it is said where it is from: stated, of the ball that is stated, or a multiple of the bound of the periodic solution.
fn assert_said_where_sizes_are_from(cases: &[(&str, &str)]) {
    const ROW: &str = "at any time; contains the ball |x - x_0| <= ";
    for (set, expected) in cases {
        let (code, text) = of_text(&CERTIFY, "pump.toml", &PUMP.replace("{ kind = \"aligned\" }", set));
        let row = text.split_once(ROW).and_then(|(_, row)| row.split_once("; "));
        let said = row.is_some_and(|(_, rest)| rest.starts_with(&format!("{expected} - next: ")));
        assert!(code == 0 && said, "{set}: {text}");
        assert!(text.contains("orbit: x_0(t): 'Q' about 0.5"), "{text}");
    }
}

#[test]
fn where_the_sizes_of_the_set_are_from_is_said() {
    assert_said_where_sizes_are_from(&[
        ("{ kind = \"aligned\", ball = 0.001, E0 = 0.1 }", "X0 from the `ball` of the file, E0 as stated"),
        ("{ kind = \"aligned\", X0 = 0.001, E0 = \"sqrt(2)/10\" }", "X0 as stated, E0 at least as stated"),
    ]);
}

#[test]
#[ignore = "search tier"]
fn where_every_size_of_the_set_is_from_is_said() {
    assert_said_where_sizes_are_from(&[
        ("{ kind = \"aligned\" }", "about twice the bound of the periodic solution"),
        ("{ kind = \"aligned\", E0 = 0.1 }", "X0 about twice the bound of the periodic solution, E0 as stated"),
        ("{ kind = \"aligned\", X0 = 0.001 }", "X0 as stated, E0 about twice the bound of the periodic solution"),
        ("{ kind = \"aligned\", X0 = 0.001, E0 = 0.1 }", "as stated"),
        ("{ kind = \"aligned\", X0 = 0.001, E0 = \"sqrt(1/100)\" }", "as stated"),
    ]);
}

#[test]
fn what_stands_below_a_table_in_toml_belongs_to_it() {
    let parameters = "parameters = { R = 240, L = 2, C = 0.004, Qp = 0.55 }\n";
    let below = |line: &str| {
        let text = PUMP.replace(parameters, "") + "\n[parameters]\nR = 240\nL = 2\nC = 0.004\nQp = 0.55\n" + line;
        of_text(&CERTIFY, "pump.toml", &text)
    };
    let said = "is a field of the file itself";
    let (code, text) = below("initial_set = { kind = \"aligned\" }");
    assert!(
        code == 2 && text.contains(&format!("`initial_set` {said}")) && !text.contains("`nominal` is missing"),
        "{text}"
    );
    // A number may have that name, and be known to an interval.
    let (code, text) = below("domain = { nominal = 1, low = 1, high = 2 }");
    assert!(code == 0 && !text.contains(said), "{text}");
    // In another table, where no name is the user's.
    let model = "internal_model = { mu = 100,";
    let (code, text) =
        of_text(&CERTIFY, "pump.toml", &PUMP.replace(model, "internal_model = { domain = { x = 1, e = 1 }, mu = 100,"));
    assert!(code == 2 && text.contains(&format!("`domain` {said}")), "{text}");
    let (code, text) = of_text(&CERTIFY, "pump.toml", &PUMP.replace(model, "internal_model = { domein = 1, mu = 100,"));
    assert!(code == 2 && !text.contains(said), "{text}");
}

#[test]
fn what_is_no_list_no_end_and_no_gain_is_told_with_what_is() {
    let changed = |from: &str, to: &str| of_text(&CERTIFY, "pump.toml", &PUMP.replace(from, to));
    let brackets = "a list stands in brackets";
    let (code, text) = changed("f = [\"(60 + e - R*Q^2)/L\"]", "f = \"(60 + e - R*Q^2)/L\"");
    assert!(code == 2 && text.contains(brackets), "{text}");
    let (code, text) = changed("f = [\"(60 + e - R*Q^2)/L\"]", "f = 1");
    assert!(code == 2 && !text.contains(brackets), "{text}");
    let sign = "count the control with the other sign";
    let gain = |ends: &str| changed("period =", &format!("input_gain = {{ {ends} }}\nperiod ="));
    let (code, text) = gain("nominal = \"-1/C\", low = \"-1/C\", high = \"-1/C\"");
    assert!(code == 2 && text.contains(sign), "{text}");
    let (code, text) = changed("mu = 100", "mu = -100");
    assert!(code == 2 && text.contains("`mu` must be positive") && !text.contains(sign), "{text}");
    let end = "the text ends before its value does";
    let (code, text) = of_text(&CERTIFY, "plant.json", "{ \"format\": \"sigmastar/plant\"");
    assert!(code == 2 && text.contains(end), "{text}");
    let (code, text) = of_text(&CERTIFY, "plant.json", "{ \"format\": }");
    assert!(code == 2 && !text.contains(end), "{text}");
}

#[test]
fn flags_of_files_and_of_other_commands_are_told_apart() {
    let with = |words: &[&str]| {
        let output = program().args(words).output().expect("the program runs");
        (output.status.code().expect("a code"), utf8(output.stderr))
    };
    for (words, said) in [
        (&["certify", EXAMPLE, "--mu", "2"][..], "it is a field of the file: `internal_model.mu`"),
        (&["certify", EXAMPLE, "--saturation", "2"], "it is a flag of `controller`, `simulate`"),
        (&["certify", "--sigma", EXAMPLE, "5"], "a number stands where a file is expected"),
        (&["sweep", "specs/studies/linear.json", "-o", "x.csv", "--shard", "1/2"], "from Python: `sigmastar.run_case`"),
        (&["merge", "x.jsonl", "-o", "y.jsonl"], "from Python: `sigmastar.run_case`"),
        (&["rate", EXAMPLE], "`certify --n-o LIST` proves rates"),
    ] {
        let (code, text) = with(words);
        assert!(code == 2 && text.contains(said), "{words:?}: {text}");
    }
    // Flags that the command has, and a file that there is not.
    for words in
        [&["certify", EXAMPLE, "--quiet", "--progress"][..], &["certify", EXAMPLE, "--sigma"], &["certify", "5.json"]]
    {
        let (code, text) = with(words);
        let wrong = ["it is a field", "it is a flag", "a number stands"].iter().find(|said| text.contains(**said));
        assert!(code == 2 && wrong.is_none(), "{words:?}: {text}");
    }
}

#[test]
fn what_limits_a_gain_at_samples_is_what_it_would_fall_without() {
    let limit = |name: &str, samples: u32, flags: &[&str]| {
        let h = format!("1/{samples}");
        let call = ["certify", "--no-alternatives", "-q", "--format", "json", "--sampling-period", &h, name];
        let output = program().args(call).args(flags).output().expect("the program runs");
        let report = parsed(&output.stdout);
        report["limit"]["name"].as_str().expect("a limit").to_owned()
    };
    let rms = "specs/paper-example-rms-at-rest.json";
    for (name, samples, flags, expected) in [
        // In continuous time the gain is 1.324: at 20 samples it is a seventh larger, at 1000 nothing that matters.
        ("specs/linear.json", 20, &[][..], "theta"),
        ("specs/linear.json", 1000, &[], "gain"),
        // Here it is 13.84; 16 is certified with 30 samples, and with 25 the gain is 1/h.
        (rms, 30, &["--sigma", "16"], "motion"),
        (rms, 25, &["--sigma", "25"], "hold"),
        (rms, 100, &[], "gain"),
    ] {
        assert_eq!(limit(name, samples, flags), expected, "{name} {samples} {flags:?}");
    }
}
