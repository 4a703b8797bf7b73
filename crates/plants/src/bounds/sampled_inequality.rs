//! The matrix inequalities of the regulator at samples (derivation, 13.7, (Ms), and (E) at samples): decided with enclosures by
//! subdivision, and the latter with the least gamma that is proved.

use super::PRECISION;
use super::centred::{Centred, Frame};
use super::decide::{Decision, InY, Values};
use super::definite::SymmetricValues;
use super::engine::Engine;
use super::quantity::Part;
use super::sampled_form::{FormNumbers, Less, LoopNumbers, Parts, form};
use super::sampled_point::SampledEnergy;
use super::suprema::FloatSuprema;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, Portable, round_f64};
use sigmastar_lang::spec::{Bound, SampledExistence, SampledInequality};
use sigmastar_matrix::is_symmetric;

/// The shares that gamma at samples gains until it is proved, and the boxes that each attempt may take at either end; the first is
/// for derivatives that do not vary.
const ATTEMPTS: [(f64, usize); 5] = [(1e-5, 8), (0.02, 1500), (0.08, 4000), (0.3, 12_000), (1.0, 20_000)];

/// Significant digits of gamma.
const DIGITS: u32 = 6;

impl Engine {
    /// Decides the inequality of stability, with so many boxes for each end of a sample at most.
    ///
    /// Guarantee: `True` only if, for s = 0 and s = h, both ends of an input gain, every t, every point of `|y| <= X`, `|e| <= E` around any x_0 within r of xb,
    /// and the derivatives of f and q there in the coordinates y, the matrix of [`SampledInequality`] is positive definite, and its
    /// weights, `lambda`, `rate`, `c_e` and `c_y` are positive. `False` only if it is not so at a point, or a number is not. For the
    /// caller to prove: what [`Engine::decide`] leaves to him, and that T/h is the number of samples.
    #[must_use]
    pub fn decide_sampled(&self, inequality: &SampledInequality, effort: usize) -> Decision {
        let SampledInequality { x, e, w_x, eta, lambda, rate, c_e, c_y, at } = inequality;
        if [w_x, eta, lambda, rate, c_e, c_y].into_iter().any(|number| *number <= 0) {
            return Decision::FALSE;
        }
        if *x < 0 || *e < 0 || (self.states() > 0 && !self.has_matrix(Bound::Rate)) {
            return Decision::UNDECIDED;
        }
        let of = LoopNumbers::enclosed(at, &self.period(), self.moves());
        let [w_x, eta, lambda, rate, c_e, c_y] = [w_x, eta, lambda, rate, c_e, c_y].map(exact);
        let k_p = eta * 2 / &of.gain;
        let less = Less { e_k: c_e, e: zero(), y: c_y };
        let numbers = FormNumbers { of: &of, weight: Enclosure::one(PRECISION), k_p, lambda, less, gamma: None };
        self.at_all_ends(&numbers, [x, e], effort, |values| of_stability(values, &w_x, &rate))
    }

    /// Decides the inequality of existence, in the same way.
    ///
    /// Guarantee: that of [`Engine::decide_sampled`], for the matrix of [`SampledExistence`], with P symmetric of the order of the plant.
    #[must_use]
    pub fn decide_sampled_existence(&self, inequality: &SampledExistence, effort: usize) -> Decision {
        let SampledExistence { x, e, matrix, k_p, c_x, c_e, c_y, gamma, lambda, at } = inequality;
        let order = self.states();
        if [k_p, c_x, c_e, c_y, gamma, lambda].into_iter().any(|number| *number <= 0) || !is_symmetric(matrix, order) {
            return Decision::FALSE;
        }
        if *x < 0 || *e < 0 {
            return Decision::UNDECIDED;
        }
        let of = LoopNumbers::enclosed(at, &self.period(), self.moves());
        let [k_p, c_e, c_y, gamma, lambda] = [k_p, c_e, c_y, gamma, lambda].map(exact);
        let less = Less { e_k: zero(), e: c_e, y: c_y };
        let numbers = FormNumbers { of: &of, weight: Enclosure::one(PRECISION), k_p, lambda, less, gamma: Some(gamma) };
        self.at_all_ends(&numbers, [x, e], effort, |values| of_existence(values, matrix, c_x))
    }

    /// The inequality of existence with the least gamma that is proved and little above that of the samples; `None` if none is. `samples`
    /// must be of the same plant and region; gamma is not used.
    #[must_use]
    pub fn prove_sampled_existence(
        &self,
        samples: &FloatSuprema,
        inequality: &SampledExistence,
    ) -> Option<SampledExistence> {
        let reach = self.reach(&inequality.x);
        let energy = SampledEnergy::from(inequality);
        let of = LoopNumbers::enclosed(&inequality.at, &self.period(), self.moves()).to_f64();
        let sampled = samples.refined_gamma([reach, inequality.e.to_f64()], &energy, &of);
        ATTEMPTS.into_iter().find_map(|(slack, effort)| {
            let gamma = round_f64(sampled * (1.0 + slack), DIGITS, Direction::Up).filter(|gamma| *gamma > 0)?;
            let inequality = SampledExistence { gamma, ..inequality.clone() };
            self.decide_sampled_existence(&inequality, effort).truth.is_true().then_some(inequality)
        })
    }

    /// That F is positive definite for s = 0 and for s = h, with an input gain at both of its ends.
    fn at_all_ends(
        &self,
        numbers: &FormNumbers<'_, Enclosure>,
        at: [&Rational; 2],
        effort: usize,
        parts: impl Fn(&Values<'_>) -> Option<Parts<Centred>>,
    ) -> Decision {
        numbers.of.ends().fold(Decision::TRUE, |all, end| {
            let entries = |values: &Values<'_>| Some(form(values.frame, numbers.clone(), end, parts(values)?));
            all.and(|| self.decide_part(Part::All, at, effort, |values| Some(balanced(values.frame, entries(values)?))))
        })
    }
}

fn exact(number: &Rational) -> Enclosure {
    Enclosure::from_rational(number, PRECISION)
}

fn zero() -> Enclosure {
    Enclosure::zero(PRECISION)
}

/// With w_x P(t): the block of x is `-w_x (P' + P J + J'P + 2 rate P)`.
fn of_stability(values: &Values<'_>, w_x: &Enclosure, rate: &Enclosure) -> Option<Parts<Centred>> {
    let frame = values.frame;
    let InY { jacobian, column, row: r, slope } = values.in_y(Part::All)?;
    let d = slope?;
    if r.is_empty() {
        return Some(Parts { decay: Vec::new(), moved: Vec::new(), r, d });
    }
    let decay = values.decay(Bound::Rate, &jacobian, &frame.constant(rate.clone()))?.entries;
    let decay = decay.into_iter().map(|(i, j, value)| (i, j, frame.scale(&value, w_x))).collect();
    let moved = values.times_p(&column)?.iter().map(|value| frame.scale(value, w_x)).collect();
    Some(Parts { decay, moved, r, d })
}

/// With a constant P: the block of x is `-(P J + J'P) - c_x I`.
fn of_existence(values: &Values<'_>, p: &[Vec<Rational>], c_x: &Rational) -> Option<Parts<Centred>> {
    let InY { jacobian, column, row: r, slope } = values.in_y(Part::All)?;
    let decay = values.steady_decay(p, &jacobian, c_x);
    Some(Parts { decay, moved: values.product(p, &column, false).concat(), r, d: slope? })
}

/// The same form in variables whose squares have coefficients of about 1: each is multiplied with a power of two, exactly.
fn balanced(frame: &Frame, mut entries: Vec<(usize, usize, Centred)>) -> SymmetricValues {
    let order = entries.iter().map(|(_, j, _)| j + 1).max().unwrap_or(0);
    let mut exponents = vec![0; order];
    for (i, j, value) in &entries {
        let size = value.centre.midpoint_f64();
        if i == j && size.is_normal() && size > 0.0 {
            exponents[*i] = (-0.5 * size.portable_ln() / std::f64::consts::LN_2).round() as i32;
        }
    }
    for (i, j, value) in &mut entries {
        let factor = Rational::from(1) << (exponents[*i] + exponents[*j]);
        *value = frame.scale(value, &exact(&factor));
    }
    SymmetricValues { order, entries }
}
