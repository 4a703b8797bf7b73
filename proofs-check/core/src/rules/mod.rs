//! The rules, one a file.
pub mod bounding;
pub mod claim;
pub mod common;
pub mod derivation;
pub mod existence;
pub mod gains;
pub mod inequality;
pub mod joint;
pub mod mean_squares;
pub mod metric;
pub mod paths;
pub mod regulation;
pub mod sampled;
pub mod set;
pub mod sharp;
pub mod stability;
pub mod transfer;
