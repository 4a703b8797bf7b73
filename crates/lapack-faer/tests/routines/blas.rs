use crate::common::{GUARD, Matrix, Random, assert_close, sum, triangle};
use core::ffi::{c_char, c_int};
use lapack_faer::{dgemm_, dsyr2k_, dsyrk_};

const SCALARS: [(f64, f64); 6] = [(1.0, 0.0), (-0.7, 1.0), (1.3, -0.4), (0.5, 2.0), (0.0, 0.0), (0.0, 3.0)];

const EPS: f64 = f64::EPSILON;

/// The flags and dimensions of a call, which the tests falsify one at a time.
#[derive(Clone, Copy)]
struct Gemm {
    transa: u8,
    transb: u8,
    m: c_int,
    n: c_int,
    k: c_int,
    lda: c_int,
    ldb: c_int,
    ldc: c_int,
}

impl Gemm {
    fn run(self, alpha: f64, a: &Matrix, b: &Matrix, beta: f64, c: &mut Matrix) {
        let (ta, tb) = (self.transa as c_char, self.transb as c_char);
        // SAFETY: the matrices cover the shapes that the tests ask for.
        unsafe {
            dgemm_(
                &ta,
                &tb,
                &self.m,
                &self.n,
                &self.k,
                &alpha,
                a.ptr(),
                &self.lda,
                b.ptr(),
                &self.ldb,
                &beta,
                c.ptr_mut(),
                &self.ldc,
            );
        }
    }
}

/// A rank-k or rank-2k update, the latter if there is a `b`.
#[derive(Clone, Copy)]
struct Rank {
    uplo: u8,
    trans: u8,
    n: c_int,
    k: c_int,
    lda: c_int,
    ldb: c_int,
    ldc: c_int,
}

impl Rank {
    fn run(self, alpha: f64, a: &Matrix, b: Option<&Matrix>, beta: f64, c: &mut Matrix) {
        let (uplo, trans) = (self.uplo as c_char, self.trans as c_char);
        // SAFETY: the matrices cover the shapes that the tests ask for.
        unsafe {
            match b {
                None => {
                    dsyrk_(&uplo, &trans, &self.n, &self.k, &alpha, a.ptr(), &self.lda, &beta, c.ptr_mut(), &self.ldc)
                }
                Some(b) => dsyr2k_(
                    &uplo,
                    &trans,
                    &self.n,
                    &self.k,
                    &alpha,
                    a.ptr(),
                    &self.lda,
                    b.ptr(),
                    &self.ldb,
                    &beta,
                    c.ptr_mut(),
                    &self.ldc,
                ),
            }
        }
    }
}

/// A stored factor such that `op(factor)` is `rows` x `cols`.
fn factor(random: &mut Random, trans: u8, rows: usize, cols: usize, pad: usize) -> Matrix {
    match trans {
        b'N' => random.matrix(rows, cols, pad),
        _ => random.matrix(cols, rows, pad),
    }
}

fn op(trans: u8, a: &Matrix, i: usize, j: usize) -> f64 {
    if trans == b'N' { a.get(i, j) } else { a.get(j, i) }
}

/// With `alpha = 0` the factors are not read, and with `beta = 0` neither is `C`.
fn poison(alpha: f64, beta: f64, factors: &mut [&mut Matrix], c: &mut Matrix) {
    if alpha == 0.0 {
        for factor in factors {
            factor.fill(|_, _| true, |_, _| f64::NAN);
        }
    }
    if beta == 0.0 {
        c.fill(|_, _| true, |_, _| f64::NAN);
    }
}

/// `alpha * product + beta * old`, where a factor 0 wins over anything.
fn expected(alpha: f64, product: impl Fn() -> f64, beta: f64, old: f64) -> f64 {
    let new = if alpha == 0.0 { 0.0 } else { alpha * product() };
    let old = if beta == 0.0 { 0.0 } else { beta * old };
    new + old
}

fn check_gemm(random: &mut Random, (m, n, k): (usize, usize, usize), pad: usize) {
    for (transa, transb) in [(b'N', b'N'), (b'N', b'T'), (b'T', b'N'), (b'T', b'T')] {
        for (alpha, beta) in SCALARS {
            let mut a = factor(random, transa, m, k, pad);
            let mut b = factor(random, transb, k, n, pad);
            let mut c = random.matrix(m, n, pad);
            poison(alpha, beta, &mut [&mut a, &mut b], &mut c);
            let before = c.clone();
            let (lda, ldb, ldc) = (a.ld(), b.ld(), c.ld());
            let [m_, n_, k_] = [m, n, k].map(|x| x as c_int);
            Gemm { transa, transb, m: m_, n: n_, k: k_, lda, ldb, ldc }.run(alpha, &a, &b, beta, &mut c);
            c.assert_only_changed(&before, |_, _| true);
            for i in 0..m {
                for j in 0..n {
                    let product = || sum(k, |l| op(transa, &a, i, l) * op(transb, &b, l, j));
                    let want = expected(alpha, product, beta, before.get(i, j));
                    assert_close(c.get(i, j), want, 4.0 * EPS * (k + 4) as f64);
                }
            }
        }
    }
}

fn check_rank(random: &mut Random, (n, k): (usize, usize), pad: usize, two: bool) {
    for (uplo, trans) in [(b'U', b'N'), (b'U', b'T'), (b'L', b'N'), (b'L', b'T')] {
        for (alpha, beta) in SCALARS {
            let mut a = factor(random, trans, n, k, pad);
            let mut b = factor(random, trans, n, k, pad);
            let mut c = random.matrix(n, n, pad);
            poison(alpha, beta, &mut [&mut a, &mut b], &mut c);
            // The other triangle must not be read either.
            let part = triangle(uplo);
            c.fill(|i, j| !part(i, j), |_, _| GUARD);
            let before = c.clone();
            let (lda, ldb, ldc) = (a.ld(), b.ld(), c.ld());
            let call = Rank { uplo, trans, n: n as c_int, k: k as c_int, lda, ldb, ldc };
            call.run(alpha, &a, two.then_some(&b), beta, &mut c);
            c.assert_only_changed(&before, part);
            for i in 0..n {
                for j in (0..n).filter(|&j| part(i, j)) {
                    let get = |x: &Matrix, i, l| op(trans, x, i, l);
                    let product = || {
                        sum(k, |l| match two {
                            false => get(&a, i, l) * get(&a, j, l),
                            true => get(&a, i, l) * get(&b, j, l) + get(&b, i, l) * get(&a, j, l),
                        })
                    };
                    let want = expected(alpha, product, beta, before.get(i, j));
                    assert_close(c.get(i, j), want, 8.0 * EPS * (k + 4) as f64);
                }
            }
        }
    }
}

#[test]
fn gemm_small_and_empty() {
    let mut random = Random(1);
    for m in 0..=12 {
        for n in 0..=12 {
            for k in 0..=12 {
                check_gemm(&mut random, (m, n, k), (m + n + k) % 4);
            }
        }
    }
}

#[test]
fn gemm_blocked() {
    let mut random = Random(2);
    for sizes in [(40, 33, 70), (130, 17, 65), (1, 150, 150), (150, 1, 150)] {
        check_gemm(&mut random, sizes, 3);
    }
}

#[test]
fn gemm_accepts_one_matrix_twice() {
    let a = Random(3).matrix(5, 5, 2);
    let mut c = Matrix::new(5, 5, 0, |_, _| f64::NAN);
    let (n, ld) = (5, a.ld());
    let call = Gemm { transa: b'c', transb: b'n', m: n, n, k: n, lda: ld, ldb: ld, ldc: 5 };
    call.run(1.0, &a, &a, 0.0, &mut c);
    for i in 0..5 {
        for j in 0..5 {
            assert_close(c.get(i, j), sum(5, |l| a.get(l, i) * a.get(l, j)), 20.0 * EPS);
        }
    }
}

#[test]
fn rank_k_and_2k_small_and_empty() {
    let mut random = Random(4);
    for n in 0..=12 {
        for k in 0..=12 {
            for two in [false, true] {
                check_rank(&mut random, (n, k), (n + k) % 4, two);
            }
        }
    }
}

#[test]
fn rank_k_and_2k_blocked() {
    let mut random = Random(5);
    for sizes in [(37, 50), (130, 40), (150, 1)] {
        for two in [false, true] {
            check_rank(&mut random, sizes, 3, two);
        }
    }
}

/// All entries are NaN and no guard cell is written.
fn assert_poisoned(c: &Matrix, before: &Matrix) {
    c.assert_only_changed(before, |_, _| true);
    for j in 0..c.cols {
        for i in 0..c.rows {
            assert!(c.get(i, j).is_nan());
        }
    }
}

#[test]
fn illegal_arguments_poison_the_result() {
    let mut random = Random(6);
    let (a, b) = (random.matrix(3, 4, 0), random.matrix(4, 3, 0));
    let before = random.matrix(3, 3, 2);
    let good = Gemm { transa: b'N', transb: b'N', m: 3, n: 3, k: 4, lda: 3, ldb: 4, ldc: 5 };
    let bad = [
        Gemm { transa: b'X', ..good },
        Gemm { transb: b'X', ..good },
        Gemm { k: -1, ..good },
        Gemm { lda: 2, ..good },
        Gemm { ldb: 3, ..good },
        Gemm { transa: b'T', ..good },
    ];
    for call in bad {
        let mut c = before.clone();
        call.run(1.0, &a, &b, 0.0, &mut c);
        assert_poisoned(&c, &before);
    }
    for call in [Gemm { m: -1, ..good }, Gemm { n: -1, ..good }, Gemm { ldc: 2, ..good }] {
        let mut c = before.clone();
        call.run(1.0, &a, &b, 0.0, &mut c);
        c.assert_unchanged(&before);
    }

    let (a, b) = (random.matrix(3, 4, 0), random.matrix(3, 4, 0));
    let good = Rank { uplo: b'U', trans: b'N', n: 3, k: 4, lda: 3, ldb: 3, ldc: 5 };
    let bad = [
        Rank { uplo: b'X', ..good },
        Rank { trans: b'X', ..good },
        Rank { k: -1, ..good },
        Rank { lda: 2, ..good },
        Rank { trans: b'T', ..good },
    ];
    for call in bad {
        for b in [None, Some(&b)] {
            let mut c = before.clone();
            call.run(1.0, &a, b, 0.0, &mut c);
            assert_poisoned(&c, &before);
        }
    }
    let mut c = before.clone();
    Rank { ldb: 2, ..good }.run(1.0, &a, Some(&b), 0.0, &mut c);
    assert_poisoned(&c, &before);
    for call in [Rank { n: -1, ..good }, Rank { ldc: 2, ..good }] {
        for b in [None, Some(&b)] {
            let mut c = before.clone();
            call.run(1.0, &a, b, 0.0, &mut c);
            c.assert_unchanged(&before);
        }
    }
}
