//! Bounds at one gain, as reports have them for the gain of a claim and for larger ones (derivation, 13.5).

use crate::rate::found::ForCount;
use rug::Rational;
use sigmastar_decide::conditions::{SampledProof, SharpProof};
use sigmastar_decide::linear::Falling;
use sigmastar_decide::trial::{Trial, TubeProof};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_rational};
use sigmastar_lang::spec::{Oscillators, Specification};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::control::Control;
use sigmastar_theory::derivation::initial_set::{ClaimedSet, claimed_distances};
use sigmastar_theory::derivation::targets::{Target, TargetKind};
use std::sync::{Arc, LazyLock};

/// The numbers of oscillators of which the steady error is bounded in continuous time where none are asked about.
const SHOWN_N_O: [u32; 2] = [0, 10];

/// Those that are asked about, or these.
pub(super) fn shown(asked: &[u32]) -> &[u32] {
    if asked.is_empty() { &SHOWN_N_O } else { asked }
}

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
    /// Of |e| along the periodic solution: in continuous time with 0 oscillators, at samples with every number of them.
    pub steady: Enclosure,
    /// The same for each number of oscillators that was asked about, or for 0 and 10; none at samples.
    pub steady_with: Vec<(u32, Enclosure)>,
    /// Of |e| on the way, for every n_o.
    pub peak: Enclosure,
    /// Of what is put out, for every n_o.
    pub control: Control<Enclosure>,
    /// The rates for the numbers of oscillators that were asked about, in 1/time; none where it is not proved.
    pub rates: Vec<(u32, Option<Rational>)>,
    pub(super) proof: RowProof,
}

/// Bounds for given oscillators, or for every number of them from some on, at one gain.
#[derive(Clone, Debug)]
pub struct CountBounds {
    /// At which harmonics they are.
    pub oscillators: Oscillators,
    /// Whether they hold for every larger number, too.
    pub or_more: bool,
    /// Of |e| along the periodic solution.
    pub steady_error: Enclosure,
    /// Of the root mean square of e along it.
    pub mean_square: Enclosure,
    /// Of what is put out along it.
    pub steady_control: Enclosure,
    /// Of how large the rest of the loop is along it.
    pub sizes: LoopSizes,
    /// For every solution from the set, where they are proved.
    pub largest: Option<Largest>,
}

/// Bounds of the states of a loop along its periodic solution.
#[derive(Clone, Debug)]
pub struct LoopSizes {
    /// Of `|L^-1 (x - x_0)|`.
    pub states: Enclosure,
    /// Of `|zeta|_N`.
    pub zeta: Enclosure,
    /// Of |y|, where the law at samples has a delay; else 0.
    pub mean: Enclosure,
}

/// Bounds for every solution from the set, at all times.
#[derive(Clone, Debug)]
pub struct Largest {
    /// Of |e|.
    pub error: Enclosure,
    /// Of how far what is put out is from that along the periodic solution.
    pub transient: Enclosure,
}

impl CountBounds {
    /// The number of oscillators, where they are at the first harmonics.
    #[must_use]
    pub fn n_o(&self) -> Option<u64> {
        self.oscillators.n_o().map(u64::from)
    }

    /// Of what is put out at all times, for every solution from the set, where it is proved.
    #[must_use]
    pub fn largest_control(&self) -> Option<Enclosure> {
        Some(&self.steady_control + &self.largest.as_ref()?.transient)
    }
}

/// Bounds by the number of oscillators.
#[derive(Clone, Debug)]
pub struct ByCount {
    /// By their number in rising order, the last one of which may hold for every larger number, too; then other sets.
    pub counts: Vec<CountBounds>,
    /// What proves them.
    pub proof: CountProof,
    /// Whether an independent program decides them, too.
    pub checked: bool,
}

/// What proves bounds by the number of oscillators.
#[derive(Clone, Debug)]
pub enum CountProof {
    /// Of a plant that is linear in x and e (derivation, 14.3).
    Linear {
        /// Forms that fall along the differences of solutions.
        forms: Vec<Falling>,
    },
    /// A trial for each number, and what is proved around it (derivation, 14.4).
    Trials(Vec<(Trial, TubeProof)>),
}

/// By what share the numbers of a claim are above what is found: the size of a curve is bounded in another way by the checker.
static OF_LINEAR: LazyLock<Rational> = LazyLock::new(|| Rational::from((1, 10_000)));
static OF_TRIALS: LazyLock<Rational> = LazyLock::new(|| Rational::from((1, 5_000_000)));

/// The same of the sizes of the states of a loop beside a trial, which are bounded roughly, and on which factors of rates alone rest.
static OF_SIZES: LazyLock<Rational> = LazyLock::new(|| Rational::from((1, 100)));

/// Significant digits of the upper ends in a claim.
pub(crate) const CLAIM_DIGITS: u32 = 12;

/// A bound as a certificate has it, with this room.
fn above(bound: &Enclosure, room: &Rational) -> Enclosure {
    let one = Enclosure::one(bound.precision());
    written(&(bound * (Enclosure::from_rational(room, bound.precision()) + one)))
}

/// The upper end of a bound as a claim has it, with few digits, rounded up; none where there is no upper end.
pub(crate) fn written(bound: &Enclosure) -> Enclosure {
    let upper = bound.upper_rational().map(|upper| round_rational(&upper, CLAIM_DIGITS, Direction::Up));
    upper.map_or_else(|| bound.clone(), |upper| Enclosure::from_rational(&upper, bound.precision()))
}

impl ByCount {
    /// By what share the numbers that a certificate has are above what is found.
    pub(crate) fn room(&self) -> &'static Rational {
        match &self.proof {
            CountProof::Linear { .. } => &OF_LINEAR,
            CountProof::Trials(_) => &OF_TRIALS,
        }
    }

    /// That of [`ByCount::room`] for [`LoopSizes`].
    pub(crate) fn room_of_sizes(&self) -> &'static Rational {
        match &self.proof {
            CountProof::Linear { .. } => &OF_LINEAR,
            CountProof::Trials(_) => &OF_SIZES,
        }
    }

    /// Whether the bounds do not depend on what proves the claim but on its set: by trials they do, as the error box says of which solution they are, and the
    /// function of the claim is a part of what proves them.
    pub(crate) fn is_of_set(&self) -> bool {
        matches!(self.proof, CountProof::Linear { .. })
    }

    /// A bound as a certificate has it: what the independent checker decides is that number, no smaller one.
    pub(crate) fn stated(&self, bound: &Enclosure) -> Enclosure {
        above(bound, self.room())
    }

    /// Those for a number of oscillators.
    #[must_use]
    pub fn at(&self, n_o: u64) -> Option<&CountBounds> {
        let mut below = self.counts.iter().rev().filter(|bounds| bounds.n_o().is_some_and(|own| own <= n_o));
        below.next().filter(|bounds| bounds.or_more || bounds.n_o() == Some(n_o))
    }

    /// Those for these oscillators: of a set with gaps none but its own.
    pub(super) fn with(&self, oscillators: &Oscillators) -> Option<&CountBounds> {
        match oscillators.n_o() {
            Some(n_o) => self.at(u64::from(n_o)),
            None => self.counts.iter().find(|bounds| bounds.oscillators == *oscillators),
        }
    }

    /// dX, dE and dZ of a set with these oscillators, from the sizes of its periodic solution as the certificate has them; none where it says
    /// nothing of them.
    pub(super) fn distances(
        &self,
        data: &Data<'_>,
        set: &ClaimedSet,
        oscillators: &Oscillators,
    ) -> Option<[Enclosure; 3]> {
        let bounds = self.with(oscillators).filter(|_| self.checked)?;
        let LoopSizes { states, zeta, .. } = &bounds.sizes;
        let [states, zeta] = [states, zeta].map(|size| above(size, self.room_of_sizes()));
        Some(claimed_distances(data, set, [&states, &self.stated(&bounds.steady_error), &zeta]))
    }

    /// Of |zeta|_N along the periodic solution with these oscillators, as the certificate has it; none where it says nothing of it.
    pub(super) fn largest_zeta(&self, oscillators: &Oscillators) -> Option<Enclosure> {
        let bounds = self.with(oscillators).filter(|_| self.checked)?;
        Some(above(&bounds.sizes.zeta, self.room_of_sizes()))
    }

    /// The smallest number of oscillators whose bound is certainly at most a target.
    pub(super) fn reaching(&self, target: &Target) -> Option<u64> {
        let reaches = |bounds: &&CountBounds| {
            let bound = match target.kind {
                TargetKind::Sup => &bounds.steady_error,
                TargetKind::Rms => &bounds.mean_square,
            };
            bound.le(&target.value.enclose(bound.precision())).is_true()
        };
        self.counts.iter().filter(|bounds| bounds.n_o().is_some()).find(reaches)?.n_o()
    }

    /// The largest of a bound over these numbers of oscillators, or over all of them where there are none; none where it is not known of one.
    pub(super) fn over(&self, counts: &[u32], of: &dyn Fn(&CountBounds) -> Option<Enclosure>) -> Option<Enclosure> {
        let all: Vec<Enclosure> = match counts {
            [] => {
                self.is_about_all().then_some(())?;
                self.counts.iter().filter(|bounds| bounds.n_o().is_some()).map(of).collect::<Option<_>>()?
            }
            _ => counts.iter().map(|n_o| of(self.at(u64::from(*n_o))?)).collect::<Option<_>>()?,
        };
        all.into_iter().reduce(|a, b| a.max(&b))
    }

    /// Whether there are bounds of every number of oscillators at the first harmonics.
    #[must_use]
    pub fn is_about_all(&self) -> bool {
        let first: Vec<u64> = self.counts.iter().filter_map(CountBounds::n_o).collect();
        let last = self.counts.iter().rfind(|bounds| bounds.n_o().is_some());
        first.iter().copied().eq(0..first.len() as u64) && last.is_some_and(|last| last.or_more)
    }

    /// Of what is put out at all times with every number of oscillators, as the certificate has it; none where it is not proved of one.
    pub(crate) fn stated_control(&self) -> Option<Enclosure> {
        self.over(&[], &CountBounds::largest_control).map(|found| self.stated(&found))
    }

    /// The largest of a bound over all numbers of oscillators; none where not all are known.
    pub(super) fn largest(&self, of: impl Fn(&CountBounds) -> Option<&Enclosure>) -> Option<Enclosure> {
        self.over(&[], &|bounds| of(bounds).cloned())
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
        let start = self.e0.to_f64().max(self.steady.upper_f64());
        self.peak.upper_f64() > FAR * start
    }
}

/// What is proved of noise at one gain of the rows.
#[derive(Clone, Debug)]
pub struct RowNoise {
    /// The oscillators.
    pub oscillators: Oscillators,
    /// The gain.
    pub sigma: Rational,
    /// What the deviation of e is at most in the limit.
    pub limit: Rational,
}

impl RowNoise {
    /// Of the oscillators for which something is proved.
    pub(super) fn of<P, Q>(sigma: &Rational, found: Vec<ForCount<P, Q>>) -> Vec<RowNoise> {
        let one = |found: &ForCount<P, Q>| {
            let limit = found.proved_noise()?.limit.clone();
            Some(RowNoise { oscillators: found.oscillators.clone(), sigma: sigma.clone(), limit })
        };
        found.iter().filter_map(one).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bounds with these steady errors, for so many oscillators; the last one is for more, too, where that is said.
    fn with(errors: &[(u32, f64)], or_more: bool) -> ByCount {
        let bounds = |(n_o, error): &(u32, f64)| CountBounds {
            oscillators: Oscillators::first(*n_o),
            or_more: or_more && errors.last().is_some_and(|(last, _)| last == n_o),
            steady_error: Enclosure::exactly(*error),
            mean_square: Enclosure::exactly(*error),
            steady_control: Enclosure::exactly(1.0),
            sizes: LoopSizes {
                states: Enclosure::exactly(2.0),
                zeta: Enclosure::exactly(5.0),
                mean: Enclosure::exactly(0.0),
            },
            largest: None,
        };
        ByCount { counts: errors.iter().map(bounds).collect(), proof: CountProof::Trials(Vec::new()), checked: true }
    }

    #[test]
    fn bounds_of_some_are_none_of_all() {
        let over = |found: &ByCount, counts: &[u32]| {
            found.over(counts, &|bounds| Some(bounds.steady_error.clone())).map(|bound| bound.upper_f64())
        };
        let all = with(&[(0, 2.0), (1, 3.0), (2, 1.0)], true);
        assert_eq!([over(&all, &[]), over(&all, &[0, 7]), over(&all, &[2])], [Some(3.0), Some(2.0), Some(1.0)]);
        // One number is missing; nothing is said of more; there is none.
        let gap = with(&[(0, 2.0), (1, 3.0), (3, 1.0)], true);
        assert_eq!(
            [over(&gap, &[]), over(&gap, &[2]), over(&gap, &[0, 2]), over(&gap, &[9])],
            [None, None, None, Some(1.0)]
        );
        let few = with(&[(0, 2.0), (1, 3.0)], false);
        assert_eq!([over(&few, &[]), over(&few, &[2]), over(&few, &[0])], [None, None, Some(2.0)]);
        assert_eq!(over(&with(&[], true), &[]), None);
        // What is not known of one is not known of all.
        assert!(all.over(&[], &CountBounds::largest_control).is_none());
    }
}
