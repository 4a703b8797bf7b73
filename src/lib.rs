//! scratch
pub mod constants;
pub mod enclosure;
pub mod expr;
pub mod number;
pub mod spec;
