//! Rates of convergence for a given number of oscillators: they tend to 0 as n_o grows, while sigma* does not move.
//!
//! - [`oscillators`]: P_zeta of Lemma 1 of the paper (P:lemma:hurwitzPhiM);
//! - [`small_gain`]: the largest rate that the inequality can prove, in floating point;
//! - [`riccati`]: the Lyapunov function for it, by a Riccati equation;
//! - [`noise`]: what noise of the measurement and a disturbance do to the error, by the same inequality with inputs;
//! - [`sampled`]: all of this for the law at samples;
//! - [`bound`]: from a rate to `|e - e_per| <= C exp(-rate (t - t_0))` on a set of starts, as a certificate has it;
//! - [`by_matrices`]: the same from what is proved of all first derivatives together, where a claim has no norms; within, `slopes_program` proposes what is to be known of the derivatives, `bounded_real` the Lyapunov function;
//! - [`found`]: all of it for one n_o.

pub mod bound;
mod bounded_real;
pub mod by_matrices;
mod descent;
pub mod found;
pub mod noise;
mod noise_search;
pub mod oscillators;
pub mod riccati;
pub mod sampled;
mod slopes_program;
pub mod small_gain;

#[cfg(test)]
mod inequality_tests;
