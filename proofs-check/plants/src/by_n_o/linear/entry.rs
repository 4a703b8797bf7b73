//! What is asked of one n_o along the periodic solution, on a box of the parameters and of b (docs/mathematics.md, section 14.3).
//!
//! With `D_k = i om_k - W_k + b (sigma + i y_k (i om_k + sigma))` the harmonics are where there is an oscillator, for `|k| <= n_o` or in a set,
//! `e_k = 0`, `x_k = x_0k`, `u_k = -c_k/b`, `|zeta_k|_N^2 = 2 |c_k|^2/((b mu)^2 n_k)` (`c_0^2/((b mu)^2 n_0)` for k = 0), and elsewhere `e_k = c_k/D_k`,
//! `x_k - x_0k = R_k g e_k`, `u_k = -(sigma + i y_k (i om_k + sigma)) e_k`, `|zeta_k|_N = sqrt(g_H'(k)) |i om_k + sigma| |e_k|/Om`. At all times
//! `|zeta|_N` is at most `sqrt(|zeta_0|_N^2 + 2 sum_(1 <= k <= n_o) |zeta_k|_N^2) + 2 sum_(k > n_o) |zeta_k|_N`.
//!
//! At samples (section 14.6) `b u_k = -gamma_k/beta_k` where there is an oscillator, and elsewhere `e_k = gamma_k/(delta_k - W_k + b beta_k kappa_k)` and
//! `u_k = -kappa_k e_k`; `|zeta_k|_N^2 = 2 |u_k|^2/(K^2 n_k)`, or the factor of `|e_k|`. These are the harmonics of the values at the samples, for a phase of
//! the samples that turns each of them. Between the samples e is off the line through these values by `(h^2/8) (rho_0 + 2 sum rho_k)` at most, of which the
//! root mean square is at most `(h^2/8) sqrt(rho_0^2 + 2 sum rho_k^2)`.

use super::answer::Answer;
use super::bound::{Bound, Judgement};
use super::complex::Complex;
use super::held::Held;
use super::jet::{Axes, Jet, Number};
use super::largest::{Signal, Times, at_most, both, spread};
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
    /// y, of a law with a delay.
    Last,
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
    /// What `|e_k|` counts with in y.
    moved: Vec<Interval>,
    /// rho_k, each with its k: at samples.
    rates: Vec<(usize, Bound)>,
}

/// What is known of a plant on a box.
pub struct OnBox<'b> {
    pub axes: &'b Axes,
    /// Of each harmonic of the forcing.
    pub answers: &'b [Answer],
    /// At samples.
    pub held: Option<&'b Held<'b>>,
    /// b.
    pub gain: &'b Jet<Complex>,
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
        let last = sizes.y.iter().map(|y| (Quantity::Last, "|y|", number(y), format!("{}/y", sizes.pointer)));
        let at_samples = regulator.at_samples.is_some();
        // Without a harmonic beyond n_o the error vanishes, and x is x_0, at samples y alone; 0 is at most a number that is not negative.
        let counts = |quantity: Quantity| match quantity {
            Quantity::Error | Quantity::MeanSquare => !beyond.is_empty() || at_samples,
            Quantity::States => (!beyond.is_empty() || at_samples) && states > 0,
            Quantity::Last => !beyond.is_empty(),
            Quantity::Control | Quantity::Oscillators => true,
        };
        let all = all.into_iter().chain(last).filter(|(quantity, ..)| counts(*quantity));
        let asked = all.map(|(quantity, name, limit, pointer)| Asked {
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

    fn solution(&self, on_box: &OnBox<'_>, regulator: &Regulator<'_>) -> Solution {
        let OnBox { axes, answers, gain: b, .. } = on_box;
        let mut solution = Solution {
            error: Signal(Vec::new()),
            control: Signal(Vec::new()),
            states: Signal(Vec::new()),
            within: Vec::new(),
            beyond: Vec::new(),
            moved: Vec::new(),
            rates: Vec::new(),
        };
        let zero = Jet::constant(&Complex::zero(regulator.om.precision()));
        let of = |k: usize| answers.iter().find(|answer| answer.k == k);
        for (k, weight) in &self.within {
            let Some(answer) = of(*k) else { continue };
            // -b u_k.
            let needed = match &answer.between {
                None => answer.forcing.clone(),
                Some(between) => axes.over(&answer.forcing, &between.of_control),
            };
            let over_b = axes.over(&needed, b);
            // 2 |zeta_k|_N^2, or |zeta_0|_N^2, over |c_k/b|^2.
            let factor = if *k == 0 { 1 } else { 4 } / (regulator.mu.sqr() * weight);
            solution.control.0.push((*k, vec![over_b.clone()]));
            solution.within.push((factor, over_b));
            on_box.between(&mut solution, answer, [&zero, &needed.mapped(Number::opposite)]);
        }
        for (k, Beyond { turn, size, moved }) in &self.beyond {
            let Some(answer) = of(*k) else { continue };
            let turn = Jet::constant(turn);
            // b kappa_k, and beta_k times that at samples.
            let pull = axes.times(b, &turn);
            let pushed = match &answer.between {
                None => pull.clone(),
                Some(between) => axes.times(&between.of_control, &pull),
            };
            let divisor = Jet::constant(&answer.speed).minus(&answer.transfer).plus(&pushed);
            let error = axes.over(&answer.forcing, &divisor);
            solution.control.0.push((*k, vec![axes.times(&turn, &error)]));
            match &answer.between {
                None => {
                    let states = answer.of_error.iter().map(|part| axes.times(part, &error));
                    solution.states.0.push((*k, states.collect()));
                }
                Some(_) => {
                    let control = axes.times(&pull, &error).mapped(Number::opposite);
                    on_box.between(&mut solution, answer, [&error, &control]);
                }
            }
            solution.beyond.push((size * 2, error.clone()));
            solution.moved.push(moved * 2);
            solution.error.0.push((*k, vec![error]));
        }
        solution
    }

    /// Decides those that are open on a box, in their order: with how much each axis contributes, a hint.
    pub fn judge(
        &self,
        open: &[usize],
        on_box: &OnBox<'_>,
        (regulator, times): (&Regulator<'_>, &Times),
    ) -> Vec<(Judgement, Vec<f64>)> {
        let (solution, axes) = (self.solution(on_box, regulator), on_box.axes);
        // h^2/8.
        let share = regulator.at_samples.as_ref().map(|sampling| sampling.h.sqr() / 8);
        let along = |of: &dyn Fn(usize) -> f64| (0..axes.count()).map(of).collect::<Vec<f64>>();
        let judge = |place: &usize| {
            let Asked { quantity, limit, .. } = &self.asked[*place];
            let signal =
                |signal: &Signal| (signal.at_most(axes, limit, times), along(&|axis| signal.spread(axes, axis)));
            match quantity {
                Quantity::Error => {
                    let off = share.as_ref().map(|share| solution.off(share));
                    let judgement = solution.error.at_most_with(axes, limit, off.as_ref(), times);
                    (judgement, along(&|axis| solution.error.spread(axes, axis)))
                }
                Quantity::Control => signal(&solution.control),
                Quantity::States => signal(&solution.states),
                Quantity::MeanSquare => {
                    let judgement = match &share {
                        None => at_most(axes, &solution.mean_square(axes, limit.precision()), &limit.sqr(), true),
                        Some(share) => solution.root_mean_square(share).at_most(axes, limit),
                    };
                    (judgement, along(&|axis| solution.error.spread(axes, axis)))
                }
                Quantity::Last => {
                    let all = solution.beyond.iter().zip(&solution.moved);
                    let zero = Bound::zero(limit.precision());
                    let bound = all.fold(zero, |sum, ((_, error), moved)| sum.plus(&Bound::of(error), moved));
                    (bound.at_most(axes, limit), along(&|axis| solution.error.spread(axes, axis)))
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

impl OnBox<'_> {
    /// Adds what x is at the samples, and what e is between them, for a harmonic of e and of b u: at samples alone.
    fn between(&self, solution: &mut Solution, answer: &Answer, [error, control]: [&Jet<Complex>; 2]) {
        let Some((held, between)) = self.held.zip(answer.between.as_ref()) else { return };
        let axes = self.axes;
        let state = |(of_error, [of_control, of_forcing]): (&Jet<Complex>, &[Jet<Complex>; 2])| {
            let moved = axes.times(of_error, error).plus(&axes.times(of_control, control)).plus(of_forcing);
            axes.narrowed(moved)
        };
        let states: Vec<Jet<Complex>> = answer.of_error.iter().zip(&between.states).map(state).collect();
        let at_sample: Vec<Jet<Complex>> = states.iter().chain([error]).cloned().collect();
        solution.rates.push((answer.k, held.rate(between, &at_sample, control)));
        solution.states.0.push((answer.k, states));
    }
}

impl Solution {
    /// `share (rho_0 + 2 sum rho_k)`.
    fn off(&self, share: &Interval) -> Bound {
        let zero = Bound::zero(share.precision());
        self.rates.iter().fold(zero, |sum, (k, rate)| sum.plus(rate, &(share * both(*k))))
    }

    /// `sqrt(2 sum |e_k|^2) + share sqrt(rho_0^2 + 2 sum rho_k^2)`: a bound of the root mean square of e.
    fn root_mean_square(&self, share: &Interval) -> Bound {
        let zero = || Bound::zero(share.precision());
        let error = self.beyond.iter().fold(zero(), |all, (_, error)| all.beside(&Bound::of(error), 2));
        error.plus(&self.rates.iter().fold(zero(), |all, (k, rate)| all.beside(rate, both(*k))), share)
    }

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
