//! Constants for a matched base frequency, w = 2 pi / T exactly: only integers x matter.

use super::decide_steps;
use crate::condition::Condition;
use crate::data::Data;
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, Truth};

/// The most harmonics that a matched proof checks one by one.
pub const MAX_HARMONICS: u32 = 4096;

/// The proof that T_N(k) <= k0 + k1 k^2 for every integer k >= 0 and every N.
///
/// By Lemma T'' the supremum over N of T_N(k) is at most 2/(nu^2 n_k) for k >= 1 (attained for N >= k), and
/// T_N(0) = 1/(nu^2 n_0). So (k0, k1) is admissible if and only if k0 >= 1/(nu^2 n_0) and
/// k0 + k1 k^2 >= 2/(nu^2 n_k) for every k >= 1. Harmonics k < K are checked one by one; for k >= K, W3 gives
/// n_k >= K^2 n_K / k^2, so k1 >= 2/(nu^2 K^2 n_K) suffices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MatchedProof {
    /// K >= 1, the first harmonic covered by the tail inequality.
    pub first_of_tail: u32,
}

impl MatchedProof {
    /// Decides the proof. Hypotheses: W1-W3; base_frequency = 2 pi / period (checked here: `False` otherwise).
    #[must_use]
    pub fn decide(self, data: &Data<'_>, k0: &Rational, k1: &Rational) -> (Truth, Condition) {
        let (k0, k1) = (data.rational(k0), data.rational(k1));
        let weights = &data.spec.internal_model.weights;
        let inverse_nu_squared = data.nu.sqr().recip();
        let tail = u64::from(self.first_of_tail);
        let at_zero = Condition::at_most("T", "k = 0: 1/(nu^2 n_0) <= k0", &inverse_nu_squared / &data.n_0, k0.clone());
        if !data.spec.internal_model.matched || !(1..=MAX_HARMONICS).contains(&self.first_of_tail) {
            let what = format!("a matched proof needs base_frequency = 2 pi / period and 1 <= K <= {MAX_HARMONICS}");
            return (Truth::False, Condition::at_most("T", what, Enclosure::one(data.precision), data.zero()));
        }
        let harmonic = |k: u64| {
            let square = Enclosure::from_integer((k * k) as i64, data.precision);
            let lhs = 2 * &inverse_nu_squared / weights.weight(k, data.precision);
            Condition::at_most("T", format!("k = {k}: 2/(nu^2 n_k) <= k0 + k1 k^2"), lhs, &k0 + &k1 * square)
        };
        let square = Enclosure::from_integer((tail * tail) as i64, data.precision);
        let lhs = 2 * &inverse_nu_squared / (square * weights.weight(tail, data.precision));
        let all_others = Condition::at_most("T", format!("every k >= {tail}: 2/(nu^2 K^2 n_K) <= k1"), lhs, k1.clone());
        let one_by_one = (1..tail).map(harmonic);
        decide_steps(std::iter::once(at_zero.clone()).chain(one_by_one).chain(std::iter::once(all_others)), at_zero)
    }
}

/// The trade-off between k0 and k1 in floating point: candidates for a search, proved afterwards.
#[derive(Clone, Debug)]
pub struct TradeOff {
    /// Candidate pairs (k0, k1, K), in order of decreasing k1.
    pub candidates: Vec<(f64, f64, u32)>,
    /// The share of the smallest cost that [`TradeOff::best`] may give up for a larger k1.
    pub slack: f64,
}

impl TradeOff {
    /// The vertices of the admissible set for a matched base frequency (up to a few dozen of them).
    #[must_use]
    pub fn matched(data: &Data<'_>) -> TradeOff {
        const HARMONICS: usize = 64;
        let weights = &data.spec.internal_model.weights;
        let inverse_nu_squared = data.nu.sqr().recip().upper_f64();
        let needed = |k: usize| match k {
            0 => inverse_nu_squared / data.n_0.lower_f64(),
            _ => 2.0 * inverse_nu_squared / weights.weight(k as u64, data.precision).lower_f64(),
        };
        let needs: Vec<f64> = (0..=HARMONICS).map(needed).collect();
        let mut candidates = Vec::new();
        for first in 0..HARMONICS {
            // The vertex where the constraint of harmonic `first` meets the steepest of the later ones.
            let slope = (first + 1..=HARMONICS)
                .map(|k| (needs[k] - needs[first]) / ((k * k - first * first) as f64))
                .fold(f64::NEG_INFINITY, f64::max);
            // Harmonics beyond the list need k1 >= 2/(nu^2 K^2 n_K), which only fails to hold for a flat tail.
            let tail = (1..=HARMONICS).find(|&k| needs[k] / ((k * k) as f64) <= slope);
            if let (Some(tail), true) = (tail, slope > 0.0) {
                let k0 = (0..=HARMONICS).map(|k| needs[k] - slope * (k * k) as f64).fold(needs[0], f64::max);
                candidates.push((k0, slope, tail as u32));
            }
        }
        // k0 = 1/(nu^2 n_0) with K = 1 is always admissible.
        candidates.push((needs[0], needs[1], 1));
        candidates.sort_by(|a, b| b.1.total_cmp(&a.1));
        candidates.dedup();
        TradeOff { candidates, slack: 0.0 }
    }

    /// A single pair valid for every x: the closed form.
    #[must_use]
    pub fn closed_form(data: &Data<'_>) -> TradeOff {
        let (k0, k1) = super::closed_form_pair(data);
        TradeOff { candidates: vec![(k0.upper_f64(), k1.upper_f64(), 0)], slack: 0.0 }
    }

    /// The candidate that minimises `k0 a + k1 b`: the first one, so with the largest k1, whose cost exceeds the smallest
    /// by no more than the slack.
    #[must_use]
    pub fn best(&self, a: f64, b: f64) -> (f64, f64, u32) {
        let cost = |pair: &(f64, f64, u32)| pair.0 * a + pair.1 * b;
        let least = self.candidates.iter().map(cost).fold(f64::INFINITY, f64::min);
        let first = self.candidates.iter().copied().find(|pair| cost(pair) <= least * (1.0 + self.slack));
        first.unwrap_or((f64::INFINITY, f64::INFINITY, 1))
    }
}
