//! The report of a run, of either regulator.

use super::Origin;
use super::certification::Report;
use super::remarks::{remarks, sampled_remarks};
use super::sampled::{self, SampledReport};
use super::verdict::{assumed, sentence};
use super::words;
use sigmastar_document::{Extent, Readable, plain, plain_all};
use sigmastar_prove::reduction::Run;
use sigmastar_theory::derivation::targets::Target;

/// The report of a run, with answers to the targets; for a short one not all of the whole one is worked out.
#[must_use]
pub fn run_report<'r>(run: &'r Run<'r>, targets: &[Target], origin: Origin, extent: Extent) -> Box<dyn Readable + 'r> {
    match run {
        Run::Continuous(run) => Box::new(Report::new(run, targets, origin, extent)),
        Run::Sampled(run) => Box::new(SampledReport::new(run, targets, origin)),
    }
}

/// What came of a run in one sentence; without a certificate, what failed.
#[must_use]
pub fn run_sentence(run: &Run<'_>) -> String {
    plain(&match run {
        Run::Continuous(run) => sentence(run),
        Run::Sampled(run) => sampled::sentence(run),
    })
}

/// What is said of a certified run, with its formulas marked.
pub struct ClaimInWords {
    /// The initial set, in a clause.
    pub initial_set: String,
    /// What is assumed of the plant, in a clause.
    pub assumed: String,
    /// What the letters are, in a sentence.
    pub letters: String,
}

/// The initial set, the assumptions and the letters of a certified run; `None` where nothing is certified.
#[must_use]
pub fn run_in_words(run: &Run<'_>) -> Option<ClaimInWords> {
    let (spec, claimed) = (run.spec(), run.certified()?.set);
    let initial_set = words::set(spec, claimed) + &words::ball(spec, claimed);
    let used = match run {
        Run::Continuous(run) => run.largest_arguments(),
        Run::Sampled(run) => run.largest_arguments(),
    };
    Some(ClaimInWords { initial_set, assumed: assumed(spec, used, None), letters: words::letters(spec, claimed) })
}

/// What the data of a certified claim are to be looked at for.
pub fn run_remarks(run: &Run<'_>) -> Vec<String> {
    plain_all(match run {
        Run::Continuous(run) => remarks(run),
        Run::Sampled(run) => sampled_remarks(run),
    })
}
