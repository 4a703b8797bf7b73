//! scratch
pub mod enclosure;
pub mod number;
