//! From what is read to a claim: the search, the decision, the certificate.

#![deny(missing_docs)]
// What tests compare with need not be the same on every machine.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

pub mod attempt;
pub mod certificate;
pub mod certify;
pub mod lmi;
pub mod rate;
pub mod reduction;
