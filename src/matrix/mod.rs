//! Symmetric matrices and their definiteness, exactly or within enclosures; exact inverses.
//!
//! - [`symmetric`]: one triangle, stored;
//! - [`inverse()`]: of rational matrices, exactly;
//! - [`affine`]: matrices that are affine in decision variables, exact or in floating point;
//! - [`ldl`]: exact definiteness of small matrices, and their leading minors;
//! - [`residual`]: definiteness of larger ones, exactly or within errors.

pub mod affine;
mod inverse;
pub mod ldl;
pub mod residual;
pub mod symmetric;

pub use affine::AffineMatrix;
pub use inverse::inverse;
pub use ldl::{is_positive_definite, leading_minors};
pub use residual::ScaledMatrix;
pub use symmetric::Symmetric;
