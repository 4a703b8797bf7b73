//! Rates of convergence for given oscillators, the first n_o or those of a set of harmonics: they tend to 0 as n_o grows, while sigma* does not move.
//!
//! - [`oscillators`]: P_zeta of Lemma 1 of the paper (P:lemma:hurwitzPhiM);
//! - [`noise`]: what noise of the measurement and a disturbance do to the error, by the same inequality with inputs;
//! - [`control`]: what they do to the control;
//! - [`sampled`]: all of this for the law at samples;
//! - [`bound`]: from a rate to `|e - e_per| <= C exp(-rate (t - t_0))` on a set of starts, as a certificate has it;
//! - [`by_matrices`]: the same from what is proved of all first derivatives together, where a claim has no norms;
//! - [`found`]: all of it for some oscillators.
//!
//! The numbers are proposed by [`sigmastar_propose::rates`] and decided by [`sigmastar_decide::rates`]; here is the way from the ones to the others.

pub mod bound;
pub mod by_matrices;
pub mod control;
pub mod found;
pub mod noise;
pub mod oscillators;
pub mod sampled;
