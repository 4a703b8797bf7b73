//! The matrix inequality (M) of stability, on the straight path (derivation, 13.7): decided with enclosures by subdivision.

use super::PRECISION;
use super::centred::{Centred, negated};
use super::chart::{Active, Chart};
use super::decide::{Decision, OnBoxes, Values, subdivide};
use super::definite::{SymmetricValues, Verdict, definite};
use super::engine::Engine;
use super::quantity::{Quantity, Right};
use super::sampled_threshold::FloatWeights;
use super::suprema::FloatSuprema;
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_lang::expr::{Formula, Formulas, PlantVariable};
use sigmastar_lang::spec::{Bound, Constant, MatrixInequality};

/// What the least sigma at samples is enlarged by, until it is proved, and the boxes that each attempt may take.
const ATTEMPTS: [(f64, usize); 5] = [(0.001, 1500), (0.003, 3000), (0.01, 6000), (0.03, 12_000), (0.1, 20_000)];

/// Significant digits of a threshold.
const DIGITS: u32 = 6;

impl Quantity {
    /// The first derivatives `[[f_x, f_e], [q_x, q_e]]`, by the formulas themselves.
    pub(super) fn first_derivatives(formulas: &mut Formulas, sides: &[Formula], moves: bool) -> Quantity {
        let order = sides.len() - 1;
        let variables = (0..order).map(PlantVariable::State).chain([PlantVariable::Error]);
        let columns: Vec<Vec<Formula>> = variables.map(|variable| formulas.derivatives(sides, variable)).collect();
        let outputs: Vec<Formula> = (0..=order).flat_map(|row| columns.iter().map(move |column| column[row])).collect();
        let walk = formulas.walk(&outputs);
        let used = walk.all_variables();
        let active = Active {
            time: used.has(PlantVariable::Time) || moves,
            states: (0..order).filter(|&index| used.has(PlantVariable::State(index))).collect(),
            error: used.has(PlantVariable::Error),
        };
        let row = |row: usize| (0..=order).map(|column| row * (order + 1) + column).collect();
        let plain = (0..=order).map(row).collect();
        Quantity { walk, plain, along: Vec::new(), inverse: false, right: Right::One, active }
    }
}

impl Engine {
    /// Decides the inequality, with so many boxes at most; mu is that of the internal model.
    ///
    /// Guarantee: `True` only if, for every t, every point of `|y| <= X`, `|e| <= E` around any x_0 within r of xb, and the
    /// derivatives (J, g, r, d) of f and q there in the coordinates y, with `kp = 2 h/mu` and `J_+ = J + rate I`,
    /// `[[-w_x (P' + P J_+ + J_+'P), -w_x P g, -(kp/2) r'], [., 2 value, -1 - (kp/2) d], [., ., kp]]` is positive definite, and
    /// `w_x`, `h` and `rate` are positive. `False` only if it is not at a point of it. For the caller to prove: what
    /// [`Engine::decide`] leaves to him.
    #[must_use]
    pub fn decide_inequality(&self, inequality: &MatrixInequality, mu: &Constant, effort: usize) -> Decision {
        let MatrixInequality { x, e, w_x, h, rate, value } = inequality;
        if [w_x, h, rate].into_iter().any(|weight| *weight <= 0) {
            return Decision { truth: Truth::False, boxes: 0 };
        }
        if *x < 0 || *e < 0 || (self.states() > 0 && !self.has_matrix(Bound::Rate)) {
            return Decision { truth: Truth::Undecided, boxes: 0 };
        }
        let exact = |number: &Rational| Enclosure::from_rational(number, PRECISION);
        let half_k_p = exact(h) / mu.enclose(PRECISION);
        let form = Form { w_x: exact(w_x), half_k_p, rate: exact(rate), value: exact(value) };
        let quantity = self.first_derivatives();
        let chart = Chart::new(&self.region, self.period(), &quantity.active, [x, e], |index| self.extent(index));
        let mut boxes = OnBoxes::new(self, quantity, &chart);
        subdivide(&chart, effort, |cell, ball| {
            boxes.with(cell, ball, |values, frame| match form.on_box(values) {
                Some(form) => definite(frame, &form, ball),
                None => Verdict::Stuck,
            })
        })
    }

    /// The inequality with the smallest threshold that is proved and little above that of the samples: by 0.1 %, 0.3 %, 1 %, 3 % or
    /// 10 %; `None` if none is. `samples` must be of the same plant and region, with P = 1; `value` is not used.
    #[must_use]
    pub fn prove_inequality(
        &self,
        samples: &FloatSuprema,
        inequality: &MatrixInequality,
        mu: &Constant,
    ) -> Option<MatrixInequality> {
        let MatrixInequality { x, e, w_x, h, rate, .. } = inequality;
        let at = [Rational::from(x + self.region.radius()).to_f64(), e.to_f64()];
        let weights = FloatWeights { w_x: w_x.to_f64(), k_p: 2.0 * h.to_f64() / mu.to_f64(), rate: rate.to_f64() };
        let sampled = samples.refined_threshold(at, weights);
        ATTEMPTS.into_iter().find_map(|(slack, effort)| {
            let value = round_f64(sampled * (1.0 + slack), DIGITS, Direction::Up)?;
            let inequality = MatrixInequality { value, ..inequality.clone() };
            self.decide_inequality(&inequality, mu, effort).truth.is_true().then_some(inequality)
        })
    }
}

/// The numbers of F.
struct Form {
    w_x: Enclosure,
    half_k_p: Enclosure,
    rate: Enclosure,
    value: Enclosure,
}

impl Form {
    /// F on a box, with x in the first places, then e and y.
    fn on_box(&self, values: &Values<'_>) -> Option<SymmetricValues> {
        let frame = values.frame;
        let mut first = values.matrix();
        let last = first.pop()?;
        let n = first.len();
        let (row, d) = last.split_at(n);
        let columns = values.product(values.engine.region.inverse(), &first, false);
        let jacobian: Vec<Vec<Centred>> = columns.iter().map(|row| row[..n].to_vec()).collect();
        let matrix = values.engine.region.matrix();
        let jacobian = values.product(matrix, &jacobian, true);
        let row = values.product(matrix, &[row.to_vec()], true).concat();
        let constant = |value: &Enclosure| frame.constant(value.clone());
        let mut entries = Vec::new();
        if n > 0 {
            let decay = values.decay(Bound::Rate, &jacobian, &constant(&self.rate))?;
            entries.extend(decay.entries.into_iter().map(|(i, j, value)| (i, j, frame.scale(&value, &self.w_x))));
            let columns: Vec<Vec<Centred>> = columns.into_iter().map(|mut row| row.split_off(n)).collect();
            let moved = values.times_p(&columns)?;
            entries.extend(
                moved.into_iter().enumerate().map(|(i, value)| (i, n, negated(&frame.scale(&value, &self.w_x)))),
            );
        }
        entries.push((n, n, constant(&(&self.value * 2))));
        entries
            .extend(row.iter().enumerate().map(|(i, value)| (i, n + 1, negated(&frame.scale(value, &self.half_k_p)))));
        let slope = frame.add(&constant(&Enclosure::one(PRECISION)), &frame.scale(&d[0], &self.half_k_p));
        entries.push((n, n + 1, negated(&slope)));
        entries.push((n + 1, n + 1, constant(&(&self.half_k_p * 2))));
        entries.retain(|(i, j, value)| i == j || !value.is_zero());
        Some(SymmetricValues { order: n + 2, entries })
    }
}
