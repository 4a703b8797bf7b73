//! What a plant that is linear in x and e answers to its forcing and to the error, harmonic by harmonic, on a box of its parameters (docs/mathematics.md,
//! section 14.3): with `R_k = (i om_k - J)^-1`, `R_k g`, `W_k = d + r R_k g` and `c_k = q_0k + r R_k f_0k`. Without e, x answers to f_0 with x_0, and q has
//! the harmonics c_k. What it answers at samples is in [`super::held`].

use super::complex::Complex;
use super::held::Between;
use super::jet::{Axes, Jet};
use super::system::Numbers;
use proofs_core::interval::Interval;

/// Of one harmonic: `(i om_k - W_k) e_k = b u_k + c_k`, and at samples `(delta_k - W_k) e_k = beta_k b u_k + gamma_k`.
pub struct Answer {
    /// k.
    pub k: usize,
    /// `i om_k`, or delta_k.
    pub speed: Complex,
    /// `R_k g`, or `R_k E_xe`, in the coordinates of the claim.
    pub of_error: Vec<Jet<Complex>>,
    /// W_k.
    pub transfer: Jet<Complex>,
    /// c_k, or gamma_k.
    pub forcing: Jet<Complex>,
    /// What it has besides at samples.
    pub between: Option<Between>,
}

/// The numbers of a system in the middle of a box, on it, and of its derivatives there.
pub struct OnBox<'n> {
    /// The axes of the box.
    pub axes: &'n Axes,
    /// In the middle, on the box, and along each parameter that counts.
    pub numbers: &'n (Numbers, Numbers, Vec<Numbers>),
    /// The number of states.
    pub states: usize,
}

impl OnBox<'_> {
    fn jet(&self, of: impl Fn(&Numbers) -> Complex) -> Jet<Complex> {
        let (middle, all, slopes) = self.numbers;
        self.axes.narrowed(Jet { middle: of(middle), all: of(all), slopes: slopes.iter().map(of).collect() })
    }

    /// One of J by rows, g, r and d.
    fn part(&self, place: usize) -> Jet<Complex> {
        self.jet(|numbers| Complex::real(numbers.parts[place].clone()))
    }

    /// The harmonic k of a component of `L^-1 f_0`, or after them of q_0.
    fn forced(&self, component: usize, k: usize, precision: u32) -> Jet<Complex> {
        self.jet(|numbers| numbers.forcing[component].at(k, precision))
    }

    /// The answer at `om_k`.
    pub fn answer(&self, k: usize, frequency: &Interval) -> Answer {
        let (n, axes, p) = (self.states, self.axes, frequency.precision());
        let speed = Complex { re: Interval::int(0, p), im: frequency.clone() };
        let turn = Jet::constant(&speed);
        // The rows of [i om_k - J | g, f_0k].
        let row = |i: usize| {
            let mut row: Vec<Jet<Complex>> = (0..n)
                .map(|j| self.part(i * n + j).mapped(|value| Complex { re: -&value.re, im: -&value.im }))
                .collect();
            row[i] = row[i].plus(&turn);
            row.extend([self.part(n * n + i), self.forced(i, k, p)]);
            row
        };
        let solved = solved((0..n).map(row).collect(), axes);
        let along = |start: Jet<Complex>, which: usize| {
            let terms = solved.iter().enumerate().map(|(i, row)| axes.times(&self.part(n * n + n + i), &row[which]));
            terms.fold(start, |sum, term| sum.plus(&term))
        };
        let transfer = along(self.part(n * n + 2 * n), 0);
        let forcing = along(self.forced(n, k, p), 1);
        let of_error = solved.into_iter().map(|mut row| row.swap_remove(0)).collect();
        Answer { k, speed, of_error, transfer, forcing, between: None }
    }

    /// The rows of `[J g; r d]`.
    pub fn rows(&self) -> Vec<Vec<Jet<Interval>>> {
        let n = self.states;
        let entry = |place: usize| self.part(place).mapped(|value| value.re.clone());
        let row = |i: usize| (0..n).map(|j| entry(i * n + j)).chain([entry(n * n + i)]).collect();
        let output = (0..=n).map(|j| entry(n * n + n + j)).collect();
        (0..n).map(row).chain([output]).collect()
    }
}

/// The solutions of linear equations, by their rows of n coefficients and the right sides: what stands in the place of the right sides in the end
/// (Gauss and Jordan). The pivot is one that is large in the middle; which one it is decides nothing.
pub fn solved(mut rows: Vec<Vec<Jet<Complex>>>, axes: &Axes) -> Vec<Vec<Jet<Complex>>> {
    let n = rows.len();
    for step in 0..n {
        let size = |row: &Vec<Jet<Complex>>| row[step].middle.square().to_f64();
        let best = (step..n).max_by(|a, b| size(&rows[*a]).total_cmp(&size(&rows[*b])));
        rows.swap(step, best.unwrap_or(step));
        let pivot = rows[step][step].clone();
        rows[step].iter_mut().skip(step).for_each(|entry| *entry = axes.over(entry, &pivot));
        let own = rows[step].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != step) {
            let factor = row[step].clone();
            row.iter_mut()
                .zip(&own)
                .skip(step)
                .for_each(|(entry, other)| *entry = entry.minus(&axes.times(&factor, other)));
        }
    }
    rows.into_iter().map(|row| row.into_iter().skip(n).collect()).collect()
}
