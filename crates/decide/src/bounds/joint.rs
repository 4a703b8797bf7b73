//! The joint inequality (Jm) of existence or of stability (derivation, 13.7): decided with enclosures by subdivision.

use super::decide::Decision;
use super::engine::Engine;
use super::metric_form::MetricForm;
use rug::Rational;
use sigmastar_lang::spec::{JointInequality, JointStability, Level, Metric};
use sigmastar_matrix::{is_positive_definite, is_symmetric};
use sigmastar_theory::evidence::Part;

impl Engine {
    /// Decides a joint inequality, with so many boxes for each metric at most.
    ///
    /// Guarantee: `True` only if, for every t, every point of `|y| <= X`, `|e| <= E` around any x_0 within r of xb, and the
    /// derivatives of f and q there in the coordinates y, both matrices of [`JointInequality`] are positive definite, both P are
    /// symmetric of the order of the plant, k_p, c_x, c_e and c_y are positive, w of the far metric is not negative and its p is 0.
    /// `False` only if it is not so at a point, or a number is not. For the caller to prove: what [`Engine::decide`] leaves to him.
    /// Of an uncertain input gain nothing is decided: joint metrics are not proved for it.
    #[must_use]
    pub fn decide_joint(&self, inequality: &JointInequality, effort: usize) -> Decision {
        let JointInequality { x, e, value, near, far } = inequality;
        let order = self.states();
        let far_fits = far.weight >= 0 && far.cross.iter().all(|entry| *entry == 0);
        if !fits(near, order) || !fits(far, order) || !far_fits || *value <= 0 {
            return Decision::FALSE;
        }
        if *x < 0 || *e < 0 || self.moves().is_some() {
            return Decision::UNDECIDED;
        }
        let sum = Rational::from(&near.weight + &far.weight);
        let [of_near, of_far] = [(near, &near.weight), (far, &sum)].map(|(metric, of_e)| MetricForm {
            metric: metric.clone(),
            pulled: near.cross.iter().map(|entry| Rational::from(entry * value)).collect(),
            of_e: Rational::from(of_e * value) * 2,
            moved: Rational::new(),
        });
        let decide = |form: &MetricForm| self.decide_part(Part::All, [x, e], effort, |values| form.matrix(values));
        decide(&of_near).and(|| decide(&of_far))
    }

    /// Decides a joint inequality that proves stability, with so many boxes for each metric at most.
    ///
    /// Guarantee: as [`Engine::decide_joint`], and for both metrics, of which `Pi` is positive definite, `P <= p_up I`,
    /// `Pi >= diag(x_low I, 0)` and `Pi >= diag(0, e_low)` with p_up, x_low and e_low positive.
    #[must_use]
    pub fn decide_joint_stability(&self, joint: &JointStability, effort: usize) -> Decision {
        let JointStability { inequality, levels } = joint;
        let decision = self.decide_joint(inequality, effort);
        let hold = || inequality.metrics().into_iter().zip(levels).all(|(metric, level)| lies_between(metric, level));
        if decision.truth.is_true() && !hold() { Decision::FALSE } else { decision }
    }
}

/// Whether a metric has this order, and its margins are positive.
pub(super) fn fits(Metric { matrix, cross, k_p, c_x, c_e, c_y, .. }: &Metric, order: usize) -> bool {
    is_symmetric(matrix, order) && cross.len() == order && [k_p, c_x, c_e, c_y].into_iter().all(|number| *number > 0)
}

/// Whether a metric is strictly between what a level says.
pub(super) fn lies_between(
    Metric { matrix, cross, weight, .. }: &Metric,
    Level { p_up, x_low, e_low }: &Level,
) -> bool {
    let n = matrix.len();
    let less = |x: &Rational, e: &Rational| {
        let entry = |i: usize, j: usize| match (i < n, j < n) {
            (true, true) if i == j => Rational::from(&matrix[i][j] - x),
            (true, true) => matrix[i][j].clone(),
            (false, false) => Rational::from(weight - e),
            _ => cross[i.min(j)].clone(),
        };
        (0..=n).map(|i| (0..=n).map(|j| entry(i, j)).collect()).collect::<Vec<Vec<Rational>>>()
    };
    let zero = Rational::new();
    let above = |i: usize, j: usize| (if i == j { p_up.clone() } else { Rational::new() }) - &matrix[i][j];
    let above: Vec<Vec<Rational>> = (0..n).map(|i| (0..n).map(|j| above(i, j)).collect()).collect();
    // Without states the matrices of P say nothing.
    [p_up, x_low, e_low].into_iter().all(|number| *number > 0)
        && is_positive_definite(&above)
        && is_positive_definite(&less(x_low, &zero))
        && is_positive_definite(&less(&zero, e_low))
}
