//! The loop, sample by sample.

use crate::simulate::ClosedLoop;
use crate::simulate::adaptive::trajectory;
use crate::simulate::integration::{IntegrationFailure, Tolerance, is_bounded};
use sigmastar_lang::plant::{Initial, InitialRegulator, Plant};
use sigmastar_regulator::{Discrete, Regulator, Stepper, WrongDimension};

/// How near to a whole number the samples of a period are for their number to count as one.
const WHOLE: f64 = 1e-9;

/// Operations of the law for each component of z.
const LAW: u64 = 8;

/// What it costs to begin an integration, in operations.
pub(super) const BEGIN: u64 = 4000;

/// What stands between the law and the plant beside the hold. The default is nothing, as the claims of a certificate have it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Converters {
    /// The time D that a control takes to be computed: u_k acts from k h + D on. At most h.
    pub delay: f64,
    /// The error is measured in multiples of this.
    pub measured: Option<f64>,
    /// The control is put out in multiples of this; the law is not told.
    pub put_out: Option<f64>,
}

impl Converters {
    /// Whether the loop is smooth but for a limit of the control, so that it has a derivative.
    #[must_use]
    pub fn are_smooth(&self) -> bool {
        self.measured.is_none() && self.put_out.is_none()
    }
}

/// The nearest multiple of a quantum.
fn quantised(value: f64, quantum: Option<f64>) -> f64 {
    quantum.map_or(value, |quantum| quantum * libm::round(value / quantum))
}

/// A plant with the regulator at samples.
#[derive(Clone, Debug)]
pub struct SampledLoop {
    plant: ClosedLoop,
    /// The parameters of the regulator.
    pub regulator: Regulator,
    /// Its law at samples.
    pub discrete: Discrete,
    /// What stands between the law and the plant.
    pub converters: Converters,
    /// The time of the first sample: the phase of the sampling grid.
    pub phase: f64,
    samples: Option<usize>,
}

impl SampledLoop {
    /// Joins a plant and a regulator with its law at samples.
    #[must_use]
    pub fn new(plant: &Plant, regulator: Regulator, discrete: Discrete) -> SampledLoop {
        let plant = ClosedLoop::held(plant);
        let ratio = plant.period / discrete.step;
        let whole = libm::round(ratio);
        let samples =
            ((ratio - whole).abs() <= WHOLE * whole && (1.0..1e15).contains(&whole)).then_some(whole as usize);
        SampledLoop { plant, regulator, discrete, converters: Converters::default(), phase: 0.0, samples }
    }

    /// This loop with an actuator of this gain.
    #[must_use]
    pub fn with_input_gain(self, gain: f64) -> SampledLoop {
        SampledLoop { plant: self.plant.with_input_gain(gain), ..self }
    }

    /// The period T of the plant.
    #[must_use]
    pub fn period(&self) -> f64 {
        self.plant.period
    }

    /// The number of states of the plant without e.
    #[must_use]
    pub fn states(&self) -> usize {
        self.plant.states()
    }

    /// The samples of a period, where they are a whole number (to nine digits).
    #[must_use]
    pub fn samples(&self) -> Option<usize> {
        self.samples
    }

    /// The samples that make a period, rounded up where they are no whole number.
    #[must_use]
    pub fn samples_rounded_up(&self) -> usize {
        // Beyond that no run gets through a period.
        self.samples.unwrap_or_else(|| libm::ceil((self.period() / self.discrete.step).min(1e15)) as usize).max(1)
    }

    /// The sampling time h; a whole part of the period is the one that it is meant to be.
    #[must_use]
    pub fn step(&self) -> f64 {
        self.samples.map_or(self.discrete.step, |samples| self.period() / samples as f64)
    }

    /// The time of a sample.
    #[must_use]
    pub fn time(&self, sample: usize) -> f64 {
        self.phase
            + match self.samples {
                Some(samples) => self.period() * (sample as f64 / samples as f64),
                None => self.discrete.step * sample as f64,
            }
    }

    /// The time after its sample at which a control acts: the whole step with the law that has it to be computed.
    #[must_use]
    pub fn delay(&self) -> f64 {
        if self.discrete.prediction.is_some() { self.step() } else { self.converters.delay }
    }

    /// The dimension of a state at a sample: x, e, the state of the law and, with a delay, the control that still acts.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.states() + 1 + self.discrete.dimension() + usize::from(self.delay() > 0.0)
    }

    /// The state at the first sample from x, e and z: nothing is predicted yet. The control that acts is 0; of the law with a delay
    /// that of z, or 0 where it starts `aligned`.
    #[must_use]
    pub fn starting(&self, mut state: Vec<f64>, aligned: bool) -> Vec<f64> {
        let z = state.get(self.states() + 1..).unwrap_or_default();
        let delayed = self.discrete.prediction.is_some();
        let acting = if delayed && !aligned { self.discrete.first_control(&self.regulator, z) } else { 0.0 };
        state.resize(self.dimension(), 0.0);
        if let (true, Some(last)) = (delayed, state.last_mut()) {
            *last = acting;
        }
        state
    }

    /// The state at the first sample of a plant's initial condition.
    ///
    /// # Errors
    /// A z of another dimension than the regulator.
    pub fn start_of(&self, initial: &Initial) -> Result<Vec<f64>, WrongDimension> {
        let z = self.regulator.start(&initial.z, initial.e)?;
        let start: Vec<f64> = initial.x.iter().copied().chain([initial.e]).chain(z).collect();
        Ok(self.starting(start, matches!(initial.z, InitialRegulator::Aligned)))
    }

    /// The plant alone.
    pub(crate) fn plant(&self) -> &ClosedLoop {
        &self.plant
    }
}

/// A stretch of time in which the control is constant.
#[derive(Clone, Debug)]
pub struct Piece {
    /// Its start.
    pub t: f64,
    /// The distance of the states.
    pub unit: f64,
    /// The control.
    pub u: f64,
    /// (x, e) at its start, at equal distances, and at its end.
    pub states: Vec<Vec<f64>>,
}

/// A loop on its way.
#[derive(Clone, Debug)]
pub struct SampledRun<'l> {
    sampled: &'l SampledLoop,
    plant: ClosedLoop,
    stepper: Stepper,
    state: Vec<f64>,
    held: f64,
    sample: usize,
}

impl<'l> SampledRun<'l> {
    /// Starts at a sample, in a state of [`SampledLoop::dimension`]; without its last part the control that still acts is 0.
    /// `None` where the state has another dimension.
    #[must_use]
    pub fn new(sampled: &'l SampledLoop, sample: usize, state: &[f64]) -> Option<SampledRun<'l>> {
        let (plant, rest) = state.split_at_checked(sampled.states() + 1)?;
        let (z, held) = rest.split_at_checked(sampled.discrete.dimension())?;
        let held = match held {
            [] => 0.0,
            [held] => *held,
            _ => return None,
        };
        let stepper = Stepper::starting(sampled.regulator.clone(), sampled.discrete.clone(), z.to_vec())?;
        Some(SampledRun { sampled, plant: sampled.plant.clone(), stepper, state: plant.to_vec(), held, sample })
    }

    /// (x, e) at the next sample.
    #[must_use]
    pub fn plant_state(&self) -> &[f64] {
        &self.state
    }

    /// z at the next sample, before the law has seen it.
    #[must_use]
    pub fn regulator_state(&self) -> &[f64] {
        let state = self.stepper.state();
        &state[..state.len().min(self.sampled.regulator.dimension())]
    }

    /// The control that was computed at the last sample.
    #[must_use]
    pub fn put_out(&self) -> f64 {
        self.held
    }

    /// The time of the next sample.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.sampled.time(self.sample)
    }

    /// The state, as [`SampledRun::new`] takes it.
    #[must_use]
    pub fn whole_state(&self) -> Vec<f64> {
        let held = (self.sampled.delay() > 0.0).then_some(self.held);
        self.state.iter().chain(self.stepper.state()).copied().chain(held).collect()
    }

    /// From this sample to the next by the law of the loop.
    ///
    /// # Errors
    /// [`IntegrationFailure`].
    pub fn advance(&mut self, units: usize, tolerance: Tolerance) -> Result<Vec<Piece>, IntegrationFailure> {
        self.plant.pay(self.time(), LAW * self.sampled.regulator.dimension() as u64)?;
        let e = quantised(self.error(), self.sampled.converters.measured);
        let u = self.stepper.step(e);
        self.advance_with(u, units, tolerance)
    }

    /// From this sample to the next with this control, whatever the law would have said. The pieces have at least `units`
    /// states after their first all together, each an even number where `units` is more than 1.
    ///
    /// # Errors
    /// [`IntegrationFailure`].
    pub fn advance_with(
        &mut self,
        u: f64,
        units: usize,
        tolerance: Tolerance,
    ) -> Result<Vec<Piece>, IntegrationFailure> {
        let u = quantised(u, self.sampled.converters.put_out);
        let (t, h) = (self.time(), self.sampled.step());
        let delay = self.sampled.delay().min(h);
        let mut pieces = Vec::with_capacity(2);
        for (start, length, control) in [(t, delay, self.held), (t + delay, h - delay, u)] {
            if length > 0.0 {
                let even = |units: f64| 2 * (libm::ceil(0.5 * units) as usize).max(1);
                let units = if units > 1 { even(units as f64 * length / h) } else { 1 };
                self.plant.pay(start, BEGIN)?;
                self.plant.hold(control);
                let states = trajectory(&self.plant, start, length, units, &self.state, tolerance)?;
                self.state = states.last().filter(|state| is_bounded(state)).cloned().ok_or(escaped(start))?;
                pieces.push(Piece { t: start, unit: length / units as f64, u: control, states });
            }
        }
        self.held = u;
        self.sample += 1;
        Ok(pieces)
    }

    /// e at the next sample.
    fn error(&self) -> f64 {
        self.state.last().copied().unwrap_or_default()
    }
}

fn escaped(t: f64) -> IntegrationFailure {
    IntegrationFailure::Escaped { t }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quanta() {
        for (value, quantum, expected) in
            [(0.26, Some(0.1), 0.3), (-0.26, Some(0.1), -0.3), (0.04, Some(0.1), 0.0), (0.04, None, 0.04)]
        {
            assert!((quantised(value, quantum) - expected).abs() < 1e-15, "{value} {quantum:?}");
        }
    }
}
