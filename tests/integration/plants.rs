//! Plants by their formulas: every file of `specs/plants` with its verdict, its certificate before the checker, and what
//! other commands make of it.

use crate::gallery;
use crate::support::{
    assert_valid, certified_in, checked, decided_again, document, every, files, json, made, number, plant, program,
    read, stem, stored,
};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// The certified ones, with the largest gain that is accepted.
const CERTIFIED: [(&str, f64); 12] = [
    ("chain", 2.4),
    ("converter", 1650.0),
    ("duffing", 0.52),
    ("linear", 1e-3),
    ("motor-axis", 20.0),
    ("paper-example", 6.2),
    ("paper-example-ball", 25.5),
    ("paper-example-paper-set", 10.8),
    ("paper-example-rotated", 6.2),
    ("pendulum", 0.73),
    ("relative-degree-2", 1.7),
    ("relative-degree-2-domain", 2.7),
];

/// Those that are refused, with the exit code and words of the message.
const REFUSED: [(&str, i32, &str); 6] = [
    ("corner", 3, "corner"),
    ("marginal", 3, "Floquet exponents"),
    ("not-periodic", 2, "`sin(t)`: the coefficient of t times the period is not a whole multiple of 2 pi"),
    ("root", 3, "has no value: the argument of sqrt is not positive"),
    ("time-outside", 2, "t stands outside of sin, cos, tan"),
    ("unstable", 3, "no certificate of this kind"),
];

/// The certificate of a plant, written into a folder, and its report.
fn reported(folder: &Path, name: &str) -> (PathBuf, Value) {
    let file = folder.join(format!("{name}.certificate.json"));
    let plant = format!("specs/plants/{name}.json");
    let (output, certificate) = made(&["certify", &plant, "--quiet", "--format", "json"]);
    let report = json(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{name}: {report:#}");
    assert_eq!(report["verdict"], "certified", "{name}");
    std::fs::write(&file, certificate).unwrap();
    (file, report)
}

/// The certificate with one number replaced.
fn altered(certificate: &Path, pointer: &str, value: &str) -> PathBuf {
    let mut document = read(certificate);
    *document.pointer_mut(pointer).unwrap_or_else(|| panic!("{pointer}")) = value.into();
    stored(certificate.parent().unwrap(), "altered.json", &document)
}

#[test]
fn every_plant_is_listed() {
    let names = |folder: &str| files(folder).iter().map(|path| stem(path).to_owned()).collect::<BTreeSet<_>>();
    assert_eq!(names("specs/plants"), BTreeSet::from(CERTIFIED.map(|(name, _)| name.to_owned())));
    assert_eq!(names("specs/plants/invalid"), BTreeSet::from(REFUSED.map(|(name, ..)| name.to_owned())));
}

/// The gain of a plant. The certificate is decided by the checker, which has no line in common with what made it, and shows the conditions
/// that are decided; the documents say of the plant what its report says.
fn certified_and_checked(name: &str, most: f64) -> f64 {
    let folder = TempDir::new().unwrap();
    let (certificate, report) = reported(folder.path(), name);
    let sigma = number(&report["sigma_star"]);
    assert!(sigma <= most, "{name}: {sigma}");
    gallery::compare(name, &report);
    assert_valid(&certificate);
    sigma
}

/// The gain does not depend on the units and the axes in which a plant is written.
#[test]
#[ignore = "search tier"]
fn a_shipped_plant_is_certified_and_checked_in_any_axes() {
    let most = BTreeMap::from(CERTIFIED);
    let [plain, rotated] =
        ["paper-example", "paper-example-rotated"].map(|name| certified_and_checked(name, most[name]));
    assert!((rotated / plain - 1.0).abs() < 0.03, "{}", rotated / plain);
}

#[test]
#[ignore = "search tier"]
fn the_shipped_plants_are_certified_and_checked() {
    for (name, most) in CERTIFIED {
        certified_and_checked(name, most);
    }
}

#[test]
fn plants_that_have_no_certificate_are_told_why() {
    for (name, code, words) in REFUSED {
        let plant = format!("specs/plants/invalid/{name}.json");
        let output = program().args(["certify", &plant, "--quiet"]).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{name}: {said}");
        assert!(said.contains(words), "{name}: {said}");
        assert!(output.stdout.is_empty(), "{name}");
    }
}

/// `--witness` proves the data of a certificate again; numbers that are too good are not proved.
#[test]
fn the_witness_of_a_plant_is_decided_again() {
    let folder = TempDir::new().unwrap();
    let (certificate, _) = reported(folder.path(), "motor-axis");
    let plant = document("plants/motor-axis");
    let again = |certificate: &Path| decided_again(folder.path(), &plant, certificate);
    assert_eq!(again(&certificate).0, Some(0));
    for (pointer, value) in [
        ("/witness/orbit/defect", "1e-40"),
        ("/witness/orbit/radius", "1"),
        ("/witness/lyapunov/alpha", "201"),
        ("/witness/forcing/rest", "1e-30"),
        ("/witness/bounds/1/value", "201"),
        ("/witness/bounds/4/value", "50"),
        ("/claim/sigma_star", "15"),
    ] {
        let (code, report) = again(&altered(&certificate, pointer, value));
        assert!(code != Some(0), "{pointer}: {report:#}");
        assert_ne!(report["verdict"], "certified", "{pointer}");
        let answer = checked(&altered(&certificate, pointer, value));
        assert_ne!(answer["verdict"], "valid", "{pointer}: {answer:#}");
    }
}

/// The plant itself, from the boundary of its set, at the gain and above it.
#[test]
fn a_plants_own_simulation_does_not_contradict_its_certificate() {
    let folder = TempDir::new().unwrap();
    let (certificate, of_claim) = reported(folder.path(), "pendulum");
    let falsify = |certificate: &Path| {
        let call = ["falsify", "--trials", "6", "--format", "json", "--quiet"];
        let output = program().args(call).arg(certificate).output().unwrap();
        (output.status.code(), json(&output.stdout))
    };
    let (code, report) = falsify(&certificate);
    assert_eq!(code, Some(0), "{report:#}");
    let held = |trial: &Value| trial["finding"] == "holds";
    assert!(
        report["trials"].as_array().is_some_and(|trials| trials.len() == 6 && trials.iter().all(held)),
        "{report:#}"
    );
    assert_eq!(report["worst"]["plant"]["states"], serde_json::json!(["theta", "omega"]));
    // A set that is larger than the error box is contradicted.
    let (code, _) = falsify(&altered(&certificate, "/claim/initial_set/X0", "30"));
    assert_eq!(code, Some(1), "sigma = {}", of_claim["sigma_star"]);
}

/// The triple and the regulator of a plant.
#[test]
fn other_commands_take_plants() {
    let plant = "specs/plants/motor-axis.json";
    let output = program().args(["lyapunov", plant, "--format", "json"]).output().unwrap();
    let report = json(&output.stdout);
    assert_eq!((output.status.code(), report["verdict"].as_str()), (Some(0), Some("certified")));
    // x' = -200 x + ...: no P has a larger rate.
    let alpha = number(&report["alpha"]);
    assert!(alpha <= 200.0 && alpha > 198.0, "{alpha}");
    assert_eq!(report["floquet_exponents_not_certified"], serde_json::json!([["-200", "0"]]));
    let output = program().args(["lyapunov", "specs/plants/invalid/unstable.json"]).output().unwrap();
    assert_eq!(output.status.code(), Some(3));
    let output = program().args(["controller", plant, "--sigma", "30", "--n-o", "2"]).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(json(&output.stdout)["format"], "sigmastar/controller");
}

/// The ball of the claim is not below an irrational one that was asked for, and the checker agrees.
#[test]
fn irrational_balls_are_covered() {
    let folder = TempDir::new().unwrap();
    let mut plant = plant(&["x", "y"], &["-x + e", "x - 2*y"], "y + sin(2*pi*t)");
    plant["initial_set"] = serde_json::json!({ "kind": "at-rest", "ball": "sqrt(2)/10" });
    let (certificate, _) = certified_in(folder.path(), &plant, &[]);
    assert_eq!(read(&certificate)["claim"]["initial_set"]["ball"], "0.141421356238");
    assert_eq!(checked(&certificate)["verdict"], "valid");
    assert_ne!(checked(&altered(&certificate, "/claim/initial_set/ball", "0.141421356237"))["verdict"], "valid");
}

/// One state more than is taken.
#[test]
fn too_many_states_are_refused_with_their_number() {
    let folder = TempDir::new().unwrap();
    let names = ["a", "b", "c", "d", "g", "h", "k"];
    let f = names.map(|name| format!("-{name} + e"));
    let plant = plant(&names, &f.each_ref().map(String::as_str), "a");
    let plant = stored(folder.path(), "plant.json", &plant);
    let output = program().arg("certify").arg(&plant).arg("--quiet").output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("7 states; a plant of at most 6 is certified"), "{said}");
}

/// The rate of one P says nothing about another: without `rate_existence` a P of existence proves nothing, whatever c it has. Here
/// P = diag(1/100, 1) contracts at 0.904 and has c = 10; the identity has c = 1 and contracts at 0.05. With the rate of the one and
/// the c of the other every condition would hold, and sup|x| of the periodic solution (4.09) would be claimed to be 2.6.
#[test]
fn the_rate_of_stability_is_none_in_the_p_of_existence() {
    let folder = TempDir::new().unwrap();
    let plant = folder.path().join("plant.json");
    let text = r#"{"format": "sigmastar/plant", "version": 1, "name": "shear", "period": "40", "states": ["x", "v"],
        "f": ["-x + 19*v/10", "-v + e"], "q": "x/100 + cos(2*pi*t/40)",
        "internal_model": {"mu": "1/100", "base_frequency": "2*pi/40", "matched": true,
            "weights": {"family": "power", "n0": "2", "epsilon": "1/2"}}}"#;
    std::fs::write(&plant, text).unwrap();
    let everywhere = |bound: &str, value: &str| {
        let e = if bound == "f_x" { "0" } else { "1000" };
        serde_json::json!({ "bound": bound, "X": "100000", "E": e, "value": value })
    };
    let bounds: Vec<Value> = [
        ("f_x", "2.5"),
        ("rate", "0.904"),
        ("f_e", "1.0001"),
        ("q_x", "0.010001"),
        ("q_e", "0"),
        ("q_e_max", "0"),
        ("q_tx", "0"),
        ("q_te", "0"),
    ]
    .map(|(bound, value)| everywhere(bound, value))
    .to_vec();
    let witness = serde_json::json!({
        "X_p": "2.6", "E_p": "2.3", "r_x": "1.75", "r_e": "1.55", "r_d": "0.5", "kap": "0", "D_x": "5800", "D_e": "80",
        "w_x": "0.15", "h": "0.24", "k0": "192.71602", "k1": "300.76421", "transfer": { "proof": "matched", "K": 3 },
        "lyapunov": { "P": [["0.01", "0"], ["0", "1"]], "p_low": "0.00999", "p_up": "1.0001", "alpha": "0.904" },
        "coordinates": [["1", "0"], ["0", "1"]],
        "orbit": { "mean": ["0", "0"], "defect": "1.00001e-30", "tube": "0.0002", "radius": "1.2e-29" },
        "forcing": { "mean": "0", "harmonics": [{ "cos": "1", "sin": "0" }], "rest": "9.18758e-15",
            "rest_t": "7.35007e-14" },
        "bounds": bounds,
        "lyapunov_existence": { "P": [["1", "0"], ["0", "1"]], "p_low": "1", "p_up": "1", "alpha": "0.049" },
    });
    let document: Value = serde_json::from_str(text).unwrap();
    let certificate = serde_json::json!({
        "format": "sigmastar/certificate", "version": 1, "plant": document, "witness": witness,
        "claim": { "derivation": "sharp", "sigma_star": "0.5", "initial_set": { "X0": "5.2", "E0": "4.6", "Z0": "0" } },
    });
    let decided = |certificate: &Value| {
        let file = stored(folder.path(), "witness.json", certificate);
        let output = program().arg("certify").arg(&plant).args(["--quiet", "--witness"]).arg(&file).output().unwrap();
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    assert_eq!(decided(&certificate).0, Some(3), "{}", decided(&certificate).1);
    // With the P of stability for both everything is read and decided as well: c = 10 is too much for this X_p.
    let mut single = certificate.clone();
    single["witness"].as_object_mut().unwrap().remove("lyapunov_existence");
    assert_eq!(decided(&single).0, Some(1), "{}", decided(&single).1);
}

/// The P of existence: every number of it is decided, by the program and by the checker.
#[test]
fn a_false_matrix_of_existence_is_refused() {
    let folder = TempDir::new().unwrap();
    let (certificate, _) = reported(folder.path(), "pendulum");
    let document = read(&certificate);
    let bounds = document["witness"]["bounds"].as_array().unwrap();
    let at = bounds.iter().position(|entry| entry["bound"] == "rate_existence").unwrap();
    let rate = number(&bounds[at]["value"]);
    let rate_place = format!("/witness/bounds/{at}/value");
    for (pointer, value) in [
        ("/witness/lyapunov_existence/alpha", "1.1".to_owned()),
        ("/witness/lyapunov_existence/p_low", "1.2".to_owned()),
        ("/witness/lyapunov_existence/p_up", "0.9".to_owned()),
        ("/witness/lyapunov_existence/P/0/0", "-1".to_owned()),
        (rate_place.as_str(), (1.01 * rate).to_string()),
    ]
    .into_iter()
    .step_by(every(2))
    {
        let false_one = altered(&certificate, pointer, &value);
        assert_ne!(
            decided_again(folder.path(), &crate::support::document("plants/pendulum"), &false_one).0,
            Some(0),
            "{pointer}"
        );
        let answer = checked(&false_one);
        assert_ne!(answer["verdict"], "valid", "{pointer}: {answer:#}");
    }
}

/// A motor axis at 1000 samples a period, and what of its certificate is proved again.
#[test]
fn a_claim_at_samples_by_matrix_inequalities() {
    let folder = TempDir::new().unwrap();
    let certificate = folder.path().join("axis.json");
    let call = ["certify", "specs/plants/motor-axis.json", "--quiet", "--sampling-period", "1/50000"];
    assert!(program().args(call).arg("-o").arg(&certificate).output().unwrap().status.success());
    let document = read(&certificate);
    let names: Vec<&str> =
        document["conditions"].as_array().unwrap().iter().map(|condition| condition["id"].as_str().unwrap()).collect();
    assert!(names.contains(&"C5x") && names.contains(&"C5e") && !names.contains(&"C5h"), "{names:?}");
    let again = |file: &Path| program().args(call).arg("--witness").arg(file).output().unwrap();
    assert!(again(&certificate).status.success());
    for (pointer, value) in [
        ("/witness/matrix_inequality/lambda", "1000000000000"),
        ("/witness/matrix_inequality/c_e", "1000000000"),
        ("/witness/matrix_inequality/c_y", "1000000"),
        ("/witness/matrix_inequality/rate", "-1"),
        ("/witness/matrix_inequality/X", "0"),
        ("/claim/sigma", "1/1000"),
    ] {
        let output = again(&altered(&certificate, pointer, value));
        assert_ne!(output.status.code(), Some(0), "{pointer}");
    }
    // The fields of continuous time are none here.
    let mut other = document;
    other["witness"]["matrix_inequality"] = serde_json::json!({ "X": "1", "E": "10", "rate": "1", "sigma": "1" });
    let output = again(&stored(folder.path(), "forged.json", &other));
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(!output.status.success() && told.contains("lambda"), "{told}");
}
