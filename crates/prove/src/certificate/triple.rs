//! The Lyapunov triple of a Jacobian as a part of a certificate.

use super::json::{rows, series, text};
use serde_json::{Map, Value};
use sigmastar_lang::spec::Specification;
use sigmastar_lang::spec::model::{Lyapunov, LyapunovSource, PeriodicMatrix};

/// P(t) as fields: `P` are the rows of the mean, and `harmonics`, where there are any, lists `cos` and `sin` of k = 1, 2, ...
#[must_use]
pub fn matrix_json(matrix: &PeriodicMatrix) -> Map<String, Value> {
    series("P", matrix, |part| rows(part)).into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
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
    let numbers = [("p_low", &triple.p_low), ("p_up", &triple.p_up), ("alpha", &triple.alpha)];
    let numbers = numbers.map(|(name, value)| (name.to_owned(), text(value.text.clone())));
    Value::Object(matrix_json(matrix).into_iter().chain(numbers).collect())
}
