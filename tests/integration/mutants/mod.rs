//! Specifications altered at random: every datum over twelve decades, swapped, replaced by other expressions, with other
//! domains, sets, weights, Jacobians, frequencies and relative degrees. The same seed gives the same specification.

use crate::support::specification_text;
use rand::rngs::SmallRng;
use rand::seq::IndexedRandom;
use rand::{RngExt, SeedableRng};
use serde_json::{Value, json};

/// The specifications that mutation starts from.
const BASES: [&str; 11] = [
    "explicit-weights",
    "ill-conditioned",
    "linear",
    "no-x",
    "paper-example",
    "paper-example-at-rest",
    "paper-example-jacobian",
    "paper-example-rms",
    "paper-example-rms-at-rest",
    "relative-degree-4",
    "short-period",
];

const BOUNDS: [&str; 8] = ["f", "f_e", "f_xx", "f_ex", "q", "q_e", "q_x", "q_t"];

/// Nondecreasing, or nearly so: what users write, and the corners of the proof that they are.
const EXPRESSIONS: [&str; 30] = [
    "0",
    "X",
    "E",
    "X + E",
    "X*E",
    "sqrt(X)",
    "sqrt(1 + X^2) - 1",
    "X^2*exp(-X/20)",
    "(1+X)*log(1+X) - X",
    "X^3 - 3*X^2 + 3*X",
    "X + 0.1*exp(X) - 0.1 + E",
    "exp(X) - 1 + E",
    "1 - cos(min(X, 3))",
    "sin(min(X, 1)) + E",
    "2 + sin(X) + X",
    "X^2/(1 + X)",
    "X*E/(1 + E)",
    "atan(X*E) + tanh(E)",
    "log(1 + X + E^2)",
    "max(X, E)^(3/2)",
    "min(X^2, 5) + E/3",
    "abs(X - 1) + X",
    "X^2.5 + E^0.5",
    "(X + E)^3/7",
    "1/3 + X^2/(1 + X^2)",
    "tan(min(X, 1)) + 1e-3*E",
    "sqrt(2) + pi*X + E*sqrt(X)",
    "X - tanh(X) + E",
    "exp(min(E, 1)) - exp(-X)",
    "X*log(1 + X)",
];

const CONSTANTS: [&str; 10] = ["1/2", "1", "2", "1/3", "0.1", "sqrt(2)", "pi", "7/5", "25", "1e-3"];

const JACOBIANS: [&str; 8] = [
    r#"[["-1"]]"#,
    r#"[["-1/2", "1"], ["-1", "-1/2"]]"#,
    r#"[[["-2", "-1"]]]"#,
    r#"[["-1", ["0", "1/2"]], ["0", "-2"]]"#,
    r#"[["-2 + cos(2*pi*t)"]]"#,
    r#"[["-1", "3"], ["0", "-1"]]"#,
    r#"[["-3", "1", "0"], ["0", "-2", "1"], ["0", "0", "-1"]]"#,
    r#"[["-100"]]"#,
];

fn pick<'a>(rng: &mut SmallRng, list: &[&'a str]) -> &'a str {
    list.choose(rng).copied().unwrap_or("1")
}

fn written(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// A factor over twelve decades, with a digit or two; now and then a plain power of ten.
fn factor(rng: &mut SmallRng) -> String {
    let exponent = rng.random_range(-6..=6);
    if rng.random_bool(0.3) { format!("1e{exponent}") } else { format!("{}e{exponent}", rng.random_range(1..40)) }
}

fn scaled(rng: &mut SmallRng, value: &Value) -> Value {
    Value::String(format!("({})*({})", written(value), factor(rng)))
}

fn constant(rng: &mut SmallRng) -> Value {
    let plain = Value::String(pick(rng, &CONSTANTS).to_owned());
    if rng.random_bool(0.5) { plain } else { scaled(rng, &plain) }
}

/// Pointers to everything that is one number or one expression.
fn data(spec: &Value) -> Vec<String> {
    let mut list = vec!["/period".to_owned()];
    let objects = ["/lyapunov", "/bounds", "/domain", "/internal_model", "/internal_model/weights", "/initial_set"];
    for at in objects {
        let Some(Value::Object(map)) = spec.pointer(at) else { continue };
        let scalar = |(key, value): (&String, &Value)| {
            let words = ["kind", "family", "matched"].contains(&key.as_str());
            ((value.is_string() || value.is_number()) && !words).then(|| format!("{at}/{key}"))
        };
        list.extend(map.iter().filter_map(scalar));
    }
    list
}

fn mutate(rng: &mut SmallRng, spec: &mut Value) {
    match rng.random_range(0..13) {
        0..=3 => {
            let all = data(spec);
            let at = &all[rng.random_range(0..all.len())];
            if let Some(value) = spec.pointer_mut(at) {
                *value = scaled(rng, value);
            }
        }
        4 => {
            let (a, b) = (pick(rng, &BOUNDS), pick(rng, &BOUNDS));
            let kept = spec["bounds"][a].take();
            spec["bounds"][a] = spec["bounds"][b].take();
            spec["bounds"][b] = kept;
            if a == b {
                spec["bounds"][a] = json!("1");
            }
        }
        5 | 6 => {
            let bound = pick(rng, &BOUNDS);
            let expression = Value::String(pick(rng, &EXPRESSIONS).to_owned());
            spec["bounds"][bound] = if rng.random_bool(0.5) { expression } else { scaled(rng, &expression) };
        }
        7 => {
            if rng.random_bool(0.4) {
                spec.as_object_mut().map(|map| map.remove("domain"));
            } else {
                spec["domain"] = json!({ "X": constant(rng), "E": constant(rng) });
            }
        }
        8 => {
            spec["initial_set"] = match rng.random_range(0..4) {
                0 => json!({ "kind": "paper" }),
                1 => json!({ "kind": "at-rest" }),
                2 => json!({ "kind": "at-rest", "X0": constant(rng), "E0": constant(rng) }),
                _ => json!({ "kind": "box", "X0": constant(rng), "E0": constant(rng), "Z0": constant(rng) }),
            };
        }
        9 => {
            spec["internal_model"]["weights"] = match rng.random_range(0..3) {
                0 => json!({ "family": "power", "n0": pick(rng, &["1.001", "2", "1000", "sqrt(3)"]),
                    "epsilon": pick(rng, &["1/1000", "1/3", "1/2", "1"]) }),
                1 => {
                    json!({ "family": "explicit", "values": ["3", "1"], "tail": { "coefficient": "1", "exponent": "2" } })
                }
                _ => json!({ "family": "explicit", "values": ["1.5", "1", "0.4", "0.22"],
                    "tail": { "coefficient": "1", "exponent": "3/2" } }),
            };
        }
        10 => {
            spec["lyapunov"] = if rng.random_bool(0.5) {
                json!({ "jacobian": serde_json::from_str::<Value>(pick(rng, &JACOBIANS)).unwrap() })
            } else {
                json!({ "p_low": "1", "p_up": pick(rng, &["1", "3/2", "1e4", "sqrt(2)"]), "alpha": constant(rng) })
            };
        }
        11 => {
            if rng.random_bool(0.3) {
                spec.as_object_mut().map(|map| map.remove("relative_degree"));
            } else {
                let a = [json!(["1"]), json!(["2", "3"]), json!(["6", "11", "6"])];
                spec["relative_degree"] = json!({ "a": a.choose(rng).unwrap() });
            }
        }
        _ => {
            let period = written(&spec["period"]);
            let model = &mut spec["internal_model"];
            if rng.random_bool(0.5) {
                model["base_frequency"] = Value::String(format!("2*pi/({period})"));
                model["matched"] = json!(true);
            } else {
                model["base_frequency"] = constant(rng);
                model["matched"] = json!(false);
            }
        }
    }
}

/// A mutated specification.
pub fn specification(seed: u64) -> Value {
    let mut rng = SmallRng::seed_from_u64(seed);
    let text = specification_text(pick(&mut rng, &BASES));
    let mut spec: Value = serde_json::from_str(&text).expect("JSON");
    for _ in 0..rng.random_range(1..=4) {
        mutate(&mut rng, &mut spec);
    }
    // A scaled period leaves the frequency unmatched unless it follows.
    if spec["internal_model"]["matched"] == json!(true) && rng.random_bool(0.8) {
        let period = written(&spec["period"]);
        spec["internal_model"]["base_frequency"] = Value::String(format!("2*pi/({period})"));
    }
    // Some start aligned, with sizes where there are any; without a number drawn, which would change what the other seeds make.
    if let Some(set) = spec["initial_set"].as_object_mut().filter(|_| seed % 5 == 4) {
        set.remove("Z0");
        set.insert("kind".to_owned(), json!("aligned"));
    }
    spec
}
