//! The rules, one a file.
pub mod claim;
pub mod derivation;
pub mod existence;
pub mod lmi;
pub mod lyapunov;
pub mod regulation;
pub mod repaired;
pub mod set;
pub mod sharp;
pub mod stability;
pub mod transfer;
