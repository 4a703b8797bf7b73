//! Many claims: parameter studies, and values of the free numbers that are better.

#![deny(missing_docs)]
// What tests compare with need not be the same on every machine.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

pub mod sweep;
pub mod tune;
