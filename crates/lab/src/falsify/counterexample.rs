//! The plant of a trial as a plant file, which anyone can simulate again.

use super::claim::TriedClaim;
use super::finding::{Trial, TriedPlant, Violation};
use super::oscillators::harmonics_flag;
use serde_json::json;
use sigmastar_document::{clean, plain};
use sigmastar_lang::plant;
use sigmastar_lang::spec::{Document, SpecErrors};

/// The flags with which `simulate` shows a trial.
#[must_use]
pub fn flags(claim: &TriedClaim, trial: &Trial) -> String {
    let gain = trial.input_gain.map_or_else(String::new, |gain| format!(" --input-gain {gain:?}"));
    // A drawn plant has it in its file.
    let period = trial.period.as_ref().filter(|_| matches!(trial.plant, TriedPlant::Own(_)));
    let period = period.map_or_else(String::new, |period| format!(" --period \"{}\"", period.text));
    let oscillators = match trial.oscillators.n_o() {
        Some(n_o) => format!("--n-o {n_o}"),
        None => harmonics_flag(&trial.oscillators),
    };
    let plain = format!("--sigma {:?} {oscillators}{gain}{period}", trial.sigma);
    match claim.sampled.as_ref().zip(trial.phase) {
        None => plain,
        Some((sampled, phase)) => format!("{plain} --sampled \"{}\" --phase {phase:?}", sampled.step.text),
    }
}

/// The plant of a trial as a plant file with its initial condition, as a document.
///
/// # Errors
/// None is known: the text is made here.
pub fn counterexample_plant(
    claim: &TriedClaim,
    trial: &Trial,
    violation: Option<&Violation>,
) -> Result<Document, SpecErrors> {
    let ((f, q), names) = (trial.plant.texts(), trial.plant.names());
    let states = f.len();
    let (x, rest) = trial.start.split_at(states);
    let (e, z) = rest.split_first().map_or((0.0, &[][..]), |(e, z)| (*e, z));
    let found = violation.map_or_else(String::new, |violation| {
        let Violation { quantity, bound, found } = violation;
        format!("Counterexample: {} is {found} where at most {bound} is claimed. ", plain(quantity))
    });
    let description = format!("{found}Simulate it with {}.", flags(claim, trial));
    let mut file = json!({
        "format": plant::FORMAT, "version": 1,
        "name": format!("Trial {} for {}", trial.number, clean(&claim.spec.name)),
        "description": description,
        "period": trial.period.as_ref().unwrap_or(claim.spec.period.nominal()).text,
        "states": names, "f": f, "q": q,
        "initial": { "x": x, "e": e, "z": z },
        "internal_model": claim.spec.document["internal_model"],
    });
    if let TriedPlant::Own(plant) = &trial.plant
        && !plant.parameters.list().is_empty()
    {
        for member in ["f", "q"] {
            file[member] = plant.document[member].clone();
        }
        let values = plant.parameters.list().iter().map(|one| (one.name.clone(), one.value.text.clone()));
        file["parameters"] = values.collect();
    }
    for name in ["input_gain", "actuator"] {
        if let Some(part) = claim.spec.document.get(name) {
            file[name] = part.clone();
        }
    }
    Document::parse("trial", &format!("{file:#}\n"))
}
