//! Where what is wrong with a case stands in the files that were written: at a value of the study, or in its subject.

use super::cases::Sweep;
use super::row::{Row, RowError};
use super::study::SubjectSource;
use super::values::Scalar;
use sigmastar_lang::spec::{Document, ErrorKind, Errors, SpecErrors, Value};
use std::collections::BTreeMap;

impl Sweep {
    /// What is wrong with the documents of cases, each error once, with the first case that has it and how many have it; those in the study before those
    /// in `subject`, which is the document at the study's path. A case is no file of anybody's: its errors are told where their text was written.
    #[must_use]
    pub fn errors_of<'r>(&self, rows: impl Iterator<Item = &'r Row>, subject: Option<&Document>) -> Vec<SpecErrors> {
        let mut found: BTreeMap<(bool, usize, &str), Told<'_, 'r>> = BTreeMap::new();
        for row in rows {
            for error in &row.errors {
                let Some(place) = self.place(row, error, subject) else { continue };
                let in_study = std::ptr::eq(place.document(), &self.study.source);
                let told = Told { place, error, first: row, others: 0 };
                found
                    .entry((!in_study, told.place.span().start, error.message.as_str()))
                    .and_modify(|told| told.others += 1)
                    .or_insert(told);
            }
        }
        let (mut of_study, mut of_subject) = (Errors::new(), Errors::new());
        for ((elsewhere, ..), told) in &found {
            let errors = if *elsewhere { &mut of_subject } else { &mut of_study };
            let kind = ErrorKind::from_code(&told.error.code).unwrap_or(ErrorKind::Range);
            errors.report(told.place.error(kind, told.error.message.clone()).help(self.where_it_is(told)));
        }
        let some = |elsewhere| found.keys().any(|(one, ..)| *one == elsewhere);
        let study = some(false).then(|| of_study.into_errors(&self.study.source));
        let subject = subject.filter(|_| some(true)).map(|subject| of_subject.into_errors(subject));
        study.into_iter().chain(subject).collect()
    }

    /// The value of the study that was put in there, or what the subject has there; where it has nothing, what it should be in.
    fn place<'d>(&'d self, row: &Row, error: &RowError, subject: Option<&'d Document>) -> Option<Value<'d>> {
        let study = &self.study.source;
        for (index, parameter) in self.study.parameters.iter().enumerate() {
            if error.pointer == parameter.pointer || error.pointer.starts_with(&format!("{}/", parameter.pointer)) {
                let whole = format!("/parameters/{index}");
                let values = ["values", "linear", "logarithmic"].into_iter();
                let values = values.filter_map(|kind| study.at(&format!("{whole}/{kind}"))).next();
                let value = row.values.get(index);
                let listed = (0..).map_while(|at| study.at(&format!("{whole}/values/{at}")));
                let mut listed = listed.filter(|one| value.is_some_and(|value| Scalar(one.to_json()).text() == *value));
                return listed.next().or(values).or_else(|| study.at(&whole));
            }
        }
        if self.study.sampling_period.is_some() && error.pointer == "/internal_model/sampling_period" {
            return study.at("/sampling_period");
        }
        let (document, before) = match &self.study.subject {
            SubjectSource::Embedded(_) => (study, "/subject"),
            SubjectSource::Path(_) => (subject?, ""),
        };
        let mut pointer = error.pointer.as_str();
        loop {
            if let Some(place) = document.at(&format!("{before}{pointer}")) {
                return Some(place);
            }
            pointer = &pointer[..pointer.rfind('/')?];
        }
    }

    /// Which cases have an error, and how the first of them is looked at.
    fn where_it_is(&self, told: &Told<'_, '_>) -> String {
        let names = self.study.parameters.iter().map(|parameter| parameter.name.as_str());
        let values: Vec<String> =
            names.zip(&told.first.values).map(|(name, value)| format!("{name} = {value}")).collect();
        let others = match told.others {
            0 => String::new(),
            1 => " and in one more".to_owned(),
            more => format!(" and in {more} more"),
        };
        let index = told.first.index;
        format!("in case {index} ({}){others}; `sweep --case {index}` writes that document", values.join(", "))
    }
}

/// An error, where it is, and which cases have it.
struct Told<'d, 'r> {
    place: Value<'d>,
    error: &'r RowError,
    first: &'r Row,
    others: u64,
}
