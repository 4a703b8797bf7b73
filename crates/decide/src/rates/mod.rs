//! What proves a rate of convergence for given oscillators, the first n_o or those of a set of harmonics (derivation, 13.6).
//!
//! - [`oscillators`]: `Phi - mu M M'N`, enclosed;
//! - [`inequality`]: the matrix inequality that proves a rate of the closed loop, for any quadratic Lyapunov function;
//! - [`matrix_loop`]: the same inequality where all first derivatives of a plant are known to lie in a ball;
//! - [`at_samples`]: the matrix inequality that proves a decay from sample to sample.

pub mod at_samples;
pub mod inequality;
pub mod matrix_loop;
pub mod oscillators;

pub use oscillators::OscillatorMatrix;
