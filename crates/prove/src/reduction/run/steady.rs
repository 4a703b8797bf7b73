//! A smaller gain where the steady error is to be kept with given numbers of oscillators, and not with every one (derivation, 13.5, 14).

use super::seeking::Search;
use super::{Checked, Prepared, Run, Subject};
use crate::certify::Limits;
use rug::Rational;
use sigmastar_exact::number::{Direction, Portable, round_f64};
use sigmastar_lang::spec::Oscillators;
use std::sync::OnceLock;

/// Gains that are tried at most.
const TRIES: usize = 8;

/// A gain that is so near one that does not do, or is thought not to do, is not improved.
const CLOSE: f64 = 1.02;

/// By how much a gain is larger than one that seems to do just so; than one that does not do, at least; and where nothing is known above, in every second
/// step.
const ROOM: f64 = 1.002;
const STEP: f64 = 1.1;
const FAR: f64 = 3.0;

/// Digits of a gain.
const DIGITS: u32 = 5;

/// A gain that is certified, and what bounds the steady error there.
struct Tried {
    sigma: Rational,
    error: f64,
    does: bool,
}

impl Tried {
    /// By how much a gain with this error is larger than this one, which has a larger error: the error is to fall as it does up to one that is found, or
    /// as the gain grows.
    fn share(&self, found: Option<&Tried>, error: f64) -> f64 {
        let distance = |a: f64, b: f64| (a / b).portable_ln();
        let falls = found.map_or(1.0, |found| {
            distance(self.error, found.error) / distance(found.sigma.to_f64(), self.sigma.to_f64())
        });
        (distance(self.error, error) / falls).portable_exp()
    }
}

impl Search<'_> {
    /// What is prepared to keep the steady error with every number of oscillators, or what has a smaller gain, at which it is kept with those that are
    /// asked about.
    pub(super) fn with_these_counts(&self, for_every: Prepared) -> Prepared {
        let Some(most) = &self.limits.steady_error else { return for_every };
        if self.counts.is_empty() || self.subject.sampling().is_some() {
            return for_every;
        }
        let limits = Limits { steady_with: self.counts.to_vec(), ..self.limits.clone() };
        let known = self.certified(&for_every);
        if for_every.gain.is_some() {
            if known.is_some() {
                return for_every;
            }
            let asked = Prepared { limits, ..for_every };
            return match self.steady(&asked, most) {
                Some(Tried { does: true, .. }) => asked,
                _ => Prepared { limits: self.limits.clone(), ..asked },
            };
        }
        // Where that is the answer it is to be the same as without these numbers.
        self.smaller(&limits, (known.as_ref(), most)).unwrap_or(Prepared { closer: OnceLock::new(), ..for_every })
    }

    /// One with a smaller gain than the known one.
    fn smaller(&self, limits: &Limits, (known, most): (Option<&Rational>, &Rational)) -> Option<Prepared> {
        // With the data that the pool has again when all is compared.
        let quick = OnceLock::from(None);
        let least = Prepared { quick, ..self.at(None).ok()?.within(limits.clone(), self.watch) };
        let mut below = self.steady(&least, most).filter(|tried| known.is_none_or(|known| tried.sigma < *known))?;
        let smallest = below.sigma.to_f64();
        if below.does {
            return Some(Prepared { found_above: Some(smallest), ..least });
        }
        let mut best: Option<(Prepared, Tried)> = None;
        for tries in 0..TRIES {
            let found = best.as_ref().map(|(_, tried)| tried);
            let above = found.map(|tried| &tried.sigma).or(known).map(Rational::to_f64);
            let low = below.sigma.to_f64();
            let asked = low * below.share(found, most.to_f64()) * ROOM;
            let is_near = |above: f64| above <= low * CLOSE || found.is_some() && above <= asked * CLOSE;
            if above.is_some_and(is_near) {
                break;
            }
            // What the error seems to be like may be far from what it is.
            let next = match above {
                Some(above) if tries % 2 == 1 || asked >= above => (low * above).sqrt(),
                None if tries % 2 == 1 => asked.max(FAR * low),
                _ => asked.max(STEP * low),
            };
            let sigma = round_f64(next, DIGITS, Direction::Up);
            let is_below = |sigma: &Rational| above.is_none_or(|above| sigma.to_f64() < above);
            let Some(sigma) = sigma.filter(is_below) else { break };
            let tried = self.at(Some(sigma.clone())).ok().and_then(|prepared| {
                let prepared = Prepared { found_above: Some(smallest), ..prepared.within(limits.clone(), self.watch) };
                self.steady(&prepared, most).map(|tried| (prepared, tried))
            });
            match tried {
                Some((prepared, tried)) if tried.does => best = Some((prepared, tried)),
                Some((_, tried)) => below = tried,
                None => below.sigma = sigma,
            }
        }
        best.map(|(prepared, _)| prepared)
    }

    fn certified(&self, prepared: &Prepared) -> Option<Rational> {
        let run = prepared.certify_checked(self.options, &|_| Checked::Decided, self.watch).ok()?;
        Some(run.certified()?.sigma.clone())
    }

    /// What is certified, and the steady error with the numbers of oscillators that are asked about.
    fn steady(&self, prepared: &Prepared, most: &Rational) -> Option<Tried> {
        let run = prepared.certify_checked(self.options, &|_| Checked::Decided, self.watch).ok()?;
        let Run::Continuous(mut run) = run else { return None };
        let sigma = run.sigma_star()?.clone();
        if let (false, Subject::Plant(plant)) = (run.keeps_steady_error(most, self.counts), self.subject) {
            run.set_counts(plant, &self.counts.iter().copied().map(Oscillators::first).collect::<Vec<_>>());
        }
        let error = run.steady_error_with(self.counts)?.upper_f64();
        Some(Tried { sigma, error, does: run.keeps_steady_error(most, self.counts) })
    }
}
