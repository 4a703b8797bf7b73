//! The transfer bound T_N(x) <= k0 + k1 x^2, uniform in the number of oscillators N (derivation, section 2).
//!
//! `v -> zeta` of zeta' = (Phi - mu M M'N) zeta - M v satisfies zeta* N zeta = (1/w^2) T_N(omega/w) |v|^2 with
//! T_N = g_N' / (1 + nu^2 g_N^2), nu = mu/w. A pair (k0, k1) is *admissible* when T_N(x) <= k0 + k1 x^2 for every N
//! and every x that occurs: every x >= 0, or only the integers when the base frequency is exactly 2 pi / T.

mod closed_form;
mod matched;
mod printed;

pub use closed_form::closed_form_pair;
pub use matched::{MatchedProof, TradeOff};
pub use printed::{PrintedTransfer, lambda_interval, printed_transfer};

use crate::constants::data::Data;
use crate::enclosure::{Enclosure, Truth};
use rug::Rational;

/// How a pair (k0, k1) is proved admissible.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TransferProof {
    /// It dominates the closed-form constants of derivation section 2; valid for every x >= 0.
    ClosedForm,
    /// Integers only: harmonics below K one by one, the others by one inequality. Needs base_frequency = 2 pi / T.
    Matched {
        /// The first harmonic covered by the tail inequality.
        k: u32,
    },
}

impl TransferProof {
    /// The name in certificates.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            TransferProof::ClosedForm => "closed-form",
            TransferProof::Matched { .. } => "matched",
        }
    }
}

/// One comparison of a transfer proof: `lhs <= rhs`.
#[derive(Clone, Debug)]
pub struct TransferStep {
    /// What is compared, in words.
    pub what: String,
    /// The left side.
    pub lhs: Enclosure,
    /// The right side.
    pub rhs: Enclosure,
}

/// Decides whether (k0, k1) is admissible by the given proof; with it, the comparison that decides (the first that
/// is not proved, or the last).
///
/// Guarantee: `True` means T_N(x) <= k0 + k1 x^2 for every N >= 0, at every x >= 0 (`ClosedForm`) or every integer
/// x >= 0 (`Matched`). `False` means that this proof refutes itself, not that the pair is inadmissible.
#[must_use]
pub fn decide(data: &Data<'_>, k0: &Rational, k1: &Rational, proof: TransferProof) -> (Truth, TransferStep) {
    match proof {
        TransferProof::ClosedForm => closed_form::decide(data, k0, k1),
        TransferProof::Matched { k } => MatchedProof { first_of_tail: k }.decide(data, k0, k1),
    }
}

/// Decides a list of comparisons in order: the truth of their conjunction, and the step that decides it.
fn decide_steps(steps: impl IntoIterator<Item = TransferStep>, otherwise: TransferStep) -> (Truth, TransferStep) {
    let mut last = otherwise;
    for step in steps {
        let truth = step.lhs.le(&step.rhs);
        if !truth.is_true() {
            return (truth, step);
        }
        last = step;
    }
    (Truth::True, last)
}
