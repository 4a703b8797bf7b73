//! Each routine against a naive version of its definition, on matrices with guard cells.

#![allow(clippy::disallowed_methods, reason = "what is compared need not be the same on every machine")]

extern crate lapack_faer as _;

mod blas;
mod cholesky;
mod common;
mod eigen;
mod svd;
