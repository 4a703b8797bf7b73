//! What is asked beside one claim: polynomials above a plant's bounds, rates of convergence, pairs of a gain and a sampling period.

#![deny(missing_docs)]
// What tests compare with need not be the same on every machine.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

pub mod bounding;
pub mod sampling;
