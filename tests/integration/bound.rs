//! `sigmastar bound`: a specification from a plant, and its certificate.

use crate::support::{self, assert_valid, certified_in, every, json, number, program, read, stored};
use serde_json::Value;
use tempfile::TempDir;

/// The gain of a shipped plant, or of what `bound` made of one, which the checker accepts.
fn gain(document: &Value) -> f64 {
    let folder = TempDir::new().unwrap();
    let (certificate, report) = certified_in(folder.path(), document, &[]);
    assert_valid(&certificate);
    number(&report["sigma_star"])
}

/// The specification is certified and checked, with a gain not far above that of the plant itself, which may rest on a matrix
/// inequality; it is the same every time.
#[test]
fn the_specification_of_a_plant_is_certified() {
    let folder = TempDir::new().unwrap();
    for (name, most) in [
        ("motor-axis", 1.95),
        ("chain", 1.55),
        ("paper-example", 1.35),
        ("pendulum", 2.6),
        ("relative-degree-2-domain", 1.45),
    ]
    .into_iter()
    .step_by(every(5))
    {
        let plant = format!("specs/plants/{name}.json");
        let spec = folder.path().join(format!("{name}.json"));
        let output = program().args(["bound", &plant, "-o"]).arg(&spec).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{name}: {said}");
        assert!(said.contains("every bound is proved for |y| <= ") && output.stdout.is_empty(), "{said}");
        let (found, own) = (gain(&read(&spec)), gain(&support::document(&format!("plants/{name}"))));
        assert!(found <= most * own, "{name}: {found} for {own}");
        if name == "motor-axis" {
            let again = program().args(["bound", &plant, "--quiet"]).output().unwrap();
            assert_eq!(std::fs::read(&spec).unwrap(), again.stdout);
            assert!(again.stderr.is_empty());
        }
    }
}

/// The bounds of the motor axis, whose f and q are linear but for sines: known by hand.
#[test]
fn bounds_are_those_of_the_formulas() {
    let call = ["bound", "specs/plants/motor-axis.json", "--quiet", "--domain", "10,5"];
    let output = program().args(call).output().unwrap();
    let spec = json(&output.stdout);
    assert_eq!(spec["domain"], serde_json::json!({ "X": "10", "E": "5" }));
    // f = -200 x + 150 e, q = 100 x - (60 .. 100) e + ...
    let near = |field: &str, exact: f64| {
        let value = number(&spec["bounds"][field]);
        assert!(value >= exact && value < 1.01 * exact, "{field}: {value} for {exact}");
    };
    near("f_x", 200.0);
    near("f_e", 150.0);
    assert_eq!((&spec["bounds"]["f_xx"], &spec["bounds"]["f_ex"]), (&"0".into(), &"0".into()));
    let rate = number(&spec["lyapunov"]["rate"]);
    assert!(rate <= 200.0 && rate > 198.0, "{rate}");
}

/// A specification has no parameters: names of the plant are written out, and of intervals the description tells.
#[test]
fn names_of_parameters_are_written_out() {
    let folder = TempDir::new().unwrap();
    let mut named = support::document("plants/duffing");
    named["parameters"] =
        serde_json::json!({ "T": "2", "w": "pi", "d": { "nominal": 2, "low": "1.9", "high": "2.1" } });
    named["period"] = "T".into();
    named["f"][1] = "-4*x - x^3/2 - d*v + e + cos(w*t)".into();
    named["internal_model"]["base_frequency"] = "2*w/T".into();
    named["internal_model"]["mu"] = "T/2".into();
    let plant = stored(folder.path(), "plant.json", &named);
    let output = program().args(["bound", "--quiet"]).arg(&plant).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let written = json(&output.stdout);
    let model = &written["internal_model"];
    assert_eq!(
        (&written["period"], &model["base_frequency"], &model["mu"]),
        (&"2".into(), &"2*(pi)/2".into(), &"2/2".into())
    );
    assert!(
        written["description"]
            .as_str()
            .unwrap()
            .ends_with("for every plant with a constant 'd' of the file in [1.9, 2.1].")
    );
    gain(&written);
}

#[test]
fn calls_that_make_no_sense_are_refused() {
    for (call, code, words) in [
        (&["bound", "specs/linear.json"][..], 2, "sigmastar/plant"),
        (&["bound", "specs/plants/motor-axis.json", "--domain", "1"], 2, "two positive rational numbers"),
        (&["bound", "specs/plants/motor-axis.json", "--domain", "1,-2"], 2, "positive"),
        (&["bound", "specs/plants/motor-axis.json", "--domain", "1,pi"], 2, "two positive rational numbers"),
        (&["bound", "specs/plants/invalid/unstable.json"], 3, "no certificate of this kind"),
        (&["bound", "specs/plants/motor-axis.json", "-o", "specs/plants/motor-axis.json"], 2, "plant"),
    ] {
        let output = program().args(call).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{call:?}: {said}");
        assert!(said.contains(words), "{call:?}: {said}");
        assert!(output.stdout.is_empty());
    }
}
