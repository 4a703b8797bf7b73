//! The certificate of a run of either regulator, and the witness of a certificate for a subject of either kind.

use super::fields::HARMONICS;
use super::read::{read_lyapunov, read_witness};
use super::read_plant::read_plant_witness;
use super::read_sampled::{is_sampled, read_sampled_witness};
use super::sampled::sampled_certificate_json;
use super::write::certificate_json;
use crate::rate::bound::MAX_OSCILLATORS;
use crate::reduction::{FreeNumbers, Run, Subject, Witness, WitnessData};
use serde_json::Value;
use sigmastar_lang::spec::{Document, Oscillators, SpecErrors};

/// Where a certificate states rates.
const RATES: &str = "/claim/for_n_o";

/// The certificate of a run; `None` where nothing is certified.
#[must_use]
pub fn certificate_of(run: &Run<'_>) -> Option<Value> {
    match run {
        Run::Continuous(run) => certificate_json(run),
        Run::Sampled(run) => sampled_certificate_json(run),
    }
}

/// Whether the claim of a run is the one that a certificate states, in all but its words, which follow from the rest.
#[must_use]
pub fn is_stated(run: &Run<'_>, certificate: &Document) -> bool {
    let Some(mut stated) = certificate.at("/claim").map(|claim| claim.to_json()) else { return false };
    let Some(mut made) = certificate_of(run).map(|mut made| made["claim"].take()) else { return false };
    for claim in [&mut stated, &mut made] {
        claim["statement"] = Value::Null;
    }
    // An older certificate says less: it is about the first harmonics alone.
    if let (None, Some(claim)) = (stated.get(HARMONICS), made.as_object_mut()) {
        claim.remove(HARMONICS);
    }
    made == stated
}

/// The oscillators of which a certificate states rates.
#[must_use]
pub fn stated_counts(certificate: &Document) -> Vec<Oscillators> {
    oscillators_in(certificate, RATES).unwrap_or_default()
}

/// The oscillators of which a certificate states bounds under noise or rounding.
#[must_use]
pub fn stated_with_noise(certificate: &Document) -> Vec<Oscillators> {
    let list = certificate.at(RATES).map(|list| list.to_json()).unwrap_or_default();
    let entries = list.as_array().into_iter().flatten();
    entries.filter(|entry| entry.get("noise").is_some()).filter_map(of_entry).collect()
}

/// The oscillators of which a certificate states bounds; none where it states nothing by these.
#[must_use]
pub fn stated_by_count(certificate: &Document) -> Option<Vec<Oscillators>> {
    oscillators_in(certificate, "/claim/by_n_o")
}

/// The oscillators that an entry is about. Anybody may have written it: of a number beyond the limit there is no list of harmonics.
pub(super) fn of_entry(entry: &Value) -> Option<Oscillators> {
    let small = |value: &Value| u32::try_from(value.as_u64()?).ok().filter(|k| *k <= MAX_OSCILLATORS);
    match entry[HARMONICS].as_array() {
        Some(list) => Oscillators::at(&list.iter().map(small).collect::<Option<Vec<u32>>>()?).ok(),
        None => small(&entry["n_o"]).map(Oscillators::first),
    }
}

/// The oscillators in a list of a claim.
fn oscillators_in(certificate: &Document, pointer: &str) -> Option<Vec<Oscillators>> {
    let list = certificate.at(pointer)?.to_json();
    // Of each larger number something is said without one of its own.
    let own = list.as_array()?.iter().filter(|entry| entry["or_more"] != true);
    Some(own.filter_map(of_entry).collect())
}

/// Reads the free numbers of a certificate about either regulator.
///
/// # Errors
/// Every field that is missing, unknown or not exact, with its place.
pub fn read_numbers(document: &Document) -> Result<FreeNumbers, SpecErrors> {
    if is_sampled(document) {
        return read_sampled_witness(document).map(|witness| FreeNumbers::Sampled(Box::new(witness)));
    }
    read_witness(document).map(FreeNumbers::Continuous)
}

/// Reads the witness of a certificate, to be tried on a subject: the free numbers, and the data that the subject does not give.
///
/// # Errors
/// Every field that is missing, unknown or not exact, with its place.
pub fn read_for(document: &Document, subject: &Subject) -> Result<Witness, SpecErrors> {
    let numbers = read_numbers(document)?;
    let (digest, data) = match subject {
        Subject::Plant(_) => {
            let (_, of_plant, values) = read_plant_witness(document, &numbers)?;
            ("/plant_sha256", WitnessData::OfPlant(Box::new((of_plant, values))))
        }
        Subject::Specification(spec) if spec.lyapunov.triple().is_none() => {
            ("/specification_sha256", WitnessData::Triples(Box::new(read_lyapunov(document)?)))
        }
        Subject::Specification(_) => ("/specification_sha256", WitnessData::Given),
    };
    let of_another = document.at(digest).is_some_and(|digest| digest.text() != Some(subject.sha256()));
    Ok(Witness { numbers, data, of_another })
}
