//! Attempts to break a certificate: floating point, no claim.

use super::error::{Error, ErrorKind};
use super::report::Report;
use super::{in_range, json_text};
use rug::Rational;
use sigmastar_document::progress::{Progress, Silent};
use sigmastar_lab::falsify::{
    Falsification as Found, FalsificationReport, FrequencyError, OscillatorsError, ParameterError, TriedClaim,
    counterexample_plant, flags, with_base_frequency,
};
use sigmastar_lang::spec::{Constant, Document, Oscillators};

pub use sigmastar_lab::falsify::TrialSettings;

/// How many trials there are at most.
const MAX_TRIALS: u32 = 1_000_000;

/// What random plants did to a certificate. Nothing is proved by it.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Falsification {
    outcome: FalsificationOutcome,
    counterexample: Option<String>,
    trial: Option<TrialPlant>,
    report: Report,
}

/// The plant of a trial, for the program.
#[derive(Clone, Debug)]
pub struct TrialPlant {
    /// The plant file.
    pub text: String,
    /// The flags of `simulate` with which it does what it did.
    pub flags: String,
    /// Whether a bound did not hold.
    pub broken: bool,
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

    /// The plant of the first trial in which a bound did not hold; of the one trial that was asked for, where one was, in any case.
    #[doc(hidden)]
    #[must_use]
    pub fn trial(&self) -> Option<&TrialPlant> {
        self.trial.as_ref()
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
    let settings = TrialSettings { trials: u64::from(trials), seed, only: None };
    Attempt::new(&Document::from_bytes(name, certificate)?)?.run(settings, &Silent)
}

/// What is held against the bounds of a certificate.
pub struct Attempt {
    /// That of the certificate, then those with other base frequencies.
    claims: Vec<TriedClaim>,
}

impl Attempt {
    /// The plants of the certificate.
    ///
    /// # Errors
    /// What is wrong with the certificate.
    pub fn new(certificate: &Document) -> Result<Attempt, Error> {
        Ok(Attempt { claims: vec![TriedClaim::from_document(certificate)?] })
    }

    /// Of a plant with parameters in intervals, the ones with these values alone.
    ///
    /// # Errors
    /// Values that the claim is not about.
    pub fn with_parameters(self, values: &[(String, Rational)]) -> Result<Attempt, Error> {
        let with = |claim: TriedClaim| {
            let wrong = |error: ParameterError| Error::new(ErrorKind::Range, error.to_string(), &error.help());
            claim.with_parameters(values).map_err(wrong)
        };
        Ok(Attempt { claims: self.claims.into_iter().map(with).collect::<Result<_, _>>()? })
    }

    /// Beside them those with other base frequencies, each certified first.
    ///
    /// # Errors
    /// A claim about samples, and a base frequency for which there is no claim.
    pub fn with_base_frequencies(mut self, others: &[Constant]) -> Result<Attempt, Error> {
        if self.claims[0].sampled.is_some() && !others.is_empty() {
            let message = "the law at samples is certified for the base frequency 2 pi/period alone";
            return Err(Error::new(ErrorKind::Options, message, "leave --base-frequency out"));
        }
        for frequency in others {
            let claim = with_base_frequency(&self.claims[0], frequency).map_err(|error| match error {
                FrequencyError::Specification(errors) => Error::from(errors),
                error @ FrequencyError::NotCertified { .. } => {
                    let help = "see why with `certify`, or leave this base frequency out";
                    Error::new(ErrorKind::Options, error.to_string(), help)
                }
            })?;
            self.claims.push(claim);
        }
        Ok(self)
    }

    /// All of them with oscillators at these sets of harmonics alone, one trial after the other; none chooses nothing.
    ///
    /// # Errors
    /// A set that a claim is not about.
    pub fn with_oscillators(self, sets: &[Oscillators]) -> Result<Attempt, Error> {
        let with = |claim: TriedClaim| {
            let wrong = |error: OscillatorsError| Error::new(ErrorKind::Range, error.to_string(), error.help());
            claim.with_oscillators(sets).map_err(wrong)
        };
        Ok(Attempt { claims: self.claims.into_iter().map(with).collect::<Result<_, _>>()? })
    }

    /// The trials.
    ///
    /// # Errors
    /// A plant of a trial that is too large for a file.
    pub fn run(self, settings: TrialSettings, progress: &impl Progress) -> Result<Falsification, Error> {
        let tried: Vec<(TriedClaim, Found)> = self
            .claims
            .into_iter()
            .map(|claim| {
                let found = sigmastar_lab::falsify::falsify(&claim, settings, progress);
                (claim, found)
            })
            .collect();
        let broken = tried.iter().find_map(|(claim, found)| Some((claim, found.counterexample()?)));
        let written = broken.map(|(claim, (trial, violation))| (claim, trial, Some(violation)));
        let asked = || tried.iter().find_map(|(claim, found)| Some((claim, found.worst()?.trial, None)));
        let written = written.or_else(|| settings.only.and_then(|_| asked()));
        let mut counterexample = None;
        let mut of_trial = None;
        if let Some((claim, trial, violation)) = written {
            let plant = counterexample_plant(claim, trial, violation)?;
            let broken = violation.is_some();
            counterexample = broken.then(|| json_text(&plant.root().to_json()));
            of_trial = Some(TrialPlant { text: plant.text().to_owned(), flags: flags(claim, trial), broken });
        }
        let outcome = match broken {
            Some(_) => FalsificationOutcome::Broken,
            None if tried.iter().all(|(_, found)| found.has_held()) => FalsificationOutcome::Held,
            None => FalsificationOutcome::Unfinished,
        };
        let report = Report::of(&FalsificationReport { tried: &tried });
        Ok(Falsification { outcome, counterexample, trial: of_trial, report })
    }
}
