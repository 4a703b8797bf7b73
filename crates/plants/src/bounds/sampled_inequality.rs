//! The matrix inequalities of the regulator at samples (derivation, 13.7, (Ms), and (E) at samples): decided with enclosures by
//! subdivision, and the latter with the least gamma that is proved.

use super::PRECISION;
use super::centred::{Centred, Frame};
use super::decide::{Decision, Values};
use super::definite::SymmetricValues;
use super::engine::{Engine, is_symmetric};
use super::quantity::Part;
use super::sampled_form::{End, FormNumbers, Less, LoopNumbers, Parts, form};
use super::sampled_point::SampledEnergy;
use super::suprema::FloatSuprema;
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_exact::number::{Direction, Portable, round_f64};
use sigmastar_lang::spec::{Bound, SampledExistence, SampledInequality};

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
            return Decision { truth: Truth::False, boxes: 0 };
        }
        if *x < 0 || *e < 0 || (self.states() > 0 && !self.has_matrix(Bound::Rate)) {
            return Decision { truth: Truth::Undecided, boxes: 0 };
        }
        let of = LoopNumbers::enclosed(at, &self.period(), self.moves());
        let [w_x, eta, lambda, rate, c_e, c_y] = [w_x, eta, lambda, rate, c_e, c_y].map(exact);
        let k_p = eta * 2 / &of.gain;
        self.at_all_ends(&of, [x, e], effort, |values, (end, moved)| {
            let numbers = FormNumbers {
                of: &of,
                end,
                moved: moved.clone(),
                weight: Enclosure::one(PRECISION),
                k_p: k_p.clone(),
                lambda: lambda.clone(),
                less: Less { e_k: c_e.clone(), e: zero(), y: c_y.clone() },
                gamma: None,
            };
            Some(form(values.frame, numbers, of_stability(values, &w_x, &rate)?))
        })
    }

    /// Decides the inequality of existence, in the same way.
    ///
    /// Guarantee: that of [`Engine::decide_sampled`], for the matrix of [`SampledExistence`], with P symmetric of the order of the plant.
    #[must_use]
    pub fn decide_sampled_existence(&self, inequality: &SampledExistence, effort: usize) -> Decision {
        let SampledExistence { x, e, matrix, k_p, c_x, c_e, c_y, gamma, lambda, at } = inequality;
        let order = self.states();
        if [k_p, c_x, c_e, c_y, gamma, lambda].into_iter().any(|number| *number <= 0) || !is_symmetric(matrix, order) {
            return Decision { truth: Truth::False, boxes: 0 };
        }
        if *x < 0 || *e < 0 {
            return Decision { truth: Truth::Undecided, boxes: 0 };
        }
        let of = LoopNumbers::enclosed(at, &self.period(), self.moves());
        let [k_p, c_e, c_y, gamma, lambda] = [k_p, c_e, c_y, gamma, lambda].map(exact);
        self.at_all_ends(&of, [x, e], effort, |values, (end, moved)| {
            let numbers = FormNumbers {
                of: &of,
                end,
                moved: moved.clone(),
                weight: Enclosure::one(PRECISION),
                k_p: k_p.clone(),
                lambda: lambda.clone(),
                less: Less { e_k: zero(), e: c_e.clone(), y: c_y.clone() },
                gamma: Some(gamma.clone()),
            };
            Some(form(values.frame, numbers, of_existence(values, matrix, c_x)?))
        })
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
        of: &LoopNumbers<Enclosure>,
        at: [&Rational; 2],
        effort: usize,
        entries: impl Fn(&Values<'_>, (End, &Enclosure)) -> Option<Vec<(usize, usize, Centred)>>,
    ) -> Decision {
        let mut boxes = 0;
        for end in of.ends() {
            let decision =
                self.decide_part(Part::All, at, effort, |values| Some(balanced(values.frame, entries(values, end)?)));
            boxes += decision.boxes;
            if !decision.truth.is_true() {
                return Decision { boxes, ..decision };
            }
        }
        Decision { truth: Truth::True, boxes }
    }
}

fn exact(number: &Rational) -> Enclosure {
    Enclosure::from_rational(number, PRECISION)
}

fn zero() -> Enclosure {
    Enclosure::zero(PRECISION)
}

/// J, g, r and d on a box, in the coordinates y.
struct OnBox {
    jacobian: Vec<Vec<Centred>>,
    column: Vec<Vec<Centred>>,
    r: Vec<Centred>,
    d: Centred,
}

impl OnBox {
    fn new(values: &Values<'_>) -> Option<OnBox> {
        let region = values.engine.region();
        let mut of_f = values.matrix();
        let mut r = of_f.pop()?;
        let n = of_f.len();
        let d = r.pop()?;
        let column: Vec<Vec<Centred>> = of_f.iter_mut().map(|row| row.split_off(n)).collect();
        if n == 0 {
            return Some(OnBox { jacobian: Vec::new(), column, r, d });
        }
        let jacobian = values.product(region.matrix(), &values.product(region.inverse(), &of_f, false), true);
        let column = values.product(region.inverse(), &column, false);
        let r = values.product(region.matrix(), &[r], true).concat();
        Some(OnBox { jacobian, column, r, d })
    }
}

/// With w_x P(t): the block of x is `-w_x (P' + P J + J'P + 2 rate P)`.
fn of_stability(values: &Values<'_>, w_x: &Enclosure, rate: &Enclosure) -> Option<Parts<Centred>> {
    let frame = values.frame;
    let OnBox { jacobian, column, r, d } = OnBox::new(values)?;
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
    let frame = values.frame;
    let OnBox { jacobian, column, r, d } = OnBox::new(values)?;
    let n = r.len();
    if n == 0 {
        return Some(Parts { decay: Vec::new(), moved: Vec::new(), r, d });
    }
    let moved = values.product(p, &jacobian, false);
    let minus_one = Enclosure::from_integer(-1, PRECISION);
    let upper = (0..n).flat_map(|i| (i..n).map(move |j| (i, j)));
    let decay = upper.map(|(i, j)| {
        let sum = frame.add(&moved[i][j], &moved[j][i]);
        let sum = if i == j { frame.add(&sum, &frame.rational(c_x)) } else { sum };
        (i, j, frame.scale(&sum, &minus_one))
    });
    Some(Parts { decay: decay.collect(), moved: values.product(p, &column, false).concat(), r, d })
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
