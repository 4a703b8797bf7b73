//! Attempts to break a certificate: floating point, no claim.

use super::error::Error;
use super::report::Report;
use super::{in_range, json_text};
use sigmastar_document::progress::Silent;
use sigmastar_lab::falsify::{
    Falsification as Found, FalsificationReport, TrialSettings, TriedClaim, counterexample_plant,
};
use sigmastar_lang::spec::Document;

/// How many trials there are at most.
const MAX_TRIALS: u32 = 1_000_000;

/// What random plants did to a certificate. Nothing is proved by it.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Falsification {
    outcome: FalsificationOutcome,
    counterexample: Option<String>,
    report: Report,
}

/// What became of all trials.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum FalsificationOutcome {
    /// In every trial that could be finished every bound held.
    Held,
    /// In a trial a bound did not hold.
    Broken,
    /// No trial could be finished.
    Unfinished,
}

impl Falsification {
    /// What became of all trials.
    #[must_use]
    pub fn outcome(&self) -> FalsificationOutcome {
        self.outcome
    }

    /// The plant of the first trial in which a bound did not hold, as a plant file with its initial condition; its description says how
    /// to simulate it.
    #[must_use]
    pub fn counterexample(&self) -> Option<&str> {
        self.counterexample.as_deref()
    }

    /// The report of `sigmastar falsify`, with every trial.
    #[must_use]
    pub fn report(&self) -> &Report {
        &self.report
    }
}

/// Simulates random plants that satisfy the data of a certificate, or of a plant's certificate the plant, and holds what they do
/// against its bounds. `name` is what errors call the certificate. The same seed gives the same trials.
///
/// # Errors
/// What is wrong with the certificate; [`Range`](super::ErrorKind::Range) for no trials, or more than a million.
pub fn falsify(name: &str, certificate: &[u8], trials: u32, seed: u64) -> Result<Falsification, Error> {
    in_range("trials", trials, 1..=MAX_TRIALS)?;
    let claim = TriedClaim::from_document(&Document::from_bytes(name, certificate)?)?;
    let settings = TrialSettings { trials: u64::from(trials), seed, only: None };
    let found: Found = sigmastar_lab::falsify::falsify(&claim, settings, &Silent);
    let counterexample = match found.counterexample() {
        None => None,
        Some((trial, violation)) => {
            Some(json_text(&counterexample_plant(&claim, trial, Some(violation))?.root().to_json()))
        }
    };
    let outcome = match &counterexample {
        Some(_) => FalsificationOutcome::Broken,
        None if found.has_held() => FalsificationOutcome::Held,
        None => FalsificationOutcome::Unfinished,
    };
    let report = Report::of(&FalsificationReport { tried: &[(claim, found)] });
    Ok(Falsification { outcome, counterexample, report })
}
