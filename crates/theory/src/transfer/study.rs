//! The transfer bound of one specification: the certified pair, how much of it each n_o uses, the trade-off, and what
//! becomes of the paper's constants.

use super::printed::PrintedChecks;
use super::{
    CertifiedPair, MAX_POLE_OSCILLATORS, OscillatorCount, PairError, SetPair, SupRatio, TradeOff, TransferProof,
    cheapest_pair, decide, internal_model_poles, serves_every_set, slowest_decay, smallest_k1,
    smallest_k1_for_every_set, sup_ratios, trade_off_pairs,
};
use crate::data::{Bound, Data, Problem};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, Portable, round_f64, round_rational};
use sigmastar_exact::parallel;
use sigmastar_lang::spec::{Constant, Specification};

/// Pairs in the table of the trade-off.
const TRADE_OFF_PAIRS: usize = 10;
/// Significant digits of a k0 that is no rational.
const K0_DIGITS: u32 = 16;

/// Which pair (k0, k1) is wanted.
#[derive(Clone, Debug)]
pub enum PairChoice {
    /// The smallest k1 for this k0.
    SmallestK1(Constant),
    /// The pair with the smallest a k0 + b k1.
    Cheapest {
        /// a.
        a: Constant,
        /// b.
        b: Constant,
    },
    /// As `Cheapest`, with the weights of Z^2 (section 4) at X = E = 0: a = b_q^2/w^2 and b = b_qt^2/w^4.
    ForData,
}

/// A pair that is proved for a matched base frequency: T_N(x) <= k0 + k1 x^2 at every integer x >= 0.
#[derive(Clone, Debug)]
pub struct MatchedPair {
    /// k0.
    pub k0: Rational,
    /// k1.
    pub k1: Rational,
    /// The first harmonic that the tail inequality covers.
    pub first_of_tail: u32,
}

/// What serves every finite set of harmonics that contains 0, beside the closed form, which does (derivation, 14.7).
#[derive(Clone, Debug)]
pub struct ForEverySet {
    /// A pair with the k0 of the study, at every x >= 0; `None` where no proof was found within the effort.
    pub pair: Option<SetPair>,
    /// Whether the pair for a matched base frequency is proved to serve every set, where there is one.
    pub matched: Option<bool>,
}

impl ForEverySet {
    fn new(data: &Data<'_>, k0: &Rational, matched: Option<&MatchedPair>) -> ForEverySet {
        let serves = |pair: &MatchedPair| serves_every_set(data, &TransferProof::Matched { k: pair.first_of_tail });
        ForEverySet { pair: smallest_k1_for_every_set(data, k0), matched: matched.map(serves) }
    }
}

/// What is known of one number of oscillators.
#[derive(Clone, Debug)]
pub struct Uniformity {
    /// How much of the bound it uses.
    pub sup: SupRatio,
    /// The decay rate of the slowest mode of Phi - mu M M'N, where its poles are enclosed.
    pub decay: Option<Enclosure>,
}

/// The certified transfer bound of a specification.
#[derive(Clone, Debug)]
pub struct TransferStudy<'s> {
    /// The specification at one precision.
    pub data: Data<'s>,
    /// The pair.
    pub pair: CertifiedPair,
    /// One entry for each number of oscillators that was asked for, in that order.
    pub uniformity: Vec<Uniformity>,
    /// Proved pairs along the trade-off, k0 increasing.
    pub trade_off: Vec<CertifiedPair>,
    /// The pair that only integers x need, where the base frequency is matched.
    pub matched: Option<MatchedPair>,
    /// What serves every set of harmonics, where that was asked for.
    pub every_set: Option<ForEverySet>,
    /// The paper's constants, statement by statement.
    pub printed: PrintedChecks,
}

impl<'s> TransferStudy<'s> {
    /// Finds and proves the pair, and all that belongs to it, for some numbers of oscillators, and where that is asked for every set of harmonics; `done` is
    /// called after each number.
    ///
    /// Guarantee: every pair, ratio and comparison is proved.
    ///
    /// # Errors
    /// There is no certified pair.
    pub fn new(
        spec: &'s Specification,
        precision: u32,
        choice: &PairChoice,
        (n_o, every_set): (&[OscillatorCount], bool),
        done: impl Fn() + Sync,
    ) -> Result<TransferStudy<'s>, PairError> {
        let data = Data::new(spec, precision);
        let (a, b) = weights(&data, choice);
        let pair = match choice {
            PairChoice::SmallestK1(k0) => {
                let at_zero = || data.transfer_at_zero().upper_decimal(3);
                let k0 = rational_k0(k0, precision).ok_or_else(|| PairError::OutOfRange { at_zero: at_zero() })?;
                smallest_k1(&data, &k0)?
            }
            PairChoice::Cheapest { .. } | PairChoice::ForData => cheapest_pair(&data, a, b)?,
        };
        let decay = |n_o| match n_o {
            OscillatorCount::Finite(n) if n <= MAX_POLE_OSCILLATORS => {
                internal_model_poles(&data, n).ok().map(|poles| slowest_decay(&data, &poles))
            }
            _ => None,
        };
        let ratios = sup_ratios(&data, &pair.k0, &pair.k1, n_o, done);
        let decays = parallel::map(&ratios, |sup| decay(sup.n_o));
        let uniformity = ratios.into_iter().zip(decays).map(|(sup, decay)| Uniformity { decay, sup }).collect();
        let trade_off = trade_off_pairs(&data, TRADE_OFF_PAIRS);
        let matched = if spec.internal_model.matched { matched_pair(&data, a, b) } else { None };
        let every_set = every_set.then(|| ForEverySet::new(&data, &pair.k0, matched.as_ref()));
        let printed = PrintedChecks::new(&data);
        Ok(TransferStudy { data, pair, uniformity, trade_off, matched, every_set, printed })
    }
}

/// A k0 that was asked for: itself where it is rational, else rounded up; `None` where it has no upper end.
#[must_use]
pub fn rational_k0(k0: &Constant, precision: u32) -> Option<Rational> {
    let rounded = || Some(round_rational(&k0.enclose(precision).upper_rational()?, K0_DIGITS, Direction::Up));
    k0.as_rational().cloned().or_else(rounded)
}

/// a and b of a choice, as doubles: they steer the choice of k0 and decide nothing.
fn weights(data: &Data<'_>, choice: &PairChoice) -> (f64, f64) {
    match choice {
        PairChoice::Cheapest { a, b } => (a.to_f64(), b.to_f64()),
        PairChoice::SmallestK1(_) | PairChoice::ForData => {
            let zero = data.zero();
            let at_zero = |bound| data.bound(bound, &zero, &zero).midpoint_f64();
            let w = data.base_frequency.midpoint_f64();
            let (q, q_t) = (at_zero(Bound::QRms), at_zero(Bound::QtRms));
            if q > 0.0 || q_t > 0.0 { (q * q, (q_t / w).portable_powi(2)) } else { (1.0, 1.0) }
        }
    }
}

fn matched_pair(data: &Data<'_>, a: f64, b: f64) -> Option<MatchedPair> {
    let (k0, k1, first_of_tail) = TradeOff::matched(data).best(a, b);
    let up = |value: f64| round_f64(value * (1.0 + 1e-12), 8, Direction::Up);
    let (k0, k1) = (up(k0)?, up(k1)?);
    let proof = TransferProof::Matched { k: first_of_tail };
    decide(data, &k0, &k1, &proof).0.is_true().then_some(MatchedPair { k0, k1, first_of_tail })
}
