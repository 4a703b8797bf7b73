//! What is certified: a bounding specification, or a plant by its formulas.

use super::error::Error;
use super::specification::Specification;
use super::{json_text, with_sampling_period};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Document, MAX_BYTES, Notation};
use sigmastar_prove::reduction::Subject as Read;
use std::path::Path;

/// What errors call a document without a name of its own.
const LABEL: &str = "document";

/// A bounding specification or a plant, as it was read. Which of both a document is says its `format`.
///
/// Of a plant nothing is left to the user: [`certify`](sigmastar_prove::certify) finds and proves its orbit and every bound that the
/// claim needs.
///
/// ```no_run
/// use sigmastar::{CertifyOptions, Subject, certify};
/// # fn main() -> Result<(), sigmastar::Error> {
/// # let text = "";
/// let plant = Subject::from_json(text)?;
/// let certificate = certify(&plant, &CertifyOptions::new())?;
/// assert!(plant.is_plant() && certificate.claim().specification_sha256() == plant.sha256());
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Subject {
    pub(super) read: Read,
    /// The document with its places.
    pub(super) source: Document,
}

impl Subject {
    /// The most bytes of a document that are read.
    pub const MAX_BYTES: usize = MAX_BYTES;

    /// Reads a document from its text (`docs/formats.md`). Never panics, whatever the text.
    ///
    /// # Errors
    /// Those of [`Specification::from_json`].
    pub fn from_json(text: &str) -> Result<Subject, Error> {
        Subject::new(Document::parse(LABEL, text)?)
    }

    /// Reads a document from the bytes of a file; `name` is what errors call it, usually its path, whose ending says the notation: JSON, or with
    /// `.jsonc` JSON with comments, with `.toml` TOML.
    ///
    /// # Errors
    /// Those of [`Subject::from_json`], and bytes that are not UTF-8.
    pub fn from_bytes(name: &str, bytes: &[u8]) -> Result<Subject, Error> {
        Subject::new(Document::from_bytes_as(name, bytes, Notation::of(Path::new(name)))?)
    }

    pub(super) fn new(source: Document) -> Result<Subject, Error> {
        Ok(Subject { read: Read::read(&source)?, source })
    }

    /// This document about the regulator at samples this far apart, as `sampling_period` of its internal model: what
    /// [`certify`](crate::certify) with [`CertifyOptions::sampling_period`](crate::CertifyOptions::sampling_period) certifies, so that
    /// [`check_against`](crate::check_against) can compare such a certificate with the document that it was made for.
    ///
    /// # Errors
    /// A sampling period that is no exact positive constant, or does not go with the document.
    pub fn at_samples(&self, sampling_period: &str) -> Result<Subject, Error> {
        let document = with_sampling_period(&self.source, "sampling_period", sampling_period)?;
        let read = Read::read(&document)?;
        // Errors have been told at the lines that were read; from here on the text has the field, too.
        let source = Document::parse(document.label(), &json_text(&document.root().to_json()))?;
        Ok(Subject { read, source })
    }

    /// The plant; what is none is told as such.
    pub(super) fn plant(&self) -> Result<Plant, Error> {
        Ok(Plant::from_value(&self.source.root())?)
    }

    /// Whether it is a plant by its formulas.
    #[must_use]
    pub fn is_plant(&self) -> bool {
        matches!(self.read, Read::Plant(_))
    }

    /// Its name.
    #[must_use]
    pub fn name(&self) -> &str {
        self.read.name()
    }

    /// The document as it was read, indented, with every number as it was written.
    #[must_use]
    pub fn to_json(&self) -> String {
        json_text(self.read.document())
    }

    /// SHA-256, in hexadecimal, of the canonical form of the document: what a certificate names.
    #[must_use]
    pub fn sha256(&self) -> &str {
        self.read.sha256()
    }
}

impl From<Specification> for Subject {
    fn from(specification: Specification) -> Subject {
        let source = specification.read.source.clone();
        Subject { read: Read::Specification(Box::new(specification.read)), source }
    }
}

impl From<&Specification> for Subject {
    fn from(specification: &Specification) -> Subject {
        specification.clone().into()
    }
}

impl From<&Subject> for Subject {
    fn from(subject: &Subject) -> Subject {
        subject.clone()
    }
}
