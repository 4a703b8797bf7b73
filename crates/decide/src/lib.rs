//! What enclosures decide of a plant's formulas: its periodic orbit, its Lyapunov function, bounds on a tube; the conditions of a claim.
//! A verdict follows from its exact arguments alone; this crate cannot name the crate that proposes them.

#![deny(missing_docs)]
// What tests compare with need not be the same on every machine.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

pub mod bounds;
pub mod conditions;
pub mod linear;
pub mod lyapunov;
pub mod orbit;
pub mod rates;
pub mod trial;
