//! The periodic solutions of a loop, harmonic by harmonic.

use super::linear_loop::Loop;
use nalgebra::{Complex, DMatrix, DVector};
use std::f64::consts::TAU;

type C = Complex<f64>;

/// The harmonics of a force, and those of a solution beyond them.
pub const FORCED: usize = 4;
const BEYOND: usize = 20;

/// What is left of the equations at instants, relative to 1 and what is added up in them.
const LEFT: f64 = 1e-10;

/// Instants at which the largest |e| is sought.
const INSTANTS: usize = 256;

/// n_l of the family with n_0 = 2 and epsilon = 1/2.
fn weight(l: usize) -> f64 {
    if l == 0 { 2.0 } else { (l as f64).powf(-1.5) }
}

/// The harmonics `-last..=last` of q_0, x, e and zeta, the components of one harmonic one after the other, for each of the forces
/// `sqrt(2) cos(k Om t)`, `sqrt(2) sin(k Om t)`.
pub struct Answers {
    omega: f64,
    pub last: i64,
    pub forces: DMatrix<C>,
    x: DMatrix<C>,
    e: DMatrix<C>,
    zeta: DMatrix<C>,
}

impl Answers {
    /// The harmonics of the derivative.
    fn rate(&self, harmonics: &DMatrix<C>) -> DMatrix<C> {
        let each = harmonics.nrows() / self.e.nrows();
        DMatrix::from_fn(harmonics.nrows(), harmonics.ncols(), |row, column| {
            C::new(0.0, ((row / each) as i64 - self.last) as f64 * self.omega) * harmonics[(row, column)]
        })
    }

    /// v, e, x and e'.
    pub fn signals(&self, sigma: f64) -> [DMatrix<C>; 4] {
        let e_rate = self.rate(&self.e);
        [&e_rate + &self.e * C::from(sigma), self.e.clone(), self.x.clone(), e_rate]
    }

    /// The values at an instant, in periods.
    fn at(&self, harmonics: &DMatrix<C>, time: f64) -> DMatrix<f64> {
        let rows = harmonics.nrows() / self.e.nrows();
        let mut sum = DMatrix::zeros(rows, harmonics.ncols());
        for (index, k) in (-self.last..=self.last).enumerate() {
            let turn = C::from_polar(1.0, TAU * k as f64 * time);
            sum += harmonics.rows(index * rows, rows).map(|value| (value * turn).re);
        }
        sum
    }

    /// The equations of the loop at instants: with too few harmonics they would not hold.
    fn check(&self, of: &Loop) {
        let n = of.vertices[0].nrows() - 1;
        let (phi, m, mn) = of.internal_model();
        for time in [0.0, 0.137, 0.411, 0.83] {
            let now = |harmonics: &DMatrix<C>| self.at(harmonics, time);
            let (x, e, zeta) = (now(&self.x), now(&self.e), now(&self.zeta));
            let derivatives = of.derivatives(time);
            let of_states = DMatrix::from_fn(n + 1, x.ncols(), |i, j| if i < n { x[(i, j)] } else { e[(0, j)] });
            let moved = derivatives * of_states;
            let v = now(&self.forces) + moved.rows(n, 1) + mn.transpose() * &zeta * of.mu;
            let size = |matrix: &DMatrix<f64>| LEFT * (1.0 + matrix.amax());
            let x_rate = now(&self.rate(&self.x));
            assert!((&x_rate - moved.rows(0, n)).amax() < size(&x_rate), "x'");
            let e_rate = now(&self.rate(&self.e));
            assert!((&e_rate + &e * of.sigma - &v).amax() < size(&e_rate), "e'");
            let zeta_rate = now(&self.rate(&self.zeta));
            assert!((&zeta_rate - &phi * &zeta + &m * &v).amax() < size(&zeta_rate), "zeta'");
        }
    }

    /// A force of rms 1 for which the rms of a signal is largest.
    pub fn worst(&self, signal: &DMatrix<C>) -> DVector<f64> {
        let squares = (signal.adjoint() * signal).map(|value| value.re).symmetric_eigen();
        squares.eigenvectors.column(squares.eigenvalues.imax()).into_owned()
    }

    /// e at instants.
    fn errors(&self) -> impl Iterator<Item = DMatrix<f64>> {
        (0..INSTANTS).map(|i| self.at(&self.e, i as f64 / INSTANTS as f64))
    }

    /// A force of rms 1 for which |e| is largest at an instant.
    pub fn highest(&self) -> DVector<f64> {
        let row = self.errors().max_by(|a, b| a.norm().total_cmp(&b.norm())).expect("there are instants");
        row.transpose().column(0).normalize()
    }

    /// The largest |e| of a force, but for what is between the instants.
    pub fn largest_error(&self, force: &DVector<f64>) -> f64 {
        self.errors().map(|row| (row * force)[0].abs()).fold(0.0, f64::max)
    }
}

impl Loop {
    /// Phi, M and M'N.
    fn internal_model(&self) -> (DMatrix<f64>, DVector<f64>, DVector<f64>) {
        let order = 2 * self.oscillators + 1;
        let mut phi = DMatrix::zeros(order, order);
        let (mut m, mut mn) = (DVector::zeros(order), DVector::zeros(order));
        (m[0], mn[0]) = (1.0, weight(0));
        for l in 1..=self.oscillators {
            let (first, frequency) = (2 * l - 1, l as f64 * self.ratio * self.omega);
            (phi[(first, first + 1)], phi[(first + 1, first)]) = (frequency, -frequency);
            (m[first], mn[first]) = (1.0, weight(l));
        }
        (phi, m, mn)
    }

    /// zeta at a harmonic of q = e^(i k Om t).
    fn zeta(&self, k: i64) -> DVector<C> {
        let (phi, m, mn) = self.internal_model();
        let closed = phi - &m * mn.transpose() * self.mu;
        let shifted = DMatrix::from_diagonal_element(m.len(), m.len(), C::new(0.0, k as f64 * self.omega));
        (shifted - closed.map(C::from)).lu().solve(&-m.map(C::from)).expect("the internal model is stable")
    }

    /// The answers of the loop to forces of rms 1.
    pub fn answers(&self) -> Answers {
        let n = self.vertices[0].nrows() - 1;
        let harmonics = self.harmonics();
        let last = (self.first + FORCED - 1 + BEYOND) as i64;
        let (_, _, mn) = self.internal_model();
        let zeta: Vec<DVector<C>> = (-last..=last).map(|k| self.zeta(k)).collect();
        // v over q at each harmonic.
        let through: Vec<C> = zeta.iter().map(|zeta| mn.map(C::from).dot(zeta) * self.mu + 1.0).collect();
        let count = through.len();
        // f and q without q_0, from x and e.
        let mut moved = DMatrix::zeros(count * (n + 1), count * (n + 1));
        for row in 0..count {
            for (turns, part) in &harmonics {
                if let Some(column) = usize::try_from(row as i64 - turns).ok().filter(|column| *column < count) {
                    moved.view_mut((row * (n + 1), column * (n + 1)), (n + 1, n + 1)).copy_from(part);
                }
            }
        }
        let is_q = |row: usize| row % (n + 1) == n;
        let factor = |row: usize| if is_q(row) { through[row / (n + 1)] } else { C::from(1.0) };
        let frequency = |row: usize| C::new(0.0, ((row / (n + 1)) as i64 - last) as f64 * self.omega);
        let matrix = DMatrix::from_fn(moved.nrows(), moved.ncols(), |row, column| {
            let own = frequency(row) + if is_q(row) { self.sigma } else { 0.0 };
            (if row == column { own } else { C::from(0.0) }) - factor(row) * moved[(row, column)]
        });
        let mut forces = DMatrix::zeros(count * (n + 1), 2 * FORCED);
        for index in 0..FORCED {
            let k = (self.first + index) as i64;
            for (k, half) in [(k, C::from(0.5)), (-k, C::from(0.5))] {
                let row = (k + last) as usize * (n + 1) + n;
                forces[(row, 2 * index)] = half * 2f64.sqrt();
                forces[(row, 2 * index + 1)] = half * C::new(0.0, -(k.signum() as f64) * 2f64.sqrt());
            }
        }
        let right = DMatrix::from_fn(forces.nrows(), forces.ncols(), |row, column| factor(row) * forces[(row, column)]);
        let solution = matrix.lu().solve(&right).expect("one periodic solution");
        let inputs = moved * &solution + &forces;
        let of_q = |matrix: &DMatrix<C>| {
            DMatrix::from_fn(count, matrix.ncols(), |row, column| matrix[(row * (n + 1) + n, column)])
        };
        let q = of_q(&inputs);
        let x = DMatrix::from_fn(count * n, q.ncols(), |row, column| solution[(row / n * (n + 1) + row % n, column)]);
        let states = mn.len();
        let zeta = DMatrix::from_fn(count * states, q.ncols(), |row, column| {
            zeta[row / states][row % states] * q[(row / states, column)]
        });
        let answers = Answers { omega: self.omega, last, forces: of_q(&forces), x, e: of_q(&solution), zeta };
        answers.check(self);
        answers
    }
}
