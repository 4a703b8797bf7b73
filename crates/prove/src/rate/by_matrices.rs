//! From balls of the first derivatives to a bound of the error for given oscillators: Propositions R_D and, where (M) is proved on a path with a corner,
//! R_P of derivation, 13.6, for claims by (M) and (Jm), which have no norms of the error system.
//!
//! With `Pi > diag(0, e_low, 0)` and `Pi < diag(x_up I, e_up, z_up I)` the start has `W <= x_up dX^2 + e_up dE^2 + z_up dZ^2`, and
//! `et^2 <= W/e_low`: the factor is as in [`super::bound`].

use super::bound::{ByForm, ByMatrices, DIGITS, RateBound, SHARES, factor, lies_between};
use crate::attempt::prove_slopes;
use rug::Rational;
use sigmastar_decide::bounds::Engine;
use sigmastar_decide::rates::inequality::{RateWitness, is_definite};
use sigmastar_decide::rates::matrix_loop::{KnownSlopes, MatrixLoop, Multipliers};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::Oscillators;
use sigmastar_propose::bounds::{FloatSlopes, FloatSuprema};
use sigmastar_propose::rates::{BoundedReal, Limit, SampledSlopes};
use sigmastar_theory::data::Data;
use sigmastar_theory::evidence::{Part, Slopes};
use std::iter;

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
    /// dX, dE, dZ with some oscillators.
    pub distances: &'a dyn Fn(&Oscillators) -> [Enclosure; 3],
}

/// Bounds for each of these oscillators, in order; `None` where nothing is proved.
///
/// Guarantee: for every solution that stays in the error box from a start within the distances, at the gain, with these oscillators,
/// every input gain of the data and every member of a family, `|e(t) - e_per(t)| <= factor exp(-rate (t - t_0))`.
#[must_use]
pub fn bounds(data: &Data<'_>, tube: &Tube<'_>, asked: &[Oscillators]) -> Vec<Option<RateBound<ByForm>>> {
    let mut kinds: Vec<Kind<'_>> = tube.kinds().into_iter().map(|parts| Kind::new(tube, parts)).collect();
    asked.iter().map(|oscillators| bound(data, tube, &mut kinds, oscillators)).collect()
}

/// The bound at another gain, from what is proved of the derivatives already: of a plant with so many states.
///
/// Guarantee: that of [`bounds`] at the gain of `start`, for solutions that stay where `slopes` are proved.
#[must_use]
pub fn again(
    data: &Data<'_>,
    (states, start): (usize, &Start<'_>),
    slopes: &[Slopes],
    oscillators: &Oscillators,
) -> Option<RateBound<ByForm>> {
    let of = MatrixLoop::new(data, states, start.sigma, oscillators.beyond_mean());
    with_slopes(data, start, (&of, oscillators), slopes.to_vec())
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

fn bound(
    data: &Data<'_>,
    tube: &Tube<'_>,
    kinds: &mut [Kind<'_>],
    oscillators: &Oscillators,
) -> Option<RateBound<ByForm>> {
    let states = tube.engine.states();
    let with = |oscillators: &[u32]| MatrixLoop::new(data, states, tube.start.sigma, oscillators);
    // The mode of the fastest oscillator is the slowest of the loop.
    let all = oscillators.beyond_mean();
    let few = match all {
        [first, _, .., last] => vec![*first, *last],
        few => few.to_vec(),
    };
    let (few, of) = (with(&few), with(all));
    let mut proposed: Vec<_> = kinds
        .iter_mut()
        .filter_map(|kind| kind.propose(tube, &few, &of).map(|(rate, balls)| (rate, balls, &*kind)))
        .collect();
    proposed.sort_by(|a, b| b.0.total_cmp(&a.0));
    proposed
        .iter()
        .find_map(|(_, balls, kind)| with_slopes(data, &tube.start, (&of, oscillators), kind.prove(tube, balls)?))
}

/// The best bound that follows from what is proved of D.
fn with_slopes(
    data: &Data<'_>,
    start: &Start<'_>,
    (of, oscillators): (&MatrixLoop<Enclosure>, &Oscillators),
    slopes: Vec<Slopes>,
) -> Option<RateBound<ByForm>> {
    let states = of.states;
    let (equation, largest) = equation(of, &slopes)?;
    let distances = (start.distances)(oscillators);
    let distances = distances.each_ref();
    let proposals = SHARES.iter().flat_map(|share| {
        let of_factor = iter::once_with(|| equation.propose_factor(largest, *share, distances));
        of_factor.chain(iter::once_with(|| equation.propose(largest, *share))).flatten()
    });
    proposals.into_iter().find_map(|proposal| {
        let (upper, e_low) = proposal.diagonal_bounds_of_states(distances)?;
        DIGITS.iter().find_map(|digits| {
            let witness = proposal.in_digits(*digits)?;
            let known = Known { data, of, slopes: &slopes };
            let lies = || lies_between(&witness.pi, states, &e_low, upper.each_ref(), data.precision);
            if !known.proves(&witness) || !lies() {
                return None;
            }
            let factor = factor(data, upper.each_ref().map(|value| data.rational(value)), distances, &e_low)?;
            let [x_up, e_up, z_up] = upper.clone();
            let x_up = (states > 0).then_some(x_up);
            let by = Some(ByMatrices { slopes: slopes.clone(), x_up });
            let limit = Limit::Middle(equation.fastest());
            let (rate, upper, e_low) = (witness.rate.clone(), [e_up, z_up], e_low.clone());
            let proof = ByForm { witness, has_x: false, by };
            let oscillators = oscillators.clone();
            Some(RateBound { oscillators, rate, proof, e_low, upper, factor, limit })
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
