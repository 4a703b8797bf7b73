//! The conditions of a claim as linear matrix inequalities: the solver proposes, exact rational arithmetic decides
//! (derivation, sections 5 and 7).
//!
//! - [`decay`]: the 6x6 matrix of C5, defined once, exactly, and decided exactly;
//! - `propose`: the smallest sigma and the multipliers of C5, well scaled, in floating point;
//! - [`level`]: the same together with the level condition C4, with the weights w_x, h free;
//! - [`contraction`]: C3 with weights, and as a diagonal Stein inequality;
//! - `cross_check`: the matrix inequality against the closed form of C5 on a certificate.
//!
//! Nothing that comes out of the solver is a claim: it is rounded to rationals and verified, or dropped.

pub mod contraction;
mod cross_check;
pub mod decay;
pub mod level;
pub mod propose;

pub use cross_check::{AGREEMENT, CrossCheck, CrossCheckError, SigmaBothWays, cross_check};
pub use decay::{DecayData, verify_decay};
pub use level::{LevelData, WeightsProposal, propose_lyapunov_weights};
pub use propose::{DecayProposal, propose_multipliers, propose_sigma, two_sided_threshold};
