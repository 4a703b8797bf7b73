//! The right sides of a plant in doubles, along a curve of states at e = 0.

use crate::expr::Evaluator;
use crate::plant::Plant;
use nalgebra::{DMatrix, DVector};
use std::sync::Arc;

/// f, q and their derivatives at points, in doubles.
pub(super) struct Field {
    evaluator: Evaluator,
    states: usize,
    outputs: Vec<f64>,
    /// T.
    pub(super) period: f64,
}

impl Field {
    pub(super) fn new(plant: &Plant) -> Field {
        let program = Arc::new(plant.program_with_derivatives());
        let outputs = vec![0.0; program.outputs()];
        Field { evaluator: Evaluator::new(program), states: plant.states(), outputs, period: plant.period.to_f64() }
    }

    pub(super) fn states(&self) -> usize {
        self.states
    }

    /// Evaluates everything at the time `s T`; what follows reads it.
    pub(super) fn set(&mut self, s: f64, x: &[f64], e: f64) {
        self.evaluator.set_time(s * self.period);
        self.evaluator.evaluate(x, e, &mut self.outputs);
    }

    /// f.
    pub(super) fn f(&self) -> DVector<f64> {
        DVector::from_column_slice(&self.outputs[..self.states])
    }

    /// The size of the terms of `T f` at the state that was set: f may vanish where they cancel.
    pub(super) fn size(&self, x: &[f64]) -> f64 {
        let terms = |i: usize| {
            (0..x.len()).map(|j| (self.jacobian_at(i, j) * x[j]).abs()).fold(self.outputs[i].abs(), f64::max)
        };
        (0..self.states).map(terms).fold(0.0, f64::max) * self.period
    }

    fn jacobian_at(&self, i: usize, j: usize) -> f64 {
        self.outputs[(self.states + 1) * (1 + j) + i]
    }

    /// q.
    pub(super) fn q(&self) -> f64 {
        self.outputs[self.states]
    }

    /// The derivative of f with respect to x.
    pub(super) fn jacobian(&self) -> DMatrix<f64> {
        let n = self.states;
        DMatrix::from_fn(n, n, |i, j| self.jacobian_at(i, j))
    }
}
