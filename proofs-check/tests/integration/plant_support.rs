//! Plants with the parts of a witness that are about their formulas, and what the rules of section 11 say of them.

use super::common::folder;
use proofs_check::effort;
use proofs_check::json::{Field, Json, parse};
use proofs_check::plant;
use proofs_check::spec::Specification;
use proofs_check::verdict::{Finding, Outcome};
use rug::Float;
use serde_json::Value;

/// A file of `tests/plants`: a plant, and parts of a witness.
pub fn stored(name: &str) -> Value {
    let text = std::fs::read_to_string(folder("plants").join(format!("{name}.json"))).unwrap();
    serde_json::from_str(&text).unwrap()
}

fn read(parts: &Value) -> Outcome<Specification> {
    let parse = |part: &str| -> Json { parse(parts[part].to_string().as_bytes()).unwrap() };
    let (plant, witness) = (parse("plant"), parse("witness"));
    let mut fields = Field { json: &witness, pointer: "/witness".to_owned() }.fields()?;
    let spec = plant::read::read(&Field { json: &plant, pointer: "/plant".to_owned() }, &mut fields)?;
    fields.finish().map(|()| spec)
}

/// Applies the rules of section 11; the lines of the argument.
pub fn judged(parts: &Value) -> Result<Vec<String>, Finding> {
    let spec = read(parts).map_err(|finding| *finding)?;
    let plant = spec.plant.as_ref().expect("it is a plant");
    let none = Float::new(128);
    let mut lines = Vec::new();
    let (answer, steps) =
        effort::limited(effort::LIMIT, || plant::prove(&spec, plant, [&none, &none], &mut lines));
    lines.push(format!("{steps} steps"));
    answer.map(|()| lines).map_err(|finding| *finding)
}
