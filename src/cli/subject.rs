//! What a command is asked about, a specification, a plant or a certificate of one, and what of it takes long.

use super::failure::Failure;
use super::given::Given;
use super::input;
use super::output::{json_text, shown};
use super::progress::{Later, working};
use sigmastar_lang::plant::{FORMAT as PLANT, Plant};
use sigmastar_lang::spec::{Document, Specification};
use sigmastar_prove::certificate::{FORMAT as CERTIFICATE, embedded};
use std::path::Path;

pub use sigmastar_prove::reduction::Subject;

/// The document that a command is asked about, and the certificate that it was taken from, where there is one.
pub struct Asked {
    /// The specification or plant.
    pub document: Document,
    /// The certificate that it is embedded in. What it claims is taken as it is.
    pub given: Option<Given>,
}

impl Asked {
    /// Reads a specification or plant, or the one that a certificate embeds.
    ///
    /// # Errors
    /// What cannot be read of the file, and a certificate whose document is not the one that its digest is of.
    pub fn read(path: &Path) -> Result<Asked, Failure> {
        Asked::of(path, input::document(path)?)
    }

    /// Reads what a document from this path is about: a specification or plant, or the one that a certificate embeds.
    ///
    /// # Errors
    /// A certificate whose document is not the one that its digest is of.
    pub fn of(path: &Path, document: Document) -> Result<Asked, Failure> {
        if !has_format(&document, CERTIFICATE) {
            return Ok(Asked { document, given: None });
        }
        let given = Given::read(&document)?;
        let embedded = embedded(&document.root()).ok_or_else(|| {
            let help = "take a certificate that `certify -o` wrote";
            Failure::call("the certificate embeds neither a specification nor a plant", help)
        })?;
        let subject = Subject::from_value(&embedded)?;
        let kind = subject.kind();
        if !given.is_about(subject.sha256()) {
            let message = format!("the {kind} in the certificate is not the one that its digest is of");
            return Err(Failure::call(message, "the file was changed; `sigmastar check` says more"));
        }
        // A document of its own, for what puts other values into it.
        let document = Document::parse(&format!("the {kind} in {}", shown(path)), &json_text(&embedded.to_json()))?;
        Ok(Asked { document, given: Some(given) })
    }

    /// The specification or plant.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn subject(&self) -> Result<Subject, Failure> {
        Ok(Subject::read(&self.document)?)
    }

    /// The plant, where only formulas will do; `what` needs them.
    ///
    /// # Errors
    /// What is wrong with it; a certificate of a specification.
    pub fn plant(&self, what: &str) -> Result<Plant, Failure> {
        if self.given.is_some() && !has_format(&self.document, PLANT) {
            let message = format!("this certificate is of a specification, by bounds alone, and {what} needs formulas");
            return Err(Failure::call(message, "take a plant (`sigmastar new plant`), or the certificate of one"));
        }
        Ok(Plant::from_value(&self.document.root())?)
    }

    /// The specification, where only one that states its bounds will do; `what` needs them.
    ///
    /// # Errors
    /// What is wrong with it; a certificate of a plant.
    pub fn specification(&self, what: &str) -> Result<Specification, Failure> {
        if self.given.is_some() && has_format(&self.document, PLANT) {
            let message = format!("this certificate is of a plant, and {what} needs a bounding specification");
            return Err(Failure::call(message, "`sigmastar bound` writes one for a plant or its certificate"));
        }
        Ok(Specification::from_value(&self.document.root())?)
    }
}

/// Whether a document says that it is of this format.
pub fn has_format(document: &Document, format: &str) -> bool {
    document.at("/format").is_some_and(|value| value.text() == Some(format))
}

/// Says what takes long of a subject's data, if anything does, and `more` of how to hear of it.
pub fn proving(subject: &Subject, more: &'static str, quiet: bool) -> Option<Later> {
    match subject {
        Subject::Specification(spec) if spec.lyapunov.triple().is_some() => None,
        Subject::Specification(_) => seeking_triple(more, quiet),
        Subject::Plant(_) => working("finding the orbit and proving the plant's bounds", more, quiet),
    }
}

/// Says that a triple is sought, where that takes long.
pub fn seeking_triple(more: &'static str, quiet: bool) -> Option<Later> {
    working("finding and proving the Lyapunov triple of the Jacobian", more, quiet)
}
