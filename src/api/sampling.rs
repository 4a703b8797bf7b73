//! Which gains go with which sampling periods.

use super::error::{Error, ErrorKind};
use super::report::Report;
use super::subject::Subject;
use super::{positive, rational};
use sigmastar_lang::spec::Sampling;
use sigmastar_prove::reduction::{Subject as Read, with_sampled_pairs};
use sigmastar_studies::sampling::{OfPlant, OfSpecification, SamplingReport, SamplingStudy, Unfit};

/// Certified pairs of a gain and a sampling period.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct SamplingPairs {
    has_pair: bool,
    report: Report,
}

impl SamplingPairs {
    /// Whether any pair is certified.
    #[must_use]
    pub fn has_pair(&self) -> bool {
        self.has_pair
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
    let subject = subject.into().read;
    let unfit = |kind, unfit: Unfit| Error::new(kind, unfit.to_string(), &unfit.help());
    if !subject.is_matched() {
        return Err(unfit(ErrorKind::Options, Unfit::NotMatched));
    }
    let (name, sha256, period) =
        (subject.name().to_owned(), subject.sha256().to_owned(), subject.period().nominal().clone());
    let step = |text: &&str| {
        let step = positive("sampling_period", text)?;
        let none =
            || unfit(ErrorKind::Range, Unfit::NoWholeMultiple { period: period.clone(), step: step.text.clone() });
        Sampling::new(&period, step.clone()).ok_or_else(none)
    };
    let steps = periods.map(|all| all.iter().map(step).collect()).transpose()?;
    let gains = sigmas.map(|all| all.iter().map(|text| rational("sigma", text)).collect()).transpose()?;
    let study = match subject {
        Read::Plant(plant) => {
            with_sampled_pairs(&plant, |pairs| SamplingStudy::new(&OfPlant { pairs }, &period, steps, gains))
                .map_err(|refusal| Error::documents(&refusal.errors(&plant)))?
        }
        specification @ Read::Specification(_) => {
            let (spec, _) = specification.proved().map_err(|all| Error::documents(&all))?;
            SamplingStudy::new(&OfSpecification { spec: &spec }, &period, steps, gains)
        }
    };
    let report = Report::of(&SamplingReport { study: &study, name: &name, sha256: &sha256 });
    Ok(SamplingPairs { has_pair: study.has_pair(), report })
}
