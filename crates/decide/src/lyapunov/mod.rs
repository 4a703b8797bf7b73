//! The triple (p_low, p_up, alpha) of a rational P(t) for every matrix of a Jacobian F(t), decided for every t (derivation, 11.2).

mod prove;

pub use prove::{NotProved, prove, prove_bounds};
