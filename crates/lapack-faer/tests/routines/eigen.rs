use crate::common::{GUARD, Matrix, Random, assert_close, sum, table, triangle};
use core::ffi::{c_char, c_int};
use lapack_faer::dsyevr_;

/// The arguments that the tests falsify, and the buffers.
#[derive(Clone)]
struct Call {
    jobz: u8,
    range: u8,
    uplo: u8,
    n: c_int,
    lda: c_int,
    ldz: c_int,
    lwork: c_int,
    liwork: c_int,
    a: Matrix,
    m: c_int,
    w: Matrix,
    z: Matrix,
    isuppz: Vec<c_int>,
    work: Vec<f64>,
    iwork: Vec<c_int>,
}

impl Call {
    /// All eigenvalues of the table, of which one triangle is passed on.
    fn new(table: &[Vec<f64>], jobz: u8, uplo: u8, pad: usize) -> Self {
        let n = table.len();
        let part = triangle(uplo);
        let a = Matrix::new(n, n, pad, |i, j| if part(i, j) { table[i][j] } else { GUARD });
        let z = if jobz == b'V' { n } else { 0 };
        let z = Matrix::new(z, z, pad, |_, _| f64::NAN);
        let (lwork, liwork) = if n <= 1 { (1, 1) } else { (26 * n, 10 * n) };
        Self {
            jobz,
            range: b'A',
            uplo,
            n: n as c_int,
            lda: a.ld(),
            ldz: z.ld(),
            lwork: lwork as c_int,
            liwork: liwork as c_int,
            a,
            m: -7,
            w: Matrix::new(n, 1, 2, |_, _| f64::NAN),
            z,
            isuppz: vec![-7; 2 * n + 2],
            work: vec![0.0; lwork],
            iwork: vec![0; liwork],
        }
    }

    fn run(&mut self) -> c_int {
        let [jobz, range, uplo] = [self.jobz, self.range, self.uplo].map(|x| x as c_char);
        // The bounds and the tolerance are not used with range 'A'.
        let (vl, vu, il, iu, abstol) = (f64::NAN, f64::NAN, -1, -1, -1.0);
        let mut info = 99;
        // SAFETY: the buffers cover the shapes that the tests ask for.
        unsafe {
            dsyevr_(
                &jobz,
                &range,
                &uplo,
                &self.n,
                self.a.ptr_mut(),
                &self.lda,
                &vl,
                &vu,
                &il,
                &iu,
                &abstol,
                &mut self.m,
                self.w.ptr_mut(),
                self.z.ptr_mut(),
                &self.ldz,
                self.isuppz.as_mut_ptr(),
                self.work.as_mut_ptr(),
                &self.lwork,
                self.iwork.as_mut_ptr(),
                &self.liwork,
                &mut info,
            );
        }
        info
    }

    /// No output but the workspace has changed.
    fn assert_no_result(&self, before: &Self) {
        self.a.assert_unchanged(&before.a);
        self.w.assert_unchanged(&before.w);
        self.z.assert_unchanged(&before.z);
        assert_eq!((self.m, &self.isuppz), (before.m, &before.isuppz));
    }
}

fn norm(table: &[Vec<f64>]) -> f64 {
    let max = table.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
    max * table.len() as f64
}

/// The spectrum is checked without reference to another eigenvalue solver: with vectors, by
/// `A Z = Z W` and `Z^T Z = I`, which determine it; without, by agreement.
fn check(table: &[Vec<f64>], pad: usize) {
    let n = table.len();
    let eps = 4.0 * f64::EPSILON * (n + 4) as f64;
    for uplo in [b'U', b'L'] {
        let before = Call::new(table, b'V', uplo, pad);
        let mut full = before.clone();
        assert_eq!(full.run(), 0);
        full.a.assert_unchanged(&before.a);
        full.w.assert_only_changed(&before.w, |_, _| true);
        full.z.assert_only_changed(&before.z, |_, _| true);
        assert_eq!(full.m, n as c_int);
        for i in 0..n {
            assert_eq!(full.isuppz[2 * i..2 * i + 2], [1, n as c_int]);
        }
        assert_eq!(full.isuppz[2 * n..], [-7, -7]);
        let (w, z) = (&full.w, &full.z);
        for j in 0..n {
            assert!(j == 0 || w.get(j - 1, 0) <= w.get(j, 0), "not ascending");
            for i in 0..n {
                let product = sum(n, |l| table[i][l] * z.get(l, j));
                assert_close(product, z.get(i, j) * w.get(j, 0), eps * norm(table));
                let gram = sum(n, |l| z.get(l, i) * z.get(l, j));
                assert_close(gram, f64::from(i == j), eps);
            }
        }

        let before = Call::new(table, b'N', uplo, pad);
        let mut values = before.clone();
        assert_eq!(values.run(), 0);
        values.a.assert_unchanged(&before.a);
        values.w.assert_only_changed(&before.w, |_, _| true);
        values.z.assert_unchanged(&before.z);
        assert_eq!(values.isuppz, before.isuppz);
        assert_eq!(values.m, n as c_int);
        for j in 0..n {
            assert_close(values.w.get(j, 0), w.get(j, 0), eps * norm(table));
        }
    }
}

#[test]
fn small_and_empty() {
    let mut random = Random(21);
    for n in 0..=12 {
        for pad in [0, 3] {
            check(&random.symmetric(n), pad);
        }
    }
}

#[test]
fn blocked() {
    let mut random = Random(22);
    for n in [33, 150] {
        check(&random.symmetric(n), 3);
    }
}

#[test]
fn degenerate_spectra() {
    for n in 1..=12 {
        check(&table(n, |_, _| 0.0), 1);
        check(&table(n, |_, _| 1.0), 1);
        check(&table(n, |i, j| f64::from(i == j)), 1);
        check(&table(n, |i, j| if i == j { 10_f64.powi(-(3 * i as i32)) } else { 0.0 }), 1);
    }
}

/// The path graph: eigenvalues `2 cos(k pi / (n + 1))`.
#[test]
fn known_spectrum() {
    for n in 1..=12 {
        let path = |i: usize, j: usize| f64::from(i.abs_diff(j) == 1);
        let table = table(n, path);
        let mut call = Call::new(&table, b'n', b'u', 0);
        assert_eq!(call.run(), 0);
        for k in 0..n {
            let angle = core::f64::consts::PI * (n - k) as f64 / (n + 1) as f64;
            assert_close(call.w.get(k, 0), 2.0 * angle.cos(), 1e-14);
        }
    }
}

/// Scaling by a power of two is exact, also where squares overflow or underflow.
#[test]
fn extreme_scales() {
    let a = Random(23).symmetric(7);
    let mut unit = Call::new(&a, b'V', b'U', 0);
    assert_eq!(unit.run(), 0);
    for exponent in [-900, -600, -300, 300, 600, 1000] {
        let factor = 2_f64.powi(exponent);
        let scaled = table(7, |i, j| a[i][j] * factor);
        let mut call = Call::new(&scaled, b'V', b'U', 0);
        assert_eq!(call.run(), 0);
        for j in 0..7 {
            assert_eq!(call.w.get(j, 0), unit.w.get(j, 0) * factor);
            for i in 0..7 {
                assert_eq!(call.z.get(i, j), unit.z.get(i, j));
            }
        }
    }
}

#[test]
fn workspace_query() {
    for (lwork, liwork) in [(-1, -1), (-1, 1), (1, -1)] {
        for (n, want) in [(0, (1.0, 1)), (1, (1.0, 1)), (5, (130.0, 50))] {
            let mut before = Call::new(&Random(24).symmetric(n), b'V', b'U', 0);
            (before.lwork, before.liwork) = (lwork, liwork);
            (before.work, before.iwork) = (vec![0.0; 1], vec![0; 1]);
            let mut call = before.clone();
            assert_eq!(call.run(), 0);
            assert_eq!((call.work[0], call.iwork[0]), want);
            call.assert_no_result(&before);
        }
    }
}

#[test]
fn not_finite() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for (i, j) in [(0, 0), (3, 1), (4, 4)] {
            for uplo in [b'U', b'L'] {
                let mut table = Random(25).symmetric(5);
                (table[i][j], table[j][i]) = (bad, bad);
                let before = Call::new(&table, b'V', uplo, 0);
                let mut call = before.clone();
                assert_eq!(call.run(), -5);
                call.assert_no_result(&before);
            }
        }
    }
}

#[test]
fn illegal_arguments() {
    let good = Call::new(&Random(26).symmetric(4), b'V', b'U', 0);
    type Falsify = fn(&mut Call);
    let bad: [(Falsify, c_int); 9] = [
        (|c| c.jobz = b'X', -1),
        (|c| c.range = b'I', -2),
        (|c| c.range = b'V', -2),
        (|c| c.uplo = b'X', -3),
        (|c| c.n = -1, -4),
        (|c| c.lda = 3, -6),
        (|c| c.ldz = 3, -15),
        (|c| c.lwork -= 1, -18),
        (|c| c.liwork -= 1, -20),
    ];
    for (falsify, want) in bad {
        let mut call = good.clone();
        falsify(&mut call);
        assert_eq!(call.run(), want);
        call.assert_no_result(&good);
    }
}
