//! The smallest gain for which a claim has what is asked of it (derivation, 13.5, 13.6).

use super::{Ask, Checked, Prepared, RestsOn, Run, Start, Subject, Watch};
use crate::certify::{Limits, Options};
use rug::Rational;
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_lang::spec::{Oscillators, SpecErrors};

/// The gains that are tried in turn, over the smallest one; and, where that is far smaller, over the rate that is asked for: e itself is to
/// decay as fast.
const SHARES: [f64; 7] = [1.2, 1.5, 2.0, 3.0, 4.0, 6.0, 10.0];
const OF_RATE: [f64; 7] = [0.5, 1.0, 2.0, 4.0, 8.0, 20.0, 50.0];

/// After so many of the latter in turn without a larger rate the others are left out: it falls.
const FALLS: usize = 2;

/// Steps of the bisection between a gain that does not do and one that does.
const STEPS: usize = 6;

/// Digits of a gain.
const DIGITS: u32 = 5;

/// What is asked of a claim.
pub(super) struct Search<'q> {
    pub(super) subject: &'q Subject,
    pub(super) limits: &'q Limits,
    pub(super) counts: &'q [u32],
    /// Without comparisons.
    pub(super) options: Options,
    /// Whether data for larger gains are wanted beside those of the smallest one.
    pub(super) rows: bool,
    pub(super) watch: &'q dyn Watch,
}

/// A gain that is certified, and the slowest of its rates; none where one of them is not proved.
struct Tried {
    prepared: Prepared,
    sigma: Rational,
    rate: Option<Rational>,
}

impl Prepared {
    /// The data of a subject for the smallest gain that is found with which the limits are kept, the least rate among them, of these numbers
    /// of oscillators; where no gain has it, for the one with the largest rate that is found. A run with it whose rates are proved
    /// decides anew ([`Run::prove_rates`]). A claim of a plant rests on norms where it can and what is asked needs them: rates at samples, what
    /// noise does, and limits at samples that are kept with them alone. At the gain that is given nothing is sought. Without a least rate the other
    /// limits are about these numbers of oscillators, where there are some and the plant has bounds by their number.
    ///
    /// # Errors
    /// Those of [`Prepared::new`].
    pub fn seeking(
        subject: &Subject,
        gain: Option<Rational>,
        (limits, counts): (&Limits, &[u32]),
        options: Options,
        watch: &dyn Watch,
    ) -> Result<Prepared, Vec<SpecErrors>> {
        let prepared = Prepared::seeking_by_conditions(subject, gain.clone(), (limits, counts), options, watch)?;
        Ok(prepared.keeping_actuator(subject, gain, (limits, counts), options, watch))
    }

    /// What is prepared; where that does not keep to an actuator by the conditions, what does so by the number of oscillators, or comes closer to it.
    pub(super) fn keeping_actuator(
        self,
        subject: &Subject,
        gain: Option<Rational>,
        asked: (&Limits, &[u32]),
        options: Options,
        watch: &dyn Watch,
    ) -> Prepared {
        if subject.actuator().is_none() {
            return self;
        }
        let own = self.judged(options, watch);
        if own.as_ref().is_some_and(|run| run.certified().is_some()) {
            return self;
        }
        let Some(other) = Prepared::seeking_by_count(subject, gain, asked, options, watch) else { return self };
        let is_closer = match (other.judged(options, watch), &own) {
            (Some(run), _) if run.certified().is_some() => true,
            (Some(run), Some(known)) => run.missed_share() < known.missed_share(),
            (run, _) => run.is_some(),
        };
        drop(own);
        if is_closer { other } else { self }
    }

    /// The same for a claim that is to keep to its actuator by the bounds for every number of oscillators. `None` where there can be none. Limits that are about
    /// some numbers alone are sought first, and the actuator is judged at the gain that keeps to these.
    pub(super) fn seeking_by_count(
        subject: &Subject,
        gain: Option<Rational>,
        (limits, counts): (&Limits, &[u32]),
        options: Options,
        watch: &dyn Watch,
    ) -> Option<Prepared> {
        let (subject, max) = subject.kept_by_count().filter(|_| limits.rate.is_none())?;
        let of_some = limits.bounds_anything() && !counts.is_empty();
        let control = limits.control.clone().map_or(max.clone(), |limit| limit.min(max));
        let with_actuator = Limits { control: Some(control), ..limits.clone() };
        let (sought, about) = if of_some { (limits, counts) } else { (&with_actuator, &[][..]) };
        let prepared = Prepared::seeking_by_conditions(&subject, gain, (sought, about), options, watch).ok()?;
        // What is asked for is told; the actuator is judged beside it.
        let limits = Limits { by_count: Some(about.to_vec()), ..limits.clone() };
        Some(Prepared { counts: counts.to_vec(), limits, ..prepared })
    }

    /// The run without comparisons, judged by the limits, those by the number of oscillators and the actuator included.
    pub(in crate::reduction) fn judged(&self, options: Options, watch: &dyn Watch) -> Option<Run<'_>> {
        let options = Options { compare: false, ..options };
        let mut run = self.certify_checked(options, &|_| Checked::Decided, watch).ok()?;
        run.prove_rates(&[]).ok()?;
        Some(run)
    }

    fn seeking_by_conditions(
        subject: &Subject,
        gain: Option<Rational>,
        (limits, counts): (&Limits, &[u32]),
        options: Options,
        watch: &dyn Watch,
    ) -> Result<Prepared, Vec<SpecErrors>> {
        let rows = options.compare || !limits.is_empty() || subject.actuator().is_some();
        let search = Search { subject, limits, counts, options: Options { compare: false, ..options }, rows, watch };
        let prepared = match (&limits.rate, gain) {
            (_, Some(gain)) => {
                let prepared = search.at(Some(gain))?;
                let norms_from = search.norms_from(&prepared);
                search.given_with_these_counts(Prepared { norms_from, ..prepared.within(limits.clone(), watch) })
            }
            (None, None) => search.smallest_with_these_counts()?,
            (Some(least), None) => search.with_rate(least)?,
        };
        Ok(Prepared { counts: counts.to_vec(), ..prepared })
    }
}

impl Prepared {
    /// Whether a gain that is given is not below the smallest one of the data in continuous time; at samples they are those of the gain.
    pub(super) fn reaches(&self, gain: Option<&Rational>) -> bool {
        match (&self.start, gain) {
            (Start::Continuous(Some(sought)), Some(gain)) => sought.proposal.sigma <= gain.to_f64(),
            _ => true,
        }
    }
}

impl Search<'_> {
    fn by_norms(&self, gain: Option<Rational>) -> Result<Prepared, Vec<SpecErrors>> {
        Prepared::resting(self.subject.clone(), Ask { gain, on: RestsOn::Norms, rows: false }, self.watch)
    }

    /// Whether what is asked can be had of a claim by norms alone: rates at samples, and what noise does.
    fn asks_for_norms(&self) -> bool {
        let Subject::Plant(plant) = self.subject else { return false };
        !self.counts.is_empty() && (self.subject.sampling().is_some() || plant.disturbances.any())
    }

    /// About the gain at which norms prove a claim at samples, where rates are asked for and this one rests on a matrix inequality.
    fn norms_from(&self, prepared: &Prepared) -> Option<f64> {
        let by_matrix = prepared.spec.bounds.proved_values().at_samples.stability.is_some();
        let other = (by_matrix && self.asks_for_norms()).then(|| self.by_norms(None).ok()).flatten()?;
        match &other.start {
            Start::Sampled(_, Some(sought)) => Some(sought.proposal.sigma),
            _ => None,
        }
    }

    pub(super) fn at(&self, gain: Option<Rational>) -> Result<Prepared, Vec<SpecErrors>> {
        let by_norms = || self.by_norms(gain.clone()).ok().filter(|prepared| prepared.reaches(gain.as_ref()));
        match self.asks_for_norms().then(by_norms).flatten() {
            Some(prepared) => Ok(prepared),
            None => {
                let ask = Ask { gain, on: RestsOn::Either, rows: self.rows };
                Prepared::resting(self.subject.clone(), ask, self.watch)
            }
        }
    }

    /// What is proved for the smallest gain, or by norms, prepared to keep to the limits by the conditions of a claim.
    pub(super) fn within_limits(&self, smallest: Prepared) -> Prepared {
        let prepared = smallest.within(self.limits.clone(), self.watch);
        let certifies = |prepared: &Prepared| {
            prepared
                .certify_checked(self.options, &|_| Checked::Decided, self.watch)
                .is_ok_and(|run| run.certified().is_some())
        };
        let plant_at_samples = matches!(self.subject, Subject::Plant(_)) && self.subject.sampling().is_some();
        let has_other = plant_at_samples && !self.asks_for_norms() && !self.limits.is_empty();
        if !has_other || certifies(&prepared) {
            return prepared;
        }
        let other = self.by_norms(None).map(|other| other.within(self.limits.clone(), self.watch));
        other.ok().filter(certifies).unwrap_or(prepared)
    }

    fn with_rate(&self, least: &Rational) -> Result<Prepared, Vec<SpecErrors>> {
        // With it a claim that is too slow would be taken back, and its rates with it.
        let others = || Limits { rate: None, ..self.limits.clone() };
        let asking = |prepared: Prepared| Ok(Prepared { limits: self.limits.clone(), ..prepared });
        let does = |tried: &Tried| tried.rate.as_ref().is_some_and(|rate| rate >= least);
        let (prepared, claim) = self.tried(self.at(None)?.within(others(), self.watch));
        let Some((sigma, rate)) = claim else { return asking(prepared) };
        let mut best = Tried { prepared, sigma, rate };
        if does(&best) {
            return asking(best.prepared);
        }
        let (smallest, mut below) = (best.sigma.to_f64(), best.sigma.clone());
        let tried = |sigma: Rational| {
            let (prepared, claim) = self.tried(self.at(Some(sigma)).ok()?.within(others(), self.watch));
            let (sigma, rate) = claim?;
            Some(Tried { prepared: Prepared { found_above: Some(smallest), ..prepared }, sigma, rate })
        };
        let shares = SHARES.map(|share| smallest * share);
        let of_rate = OF_RATE.map(|share| least.to_f64() * share);
        let of_rate = of_rate.into_iter().filter(|sigma| shares.iter().all(|share| share < sigma));
        let all = shares.into_iter().map(|sigma| (sigma, 0)).chain(of_rate.map(|sigma| (sigma, 1)));
        let mut falls = 0;
        for (sigma, fall) in all.filter_map(|(sigma, fall)| Some((round_f64(sigma, DIGITS, Direction::Up)?, fall))) {
            match tried(sigma.clone()).filter(|next| next.rate > best.rate) {
                Some(next) => (best, falls) = (next, 0),
                None => falls += fall,
            }
            if does(&best) || falls >= FALLS {
                break;
            }
            below = sigma;
        }
        for _ in 0..if does(&best) { STEPS } else { 0 } {
            let middle = round_f64((below.to_f64() * best.sigma.to_f64()).sqrt(), DIGITS, Direction::Up);
            let Some(middle) = middle.filter(|middle| below < *middle && *middle < best.sigma) else { break };
            match tried(middle.clone()).filter(does) {
                Some(smaller) => best = smaller,
                None => below = middle,
            }
        }
        asking(best.prepared)
    }

    /// The gain that is certified with it, and the slowest rate.
    fn tried(&self, prepared: Prepared) -> (Prepared, Option<(Rational, Option<Rational>)>) {
        let mut run = prepared.certify_checked(self.options, &|_| Checked::Decided, self.watch).ok();
        let sigma = run.as_ref().and_then(|run| Some(run.certified()?.sigma.clone()));
        let rate = run.as_mut().and_then(|run| run.slowest_rate(self.counts));
        drop(run);
        (prepared, sigma.map(|sigma| (sigma, rate)))
    }
}

impl Run<'_> {
    /// The smallest of the rates of these numbers of oscillators; `None` where one of them is not proved.
    fn slowest_rate(&mut self, counts: &[u32]) -> Option<Rational> {
        let asked: Vec<Oscillators> = counts.iter().copied().map(Oscillators::first).collect();
        self.prove_rates(&asked).ok()?;
        self.rates().into_iter().map(|(_, rate)| rate).min()?.cloned()
    }
}
