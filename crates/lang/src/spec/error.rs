//! What is wrong with a document, and where.

use super::source::Source;
use std::fmt;
use std::ops::Range;
use std::sync::Arc;
use thiserror::Error;

/// The most errors that are kept of one document; the rest are counted.
pub const MAX_ERRORS: usize = 32;

/// The kind of an error; its [`code`](ErrorKind::code) appears in the rendered diagnostic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ErrorKind {
    /// The file could not be opened or read.
    Unreadable,
    /// The document exceeds a limit on size, nesting, number of values or length of a numeral.
    Limit,
    /// The document is not UTF-8.
    Encoding,
    /// The document is not JSON.
    Syntax,
    /// The document is not TOML.
    TomlSyntax,
    /// A key occurs twice in one object.
    DuplicateKey,
    /// A value has the wrong JSON type.
    Type,
    /// A field that is not known here.
    UnknownField,
    /// A required field is absent.
    MissingField,
    /// `format` names another kind of file.
    Format,
    /// `version` is not one that is read.
    Version,
    /// A kind or family that is not known.
    UnknownName,
    /// An expression or a constant that cannot be read.
    Expression,
    /// A number outside its range: not positive, negative, not rational, out of order, or too many of them.
    Range,
    /// `matched` is asserted and does not hold.
    Matched,
    /// The weights break one of the conditions W1-W3 or the strict decrease.
    Weights,
    /// A condition that could be neither proved nor refuted at the highest precision.
    Undecided,
    /// A field that is right, and that what was asked for does not know how to honour.
    NotAvailable,
}

/// Their codes, in the order of declaration.
const CODES: [(ErrorKind, &str); 18] = [
    (ErrorKind::Unreadable, "unreadable"),
    (ErrorKind::Limit, "limit"),
    (ErrorKind::Encoding, "encoding"),
    (ErrorKind::Syntax, "not-json"),
    (ErrorKind::TomlSyntax, "not-toml"),
    (ErrorKind::DuplicateKey, "duplicate-key"),
    (ErrorKind::Type, "wrong-type"),
    (ErrorKind::UnknownField, "unknown-field"),
    (ErrorKind::MissingField, "missing-field"),
    (ErrorKind::Format, "wrong-format"),
    (ErrorKind::Version, "wrong-version"),
    (ErrorKind::UnknownName, "unknown-name"),
    (ErrorKind::Expression, "expression"),
    (ErrorKind::Range, "out-of-range"),
    (ErrorKind::Matched, "not-matched"),
    (ErrorKind::Weights, "weights"),
    (ErrorKind::Undecided, "undecided"),
    (ErrorKind::NotAvailable, "not-available"),
];

impl ErrorKind {
    /// The short name in diagnostics, as in `error[unknown-field]`.
    #[must_use]
    pub fn code(self) -> &'static str {
        CODES[self as usize].1
    }

    /// The kind of a [`code`](ErrorKind::code).
    #[must_use]
    pub fn from_code(code: &str) -> Option<ErrorKind> {
        CODES.iter().find(|(_, own)| *own == code).map(|(kind, _)| *kind)
    }
}

/// One error in a document.
#[derive(Clone, Debug, Error)]
#[error("{message}")]
pub struct SpecError {
    /// What kind of error it is.
    pub kind: ErrorKind,
    /// JSON pointer (RFC 6901) of the field, e.g. `/bounds/q_e`; empty for the document as a whole. For a missing
    /// field, where it should be.
    pub pointer: String,
    /// The bytes of the file at fault. For expressions and constants inside strings this is the offending part of
    /// the literal; for a missing field, the key of the object that lacks it.
    pub span: Range<usize>,
    /// What is wrong, in one sentence.
    pub message: String,
    /// What was expected in that place.
    pub expected: Option<String>,
    /// What to do about it.
    pub help: Option<String>,
}

impl SpecError {
    /// An error with neither expectation nor help.
    #[must_use]
    pub fn new(
        kind: ErrorKind,
        pointer: impl Into<String>,
        span: Range<usize>,
        message: impl Into<String>,
    ) -> SpecError {
        SpecError { kind, pointer: pointer.into(), span, message: message.into(), expected: None, help: None }
    }

    /// This error, saying what was expected.
    #[must_use]
    pub fn expected(mut self, expected: impl Into<String>) -> SpecError {
        self.expected = Some(expected.into());
        self
    }

    /// This error in another place.
    #[must_use]
    pub(super) fn at(mut self, pointer: String, span: Range<usize>) -> SpecError {
        (self.pointer, self.span) = (pointer, span);
        self
    }

    /// This error, saying what to do.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> SpecError {
        self.help = Some(help.into());
        self
    }
}

/// The errors found in one document, in file order and with its text, so that they can be shown in context.
///
/// There is at least one. `Display` gives one line per error; [`SpecErrors::render`] shows the source.
#[derive(Clone, Debug, Error)]
pub struct SpecErrors {
    pub(super) origin: Arc<Source>,
    pub(super) errors: Vec<SpecError>,
    pub(super) omitted: usize,
    /// The sentence of an error that stands alone with every digit, where its message has fewer.
    pub(super) in_full: Option<String>,
}

impl SpecErrors {
    /// The error that stopped the reading of a document.
    pub(super) fn single(origin: Arc<Source>, error: SpecError) -> SpecErrors {
        SpecErrors { origin, errors: vec![error], omitted: 0, in_full: None }
    }

    /// These errors, with the sentence in full of an error that stands alone.
    #[must_use]
    pub fn with_sentence_in_full(self, in_full: Option<String>) -> SpecErrors {
        SpecErrors { in_full, ..self }
    }

    /// These errors, with more to do about an error that stands alone.
    #[must_use]
    pub fn with_more_help(mut self, more: &str) -> SpecErrors {
        if let [error] = self.errors.as_mut_slice() {
            error.help = Some(error.help.take().map_or_else(|| more.to_owned(), |help| format!("{help}; {more}")));
        }
        self
    }

    /// The sentence of one of these errors with every digit of its numbers.
    #[must_use]
    pub fn in_full<'e>(&'e self, error: &'e SpecError) -> &'e str {
        match (&self.in_full, self.errors.as_slice()) {
            (Some(sentence), [_]) => sentence,
            _ => &error.message,
        }
    }

    /// The errors, in file order; at least one and at most [`MAX_ERRORS`].
    #[must_use]
    pub fn errors(&self) -> &[SpecError] {
        &self.errors
    }

    /// How many errors were found beyond those that are kept.
    #[must_use]
    pub fn omitted(&self) -> usize {
        self.omitted
    }

    /// The name under which the document was read.
    #[must_use]
    pub fn label(&self) -> &str {
        &self.origin.label
    }

    /// The text of the document; empty where it was refused for its size or its encoding.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.origin.text
    }

    /// Line and column (in characters) at which one of these errors starts, both from 1.
    #[must_use]
    pub fn place(&self, error: &SpecError) -> (usize, usize) {
        self.origin.line_and_column(error.span.start)
    }

    /// Whether nothing was found to be wrong and something could not be decided: then the answer is "undecided"
    /// (exit code 3), not "bad input".
    #[must_use]
    pub fn is_undecided(&self) -> bool {
        self.omitted == 0 && self.errors.iter().all(|error| error.kind == ErrorKind::Undecided)
    }
}

impl fmt::Display for SpecErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, error) in self.errors.iter().enumerate() {
            let (line, column) = self.origin.line_and_column(error.span.start);
            let separator = if index == 0 { "" } else { "\n" };
            write!(f, "{separator}{}:{line}:{column}: {}", self.origin.label, error.message)?;
        }
        if self.omitted > 0 {
            write!(f, "\n{}: {} more errors are not shown", self.origin.label, self.omitted)?;
        }
        Ok(())
    }
}

/// Proof that an error was recorded: only [`Errors::report`] makes one, so a reader that fails with it cannot fail
/// silently.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reported(());

/// Collects the errors of one document, so that a user sees all of them at once.
#[derive(Debug, Default)]
pub struct Errors {
    pub(super) list: Vec<SpecError>,
    pub(super) omitted: usize,
}

impl Errors {
    /// An empty collection.
    #[must_use]
    pub fn new() -> Errors {
        Errors::default()
    }

    /// Records an error.
    pub fn report(&mut self, error: SpecError) -> Reported {
        if self.list.len() < MAX_ERRORS {
            self.list.push(error);
        } else {
            self.omitted += 1;
        }
        Reported(())
    }

    /// Counts errors that are not recorded one by one, beyond others that are.
    pub(super) fn count(&mut self, more: usize) {
        self.omitted += more;
    }
}

/// A name from the document as it may appear in a message: short, and without control characters.
pub(super) fn shown(text: &str) -> String {
    let short: String =
        if text.chars().count() <= 40 { text.to_owned() } else { text.chars().take(37).collect::<String>() + "..." };
    // Quotes stay as they are; everything that could move the cursor is escaped.
    short.chars().flat_map(|c| if c == '"' || c == '\'' { vec![c] } else { c.escape_debug().collect() }).collect()
}

/// The known name nearest to what was written, if one is near enough to be what was meant.
pub fn nearest<'n>(written: &str, known: impl IntoIterator<Item = &'n str>) -> Option<&'n str> {
    // Beyond this length nothing is near, and the distance would be costly.
    if written.len() > 64 {
        return None;
    }
    let written = written.to_lowercase();
    known
        .into_iter()
        .map(|name| (strsim::damerau_levenshtein(&written, &name.to_lowercase()), name))
        .filter(|(distance, name)| *distance <= (name.chars().count() / 3).max(1))
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, name)| name)
}

/// "`a`, `b` and `c`".
pub(super) fn list(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [only] => format!("`{only}`"),
        [first @ .., last] => {
            let first: Vec<String> = first.iter().map(|name| format!("`{name}`")).collect();
            format!("{} and `{last}`", first.join(", "))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_codes_are_in_the_order_of_declaration() {
        for (index, (kind, code)) in CODES.into_iter().enumerate() {
            assert_eq!(kind as usize, index);
            assert_eq!(ErrorKind::from_code(code), Some(kind));
        }
        assert_eq!(CODES.len(), ErrorKind::NotAvailable as usize + 1);
    }
}
