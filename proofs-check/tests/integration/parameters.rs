//! Named constants of a plant: each counts as the number that it stands for.

use super::plant_support::Parts;
use proofs_check::verdict::Verdict;
use serde_json::{Value, json};

/// `x' = -x + e + cos(2 pi t)`, `q = sin(2 pi t) + x` on `|x - x_0| <= 2`, with these names.
fn named(parameters: Value, f: &str, q: &str) -> Parts {
    let om = 2.0 * std::f64::consts::PI;
    let (cos, sin) = (1.0 / (1.0 + om * om), om / (1.0 + om * om));
    Parts::scalar(f, q)
        .orbit(cos, sin, "1e-14", "1.1e-14")
        .forcing(0.0, cos, 1.0 + sin, "3e-14", "2e-13")
        .bounds(&[("f_x", "1", "0", "1"), ("f_e", "2", "3", "1"), ("q_x", "2", "3", "1"), ("rate", "2", "3", "1")])
        .with("/plant/parameters", parameters)
}

const F: &str = "-a*x + e + cos(w*t)";
const Q: &str = "sin(w*t) + x^two/x^(two - 1)";

fn usual() -> Parts {
    named(json!({ "a": "1", "w": "2*pi/T0", "two": 2, "T0": 1 }), F, "sin(2*pi*t) + x")
}

#[test]
fn a_name_is_its_number() {
    named(json!({ "a": 1, "w": "2*pi" }), F, "sin(w*t) + a*x").accepted();
    named(json!({ "a": "3 - 2", "w": "2*pi", "T": "1" }), F, "sin(w*t) + x")
        .with("/plant/period", json!("T"))
        .with("/plant/internal_model/base_frequency", json!("w"))
        .with("/plant/internal_model/mu", json!("2*a"))
        .with("/plant/domain", json!({ "x": "5*a", "e": "w" }))
        .with("/plant/initial_set", json!({ "kind": "at-rest", "X0": "a/2", "E0": "a" }))
        .with("/plant/initial", json!({ "x": ["-a"], "e": "w" }))
        .accepted();
    // Another number is another plant.
    assert_eq!(named(json!({ "a": "1.01", "w": "2*pi" }), F, "sin(w*t) + x").verdict().0, Verdict::Invalid);
    // An exponent that is a name is a whole number, where x may be 0 or negative.
    named(json!({ "a": 1, "w": "2*pi", "one": 1 }), "-a*x^one + e + cos(w*t)", "sin(w*t) + x").accepted();
}

#[test]
fn names_that_say_nothing_or_something_else_are_refused() {
    // A value does not refer to another one.
    usual().refused(Verdict::BadInput, "", "/plant/parameters/w");
    let with = |parameters: Value| named(parameters, F, Q);
    for (parameters, at) in [
        (json!({ "a": 1 }), "/plant/f/0"),
        (json!({ "a": 1, "w": "2*pi", "t": 1 }), "/plant/parameters/t"),
        (json!({ "a": 1, "w": "2*pi", "u": 1 }), "/plant/parameters/u"),
        (json!({ "a": 1, "w": "2*pi", "x": 1 }), "/plant/parameters/x"),
        (json!({ "a": 1, "w": "2*pi", "sin": 1 }), "/plant/parameters/sin"),
        (json!({ "a": 1, "w": "2*pi", "2w": 1 }), "/plant/parameters/2w"),
        (json!({ "a": "1/0", "w": "2*pi" }), "/plant/parameters/a"),
        (json!({ "a": "x", "w": "2*pi" }), "/plant/parameters/a"),
        (json!({ "a": [1], "w": "2*pi" }), "/plant/parameters/a"),
        (json!([1]), "/plant/parameters"),
    ] {
        with(parameters).refused(Verdict::BadInput, "", at);
    }
    let many: serde_json::Map<String, Value> = (0..13).map(|i| (format!("k{i}"), json!(1))).collect();
    with(Value::Object(many)).refused(Verdict::BadInput, "", "/plant/parameters");
}
