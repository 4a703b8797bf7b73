//! The exponential of a matrix, and what it makes of a wave, on a box of parameters (docs/mathematics.md, section 14.6): for `0 <= s <= h`,
//! `e^(s A) - I = sum_(j >= 1) s^j A^j/j!` and `int_0^s e^((s-r) A) e^(lambda r) dr B = sum_(j >= 1) s^j g_j/j!` with `g_1 = B`,
//! `g_j = A g_(j-1) + lambda^(j-1) B`, where B is 1 in its last component and else 0.
//!
//! In the norm of the largest component, with `|A| <= a`, `|lambda| <= a`, `|A'| <= a'` for a derivative along a parameter: `|A^j| <= a^j`,
//! `|(A^j)'| <= j a^(j-1) a'`, `|g_j| <= j a^(j-1)` and `|g_j'| <= a' a^(j-2) j (j-1)/2`. So with `r_J`, which is not below `sum_(i >= J) (h a)^i/i!`, what
//! is left after J terms is at most `s a r_J` of the first and `s r_J` of the second, and of their derivatives `s a' r_J` and `(s^2 a'/2) r_(J-1)`. For
//! `J + 1 > h a` that is `(h a)^J/J!` over `1 - h a/(J+1)`.

use super::complex::Complex;
use super::jet::{Axes, Jet, Number};
use crate::time::around;
use proofs_core::interval::Interval;

/// The most terms.
const MOST_TERMS: usize = 300;

/// The powers of a matrix by rows.
pub struct Exponential<'a> {
    axes: &'a Axes,
    /// The rows of A, among complex ones.
    pub matrix: Vec<Vec<Jet<Complex>>>,
    /// `A^j/j!` for j from 1 to J.
    powers: Vec<Vec<Vec<Jet<Interval>>>>,
    /// a, and a' along each axis.
    size: Interval,
    slopes: Vec<Interval>,
    /// r_J and r_(J-1).
    rests: [Interval; 2],
}

/// `g_j/j!` for j from 1 to J.
pub struct Driven(Vec<Vec<Jet<Complex>>>);

impl<'a> Exponential<'a> {
    /// Of a matrix by its rows, for waves with `|lambda| <= fastest`, up to h.
    pub fn new(axes: &'a Axes, real: Vec<Vec<Jet<Interval>>>, fastest: &Interval, h: &Interval) -> Exponential<'a> {
        let p = h.precision();
        let norm = |of: &dyn Fn(&Jet<Interval>) -> Interval| {
            let sum = |row: &Vec<Jet<Interval>>| row.iter().fold(Interval::int(0, p), |sum, jet| sum + of(jet).abs());
            real.iter().map(sum).reduce(|a, b| a.max(&b)).unwrap_or_else(|| Interval::int(0, p)).ceiling()
        };
        let size = norm(&|jet| jet.all.clone()).max(&fastest.ceiling());
        let slope = |axis: usize| norm(&|jet| jet.slopes.get(axis).cloned().unwrap_or_else(|| Interval::int(0, p)));
        let slopes = (0..axes.count()).map(slope).collect();
        let reach = (h * &size).ceiling();
        let (count, rests) = rests(&reach);

        let mut powers = vec![real.clone()];
        for j in 2..=count as i64 {
            let next = powers.last().map(|last| times(axes, last, &real, j));
            powers.extend(next);
        }
        let matrix = real.iter().map(|row| row.iter().map(complex).collect()).collect();
        Exponential { axes, matrix, powers, size, slopes, rests }
    }

    /// The rows of A.
    pub fn real(&self) -> &[Vec<Jet<Interval>>] {
        self.powers.first().map_or(&[], Vec::as_slice)
    }

    /// `e^(s A) - I`.
    pub fn grown(&self, s: &Interval) -> Vec<Vec<Jet<Interval>>> {
        let order = self.matrix.len();
        let left = s * &self.rests[0];
        let rest = Jet {
            middle: around(&(&left * &self.size)),
            all: around(&(&left * &self.size)),
            slopes: self.slopes.iter().map(|slope| around(&(&left * slope))).collect(),
        };
        let entry = |i: usize, j: usize| {
            let terms = (1..).zip(&self.powers).map(|(power, of)| {
                let factor = s.powi(power);
                of[i][j].mapped(|value| value * &factor)
            });
            self.axes.narrowed(terms.fold(rest.clone(), |sum, term| sum.plus(&term)))
        };
        (0..order).map(|i| (0..order).map(|j| entry(i, j)).collect()).collect()
    }

    /// The terms of a wave.
    pub fn driven(&self, lambda: &Complex) -> Driven {
        let (order, p) = (self.matrix.len(), self.size.precision());
        let one = Complex::real(Interval::int(1, p));
        let unit = |i: usize| if i + 1 == order { one.clone() } else { Complex::zero(p) };
        let mut terms: Vec<Vec<Jet<Complex>>> = vec![(0..order).map(|i| Jet::constant(&unit(i))).collect()];
        // lambda^(j-1)/j!.
        let mut wave = one.clone();
        for j in 2..=self.powers.len() as i64 {
            let over = |z: Complex| Complex { re: z.re / j, im: z.im / j };
            wave = over(wave.times(lambda));
            let Some(last) = terms.last() else { break };
            let zero = Jet::constant(&Complex::zero(p));
            let next = self.matrix.iter().enumerate().map(|(i, row)| {
                let moved = plus_products(self.axes, zero.clone(), row, last).mapped(|value| over(value.clone()));
                if i + 1 == order { moved.plus(&Jet::constant(&wave)) } else { moved }
            });
            let next = next.collect();
            terms.push(next);
        }
        Driven(terms)
    }

    /// `int_0^s e^((s-r) A) e^(lambda r) dr B`.
    pub fn answer(&self, Driven(terms): &Driven, s: &Interval) -> Vec<Jet<Complex>> {
        let around = |size: Interval| {
            let part = around(&size);
            Complex { re: part.clone(), im: part }
        };
        let value = around(s * &self.rests[0]);
        let slope = |slope: &Interval| around(s.sqr() * slope * &self.rests[1] / 2);
        let rest = Jet { middle: value.clone(), all: value, slopes: self.slopes.iter().map(slope).collect() };
        let entry = |i: usize| {
            let scaled = (1..).zip(terms).map(|(power, of)| {
                let factor = s.powi(power);
                of[i].mapped(|value| value.scaled(&factor))
            });
            self.axes.narrowed(scaled.fold(rest.clone(), |sum, term| sum.plus(&term)))
        };
        (0..self.matrix.len()).map(entry).collect()
    }
}

/// J, and r_J and r_(J-1) for it. With too many terms they are undefined.
fn rests(reach: &Interval) -> (usize, [Interval; 2]) {
    let p = reach.precision();
    let undefined = (1, [(); 2].map(|()| Interval::undefined(p)));
    let x = reach.to_f64();
    let enough = (0..p).fold(1.0, |half, _| half / 2.0);
    let (mut count, mut term) = (2, x * x / 2.0);
    while !(count as f64 + 1.0 > 2.0 * x && term < enough) {
        count += 1;
        term *= x / count as f64;
        if count > MOST_TERMS || !term.is_finite() {
            return undefined;
        }
    }
    let rest = |count: usize| {
        let term = (1..=count as i64).fold(Interval::int(1, p), |term, j| term * reach / j);
        let share = 1 - reach / (count as i64 + 1);
        if share.is_positive() { term / share } else { Interval::undefined(p) }
    };
    (count, [rest(count), rest(count - 1)])
}

/// A real function among complex ones.
pub fn complex(jet: &Jet<Interval>) -> Jet<Complex> {
    jet.mapped(|value| Complex::real(value.clone()))
}

/// The sum of a function and of products.
pub fn plus_products<T: Number>(axes: &Axes, start: Jet<T>, a: &[Jet<T>], b: &[Jet<T>]) -> Jet<T> {
    a.iter().zip(b).fold(start, |sum, (a, b)| sum.plus(&axes.times(a, b)))
}

/// The column j.
pub fn column(rows: &[Vec<Jet<Interval>>], j: usize) -> Vec<Jet<Interval>> {
    rows.iter().map(|row| row[j].clone()).collect()
}

/// The product of two matrices over a number.
fn times(axes: &Axes, a: &[Vec<Jet<Interval>>], b: &[Vec<Jet<Interval>>], over: i64) -> Vec<Vec<Jet<Interval>>> {
    let columns: Vec<Vec<Jet<Interval>>> = (0..b.len()).map(|j| column(b, j)).collect();
    let zero = |row: &[Jet<Interval>]| {
        let precision = row.first().map_or(0, |jet| jet.middle.precision());
        Jet::constant(&Interval::int(0, precision))
    };
    let entry = |row: &[Jet<Interval>], column: &[Jet<Interval>]| {
        plus_products(axes, zero(row), row, column).mapped(|value| value / over)
    };
    a.iter().map(|row| columns.iter().map(|column| entry(row, column)).collect()).collect()
}
