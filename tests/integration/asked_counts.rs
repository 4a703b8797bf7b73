//! Numbers of oscillators that are asked for with `--n-o`: bounds for these too, in the table, the report as JSON and the certificate.

use super::support::{assert_valid, certified_in, number, program, read, stored, utf8};
use serde_json::{Value, json};

/// `v' = -v + e + cos(phase)`, and q linear in v and e with these waves, where it is; period 2.
fn plant(name: &str, q: &str) -> Value {
    json!({
        "format": "sigmastar/plant", "version": 1, "name": name, "period": 2, "states": ["v"],
        "f": ["-v + e + cos(phase)"], "q": q,
        "initial_set": { "kind": "aligned", "X0": "1/2", "E0": "1/2" },
        "internal_model": {
            "mu": 1, "base_frequency": "pi", "matched": true, "weights": { "family": "power", "n0": 2, "epsilon": "1/2" },
        },
    })
}

fn bent() -> Value {
    // Harmonic k of the last part is 0.54^k or so: no number of oscillators soon leaves nothing.
    plant("bent", "v/2 - atan(e) + 1/(12/5 - 2*cos(phase))")
}

fn straight() -> Value {
    plant("straight", "v/2 + e/2 + sin(phase) + sin(6*phase)/2")
}

/// The first column of the table in the short report.
fn rows(document: &Value, flags: &[&str]) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    let file = stored(folder.path(), "plant.json", document);
    let output = program().arg("certify").arg(file).args(flags).arg("-q").output().unwrap();
    let report = utf8(output.stdout);
    let table = report.lines().skip_while(|line| !line.contains("n_o  steady |e|")).skip(2);
    table
        .map_while(|line| line.trim_start().split("  ").next().filter(|name| !name.is_empty()).map(str::to_owned))
        .collect()
}

#[test]
fn what_is_asked_for_has_entries_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let (file, report) = certified_in(folder.path(), &bent(), &["--n-o", "7,2,64"]);
    assert_valid(&file);
    let certificate = read(&file);
    let entries = certificate["claim"]["by_n_o"].as_array().unwrap();
    let of =
        |list: &Value| list.as_array().unwrap().iter().map(|entry| entry["n_o"].as_u64().unwrap()).collect::<Vec<_>>();
    assert_eq!(of(&certificate["claim"]["by_n_o"]), [0, 1, 2, 3, 5, 7, 10, 20]);
    assert_eq!(of(&report["by_n_o"]), [0, 1, 2, 3, 5, 7, 10, 20]);
    assert_eq!(of(&certificate["claim"]["for_n_o"]), [2, 7, 64]);
    // The last one is about 64 as well.
    assert_eq!(entries[7]["or_more"], true, "{}", entries[7]);
    assert!(number(&entries[7]["steady"]["e"]) < 1e-3 * number(&entries[0]["steady"]["e"]), "{}", entries[7]);
    let sentence = certificate["claim"]["statement"].as_str().unwrap();
    assert!(
        sentence.contains("With n_o = 7 and sigma = ") && sentence.contains("With every n_o >= 20 and sigma = "),
        "{sentence}"
    );
    assert_eq!(rows(&bent(), &["--n-o", "7,2,64"]), ["0", "1", "2", "3", "5", "7", "10", "20 or more"]);
    // Those that are not asked for are what they are without.
    let (_, without) = certified_in(folder.path(), &bent(), &[]);
    assert_eq!(without["by_n_o"][4], report["by_n_o"][4]);
    assert_eq!(of(&without["by_n_o"]), [0, 1, 2, 3, 5, 10, 20]);

    // A certificate that is decided again has them too.
    let again = sigmastar::reread("certificate", certificate.to_string().as_bytes()).unwrap();
    let again: Value = serde_json::from_str(again.to_json()).unwrap();
    assert_eq!(again["claim"], certificate["claim"]);
    assert_eq!(again["witness"]["by_n_o"], certificate["witness"]["by_n_o"]);
}

#[test]
fn of_a_linear_plant_the_table_shows_what_is_asked_for() {
    assert_eq!(rows(&straight(), &[]), ["0", "1", "2", "3", "5", "6 or more"]);
    // The last row is about 20 as well.
    assert_eq!(rows(&straight(), &["--n-o", "4,20"]), ["0", "1", "2", "3", "4", "5", "6 or more"]);
}
