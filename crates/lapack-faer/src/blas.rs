//! Matrix products: `dgemm`, `dsyrk`, `dsyr2k`.

use crate::args::{Checked, Uplo, contain, dim, leading, transposed, uplo};
use crate::views::{matrix, matrix_mut};
use core::ffi::{c_char, c_int};
use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::prelude::*;
use faer::{Accum, MatMut, MatRef, Par};
use std::io::Write;

/// The part of `C` that a routine reads and writes.
#[derive(Clone, Copy)]
enum Part {
    Full,
    Lower,
    Upper,
}

impl From<Uplo> for Part {
    fn from(uplo: Uplo) -> Self {
        match uplo {
            Uplo::Lower => Part::Lower,
            Uplo::Upper => Part::Upper,
        }
    }
}

impl Part {
    fn structure(self) -> BlockStructure {
        match self {
            Part::Full => BlockStructure::Rectangular,
            Part::Lower => BlockStructure::TriangularLower,
            Part::Upper => BlockStructure::TriangularUpper,
        }
    }

    fn update(self, c: &mut MatMut<'_, f64>, mut f: impl FnMut(&mut f64)) {
        for j in 0..c.ncols() {
            let rows = match self {
                Part::Full => 0..c.nrows(),
                Part::Lower => j..c.nrows(),
                Part::Upper => 0..j + 1,
            };
            for i in rows {
                f(&mut c[(i, j)]);
            }
        }
    }
}

/// A matrix argument before it becomes a view: rows, columns and leading dimension as stored.
#[derive(Clone, Copy)]
struct Shape {
    rows: usize,
    cols: usize,
    ld: usize,
}

/// `A` such that `op(A)` is `rows` x `cols`.
fn operand(trans: bool, rows: usize, cols: usize, ld: c_int, position: c_int) -> Checked<Shape> {
    let (rows, cols) = if trans { (cols, rows) } else { (rows, cols) };
    let ld = leading(ld, rows, position)?;
    Ok(Shape { rows, cols, ld })
}

/// The view of `op(A)`.
///
/// # Safety
///
/// `ptr` is a matrix argument of this shape, see the contract of the crate.
unsafe fn operand_view<'a>(ptr: *const f64, shape: Shape, trans: bool) -> MatRef<'a, f64> {
    // SAFETY: `operand` checked the leading dimension; the rest is the caller's promise.
    let view = unsafe { matrix(ptr, shape.rows, shape.cols, shape.ld) };
    if trans { view.transpose() } else { view }
}

/// Adds `alpha * sum of left * right` to `beta * C`, within `part`.
///
/// As in the reference BLAS, `beta = 0` means that `C` is not read, and `alpha = 0` that the
/// factors are not, whatever they hold. faer promises the first for `Accum::Replace`.
fn accumulate(
    mut c: MatMut<'_, f64>,
    part: Part,
    alpha: f64,
    products: &[(MatRef<'_, f64>, MatRef<'_, f64>)],
    beta: f64,
) {
    let done = contain(|| {
        let mut accum = if beta == 0.0 {
            Accum::Replace
        } else {
            if beta != 1.0 {
                part.update(&mut c, |x| *x *= beta);
            }
            Accum::Add
        };
        if alpha == 0.0 {
            if accum == Accum::Replace {
                part.update(&mut c, |x| *x = 0.0);
            }
            return;
        }
        for &(left, right) in products {
            match part {
                Part::Full => matmul(c.rb_mut(), accum, left, right, alpha, Par::Seq),
                Part::Lower | Part::Upper => triangular::matmul(
                    c.rb_mut(),
                    part.structure(),
                    accum,
                    left,
                    BlockStructure::Rectangular,
                    right,
                    BlockStructure::Rectangular,
                    alpha,
                    Par::Seq,
                ),
            }
            accum = Accum::Add;
        }
    });
    if done.is_none() {
        part.update(&mut c, |x| *x = f64::NAN);
    }
}

/// Refuses a call: says so, and fills `C` with NaN if its own shape is legal.
///
/// # Safety
///
/// If the shape is legal, `c` is a writable matrix argument of that shape.
unsafe fn refuse(name: &str, info: c_int, c: *mut f64, rows: c_int, cols: c_int, ldc: c_int) {
    // Not `eprintln!`, which panics when standard error is closed.
    let _ = writeln!(std::io::stderr(), "lapack-faer: argument {} of {name} is illegal", -info);
    let shape = || {
        let (rows, cols) = (dim(rows, 1)?, dim(cols, 1)?);
        Checked::Ok((rows, cols, leading(ldc, rows, 1)?))
    };
    if let Ok((rows, cols, ldc)) = shape() {
        // SAFETY: the shape is legal, so the caller promises the matrix.
        let mut c = unsafe { matrix_mut(c, rows, cols, ldc) };
        Part::Full.update(&mut c, |x| *x = f64::NAN);
    }
}

/// `C := alpha * op(A) * op(B) + beta * C` with `C` of size `m` x `n` and inner dimension `k`.
///
/// `transa` and `transb` are `'N'`, `'T'` or `'C'`. With `beta = 0`, `C` is not read; with
/// `alpha = 0` or `k = 0`, `A` and `B` are not read.
///
/// # Safety
///
/// The contract in the crate documentation; `A` and `B` may overlap each other.
#[cfg_attr(feature = "symbols", unsafe(no_mangle))]
pub unsafe extern "C" fn dgemm_(
    transa: *const c_char,
    transb: *const c_char,
    m: *const c_int,
    n: *const c_int,
    k: *const c_int,
    alpha: *const f64,
    a: *const f64,
    lda: *const c_int,
    b: *const f64,
    ldb: *const c_int,
    beta: *const f64,
    c: *mut f64,
    ldc: *const c_int,
) {
    // SAFETY: scalars are readable by contract.
    let (transa, transb, m, n, k) = unsafe { (*transa, *transb, *m, *n, *k) };
    // SAFETY: as above.
    let (alpha, lda, ldb, beta, ldc) = unsafe { (*alpha, *lda, *ldb, *beta, *ldc) };
    let check = || {
        let (ta, tb) = (transposed(transa, 1)?, transposed(transb, 2)?);
        let (m, n, k) = (dim(m, 3)?, dim(n, 4)?, dim(k, 5)?);
        let a = operand(ta, m, k, lda, 8)?;
        let b = operand(tb, k, n, ldb, 10)?;
        let ld = leading(ldc, m, 13)?;
        let (rows, cols) = (m, n);
        Checked::Ok((ta, tb, a, b, Shape { rows, cols, ld }))
    };
    match check() {
        Ok((ta, tb, a_shape, b_shape, c_shape)) => {
            // SAFETY: the shapes are checked and the matrices are the caller's promise.
            let (a, b, c) = unsafe {
                (
                    operand_view(a, a_shape, ta),
                    operand_view(b, b_shape, tb),
                    matrix_mut(c, c_shape.rows, c_shape.cols, c_shape.ld),
                )
            };
            accumulate(c, Part::Full, alpha, &[(a, b)], beta);
        }
        // SAFETY: `c` is a matrix argument of this shape.
        Err(info) => unsafe { refuse("dgemm", info, c, m, n, ldc) },
    }
}

/// `C := alpha * op(A) * op(A)^T + beta * C` on one triangle of the `n` x `n` matrix `C`, with
/// `op(A)` of size `n` x `k`.
///
/// `uplo` is `'U'` or `'L'`; the other triangle of `C` is neither read nor written. `trans` is
/// `'N'`, `'T'` or `'C'`. With `beta = 0`, `C` is not read; with `alpha = 0` or `k = 0`, `A` is not
/// read. An illegal argument fills both triangles with NaN.
///
/// # Safety
///
/// The contract in the crate documentation.
#[cfg_attr(feature = "symbols", unsafe(no_mangle))]
pub unsafe extern "C" fn dsyrk_(
    uplo: *const c_char,
    trans: *const c_char,
    n: *const c_int,
    k: *const c_int,
    alpha: *const f64,
    a: *const f64,
    lda: *const c_int,
    beta: *const f64,
    c: *mut f64,
    ldc: *const c_int,
) {
    // SAFETY: scalars are readable by contract.
    let (part, trans, n, k) = unsafe { (*uplo, *trans, *n, *k) };
    // SAFETY: as above.
    let (alpha, lda, beta, ldc) = unsafe { (*alpha, *lda, *beta, *ldc) };
    let check = || {
        let part = Part::from(self::uplo(part, 1)?);
        let trans = transposed(trans, 2)?;
        let (n, k) = (dim(n, 3)?, dim(k, 4)?);
        let a = operand(trans, n, k, lda, 7)?;
        Checked::Ok((part, trans, n, a, leading(ldc, n, 10)?))
    };
    match check() {
        Ok((part, trans, n, shape, ldc)) => {
            // SAFETY: the shapes are checked and the matrices are the caller's promise.
            let (a, c) = unsafe { (operand_view(a, shape, trans), matrix_mut(c, n, n, ldc)) };
            accumulate(c, part, alpha, &[(a, a.transpose())], beta);
        }
        // SAFETY: `c` is a matrix argument of this shape.
        Err(info) => unsafe { refuse("dsyrk", info, c, n, n, ldc) },
    }
}

/// `C := alpha * (op(A) * op(B)^T + op(B) * op(A)^T) + beta * C` on one triangle of the `n` x `n`
/// matrix `C`, with `op(A)` and `op(B)` of size `n` x `k`.
///
/// The flags, and what is read and written, are as in [`dsyrk_`].
///
/// # Safety
///
/// The contract in the crate documentation; `A` and `B` may overlap each other.
#[cfg_attr(feature = "symbols", unsafe(no_mangle))]
pub unsafe extern "C" fn dsyr2k_(
    uplo: *const c_char,
    trans: *const c_char,
    n: *const c_int,
    k: *const c_int,
    alpha: *const f64,
    a: *const f64,
    lda: *const c_int,
    b: *const f64,
    ldb: *const c_int,
    beta: *const f64,
    c: *mut f64,
    ldc: *const c_int,
) {
    // SAFETY: scalars are readable by contract.
    let (part, trans, n, k) = unsafe { (*uplo, *trans, *n, *k) };
    // SAFETY: as above.
    let (alpha, lda, ldb, beta, ldc) = unsafe { (*alpha, *lda, *ldb, *beta, *ldc) };
    let check = || {
        let part = Part::from(self::uplo(part, 1)?);
        let trans = transposed(trans, 2)?;
        let (n, k) = (dim(n, 3)?, dim(k, 4)?);
        let a = operand(trans, n, k, lda, 7)?;
        let b = operand(trans, n, k, ldb, 9)?;
        Checked::Ok((part, trans, n, a, b, leading(ldc, n, 12)?))
    };
    match check() {
        Ok((part, trans, n, a_shape, b_shape, ldc)) => {
            // SAFETY: the shapes are checked and the matrices are the caller's promise.
            let (a, b, c) =
                unsafe { (operand_view(a, a_shape, trans), operand_view(b, b_shape, trans), matrix_mut(c, n, n, ldc)) };
            let products = [(a, b.transpose()), (b, a.transpose())];
            accumulate(c, part, alpha, &products, beta);
        }
        // SAFETY: `c` is a matrix argument of this shape.
        Err(info) => unsafe { refuse("dsyr2k", info, c, n, n, ldc) },
    }
}
