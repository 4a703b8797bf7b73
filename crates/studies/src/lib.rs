//! What is asked beside one claim: polynomials above a plant's bounds, the design table, pairs of a gain and a sampling period, parameter studies, and values of
//! the free numbers that are better. Each claim among the results is a certification by itself.

#![deny(missing_docs)]
// What tests compare with need not be the same on every machine.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

pub mod bounding;
pub mod design;
pub mod sampling;
pub mod sweep;
pub mod tune;
