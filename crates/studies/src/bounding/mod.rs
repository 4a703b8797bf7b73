//! From a plant's formulas to a bounding specification that can be read and edited (derivation, 11, and section 1).
//!
//! [`bounding_specification`] proves a polynomial in X and E for each bounding function on a domain, and writes the
//! specification. `fit` proposes the polynomials from sampled suprema, `prove` decides them, `document` writes.

mod document;
mod fit;
mod prove;
#[cfg(test)]
mod tests;

pub use document::{BoundedPlant, bounding_specification};
