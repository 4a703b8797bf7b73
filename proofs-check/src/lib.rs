//! The independent checker of certificates.
//!
//! This crate is a placeholder: it has no rules yet and decides nothing. It will share no line with `sigmastar`.
