//! What one proposal comes to: its certified figures, and the one that is to be small.

use super::parameter::TuneError;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::{Document, Sampling, SpecErrors, StartSizes};
use sigmastar_prove::certify::{Options, Verdict, verdict_of_errors};
use sigmastar_prove::reduction::{Prepared, Run, Subject};

/// What is to be as small as possible.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Goal {
    /// The certified gain.
    Sigma,
    /// sigma* + mu Nbar^2: what the law multiplies e by, at most, for every n_o.
    Feedback,
    /// The certified bound of sup|e| with so many oscillators, at the certified gain.
    Error(u64),
}

impl Goal {
    /// That a document has what is to be made small.
    ///
    /// # Errors
    /// What it has not: at samples only the gain is tuned, and bounds of the error by the number of oscillators are of a matched base
    /// frequency.
    pub fn fits(self, subject: &Subject) -> Result<(), TuneError> {
        match self {
            Goal::Sigma => Ok(()),
            _ if subject.sampling().is_some() => Err(TuneError::Sampled),
            Goal::Error(_) if !subject.is_matched() => Err(TuneError::NotMatched),
            _ => Ok(()),
        }
    }

    /// The name in JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Goal::Sigma => "sigma_star",
            Goal::Feedback => "feedback",
            Goal::Error(_) => "error",
        }
    }
}

/// The certified figures of a document.
#[derive(Clone, Debug)]
pub struct Figures {
    /// The certified gain.
    pub sigma: Rational,
    /// The sampling period that the gain is for, of the regulator at samples: then it is no threshold.
    pub sampling_period: Option<String>,
    /// An upper bound of sigma + mu Nbar^2; not of the regulator at samples.
    pub feedback: Option<Enclosure>,
    /// The initial set of the claim.
    pub initial_set: StartSizes,
    /// Upper bounds of |x|, |e|, |zeta|_N and |z|_N along the periodic solution.
    pub periodic: [Enclosure; 4],
    /// Upper bounds of rms(e) and sup|e| with the oscillators that were asked about; only where the base frequency is matched,
    /// and not of the regulator at samples.
    pub error: Option<[Enclosure; 2]>,
    /// Whether it is proved that no plant with a state has these data.
    pub no_plant: bool,
    /// What the state is called whose norms these are; `None` for a plant without states.
    pub state: Option<&'static str>,
}

impl Figures {
    /// Certifies a document.
    ///
    /// # Errors
    /// The verdict, where nothing is certified.
    pub(super) fn of(document: &Document, n_o: u64) -> Result<Figures, Verdict> {
        let refused = |errors: Vec<SpecErrors>| verdict_of_errors(&errors);
        let subject = Subject::read(document).map_err(|errors| refused(vec![errors]))?;
        let prepared = Prepared::new(subject, None).map_err(refused)?;
        let run = prepared.certify(Options { compare: false, ..Options::default() }).map_err(refused)?;
        figures(&run, n_o).ok_or_else(|| run.verdict().without_claim())
    }

    /// An upper bound of what is to be small.
    pub(super) fn value(&self, goal: Goal) -> Option<Rational> {
        match goal {
            Goal::Sigma => Some(self.sigma.clone()),
            Goal::Feedback => self.feedback.as_ref()?.upper_rational(),
            Goal::Error(_) => self.error.as_ref().and_then(|[_, sup]| sup.upper_rational()),
        }
    }
}

fn figures(run: &Run<'_>, n_o: u64) -> Option<Figures> {
    let (feedback, error) = match run {
        Run::Continuous(run) => (run.feedback(), run.error_with(n_o).map(|bounds| [bounds.rms, bounds.sup])),
        Run::Sampled(_) => (None, None),
    };
    let certified = run.certified()?;
    let set = certified.set;
    Some(Figures {
        sigma: certified.sigma.clone(),
        sampling_period: certified.sampling.map(Sampling::text),
        feedback,
        initial_set: set.clone(),
        periodic: certified.periodic,
        error,
        no_plant: certified.no_plant,
        state: run.spec().state_name(),
    })
}
