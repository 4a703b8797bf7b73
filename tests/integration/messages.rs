//! What a newcomer writes by mistake, and what is said to it; beside each the case that nearly is the mistake.

use crate::support::{EXAMPLE, document, in_one_line, program, utf8};
use serde_json::Value;
use std::path::PathBuf;

/// A file of this name and content, in a folder that is removed with the first part.
fn file(name: &str, content: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, content).unwrap();
    (folder, path)
}

/// The linear plant with another q, and perhaps with a state of this name.
fn plant(q: &str, state: Option<&str>) -> String {
    let mut plant = document("plants/linear");
    plant["q"] = q.into();
    if let Some(name) = state {
        plant["states"] = vec![name].into();
        plant["f"] = vec![format!("-{name} + e")].into();
        plant["initial"] = serde_json::json!({ "x": ["0"], "e": "0" });
    }
    plant.to_string()
}

/// The exit code and both streams of a call on this file.
fn told(command: &[&str], path: &std::path::Path) -> (i32, String) {
    let output = program().args(command).arg(path).output().expect("the program runs");
    (output.status.code().unwrap(), utf8(output.stdout) + &utf8(output.stderr))
}

#[test]
fn the_control_is_left_out_of_q() {
    let (_folder, path) = file("plant.json", &plant("e + u + sin(2*pi*t)", None));
    let (code, text) = told(&["certify"], &path);
    assert!(code == 2 && text.contains("leave it out of q") && text.contains("Relative degree above 1"), "{text}");
    // Another name is no control, and a state may have that one.
    let (_folder, path) = file("plant.json", &plant("e + v + sin(2*pi*t)", None));
    let (code, text) = told(&["certify"], &path);
    assert!(code == 2 && !text.contains("leave it out of q"), "{text}");
    let (_folder, path) = file("plant.json", &plant("u + sin(2*pi*t)", Some("u")));
    assert_eq!(told(&["certify", "--no-alternatives"], &path).0, 0);
}

#[test]
fn a_sign_has_a_smooth_function_in_its_place() {
    for (q, code, said) in [
        ("sign(e) + sin(2*pi*t)", 2, Some("write tanh(20*x) for sign(x)")),
        ("sinn(e) + sin(2*pi*t)", 2, Some("did you mean sin?")),
        ("tanh(20*e)/10 + sin(2*pi*t)", 0, None),
    ] {
        let (_folder, path) = file("plant.json", &plant(q, None));
        let (found, text) = told(&["certify", "--no-alternatives"], &path);
        assert!(found == code && said.is_none_or(|said| text.contains(said)), "{q}: {text}");
    }
}

/// A plant in which u is 0 at a quarter of the period, as Hodgkin and Huxley's rates are: what is undefined is named, and when; what has it
/// built in is offered, and what is another model is said to be.
#[test]
fn a_quotient_that_is_0_over_0_is_named_with_its_instant() {
    let told_of = |f: &str, initial: Option<&str>| {
        let mut plant: Value = serde_json::from_str(&plant("x + sin(2*pi*t)", Some("x"))).unwrap();
        plant["f"] = vec![f].into();
        plant.as_object_mut().unwrap().remove("initial");
        if let Some(x) = initial {
            plant["initial"] = serde_json::json!({ "x": [x], "e": "0" });
        }
        let (_folder, path) = file("plant.json", &plant.to_string());
        let (code, text) = told(&["certify", "--no-alternatives"], &path);
        (code, in_one_line(&text))
    };
    const CHANGED: &str = "with it the model is another one";
    for (f, quotient, offered) in [
        ("-x + e + u/(exp(u) - 1)", true, "write a*b*exprelr(u/b) for a*u/(exp(u/b) - 1)"),
        ("-x + e + sin(u)/u", true, "write sinc(u) for sin(u)/u"),
        ("-x + e + 1/u", false, CHANGED),
    ] {
        // The zero is met by a time that is looked at, and by none.
        for (u, s) in [("(cos(2*pi*t) + e/9)", "t/T = 0.25"), ("(cos(2*pi*t - 1) + e/9)", "t/T = 0.409")] {
            let (code, text) = told_of(&f.replace('u', u), Some("0.4"));
            assert!(code == 3 && text.contains("at /f/0"), "{f}: {text}");
            assert!(text.contains(s) && text.contains("has no value"), "{f}: {text}");
            assert_eq!(text.contains("it is 0/0 there"), quotient, "{f}: {text}");
            assert!(text.contains(offered) && text.contains(CHANGED), "{f}: {text}");
            assert!(!text.contains("initial`") && !text.contains("units"), "{f}: {text}");
        }
    }
    // Nearly: with the function; and where another state helps, which is asked for where none is stated, or another one where one is.
    assert_eq!(told_of("-x + e/9 + exprelr(cos(2*pi*t) + e/9)", None).0, 0);
    let root = "1 - sqrt(x - 200000) + cos(2*pi*t)/9 + e/9";
    let (_, text) = told_of(root, None);
    assert!(text.contains("state an `initial`"), "{text}");
    let (_, text) = told_of(root, Some("0.4"));
    assert!(
        text.contains("state another `initial`") && text.contains("the argument of sqrt is not positive"),
        "{text}"
    );
}

#[test]
fn a_corner_is_told_straight() {
    let (_folder, path) = file("plant.json", &plant("abs(e) + sin(2*pi*t)", None));
    let (code, text) = told(&["certify"], &path);
    assert!(code == 3 && text.contains("the argument of abs vanishes at some state and error"), "{text}");
    assert!(text.contains("write sqrt(e^2 + 1/100) for abs(e)") && !text.contains("not true"), "{text}");
    let (_folder, path) = file("plant.json", &plant("abs(100 + e)/100 + sin(2*pi*t)", None));
    // What is not seen to vanish anywhere is not said to.
    let (_, text) = told(&["certify", "--no-alternatives"], &path);
    assert!(!text.contains("abs vanishes at some state"), "{text}");
}

#[test]
fn another_notation_under_the_name_of_json_is_recognised() {
    const TOML: &str = "this looks like TOML: name the file `.toml`";
    const YAML: &str = "this looks like YAML, which is not read";
    for (content, said) in [
        ("format = \"sigmastar/plant\"\nversion = 1\n", Some(TOML)),
        ("# a plant\n[internal_model]\nmu = \"1\"\n", Some(TOML)),
        ("format: sigmastar/plant\nversion: 1\n", Some(YAML)),
        ("---\n# a plant\nformat: sigmastar/plant\n", Some(YAML)),
        ("{ \"format\": \"sigmastar/plant\", version: 1 }", None),
        ("{ format: 1 }", None),
        ("[1, 2", None),
        ("// format: 1\n{ }", None),
        ("hello", None),
    ] {
        let (_folder, path) = file("plant.json", content);
        let (code, text) = told(&["certify"], &path);
        assert_eq!(code, 2, "{content}: {text}");
        for message in [TOML, YAML] {
            assert_eq!(text.contains(message), said == Some(message), "{content}: {text}");
        }
    }
    // Under their own names the one is read, and what is wrong is something else.
    let (_folder, path) = file("plant.toml", "format = \"sigmastar/plant\"\nversion = 1\n");
    let (_, text) = told(&["certify"], &path);
    assert!(!text.contains("looks like") && text.contains("`period`"), "{text}");
}

#[test]
fn what_is_no_certificate_yet_is_certified_first() {
    for (name, what) in [("specs/plants/linear.json", "a plant"), ("specs/no-x.json", "a specification")] {
        for command in ["falsify", "check"] {
            let (code, text) = told(&[command], std::path::Path::new(name));
            let text = in_one_line(&text);
            assert_eq!(code, 2, "{command} {name}: {text}");
            let first = "is to be certified first: `sigmastar certify FILE -o CERTIFICATE`";
            assert!(text.contains(what) && text.contains(first), "{command} {name}: {text}");
        }
    }
    // A study is neither.
    let (_folder, path) = file("study.json", r#"{ "format": "sigmastar/study", "version": 1 }"#);
    for command in ["falsify", "check"] {
        let (code, text) = told(&[command], &path);
        assert!(code == 2 && !text.contains("certified first"), "{command}: {text}");
    }
}

/// What is certified of the paper's example with these flags: the exit code, and both streams in one line.
fn certified(flags: &[&str]) -> (i32, String) {
    let (code, text) = told(&[&["certify", "--no-alternatives"], flags].concat(), std::path::Path::new(EXAMPLE));
    (code, in_one_line(&text))
}

#[test]
fn the_words_of_a_claim_say_what_it_keeps_to() {
    let (code, text) = certified(&["--max-control", "300", "--peak-error", "10"]);
    let (words, facts) = text.split_once(" - gain: ").unwrap();
    assert!(code == 0 && words.contains("exponentially to it. At sigma = ") && !facts.contains("(proved: "), "{text}");
    assert!(
        words.contains(", |e| <= 10 (proved: ") && words.contains(") in the transient, |u| <= 300 (proved: "),
        "{text}"
    );
    let (_, text) = certified(&[]);
    assert!(!text.contains("At sigma = "), "{text}");
}

#[test]
fn another_gain_is_the_advice_where_one_is_given() {
    const SMALLER: &str = "another gain, and a smaller one if this is far above sigma*";
    const LARGER: &str = "a larger gain, which may lower the error";
    for (flags, said) in [
        (&["--sigma", "60", "--max-control", "1"][..], Some(SMALLER)),
        (&["--sigma", "60", "--max-control", "1", "--sampling-period", "1/10000"], Some(SMALLER)),
        (&["--sigma", "60", "--steady-error", "1/1000"], Some(LARGER)),
        // No gain was given, and none does.
        (&["--max-control", "1"], None),
    ] {
        let (code, text) = certified(flags);
        assert_eq!(code, 3, "{flags:?}: {text}");
        for advice in [SMALLER, LARGER] {
            assert_eq!(text.contains(advice), said == Some(advice), "{flags:?}: {text}");
        }
    }
}

#[test]
fn what_wants_quotes_in_json_is_shown_with_them() {
    for (content, said) in [
        ("{ \"period\": 2*pi }", Some("formulas and fractions stand in double quotes: `\"2*pi\"`")),
        ("{ \"period\": 1/50,\n\"x\": 1 }", Some("`\"1/50\"`")),
        ("{ \"f\": 1e5*x, \"é\": 1 }", Some("`\"1e5*x\"`")),
        ("{ \"f\": [\"é\" 1*x, é1*x] }", None),
        ("{ \"f\": [-2*x, 1] }", Some("`\"-2*x\"`")),
        ("{ \"name\": My plant, \"x\": 1 }", Some("texts and formulas stand in double quotes: `\"My plant\"`")),
        ("{ \"mu\": 1,5 }", Some("decimals have a point")),
        ("{ name: 1 }", Some("the names of fields stand in double quotes: `\"name\"`")),
        ("{ \"matched\": True }", Some("write `true`")),
        ("{ \"a\": 1 \"b\": 2 }", Some("put a comma in front of it")),
        ("{ \"a\": 1 // one\n}", Some("JSON has no comments")),
        ("{ \"a\": 1; }", None),
        ("{ \"a\": }", None),
        ("{ \"a\": 1", None),
    ] {
        let (_folder, path) = file("plant.json", content);
        let (code, text) = told(&["certify"], &path);
        assert!(code == 2 && said.is_none_or(|said| text.contains(said)), "{content}: {text}");
        assert!(said.is_some() || !text.contains("quotes") && !text.contains("comma in front"), "{content}: {text}");
    }
}

#[test]
fn a_sampling_period_is_told_at_its_flag_and_the_rest_in_the_file() {
    let (_folder, path) = file("plant.json", &plant("sin(2*pi*t)", None));
    let (code, text) = told(&["certify", "--sampling-period", "500"], &path);
    assert!(code == 2 && text.contains("--> <command line>:1:19") && text.contains("write `1/500`"), "{text}");
    // Longer than the period, and no rate of samples either; shorter, and no share of it.
    for step in ["3/2", "2/7"] {
        let (code, text) = told(&["certify", "--sampling-period", step], &path);
        assert!(code == 2 && text.contains("<command line>") && !text.contains("two samples"), "{text}");
    }
    let (_folder, path) = file("plant.json", &plant("sin(2*pi*t)", None).replace("\"mu\":\"1\"", "\"mu\":\"-1\""));
    let (code, text) = told(&["certify", "--sampling-period", "1/500"], &path);
    assert!(code == 2 && text.contains("plant.json:1:") && !text.contains("command line"), "{text}");
}

#[test]
fn a_file_of_another_format_is_sent_to_its_command() {
    let plant_text = plant("sin(2*pi*t)", None);
    let specification = std::fs::read_to_string("specs/no-x.json").unwrap();
    for (command, content, said) in [
        ("errata", plant_text.clone(), "`sigmastar bound FILE -o SPEC` writes those of a plant"),
        ("bound", specification.clone(), "this command needs formulas"),
        ("certify", plant_text.replace("sigmastar/plant", "sigmastar/plnat"), "did you mean `sigmastar/plant`?"),
        ("certify", plant_text.replace("sigmastar/plant", "sigmastar/bounding-spec"), "expected `sigmastar/plant`"),
        (
            "certify",
            specification.replace("sigmastar/bounding-spec", "sigmastar/plant"),
            "those of a file of the format `sigmastar/bounding-spec`",
        ),
        (
            "certify",
            "{ \"format\": \"sigmastar/study\", \"version\": 1 }".to_owned(),
            "`sigmastar sweep` is for studies",
        ),
        ("certify", plant_text.replace("\"format\":\"sigmastar/plant\",", ""), "the field `format` is missing"),
    ] {
        let (_folder, path) = file("file.json", &content);
        let (code, text) = told(&[command], &path);
        assert!(code == 2 && text.contains(said), "{command}: {text}");
        assert_eq!(text.matches("error[").count(), 1, "{command}: {text}");
    }
    // What is nothing that is known, and near to nothing.
    let (_folder, path) = file("file.json", &plant_text.replace("sigmastar/plant", "another/one"));
    let (_, text) = told(&["certify"], &path);
    assert!(!text.contains("did you mean"), "{text}");
}

#[test]
fn what_stands_in_a_field_of_an_object_is_put_there() {
    let changed = |name: &str, value: Value| {
        let mut plant: Value = serde_json::from_str(&plant("sin(2*pi*t)", None)).unwrap();
        plant[name] = value;
        let (_folder, path) = file("plant.json", &plant.to_string());
        told(&["certify", "--no-alternatives"], &path)
    };
    for (name, value, said) in [
        ("actuator", "5".into(), "write `{ \"max\": \"5\" }`"),
        ("initial_set", "aligned".into(), "write `{ \"kind\": \"aligned\" }`"),
        ("sampling_period", "1/500".into(), "`sampling_period` stands in `internal_model`"),
        ("parameters", serde_json::json!({ "k": "3 +- 1" }), "\"low\": \"2\", \"high\": \"4\""),
        ("parameters", serde_json::json!({ "k": ["1", "2"] }), "\"low\": \"1\", \"high\": \"2\""),
        ("q", "1,5*sin(2*pi*t)".into(), "decimals have a point, as in 1.5"),
    ] {
        let (code, text) = changed(name, value);
        assert!(code == 2 && text.contains(said), "{name}: {text}");
    }
    let (code, text) = changed("parameters", serde_json::json!({ "k": "3 - 1" }));
    assert!(code == 0 && text.contains("'k' is used nowhere"), "{text}");
    let (code, text) = changed("q", "min(1, 2)*sin(2*pi*t)".into());
    assert!(code == 0, "{text}");
}

#[test]
fn what_is_no_certificate_is_told_what_one_is() {
    const WRITES: &str = "is no certificate: `sigmastar certify FILE -o CERTIFICATE` writes one";
    for content in ["{ \"format\": \"sigmastar/study\", \"version\": 1 }", "{}", "hello"] {
        let (_folder, path) = file("file.json", content);
        let (code, text) = told(&["check"], &path);
        assert!(code == 2 && text.contains(WRITES), "{content}: {text}");
    }
    // One that is broken is one.
    let (_folder, path) = file("file.json", "{ \"format\": \"sigmastar/certificate\", \"version\": 1 }");
    let (code, text) = told(&["check"], &path);
    assert!(code == 2 && !text.contains(WRITES), "{text}");
}

#[test]
fn a_period_that_is_not_that_of_the_formulas_is_told_for_itself() {
    let with = |period: &str, frequency: &str| {
        let text = plant("sin(2*pi*t)", None).replace("\"period\":\"1\"", &format!("\"period\":\"{period}\""));
        text.replace("\"base_frequency\":\"2*pi\"", &format!("\"base_frequency\":\"{frequency}\""))
    };
    let told = |text: &str| {
        let (_folder, path) = file("plant.json", text);
        told(&["certify"], &path)
    };
    let (code, text) = told(&with("1/2", "2*pi"));
    assert!(code == 2 && text.contains("not periodic in t with the stated period"), "{text}");
    assert!(!text.contains("base_frequency") && !text.contains("matched"), "{text}");
    // Two periods are a period, and the base frequency is of one.
    let (code, text) = told(&with("2", "2*pi"));
    assert!(code == 2 && text.contains("state the period of this base frequency, 1,"), "{text}");
}

#[test]
fn what_is_used_nowhere_is_told_before_the_search() {
    let mut plant: Value = serde_json::from_str(&plant("k*sin(2*pi*t)", None)).unwrap();
    plant["parameters"] = serde_json::json!({ "k": "1", "c": "2" });
    let (_folder, path) = file("plant.json", &plant.to_string());
    let output = program().args(["certify", "--progress", "--no-alternatives"]).arg(&path).output().unwrap();
    let text = utf8(output.stderr);
    let [remark, stage] = ["the parameter 'c' is used nowhere", "stage 1 of"].map(|part| text.find(part).unwrap());
    assert!(remark < stage, "{text}");
    plant["q"] = "k*sin(2*pi*t)/c".into();
    let (_folder, path) = file("plant.json", &plant.to_string());
    let (_, text) = told(&["certify", "--no-alternatives"], &path);
    assert!(!text.contains("used nowhere"), "{text}");
}

#[test]
fn a_start_of_simulations_far_outside_of_the_set_is_told() {
    let mut plant: Value = serde_json::from_str(&plant("x/10 + sin(2*pi*t)", Some("x"))).unwrap();
    plant["initial_set"] = serde_json::json!({ "kind": "at-rest", "ball": "1", "E0": "1" });
    for (initial, far) in [("-20", true), ("1/2", false)] {
        plant["initial"]["x"][0] = initial.into();
        let (folder, path) = file("plant.json", &plant.to_string());
        let certificate = folder.path().join("certificate.json");
        let output =
            program().args(["certify", "--no-alternatives", "-o"]).args([&certificate, &path]).output().unwrap();
        let said = "far outside of the certified set |y| <= ";
        let text = utf8(output.stderr);
        assert!(output.status.success() && text.contains(said) == far, "{initial}: {text}");
        let (code, text) = told(&["simulate", "--n-o", "1", "--periods", "1"], &certificate);
        assert!(code == 0 && text.contains(said) == far, "{initial}: {text}");
    }
}

#[test]
fn what_is_wrong_with_a_case_is_told_where_it_was_written() {
    let folder = tempfile::tempdir().unwrap();
    // A table that is there is not overwritten.
    let table = |name: &str| folder.path().join(name).to_str().expect("a path in UTF-8").to_owned();
    let write = |name: &str, content: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, content).unwrap();
        path
    };
    let subject = write("subject.json", &plant("sin(2*pi*t)", Some("x")));
    let study = |values: &str, embedded: Option<&str>| {
        let subject = embedded.map_or_else(|| "\"subject.json\"".to_owned(), str::to_owned);
        write(
            "study.json",
            &format!(
                "{{ \"format\": \"sigmastar/study\", \"version\": 1, \"name\": \"s\", \"design\": \"grid\", \"subject\": {subject},\n\
                 \"parameters\": [ {{ \"pointer\": \"/internal_model/mu\", \"name\": \"mu\",\n \"values\": {values} }} ] }}"
            ),
        )
    };
    let (_, text) = told(&["sweep", "-o", &table("0.csv")], &study("[1, \"-1\", \"two\"]", None));
    assert!(text.contains("study.json:3:16") && text.contains("study.json:3:22"), "{text}");
    assert!(text.contains("in case 1 (mu = -1); `sweep --case 1` writes that document"), "{text}");
    let (_, text) = told(&["sweep", "-o", &table("1.csv")], &study("[1, 2]", None));
    assert!(!text.contains("error"), "{text}");
    // What stands in the subject is wrong in every case, and told once.
    let wrong = std::fs::read_to_string(&subject).unwrap().replace("sin(2*pi*t)", "sin(2*pi*t");
    write("subject.json", &wrong);
    let (_, text) = told(&["sweep", "-o", &table("2.csv")], &study("[1, 2]", None));
    assert!(text.contains("subject.json:") && text.contains("in case 0 (mu = 1) and in one more"), "{text}");
    assert_eq!(text.matches("error[").count(), 1, "{text}");
    let (_, text) = told(&["sweep", "-o", &table("3.csv")], &study("[1, 2]", Some(&wrong)));
    assert!(text.contains("study.json:") && text.contains("at /subject/q"), "{text}");
}

#[test]
fn a_constant_that_divides_is_zero() {
    let text = |zero: &str| {
        let mut plant: Value = serde_json::from_str(&plant("-e/J + sin(2*pi*t)", None)).unwrap();
        plant["parameters"] = serde_json::json!({ "J": zero });
        plant.to_string()
    };
    let (_folder, path) = file("plant.json", &text("2 - 2"));
    let (code, said) = told(&["certify"], &path);
    assert!(
        code == 2 && said.contains("`-e/J`: the divisor is 0") && said.contains("a parameter that divides"),
        "{said}"
    );
    let (_folder, path) = file("plant.json", &text("2 - 1"));
    assert_eq!(told(&["certify", "--no-alternatives"], &path).0, 0);
    // One that is 0 at some states alone is told of those.
    let (_folder, path) = file("plant.json", &plant("-e/(1 - e) + sin(2*pi*t)", None));
    let (_, said) = told(&["certify"], &path);
    assert!(!said.contains("the divisor is 0"), "{said}");
}

#[test]
fn an_operation_by_entries() {
    let (_folder, path) = file("plant.json", &plant("-e + sin(2*pi.*t)", None));
    let (code, said) = told(&["certify"], &path);
    assert!(code == 2 && said.contains("write *, / and ^ for .*, ./ and .^"), "{said}");
    let (_folder, path) = file("plant.json", &plant("-e + sin(2*pi . t)", None));
    let (code, said) = told(&["certify"], &path);
    assert!(code == 2 && !said.contains("for .*"), "{said}");
    let (_folder, path) = file("plant.json", &plant("-e + sin(2.*pi*t)", None));
    assert_eq!(told(&["certify", "--no-alternatives"], &path).0, 0);
}

#[test]
fn a_certificate_is_no_page() {
    let (folder, path) = file("plant.json", &plant("-e + sin(2*pi*t)", None));
    let certify = |name: &str| {
        let target = folder.path().join(name);
        let target = target.to_str().unwrap();
        (told(&["certify", "--no-alternatives", "-o", target], &path), std::path::Path::new(target).exists())
    };
    let ((code, said), written) = certify("report.html");
    assert!(code == 2 && !written && said.contains("--format html > report.html"), "{said}");
    let ((code, said), written) = certify("html.json");
    assert!(code == 0 && written, "{said}");
}
