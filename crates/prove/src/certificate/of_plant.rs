//! What a certificate of a plant adds to the witness (derivation, 11).

use super::fields::{
    CELLS, EXISTENCE_INEQUALITY, INEQUALITY, JOINT_INEQUALITY, NumberFields, SENSITIVITIES, SPLITTING,
};
use super::json::{exact, listed, object, rows, series, vector};
use rug::Rational;
use serde_json::Value;
use sigmastar_lang::spec::{
    Interval, JointInequality, JointStability, Level, MatrixInequality, Metric, ProvedCell, ProvedForcing, ProvedOrbit,
    ProvedValue, ProvedValues, SampledInequalities, Specification, Splitting, TrigonometricVector, Wave,
};

/// `coordinates`, `orbit` and `forcing` or `cells`, and `bounds`, and the matrix inequalities that are used; none where the data do not come from a plant's formulas.
#[must_use]
pub fn plant_parts(spec: &Specification) -> Vec<(&'static str, Value)> {
    let Some(plant) = spec.plant() else { return Vec::new() };
    let values = spec.bounds.proved_values();
    let around = |ProvedCell { orbit, forcing, .. }: &ProvedCell| {
        vec![("orbit", orbit_json(orbit)), ("forcing", forcing_json(forcing))]
    };
    let cell = |cell: &ProvedCell| {
        let ends =
            |(_, Interval { low, high, .. }): (&str, &Interval)| object([("low", exact(low)), ("high", exact(high))]);
        let ends = cell.parameters.named_intervals().map(ends).collect();
        object([("parameters", ends)].into_iter().chain(around(cell)))
    };
    let mut parts = vec![("coordinates", rows(&plant.coordinates))];
    parts.extend(match plant.undivided() {
        Some(whole) => around(whole),
        None => vec![(CELLS, plant.cells.iter().map(cell).collect())],
    });
    parts.push(("bounds", values_json(values)));
    parts.extend(values.inequality.as_ref().map(|inequality| (INEQUALITY, inequality_json(inequality))));
    parts.extend(
        values.existence.as_ref().map(|existence| (EXISTENCE_INEQUALITY, existence_json(existence, &existence.matrix))),
    );
    parts.extend(values.joint_stability.as_ref().map(|joint| (JOINT_INEQUALITY, joint_stability_json(joint))));
    parts.extend(values.joint_existence.as_ref().map(|joint| (EXISTENCE_INEQUALITY, joint_existence_json(joint))));
    let SampledInequalities { stability, existence } = &values.at_samples;
    parts.extend(stability.as_ref().map(|known| (INEQUALITY, object(known.json()))));
    parts.extend(existence.as_ref().map(|known| (EXISTENCE_INEQUALITY, existence_json(known, &known.matrix))));
    parts
}

/// The joint inequality of existence, by its fields.
#[must_use]
pub fn joint_existence_json(joint: &JointInequality) -> Value {
    joint_json(joint, [None; 2])
}

/// That of stability.
#[must_use]
pub fn joint_stability_json(JointStability { inequality, levels: [near, far] }: &JointStability) -> Value {
    joint_json(inequality, [Some(near), Some(far)])
}

/// The near metric has a p; the far one has none.
fn joint_json(joint: &JointInequality, levels: [Option<&Level>; 2]) -> Value {
    let metric = |metric: &Metric, is_near: bool, level: Option<&Level>| {
        let cross = is_near.then(|| ("p", vector(&metric.cross)));
        let level = level.into_iter().flat_map(NumberFields::json);
        object([("P", rows(&metric.matrix))].into_iter().chain(cross).chain(metric.json()).chain(level))
    };
    let [of_near, of_far] = levels;
    let metrics = [("near", metric(&joint.near, true, of_near)), ("far", metric(&joint.far, false, of_far))];
    object(joint.json().into_iter().chain(metrics))
}

/// An inequality of existence: P stands behind X and E.
fn existence_json(known: &impl NumberFields, matrix: &[Vec<Rational>]) -> Value {
    let mut fields = known.json();
    fields.insert(2, ("P", rows(matrix)));
    object(fields)
}

fn inequality_json(known: &MatrixInequality) -> Value {
    let of = |splitting: &Splitting| object(splitting.json().into_iter().chain([("S", rows(&splitting.matrix))]));
    object(known.json().into_iter().chain(known.splitting.iter().map(|splitting| (SPLITTING, of(splitting)))))
}

fn orbit_json(orbit: &ProvedOrbit) -> Value {
    let part = |curve: &TrigonometricVector| series("mean", curve, |part| vector(part));
    let sizes = [("defect", &orbit.defect), ("tube", &orbit.tube), ("radius", &orbit.radius)];
    let sizes = sizes.map(|(name, value)| (name, exact(value)));
    let sensitivities = listed(SENSITIVITIES, orbit.approximation.sensitivities.iter().map(|one| object(part(one))));
    object(part(&orbit.approximation.centre).into_iter().chain(sensitivities).chain(sizes))
}

fn forcing_json(forcing: &ProvedForcing) -> Value {
    let part = |wave: &Wave| series("mean", wave, exact);
    let sensitivities = listed(SENSITIVITIES, forcing.sensitivities.iter().map(|one| object(part(one))));
    let rests = [("rest", exact(&forcing.rest)), ("rest_t", exact(&forcing.rest_t))];
    object(part(&forcing.nominal()).into_iter().chain(sensitivities).chain(rests))
}

fn values_json(values: &ProvedValues) -> Value {
    let one =
        |entry: &ProvedValue| object([("bound", Value::from(entry.bound.field()))].into_iter().chain(entry.json()));
    values.entries.iter().map(one).collect()
}
