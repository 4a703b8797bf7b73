//! The report on a certification as JSON.

use super::by_count::counts_json;
use super::conditions::conditions_with_truth;
use super::constants::parts_json;
use super::failures::{FORMAT, VERSION, errors_json};
use super::for_n_o::rates_json;
use super::gains::{rows_json, to_use_json};
use super::limits;
use super::obstacles::advice;
use super::of_plant::plant_json;
use super::relative_degree::gains_json;
use super::remarks::remarks;
use super::sensitivity;
use super::verdict::{basis, sentence};
use serde_json::{Map, Value, json};
use sigmastar_document::number::{estimate, full};
use sigmastar_document::{plain, plain_all};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::write_exact;
use sigmastar_lang::spec::{InputGain, Specification};
use sigmastar_propose::search::{Binding, OptionalDatum};
use sigmastar_prove::certificate::{no_plant_json, set_fields};
use sigmastar_prove::certify::{Certification, Verdict};
use sigmastar_theory::derivation::consequences::ErrorBounds;
use sigmastar_theory::derivation::control::Control;
use sigmastar_theory::derivation::targets::{Consequences, Target, TargetKind, TargetOutcome};

/// The whole report: the same content as the text.
pub(super) fn report(run: &Certification<'_>, consequences: Option<&Consequences>, rechecked: bool) -> Value {
    let mut report = json!({
        "format": FORMAT, "version": VERSION,
        "verdict": run.verdict.to_string(), "statement": plain(&sentence(run)), "remarks": plain_all(remarks(run)),
        "no_plant": run.no_plant.as_ref().map(no_plant_json), "derivation": "sharp",
        "specification": { "name": run.spec.name, "sha256": run.spec.sha256 },
    });
    if let (Some(sigma), Some(claimed), Some(periodic), Some(error_box)) =
        (run.sigma_star(), run.claimed_set(), run.periodic_solution(), run.error_box())
    {
        report[if run.spec.actuator.is_some() { "sigma" } else { "sigma_star" }] = json!(write_exact(sigma));
        report["given_gain"] = json!(run.given_gain.is_some());
        report["basis"] = json!(plain_all(basis(run)));
        report["initial_set"] = set_fields(claimed).collect();
        let [x, e, zeta, z] = periodic.each_ref().map(full);
        report["periodic_solution"] = json!({ "x": x, "e": e, "zeta": zeta, "z": z });
        report["control"] = control(run.control());
        if let Some(kept) = limits::json(run) {
            report["limits"] = kept;
            report["sigma_star_estimate"] = json!(run.smallest_gain.map(estimate));
        }
        let [x, e] = error_box.each_ref().map(full);
        report["error_box"] = json!({ "D_x": x, "D_e": e });
    }
    if let Some([x, e]) = run.largest_arguments().map(|arguments| arguments.each_ref().map(full)) {
        report["largest_arguments"] = json!({ "X": x, "E": e });
    }
    if !run.unproved_bounds.is_empty() {
        let errors: Vec<_> = run.unproved_bounds.iter().map(|problem| problem.errors(run.spec)).collect();
        report["errors"] = errors_json(&errors);
    }
    if run.verdict != Verdict::Certified {
        report["advice"] = json!(plain_all(advice(run, rechecked)));
    }
    report["conditions"] = conditions_with_truth(run.conditions());
    for (name, value) in parts_json(run).into_iter().chain([
        ("plant", plant_json(run.spec, run.claimed_set())),
        ("binding", json!(run.binding.map(Binding::describe))),
        (
            "binding_advice",
            json!(
                run.binding
                    .map(|binding| binding.advice(run.spec.plant().is_some(), run.spec.initial_set.is_aligned()))
            ),
        ),
        ("without_optional", without_optional(run)),
        ("sensitivities", sensitivities(run)),
        ("sigma_star_aligned_estimate", json!(run.alternatives.aligned.map(estimate))),
        ("sigma_star_by_norms_estimate", json!(run.alternatives.by_norms.map(estimate))),
        ("consequences", consequences.map_or(Value::Null, consequences_json)),
        ("gain_to_use", to_use_json(&run.gains)),
        ("gains", rows_json(&run.gains)),
        ("by_n_o", counts_json(run.by_count.as_ref())),
        ("exact_regulation", exact_regulation(run)),
        ("relative_degree", gains_json(run)),
    ]) {
        report[name] = value;
    }
    if let Some(rates) = rates_json(&run.for_n_o, &run.why_no_rate()) {
        report["for_n_o"] = rates;
    }
    if let Some(actuator) = actuator(run.spec) {
        report["actuator"] = actuator;
    }
    if let Some(gain) = input_gain(run.spec) {
        report["input_gain"] = gain;
        report["sigma_star_nominal_gain_estimate"] = json!(run.alternatives.nominal_gain.map(estimate));
    }
    if let Some([low, high]) = run.spec.period.interval() {
        report["period"] = json!({ "nominal": run.spec.period.nominal().text, "low": low.text, "high": high.text });
    }
    if !run.interval_costs.is_empty() {
        report["sigma_star_without_interval_estimates"] = interval_costs(&run.interval_costs);
    }
    report
}

/// The interval of the input gain, where there is one.
pub(super) fn input_gain(spec: &Specification) -> Option<Value> {
    let InputGain { nominal, low, high, .. } = spec.input_gain.as_ref()?;
    Some(json!({ "nominal": nominal.text, "low": low.text, "high": high.text }))
}

/// What the actuator takes, where that is stated.
pub(super) fn actuator(spec: &Specification) -> Option<Value> {
    let actuator = spec.actuator.as_ref()?;
    let middle = actuator.middle();
    Some(match &actuator.range {
        None => json!({ "max": actuator.max.text }),
        Some(_) => {
            let mut value: Map<String, Value> =
                actuator.written().into_iter().map(|(name, number)| (name.to_owned(), json!(number))).collect();
            value.insert("u_from".to_owned(), json!(middle.as_ref().map_or_else(|| "0".to_owned(), write_exact)));
            value.into()
        }
    })
}

/// The gain with each interval closed to its nominal value.
pub(super) fn interval_costs(all: &[(String, Option<f64>)]) -> Value {
    all.iter().map(|(name, sigma)| (name.clone(), json!(sigma.map(estimate)))).collect::<serde_json::Map<_, _>>().into()
}

/// The optional data with the estimate of sigma* without each; null where none is found.
fn without_optional(run: &Certification<'_>) -> Value {
    let one = |(datum, sigma): &(OptionalDatum, Option<f64>)| json!({ "datum": datum.field(), "estimate": sigma.map(estimate) });
    run.without_optional.iter().map(one).collect()
}

/// Relative falls of sigma* for 1 %; floating-point estimates.
fn sensitivities(run: &Certification<'_>) -> Value {
    run.sensitivities
        .iter()
        .map(|(datum, gain)| json!({ "datum": plain(&sensitivity::name(run.spec, *datum)), "estimate": estimate(*gain) }))
        .collect()
}

/// Bounds of the error by the number of oscillators.
pub(super) fn bounds_json(by_n_o: &[(u64, ErrorBounds)]) -> Value {
    by_n_o
        .iter()
        .map(|(n_o, bounds)| json!({ "n_o": n_o, "rms": full(&bounds.rms), "sup": full(&bounds.sup) }))
        .collect()
}

/// The answers to targets.
pub(super) fn targets_json(targets: &[(Target, TargetOutcome)]) -> Value {
    let one = |(target, outcome): &(Target, TargetOutcome)| {
        let norm = match target.kind {
            TargetKind::Sup => "sup",
            TargetKind::Rms => "rms",
        };
        let (answer, n_o) = match outcome {
            TargetOutcome::Reached(n_o) | TargetOutcome::ReachedAtGain(n_o, _) => ("reached", Some(n_o)),
            TargetOutcome::NotReached => ("not reached", None),
        };
        let mut value = json!({ "norm": norm, "target": target.value.text, "answer": answer, "n_o": n_o });
        if let TargetOutcome::ReachedAtGain(_, larger) = outcome {
            value["n_o_at_larger_gains"] = json!(larger);
        }
        value
    };
    targets.iter().map(one).collect()
}

fn consequences_json(consequences: &Consequences) -> Value {
    let psi = &consequences.psi;
    // psi_2 speaks about matched base frequencies only.
    let psi_2 = if consequences.mistuned.is_some() { Value::Null } else { json!(full(&psi.psi_2)) };
    let mistuned = consequences.mistuned.as_ref().map(|mistuned| {
        json!({
            "largest": full(&mistuned.largest), "last_that_pays": mistuned.last_that_pays, "enough": mistuned.enough,
        })
    });
    json!({
        "psi_1": full(&psi.psi_1), "psi_x": full(&psi.psi_x), "psi_2": psi_2,
        "error_bounds": bounds_json(&consequences.by_n_o), "mistuned": mistuned,
        "targets": targets_json(&consequences.targets),
    })
}

fn exact_regulation(run: &Certification<'_>) -> Value {
    match (&run.exact, run.sigma_star()) {
        (Some(claim), Some(_)) => json!({
            "sigma_star_oo": write_exact(&claim.witness.sigma),
            "largest_arguments": run.exact_arguments().map(|arguments| {
                let [x, e] = arguments.each_ref().map(full);
                json!({ "X": x, "E": e })
            }),
            "conditions": conditions_with_truth(&claim.evaluation.conditions),
        }),
        _ => Value::Null,
    }
}

/// Upper bounds of the control.
pub(super) fn control(bounds: Option<&Control<Enclosure>>) -> Value {
    json!(bounds.map(|Control { steady, transient }| json!({ "steady": full(steady), "transient": full(transient) })))
}
