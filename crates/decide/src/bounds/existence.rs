//! The matrix inequality (E) of existence (derivation, 13.7): decided with enclosures by subdivision.

use super::decide::Decision;
use super::engine::Engine;
use super::metric_form::MetricForm;
use rug::Rational;
use sigmastar_lang::spec::{ExistenceInequality, Metric};
use sigmastar_matrix::is_symmetric;
use sigmastar_theory::evidence::Part;

impl Engine {
    /// Decides the inequality, with so many boxes at most.
    ///
    /// Guarantee: `True` only if, for every t, every point of `|y| <= X`, `|e| <= E` around any x_0 within r of xb, and the
    /// derivatives of f and q there in the coordinates y, the matrix of [`ExistenceInequality`] is positive definite, P is symmetric of
    /// the order of the plant, and k_p, c_x and c_y are positive; with an input gain so at both ends of b with d + (1-b) value in the
    /// place of d. `False` only if it is not so at a point, or a number is not. For the
    /// caller to prove: what [`Engine::decide`] leaves to him.
    #[must_use]
    pub fn decide_existence(&self, inequality: &ExistenceInequality, effort: usize) -> Decision {
        let ExistenceInequality { x, e, matrix, k_p, c_x, c_y, value } = inequality;
        let order = self.states();
        if [k_p, c_x, c_y].into_iter().any(|number| *number <= 0) || !is_symmetric(matrix, order) {
            return Decision::FALSE;
        }
        if *x < 0 || *e < 0 {
            return Decision::UNDECIDED;
        }
        // With the metric [P 0; 0 1], and no margin of e.
        let zeros = vec![Rational::new(); order];
        let form = |moved: &Rational| MetricForm {
            metric: Metric {
                matrix: matrix.clone(),
                cross: zeros.clone(),
                weight: Rational::from(1),
                k_p: k_p.clone(),
                c_x: c_x.clone(),
                c_e: Rational::new(),
                c_y: c_y.clone(),
            },
            pulled: zeros.clone(),
            of_e: Rational::from(value * 2u32),
            moved: moved.clone(),
        };
        let ends = self.moved_slopes(value);
        self.decide_ends(&ends, (Part::All, [x, e]), effort, |values, moved| form(moved).matrix(values))
    }
}
