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
//! affine in b_u, so its ends serve; it does not contain the plant. Of parts of D that are known apart omega is the sum of what each of them makes
//! of its entries of a, and K, in eta and all of these, has a bracket for each.

use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::real::{Operand, Real};
use sigmastar_theory::data::Data;
use std::ops::Range;

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

/// What is known of some columns of D.
#[derive(Clone, Debug)]
pub struct KnownSlopes<R> {
    /// Which they are, so the entries of a that they multiply.
    pub columns: Range<usize>,
    /// Q by rows.
    pub q: Vec<Vec<R>>,
    /// G by rows.
    pub g: Vec<Vec<R>>,
    /// H by rows.
    pub h: Vec<Vec<R>>,
}

/// Pi with its rate, and what is known of D.
pub struct Multipliers<'m, R> {
    /// The rate, in 1/time.
    pub rate: &'m R,
    /// Pi by rows.
    pub pi: &'m [Vec<R>],
    /// Each part of D.
    pub slopes: &'m [KnownSlopes<R>],
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

    /// K at one end of b_u, by the rows of its lower triangle, in eta and the omega of each part.
    #[must_use]
    pub fn form(&self, gain: &R, Multipliers { rate, pi, slopes }: &Multipliers<'_, R>) -> Vec<Vec<R>> {
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
            let known = slopes.iter().find(|part| part.columns.contains(&i) && part.columns.contains(&j));
            -(match known {
                Some(KnownSlopes { columns, q, .. }) => taken + &q[i - columns.start][j - columns.start],
                None => taken,
            })
        };
        let mut rows: Vec<Vec<R>> = (0..order).map(|i| (0..=i).map(|j| of_state(i, j)).collect()).collect();
        for (part, KnownSlopes { columns, g, h, .. }) in slopes.iter().enumerate() {
            // The row of omega_k and the column of eta_j.
            let between = |k: usize, j: usize| {
                let driven = if k == self.states { &image[j] } else { &pi[j][k] };
                if columns.contains(&j) { &g[j - columns.start][k] - driven } else { -driven.clone() }
            };
            rows.extend((0..signals).map(|k| {
                let mut row: Vec<R> = (0..order).map(|j| between(k, j)).collect();
                row.extend(std::iter::repeat_n(R::int(0), part * signals));
                row.extend(h[k][..=k].iter().cloned());
                row
            }));
        }
        rows
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sigmastar_theory::evidence::Part;

    fn random(seed: &mut u64) -> f64 {
        *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / (1_u64 << 53) as f64 * 2.0 - 1.0
    }

    fn square(n: usize, seed: &mut u64, symmetric: bool) -> Vec<Vec<f64>> {
        let all: Vec<Vec<f64>> = (0..n).map(|_| (0..n).map(|_| random(seed)).collect()).collect();
        let entry = |i: usize, j: usize| if symmetric { all[i.max(j)][i.min(j)] } else { all[i][j] };
        (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect()
    }

    fn form_of(matrix: &[Vec<f64>], a: &[f64], b: &[f64]) -> f64 {
        a.iter().zip(matrix).map(|(a, row)| a * row.iter().zip(b).map(|(entry, b)| entry * b).sum::<f64>()).sum()
    }

    /// K at random vectors is `-2 eta'Pi eta' - 2 rate eta'Pi eta` less the brackets, eta' from the equations of the loop; of D as a whole, and of
    /// its columns of x and of e apart.
    #[test]
    fn k_is_the_fall_of_w_less_the_brackets() {
        let mut seed = 7;
        let loops = [(0, vec![], 1.0), (2, vec![3.0, 5.0], 1.0), (1, vec![2.5], 0.8), (3, vec![2.0], 1.3)];
        for (is_whole, (states, turns, gain)) in
            [true, false].into_iter().flat_map(|whole| loops.clone().map(|of| (whole, of)))
        {
            let (sigma, mu, rate) = (4.0, 0.7, 0.3);
            let b: Vec<f64> = (0..=turns.len()).map(|l| 1.4 / (1.0 + l as f64)).collect();
            let of = MatrixLoop { states, sigma, mu, turns: turns.clone(), b: b.clone(), gains: vec![gain] };
            let order = of.order();
            let pi = square(order, &mut seed, true);
            let parts: &[Part] = if is_whole { &[Part::All] } else { &[Part::States, Part::Error] };
            let mut known = |columns: Range<usize>| KnownSlopes {
                q: square(columns.len(), &mut seed, true),
                g: square(states + 1, &mut seed, false)[columns.clone()].to_vec(),
                h: square(states + 1, &mut seed, true),
                columns,
            };
            let slopes: Vec<KnownSlopes<f64>> = parts.iter().map(|part| known(part.columns(states))).collect();
            let form = of.form(&gain, &Multipliers { rate: &rate, pi: &pi, slopes: &slopes });
            for _ in 0..20 {
                let eta: Vec<f64> = (0..order).map(|_| random(&mut seed)).collect();
                let omegas: Vec<Vec<f64>> =
                    slopes.iter().map(|_| (0..=states).map(|_| random(&mut seed)).collect()).collect();
                let omega: Vec<f64> = (0..=states).map(|i| omegas.iter().map(|part| part[i]).sum()).collect();
                let (a, zeta) = eta.split_at(states + 1);
                let e = a[states];
                // b'zs: the second states of the oscillators do not count.
                let s: f64 = b.iter().enumerate().map(|(l, b)| b * zeta[if l == 0 { 0 } else { 2 * l - 1 }]).sum();
                let push = -gain * sigma * e + gain * mu * s + omega[states];
                let mut slope = omega.clone();
                slope[states] = push;
                let into = gain * mu * s + (1.0 - gain) * sigma * e + omega[states];
                slope.push(-b[0] * into);
                for (l, turn) in turns.iter().enumerate() {
                    slope.push(turn * zeta[2 * l + 2] - b[l + 1] * into);
                    slope.push(-turn * zeta[2 * l + 1]);
                }
                let bracket = |(KnownSlopes { columns, q, g, h }, omega): (&KnownSlopes<f64>, &Vec<f64>)| {
                    let own = &a[columns.clone()];
                    form_of(q, own, own) - 2.0 * form_of(g, own, omega) - form_of(h, omega, omega)
                };
                let brackets: f64 = slopes.iter().zip(&omegas).map(bracket).sum();
                let expected = -2.0 * form_of(&pi, &eta, &slope) - 2.0 * rate * form_of(&pi, &eta, &eta) - brackets;
                let vector = [eta.clone(), omegas.concat()].concat();
                let full: Vec<Vec<f64>> =
                    (0..form.len()).map(|i| (0..form.len()).map(|j| form[i.max(j)][i.min(j)]).collect()).collect();
                let found = form_of(&full, &vector, &vector);
                assert!(
                    (found - expected).abs() < 1e-10 * (1.0 + expected.abs()),
                    "{states} {gain}: {found} {expected}"
                );
            }
        }
    }
}
