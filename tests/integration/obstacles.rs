//! What keeps something from being certified is told with its true cause, and what helps for that; and plants whose base
//! frequency is not that of their period are certified.

use crate::support::{json, program};
use serde_json::Value;
use std::path::Path;

/// A plant of `specs/plants` with other fields.
fn plant(name: &str, changes: &[(&str, &str)]) -> String {
    let text = std::fs::read_to_string(format!("{}/specs/plants/{name}.json", crate::support::ROOT)).unwrap();
    let mut plant: Value = serde_json::from_str(&text).unwrap();
    for (pointer, value) in changes {
        let field = plant.pointer_mut(pointer).unwrap_or_else(|| panic!("{pointer}"));
        *field = serde_json::from_str(value).unwrap_or_else(|_| Value::String((*value).to_owned()));
    }
    plant.to_string()
}

/// The exit code of `certify`, and what it tells.
fn certify(text: &str, more: &[&str]) -> (i32, String) {
    let output = program().args(["certify", "-", "--full"]).args(more).write_stdin(text.to_owned()).output().unwrap();
    let words = [output.stdout, output.stderr].map(|stream| String::from_utf8(stream).unwrap()).join("\n");
    (output.status.code().unwrap(), words.split_whitespace().collect::<Vec<_>>().join(" "))
}

fn certificate(folder: &Path, name: &str, text: &str) -> String {
    let file = folder.join(format!("{name}.certificate.json"));
    let file = file.to_str().unwrap().to_owned();
    assert_eq!(certify(text, &["-o", &file]).0, 0, "{name}");
    file
}

/// `matched` false with the frequency of the period, and frequencies that are off by one per cent and by sqrt(2).
#[test]
fn other_base_frequencies_are_certified_and_valid() {
    let folder = tempfile::tempdir().unwrap();
    for (at, frequency) in ["pi", "101*pi/100", "sqrt(2)*pi"].into_iter().enumerate() {
        let changes = [("/internal_model/matched", "false"), ("/internal_model/base_frequency", frequency)];
        let file = certificate(folder.path(), &format!("duffing-{at}"), &plant("duffing", &changes));
        let output = program().args(["check", "--format", "json", &file]).output().unwrap();
        assert_eq!(json(&output.stdout)["verdict"], "valid", "{frequency}");
    }
}

/// A gain below the smallest one is told as that, with about the smallest one and what sets it; one above it is certified.
#[test]
fn a_gain_that_is_too_small_is_told_with_the_smallest() {
    for (text, small, large, smallest) in [
        (plant("paper-example", &[]), "8", "9", "8.4"),
        (
            std::fs::read_to_string(format!("{}/specs/linear.json", crate::support::ROOT)).unwrap(),
            "1/100",
            "100",
            "about ",
        ),
    ] {
        let (code, told) = certify(&text, &["--sigma", small]);
        assert_eq!(code, 3, "{told}");
        assert!(told.contains("is below the smallest one that is found, about"), "{told}");
        assert!(
            told.contains(smallest) && told.contains("which is set by") && told.contains("a larger gain"),
            "{told}"
        );
        assert!(!told.contains("finite value") && !told.contains("not finite"), "{told}");
        assert_eq!(certify(&text, &["--sigma", large]).0, 0);
    }
}

/// The witness of another plant is told as that; a witness of the same plant that is forged is not.
#[test]
fn the_witness_of_another_plant_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let own = certificate(folder.path(), "paper-example", &plant("paper-example", &[]));
    let (code, told) = certify(&plant("linear", &[]), &["--witness", &own]);
    assert_eq!(code, 3, "{told}");
    assert!(told.contains("made for another plant") && told.contains("without --witness"), "{told}");
    assert!(!told.contains("ordinary size"), "{told}");
    let mut forged: Value = serde_json::from_str(&std::fs::read_to_string(&own).unwrap()).unwrap();
    forged["witness"]["orbit"]["radius"] = "1/10000000000000000000000000000000000".into();
    let file = folder.path().join("forged.json");
    std::fs::write(&file, forged.to_string()).unwrap();
    let (code, told) = certify(&plant("paper-example", &[]), &["--witness", file.to_str().unwrap()]);
    assert!(code == 3 && !told.contains("another plant"), "{told}");
}

/// Torricelli's law has no derivative at 0: the orbit is found from elsewhere, or `initial` is named.
#[test]
fn an_orbit_away_from_a_singularity_is_found() {
    let with = |f: &str| {
        let f = format!(r#"["{f}"]"#);
        let initial = r#"{ "x": ["0"], "e": "1" }"#;
        let formulas = [("/states", r#"["h"]"#), ("/f", &f), ("/q", "h/10 + sin(2*pi*t)"), ("/initial", initial)];
        plant("linear", &formulas)
    };
    let (code, told) = certify(&with("2 - sqrt(h) + sin(2*pi*t)/5"), &[]);
    assert_eq!(code, 0, "{told}");
    let (code, told) = certify(&with("-2 - sqrt(h)"), &[]);
    assert!(code == 3 && told.contains("`initial`") && told.contains("x = 0"), "{told}");
    // Without a singularity `initial` is not blamed.
    let (code, told) = certify(&with("2 + 0*h"), &[]);
    assert!(code == 3 && !told.contains("`initial`"), "{told}");
}
