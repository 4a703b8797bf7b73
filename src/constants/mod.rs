//! Constants of a certificate.

pub mod relative_degree;
