//! Limits that are judged by all that is proved at the gain of a claim, bounds by the number of oscillators included (derivation, 13.5, 14).

use super::certification::Certification;
use super::gain_row::{ByCount, CountBounds, written};
use super::options::Limits;
use super::sampled::SampledCertification;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::Oscillators;
use sigmastar_propose::search::{Failing, Limited};
use sigmastar_theory::derivation::control::Control;
use sigmastar_theory::derivation::sampled::SampledEvaluation;

/// A limit beside what is proved.
struct Against {
    which: Limited,
    asked: f64,
    least: f64,
    kept: bool,
}

impl Against {
    fn share(&self) -> f64 {
        self.least / self.asked
    }
}

/// What is proved of the steady error, the peak and the control for the numbers of oscillators that limits are about, by the conditions of a claim; and what
/// is proved by the number of oscillators.
type Judged<'c> = ([Enclosure; 3], Option<&'c ByCount>);

/// What is proved beside the limits that are judged by the number of oscillators.
fn against(limits: &Limits, (known, by_count): Judged<'_>) -> Vec<Against> {
    let Some(counts) = &limits.by_count else { return Vec::new() };
    let one = |((which, limit), bound): ((Limited, Option<&Rational>), Enclosure)| {
        let kept = |limit: &Rational| bound.upper_rational().is_some_and(|upper| upper <= *limit);
        limit.map(|limit| Against { which, asked: limit.to_f64(), least: bound.upper_f64(), kept: kept(limit) })
    };
    limits.named().into_iter().zip(least(known, by_count, counts)).filter_map(one).collect()
}

/// How far what is proved at a gain is from limits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shares {
    /// The largest share that the steady error and the peak have of their limits, which falls with the gain; 0 where they have none.
    pub(crate) error: f64,
    /// The largest share of all.
    pub(crate) largest: f64,
    /// Whether the limits of the error are kept.
    pub(crate) keeps_error: bool,
    /// Whether all are.
    pub(crate) keeps_all: bool,
}

fn shares(all: &[Against]) -> Option<Shares> {
    let largest = |of: &dyn Fn(&&Against) -> bool| all.iter().filter(of).map(Against::share).reduce(f64::max);
    let keeps = |of: &dyn Fn(&&Against) -> bool| all.iter().filter(of).all(|against| against.kept);
    let is_of_error = |against: &&Against| against.which != Limited::Control;
    Some(Shares {
        error: largest(&is_of_error).unwrap_or(0.0),
        largest: largest(&|_| true)?,
        keeps_error: keeps(&is_of_error),
        keeps_all: keeps(&|_| true),
    })
}

/// The limit that is missed by most at a gain.
fn missed(all: &[Against], sigma: &Rational) -> Option<Failing> {
    let by_share = |a: &&Against, b: &&Against| a.share().total_cmp(&b.share());
    let Against { which, asked, least, .. } = all.iter().filter(|against| !against.kept).max_by(by_share)?;
    let second = all.iter().filter(|against| against.which != *which).max_by(by_share);
    let beside = second.map(|other| (other.which, other.asked));
    Some(Failing::Limit { which: *which, asked: *asked, beside, least: *least, sigma: sigma.to_f64(), proved: true })
}

/// Why the limits are not kept by what is proved at a gain; nothing where they are, and where they are not judged by the number of oscillators. What the
/// independent checker did not decide keeps none: where it would, that is the reason.
fn why_missed(limits: &Limits, sigma: &Rational, (known, by_count): Judged<'_>) -> Option<Failing> {
    let missed = missed(&against(limits, (known.clone(), by_count)), sigma)?;
    let undecided = by_count.filter(|found| !found.checked).map(|found| ByCount { checked: true, ..found.clone() });
    let would_be_kept =
        undecided.is_some_and(|found| against(limits, (known, Some(&found))).iter().all(|one| one.kept));
    Some(if would_be_kept { Failing::NotDecidedAgain { refused: false, sigma: sigma.to_f64() } } else { missed })
}

impl Shares {
    /// What is to fall next: that of the error; once it is kept, that of the control.
    pub(crate) fn next(&self) -> f64 {
        if self.keeps_error { self.largest } else { self.error }
    }
}

impl ByCount {
    /// Whether it has bounds of each of these numbers of oscillators, or of every one where there are none.
    #[must_use]
    pub(crate) fn covers(&self, counts: &[u32]) -> bool {
        self.over(counts, &|bounds| Some(bounds.steady_error.clone())).is_some()
    }
}

/// The smaller of what the conditions of a claim prove and what its certificate has by the number of oscillators, where the independent checker decides
/// that, too.
fn least([steady, peak, control]: [Enclosure; 3], by_count: Option<&ByCount>, counts: &[u32]) -> [Enclosure; 3] {
    let by_count = by_count.filter(|found| found.checked);
    let smaller = |known: Enclosure, of: &dyn Fn(&CountBounds) -> Option<Enclosure>| {
        let found = by_count.and_then(|found| Some(found.stated(&found.over(counts, of)?)));
        found.map_or_else(|| known.clone(), |found| known.min(&found))
    };
    [
        smaller(steady, &|bounds| Some(bounds.steady_error.clone())),
        smaller(peak, &|bounds| Some(bounds.largest.as_ref()?.error.clone())),
        smaller(control, &CountBounds::largest_control),
    ]
}

/// A bound, and whether it is in the certificate, so that the independent checker decides it.
#[derive(Clone, Debug)]
pub struct Stated {
    /// Its upper end is what counts.
    pub bound: Enclosure,
    /// Whether it is in the certificate.
    pub is_in_certificate: bool,
}

/// What is proved with given oscillators at the gain of a claim.
#[derive(Clone, Debug)]
pub struct BoundsOfCount {
    /// Of |e| along the periodic solution.
    pub steady_error: Stated,
    /// Of |e| at all times from the initial set.
    pub peak_error: Stated,
    /// Of what is put out at all times from the initial set; it is in the certificate.
    pub control: Enclosure,
    /// Of what is put out along the periodic solution; it is in the certificate.
    pub steady_control: Enclosure,
    /// Of how far it is from that, by the function of the claim.
    pub(super) transient: Enclosure,
}

impl BoundsOfCount {
    /// From bounds that the certificate has for every number of oscillators: of |e| along the periodic solution, and of the control along it and in the
    /// transient; from that of the peak by the conditions, which it has not; from those by the number of oscillators; and from one of the steady error that
    /// only this program evaluates, which counts where nothing else is known by the number of oscillators.
    fn of(
        [steady, peak]: [&Enclosure; 2],
        control: &Control<Enclosure>,
        (by_count, oscillators): (Option<&ByCount>, &Oscillators),
        by_formulas: Option<Enclosure>,
    ) -> BoundsOfCount {
        let steady_control = written(&control.steady);
        let transient = written(&control.transient);
        let control = &steady_control + &transient;
        let in_certificate = |bound: Enclosure| Stated { bound, is_in_certificate: true };
        let outside = |bound: Enclosure| Stated { bound, is_in_certificate: false };
        let steady = written(steady);
        let found = by_count.filter(|found| found.checked);
        match found.and_then(|found| Some((found, found.with(oscillators)?))) {
            None => BoundsOfCount {
                steady_error: match by_formulas {
                    Some(other) if other.lt(&steady).is_true() => outside(other),
                    _ => in_certificate(steady),
                },
                peak_error: outside(peak.clone()),
                control,
                steady_control,
                transient,
            },
            Some((found, own)) => BoundsOfCount {
                steady_error: in_certificate(steady.min(&found.stated(&own.steady_error))),
                peak_error: match &own.largest {
                    Some(largest) => in_certificate(found.stated(&largest.error)),
                    None => outside(peak.clone()),
                },
                control: own.largest_control().map_or(control.clone(), |own| control.min(&found.stated(&own))),
                steady_control: steady_control.min(&found.stated(&own.steady_control)),
                transient,
            },
        }
    }
}

impl Certification<'_> {
    /// What is proved with these oscillators, which the claim is about, and which of it is in the certificate; `None` without a certified claim.
    #[must_use]
    pub fn bounds_of(&self, oscillators: &Oscillators) -> Option<BoundsOfCount> {
        let (steady, peak, control) = self.bounds()?;
        let by_formulas = oscillators.n_o().and_then(|n_o| Some(self.error_with(u64::from(n_o))?.sup));
        Some(BoundsOfCount::of([steady, peak], control, (self.by_count.as_ref(), oscillators), by_formulas))
    }

    /// What the conditions of the claim, and the table of the regulated error, prove with these numbers of oscillators.
    fn known(&self, counts: &[u32]) -> Option<[Enclosure; 3]> {
        let (steady, peak, control) = self.bounds()?;
        let with = |n_o: &u32| Some(self.error_with(u64::from(*n_o))?.sup);
        let found: Option<Enclosure> = counts.iter().map(with).reduce(|a, b| Some(a?.max(&b?))).flatten();
        let steady = found.map_or_else(|| steady.clone(), |found| steady.min(&found));
        Some([steady, peak.clone(), &control.steady + &control.transient])
    }

    fn judged(&self, limits: &Limits) -> Option<Judged<'_>> {
        Some((self.known(limits.by_count.as_deref()?)?, self.by_count.as_ref()))
    }

    /// Bounds of |e| along the periodic solution and in the transient, and of the control, with each of these numbers of oscillators, or with every one
    /// where there are none, at the gain of the claim: the least that are proved, those by the number of oscillators where the independent checker decides
    /// them. `None` without a certified claim.
    #[must_use]
    pub fn bounds_with(&self, counts: &[u32]) -> Option<[Enclosure; 3]> {
        Some(least(self.known(counts)?, self.by_count.as_ref(), counts))
    }

    /// How far what is proved is from the limits that are judged by the number of oscillators; `None` without a certified claim or such limits.
    pub(crate) fn shares_of_limits(&self, limits: &Limits) -> Option<Shares> {
        shares(&against(limits, self.judged(limits)?))
    }

    /// Takes the claim back where a limit was to be kept by what is proved by the number of oscillators, and is not.
    pub(crate) fn keep_to_counts(&mut self) {
        let judged = self.sigma_star().zip(self.judged(&self.limits));
        if let Some(reason) = judged.and_then(|(sigma, judged)| why_missed(&self.limits, sigma, judged)) {
            self.take_back(reason);
        }
    }
}

impl SampledCertification<'_> {
    /// What is proved with these oscillators, which the claim is about, and which of it is in the certificate; `None` without a certified claim.
    #[must_use]
    pub fn bounds_of(&self, oscillators: &Oscillators) -> Option<BoundsOfCount> {
        let SampledEvaluation { size, peak, control, .. } = &self.claim()?.evaluation;
        Some(BoundsOfCount::of([&size.e_per, peak], control, (self.by_count.as_ref(), oscillators), None))
    }

    /// What the conditions of the claim prove for every number of oscillators.
    fn known(&self) -> Option<[Enclosure; 3]> {
        let SampledEvaluation { size, peak, control, .. } = &self.claim()?.evaluation;
        Some([size.e_per.clone(), peak.clone(), &control.steady + &control.transient])
    }

    /// Bounds of |e| along the periodic solution and in the transient, between samples too, and of the control, with each of these numbers of oscillators, or
    /// with every one where there are none, at the gain and the samples of the claim: the least that are proved, those by the number of oscillators where the
    /// independent checker decides them. `None` without a certified claim.
    #[must_use]
    pub fn bounds_with(&self, counts: &[u32]) -> Option<[Enclosure; 3]> {
        Some(least(self.known()?, self.by_count.as_ref(), counts))
    }

    /// How far what is proved is from the limits that are judged by the number of oscillators; `None` without a certified claim or such limits.
    pub(crate) fn shares_of_limits(&self, limits: &Limits) -> Option<Shares> {
        shares(&against(limits, (self.known()?, self.by_count.as_ref())))
    }

    /// Takes the claim back where a limit was to be kept by what is proved by the number of oscillators, and is not.
    pub(crate) fn keep_to_counts(&mut self) {
        let sigma = self.claim().map(|proof| &proof.witness.sigma).zip(self.known());
        let reason = sigma.and_then(|(sigma, known)| why_missed(&self.limits, sigma, (known, self.by_count.as_ref())));
        if let Some(reason) = reason {
            self.take_back(reason);
        }
    }
}
