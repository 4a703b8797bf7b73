//! `docs/formats.md` against the readers and against what the program writes: no example on it is wrong, and no field
//! that is read or written is missing from it.

use crate::cells;
use crate::no_plant::{JACOBIAN, write};
use crate::sampled;
use crate::schemas::properties_of;
use crate::support::{EXAMPLE, PLANT, ROOT, certified_in, document, files, options, program, read, refuted_witness};
use serde_json::{Value, json};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Document, Specification};
use sigmastar_prove::certificate::{certificate_json, sampled_certificate_json};
use sigmastar_prove::certify::{Options, TransferChoice, certify, resolve};
use sigmastar_regulator::read_regulator;
use sigmastar_schema::Schema;
use sigmastar_studies::sweep::Study;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::OnceLock;

/// How many blocks of each kind there are at least.
const LEAST: [(&str, usize); 19] = [
    ("bounding-spec", 1),
    ("bounding-spec-part", 10),
    ("plant", 2),
    ("controller", 1),
    ("certificate-fragment", 12),
    ("report-fragment", 4),
    ("sampling-fragment", 1),
    ("study", 1),
    ("case-fragment", 1),
    ("tune-fragment", 1),
    ("design-fragment", 1),
    ("transfer-fragment", 2),
    ("check-fragment", 2),
    ("lyapunov-fragment", 1),
    ("errata-fragment", 1),
    ("constants-fragment", 1),
    ("simulation-fragment", 1),
    ("falsification-fragment", 1),
    ("reproduction-fragment", 1),
];

fn file(path: &str) -> String {
    std::fs::read_to_string(format!("{ROOT}/{path}")).unwrap_or_else(|error| panic!("{path}: {error}"))
}

fn page() -> String {
    file("docs/formats.md")
}

fn parsed(text: &str, what: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{what}: {error}\n{text}"))
}

/// A fenced block.
#[derive(Debug)]
struct Block {
    /// The words behind the fence.
    info: Vec<String>,
    line: usize,
    text: String,
}

impl Block {
    fn place(&self) -> String {
        format!("docs/formats.md, line {} ({})", self.line, self.info.join(" "))
    }

    fn value(&self) -> Value {
        parsed(&self.text, &self.place())
    }

    /// The file that the block names as its source.
    fn source(&self) -> Option<Value> {
        self.info.get(2).map(|path| parsed(&file(path), path))
    }
}

fn blocks(page: &str) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::new();
    let mut open = false;
    for (index, line) in page.lines().enumerate() {
        match line.strip_prefix("```") {
            Some("") if open => open = false,
            Some(info) => {
                assert!(!open, "line {}: a fence inside a block", index + 1);
                let info = info.split_whitespace().map(str::to_owned).collect();
                blocks.push(Block { info, line: index + 1, text: String::new() });
                open = true;
            }
            None if open => {
                let text = &mut blocks.last_mut().expect("one is open").text;
                text.push_str(line);
                text.push('\n');
            }
            None => {}
        }
    }
    assert!(!open, "the last block is not closed");
    blocks
}

/// The places and types of all fields of many documents. Elements of an array have one place.
#[derive(Default, Debug)]
struct Shape {
    types: BTreeSet<&'static str>,
    fields: BTreeMap<String, Shape>,
    elements: Option<Box<Shape>>,
}

fn type_name(value: &Value) -> &'static str {
    match value {
        Value::Null => "null",
        Value::Bool(_) => "a Boolean",
        Value::Number(_) => "a number",
        Value::String(_) => "a string",
        Value::Array(_) => "an array",
        Value::Object(_) => "an object",
    }
}

impl Shape {
    fn of<'v>(documents: impl IntoIterator<Item = &'v Value>) -> Shape {
        let mut shape = Shape::default();
        documents.into_iter().for_each(|document| shape.add(document));
        shape
    }

    fn add(&mut self, value: &Value) {
        self.types.insert(type_name(value));
        match value {
            Value::Object(fields) => {
                fields.iter().for_each(|(name, value)| self.fields.entry(name.clone()).or_default().add(value));
            }
            Value::Array(elements) => {
                let shape = self.elements.get_or_insert_default();
                elements.iter().for_each(|value| shape.add(value));
            }
            _ => {}
        }
    }

    /// What of a fragment has no place in the documents.
    fn misfits(&self, value: &Value, pointer: &str, found: &mut Vec<String>) {
        if !self.types.contains(type_name(value)) {
            found.push(format!("{pointer} is {}, where the program writes {:?}", type_name(value), self.types));
        }
        match value {
            Value::Object(fields) => {
                for (name, value) in fields {
                    let pointer = format!("{pointer}/{name}");
                    match self.fields.get(name) {
                        Some(shape) => shape.misfits(value, &pointer, found),
                        None => found.push(format!("{pointer} is never written")),
                    }
                }
            }
            Value::Array(elements) => {
                let none = Shape::default();
                let shape = self.elements.as_deref().unwrap_or(&none);
                elements.iter().for_each(|value| shape.misfits(value, &format!("{pointer}/*"), found));
            }
            _ => {}
        }
    }

    /// Every name of a field, but for those below `but`.
    fn names(&self, pointer: &str, but: &[&str], found: &mut BTreeMap<String, String>) {
        for (name, shape) in &self.fields {
            let pointer = format!("{pointer}/{name}");
            // The names of the constants are data; what is below each of them is not.
            if pointer.rsplit('/').nth(1) != Some("constants") {
                found.insert(name.clone(), pointer.clone());
            }
            if !but.contains(&name.as_str()) {
                shape.names(&pointer, but, found);
            }
        }
        if let Some(shape) = &self.elements {
            shape.names(&format!("{pointer}/*"), but, found);
        }
    }
}

/// Where a fragment has another value than its source. Elements of arrays may be left out, but not move.
fn differences(fragment: &Value, source: &Value, pointer: &str, found: &mut Vec<String>) {
    match (fragment, source) {
        (Value::Object(fragment), Value::Object(source)) => {
            for (name, value) in fragment {
                let pointer = format!("{pointer}/{name}");
                match source.get(name) {
                    Some(source) => differences(value, source, &pointer, found),
                    None => found.push(format!("{pointer} is not in the file")),
                }
            }
        }
        (Value::Array(fragment), Value::Array(source)) => {
            let mut rest = source.iter();
            for (index, value) in fragment.iter().enumerate() {
                let same = |source: &&Value| {
                    let mut found = Vec::new();
                    differences(value, source, "", &mut found);
                    found.is_empty()
                };
                if rest.find(same).is_none() {
                    found.push(format!("{pointer}/{index} is not in the file, or not in this order"));
                    return;
                }
            }
        }
        _ if fragment == source => {}
        _ => found.push(format!("{pointer} is {fragment}, in the file {source}")),
    }
}

/// The example with fields in place of its own.
fn replaced(part: &Value) -> String {
    let mut document = parsed(&file("specs/linear.json"), "the example");
    let (fields, part) = (document.as_object_mut().expect("an object"), part.as_object().expect("an object"));
    part.iter().for_each(|(name, value)| drop(fields.insert(name.clone(), value.clone())));
    document.to_string()
}

fn specification(text: &str, what: &str) -> Specification {
    Specification::from_json(what, text).unwrap_or_else(|errors| panic!("{what}\n{}", errors.render(false)))
}

fn certificate(spec: &Specification, options: Options) -> Value {
    let proved = resolve(spec).map(|found| found.map(|found| found.spec).unwrap_or_else(|error| panic!("{error}")));
    let run = certify(proved.as_ref().unwrap_or(spec), options).expect("the bounding functions are proved");
    certificate_json(&run).expect("it certifies")
}

/// Runs the program and reads what it writes to standard output; with the exit code.
fn run(code: i32, arguments: &[&str]) -> Value {
    let output = program().args(arguments).assert().code(code);
    parsed(&String::from_utf8_lossy(&output.get_output().stdout), &arguments.join(" "))
}

const AT_REST: &str = "specs/paper-example-rms-at-rest.json";
const VALID: &str = "proofs-check/tests/certificates/paper-example.means.json";

/// No plant with a state has these data.
fn without_plant(lyapunov: Value, f: &str) -> String {
    let mut part = json!({ "lyapunov": lyapunov, "domain": { "X": "1e6", "E": "1e6" } });
    part["bounds"] = json!({
        "f": f, "f_e": "0", "f_xx": "0", "f_ex": "0", "q": "1 + X/10", "q_e": "0.1", "q_x": "0.1", "q_t": "1",
    });
    replaced(&part)
}

fn certificates() -> Vec<Value> {
    let example = specification(&file(EXAMPLE), EXAMPLE);
    let of = |name: &str| {
        let file = parsed(&file(&format!("proofs-check/tests/certificates/{name}.json")), name);
        specification(&file["specification"].to_string(), name)
    };
    let quick = options();
    let mut all = vec![
        certificate(&example, Options::default()),
        certificate(&example, Options { transfer: TransferChoice::Boxes, ..Options::default() }),
    ];
    for name in ["periodic-jacobian.sharp", "refined.means", "two-matrices.means"] {
        all.push(certificate(&of(name), quick));
    }
    let triple = json!({ "p_low": "1", "p_up": "1", "alpha": "50" });
    let jacobian = json!({ "jacobian": [["-2", "1"], ["-1", "-2"]] });
    for (lyapunov, f) in [(triple, "0.01*X"), (jacobian, "2.1*X")] {
        let none = certificate(&specification(&without_plant(lyapunov, f), "no plant"), quick);
        assert!(none["no_plant"].is_object(), "{}", none["no_plant"]);
        all.push(none);
    }
    all.push(sampled_certificate());
    all.extend(["family-gain", "trials"].map(|name| read(format!("{ROOT}/proofs-check/tests/by-n-o/{name}.json"))));
    all
}

/// That of the example on the page.
fn sampled_certificate() -> Value {
    let mut document = parsed(&file("specs/paper-example-rms-at-rest.json"), "the example at rest");
    document["internal_model"]["sampling_period"] = json!("1/1000");
    let spec = specification(&document.to_string(), "sampled");
    sampled_certificate_json(&sampled::run(&spec, Some("25"))).expect("it certifies")
}

/// The lines of a study at samples with a case that is certified, one that is not and one that is refused.
fn lines_of_cases() -> Vec<Value> {
    let study = json!({
        "format": "sigmastar/study", "version": 1, "name": "study", "subject": parsed(&file(AT_REST), AT_REST),
        "sampling_period": "1/100", "design": "grid",
        "parameters": [{ "pointer": "/internal_model/mu", "values": ["1", "1000", "-1"] }],
    });
    let nowhere = |_: &str| Err("it stands in the study".to_owned());
    let study = sigmastar::Study::from_bytes("study.json", study.to_string().as_bytes(), nowhere).expect("a study");
    let line = |index: u64| parsed(&study.run_case(index).expect("a line"), "a line");
    let lines: Vec<Value> = (0..study.cases()).map(line).collect();
    assert!(lines.iter().any(|line| line["reason"].is_string()) && lines.iter().any(|line| line["errors"].is_array()));
    lines
}

/// What the program writes under each format, as it is now: by the kind of the fragments.
fn written() -> &'static BTreeMap<&'static str, Vec<Value>> {
    static WRITTEN: OnceLock<BTreeMap<&'static str, Vec<Value>>> = OnceLock::new();
    WRITTEN.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| folder.path().join(name).display().to_string();
        let narrow = path("narrow.json");
        let far = json!({ "kind": "box", "X0": "1", "E0": "4", "Z0": "0" });
        let mut document = parsed(&file(EXAMPLE), EXAMPLE);
        (document["domain"], document["initial_set"]) = (json!({ "X": "1", "E": "1" }), far);
        std::fs::write(&narrow, document.to_string()).expect("written");

        let json = ["--format", "json"];
        let report = |code, arguments: &[&str]| run(code, &[&["certify", "-q"], arguments, &json].concat());
        let other = |arguments: &[&str]| run(0, &[arguments, &json].concat());
        let reproduced = |only: &str, name: &str| {
            let folder = path(name);
            let noise = ["--seeds", "1", "--noise-steps", "1000"];
            program().args(["reproduce", "-q", "--only", only, "-o", &folder]).args(noise).assert().code(0);
            read(format!("{folder}/report.json"))
        };
        let falsify = ["falsify", "-q", "--trials", "2", VALID];
        BTreeMap::from([
            ("certificate-fragment", certificates()),
            (
                "report-fragment",
                vec![
                    report(0, &[EXAMPLE, "--target-sup", "0.1", "--target-rms", "0.01"]),
                    report(0, &["specs/relative-degree-2.json"]),
                    report(0, &["specs/motor-axis-friction.json"]),
                    report(1, &[EXAMPLE, "--witness", refuted_witness()]),
                    report(2, &["specs/invalid/many-errors.json"]),
                    report(2, &["specs/invalid/misspelt-field.json"]),
                    report(2, &["nowhere.json"]),
                    report(3, &[&narrow]),
                    report(0, &[AT_REST, "--sampling-period", "1/1000", "--sigma", "25"]),
                    report(3, &[AT_REST, "--sampling-period", "1/100", "--sigma", "1"]),
                ],
            ),
            (
                "sampling-fragment",
                vec![other(&["sampling", "-q", AT_REST, "--sampling-period", "1/1000", "--sigma", "1,25"])],
            ),
            (
                "transfer-fragment",
                vec![
                    other(&["transfer", "-q", EXAMPLE, "--k0", "2*pi^2", "--n-o", "0,1,inf", "--sets"]),
                    run(1, &["transfer", "-q", EXAMPLE, "--k0", "1", "--format", "json"]),
                ],
            ),
            (
                "check-fragment",
                vec![other(&["check", VALID]), run(1, &["check", refuted_witness(), "--format", "json"])],
            ),
            ("case-fragment", lines_of_cases()),
            (
                "design-fragment",
                vec![
                    other(&[
                        "design",
                        "-q",
                        PLANT,
                        "--steady-error",
                        "0.2",
                        "--settle",
                        "90",
                        "--sigma",
                        "8",
                        "--n-o",
                        "0,2",
                    ]),
                    other(&["design", "-q", AT_REST, "--sampling-period", "1/1000", "--sigma", "25", "--n-o", "0"]),
                ],
            ),
            ("tune-fragment", vec![other(&["tune", "-q", EXAMPLE, "--over", "mu", "--tries", "8"])]),
            ("lyapunov-fragment", vec![other(&["lyapunov", "specs/paper-example-jacobian.json"])]),
            ("errata-fragment", vec![other(&["errata"]), other(&["errata", "specs/linear.json"])]),
            ("constants-fragment", vec![other(&["constants", EXAMPLE])]),
            ("controller", {
                let parameters = ["controller", EXAMPLE, "--sigma", "48", "--n-o", "1"];
                let certified = ["controller", VALID, "--n-o", "0", "--discretise", "1/1000", "--saturation", "9"];
                let sampled = path("sampled.json");
                std::fs::write(&sampled, sampled_certificate().to_string()).expect("written");
                vec![
                    other(&["controller", &sampled, "--n-o", "3"]),
                    other(&parameters),
                    other(&[&parameters[..], &["--discretise", "1/1000"]].concat()),
                    other(&certified),
                ]
            }),
            ("simulation-fragment", {
                let quick = ["simulate", "-q", PLANT, "--sigma", "2", "--periods", "2"];
                let noise = ["--noise-power", "1e-3", "--noise-steps", "1000", "--fixed", "1000"];
                let at_samples = ["--sampled", "1/100", "--delay", "1/200", "--saturation", "50"];
                let stiff = ["simulate", "-q", PLANT, "--sigma", "100000", "--n-o", "2", "--fixed", "20000"];
                vec![
                    other(&[&quick[..], &["--n-o", "1"]].concat()),
                    other(&[&quick[..], &["--high-gain"], &noise].concat()),
                    run(3, &[&stiff[..], &json].concat()),
                    other(&[&quick[..], &["--n-o", "1"], &at_samples].concat()),
                    run(
                        3,
                        &[&quick[..], &["--n-o", "1", "--sampled", "1/50", "--quantise", "0.1,0.1"], &json].concat(),
                    ),
                ]
            }),
            ("falsification-fragment", {
                let at_samples = path("samples.json");
                std::fs::write(&at_samples, crate::sampled_falsify::CERTIFICATE.to_string()).expect("written");
                vec![
                    other(&[&falsify[..], &["--base-frequency", "3*pi"]].concat()),
                    other(&["falsify", "-q", "--trials", "2", &at_samples]),
                ]
            }),
            ("reproduction-fragment", vec![reproduced("table1", "table1"), reproduced("noise", "noise")]),
        ])
    })
}

#[test]
fn every_example_is_right() {
    let blocks = blocks(&page());
    for (kind, least) in LEAST {
        let count = blocks.iter().filter(|block| block.info.get(1).is_some_and(|found| found == kind)).count();
        assert!(count >= least, "{count} blocks of the kind {kind}, not {least}");
    }
    let mut wrong = Vec::new();
    for block in &blocks {
        let place = block.place();
        let words: Vec<&str> = block.info.iter().map(String::as_str).collect();
        let kind = match words[..] {
            ["json", kind] | ["json", kind, _] => kind,
            ["csv", "simulation"] => {
                csv_is_written(block);
                continue;
            }
            _ => panic!("{place}: it is not said what reads this block"),
        };
        let value = block.value();
        let mut found = Vec::new();
        if let Some(source) = block.source() {
            differences(&value, &source, "", &mut found);
            let whole = matches!(kind, "bounding-spec" | "plant" | "study");
            assert!(!whole || value == source, "{place}: not the whole file");
        }
        match kind {
            "bounding-spec" => drop(specification(&block.text, &place)),
            "bounding-spec-part" => drop(specification(&replaced(&value), &place)),
            "plant" => {
                let plant = Plant::from_json(&place, &block.text);
                plant.map(drop).unwrap_or_else(|errors| panic!("{place}\n{}", errors.render(false)));
            }
            "study" => {
                let document = Document::parse(&place, &block.text).expect("JSON");
                Study::read(&document).map(drop).unwrap_or_else(|errors| panic!("{place}\n{}", errors.render(false)));
            }
            kind => {
                let documents = written().get(kind);
                let documents = documents.unwrap_or_else(|| panic!("{place}: nothing of this kind is written"));
                Shape::of(documents).misfits(&value, "", &mut found);
                if kind == "controller" {
                    let document = Document::parse(&place, &block.text).expect("JSON");
                    read_regulator(&document).unwrap_or_else(|errors| panic!("{place}\n{}", errors.render(false)));
                }
            }
        }
        wrong.extend(found.into_iter().map(|message| format!("{place}: {message}")));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The first lines of the samples are those of the block, which has no others.
fn csv_is_written(block: &Block) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("samples.csv");
    let arguments = ["simulate", "-q", PLANT, "--sigma", "2", "--n-o", "1", "--periods", "1", "--samples", "2"];
    program().args(arguments).arg("--csv").arg(&path).assert().code(0);
    let text = std::fs::read_to_string(path).expect("written");
    assert!(text.starts_with(&block.text), "{}: {text}", block.place());
}

/// The names that stand on the page as code: between backquotes, or as keys of the examples.
fn named(page: &str) -> BTreeSet<String> {
    let name = |c: char| c.is_alphanumeric() || c == '_';
    let prose: String = {
        let mut open = false;
        let keep = |line: &&str| {
            let fence = line.starts_with("```");
            open ^= fence;
            !open && !fence
        };
        page.lines().filter(keep).map(|line| format!("{line}\n")).collect()
    };
    let code = prose.split('`').skip(1).step_by(2);
    let mut names: BTreeSet<String> = code.flat_map(|code| code.split(|c| !name(c))).map(str::to_owned).collect();
    let mut keys = BTreeMap::new();
    for block in blocks(page).iter().filter(|block| block.info[0] == "json") {
        Shape::of([&block.value()]).names("", &[], &mut keys);
    }
    names.extend(keys.into_keys());
    names
}

#[test]
fn every_field_that_is_written_is_named() {
    let named = named(&page());
    let mut missing = Vec::new();
    for (kind, documents) in written() {
        let mut fields = BTreeMap::new();
        // The specification inside a certificate is the user's.
        let but: &[&str] = if *kind == "certificate-fragment" { &["specification"] } else { &[] };
        Shape::of(documents).names("", but, &mut fields);
        assert!(fields.len() > 5, "{kind}: {fields:?}");
        let absent = fields.into_iter().filter(|(name, _)| !named.contains(name));
        missing.extend(absent.map(|(_, pointer)| format!("{kind}: {pointer}")));
    }
    assert!(missing.is_empty(), "docs/formats.md does not name\n{}", missing.join("\n"));
}

/// Certificates of every kind: what they hold stands on the page, but for the file of the user that is inside of them and its names of
/// parameters.
#[test]
fn every_field_of_a_certificate_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let contradicted = read(write(folder.path(), JACOBIAN, "2.1*X", "0"));
    let axis = document("plants/motor-axis");
    let no_x = |fields: &[(&str, Value)]| {
        let mut made = document("no-x");
        fields.iter().for_each(|(name, value)| made[*name] = value.clone());
        made
    };
    let uncertain = no_x(&[("input_gain", json!({ "nominal": 1, "low": 0.9, "high": 1.1 }))]);
    let noisy = no_x(&[("measurement", json!({ "noise": "1e-6", "quantum": "1e-6" })), ("disturbance", json!("1e-6"))]);
    let doubles = no_x(&[("arithmetic", json!("double"))]);
    let made: [(&Value, &[&str]); 9] = [
        // One whose Jacobian contradicts its bounds.
        (&contradicted, &[]),
        // A plant whose existence rests on a matrix inequality.
        (&document("plants/converter"), &[]),
        // One at samples, where stability and existence rest on matrix inequalities.
        (&axis, &["--sampling-period", "1/50000"]),
        // An actuator whose gain is known to an interval.
        (&uncertain, &[]),
        // Noise and a disturbance, for given n_o; and rounding, at samples.
        (&noisy, &["--sigma", "6", "--n-o", "1"]),
        (&doubles, &["--sigma", "6.5", "--sampling-period", "(1)/120", "--n-o", "1"]),
        // A rate of a plant whose claim rests on a matrix inequality.
        (&axis, &["--sigma", "23", "--n-o", "1"]),
        // The same on a path with a corner, where the parts of the derivatives are known apart.
        (&document("plants/paper-example"), &["--sigma", "9.1", "--n-o", "0"]),
        // A family whose parameters are cut into cells.
        (&cells::family(["1.7", "2.3"]), &[]),
    ];
    let made = made.map(|(document, flags)| {
        read(certified_in(folder.path(), document, &[&["--no-alternatives"], flags].concat()).0)
    });
    let folders = ["certificates", "sampled", "plants", "actuator", "rates", "noise", "arithmetic", "gain", "periods"];
    let stored = folders.iter().flat_map(|folder| files(&format!("proofs-check/tests/{folder}"))).map(read);
    let is_certificate = |file: &Value| file["format"] == "sigmastar/certificate";
    let all: Vec<Value> = stored.filter(is_certificate).chain(made).collect();
    let mut fields = BTreeMap::new();
    Shape::of(&all).names("", &["specification", "plant", "parameters"], &mut fields);
    // Parts that few of them have.
    for rare in
        ["no_plant", "comparison", "matrix_inequality", "existence_inequality", "joint_inequality", "cells", "Pi"]
    {
        assert!(fields.contains_key(rare), "no certificate has `{rare}`");
    }
    let named = named(&page());
    let missing: Vec<&String> =
        fields.iter().filter(|(name, _)| !named.contains(*name)).map(|(_, pointer)| pointer).collect();
    assert!(missing.is_empty(), "docs/formats.md does not name {missing:?}");
}

/// The schemas know exactly the fields that the readers know (`schemas.rs`).
#[test]
fn every_field_that_is_read_is_named() {
    let named = named(&page());
    for schema in Schema::ALL {
        let mut fields = BTreeSet::new();
        properties_of(&schema.json(), &mut fields);
        let missing: Vec<&String> =
            fields.iter().filter(|name| !named.contains(name.trim_start_matches('$'))).collect();
        assert!(missing.is_empty() && fields.len() > 15, "docs/formats.md does not name {missing:?}");
    }
}
