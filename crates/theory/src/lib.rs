//! The paper's constants and conditions, printed, repaired and sharp, and the transfer bound; what proofs leave behind, as data.

#![deny(missing_docs)]
// What tests compare with need not be the same on every machine.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

pub mod condition;
pub mod data;
pub mod derivation;
pub mod evidence;
pub mod input_gain;
pub mod jacobian;
pub mod transfer;
mod undefined;

pub use undefined::{Undefined, instead, otherwise, undefined_along};
