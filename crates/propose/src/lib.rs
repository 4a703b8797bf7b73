//! What floating point proposes: of a plant's formulas the periodic orbit, coordinates, metrics and suprema over samples; the free numbers of a
//! claim; and quadratic functions for rates and noise. Nothing is claimed by it, and no verdict rests on it.

#![deny(missing_docs)]
// What tests compare with need not be the same on every machine.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

pub mod bounds;
pub mod lyapunov;
pub mod orbit;
pub mod rates;
pub mod search;
pub mod semidefinite;
pub mod trial;
