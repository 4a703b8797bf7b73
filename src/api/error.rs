//! The one error of the front door.

use super::certificate::Condition;
use crate::spec::{self, SpecError, SpecErrors};
use std::fmt;

/// What kind of error an [`Error`] is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The text is not JSON that is read: syntax, a key given twice, or a limit on its size.
    Document,
    /// The document is of another format or version.
    Format,
    /// A field is missing, not known, or of the wrong type, or names a kind or family that is not known.
    Field,
    /// An expression or a constant that cannot be read.
    Expression,
    /// A number outside its range, or a condition on numbers that fails: weights, a matched base frequency, a sampling
    /// time, a bounding function that is proved not to be one.
    Range,
    /// What was asked for is proved not to hold.
    Refuted,
    /// Nothing was found to be wrong, and something could not be decided: nothing is claimed either way.
    Undecided,
    /// No gain was certified for the specification: nothing is claimed either way.
    NotCertified,
    /// A result is beyond double precision.
    Overflow,
}

impl ErrorKind {
    fn of(kind: spec::ErrorKind) -> ErrorKind {
        use spec::ErrorKind as Kind;
        match kind {
            Kind::Unreadable | Kind::Limit | Kind::Encoding | Kind::Syntax | Kind::TomlSyntax | Kind::DuplicateKey => {
                ErrorKind::Document
            }
            Kind::Format | Kind::Version => ErrorKind::Format,
            Kind::Type | Kind::UnknownField | Kind::MissingField | Kind::UnknownName => ErrorKind::Field,
            Kind::Expression => ErrorKind::Expression,
            Kind::Range | Kind::Matched | Kind::Weights => ErrorKind::Range,
            Kind::Undecided => ErrorKind::Undecided,
        }
    }
}

/// Why there is no result.
///
/// `Display` gives every error that was found: its place, what is wrong, what was expected and what to do. The text is
/// for people and may change; programs ask for [`Error::kind`].
#[derive(Clone, Debug)]
pub struct Error {
    kind: ErrorKind,
    text: String,
    conditions: Vec<Condition>,
}

impl Error {
    /// The kind. Where several errors were found, that of the first one which is not merely undecided.
    #[must_use]
    pub fn kind(&self) -> ErrorKind {
        self.kind
    }

    /// The conditions of the attempt that came nearest, where one was evaluated (kind [`ErrorKind::NotCertified`]);
    /// otherwise empty.
    #[must_use]
    pub fn conditions(&self) -> &[Condition] {
        &self.conditions
    }

    /// An error without a place.
    pub(super) fn new(kind: ErrorKind, message: impl Into<String>, help: &str) -> Error {
        let text = format!("{}\n  help: {help}", message.into());
        Error { kind, text, conditions: Vec::new() }
    }

    /// No claim, with the conditions of the attempt.
    pub(super) fn not_certified(text: String, conditions: Vec<Condition>) -> Error {
        Error { kind: ErrorKind::NotCertified, text, conditions }
    }

    /// Errors in documents; at least one.
    pub(super) fn documents(all: &[SpecErrors]) -> Error {
        let each = || all.iter().flat_map(|errors| errors.errors().iter().map(move |error| (errors, error)));
        let placed = |(errors, error): (&SpecErrors, &SpecError)| {
            let (line, column) = errors.place(error);
            let mut text = format!("{}:{line}:{column}: {}", errors.label(), errors.in_full(error));
            if !error.pointer.is_empty() {
                text += &format!("\n  at: {}", error.pointer);
            }
            text + &advice(error)
        };
        let mut lines: Vec<String> = each().map(placed).collect();
        lines.extend(all.iter().filter(|errors| errors.omitted() > 0).map(omitted));
        Error { kind: kind(each().map(|(_, error)| error)), text: lines.join("\n"), conditions: Vec::new() }
    }

    /// Errors in an argument, which is shown by its name.
    pub(super) fn argument(name: &str, errors: &SpecErrors) -> Error {
        let named = |error: &SpecError| format!("{name}: {}{}", errors.in_full(error), advice(error));
        let lines: Vec<String> = errors.errors().iter().map(named).collect();
        Error { kind: kind(errors.errors().iter()), text: lines.join("\n"), conditions: Vec::new() }
    }
}

fn kind<'e>(errors: impl Iterator<Item = &'e SpecError>) -> ErrorKind {
    let mut kinds = errors.map(|error| ErrorKind::of(error.kind));
    kinds.find(|kind| *kind != ErrorKind::Undecided).unwrap_or(ErrorKind::Undecided)
}

fn advice(error: &SpecError) -> String {
    let expected = error.expected.as_ref().map(|expected| format!("\n  {expected}"));
    let help = error.help.as_ref().map(|help| format!("\n  help: {help}"));
    expected.unwrap_or_default() + &help.unwrap_or_default()
}

fn omitted(errors: &SpecErrors) -> String {
    format!("{}: {} more errors are not shown", errors.label(), errors.omitted())
}

impl From<SpecErrors> for Error {
    fn from(errors: SpecErrors) -> Error {
        Error::documents(&[errors])
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl std::error::Error for Error {}
