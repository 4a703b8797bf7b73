//! Symmetric eigenvalues: `dsyevr`.

use crate::args::{Checked, Uplo, contain, dim, leading, only, uplo, vectors, workspace};
use crate::scale::Scale;
use crate::views::{matrix, matrix_mut, vector_mut};
use core::ffi::{c_char, c_int};
use faer::diag::DiagMut;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{ComputeEigenvectors, self_adjoint_evd, self_adjoint_evd_scratch};
use faer::{Mat, MatMut, MatRef, Par};

/// The position of `A` in the argument list.
const A: c_int = 5;

/// The `info` of a decomposition that did not converge, LAPACK's "internal error".
const INTERNAL_ERROR: c_int = 1;

/// Eigenvalues, ascending, and if wanted the eigenvectors of the symmetric matrix whose lower
/// triangle is that of `a`. Gives the `info`.
fn decompose(a: MatRef<'_, f64>, w: &mut [f64], z: Option<MatMut<'_, f64>>) -> c_int {
    let n = a.nrows();
    if n == 0 {
        // faer's formula for the scratch size subtracts 1 from the order.
        return 0;
    }
    let entries = (0..n).flat_map(|j| (j..n).map(move |i| a[(i, j)]));
    let Some(scale) = Scale::of(entries) else {
        return -A;
    };
    // faer reads the lower triangle only.
    let scaled = Mat::from_fn(n, n, |i, j| if i >= j { a[(i, j)] * scale.down } else { 0.0 });
    let wanted = match z {
        Some(_) => ComputeEigenvectors::Yes,
        None => ComputeEigenvectors::No,
    };
    let scratch = self_adjoint_evd_scratch::<f64>(n, wanted, Par::Seq, Default::default());
    let result = self_adjoint_evd(
        scaled.as_ref(),
        DiagMut::from_slice_mut(w),
        z,
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(scratch)),
        Default::default(),
    );
    if result.is_err() {
        return INTERNAL_ERROR;
    }
    for value in w {
        *value *= scale.up;
    }
    0
}

/// All eigenvalues, and if wanted the eigenvectors, of an `n` x `n` symmetric matrix of which one
/// triangle is given.
///
/// * `jobz`: `'N'` for the eigenvalues only, `'V'` for the eigenvectors too.
/// * `range`: only `'A'` (all) is implemented; `vl`, `vu`, `il`, `iu` are then not used, and
///   neither is `abstol`, as the eigenvalues always come at full accuracy.
/// * `uplo`: `'U'` or `'L'`; the other triangle is not read. `A` is not written.
/// * `m` is set to `n`, and `w` (length `n`) holds the eigenvalues in ascending order.
/// * With `jobz = 'V'`, column `i` of `z` is a unit eigenvector for `w[i]`, the columns are
///   orthogonal, and `isuppz` (length `2 n`) says that each is supported on rows `1..n`. With
///   `jobz = 'N'`, neither is touched.
/// * `lwork >= 26 n` and `liwork >= 10 n` (1 if `n <= 1`); if one of them is -1, only these sizes
///   are written, into `work[0]` and `iwork[0]`.
///
/// `info = -5`: `A` holds a NaN or an infinity. `info > 0`: no convergence; `w` and `z` are
/// unspecified.
///
/// # Safety
///
/// The contract in the crate documentation.
#[cfg_attr(feature = "symbols", unsafe(no_mangle))]
pub unsafe extern "C" fn dsyevr_(
    jobz: *const c_char,
    range: *const c_char,
    uplo: *const c_char,
    n: *const c_int,
    a: *mut f64,
    lda: *const c_int,
    _vl: *const f64,
    _vu: *const f64,
    _il: *const c_int,
    _iu: *const c_int,
    _abstol: *const f64,
    m: *mut c_int,
    w: *mut f64,
    z: *mut f64,
    ldz: *const c_int,
    isuppz: *mut c_int,
    work: *mut f64,
    lwork: *const c_int,
    iwork: *mut c_int,
    liwork: *const c_int,
    info: *mut c_int,
) {
    // SAFETY: scalars are readable by contract.
    let (jobz, range, triangle, order) = unsafe { (*jobz, *range, *uplo, *n) };
    // SAFETY: as above.
    let (lda, ldz, lwork, liwork) = unsafe { (*lda, *ldz, *lwork, *liwork) };
    let (work_size, iwork_size) =
        if order <= 1 { (1.0, 1) } else { (26.0 * f64::from(order), order.saturating_mul(10)) };
    let check = || {
        let vectors = vectors(jobz, 1)?;
        only(range, b'A', 2)?;
        let triangle = self::uplo(triangle, 3)?;
        let n = dim(order, 4)?;
        let lda = leading(lda, n, 6)?;
        let ldz = leading(ldz, if vectors { n } else { 0 }, 15)?;
        // One query exempts both lengths from the check.
        let query = lwork == -1 || liwork == -1;
        if !query {
            workspace(lwork, work_size, 18)?;
            workspace(liwork, f64::from(iwork_size), 20)?;
        }
        Checked::Ok((vectors, triangle, n, lda, ldz, query))
    };
    let (vectors, triangle, n, lda, ldz, query) = match check() {
        Ok(plan) => plan,
        Err(illegal) => {
            // SAFETY: `info` is writable by contract.
            unsafe { *info = illegal };
            return;
        }
    };
    // SAFETY: `work` and `iwork` have an element, and with `info` are writable, by contract.
    unsafe {
        *work = work_size;
        *iwork = iwork_size;
        *info = 0;
    }
    if query {
        return;
    }
    // SAFETY: the shapes are checked; the matrices and vectors are the caller's promise, where `z`
    // and `isuppz` are taken only if vectors are wanted.
    let (a, w, z, isuppz) = unsafe {
        (
            matrix(a, n, n, lda),
            vector_mut(w, n),
            vectors.then(|| matrix_mut(z, n, n, ldz)),
            vector_mut(isuppz, if vectors { 2 * n } else { 0 }),
        )
    };
    let a = match triangle {
        Uplo::Lower => a,
        Uplo::Upper => a.transpose(),
    };
    let outcome = contain(|| decompose(a, w, z)).unwrap_or(INTERNAL_ERROR);
    if outcome == 0 {
        for support in isuppz.chunks_exact_mut(2) {
            support.copy_from_slice(&[1, order]);
        }
        // SAFETY: `m` is writable by contract.
        unsafe { *m = order };
    }
    // SAFETY: `info` is writable by contract.
    unsafe { *info = outcome };
}
