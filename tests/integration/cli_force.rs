//! Files that exist are replaced only where `--force` says so, and colours come only where they are asked for.

use crate::support::{EXAMPLE, PLANT, program};
use predicates::prelude::*;
use predicates::str::contains;
use std::fs;
use std::path::Path;

const LINEAR: &str = "specs/linear.json";
const LINEAR_PLANT: &str = "specs/plants/linear.json";
const CERTIFICATE: &str = "proofs-check/tests/certificates/paper-example.means.json";

/// Each command that writes a file, with `FILE` in its place.
const CALLS: [&[&str]; 8] = [
    &["certify", "-q", LINEAR, "-o", "FILE.json"],
    &["bound", "-q", LINEAR_PLANT, "-o", "FILE.json"],
    &["controller", LINEAR, "--sigma", "2", "--n-o", "1", "-o", "FILE.json"],
    &["falsify", "-q", CERTIFICATE, "--trial", "1", "-o", "FILE.json"],
    &["simulate", "-q", LINEAR_PLANT, "--sigma", "2", "--n-o", "1", "--periods", "1", "--csv", "FILE.csv"],
    &["transfer", "-q", LINEAR, "--n-o", "0", "--plot", "FILE.svg"],
    &["sampling", "-q", LINEAR, "--sampling-period", "1/100", "--sigma", "50", "--plot", "FILE.svg"],
    &["controller", LINEAR, "--sigma", "2", "--n-o", "1", "--discretise", "1/100", "--format", "c", "-o", "FILE.c"],
];

#[test]
fn a_file_that_exists_is_replaced_only_with_force() {
    for call in CALLS {
        let folder = tempfile::tempdir().unwrap();
        let base = folder.path().join("file").display().to_string();
        let arguments: Vec<String> = call.iter().map(|part| part.replace("FILE", &base)).collect();
        let path = Path::new(arguments.last().unwrap());
        fs::write(path, "mine").unwrap();
        program().args(&arguments).assert().code(2).stderr(contains("exists already").and(contains("--force")));
        assert_eq!(fs::read(path).unwrap(), b"mine", "{arguments:?}");
        program().args(&arguments).arg("--force").assert().success();
        assert_ne!(fs::read(path).unwrap(), b"mine", "{arguments:?}");
    }
}

/// The header of C code is a file like its source.
#[test]
fn no_file_of_several_is_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let [source, header] = ["a.c", "a.h"].map(|name| folder.path().join(name));
    fs::write(&header, "mine").unwrap();
    let call = ["controller", LINEAR, "--sigma", "2", "--n-o", "1", "--discretise", "1/100", "--format", "c", "-o"];
    program().args(call).arg(&source).assert().code(2).stderr(contains("a.h` exists already"));
    assert!(!source.exists());
}

/// Whatever else is in the folder is nobody's business.
#[test]
fn a_folder_of_figures_is_written_twice_only_with_force() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("notes.txt"), "mine").unwrap();
    let call = ["simulate", "-q", LINEAR_PLANT, "--sigma", "2", "--n-o", "1", "--periods", "1", "--plots"];
    for more in [&[][..], &["--sampled", "1/50"]] {
        let simulate = |force: bool| {
            let mut command = program();
            command.args(call).arg(folder.path()).args(more).args(force.then_some("--force"));
            command.assert()
        };
        simulate(!more.is_empty()).success();
        simulate(false).code(2).stderr(contains(".svg` exists already"));
        simulate(true).success();
    }
    assert_eq!(fs::read(folder.path().join("notes.txt")).unwrap(), b"mine");
    let call = ["reproduce", "-q", "--only", "figures", "-o"];
    fs::write(folder.path().join("report.md"), "mine").unwrap();
    program().args(call).arg(folder.path()).assert().code(2).stderr(contains("report.md` exists already"));
    assert_eq!(fs::read(folder.path().join("report.md")).unwrap(), b"mine");
}

/// The table of a sweep is a file like any other.
#[test]
fn a_table_is_not_replaced_without_force() {
    let folder = tempfile::tempdir().unwrap();
    let [study, table] = ["study.json", "table.csv"].map(|name| folder.path().join(name));
    let text = format!(
        r#"{{ "format": "sigmastar/study", "version": 1, "name": "n", "subject": {:?}, "design": "grid",
            "parameters": [{{ "pointer": "/internal_model/mu", "values": ["1", "1/2"] }}] }}"#,
        Path::new(crate::support::ROOT).join(LINEAR)
    );
    fs::write(&study, text).unwrap();
    let sweep = |force: bool| {
        let mut command = program();
        command.args(["sweep", "-q"]).arg(&study).arg("-o").arg(&table);
        command.args(force.then_some("--force")).assert()
    };
    sweep(false).success().stdout(contains("2 cases: 2 certified"));
    sweep(false).code(2).stderr(contains("table.csv` exists already"));
    sweep(true).success();
}

#[test]
fn colours_come_where_they_are_asked_for() {
    const ESCAPE: &str = "\u{1b}[";
    // Diagnostics with and without a place, an error of the call, and help.
    let wrong: [&[&str]; 4] = [
        &["certify", "specs/invalid/zero-alpha.json"],
        &["certify", "no-such-file"],
        &["certify", "--wrong"],
        &["certify", "--help"],
    ];
    for call in wrong {
        let written = |arguments: &[&str], environment: &[(&str, &str)]| {
            let output = program().args(arguments).envs(environment.iter().copied()).output().unwrap();
            String::from_utf8([output.stdout, output.stderr].concat()).unwrap()
        };
        let with = |choice| [call, &["--color", choice]].concat();
        let plain = written(call, &[]);
        assert!(!plain.contains(ESCAPE), "{plain}");
        assert_eq!(written(&with("never"), &[]), plain);
        assert_eq!(written(&with("auto"), &[]), plain);
        for environment in [&[][..], &[("NO_COLOR", "1")]] {
            let coloured = written(&with("always"), environment);
            assert!(coloured.contains(ESCAPE), "{call:?}: {coloured}");
        }
    }
    program().args(["--color", "red", "certify", EXAMPLE]).assert().code(2).stderr(contains("always"));
    // Reports have none.
    let report = ["lyapunov", "specs/paper-example-jacobian.json", "--color", "always"];
    program().args(report).assert().success().stdout(contains(ESCAPE).not());
    program()
        .args(["simulate", PLANT, "--sigma", "2", "--n-o", "1", "--color=always", "--periods", "1"])
        .assert()
        .success();
}
