//! Exact numbers, enclosures over MPFR, and what they and doubles have in common.

#![deny(missing_docs)]
// What tests compare with need not be the same on every machine.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

pub mod enclosure;
pub mod number;
pub mod parallel;
pub mod real;
pub mod removable;
