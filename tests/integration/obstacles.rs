//! What keeps something from being certified is told with its true cause, and what helps for that; and plants whose base
//! frequency is not that of their period are certified.

use crate::support::{self, checked, every, program, read, stored};
use serde_json::Value;
use std::path::Path;

/// A plant of `specs/plants` with other fields.
fn plant(name: &str, changes: &[(&str, &str)]) -> String {
    changed(&format!("plants/{name}"), changes)
}

/// A document of `specs` with other fields.
fn changed(name: &str, changes: &[(&str, &str)]) -> String {
    let mut document = support::document(name);
    for (pointer, value) in changes {
        let field = document.pointer_mut(pointer).unwrap_or_else(|| panic!("{pointer}"));
        *field = serde_json::from_str(value).unwrap_or_else(|_| Value::String((*value).to_owned()));
    }
    document.to_string()
}

/// The exit code of `certify`, and what it tells.
fn certify(text: &str, more: &[&str]) -> (i32, String) {
    support::told(program().args(["certify", "-", "--full"]).args(more).write_stdin(text.to_owned()))
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
    for (at, frequency) in ["pi", "101*pi/100", "sqrt(2)*pi"].into_iter().enumerate().step_by(every(3)) {
        let changes = [("/internal_model/matched", "false"), ("/internal_model/base_frequency", frequency)];
        let file = certificate(folder.path(), &format!("duffing-{at}"), &plant("duffing", &changes));
        assert_eq!(checked(Path::new(&file))["verdict"], "valid", "{frequency}");
    }
}

/// A gain below the smallest one is told as that, with about the smallest one and what sets it; one above it is certified.
#[test]
fn a_gain_that_is_too_small_is_told_with_the_smallest() {
    for (text, small, large, smallest) in [
        (plant("motor-axis", &[]), "10", "30", "15."),
        (
            std::fs::read_to_string(format!("{}/specs/linear.json", crate::support::ROOT)).unwrap(),
            "1/100",
            "100",
            "about ",
        ),
    ] {
        let (code, told) = certify(&text, &["--sigma", small]);
        assert_eq!(code, 3, "{told}");
        assert!(told.contains("is below the smallest one found, about"), "{told}");
        assert!(
            told.contains(smallest) && told.contains("which is limited by") && told.contains("a larger gain"),
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
    let mut forged = read(&own);
    forged["witness"]["orbit"]["radius"] = "1/10000000000000000000000000000000000".into();
    let file = stored(folder.path(), "forged.json", &forged);
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

const BOX: &str = "/initial_set";

/// A specification, changes under which a cause is told with these words, and the changes that nearly do.
type Case =
    (&'static str, &'static [(&'static str, &'static str)], &'static str, &'static [(&'static str, &'static str)]);

/// Each cause of a search that finds nothing is told where it is the cause, and not where the data nearly have it. Without words
/// the near case is certified.
#[test]
fn each_cause_is_told_where_it_is_one() {
    const WIDE: &str = r#"{ "kind": "box", "X0": "3", "E0": "1", "Z0": "0" }"#;
    const WIDER: &str = r#"{ "kind": "box", "X0": "5", "E0": "1", "Z0": "0" }"#;
    const OF_X: &str = r#"{ "kind": "box", "X0": "3", "E0": "0", "Z0": "0" }"#;
    const HIGH: &str = r#"{ "kind": "box", "X0": "1", "E0": "3", "Z0": "0" }"#;
    const UNIT: &str = r#"{ "kind": "box", "X0": "1", "E0": "1", "Z0": "0" }"#;
    const TENFOLD: &str = r#"{ "kind": "box", "X0": "1", "E0": "10", "Z0": "0" }"#;
    // On every path dq/de is taken up to E_b.
    const STEEP: (&str, &str) = ("/bounds/q_e", "exp(exp(E))");
    const GROWING: [(&str, &str); 3] =
        [("/bounds/f", "2*X + exp(E) - 1"), ("/bounds/f_e", "exp(E)"), ("/bounds/f_ex", "exp(E)")];
    let cases: [Case; 8] = [
        ("paper-example", &[(BOX, WIDE), ("/domain/X", "29/10")], "domain X:", &[(BOX, WIDE)]),
        ("paper-example", &[(BOX, HIGH), ("/domain/E", "23/10")], "domain E:", &[(BOX, HIGH)]),
        ("paper-example", &[(BOX, WIDER)], "C5: a_2 <= 0", &[(BOX, WIDE)]),
        (
            "paper-example",
            &[(BOX, OF_X), ("/bounds/q_x", "1e9")],
            "k_x^2 >= 4 w_x a_2",
            &[(BOX, OF_X), ("/bounds/q_x", "1e6")],
        ),
        ("linear", &[(BOX, TENFOLD), STEEP], "q_e has no finite value", &[(BOX, UNIT), STEEP]),
        (
            "linear",
            &[GROWING[0], GROWING[1], GROWING[2], ("/bounds/f_xx", "1e50")],
            "existence: no set",
            &[GROWING[0], GROWING[1], GROWING[2], ("/bounds/f_xx", "1e5")],
        ),
        ("linear", &[("/lyapunov/alpha", "1e-320")], "alpha = ", &[("/lyapunov/alpha", "1e-9")]),
        ("linear", &[("/bounds/q", "1e400 + X")], "the bounding function q at X = E = 0", &[("/bounds/q", "1e9 + X")]),
    ];
    for (name, failing, words, near) in cases {
        let (code, told) = certify(&changed(name, failing), &[]);
        assert!(code == 3 && told.contains(words), "{words}: {told}");
        assert!(told.contains("What to try"), "{told}");
        let (code, told) = certify(&changed(name, near), &[]);
        assert_eq!(code, 0, "nearly {words}: {told}");
    }
}

/// The same of the law at samples.
#[test]
fn each_cause_at_samples_is_told_where_it_is_one() {
    let overshoots = "h sigma exceeds 1";
    let every = "h sigma > 1 for every gain that may be proved by norms";
    let decay = "the decay from sample to sample is not positive";
    let large = [("/internal_model/mu", "15")];
    let changes: [&[(&str, &str)]; 2] = [&[], &large];
    for (name, changes, options, told, exit) in [
        ("linear", changes[0], &["1/7", "--sigma", "71/10"][..], Some(overshoots), 3),
        ("linear", changes[0], &["1/7", "--sigma", "6"], None, 0),
        ("paper-example", changes[0], &["1/7"], Some(every), 3),
        ("paper-example", changes[0], &["1/1000"], None, 0),
        ("linear", changes[1], &["1/7"], Some(decay), 3),
        ("linear", changes[0], &["1/3"], Some(decay), 3),
        ("linear", changes[1], &["1/40"], None, 0),
        ("linear", changes[0], &["1/4"], None, 0),
    ] {
        let (code, words) = certify(&changed(name, changes), &[&["--sampling-period"], options].concat());
        assert_eq!(code, exit, "{name} {options:?}: {words}");
        for cause in [overshoots, every, decay] {
            assert_eq!(words.contains(cause), told == Some(cause), "{name} {options:?}: {words}");
        }
    }
}

/// What makes a large gain is named, where it was sought.
#[test]
fn a_large_gain_is_remarked() {
    let large = changed("linear", &[("/bounds/q_e", "30000")]);
    let (code, told) = certify(&large, &[]);
    assert!(
        code == 0 && told.contains("sigma* is above 10^4 divided by the period. It is limited by C5: dq/de"),
        "{told}"
    );
    for (text, options) in [(changed("linear", &[]), &[][..]), (large, &["--sigma", "40000"])] {
        let (code, told) = certify(&text, options);
        assert!(code == 0 && !told.contains("above 10^4"), "{told}");
    }
}
