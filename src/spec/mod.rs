//! The specification
pub mod model;
pub mod weights;
