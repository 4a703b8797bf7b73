//! `sigmastar simulate` and `reproduce` from the command line.

use crate::support::{self, EXAMPLE_TEXT, PLANT, PLANT_TEXT, every, process, sigmastar, utf8};
use predicates::prelude::*;
use serde_json::Value;

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
    output.stdout(predicate::str::contains("sup|e| = 0.01768").and(predicate::str::contains("0.006466")));
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
