//! What is proved by the number of oscillators can be asked for: a limit of the steady error, the peak or the control is kept at the smallest gain at which
//! the table shows that it is, and where none does it is told with what is proved.

use super::support::{assert_valid, certified_in, in_one_line, number, program, read, stored, utf8};
use serde_json::{Value, json};
use std::path::Path;

/// `v' = -v + e + cos(phase)`, with two harmonics in q; period 2.
fn plant() -> Value {
    json!({
        "format": "sigmastar/plant", "version": 1, "name": "limited", "period": 2, "states": ["v"],
        "f": ["-v + e + cos(phase)"], "q": "v/2 + e/2 + sin(phase) + sin(6*phase)/2",
        "initial_set": { "kind": "aligned", "X0": "1/2", "E0": "1/2" },
        "internal_model": {
            "mu": 1, "base_frequency": "pi", "matched": true, "weights": { "family": "power", "n0": 2, "epsilon": "1/2" },
        },
    })
}

const AT_SAMPLES: &[&str] = &["--sampling-period", "1/100"];

/// The gain of a report, of either regulator.
fn gain(report: &Value) -> f64 {
    number(report.get("sigma_star").filter(|gain| !gain.is_null()).unwrap_or(&report["sigma"]))
}

/// The steady error, the peak and the control of an entry.
fn bounds(entry: &Value) -> [f64; 3] {
    let control = &entry["control"];
    let control = number(&control["steady"]) + number(&control["transient"]);
    [number(&entry["steady_error"]), number(&entry["peak_error"]), control]
}

const FLAGS: [&str; 3] = ["--steady-error", "--peak-error", "--max-control"];

/// A limit that is just above a bound, as it is written.
fn above(bound: f64) -> String {
    format!("{:.6}", 1.001 * bound + 1e-6)
}

/// What a call says in its report, and its exit code.
fn said(folder: &Path, flags: &[&str]) -> (i32, String) {
    let file = stored(folder, "plant.json", &plant());
    let output = program().arg("certify").arg(file).args(flags).arg("-q").output().unwrap();
    (output.status.code().unwrap(), in_one_line(&utf8(output.stdout)))
}

#[test]
fn what_the_table_shows_can_be_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    for samples in [&[][..], AT_SAMPLES] {
        let with = |flags: &[&str]| certified_in(folder.path(), &plant(), &[samples, flags].concat()).1;
        let table = with(&[]);
        let entries: Vec<[f64; 3]> = table["by_n_o"].as_array().unwrap().iter().map(bounds).collect();
        for (i, flag) in FLAGS.into_iter().enumerate() {
            let largest = entries.iter().map(|entry| entry[i]).fold(0.0, f64::max);
            let report = with(&[flag, &above(largest)]);
            assert!((gain(&report) / gain(&table) - 1.0).abs() < 1e-3, "{flag}: {} {}", gain(&report), gain(&table));
            // With one oscillator less needs a larger gain.
            assert!(entries[1][i] < 0.98 * largest, "{flag}");
            let report = with(&[flag, &above(entries[1][i]), "--n-o", "1"]);
            assert!((gain(&report) / gain(&table) - 1.0).abs() < 1e-3, "{flag}: {} {}", gain(&report), gain(&table));
            let name = ["steady_error", "peak_error", "control"][i];
            assert_eq!(report["limits"][name]["n_o"], json!([1]), "{flag}");
        }
    }
}

#[test]
fn what_cannot_be_kept_is_told_with_what_is_proved() {
    let folder = tempfile::tempdir().unwrap();
    let (_, table) = certified_in(folder.path(), &plant(), &[]);
    let [_, _, control] = bounds(table["by_n_o"].as_array().unwrap().last().unwrap());
    let (code, text) = said(folder.path(), &["--max-control", "1"]);
    assert_eq!(code, 3, "{text}");
    let least = text.split("the least for which a proof is found is ").nth(1).expect("what is proved");
    let least: f64 = least.split(',').next().unwrap().parse().unwrap();
    assert!(least > 1.0 && least <= 1.001 * control, "{least} {control}");
    assert!(text.contains("|u| in the transient is not proved to be at most 1;"), "{text}");
    // Along the periodic solution u is larger than that, from whatever set.
    assert!(!text.contains("the limit is kept"), "{text}");
    let (code, text) = said(folder.path(), &["--max-control", "1", "--sampling-period", "1/100"]);
    assert!(code == 3 && !text.contains("the limit is kept"), "{text}");
    // A limit below the start is told as that.
    let (code, text) = said(folder.path(), &["--peak-error", "1/4"]);
    assert!(code == 3 && text.contains("0.5"), "{text}");
}

#[test]
fn several_limits_are_kept_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let peak = ["--peak-error", "1", "--n-o", "1"];
    let (file, report) = certified_in(folder.path(), &plant(), &peak);
    assert_valid(&file);
    let entry = &read(&file)["claim"]["by_n_o"][1];
    assert!(number(&entry["largest"]["e"]) <= 1.0, "{entry}");
    let most = number(&entry["largest"]["u"]);
    // It is the smallest gain that is found: the peak is hardly below its limit.
    assert!(number(&entry["largest"]["e"]) > 0.95, "{entry}");

    let both = |share: f64| {
        let control = format!("{:.6}", share * most);
        said(folder.path(), &[&peak[..], &["--max-control", &control]].concat())
    };
    let (code, text) = both(1.01);
    assert_eq!(code, 0, "{text}");
    let sentence = format!("At sigma = {},", report["sigma_star"].as_str().unwrap());
    assert!(text.contains(&sentence) && text.contains("in the transient with n_o = 1, |u| <= "), "{text}");
    // The control grows with the gain, and the peak falls.
    let (code, text) = both(0.9);
    assert!(code == 3 && text.contains("not proved to be at most"), "{text}");
}

#[test]
fn a_gain_that_is_given_keeps_to_what_its_table_shows() {
    let folder = tempfile::tempdir().unwrap();
    let (_, table) = certified_in(folder.path(), &plant(), &["--sigma", "2"]);
    let entries: Vec<[f64; 3]> = table["by_n_o"].as_array().unwrap().iter().map(bounds).collect();
    let largest = entries.iter().map(|entry| entry[1]).fold(0.0, f64::max);
    let with =
        |limit: &str, more: &[&str]| said(folder.path(), &[&["--sigma", "2", "--peak-error", limit], more].concat());
    assert_eq!(with(&above(largest), &[]).0, 0);
    assert_eq!(with(&above(0.99 * largest), &[]).0, 3);
    assert_eq!(with(&above(entries[1][1]), &["--n-o", "1"]).0, 0);
    assert_eq!(with(&above(0.99 * entries[1][1]), &["--n-o", "1"]).0, 3);
}

/// The claim rests on norms then, from which rates are proved.
#[test]
fn rates_at_samples_do_not_take_the_table_away() {
    let folder = tempfile::tempdir().unwrap();
    let (file, report) = certified_in(folder.path(), &plant(), &[AT_SAMPLES, &["--n-o", "6"]].concat());
    assert_valid(&file);
    let certificate = read(&file);
    assert_eq!(certificate["claim"]["for_n_o"][0]["n_o"], 6);
    let last = certificate["claim"]["by_n_o"].as_array().unwrap().last().unwrap().clone();
    assert!(last["n_o"] == 6 && last["or_more"] == true && number(&last["steady"]["e"]) < 1e-3, "{last}");
    assert!(!report["gains"].as_array().unwrap().is_empty());
}

/// The claim is about every set of harmonics, and bounds by their number are not.
#[test]
fn of_other_sets_of_harmonics_nothing_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let (code, text) = said(folder.path(), &["--peak-error", "5/2"]);
    assert_eq!(code, 0, "{text}");
    for words in [
        "for oscillators at every set of harmonics with 0",
        "in the transient with every n_o.",
        "(all at this gain; |e| and |u| with every n_o)",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
}
