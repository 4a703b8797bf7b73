//! `sigmastar transfer`: exit codes, streams, the JSON fields, the picture.

use crate::support::{self, EXAMPLE, EXAMPLE_TEXT, number, program, utf8};
use assert_cmd::Command;
use predicates::prelude::*;
use predicates::str::{contains, is_empty};
use serde_json::Value;
use tempfile::TempDir;

fn transfer(args: &[&str]) -> Command {
    let mut command = program();
    command.arg("transfer").args(args);
    command
}

fn json(args: &[&str]) -> Value {
    let output = transfer(args).args(["--format", "json"]).assert().code(0).stderr(is_empty());
    support::json(&output.get_output().stdout)
}

#[test]
fn the_pair_and_the_rows_are_in_the_json() {
    // k0 = T_N(0) = 1/(nu^2 n_0) = 2 pi^2, rounded up.
    let report = json(&[EXAMPLE, "--k0", "2*pi^2", "--n-o", "0,1,7..8,1000000000,inf"]);
    // No file that a checker could read comes of it.
    assert_eq!((&report["verdict"], &report["independent_check"]), (&"certified".into(), &"none".into()));
    let (k0, k1) = (number(&report["k0"]), number(&report["k1"]));
    assert!((19.7392..19.7393).contains(&k0) && (74.40..75.0).contains(&k1), "{k0} {k1}");
    for field in ["m0", "N0", "boxes"] {
        assert!(report[field].as_u64().expect("a number") >= 1, "{field}");
    }
    let rows = report["per_n_o"].as_array().expect("rows");
    let counts: Vec<&Value> = rows.iter().map(|row| &row["n_o"]).collect();
    assert_eq!(
        counts,
        [&0.into(), &1.into(), &7.into(), &8.into(), &1_000_000_000_u64.into(), &Value::from("infinity")]
    );
    for row in rows {
        let [low, high] = [0, 1].map(|end| number(&row["ratio"][end]));
        assert!(0.9 < low && low <= high && high <= 1.0, "{row}");
        assert!(high - low < 1e-3, "{row}");
        assert!(row["x"].is_string());
    }
    // T_N(0) itself is reached at x = 0 by every N.
    assert_eq!(rows[0]["x"], "0");
    assert!(number(&rows[0]["ratio"][0]) > 0.999_999_999);
    assert!(number(&report["obstacle"]["least_k1"][0]) > 0.99 * k1);
    assert_eq!(report["printed"]["checks"][0]["holds"], "refuted");
    assert_eq!(report["matched"]["K"], 2);
}

#[test]
fn the_statement_does_not_depend_on_the_number_of_threads() {
    let args = [EXAMPLE, "--n-o", "0..12", "--format", "json"];
    let one = transfer(&args).env("RAYON_NUM_THREADS", "1").output().expect("it runs").stdout;
    let many = transfer(&args).env("RAYON_NUM_THREADS", "5").output().expect("it runs").stdout;
    assert!(!one.is_empty() && one == many);
}

#[test]
fn nothing_in_the_report_is_called_certified() {
    let output = transfer(&[EXAMPLE, "--n-o", "0..2"]).assert().code(0).get_output().stdout.clone();
    let text = utf8(output);
    assert!(text.contains("No independent program checks this report") && !text.contains("certified"), "{text}");
}

#[test]
fn weights_choose_the_pair() {
    let dear = json(&[EXAMPLE, "--minimise", "1000,1", "--n-o", "0"]);
    let cheap = json(&[EXAMPLE, "--minimise", "1,1000", "--n-o", "0"]);
    let [(dear_0, dear_1), (cheap_0, cheap_1)] = [dear, cheap].map(|r| (number(&r["k0"]), number(&r["k1"])));
    assert!(dear_0 < cheap_0 && dear_1 > cheap_1);
    assert!(1000.0 * dear_0 + dear_1 < 1000.0 * cheap_0 + cheap_1);
    assert!(dear_0 + 1000.0 * dear_1 > cheap_0 + 1000.0 * cheap_1);
}

#[test]
fn too_small_a_k0_is_refuted_with_the_figure() {
    transfer(&[EXAMPLE, "--k0", "19.739"]).assert().code(1).stdout(is_empty()).stderr(contains("19.7392"));
    let output = transfer(&[EXAMPLE, "--k0", "1", "--format", "json"]).assert().code(1);
    let value = support::json(&output.get_output().stdout);
    assert_eq!(value["verdict"], "refuted");
    assert!(value["reason"].as_str().expect("text").contains("19.7392"));
}

/// A k0 that is admissible and larger than any rational that is made: nothing was found, and nothing is refuted.
#[test]
fn a_k0_beyond_range_is_undecided() {
    let refused = transfer(&[EXAMPLE, "--n-o", "0", "--k0", "exp(1e6)"]).assert().code(3).stdout(is_empty());
    refused.stderr(contains("leaves the range of doubles").and(contains("undecided")));
}

#[test]
fn wrong_calls_are_bad_input() {
    for args in [
        &[EXAMPLE, "--k0", "0"][..],
        &[EXAMPLE, "--k0", "-3"],
        &[EXAMPLE, "--k0", "x"],
        &[EXAMPLE, "--minimise", "1"],
        &[EXAMPLE, "--minimise", "1,0"],
        &[EXAMPLE, "--minimise", "1,2,3"],
        &[EXAMPLE, "--k0", "7", "--minimise", "1,2"],
        &[EXAMPLE, "--n-o", "3..1"],
        &[EXAMPLE, "--n-o", "-1"],
        &[EXAMPLE, "--n-o", "0..99999999"],
        &[EXAMPLE, "--plot", "-"],
        &[EXAMPLE, "--plot", "bound.png"],
        &[EXAMPLE, "--plot", "bound"],
        &["specs/missing.json"],
        &["specs/invalid/unknown-field.json"],
    ] {
        transfer(args).assert().code(2).stdout(is_empty()).stderr(is_empty().not());
    }
}

#[test]
fn the_picture_is_written_whole() {
    let folder = TempDir::new().expect("a folder");
    let file = folder.path().join("bound.svg");
    let name = file.to_str().expect("UTF-8");
    transfer(&[EXAMPLE, "--n-o", "0,1,inf", "--plot", name]).assert().code(0).stderr(contains("the plot is in"));
    let svg = std::fs::read_to_string(&file).expect("it was written");
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
    for label in ["N = 0", "N = 1", "N = infinity", "k0 + k1 x^2, every N", "x = omega / base frequency", "T_N(x)"] {
        assert!(svg.contains(label), "{label}");
    }
    // A curve and its line in the legend; those after the first are dashed, and so in pieces. The style names each colour once more.
    let pieces = |colour: &str| svg.matches(&format!(" stroke=\"{colour}\"")).count();
    assert_eq!(pieces("#0072B2"), 2);
    assert!(pieces("#D55E00") > 20 && pieces("#009E73") > 20, "{} {}", pieces("#D55E00"), pieces("#009E73"));
}

#[test]
fn an_unmatched_specification_has_no_matched_pair() {
    let text = EXAMPLE_TEXT.replace("\"matched\": true", "\"matched\": false").replace("\"2*pi\"", "\"6\"");
    let output = transfer(&["-", "--n-o", "3", "--format", "json"]).write_stdin(text).assert().code(0);
    let report = support::json(&output.get_output().stdout);
    assert!(report["matched"].is_null());
    assert_eq!(report["nu"][0].as_str().map(|text| &text[..6]), Some("0.1666"));
}
