//! Parameter studies: exact cases, rows that are those of `certify`, sweeps that are killed, shards.

use crate::support::{ROOT, plant, program, utf8};
use predicates::str::contains;
use serde_json::{Value, json};
use sigmastar_lang::spec::{Document, ErrorKind};
use sigmastar_sweep::sweep::{Results, Study, Sweep};
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

    fn rows(&self, file: &str) -> Vec<Value> {
        self.text(file).lines().skip(1).map(|line| serde_json::from_str(line).unwrap()).collect()
    }

    fn refused(&self, file: &str, more: &[&str], words: &str) {
        let mut command = program();
        command.args(["sweep", "-q"]).arg(self.path("study.json")).arg("-o").arg(self.path(file)).args(more);
        command.assert().code(2).stderr(contains(words));
    }

    fn merge(&self, files: &[&str], output: &str, more: &[&str]) -> assert_cmd::assert::Assert {
        let mut command = program();
        command.arg("merge").args(files.iter().map(|file| self.path(file))).arg("-o").arg(self.path(output)).args(more);
        command.assert()
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
    let said = run.sweep("results.jsonl", &["--minimise", "sigma_star"]);
    let rows = run.rows("results.jsonl");
    assert_eq!(rows.iter().map(|row| row["index"].as_u64().unwrap()).collect::<Vec<_>>(), (0..10).collect::<Vec<_>>());
    let verdicts: Vec<&str> = rows.iter().map(|row| row["verdict"].as_str().unwrap()).collect();
    assert_eq!(verdicts[..6], ["certified", "certified", "bad-input", "bad-input", "bad-input", "bad-input"]);
    assert!(said.contains("computed: 10") && said.contains("(case 0)"), "{said}");
    assert_eq!(rows[2]["errors"][0]["pointer"], "/lyapunov/alpha");
    assert_eq!(rows[2]["errors"][0]["code"], "out-of-range");
    assert_eq!(rows[8]["errors"][0]["code"], "expression");
    assert!(rows[2].get("sigma_star").is_none());
    for (index, row) in rows.iter().take(2).enumerate() {
        let case = program().args(["sweep", "--case", &index.to_string()]).arg(run.path("study.json")).assert().code(0);
        let certified = program()
            .args(["certify", "-", "--no-compare", "--format", "json"])
            .write_stdin(case.get_output().stdout.clone())
            .assert()
            .code(0);
        let report: Value = serde_json::from_slice(&certified.get_output().stdout).unwrap();
        assert_eq!(row["X0_bounds"], "|x|");
        for field in ["sigma_star", "initial_set", "periodic_solution"] {
            assert_eq!(row[field], report[field], "{field}");
        }
        assert_eq!(row["sha256"], report["specification"]["sha256"]);
    }
    let mut single = program();
    single.env("RAYON_NUM_THREADS", "1").args(["sweep", "-q"]).arg(run.path("study.json"));
    single.arg("-o").arg(run.path("single.jsonl")).assert().code(0);
    assert_eq!(run.text("single.jsonl"), run.text("results.jsonl"));
}

#[test]
fn a_killed_sweep_goes_on() {
    let run = Run::new(&study(json!({})));
    assert!(run.sweep("whole.jsonl", &[]).contains("taken over: 0, computed: 8"));
    let whole = run.text("whole.jsonl");
    let lines: Vec<&str> = whole.split_inclusive('\n').collect();
    assert_eq!(lines.len(), 9);
    let go_on = |left: &str, taken: u64| {
        fs::write(run.path("killed.jsonl"), left).unwrap();
        let said = run.sweep("killed.jsonl", &[]);
        assert!(said.contains(&format!("taken over: {taken}, computed: {}", 8 - taken)), "{said}");
        assert_eq!(run.text("killed.jsonl"), whole);
    };
    // Half of the lines, in the order in which they were done; a line cut off; nothing but the first line; all.
    go_on(&[lines[0], lines[7], lines[2], lines[8], lines[1]].concat(), 4);
    go_on(&format!("{}{}", lines[..4].concat(), &lines[4][..lines[4].len() / 2]), 3);
    go_on(lines[0], 0);
    go_on(&whole, 8);
    go_on("", 0);
    // The last line is whole but for its end.
    go_on(whole.trim_end(), 8);
    // A row of another document is computed again.
    // Case 0 is the subject itself, whose digest is in the first line too.
    let digest = lines[2].split("\"sha256\":\"").nth(1).unwrap()[..64].to_owned();
    go_on(&whole.replace(&digest, &"0".repeat(64)), 7);
}

#[test]
fn a_file_of_another_study_is_kept() {
    let run = Run::new(&study(json!({})));
    run.sweep("results.jsonl", &[]);
    let whole = run.text("results.jsonl");
    run.refused("results.jsonl", &["--shard", "1/2"], "another study, shard or version");
    fs::write(run.path("study.json"), study(json!({ "sampling_period": "1/100" })).to_string()).unwrap();
    run.refused("results.jsonl", &[], "another study, shard or version");
    assert_eq!(run.text("results.jsonl"), whole);
    let broken = whole.replacen("{\"index\":3", "{\"index\": 3", 1);
    fs::write(run.path("study.json"), study(json!({})).to_string()).unwrap();
    for (text, words) in [
        (broken, "line 5 of"),
        ("text\n".to_owned(), "is no file of results"),
        (whole.replacen("\"index\":3", "\"index\":30", 1), "does not belong to this study"),
        (whole.replacen("\"index\":3", "\"index\":2", 1), "says of case 2 another thing"),
    ] {
        fs::write(run.path("results.jsonl"), &text).unwrap();
        run.refused("results.jsonl", &[], words);
        assert_eq!(run.text("results.jsonl"), text);
    }
    run.refused("study.json", &[], "it is the study itself");
    run.refused("results.jsonl", &["--csv", run.path("results.jsonl").to_str().unwrap()], "is to be written twice");
}

#[test]
fn shards_are_the_whole() {
    let run = Run::new(&study(json!({})));
    run.sweep("whole.jsonl", &[]);
    for part in 1..4 {
        let said = run.sweep(&format!("{part}.jsonl"), &["--shard", &format!("{part}/3")]);
        assert!(said.contains(&format!("computed: {}", if part == 3 { 2 } else { 3 })), "{said}");
    }
    run.merge(&["3.jsonl", "1.jsonl", "2.jsonl"], "merged.jsonl", &[]).code(0);
    assert_eq!(run.text("merged.jsonl"), run.text("whole.jsonl"));
    run.merge(&["3.jsonl", "1.jsonl"], "two.jsonl", &[]).code(2).stderr(contains("3 of 8 cases are missing"));
    assert!(!run.path("two.jsonl").exists());
    run.merge(&["3.jsonl", "1.jsonl"], "two.jsonl", &["--incomplete"]).code(0);
    assert!(run.sweep("two.jsonl", &[]).contains("taken over: 5, computed: 3"));
    assert_eq!(run.text("two.jsonl"), run.text("whole.jsonl"));
    run.merge(&["1.jsonl"], "1.jsonl", &["--incomplete"]).code(2).stderr(contains("it is the input itself"));
    // Another study, and another thing of the same case.
    let other = run.text("2.jsonl").replacen("study_sha256\":\"", "study_sha256\":\"0", 1);
    fs::write(run.path("other.jsonl"), other).unwrap();
    run.merge(&["1.jsonl", "other.jsonl"], "x.jsonl", &[]).code(2).stderr(contains("is of another study"));
    let other = run.text("2.jsonl").replacen("\"no_plant\":false", "\"no_plant\":true", 1);
    fs::write(run.path("other.jsonl"), other).unwrap();
    run.merge(&["2.jsonl", "other.jsonl"], "x.jsonl", &[]).code(2).stderr(contains("another thing"));
    for wrong in ["0/3", "4/3", "1", "1/0", "a/b", "1/100001"] {
        run.refused("y.jsonl", &["--shard", wrong], "is no part of a study");
    }
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
    let [results, table, plot] = ["r.jsonl", "t.csv", "p.svg"].map(|name| folder.path().join(name));
    let mut command = program();
    command.args(["sweep", SHIPPED, "-o"]).arg(&results).arg("--csv").arg(&table).arg("--plot").arg(&plot);
    command.assert().code(0).stdout(contains("15 of 15 cases: 15 certified"));
    let read = Results::read("r", &fs::read(&results).unwrap()).unwrap();
    assert_eq!(read.rows.len(), 15);
    let table = fs::read_to_string(table).unwrap();
    assert!(
        table.starts_with(
            "index,alpha,p_up,verdict,sigma_star,X0,X0_bounds,E0,Z0,x,e,zeta,z,no_plant,sha256,message\r\n"
        )
    );
    assert!(table.lines().nth(1).unwrap().starts_with("0,0.5,1.1,certified,"), "{table}");
    assert!(table.lines().skip(1).all(|line| line.split(',').count() == 16));
    let svg = fs::read_to_string(plot).unwrap();
    for label in ["p_up = 11/10", "p_up = 1.5512", "p_up = 2.5", "alpha", "sigma_star"] {
        assert!(svg.contains(label), "{label}");
    }
    // Inside the study or beside it: the same study.
    let mut embedded: Value =
        serde_json::from_str(&fs::read_to_string(Path::new(ROOT).join(SHIPPED)).unwrap()).unwrap();
    embedded["subject"] = subject();
    fs::write(folder.path().join("study.json"), embedded.to_string()).unwrap();
    let mut command = program();
    command.args(["sweep", "-q"]).arg(folder.path().join("study.json")).arg("-o").arg(&results);
    command.assert().code(0).stdout(contains("taken over: 15, computed: 0"));
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
        run.refused("r.jsonl", &["--plot", run.path("p.svg").to_str().unwrap()], words);
        assert!(!run.path("r.jsonl").exists());
    }
    let logarithmic =
        json!([{ "pointer": "/internal_model/mu", "logarithmic": { "from": "1/10", "to": 1, "count": 3 } }]);
    let run = Run::new(&study(json!({ "parameters": logarithmic })));
    run.sweep("r.jsonl", &["--plot", run.path("p.svg").to_str().unwrap()]);
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
    run.sweep("r.jsonl", &[]);
    let row = &run.rows("r.jsonl")[0];
    assert_eq!((&row["verdict"], &row["sampling_period"]), (&json!("certified"), &json!("0.001")));
    let plant = json!({
        "format": "sigmastar/study", "version": 1, "name": "plant", "design": "grid",
        "subject": Path::new(ROOT).join("specs/plants/linear.json"),
        "parameters": [{ "pointer": "/internal_model/mu", "values": ["1", "-1"] }],
    });
    let run = Run::new(&plant);
    run.sweep("r.jsonl", &[]);
    let rows = run.rows("r.jsonl");
    assert_eq!((&rows[0]["verdict"], &rows[1]["verdict"]), (&json!("certified"), &json!("bad-input")));
}

/// X0 of a plant is in the coordinates of its certificate, but where the set is asked for as a ball: then it is that ball, of x.
#[test]
fn a_line_says_what_its_set_bounds() {
    let mut plant = plant(&["a", "b"], &["-a + 4*b", "-4*b + sin(2*pi*t)"], "1 + a/8 + cos(2*pi*t)");
    plant["initial_set"] = json!({ "kind": "aligned", "ball": "1/3", "E0": "1" });
    let sweep = |plant: &Value| {
        let run = Run::new(&json!({
            "format": "sigmastar/study", "version": 1, "name": "sets", "design": "grid", "subject": plant,
            "parameters": [{ "pointer": "/internal_model/mu", "values": ["1"] }],
        }));
        run.sweep("r.jsonl", &["--csv", run.path("t.csv").to_str().unwrap()]);
        let certify = |format: &str| {
            let mut certify = program();
            certify.args(["certify", "-", "-q", "--no-compare", "--format", format]).write_stdin(plant.to_string());
            certify.assert().code(0).get_output().stdout.clone()
        };
        let report: Value = serde_json::from_slice(&certify("json")).unwrap();
        (run.rows("r.jsonl")[0].clone(), run.text("t.csv"), report)
    };
    let (row, table, report) = sweep(&plant);
    assert_eq!((&row["initial_set"]["X0"], &row["X0_bounds"]), (&json!("1/3"), &json!("|x - x_0|")));
    assert_ne!(row["initial_set"]["X0"], report["initial_set"]["X0"]);
    assert_eq!(row["initial_set"]["E0"], report["initial_set"]["E0"]);
    assert!(table.contains(",0.3333333333333333,|x - x_0|,1,M e,"), "{table}");
    let mut other = plant;
    other["initial_set"] = json!({ "kind": "aligned" });
    let (row, table, report) = sweep(&other);
    assert_eq!((&row["initial_set"], &row["X0_bounds"]), (&report["initial_set"], &json!("|L^-1 (x - x_0)|")));
    assert!(table.contains(",|L^-1 (x - x_0)|,"), "{table}");
    // Lines of earlier programs do not say, and are read; another word is refused.
    let run = Run::new(&study(json!({})));
    run.sweep("r.jsonl", &[]);
    let text = run.text("r.jsonl");
    let read = |text: &str| Results::read("r", text.as_bytes());
    assert_eq!(
        read(&text.replace("\"X0_bounds\":\"|x|\",", "")).unwrap().rows[&0].claim.as_ref().unwrap().x0_bounds,
        None
    );
    assert!(read(&text.replace("\"X0_bounds\":\"|x|\"", "\"X0_bounds\":\"x\"")).is_err());
}
