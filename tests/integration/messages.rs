//! What a newcomer writes by mistake, and what is said to it; beside each the case that nearly is the mistake.

use crate::support::{program, utf8};
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
    let text = std::fs::read_to_string("specs/plants/linear.json").unwrap();
    let mut plant: Value = serde_json::from_str(&text).unwrap();
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
    assert!(code == 2 && text.contains("leave u out: it is added to q"), "{text}");
    // Another name is no control, and a state may have that one.
    let (_folder, path) = file("plant.json", &plant("e + v + sin(2*pi*t)", None));
    let (code, text) = told(&["certify"], &path);
    assert!(code == 2 && !text.contains("leave u out"), "{text}");
    let (_folder, path) = file("plant.json", &plant("u + sin(2*pi*t)", Some("u")));
    assert_eq!(told(&["certify", "--no-compare"], &path).0, 0);
}

#[test]
fn a_sign_has_a_smooth_function_in_its_place() {
    for (q, code, said) in [
        ("sign(e) + sin(2*pi*t)", 2, Some("write tanh(20*x) for sign(x)")),
        ("sinn(e) + sin(2*pi*t)", 2, Some("did you mean sin?")),
        ("tanh(20*e)/10 + sin(2*pi*t)", 0, None),
    ] {
        let (_folder, path) = file("plant.json", &plant(q, None));
        let (found, text) = told(&["certify", "--no-compare"], &path);
        assert!(found == code && said.is_none_or(|said| text.contains(said)), "{q}: {text}");
    }
}

#[test]
fn a_corner_is_told_straight() {
    let (_folder, path) = file("plant.json", &plant("abs(e) + sin(2*pi*t)", None));
    let (code, text) = told(&["certify"], &path);
    assert!(code == 3 && text.contains("the argument of abs vanishes at some state and error"), "{text}");
    assert!(text.contains("write sqrt(u^2 + 1/100) for abs(u)") && !text.contains("not true"), "{text}");
    let (_folder, path) = file("plant.json", &plant("abs(100 + e)/100 + sin(2*pi*t)", None));
    // What is not seen to vanish anywhere is not said to.
    let (_, text) = told(&["certify", "--no-compare"], &path);
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
            let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
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
