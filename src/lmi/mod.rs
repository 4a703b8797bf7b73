//! Linear matrix inequalities: Clarabel proposes, exact rational arithmetic decides (derivation, sections 5 and 7).
//!
//! - [`affine`]: symmetric matrices affine in the decision variables, exact or in floating point;
//! - [`solve`]: a linear cost under such constraints, with fixed settings and an honest status;
//! - [`decay`]: the 6x6 matrix of C5, defined once, exactly, and decided exactly;
//! - `propose`: the smallest sigma and the multipliers of C5, well scaled, in floating point;
//! - [`level`]: the same together with the level condition C4, with the weights w_x, h free;
//! - [`ldl`]: exact definiteness of small matrices, and their leading minors;
//! - [`residual`]: definiteness of larger ones, exactly or within errors;
//! - [`perron`]: C3 with weights, and as a diagonal Stein inequality;
//! - `cross_check`: the matrix inequality against the closed form of C5 on a certificate.
//!
//! Nothing that comes out of the solver is a claim: it is rounded to rationals and verified, or dropped.

pub mod affine;
mod cross_check;
pub mod decay;
pub mod ldl;
pub mod level;
pub mod perron;
pub mod propose;
pub mod residual;
pub mod solve;

pub use cross_check::{AGREEMENT, CrossCheck, CrossCheckError, Figures, cross_check};
pub use decay::{DecayData, verify_decay};
pub use ldl::{is_positive_definite, leading_minors};
pub use level::{LevelData, WeightsProposal, propose_lyapunov_weights};
pub use propose::{DecayProposal, propose_multipliers, propose_sigma};
pub use residual::ScaledMatrix;
pub use solve::{Candidate, SolverFailure, margin, propose};
