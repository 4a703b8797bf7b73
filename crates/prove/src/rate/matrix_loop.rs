//! The error system of a plant of which the first derivatives are known together, for one n_o at one gain: (K) of derivation, 13.6.
//!
//! With `zs = N^(1/2) zt`, `b = N^(1/2) M`, `eta = (x, e, zs)`, `a = (x, e)` and `omega = D a` the differences of (f, q),
//!
//!   `eta' = A eta + B omega`,  `A = blkdiag(0, -sigma, Phi) + B_q ((1-b_u) sigma e' + b_u mu b')`,  `B = [[I, 0], [0, 1], [0, -b]]`,
//!
//! B_q the last column of B and b_u the input gain. Let K be the symmetric matrix, in (eta, omega), of
//!
//!   `-2 eta'Pi (A + rate) eta - 2 eta'Pi B omega - (a'Q a - 2 a'G omega - omega'H omega)`.
//!
//! Where the bracket is not negative, that is where (D) holds of D, and K is positive definite, `W = eta'Pi eta` has `W' <= -2 rate W`. K is
//! affine in b_u, so its ends serve; it does not contain the plant.

use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::real::{Operand, Real};
use sigmastar_theory::data::Data;

/// The numbers of the loop with some of its oscillators.
#[derive(Clone, Debug)]
pub struct MatrixLoop<R> {
    /// n.
    pub states: usize,
    sigma: R,
    mu: R,
    /// l w of each oscillator.
    turns: Vec<R>,
    /// b: of the integrator, then of the first state of each oscillator; that of the second is 0.
    b: Vec<R>,
    /// The ends of b_u: one where it is 1.
    gains: Vec<R>,
}

/// Q, G and H by rows, and Pi with its rate.
pub struct Multipliers<'m, R> {
    /// The rate, in 1/time.
    pub rate: &'m R,
    /// Pi by rows.
    pub pi: &'m [Vec<R>],
    /// Q, G, H by rows.
    pub slopes: [&'m [Vec<R>]; 3],
}

impl MatrixLoop<Enclosure> {
    /// The loop with these oscillators, of which each number is enclosed.
    #[must_use]
    pub fn new(data: &Data<'_>, states: usize, sigma: &Rational, oscillators: &[u32]) -> MatrixLoop<Enclosure> {
        let weights = &data.spec.internal_model.weights;
        let root = |l: u32| weights.weight(u64::from(l), data.precision).sqrt();
        let ends = data.input_gain.as_ref().map(|gain| vec![gain.low.clone(), gain.high.clone()]);
        MatrixLoop {
            states,
            sigma: data.rational(sigma),
            mu: data.mu.clone(),
            turns: oscillators.iter().map(|l| &data.base_frequency * i64::from(*l)).collect(),
            b: std::iter::once(0).chain(oscillators.iter().copied()).map(root).collect(),
            gains: ends.unwrap_or_else(|| vec![Enclosure::one(data.precision)]),
        }
    }

    /// The middles, with time in this unit.
    #[must_use]
    pub fn doubles(&self, unit: f64) -> MatrixLoop<f64> {
        let all = |of: &[Enclosure], unit: f64| of.iter().map(|value| value.midpoint_f64() * unit).collect();
        MatrixLoop {
            states: self.states,
            sigma: self.sigma.midpoint_f64() * unit,
            mu: self.mu.midpoint_f64() * unit,
            turns: all(&self.turns, unit),
            b: all(&self.b, 1.0),
            gains: all(&self.gains, 1.0),
        }
    }
}

impl<R: Real> MatrixLoop<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// The order of Pi, `n + 2 + 2 k` with k oscillators.
    #[must_use]
    pub fn order(&self) -> usize {
        self.states + 2 + 2 * self.turns.len()
    }

    /// How many ends of b_u there are.
    #[must_use]
    pub fn ends(&self) -> &[R] {
        &self.gains
    }

    /// b at an entry of eta, where it is not 0.
    fn b_at(&self, i: usize) -> Option<&R> {
        match i.checked_sub(self.states + 1)? {
            0 => self.b.first(),
            odd if odd % 2 == 1 => self.b.get(odd.div_ceil(2)),
            _ => None,
        }
    }

    /// B_q, entry by entry; none where it is 0.
    #[must_use]
    pub fn input(&self) -> Vec<Option<R>> {
        let entry = |i: usize| if i == self.states { Some(R::int(1)) } else { self.b_at(i).map(|b| -b.clone()) };
        (0..self.order()).map(entry).collect()
    }

    /// `(1 - b_u) sigma e' + b_u mu b'`, entry by entry; none where it is 0.
    #[must_use]
    pub fn feedback(&self, gain: &R) -> Vec<Option<R>> {
        let entry = |i: usize| match i == self.states {
            true => Some((R::int(1) - gain) * &self.sigma).filter(|entry| !entry.is_zero()),
            false => self.b_at(i).map(|b| gain * &self.mu * b),
        };
        (0..self.order()).map(entry).collect()
    }

    /// The one entry of a column of blkdiag(0, -sigma, Phi): where it stands, and what it is.
    #[must_use]
    pub fn drift(&self, column: usize) -> Option<(usize, R)> {
        match column.checked_sub(self.states)? {
            0 => Some((column, -self.sigma.clone())),
            1 => None,
            // Phi = l w [[0, 1], [-1, 0]] on the two states of an oscillator.
            even if even % 2 == 0 => self.turns.get(even / 2 - 1).map(|turn| (column + 1, -turn.clone())),
            odd => self.turns.get(odd / 2 - 1).map(|turn| (column - 1, turn.clone())),
        }
    }

    /// K at one end of b_u, by the rows of its lower triangle, in (eta, omega).
    #[must_use]
    pub fn form(&self, gain: &R, Multipliers { rate, pi, slopes: [q, g, h] }: &Multipliers<'_, R>) -> Vec<Vec<R>> {
        let (order, signals) = (self.order(), self.states + 1);
        let (input, feedback) = (self.input(), self.feedback(gain));
        let drift: Vec<Option<(usize, R)>> = (0..order).map(|column| self.drift(column)).collect();
        let twice = R::int(2) * *rate;
        let image = |i: usize| {
            let terms = input.iter().zip(&pi[i]).filter_map(|(b, pi)| Some(pi * b.as_ref()?));
            terms.reduce(|sum, term| sum + term).unwrap_or_else(|| R::int(0))
        };
        let image: Vec<R> = (0..order).map(image).collect();
        // (Pi A)_ij.
        let half = |i: usize, j: usize| {
            let back = feedback[j].as_ref().map(|row| &image[i] * row);
            let own = drift[j].as_ref().map(|(row, entry)| &pi[i][*row] * entry);
            match (back, own) {
                (Some(back), Some(own)) => back + own,
                (Some(one), None) | (None, Some(one)) => one,
                (None, None) => R::int(0),
            }
        };
        let of_state = |i: usize, j: usize| {
            let taken = half(i, j) + half(j, i) + &twice * &pi[i][j];
            -(if i < signals && j < signals { taken + &q[i][j] } else { taken })
        };
        // The row of omega_k and the column of eta_j.
        let between = |k: usize, j: usize| {
            let driven = if k == self.states { &image[j] } else { &pi[j][k] };
            if j < signals { &g[j][k] - driven } else { -driven.clone() }
        };
        let mut rows: Vec<Vec<R>> = (0..order).map(|i| (0..=i).map(|j| of_state(i, j)).collect()).collect();
        rows.extend((0..signals).map(|k| {
            let mut row: Vec<R> = (0..order).map(|j| between(k, j)).collect();
            row.extend(h[k][..=k].iter().cloned());
            row
        }));
        rows
    }
}
