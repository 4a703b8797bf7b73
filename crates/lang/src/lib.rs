//! What is read: expressions, specifications, plants by their formulas.

#![deny(missing_docs)]
// What tests compare with need not be the same on every machine.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

pub mod expr;
pub mod plant;
pub mod spec;
