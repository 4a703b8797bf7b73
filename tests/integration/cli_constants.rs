//! `sigmastar constants`: the table of the paper's constants is one table, and is worked out where it is shown.

use crate::support::{EXAMPLE, EXAMPLE_TEXT, answer, json, program, utf8};
use predicates::str::contains;
use serde_json::{Value, json};
use sigmastar_document::{Block, Extent};
use sigmastar_lang::spec::Document;
use sigmastar_prove::certify::{Limits, Options};
use sigmastar_prove::reduction::{Prepared, Subject, Unwatched};
use sigmastar_report::{Origin, run_report};

const TABLE: &str = "Constants in the three derivations";

fn output(arguments: &[&str]) -> String {
    let output = answer(arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", utf8(output.stderr));
    utf8(output.stdout)
}

fn report(arguments: &[&str]) -> Value {
    json(output(&[arguments, &["--format", "json"]].concat()).as_bytes())
}

/// The command, the whole report and its JSON have the same table.
#[test]
fn there_is_one_table() {
    let (own, whole) = (report(&["constants", EXAMPLE]), report(&["certify", EXAMPLE]));
    for part in ["matrix_inequalities", "derivations", "constants", "printed"] {
        assert!(own[part].as_object().is_some_and(|fields| !fields.is_empty()), "{part}");
        assert_eq!(own[part], whole[part], "{part}");
    }
    assert_eq!(own["verdict"], "certified");
    assert_eq!(report(&["errata", EXAMPLE])["constants"], own);
    let folder = tempfile::tempdir().unwrap();
    program().args(["reproduce", "-q", "--only", "constants", "-o"]).arg(folder.path()).assert().code(0);
    let reproduced = json(&std::fs::read(folder.path().join("report.json")).unwrap());
    assert_eq!(reproduced["constants"], own);
    let row = &own["constants"]["kappa_1"];
    assert!(["printed", "repaired", "sharp"].iter().all(|column| row[column]["value"].is_array()), "{row}");
    let text = output(&["constants", EXAMPLE]);
    assert!(text.starts_with("Example of the paper: the paper's constants\n"), "{text}");
    let (_, table) = text.split_once("Matrix inequalities").expect("a table");
    assert!(table.contains("Sylvester's criterion") && table.contains(TABLE) && table.contains("rho_11"), "{table}");
    assert!(output(&["certify", EXAMPLE, "--full"]).contains(table.trim_end()), "{table}");
    assert!(!output(&["certify", EXAMPLE]).contains(TABLE));
}

/// The repaired gain is above the claimed one in the table, which is why it is beside it.
#[test]
fn the_repaired_gain_is_in_the_table() {
    let found = report(&["constants", "specs/no-x.json"]);
    assert_eq!(found["derivations"]["repaired"]["outcome"], "proved");
    let gain =
        |derivation: &str| -> f64 { found["derivations"][derivation]["sigma"].as_str().unwrap().parse().unwrap() };
    assert!(gain("sharp") < gain("repaired"), "{found}");
}

/// Lemma 1 of the paper: with no oscillator A = -mu n_0, so that p is at least 1/(2 mu n_0), and what is proved is at most about twice that;
/// the rates fall with n_o, and stay below what the spectral abscissa allows.
#[test]
fn lemma_1_is_shown_for_a_few_numbers_of_oscillators() {
    let found = report(&["constants", EXAMPLE]);
    let rows = found["lemma_1"].as_array().unwrap();
    let number = |value: &Value| -> f64 { value.as_str().unwrap().parse().unwrap() };
    assert_eq!(rows[0]["n_o"], 0);
    let n_0 = 2.0;
    assert!((1.0..2.001).contains(&(number(&rows[0]["p"]) * 2.0 * n_0)), "{found:#}");
    let rates: Vec<f64> = rows.iter().map(|row| number(&row["rate"])).collect();
    assert!(rates.len() > 3 && rates.windows(2).all(|pair| pair[1] < pair[0]), "{rates:?}");
    for row in rows {
        assert!(number(&row["rate"]) * number(&row["p"]) * 2.0 <= 1.0, "{row}");
        assert!(number(&row["rate"]) < -0.99 * number(&row["spectral_abscissa_estimate"]), "{row}");
    }
    let text = output(&["constants", EXAMPLE]);
    assert!(text.contains("Lemma 1 of the paper") && text.contains("P_zeta"), "{text}");
}

/// For the short form of a report the table is not worked out.
#[test]
fn a_short_report_has_no_table() {
    let subject = Subject::read(&Document::parse("spec", EXAMPLE_TEXT).unwrap()).unwrap();
    let asked = (&Limits::default(), &[][..]);
    let run = Prepared::seeking(&subject, None, asked, Options::default(), &Unwatched).unwrap();
    let run = run.certify(Options::default()).unwrap();
    let has_table = |extent| {
        let blocks = run_report(&run, &[], Origin::Search, extent).blocks();
        blocks.iter().any(|block| matches!(block, Block::Aside(title) if title == TABLE))
    };
    assert!(!has_table(Extent::Short) && has_table(Extent::Full));
}

/// A plant has no bounding functions: it is told how to get some, and its report has no such table.
#[test]
fn a_plant_is_told_what_to_do() {
    let plant = "specs/plants/linear.json";
    program()
        .args(["constants", plant])
        .assert()
        .code(2)
        .stderr(contains("the paper's constants are about bounding functions, and this is a plant"))
        .stderr(contains("`sigmastar bound FILE -o SPEC`"));
    let whole = report(&["certify", plant]);
    assert_eq!([&whole["constants"], &whole["matrix_inequalities"]["R"]], [&json!({}), &Value::Null]);
    assert_eq!(whole["derivations"]["repaired"]["outcome"], "skipped");
    assert!(!output(&["certify", plant, "--full"]).contains("Constants"));
}

/// What the paper's formulas know nothing of is refused by name.
#[test]
fn what_the_paper_does_not_know_is_refused() {
    let mut spec: Value = serde_json::from_str(EXAMPLE_TEXT).unwrap();
    spec["input_gain"] = json!({ "nominal": "1", "low": "9/10", "high": "11/10" });
    let refused = program().args(["constants", "-"]).write_stdin(spec.to_string()).assert().code(2);
    refused.stderr(contains("the paper's constants know nothing of `input_gain`"));
    spec["input_gain"] = json!({ "nominal": "1", "low": "1", "high": "1" });
    program().args(["constants", "-"]).write_stdin(spec.to_string()).assert().code(0);
}
