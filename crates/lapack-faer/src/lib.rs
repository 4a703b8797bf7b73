//! The eight BLAS and LAPACK routines that the conic solver Clarabel needs for its semidefinite
//! cone, in pure Rust on top of [`faer`].
//!
//! Clarabel calls `dgemm`, `dsyrk`, `dsyr2k`, `dpotrf`, `dpotrs`, `dsyevr`, `dgesdd` and `dgesvd`
//! through their Fortran names, and leaves it to the final binary to supply them. This crate does
//! so without a system package. A crate that calls Clarabel must name this one, or the linker
//! never sees the symbols:
//!
//! ```
//! extern crate lapack_faer as _;
//! ```
//!
//! The feature `symbols` (on by default) exports the Fortran names. With it off, the functions are
//! ordinary Rust items and nothing clashes with a real LAPACK linked elsewhere in the program.
//!
//! # What is promised
//!
//! Each routine has the semantics of its LAPACK namesake for every flag combination Clarabel uses,
//! and its own documentation lists the flags accepted. In particular:
//!
//! * Matrices are column major; a leading dimension may exceed the number of rows, and what lies
//!   between the columns is neither read nor written.
//! * A routine that takes `uplo` neither reads nor writes the other triangle.
//! * Flags are case insensitive; `'C'` (conjugate transpose) means `'T'`.
//! * Arguments are checked in LAPACK's order. `info = -i` means that argument `i` is illegal or
//!   asks for something not implemented here, and then no result is written.
//! * A workspace query (`lwork = -1`) writes the size into `work[0]`. The sizes are LAPACK's
//!   documented minima and smaller ones are refused, so that a caller which works here works with
//!   LAPACK; the workspace itself is not used, as faer brings its own.
//!
//! Three points are stricter than LAPACK, none of them weaker:
//!
//! * The decompositions refuse a matrix with a NaN or an infinity: `info` is minus the position of
//!   the matrix. LAPACK does this in `dgesdd` only, and for NaN only.
//! * The input matrix of a decomposition, and the matrix `dpotrf` fails on, stay as they were.
//! * Eigenvalues and singular values are computed after scaling by a power of two, so no scale of
//!   the input overflows or underflows on the way, and scaling the input by a power of two scales
//!   the values exactly (short of underflow or overflow in the results themselves).
//!
//! The three BLAS routines have no `info`. The reference BLAS stops the process on an illegal
//! argument. Here a line goes to standard error and the result is filled with NaN, because a NaN is
//! noticed downstream and a stale `C` is not. Only when the shape of `C` is itself illegal is
//! nothing written, as there is then no place known to be writable.
//!
//! No panic crosses the boundary. Should faer panic, the BLAS routines fill the result with NaN
//! and the LAPACK routines return a positive `info`.
//!
//! All computation is sequential, so on one machine the same input gives the same bits. faer picks
//! its kernels by the processor's vector width, so the bits may differ between machines.
//!
//! # Calling convention
//!
//! Integers are 32 bits wide (LP64), and Fortran's hidden string lengths are not expected.
//!
//! # Safety
//!
//! All functions share one contract, LAPACK's own:
//!
//! * Every scalar argument points to one readable value, and `info` and `m` to one writable one.
//! * A matrix argument of `r` rows, `c` columns and leading dimension `ld >= r` points to
//!   initialized memory that covers entry `(i, j)` at offset `i + j * ld` for all `i < r`,
//!   `j < c`. It is writable if the routine writes it.
//! * A vector argument points to memory of the documented length, under the same conditions.
//!   `work` and `iwork` have at least one element, even in a workspace query.
//! * An argument that is written overlaps no other argument.
//!
//! An empty matrix or vector may be any pointer, null included.

#![deny(unsafe_op_in_unsafe_fn)]
#![deny(missing_docs)]
#![cfg_attr(test, allow(clippy::disallowed_methods))]
#![deny(clippy::undocumented_unsafe_blocks)]
#![allow(clippy::too_many_arguments, reason = "the signatures are LAPACK's")]

mod args;
mod blas;
mod cholesky;
mod eigen;
mod scale;
mod svd;
mod views;

pub use blas::{dgemm_, dsyr2k_, dsyrk_};
pub use cholesky::{dpotrf_, dpotrs_};
pub use eigen::dsyevr_;
pub use svd::{dgesdd_, dgesvd_};
