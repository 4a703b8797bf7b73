//! Named constants of a plant: each counts as the number that it stands for, from the file to the certificate.

use super::support::{json, program};
use serde_json::{Value, json};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::ErrorKind;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

fn shipped(name: &str) -> Value {
    let text = std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("specs/plants/{name}.json")));
    json(&text.expect("shipped"))
}

/// The paper's example with names for some of its numbers, or with these numbers in parentheses.
fn example(named: bool) -> Value {
    let mut plant = shipped("paper-example");
    let parameters = [("k", "1/5"), ("c", "0.1"), ("two", "2"), ("T", "1"), ("m", "3 - 2")];
    let put = |text: &str| {
        if named {
            return text.to_owned();
        }
        // Names stand here between signs of operations.
        parameters.iter().fold(format!(" {text} "), |text, (name, value)| {
            text.replace(&format!(" {name} "), &format!(" ({value}) "))
        })
    };
    plant["f"][0] = put("- k * x1 + sqrt(3)*x2 + sin(x2)/10 + sin(2*pi*t)").into();
    plant["f"][1] = put("-sqrt(3)*x1 - x2 + c * x2^ two + x2*e + cos(4*pi*t)*(1 + sin(2*pi*t))").into();
    plant["initial_set"] = json!({ "kind": "at-rest", "X0": put("k * m").trim(), "E0": put("c * 5").trim() });
    plant["domain"] = json!({ "x": "20", "e": put("m * 20").trim() });
    plant["internal_model"]["mu"] = put("m ").trim().into();
    if named {
        plant["parameters"] = parameters.map(|(name, value)| (name.to_owned(), json!(value))).into_iter().collect();
        plant["period"] = "T".into();
        plant["internal_model"]["base_frequency"] = "2*pi/T".into();
    } else {
        plant["internal_model"]["mu"] = "3 - 2".into();
        plant["internal_model"]["base_frequency"] = "2*pi/1".into();
    }
    plant
}

fn certified(folder: &TempDir, plant: &Value) -> (PathBuf, Value) {
    let (file, certificate) = (folder.path().join("plant.json"), folder.path().join("certificate.json"));
    std::fs::write(&file, plant.to_string()).unwrap();
    let output = program()
        .arg("certify")
        .arg(&file)
        .args(["--quiet", "--force", "--format", "json", "-o"])
        .arg(&certificate)
        .output();
    let output = output.unwrap();
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}{}",
        String::from_utf8_lossy(&output.stderr),
        String::from_utf8_lossy(&output.stdout)
    );
    (certificate, json(&output.stdout))
}

fn checked(certificate: &Path) -> Value {
    json(&program().args(["check", "--format", "json"]).arg(certificate).output().unwrap().stdout)
}

/// The certificates differ in the notation of the plant alone, and the checker, which reads names by its own code, accepts both.
#[test]
fn a_parameter_is_its_number() {
    let folder = TempDir::new().unwrap();
    let mut certificates = [true, false].map(|named| {
        let (file, _) = certified(&folder, &example(named));
        assert_eq!(checked(&file)["verdict"], "valid", "{:#}", checked(&file));
        json(&std::fs::read(&file).unwrap())
    });
    assert_eq!(certificates[0]["plant"]["parameters"]["k"], "1/5");
    for certificate in &mut certificates {
        let fields = certificate.as_object_mut().unwrap();
        fields.remove("plant");
        fields.remove("plant_sha256");
        let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        let statement = fields["claim"]["statement"].as_str().map(words);
        fields["claim"]["statement"] = statement.into();
    }
    let [with, without] = &certificates;
    assert_eq!(with["claim"], without["claim"]);
    assert_eq!(with["witness"], without["witness"]);
}

/// A certificate is of the numbers that stand in it.
#[test]
fn another_number_is_another_plant() {
    let folder = TempDir::new().unwrap();
    let mut plant = shipped("motor-axis");
    plant["f"][0] = "-200*i + k*e + 40*sin(100*pi*t)".into();
    plant["parameters"] = json!({ "k": "150", "spare": 7, "more": 1 });
    let (file, report) = certified(&folder, &plant);
    assert_eq!(checked(&file)["verdict"], "valid");
    let remarks = report["remarks"].to_string() + &report["sentence"].to_string();
    let text =
        program().arg("certify").arg(folder.path().join("plant.json")).args(["--quiet", "--full"]).output().unwrap();
    let text = String::from_utf8_lossy(&text.stdout).into_owned();
    let flat = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(flat.contains("the parameters spare, more are used nowhere"), "{remarks} {text}");
    assert!(flat.contains("parameters: k = 150, spare = 7, more = 1"), "{text}");

    let mut forged = json(&std::fs::read(&file).unwrap());
    forged["plant"]["parameters"]["k"] = "1500".into();
    std::fs::write(&file, forged.to_string()).unwrap();
    assert_ne!(checked(&file)["verdict"], "valid");
    // With the digest of that plant too.
    let sha256 = Plant::from_json("plant", &forged["plant"].to_string()).unwrap().sha256;
    forged["plant_sha256"] = sha256.into();
    std::fs::write(&file, forged.to_string()).unwrap();
    assert_eq!(checked(&file)["verdict"], "invalid");
}

#[test]
fn what_is_wrong_with_parameters_is_told_in_its_place() {
    use ErrorKind::{Expression, Range, UnknownName};
    let with = |parameters: Value, place: &str, value: Value| {
        let mut plant = shipped("motor-axis");
        plant["parameters"] = parameters;
        if !place.is_empty() {
            *plant.pointer_mut(place).unwrap() = value;
        }
        plant
    };
    let none = || Value::Null;
    for (plant, kind, pointer) in [
        (with(json!({ "i": 1 }), "", none()), UnknownName, "/parameters/i"),
        (with(json!({ "e": 1 }), "", none()), UnknownName, "/parameters/e"),
        (with(json!({ "pi": 3 }), "", none()), UnknownName, "/parameters/pi"),
        (with(json!({ "a": 1, "b": "a/2" }), "", none()), Expression, "/parameters/b"),
        (with(json!({ "stiffness": 1 }), "/q", json!("stifness*i")), Expression, "/q"),
        (with(json!({ "mu0": -1 }), "/internal_model/mu", json!("mu0")), Range, "/internal_model/mu"),
        (with(json!({ "mu0": 1 }), "/internal_model/mu", json!("mu1")), Expression, "/internal_model/mu"),
        (with(json!({ "n": 2 }), "/internal_model/weights/n0", json!("n")), Expression, "/internal_model/weights/n0"),
    ] {
        let errors = Plant::from_json("plant", &plant.to_string()).map(|_| ()).unwrap_err();
        let found: Vec<_> = errors.errors().iter().map(|error| (error.kind, error.pointer.as_str())).collect();
        assert_eq!(found, [(kind, pointer)], "{errors}");
    }
    let plant = with(json!({ "stiffness": 1 }), "/q", json!("stifness*i"));
    let errors = Plant::from_json("plant", &plant.to_string()).map(|_| ()).unwrap_err();
    assert!(errors.render(false).contains("did you mean stiffness?"), "{}", errors.render(false));
}

/// A table of TOML, and a study that varies a parameter by its name.
#[test]
fn parameters_in_toml_and_in_studies() {
    let folder = TempDir::new().unwrap();
    let toml = r#"
format = "sigmastar/plant"
version = 1
name = "a wave"
period = "1"
states = []
f = []
q = "1 + tanh(a*sin(2*pi*t))"
[parameters]
a = 3
[internal_model]
mu = "1"
base_frequency = "2*pi"
matched = true
weights = { family = "power", n0 = "2", epsilon = "1/2" }
"#;
    std::fs::write(folder.path().join("wave.toml"), toml).unwrap();
    let study = json!({
        "format": "sigmastar/study", "version": 1, "name": "a", "subject": "wave.toml", "design": "grid",
        "parameters": [{ "parameter": "a", "values": [1, "3"] }],
    });
    std::fs::write(folder.path().join("study.json"), study.to_string()).unwrap();
    let rows = folder.path().join("rows.jsonl");
    program().arg("sweep").arg(folder.path().join("study.json")).arg("-o").arg(&rows).arg("--quiet").assert().success();
    let text = std::fs::read_to_string(&rows).unwrap();
    let lines: Vec<Value> = text.lines().map(|line| json(line.as_bytes())).collect();
    assert_eq!(lines[0]["parameters"], json!([{ "pointer": "/parameters/a", "name": "a" }]));
    let gain = |line: &Value| line["sigma_star"].as_str().and_then(|text| text.parse::<f64>().ok()).expect("a gain");
    assert_eq!((&lines[1]["values"], &lines[2]["values"]), (&json!(["1"]), &json!(["3"])));
    assert!(gain(&lines[1]) > 0.0 && gain(&lines[2]) > 0.0);
}
