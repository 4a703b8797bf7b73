//! What a command is asked about: a bounding specification, or a plant by its formulas.

use super::failure::Failure;
use super::progress::{Audience, Working};
use sigmastar::certify::with_triple;
use sigmastar::plant::{self, Plant};
use sigmastar::reduction::reduce;
use sigmastar::search::SharpProposal;
use sigmastar::spec::{Document, Specification};

/// A document of either kind.
pub enum Subject {
    /// A bounding specification.
    Specification(Box<Specification>),
    /// A plant.
    Plant(Box<Plant>),
}

impl Subject {
    /// Reads it, by its `format`; what is neither is told as a specification.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn read(document: &Document) -> Result<Subject, Failure> {
        let root = document.root();
        if document.at("/format").is_some_and(|format| format.text() == Some(plant::FORMAT)) {
            return Ok(Subject::Plant(Box::new(Plant::from_value(&root)?)));
        }
        Ok(Subject::Specification(Box::new(Specification::from_value(&root)?)))
    }

    /// The specification with proved data, and where the search for a gain may start: the triple of a Jacobian is sought, the
    /// data of a plant are proved.
    ///
    /// # Errors
    /// What keeps the data from being proved, at its place.
    pub fn into_data(self, quiet: bool) -> Result<(Specification, Option<SharpProposal>), Failure> {
        match self {
            Subject::Specification(spec) => {
                let wanted = spec.lyapunov.triple().is_none();
                let _working = wanted.then(|| seeking_triple(quiet));
                let proved = with_triple(&spec, None).map_err(|refusal| Failure::Documents(refusal.errors(&spec)))?;
                Ok((proved.into_owned(), None))
            }
            Subject::Plant(plant) => {
                let audience = if quiet { Audience::Nobody } else { Audience::Everywhere };
                let _working = Working::new("finding the orbit and proving the plant's bounds", audience);
                let reduced = reduce(&plant).map_err(|refusal| Failure::Documents(refusal.errors(&plant)))?;
                Ok((reduced.spec, Some(reduced.proposal)))
            }
        }
    }
}

/// Says that a triple is sought, where that takes long.
pub fn seeking_triple(quiet: bool) -> Working {
    let audience = if quiet { Audience::Nobody } else { Audience::Everywhere };
    Working::new("finding and proving the Lyapunov triple of the Jacobian", audience)
}
