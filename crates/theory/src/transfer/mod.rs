//! The transfer bound T_N(x) <= k0 + k1 x^2, uniform in the number of oscillators N (derivation, section 2).
//!
//! `v -> zeta` of zeta' = (Phi - mu M M'N) zeta - M v satisfies zeta* N zeta = (1/w^2) T_N(omega/w) |v|^2 with
//! T_N = g_N' / (1 + nu^2 g_N^2), nu = mu/w. A pair (k0, k1) is *admissible* when T_N(x) <= k0 + k1 x^2 for every N
//! and every x that occurs: every x >= 0, or only the integers when the base frequency is exactly 2 pi / T.

mod boxes;
mod closed_form;
mod complex;
mod cover;
mod curve;
mod euler_maclaurin;
mod every_set;
mod float_sums;
mod graph;
mod inverse_powers;
mod lorentz;
mod matched;
mod pair;
mod pole_sums;
mod poles;
mod printed;
mod set_boxes;
mod set_pair;
mod set_sums;
mod study;
mod uniformity;
#[cfg(test)]
pub(crate) mod weights_only;

pub use boxes::{BoxProof, MAX_BOXES, MAX_N0};
pub use closed_form::closed_form_pair;
pub use complex::Complex;
pub use every_set::serves_every_set;
pub use graph::transfer_graph;
pub use matched::{MatchedProof, TradeOff};
pub use pair::{
    BindingPoint, CertifiedPair, PairCounterexample, PairError, PairStatus, cheapest_pair, pair_status, prove_above,
    smallest_k1, trade_off_pairs,
};
pub use pole_sums::{AroundPole, MAX_DIRECT_POLES, MAX_PIECES, OscillatorCount, PoleSums};
pub use poles::{MAX_POLE_OSCILLATORS, PoleDisc, PolesError, internal_model_poles, slowest_decay};
pub use printed::{PrintedCheck, PrintedChecks, PrintedTransfer, lambda_interval, printed_transfer};
pub use set_boxes::SetBoxProof;
pub use set_pair::{SetPair, smallest_k1_for_every_set};
pub use study::{ForEverySet, MatchedPair, PairChoice, TransferStudy, Uniformity, rational_k0};
pub use uniformity::{SupRatio, sup_ratios};

use crate::condition::Condition;
use crate::data::Data;
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, Truth};

/// How a pair (k0, k1) is proved admissible.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TransferProof {
    /// It dominates the closed-form constants of derivation section 2; valid for every x >= 0.
    ClosedForm,
    /// Integers only: harmonics below K one by one, the others by one inequality. Needs base_frequency = 2 pi / T.
    Matched {
        /// The first harmonic covered by the tail inequality.
        k: u32,
    },
    /// Boxes over x in [0, m0 - 1/2] and a scalar test beyond; valid for every x >= 0.
    Boxes(BoxProof),
}

impl TransferProof {
    /// The name in certificates.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            TransferProof::ClosedForm => "closed-form",
            TransferProof::Matched { .. } => "matched",
            TransferProof::Boxes(_) => "boxes",
        }
    }
}

/// Decides whether (k0, k1) is admissible by the given proof; with it, as condition T, the comparison that decides (the first that
/// is not proved, or the tightest).
///
/// Guarantee: `True` means T_N(x) <= k0 + k1 x^2 for every N >= 0, at every x >= 0 (`ClosedForm`, `Boxes`) or every integer
/// x >= 0 (`Matched`); where the document asks for every set of harmonics, for each of these, too. `False` means that this proof refutes itself, not that the pair is inadmissible.
#[must_use]
pub fn decide(data: &Data<'_>, k0: &Rational, k1: &Rational, proof: &TransferProof) -> (Truth, Condition) {
    if data.spec.internal_model.asks_every_set() && !serves_every_set(data, proof) {
        let what = format!("transfer bound, {}: a proof that serves every set of harmonics (14.7)", proof.name());
        // Boxes are about n_o. That (14.7b) is not proved refutes nothing.
        let (truth, rhs) = match proof {
            TransferProof::Boxes(_) => (Truth::False, data.zero()),
            TransferProof::ClosedForm | TransferProof::Matched { .. } => {
                (Truth::Undecided, Enclosure::between(&Rational::new(), &Rational::from(2), data.precision))
            }
        };
        return (truth, Condition::at_most("T", what, Enclosure::one(data.precision), rhs));
    }
    let (truth, step) = match proof {
        TransferProof::ClosedForm => closed_form::decide(data, k0, k1),
        TransferProof::Matched { k } => MatchedProof { first_of_tail: *k }.decide(data, k0, k1),
        TransferProof::Boxes(proof) => proof.decide(data, k0, k1),
    };
    (truth, Condition { what: format!("transfer bound, {}: {}", proof.name(), step.what), ..step })
}

/// Decides a list of comparisons: the truth of their conjunction, with the first one that is not proved or, if all are,
/// the one with the smallest relative margin (which is only shown).
pub fn decide_steps(steps: impl IntoIterator<Item = Condition>, otherwise: Condition) -> (Truth, Condition) {
    let mut tightest = (otherwise.relative_margin(), otherwise);
    for step in steps {
        let truth = step.truth();
        if !truth.is_true() {
            return (truth, step);
        }
        let margin = step.relative_margin();
        if margin < tightest.0 {
            tightest = (margin, step);
        }
    }
    (Truth::True, tightest.1)
}
