//! Each routine against a naive version of its definition, on matrices with guard cells.

extern crate lapack_faer as _;

mod blas;
mod cholesky;
mod common;
mod eigen;
mod svd;
