use crate::common::{GUARD, Matrix, Random, assert_close, sum, table, triangle};
use core::ffi::{c_char, c_int};
use lapack_faer::{dpotrf_, dpotrs_};

fn potrf(uplo: u8, n: c_int, a: &mut Matrix, lda: c_int) -> c_int {
    let (uplo, mut info) = (uplo as c_char, 99);
    // SAFETY: the matrix covers the shapes that the tests ask for.
    unsafe { dpotrf_(&uplo, &n, a.ptr_mut(), &lda, &mut info) };
    info
}

/// `(order, right-hand sides, lda, ldb)` of a solve.
type Sizes = (c_int, c_int, c_int, c_int);

fn potrs(uplo: u8, (n, nrhs, lda, ldb): Sizes, a: &Matrix, b: &mut Matrix) -> c_int {
    let (uplo, mut info) = (uplo as c_char, 99);
    // SAFETY: the matrices cover the shapes that the tests ask for.
    unsafe {
        dpotrs_(&uplo, &n, &nrhs, a.ptr(), &lda, b.ptr_mut(), &ldb, &mut info);
    }
    info
}

/// `M^T * M + I`, well conditioned enough for tight bounds.
fn positive_definite(random: &mut Random, n: usize) -> Vec<Vec<f64>> {
    let m = random.matrix(n, n, 0);
    let entry = |i, j| sum(n, |l| m.get(l, i) * m.get(l, j)) + f64::from(i == j);
    table(n, entry)
}

/// One triangle of `a`, with guards in the other.
fn stored(a: &[Vec<f64>], uplo: u8, pad: usize) -> Matrix {
    let part = triangle(uplo);
    Matrix::new(a.len(), a.len(), pad, |i, j| if part(i, j) { a[i][j] } else { GUARD })
}

/// Entry `(i, j)` of the lower factor, wherever it is stored.
fn lower(factor: &Matrix, uplo: u8, i: usize, j: usize) -> f64 {
    match (i >= j, uplo) {
        (false, _) => 0.0,
        (true, b'L') => factor.get(i, j),
        (true, _) => factor.get(j, i),
    }
}

fn check_factor_and_solve(random: &mut Random, n: usize, nrhs: usize, pad: usize) {
    let table = positive_definite(random, n);
    for uplo in [b'L', b'U'] {
        let before = stored(&table, uplo, pad);
        let mut a = before.clone();
        assert_eq!(potrf(uplo, n as c_int, &mut a, before.ld()), 0);
        a.assert_only_changed(&before, triangle(uplo));
        for (i, row) in table.iter().enumerate() {
            assert!(lower(&a, uplo, i, i) > 0.0);
            for (j, &want) in row.iter().enumerate() {
                let got = sum(n, |l| lower(&a, uplo, i, l) * lower(&a, uplo, j, l));
                assert_close(got, want, 1e-14 * (n * n) as f64);
            }
        }

        // The right-hand side is A * X for a known X.
        let x = random.matrix(n, nrhs, 0);
        let b = Matrix::new(n, nrhs, pad, |i, j| sum(n, |l| table[i][l] * x.get(l, j)));
        let factor = a.clone();
        let mut solution = b.clone();
        let sizes = (n as c_int, nrhs as c_int, a.ld(), b.ld());
        assert_eq!(potrs(uplo, sizes, &a, &mut solution), 0);
        a.assert_unchanged(&factor);
        solution.assert_only_changed(&b, |_, _| true);
        for i in 0..n {
            for j in 0..nrhs {
                assert_close(solution.get(i, j), x.get(i, j), 1e-13 * (n * n) as f64);
            }
        }
    }
}

#[test]
fn factor_and_solve_small_and_empty() {
    let mut random = Random(11);
    for n in 0..=12 {
        for nrhs in 0..=5 {
            for pad in [0, 3] {
                check_factor_and_solve(&mut random, n, nrhs, pad);
            }
        }
    }
}

#[test]
fn factor_and_solve_blocked() {
    let mut random = Random(12);
    for (n, nrhs) in [(35, 9), (64, 1), (150, 40)] {
        check_factor_and_solve(&mut random, n, nrhs, 3);
    }
}

#[test]
fn factor_of_a_known_matrix() {
    let table = [[4.0, 2.0, -2.0], [2.0, 10.0, 2.0], [-2.0, 2.0, 6.0]].map(Vec::from);
    let want = [[2.0, 0.0, 0.0], [1.0, 3.0, 0.0], [-1.0, 1.0, 2.0]];
    for uplo in [b'L', b'U', b'l', b'u'] {
        let mut a = stored(&table, uplo, 1);
        let lda = a.ld();
        assert_eq!(potrf(uplo, 3, &mut a, lda), 0);
        for (i, row) in want.iter().enumerate() {
            for (j, &want) in row.iter().enumerate().take(i + 1) {
                let (i, j) = if triangle(uplo)(i, j) { (i, j) } else { (j, i) };
                assert_close(a.get(i, j), want, 1e-15);
            }
        }
    }
}

/// `info` is the order of the first leading minor that fails, and nothing is written.
#[test]
fn not_positive_definite() {
    let mut random = Random(13);
    for n in (1..=12).chain([40, 150]) {
        for bad in (0..n).step_by(1 + n / 13) {
            for value in [-1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                let mut table = positive_definite(&mut random, n);
                table[bad][bad] = value;
                for uplo in [b'L', b'U'] {
                    let before = stored(&table, uplo, 2);
                    let mut a = before.clone();
                    let info = potrf(uplo, n as c_int, &mut a, before.ld());
                    assert_eq!(info, bad as c_int + 1);
                    a.assert_unchanged(&before);
                }
            }
        }
    }
    // A zero pivot, exactly, in the second step and at the start.
    for (table, want) in [([[1.0, 1.0], [1.0, 1.0]], 2), ([[0.0, 0.0], [0.0, 1.0]], 1)] {
        let mut a = stored(&table.map(Vec::from), b'L', 0);
        assert_eq!(potrf(b'L', 2, &mut a, 2), want);
    }
}

#[test]
fn illegal_arguments() {
    let before = stored(&positive_definite(&mut Random(14), 3), b'L', 0);
    for (uplo, n, lda, want) in [(b'X', 3, 3, -1), (b'L', -1, 3, -2), (b'L', 3, 2, -4)] {
        let mut a = before.clone();
        assert_eq!(potrf(uplo, n, &mut a, lda), want);
        a.assert_unchanged(&before);
    }
    // LAPACK asks for a positive leading dimension even of an empty matrix.
    assert_eq!(potrf(b'L', 0, &mut before.clone(), 0), -4);

    let calls = [
        (b'X', (3, 2, 3, 3), -1),
        (b'L', (-1, 2, 3, 3), -2),
        (b'L', (3, -1, 3, 3), -3),
        (b'L', (3, 2, 2, 3), -5),
        (b'L', (3, 2, 3, 2), -7),
    ];
    let rhs = Random(15).matrix(3, 2, 0);
    for (uplo, sizes, want) in calls {
        let mut b = rhs.clone();
        assert_eq!(potrs(uplo, sizes, &before, &mut b), want);
        b.assert_unchanged(&rhs);
    }
}
