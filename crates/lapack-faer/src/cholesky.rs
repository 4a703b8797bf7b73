//! Cholesky factorization and the solve that follows it: `dpotrf`, `dpotrs`.

use crate::args::{Checked, Uplo, contain, dim, leading, uplo};
use crate::views::{matrix, matrix_mut};
use core::ffi::{c_char, c_int};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltError, LltRegularization, cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::cholesky::llt::solve::{solve_in_place, solve_in_place_scratch};
use faer::prelude::*;
use faer::{Mat, MatMut, MatRef, Par};

/// Replaces the lower triangle of `a` by its Cholesky factor; on failure gives the one-based index
/// of the first pivot that is not positive and leaves `a` as it was.
///
/// faer uses the other triangle of its argument as scratch space, and LAPACK must leave it alone:
/// Clarabel multiplies by the factor as a full matrix and relies on the zeros above the diagonal.
/// So the factorization runs in a copy.
fn factor(mut a: MatMut<'_, f64>) -> Result<(), usize> {
    let n = a.nrows();
    let mut l = Mat::zeros(n, n);
    l.copy_from_triangular_lower(a.rb());
    let scratch = cholesky_in_place_scratch::<f64>(n, Par::Seq, Default::default());
    cholesky_in_place(
        l.as_mut(),
        LltRegularization::default(),
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(scratch)),
        Default::default(),
    )
    .map_err(|LltError::NonPositivePivot { index }| index + 1)?;
    a.copy_from_triangular_lower(&l);
    Ok(())
}

/// `B := (L * L^T)^-1 * B`; only the lower triangle of `l` is read.
fn solve(l: MatRef<'_, f64>, b: MatMut<'_, f64>) {
    let scratch = solve_in_place_scratch::<f64>(l.nrows(), b.ncols(), Par::Seq);
    solve_in_place(l, b, Par::Seq, MemStack::new(&mut MemBuffer::new(scratch)));
}

/// The Cholesky factorization `A = L * L^T` (`uplo = 'L'`) or `A = U^T * U` (`uplo = 'U'`) of an
/// `n` x `n` symmetric matrix, of which one triangle is given and replaced by the factor.
///
/// The other triangle is neither read nor written.
///
/// `info = i > 0`: the `i`-th pivot is not a finite positive number, so the leading minor of order
/// `i` is not positive definite (or overflows, or holds a NaN); `A` is as it was. Should the
/// factorization panic, `info = n + 1`.
///
/// # Safety
///
/// The contract in the crate documentation.
#[cfg_attr(feature = "symbols", unsafe(no_mangle))]
pub unsafe extern "C" fn dpotrf_(
    uplo: *const c_char,
    n: *const c_int,
    a: *mut f64,
    lda: *const c_int,
    info: *mut c_int,
) {
    // SAFETY: scalars are readable by contract.
    let (triangle, order, lda) = unsafe { (*uplo, *n, *lda) };
    let check = || {
        let triangle = self::uplo(triangle, 1)?;
        let n = dim(order, 2)?;
        Checked::Ok((triangle, n, leading(lda, n, 4)?))
    };
    let outcome = match check() {
        Ok((triangle, n, lda)) => {
            // SAFETY: the shape is checked and the matrix is the caller's promise.
            let a = unsafe { matrix_mut(a, n, n, lda) };
            let a = match triangle {
                Uplo::Lower => a,
                // The lower triangle of A^T is the upper one of A, and its factor is U^T.
                Uplo::Upper => a.transpose_mut(),
            };
            match contain(|| factor(a)) {
                Some(Ok(())) => 0,
                // The index is at most `order`, so it fits.
                Some(Err(index)) => index as c_int,
                None => order.saturating_add(1),
            }
        }
        Err(info) => info,
    };
    // SAFETY: `info` is writable by contract.
    unsafe { *info = outcome };
}

/// Solves `A * X = B` for `nrhs` right-hand sides, given the factor of `A` from [`dpotrf_`] with
/// the same `uplo`; `X` replaces `B`.
///
/// The triangle of `A` that does not hold the factor is not read. Should the solve panic,
/// `info = 1`, and `B` is unspecified.
///
/// # Safety
///
/// The contract in the crate documentation.
#[cfg_attr(feature = "symbols", unsafe(no_mangle))]
pub unsafe extern "C" fn dpotrs_(
    uplo: *const c_char,
    n: *const c_int,
    nrhs: *const c_int,
    a: *const f64,
    lda: *const c_int,
    b: *mut f64,
    ldb: *const c_int,
    info: *mut c_int,
) {
    // SAFETY: scalars are readable by contract.
    let (triangle, n, nrhs, lda, ldb) = unsafe { (*uplo, *n, *nrhs, *lda, *ldb) };
    let check = || {
        let triangle = self::uplo(triangle, 1)?;
        let (n, nrhs) = (dim(n, 2)?, dim(nrhs, 3)?);
        let (lda, ldb) = (leading(lda, n, 5)?, leading(ldb, n, 7)?);
        Checked::Ok((triangle, n, nrhs, lda, ldb))
    };
    let outcome = match check() {
        Ok((triangle, n, nrhs, lda, ldb)) => {
            // SAFETY: the shapes are checked and the matrices are the caller's promise.
            let (a, b) = unsafe { (matrix(a, n, n, lda), matrix_mut(b, n, nrhs, ldb)) };
            let l = match triangle {
                Uplo::Lower => a,
                Uplo::Upper => a.transpose(),
            };
            match contain(|| solve(l, b)) {
                Some(()) => 0,
                None => 1,
            }
        }
        Err(info) => info,
    };
    // SAFETY: `info` is writable by contract.
    unsafe { *info = outcome };
}
