//! Which gains go with which sampling periods.

use super::error::{Error, ErrorKind};
use super::report::Report;
use super::subject::Subject;
use super::{positive, rational};
use sigmastar_document::plot::Figure;
use sigmastar_lang::spec::Sampling;
use sigmastar_prove::reduction::{Subject as Read, with_sampled_pairs};
use sigmastar_studies::sampling::{OfPlant, OfSpecification, SamplingReport, SamplingStudy, Unfit, sampling_figure};

/// What the two lists are called in errors.
const NAMES: [&str; 2] = ["sampling_period", "sigma"];

/// Certified pairs of a gain and a sampling period.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct SamplingPairs {
    study: SamplingStudy,
    report: Report,
}

/// What takes long of a search for pairs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PairsPart {
    /// The triple of a Jacobian.
    Triple,
    /// The pairs of a specification.
    OfSpecification,
    /// The orbit and the pairs of a plant, each with its bounds.
    OfPlant,
}

impl SamplingPairs {
    /// Whether any pair is certified.
    #[must_use]
    pub fn has_pair(&self) -> bool {
        self.study.has_pair()
    }

    /// The longest sampling periods for gains, positive rational numbers.
    pub(super) fn of_gains(subject: Read, sigmas: &[&str]) -> Result<SamplingPairs, Error> {
        pairs_of(subject, [None, Some(sigmas)], NAMES, |_| {})
    }

    pub(super) fn study(&self) -> &SamplingStudy {
        &self.study
    }

    /// The certified pairs, drawn, for the program.
    #[doc(hidden)]
    #[must_use]
    pub fn figure(&self) -> Figure {
        sampling_figure(&self.study)
    }

    /// The report of `sigmastar sampling`, with every pair.
    #[must_use]
    pub fn report(&self) -> &Report {
        &self.report
    }
}

/// The smallest certified gain for sampling periods, exact constants of which the period is a whole multiple, and the longest
/// certified sampling period for gains, positive rational numbers; without either list, of some that fit the gain in continuous time.
///
/// Guarantee: every pair is certified by itself; between them nothing is said.
///
/// # Errors
/// Those of [`certify`](crate::certify) for the document; [`Options`](ErrorKind::Options) without a matched base frequency;
/// [`Range`](ErrorKind::Range) for a sampling period that does not fit, and numbers that are none.
pub fn sampling(
    subject: impl Into<Subject>,
    periods: Option<&[&str]>,
    sigmas: Option<&[&str]>,
) -> Result<SamplingPairs, Error> {
    pairs_of(subject.into().read, [periods, sigmas], NAMES, |_| {})
}

/// [`sampling`] of a document that was read, with the names of the two lists; what `waiting` returns of a part is dropped after it.
///
/// # Errors
/// Those of [`sampling`].
pub fn pairs_of<W>(
    subject: Read,
    [periods, sigmas]: [Option<&[&str]>; 2],
    names: [&str; 2],
    waiting: impl Fn(PairsPart) -> W,
) -> Result<SamplingPairs, Error> {
    let unfit = |kind, unfit: Unfit| Error::new(kind, unfit.to_string(), &unfit.help());
    if !subject.is_matched() {
        return Err(unfit(ErrorKind::Options, Unfit::NotMatched));
    }
    let (name, sha256, period) =
        (subject.name().to_owned(), subject.sha256().to_owned(), subject.period().nominal().clone());
    let step = |text: &&str| {
        let step = positive(names[0], text)?;
        let none = || {
            let unfit = Unfit::NoWholeMultiple { period: period.clone(), step: step.text.clone() };
            Error::new(ErrorKind::Range, format!("{}: {unfit}", names[0]), &unfit.help())
        };
        Sampling::new(&period, step.clone()).ok_or_else(none)
    };
    let steps = periods.map(|all| all.iter().map(step).collect()).transpose()?;
    let gains = sigmas.map(|all| all.iter().map(|text| rational(names[1], text)).collect()).transpose()?;
    let study = match subject {
        Read::Plant(plant) => {
            let _waiting = waiting(PairsPart::OfPlant);
            with_sampled_pairs(&plant, |pairs| SamplingStudy::new(&OfPlant { pairs }, &period, steps, gains))
                .map_err(|refusal| Error::documents(&refusal.errors(&plant)))?
        }
        Read::Specification(spec) => {
            let seeking = spec.lyapunov.triple().is_none().then(|| waiting(PairsPart::Triple));
            let (spec, _) = Read::Specification(spec).proved().map_err(|all| Error::documents(&all))?;
            drop(seeking);
            let _waiting = waiting(PairsPart::OfSpecification);
            SamplingStudy::new(&OfSpecification { spec: &spec }, &period, steps, gains)
        }
    };
    let report = Report::of(&SamplingReport { study: &study, name: &name, sha256: &sha256 });
    Ok(SamplingPairs { study, report })
}
