//! The JSON Schemas: they are what the command prints, they accept every file that the readers accept, and they know exactly
//! the fields that the readers know.

use crate::support::{ROOT, files, program, stem, utf8};
use crate::validator::Validator;
use serde_json::{Value, json};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Document, SpecErrors, Specification};
use sigmastar_schema::Schema;
use sigmastar_studies::sweep::Study;
use std::collections::BTreeSet;
use std::path::Path;

/// What is wrong with a text, to its reader.
type Reader<'r> = &'r dyn Fn(&str) -> Option<SpecErrors>;

fn validator(schema: Schema) -> Validator {
    Validator::new(&schema.json())
}

fn parsed(path: &Path) -> Value {
    let text = std::fs::read_to_string(path).expect("readable");
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[test]
fn the_shipped_schemas_are_those_that_are_printed() {
    for schema in Schema::ALL {
        let printed = utf8(program().args(["schema", schema.name()]).assert().code(0).get_output().stdout.clone());
        let shipped = format!("{ROOT}/docs/schemas/{}.schema.json", schema.name());
        assert_eq!(std::fs::read_to_string(&shipped).expect(&shipped), printed, "write {shipped} again");
        // That it is a schema is seen where it is read.
        Validator::new(&serde_json::from_str(&printed).expect("JSON"));
    }
    let error = utf8(program().args(["schema", "plnat"]).assert().code(2).get_output().stderr.clone());
    assert!(error.contains("plant"), "{error}");
}

#[test]
fn every_shipped_file_is_valid() {
    for (schema, folders) in [
        (Schema::Specification, &["specs"][..]),
        (Schema::Plant, &["specs/plants"]),
        (Schema::Study, &["specs/studies"]),
    ] {
        let validator = validator(schema);
        let all: Vec<_> = folders.iter().flat_map(|folder| files(folder)).collect();
        assert!(!all.is_empty());
        for path in all {
            assert_eq!(validator.complaints(&parsed(&path)), None, "{}", path.display());
        }
    }
}

/// Invalid files that a schema cannot catch: what is wrong with them is in a text, in numbers that belong together, or in
/// the JSON itself.
const BEYOND: [&str; 34] = [
    "bad-expression",
    "decreasing-bound",
    "decreasing-one-sided",
    "duplicate-key",
    "escaped-text",
    "exponent-too-large",
    "increasing-rate",
    "irrational-coefficient",
    "jacobian",
    "matched-undecided",
    "negative-bound",
    "negative-harmonic",
    "negative-initial-set",
    "negative-period",
    "no-value",
    "not-matched",
    "p-order",
    "undecided-sign",
    "unknown-function",
    "unquoted-escape",
    "variable-in-constant",
    "weights-epsilon",
    "weights-junction",
    "weights-n0",
    "weights-undecided",
    "weights-w2",
    "weights-w3",
    "zero-alpha",
    // Of plants.
    "corner",
    "marginal",
    "not-periodic",
    "root",
    "time-outside",
    "unstable",
];

#[test]
fn every_invalid_file_that_a_schema_can_catch_is_caught() {
    let mut seen = BTreeSet::new();
    for (schema, folder) in [(Schema::Specification, "specs/invalid"), (Schema::Plant, "specs/plants/invalid")] {
        let validator = validator(schema);
        for path in files(folder) {
            let text = std::fs::read_to_string(&path).expect("readable");
            // What is no JSON has no fields.
            let Ok(value) = serde_json::from_str::<Value>(&text) else { continue };
            let name = stem(&path).to_owned();
            let expected = !BEYOND.contains(&name.as_str());
            assert_eq!(!validator.is_valid(&value), expected, "{name}");
            seen.insert(name);
        }
    }
    let missing: Vec<_> = BEYOND.iter().filter(|name| !seen.contains(**name)).collect();
    assert!(missing.is_empty(), "{missing:?}");
}

/// The fields that a reader knows at a place, as it tells them for one that it does not know.
fn known(read: Reader<'_>, document: &Value, pointer: &str) -> BTreeSet<String> {
    let mut document = document.clone();
    let place = document.pointer_mut(pointer).and_then(Value::as_object_mut).expect("an object");
    place.insert("zzzzzzzzzzzzzzzzzzzz".to_owned(), Value::Null);
    let errors = read(&document.to_string()).unwrap_or_else(|| panic!("{pointer}: an unknown field is read"));
    let mut helps = errors.errors().iter().filter_map(|error| error.help.as_deref());
    let help = helps.find(|help| help.contains("fields known"));
    let list = help.and_then(|help| help.split_once(" are ")).unwrap_or_else(|| panic!("{pointer}: {errors}")).1;
    list.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

/// The schema of a value inside of another one: what applies to it, with the alternative that it satisfies.
fn chosen(schema: &Value, value: &Value) -> Value {
    let Some(alternatives) = schema.get("oneOf").and_then(Value::as_array) else { return schema.clone() };
    let valid = |schema: &&Value| Validator::new(schema).is_valid(value);
    let fitting: Vec<&Value> = alternatives.iter().filter(valid).collect();
    assert_eq!(fitting.len(), 1, "{value}");
    fitting[0].clone()
}

fn properties(schema: &Value) -> BTreeSet<String> {
    schema["properties"].as_object().expect("an object").keys().cloned().collect()
}

/// Compares the schema with the reader at every object of a document; returns how many there are.
fn compared(read: Reader<'_>, document: &Value, schema: &Value) -> usize {
    assert!(read(&document.to_string()).is_none(), "{document}: {:?}", read(&document.to_string()));
    let mut count = 0;
    let whole = Validator::new(schema);
    let mut open = vec![(String::new(), schema.clone())];
    while let Some((pointer, schema)) = open.pop() {
        let value = document.pointer(&pointer).expect("there");
        let one = chosen(&schema, value);
        match value {
            // A subject in a study is read later, by its own reader.
            Value::Object(_) if one.get("properties").is_none() => {}
            Value::Object(fields) => {
                let (accepted, known) = (properties(&one), known(read, document, &pointer));
                let all: BTreeSet<String> =
                    schema["oneOf"].as_array().into_iter().flatten().flat_map(properties).collect();
                // The ways to give the values of a parameter, how far x may be, or what an actuator takes, exclude each other: a reader that
                // knows one knows the others, to say so.
                let exclusive = ["pointer", "ball", "min"].iter().any(|name| all.contains(*name));
                let same =
                    if exclusive { accepted.is_subset(&known) && known.is_subset(&all) } else { accepted == known };
                assert!(same, "{pointer}: schema {accepted:?}, reader {known:?}");
                count += 1;
                for name in fields.keys() {
                    open.push((format!("{pointer}/{name}"), one["properties"][name].clone()));
                }
                // What the schema misses, the reader misses.
                for name in one["required"].as_array().expect("a list") {
                    let name = name.as_str().expect("a name");
                    let mut less = document.clone();
                    let place = less.pointer_mut(&pointer).and_then(Value::as_object_mut).expect("an object");
                    place.shift_remove(name);
                    let refused = read(&less.to_string()).is_some();
                    assert!(refused || whole.is_valid(&less), "{pointer} is read without {name}");
                }
            }
            Value::Array(elements) => {
                open.extend((0..elements.len()).map(|index| (format!("{pointer}/{index}"), one["items"].clone())));
            }
            _ => {}
        }
    }
    count
}

/// A file with some fields in the place of others.
fn with(path: &str, fields: &[(&str, Value)]) -> Value {
    let mut document = parsed(&Path::new(ROOT).join(path));
    for (name, value) in fields {
        document[*name] = value.clone();
    }
    document
}

/// What is required is needed, what is optional may be there: every optional field is in one of these documents.
fn specifications() -> Vec<Value> {
    let explicit = json!({ "mu": 1, "base_frequency": "2*pi", "matched": true, "sampling_period": "1/100", "delay_samples": 1,
        "harmonics": "every-set", "weights": { "family": "explicit", "values": [2, 1], "tail": { "coefficient": 1, "exponent": "3/2" } } });
    let lyapunov = json!({ "p_low": 1, "p_up": 1, "alpha": 1, "rate": "1 - X/100" });
    let q_0 = json!({ "harmonics": [1], "rest_rms": 1, "rest_t_rms": 1 });
    let at_rest = json!({ "kind": "at-rest", "X0": 0, "E0": 0 });
    let linear = "specs/linear.json";
    let mut bounds = parsed(&Path::new(ROOT).join(linear))["bounds"].clone();
    for name in ["q_rms", "q_t_rms", "q_e_max", "f_x", "q_tx", "q_te"] {
        bounds[name] = json!("1");
    }
    vec![
        with(linear, &[("$schema", json!("x"))]),
        with(
            linear,
            &[
                ("lyapunov", lyapunov),
                ("bounds", bounds),
                ("q_0", q_0),
                ("domain", json!({ "X": 1, "E": 1 })),
                ("relative_degree", json!({ "a": ["1/2"] })),
                ("internal_model", explicit),
                ("initial_set", at_rest),
                ("input_gain", json!({ "nominal": 1, "low": "4/5", "high": 1.25 })),
                ("actuator", json!({ "max": "3*pi" })),
                ("measurement", json!({ "noise": 0.01, "quantum": "1/300" })),
                ("arithmetic", json!("double")),
                ("disturbance", json!("0")),
            ],
        ),
        with(
            linear,
            &[
                ("lyapunov", json!({ "jacobian": [["-1", ["0", "1/2"]], [0, "-2 + cos(2*pi*t)"]] })),
                ("initial_set", json!({ "kind": "box", "X0": 0, "E0": 0, "Z0": 0 })),
            ],
        ),
    ]
}

fn plants() -> Vec<Value> {
    let file = "specs/plants/paper-example.json";
    let start = json!({ "x": [0, 0], "e": 0, "z": [0] });
    let explicit = json!({ "mu": 1, "base_frequency": "2*pi", "matched": true, "sampling_period": "1/100", "delay_samples": 1,
        "harmonics": "first", "weights": { "family": "explicit", "values": [2, 1], "tail": { "coefficient": 1, "exponent": "3/2" } } });
    let set = |set: Value| with(file, &[("initial_set", set), ("domain", json!({ "x": 1, "e": 1 }))]);
    vec![
        with(file, &[("$schema", json!("x")), ("initial", start)]),
        with(file, &[("parameters", json!({ "k": "1/5", "J": { "nominal": 2, "low": 1, "high": 3 } }))]),
        with(
            file,
            &[
                ("internal_model", explicit),
                ("input_gain", json!({ "nominal": 2, "low": 1, "high": 3 })),
                ("actuator", json!({ "max": 30 })),
                ("measurement", json!({ "noise": "0.01", "quantum": 0 })),
                ("arithmetic", json!("exact")),
                ("disturbance", json!(2)),
            ],
        ),
        with(file, &[("actuator", json!({ "min": "-1/2", "max": 4 }))]),
        set(json!({ "kind": "paper" })),
        set(json!({ "kind": "at-rest" })),
        set(json!({ "kind": "at-rest", "ball": 1, "E0": 1 })),
        set(json!({ "kind": "box", "X0": 1, "E0": 1, "Z0": 1 })),
        set(json!({ "kind": "box", "ball": 1, "E0": 1, "Z0": 1 })),
    ]
}

fn studies() -> Vec<Value> {
    let file = "specs/studies/linear.json";
    let logarithmic = json!([{ "pointer": "/period", "logarithmic": { "from": 1, "to": 2, "count": 3 } }]);
    let latin = json!([{ "pointer": "/period", "name": "T", "linear": { "from": 1, "to": 2 } },
        { "pointer": "/name", "values": ["a", 1, true] }]);
    let embedded = parsed(&Path::new(ROOT).join("specs/linear.json"));
    let named = with("specs/plants/paper-example.json", &[("parameters", json!({ "k": "1/5" }))]);
    let by_name = json!([{ "parameter": "k", "values": ["1/5", "1/4"] }]);
    vec![
        with(file, &[("subject", named), ("parameters", by_name)]),
        with(file, &[("$schema", json!("x")), ("derivation", json!("sharp")), ("subject", embedded)]),
        with(file, &[("parameters", logarithmic), ("sampling_period", json!("1/9"))]),
        with(file, &[("design", json!("latin")), ("count", json!(3)), ("seed", json!(1)), ("parameters", latin)]),
    ]
}

#[test]
fn the_schemas_know_what_the_readers_know() {
    let specification = |text: &str| Specification::from_json("x", text).err();
    let plant = |text: &str| Plant::from_json("x", text).err();
    let study = |text: &str| Document::parse("x", text).and_then(|document| Study::read(&document)).err();
    let readers: [(Schema, Reader<'_>, Vec<Value>, usize); 3] = [
        (Schema::Specification, &specification, specifications(), 18),
        (Schema::Plant, &plant, plants(), 24),
        (Schema::Study, &study, studies(), 10),
    ];
    for (schema, read, documents, least) in readers {
        let json = schema.json();
        let mut used = BTreeSet::new();
        let mut objects = 0;
        for document in &documents {
            let found = validator(schema).complaints(document);
            assert_eq!(found, None, "{document}");
            objects += compared(read, document, &json);
            names(document, &mut used);
        }
        assert!(objects >= least, "{}: {objects} objects", schema.name());
        // Every property is in one of the documents, which the reader takes.
        let mut all = BTreeSet::new();
        properties_of(&json, &mut all);
        assert_eq!(all.difference(&used).collect::<Vec<_>>(), Vec::<&String>::new(), "{}", schema.name());
    }
}

/// The names of all fields.
fn names(value: &Value, found: &mut BTreeSet<String>) {
    match value {
        Value::Object(fields) => fields.iter().for_each(|(name, value)| {
            found.insert(name.clone());
            names(value, found);
        }),
        Value::Array(elements) => elements.iter().for_each(|value| names(value, found)),
        _ => {}
    }
}

/// The names of all properties.
pub fn properties_of(schema: &Value, found: &mut BTreeSet<String>) {
    if let Some(properties) = schema.get("properties").and_then(Value::as_object) {
        for (name, schema) in properties {
            found.insert(name.clone());
            properties_of(schema, found);
            assert!(schema["title"].as_str().is_some_and(|title| !title.is_empty()), "{name} has no title");
            assert!(schema["description"].as_str().is_some_and(|text| text.len() > 5), "{name} has no description");
        }
    }
    for keyword in ["items", "additionalProperties"] {
        schema.get(keyword).into_iter().for_each(|schema| properties_of(schema, found));
    }
    schema.get("oneOf").and_then(Value::as_array).into_iter().flatten().for_each(|schema| properties_of(schema, found));
}
