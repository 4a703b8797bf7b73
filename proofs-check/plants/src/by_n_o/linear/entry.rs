//! What is asked of one n_o along the periodic solution, on a box of the parameters and of b (docs/mathematics.md, section 14.3).
//!
//! With `D_k = i om_k - W_k + b (sigma + i y_k (i om_k + sigma))` the harmonics are where there is an oscillator, for `|k| <= n_o` or in a set,
//! `e_k = 0`, `x_k = x_0k`, `u_k = -c_k/b`, `|zeta_k|_N^2 = 2 |c_k|^2/((b mu)^2 n_k)` (`c_0^2/((b mu)^2 n_0)` for k = 0), and elsewhere `e_k = c_k/D_k`,
//! `x_k - x_0k = R_k g e_k`, `u_k = -(sigma + i y_k (i om_k + sigma)) e_k`, `|zeta_k|_N = sqrt(g_H'(k)) |i om_k + sigma| |e_k|/Om`. At all times
//! `|zeta|_N` is at most `sqrt(|zeta_0|_N^2 + 2 sum_(1 <= k <= n_o) |zeta_k|_N^2) + 2 sum_(k > n_o) |zeta_k|_N`.

use super::answers::Answer;
use super::complex::Complex;
use super::jet::{Axes, Jet};
use super::largest::{Judgement, Signal, Times, at_most, spread};
use super::oscillators::{Beyond, Regulator};
use proofs_core::interval::Interval;
use proofs_core::rules::by_n_o::claimed;
use proofs_core::rules::by_n_o::linear::Sizes;
use rug::Rational;

/// What is bounded.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    Error,
    MeanSquare,
    Control,
    States,
    Oscillators,
}

/// A bound that is asked for.
pub struct Asked {
    /// What it bounds.
    pub quantity: Quantity,
    /// In words.
    pub what: String,
    /// Where it stands.
    pub pointer: String,
    limit: Interval,
}

/// What is asked of one n_o.
pub struct Entry {
    /// Of each harmonic of the forcing that is beyond n_o.
    beyond: Vec<(usize, Beyond)>,
    /// The weights n_k of those that are not, each with its k.
    within: Vec<(usize, Interval)>,
    /// The bounds.
    pub asked: Vec<Asked>,
}

/// The harmonics of one n_o.
struct Solution {
    error: Signal,
    /// -u.
    control: Signal,
    states: Signal,
    /// c_k of those within n_o, and what `|e_k|` of the others count with.
    within: Vec<(Interval, Jet<Complex>)>,
    beyond: Vec<(Interval, Jet<Complex>)>,
}

impl Entry {
    /// From an entry of the claim with its sizes, for these harmonics of the forcing; the control is put out over `nominal`.
    pub fn new(
        (claimed, sizes): (&claimed::Entry<'_>, &Sizes),
        regulator: &Regulator<'_>,
        harmonics: &[usize],
        (nominal, states): (&Interval, usize),
    ) -> Entry {
        let own = &claimed.oscillators;
        let (within, beyond): (Vec<usize>, Vec<usize>) = harmonics.iter().partition(|k| own.contains(**k));
        let number = |value: &Rational| Interval::rational(value, nominal.precision());
        let [e, e_rms, u] = &claimed.steady;
        let all = [
            (Quantity::Error, "|e|", number(e), format!("{}/steady/e", claimed.pointer)),
            (
                Quantity::MeanSquare,
                "the root mean square of e",
                number(e_rms),
                format!("{}/steady/e_rms", claimed.pointer),
            ),
            (
                Quantity::Control,
                "|u|, over the nominal gain where there is one,",
                number(u) * nominal,
                format!("{}/steady/u", claimed.pointer),
            ),
            (Quantity::States, "|L^-1 (x - x_0)|", number(&sizes.x), format!("{}/x", sizes.pointer)),
            (Quantity::Oscillators, "|zeta|_N", number(&sizes.zeta), format!("{}/zeta", sizes.pointer)),
        ];
        // Without a harmonic beyond n_o the error vanishes, and x is x_0; 0 is at most a number that is not negative.
        let counts = |quantity: Quantity| match quantity {
            Quantity::Error | Quantity::MeanSquare => !beyond.is_empty(),
            Quantity::States => !beyond.is_empty() && states > 0,
            Quantity::Control | Quantity::Oscillators => true,
        };
        let asked =
            all.into_iter().filter(|(quantity, ..)| counts(*quantity)).map(|(quantity, name, limit, pointer)| Asked {
                quantity,
                what: format!("{name} along the periodic solution is at most that for {}", claimed.about()),
                pointer,
                limit,
            });
        Entry {
            asked: asked.collect(),
            beyond: beyond.into_iter().map(|k| (k, regulator.beyond(own, k))).collect(),
            within: within.into_iter().map(|k| (k, regulator.weight(k))).collect(),
        }
    }

    fn solution(&self, axes: &Axes, answers: &[Answer], regulator: &Regulator<'_>, b: &Jet<Complex>) -> Solution {
        let p = regulator.om.precision();
        let mut solution = Solution {
            error: Signal(Vec::new()),
            control: Signal(Vec::new()),
            states: Signal(Vec::new()),
            within: Vec::new(),
            beyond: Vec::new(),
        };
        let of = |k: usize| answers.iter().find(|answer| answer.k == k);
        for (k, weight) in &self.within {
            let Some(answer) = of(*k) else { continue };
            let over_b = axes.over(&answer.forcing, b);
            // 2 |zeta_k|_N^2, or |zeta_0|_N^2, over |c_k/b|^2.
            let factor = if *k == 0 { 1 } else { 4 } / (regulator.mu.sqr() * weight);
            solution.control.0.push((*k, vec![over_b.clone()]));
            solution.within.push((factor, over_b));
        }
        for (k, Beyond { turn, size }) in &self.beyond {
            let Some(answer) = of(*k) else { continue };
            let frequency = Jet::constant(&Complex { re: Interval::int(0, p), im: regulator.frequency(*k) });
            let turn = Jet::constant(turn);
            let divisor = frequency.minus(&answer.transfer).plus(&axes.times(b, &turn));
            let error = axes.over(&answer.forcing, &divisor);
            solution.control.0.push((*k, vec![axes.times(&turn, &error)]));
            let states = answer.of_error.iter().map(|part| axes.times(part, &error));
            solution.states.0.push((*k, states.collect()));
            solution.beyond.push((size * 2, error.clone()));
            solution.error.0.push((*k, vec![error]));
        }
        solution
    }

    /// Decides those that are open on a box, in their order: with how much each axis contributes, a hint.
    pub fn judge(
        &self,
        open: &[usize],
        (axes, answers, b): (&Axes, &[Answer], &Jet<Complex>),
        (regulator, times): (&Regulator<'_>, &Times),
    ) -> Vec<(Judgement, Vec<f64>)> {
        let solution = self.solution(axes, answers, regulator, b);
        let along = |of: &dyn Fn(usize) -> f64| (0..axes.count()).map(of).collect::<Vec<f64>>();
        let judge = |place: &usize| {
            let Asked { quantity, limit, .. } = &self.asked[*place];
            let signal =
                |signal: &Signal| (signal.at_most(axes, limit, times), along(&|axis| signal.spread(axes, axis)));
            match quantity {
                Quantity::Error => signal(&solution.error),
                Quantity::Control => signal(&solution.control),
                Quantity::States => signal(&solution.states),
                Quantity::MeanSquare => {
                    let judgement = at_most(axes, &solution.mean_square(axes, limit.precision()), &limit.sqr(), true);
                    (judgement, along(&|axis| solution.error.spread(axes, axis)))
                }
                Quantity::Oscillators => {
                    let judgement = at_most(axes, &solution.oscillators(axes, limit.precision()), limit, false);
                    (judgement, along(&|axis| solution.spread(axes, axis)))
                }
            }
        };
        open.iter().map(judge).collect()
    }
}

impl Solution {
    /// `2 sum |e_k|^2`; e has no mean.
    fn mean_square(&self, axes: &Axes, precision: u32) -> Jet<Interval> {
        let zero = Jet::constant(&Interval::int(0, precision));
        let squares = self.beyond.iter().map(|(_, error)| axes.square(error).mapped(|square| square * 2));
        squares.fold(zero, |sum, square| sum.plus(&square))
    }

    /// The bound of `|zeta|_N`.
    fn oscillators(&self, axes: &Axes, precision: u32) -> Jet<Interval> {
        let zero = || Jet::constant(&Interval::int(0, precision));
        let square = |(factor, part): &(Interval, Jet<Complex>)| axes.square(part).mapped(|square| square * factor);
        let within = self.within.iter().map(square).fold(zero(), |sum, square| sum.plus(&square));
        let size =
            |(factor, part): &(Interval, Jet<Complex>)| axes.root(&axes.square(part)).mapped(|size| size * factor);
        self.beyond.iter().map(size).fold(axes.root(&within), |sum, size| sum.plus(&size))
    }

    fn spread(&self, axes: &Axes, axis: usize) -> f64 {
        self.within.iter().chain(&self.beyond).map(|(factor, part)| factor.to_f64() * spread(part, axes, axis)).sum()
    }
}
