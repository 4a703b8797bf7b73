//! Parameter studies: exact cases, rows that are those of `certify`.

use crate::support::{ROOT, plant, program, utf8};
use predicates::str::contains;
use serde_json::{Value, json};
use sigmastar::Study as Front;
use sigmastar_lang::spec::{Document, ErrorKind};
use sigmastar_studies::sweep::{Study, Sweep};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

const SHIPPED: &str = "specs/studies/linear.json";

fn subject() -> Value {
    serde_json::from_str(include_str!("../../specs/linear.json")).unwrap()
}

/// A study of the linear example, with fields in place of its own.
fn study(changes: Value) -> Value {
    let mut study = json!({
        "format": "sigmastar/study", "version": 1, "name": "study", "subject": subject(), "design": "grid",
        "parameters": [
            { "pointer": "/lyapunov/alpha", "values": ["0.58", 1] },
            { "pointer": "/internal_model/mu", "linear": { "from": 1, "to": 2, "count": 4 } },
        ],
    });
    for (name, value) in changes.as_object().unwrap() {
        study[name] = value.clone();
    }
    study
}

fn sweep_of(study: &Value) -> Sweep {
    let document = Document::parse("study", &study.to_string()).unwrap();
    Sweep::new(Study::read(&document).unwrap_or_else(|errors| panic!("{errors}")), None).unwrap()
}

fn values(study: &Value) -> Vec<String> {
    let sweep = sweep_of(study);
    (0..sweep.count()).map(|index| sweep.case(index).unwrap().values.join(" ")).collect()
}

struct Run {
    folder: TempDir,
}

impl Run {
    fn new(study: &Value) -> Run {
        let folder = TempDir::new().unwrap();
        fs::write(folder.path().join("study.json"), study.to_string()).unwrap();
        Run { folder }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Runs the sweep into a file and returns what it says.
    fn sweep(&self, file: &str, more: &[&str]) -> String {
        let mut command = program();
        command.args(["sweep", "-q"]).arg(self.path("study.json")).arg("-o").arg(self.path(file)).args(more);
        utf8(command.assert().code(0).get_output().stdout.clone())
    }

    fn text(&self, file: &str) -> String {
        fs::read_to_string(self.path(file)).unwrap()
    }

    /// The rows of the table by the names of their columns; the last one, the message, up to its first comma.
    fn rows(&self, file: &str) -> Vec<BTreeMap<String, String>> {
        let text = self.text(file);
        let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned));
        let names: Vec<String> = lines.next().unwrap().collect();
        lines.map(|line| names.iter().cloned().zip(line).collect()).collect()
    }

    fn refused(&self, file: &str, more: &[&str], words: &str) {
        let mut command = program();
        command.args(["sweep", "-q"]).arg(self.path("study.json")).arg("-o").arg(self.path(file)).args(more);
        command.assert().code(2).stderr(contains(words));
    }
}

#[test]
fn cases_are_exact() {
    let one = |values: Value| {
        let mut parameter = json!({ "pointer": "/lyapunov/alpha" });
        parameter.as_object_mut().unwrap().extend(values.as_object().unwrap().clone());
        values_of(parameter)
    };
    fn values_of(parameter: Value) -> Vec<String> {
        values(&study(json!({ "parameters": [parameter] })))
    }
    assert_eq!(one(json!({ "linear": { "from": "0.1", "to": "1/3", "count": 3 } })), ["0.1", "13/60", "1/3"]);
    assert_eq!(one(json!({ "logarithmic": { "from": 1, "to": "0.001", "count": 4 } })), ["1", "0.1", "0.01", "0.001"]);
    // As they are written: no double comes between.
    let list: Value = serde_json::from_str(r#"{ "values": [0.1000000000000000000001, "sqrt(2)", 1.50] }"#).unwrap();
    assert_eq!(one(list), ["0.1000000000000000000001", "sqrt(2)", "1.50"]);
    let grid = values(&study(json!({})));
    assert_eq!(grid[..5], ["0.58 1", "0.58 4/3", "0.58 5/3", "0.58 2", "1 1"]);
    assert_eq!(grid.len(), 8);
}

/// The digest is that of the document, in which everything else is as it was.
#[test]
fn a_case_is_the_document_with_its_values() {
    let case = sweep_of(&study(json!({ "sampling_period": "1/1000" }))).case(1).unwrap();
    let mut expected = subject();
    expected["lyapunov"]["alpha"] = json!("0.58");
    expected["internal_model"]["mu"] = json!("4/3");
    expected["internal_model"]["sampling_period"] = json!("1/1000");
    assert_eq!(case.sha256, Document::parse("expected", &expected.to_string()).unwrap().root().sha256());
}

#[test]
fn a_latin_hypercube_has_each_part_once_and_a_seed() {
    let latin = |seed: u64| {
        values(&study(json!({
            "design": "latin", "count": 8, "seed": seed,
            "parameters": [
                { "pointer": "/lyapunov/alpha", "linear": { "from": 1, "to": 9 } },
                { "pointer": "/internal_model/mu", "logarithmic": { "from": "1/2", "to": 128 } },
                { "pointer": "/period", "values": [1, "2"] },
            ],
        })))
    };
    let cases = latin(3);
    assert_eq!((cases.len(), &cases), (8, &latin(3)));
    assert_ne!(cases, latin(4));
    for column in 0..2 {
        let mut parts: Vec<u32> = cases
            .iter()
            .map(|case| {
                let text = case.split(' ').nth(column).unwrap();
                let value: f64 = text.parse().unwrap();
                if column == 0 { value as u32 } else { (value.log2() + 2.0).floor() as u32 }
            })
            .collect();
        parts.sort_unstable();
        assert_eq!(parts, (1..9).collect::<Vec<_>>(), "{cases:?}");
    }
    assert_eq!(cases.iter().filter(|case| case.ends_with(" 2")).count(), 4);
}

/// Rows are those of `certify`, in the order of the cases, the same with any number of threads; what is refused is a row.
#[test]
fn rows_are_what_certify_says() {
    let mut study = study(json!({}));
    study["parameters"][0]["values"] = json!(["0.58", "-1", "0", "1/1000000", "1 s"]);
    study["parameters"][1] = json!({ "pointer": "/internal_model/matched", "values": [true, false] });
    let run = Run::new(&study);
    let said = run.sweep("results.csv", &["--minimise", "sigma_star"]);
    let rows = run.rows("results.csv");
    let indices: Vec<u64> = rows.iter().map(|row| row["index"].parse().unwrap()).collect();
    assert_eq!(indices, (0..10).collect::<Vec<_>>());
    let verdicts: Vec<&str> = rows.iter().map(|row| row["verdict"].as_str()).collect();
    assert_eq!(verdicts[..6], ["certified", "certified", "bad-input", "bad-input", "bad-input", "bad-input"]);
    assert!(said.contains("10 cases: 4 certified, 6 bad-input") && said.contains("(case 0)"), "{said}");
    assert!(rows[2]["message"].contains("must be positive") && rows[2]["sigma_star"].is_empty(), "{:?}", rows[2]);
    // A line, by which a case goes from one process to another, says it with its place.
    let front = Front::from_bytes("study.json", run.text("study.json").as_bytes(), |_| unreachable!()).unwrap();
    let line = |index| serde_json::from_str::<Value>(&front.run_case(index).unwrap()).unwrap();
    let [of_range, of_text] = [2, 8].map(line);
    assert_eq!(of_range["errors"][0]["pointer"], "/lyapunov/alpha");
    assert_eq!(of_range["errors"][0]["code"], "out-of-range");
    assert_eq!(of_text["errors"][0]["code"], "expression");
    assert!(of_range.get("sigma_star").is_none());
    for (index, row) in rows.iter().take(2).enumerate() {
        let case = program().args(["sweep", "--case", &index.to_string()]).arg(run.path("study.json")).assert().code(0);
        let certified = program()
            .args(["certify", "-", "--no-alternatives", "--format", "json"])
            .write_stdin(case.get_output().stdout.clone())
            .assert()
            .code(0);
        let report: Value = serde_json::from_slice(&certified.get_output().stdout).unwrap();
        assert_eq!(row["X0_bounds"], "|x|");
        assert_eq!(row["sigma_star"], report["sigma_star"]);
        for (field, columns) in
            [("initial_set", ["X0", "E0", "Z0"].as_slice()), ("periodic_solution", &["x", "e", "zeta", "z"])]
        {
            assert!(columns.iter().all(|column| row[*column] == report[field][column]), "{field}: {row:?}");
        }
        assert_eq!(row["sha256"], report["specification"]["sha256"]);
    }
    let mut single = program();
    single.env("RAYON_NUM_THREADS", "1").args(["sweep", "-q"]).arg(run.path("study.json"));
    single.arg("-o").arg(run.path("single.csv")).assert().code(0);
    assert_eq!(run.text("single.csv"), run.text("results.csv"));
}

#[test]
fn no_file_is_written_twice_or_over_the_study() {
    let run = Run::new(&study(json!({})));
    run.refused("study.json", &["--force"], "it is the study itself");
    run.refused("x.svg", &["--plot", run.path("x.svg").to_str().unwrap()], "is to be written twice");
    assert!(!run.path("x.svg").exists());
}

#[test]
fn what_is_wrong_with_a_study_is_told_in_its_place() {
    use ErrorKind::*;
    let range = |range: Value| json!({ "parameters": [{ "pointer": "/period", "linear": range }] });
    let logarithmic = |range: Value| json!({ "parameters": [{ "pointer": "/period", "logarithmic": range }] });
    let parameter = |parameter: Value| json!({ "parameters": [parameter] });
    let cases = [
        (json!({ "format": "sigmastar/plant" }), Format, "/format"),
        (json!({ "version": 2 }), Version, "/version"),
        (json!({ "name": 1 }), Type, "/name"),
        (json!({ "description": 1 }), Type, "/description"),
        (json!({ "subject": 1 }), Type, "/subject"),
        (json!({ "subject": "" }), Range, "/subject"),
        (json!({ "subject": "nowhere.json" }), Unreadable, "/subject"),
        (json!({ "subject": { "format": "sigmastar/certificate" } }), Format, "/subject"),
        (json!({ "derivation": "printed" }), UnknownName, "/derivation"),
        (json!({ "derivation": "repaired" }), UnknownName, "/derivation"),
        (json!({ "sampling_period": 0 }), Range, "/sampling_period"),
        (json!({ "design": "random" }), UnknownName, "/design"),
        (json!({ "count": 8 }), UnknownField, "/count"),
        (json!({ "seed": 8 }), UnknownField, "/seed"),
        (json!({ "design": "latin", "seed": 1 }), MissingField, "/count"),
        (json!({ "design": "latin", "count": 4 }), MissingField, "/seed"),
        (json!({ "design": "latin", "count": 1, "seed": 1 }), Range, "/count"),
        (json!({ "design": "latin", "count": 100_001, "seed": 1 }), Range, "/count"),
        (json!({ "design": "latin", "count": 4, "seed": -1 }), Type, "/seed"),
        (json!({ "parameters": [] }), Range, "/parameters"),
        (json!({ "parameters": vec![json!({ "pointer": "/period", "values": [1] }); 17] }), Range, "/parameters"),
        (json!({ "parameters": vec![json!({ "pointer": "/period", "values": [1] }); 2] }), Range, "/parameters/1"),
        (parameter(json!({ "values": [1] })), MissingField, "/parameters/0/pointer"),
        (parameter(json!({ "pointer": "period", "values": [1] })), Range, "/parameters/0/pointer"),
        (parameter(json!({ "pointer": "/perod", "values": [1] })), UnknownName, "/parameters/0/pointer"),
        (parameter(json!({ "parameter": "k", "values": [1] })), UnknownName, "/parameters/0/parameter"),
        (parameter(json!({ "parameter": 1, "values": [1] })), Type, "/parameters/0/parameter"),
        (parameter(json!({ "parameter": "k", "pointer": "/period", "values": [1] })), Range, "/parameters/0/parameter"),
        (parameter(json!({ "pointer": "/bounds", "values": [1] })), UnknownName, "/parameters/0/pointer"),
        (parameter(json!({ "pointer": "/period", "name": 1, "values": [1] })), Type, "/parameters/0/name"),
        (parameter(json!({ "pointer": "/period" })), MissingField, "/parameters/0"),
        (parameter(json!({ "pointer": "/period", "values": [] })), Range, "/parameters/0/values"),
        (parameter(json!({ "pointer": "/period", "values": [null] })), Type, "/parameters/0/values/0"),
        (parameter(json!({ "pointer": "/period", "values": [1, "1"] })), Range, "/parameters/0/values/1"),
        (
            parameter(json!({ "pointer": "/period", "values": [1], "linear": { "from": 1, "to": 2, "count": 2 } })),
            Range,
            "/parameters/0/linear",
        ),
        (range(json!({ "from": "pi", "to": 2, "count": 2 })), Range, "/parameters/0/linear/from"),
        (range(json!({ "from": 1, "to": "x", "count": 2 })), Expression, "/parameters/0/linear/to"),
        (range(json!({ "from": 1, "to": "2/2", "count": 2 })), Range, "/parameters/0/linear/to"),
        (range(json!({ "from": 1, "to": 2, "count": 1 })), Range, "/parameters/0/linear/count"),
        (range(json!({ "from": 1, "to": 2 })), MissingField, "/parameters/0/linear/count"),
        (range(json!({ "from": 1, "to": 2, "count": 2, "step": 1 })), UnknownField, "/parameters/0/linear/step"),
        (logarithmic(json!({ "from": 0, "to": 2, "count": 2 })), Range, "/parameters/0/logarithmic/from"),
        (logarithmic(json!({ "from": 1, "to": "1e-200", "count": 2 })), Range, "/parameters/0/logarithmic/to"),
        (logarithmic(json!({ "from": 1, "to": "1.000001", "count": 9 })), Range, "/parameters/0/logarithmic"),
        (
            json!({ "parameters": [
                { "pointer": "/period", "linear": { "from": 1, "to": 2, "count": 1000 } },
                { "pointer": "/lyapunov/alpha", "linear": { "from": 1, "to": 2, "count": 101 } },
            ] }),
            Limit,
            "/parameters",
        ),
        (
            json!({ "design": "latin", "count": 4, "seed": 1,
                    "parameters": [{ "pointer": "/period", "linear": { "from": 1, "to": 2, "count": 4 } }] }),
            UnknownField,
            "/parameters/0/linear/count",
        ),
    ];
    for (changes, kind, pointer) in cases {
        let document = Document::parse("study", &study(changes.clone()).to_string()).unwrap();
        let errors = Study::read(&document).and_then(|study| Sweep::new(study, None)).expect_err(&changes.to_string());
        let found = errors.errors().iter().any(|error| error.kind == kind && error.pointer == pointer);
        assert!(found, "{changes}: {:?}", errors.errors());
    }
}

#[test]
fn the_shipped_study_has_a_table_and_a_plot() {
    let folder = TempDir::new().unwrap();
    let [table, plot] = ["t.csv", "p.svg"].map(|name| folder.path().join(name));
    let mut command = program();
    command.args(["sweep", SHIPPED, "-o"]).arg(&table).arg("--plot").arg(&plot);
    command.assert().code(0).stdout(contains("15 cases: 15 certified"));
    let table = fs::read_to_string(&table).unwrap();
    assert_eq!(table.lines().count(), 16);
    assert!(table.starts_with(
        "index,alpha,p_up,verdict,sigma_star,sampling_period,X0,X0_bounds,E0,Z0,x,e,zeta,z,no_plant,sha256,message\r\n"
    ));
    assert!(table.lines().nth(1).unwrap().starts_with("0,0.5,1.1,certified,"), "{table}");
    assert!(table.lines().skip(1).all(|line| line.split(',').count() == 17));
    let svg = fs::read_to_string(plot).unwrap();
    for label in ["p_up = 11/10", "p_up = 1.5512", "p_up = 2.5", "alpha", "sigma_star"] {
        assert!(svg.contains(label), "{label}");
    }
    // Inside the study or beside it: the same study.
    let mut embedded: Value =
        serde_json::from_str(&fs::read_to_string(Path::new(ROOT).join(SHIPPED)).unwrap()).unwrap();
    embedded["subject"] = subject();
    let run = Run::new(&embedded);
    run.sweep("t.csv", &[]);
    assert_eq!(run.text("t.csv"), table);
    program().args(["sweep", SHIPPED, "--case", "15"]).assert().code(2).stderr(contains("there is no case 15"));
}

#[test]
fn a_plot_that_cannot_be_is_refused_before_the_work() {
    for (parameters, words) in [
        (json!([{ "pointer": "/bounds/q", "values": ["X", "2*X"] }]), "is no number"),
        (
            json!([{ "pointer": "/period", "values": [1] }, { "pointer": "/lyapunov/alpha", "values": [1] },
                   { "pointer": "/internal_model/mu", "values": [1] }]),
            "one or two parameters",
        ),
    ] {
        let run = Run::new(&study(json!({ "parameters": parameters })));
        run.refused("r.csv", &["--plot", run.path("p.svg").to_str().unwrap()], words);
        assert!(!run.path("r.csv").exists());
    }
    let logarithmic =
        json!([{ "pointer": "/internal_model/mu", "logarithmic": { "from": "1/10", "to": 1, "count": 3 } }]);
    let run = Run::new(&study(json!({ "parameters": logarithmic })));
    run.sweep("r.csv", &["--plot", run.path("p.svg").to_str().unwrap()]);
    assert!(fs::read_to_string(run.path("p.svg")).unwrap().contains("<polyline"));
}

/// The law at samples: the gain is that of `certify --sampling-period`, and the row says for which samples it is.
#[test]
fn plants_and_samples_are_swept() {
    let study = json!({
        "format": "sigmastar/study", "version": 1, "name": "samples", "design": "grid", "sampling_period": "1/1000",
        "subject": Path::new(ROOT).join("specs/paper-example-rms-at-rest.json"),
        "parameters": [{ "pointer": "/internal_model/mu", "values": [1] }],
    });
    let run = Run::new(&study);
    run.sweep("r.csv", &[]);
    let row = &run.rows("r.csv")[0];
    assert_eq!([&row["verdict"], &row["sampling_period"]], ["certified", "0.001"]);
    let plant = json!({
        "format": "sigmastar/study", "version": 1, "name": "plant", "design": "grid",
        "subject": Path::new(ROOT).join("specs/plants/linear.json"),
        "parameters": [{ "pointer": "/internal_model/mu", "values": ["1", "-1"] }],
    });
    let run = Run::new(&plant);
    run.sweep("r.csv", &[]);
    let rows = run.rows("r.csv");
    assert_eq!([&rows[0]["verdict"], &rows[1]["verdict"]], ["certified", "bad-input"]);
}

/// X0 of a plant is in the coordinates of its certificate, but where the set is asked for as a ball: then it is that ball, of x.
#[test]
fn a_row_says_what_its_set_bounds() {
    let mut plant = plant(&["a", "b"], &["-a + 4*b", "-4*b + sin(2*pi*t)"], "1 + a/8 + cos(2*pi*t)");
    plant["initial_set"] = json!({ "kind": "aligned", "ball": "1/3", "E0": "1" });
    let sweep = |plant: &Value| {
        let run = Run::new(&json!({
            "format": "sigmastar/study", "version": 1, "name": "sets", "design": "grid", "subject": plant,
            "parameters": [{ "pointer": "/internal_model/mu", "values": ["1"] }],
        }));
        run.sweep("r.csv", &[]);
        let mut certify = program();
        certify.args(["certify", "-", "-q", "--no-alternatives", "--format", "json"]).write_stdin(plant.to_string());
        let report: Value = serde_json::from_slice(&certify.assert().code(0).get_output().stdout).unwrap();
        (run.rows("r.csv")[0].clone(), report["initial_set"].clone())
    };
    let (row, set) = sweep(&plant);
    assert_eq!([&row["X0"], &row["X0_bounds"], &row["Z0"]], ["0.3333333333333333", "|x - x_0|", "M e"]);
    assert_ne!(row["X0"], set["X0"]);
    assert_eq!(row["E0"], set["E0"]);
    let mut other = plant;
    other["initial_set"] = json!({ "kind": "aligned" });
    let (row, set) = sweep(&other);
    assert_eq!(row["X0_bounds"], "|L^-1 (x - x_0)|");
    assert!(row["X0"] == set["X0"] && row["E0"] == set["E0"], "{row:?} {set}");
    // A line with another word is refused.
    let study = study(json!({ "parameters": [{ "pointer": "/period", "values": ["1"] }] }));
    let front = Front::from_bytes("study.json", study.to_string().as_bytes(), |_| unreachable!()).unwrap();
    let line = front.run_case(0).unwrap();
    assert!(front.results([line.as_str()]).is_ok());
    assert!(front.results([line.replace("\"X0_bounds\":\"|x|\"", "\"X0_bounds\":\"x\"").as_str()]).is_err());
}
