//! The members of a linear family on a box of its parameters, and how their zero dynamics answer a harmonic.

use super::PRECISION;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::expr::TrigonometricPolynomial;
use sigmastar_theory::transfer::Complex;

/// The coefficients of all members with parameters in a box.
#[derive(Clone, Debug)]
pub struct Member {
    /// `[[A, b], [c, d]]` by rows.
    pub rows: Vec<Vec<Enclosure>>,
    /// f(t,0,0) and then q(t,0,0).
    pub waves: Vec<TrigonometricPolynomial>,
}

/// One harmonic, `e^{i k Om t}`, of the members.
#[derive(Clone, Debug)]
pub(super) struct Line {
    /// `om_k = k Om`.
    pub(super) frequency: Enclosure,
    /// `(i om_k - A)^-1 b`: the harmonic of x over that of e.
    pub(super) states: Vec<Complex>,
    /// `W_k = d + c (i om_k - A)^-1 b`.
    pub(super) transfer: Complex,
    /// c_k, the harmonic of q along the orbit.
    pub(super) forcing: Complex,
}

impl Member {
    /// The lines 0, ..., `last`; `None` where the system for one may be singular.
    pub(super) fn lines(&self, last: usize, fundamental: &Enclosure) -> Option<Vec<Line>> {
        (0..=last).map(|k| self.line(k, fundamental)).collect()
    }

    fn line(&self, k: usize, fundamental: &Enclosure) -> Option<Line> {
        let n = self.rows.len() - 1;
        let frequency = fundamental * k as i64;
        let forcing: Vec<Complex> = self.waves.iter().map(|wave| coefficient(wave, k)).collect();
        let system = (0..n)
            .map(|i| {
                let entry = |j: usize| {
                    let im = if i == j { frequency.clone() } else { Enclosure::zero(PRECISION) };
                    Complex { re: self.rows[i][j].negate(), im }
                };
                let right = [Complex::real(self.rows[i][n].clone()), forcing[i].clone()];
                (0..n).map(entry).chain(right).collect()
            })
            .collect();
        let [states, orbit] = solved(system)?;
        let along_q = |x: &[Complex], start: Complex| {
            x.iter().zip(&self.rows[n]).fold(start, |sum, (x, c)| sum.add(&x.scaled(c)))
        };
        let transfer = along_q(&states, Complex::real(self.rows[n][n].clone()));
        let forcing = along_q(&orbit, forcing[n].clone());
        Some(Line { frequency, states, transfer, forcing })
    }
}

/// The coefficient of `e^{i k Om t}`: (a_k - i b_k)/2, and the mean for k = 0.
fn coefficient(wave: &TrigonometricPolynomial, k: usize) -> Complex {
    let zero = Enclosure::zero(PRECISION);
    match k.checked_sub(1) {
        None => Complex::real(wave.mean.clone()),
        Some(index) => match wave.harmonics.get(index) {
            Some([a, b]) => Complex { re: a / 2, im: (b / 2).negate() },
            None => Complex::real(zero),
        },
    }
}

/// The solutions for both right sides, which stand in the last two columns: elimination with the pivot whose middle is largest.
///
/// Guarantee: they contain those of every system within the enclosures. `None` where a pivot may be 0.
fn solved(mut rows: Vec<Vec<Complex>>) -> Option<[Vec<Complex>; 2]> {
    let n = rows.len();
    for k in 0..n {
        let size = |row: &Vec<Complex>| row[k].re.midpoint_f64().abs() + row[k].im.midpoint_f64().abs();
        let pivot = (k..n).max_by(|&a, &b| size(&rows[a]).total_cmp(&size(&rows[b])))?;
        rows.swap(k, pivot);
        if !rows[k][k].norm_squared().is_positive().is_true() {
            return None;
        }
        let (done, rest) = rows.split_at_mut(k + 1);
        let row = &done[k];
        for other in rest {
            let factor = other[k].div(&row[k]);
            for j in k..row.len() {
                other[j] = other[j].sub(&factor.mul(&row[j]));
            }
        }
    }
    let mut solutions = [0, 1].map(|side| rows.iter().map(|row| row[n + side].clone()).collect::<Vec<Complex>>());
    for solution in &mut solutions {
        for k in (0..n).rev() {
            let known = (k + 1..n).fold(solution[k].clone(), |sum, j| sum.sub(&rows[k][j].mul(&solution[j])));
            solution[k] = known.div(&rows[k][k]);
        }
    }
    Some(solutions)
}
