//! What a command is asked about, and what of it takes long.

use super::failure::Failure;
use super::progress::{Audience, Working};
use rug::Rational;
use sigmastar::search::{SampledProposal, SharpProposal};
use sigmastar::spec::{Sampling, Specification};

pub use sigmastar::reduction::Subject;

/// Proving the data of a subject, with a word to whoever waits.
pub trait IntoData {
    /// [`Subject::proved`].
    ///
    /// # Errors
    /// What keeps the data from being proved, at its place.
    fn into_data(self, quiet: bool) -> Result<(Specification, Option<SharpProposal>), Failure>;

    /// [`Subject::proved_at_samples`].
    ///
    /// # Errors
    /// Those of [`IntoData::into_data`].
    fn into_sampled_data(
        self,
        sampling: &Sampling,
        gain: Option<&Rational>,
        quiet: bool,
    ) -> Result<(Specification, Option<SampledProposal>), Failure>;
}

impl IntoData for Subject {
    fn into_data(self, quiet: bool) -> Result<(Specification, Option<SharpProposal>), Failure> {
        let _working = proving(&self, quiet);
        self.proved().map_err(Failure::Documents)
    }

    fn into_sampled_data(
        self,
        sampling: &Sampling,
        gain: Option<&Rational>,
        quiet: bool,
    ) -> Result<(Specification, Option<SampledProposal>), Failure> {
        let _working = proving(&self, quiet);
        self.proved_at_samples(sampling, gain).map_err(Failure::Documents)
    }
}

/// Says what takes long of a subject, if anything does.
fn proving(subject: &Subject, quiet: bool) -> Option<Working> {
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
