//! Matrices with guard cells, a generator of numbers, and the naive product.

use core::ffi::c_int;

/// What guard cells hold: a NaN, so that reading one poisons the result, with a payload that no
/// arithmetic produces, so that writing one is seen.
pub const GUARD: f64 = f64::from_bits(0x7ff8_dead_beef_0001);

/// A column-major matrix with `pad` extra rows, and a margin before and after; all cells that are
/// not entries hold [`GUARD`].
#[derive(Clone)]
pub struct Matrix {
    pub rows: usize,
    pub cols: usize,
    ld: usize,
    data: Vec<f64>,
}

const MARGIN: usize = 5;

impl Matrix {
    pub fn new(rows: usize, cols: usize, pad: usize, f: impl FnMut(usize, usize) -> f64) -> Self {
        let ld = rows.max(1) + pad;
        let data = vec![GUARD; ld * cols + 2 * MARGIN];
        let mut matrix = Self { rows, cols, ld, data };
        matrix.fill(|_, _| true, f);
        matrix
    }

    /// Sets the entries that `part` selects.
    pub fn fill(&mut self, part: impl Fn(usize, usize) -> bool, mut f: impl FnMut(usize, usize) -> f64) {
        for j in 0..self.cols {
            for i in 0..self.rows {
                if part(i, j) {
                    let at = self.at(i, j);
                    self.data[at] = f(i, j);
                }
            }
        }
    }

    fn at(&self, i: usize, j: usize) -> usize {
        MARGIN + i + j * self.ld
    }

    pub fn get(&self, i: usize, j: usize) -> f64 {
        assert!(i < self.rows && j < self.cols);
        self.data[self.at(i, j)]
    }

    pub fn ld(&self) -> c_int {
        self.ld as c_int
    }

    pub fn ptr(&self) -> *const f64 {
        self.data[MARGIN..].as_ptr()
    }

    pub fn ptr_mut(&mut self) -> *mut f64 {
        self.data[MARGIN..].as_mut_ptr()
    }

    /// Every cell that is not an entry selected by `part` has the same bits as in `before`.
    pub fn assert_only_changed(&self, before: &Self, part: impl Fn(usize, usize) -> bool) {
        let mut writable = vec![false; self.data.len()];
        for j in 0..self.cols {
            for i in 0..self.rows {
                writable[self.at(i, j)] = part(i, j);
            }
        }
        for (cell, writable) in writable.into_iter().enumerate() {
            if !writable {
                let (now, then) = (self.data[cell], before.data[cell]);
                assert_eq!(now.to_bits(), then.to_bits(), "cell {cell} was written");
            }
        }
    }

    pub fn assert_unchanged(&self, before: &Self) {
        self.assert_only_changed(before, |_, _| false);
    }
}

/// One of the triangles, with the diagonal.
pub fn triangle(uplo: u8) -> impl Fn(usize, usize) -> bool + Copy {
    move |i, j| match uplo {
        b'L' | b'l' => i >= j,
        b'U' | b'u' => i <= j,
        _ => panic!("no such triangle"),
    }
}

/// Splitmix64; reproducible numbers in `[-1, 1)`.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^= x >> 31;
        (x >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    pub fn matrix(&mut self, rows: usize, cols: usize, pad: usize) -> Matrix {
        Matrix::new(rows, cols, pad, |_, _| self.next())
    }

    /// A symmetric matrix as a plain table.
    pub fn symmetric(&mut self, n: usize) -> Vec<Vec<f64>> {
        let half = self.matrix(n, n, 0);
        let entry = |i: usize, j: usize| half.get(i.max(j), i.min(j));
        table(n, entry)
    }
}

/// A square matrix as a plain table.
pub fn table(n: usize, f: impl Fn(usize, usize) -> f64) -> Vec<Vec<f64>> {
    (0..n).map(|i| (0..n).map(|j| f(i, j)).collect()).collect()
}

/// `sum over l of f(l)`.
pub fn sum(range: usize, f: impl Fn(usize) -> f64) -> f64 {
    (0..range).map(f).sum()
}

#[track_caller]
pub fn assert_close(got: f64, want: f64, tolerance: f64) {
    // Written so that a NaN fails.
    let close = (got - want).abs() <= tolerance;
    assert!(close, "got {got:e}, want {want:e}, tolerance {tolerance:e}");
}
