//! The notations of a document that people write: JSON, JSON with comments, TOML. All of them give the same values.

use super::error::SpecError;
use super::json::{self, Node};
use super::{comments, toml, visible};
use std::ops::Range;
use std::path::Path;

/// How a document is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Notation {
    /// RFC 8259 and nothing more.
    Json,
    /// JSON (RFC 8259) with `//` and `/* */` comments.
    JsonWithComments,
    /// TOML; its tables are objects.
    Toml,
}

impl Notation {
    /// The notation of a file, by its extension: `.jsonc` and `.toml`; anything else is JSON.
    #[must_use]
    pub fn of(path: &Path) -> Notation {
        match path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase).as_deref() {
            Some("jsonc") => Notation::JsonWithComments,
            Some("toml") => Notation::Toml,
            _ => Notation::Json,
        }
    }

    /// Whether every document of this notation is one of the other.
    #[must_use]
    pub fn is_part_of(self, other: Notation) -> bool {
        self == other || (self == Notation::Json && other == Notation::JsonWithComments)
    }

    /// Reads a document to its tree.
    ///
    /// # Errors
    /// The first thing that is wrong with the document in this notation.
    pub(super) fn parse(self, text: &str) -> Result<Node, SpecError> {
        match self {
            Notation::Json => json::parse(text),
            Notation::JsonWithComments => {
                visible::check(text)?;
                json::parse(&comments::blanked(text)).map_err(|error| match text.get(error.span.clone()) {
                    Some("/" | "#") => {
                        error.help("a comment runs from `//` to the end of the line, or from `/*` to `*/`")
                    }
                    _ => error,
                })
            }
            Notation::Toml => {
                visible::check(text)?;
                toml::parse(text)
            }
        }
    }

    /// Where the bytes `range` of a decoded string stand in the document, given the span of its literal (with quotes).
    pub(super) fn locate(self, text: &str, literal: &Range<usize>, range: &Range<usize>) -> Range<usize> {
        match self {
            Notation::Json | Notation::JsonWithComments => json::locate(text, literal, range),
            Notation::Toml => toml::locate(text, literal, range),
        }
    }
}
