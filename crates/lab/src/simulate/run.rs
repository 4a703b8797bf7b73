//! One simulation: a steady state, a long run from the initial condition, and a run with noise.

use super::adaptive::trajectory;
use super::fixed::checked;
use super::integration::{IntegrationFailure, Tolerance};
use super::limits::MAX_NUMBERS;
use super::orbit::{Orbit, amplitudes, rms, sup};
use super::steady::steady_state_near;
use super::{
    BandLimitedNoise, ClosedLoop, Disturbance, FixedStep, Noise, NoiseSettings, SteadyState, SteadyStateError,
    steady_state,
};
use sigmastar_document::progress::Progress;

/// How a long run is integrated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Integrator {
    /// Dormand-Prince 8(5,3) with step control.
    Adaptive,
    /// Classical Runge-Kutta with this many steps per period.
    Fixed(usize),
}

/// What is simulated.
#[derive(Clone, Copy, Debug)]
pub struct SimulationSettings {
    /// The length of the long run in periods, at least 1.
    pub periods: usize,
    /// How it is integrated.
    pub integrator: Integrator,
    /// Samples of a period in the long run, at least 1.
    pub samples: usize,
    /// Noise, if any, and where it enters.
    pub noise: Option<(NoiseSettings, Noise)>,
    /// Steps per period of the run with noise.
    pub noise_steps: usize,
    /// How many Fourier coefficients are reported.
    pub harmonics: usize,
}

impl SimulationSettings {
    /// The steps per period of the fixed method in use: the number asked for, raised to a multiple of the samples.
    #[must_use]
    pub fn fixed_steps(&self) -> Option<usize> {
        let samples = self.samples.max(1);
        match self.integrator {
            Integrator::Adaptive => None,
            Integrator::Fixed(steps) => Some(steps.div_ceil(samples).max(1) * samples),
        }
    }
}

/// A run from the initial condition without noise.
#[derive(Clone, Debug)]
pub struct LongRun {
    /// Times of the samples.
    pub times: Vec<f64>,
    /// y at these times.
    pub states: Vec<Vec<f64>>,
    /// The largest |e| among the samples of the last period.
    pub sup: f64,
    /// The root mean square of e over the last period.
    pub rms: f64,
    /// The largest |u| among the samples of the whole run, the start included.
    pub peak_u: f64,
    /// The control and the states among the samples of the last period.
    pub last_period: PeriodFigures,
    /// The distance max|y(t + T) - y(t)| at the end of each period.
    pub return_distances: Vec<f64>,
    /// The first period at whose end that distance is below 1e-6 (1 + max|y|), counted from 1.
    pub settled: Option<usize>,
}

/// A run with noise from the initial condition, of the same length as the long run.
#[derive(Clone, Debug)]
pub struct NoisyRun {
    /// For each period: the largest |e|.
    pub sup: Vec<f64>,
    /// For each period: the root mean square of e.
    pub rms: Vec<f64>,
    /// The largest |v| of the whole run.
    pub largest_noise: f64,
}

/// The outcome of a simulation.
#[derive(Clone, Debug)]
pub struct Simulation {
    /// What was asked for.
    pub settings: SimulationSettings,
    /// The steady state, or why there is none.
    pub steady: Result<(SteadyState, SteadyFigures), SteadyStateError>,
    /// The long run, or why it ended early.
    pub long: Result<LongRun, IntegrationFailure>,
    /// The run with noise, where it was asked for.
    pub noisy: Option<Result<NoisyRun, IntegrationFailure>>,
}

/// What a period of the control and of the states of the plant comes to.
#[derive(Clone, Debug, PartialEq)]
pub struct PeriodFigures {
    /// The largest |u|.
    pub sup_u: f64,
    /// The energy of the control, the integral of u^2 over the period.
    pub energy: f64,
    /// For each state of the plant the largest |x|.
    pub sup_x: Vec<f64>,
}

impl PeriodFigures {
    /// From samples at equal distances, the first at the start of the period and the last at its end.
    fn new(closed_loop: &ClosedLoop, samples: &[Vec<f64>]) -> PeriodFigures {
        let controls: Vec<f64> = samples.iter().map(|y| closed_loop.control(y, Disturbance::default())).collect();
        let last = controls.len().saturating_sub(1);
        let trapezoids = controls.windows(2).map(|pair| 0.5 * (pair[0] * pair[0] + pair[1] * pair[1])).sum::<f64>();
        let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0_f64, |most, value| most.max(value.abs()));
        PeriodFigures {
            sup_u: largest(&mut controls.iter().copied()),
            energy: trapezoids * closed_loop.period / last.max(1) as f64,
            sup_x: (0..closed_loop.states()).map(|i| largest(&mut samples.iter().map(|y| y[i]))).collect(),
        }
    }
}

/// Figures over a period of the steady state.
#[derive(Clone, Debug)]
pub struct SteadyFigures {
    /// sup|e|.
    pub sup: f64,
    /// rms(e).
    pub rms: f64,
    /// |c_0|, |c_1|, ...
    pub amplitudes: Vec<f64>,
    /// The control and the states.
    pub period: PeriodFigures,
}

impl SteadyFigures {
    /// Samples a steady state and works its figures out.
    ///
    /// # Errors
    /// [`IntegrationFailure`].
    pub fn new(
        closed_loop: &ClosedLoop,
        steady: &SteadyState,
        harmonics: usize,
    ) -> Result<SteadyFigures, IntegrationFailure> {
        let orbit = Orbit::new(closed_loop, steady)?;
        let error = orbit.error();
        // A period ends where it started.
        let closed: Vec<Vec<f64>> = orbit.samples.iter().chain(orbit.samples.first()).cloned().collect();
        Ok(SteadyFigures {
            sup: sup(&error),
            rms: rms(&error),
            amplitudes: amplitudes(&error, harmonics),
            period: PeriodFigures::new(closed_loop, &closed),
        })
    }
}

/// Runs everything that the settings ask for.
#[must_use]
pub fn simulate(
    closed_loop: &ClosedLoop,
    start: &[f64],
    settings: &SimulationSettings,
    progress: &dyn Progress,
) -> Simulation {
    let found = steady_state(closed_loop, start, progress);
    let long = long_run(closed_loop, start, settings, progress);
    let steady = found.or_else(|error| from_the_end(closed_loop, &long, error)).and_then(|steady| {
        let figures = SteadyFigures::new(closed_loop, &steady, settings.harmonics)?;
        Ok((steady, figures))
    });
    let noisy = settings.noise.map(|(noise, enters)| {
        noisy_run(closed_loop, start, settings.periods, settings.noise_steps, noise, enters, progress)
    });
    Simulation { settings: *settings, steady, long, noisy }
}

/// The steady state from the end of a long run, where Newton's method failed from its start.
fn from_the_end(
    closed_loop: &ClosedLoop,
    long: &Result<LongRun, IntegrationFailure>,
    error: SteadyStateError,
) -> Result<SteadyState, SteadyStateError> {
    let end = long.as_ref().ok().and_then(|run| run.states.last());
    match (&error, end) {
        (SteadyStateError::Newton { .. }, Some(end)) => {
            closed_loop.renew_effort();
            steady_state_near(closed_loop, end).map_err(|_| error)
        }
        _ => Err(error),
    }
}

/// Numbers that the samples of a long run may fill; written as text they take twenty bytes each.
const MAX_SAMPLED: usize = MAX_NUMBERS / 2;

fn long_run(
    closed_loop: &ClosedLoop,
    start: &[f64],
    settings: &SimulationSettings,
    progress: &dyn Progress,
) -> Result<LongRun, IntegrationFailure> {
    let samples = settings.samples.max(1);
    closed_loop.renew_effort();
    let numbers = settings.periods.max(1).saturating_mul(samples).saturating_mul(closed_loop.dimension());
    if numbers > MAX_SAMPLED {
        return Err(IntegrationFailure::TooMuchWork { t: 0.0 });
    }
    let mut y = start.to_vec();
    let mut run = LongRun {
        times: vec![0.0],
        states: vec![y.clone()],
        sup: 0.0,
        rms: 0.0,
        peak_u: 0.0,
        last_period: PeriodFigures { sup_u: 0.0, energy: 0.0, sup_x: Vec::new() },
        return_distances: Vec::new(),
        settled: None,
    };
    let mut fixed = settings.fixed_steps().map(|steps| (steps / samples, FixedStep::new(closed_loop, steps)));
    let period = closed_loop.period;
    for index in 0..settings.periods.max(1) {
        let t = index as f64 * period;
        let before = y.clone();
        let states = match &mut fixed {
            None => trajectory(closed_loop, t, period, samples, &y, Tolerance::ORDINARY)?.split_off(1),
            Some((stride, method)) => {
                closed_loop.pay_fixed(t, *stride * samples)?;
                let mut states = Vec::with_capacity(samples);
                for sample in 0..samples {
                    for step in 0..*stride {
                        method.step(sample * *stride + step, &mut y, Disturbance::default());
                    }
                    states.push(y.clone());
                }
                // The Jacobian at the ends of the run stands for those between; a run that left all bounds is one too.
                let ends = index == 0 || index + 1 == settings.periods || !y.iter().all(|value| value.is_finite());
                if ends {
                    checked(closed_loop, *stride * samples, t, &before, &y)?;
                }
                states
            }
        };
        let errors: Vec<f64> = states.iter().map(|y| y[closed_loop.states()]).collect();
        (run.sup, run.rms) = (errors.iter().fold(0.0, |largest: f64, e| largest.max(e.abs())), rms(&errors));
        run.times.extend((1..=states.len()).map(|k| t + period * k as f64 / samples as f64));
        run.states.extend(states);
        run.last_period = PeriodFigures::new(closed_loop, &run.states[index * samples..]);
        run.peak_u = run.peak_u.max(run.last_period.sup_u);
        y.clone_from(run.states.last().unwrap_or(&before));
        let distance = y.iter().zip(&before).fold(0.0, |largest: f64, (a, b)| largest.max((a - b).abs()));
        let size = y.iter().fold(1.0, |largest: f64, value| largest.max(1.0 + value.abs()));
        run.return_distances.push(distance);
        if distance >= 1e-6 * size {
            run.settled = None;
        } else if run.settled.is_none() {
            run.settled = Some(index + 1);
        }
        progress.advance();
    }
    Ok(run)
}

/// A run with noise by the fixed-step method, the noise held over each step.
///
/// # Errors
/// A solution that escapes.
pub fn noisy_run(
    closed_loop: &ClosedLoop,
    start: &[f64],
    periods: usize,
    steps_per_period: usize,
    settings: NoiseSettings,
    enters: Noise,
    progress: &dyn Progress,
) -> Result<NoisyRun, IntegrationFailure> {
    let mut method = FixedStep::new(closed_loop, steps_per_period);
    let mut noise = BandLimitedNoise::new(settings, method.step_length());
    let mut y = start.to_vec();
    let mut run = NoisyRun { sup: Vec::new(), rms: Vec::new(), largest_noise: 0.0 };
    closed_loop.renew_effort();
    for period in 0..periods {
        closed_loop.pay_fixed(period as f64 * closed_loop.period, steps_per_period)?;
        let before = y.clone();
        let (mut largest, mut squares) = (0.0_f64, 0.0);
        for step in 0..steps_per_period {
            let v = noise.sample();
            run.largest_noise = run.largest_noise.max(v.abs());
            method.step(step, &mut y, enters.enters(&closed_loop.regulator, v));
            let e = y[closed_loop.states()];
            largest = largest.max(e.abs());
            squares += e * e;
        }
        if period == 0 || period + 1 == periods || !y.iter().all(|value| value.is_finite()) {
            checked(closed_loop, steps_per_period, period as f64 * closed_loop.period, &before, &y)?;
        }
        run.sup.push(largest);
        run.rms.push((squares / steps_per_period as f64).sqrt());
        progress.advance();
    }
    Ok(run)
}
