//! The report of a run, of either regulator.

use super::remarks::{remarks, sampled_remarks};
use super::verdict::sentence;
use super::{Origin, Report, SampledReport};
use serde_json::Value;
use sigmastar_document::{Block, Readable};
use sigmastar_prove::reduction::Run;
use sigmastar_theory::derivation::targets::Target;

/// The report of a run.
pub enum RunReport<'r> {
    /// Of the regulator in continuous time.
    Continuous(Box<Report<'r>>),
    /// Of the regulator at samples.
    Sampled(SampledReport<'r>),
}

impl<'r> RunReport<'r> {
    /// The report, with answers to the targets.
    #[must_use]
    pub fn new(run: &'r Run<'r>, targets: &[Target], origin: Origin) -> RunReport<'r> {
        match run {
            Run::Continuous(run) => RunReport::Continuous(Box::new(Report::new(run, targets, origin))),
            Run::Sampled(run) => RunReport::Sampled(SampledReport::new(run, targets, origin)),
        }
    }
}

impl Readable for RunReport<'_> {
    fn blocks(&self) -> Vec<Block> {
        match self {
            RunReport::Continuous(report) => report.blocks(),
            RunReport::Sampled(report) => report.blocks(),
        }
    }

    fn json(&self) -> Value {
        match self {
            RunReport::Continuous(report) => report.json(),
            RunReport::Sampled(report) => report.json(),
        }
    }
}

/// What came of a run in one sentence; without a certificate, what failed.
#[must_use]
pub fn run_sentence(run: &Run<'_>) -> String {
    match run {
        Run::Continuous(run) => sentence(run),
        Run::Sampled(run) => SampledReport::sentence_of(run),
    }
}

/// What the data of a certified claim are to be looked at for.
pub fn run_remarks(run: &Run<'_>) -> Vec<String> {
    match run {
        Run::Continuous(run) => remarks(run),
        Run::Sampled(run) => sampled_remarks(run),
    }
}
