//! The plant with its regulator.

use sigmastar_lang::expr::{Evaluator, Program};
use sigmastar_lang::plant::{Initial, Plant};
use sigmastar_regulator::{Regulator, WrongDimension};
use std::sync::Arc;
use std::sync::atomic::AtomicU64;

/// Where measurement noise v enters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Noise {
    /// As the paper prints it: z' = Phi z + Gamma (e + v), u = -sigma e + mu M'N(z - M(e + v)); for the high-gain
    /// feedback u = -sigma (e + v).
    Printed,
    /// In everything that is fed back: as printed with u = -sigma (e + v) + mu M'N(z - M(e + v)) (erratum E22).
    Everywhere,
}

/// The noise and the disturbance at one moment, as they enter.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Disturbance {
    /// What is added to e in the internal model.
    pub model: f64,
    /// What is added to e in -sigma e.
    pub feedback: f64,
    /// What is added to q.
    pub q: f64,
}

impl Noise {
    /// How the value v of the noise enters a loop with this regulator.
    #[must_use]
    pub fn enters(self, regulator: &Regulator, v: f64) -> Disturbance {
        let fed_back = self == Noise::Everywhere || regulator.oscillators().is_none();
        Disturbance { model: v, feedback: if fed_back { v } else { 0.0 }, q: 0.0 }
    }
}

/// The closed loop with the state y = (x, e, z): x' = f(t, x, e), e' = q(t, x, e) + u, z' = Phi z + Gamma e,
/// u = -sigma e + mu M'N(z - M e). With an actuator of an uncertain gain e' = q(t, x, e) + gain u, and u is over its nominal value
/// (derivation, 13.1).
#[derive(Clone, Debug)]
pub struct ClosedLoop {
    /// The regulator.
    pub regulator: Regulator,
    /// The period T.
    pub period: f64,
    states: usize,
    values: Arc<Program>,
    derivatives: Arc<Program>,
    /// The operations that were spent. One closed loop is simulated by one thread, so the count does not depend on how many
    /// threads there are.
    pub(super) effort: Arc<AtomicU64>,
    /// A constant that is added to the control: what a computer holds between samples. 0 in continuous time.
    held: f64,
    /// The gain of the actuator.
    gain: f64,
    /// The largest |u| that the actuator takes; what is beyond is cut off.
    limit: Option<f64>,
}

impl ClosedLoop {
    /// Joins a plant and a regulator; the gain of the actuator is the nominal one.
    #[must_use]
    pub fn new(plant: &Plant, regulator: Regulator) -> ClosedLoop {
        ClosedLoop {
            regulator,
            period: plant.period.nominal().to_f64(),
            states: plant.states(),
            values: Arc::new(plant.program()),
            derivatives: Arc::new(plant.program_with_derivatives()),
            effort: Arc::default(),
            held: 0.0,
            gain: plant.input_gain.as_ref().map_or(1.0, |gain| gain.nominal.to_f64()),
            limit: plant.actuator.as_ref().map(|actuator| actuator.max.to_f64()),
        }
    }

    /// The largest |u| that the actuator takes, where it saturates.
    #[must_use]
    pub fn limit(&self) -> Option<f64> {
        self.limit
    }

    /// This loop with an actuator that takes everything: for whoever asks what is put out.
    #[must_use]
    pub fn without_limit(self) -> ClosedLoop {
        ClosedLoop { limit: None, ..self }
    }

    /// This loop with an actuator of this gain.
    #[must_use]
    pub fn with_input_gain(self, gain: f64) -> ClosedLoop {
        ClosedLoop { gain, ..self }
    }

    /// b: what of the law's control reaches the plant.
    pub(super) fn acting(&self) -> f64 {
        self.gain / self.regulator.divisor()
    }

    /// The plant with a control that is held: x' = f(t, x, e), e' = q(t, x, e) + u, with u = 0 at first. It acts as it is: what holds it
    /// cuts it off.
    #[must_use]
    pub fn held(plant: &Plant) -> ClosedLoop {
        ClosedLoop { limit: None, ..ClosedLoop::new(plant, Regulator::high_gain(0.0)) }
    }

    /// Holds another control from now on.
    pub fn hold(&mut self, u: f64) {
        self.held = u;
    }

    /// What the control that is held adds to e'.
    pub(super) fn held_control(&self) -> f64 {
        self.gain * self.held
    }

    /// The number of states of the plant without e; `y[states()]` is e.
    #[must_use]
    pub fn states(&self) -> usize {
        self.states
    }

    /// The dimension of y.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.states + 1 + self.regulator.dimension()
    }

    /// (x(0), e(0), 0).
    #[must_use]
    pub fn start(&self, x: &[f64], e: f64) -> Vec<f64> {
        let mut y = x.to_vec();
        y.push(e);
        y.resize(self.dimension(), 0.0);
        y
    }

    /// (x(0), e(0), z(0)) of a plant's initial condition.
    ///
    /// # Errors
    /// A z of another dimension than the regulator.
    pub fn start_of(&self, initial: &Initial) -> Result<Vec<f64>, WrongDimension> {
        let z = self.regulator.start(&initial.z, initial.e)?;
        Ok(initial.x.iter().copied().chain([initial.e]).chain(z).collect())
    }

    /// An evaluator of f and q.
    #[must_use]
    pub fn evaluator(&self) -> Evaluator {
        Evaluator::new(self.values.clone())
    }

    /// An evaluator of f and q with their derivatives.
    #[must_use]
    pub fn derivative_evaluator(&self) -> Evaluator {
        Evaluator::new(self.derivatives.clone())
    }

    /// The number of values that depend on the time alone.
    #[must_use]
    pub fn time_values(&self) -> usize {
        self.values.time_values()
    }

    /// The operations of one evaluation of f and q, or of them with their derivatives.
    pub(super) fn operations(&self, derivatives: bool) -> u64 {
        let program = if derivatives { &self.derivatives } else { &self.values };
        program.operations() as u64
    }

    /// The control u for a state, as it acts: cut off at what the actuator takes.
    #[must_use]
    pub fn control(&self, y: &[f64], noise: Disturbance) -> f64 {
        let demanded = self.demanded(y, noise);
        self.limit.map_or(demanded, |limit| demanded.clamp(-limit, limit))
    }

    /// The control u for a state, as it is put out.
    #[must_use]
    pub fn demanded(&self, y: &[f64], noise: Disturbance) -> f64 {
        let e = y[self.states];
        let sum = self.regulator.internal_model_output(&y[self.states + 1..], e + noise.model);
        let law = self.regulator.mu * sum - self.regulator.sigma * (e + noise.feedback);
        self.held + law / self.regulator.divisor()
    }

    /// y' at the time that the evaluator (of [`ClosedLoop::evaluator`]) was set to.
    #[inline]
    pub fn right_side(&self, evaluator: &mut Evaluator, y: &[f64], noise: Disturbance, dy: &mut [f64]) {
        let n = self.states;
        let (plant, dz) = dy.split_at_mut(n + 1);
        evaluator.evaluate(&y[..n], y[n], plant);
        self.add_regulator(y, noise, &mut plant[n], dz);
    }

    /// Whether the actuator does not take what is put out at a state.
    pub(super) fn saturates(&self, y: &[f64], noise: Disturbance) -> bool {
        self.limit.is_some_and(|limit| self.demanded(y, noise).abs() > limit)
    }

    /// Adds u to e' and sets z'.
    #[inline]
    fn add_regulator(&self, y: &[f64], noise: Disturbance, de: &mut f64, dz: &mut [f64]) {
        *de += noise.q;
        let plant = *de;
        self.add_unlimited(y, noise, de, dz);
        if self.saturates(y, noise) {
            *de = plant + self.gain * self.control(y, noise);
        }
    }

    /// Adds u to e' and sets z', for an actuator that takes everything.
    #[inline]
    fn add_unlimited(&self, y: &[f64], noise: Disturbance, de: &mut f64, dz: &mut [f64]) {
        let Regulator { sigma, mu, frequencies, weights, .. } = &self.regulator;
        let (e, z) = (y[self.states], &y[self.states + 1..]);
        // With 1 for the gain the same bits.
        let b = self.acting();
        *de -= b * (sigma * (e + noise.feedback));
        *de += self.gain * self.held;
        let (Some((n_0, weights)), Some((z_0, z)), Some((dz_0, dz))) =
            (weights.split_first(), z.split_first(), dz.split_first_mut())
        else {
            return;
        };
        let measured = e + noise.model;
        let mut sum = n_0 * (z_0 - measured);
        *dz_0 = -sigma * measured;
        let blocks = z.chunks_exact(2).zip(dz.chunks_exact_mut(2));
        for ((z, dz), (n_l, frequency)) in blocks.zip(weights.iter().zip(frequencies)) {
            sum += n_l * (z[0] - measured);
            dz[0] = frequency * z[1] - sigma * measured;
            dz[1] = frequency * (measured - z[0]);
        }
        *de += b * (mu * sum);
    }

    /// The derivatives of (f, q) by x and e at a time and state, column by column. `evaluator` is one of
    /// [`ClosedLoop::derivative_evaluator`].
    pub(super) fn plant_jacobian(&self, evaluator: &mut Evaluator, t: f64, y: &[f64]) -> Vec<f64> {
        let n = self.states;
        let mut outputs = vec![0.0; (n + 1) * (n + 2)];
        evaluator.set_time(t);
        evaluator.evaluate(&y[..n], y[n], &mut outputs);
        outputs.split_off(n + 1)
    }

    /// The size of a component of y beside those of x and z, by which absolute tolerances are multiplied: e is what a
    /// control of ordinary size leaves over, u/sigma.
    pub(super) fn natural_sizes(&self) -> Vec<f64> {
        let mut sizes = vec![1.0; self.dimension()];
        sizes[self.states] = 1.0 / (self.period * self.regulator.sigma).max(1.0);
        sizes
    }

    /// The Jacobian dy'/dy, row by row, at a time and without noise. `evaluator` is one of
    /// [`ClosedLoop::derivative_evaluator`].
    #[must_use]
    pub fn linearise(&self, evaluator: &mut Evaluator, t: f64, y: &[f64]) -> Vec<f64> {
        let (n, d) = (self.states, self.dimension());
        let mut jacobian = vec![0.0; d * d];
        for (variable, block) in self.plant_jacobian(evaluator, t, y).chunks_exact(n + 1).enumerate() {
            for (row, derivative) in block.iter().enumerate() {
                jacobian[row * d + variable] = *derivative;
            }
        }
        let Regulator { sigma, mu, frequencies, weights, .. } = &self.regulator;
        // What is cut off does not move.
        let b = if self.saturates(y, Disturbance::default()) { 0.0 } else { self.acting() };
        jacobian[n * d + n] -= b * (sigma + mu * weights.iter().sum::<f64>());
        for (l, weight) in weights.iter().enumerate() {
            // z_0, z_11, z_21, ... follow e.
            let first = if l == 0 { n + 1 } else { n + 2 * l };
            jacobian[n * d + first] = b * (mu * weight);
            jacobian[first * d + n] = -sigma;
            if l > 0 {
                let frequency = frequencies[l - 1];
                jacobian[first * d + first + 1] = frequency;
                jacobian[(first + 1) * d + first] = -frequency;
                jacobian[(first + 1) * d + n] = frequency;
            }
        }
        jacobian
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_jacobian_is_that_of_the_right_side() {
        let text = include_str!("../../../../specs/plants/paper-example.json");
        let plant = Plant::from_json("paper-example", text).unwrap();
        for regulator in [Regulator::high_gain(3.0), Regulator::new(3.0, 1.5, 2.0, vec![2.0, 1.0, 0.4])] {
            let closed_loop = ClosedLoop::new(&plant, regulator);
            let d = closed_loop.dimension();
            let y: Vec<f64> = (0..d).map(|i| (1.3 * i as f64).sin()).collect();
            let jacobian = closed_loop.linearise(&mut closed_loop.derivative_evaluator(), 0.2, &y);
            let at = |y: &[f64]| {
                let (mut evaluator, mut dy) = (closed_loop.evaluator(), vec![0.0; d]);
                evaluator.set_time(0.2);
                closed_loop.right_side(&mut evaluator, y, Disturbance::default(), &mut dy);
                dy
            };
            for column in 0..d {
                let shifted = |by: f64| {
                    let mut y = y.clone();
                    y[column] += by;
                    at(&y)
                };
                let (up, down) = (shifted(1e-6), shifted(-1e-6));
                for row in 0..d {
                    let quotient = (up[row] - down[row]) / 2e-6;
                    assert!((jacobian[row * d + column] - quotient).abs() < 1e-7, "{row} {column}");
                }
            }
        }
    }

    #[test]
    fn beyond_what_the_actuator_takes_nothing_acts() {
        let text = include_str!("../../../../specs/plants/linear.json");
        let free = Plant::from_json("linear", text).unwrap();
        let limited = text.replacen('{', "{ \"actuator\": { \"max\": 2 },", 1);
        let limited = Plant::from_json("linear", &limited).unwrap();
        let regulator = Regulator::new(3.0, 1.5, 2.0, vec![2.0, 1.0, 0.4]);
        let [free, limited] = [&free, &limited].map(|plant| ClosedLoop::new(plant, regulator.clone()));
        let slope = |closed_loop: &ClosedLoop, y: &[f64]| {
            let (mut evaluator, mut dy) = (closed_loop.evaluator(), vec![0.0; y.len()]);
            evaluator.set_time(0.25);
            closed_loop.right_side(&mut evaluator, y, Disturbance::default(), &mut dy);
            (dy, closed_loop.linearise(&mut closed_loop.derivative_evaluator(), 0.25, y))
        };
        // Of this size the control is within 2, and of twice that it is not.
        for (scale, saturates) in [(0.1, false), (4.0, true), (-4.0, true)] {
            let y = [0.3, -1.0, 0.5, 0.25, 2.0, -0.7].map(|part| part * scale);
            let u = free.control(&y, Disturbance::default());
            assert_eq!((u.abs() > 2.0, limited.saturates(&y, Disturbance::default())), (saturates, saturates));
            assert_eq!(limited.control(&y, Disturbance::default()), u.clamp(-2.0, 2.0));
            let ((without, of_without), (with, of_with)) = (slope(&free, &y), slope(&limited, &y));
            assert!((with[0] - (without[0] - u + u.clamp(-2.0, 2.0))).abs() < 1e-13);
            assert_eq!(with[1..], without[1..]);
            assert_eq!(of_with == of_without, !saturates);
            assert_eq!(of_with[1..6].iter().all(|entry| *entry == 0.0), saturates);
        }
    }

    #[test]
    fn the_right_side_is_that_of_the_matrices() {
        let text = include_str!("../../../../specs/plants/linear.json");
        let plant = Plant::from_json("linear", text).unwrap();
        let regulator = Regulator::new(3.0, 1.5, 2.0, vec![2.0, 1.0, 0.4]);
        let closed_loop = ClosedLoop::new(&plant, regulator.clone());
        let y = [0.3, -1.0, 0.5, 0.25, 2.0, -0.7];
        let noise = Disturbance { model: 0.2, feedback: -0.1, q: 0.7 };
        let mut evaluator = closed_loop.evaluator();
        evaluator.set_time(0.25);
        let mut dy = vec![0.0; 6];
        closed_loop.right_side(&mut evaluator, &y, noise, &mut dy);
        let (m, n, gamma, phi) = (regulator.m(), regulator.n_diagonal(), regulator.gamma(), regulator.phi());
        let z = &y[1..];
        let measured = 0.3 + 0.2;
        let expected = (0..5).map(|i| (0..5).map(|j| phi[(i, j)] * z[j]).sum::<f64>() + measured * gamma[i]);
        let s: f64 = (0..5).map(|i| m[i] * n[i] * (z[i] - measured * m[i])).sum();
        let u = -3.0 * (0.3 - 0.1) + 1.5 * s;
        assert!((dy[0] - (1.0 + 3.0_f64.tanh() + 0.7 + u)).abs() < 1e-14);
        assert!((closed_loop.control(&y, noise) - u).abs() < 1e-14);
        dy[1..].iter().zip(expected).for_each(|(a, b)| assert!((a - b).abs() < 1e-14));
        assert_eq!(Noise::Printed.enters(&regulator, 1.0), Disturbance { model: 1.0, feedback: 0.0, q: 0.0 });
        assert_eq!(Noise::Everywhere.enters(&regulator, 1.0), Disturbance { model: 1.0, feedback: 1.0, q: 0.0 });
        assert_eq!(Noise::Printed.enters(&Regulator::high_gain(1.0), 1.0).feedback, 1.0);
    }
}
