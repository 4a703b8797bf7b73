//! The one error of the front door.

use super::condition::Condition;
use super::report::Report;
use sigmastar_lang::spec::{self, SpecError, SpecErrors};
use sigmastar_prove::certify::{NoRatesOfClaim, Verdict, verdict_of_errors};
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
    /// Options that do not go together, or not with what is asked about.
    Options,
    /// Lines of results that are not of this study, or not all of them.
    Results,
    /// A certificate states another claim than the one that its witness proves.
    Claim,
    /// What was asked for is proved not to hold.
    Refuted,
    /// Nothing was found to be wrong, and something could not be decided: nothing is claimed either way.
    Undecided,
    /// No gain was certified for the specification: nothing is claimed either way.
    NotCertified,
    /// A result is beyond double precision.
    Overflow,
    /// What was asked for does not know how to honour a field of the document, such as `delay_samples`.
    NotAvailable,
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
            Kind::NotAvailable => ErrorKind::NotAvailable,
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
    verdict: Verdict,
    text: String,
    diagnostics: Vec<Diagnostic>,
    /// Those of documents, with their source.
    sources: Vec<SpecErrors>,
    conditions: Vec<Condition>,
    report: Option<Report>,
}

/// One thing that is wrong, or that could not be decided, with its place.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Diagnostic {
    /// The word of its kind, as in the JSON of the program (`docs/formats.md`).
    pub code: &'static str,
    /// The document or argument, as it is called.
    pub file: String,
    /// Its place as a JSON pointer; empty for the document as a whole and for arguments.
    pub pointer: String,
    /// Line and column, in characters from 1 on; `None` where there is no document.
    pub place: Option<(usize, usize)>,
    /// What is wrong, in a sentence.
    pub message: String,
    /// What was expected.
    pub expected: Option<String>,
    /// What to do about it.
    pub help: Option<String>,
}

impl Error {
    /// The kind. Where several errors were found, that of the first one which is not merely undecided.
    #[must_use]
    pub fn kind(&self) -> ErrorKind {
        self.kind
    }

    /// The verdict of the program: [`Refuted`](Verdict::Refuted) where the claim is proved not to hold as it was asked,
    /// [`Undecided`](Verdict::Undecided) where nothing is claimed either way, otherwise
    /// [`BadInput`](Verdict::BadInput). Never [`Certified`](Verdict::Certified).
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        self.verdict
    }

    /// Everything that was found, in order, with its place. Where only a claim as a whole is not certified there is none.
    #[must_use]
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.diagnostics
    }

    /// The report of a run that certified nothing: what failed and what to try.
    #[must_use]
    pub fn report(&self) -> Option<&Report> {
        self.report.as_ref()
    }

    /// The conditions of the attempt that came nearest, where one was evaluated (kind [`ErrorKind::NotCertified`]);
    /// otherwise empty.
    #[must_use]
    pub fn conditions(&self) -> &[Condition] {
        &self.conditions
    }

    /// What is wrong, in a sentence: of several errors the first.
    pub(super) fn sentence(&self) -> String {
        self.diagnostics.first().map_or_else(|| self.text.clone(), |first| first.message.clone())
    }

    /// What was found in documents and arguments, for the program, which shows it in its source; empty for an error without a place.
    #[doc(hidden)]
    #[must_use]
    pub fn sources(&self) -> &[SpecErrors] {
        &self.sources
    }

    /// An error without a place.
    pub(super) fn new(kind: ErrorKind, message: impl Into<String>, help: &str) -> Error {
        let message = message.into();
        let verdict = match kind {
            ErrorKind::Refuted => Verdict::Refuted,
            ErrorKind::Undecided | ErrorKind::NotCertified => Verdict::Undecided,
            _ => Verdict::BadInput,
        };
        let text = format!("{message}\n  help: {help}");
        let diagnostic = Diagnostic {
            code: "call",
            file: String::new(),
            pointer: String::new(),
            place: None,
            message,
            expected: None,
            help: Some(help.to_owned()),
        };
        let (diagnostics, sources) = (vec![diagnostic], Vec::new());
        Error { kind, verdict, text, diagnostics, sources, conditions: Vec::new(), report: None }
    }

    /// A claim that has no rates for given numbers of oscillators; `n_o` is what the argument is called.
    pub(super) fn no_rates(reason: NoRatesOfClaim, n_o: &str) -> Error {
        Error::new(ErrorKind::Options, reason.message(n_o), reason.help())
    }

    /// No claim: because of bounding functions that are not proved, or as the sentence says.
    pub(super) fn not_certified(
        verdict: Verdict,
        sentence: String,
        unproved: &[SpecErrors],
        conditions: Vec<Condition>,
        report: Report,
    ) -> Error {
        let mut error = match unproved {
            [] => Error { diagnostics: Vec::new(), ..Error::new(ErrorKind::NotCertified, "", "") },
            some => Error::documents(some),
        };
        if unproved.is_empty() {
            error.text = sentence;
        }
        Error { verdict, conditions, report: Some(report), ..error }
    }

    /// Errors in documents; at least one.
    pub(super) fn documents(all: &[SpecErrors]) -> Error {
        let each = || all.iter().flat_map(|errors| errors.errors().iter().map(move |error| (errors, error)));
        let diagnostics: Vec<Diagnostic> =
            each().map(|(errors, error)| Diagnostic::new(errors.label(), true, errors, error)).collect();
        let mut lines: Vec<String> = diagnostics.iter().map(Diagnostic::line).collect();
        lines.extend(all.iter().filter(|errors| errors.omitted() > 0).map(omitted));
        let kind = kind(each().map(|(_, error)| error));
        let (verdict, sources) = (verdict_of_errors(all), all.to_vec());
        Error { kind, verdict, text: lines.join("\n"), diagnostics, sources, conditions: Vec::new(), report: None }
    }

    /// Errors in an argument, which is shown by its name.
    pub(super) fn argument(name: &str, errors: &SpecErrors) -> Error {
        let named = |error: &SpecError| Diagnostic::new(name, false, errors, error);
        let diagnostics: Vec<Diagnostic> = errors.errors().iter().map(named).collect();
        let lines: Vec<String> = diagnostics.iter().map(Diagnostic::line).collect();
        let mut error = Error::documents(std::slice::from_ref(errors));
        error.text = lines.join("\n");
        Error { diagnostics, ..error }
    }
}

impl Diagnostic {
    /// With its place, where the document is one that the user has.
    fn new(file: &str, placed: bool, errors: &SpecErrors, error: &SpecError) -> Diagnostic {
        Diagnostic {
            code: error.kind.code(),
            file: file.to_owned(),
            pointer: if placed { error.pointer.clone() } else { String::new() },
            place: placed.then(|| errors.place(error)),
            message: errors.in_full(error).to_owned(),
            expected: error.expected.clone(),
            help: error.help.clone(),
        }
    }

    /// As errors show it.
    fn line(&self) -> String {
        let Diagnostic { file, message, .. } = self;
        let mut text = match self.place {
            Some((line, column)) => format!("{file}:{line}:{column}: {message}"),
            None => format!("{file}: {message}"),
        };
        if !self.pointer.is_empty() {
            text += &format!("\n  at: {}", self.pointer);
        }
        let expected = self.expected.as_ref().map(|expected| format!("\n  {expected}"));
        let help = self.help.as_ref().map(|help| format!("\n  help: {help}"));
        text + &expected.unwrap_or_default() + &help.unwrap_or_default()
    }
}

fn kind<'e>(errors: impl Iterator<Item = &'e SpecError>) -> ErrorKind {
    let mut kinds = errors.map(|error| ErrorKind::of(error.kind));
    kinds.find(|kind| *kind != ErrorKind::Undecided).unwrap_or(ErrorKind::Undecided)
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
