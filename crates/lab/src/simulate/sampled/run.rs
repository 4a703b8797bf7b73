//! One simulation at samples: the steady state, and a run from the initial condition.

use super::sampled_loop::{Piece, SampledLoop, SampledRun};
use super::steady::{SampledSteady, SampledSteadyError, max_distance, sampled_steady_state};
use crate::simulate::integration::{IntegrationFailure, Tolerance};
use crate::simulate::limits::MAX_NUMBERS;
use crate::simulate::orbit::amplitudes;
use crate::simulate::run::PeriodFigures;
use num_complex::Complex;
use sigmastar_document::progress::Progress;
use std::f64::consts::TAU;

/// States of a period that the figures of a steady state are of, at least, and between two samples.
const STATES: usize = 4096;
const BETWEEN: usize = 4;

/// A run settles where a period differs from the one before by this, relative to 1 + max|y|.
const SETTLED: f64 = 1e-6;

/// Periods from which on it is judged whether a run grows.
const ENOUGH: usize = 4;

/// What is simulated.
#[derive(Clone, Copy, Debug)]
pub struct SampledSettings {
    /// The length of the run in periods, at least 1.
    pub periods: usize,
    /// States of a period that are written out, at least: each sampling interval has the same even number.
    pub samples: usize,
    /// How many Fourier coefficients are reported.
    pub harmonics: usize,
}

/// What pieces of the loop come to: e between the samples as well as at them.
#[derive(Clone, Debug)]
pub struct PeriodSums {
    /// The largest |e|.
    pub sup: f64,
    /// The largest |e| at a sample.
    pub sup_at_samples: f64,
    /// The root mean square of e over the time.
    pub rms: f64,
    /// |c_0|, |c_1|, ... of e(t).
    pub amplitudes: Vec<f64>,
    /// |c_0|, |c_1|, ... of e at the samples.
    pub amplitudes_at_samples: Vec<f64>,
    /// The control and the states.
    pub period: PeriodFigures,
}

impl PeriodSums {
    /// From the pieces of each sampling interval. The integrals are by Simpson's rule, piece by piece, as e has a kink between
    /// two; that of u^2 is exact.
    #[must_use]
    pub fn new(intervals: &[Vec<Piece>], states: usize, period: f64, harmonics: usize) -> PeriodSums {
        let pieces = || intervals.iter().flatten();
        let errors: Vec<f64> =
            intervals.iter().filter_map(|pieces| pieces.first()?.states.first()?.last()).copied().collect();
        let peak = |component: usize| pieces().fold(0.0, |most: f64, piece| most.max(peak(piece, component)));
        let (mut squares, mut length) = (0.0, 0.0);
        let mut coefficients = vec![Complex::new(0.0, 0.0); harmonics];
        for piece in pieces() {
            length += piece.unit * (piece.states.len() - 1) as f64;
            for (t, weight, e) in weighted(piece) {
                squares += weight * e * e;
                for (k, sum) in coefficients.iter_mut().enumerate() {
                    let (sine, cosine) = libm::sincos(-TAU * (k as f64 * (t / period)).fract());
                    *sum += weight * e * Complex::new(cosine, sine);
                }
            }
        }
        let energy = |piece: &Piece| piece.u * piece.u * piece.unit * (piece.states.len() - 1) as f64;
        PeriodSums {
            sup: peak(states),
            sup_at_samples: errors.iter().fold(0.0, |most: f64, e| most.max(e.abs())),
            rms: (squares / length).sqrt(),
            amplitudes: coefficients.iter().map(|sum| sum.norm() / length).collect(),
            amplitudes_at_samples: amplitudes(&errors, harmonics),
            period: PeriodFigures {
                sup_u: pieces().fold(0.0, |most: f64, piece| most.max(piece.u.abs())),
                energy: pieces().map(energy).sum(),
                sup_x: (0..states).map(peak).collect(),
            },
        }
    }
}

/// The largest absolute value of a component of (x, e): of the states, and of the parabolas through three that follow each other
/// in the piece, within their reach. (At the end of a piece the component may have a kink.)
fn peak(piece: &Piece, component: usize) -> f64 {
    let values: Vec<f64> = piece.states.iter().filter_map(|state| state.get(component)).copied().collect();
    let most = values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    values.windows(3).fold(most, |most, window| {
        let (slope, bend) = (window[2] - window[0], window[0] - 2.0 * window[1] + window[2]);
        // Its top is at -slope/(2 bend), in units from the one in the middle.
        let within = slope.abs() < 2.0 * bend.abs();
        if within { most.max((window[1] - slope * slope / (8.0 * bend)).abs()) } else { most }
    })
}

/// Times, weights of Simpson's rule, and e.
fn weighted(piece: &Piece) -> impl Iterator<Item = (f64, f64, f64)> + '_ {
    let last = piece.states.len() - 1;
    piece.states.iter().enumerate().map(move |(at, state)| {
        let weight = if at == 0 || at == last { 1.0 } else { 2.0 + 2.0 * (at % 2) as f64 };
        let e = state.last().copied().unwrap_or_default();
        (piece.t + piece.unit * at as f64, weight * piece.unit / 3.0, e)
    })
}

/// A sampling interval as it was.
#[derive(Clone, Debug)]
pub struct Interval {
    /// z at its start, before the law has seen the sample.
    pub z: Vec<f64>,
    /// The plant.
    pub pieces: Vec<Piece>,
}

/// A run from the initial condition.
#[derive(Clone, Debug)]
pub struct SampledLongRun {
    /// All of it.
    pub intervals: Vec<Interval>,
    /// The largest |u| of the whole run.
    pub peak_u: f64,
    /// Figures of the last period.
    pub last_period: PeriodSums,
    /// The distance max|y(t + T) - y(t)| at the end of each period; of samples as near to a period as there are.
    pub return_distances: Vec<f64>,
    /// The first period at whose end and ever after that distance is below 1e-6 (1 + max|y|), counted from 1.
    pub settled: Option<usize>,
}

impl SampledLongRun {
    /// Whether a period differs more from the one before at the end than it did in the first half: the run grows.
    #[must_use]
    pub fn grows(&self) -> bool {
        let distances = &self.return_distances;
        let (first, second) = distances.split_at(distances.len() / 2);
        let most = |values: &[f64]| values.iter().fold(0.0, |most: f64, value| most.max(*value));
        distances.len() >= ENOUGH && self.settled.is_none() && most(second) > 1.5 * most(first)
    }
}

/// The outcome of a simulation at samples.
#[derive(Clone, Debug)]
pub struct SampledSimulation {
    /// The steady state with the figures of its period, or why there is none.
    pub steady: Result<(SampledSteady, PeriodSums), SampledSteadyError>,
    /// The run, or why it ended early.
    pub long: Result<SampledLongRun, IntegrationFailure>,
}

impl SampledSimulation {
    /// Whether the loop was seen to be unstable: figures of its last period would be those of a moment.
    #[must_use]
    pub fn is_unstable(&self) -> bool {
        let steady = matches!(&self.steady, Err(SampledSteadyError::Unstable { .. }))
            || self.steady.as_ref().is_err_and(SampledSteadyError::is_escape);
        let settled = self.long.as_ref().is_ok_and(|run| run.settled.is_some());
        (steady && !settled) || self.long.as_ref().is_ok_and(SampledLongRun::grows)
    }
}

/// Runs everything that the settings ask for.
#[must_use]
pub fn simulate_sampled(
    sampled: &SampledLoop,
    start: &[f64],
    settings: &SampledSettings,
    progress: &dyn Progress,
) -> SampledSimulation {
    let steady = sampled_steady_state(sampled, start, progress).and_then(|steady| {
        let each = STATES.div_ceil(sampled.samples_rounded_up()).max(BETWEEN);
        let run = SampledRun::new(sampled, 0, &steady.start);
        let mut run = run.ok_or(IntegrationFailure::Escaped { t: sampled.time(0) })?;
        let intervals = (0..sampled.samples_rounded_up()).map(|_| run.advance(each, Tolerance::TIGHT));
        let intervals: Vec<Vec<Piece>> = intervals.collect::<Result<_, _>>()?;
        let sums = PeriodSums::new(&intervals, sampled.states(), sampled.period(), settings.harmonics);
        Ok((steady, sums))
    });
    let long = long_run(sampled, start, settings, progress);
    SampledSimulation { steady, long }
}

fn long_run(
    sampled: &SampledLoop,
    start: &[f64],
    settings: &SampledSettings,
    progress: &dyn Progress,
) -> Result<SampledLongRun, IntegrationFailure> {
    sampled.plant().renew_effort();
    let (samples, periods) = (sampled.samples_rounded_up(), settings.periods.max(1));
    let each = settings.samples.div_ceil(samples).max(2);
    let too_much = IntegrationFailure::TooMuchWork { t: sampled.time(0) };
    let numbers = periods.saturating_mul(samples).saturating_mul(each * (sampled.states() + 1) + sampled.dimension());
    if numbers > MAX_NUMBERS / 2 {
        return Err(too_much);
    }
    let mut run = SampledRun::new(sampled, 0, start).ok_or(too_much)?;
    let mut intervals = Vec::with_capacity(periods * samples);
    let (mut return_distances, mut settled) = (Vec::with_capacity(periods), None);
    let mut before = run.whole_state();
    for period in 1..=periods {
        for _ in 0..samples {
            let z = run.regulator_state().to_vec();
            intervals.push(Interval { z, pieces: run.advance(each, Tolerance::ORDINARY)? });
        }
        let y = run.whole_state();
        let distance = max_distance(&y, &before);
        let size = y.iter().fold(1.0, |size: f64, value| size.max(1.0 + value.abs()));
        return_distances.push(distance);
        settled = settled.filter(|_| distance < SETTLED * size).or((distance < SETTLED * size).then_some(period));
        before = y;
        progress.advance();
    }
    let last: Vec<Vec<Piece>> =
        intervals.iter().skip(intervals.len() - samples).map(|interval| interval.pieces.clone()).collect();
    let pieces = intervals.iter().flat_map(|interval| &interval.pieces);
    Ok(SampledLongRun {
        peak_u: pieces.fold(0.0, |most: f64, piece| most.max(piece.u.abs())),
        last_period: PeriodSums::new(&last, sampled.states(), sampled.period(), settings.harmonics),
        return_distances,
        settled,
        intervals,
    })
}
