//! Better values of the free numbers of a document.

use super::error::{Error, ErrorKind};
use super::report::Report;
use super::subject::Subject;
use super::{in_range, json_text};
use sigmastar_document::progress::{Progress, Silent};
use sigmastar_lang::spec::Document;
use sigmastar_prove::reduction::Subject as Read;
use sigmastar_regulator::MAX_EXPORTED_OSCILLATORS;
use sigmastar_studies::tune::{self, Goal, MAX_TRIES, Settings, TuneError, TuningReport, parameters};

/// The number of oscillators for which the error is told where it is not what is minimised.
const N_O: u32 = 5;

/// What a tuning makes as small as possible.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum TuneGoal {
    /// The certified gain.
    SigmaStar,
    /// `sigma* + mu Nbar^2`, what the law multiplies e by at most.
    Feedback,
    /// The certified bound of `sup|e|` with this many oscillators, at `sigma*`.
    ErrorAt(u32),
}

/// What is tuned, and how long. The defaults are those of `sigmastar tune`.
///
/// ```
/// use sigmastar::{TuneGoal, TuneOptions};
/// let options = TuneOptions::new().over("mu=1/10..10,n0").goal(TuneGoal::Feedback).tries(60);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct TuneOptions {
    over: String,
    goal: TuneGoal,
    tries: u32,
}

impl Default for TuneOptions {
    fn default() -> TuneOptions {
        TuneOptions::new()
    }
}

impl TuneOptions {
    /// The most proposals of one call.
    pub const MOST_TRIES: u32 = MAX_TRIES;

    /// `mu` and `n0`, for the smallest gain, by at most 120 proposals.
    #[must_use]
    pub fn new() -> TuneOptions {
        TuneOptions { over: "mu,n0".to_owned(), goal: TuneGoal::SigmaStar, tries: 120 }
    }

    /// The numbers, separated by commas, each with a range where it is to have one: `mu=1/10..10,n0`.
    #[must_use]
    pub fn over(mut self, over: impl Into<String>) -> TuneOptions {
        self.over = over.into();
        self
    }

    /// What is to be small.
    #[must_use]
    pub fn goal(mut self, goal: TuneGoal) -> TuneOptions {
        self.goal = goal;
        self
    }

    /// How many proposals are certified at most, the values of the document among them.
    #[must_use]
    pub fn tries(mut self, tries: u32) -> TuneOptions {
        self.tries = tries;
        self
    }
}

/// What a tuning came to.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Tuned {
    has_claim: bool,
    document: Option<Document>,
    json: Option<String>,
    report: Report,
}

impl Tuned {
    /// Whether anything is certified, before or after.
    #[must_use]
    pub fn has_claim(&self) -> bool {
        self.has_claim
    }

    /// The document with the better values and nothing else changed, as JSON; `None` where nothing better was found.
    #[must_use]
    pub fn document(&self) -> Option<&str> {
        self.json.as_deref()
    }

    /// The same in the notation that it was read in, for the program.
    #[doc(hidden)]
    #[must_use]
    pub fn text(&self) -> Option<&str> {
        self.document.as_ref().map(Document::text)
    }

    /// The report of `sigmastar tune`.
    #[must_use]
    pub fn report(&self) -> &Report {
        &self.report
    }
}

/// Looks for better values of the free numbers of a specification or plant.
///
/// Guarantee: the figures before and after are certified, each for its document; nothing is claimed of other values.
///
/// # Errors
/// [`Options`](ErrorKind::Options) for what cannot be tuned, and a goal that does not fit the document; [`Range`](ErrorKind::Range) for a
/// number that is out of range; a document that is too large with other values.
pub fn tune(subject: impl Into<Subject>, options: &TuneOptions) -> Result<Tuned, Error> {
    let Subject { read, source } = subject.into();
    tune_watched((&read, &source), options, &Silent)
}

/// [`tune()`] of a document that was read.
///
/// # Errors
/// Those of [`tune()`].
pub fn tune_watched(
    (read, source): (&Read, &Document),
    options: &TuneOptions,
    progress: &impl Progress,
) -> Result<Tuned, Error> {
    in_range("tries", options.tries, 2..=TuneOptions::MOST_TRIES)?;
    let goal = match options.goal {
        TuneGoal::SigmaStar => Goal::Sigma,
        TuneGoal::Feedback => Goal::Feedback,
        TuneGoal::ErrorAt(n_o) => {
            in_range("error_at", n_o, 0..=MAX_EXPORTED_OSCILLATORS)?;
            Goal::Error(u64::from(n_o))
        }
    };
    let n_o = match goal {
        Goal::Error(n_o) => n_o,
        _ => u64::from(N_O),
    };
    let wrong = |error: TuneError| Error::new(ErrorKind::Options, error.to_string(), &error.way_out());
    goal.fits(read).map_err(wrong)?;
    let free = parameters(&options.over, source, read.internal_model()).map_err(wrong)?;
    let settings = Settings { goal, n_o, tries: options.tries };
    let tuning = tune::tune(source, free, settings, progress)?;
    let report = Report::of(&TuningReport { tuning: &tuning, name: read.name(), sha256: read.sha256() });
    let has_claim = tuning.has_claim();
    let document = tuning.after.map(|(_, tuned)| tuned);
    let json = document.as_ref().map(|tuned| json_text(&tuned.root().to_json()));
    Ok(Tuned { has_claim, document, json, report })
}
