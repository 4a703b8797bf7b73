//! The matrix inequalities of the regulator at samples (derivation, 13.7, (Ms), and (E) at samples): decided with enclosures by
//! subdivision.

use super::PRECISION;
use super::centred::{Centred, Frame};
use super::decide::{Decision, InY, Values};
use super::definite::SymmetricValues;
use super::engine::Engine;
use super::joint::{fits, lies_between};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::Portable;
use sigmastar_lang::spec::{Bound, Level, Metric, SampledExistence, SampledInequality, SampledLoop};
use sigmastar_matrix::is_symmetric;
use sigmastar_theory::derivation::sampled_form::{Arithmetic, FormNumbers, Less, LoopNumbers, Parts, form};
use sigmastar_theory::evidence::Part;

/// What a form around a trial has at samples besides.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WithinSample {
    /// lambda > 0, the multiplier of what moves within a sample.
    pub lambda: Rational,
    /// gamma > 0, of the square of a defect of q.
    pub gamma: Rational,
}

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
        let of = LoopNumbers::enclosed(at, &self.period(), self.moves(), PRECISION);
        let [w_x, eta, lambda, rate, c_e, c_y] = [w_x, eta, lambda, rate, c_e, c_y].map(exact);
        let k_p = eta * 2 / &of.gain;
        let less = Less { e_k: c_e, e: zero(), y: c_y };
        let numbers =
            FormNumbers { of: &of, weight: Enclosure::one(PRECISION), k_p, lambda, less, gamma: None, past: None };
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
        let of = LoopNumbers::enclosed(at, &self.period(), self.moves(), PRECISION);
        let [k_p, c_e, c_y, gamma, lambda] = [k_p, c_e, c_y, gamma, lambda].map(exact);
        let less = Less { e_k: zero(), e: c_e, y: c_y };
        let numbers = FormNumbers {
            of: &of,
            weight: Enclosure::one(PRECISION),
            k_p,
            lambda,
            less,
            gamma: Some(gamma),
            past: None,
        };
        self.at_all_ends(&numbers, [x, e], effort, |values| of_existence(values, matrix, c_x))
    }

    /// Decides the forms of a trial at samples (14.6), with so many boxes at most for each end of a sample and of an input gain.
    ///
    /// Guarantee: `True` only if at every t and every point of `|y| <= X`, `|e| <= E` around the orbit of the region, with the derivatives of f and q there in the
    /// coordinates y, the matrix of each form is positive definite for s = 0 and s = h and at both ends of an input gain, for every member: F_s of (14.6a) with 3/2 h/pi for
    /// h/pi and q_0 beside `r x + d e_s`, less `c_x |x|^2 + c_e e_s^2 + c_y y^2`, with `gamma q_0^2` (14.6b). Each has a p of zeros, margins, lambda and gamma that are positive, and is strictly between
    /// what its level says. For the caller to prove: what [`Engine::decide`] leaves to him, and that T/h is the number of samples.
    #[must_use]
    pub fn decide_held_forms(
        &self,
        forms: &[(Metric, Level)],
        within: &[WithinSample],
        at: &SampledLoop,
        place: [&Rational; 2],
        effort: usize,
    ) -> Decision {
        let fits = |((metric, level), own): (&(Metric, Level), &WithinSample)| {
            let alone = metric.cross.iter().all(|entry| *entry == 0) && metric.weight > 0;
            fits(metric, self.states()) && lies_between(metric, level) && alone && own.lambda > 0 && own.gamma > 0
        };
        if forms.len() != within.len() || !forms.iter().zip(within).all(fits) || at.sigma <= 0 {
            return Decision::FALSE;
        }
        if place.into_iter().any(|end| *end < 0) {
            return Decision::UNDECIDED;
        }
        let of = LoopNumbers::enclosed(at, &self.period(), self.moves(), PRECISION).with_ripple();
        forms.iter().zip(within).fold(Decision::TRUE, |all, ((metric, _), WithinSample { lambda, gamma })| {
            let Metric { matrix, weight, k_p, c_x, c_e, c_y, .. } = metric;
            let [weight, k_p, c_e, c_y, lambda, gamma] = [weight, k_p, c_e, c_y, lambda, gamma].map(exact);
            let less = Less { e_k: zero(), e: c_e, y: c_y };
            let numbers = FormNumbers { of: &of, weight, k_p, lambda, less, gamma: Some(gamma), past: None };
            all.and(|| self.at_all_ends(&numbers, place, effort, |values| of_existence(values, matrix, c_x)))
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
        numbers.of.corners(numbers.past.is_some()).fold(Decision::TRUE, |all, corner| {
            let entries = |values: &Values<'_>| Some(form(values.frame, numbers.clone(), &corner, parts(values)?));
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

/// The form of these entries in variables whose squares have coefficients of about 1. Each variable is multiplied with a power of two,
/// exactly: the form is positive definite in these variables if and only if it is in the given ones.
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

impl Arithmetic for Frame {
    type Number = Enclosure;
    type Value = Centred;

    fn constant(&self, value: Enclosure) -> Centred {
        Frame::constant(self, value)
    }

    fn add(&self, a: &Centred, b: &Centred) -> Centred {
        Frame::add(self, a, b)
    }

    fn scale(&self, value: &Centred, factor: &Enclosure) -> Centred {
        Frame::scale(self, value, factor)
    }
}
