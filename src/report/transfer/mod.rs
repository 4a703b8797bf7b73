//! The transfer bound as a report: the certified pair, how much of it each n_o uses, and what the paper printed.

mod json;
mod plot;
mod printed;
mod sections;

pub use plot::plot_svg;

use super::Readable;
use super::blocks::{Block, clean};
use crate::data::{Bound, Data, Problem};
use crate::enclosure::Enclosure;
use crate::number::{Direction, round_rational};
use crate::spec::Specification;
use crate::spec::model::Constant;
use crate::transfer::{
    CertifiedPair, MAX_POLE_OSCILLATORS, OscillatorCount, PairError, SupRatio, TradeOff, TransferProof, cheapest_pair,
    decide, internal_model_poles, slowest_decay, smallest_k1, sup_ratios, trade_off_pairs,
};
use printed::PrintedVerdict;
use rayon::prelude::*;
use rug::Rational;
use serde_json::Value;

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

/// What is asked of a [`TransferReport`].
#[derive(Clone, Debug)]
pub struct TransferRequest {
    /// The pair.
    pub pair: PairChoice,
    /// The numbers of oscillators to look at.
    pub n_o: Vec<OscillatorCount>,
}

/// A pair for a matched base frequency.
#[derive(Clone, Debug)]
struct MatchedPair {
    k0: Rational,
    k1: Rational,
    first_of_tail: u32,
}

/// What is shown of one number of oscillators.
struct Row {
    ratio: SupRatio,
    /// The decay rate of the slowest mode of Phi - mu M M'N, where its poles are enclosed.
    decay: Option<Enclosure>,
}

/// The certified transfer bound of a specification.
pub struct TransferReport<'s> {
    data: Data<'s>,
    pair: CertifiedPair,
    rows: Vec<Row>,
    trade_off: Vec<CertifiedPair>,
    matched: Option<MatchedPair>,
    printed: PrintedVerdict,
}

impl<'s> TransferReport<'s> {
    /// Finds and proves the pair, and all that is shown with it; `done` is called after each n_o.
    ///
    /// Guarantee: every pair, ratio and comparison in the report is proved; what is only an estimate says so.
    ///
    /// # Errors
    /// There is no certified pair.
    pub fn new(
        spec: &'s Specification,
        precision: u32,
        request: &TransferRequest,
        done: impl Fn() + Sync,
    ) -> Result<TransferReport<'s>, PairError> {
        let data = Data::new(spec, precision);
        let (a, b) = weights(&data, &request.pair);
        let pair = match &request.pair {
            PairChoice::SmallestK1(k0) => {
                let exact = k0.as_rational().cloned();
                let rounded = || {
                    let upper = k0.enclose(precision).upper_rational()?;
                    Some(round_rational(&upper, K0_DIGITS, Direction::Up))
                };
                smallest_k1(&data, &exact.or_else(rounded).unwrap_or_default())?
            }
            PairChoice::Cheapest { .. } | PairChoice::ForData => cheapest_pair(&data, a, b)?,
        };
        let decay = |n_o| match n_o {
            OscillatorCount::Finite(n) if n <= MAX_POLE_OSCILLATORS => {
                internal_model_poles(&data, n).ok().map(|poles| slowest_decay(&data, &poles))
            }
            _ => None,
        };
        let rows = sup_ratios(&data, &pair.k0, &pair.k1, &request.n_o, done)
            .into_par_iter()
            .map(|ratio| Row { decay: decay(ratio.n_o), ratio })
            .collect();
        let trade_off = trade_off_pairs(&data, TRADE_OFF_PAIRS);
        let matched = if spec.internal_model.matched { matched_pair(&data, a, b) } else { None };
        let printed = PrintedVerdict::new(&data);
        Ok(TransferReport { data, pair, rows, trade_off, matched, printed })
    }

    /// T_N under the envelope as an SVG picture, for the n_o of the table.
    ///
    /// # Errors
    /// The plotting library's reason, as text.
    pub fn plot(&self) -> Result<String, String> {
        let counts: Vec<OscillatorCount> = self.rows.iter().map(|row| row.ratio.n_o).collect();
        plot_svg(&self.data, &self.pair, &counts)
    }
}

impl Readable for TransferReport<'_> {
    fn blocks(&self) -> Vec<Block> {
        let name = clean(&self.data.spec.name);
        let mut blocks = vec![Block::Title(format!("{name}: transfer bound"))];
        blocks.extend(sections::pair(&self.data, &self.pair));
        blocks.extend(sections::uniformity(&self.rows));
        blocks.extend(sections::trade_off(&self.data, &self.trade_off));
        blocks.extend(self.matched.iter().flat_map(|matched| sections::matched(&self.data, matched)));
        blocks.extend(self.printed.section(&self.data, &self.pair));
        blocks
    }

    /// As JSON.
    fn json(&self) -> Value {
        json::report(self)
    }
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
            if q > 0.0 || q_t > 0.0 { (q * q, (q_t / w).powi(2)) } else { (1.0, 1.0) }
        }
    }
}

fn matched_pair(data: &Data<'_>, a: f64, b: f64) -> Option<MatchedPair> {
    let (k0, k1, first_of_tail) = TradeOff::matched(data).best(a, b);
    let up = |value: f64| crate::number::round_f64(value * (1.0 + 1e-12), 8, Direction::Up);
    let (k0, k1) = (up(k0)?, up(k1)?);
    let proof = TransferProof::Matched { k: first_of_tail };
    decide(data, &k0, &k1, &proof).0.is_true().then_some(MatchedPair { k0, k1, first_of_tail })
}
