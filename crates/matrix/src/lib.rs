//! Symmetric matrices and their definiteness, exactly or within enclosures; exact inverses.
//!
//! - [`symmetric`]: one triangle, stored;
//! - [`inverse()`]: of rational matrices, exactly;
//! - [`affine`]: matrices that are affine in decision variables, exact or in floating point;
//! - [`ldl`]: exact definiteness of small matrices, and their leading minors;
//! - [`residual`]: definiteness of larger ones, exactly or within errors;
//! - [`doubles`]: eigenvalues and products of small matrices in floating point, which propose.

#![deny(missing_docs)]
// What tests compare with need not be the same on every machine.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

pub mod affine;
pub mod doubles;
mod inverse;
pub mod ldl;
pub mod residual;
pub mod symmetric;

pub use affine::AffineMatrix;
pub use inverse::inverse;
pub use ldl::{is_positive_definite, is_symmetric, leading_minors};
pub use residual::ScaledMatrix;
pub use symmetric::Symmetric;
