//! Real machines: every file of `specs/machines` is certified as `docs/machines.md` says, its certificates are decided by the
//! checker, its C code compiles, and its figure is what the program draws.

use crate::controller::installed;
use crate::controller_c::gcc;
use crate::gallery::{compare_response, is_rounded, page, table, wrong_cells_are_found};
use crate::support::{ROOT, assert_valid, every, json, number, program, utf8};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// What calls an exported law.
const MAIN: &str = r#"#include "law.h"
int main(void)
{
    sigmastar_controller controller;

    sigmastar_reset(&controller, 0.0);
    return sigmastar_step(&controller, 0.0) == 0.0 ? 0 : 1;
}
"#;

fn machines() -> BTreeMap<String, Vec<String>> {
    table(
        &page("machines.md"),
        "| machine | states | sigma* | sigma | ball | e | n_o = 0 | n_o = 3 | largest e | largest u | h |",
    )
}

/// The certificate of a machine with further flags, written into a folder, and its report.
fn certified(folder: &Path, name: &str, flags: &[&str]) -> (PathBuf, Value) {
    let (file, machine) = (folder.join("certificate.json"), format!("specs/machines/{name}.toml"));
    let call = ["certify", &machine, "--quiet", "--force", "--format", "json"];
    let output = program().args(call).args(flags).arg("-o").arg(&file).output().unwrap();
    let report = json(&output.stdout);
    assert_eq!(report["verdict"], "certified", "{name} {flags:?}: {report:#}");
    (file, report)
}

/// The bounds with a number of oscillators.
fn of_count(report: &Value, n_o: u64) -> &Value {
    let rows = report["by_n_o"].as_array().expect("bounds by the number of oscillators");
    let row = rows.iter().rev().find(|row| row["n_o"].as_u64().is_some_and(|own| own <= n_o));
    row.filter(|row| row["or_more"] == true || row["n_o"] == n_o).unwrap_or(&Value::Null)
}

fn largest_control(row: &Value) -> Value {
    let control = &row["control"];
    format!("{:.12e}", number(&control["steady"]) + number(&control["transient"])).into()
}

/// What is wrong in the row of a machine beside the report at its gain.
fn wrong(cells: &[String], states: usize, report: &Value) -> Vec<&'static str> {
    [
        ("states", cells[1] == states.to_string()),
        ("sigma", report["sigma_star"] == *cells[3]),
        ("ball", is_rounded(&cells[4], &report["plant"]["ball"], false)),
        ("e", is_rounded(&cells[5], &report["initial_set"]["E0"], false)),
        ("n_o = 0", is_rounded(&cells[6], &of_count(report, 0)["steady_error"], true)),
        ("n_o = 3", is_rounded(&cells[7], &of_count(report, 3)["steady_error"], true)),
        ("largest e", is_rounded(&cells[8], &of_count(report, 3)["peak_error"], true)),
        ("largest u", is_rounded(&cells[9], &largest_control(of_count(report, 3)), true)),
    ]
    .into_iter()
    .filter_map(|(column, right)| (!right).then_some(column))
    .collect()
}

#[test]
fn every_machine_has_a_row_and_a_section() {
    let folder = std::fs::read_dir(Path::new(ROOT).join("specs/machines")).unwrap();
    let there: BTreeSet<String> =
        folder.map(|entry| entry.unwrap().path().file_stem().unwrap().to_str().unwrap().to_owned()).collect();
    let rows = machines();
    assert!(rows.keys().eq(&there), "{there:?}");
    let text = page("machines.md");
    for name in rows.keys() {
        assert!(text.contains(&format!("(figures/{name}.svg)")), "docs/machines.md does not show {name}");
    }
}

/// What the page says of a machine: its row, its certificates in continuous time and at samples, and the C code of the latter.
fn assert_as_documented(name: &str, cells: &[String]) {
    let folder = TempDir::new().unwrap();
    let gain = ["--sigma", &cells[3]];
    let (certificate, report) = certified(folder.path(), name, &gain);
    let columns = wrong(cells, states(name), &report);
    assert!(columns.is_empty(), "docs/machines.md, {name}: {columns:?} in\n{cells:?}\n{report:#}");
    assert_valid(&certificate);
    let output = program().args(["falsify", "-q", "--trials", "2"]).arg(&certificate).output().unwrap();
    assert!(output.status.success(), "{name}: {}", utf8(output.stderr));
    let (certificate, _) = certified(folder.path(), name, &[gain[0], gain[1], "--sampling-period", &cells[10]]);
    assert_valid(&certificate);
    compiles(folder.path(), &certificate);
}

#[test]
fn a_machine_is_certified_checked_and_exported() {
    assert_as_documented("hard-disk", &machines()["hard-disk"]);
}

/// In a night the smallest gains that are found, too.
#[test]
#[ignore = "search tier"]
fn the_machines_are_certified_checked_and_exported() {
    for (name, cells) in machines() {
        if every(2) == 1 {
            let (_, report) = certified(TempDir::new().unwrap().path(), &name, &[]);
            assert_eq!(report["sigma_star"], *cells[2], "{name}");
        }
        assert_as_documented(&name, &cells);
    }
}

fn states(name: &str) -> usize {
    let output = program().args(["convert", &format!("specs/machines/{name}.toml")]).output().unwrap();
    json(&output.stdout)["states"].as_array().map_or(0, Vec::len)
}

/// The law of a certificate as C, with ten oscillators.
fn compiles(folder: &Path, certificate: &Path) {
    let (law, main, run) = (folder.join("law.c"), folder.join("main.c"), folder.join("law"));
    let call = ["--n-o", "10", "--format", "c", "--force", "-o"];
    let output = program().arg("controller").arg(certificate).args(call).arg(&law).output().unwrap();
    assert!(output.status.success(), "{}", utf8(output.stderr));
    std::fs::write(&main, MAIN).unwrap();
    if installed("gcc", &["--version"]) {
        gcc(&[&law, &main], &run);
        assert!(std::process::Command::new(&run).status().unwrap().success());
    }
}

/// The figures of the page. `SIGMASTAR_FIGURES=write` draws them again.
#[test]
fn the_figures_of_the_machines_are_what_the_program_draws() {
    for (name, cells) in machines() {
        compare_response(&name, &format!("specs/machines/{name}.toml"), &cells[3]);
    }
}

#[test]
fn figures_that_are_not_the_programs_are_found() {
    let report = serde_json::json!({
        "sigma_star": "3000", "plant": { "ball": "0.05" }, "initial_set": { "E0": "20" },
        "by_n_o": [
            { "n_o": 0, "or_more": false, "steady_error": "1.31586" },
            {
                "n_o": 2, "or_more": true, "steady_error": "0.030052", "peak_error": "20.811",
                "control": { "steady": "0.1", "transient": "0.051432" },
            },
        ],
    });
    let right = ["`a`", "1", "656.774", "3000", "0.05", "20", "1.316", "0.03006", "20.82", "0.1515", "1/20000"];
    let right = right.map(str::to_owned);
    let cases = [
        (1, "2", "states"),
        (3, "3001", "sigma"),
        (4, "0.051", "ball"),
        (5, "21", "e"),
        (6, "1.315", "n_o = 0"),
        (7, "0.03005", "n_o = 3"),
        (8, "20.81", "largest e"),
        (9, "0.1514", "largest u"),
    ];
    wrong_cells_are_found(&right, |cells| wrong(cells, 1, &report), &cases);
}

/// The script of the comparison has the data of the machine; where python-control is installed it prints what the page shows.
#[test]
fn the_comparison_is_about_the_magnetic_bearing() {
    let text = page("comparison.md");
    let script = std::fs::read_to_string(Path::new(ROOT).join("examples/comparison.py")).unwrap();
    let row = &machines()["magnetic-bearing"];
    assert!(script.contains(&format!("(1, 10, 100, {}, {})", row[2], row[3])), "examples/comparison.py");
    for figure in [&row[2], &row[3]] {
        assert!(text.contains(&format!("\n{figure:<8}  ")), "docs/comparison.md: {figure}");
    }
    let machine = std::fs::read_to_string(Path::new(ROOT).join("specs/machines/magnetic-bearing.toml")).unwrap();
    let data = ["lambda = 500 ", "m = 1.637 ", "s_0 = 0.78 ", "low = 172000, high = 210000", "mu = 500", "x = \"1/5\""];
    assert!(data.iter().all(|datum| machine.contains(datum)), "{machine}");
    assert!(script.contains("= 500.0, 1.637, 0.78, 0.2, 500.0, 200 * np.pi"), "{script}");
    if installed("python3", &["-c", "import control"]) {
        let output =
            std::process::Command::new("python3").arg("examples/comparison.py").current_dir(ROOT).output().unwrap();
        assert!(text.contains(&utf8(output.stdout)), "{}", utf8(output.stderr));
    }
}
