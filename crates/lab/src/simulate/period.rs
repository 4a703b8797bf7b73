//! One period in implicit steps of equal length: its end, its derivative, its samples.
//!
//! A step is linear in z and in what e does to it, so the derivative of all components is carried through the same weights,
//! columns beside each other: per step and column it costs the dimension times the stages. The steps of an explicit method
//! would be as short as the fastest oscillator demands, and as many evaluations each as it has stages.

use super::ClosedLoop;
use super::collocation::{Collocation, Table};
use super::integration::{IntegrationFailure, is_bounded};
use super::radau::STAGES;
use nalgebra::DMatrix;

/// The fewest steps of a period.
const FEWEST: usize = 16;

/// A period of a number of steps.
pub(super) struct Period<'l> {
    collocation: Collocation<'l>,
    table: Table,
    steps: usize,
}

/// What a period leaves.
pub(super) struct Passed {
    /// y(T).
    pub(super) end: Vec<f64>,
    /// The largest |e| at the nodes.
    pub(super) largest_error: f64,
    /// dy(T)/dy(0), where it was asked for.
    pub(super) derivative: Option<DMatrix<f64>>,
}

impl<'l> Period<'l> {
    /// The fewest steps in which no oscillator turns further than a step can follow, a power of 2.
    pub(super) fn fewest_steps(closed_loop: &ClosedLoop) -> usize {
        let needed = closed_loop.period / Table::longest(closed_loop);
        // Beyond that the work is too much anyway.
        (needed.min(1e9) as usize + 1).next_power_of_two().max(FEWEST)
    }

    pub(super) fn new(closed_loop: &'l ClosedLoop, steps: usize) -> Period<'l> {
        let table = Table::new(closed_loop, closed_loop.period / steps as f64);
        Period { collocation: Collocation::new(closed_loop), table, steps }
    }

    fn time(&self, step: usize) -> f64 {
        self.collocation.closed_loop.period * (step as f64 / self.steps as f64)
    }

    /// The stages of the step at y; the step is paid for.
    fn stages(&mut self, step: usize, y: &[f64], columns: usize) -> Result<Vec<f64>, IntegrationFailure> {
        let (t, closed_loop) = (self.time(step), self.collocation.closed_loop);
        closed_loop.pay(t, closed_loop.implicit_step_cost(columns))?;
        self.collocation.stages(&self.table, t, y).ok_or(IntegrationFailure::Escaped { t })
    }

    /// Passes a period from y, with or without the derivative.
    pub(super) fn pass(&mut self, y: &[f64], with_derivative: bool) -> Result<Passed, IntegrationFailure> {
        let closed_loop = self.collocation.closed_loop;
        let (n, d) = (closed_loop.states() + 1, closed_loop.dimension());
        let mut y = y.to_vec();
        let mut largest_error = y[n - 1].abs();
        // The rows of the derivative one after the other.
        let mut rows = with_derivative.then(|| DMatrix::<f64>::identity(d, d).as_slice().to_vec());
        for step in 0..self.steps {
            let stages = self.stages(step, &y, if with_derivative { d } else { 0 })?;
            largest_error = stages.iter().skip(n - 1).step_by(n).fold(largest_error, |most, e| most.max(e.abs()));
            if let Some(rows) = &mut rows {
                self.carry(self.time(step), &stages, rows)?;
            }
            y = self.collocation.end(&self.table, &y, &stages);
            if !is_bounded(&y) {
                return Err(IntegrationFailure::Escaped { t: self.time(step) });
            }
        }
        let derivative = rows.map(|rows| DMatrix::from_row_slice(d, d, &rows));
        Ok(Passed { end: y, largest_error, derivative })
    }

    /// Carries the rows of a derivative through the step with these stages.
    fn carry(&mut self, t: f64, stages: &[f64], rows: &mut Vec<f64>) -> Result<(), IntegrationFailure> {
        let closed_loop = self.collocation.closed_loop;
        let (n, d) = (closed_loop.states() + 1, closed_loop.dimension());
        let jacobians = self.collocation.jacobians(&self.table, t, stages);
        let factors = self.table.matrix(closed_loop.states(), &jacobians).lu();
        let (plant, z) = rows.split_at(n * d);
        let mut outputs = vec![0.0; STAGES * d];
        for (row, output) in self.table.rows.iter().zip(outputs.chunks_exact_mut(d)) {
            row.add_output(closed_loop, z, d, output);
        }
        let mut stages = DMatrix::from_fn(n * STAGES, d, |index, column| plant[index % n * d + column]);
        for (i, weights) in self.table.method.iter().enumerate() {
            for (output, weight) in outputs.chunks_exact(d).zip(weights) {
                for (column, output) in output.iter().enumerate() {
                    stages[(i * n + n - 1, column)] += weight * output;
                }
            }
        }
        if !factors.solve_mut(&mut stages) {
            return Err(IntegrationFailure::Escaped { t });
        }
        let mut end = vec![0.0; rows.len()];
        for (component, row) in end.chunks_exact_mut(d).take(n).enumerate() {
            let last = (STAGES - 1) * n + component;
            row.iter_mut().enumerate().for_each(|(column, value)| *value = stages[(last, column)]);
        }
        let e: [Vec<f64>; STAGES] =
            std::array::from_fn(|node| (0..d).map(|column| stages[(node * n + n - 1, column)]).collect());
        let nodes = std::array::from_fn(|node| e[node].as_slice());
        if let Some(row) = self.table.rows.last() {
            row.apply(z, nodes, d, &mut end[n * d..]);
        }
        *rows = end;
        Ok(())
    }

    /// y at 0, T/count, ..., T - T/count from y(0); `count` is a multiple of the steps, or divides them.
    pub(super) fn samples(&mut self, y: &[f64], count: usize) -> Result<Vec<Vec<f64>>, IntegrationFailure> {
        let closed_loop = self.collocation.closed_loop;
        let (each, stride) = ((count / self.steps).max(1), (self.steps / count).max(1));
        let places: Vec<f64> = (1..each).map(|k| k as f64 / each as f64).collect();
        let rows: Vec<_> = places.iter().map(|place| self.table.row(closed_loop, *place)).collect();
        let mut y = y.to_vec();
        let mut samples = Vec::with_capacity(count);
        for step in 0..self.steps {
            let stages = self.stages(step, &y, 0)?;
            if step.is_multiple_of(stride) {
                samples.push(y.clone());
            }
            for (place, row) in places.iter().zip(&rows) {
                samples.push(self.collocation.sample(row, *place, &y, &stages));
            }
            y = self.collocation.end(&self.table, &y, &stages);
        }
        Ok(samples)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::{Tolerance, flow};
    use sigmastar_lang::plant::Plant;
    use sigmastar_regulator::Regulator;

    /// The derivative against difference quotients of the flow, by explicit steps and, with the larger gain, by implicit ones.
    #[test]
    fn the_derivative_is_that_of_the_flow() {
        let text = include_str!("../../../../specs/plants/paper-example.json");
        let plant = Plant::from_json("paper-example", text).unwrap();
        for sigma in [3.0, 1e5] {
            let regulator = Regulator::new(sigma, 1.5, std::f64::consts::TAU, vec![2.0, 1.0, 0.4]);
            let closed_loop = ClosedLoop::new(&plant, regulator);
            let d = closed_loop.dimension();
            // A state on the slow manifold.
            let y = flow(&closed_loop, 0.0, 1.0, &closed_loop.start(&[0.3, -0.2], 0.0), Tolerance::TIGHT).unwrap();
            let passed = Period::new(&closed_loop, 64).pass(&y, true).unwrap();
            let end = flow(&closed_loop, 0.0, 1.0, &y, Tolerance::TIGHT).unwrap();
            end.iter().zip(&passed.end).for_each(|(a, b)| assert!((a - b).abs() < 1e-10, "{sigma}: {a} {b}"));
            let derivative = passed.derivative.unwrap();
            for column in (0..d).filter(|column| *column != 2 || sigma < 10.0) {
                let shifted = |by: f64| {
                    let mut y = y.clone();
                    y[column] += by;
                    flow(&closed_loop, 0.0, 1.0, &y, Tolerance::TIGHT).unwrap()
                };
                let (up, down) = (shifted(1e-4), shifted(-1e-4));
                for row in 0..d {
                    let quotient = (up[row] - down[row]) / 2e-4;
                    assert!((derivative[(row, column)] - quotient).abs() < 1e-6, "{sigma} {row} {column}: {quotient}");
                }
            }
        }
    }

    #[test]
    fn samples_are_at_equal_distances() {
        let text = include_str!("../../../../specs/plants/paper-example.json");
        let plant = Plant::from_json("paper-example", text).unwrap();
        let closed_loop = ClosedLoop::new(&plant, Regulator::new(3.0, 1.0, std::f64::consts::TAU, vec![2.0, 1.0]));
        let y = closed_loop.start(&[0.3, -0.2], 0.5);
        for (steps, count) in [(32, 128), (32, 32), (64, 16)] {
            let samples = Period::new(&closed_loop, steps).samples(&y, count).unwrap();
            assert_eq!((samples.len(), &samples[0]), (count, &y));
            for at in [1, count / 2, count - 1] {
                let exact = flow(&closed_loop, 0.0, at as f64 / count as f64, &y, Tolerance::TIGHT).unwrap();
                let error = exact.iter().zip(&samples[at]).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
                assert!(error < 1e-9, "{steps} {count} {at}: {error}");
            }
        }
    }
}
