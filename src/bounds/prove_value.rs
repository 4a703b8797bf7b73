//! From a sampled supremum to a decided bound a little above it.

use super::engine::Engine;
use super::entry::{Entry, Kind};
use super::suprema::FloatSuprema;
use crate::number::{Direction, round_f64};
use rug::Rational;

/// What a sampled supremum is enlarged by, until a bound is proved, and the boxes that each attempt may take.
const ATTEMPTS: [(f64, usize); 6] =
    [(0.001, 1500), (0.003, 3000), (0.01, 4000), (0.03, 6000), (0.1, 6000), (0.3, 20_000)];

/// The same from three states on: another program, which may need some ten times as many boxes, is to decide the value again.
const MODEST_ATTEMPTS: [(f64, usize); 6] =
    [(0.001, 100), (0.003, 200), (0.01, 400), (0.03, 800), (0.1, 2000), (0.3, 20_000)];

/// Digits of a value, beyond those that its slack takes.
const DIGITS: u32 = 6;

/// What an attempt adds at least, relative to the spread of the local rates over the region: a rate may be near 0.
const PART_OF_SPREAD: f64 = 0.1;

/// A bound with its proof done.
#[derive(Clone, Debug, PartialEq)]
pub struct ProvedValue {
    /// The value, which [`Engine::decide`] has found true.
    pub value: Rational,
    /// How far it lies from the sampled supremum, relative to it.
    pub slack: f64,
    /// The boxes of the proof.
    pub boxes: usize,
}

impl Engine {
    /// A bound for `G(X,E)` that is proved and little larger than the sampled supremum (little less for a rate): by 0.1 %,
    /// 0.3 %, 1 %, 3 %, 10 % or 30 %. `None` if none of these is proved. `samples` must be of the same plant and region.
    #[must_use]
    pub fn prove_value(&self, samples: &FloatSuprema, kind: Kind, x: &Rational, e: &Rational) -> Option<ProvedValue> {
        let reach = Rational::from(x + self.region.radius()).to_f64();
        let sampled = samples.refined(kind, reach, e.to_f64());
        if !sampled.value.is_finite() {
            return None;
        }
        let size = match kind.is_rate() {
            true => sampled.value.abs().max(PART_OF_SPREAD * sampled.spread),
            false => sampled.value.abs(),
        };
        for (slack, effort) in if self.states() > 2 { MODEST_ATTEMPTS } else { ATTEMPTS } {
            let (moved, direction) = match kind.is_rate() {
                true => (sampled.value - slack * size, Direction::Down),
                false => (sampled.value + slack * size, Direction::Up),
            };
            let value = round_f64(moved, DIGITS, direction)?;
            let decision =
                self.decide(&Entry { bound: kind, x: x.clone(), e: e.clone(), value: value.clone() }, effort);
            if decision.truth.is_true() {
                return Some(ProvedValue { value, slack, boxes: decision.boxes });
            }
        }
        None
    }
}
