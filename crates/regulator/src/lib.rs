//! The regulator that a certificate speaks of: its matrices, the law for computers, and the forms both are exported in.
//!
//! With n_o oscillators, gains sigma and mu, weights n_0, n_1, ... and base frequency w (derivation, section 1):
//! z' = Phi z + Gamma e, u = -sigma e + mu M'N(z - M e), with Phi = blkdiag(0, l w [[0, 1], [-1, 0]]),
//! Gamma = -(Phi + sigma I) M, M = (1, 1, 0, 1, 0, ...), N = blkdiag(n_0, n_l I_2), l = 1, ..., n_o.
//!
//! Nothing here is searched or decided: every number is an exact number of the specification, rounded once.

#![deny(missing_docs)]
#![cfg_attr(test, allow(clippy::disallowed_methods))]

mod design;
mod discrete;
pub mod export;
mod law;
mod read;
mod read_discrete;
mod sampled;
mod sampling;

pub use design::{Design, MAX_EXPORTED_OSCILLATORS};
pub use discrete::{Discrete, Stepper};
pub use law::{Regulator, WrongDimension};
pub use read::read_regulator;
pub use read_discrete::read_discrete;
pub use sampled::{Convergence, spectral_radius};
pub use sampling::SamplingError;
