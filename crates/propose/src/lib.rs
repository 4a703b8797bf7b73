//! What floating point proposes of a plant's formulas: its periodic orbit, coordinates, metrics, suprema over samples. Nothing is claimed by
//! it, and no verdict rests on it.

#![deny(missing_docs)]
// What tests compare with need not be the same on every machine.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

pub mod bounds;
pub mod linear_peak;
pub mod lyapunov;
pub mod orbit;
pub mod search;
pub mod semidefinite;
