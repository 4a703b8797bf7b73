//! Flags, dimensions and workspace sizes, checked the way LAPACK checks them; and the guard that
//! keeps panics inside.

use core::ffi::{c_char, c_int};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The value of an argument, or the `info` that refuses it: minus its one-based position.
pub type Checked<T> = Result<T, c_int>;

/// The triangle of a symmetric matrix that is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Uplo {
    Lower,
    Upper,
}

/// A flag as an upper-case letter; LAPACK's flags are case insensitive.
fn letter(flag: c_char) -> u8 {
    // `c_char` is signed on some targets; flags are ASCII, and any other byte matches no flag.
    (flag as u8).to_ascii_uppercase()
}

/// `'L'` or `'U'`.
pub fn uplo(flag: c_char, position: c_int) -> Checked<Uplo> {
    match letter(flag) {
        b'L' => Ok(Uplo::Lower),
        b'U' => Ok(Uplo::Upper),
        _ => Err(-position),
    }
}

/// Whether a matrix is transposed: `'N'`, or `'T'` or `'C'`, which agree for real matrices.
pub fn transposed(flag: c_char, position: c_int) -> Checked<bool> {
    match letter(flag) {
        b'N' => Ok(false),
        b'T' | b'C' => Ok(true),
        _ => Err(-position),
    }
}

/// Whether vectors are wanted: `'V'` or `'N'`.
pub fn vectors(flag: c_char, position: c_int) -> Checked<bool> {
    match letter(flag) {
        b'N' => Ok(false),
        b'V' => Ok(true),
        _ => Err(-position),
    }
}

/// Accepts a flag that has only one implemented value.
pub fn only(flag: c_char, value: u8, position: c_int) -> Checked<()> {
    if letter(flag) == value { Ok(()) } else { Err(-position) }
}

/// A number of rows or columns.
pub fn dim(value: c_int, position: c_int) -> Checked<usize> {
    usize::try_from(value).map_err(|_| -position)
}

/// The leading dimension of a matrix of `rows` rows: at least `max(1, rows)`.
pub fn leading(value: c_int, rows: usize, position: c_int) -> Checked<usize> {
    let ld = dim(value, position)?;
    if ld >= rows.max(1) { Ok(ld) } else { Err(-position) }
}

/// Whether `length` asks for the workspace size; otherwise it must reach `minimum`.
///
/// The minimum is a float because LAPACK's formulas are quadratic in a 32-bit integer, and because
/// that is how the answer to the query travels.
pub fn workspace(length: c_int, minimum: f64, position: c_int) -> Checked<bool> {
    if length == -1 {
        Ok(true)
    } else if f64::from(length) >= minimum {
        Ok(false)
    } else {
        Err(-position)
    }
}

/// Runs `f`, and gives `None` if it panics.
///
/// The closures passed here own or exclusively borrow all they mutate, and after a panic the caller
/// either overwrites the result or reports it as failed, so no broken invariant is observed.
pub fn contain<T>(f: impl FnOnce() -> T) -> Option<T> {
    catch_unwind(AssertUnwindSafe(f)).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flags_are_case_insensitive_and_closed() {
        let flag = |c: u8| c as c_char;
        for c in 0..=u8::MAX {
            let expect = match c {
                b'L' | b'l' => Ok(Uplo::Lower),
                b'U' | b'u' => Ok(Uplo::Upper),
                _ => Err(-7),
            };
            assert_eq!(uplo(flag(c), 7), expect);
            let expect = match c {
                b'N' | b'n' => Ok(false),
                b'T' | b't' | b'C' | b'c' => Ok(true),
                _ => Err(-7),
            };
            assert_eq!(transposed(flag(c), 7), expect);
            let expect = match c {
                b'N' | b'n' => Ok(false),
                b'V' | b'v' => Ok(true),
                _ => Err(-7),
            };
            assert_eq!(vectors(flag(c), 7), expect);
            let expect = if c == b'S' || c == b's' { Ok(()) } else { Err(-7) };
            assert_eq!(only(flag(c), b'S', 7), expect);
        }
    }

    #[test]
    fn dimensions_and_workspaces() {
        assert_eq!(dim(0, 3), Ok(0));
        assert_eq!(dim(-1, 3), Err(-3));
        assert_eq!(leading(0, 0, 3), Err(-3));
        assert_eq!(leading(1, 0, 3), Ok(1));
        assert_eq!(leading(4, 5, 3), Err(-3));
        assert_eq!(leading(5, 5, 3), Ok(5));
        assert_eq!(workspace(-1, 10.0, 3), Ok(true));
        assert_eq!(workspace(10, 10.0, 3), Ok(false));
        assert_eq!(workspace(9, 10.0, 3), Err(-3));
        assert_eq!(workspace(-2, 10.0, 3), Err(-3));
    }

    #[test]
    fn panics_are_contained() {
        assert_eq!(contain(|| 1), Some(1));
        assert_eq!(contain(|| -> i32 { panic!("contained on purpose") }), None);
    }
}
