//! What a command is asked about: a bounding specification, or a plant by its formulas.

use super::failure::Failure;
use super::progress::{Audience, Working};
use rug::Rational;
use sigmastar::certify::with_triple;
use sigmastar::plant::{self, Plant};
use sigmastar::reduction::{reduce, reduce_digital};
use sigmastar::search::{DigitalProposal, SharpProposal};
use sigmastar::spec::{Document, Sampling, Specification};

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

    /// The samples that the regulator is asked for at, if any.
    pub fn sampling(&self) -> Option<&Sampling> {
        match self {
            Subject::Specification(spec) => spec.internal_model.sampling.as_ref(),
            Subject::Plant(plant) => plant.internal_model.sampling.as_ref(),
        }
    }

    /// Whether the base frequency is that of the period.
    pub fn is_matched(&self) -> bool {
        match self {
            Subject::Specification(spec) => spec.internal_model.matched,
            Subject::Plant(plant) => plant.internal_model.matched,
        }
    }

    /// The same for a claim about the regulator at samples, at the gain that is given or at the smallest one.
    ///
    /// # Errors
    /// Those of [`Subject::into_data`].
    pub fn into_digital_data(
        self,
        sampling: &Sampling,
        gain: Option<&Rational>,
        quiet: bool,
    ) -> Result<(Specification, Option<DigitalProposal>), Failure> {
        match self {
            Subject::Plant(plant) => {
                let _working = proving_bounds(quiet);
                let reduced = reduce_digital(&plant, sampling, gain);
                let reduced = reduced.map_err(|refusal| Failure::Documents(refusal.errors(&plant)))?;
                Ok((reduced.spec, Some(reduced.proposal)))
            }
            specification @ Subject::Specification(_) => Ok((specification.into_data(quiet)?.0, None)),
        }
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
                let _working = proving_bounds(quiet);
                let reduced = reduce(&plant).map_err(|refusal| Failure::Documents(refusal.errors(&plant)))?;
                Ok((reduced.spec, Some(reduced.proposal)))
            }
        }
    }
}

/// Says what takes long of a plant.
fn proving_bounds(quiet: bool) -> Working {
    let audience = if quiet { Audience::Nobody } else { Audience::Everywhere };
    Working::new("finding the orbit and proving the plant's bounds", audience)
}

/// Says that a triple is sought, where that takes long.
pub fn seeking_triple(quiet: bool) -> Working {
    let audience = if quiet { Audience::Nobody } else { Audience::Everywhere };
    Working::new("finding and proving the Lyapunov triple of the Jacobian", audience)
}
