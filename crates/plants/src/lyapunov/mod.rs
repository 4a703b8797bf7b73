//! P_x(t) and the triple (p_low, p_up, alpha) for a Jacobian F(t): proposed in floating point, proved for every t.
//!
//! - `family`: the matrices F(t) that the specification describes, enclosed;
//! - `float`: the same in floating point, Floquet exponents, what P gives at sampled times;
//! - `propose`: P(t) by semidefinite programs, and by the periodic Lyapunov equation;
//! - `prove`: the two inequalities for a rational P(t), for every t and every member of the family;
//! - `candidates`: candidates from the largest rate down to the smallest ratio p_up/p_low.

mod candidates;
mod family;
mod float;
mod propose;
mod prove;

pub use candidates::{
    Candidate, Candidates, LyapunovFailure, MAX_PROGRAM_COST, candidates, candidates_of, floquet_exponents,
};
pub use family::{Deviation, Family};
pub(crate) use propose::decay_entry;
pub use prove::{NotProved, ProvedTriple, ProvedTriples, prove, prove_bounds};
