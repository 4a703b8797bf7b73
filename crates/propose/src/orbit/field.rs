//! The right sides of a plant in doubles, along a curve of states at e = 0, with the states in units of their own: nothing that
//! is found with a [`Field`] depends on the units in which a plant is written.

use super::balance::balance;
use super::series::FloatSeries;
use nalgebra::{DMatrix, DVector};
use sigmastar_lang::expr::Evaluator;
use sigmastar_lang::plant::Plant;
use std::sync::Arc;

/// Times at which the sizes of the derivatives are looked at.
const TIMES: usize = 8;

/// Where f has no derivatives at x = 0, the units of the states are sought at these in turn: at the root of a level, say.
const ELSEWHERE: [f64; 5] = [1.0, 1e-2, 1e2, 1e-4, 1e4];

/// f, q and their derivatives at points, in doubles.
pub(crate) struct Field {
    evaluator: Evaluator,
    states: usize,
    outputs: Vec<f64>,
    /// The states of the plant in units of those of the field: powers of two.
    units: Vec<f64>,
    /// The state of the plant, which is written over.
    state: Vec<f64>,
    /// T.
    pub(crate) period: f64,
}

impl Field {
    pub(crate) fn new(plant: &Plant) -> Field {
        let program = Arc::new(plant.program_with_derivatives());
        let outputs = vec![0.0; program.outputs()];
        let states = plant.states();
        let (units, state) = (vec![1.0; states], vec![0.0; states]);
        let evaluator = Evaluator::new(program);
        let mut field = Field { evaluator, states, outputs, units, state, period: plant.period.nominal().to_f64() };
        let zero = vec![0.0; states];
        let elsewhere = ELSEWHERE.iter().map(|size| vec![*size; states]);
        for at in [zero, plant.initial.x.clone()].into_iter().chain(elsewhere) {
            if let Some(units) = field.sought_units(&at) {
                field.units = units;
                break;
            }
        }
        field
    }

    /// Units in which the couplings of the states with each other and with e are of one size, at a state in the units of now;
    /// `None` where they are not finite.
    fn sought_units(&mut self, at: &[f64]) -> Option<Vec<f64>> {
        let n = self.states;
        let mut couplings = Vec::new();
        for j in 0..TIMES {
            self.set(j as f64 / TIMES as f64, at, 0.0);
            couplings.push(DMatrix::from_fn(n + 1, n + 1, |i, j| self.derivative(i, j)));
        }
        let finite = couplings.iter().flat_map(DMatrix::iter).all(|entry| entry.is_finite());
        finite.then(|| {
            let units = balance(&couplings);
            units[..n].iter().map(|unit| unit / units[n]).collect()
        })
    }

    /// A curve of the plant's states in the units of the field.
    pub(crate) fn own(&self, series: &FloatSeries) -> FloatSeries {
        series.scaled(|i| self.units[i].recip())
    }

    /// A curve in the units of the field, in those of the plant.
    pub(crate) fn written(&self, series: &FloatSeries) -> FloatSeries {
        series.scaled(|i| self.units[i])
    }

    /// The units of the states: powers of two.
    pub(crate) fn units(&self) -> &[f64] {
        &self.units
    }

    pub(crate) fn states(&self) -> usize {
        self.states
    }

    /// Evaluates everything at the time `s T`; what follows reads it. The state is in the units of the field.
    pub(crate) fn set(&mut self, s: f64, x: &[f64], e: f64) {
        self.evaluator.set_time(s * self.period);
        self.state.iter_mut().zip(x).zip(&self.units).for_each(|((state, x), unit)| *state = x * unit);
        self.evaluator.evaluate(&self.state, e, &mut self.outputs);
    }

    /// f.
    pub(crate) fn f(&self) -> DVector<f64> {
        DVector::from_fn(self.states, |i, _| self.outputs[i] / self.units[i])
    }

    /// The size of the terms of `T f` at the state that was set: f may vanish where they cancel.
    pub(crate) fn size(&self, x: &[f64]) -> f64 {
        let terms = |i: usize| {
            let own = (self.outputs[i] / self.units[i]).abs();
            (0..x.len()).map(|j| (self.derivative(i, j) * x[j]).abs()).fold(own, f64::max)
        };
        (0..self.states).map(terms).fold(0.0, f64::max) * self.period
    }

    /// The derivative of the side i (q after the last state) with respect to the state j (e after the last).
    fn derivative(&self, i: usize, j: usize) -> f64 {
        let unit = |index: usize| self.units.get(index).copied().unwrap_or(1.0);
        self.outputs[(self.states + 1) * (1 + j) + i] * (unit(j) / unit(i))
    }

    /// The derivative of f with respect to e.
    pub(crate) fn f_e(&self) -> DVector<f64> {
        DVector::from_fn(self.states, |i, _| self.derivative(i, self.states))
    }

    /// That of q with respect to x.
    pub(crate) fn q_x(&self) -> DVector<f64> {
        DVector::from_fn(self.states, |j, _| self.derivative(self.states, j))
    }

    /// That of q with respect to e.
    pub(crate) fn q_e(&self) -> f64 {
        self.derivative(self.states, self.states)
    }

    /// q.
    pub(crate) fn q(&self) -> f64 {
        self.outputs[self.states]
    }

    /// The derivative of f with respect to x.
    pub(crate) fn jacobian(&self) -> DMatrix<f64> {
        let n = self.states;
        DMatrix::from_fn(n, n, |i, j| self.derivative(i, j))
    }
}
