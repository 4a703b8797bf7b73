//! Names of a document in sentences: apart from the letters that these have of their own, in the claim and in the report.

use crate::controller::controller;
use crate::support::{self, certified_in, every, files, json, program, read, stored, utf8};
use serde_json::{Value, json as object};
use sigmastar_lang::spec::Document;
use sigmastar_prove::certificate::claim_in_words;
use std::collections::BTreeSet;
use std::path::Path;

/// A family of one state, with a constant, a gain of the actuator that is an expression of the parameter, and a domain; a parameter, a
/// constant, a state and the file have these names.
fn plant([parameter, constant, state, name]: [&str; 4]) -> Value {
    let gain = |number: u32| format!("{}.{}/{parameter}", number / 10, number % 10);
    object!({
        "format": "sigmastar/plant", "version": 1, "name": name, "period": "10",
        "states": [state], "f": [format!("-{parameter}*{state} + e")],
        "q": format!("cos(phase)/10 + {constant}*e + {state}/10"),
        "parameters": { (parameter): { "nominal": "2", "low": "1.8", "high": "2.2" }, (constant): "1/5" },
        "input_gain": { "nominal": gain(20), "low": gain(19), "high": gain(21) },
        "domain": { "x": "50", "e": "50" },
        "initial_set": { "kind": "aligned", "E0": "1/10" },
        "internal_model": {
            "mu": "1", "base_frequency": "pi/5", "matched": true,
            "weights": { "family": "power", "n0": "2", "epsilon": "1/2" }
        }
    })
}

/// The whole report without its title, in words; a name in quotes is one, and the digest, which is that of the file, none.
fn words_of_the_report(folder: &Path, plant: &Value) -> Vec<String> {
    let file = stored(folder, "plant.json", plant);
    let output = program().args(["certify", "--full", "--format", "markdown", "-q"]).arg(file).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", utf8(output.stderr));
    let text = utf8(output.stdout);
    let (_, text) = text.split_once('\n').unwrap();
    words(text).into_iter().filter(|word| word.len() != 64).collect()
}

fn words(text: &str) -> Vec<String> {
    let of_word = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '\'';
    text.split(|c| !of_word(c)).filter(|word| !word.is_empty()).map(str::to_owned).collect()
}

const LETTERS: [&str; 24] = [
    "T", "L", "K", "M", "N", "P", "J", "H", "R", "x", "y", "z", "g", "v", "h", "mu", "sigma", "n_o", "x_0", "xb",
    "e_per", "f", "q", "Z",
];

/// Honest users call a parameter T, L or mu.
#[test]
fn no_name_of_a_plant_is_taken_for_a_letter_of_the_claim() {
    let folder = tempfile::tempdir().unwrap();
    let plain = plant(["p_1", "p_2", "p_3", "p_4"]);
    let (certificate, _) = certified_in(folder.path(), &plain, &["--no-alternatives"]);
    let statement = read(certificate)["claim"]["statement"].as_str().unwrap().to_owned();
    for part in ["every input gain in [1.9/'p_1', 2.1/'p_1'] (one", "with a constant 'p_1' of the file in [1.8, 2.2] ("]
    {
        assert!(statement.contains(part), "{statement}");
    }
    let report = words_of_the_report(folder.path(), &plain);
    let named = |name: &str| report.iter().any(|word| *word == format!("'{name}'"));
    assert!(named("p_1") && named("p_2") && named("p_3"));
    let bare = |word: &&String| ["p_1", "p_2", "p_3", "p_4"].contains(&word.as_str());
    assert_eq!(report.iter().filter(bare).collect::<Vec<_>>(), Vec::<&String>::new());
    // X and E are the arguments of bounding functions, and no constant of an `input_gain`.
    let taken = [
        "X", "E", "t", "phase", "e", "u", "pi", "sqrt", "exp", "log", "sin", "cos", "tan", "atan", "tanh", "abs",
        "min", "max",
    ];
    let is_name = |word: &str| {
        word.starts_with(|c: char| c.is_ascii_alphabetic()) && !word.contains('\'') && !taken.contains(&word)
    };
    let own: BTreeSet<&str> = report.iter().map(String::as_str).filter(|word| is_name(word)).collect();
    assert!(["T", "L", "M", "N", "x", "z", "sigma"].iter().all(|letter| own.contains(letter)), "{own:?}");
    let others = own.into_iter().filter(|word| !LETTERS.contains(word));
    let names: Vec<&str> = LETTERS.into_iter().chain(others.step_by(every(16))).collect();
    // Of an ordinary run each name is one of three once, of a night each of the three.
    for place in (0..names.len()).step_by(every(3)) {
        let [a, b, c] = [place, place + 1, place + 2].map(|place| names[place % names.len()]);
        let other = plant([a, b, c, a]);
        let (certificate, _) = certified_in(folder.path(), &other, &["--no-alternatives"]);
        let certificate = read(certificate);
        let put_in = |text: &str| {
            ["p_1", "p_2", "p_3"]
                .iter()
                .zip([a, b, c])
                .fold(text.to_owned(), |text, (from, to)| text.replace(&format!("'{from}'"), &format!("'{to}'")))
        };
        assert_eq!(certificate["claim"]["statement"].as_str().unwrap(), put_in(&statement), "{a}");
        let expected: Vec<String> = report.iter().map(|word| put_in(word)).collect();
        assert_eq!(words_of_the_report(folder.path(), &other), expected, "{a} {b} {c}");
    }
}

fn all_stored() -> Vec<Value> {
    let folders = ["certificates", "plants", "gain", "periods", "noise", "arithmetic", "actuator", "sampled", "rates"];
    let all = folders.iter().flat_map(|folder| files(&format!("proofs-check/tests/{folder}"))).map(read);
    let all: Vec<Value> = all.filter(|certificate| certificate["format"] == "sigmastar/certificate").collect();
    assert!(all.len() > 70, "{}", all.len());
    all
}

/// The sentence of either program is its own, and they say the same.
#[test]
fn the_words_of_both_programs_are_the_same() {
    for certificate in all_stored().into_iter().step_by(every(5)) {
        let text = certificate.to_string();
        let report = proofs_check::check(text.as_bytes());
        let own = claim_in_words(&Document::parse("certificate", &text).unwrap()).unwrap();
        assert_eq!(report.subject.expect("it is valid").statement, own);
    }
}

/// What a certificate says in words gets into no export: anybody may have written it.
#[test]
fn an_export_has_the_words_of_this_program() {
    let folder = tempfile::tempdir().unwrap();
    let (file, _) = certified_in(folder.path(), &support::document("linear"), &["--no-alternatives"]);
    let mut certificate = read(&file);
    let own = certificate["claim"]["statement"].clone();
    certificate["claim"]["statement"] = "Nothing saturates.".into();
    let forged = stored(folder.path(), "forged.json", &certificate);
    let output = controller(&[forged.to_str().unwrap(), "--n-o", "2"]).assert().success();
    let export = json(&output.get_output().stdout);
    assert_eq!(export["certificate"]["statement"], own);
    assert!(!export.to_string().contains("Nothing saturates"));
    // A number of it that is no rational number is told in its place.
    certificate["claim"]["initial_set"]["E0"] = "3/-2".into();
    let broken = stored(folder.path(), "broken.json", &certificate);
    let output = controller(&[broken.to_str().unwrap(), "--n-o", "2"]).output().unwrap();
    let told = utf8(output.stderr);
    assert!(output.status.code() == Some(2) && told.contains("`E0` is not written as a rational number"), "{told}");
}
