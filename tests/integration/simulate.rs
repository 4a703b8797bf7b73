//! `sigmastar simulate`, `reproduce` and `falsify` from the command line.

use crate::support::{self, EXAMPLE_TEXT, PLANT, PLANT_TEXT, every, process, program, specification_text, utf8};
use assert_cmd::Command;
use predicates::prelude::*;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

fn sigmastar(arguments: &[&str]) -> Command {
    let mut command = program();
    command.args(arguments);
    command
}

fn json(arguments: &[&str]) -> Value {
    let output = sigmastar(arguments).assert().success().stderr("").get_output().stdout.clone();
    support::json(&output)
}

#[test]
fn a_simulation_reports_writes_samples_and_draws() {
    let folder = tempfile::tempdir().unwrap();
    let (csv, plots) = (folder.path().join("run.csv"), folder.path().join("figures"));
    let arguments = ["simulate", PLANT, "--sigma", "2", "--n-o", "2", "--periods", "3", "--samples", "50"];
    let output = sigmastar(&arguments).arg("--csv").arg(&csv).arg("--plots").arg(&plots).assert().success();
    output.stdout(predicate::str::contains("sup|e| = 0.01768").and(predicate::str::contains("6.466e-3")));
    let text = std::fs::read_to_string(csv).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], "t,x1,x2,e,u,z0,z1c,z1s,z2c,z2s");
    assert_eq!(lines.len(), 1 + 1 + 3 * 50);
    assert!(lines[1].starts_with("0.0,1.0,-2.0,4.0,") && lines[151].starts_with("3.0,"), "{} {}", lines[1], lines[151]);
    for name in ["response.svg", "states.svg", "control.svg", "spectrum.svg", "bode.svg"] {
        let svg = std::fs::read_to_string(plots.join(name)).unwrap();
        assert!(svg.starts_with("<svg") && svg.matches("<polyline").count() >= 1, "{name}");
    }
}

#[test]
fn an_exported_regulator_gives_the_same_simulation() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("controller.json");
    let arguments =
        ["controller", "specs/paper-example.json", "--sigma", "2", "--n-o", "3", "--discretise", "1/10", "-o"];
    sigmastar(&arguments).arg(&file).assert().success();
    let short = ["--periods", "2", "--format", "json"];
    let direct = json(&[&["simulate", PLANT, "--sigma", "2", "--n-o", "3"][..], &short].concat());
    let read = json(&[&["simulate", PLANT, "--controller", file.to_str().unwrap()][..], &short].concat());
    assert_eq!(direct, read);
    assert_eq!(direct["steady_state"]["multipliers"].as_array().unwrap().len(), 10);
    // The high-gain feedback has no file; the error says what to use.
    let empty =
        r#"{"format": "sigmastar/controller", "version": 1, "sigma": 2, "mu": 1, "frequencies": [], "weights": []}"#;
    std::fs::write(&file, empty).unwrap();
    sigmastar(&["simulate", PLANT, "--controller"])
        .arg(&file)
        .assert()
        .code(2)
        .stderr(predicate::str::contains("--high-gain --sigma"));
    let high_gain = json(&["simulate", PLANT, "--sigma", "2", "--high-gain", "--periods", "2", "--format", "json"]);
    assert!((high_gain["steady_state"]["sup_e"].as_f64().unwrap() - 1.2555).abs() < 1e-4);
}

#[test]
fn the_two_methods_and_the_seeds() {
    let base = ["simulate", PLANT, "--sigma", "5", "--n-o", "1", "--periods", "4", "--format", "json"];
    let adaptive = json(&base);
    let fixed = json(&[&base[..], &["--fixed", "1000"]].concat());
    // Settled: the last period that changes by more than 1e-6 is the one before.
    let long = json(&["simulate", PLANT, "--sigma", "5", "--n-o", "0", "--periods", "40", "--format", "json"]);
    let settled = long["long_run"]["settled_period"].as_u64().unwrap() as usize;
    let change = |period: usize| long["long_run"]["return_distances"][period - 1].as_f64().unwrap();
    assert!(change(settled - 1) > 1e-6 && change(settled) < 1e-5, "{settled}");
    let at = |value: &Value| value["long_run"]["rms_e_last_period"].as_f64().unwrap();
    assert!((at(&adaptive) / at(&fixed) - 1.0).abs() < 1e-6);
    let noisy = |seed: &str, more: &[&str]| {
        json(&[&base[..], &["--noise-power", "1e-3", "--noise-steps", "1000", "--seed", seed], more].concat())["noisy_run"]
            .clone()
    };
    let first = noisy("1", &[]);
    assert_eq!(first, noisy("1", &[]));
    assert_ne!(first, noisy("2", &[]));
    assert_ne!(first["rms_e"], noisy("1", &["--noise-everywhere"])["rms_e"]);
    // 4000 normal samples of variance 1: the largest is between 3 and 6.
    let largest = first["sup_v"].as_f64().unwrap();
    assert!((3.0..6.0).contains(&largest), "{largest}");
}

/// The last period of the paper's plant from its initial condition, with large gains, and no flag to say how. The references
/// are by an implicit method (Radau IIA of order 5 of SciPy, in the variable sigma e, relative tolerance 1e-12, where its
/// digits shown here no longer change).
#[test]
fn stiff_loops_agree_with_an_implicit_reference() {
    let base = ["simulate", PLANT, "--n-o", "2", "--periods", "3", "--format", "json", "-q"];
    let run = |sigma: &str, more: &[&str]| {
        let output = sigmastar(&[&base[..], &["--sigma", sigma], more].concat()).output().unwrap();
        let report = support::json(&output.stdout);
        (output.status.code().unwrap(), report)
    };
    let run_figure = |report: &Value, name: &str| report["long_run"][name].as_f64().unwrap();
    for (sigma, sup, rms) in [
        ("100", 1.224549010834e-2, 7.382340555311e-3),
        ("1000", 1.231655404781e-3, 7.413283918171e-4),
        ("10000", 1.231568013179e-4, 7.414205881211e-5),
        ("100000", 1.231546146856e-5, 7.414274672205e-6),
        ("1000000", 1.231543830060e-6, 7.414281316036e-7),
        ("10000000", 1.231543597080e-7, 7.414281978066e-8),
    ]
    .into_iter()
    .step_by(every(2))
    {
        let (code, report) = run(sigma, &[]);
        let found = [run_figure(&report, "sup_e_last_period"), run_figure(&report, "rms_e_last_period")];
        let off = [found[0] / sup - 1.0, found[1] / rms - 1.0];
        assert!(code == 0 && off.iter().all(|off| off.abs() < 1e-7), "{sigma}: {off:?} {report}");
        // The steady error is u/sigma with the same u for all of them, to within 1/sigma.
        let steady = &report["steady_state"];
        let scaled = steady["sup_e"].as_f64().unwrap() * sigma.parse::<f64>().unwrap();
        assert!((scaled / 0.3681900 - 1.0).abs() < 3.0 / sigma.parse::<f64>().unwrap() + 1e-6, "{sigma}: {scaled}");
        assert!((steady["multipliers"][0].as_f64().unwrap() - 0.8477926).abs() < 1e-6, "{sigma}: {steady}");
        assert!(steady["multipliers_uncertainty"].as_f64().unwrap() < 1e-8);
    }
    // A fixed step beyond the stability of its method is told, and not what came out of it; what it names is enough.
    let (code, report) = run("100000", &["--fixed", "20000"]);
    let error = report["long_run"]["error"].as_str().unwrap();
    assert!(code == 3 && error.contains("20000 steps per period are too few"), "{report}");
    let help = report["long_run"]["help"].as_str().unwrap();
    let steps = help.strip_prefix("--fixed ").unwrap().split(' ').next().unwrap();
    let (code, report) = run("100000", &["--fixed", steps]);
    assert!(code == 0 && (run_figure(&report, "sup_e_last_period") / 1.231546146856e-5 - 1.0).abs() < 1e-5, "{report}");
}

/// A steady state beyond any number of fixed steps: that of the high-gain limit e = q/sigma.
#[test]
fn a_stiff_loop_has_a_steady_state() {
    let call = ["simulate", "specs/plants/linear.json", "--high-gain", "--sigma", "100000000", "--periods", "1", "-q"];
    let report = json(&[&call[..], &["--format", "json", "--samples", "10"]].concat());
    let steady = &report["steady_state"];
    let sup = steady["sup_e"].as_f64().unwrap();
    // q = 1 + tanh(3 sin(2 pi t)), and e = q/sigma to within q'/sigma^2; u = -q.
    let q = 1.0 + 3.0_f64.tanh();
    assert!((sup / (1e-8 * q) - 1.0).abs() < 1e-6 && steady["method"] == "radau-13", "{report}");
    assert!((steady["sup_u"].as_f64().unwrap() / q - 1.0).abs() < 1e-6, "{report}");
    let energy = |k: i32| {
        let t = f64::from(k) / 1000.0;
        (1.0 + (3.0 * (std::f64::consts::TAU * t).sin()).tanh()).powi(2) / 1000.0
    };
    let energy: f64 = (0..1000).map(energy).sum();
    assert!((steady["energy_u"].as_f64().unwrap() / energy - 1.0).abs() < 1e-6, "{report}");
}

#[test]
fn noise_with_too_few_steps_is_told() {
    let call = ["simulate", PLANT, "--sigma", "300", "--n-o", "1", "--periods", "2", "--noise-power", "1e-3"];
    let assert = sigmastar(&call).args(["--noise-steps", "100"]).assert().code(3);
    assert.stdout(
        predicate::str::contains("100 steps per period are too few").and(predicate::str::contains("--noise-steps")),
    );
}

#[test]
fn remarks_and_failures_follow_the_flags() {
    let raised =
        ["simulate", PLANT, "--sigma", "2", "--n-o", "0", "--periods", "1", "--fixed", "50", "--samples", "80"];
    let assert = sigmastar(&raised).args(["--format", "json"]).assert().success();
    let output = assert.get_output();
    assert!(String::from_utf8_lossy(&output.stderr).contains("--fixed 50 is raised to 80 steps per period"));
    let report = support::json(&output.stdout);
    let method = &report["long_run"]["method"];
    assert_eq!((method["asked"].as_u64(), method["steps_per_period"].as_u64()), (Some(50), Some(80)), "{method}");
    sigmastar(&raised).arg("--quiet").assert().success().stderr("");
    // Failures are JSON under --format json, in both commands, and --quiet leaves nothing beside it.
    for command in [&["simulate", "-", "--sigma", "2", "--n-o", "1"][..], &["falsify", "-"]] {
        for (text, code) in [("{", "syntax"), ("{\"format\": 1}", "")] {
            let assert =
                sigmastar(command).args(["--format", "json", "-q"]).write_stdin(text).assert().code(2).stderr("");
            let report = support::json(&assert.get_output().stdout);
            let error = &report["errors"][0];
            assert!(report["verdict"] == "bad-input" && error["message"].is_string(), "{code}: {report}");
        }
        let assert = sigmastar(command).write_stdin("{").assert().code(2).stdout("");
        assert.stderr(predicate::str::contains("bad-input: nothing was written"));
    }
    // Markdown has the same blocks as the text.
    let markdown = [&raised[..], &["--quiet", "--format", "markdown"]].concat();
    let starts = predicate::str::starts_with("# Example of the paper: simulation\n\nFloating point, no claim.");
    sigmastar(&markdown).assert().success().stdout(starts.and(predicate::str::contains("| k | \\|c_k\\| of e |")));
    // A file that is not there is a call.
    for command in [&["simulate", "nothing.json", "--sigma", "2", "--n-o", "1"][..], &["falsify", "nothing.json"]] {
        let assert = sigmastar(command).args(["--format", "json", "-q"]).assert().code(2).stderr("");
        let report = support::json(&assert.get_output().stdout);
        assert_eq!(report["errors"][0]["code"], "call");
    }
}

#[test]
fn a_regulator_of_another_base_frequency_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let spec = folder.path().join("spec.json");
    let detuned =
        EXAMPLE_TEXT.replacen("\"2*pi\"", "\"19*pi/10\"", 1).replacen("\"matched\": true", "\"matched\": false", 1);
    assert_ne!(detuned, EXAMPLE_TEXT);
    std::fs::write(&spec, detuned).unwrap();
    let other = folder.path().join("other.json");
    let call = |spec: &str| {
        sigmastar(&["controller", spec, "--sigma", "2", "--n-o", "1", "--force", "-o"]).arg(&other).assert().success();
        let run = sigmastar(&["simulate", PLANT, "--periods", "1", "--controller"]).arg(&other).assert().success();
        utf8(run.get_output().stderr.clone())
    };
    assert!(call(spec.to_str().unwrap()).contains("is 5.969"));
    assert_eq!(call("specs/paper-example.json"), "");
}

/// An interruption while a large file is written: it is not there, and no temporary file either.
#[cfg(unix)]
#[test]
fn an_interrupted_run_leaves_nothing_behind() {
    let folder = tempfile::tempdir().unwrap();
    let csv = folder.path().join("samples.csv");
    let mut interrupted = false;
    // The file may be complete before the signal comes; then there is another try.
    for _ in 0..10 {
        let mut child = process()
            .args(["simulate", "specs/plants/linear.json", "--sigma", "2", "--high-gain", "--periods", "10", "-q"])
            .args(["--samples", "100000", "--fixed", "100000", "--csv"])
            .arg(&csv)
            .stdout(std::process::Stdio::null())
            .spawn()
            .unwrap();
        let names = || -> Vec<String> {
            let entries = std::fs::read_dir(folder.path()).unwrap();
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
        };
        while child.try_wait().unwrap().is_none() {
            if !interrupted && names().iter().any(|name| name.starts_with(".sigmastar-")) {
                let sent = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
                assert!(sent.is_ok());
                break;
            }
        }
        interrupted = child.wait().unwrap().code() == Some(130);
        let names = names();
        assert!(names.iter().all(|name| !name.starts_with(".sigmastar-")), "{names:?}");
        if interrupted {
            assert_eq!(names, Vec::<String>::new());
            break;
        }
        let _ = std::fs::remove_file(&csv);
    }
    assert!(interrupted);
}

#[test]
fn wrong_plants_and_calls_are_refused() {
    for (old, new, message) in [
        ("sin(x2)/10", "sin(x3)/10", "`x3` is not a known name"),
        ("\"x2\"]", "\"e\"]", "another meaning"),
        ("\"x2\"]", "\"x1\"]", "has the name of another state"),
        ("\"x2\"]", "\"x2\", \"x3\"]", "2 right sides for 3 states"),
        ("[\"1\", \"-2\"]", "[\"1\"]", "1 initial values for 2 states"),
        ("+ sin(2*pi*t)\"", "+ sin(3*t)\"", "not periodic in t with the stated period"),
        ("\"period\": \"1\"", "\"period\": \"2\"", "asserts base_frequency = 2 pi / period"),
        ("\"q\":", "\"Q\":", "did you mean `q`?"),
        ("\"e\": \"4\"", "\"e\": \"1e400\"", "beyond double precision"),
        ("sigmastar/plant", "sigmastar/bounding-spec", "this is a file of format"),
        ("\"e\": \"4\"", "\"e\": \"4\", \"z\": [1, 2]", "the initial z of the plant file has 2 components"),
    ] {
        assert!(PLANT_TEXT.contains(old), "{old}");
        let arguments = ["simulate", "-", "--sigma", "2", "--n-o", "1"];
        let assert = sigmastar(&arguments).write_stdin(PLANT_TEXT.replacen(old, new, 1)).assert();
        assert.code(2).stdout("").stderr(predicate::str::contains(message));
    }
    sigmastar(&["simulate", PLANT, "--n-o", "1"]).assert().code(2);
    sigmastar(&["simulate", PLANT, "--sigma", "2"]).assert().code(2);
    sigmastar(&["simulate", PLANT, "--sigma", "0", "--n-o", "1"]).assert().code(2);
    // Without a steady state nothing is claimed either way.
    let unstable = PLANT_TEXT.replacen("- x2 + x2^2/10", "+ x2 + x2^2/10", 1);
    let arguments = ["simulate", "-", "--sigma", "2", "--n-o", "0"];
    let assert = sigmastar(&arguments).write_stdin(unstable).assert().code(3);
    assert.stdout(predicate::str::contains("None was found: the solution escapes"));
}

#[test]
fn the_tables_of_the_paper_are_reproduced() {
    let folder = tempfile::tempdir().unwrap();
    sigmastar(&["reproduce", "--only", "table1,table2,figures", "-o"])
        .arg(folder.path())
        .assert()
        .success()
        .stdout(predicate::str::contains("| 1 | 4 | 2 | 3.04e-8 | 3.0395e-8 | 0 | 1.66e-8 | 1.6610e-8 | 0 | 0.940 |"));
    // The page has the figures in it, each for wide windows and for narrow ones.
    let page = std::fs::read_to_string(folder.path().join("report.html")).unwrap();
    assert!(page.starts_with("<!DOCTYPE html>") && page.matches("<svg ").count() == 2 * 5, "{page}");
    let report: Value = serde_json::from_slice(&std::fs::read(folder.path().join("report.json")).unwrap()).unwrap();
    let rows = report["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 5 + 2 * 14);
    let mut exact = 0;
    for row in rows {
        let units = |column: &str| row["without_noise"][column]["units_of_last_place"].as_f64().unwrap().abs();
        let (sup, rms) = (units("sup"), units("rms"));
        if row["n_0"] == 2.0 {
            continue;
        }
        // Every noise-free entry, to its printed digits.
        assert!(sup <= 1.0 && rms <= 1.0, "{row}");
        exact += i32::from(sup == 0.0) + i32::from(rms == 0.0);
        if let (Some(n_o), "1") = (row["n_o"].as_u64(), row["base_frequency_ratio"].as_str().unwrap()) {
            let amplitudes = row["amplitudes"].as_array().unwrap();
            assert!(amplitudes[..=n_o as usize].iter().all(|amplitude| amplitude.as_f64().unwrap() < 1e-9));
            assert!(amplitudes[n_o as usize + 1].as_f64().unwrap() > 1e-9);
        }
    }
    assert_eq!(exact, 38);
    let figures = report["figures"].as_array().unwrap();
    assert_eq!(figures.len(), 5);
    for figure in figures {
        let svg = std::fs::read_to_string(folder.path().join(figure.as_str().unwrap())).unwrap();
        assert!(svg.contains("<polyline"), "{figure}");
    }
}

#[test]
fn the_columns_with_noise_are_ranges_over_seeds() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["reproduce", "--only", "noise", "--seeds", "1", "--noise-steps", "1000", "-o"];
    sigmastar(&arguments).arg(folder.path()).assert().success();
    let report: Value = serde_json::from_slice(&std::fs::read(folder.path().join("report.json")).unwrap()).unwrap();
    // E22: the stated noise is larger than stated.
    assert!((45.0..65.0).contains(&report["largest_noise"][0].as_f64().unwrap()));
    for row in report["rows"].as_array().unwrap() {
        let laws = row["with_noise"].as_array().unwrap();
        assert_eq!(laws.len(), if row["table"] == 1 { 1 } else { 2 }, "{row}");
        for law in laws {
            let [low, high] = [0, 1].map(|end| law["rms"]["range"][end].as_f64().unwrap());
            let printed: f64 = law["rms"]["printed"].as_str().unwrap().parse().unwrap();
            // The order of magnitude; nothing is tuned.
            assert!(low < high && low < printed && printed < 3.0 * high, "{row}");
        }
    }
    assert!(report["rows"][0]["without_noise"].is_null());
}

/// The certificate that the program writes for a shipped specification, made once.
fn certificate(name: &str) -> Value {
    static MADE: Mutex<BTreeMap<String, Value>> = Mutex::new(BTreeMap::new());
    let mut made = MADE.lock().unwrap_or_else(PoisonError::into_inner);
    let make = || {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("certificate.json");
        let call = ["certify", &format!("specs/{name}.json"), "--no-compare", "-q", "-o"];
        sigmastar(&call).arg(&file).assert().success();
        support::json(&std::fs::read(file).unwrap())
    };
    made.entry(name.to_owned()).or_insert_with(make).clone()
}

/// Runs `falsify` on a certificate and returns the exit code, the report and the counterexample, if one was written.
fn falsify(certificate: &Value, folder: &Path, trials: &str, more: &[&str]) -> (i32, Value, Option<String>) {
    let file = folder.join("tried.json");
    let counterexample = folder.join("counterexample.json");
    std::fs::write(&file, certificate.to_string()).unwrap();
    let _ = std::fs::remove_file(&counterexample);
    let mut command = sigmastar(&["falsify", "--trials", trials, "--format", "json", "--quiet", "-o"]);
    let output = command.arg(&counterexample).arg(&file).args(more).output().unwrap();
    let report = support::json(&output.stdout);
    (output.status.code().unwrap(), report, std::fs::read_to_string(counterexample).ok())
}

#[test]
fn shipped_certificates_withstand_the_trials() {
    for name in ["paper-example", "linear", "no-x", "paper-example-jacobian"] {
        let folder = tempfile::tempdir().unwrap();
        let (code, report, counterexample) = falsify(&certificate(name), folder.path(), "4", &[]);
        assert_eq!((code, counterexample), (0, None), "{name}: {report}");
        let trials = report["trials"].as_array().unwrap();
        assert!(trials.len() == 4 && trials.iter().all(|trial| trial["finding"] == "holds"), "{name}: {report}");
    }
}

/// Only F = -20 has the rate 20 within |f| <= 20 X: no other plant fits.
fn tight() -> Value {
    let mut spec: Value = serde_json::from_str(&specification_text("linear")).unwrap();
    spec["lyapunov"] = serde_json::json!({ "p_low": "1", "p_up": "1", "alpha": "20" });
    for (field, text) in [("f", "20*X + 2000*E"), ("f_e", "2000"), ("q", "1 + X/1000 + E/4"), ("q_x", "1/1000")] {
        spec["bounds"][field] = Value::String(text.to_owned());
    }
    spec
}

fn certified(spec: &Value, folder: &Path) -> Value {
    let (file, certificate) = (folder.join("spec.json"), folder.join("certificate.json"));
    std::fs::write(&file, spec.to_string()).unwrap();
    let mut command = sigmastar(&["certify", "--no-compare", "-q", "-o"]);
    command.arg(&certificate).arg(&file).assert().success();
    serde_json::from_slice(&std::fs::read(certificate).unwrap()).unwrap()
}

#[test]
fn a_tight_f_leaves_its_linear_member() {
    let folder = tempfile::tempdir().unwrap();
    let mut certificate = certified(&tight(), folder.path());
    let (code, report, _) = falsify(&certificate, folder.path(), "3", &[]);
    let trials = report["trials"].as_array().unwrap();
    assert!(code == 0 && trials.iter().all(|trial| trial["finding"] == "holds"), "{report}");
    // What it is, from a claim that is false.
    certificate["claim"]["periodic_solution"]["z"] = Value::String("1/1000".to_owned());
    let (code, report, counterexample) = falsify(&certificate, folder.path(), "1", &[]);
    assert_eq!(code, 1, "{report}");
    let plant: Value = serde_json::from_str(&counterexample.unwrap()).unwrap();
    let (f, q) = (plant["f"][0].as_str().unwrap(), plant["q"].as_str().unwrap());
    assert!(f.starts_with("(-(20))*x1 + e*1*((2000.0)"), "{f}");
    assert!(q.contains("(0.25)*1*e") && q.contains("((0.001)"), "{q}");
}

/// Loops at gains of millions are simulated too.
#[test]
fn stiff_trials_come_to_their_end() {
    let folder = tempfile::tempdir().unwrap();
    let mut spec: Value = serde_json::from_str(&specification_text("linear")).unwrap();
    spec["bounds"]["f"] = Value::String("20*X + 2e6*E".to_owned());
    spec["bounds"]["f_e"] = Value::String("2e6".to_owned());
    let (code, report, counterexample) = falsify(&certified(&spec, folder.path()), folder.path(), "2", &[]);
    assert_eq!((code, counterexample), (0, None), "{report}");
    let trials = report["trials"].as_array().unwrap();
    assert!(trials.iter().all(|trial| trial["finding"] == "holds"), "{report}");
}

#[test]
fn other_base_frequencies_are_certified_and_tried() {
    let folder = tempfile::tempdir().unwrap();
    let more = ["--base-frequency", "19*pi/10,2*pi"];
    let (code, report, _) = falsify(&certificate("no-x"), folder.path(), "3", &more);
    assert_eq!(code, 0, "{report}");
    let others = report["other_base_frequencies"].as_array().unwrap();
    assert_eq!(others.len(), 2);
    for other in others {
        let shares = other["trials"][0]["shares"].as_array().unwrap();
        let by_n_o = shares.iter().find(|share| share["quantity"] == "rms(e) against its bound for this n_o");
        assert!(by_n_o.is_some_and(|share| share["share"].as_f64().unwrap() < 1.0), "{other}");
    }
    assert!(others[0]["sigma_star"].as_f64().unwrap() > others[1]["sigma_star"].as_f64().unwrap());
    for (frequencies, message) in [("0", "must be positive"), ("2*pi,", "is empty"), ("pi+", "more is needed")] {
        let file = folder.path().join("tried.json");
        let arguments = ["falsify", "--base-frequency", frequencies];
        sigmastar(&arguments).arg(&file).assert().code(2).stdout("").stderr(predicate::str::contains(message));
    }
}

/// The simulation that the description of a counterexample names.
fn simulated_again(counterexample: &str, more: &[&str]) -> Value {
    let plant: Value = serde_json::from_str(counterexample).unwrap();
    let description = plant["description"].as_str().unwrap();
    let words: Vec<&str> = description.split_whitespace().collect();
    let after = |flag: &str| words[words.iter().position(|word| *word == flag).unwrap() + 1].trim_end_matches('.');
    let arguments = ["simulate", "-", "--sigma", after("--sigma"), "--n-o", after("--n-o"), "--format", "json", "-q"];
    let output = sigmastar(&arguments).args(more).write_stdin(counterexample).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{counterexample}");
    support::json(&output.stdout)
}

#[test]
fn false_certificates_are_refuted_with_a_counterexample() {
    for (name, pointer, value, quantity) in [
        // A gain that is far too small, and nothing else wrong: sigma*/50 and less.
        ("paper-example", "/claim/sigma_star", "9/10", "|e - e_p| on the way, against D_e"),
        ("no-x", "/claim/sigma_star", "1/230", "|e - e_p| on the way, against D_e"),
        ("linear", "/claim/sigma_star", "1/50", "Lyapunov function on the way, against its start"),
        // A periodic solution far smaller than it is.
        ("no-x", "/witness/E_p", "0.002", "sup|e| of the periodic solution"),
        ("no-x", "/claim/periodic_solution/zeta", "1/10", "sup|zeta|_N of the periodic solution"),
        ("no-x", "/claim/periodic_solution/z", "1/10", "sup|z|_N of the periodic solution"),
        // An initial set that the error box does not hold.
        ("linear", "/claim/initial_set/X0", "99", "against D_x"),
        // An error box that solutions leave.
        ("no-x", "/witness/D_e", "1/100", "against D_e"),
    ]
    .into_iter()
    .step_by(every(3))
    {
        let folder = tempfile::tempdir().unwrap();
        let mut altered = certificate(name);
        *altered.pointer_mut(pointer).unwrap() = Value::String(value.to_owned());
        let (code, report, counterexample) = falsify(&altered, folder.path(), "8", &[]);
        assert_eq!(code, 1, "{pointer}: {report}");
        assert_eq!(report["refuted"], true);
        let counterexample = counterexample.expect(pointer);
        assert!(counterexample.contains(quantity), "{pointer}: {counterexample}");
        let again = simulated_again(&counterexample, &["--periods", "2"]);
        let steady = again["steady_state"]["sup_e"].as_f64().unwrap();
        assert!(pointer != "/witness/E_p" || steady > 0.002, "{again}");
    }
}

/// Optional data: no plant that they exclude is held against a certificate, and too small a gain is still found.
#[test]
fn certificates_with_optional_data_withstand_the_trials_and_false_ones_do_not() {
    for (name, too_small, quantity) in [
        ("motor-axis-friction", "200", "Lyapunov function on the way, against its start"),
        ("paper-example-harmonics-at-rest", "1/4", "Lyapunov function on the way, against its start"),
    ]
    .into_iter()
    .step_by(every(2))
    {
        let folder = tempfile::tempdir().unwrap();
        let mut certificate = certificate(name);
        let (code, report, counterexample) = falsify(&certificate, folder.path(), "12", &[]);
        let trials = report["trials"].as_array().unwrap();
        assert_eq!((code, counterexample), (0, None), "{name}: {report}");
        assert!(trials.iter().all(|trial| trial["finding"] == "holds"), "{name}: {report}");
        certificate["claim"]["sigma_star"] = Value::String(too_small.to_owned());
        let (code, report, counterexample) = falsify(&certificate, folder.path(), "20", &[]);
        assert_eq!(code, 1, "{name}: {report}");
        assert!(counterexample.unwrap().contains(quantity), "{name}: {report}");
    }
}

#[test]
fn a_fast_plant_breaks_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let (code, report, counterexample) = falsify(&certificate("motor-axis"), folder.path(), "20", &[]);
    assert_eq!((code, counterexample), (0, None), "{report}");
    assert!(report["trials"].as_array().unwrap().iter().all(|trial| trial["finding"] == "holds"), "{report}");
}

/// The worst plant is in the report, `--trial` writes the same, and its simulation is that of the trial.
#[test]
fn the_worst_plant_is_named_and_can_be_simulated_again() {
    let folder = tempfile::tempdir().unwrap();
    let certificate = certificate("linear");
    let (code, report, _) = falsify(&certificate, folder.path(), "6", &["--seed", "3"]);
    assert_eq!(code, 0, "{report}");
    let worst = &report["worst"];
    let number = worst["trial"].as_u64().unwrap();
    let trials = report["trials"].as_array().unwrap();
    for closest in report["closest"].as_array().unwrap() {
        let share = |trial: &Value| {
            let shares = trial["shares"].as_array().unwrap();
            shares.iter().find(|share| share["quantity"] == closest["quantity"]).unwrap()["share"].as_f64().unwrap()
        };
        let largest = trials.iter().map(share).fold(0.0, f64::max);
        assert_eq!(share(&trials[closest["trial"].as_u64().unwrap() as usize - 1]), largest);
        assert_eq!(closest["share"], largest);
        let general = ["largest Floquet multiplier", "Lyapunov function on the way, against its start"];
        assert!(general.iter().any(|name| closest["quantity"] == *name) || worst["share"].as_f64().unwrap() >= largest);
    }
    let (tried, plant) = (folder.path().join("tried.json"), folder.path().join("plant.json"));
    let mut command = sigmastar(&["falsify", "--seed", "3", "--trial", &number.to_string(), "-o"]);
    let output = command.arg(&plant).arg(&tried).output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    let (text, remark) = (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap());
    assert!(text.contains(&format!("Trial {number}, sigma = ")) && text.contains("The worst plant"), "{text}");
    assert!(remark.contains("the plant is in"), "{remark}");
    let written = std::fs::read_to_string(plant).unwrap();
    assert_eq!(support::json(written.as_bytes()), worst["plant"]);
    let again = simulated_again(&written, &["--periods", "2"]);
    let bound: f64 = certificate["claim"]["periodic_solution"]["e"].as_str().unwrap().parse().unwrap();
    let by_trial = trials[number as usize - 1]["shares"].as_array().unwrap();
    let of = by_trial.iter().find(|share| share["quantity"] == "sup|e| of the periodic solution").unwrap();
    let [again, then] = [again["steady_state"]["sup_e"].as_f64().unwrap() / bound, of["share"].as_f64().unwrap()];
    assert!((again - then).abs() <= 1e-3 * then + 1e-9 && then <= 1.0, "{again} {then}");
    // Only one of these makes sense.
    let both = ["falsify", "--trial", "1", "--trials", "2"];
    sigmastar(&both).arg(&tried).assert().code(2).stdout("");
}

/// What the guide tells a user to do: the samples of a counterexample show the violation.
#[test]
fn a_counterexample_can_be_seen_in_its_samples() {
    let folder = tempfile::tempdir().unwrap();
    let mut altered = certificate("no-x");
    altered["claim"]["sigma_star"] = Value::String("1/230".to_owned());
    let radius: f64 = altered["witness"]["D_e"].as_str().unwrap().parse().unwrap();
    let (_, report, counterexample) = falsify(&altered, folder.path(), "8", &[]);
    let found = report["trials"].as_array().unwrap().iter().find(|trial| trial["finding"] == "violated").unwrap();
    let csv = folder.path().join("samples.csv");
    let again = simulated_again(
        &counterexample.unwrap(),
        &["--periods", "12", "--samples", "4096", "--csv", csv.to_str().unwrap()],
    );
    let text = std::fs::read_to_string(csv).unwrap();
    let e = text.lines().skip(1).map(|line| line.split(',').nth(1).unwrap().parse::<f64>().unwrap().abs());
    let largest = e.fold(0.0, f64::max);
    let periodic = again["steady_state"]["sup_e"].as_f64().unwrap();
    let distance = found["found"].as_f64().unwrap();
    assert!(
        radius < distance && (largest - distance).abs() <= periodic * 1.001 + 1e-12 * distance,
        "{largest} {distance} {periodic}"
    );
}

#[test]
fn a_triple_that_is_not_proved_draws_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let mut altered = certificate("paper-example-jacobian");
    altered["witness"]["lyapunov"]["alpha"] = Value::String("2".to_owned());
    let file = folder.path().join("altered.json");
    std::fs::write(&file, altered.to_string()).unwrap();
    let assert = sigmastar(&["falsify", "--trials", "1"]).arg(&file).assert();
    assert.code(2).stdout("").stderr(predicate::str::contains("this triple is not proved"));
}

#[test]
fn what_is_no_certificate_is_refused() {
    sigmastar(&["falsify", "specs/linear.json"])
        .assert()
        .code(2)
        .stdout("")
        .stderr(predicate::str::contains("this is a file of format `sigmastar/bounding-spec`"));
}
