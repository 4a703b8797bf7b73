//! The paper's museum: what is wrong in print, with evidence, and its tables and figures computed again.

#![deny(missing_docs)]
// What tests compare with need not be the same on every machine.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

pub mod errata;
pub mod reproduce;
