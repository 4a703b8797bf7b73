//! An actuator with limits to both sides, and a claim that keeps to its actuator by the bounds for every number of oscillators (docs/mathematics.md, 13.5, 14.5).

use super::controller::installed;
use super::controller_c::gcc;
use super::support::{assert_valid, checked, json, number, program, read, stored, told, tried, utf8};
use serde_json::{Value, json as object};
use std::path::{Path, PathBuf};
use std::process::Command as Process;

/// A bath with a heater: `e' = -7.5 + ... + b v`, `v` in `[min, max]`.
fn bath(min: &str, max: &str) -> Value {
    object!({
        "format": "sigmastar/plant", "version": 1, "name": "Bath", "period": 2, "states": ["w"],
        "parameters": { "b": 2 }, "f": ["-w + e/2"],
        "q": "-7.5 + w/2 - e + 0.3*cos(phase) + 0.1*cos(2*phase)",
        "input_gain": { "nominal": "b", "low": "b", "high": "b" }, "actuator": { "min": min, "max": max },
        "initial_set": { "kind": "aligned", "ball": "1/10", "E0": "1/10" },
        "internal_model": { "mu": 1, "base_frequency": "pi", "matched": true, "weights": { "family": "power", "n0": 2, "epsilon": "1/2" } },
    })
}

fn certified(folder: &Path, plant: &Value, flags: &[&str]) -> (PathBuf, Value) {
    let (file, certificate) = (stored(folder, "plant.json", plant), folder.join("c.json"));
    let mut call = program();
    call.arg("certify").arg(&file).args(flags).args(["-q", "--force", "--format", "json", "-o"]).arg(&certificate);
    let report = json(&call.assert().success().get_output().stdout);
    (certificate, report)
}

/// What a heater can do to both sides of the middle is what a symmetric one can do around it, whose plant has the middle in q.
#[test]
fn limits_to_both_sides_are_those_around_the_middle() {
    let folder = tempfile::tempdir().unwrap();
    for flags in [&["--no-alternatives"][..], &["--no-alternatives", "--sampling-period", "1/50"]] {
        let (file, _) = certified(folder.path(), &bath("0", "8"), flags);
        assert_valid(&file);
        let own = read(&file);
        assert_eq!(own["claim"]["actuator"], object!({ "min": "0", "max": "8" }));
        let statement = own["claim"]["statement"].as_str().unwrap();
        assert!(
            statement.contains("limits what is put out to the range from 0 to 8 (u is measured from its middle"),
            "{statement}"
        );
        let mut by_hand = bath("0", "8");
        by_hand["q"] = "-7.5 + 2*4 + w/2 - e + 0.3*cos(phase) + 0.1*cos(2*phase)".into();
        by_hand["actuator"] = object!({ "max": "4" });
        let (file, _) = certified(folder.path(), &by_hand, flags);
        let other = read(&file);
        for part in ["sigma", "periodic_solution", "control", "initial_set"] {
            assert_eq!(own["claim"][part], other["claim"][part], "{part}");
        }
        // The same numbers prove nothing of the plant whose middle is left out.
        let mut forged = other.clone();
        forged["plant"]["q"] = own["plant"]["q"].clone();
        assert_ne!(checked(&with_digest(folder.path(), forged))["verdict"], "valid");
    }
}

/// A certificate whose digest is made right.
fn with_digest(folder: &Path, mut certificate: Value) -> PathBuf {
    let plant = stored(folder, "copy.json", &certificate["plant"]);
    let subject = sigmastar::Subject::from_json(&std::fs::read_to_string(plant).unwrap()).unwrap();
    certificate["plant_sha256"] = subject.sha256().into();
    stored(folder, "forged.json", &certificate)
}

/// Where the conditions ask for more than the actuator takes, the bounds for every number of oscillators keep to it; and the claim is about these alone.
#[test]
fn the_bounds_by_the_number_keep_to_an_actuator() {
    let folder = tempfile::tempdir().unwrap();
    let plant = bath("2.9", "5.1");
    let (file, report) = certified(folder.path(), &plant, &[]);
    assert_valid(&file);
    let made = read(&file);
    let claim = &made["claim"];
    assert_eq!(claim["actuator"], object!({ "min": "2.9", "max": "5.1", "kept_by": "by_n_o" }));
    assert!(claim.get("harmonics").is_none() && claim.get("sigma_star").is_none());
    let entries = claim["by_n_o"].as_array().unwrap();
    let largest: Vec<f64> = entries.iter().map(|entry| number(&entry["largest"]["u"])).collect();
    assert!(largest.iter().all(|u| *u <= 1.1) && entries.last().unwrap()["or_more"] == true, "{largest:?}");
    let by_conditions = number(&claim["control"]["steady"]) + number(&claim["control"]["transient"]);
    assert!(by_conditions > 1.1, "{by_conditions}");
    // The report has these bounds, and no member exceeds them.
    let (_, text) = told(program().args(["certify", "-q"]).arg(folder.path().join("plant.json")));
    assert!(
        text.contains("2.9 <= 4 + u <= 5.1 at all times, as the actuator takes it; the same for every n_o"),
        "{text}"
    );
    assert_eq!(report["actuator"], object!({ "min": "2.9", "max": "5.1", "u_from": "4" }));
    // Nobody asked for a limit; and what the claim rests on is said.
    assert!(report.get("limits").is_none(), "{}", report["limits"]);
    assert!(report["basis"].to_string().contains("14.5 for the actuator, by the number"), "{}", report["basis"]);
    assert!(tried(&made, 24, 3).counterexample().is_none());
    // Decided again from its witness it is the same; `--witness` does not decide it.
    let again = sigmastar::reread("certificate", made.to_string().as_bytes()).unwrap();
    let again: Value = serde_json::from_str(again.to_json()).unwrap();
    assert_eq!(again["claim"], *claim);
    let (code, text) = told(program().arg("certify").arg(folder.path().join("plant.json")).arg("--witness").arg(&file));
    assert!(code == 2 && text.contains("which --witness does not decide"), "{text}");
    // At samples.
    let (file, _) = certified(folder.path(), &plant, &["--sampling-period", "1/50"]);
    assert_valid(&file);
    assert_eq!(read(&file)["claim"]["actuator"]["kept_by"], "by_n_o");
    // Noise changes nothing of it: claim and bounds are about the loop without.
    let mut noisy = plant.clone();
    noisy["measurement"] = object!({ "noise": "1/1000" });
    noisy["arithmetic"] = "double".into();
    for flags in [&[][..], &["--sampling-period", "1/50"]] {
        let (file, _) = certified(folder.path(), &noisy, flags);
        assert_valid(&file);
        let claim = &read(&file)["claim"];
        assert_eq!(claim["actuator"]["kept_by"], "by_n_o");
        assert!(
            claim["statement"].as_str().unwrap().contains("exactly, without noise, disturbance and rounding, |e| <= ")
        );
    }
    // Too small for these, too: the least that is found is told, and it is not that of the conditions.
    let file = stored(folder.path(), "small.json", &bath("3.2", "4.8"));
    let (code, text) = told(program().arg("certify").arg(&file).arg("-q"));
    assert!(
        code == 3 && text.contains("what the actuator takes, 0.8; the least for which a proof is found is 0.98"),
        "{text}"
    );
    assert!(
        text.contains("; 0.8 is half of the range from 3.2 to 4.8, and u is measured from its middle, 4."),
        "{text}"
    );
    // A range about 0 needs no explanation.
    let file = stored(folder.path(), "about-0.json", &bath("-0.8", "0.8"));
    let (code, text) = told(program().arg("certify").arg(&file).args(["-q", "--no-alternatives"]));
    assert!(
        code == 3 && text.contains("what the actuator takes, 0.8;") && !text.contains("half of the range"),
        "{text}"
    );
}

/// Limits that are about some numbers of oscillators stay so, beside an actuator that is about every number.
#[test]
fn limits_of_some_numbers_and_an_actuator() {
    let folder = tempfile::tempdir().unwrap();
    let plant = bath("2.9", "5.1");
    let (file, report) = certified(folder.path(), &plant, &["--steady-error", "0.05", "--n-o", "1"]);
    assert_valid(&file);
    assert_eq!(report["limits"]["steady_error"]["n_o"], object!([1]));
    assert_eq!(read(&file)["claim"]["actuator"]["kept_by"], "by_n_o");
    let (file, _) = certified(folder.path(), &plant, &["--max-control", "0.9", "--n-o", "0"]);
    assert_valid(&file);
    // About every number, 0.9 is less than two of them need.
    let file = stored(folder.path(), "plant.json", &plant);
    let (code, text) = told(program().arg("certify").arg(&file).args(["--max-control", "0.9", "-q"]));
    assert!(code == 3 && text.contains("the least for which a proof is found is 0.98"), "{text}");
}

/// A smaller set is named with a gain that is certified with it, actuator and all.
#[test]
fn the_smaller_set_that_is_named_keeps_to_the_actuator() {
    let folder = tempfile::tempdir().unwrap();
    let mut plant = read(Path::new("specs/plants/duffing.json"));
    plant["initial_set"] = object!({ "kind": "box", "ball": "50", "E0": "50", "Z0": "0" });
    plant["actuator"] = object!({ "max": "0.1" });
    let file = stored(folder.path(), "far.json", &plant);
    let (code, text) = told(program().arg("certify").arg(&file).arg("-q"));
    // No set helps: u of the periodic solution alone is larger.
    assert!(code != 0 && !text.contains("is certified"), "{text}");
}

/// Each part of it forged.
#[test]
fn a_claim_that_does_not_keep_to_its_actuator_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let (file, _) = certified(folder.path(), &bath("2.9", "5.1"), &["--no-alternatives"]);
    let made = read(&file);
    let last = made["claim"]["by_n_o"].as_array().unwrap().len() - 1;
    type Forge = Box<dyn Fn(&mut Value)>;
    let of_limits = |min: &'static str| -> Forge {
        Box::new(move |it| {
            it["plant"]["actuator"]["min"] = min.into();
            it["claim"]["actuator"]["min"] = min.into();
        })
    };
    let forged: [(&str, Forge); 8] = [
        ("by C6", Box::new(|it| drop(it["claim"]["actuator"].as_object_mut().unwrap().remove("kept_by")))),
        ("another word", Box::new(|it| it["claim"]["actuator"]["kept_by"] = "C6".into())),
        ("a number is left out", Box::new(|it| drop(it["claim"]["by_n_o"].as_array_mut().unwrap().remove(1)))),
        (
            "not every number",
            Box::new(move |it| drop(it["claim"]["by_n_o"][last].as_object_mut().unwrap().remove("or_more"))),
        ),
        (
            "nothing of the control",
            Box::new(move |it| drop(it["claim"]["by_n_o"][last].as_object_mut().unwrap().remove("largest"))),
        ),
        ("every set", Box::new(|it| it["claim"]["harmonics"] = "every finite set that contains 0".into())),
        // Half of the range is 0.985, below what is put out with two oscillators or more.
        ("a range that is too small", of_limits("3.13")),
        ("a control above the limit", Box::new(move |it| it["claim"]["by_n_o"][last]["largest"]["u"] = "1.2".into())),
    ];
    for (what, forge) in forged {
        let mut forgery = made.clone();
        forge(&mut forgery);
        let answer = checked(&with_digest(folder.path(), forgery));
        assert_ne!(answer["verdict"], "valid", "{what}: {answer}");
    }
    // A range around the same middle that is not too small; and one with another middle is another plant.
    for (min, max, verdict) in [("3", "5", true), ("3", "5.2", false)] {
        let mut other = made.clone();
        for part in ["plant", "claim"] {
            other[part]["actuator"]["min"] = min.into();
            other[part]["actuator"]["max"] = max.into();
        }
        let answer = checked(&with_digest(folder.path(), other));
        assert_eq!(answer["verdict"] == "valid", verdict, "{min} {max}: {answer}");
    }
}

/// A gain that is a parameter with an interval acts on the middle as it does on u; one of which only ends are known does not go with it.
#[test]
fn the_gain_acts_on_the_middle_too() {
    let folder = tempfile::tempdir().unwrap();
    let mut family = bath("2", "6");
    family["parameters"]["b"] = object!({ "nominal": 2, "low": "1.9", "high": "2.1" });
    let (file, _) = certified(folder.path(), &family, &[]);
    assert_valid(&file);
    assert!(tried(&read(&file), 24, 5).counterexample().is_none());
    let mut ends = bath("2", "6");
    ends["input_gain"] = object!({ "nominal": 2, "low": "1.9", "high": "2.1" });
    let file = stored(folder.path(), "ends.json", &ends);
    let (code, text) = told(program().arg("certify").arg(&file));
    assert!(code == 2 && text.contains("make the gain a parameter with an interval"), "{text}");
    // Without a gain it is 1, and a middle of 0 asks for nothing.
    let mut plain = ends.clone();
    plain["actuator"] = object!({ "min": "-9", "max": "9" });
    sigmastar::Subject::from_json(&plain.to_string()).unwrap();
    plain.as_object_mut().unwrap().remove("input_gain");
    plain["actuator"] = object!({ "min": "0", "max": "16" });
    let (file, _) = certified(folder.path(), &plain, &["--no-alternatives"]);
    assert_valid(&file);
    // A middle of 0 asks for no gain, in either program.
    plain["input_gain"] = object!({ "nominal": 2, "low": "1.9", "high": "2.1" });
    plain["q"] = "w/2 - e + 0.3*cos(phase)".into();
    plain["actuator"] = object!({ "min": "-9", "max": "9" });
    let (file, _) = certified(folder.path(), &plain, &["--no-alternatives"]);
    assert_valid(&file);
    // Bounding functions know no middle, and none are made of a plant with one.
    let file = stored(folder.path(), "bath.json", &bath("2.9", "5.1"));
    let (code, text) = told(program().arg("bound").arg(&file));
    assert!(code == 2 && text.contains("u is measured from 4, and bounding functions know no such number"), "{text}");
    let mut spec: Value = read(Path::new(super::support::EXAMPLE));
    spec["actuator"] = object!({ "min": "0", "max": "60" });
    let error = sigmastar::Specification::from_json(&spec.to_string()).unwrap_err().to_string();
    assert!(error.contains("limits to both sides are for plants by their formulas"), "{error}");
}

/// The exported code, looped from outside with a plant of its own, puts out what the heater takes, and removes the error.
#[test]
fn the_exported_code_puts_out_what_the_heater_takes() {
    let folder = tempfile::tempdir().unwrap();
    let flags = ["--no-alternatives", "--sampling-period", "1/50", "--sigma", "1/2"];
    let (file, _) = certified(folder.path(), &bath("2.9", "5.1"), &flags);
    let source = folder.path().join("heater.c");
    let export = |format: &str| {
        let mut call = program();
        call.arg("controller").arg(&file).args(["--n-o", "2", "--format", format]);
        call
    };
    let exported = json(&export("json").assert().success().get_output().stdout);
    assert_eq!((&exported["middle"], &exported["actuator"]["max"]), (&object!(4.0), &object!(1.1)));
    let notice = exported["notice"].to_string();
    assert!(notice.contains("is to be given 4 + u") && !notice.contains("what the actuator is given"), "{notice}");
    let script = utf8(export("matlab").assert().success().get_output().stdout.clone());
    assert!(script.contains("\nmiddle = 4;"), "{script}");
    export("c").arg("-o").arg(&source).assert().success();
    if !installed("gcc", &["--version"]) {
        return;
    }
    let main = "#include \"heater.h\"\n#include <math.h>\n#include <stdio.h>\n\
        int main(void)\n{\n    sigmastar_controller c;\n    double e = 0.1, w = 0.1, t = 0.0, low = 1e9, high = -1e9, last = 0.0;\n    int k, i;\n\n\
        \x20   sigmastar_reset(&c, e);\n    for (k = 0; k < 20000; k++) {\n        double v = sigmastar_step(&c, e);\n\n\
        \x20       if (v < low) {\n            low = v;\n        }\n        if (v > high) {\n            high = v;\n        }\n\
        \x20       for (i = 0; i < 200; i++) {\n            double p = 3.14159265358979323846 * t;\n\
        \x20           double de = -7.5 + w / 2 - e + 0.3 * cos(p) + 0.1 * cos(2 * p) + 2 * v;\n            double dw = -w + e / 2;\n\n\
        \x20           e += 1e-4 * de;\n            w += 1e-4 * dw;\n            t += 1e-4;\n        }\n\
        \x20       if (k >= 19900 && fabs(e) > last) {\n            last = fabs(e);\n        }\n    }\n\
        \x20   printf(\"%.17g %.17g %.17g\\n\", low, high, last);\n    return 0;\n}\n";
    let (main_file, run) = (folder.path().join("main.c"), folder.path().join("main"));
    std::fs::write(&main_file, main).unwrap();
    gcc(&[&source, &main_file, Path::new("-lm")], &run);
    let output = utf8(Process::new(&run).output().unwrap().stdout);
    let [low, high, last]: [f64; 3] =
        output.split_whitespace().map(|value| value.parse().unwrap()).collect::<Vec<f64>>().try_into().unwrap();
    let claim = read(&file);
    let entry =
        claim["claim"]["by_n_o"].as_array().unwrap().iter().rfind(|entry| entry["n_o"].as_u64() <= Some(2)).unwrap();
    let largest = number(&entry["largest"]["u"]);
    assert!(low >= 4.0 - largest && high <= 4.0 + largest && high - low > 0.4, "{low} {high} {largest}");
    assert!(last <= number(&entry["steady"]["e"]) * 1.01 + 1e-4, "{last} {entry}");
}

/// The sum of the middle and u is rounded: what is put out is cut off at the limits themselves.
#[test]
fn rounding_never_leaves_the_range() {
    let folder = tempfile::tempdir().unwrap();
    let mut plant = bath("0", "4.1");
    plant["q"] = "-4.1 + w/2 - e + 0.3*cos(phase)".into();
    let (file, _) =
        certified(folder.path(), &plant, &["--no-alternatives", "--sampling-period", "1/50", "--sigma", "1/2"]);
    let source = folder.path().join("heater.c");
    let call = ["--n-o", "0", "-q", "--format", "c", "-o"];
    program().arg("controller").arg(&file).args(call).arg(&source).assert().success();
    let text = std::fs::read_to_string(&source).unwrap();
    assert!(text.contains("if (u < lowest)") && text.contains("if (u > highest)"), "{text}");
    if !installed("gcc", &["--version"]) {
        return;
    }
    let main = "#include \"heater.h\"\n#include <stdio.h>\nint main(void)\n{\n    sigmastar_controller c;\n\n    sigmastar_reset(&c, 0.0);\n\
        \x20   printf(\"%.17g \", sigmastar_step(&c, 100.0));\n    sigmastar_reset(&c, 0.0);\n    printf(\"%.17g\\n\", sigmastar_step(&c, -100.0));\n    return 0;\n}\n";
    let (main_file, run) = (folder.path().join("main.c"), folder.path().join("main"));
    std::fs::write(&main_file, main).unwrap();
    gcc(&[&source, &main_file], &run);
    assert_eq!(utf8(Process::new(&run).output().unwrap().stdout).trim(), "0 4.0999999999999996");
}
