//! The Lyapunov triple of a Jacobian as a part of a certificate.

use rug::Rational;
use serde_json::{Map, Value};
use sigmastar_exact::number::write_exact;
use sigmastar_lang::spec::Specification;
use sigmastar_lang::spec::model::{Lyapunov, LyapunovSource, PeriodicMatrix};

/// Lists of exact rationals.
pub(super) fn rows(matrix: &[Vec<Rational>]) -> Value {
    let row = |row: &Vec<Rational>| Value::Array(row.iter().map(|entry| Value::from(write_exact(entry))).collect());
    Value::Array(matrix.iter().map(row).collect())
}

/// P(t) as fields: `P` are the rows of the mean, and `harmonics`, where there are any, lists `cos` and `sin` of k = 1, 2, ...
#[must_use]
pub fn matrix_json(matrix: &PeriodicMatrix) -> Map<String, Value> {
    let mut fields = Map::new();
    fields.insert("P".to_owned(), rows(&matrix.mean));
    if !matrix.harmonics.is_empty() {
        let one = |[cos, sin]: &[Vec<Vec<Rational>>; 2]| {
            let mut pair = Map::new();
            pair.insert("cos".to_owned(), rows(cos));
            pair.insert("sin".to_owned(), rows(sin));
            Value::Object(pair)
        };
        fields.insert("harmonics".to_owned(), Value::Array(matrix.harmonics.iter().map(one).collect()));
    }
    fields
}

/// The parts `witness.lyapunov` and `witness.lyapunov_existence` of a certificate: P(t) and the triple of each; none where the
/// user gave the triple. For a plant `witness.lyapunov` is that of the orbit too.
#[must_use]
pub fn lyapunov_parts(spec: &Specification) -> Vec<(&'static str, Value)> {
    let (triple, matrix, existence) = match &spec.lyapunov {
        LyapunovSource::Proved { triple, matrix, existence, .. } => (triple, matrix, existence.as_deref()),
        LyapunovSource::Plant(plant) => (&plant.triple, &plant.matrix, plant.existence.as_deref()),
        LyapunovSource::Given(_) | LyapunovSource::Wanted(_) => return Vec::new(),
    };
    let stability = (STABILITY, part(triple, matrix));
    let existence = existence.map(|(triple, matrix)| (EXISTENCE, part(triple, matrix)));
    std::iter::once(stability).chain(existence).collect()
}

/// The field of the triple of stability.
pub(super) const STABILITY: &str = "lyapunov";

/// The field of the triple of existence.
pub(super) const EXISTENCE: &str = "lyapunov_existence";

fn part(triple: &Lyapunov, matrix: &PeriodicMatrix) -> Value {
    let mut fields = matrix_json(matrix);
    for (name, value) in [("p_low", &triple.p_low), ("p_up", &triple.p_up), ("alpha", &triple.alpha)] {
        fields.insert(name.to_owned(), Value::from(value.text.clone()));
    }
    Value::Object(fields)
}
