//! The certificate of the regulator at samples: a claim about exactly one gain and one sampling period.

use super::by_count::{claimed_counts, count_witness, counts_in_words};
use super::fields::{HARMONICS, NumberFields, paths_json};
use super::json::{exact, object, text};
use super::of_plant::plant_parts;
use super::rates::{claimed_rates, sampled_rate_witnesses};
use super::triple::lyapunov_parts;
use super::words::sampled_statement;
use super::write::{
    actuator_json, conditions_json, control_json, file, input_gain_json, parameters_json, periodic_json, set_json,
};
use crate::certify::SampledCertification;
use serde_json::Value;
use sigmastar_exact::number::write_exact;

/// The word for the regulator of these claims.
pub(super) const REGULATOR: &str = "digital";

/// The name of the proof of k0, k1: harmonic by harmonic, of which there are finitely many.
pub(super) const SAMPLED: &str = "sampled";

/// The certificate of a certified run; `None` when nothing was certified. Self-contained, as
/// [`certificate_json`](super::certificate_json).
#[must_use]
pub fn sampled_certificate_json(run: &SampledCertification<'_>) -> Option<Value> {
    let proof = run.claim()?;
    let (witness, spec) = (&proof.witness, run.spec);
    let mu = &spec.internal_model.mu;
    let heading = [
        ("verdict", text(run.verdict.to_string())),
        ("regulator", text(REGULATOR)),
        ("derivation", text("sharp")),
        ("sigma", exact(&witness.sigma)),
        ("sampling_period", text(witness.sampling.text())),
        ("samples", Value::from(witness.sampling.samples)),
        ("gain", exact(&witness.law.gain)),
        ("n_o", text("every n_o < samples/2")),
        ("mu", text(mu.as_rational().map_or_else(|| mu.text.clone(), write_exact))),
    ];
    let rest = [
        ("initial_set", set_json(spec, &witness.set)),
        ("periodic_solution", periodic_json(&run.periodic_solution()?)),
        ("control", control_json(run.control()?)),
    ];
    let counts = claimed_counts(run.by_count.as_ref());
    let at = (&witness.sigma, Some(witness.sampling.samples));
    let of_counts = counts.as_ref().map_or_else(String::new, |(_, part)| counts_in_words(spec, at, part));
    let said = ("statement", text(sampled_statement(spec, witness) + &run.rates_in_words() + &of_counts));
    let sets = spec.internal_model.asks_every_set();
    let every_set = sets.then(|| (HARMONICS, text("every set below samples/2 that contains 0")));
    let delay = witness.sampling.delayed.then(|| ("delay_samples", Value::from(1)));
    let claim = {
        let of_actuator = every_set.into_iter().chain(delay).chain(input_gain_json(spec)).chain(actuator_json(spec));
        object(
            heading
                .into_iter()
                .chain(of_actuator)
                .chain(parameters_json(spec))
                .chain(rest)
                .chain(claimed_rates(&run.for_n_o))
                .chain(counts)
                .chain([said]),
        )
    };
    let of_delay = witness.delay.as_ref().map_or_else(Vec::new, NumberFields::json);
    let further = [("weight_sum", exact(&witness.law.weight_sum)), ("transfer", object([("proof", text(SAMPLED))]))];
    let parts =
        further.into_iter().chain([paths_json(witness.paths)]).chain(lyapunov_parts(spec)).chain(plant_parts(spec));
    let by_n_o = sampled_rate_witnesses(&run.for_n_o).into_iter().chain(count_witness(run.by_count.as_ref()));
    let witness = object(witness.json().into_iter().chain(of_delay).chain(parts).chain(by_n_o));
    let conditions = ("conditions", conditions_json(&proof.evaluation.conditions));
    Some(object(file(spec, proof.precision, claim, witness).into_iter().chain([conditions])))
}
