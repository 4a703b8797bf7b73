//! Bounds at one gain, as reports have them for the gain of a claim and for larger ones (derivation, 13.5).

use crate::rate::found::ForCount;
use rug::Rational;
use sigmastar_decide::conditions::{SampledProof, SharpProof};
use sigmastar_decide::linear::Falling;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::Specification;
use sigmastar_theory::derivation::control::Control;
use std::sync::Arc;

/// The numbers of oscillators of which the steady error is bounded in continuous time.
pub const SHOWN_N_O: [u64; 2] = [0, 10];

/// Bounds at one gain, for every solution from the initial set there: where the specification states no sizes of it they are those of the
/// periodic solution at this gain.
///
/// Guarantee: every condition is proved for a witness at this gain.
#[derive(Clone, Debug)]
pub struct GainRow {
    /// The gain.
    pub sigma: Rational,
    /// E0 of the initial set.
    pub e0: Rational,
    /// Of |e| along the periodic solution, for the numbers of oscillators of [`SHOWN_N_O`]; at samples one, for every n_o.
    pub steady: Vec<Enclosure>,
    /// Of |e| on the way, for every n_o.
    pub peak: Enclosure,
    /// Of what is put out, for every n_o.
    pub control: Control<Enclosure>,
    /// The rates for the numbers of oscillators that were asked about, in 1/time; none where it is not proved.
    pub rates: Vec<(u32, Option<Rational>)>,
    pub(super) proof: RowProof,
}

/// Bounds for one number of oscillators, or for all from it on, at one gain.
#[derive(Clone, Debug)]
pub struct CountBounds {
    /// n_o.
    pub n_o: u64,
    /// Whether they hold for every larger number, too.
    pub or_more: bool,
    /// Of |e| along the periodic solution.
    pub steady_error: Enclosure,
    /// Of the root mean square of e along it.
    pub mean_square: Enclosure,
    /// Of |e| of every solution from the set, at all times.
    pub peak_error: Enclosure,
    /// Of what is put out.
    pub control: Control<Enclosure>,
}

/// Bounds for every number of oscillators.
#[derive(Clone, Debug)]
pub struct ByCount {
    /// For 0, 1, ..., K, the last of them for every larger number, too: K is the number of harmonics of the plant.
    pub counts: Vec<CountBounds>,
    /// What proves them.
    pub proof: CountProof,
    /// Whether an independent program decides them, too.
    pub checked: bool,
}

/// What proves bounds for each number of oscillators.
#[derive(Clone, Debug)]
pub struct CountProof {
    /// Forms that fall along the differences of solutions.
    pub forms: Vec<Falling>,
    /// For each number of oscillators bounds of `|L^-1 (x - x_0)|` and `|zeta|_N` along the periodic solution.
    pub sizes: Vec<[Enclosure; 2]>,
}

impl ByCount {
    /// Those for a number of oscillators.
    #[must_use]
    pub fn at(&self, n_o: u64) -> Option<&CountBounds> {
        self.counts.iter().rev().find(|bounds| bounds.n_o <= n_o)
    }

    /// The largest of a bound.
    pub(super) fn largest(&self, of: impl Fn(&CountBounds) -> &Enclosure) -> Option<Enclosure> {
        self.counts.iter().map(of).cloned().reduce(|a, b| a.max(&b))
    }
}

/// What proves a row.
#[derive(Clone, Debug)]
pub(super) enum RowProof {
    /// A proof with the data of the claim, or with others of the same plant.
    Continuous(Box<SharpProof>, Option<Arc<Specification>>),
    /// Of the regulator at samples.
    Sampled(Box<SampledProof>),
}

/// By so much more than at the start |e| may be on the way before a larger gain is looked for.
const FAR: f64 = 10.0;

impl GainRow {
    /// Whether the bound of |e| on the way is far above what |e| is at the start, and along the periodic solution.
    #[must_use]
    pub fn goes_far(&self) -> bool {
        let start = self.e0.to_f64().max(self.steady[0].upper_f64());
        self.peak.upper_f64() > FAR * start
    }
}

/// What is proved of noise at one gain of the rows.
#[derive(Clone, Debug)]
pub struct RowNoise {
    /// n_o.
    pub n_o: u32,
    /// The gain.
    pub sigma: Rational,
    /// What the deviation of e is at most in the limit.
    pub limit: Rational,
}

impl RowNoise {
    /// Of the numbers of oscillators for which something is proved.
    pub(super) fn of<P, Q>(sigma: &Rational, found: Vec<ForCount<P, Q>>) -> Vec<RowNoise> {
        let one = |found: &ForCount<P, Q>| {
            let limit = found.proved_noise()?.limit.clone();
            Some(RowNoise { n_o: found.n_o, sigma: sigma.clone(), limit })
        };
        found.iter().filter_map(one).collect()
    }
}
