//! One implicit step of the closed loop: Radau IIA of order 13 for (x, e), the oscillators exactly.
//!
//! The oscillators are linear and driven by e alone, so z within a step is a rotation of z at its start and integrals of e
//! against rotations, whose weights depend on the length of the step only. What is left to solve are the stages of (x, e):
//! a step costs the dimension times the stages, not its square, and no oscillator limits its length for stability.

use super::ClosedLoop;
use super::radau::{Integrals, NODES, STAGES, interpolation};
use nalgebra::{DMatrix, DVector, Dyn, LU};
use sigmastar_lang::expr::Evaluator;

/// Radians that an oscillator turns by within a step: a polynomial of degree 7 still follows what e answers.
const LARGEST_ANGLE: f64 = 5.0;

/// Iterations of a step.
const ITERATIONS: usize = 20;

/// Increments of this size, relative to the values of a component, are rounding.
const ROUNDING: f64 = 1e-15;

/// Where rounding lets increments fall no further, they are accepted up to this size.
const ACCEPTED: f64 = 1e-11;

/// z at a place of a step, from z at its start and from e at the nodes.
pub(super) struct Row {
    /// cos and sin of the angle by which each oscillator has turned.
    turns: Vec<(f64, f64)>,
    /// For each component of z the weights of e.
    pub(super) weights: Vec<[f64; STAGES]>,
}

impl Row {
    /// The row of the place `end` times h.
    fn new(closed_loop: &ClosedLoop, h: f64, end: f64) -> Row {
        let regulator = &closed_loop.regulator;
        let sigma = regulator.sigma;
        let integrals = Integrals::new(end);
        let mut weights = Vec::with_capacity(regulator.dimension());
        if regulator.dimension() > 0 {
            weights.push(integrals.plain().map(|integral| -sigma * h * integral));
        }
        let mut turns = Vec::with_capacity(regulator.frequencies.len());
        for frequency in &regulator.frequencies {
            let [cosines, sines] = integrals.against_rotation(h * frequency);
            weights.push(std::array::from_fn(|j| h * (frequency * sines[j] - sigma * cosines[j])));
            weights.push(std::array::from_fn(|j| h * (frequency * cosines[j] + sigma * sines[j])));
            let (sine, cosine) = libm::sincos(end * h * frequency);
            turns.push((cosine, sine));
        }
        Row { turns, weights }
    }

    /// z at the place. With several columns, those of a component follow each other in `z`, and those of a node in `e`.
    pub(super) fn apply(&self, z: &[f64], e: [&[f64]; STAGES], columns: usize, end: &mut [f64]) {
        self.turn(z, columns, end);
        for (row, weights) in end.chunks_exact_mut(columns).zip(&self.weights) {
            for (e, weight) in e.iter().zip(weights) {
                row.iter_mut().zip(*e).for_each(|(value, e)| *value += weight * e);
            }
        }
    }

    fn turn(&self, z: &[f64], columns: usize, end: &mut [f64]) {
        end.copy_from_slice(z);
        let pairs = end.get_mut(columns..).unwrap_or_default();
        for (pair, (cosine, sine)) in pairs.chunks_exact_mut(2 * columns).zip(&self.turns) {
            let (first, second) = pair.split_at_mut(columns);
            for (a, b) in first.iter_mut().zip(second) {
                (*a, *b) = (cosine * *a + sine * *b, cosine * *b - sine * *a);
            }
        }
    }

    /// Adds to `sum` what the output mu M'N z is at the place if e is 0 on the way.
    pub(super) fn add_output(&self, closed_loop: &ClosedLoop, z: &[f64], columns: usize, sum: &mut [f64]) {
        let regulator = &closed_loop.regulator;
        let b = closed_loop.acting();
        let mut weights = regulator.weights.iter().map(|weight| b * (regulator.mu * weight));
        let (Some(n_0), Some((first, pairs))) = (weights.next(), z.split_at_checked(columns)) else { return };
        sum.iter_mut().zip(first).for_each(|(sum, z)| *sum += n_0 * z);
        for ((pair, (cosine, sine)), n_l) in pairs.chunks_exact(2 * columns).zip(&self.turns).zip(weights) {
            let (a, b) = pair.split_at(columns);
            let (cosine, sine) = (n_l * cosine, n_l * sine);
            sum.iter_mut().zip(a.iter().zip(b)).for_each(|(sum, (a, b))| *sum += cosine * a + sine * b);
        }
    }
}

/// What depends on the length of a step.
pub(super) struct Table {
    /// The length h.
    pub(super) h: f64,
    /// The rows of the nodes; the last is that of the end.
    pub(super) rows: Vec<Row>,
    /// h times the matrix of the method.
    pub(super) method: [[f64; STAGES]; STAGES],
    /// `method` times what e at the nodes does to u at the nodes.
    feedback: [[f64; STAGES]; STAGES],
}

impl Table {
    /// The longest step: no oscillator turns by more than [`LARGEST_ANGLE`].
    pub(super) fn longest(closed_loop: &ClosedLoop) -> f64 {
        LARGEST_ANGLE / closed_loop.regulator.frequencies.iter().fold(0.0, |fastest: f64, w| fastest.max(*w))
    }

    pub(super) fn new(closed_loop: &ClosedLoop, h: f64) -> Table {
        let regulator = &closed_loop.regulator;
        let rows: Vec<Row> = NODES.iter().map(|node| Row::new(closed_loop, h, *node)).collect();
        let method = NODES.map(|node| Integrals::new(node).plain().map(|integral| h * integral));
        let b = closed_loop.acting();
        let direct = b * (regulator.sigma + regulator.mu * regulator.weights.iter().sum::<f64>());
        // u at node i from e at node k.
        let mut control = [[0.0; STAGES]; STAGES];
        for (i, row) in rows.iter().enumerate() {
            control[i][i] = -direct;
            // z_0, z_11, z_21, ... are weighted.
            let cosine_like = row.weights.iter().take(1).chain(row.weights.iter().skip(1).step_by(2));
            for (weights, n_l) in cosine_like.zip(&regulator.weights) {
                control[i].iter_mut().zip(weights).for_each(|(u, weight)| *u += b * (regulator.mu * n_l * weight));
            }
        }
        let feedback =
            std::array::from_fn(|i| std::array::from_fn(|k| (0..STAGES).map(|j| method[i][j] * control[j][k]).sum()));
        Table { h, rows, method, feedback }
    }

    /// The row of a place within the step.
    pub(super) fn row(&self, closed_loop: &ClosedLoop, place: f64) -> Row {
        Row::new(closed_loop, self.h, place)
    }

    /// The matrix of the linear equations for the stages of (x, e), from the Jacobians of (f, q) at the nodes.
    pub(super) fn matrix(&self, states: usize, jacobians: &[Vec<f64>]) -> DMatrix<f64> {
        let (n, size) = (states + 1, (states + 1) * STAGES);
        let mut matrix = DMatrix::identity(size, size);
        for i in 0..STAGES {
            for (j, jacobian) in jacobians.iter().enumerate() {
                for (column, entries) in jacobian.chunks_exact(n).enumerate() {
                    for (row, entry) in entries.iter().enumerate() {
                        matrix[(i * n + row, j * n + column)] -= self.method[i][j] * entry;
                    }
                }
                matrix[(i * n + states, j * n + states)] -= self.feedback[i][j];
            }
        }
        matrix
    }
}

/// The steps of one closed loop.
pub(super) struct Collocation<'l> {
    pub(super) closed_loop: &'l ClosedLoop,
    values: Evaluator,
    derivatives: Evaluator,
}

impl<'l> Collocation<'l> {
    pub(super) fn new(closed_loop: &'l ClosedLoop) -> Collocation<'l> {
        Collocation { closed_loop, values: closed_loop.evaluator(), derivatives: closed_loop.derivative_evaluator() }
    }

    /// The Jacobians of (f, q) at the nodes of a step, column by column.
    pub(super) fn jacobians(&mut self, table: &Table, t: f64, stages: &[f64]) -> Vec<Vec<f64>> {
        let n = self.closed_loop.states() + 1;
        let evaluator = &mut self.derivatives;
        let closed_loop = self.closed_loop;
        let places = stages.chunks_exact(n).zip(NODES);
        places.map(|(y, node)| closed_loop.plant_jacobian(evaluator, t + node * table.h, y)).collect()
    }

    /// (x, e) at the nodes of the step from t, node by node; `None` where the iteration does not converge: the step is too
    /// long, or a right side is undefined.
    pub(super) fn stages(&mut self, table: &Table, t: f64, y: &[f64]) -> Option<Vec<f64>> {
        let closed_loop = self.closed_loop;
        let states = closed_loop.states();
        let n = states + 1;
        let (start, z) = y.split_at(n);
        let output = table.rows.iter().map(|row| {
            let mut sum = [closed_loop.held_control()];
            row.add_output(closed_loop, z, 1, &mut sum);
            sum[0]
        });
        let output: Vec<f64> = output.collect();
        let mut stages = start.repeat(STAGES);
        let jacobians = self.jacobians(table, t, &stages);
        let mut factors: LU<f64, Dyn, Dyn> = table.matrix(states, &jacobians).lu();
        let sizes = closed_loop.natural_sizes();
        let mut slopes = vec![0.0; n * STAGES];
        let (mut previous, mut renewed) = (f64::INFINITY, false);
        for _ in 0..ITERATIONS {
            for (((y, slope), node), output) in
                stages.chunks_exact(n).zip(slopes.chunks_exact_mut(n)).zip(NODES).zip(&output)
            {
                self.values.set_time(t + node * table.h);
                self.values.evaluate(&y[..states], y[states], slope);
                slope[states] += output;
            }
            let mut step = DVector::from_fn(n * STAGES, |index, _| {
                let (i, component) = (index / n, index % n);
                let drift: f64 =
                    table.method[i].iter().zip(slopes.chunks_exact(n)).map(|(a, k)| a * k[component]).sum();
                let mut defect = start[component] - stages[index] + drift;
                if component == states {
                    let e = stages.chunks_exact(n).map(|y| y[states]);
                    defect += table.feedback[i].iter().zip(e).map(|(weight, e)| weight * e).sum::<f64>();
                }
                defect
            });
            if !factors.solve_mut(&mut step) || !step.iter().all(|value| value.is_finite()) {
                return None;
            }
            stages.iter_mut().zip(step.iter()).for_each(|(stage, step)| *stage += step);
            let mut change = 0.0_f64;
            for (component, size) in sizes.iter().enumerate().take(n) {
                let most = |values: &[f64]| {
                    values.iter().skip(component).step_by(n).fold(0.0_f64, |size, value| size.max(value.abs()))
                };
                change = change.max(most(step.as_slice()) / (most(&stages) + 1e-3 * size));
            }
            if change <= ROUNDING || (change <= ACCEPTED && change >= 0.5 * previous) {
                return Some(stages);
            }
            if change > 0.25 * previous && change > ACCEPTED {
                // Slow: the Jacobian at the start is not that of the step.
                if renewed && change > 2.0 * previous {
                    return None;
                }
                let jacobians = self.jacobians(table, t, &stages);
                if !jacobians.iter().flatten().all(|entry| entry.is_finite()) {
                    return None;
                }
                factors = table.matrix(states, &jacobians).lu();
                renewed = true;
            }
            previous = change;
        }
        None
    }

    /// y at the end of the step from y at its start and its stages.
    pub(super) fn end(&self, table: &Table, y: &[f64], stages: &[f64]) -> Vec<f64> {
        let n = self.closed_loop.states() + 1;
        let mut end = stages[(STAGES - 1) * n..].to_vec();
        end.resize(y.len(), 0.0);
        if let Some(row) = table.rows.last() {
            row.apply(&y[n..], Self::nodes_of_e(stages, n), 1, &mut end[n..]);
        }
        end
    }

    /// (x, e) at a place within the step: the polynomial through the start and the stages.
    pub(super) fn between(&self, place: f64, y: &[f64], stages: &[f64]) -> Vec<f64> {
        let n = self.closed_loop.states() + 1;
        let (first, others) = interpolation(place);
        let at = |component: usize| {
            let nodes = stages.iter().skip(component).step_by(n).zip(others);
            first * y[component] + nodes.map(|(value, weight)| weight * value).sum::<f64>()
        };
        (0..n).map(at).collect()
    }

    /// y at a place within the step, whose row is given.
    pub(super) fn sample(&self, row: &Row, place: f64, y: &[f64], stages: &[f64]) -> Vec<f64> {
        let n = self.closed_loop.states() + 1;
        let mut sample = self.between(place, y, stages);
        sample.resize(y.len(), 0.0);
        row.apply(&y[n..], Self::nodes_of_e(stages, n), 1, &mut sample[n..]);
        sample
    }

    /// e at the nodes.
    pub(super) fn nodes_of_e(stages: &[f64], n: usize) -> [&[f64]; STAGES] {
        std::array::from_fn(|node| &stages[node * n + n - 1..(node + 1) * n])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::{Tolerance, flow};
    use sigmastar_lang::plant::Plant;
    use sigmastar_regulator::Regulator;

    fn closed_loop(sigma: f64) -> ClosedLoop {
        let text = include_str!("../../../../specs/plants/paper-example.json");
        let plant = Plant::from_json("paper-example", text).unwrap();
        ClosedLoop::new(&plant, Regulator::new(sigma, 1.0, std::f64::consts::TAU, vec![2.0, 1.0, 0.4]))
    }

    #[test]
    fn a_step_is_that_of_the_explicit_method_where_both_work() {
        let closed_loop = closed_loop(3.0);
        let y: Vec<f64> = (0..closed_loop.dimension()).map(|i| (1.3 * i as f64).sin()).collect();
        let mut collocation = Collocation::new(&closed_loop);
        let table = Table::new(&closed_loop, 0.05);
        let stages = collocation.stages(&table, 0.2, &y).unwrap();
        let ends = [(1.0, 1e-12, collocation.end(&table, &y, &stages))];
        // Between the nodes x and e are polynomials of degree 7.
        let between = [(0.4, 1e-10, collocation.sample(&table.row(&closed_loop, 0.4), 0.4, &y, &stages))];
        for (place, allowed, state) in ends.into_iter().chain(between) {
            let exact = flow(&closed_loop, 0.2, 0.05 * place, &y, Tolerance::TIGHT).unwrap();
            let error = exact.iter().zip(&state).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
            assert!(error < allowed, "{place}: {error}");
        }
    }

    /// What is much faster than a step has passed at its end: e is where u holds it, and z has taken its part of the start.
    #[test]
    fn what_is_fast_is_damped() {
        let closed_loop = closed_loop(1e9);
        let y = closed_loop.start(&[1.0, -2.0], 4.0);
        let mut collocation = Collocation::new(&closed_loop);
        let table = Table::new(&closed_loop, 1e-3);
        let stages = collocation.stages(&table, 0.0, &y).unwrap();
        let end = collocation.end(&table, &y, &stages);
        // What is left of e after one long step is its start over h sigma.
        assert!(end[2].abs() < 1e-4, "{end:?}");
        // The integral of sigma e from 4 to 0 is 4.
        assert!((end[3] + 4.0).abs() < 0.1 && (end[4] + 4.0).abs() < 0.1, "{end:?}");
    }
}
