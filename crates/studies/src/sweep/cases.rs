//! The cases: the subject of a study with the values of each case put in.

use super::row::Row;
use super::study::{Study, SubjectSource};
use serde_json::Value;
use sigmastar_document::clean;
use sigmastar_lang::plant;
use sigmastar_lang::spec::{self, Document, ErrorKind, Errors, SpecErrors};

/// A study with its subject: every case can be made.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// The study.
    pub study: Study,
    /// The subject, with the sampling period of the study.
    base: Value,
}

/// One case.
#[derive(Clone, Debug)]
pub struct Case {
    /// Its number, from 0 on.
    pub index: u64,
    /// Its values as texts, in the order of the parameters.
    pub values: Vec<String>,
    /// The specification or plant.
    pub document: Document,
    /// SHA-256 of the document: what `certify` of it gives as the digest of the specification or plant.
    pub sha256: String,
}

impl Case {
    /// Whether a row is of this document and these values.
    #[must_use]
    pub fn has(&self, row: &Row) -> bool {
        self.sha256 == row.sha256 && self.values == row.values
    }
}

impl Sweep {
    /// Puts a study and its subject together; `subject` is the document at the study's path, and not used where the study
    /// has the subject in it.
    ///
    /// # Errors
    /// A subject that is neither a specification nor a plant, a pointer that names nothing in it or no single value, and
    /// options that are not for this subject.
    pub fn new(study: Study, subject: Option<&Document>) -> Result<Sweep, SpecErrors> {
        let mut base = match (&study.subject, subject) {
            (SubjectSource::Embedded(value), _) => {
                Document::parse("the subject", &value.to_string())?.root().embedded().0
            }
            (SubjectSource::Path(_), Some(document)) => document.root().embedded().0,
            (SubjectSource::Path(path), None) => {
                let message = format!("the subject `{path}` was not read");
                return Err(study.source.errors_at("/subject", &(0..0), ErrorKind::Unreadable, message, None));
            }
        };
        with_sampling_period(&study, &mut base)?;
        fits(&study, &base)?;
        Ok(Sweep { study, base })
    }

    /// How many cases there are.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.study.combinations.count()
    }

    /// A case below [`Sweep::count`].
    ///
    /// # Errors
    /// A document that is too large with these values.
    pub fn case(&self, index: u64) -> Result<Case, SpecErrors> {
        let values = self.study.combinations.case(index);
        let mut value = self.base.clone();
        for (parameter, scalar) in self.study.parameters.iter().zip(&values) {
            // That it is there was looked at when the study was read.
            if let Some(place) = value.pointer_mut(&parameter.pointer) {
                *place = scalar.0.clone();
            }
        }
        let document = Document::parse(&format!("case {index}"), &value.to_string())?;
        let sha256 = document.root().sha256();
        Ok(Case { index, values: values.iter().map(|value| value.text()).collect(), document, sha256 })
    }
}

/// Puts the sampling period of the study into the internal model, as `certify --sampling-period` does.
fn with_sampling_period(study: &Study, base: &mut Value) -> Result<(), SpecErrors> {
    let Some(step) = &study.sampling_period else { return Ok(()) };
    match base.get_mut("internal_model").and_then(Value::as_object_mut) {
        Some(model) => drop(model.insert("sampling_period".to_owned(), step.clone().into())),
        None => {
            let message = "the subject has no internal model for a sampling period";
            return Err(study.source.errors_at("/sampling_period", &(0..0), ErrorKind::Range, message, None));
        }
    }
    Ok(())
}

/// Whether subject and study go together.
fn fits(study: &Study, base: &Value) -> Result<(), SpecErrors> {
    let format = base.get("format").and_then(Value::as_str);
    let of_plant = format == Some(plant::FORMAT);
    if !of_plant && format != Some(spec::FORMAT) {
        let message = "the subject is neither a bounding specification nor a plant";
        let help = format!("give a file of the format `{}` or `{}`", spec::FORMAT, plant::FORMAT);
        return Err(study.source.errors_at("/subject", &(0..0), ErrorKind::Format, message, Some(help)));
    }
    let mut errors = Errors::new();
    for (index, parameter) in study.parameters.iter().enumerate() {
        let message = match base.pointer(&parameter.pointer) {
            Some(Value::String(_) | Value::Number(_) | Value::Bool(_)) => continue,
            Some(_) => format!("`{}` is no single value of the subject", parameter.pointer),
            None => format!("`{}` names nothing in the subject", parameter.pointer),
        };
        let named = ["pointer", "parameter"].map(|field| study.source.at(&format!("/parameters/{index}/{field}")));
        let place = named.into_iter().flatten().next().unwrap_or_else(|| study.source.root());
        let error = place.error(ErrorKind::UnknownName, message);
        let known = known(base, &parameter.pointer).map_or_else(String::new, |known| format!(": {known}"));
        errors.report(error.help(format!(
            "name a number, a string or a Boolean that the subject has{known}; a field that may be left out has to be there"
        )));
    }
    errors.conclude(&study.source, Ok(()))
}

/// The names beside a place that is not there, or below one that is no single value: `in /lyapunov there are alpha, p_up`.
fn known(base: &Value, pointer: &str) -> Option<String> {
    let mut place = pointer;
    let mut value = base.pointer(place);
    while !matches!(value, Some(Value::Object(_) | Value::Array(_))) {
        place = &place[..place.rfind('/')?];
        value = base.pointer(place);
    }
    let place = if place.is_empty() { "it" } else { place };
    match value? {
        Value::Object(fields) if !fields.is_empty() => {
            let names: Vec<&str> = fields.keys().map(String::as_str).collect();
            Some(format!("in {place} there are {}", clean(&names.join(", "))))
        }
        Value::Array(entries) if !entries.is_empty() => {
            Some(format!("in {place} there are 0 to {}", entries.len() - 1))
        }
        _ => Some(format!("there is nothing in {place}")),
    }
}
