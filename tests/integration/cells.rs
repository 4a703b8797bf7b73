//! Families whose box of parameters is cut into cells: certified where one tube is too wide, checked, tried, and decided again.

use super::support::{
    certified_by, checked, decided_again, every, in_one_line, number, plant, program, read, stored, told,
};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// `x' = -a x - x^3/20 + e/5 + 2 + sin(2 pi t)` with a in these: the mean of the orbit is about 2/a.
pub(super) fn family([low, high]: [&str; 2]) -> Value {
    let mut plant = plant(&["x"], &["-a*x - x^3/20 + e/5 + 2 + sin(2*pi*t)"], "x + sin(2*pi*t)");
    plant["parameters"] = json!({ "a": { "nominal": "2", "low": low, "high": high } });
    plant
}

fn certified(folder: &Path, plant: &Value, threads: &str) -> (PathBuf, Value) {
    let mut program = program();
    program.env("RAYON_NUM_THREADS", threads);
    certified_by(program, folder, plant, &["--no-alternatives"])
}

/// The whole report on a plant by its certificate, in one line.
fn in_words(folder: &Path, plant: &Value, certificate: &Path) -> String {
    let plant = stored(folder, "in-words.json", plant);
    let mut call = program();
    call.args(["certify", "--no-alternatives", "--full", "--witness"]).arg(certificate).arg(plant);
    in_one_line(&told(&mut call).1)
}

/// The box is cut, the same on any number of threads; every number counts in every cell, for both programs.
#[test]
#[ignore = "search tier"]
fn a_wide_family_is_certified_in_cells() {
    let temporary = TempDir::new().unwrap();
    let folder = temporary.path();
    // A night takes one with twice as many cells.
    let [ends, within, beyond] = match every(2) {
        1 => [["1.4", "2.6"], ["1.5", "2.1"], ["1.3", "2.6"]],
        _ => [["1.7", "2.3"], ["1.75", "2.1"], ["1.6", "2.3"]],
    };
    let plant = family(ends);
    let (file, report) = certified(folder, &plant, "1");
    let certificate = read(&file);
    let cells = certificate["witness"]["cells"].as_array().expect("cells").clone();
    assert!(cells.len() > 1 && cells.len() <= 64, "{}", cells.len());
    assert_eq!(report["plant"]["cells"], cells.len());
    assert!(report["plant"]["cells_because"].as_str().is_some_and(|why| why.contains("affine in the parameters")));
    assert!(certificate["witness"]["orbit"].is_null() && certificate["witness"]["forcing"].is_null());
    assert_eq!(checked(&file)["verdict"], "valid");
    let again = |plant: &Value, certificate: &Path| decided_again(folder, plant, certificate).1["verdict"].clone();
    assert_eq!(again(&plant, &file), "certified");
    // For part of the box too, and not beyond it.
    let other = |ends: [&str; 2]| again(&family(ends), &file);
    assert_eq!(other(within), "certified");
    assert_ne!(other(beyond), "certified");
    // What the claim says of members is not broken by simulations, at the ends and inside.
    let tried = program().args(["falsify", "--quiet", "--trials", "6"]).arg(&file).output().unwrap();
    assert_eq!(tried.status.code(), Some(0), "{}", String::from_utf8_lossy(&tried.stderr));

    let forged = |name: &str, change: &dyn Fn(&mut Vec<Value>)| {
        let mut forged = certificate.clone();
        change(forged["witness"]["cells"].as_array_mut().unwrap());
        let file = stored(folder, name, &forged);
        [again(&plant, &file) == "certified", checked(&file)["verdict"] == "valid"]
    };
    let none = [false; 2];
    for left_out in (0..cells.len()).step_by(every(3)) {
        assert_eq!(forged("left.json", &|cells| drop(cells.remove(left_out))), none, "{left_out}");
    }
    assert_eq!(forged("twice.json", &|cells| cells.push(cells[0].clone())), [true; 2]);
    let swapped = |cells: &mut Vec<Value>| {
        let (first, second) = (cells[0]["orbit"].clone(), cells[1]["orbit"].clone());
        (cells[0]["orbit"], cells[1]["orbit"]) = (second, first);
    };
    assert_eq!(forged("swapped.json", &swapped), none);
    assert_eq!(forged("many.json", &|cells| cells.resize(65, cells[0].clone())), none);
    // A forcing and a radius of the other cell, and an orbit beside the cells.
    let taken = |cells: &mut Vec<Value>| cells[0]["forcing"] = cells[1]["forcing"].clone();
    assert_eq!(forged("taken.json", &taken), none);
    let last = cells.len() - 1;
    assert_eq!(forged("small.json", &|cells| cells[last]["orbit"]["defect"] = "1e-9".into()), none);
    let mut both = certificate.clone();
    both["witness"]["orbit"] = cells[0]["orbit"].clone();
    assert_ne!(again(&plant, &stored(folder, "both.json", &both)), "certified");

    let (file, _) = certified(folder, &plant, "3");
    assert_eq!(read(&file), certificate);
}

/// What a report says of all cells is true of each: the tube is the smallest, within which every member has one orbit.
#[test]
#[ignore = "search tier"]
fn what_is_said_of_all_cells_is_true_of_each() {
    let temporary = TempDir::new().unwrap();
    let folder = temporary.path();
    let mut plant = plant(&["x"], &["-a*x - x^3/2 + e + 2*sin(2*pi*t) + 1"], "x*a + e/4 + cos(2*pi*t)");
    plant["parameters"] = json!({ "a": { "nominal": "1", "low": "4/5", "high": "3/2" } });
    plant["initial_set"] = json!({ "kind": "at-rest", "E0": "1" });
    let (file, report) = certified(folder, &plant, "2");
    let certificate = read(&file);
    let cells = certificate["witness"]["cells"].as_array().expect("cells");
    let ends = |size: &str| {
        let sizes = cells.iter().map(|cell| number(&cell["orbit"][size]));
        [sizes.clone().fold(f64::INFINITY, f64::min), sizes.fold(0.0, f64::max)]
    };
    let [tubes, radii, defects] = ["tube", "radius", "defect"].map(ends);
    assert!([tubes, radii, defects].iter().all(|[least, most]| least < most), "{tubes:?} {radii:?} {defects:?}");
    let said = ["tube", "radius", "defect"].map(|size| number(&report["plant"]["orbit"][size]));
    assert_eq!(said, [tubes[0], radii[1], defects[1]]);
    let text = in_words(folder, &plant, &file);
    for words in [
        "follows it, in each of the cells below, as an affine function",
        &format!("cut into {} cells, which may overlap. ", cells.len()),
        "(defect at most ",
        &format!(", tube at least {})", tubes[0]),
        "about the xb of the nominal member in the first cell that has it",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
}

/// No more cells than are needed, and none for a box with a member at a corner that is not stable.
#[test]
fn cells_only_where_they_help() {
    let temporary = TempDir::new().unwrap();
    let folder = temporary.path();
    let (file, report) = certified(folder, &family(["1.95", "2.05"]), "2");
    assert_eq!(report["plant"]["cells"], 1);
    assert_eq!(report["plant"]["cells_because"], Value::Null);
    assert!(read(&file)["witness"]["cells"].is_null());
    let text = in_words(folder, &family(["1.95", "2.05"]), &file);
    assert!(text.contains("follows it as an affine function") && text.contains(", tube "), "{text}");
    assert!(!text.contains("cell") && !text.contains("at least") && !text.contains("defect at most"), "{text}");
    let mut unstable = family(["-1", "3"]);
    unstable["f"][0] = "-a*x + e/5 + 2 + sin(2*pi*t)".into();
    let unstable = stored(folder, "unstable.json", &unstable);
    let refused = program().args(["certify", "--quiet"]).arg(&unstable).output().unwrap();
    assert_eq!(refused.status.code(), Some(3), "{}", String::from_utf8_lossy(&refused.stdout));
}
