//! Singular values: `dgesdd` and `dgesvd`, which differ here in their arguments only.

use crate::args::{Checked, contain, dim, leading, only, workspace};
use crate::scale::Scale;
use crate::views::{matrix, matrix_mut, vector_mut};
use core::ffi::{c_char, c_int};
use faer::diag::DiagMut;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::svd::{ComputeSvdVectors, svd, svd_scratch};
use faer::{Mat, MatMut, MatRef, Par};

/// Why there is no decomposition.
enum Failure {
    NotFinite,
    NoConvergence,
}

/// The thin decomposition `A = U * diag(s) * VT`, singular values descending.
fn decompose(a: MatRef<'_, f64>, s: &mut [f64], u: MatMut<'_, f64>, vt: MatMut<'_, f64>) -> Result<(), Failure> {
    let (m, n) = a.shape();
    let entries = (0..n).flat_map(|j| (0..m).map(move |i| a[(i, j)]));
    let scale = Scale::of(entries).ok_or(Failure::NotFinite)?;
    let scaled = Mat::from_fn(m, n, |i, j| a[(i, j)] * scale.down);
    let thin = ComputeSvdVectors::Thin;
    let scratch = svd_scratch::<f64>(m, n, thin, thin, Par::Seq, Default::default());
    svd(
        scaled.as_ref(),
        DiagMut::from_slice_mut(s),
        Some(u),
        Some(vt.transpose_mut()),
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(scratch)),
        Default::default(),
    )
    .map_err(|_| Failure::NoConvergence)?;
    for value in s {
        *value *= scale.up;
    }
    Ok(())
}

/// The matrix arguments of both routines.
struct Matrices {
    a: *const f64,
    s: *mut f64,
    u: *mut f64,
    vt: *mut f64,
}

/// Their checked shapes.
struct Shapes {
    m: usize,
    n: usize,
    lda: usize,
    ldu: usize,
    ldvt: usize,
}

/// Runs the decomposition and gives the `info`, where `A` is argument `position`.
///
/// # Safety
///
/// The pointers are matrix and vector arguments of these shapes, see the contract of the crate.
unsafe fn run(matrices: Matrices, shapes: Shapes, position: c_int) -> c_int {
    let Shapes { m, n, lda, ldu, ldvt } = shapes;
    let k = m.min(n);
    // SAFETY: the leading dimensions are checked; the rest is the caller's promise.
    let (a, s, u, vt) = unsafe {
        (
            matrix(matrices.a, m, n, lda),
            vector_mut(matrices.s, k),
            matrix_mut(matrices.u, m, k, ldu),
            matrix_mut(matrices.vt, k, n, ldvt),
        )
    };
    match contain(|| decompose(a, s, u, vt)) {
        Some(Ok(())) => 0,
        Some(Err(Failure::NotFinite)) => -position,
        // LAPACK counts what did not converge, and nothing here is known to have; `k` fits, since
        // `m` and `n` came from 32-bit integers.
        Some(Err(Failure::NoConvergence)) | None => k as c_int,
    }
}

/// The thin singular value decomposition `A = U * diag(s) * VT` of an `m` x `n` matrix, with
/// `k = min(m, n)`.
///
/// * `jobz`: only `'S'` (the first `k` singular vectors of both sides) is implemented.
/// * `A` is not written.
/// * `s` (length `k`) holds the singular values in descending order, none negative.
/// * `u` (`m` x `k`) has orthonormal columns, and `vt` (`k` x `n`) orthonormal rows: it is the
///   transpose of the right factor.
/// * `lwork >= max(1, 4 k^2 + 7 k)`; if -1, only this size is written, into `work[0]`. `iwork` is
///   not used.
///
/// `info = -4`: `A` holds a NaN or an infinity. `info > 0`: no convergence; the results are
/// unspecified.
///
/// # Safety
///
/// The contract in the crate documentation.
#[cfg_attr(feature = "symbols", unsafe(no_mangle))]
pub unsafe extern "C" fn dgesdd_(
    jobz: *const c_char,
    m: *const c_int,
    n: *const c_int,
    a: *mut f64,
    lda: *const c_int,
    s: *mut f64,
    u: *mut f64,
    ldu: *const c_int,
    vt: *mut f64,
    ldvt: *const c_int,
    work: *mut f64,
    lwork: *const c_int,
    _iwork: *mut c_int,
    info: *mut c_int,
) {
    // SAFETY: scalars are readable by contract.
    let (jobz, m, n, lda) = unsafe { (*jobz, *m, *n, *lda) };
    // SAFETY: as above.
    let (ldu, ldvt, lwork) = unsafe { (*ldu, *ldvt, *lwork) };
    let check = || {
        only(jobz, b'S', 1)?;
        let (m, n) = (dim(m, 2)?, dim(n, 3)?);
        let lda = leading(lda, m, 5)?;
        let ldu = leading(ldu, m, 8)?;
        let ldvt = leading(ldvt, m.min(n), 10)?;
        let k = m.min(n) as f64;
        let size = (4.0 * k * k + 7.0 * k).max(1.0);
        let query = workspace(lwork, size, 12)?;
        Checked::Ok((Shapes { m, n, lda, ldu, ldvt }, size, query))
    };
    let outcome = match check() {
        Ok((shapes, size, query)) => {
            // SAFETY: `work` has a writable element by contract.
            unsafe { *work = size };
            if query {
                0
            } else {
                // SAFETY: the shapes are checked and the rest is the caller's promise.
                unsafe { run(Matrices { a, s, u, vt }, shapes, 4) }
            }
        }
        Err(illegal) => illegal,
    };
    // SAFETY: `info` is writable by contract.
    unsafe { *info = outcome };
}

/// The same decomposition as [`dgesdd_`], with other arguments.
///
/// * `jobu` and `jobvt`: only `'S'` is implemented.
/// * `lwork >= max(1, 3 min(m, n) + max(m, n), 5 min(m, n))`; if -1, only this size is written,
///   into `work[0]`.
///
/// `info = -5`: `A` holds a NaN or an infinity. `info > 0`: no convergence; the results are
/// unspecified.
///
/// # Safety
///
/// The contract in the crate documentation.
#[cfg_attr(feature = "symbols", unsafe(no_mangle))]
pub unsafe extern "C" fn dgesvd_(
    jobu: *const c_char,
    jobvt: *const c_char,
    m: *const c_int,
    n: *const c_int,
    a: *mut f64,
    lda: *const c_int,
    s: *mut f64,
    u: *mut f64,
    ldu: *const c_int,
    vt: *mut f64,
    ldvt: *const c_int,
    work: *mut f64,
    lwork: *const c_int,
    info: *mut c_int,
) {
    // SAFETY: scalars are readable by contract.
    let (jobu, jobvt, m, n) = unsafe { (*jobu, *jobvt, *m, *n) };
    // SAFETY: as above.
    let (lda, ldu, ldvt, lwork) = unsafe { (*lda, *ldu, *ldvt, *lwork) };
    let check = || {
        only(jobu, b'S', 1)?;
        only(jobvt, b'S', 2)?;
        let (m, n) = (dim(m, 3)?, dim(n, 4)?);
        let lda = leading(lda, m, 6)?;
        let ldu = leading(ldu, m, 9)?;
        let ldvt = leading(ldvt, m.min(n), 11)?;
        let (low, high) = (m.min(n) as f64, m.max(n) as f64);
        let size = (3.0 * low + high).max(5.0 * low).max(1.0);
        let query = workspace(lwork, size, 13)?;
        Checked::Ok((Shapes { m, n, lda, ldu, ldvt }, size, query))
    };
    let outcome = match check() {
        Ok((shapes, size, query)) => {
            // SAFETY: `work` has a writable element by contract.
            unsafe { *work = size };
            if query {
                0
            } else {
                // SAFETY: the shapes are checked and the rest is the caller's promise.
                unsafe { run(Matrices { a, s, u, vt }, shapes, 5) }
            }
        }
        Err(illegal) => illegal,
    };
    // SAFETY: `info` is writable by contract.
    unsafe { *info = outcome };
}
