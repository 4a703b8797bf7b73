//! Bounds for given numbers of oscillators of any plant whose period is known, by trials (derivation, 14.4, 14.5).
//!
//! - `around`: a trial with everything that is evaluated around it;
//! - `boxes`: boxes around it and forms that fall there, proposed;
//! - `held`: the same of the law at samples (14.6);
//! - `proved`: what is proved there.

mod around;
mod boxes;
mod held;
mod proved;

use super::gain_row::{ByCount, CountBounds, CountProof, Largest, LoopSizes};
use around::{Around, Prepared};
use boxes::Fit;
use proved::{Promised, rounded, short};
use rug::Rational;
use sigmastar_decide::bounds::WithinSample;
use sigmastar_decide::linear::PRECISION;
use sigmastar_decide::trial::{Concluded, Peaks, Trial, TubeProof};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::parallel;
use sigmastar_lang::spec::{Level, Metric, Oscillators};
use sigmastar_theory::derivation::control::{Control, Reach};
use std::collections::BTreeSet;

pub(super) use around::{Asked, ClaimProof, ClaimWitness};

/// The numbers of oscillators that are looked at where they are not looked at one by one, and from where on all of them at once.
const COUNTS: [u32; 6] = [0, 1, 2, 3, 5, 10];
const OR_MORE: u32 = 20;

/// For so few oscillators a box and forms of their own are looked for where others serve, and proved if the peak is less than this share of the other.
const OWN: u32 = 2;
const WORTH: f64 = 0.97;

/// The shares of the distances of the start that a box has around a trial of which nothing is known further away, in turn.
const SMALL_BOXES: [f64; 3] = [1e-4, 1e-2, 0.1];

/// Forms; at samples with what each has there.
type Forms = (Vec<(Metric, Level)>, Vec<WithinSample>);

/// What is proved, what follows, and the peaks where they are known.
type Proved = (TubeProof, Concluded, Option<Peaks>);

/// The bounds that are found; `None` without any.
pub(super) fn by_trials(asked: &Asked<'_>) -> Option<ByCount> {
    let Asked { plant, spec, .. } = asked;
    let of_plant = spec.plant()?;
    let cell = of_plant.undivided().filter(|_| plant.period.interval().is_none())?;
    let around = |oscillators: Oscillators, or_more: bool| Around { asked, of_plant, cell, oscillators, or_more };
    // Samples tell so many oscillators apart.
    let most = asked.law().map_or(u32::MAX, |law| (law.samples - 1) / 2);
    let (mut counts, from): (BTreeSet<u32>, u32) = match around(OR_MORE.min(most).into(), true).met_by() {
        Some(from) if from <= most => ((0..from).collect(), from),
        _ => (COUNTS.into_iter().filter(|n_o| *n_o < most).collect(), OR_MORE.min(most)),
    };
    // What it is proved with serves the others in many cases.
    let last = around(from.into(), true).bounds(None);
    let known = last.as_ref().map(|(_, (_, proof))| proof);
    counts.extend(asked.besides.iter().filter_map(Oscillators::n_o).filter(|n_o| *n_o < from || last.is_none()));
    let first = counts.len();
    // Sets with gaps are not among the first harmonics; they come behind.
    let sets = asked.besides.iter().filter(|set| set.n_o().is_none()).cloned().collect::<BTreeSet<_>>();
    let all: Vec<Oscillators> = counts.into_iter().map(Oscillators::first).chain(sets).collect();
    let mut found = parallel::map(&all, |oscillators| around(oscillators.clone(), false).bounds(known));
    found.insert(first, last);
    let (counts, trials): (Vec<_>, Vec<_>) = found.into_iter().flatten().unzip();
    (!counts.is_empty()).then_some(ByCount { counts, proof: CountProof::Trials(trials), checked: false })
}

impl Around<'_> {
    /// The bounds; `other`: what is proved for another number of oscillators.
    fn bounds(&self, other: Option<&TubeProof>) -> Option<(CountBounds, (Trial, TubeProof))> {
        let prepared = self.prepared()?;
        let (proof, concluded, peaks) = match self.asked.law() {
            Some(law) => self.at_samples(&prepared, law, other)?,
            None => self.continuous(&prepared, other)?,
        };
        if peaks.is_none() && !self.is_of_the_claim(&concluded) {
            return None;
        }
        // The solution is that of the claim: its function falls along the differences, too.
        let mut reach = self.reach_by_the_claim(&prepared, &concluded);
        if let Some(Peaks { error, control, .. }) = peaks {
            reach = Reach { error: reach.error.min(&error), transient: reach.transient.min(&control) };
        }
        Some((self.count_bounds(&concluded, reach), (prepared.trial, proof)))
    }

    /// What is proved of the loop in continuous time; `other`: what is proved for another number of oscillators.
    fn continuous(&self, prepared: &Prepared, other: Option<&TubeProof>) -> Option<Proved> {
        let alone = |(radii, forms): ([Rational; 2], Vec<(Metric, Level)>)| {
            let promised = self.promised(prepared, radii, (forms, Vec::new()))?;
            let concluded = self.concluded(prepared, &promised)?;
            Some((self.decided(prepared, promised)?, concluded, None))
        };
        let small = || {
            SMALL_BOXES.into_iter().find_map(|share| {
                let (radii, form) = self.small_box(prepared, share)?;
                alone((short(radii)?, vec![rounded(&form)?]))
            })
        };
        let of_other = other.map(|TubeProof { radii, forms, x_first, .. }| ((radii.clone(), forms.clone()), x_first));
        let (mut proof, concluded, mut peaks) = match of_other {
            // Where they do not fall with all derivatives at one point for another number, they do not for this one.
            Some((known, Some(_))) => alone(known).or_else(small)?,
            Some(((radii, forms), None)) => {
                let own = |known: Option<f64>| self.with_own_peaks(prepared, Some(&radii), known);
                let known = || self.with_peaks(prepared, radii.clone(), (forms.clone(), Vec::new()));
                let expected = || forms.iter().filter_map(|form| self.expected(prepared, form)).min_by(f64::total_cmp);
                let first = if self.oscillators.first_missing() <= OWN {
                    expected().and_then(|expected| own(Some(expected)))
                } else {
                    None
                };
                let found = first.or_else(known).or_else(|| own(None));
                found.or_else(small)?
            }
            None => self.with_own_peaks(prepared, None, None).or_else(small)?,
        };
        if peaks.is_none() {
            let found = self.along_x_first(prepared, &concluded, other.and_then(|other| other.x_first.as_ref()));
            (proof.x_first, peaks) = found.unzip();
        }
        Some((proof, concluded, peaks))
    }

    /// The bounds, with how far solutions from the set come from the periodic one.
    fn count_bounds(&self, concluded: &Concluded, reach: Reach<Enclosure>) -> CountBounds {
        let nominal = self.asked.spec.input_gain.as_ref().map(|gain| gain.nominal.enclose(PRECISION));
        let Control { steady, transient } =
            Control { steady: concluded.control.clone(), transient: reach.transient }.over(nominal.as_ref());
        CountBounds {
            oscillators: self.oscillators.clone(),
            or_more: self.or_more,
            steady_error: concluded.error.clone(),
            mean_square: concluded.mean_square.clone(),
            steady_control: steady,
            sizes: LoopSizes {
                states: concluded.states.clone(),
                zeta: concluded.zeta.clone(),
                mean: Enclosure::zero(PRECISION),
            },
            largest: Some(Largest { error: &concluded.error + reach.error, transient }),
        }
    }

    /// What is proved with forms of its own; `near`: the box that serves another number of oscillators; `known`: a peak
    /// that this one is expected to be well below.
    fn with_own_peaks(&self, prepared: &Prepared, near: Option<&[Rational; 2]>, known: Option<f64>) -> Option<Proved> {
        self.margins().into_iter().find_map(|margin| {
            let Fit { radii, forms, peak } = self.peak_box(prepared, margin, (None, near))?;
            if known.is_some_and(|known| peak > WORTH * known) {
                return None;
            }
            let forms = forms.iter().map(rounded).collect::<Option<_>>()?;
            self.with_peaks(prepared, short(radii)?, (forms, Vec::new()))
        })
    }

    /// The peak that a form lets expect, as far as distances are known before it is proved.
    fn expected(&self, prepared: &Prepared, (metric, level): &(Metric, Level)) -> Option<f64> {
        let [x, e, z] = prepared.distances;
        let [w, k_p, p_up, e_low] = [&metric.weight, &metric.k_p, &level.p_up, &level.e_low].map(Rational::to_f64);
        let cross = metric.cross.iter().map(|entry| entry.to_f64() * entry.to_f64()).sum::<f64>().sqrt();
        let of_states = if self.asked.plant.states() > 0 { p_up * x * x + 2.0 * cross * x * e } else { 0.0 };
        let of_mu = prepared.own.gain[1].upper_f64() * prepared.own.mu.midpoint_f64();
        let at_start = of_states + w * e * e + k_p * of_mu / 2.0 * z * z;
        Some((at_start / e_low).sqrt()).filter(|peak| peak.is_finite())
    }

    /// What is proved with forms on a box that solutions from the set do not leave.
    fn with_peaks(&self, prepared: &Prepared, radii: [Rational; 2], forms: Forms) -> Option<Proved> {
        let promised = self.promised(prepared, radii, forms)?;
        let concluded = self.concluded(prepared, &promised)?;
        let peaks_of = |proof: &TubeProof| self.peaks(prepared, &concluded, (&proof.radii, &proof.forms));
        // To decide forms costs most: none is decided from which no peak would follow.
        peaks_of(promised.if_decided())?;
        let proof = self.decided(prepared, promised)?;
        let peaks = peaks_of(&proof)?;
        Some((proof, concluded, Some(peaks)))
    }

    /// The bounds of Theorem T, which hold once [`Around::decided`] has an answer: they rest on the first form, which stays where others do not hold.
    fn concluded(&self, prepared: &Prepared, promised: &Promised) -> Option<Concluded> {
        Concluded::of(&prepared.trial, promised.if_decided(), &self.known(prepared))
    }

    /// (ii) of 14.4.
    fn is_of_the_claim(&self, concluded: &Concluded) -> bool {
        let ClaimProof { periodic, .. } = &self.asked.proof;
        let error_box = self.asked.proof.error_box().map(|radius| Enclosure::from_rational(radius, PRECISION));
        let sizes = [&concluded.states, &concluded.error];
        let within =
            |((size, periodic), end): ((&Enclosure, &Enclosure), &Enclosure)| (size + periodic).le(end).is_true();
        sizes.into_iter().zip(periodic).zip(&error_box).all(within)
    }

    /// How far solutions from the set are from the periodic one by what proves the claim, with the sizes for this number of oscillators.
    fn reach_by_the_claim(&self, prepared: &Prepared, concluded: &Concluded) -> Reach<Enclosure> {
        let own = &prepared.own;
        let mut distances = prepared.start.distances(own, [&concluded.states, &concluded.error, &concluded.zeta]);
        if self.asked.plant.states() == 0 {
            distances[0] = Enclosure::zero(PRECISION);
        }
        self.asked.proof.reach(own, distances.each_ref())
    }
}
