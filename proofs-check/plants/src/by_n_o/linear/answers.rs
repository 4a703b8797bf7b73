//! What a plant that is linear in x and e answers to its forcing and to the error, harmonic by harmonic, on a box of its parameters (docs/mathematics.md,
//! section 14.3): with `R_k = (i om_k - J)^-1`, `R_k g`, `W_k = d + r R_k g` and `c_k = q_0k + r R_k f_0k`. Without e, x answers to f_0 with x_0, and q has
//! the harmonics c_k. What it answers at samples is in [`super::held`].

use super::answer::{Answer, solved};
use super::complex::Complex;
use super::jet::{Axes, Jet};
use super::system::Numbers;
use proofs_core::interval::Interval;

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
