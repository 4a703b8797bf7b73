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

#[test]
fn rows_of_larger_gains_are_about_what_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let of_rows = |flags: &[&str]| {
        let (_, report) = certified_in(folder.path(), &straight(), flags);
        let rows = report["gains"].as_array().unwrap().iter();
        let bound = |one: &Value| (one["n_o"].as_u64().unwrap(), number(&one["sup"]));
        rows.map(|row| row["steady_error"].as_array().unwrap().iter().map(bound).collect()).collect::<Vec<Vec<_>>>()
    };
    let asked = of_rows(&["--n-o", "6,1"]);
    assert_eq!(asked.len(), 6, "the gain of the claim and larger ones");
    for row in &asked {
        // The last harmonic is the sixth.
        let [(1, one), (6, six)] = row[..] else { panic!("{row:?}") };
        assert!(six < 1e-6 && one > 1e-3, "{row:?}");
    }
    let plain = of_rows(&[]);
    assert_eq!(plain.len(), 6);
    for row in plain {
        assert_eq!(row.iter().map(|(n_o, _)| *n_o).collect::<Vec<_>>(), [0, 10]);
    }
}

#[test]
fn targets_are_answered_by_the_smaller_bounds() {
    let folder = tempfile::tempdir().unwrap();
    let target = |flag: &str, value: &str| {
        let (_, report) = certified_in(folder.path(), &straight(), &[flag, value]);
        (report["consequences"]["targets"][0].clone(), report)
    };
    // Six oscillators meet all harmonics, which the bounds for every larger gain do not say.
    let (answer, report) = target("--target-sup", "1/1000");
    let first = |list: &Value, name: &str, most: f64| {
        let entries = list.as_array().unwrap().iter();
        entries.filter(|entry| number(&entry[name]) <= most).map(|entry| entry["n_o"].as_u64().unwrap()).next()
    };
    assert_eq!(first(&report["by_n_o"], "steady_error", 1e-3), Some(6));
    assert_eq!(answer["n_o"], 6, "{answer}");
    let larger = answer["n_o_at_larger_gains"].as_u64().unwrap();
    let of_all = first(&report["consequences"]["error_bounds"], "sup", 1e-3).unwrap();
    assert!(6 < larger && larger <= of_all, "{answer} {of_all}");
    let (answer, report) = target("--target-rms", "1/50");
    assert_eq!(first(&report["by_n_o"], "mean_square", 0.02), Some(1));
    assert!(answer["n_o"] == 1 && answer["n_o_at_larger_gains"] == 6, "{answer}");
    // Where these are as good the answer is about larger gains, too.
    let (answer, _) = target("--target-sup", "1/10");
    assert!(answer["n_o"] == 1 && answer.get("n_o_at_larger_gains").is_none(), "{answer}");

    let file = stored(folder.path(), "plant.json", &straight());
    let output = program().arg("certify").arg(file).args(["--target-sup", "1/1000", "-q"]).output().unwrap();
    let report = utf8(output.stdout).split_whitespace().collect::<Vec<_>>().join(" ");
    let said = format!(
        "certified with n_o = 6 oscillators at this gain alone, the least for these bounds; with {larger} at every larger gain, too"
    );
    assert!(report.contains(&said), "{report}");
}

#[test]
fn a_steady_error_with_some_oscillators_needs_a_smaller_gain() {
    let folder = tempfile::tempdir().unwrap();
    let limit = ["--steady-error", "1/100"];
    let gain = |report: &Value| number(&report["sigma_star"]);
    let (_, for_every) = certified_in(folder.path(), &straight(), &limit);
    assert_eq!(for_every["limits"]["steady_error"].get("n_o"), None);
    let (file, report) = certified_in(folder.path(), &straight(), &[&limit[..], &["--n-o", "1"]].concat());
    assert_valid(&file);
    assert!(gain(&report) < 0.5 * gain(&for_every), "{} {}", report["sigma_star"], for_every["sigma_star"]);
    assert_eq!(report["limits"]["steady_error"]["n_o"], json!([1]));
    assert_eq!(report["given_gain"], false);
    // It is in the certificate, up to what the checker needs more.
    let certificate = read(&file);
    let entry = &certificate["claim"]["by_n_o"][1];
    let proved = number(&entry["steady"]["e"]);
    assert!(entry["n_o"] == 1 && proved > 0.008 && proved <= 0.01 * 1.0002, "{entry}");
    assert!(number(&certificate["claim"]["periodic_solution"]["e"]) > 0.01);

    // At that gain it is kept with these oscillators alone; at one far below with none.
    let sigma = report["sigma_star"].as_str().unwrap();
    let half = (gain(&report) / 2.0).to_string();
    let input = stored(folder.path(), "plant.json", &straight());
    for (sigma, counts, code) in [(sigma, &["--n-o", "1"][..], 0), (sigma, &[], 3), (&half, &["--n-o", "1"], 3)] {
        let output = program().arg("certify").arg(&input).args(limit).args(["--sigma", sigma]).args(counts).output();
        let output = output.unwrap();
        let said = utf8(output.stdout);
        assert_eq!(output.status.code(), Some(code), "{sigma} {counts:?} {said}");
        let words = said.split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(words.contains("along the periodic solution with n_o = 1."), code == 0, "{words}");
    }

    // Of a specification by the bounds for every larger gain.
    let limit = ["--steady-error", "1/200"];
    let motor: Value = serde_json::from_str(include_str!("../../specs/motor-axis.json")).unwrap();
    let (_, for_every) = certified_in(folder.path(), &motor, &limit);
    let (file, report) = certified_in(folder.path(), &motor, &[&limit[..], &["--n-o", "4"]].concat());
    assert_valid(&file);
    assert!(gain(&report) < 0.5 * gain(&for_every), "{} {}", report["sigma_star"], for_every["sigma_star"]);
    let with = |n_o: u64| {
        let all = report["consequences"]["error_bounds"].as_array().unwrap();
        number(&all.iter().find(|entry| entry["n_o"] == n_o).unwrap()["sup"])
    };
    assert!(with(4) <= 1.0 / 200.0 && with(0) > 1.0 / 200.0);
}

/// With a limit that no number of oscillators helps to keep the answer is that without them.
#[test]
fn a_steady_error_without_oscillators_is_not_worse() {
    let folder = tempfile::tempdir().unwrap();
    let motor: Value = serde_json::from_str(include_str!("../../specs/motor-axis.json")).unwrap();
    let limit = ["--steady-error", "1/20"];
    let (_, for_every) = certified_in(folder.path(), &motor, &limit);
    let (_, report) = certified_in(folder.path(), &motor, &[&limit[..], &["--n-o", "0"]].concat());
    assert!(number(&report["sigma_star"]) <= number(&for_every["sigma_star"]));
    assert!(number(&report["limits"]["steady_error"]["proved"]) <= 0.05);
}
