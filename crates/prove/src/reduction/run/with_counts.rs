//! A smaller gain by what is proved by the number of oscillators: limits of the steady error, the peak and the control are kept by the least that is
//! proved at a gain, with given numbers of oscillators or with every one (derivation, 13.5, 14).

use super::seeking::Search;
use super::{Checked, Prepared, Run, Subject};
use crate::certify::Limits;
use crate::certify::kept::Shares;
use rug::Rational;
use sigmastar_exact::number::{Direction, Portable, round_f64};
use sigmastar_lang::spec::{Constant, SpecErrors};
use std::sync::{Arc, OnceLock};

/// Gains that are tried at most.
const TRIES: usize = 8;

/// Of gains in turn at which the limits are missed by more than before so many are tried: the control grows with the gain. Where they are missed by more than
/// this factor they are to be missed by so much less.
const RISES: usize = 2;
const FAR_OFF: f64 = 2.0;
const FALLS: f64 = 0.8;

/// A gain that is so near one that does not do, or is thought not to do, is not improved.
const CLOSE: f64 = 1.02;

/// By how much a gain is larger than one that seems to do just so; than one that does not do, at least; and where nothing is known above, in every second
/// step.
const ROOM: f64 = 1.002;
const STEP: f64 = 1.1;
const FAR: f64 = 3.0;

/// The gains over mu that are tried where nothing by the number of oscillators is proved at the smallest one.
const OF_MU: [f64; 4] = [0.1, 0.3, 1.0, 3.0];

/// Digits of a gain.
const DIGITS: u32 = 5;

/// A gain that is certified, and how far what is proved there is from the limits.
struct Tried {
    sigma: Rational,
    shares: Shares,
}

impl Tried {
    /// By how much a gain that just does is larger than this one, which does not: the share is to fall as it does up to one that is found, or as the gain
    /// grows.
    fn factor(&self, found: Option<&Tried>) -> f64 {
        let distance = |a: f64, b: f64| (a / b).portable_ln();
        let falls = found.filter(|found| !self.shares.keeps_error && found.shares.error > 0.0).map_or(1.0, |found| {
            distance(self.shares.error, found.shares.error) / distance(found.sigma.to_f64(), self.sigma.to_f64())
        });
        (distance(self.shares.next(), 1.0) / falls).portable_exp()
    }
}

impl Search<'_> {
    /// What is prepared for the smallest gain at which the limits are kept: by all that is proved there for the numbers of oscillators that are asked about,
    /// or by the conditions of the claim. Where no gain keeps to them, of a plant the one that misses them by least.
    pub(super) fn smallest_with_these_counts(&self) -> Result<Prepared, Vec<SpecErrors>> {
        let smallest = self.at(None)?;
        if !self.judges_by_count(&smallest) {
            return Ok(self.within_limits(smallest));
        }
        let limits = self.by_count();
        let first = self.least(smallest.clone(), &limits).or_else(|| self.next(&smallest, &limits));
        let Some((least, below)) = first else {
            return Ok(self.within_limits(smallest));
        };
        if below.shares.keeps_all {
            return Ok(least);
        }
        let for_every = self.within_limits(smallest.clone());
        let known = self.certified(&for_every);
        Ok(match self.smaller((&limits, &smallest), (least, below), known.as_ref()) {
            (found, true) => found,
            (nearest, false) if known.is_none() && self.is_of_plant() => nearest,
            // Where that is the answer it is to be the same as without these numbers.
            _ => Prepared { closer: OnceLock::new(), ..for_every },
        })
    }

    /// What is prepared for a gain that is given: to keep to the limits by the conditions of the claim, or else by all that is proved there.
    pub(super) fn given_with_these_counts(&self, for_every: Prepared) -> Prepared {
        if self.limits.rate.is_some() || !self.judges_by_count(&for_every) || self.certified(&for_every).is_some() {
            return for_every;
        }
        let asked = Prepared { limits: self.by_count(), counts: self.counts.to_vec(), ..for_every };
        match self.tried_with(&asked) {
            Some(Tried { shares, .. }) if shares.keeps_all || self.is_of_plant() => asked,
            _ => Prepared { limits: self.limits.clone(), ..asked },
        }
    }

    fn by_count(&self) -> Limits {
        Limits { by_count: Some(self.counts.to_vec()), ..self.limits.clone() }
    }

    fn is_of_plant(&self) -> bool {
        matches!(self.subject, Subject::Plant(_))
    }

    /// Whether something by the number of oscillators may keep to the limits: of a plant, and in continuous time the steady error of a specification.
    fn judges_by_count(&self, prepared: &Prepared) -> bool {
        let start = prepared.spec.initial_set.given()[1].map(Constant::to_f64);
        let starts_beyond =
            self.limits.peak_error.as_ref().zip(start).is_some_and(|(limit, start)| limit.to_f64() < start);
        let has_some = match self.subject {
            Subject::Plant(plant) => plant.internal_model.matched,
            Subject::Specification(_) => {
                let asked = !self.counts.is_empty() && self.limits.steady_error.is_some();
                asked && self.subject.sampling().is_none()
            }
        };
        self.limits.bounds_anything() && has_some && !starts_beyond
    }

    /// What has the smallest gain, and what is proved there.
    fn least(&self, smallest: Prepared, limits: &Limits) -> Option<(Prepared, Tried)> {
        // With the data that the pool has again when all is compared.
        let quick = Arc::new(OnceLock::from(None));
        let least = Prepared { quick, counts: self.counts.to_vec(), ..smallest.within(limits.clone(), self.watch) };
        let tried = self.tried_with(&least)?;
        Some((Prepared { found_above: Some(tried.sigma.to_f64()), ..least }, tried))
    }

    /// The same at the first of a few larger gains at which something is proved for these numbers of oscillators: the smallest one may be so far below the
    /// rates of the regulator that nothing is there.
    fn next(&self, smallest: &Prepared, limits: &Limits) -> Option<(Prepared, Tried)> {
        let sigma = self.certified(smallest)?;
        let mu = smallest.spec.internal_model.mu.to_f64();
        let gains = OF_MU.iter().filter_map(|share| round_f64(share * mu, DIGITS, Direction::Up));
        let at = |gain: Rational| self.at_larger(smallest, limits, (gain, sigma.to_f64()));
        gains.filter(|gain| *gain > sigma).find_map(at)
    }

    /// What is prepared for a gain above the smallest one, and what is proved there.
    fn at_larger(
        &self,
        smallest: &Prepared,
        limits: &Limits,
        (gain, least): (Rational, f64),
    ) -> Option<(Prepared, Tried)> {
        // In continuous time what is proved for the smallest gain and its rows serves larger ones.
        let prepared = match self.subject.sampling() {
            None => Prepared { gain: Some(gain), ..smallest.clone() },
            Some(_) => self.at(Some(gain)).ok()?,
        };
        let counts = self.counts.to_vec();
        let prepared = Prepared { found_above: Some(least), counts, ..prepared.within(limits.clone(), self.watch) };
        self.tried_with(&prepared).map(|tried| (prepared, tried))
    }

    /// What is prepared for the smallest gain that is found above the least one and below the known one, and true; or for the one that misses the limits by
    /// least, and false.
    fn smaller(
        &self,
        (limits, smallest): (&Limits, &Prepared),
        (least, mut below): (Prepared, Tried),
        known: Option<&Rational>,
    ) -> (Prepared, bool) {
        let found_above = least.found_above.unwrap_or_else(|| below.sigma.to_f64());
        // With the least gain that keeps to the limits of the error the control is the smallest, as a rule.
        let mut best: Option<(Prepared, Tried)> = None;
        let (mut nearest, mut rises) = ((least, below.shares.largest), 0);
        for tries in 0..TRIES {
            let found = best.as_ref().map(|(_, tried)| tried);
            let above = found.map(|tried| &tried.sigma).or(known).map(Rational::to_f64);
            let low = below.sigma.to_f64();
            let asked = low * below.factor(found) * ROOM;
            let is_near = |above: f64| above <= low * CLOSE || found.is_some() && above <= asked * CLOSE;
            if above.is_some_and(is_near) || rises >= RISES {
                break;
            }
            // What a bound seems to be like may be far from what it is.
            let next = match above {
                Some(above) if tries % 2 == 1 || asked >= above => (low * above).sqrt(),
                None if tries % 2 == 1 => asked.max(FAR * low),
                _ => asked.max(STEP * low),
            };
            let sigma = round_f64(next, DIGITS, Direction::Up);
            let is_below = |sigma: &Rational| above.is_none_or(|above| sigma.to_f64() < above);
            let Some(sigma) = sigma.filter(is_below) else { break };
            let Some((prepared, tried)) = self.at_larger(smallest, limits, (sigma.clone(), found_above)) else {
                below.sigma = sigma;
                continue;
            };
            if tried.shares.keeps_all || tried.shares.keeps_error && !below.shares.keeps_error {
                best = Some((prepared, tried));
                continue;
            }
            let before = below.shares.next();
            let falls = if before > FAR_OFF { FALLS } else { 1.0 };
            rises = if tried.shares.next() < falls * before { 0 } else { rises + 1 };
            if tried.shares.largest < nearest.1 {
                nearest = (prepared, tried.shares.largest);
            }
            below = tried;
        }
        match best {
            Some((prepared, tried)) if tried.shares.keeps_all => (prepared, true),
            Some((prepared, tried)) if tried.shares.largest < nearest.1 => (prepared, false),
            _ => (nearest.0, false),
        }
    }

    fn certified(&self, prepared: &Prepared) -> Option<Rational> {
        let run = prepared.certify_checked(self.options, &|_| Checked::Decided, self.watch).ok()?;
        Some(run.certified()?.sigma.clone())
    }

    /// What is certified, and what is proved there for the numbers of oscillators that are asked about.
    fn tried_with(&self, prepared: &Prepared) -> Option<Tried> {
        let run = prepared.certify_checked(self.options, &|_| Checked::Decided, self.watch).ok()?;
        let sigma = run.certified()?.sigma.clone();
        // What is proved for every number of oscillators alone is a matter of the conditions of the claim.
        if self.is_of_plant() && !run.by_count().is_some_and(|found| found.covers(self.counts)) {
            return None;
        }
        let shares = match &run {
            Run::Continuous(run) => run.shares_of_limits(&prepared.limits),
            Run::Sampled(run) => run.shares_of_limits(&prepared.limits),
        }?;
        Some(Tried { sigma, shares })
    }
}
