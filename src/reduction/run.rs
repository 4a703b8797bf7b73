//! The whole way from a subject to a decided claim, of either regulator.

use super::Subject;
use crate::certify::{
    Certification, Options, Refusal, SampledCertification, certify_at, certify_near, certify_sampled,
};
use crate::search::{SampledProposal, SharpProposal};
use crate::spec::{Sampling, SpecErrors, Specification};
use rug::Rational;

/// Where a search may start: of the regulator in continuous time, or of the one at samples.
enum Start {
    Continuous(Option<SharpProposal>),
    Sampled(Box<Sampling>, Option<SampledProposal>),
}

/// A subject whose data are proved, for one question.
pub struct Prepared {
    spec: Specification,
    start: Start,
    gain: Option<Rational>,
}

/// What a run found out. What it claims is about the regulator at samples where the subject asks for that.
#[derive(Clone, Debug)]
pub enum Run<'s> {
    /// Of the regulator in continuous time.
    Continuous(Box<Certification<'s>>),
    /// Of the regulator at samples.
    Sampled(Box<SampledCertification<'s>>),
}

impl Prepared {
    /// Proves the data of a subject, for a gain that is given or for the smallest one.
    ///
    /// # Errors
    /// What keeps the data from being proved, at its place; not empty.
    pub fn new(subject: Subject, gain: Option<Rational>) -> Result<Prepared, Vec<SpecErrors>> {
        match subject.sampling().cloned() {
            None => {
                let (spec, start) = subject.proved()?;
                Ok(Prepared { spec, start: Start::Continuous(start), gain })
            }
            Some(sampling) => {
                let (spec, start) = subject.proved_at_samples(&sampling, gain.as_ref())?;
                Ok(Prepared { spec, start: Start::Sampled(Box::new(sampling), start), gain })
            }
        }
    }

    /// Searches, rounds and decides. Hypothesis: the options fit ([`Options::misfit`]).
    ///
    /// # Errors
    /// What the data are refused for, at its place; not empty.
    pub fn certify(&self, options: Options) -> Result<Run<'_>, Vec<SpecErrors>> {
        let (spec, gain) = (&self.spec, self.gain.as_ref());
        let run = match &self.start {
            Start::Continuous(start) => match gain {
                None => certify_near(spec, options, start.as_ref()),
                Some(gain) => certify_at(spec, options, start.as_ref(), gain),
            }
            .map(|run| Run::Continuous(Box::new(run))),
            Start::Sampled(sampling, start) => certify_sampled(spec, sampling, gain, start.as_ref(), options.ladder)
                .map(|run| Run::Sampled(Box::new(run))),
        };
        run.map_err(|refusal: Refusal| refusal.errors(spec))
    }
}

impl Run<'_> {
    /// The bounding functions that were neither proved nor refuted, as errors at their places.
    #[must_use]
    pub fn unproved(&self) -> Vec<SpecErrors> {
        let (problems, spec) = match self {
            Run::Continuous(run) => (&run.unproved_bounds, run.spec),
            Run::Sampled(run) => (&run.unproved_bounds, run.spec),
        };
        problems.iter().map(|problem| problem.errors(spec)).collect()
    }
}
