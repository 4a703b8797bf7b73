//! The gain for which a claim has the rates that are asked for (derivation, 13.5, 13.6).

use super::{Prepared, Run, Subject, Watch};
use crate::certify::{Limits, Options};
use rug::Rational;
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_lang::spec::SpecErrors;

/// The gains that are tried in turn, over the smallest one.
const SHARES: [f64; 7] = [1.2, 1.5, 2.0, 3.0, 4.0, 6.0, 10.0];

/// Steps of the bisection between a gain that does not do and one that does.
const STEPS: usize = 6;

/// Digits of a gain.
const DIGITS: u32 = 5;

/// A gain that is certified, and the slowest of its rates; none where one of them is not proved.
struct Tried {
    prepared: Prepared,
    sigma: Rational,
    rate: Option<Rational>,
}

impl Prepared {
    /// The data of a subject for the smallest gain that is found with which the limits are kept, the least rate among them, of these numbers
    /// of oscillators; where no gain does, for the one with the largest rate that is found. A run with it whose rates are proved
    /// decides anew ([`Run::prove_rates`]).
    ///
    /// # Errors
    /// Those of [`Prepared::new`].
    pub fn for_rates(
        subject: &Subject,
        (limits, counts): (&Limits, &[u32]),
        options: Options,
        watch: &dyn Watch,
    ) -> Result<Prepared, Vec<SpecErrors>> {
        let at = |gain: Option<Rational>| Prepared::watched(subject.clone(), gain, watch);
        let Some(asked) = &limits.rate else { return Ok(at(None)?.within(limits.clone())) };
        // With it a claim that is too slow would be taken back, and its rates with it.
        let others = Limits { rate: None, ..limits.clone() };
        let asking = |prepared: Prepared| Prepared { limits: limits.clone(), ..prepared };
        let smallest = at(None)?.within(others.clone());
        let options = Options { compare: false, ..options };
        let tried = |prepared: Prepared| {
            let mut run = prepared.certify_watched(options, watch).ok();
            let sigma = run.as_ref().and_then(|run| Some(run.certified()?.sigma.clone()));
            let rate = run.as_mut().and_then(|run| run.slowest_rate(counts));
            drop(run);
            (prepared, sigma.map(|sigma| (sigma, rate)))
        };
        let (prepared, claim) = tried(smallest);
        let Some((sigma, rate)) = claim else { return Ok(asking(prepared)) };
        let does = |tried: &Tried| tried.rate.as_ref().is_some_and(|rate| rate >= asked);
        let first = Tried { prepared, sigma, rate };
        if does(&first) {
            return Ok(asking(first.prepared));
        }
        let (least, mut below) = (first.sigma.to_f64(), first.sigma.clone());
        let tried = |sigma: Rational| {
            let (prepared, claim) = tried(at(Some(sigma)).ok()?.within(others.clone()));
            let (sigma, rate) = claim?;
            Some(Tried { prepared: Prepared { found_above: Some(least), ..prepared }, sigma, rate })
        };
        let mut best = first;
        for sigma in SHARES.iter().filter_map(|share| round_f64(least * share, DIGITS, Direction::Up)) {
            let next = tried(sigma.clone());
            if let Some(next) = next.filter(|next| next.rate > best.rate) {
                best = next;
            }
            if does(&best) {
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
        Ok(asking(best.prepared))
    }
}

impl Run<'_> {
    /// The smallest of the rates of these numbers of oscillators; `None` where one of them is not proved.
    fn slowest_rate(&mut self, counts: &[u32]) -> Option<Rational> {
        self.prove_rates(counts).ok()?;
        self.rates().into_iter().map(|(_, rate)| rate).min()?.cloned()
    }
}
