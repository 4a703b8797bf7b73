//! `sigmastar controller`: the exported forms agree with each other, with the formulas and with the Rust stepper.

use crate::support::{ROOT, json, process, program, specification, utf8};
use assert_cmd::Command;
use ndarray::{Array1, Array2};
use predicates::prelude::*;
use sigmastar::regulator::{Design, Stepper};
use sigmastar::spec::{Constant, Document, Errors, Specification, positive_constant};
use std::path::{Path, PathBuf};
use std::process::Command as Process;

fn controller(arguments: &[&str]) -> Command {
    let mut command = program();
    command.arg("controller").args(arguments);
    command
}

fn example() -> Specification {
    specification("paper-example")
}

fn constant(text: &str) -> Constant {
    let document = Document::parse("test", &format!("{{\"value\": \"{text}\"}}")).unwrap();
    let mut errors = Errors::new();
    let value = positive_constant(&document.at("/value").unwrap(), &mut errors);
    errors.conclude(&document, value).unwrap()
}

/// Whether a program answers; the tests that need it say when it does not.
fn installed(program: &str, arguments: &[&str]) -> bool {
    let found = Process::new(program).args(arguments).output().is_ok_and(|output| output.status.success());
    if !found {
        println!("skipped: `{program} {}` does not run here", arguments.join(" "));
    }
    found
}

/// e^(A) by scaling and a Taylor series.
fn exponential(matrix: &Array2<f64>) -> Array2<f64> {
    let scaled = matrix / 1024.0;
    let mut term = Array2::eye(matrix.nrows());
    let mut sum = term.clone();
    for k in 1..20 {
        term = term.dot(&scaled) / f64::from(k);
        sum += &term;
    }
    (0..10).fold(sum, |power, _| power.dot(&power))
}

#[test]
fn the_discretisation_is_the_exponential_of_the_matrices() {
    let spec = example();
    for (sigma, n_o, step) in [("48", 3_u32, "1/1000"), ("2", 5, "0.3"), ("1/10", 0, "2")] {
        let design = Design::new(&spec.internal_model, &constant(sigma), n_o);
        let (regulator, discrete) = (design.regulator(), design.discretise(&constant(step)));
        let n = regulator.dimension();
        // e^([[Phi, Gamma], [0, 0]] dt) = [[Phi_d, Gamma_d], [0, 1]].
        let mut joined = Array2::zeros((n + 1, n + 1));
        joined.slice_mut(ndarray::s![..n, ..n]).assign(&regulator.phi());
        joined.slice_mut(ndarray::s![..n, n]).assign(&Array1::from(regulator.gamma()));
        let exact = exponential(&(joined * discrete.step));
        let transition = discrete.transition();
        for row in 0..n {
            for column in 0..n {
                assert!((exact[(row, column)] - transition[(row, column)]).abs() < 1e-12, "{sigma} {row} {column}");
            }
            assert!((exact[(row, n)] - discrete.input[row]).abs() < 1e-12, "{sigma} {row}");
        }
    }
}

#[test]
fn small_sampling_times_lose_no_digits() {
    // 1 - cos(a) with a = 2 pi 1e-9 would be 0 in double precision.
    let design = Design::new(&example().internal_model, &constant("1e-12"), 1).discretise(&constant("1e-9"));
    let angle = std::f64::consts::TAU * 1e-9;
    let expected = angle * angle / 2.0 - 1e-12 * 1e-9;
    assert!((design.input[1] / expected - 1.0).abs() < 1e-12, "{}", design.input[1]);
}

fn signal(k: u32) -> f64 {
    let k = f64::from(k);
    (0.37 * k).sin() + 0.2 * (1.9 * k + 0.1).cos() - 1e-3 * k.sqrt()
}

/// Runs the exported C code over the signal and returns the bits of every output.
fn run_c(folder: &Path, n_o: u32, steps: u32) -> Vec<u64> {
    let source = folder.join("regulator.c");
    let n_o_text = n_o.to_string();
    let arguments = ["specs/paper-example.json", "--sigma", "97/2", "--n-o", &n_o_text, "--discretise", "1/500"];
    controller(&arguments).args(["--format", "c", "-o"]).arg(&source).assert().success().stdout("").stderr("");
    let inputs: Vec<String> = (0..steps).map(|k| format!("0x{:016x}ULL", signal(k).to_bits())).collect();
    let main = format!(
        "#include \"regulator.h\"\n#include <stdio.h>\n#include <string.h>\n\
         static const unsigned long long inputs[] = {{ {} }};\n\
         int main(void) {{ sigmastar_controller c; unsigned i; sigmastar_reset(&c);\n\
         for (i = 0; i < {steps}; i++) {{ double e, u; unsigned long long bits; memcpy(&e, &inputs[i], 8);\n\
         u = sigmastar_step(&c, e); memcpy(&bits, &u, 8); printf(\"%llx\\n\", bits); }} return 0; }}\n",
        inputs.join(", ")
    );
    let (main_file, program): (PathBuf, PathBuf) = (folder.join("main.c"), folder.join("main"));
    std::fs::write(&main_file, main).unwrap();
    let gcc = Process::new("gcc")
        .args(["-std=c99", "-O2", "-Wall", "-Wextra", "-pedantic", "-Werror", "-o"])
        .args([&program, &source, &main_file])
        .output()
        .unwrap();
    assert!(gcc.status.success(), "{}", String::from_utf8_lossy(&gcc.stderr));
    let output = Process::new(&program).output().unwrap();
    let text = utf8(output.stdout);
    text.lines().map(|line| u64::from_str_radix(line, 16).unwrap()).collect()
}

#[test]
fn c_code_agrees_with_the_stepper_bit_for_bit() {
    if !installed("gcc", &["--version"]) {
        return;
    }
    let spec = example();
    for n_o in [0, 1, 7, 50] {
        let folder = tempfile::tempdir().unwrap();
        let outputs = run_c(folder.path(), n_o, 3000);
        let design = Design::new(&spec.internal_model, &constant("97/2"), n_o);
        let mut stepper = Stepper::new(design.regulator(), design.discretise(&constant("1/500")));
        let expected: Vec<u64> = (0..3000).map(|k| stepper.step(signal(k)).to_bits()).collect();
        assert_eq!(outputs, expected, "n_o = {n_o}");
    }
}

#[test]
fn numpy_and_scipy_read_the_archive() {
    if !installed("python3", &["-c", "import numpy, scipy.linalg"]) {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("regulator.npz");
    let arguments = ["specs/paper-example.json", "--sigma", "5", "--n-o", "3", "--discretise", "1/10"];
    controller(&arguments).args(["--format", "npz", "-o"]).arg(&file).assert().success();
    let script = "import sys, numpy as np, scipy.linalg as la\n\
        d = np.load(sys.argv[1])\n\
        n = d['Phi'].shape[0]\n\
        assert n == 7 and d['sigma'] == 5 and d['step'] == 0.1\n\
        assert np.array_equal(d['Gamma'], -(d['Phi'] + d['sigma']*np.eye(n)) @ d['M'])\n\
        assert np.array_equal(np.diag(d['N'])[[0, 1, 3, 5]], d['weights'])\n\
        A = np.zeros((n + 1, n + 1)); A[:n, :n] = d['Phi']; A[:n, n] = d['Gamma']\n\
        E = la.expm(A*d['step'])\n\
        assert abs(E[:n, :n] - d['Phi_d']).max() < 1e-13 and abs(E[:n, n] - d['Gamma_d']).max() < 1e-13\n";
    let python = Process::new("python3").args(["-c", script]).arg(&file).output().unwrap();
    assert!(python.status.success(), "{}", String::from_utf8_lossy(&python.stderr));
}

#[test]
fn octave_runs_the_script() {
    if !installed("octave-cli", &["--version"]) {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("regulator.m");
    let arguments = ["specs/paper-example.json", "--sigma", "5", "--n-o", "3", "--discretise", "1/10"];
    controller(&arguments).args(["--format", "matlab", "-o"]).arg(&file).assert().success();
    let check = "regulator; n = rows(Phi); E = expm([Phi, Gamma; zeros(1, n + 1)]*step); \
                 assert(norm(E(1:n, 1:n) - Phi_d) < 1e-12); assert(norm(E(1:n, n + 1) - Gamma_d) < 1e-12);";
    let octave = Process::new("octave-cli").args(["--eval", check]).current_dir(folder.path()).output().unwrap();
    assert!(octave.status.success(), "{}", String::from_utf8_lossy(&octave.stderr));
}

/// The script is made of a few forms of assignment: they are read here, so that the numbers are checked everywhere.
#[test]
fn the_script_and_the_json_hold_the_same_numbers() {
    let arguments = ["specs/explicit-weights.json", "--sigma", "5", "--n-o", "3", "--discretise", "1/10"];
    let output = controller(&arguments).assert().success().get_output().stdout.clone();
    let report = json(&output);
    let output = controller(&arguments).args(["--format", "matlab"]).assert().success().get_output().stdout.clone();
    let script = utf8(output);
    let list = |name: &str| -> Vec<f64> {
        let line = script.lines().find_map(|line| line.strip_prefix(&format!("{name} = ["))).unwrap();
        line.trim_end_matches(['\'', ';', ']']).split(", ").map(|entry| entry.parse().unwrap()).collect()
    };
    let numbers = |value: &serde_json::Value| -> Vec<f64> {
        value.as_array().unwrap().iter().map(|entry| entry.as_f64().unwrap()).collect()
    };
    assert_eq!(list("weights"), numbers(&report["weights"]));
    assert_eq!(list("frequencies"), numbers(&report["frequencies"]));
    assert_eq!(list("Gamma_d"), numbers(&report["discrete"]["Gamma"]));
    let row = numbers(&report["discrete"]["Phi"][1]);
    let line = script.lines().find(|line| line.starts_with("Phi_d(2:3, 2:3)")).unwrap();
    assert!(line.contains(&format!("[{:?}, {:?};", row[1], row[2])), "{line}");
    assert_eq!(report["Phi"][6][5].as_f64(), Some(-numbers(&report["frequencies"])[2]));
}

/// A regulator that the sampling ruins: the law as it is exported, checked against eigenvalues by hand in Rust's tests.
#[test]
fn every_export_says_what_the_sampling_does() {
    let folder = tempfile::tempdir().unwrap();
    let spec = "specs/paper-example.json";
    for (n_o, verdict) in [("1", "stable"), ("3", "unstable")] {
        let call = [spec, "--sigma", "2", "--n-o", n_o, "--discretise", "1/10"];
        let assert = controller(&call).assert().success();
        let output = assert.get_output();
        let report = json(&output.stdout);
        let sampled = &report["discrete"]["sampled_loop"];
        let radius = sampled["spectral_radius"].as_f64().unwrap();
        assert_eq!((sampled["verdict"].as_str().unwrap(), radius >= 1.0), (verdict, verdict == "unstable"), "{radius}");
        let said = String::from_utf8_lossy(&output.stderr).contains("is unstable: spectral radius");
        assert_eq!(said, verdict == "unstable");
        let words = format!("is {verdict}: spectral radius {radius}");
        let matlab = controller(&call).args(["--format", "matlab"]).assert().success();
        assert!(String::from_utf8_lossy(&matlab.get_output().stdout).contains(&words), "{words}");
        let source = folder.path().join("regulator.c");
        controller(&call).args(["--format", "c", "-o"]).arg(&source).assert().success();
        assert!(std::fs::read_to_string(source.with_extension("h")).unwrap().contains(&words), "{words}");
        let archive = folder.path().join("regulator.npz");
        controller(&call).args(["--format", "npz", "-o"]).arg(&archive).assert().success();
        let mut archive = ndarray_npy::NpzReader::new(std::fs::File::open(archive).unwrap()).unwrap();
        let read: ndarray::Array0<f64> = archive.by_name("spectral_radius").unwrap();
        let unstable: ndarray::Array0<bool> = archive.by_name("unstable").unwrap();
        assert_eq!((read.into_scalar(), unstable.into_scalar()), (radius, verdict == "unstable"));
    }
}

#[test]
fn sampling_that_cannot_work_is_refused() {
    let spec = "specs/paper-example.json";
    for (sigma, n_o, step, message) in [
        ("58", "1", "1/10", "h sigma = 5.8"),
        ("20", "0", "1/10", "h sigma = 2.0"),
        ("2", "5", "1/10", "oscillator 5 turns by 0.5"),
        ("2", "9", "1/10", "at most 4 oscillators"),
    ] {
        let assert = controller(&[spec, "--sigma", sigma, "--n-o", n_o, "--discretise", step]).assert();
        assert
            .code(2)
            .stdout("")
            .stderr(predicate::str::contains(message).and(predicate::str::contains("sampling time")));
    }
    // Between 1 and 2 it is said.
    let assert = controller(&[spec, "--sigma", "15", "--n-o", "0", "--discretise", "1/10"]).assert();
    assert.success().stderr(predicate::str::contains("1.500: above 1"));
    controller(&[spec, "--sigma", "5", "--n-o", "0", "--discretise", "1/10"]).assert().success().stderr("");
}

#[test]
fn a_gain_below_the_certificate_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("certificate.json");
    program().args(["certify", "specs/linear.json", "--no-compare", "-q", "-o"]).arg(&file).assert().success();
    let call = |spec: &str, sigma: &str| {
        let assert = controller(&[spec, "--sigma", sigma, "--n-o", "1", "--certificate"]).arg(&file).assert().success();
        utf8(assert.get_output().stderr.clone())
    };
    assert!(call("specs/linear.json", "13/10").contains("sigma = 1.3 is below sigma* = 1.32"));
    assert_eq!(call("specs/linear.json", "3/2"), "");
    assert!(call("specs/no-x.json", "3/2").contains("another specification"));
}

#[cfg(unix)]
#[test]
fn the_header_stays_where_the_source_cannot_be_written() {
    let folder = tempfile::tempdir().unwrap();
    let source = folder.path().join("regulator.c");
    let call = |n_o: &str| {
        let mut shell = Process::new("bash");
        // Files of at most 16 KiB: the header fits, the source of 200 oscillators does not, as on a disk that is full.
        let script = "trap '' XFSZ; ulimit -f 16; exec \"$@\"";
        shell.args(["-c", script, "bash"]).arg(process().get_program()).current_dir(ROOT);
        shell.args([
            "controller",
            "specs/paper-example.json",
            "--sigma",
            "2",
            "--discretise",
            "1/1000",
            "--format",
            "c",
        ]);
        shell.args(["--n-o", n_o, "-o"]).arg(&source).output().unwrap()
    };
    let read = || ["c", "h"].map(|extension| std::fs::read_to_string(source.with_extension(extension)).unwrap());
    assert!(call("1").status.success());
    let before = read();
    let failed = call("200");
    let told = String::from_utf8_lossy(&failed.stderr).into_owned();
    assert_eq!(failed.status.code(), Some(2), "{told}");
    assert!(told.contains("none of the files that belong together was changed"), "{told}");
    assert_eq!(read(), before);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
}

#[test]
fn a_source_does_not_compile_with_the_header_of_another() {
    if !installed("gcc", &["--version"]) {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let source = folder.path().join("regulator.c");
    let write = |sigma: &str| {
        let call =
            ["specs/linear.json", "--sigma", sigma, "--n-o", "1", "--discretise", "1/100", "--format", "c", "-o"];
        controller(&call).arg(&source).assert().success();
    };
    let compiles = || {
        let gcc = Process::new("gcc")
            .args(["-std=c99", "-Wall", "-pedantic", "-Werror", "-fsyntax-only"])
            .arg(&source)
            .output();
        gcc.unwrap().status.success()
    };
    write("2");
    assert!(compiles());
    let old = std::fs::read(&source).unwrap();
    write("3");
    assert!(compiles());
    std::fs::write(&source, old).unwrap();
    assert!(!compiles());
}

#[test]
fn the_same_call_gives_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str| {
        let file = folder.path().join(name);
        let arguments = ["specs/linear.json", "--sigma", "2", "--n-o", "4", "--format", "npz", "-o"];
        controller(&arguments).arg(&file).assert().success();
        std::fs::read(file).unwrap()
    };
    assert_eq!(write("a.npz"), write("b.npz"));
}

#[test]
fn wrong_calls_are_refused() {
    let spec = "specs/linear.json";
    for (arguments, message) in [
        (&[spec, "--sigma", "0", "--n-o", "1"][..], "must be positive"),
        (&[spec, "--sigma", "2+", "--n-o", "1"], "ends where more is needed"),
        (&[spec, "--sigma", "1e400", "--n-o", "1"], "beyond double precision"),
        (&[spec, "--sigma", "1e-400", "--n-o", "1"], "beyond double precision"),
        (&[spec, "--sigma", "NaN", "--n-o", "1"], "`NaN` is not a known name"),
        (&[spec, "--sigma", "1/0", "--n-o", "1"], "no value that can be enclosed"),
        (&[spec, "--sigma", "2", "--n-o", "1", "--discretise", "1e-400"], "beyond double precision"),
        (&[spec, "--sigma", "2", "--n-o", "1001"], "1001 is not in"),
        (&[spec, "--sigma", "2", "--n-o", "1", "--format", "npz"], "name a file with -o"),
        (&[spec, "--sigma", "2", "--n-o", "1", "--format", "c", "-o", "/tmp/x.c"], "--discretise"),
        (&[spec, "--sigma", "2", "--n-o", "1", "--discretise", "1", "--format", "c"], "ending in `.c`"),
        (&[spec, "--sigma", "2", "--n-o", "1", "--discretise", "-1"], "must be positive"),
        (&["specs/nothing.json", "--sigma", "2", "--n-o", "1"], "there is no such file"),
    ] {
        controller(arguments).assert().code(2).stdout("").stderr(predicate::str::contains(message));
    }
}
