//! The laboratory, in floating point and without a claim: simulations, and attempts to break a certificate.

#![deny(missing_docs)]
// What tests compare with need not be the same on every machine.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

pub mod falsify;
pub mod simulate;
