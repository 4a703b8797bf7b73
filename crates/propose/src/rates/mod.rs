//! What floating point proposes for the rate of a loop with a given number of oscillators, and for what noise does there (derivation, 13.6).
//! What it proposes is rounded and decided elsewhere, by the forms of [`sigmastar_decide::rates`]; nothing rests on it.
//!
//! - [`Condition`]: the largest rate that can be proved, and Pi for a share of it; [`SmallGain`] in continuous time, by a Riccati equation
//!   (`riccati`), and [`SampledCondition`] at samples, by a discrete one (`sampled_riccati`);
//! - [`NoiseProposal`]: Pi for the bounds under noise; [`noise_search`] in continuous time and [`sampled_noise_search`] at samples, with `least`
//!   for where such a bound is about least;
//! - [`SampledSlopes`], [`BoundedReal`]: balls of the first derivatives, and Pi for the loops within them;
//! - [`oscillators`]: P_zeta of Lemma 1 of the paper.

mod bounded_real;
mod diagonal;
mod least;
mod least_factor;
pub mod noise_search;
pub mod oscillators;
mod proposal;
mod riccati;
mod sampled_condition;
pub mod sampled_noise_search;
mod sampled_riccati;
mod slopes_program;
mod small_gain;

pub use bounded_real::{BoundedReal, OfStates};
pub use diagonal::largest_square;
pub use proposal::{Condition, Limit, NoiseProposal, Numbers, Proposal};
pub use sampled_condition::{SampledCondition, SampledNumbers};
pub use slopes_program::SampledSlopes;
pub use small_gain::{RateNumbers, SmallGain};

#[cfg(test)]
mod inequality_tests;
