//! From pointers to faer views. Every raw matrix of the crate becomes a view here and nowhere else.
//!
//! # Why this is sound
//!
//! A view of `rows` x `cols` with strides `(1, ld)` touches exactly the offsets `i + j * ld` with
//! `i < rows` and `j < cols`. faer derives every access from these four numbers, so the gap between
//! the columns, which a caller may use for other data, is not part of the view. With `ld >= rows`
//! (checked before any view is made) no two entries share an address. Size and overflow are the
//! caller's promise: the matrix exists in memory, so its offsets fit an `isize`.
//!
//! The lifetime of a view is unbounded; each is used only inside the call that received the
//! pointer. A mutable view overlaps nothing, by the contract of the crate; shared views may overlap
//! one another (`dgemm` with `A = B`).

use core::ptr::NonNull;
use core::slice;
use faer::{MatMut, MatRef};

/// A read-only view of a column-major matrix.
///
/// # Safety
///
/// If the matrix is not empty, `ld >= rows`, and `ptr` covers the offsets above with initialized
/// values that nothing writes while the view lives.
pub unsafe fn matrix<'a>(ptr: *const f64, rows: usize, cols: usize, ld: usize) -> MatRef<'a, f64> {
    let ptr = if rows == 0 || cols == 0 { NonNull::dangling().as_ptr() } else { ptr };
    // SAFETY: the pointer is non-null, and covers all entries of the view (none if it dangles).
    unsafe { MatRef::from_raw_parts(ptr, rows, cols, 1, ld as isize) }
}

/// A writable view of a column-major matrix.
///
/// # Safety
///
/// As for [`matrix`], and the entries are writable and reached by nothing else while the view
/// lives.
pub unsafe fn matrix_mut<'a>(ptr: *mut f64, rows: usize, cols: usize, ld: usize) -> MatMut<'a, f64> {
    let ptr = if rows == 0 || cols == 0 { NonNull::dangling().as_ptr() } else { ptr };
    // SAFETY: as in `matrix`; entries are distinct since `ld >= rows`, and exclusive by contract.
    unsafe { MatMut::from_raw_parts_mut(ptr, rows, cols, 1, ld as isize) }
}

/// A writable view of a vector.
///
/// # Safety
///
/// If `len > 0`, `ptr` points to `len` initialized, writable values reached by nothing else while
/// the view lives.
pub unsafe fn vector_mut<'a, T>(ptr: *mut T, len: usize) -> &'a mut [T] {
    if len == 0 {
        return &mut [];
    }
    // SAFETY: the contract of this function is the one of `from_raw_parts_mut`.
    unsafe { slice::from_raw_parts_mut(ptr, len) }
}
