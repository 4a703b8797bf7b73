//! What a command is asked about, and what of it takes long.

use super::failure::Failure;
use super::input;
use super::progress::{Audience, Working};
use sigmastar_lang::spec::{Document, Specification};
use sigmastar_prove::reduction::at_samples;
use sigmastar_prove::search::SharpProposal;

pub use sigmastar_prove::reduction::Subject;

/// [`Subject::proved`], with a word to whoever waits.
///
/// # Errors
/// What keeps the data from being proved, at its place.
pub fn proved(subject: Subject, quiet: bool) -> Result<(Specification, Option<SharpProposal>), Failure> {
    let _working = proving(&subject, quiet);
    subject.proved().map_err(Failure::Documents)
}

/// Says what takes long of a subject's data, if anything does.
pub fn proving(subject: &Subject, quiet: bool) -> Option<Working> {
    match subject {
        Subject::Specification(spec) => spec.lyapunov.triple().is_none().then(|| seeking_triple(quiet)),
        Subject::Plant(_) => {
            let audience = if quiet { Audience::Nobody } else { Audience::Everywhere };
            Some(Working::new("finding the orbit and proving the plant's bounds", audience))
        }
    }
}

/// Says that a triple is sought, where that takes long.
pub fn seeking_triple(quiet: bool) -> Working {
    let audience = if quiet { Audience::Nobody } else { Audience::Everywhere };
    Working::new("finding and proving the Lyapunov triple of the Jacobian", audience)
}

/// The document with another sampling period, or itself where it has no internal model: what is wrong with it is told as ever.
///
/// # Errors
/// A period that is not an exact positive constant, and a document that is too large with it.
pub fn with_sampling_period(document: &Document, text: &str) -> Result<Document, Failure> {
    let step = input::positive("--sampling-period", text)?;
    Ok(at_samples(document, &step, "--sampling-period")?)
}
