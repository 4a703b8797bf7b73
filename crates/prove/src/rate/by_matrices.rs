//! From balls of the first derivatives to a bound of the error for one n_o: Propositions R_D and, where (M) is proved on a path with a corner,
//! R_P of derivation, 13.6, for claims by (M) and (Jm), which have no norms of the error system.
//!
//! With `Pi > diag(0, e_low, 0)` and `Pi < diag(x_up I, e_up, z_up I)` the start has `W <= x_up dX^2 + e_up dE^2 + z_up dZ^2`, and
//! `et^2 <= W/e_low`: the factor is as in [`super::bound`].

use super::bound::{ByForm, ByMatrices, DIGITS, RateBound, SHARES, factor, lies_between};
use super::bounded_real::BoundedReal;
use super::riccati::in_digits;
use super::slopes_program::SampledSlopes;
use super::small_gain::Limit;
use crate::attempt::prove_slopes;
use faer::linalg::solvers::DenseSolveCore;
use faer::{Mat, Side};
use rug::Rational;
use sigmastar_decide::bounds::Engine;
use sigmastar_decide::rates::inequality::{RateWitness, is_definite};
use sigmastar_decide::rates::matrix_loop::{KnownSlopes, MatrixLoop, Multipliers};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, Portable, round_f64};
use sigmastar_propose::bounds::{FloatSlopes, FloatSuprema};
use sigmastar_theory::data::Data;
use sigmastar_theory::evidence::{Part, Slopes};

/// By what share the diagonal bounds of Pi may differ from the best ones.
const ROOM: f64 = 1e-3;

/// By what share balls are enlarged before they are compared: what is proved of them is about that much larger.
const SLACK: f64 = 0.002;

/// What is proved of a plant's derivatives, and where.
pub struct Tube<'a> {
    /// What decides about them.
    pub engine: &'a Engine,
    /// What samples them.
    pub samples: &'a FloatSuprema,
    /// X and E of the matrix inequality, or of the joint one, of the claim: the error box lies inside.
    pub at: [&'a Rational; 2],
    /// Those of (J, r) and of (g, d), where the matrix inequality is proved on a path with a corner.
    pub corner: Option<[[&'a Rational; 2]; 2]>,
    /// The gain and the set.
    pub start: Start<'a>,
}

/// From where solutions start, at which gain.
pub struct Start<'a> {
    /// The gain of the claim, in 1/time.
    pub sigma: &'a Rational,
    /// dX, dE, dZ.
    pub distances: [&'a Enclosure; 3],
}

/// Bounds for these numbers of oscillators, in order; `None` where nothing is proved.
///
/// Guarantee: for every solution that stays in the error box from a start within the distances, at the gain, with so many oscillators,
/// every input gain of the data and every member of a family, `|e(t) - e_per(t)| <= factor exp(-rate (t - t_0))`.
#[must_use]
pub fn bounds(data: &Data<'_>, tube: &Tube<'_>, counts: &[u32]) -> Vec<Option<RateBound<ByForm>>> {
    let mut kinds: Vec<Kind<'_>> = tube.kinds().into_iter().map(|parts| Kind::new(tube, parts)).collect();
    counts.iter().map(|n_o| bound(data, tube, &mut kinds, *n_o)).collect()
}

/// The bound at another gain, from what is proved of the derivatives already: of a plant with so many states.
///
/// Guarantee: that of [`bounds`] at the gain of `start`, for solutions that stay where `slopes` are proved.
#[must_use]
pub fn again(
    data: &Data<'_>,
    (states, start): (usize, &Start<'_>),
    slopes: &[Slopes],
    n_o: u32,
) -> Option<RateBound<ByForm>> {
    let all: Vec<u32> = (1..=n_o).collect();
    let of = MatrixLoop::new(data, states, start.sigma, &all);
    with_slopes(data, start, (&of, n_o), slopes.to_vec())
}

impl<'a> Tube<'a> {
    /// The parts of D that may be known, and where: all of it, or its columns apart.
    fn kinds(&self) -> Vec<Vec<(Part, [&'a Rational; 2])>> {
        let apart = self.corner.map(|[of_x, of_e]| vec![(Part::States, of_x), (Part::Error, of_e)]);
        std::iter::once(vec![(Part::All, self.at)]).chain(apart).collect()
    }
}

/// Parts of D, and what is sampled of them.
struct Kind<'a> {
    parts: Vec<(Part, [&'a Rational; 2])>,
    sampled: SampledSlopes<'a>,
}

impl<'a> Kind<'a> {
    fn new(tube: &Tube<'a>, parts: Vec<(Part, [&'a Rational; 2])>) -> Kind<'a> {
        let float: Vec<_> = parts.iter().map(|(part, at)| (*part, tube.engine.float_arguments(*at))).collect();
        Kind { sampled: SampledSlopes::new(tube.samples, tube.engine.states(), &float), parts }
    }

    /// Balls with which the loop of all oscillators decays fastest, of those that a program with a few of them proposes; and that rate.
    fn propose(
        &mut self,
        tube: &Tube<'_>,
        few: &MatrixLoop<Enclosure>,
        all: &MatrixLoop<Enclosure>,
    ) -> Option<(f64, Vec<FloatSlopes>)> {
        let fit = |(ball, (_, at)): (&FloatSlopes, &(Part, [&Rational; 2]))| {
            tube.samples.fitted(ball, tube.engine.float_arguments(*at))
        };
        let seen = |balls: Vec<FloatSlopes>| {
            let balls: Vec<FloatSlopes> = balls.iter().zip(&self.parts).map(fit).collect::<Option<_>>()?;
            let rounded = balls.iter().map(|ball| ball.of_share(1.0 + SLACK).rounded(DIGITS[1]));
            let rounded: Vec<Slopes> = rounded.collect::<Option<_>>()?;
            Some((equation(all, &rounded)?.1[0], balls))
        };
        self.sampled.propose(few).into_iter().filter_map(seen).max_by(|a, b| a.0.total_cmp(&b.0))
    }

    fn prove(&self, tube: &Tube<'_>, balls: &[FloatSlopes]) -> Option<Vec<Slopes>> {
        balls.iter().zip(&self.parts).map(|(ball, (_, at))| prove_slopes(tube.engine, ball, *at)).collect()
    }
}

/// The equation for what is known, with its largest rate and the multiplier of the input gain.
fn equation(of: &MatrixLoop<Enclosure>, slopes: &[Slopes]) -> Option<(BoundedReal, [f64; 2])> {
    let doubles = |of: &[Vec<Rational>]| of.iter().map(|row| row.iter().map(Rational::to_f64).collect()).collect();
    let known = slopes.iter().map(|part| known(part, of.states, doubles)).collect();
    let equation = BoundedReal::new(of.doubles(1.0), known)?;
    let largest = equation.largest_rate()?;
    Some((equation, largest))
}

/// What is proved of a part of D, for the form.
fn known<R>(
    Slopes { part, q, g, h }: &Slopes,
    states: usize,
    numbers: impl Fn(&[Vec<Rational>]) -> Vec<Vec<R>>,
) -> KnownSlopes<R> {
    KnownSlopes { columns: part.columns(states), q: numbers(q), g: numbers(g), h: numbers(h) }
}

fn bound(data: &Data<'_>, tube: &Tube<'_>, kinds: &mut [Kind<'_>], n_o: u32) -> Option<RateBound<ByForm>> {
    let states = tube.engine.states();
    let with = |oscillators: &[u32]| MatrixLoop::new(data, states, tube.start.sigma, oscillators);
    // The mode of the fastest oscillator is the slowest of the loop.
    let few: Vec<u32> = if n_o > 2 { vec![1, n_o] } else { (1..=n_o).collect() };
    let all: Vec<u32> = (1..=n_o).collect();
    let (few, of) = (with(&few), with(&all));
    let mut proposed: Vec<_> = kinds
        .iter_mut()
        .filter_map(|kind| kind.propose(tube, &few, &of).map(|(rate, balls)| (rate, balls, &*kind)))
        .collect();
    proposed.sort_by(|a, b| b.0.total_cmp(&a.0));
    proposed.iter().find_map(|(_, balls, kind)| with_slopes(data, &tube.start, (&of, n_o), kind.prove(tube, balls)?))
}

/// The best bound that follows from what is proved of D.
fn with_slopes(
    data: &Data<'_>,
    start: &Start<'_>,
    (of, n_o): (&MatrixLoop<Enclosure>, u32),
    slopes: Vec<Slopes>,
) -> Option<RateBound<ByForm>> {
    let states = of.states;
    let (equation, [largest, of_gain]) = equation(of, &slopes)?;
    SHARES.iter().find_map(|share| {
        let pi = equation.pi([largest * (1.0 + share) / 2.0, of_gain])?;
        let rate = round_f64(largest * share, 6, Direction::Down)?;
        let (upper, e_low) = diagonal_bounds(&pi, states, start.distances)?;
        DIGITS.iter().find_map(|digits| {
            let witness = RateWitness {
                rate: rate.clone(),
                w: Rational::new(),
                pi: in_digits(&pi, *digits)?,
                l: Rational::new(),
                inputs: [None, None],
            };
            let known = Known { data, of, slopes: &slopes };
            let lies = || lies_between(&witness.pi, states, &e_low, upper.each_ref(), data.precision);
            if !known.proves(&witness) || !lies() {
                return None;
            }
            let factor = factor(data, upper.each_ref().map(|value| data.rational(value)), start.distances, &e_low)?;
            let [x_up, e_up, z_up] = upper.clone();
            let x_up = (states > 0).then_some(x_up);
            let by = Some(ByMatrices { slopes: slopes.clone(), x_up });
            let limit = Limit::Middle(equation.fastest());
            let (rate, upper, e_low) = (rate.clone(), [e_up, z_up], e_low.clone());
            let proof = ByForm { witness, has_x: false, by };
            Some(RateBound { n_o, rate, proof, e_low, upper, factor, limit })
        })
    })
}

/// What is known of the loop.
struct Known<'k> {
    data: &'k Data<'k>,
    of: &'k MatrixLoop<Enclosure>,
    slopes: &'k [Slopes],
}

impl Known<'_> {
    fn enclosed(&self, of: &[Vec<Rational>]) -> Vec<Vec<Enclosure>> {
        of.iter().map(|row| row.iter().map(|value| self.data.rational(value)).collect()).collect()
    }

    /// Pi by rows from its lower triangle.
    fn full(&self, pi: &[Vec<Rational>]) -> Vec<Vec<Enclosure>> {
        let lower = self.enclosed(pi);
        (0..lower.len()).map(|i| (0..lower.len()).map(|j| lower[i.max(j)][i.min(j)].clone()).collect()).collect()
    }

    /// Whether K is proved positive definite at every end of the input gain.
    fn proves(&self, RateWitness { rate, pi, .. }: &RateWitness) -> bool {
        let slopes: Vec<_> =
            self.slopes.iter().map(|part| known(part, self.of.states, |rows| self.enclosed(rows))).collect();
        let (pi, rate) = (self.full(pi), self.data.rational(rate));
        self.of.ends().iter().all(|gain| {
            let form = self.of.form(gain, &Multipliers { rate: &rate, pi: &pi, slopes: &slopes });
            is_definite(form.len(), |i, j| form[i][j].clone())
        })
    }
}

/// x_up, e_up, z_up and e_low in floating point, rounded to the safe side: of all upper bounds some for which
/// `x_up dX^2 + e_up dE^2 + z_up dZ^2` is about least. Without states x_up is 0.
fn diagonal_bounds(pi: &Mat<f64>, states: usize, distances: [&Enclosure; 3]) -> Option<([Rational; 3], Rational)> {
    let (n, signals) = (pi.nrows(), states + 1);
    let squares = distances.map(|distance| distance.upper_f64().portable_powi(2));
    let block = |from: usize, to: usize| Mat::from_fn(to - from, to - from, |i, j| pi[(from + i, from + j)]);
    let eigen = block(signals, n).self_adjoint_eigen(Side::Lower).ok()?;
    let values: Vec<f64> = eigen.S().column_vector().iter().copied().collect();
    let across = Mat::from_fn(signals, n - signals, |i, j| pi[(i, signals + j)]) * eigen.U();
    let largest = values.iter().copied().fold(0.0, f64::max);
    let steps = (0..40).map(|k| 1.0 + ROOM * 1.4f64.portable_powi(k));
    let mut best: Option<(f64, [f64; 3])> = None;
    for z_up in steps.clone().map(|step| largest * step) {
        // The Schur complement, for z_up above the largest eigenvalue; and once more for x_up.
        let rest = Mat::from_fn(signals, signals, |i, j| {
            let taken = values.iter().enumerate().map(|(k, value)| across[(i, k)] * across[(j, k)] / (z_up - value));
            pi[(i, j)] + taken.sum::<f64>()
        });
        let corner = rest[(states, states)];
        if states == 0 {
            take(&mut best, squares, [0.0, corner, z_up]);
            continue;
        }
        let eigen = Mat::from_fn(states, states, |i, j| rest[(i, j)]).self_adjoint_eigen(Side::Lower).ok()?;
        let own: Vec<f64> = eigen.S().column_vector().iter().copied().collect();
        let column = Mat::from_fn(1, states, |_, j| rest[(states, j)]) * eigen.U();
        let most = own.iter().copied().fold(0.0, f64::max);
        for x_up in steps.clone().map(|step| most * step) {
            let taken = own.iter().enumerate().map(|(k, value)| column[(0, k)].portable_powi(2) / (x_up - value));
            take(&mut best, squares, [x_up, corner + taken.sum::<f64>(), z_up]);
        }
    }
    let (_, upper) = best?;
    let inverse = pi.partial_piv_lu().inverse();
    let low = round_f64((1.0 - ROOM) / inverse[(states, states)], 6, Direction::Down).filter(|low| *low > 0)?;
    let [x_up, e_up, z_up] = upper.map(|value| round_f64(value * (1.0 + ROOM), 6, Direction::Up));
    Some(([x_up?, e_up?, z_up?], low))
}

/// Keeps the bounds for which the sum at the start is less.
fn take(best: &mut Option<(f64, [f64; 3])>, squares: [f64; 3], upper: [f64; 3]) {
    let cost: f64 = squares.iter().zip(upper).map(|(square, upper)| square * upper).sum();
    if best.is_none_or(|(least, _)| cost < least) && cost.is_finite() {
        *best = Some((cost, upper));
    }
}
