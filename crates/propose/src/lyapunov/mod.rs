//! P(t) for a Jacobian F(t), in floating point (derivation, 11.2).
//!
//! - `float`: the matrices F(t) in doubles, Floquet exponents, what P gives at sampled times;
//! - `propose`: P(t) by semidefinite programs, and by the periodic Lyapunov equation;
//! - `candidates`: candidates from the largest rate down to the smallest ratio p_up/p_low.

mod candidates;
mod float;
mod propose;

pub use candidates::{
    Candidate, Candidates, LyapunovFailure, MAX_PROGRAM_COST, candidates, candidates_of, floquet_exponents,
};
pub use propose::decay_entry;
