//! The gallery of plants: its tables say what the program certifies, its figures are what the program draws.

use crate::support::{ROOT, guide, json, program, utf8};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// What the gallery calls the mechanisms of a report, and how the report's words start.
const MECHANISMS: [(&str, &str); 5] = [
    ("joint metrics", "stability (Jm)"),
    ("matrix inequality", "(M): the matrix inequality of stability"),
    ("loop through x", "C5: the loop through x in the error box"),
    ("dq/de", "C5: dq/de in the error box"),
    ("start of z", "C5: how far the state of the internal model starts"),
];

pub fn page(name: &str) -> String {
    std::fs::read_to_string(Path::new(ROOT).join("docs").join(name)).expect("a document of the repository")
}

/// The rows of the table under a header, by the name in backticks of their first cell.
pub fn table(text: &str, header: &str) -> BTreeMap<String, Vec<String>> {
    let rows: BTreeMap<_, _> = text
        .lines()
        .skip_while(|line| *line != header)
        .skip(2)
        .map_while(|line| line.strip_prefix("| ")?.strip_suffix(" |"))
        .map(|line| {
            let cells: Vec<String> = line.split(" | ").map(str::to_owned).collect();
            let name = cells[0].split('`').nth(1).unwrap_or_else(|| panic!("a name in `{}`", cells[0]));
            (name.to_owned(), cells)
        })
        .collect();
    assert!(!rows.is_empty(), "no table under {header}");
    rows
}

fn plants() -> BTreeMap<String, Vec<String>> {
    table(&page("gallery.md"), "| plant | states | sigma* | ball | e | z | n_o = 0 | n_o = 10 | limited by |")
}

/// Four digits of a number, on the side that keeps the statement true.
pub fn is_rounded(shown: &str, value: &Value, up: bool) -> bool {
    let (Ok(shown), Some(Ok(value))) = (shown.parse::<f64>(), value.as_str().map(str::parse::<f64>)) else {
        return false;
    };
    let unit = if value == 0.0 { 0.0 } else { 10f64.powf(value.log10().floor() - 3.0) };
    let distance = if up { shown - value } else { value - shown };
    0.0 <= distance && distance <= unit
}

/// The bound of sup|e| with so many oscillators.
pub fn error_bound(report: &Value, n_o: u64) -> &Value {
    let bounds = report["consequences"]["error_bounds"].as_array().expect("a matched plant");
    bounds.iter().find(|row| row["n_o"] == n_o).map_or(&Value::Null, |row| &row["sup"])
}

/// Asserts that nothing is wrong in a row that is right, and that each of these cells in the place of its own is told with its column.
pub fn wrong_cells_are_found(
    right: &[String],
    wrong: impl Fn(&[String]) -> Vec<&'static str>,
    cases: &[(usize, &str, &str)],
) {
    assert_eq!(wrong(right), Vec::<&str>::new());
    for (cell, text, column) in cases {
        let mut cells = right.to_vec();
        (*text).clone_into(&mut cells[*cell]);
        assert_eq!(wrong(&cells), [*column], "{text}");
    }
}

/// What is wrong in the row of a plant beside the report of its certificate.
fn wrong(cells: &[String], states: usize, report: &Value) -> Vec<&'static str> {
    let ball = &report["plant"]["ball"];
    let words = report["binding"].as_str().expect("what sets the gain");
    [
        ("states", cells[1] == states.to_string()),
        ("sigma*", report["sigma_star"] == *cells[2]),
        ("ball", if ball.is_null() { cells[3] == "-" } else { is_rounded(&cells[3], ball, false) }),
        ("e", is_rounded(&cells[4], &report["initial_set"]["E0"], false)),
        ("z", is_rounded(&cells[5], &report["initial_set"]["Z0"], false)),
        ("n_o = 0", is_rounded(&cells[6], error_bound(report, 0), true)),
        ("n_o = 10", is_rounded(&cells[7], error_bound(report, 10), true)),
        ("limited by", MECHANISMS.iter().any(|(name, start)| cells[8] == *name && words.starts_with(start))),
    ]
    .into_iter()
    .filter_map(|(column, right)| (!right).then_some(column))
    .collect()
}

/// The row of the gallery, and that of the guide, against a plant's report; for the test that certifies every plant.
pub fn compare(name: &str, report: &Value) {
    let plant = std::fs::read_to_string(Path::new(ROOT).join(format!("specs/plants/{name}.json"))).expect("shipped");
    let states = json(plant.as_bytes())["states"].as_array().map_or(0, Vec::len);
    let rows = plants();
    let cells = rows.get(name).unwrap_or_else(|| panic!("docs/gallery.md: {name} is missing"));
    let columns = wrong(cells, states, report);
    assert!(columns.is_empty(), "docs/gallery.md, {name}: {} in\n{cells:?}\n{report:#}", columns.join(", "));
    let guide = table(&guide(), "| plant | what it is | sigma* |");
    let cells = guide.get(name).unwrap_or_else(|| panic!("the guide: {name} is missing"));
    assert_eq!(report["sigma_star"], *cells[2], "the guide, {name}");
}

#[test]
fn figures_that_are_not_the_programs_are_found() {
    let report = serde_json::json!({
        "sigma_star": "28.378", "binding": "C5: dq/de in the error box", "plant": { "ball": "16.4292" },
        "initial_set": { "E0": "25.853856", "Z0": "0" },
        "consequences": { "error_bounds": [{ "n_o": 0, "sup": "12.926915" }, { "n_o": 10, "sup": "0.21537" }] },
    });
    let right = ["`a`", "1", "28.378", "16.42", "25.85", "0", "12.93", "0.2154", "dq/de"].map(str::to_owned);
    let cases = [
        (1, "2", "states"),
        (2, "28.379", "sigma*"),
        (3, "-", "ball"),
        (3, "16.43", "ball"),
        (4, "25.86", "e"),
        (4, "25.83", "e"),
        (5, "1", "z"),
        (6, "12.92", "n_o = 0"),
        (7, "0.2153", "n_o = 10"),
        (7, "0.2156", "n_o = 10"),
        (8, "start of z", "limited by"),
    ];
    wrong_cells_are_found(&right, |cells| wrong(cells, 1, &report), &cases);
}

/// The gains at samples.
fn at_samples() -> BTreeMap<String, Vec<String>> {
    table(&page("gallery.md"), "| plant | h | sigma |")
}

fn assert_certified_at_samples(name: &str, cells: &[String]) {
    let plant = format!("specs/plants/{name}.json");
    let law = ["--sampling-period", &cells[1], "--sigma", &cells[2]];
    let call = ["certify", &plant, "--quiet", "--no-alternatives", "--format", "json"].into_iter().chain(law);
    let output = program().args(call).output().unwrap();
    let report = json(&output.stdout);
    assert_eq!(report["verdict"], "certified", "{name}: {report:#}");
    assert_eq!(report["samples"], 200, "{name}");
}

#[test]
fn a_gain_at_samples_in_the_gallery_is_certified() {
    let rows = at_samples();
    assert!(rows.keys().eq(plants().keys()));
    assert_certified_at_samples("linear", &rows["linear"]);
}

#[test]
#[ignore = "search tier"]
fn the_gains_at_samples_in_the_gallery_are_certified() {
    at_samples().iter().for_each(|(name, cells)| assert_certified_at_samples(name, cells));
}

/// A drawing as numbers and what is between them.
fn parts(text: &str) -> (Vec<f64>, Vec<&str>) {
    let mut numbers = Vec::new();
    let mut words = Vec::new();
    let mut rest = text;
    while let Some(start) = rest.find(|c: char| c.is_ascii_digit()) {
        words.push(&rest[..start]);
        rest = &rest[start..];
        let end = rest.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(rest.len());
        numbers.push(rest[..end].parse().unwrap_or(f64::NAN));
        rest = &rest[end..];
    }
    words.push(rest);
    (numbers, words)
}

/// Whether two drawings are the same to a pixel of 820: the mathematical functions of other machines differ in their last
/// digit.
fn same_drawing(a: &str, b: &str) -> bool {
    let ((a, between_a), (b, between_b)) = (parts(a), parts(b));
    between_a == between_b && a.len() == b.len() && a.iter().zip(&b).all(|(a, b)| (a - b).abs() <= 4.0)
}

#[test]
fn drawings_are_compared_to_a_pixel() {
    let drawing = r#"<polyline points="376,204 472.5,204 "/><text>sigma = 9</text>"#;
    assert!(same_drawing(drawing, &drawing.replace("472.5", "474")));
    assert!(!same_drawing(drawing, &drawing.replace("472.5", "478")));
    assert!(!same_drawing(drawing, &drawing.replace("376,204 ", "")));
    assert!(!same_drawing(drawing, &drawing.replace("sigma", "mu")));
}

/// The figure of a plant or machine in the documents against the one that the program draws of it at a gain.
pub fn compare_response(name: &str, file: &str, sigma: &str) {
    let folder = TempDir::new().unwrap();
    let call = ["simulate", file, "--sigma", sigma, "--n-o", "3", "--periods", "6", "--samples", "50", "--plots"];
    let output = program().args(call).arg(folder.path()).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{name}: {}", utf8(output.stderr));
    compare_figure(name, &folder.path().join("response.svg"));
}

/// A figure of the documents against the one that the program drew into a folder.
fn compare_figure(name: &str, drawn: &Path) {
    let drawn = std::fs::read_to_string(drawn).unwrap();
    let shipped: PathBuf = Path::new(ROOT).join(format!("docs/figures/{name}.svg"));
    if std::env::var_os("SIGMASTAR_FIGURES").is_some_and(|value| value == "write") {
        std::fs::write(&shipped, &drawn).unwrap();
    }
    let there = std::fs::read_to_string(&shipped).unwrap_or_else(|error| panic!("{name}: {error}"));
    assert!(same_drawing(&there, &drawn), "docs/figures/{name}.svg: make it again with SIGMASTAR_FIGURES=write");
}

/// The figure of the README, and what it says of the gain. `SIGMASTAR_FIGURES=write` draws it again.
#[test]
fn the_figure_of_the_readme_is_what_the_program_draws() {
    let folder = TempDir::new().unwrap();
    let call = ["certify", "specs/plants/paper-example.json", "-q", "--plots"];
    let output = program().args(call).arg(folder.path()).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", utf8(output.stderr));
    compare_figure("error", &folder.path().join("error.svg"));
    let readme = std::fs::read_to_string(Path::new(ROOT).join("README.md")).unwrap();
    assert!(readme.contains("(docs/figures/error.svg)"));
    assert!(utf8(output.stdout).contains("sigma* = 6.04482 in") && readme.contains("sigma\\* = 6.04482 ("));
}

/// The figures of the gallery. `SIGMASTAR_FIGURES=write` draws them again.
#[test]
fn the_figures_of_the_gallery_are_what_the_program_draws() {
    let text = page("gallery.md");
    for (name, cells) in plants() {
        compare_response(&name, &format!("specs/plants/{name}.json"), &cells[2]);
        assert!(text.contains(&format!("(figures/{name}.svg)")), "docs/gallery.md does not show {name}");
    }
}
