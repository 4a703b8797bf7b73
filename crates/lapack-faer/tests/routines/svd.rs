use crate::common::{Matrix, Random, assert_close, sum};
use core::ffi::{c_char, c_int};
use lapack_faer::{dgesdd_, dgesvd_};

#[derive(Clone, Copy, Debug, PartialEq)]
enum Routine {
    Gesdd,
    Gesvd,
}

const BOTH: [Routine; 2] = [Routine::Gesdd, Routine::Gesvd];

/// The arguments that the tests falsify, and the buffers.
#[derive(Clone)]
struct Call {
    routine: Routine,
    jobs: [u8; 2],
    m: c_int,
    n: c_int,
    lda: c_int,
    ldu: c_int,
    ldvt: c_int,
    lwork: c_int,
    a: Matrix,
    s: Matrix,
    u: Matrix,
    vt: Matrix,
    work: Vec<f64>,
}

impl Call {
    fn new(routine: Routine, a: &Matrix, pad: usize) -> Self {
        let (m, n) = (a.rows, a.cols);
        let k = m.min(n);
        let [u, vt] = [(m, k), (k, n)].map(|(r, c)| Matrix::new(r, c, pad, |_, _| f64::NAN));
        let lwork = match routine {
            Routine::Gesdd => 4 * k * k + 7 * k,
            Routine::Gesvd => (3 * k + m.max(n)).max(5 * k),
        };
        Self {
            routine,
            jobs: [b'S'; 2],
            m: m as c_int,
            n: n as c_int,
            lda: a.ld(),
            ldu: u.ld(),
            ldvt: vt.ld(),
            lwork: lwork.max(1) as c_int,
            a: a.clone(),
            s: Matrix::new(k, 1, 2, |_, _| f64::NAN),
            u,
            vt,
            work: vec![0.0; lwork.max(1)],
        }
    }

    fn run(&mut self) -> c_int {
        let [jobu, jobvt] = self.jobs.map(|x| x as c_char);
        let mut iwork = vec![0; 8 * self.s.rows + 1];
        let mut info = 99;
        // SAFETY: the buffers cover the shapes that the tests ask for.
        unsafe {
            match self.routine {
                Routine::Gesdd => dgesdd_(
                    &jobu,
                    &self.m,
                    &self.n,
                    self.a.ptr_mut(),
                    &self.lda,
                    self.s.ptr_mut(),
                    self.u.ptr_mut(),
                    &self.ldu,
                    self.vt.ptr_mut(),
                    &self.ldvt,
                    self.work.as_mut_ptr(),
                    &self.lwork,
                    iwork.as_mut_ptr(),
                    &mut info,
                ),
                Routine::Gesvd => dgesvd_(
                    &jobu,
                    &jobvt,
                    &self.m,
                    &self.n,
                    self.a.ptr_mut(),
                    &self.lda,
                    self.s.ptr_mut(),
                    self.u.ptr_mut(),
                    &self.ldu,
                    self.vt.ptr_mut(),
                    &self.ldvt,
                    self.work.as_mut_ptr(),
                    &self.lwork,
                    &mut info,
                ),
            }
        }
        info
    }

    fn assert_no_result(&self, before: &Self) {
        self.a.assert_unchanged(&before.a);
        self.s.assert_unchanged(&before.s);
        self.u.assert_unchanged(&before.u);
        self.vt.assert_unchanged(&before.vt);
    }
}

fn check(a: &Matrix, pad: usize) {
    let (m, n) = (a.rows, a.cols);
    let k = m.min(n);
    let eps = 8.0 * f64::EPSILON * (m + n + 4) as f64;
    for routine in BOTH {
        let before = Call::new(routine, a, pad);
        let mut call = before.clone();
        assert_eq!(call.run(), 0);
        call.a.assert_unchanged(&before.a);
        call.s.assert_only_changed(&before.s, |_, _| true);
        call.u.assert_only_changed(&before.u, |_, _| true);
        call.vt.assert_only_changed(&before.vt, |_, _| true);
        let (s, u, vt) = (&call.s, &call.u, &call.vt);
        for l in 0..k {
            assert!(s.get(l, 0) >= 0.0, "negative");
            assert!(l == 0 || s.get(l - 1, 0) >= s.get(l, 0), "not descending");
        }
        let norm = if k == 0 { 0.0 } else { s.get(0, 0) };
        for i in 0..m {
            for j in 0..n {
                let got = sum(k, |l| u.get(i, l) * s.get(l, 0) * vt.get(l, j));
                assert_close(got, a.get(i, j), eps * norm);
            }
        }
        for i in 0..k {
            for j in 0..k {
                let left = sum(m, |l| u.get(l, i) * u.get(l, j));
                let right = sum(n, |l| vt.get(i, l) * vt.get(j, l));
                assert_close(left, f64::from(i == j), eps);
                assert_close(right, f64::from(i == j), eps);
            }
        }
    }
}

#[test]
fn small_and_empty() {
    let mut random = Random(31);
    for m in 0..=12 {
        for n in 0..=12 {
            for pad in [0, 3] {
                check(&random.matrix(m, n, pad), pad);
            }
        }
    }
}

#[test]
fn blocked() {
    let mut random = Random(32);
    for (m, n) in [(40, 33), (33, 70), (150, 150), (1, 60), (200, 20)] {
        check(&random.matrix(m, n, 3), 3);
    }
}

#[test]
fn rank_deficient() {
    for n in 1..=12 {
        check(&Matrix::new(n, n, 1, |_, _| 0.0), 1);
        check(&Matrix::new(n, n, 1, |_, _| 1.0), 1);
        check(&Matrix::new(n, n + 1, 1, |i, j| f64::from(i == j)), 1);
        check(&Matrix::new(n, n, 1, |i, j| (1 + i) as f64 * (j as f64 - 2.0)), 1);
    }
}

/// A signed, scaled permutation, whose singular values are known exactly.
#[test]
fn known_values() {
    for routine in BOTH {
        let entry = |i, j| match (i, j) {
            (0, 2) => -3.0,
            (1, 0) => 0.25,
            (2, 3) => 7.0,
            (3, 1) => -1.0,
            _ => 0.0,
        };
        let mut call = Call::new(routine, &Matrix::new(4, 4, 0, entry), 0);
        call.jobs = [b's'; 2];
        assert_eq!(call.run(), 0);
        for (l, want) in [7.0, 3.0, 1.0, 0.25].into_iter().enumerate() {
            assert_close(call.s.get(l, 0), want, 1e-14);
        }
    }
}

/// Scaling by a power of two is exact, also where squares overflow or underflow.
#[test]
fn extreme_scales() {
    let a = Random(33).matrix(6, 5, 0);
    for routine in BOTH {
        let mut unit = Call::new(routine, &a, 0);
        assert_eq!(unit.run(), 0);
        for exponent in [-900, -600, -300, 300, 600, 1000] {
            let factor = 2_f64.powi(exponent);
            let scaled = Matrix::new(6, 5, 0, |i, j| a.get(i, j) * factor);
            let mut call = Call::new(routine, &scaled, 0);
            assert_eq!(call.run(), 0);
            for l in 0..5 {
                assert_eq!(call.s.get(l, 0), unit.s.get(l, 0) * factor);
            }
            call.u.assert_unchanged(&unit.u);
            call.vt.assert_unchanged(&unit.vt);
        }
    }
}

#[test]
fn workspace_query() {
    for (m, n, sizes) in [(0, 3, [1.0, 3.0]), (5, 3, [57.0, 15.0]), (9, 3, [57.0, 18.0])] {
        for (routine, want) in BOTH.into_iter().zip(sizes) {
            let mut before = Call::new(routine, &Random(34).matrix(m, n, 0), 0);
            before.lwork = -1;
            before.work = vec![0.0; 1];
            let mut call = before.clone();
            assert_eq!(call.run(), 0);
            assert_eq!(call.work[0], want);
            call.assert_no_result(&before);
        }
    }
}

#[test]
fn not_finite() {
    for (routine, want) in BOTH.into_iter().zip([-4, -5]) {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for at in [(0, 0), (4, 3), (2, 1)] {
                let mut a = Random(35).matrix(5, 4, 0);
                a.fill(|i, j| (i, j) == at, |_, _| bad);
                let before = Call::new(routine, &a, 0);
                let mut call = before.clone();
                assert_eq!(call.run(), want);
                call.assert_no_result(&before);
            }
        }
    }
}

#[test]
fn illegal_arguments() {
    type Falsify = fn(&mut Call);
    // For each routine the position of the argument; `dgesdd` has one job only.
    let bad: [(Falsify, [c_int; 2]); 9] = [
        (|c| c.jobs[0] = b'X', [-1, -1]),
        (|c| c.jobs = [b'A'; 2], [-1, -1]),
        (|c| c.jobs[1] = b'N', [0, -2]),
        (|c| c.m = -1, [-2, -3]),
        (|c| c.n = -1, [-3, -4]),
        (|c| c.lda = 4, [-5, -6]),
        (|c| c.ldu = 4, [-8, -9]),
        (|c| c.ldvt = 3, [-10, -11]),
        (|c| c.lwork -= 1, [-12, -13]),
    ];
    for (falsify, wants) in bad {
        for (routine, want) in BOTH.into_iter().zip(wants) {
            let good = Call::new(routine, &Random(36).matrix(5, 4, 0), 0);
            let mut call = good.clone();
            falsify(&mut call);
            assert_eq!(call.run(), want);
            if want != 0 {
                call.assert_no_result(&good);
            }
        }
    }
}
