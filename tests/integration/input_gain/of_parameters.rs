//! A gain of the actuator that depends on parameters of which intervals are known: the motor of the guide.

use crate::support::{self, certified_in, json, number, program, read, stored};
use serde_json::{Value, json as object};
use std::path::Path;

/// Inertia 30 %, friction 50 %, drive 10 %.
fn motor(gain: &Value) -> Value {
    object!({
        "format": "sigmastar/plant", "version": 1, "name": "motor",
        "parameters": {
            "J": { "nominal": "1", "low": "0.7", "high": "1.3" },
            "b": { "nominal": "60", "low": "30", "high": "90" },
            "g": "1.1"
        },
        "period": "1/50", "states": ["i"],
        "f": ["-200*i + 150*e + 40*sin(100*pi*t)"],
        "q": "(100*i - b*e - 40*tanh(e) + 2000 + 1500*cos(100*pi*t) + 400*sin(200*pi*t))/J",
        "input_gain": gain,
        "internal_model": { "mu": "100", "base_frequency": "100*pi", "matched": true,
            "weights": { "family": "power", "n0": "2", "epsilon": "1/2" } }
    })
}

fn checked(folder: &Path, certificate: &Value) -> Value {
    support::checked(&stored(folder, "checked.json", certificate))
}

#[test]
fn one_gain_serves_every_motor_and_every_drive() {
    let folder = tempfile::tempdir().unwrap();
    let motor = motor(&object!({ "nominal": "1/J", "low": "0.9/J", "high": "g/J" }));
    let (certificate, report) = certified_in(folder.path(), &motor, &["--no-alternatives"]);
    let certificate = read(certificate);
    let claim = &certificate["claim"];
    let sigma = number(&claim["sigma_star"]);
    assert!((92.9..93.1).contains(&sigma), "{sigma}");
    assert_eq!(claim["input_gain"], object!({ "nominal": "1", "low": "0.9/J", "high": "1.1/J" }));
    let statement = claim["statement"].as_str().unwrap();
    assert!(statement.contains("every input gain in [0.9/'J', 1.1/'J']"), "{statement}");
    let answer = checked(folder.path(), &certificate);
    assert_eq!(&answer["verdict"], &object!("valid"));
    // The ball about the nominal orbit is within the ball about the member's own.
    let radius = |name: &str| number(&report["plant"][name]);
    assert!(radius("nominal_ball") > 0.0 && radius("nominal_ball") <= radius("ball"));

    let mut forged = certificate.clone();
    for (end, text) in [("low", "0.95/J"), ("high", "1.05/J"), ("nominal", "2")] {
        forged["claim"]["input_gain"] = certificate["claim"]["input_gain"].clone();
        forged["claim"]["input_gain"][end] = text.into();
        assert_ne!(checked(folder.path(), &forged)["verdict"], "valid", "{end} {text}");
    }
}

/// `i' = -k i + 40 sin(100 pi t)`: the affine orbit moves by `10 * 40/|200 + 100 pi i|^2 = 0.002884` where k moves by 10 from 200, and the member's own is
/// off that by about `0.1074 (10/|200 + 100 pi i|)^2 = 0.000077`: by both the ball is smaller about the orbit of the nominal member.
#[test]
fn the_ball_about_the_nominal_orbit() {
    let folder = tempfile::tempdir().unwrap();
    let mut family = motor(&object!({ "nominal": "1", "low": "1", "high": "1" }));
    family["parameters"] = object!({ "J": "1", "b": "60", "k": { "nominal": "200", "low": "190", "high": "210" } });
    family["f"][0] = "-k*i + 150*e + 40*sin(100*pi*t)".into();
    family["initial_set"] = object!({ "kind": "at-rest", "X0": "1", "E0": "20" });
    let (_, report) = certified_in(folder.path(), &family, &["--no-alternatives"]);
    let radius = |name: &str| number(&report["plant"][name]);
    let less = radius("ball") - radius("nominal_ball");
    assert!((0.00296..0.0035).contains(&less), "{less}");
}

/// A member has its own gain, which `simulate` takes where none is given.
#[test]
fn a_member_has_its_own_gain() {
    let folder = tempfile::tempdir().unwrap();
    let motor = motor(&object!({ "nominal": "1/J", "low": "1/J", "high": "1/J" }));
    let file = stored(folder.path(), "motor.json", &motor);
    let run = |arguments: &[&str]| {
        let mut simulate = program();
        simulate.args(["simulate", "-q", "--sigma", "100", "--n-o", "1", "--format", "json"]).arg(&file);
        json(&simulate.args(arguments).assert().code(0).get_output().stdout)["steady_state"]["sup_e"].clone()
    };
    let own = run(&["--parameter", "J=0.8"]);
    assert_eq!(own, run(&["--parameter", "J=0.8", "--input-gain", "1.25"]));
    assert_ne!(own, run(&["--parameter", "J=0.8", "--input-gain", "1"]));
}
