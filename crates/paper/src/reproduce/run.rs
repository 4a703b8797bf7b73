//! Computing the cells.

use super::printed::{PrintedRow, PrintedTable, ROWS, last_place};
use rayon::prelude::*;
use sigmastar_document::progress::{Progress, Silent};
use sigmastar_exact::number::Portable;
use sigmastar_lab::simulate::{
    BandLimitedNoise, ClosedLoop, Noise, NoiseSettings, SteadyFigures, SteadyStateError, noisy_run, steady_state,
};
use sigmastar_lang::plant::Plant;
use sigmastar_regulator::Regulator;

/// mu of the paper's simulations.
const MU: f64 = 1.0;
/// epsilon of the paper's weights.
const EPSILON: f64 = 0.5;
/// n_0 as the tables were computed (E20), and as the text says.
pub(super) const N_0: [f64; 2] = [1.0, 2.0];
/// The power of the paper's noise.
const POWER: f64 = 1e-3;
/// The length of the paper's simulations, in periods.
const PERIODS: usize = 150;
/// The periods at the end from which the paper takes one at random.
const LAST_PERIODS: usize = 30;
/// The paper's steps per period.
const PAPER_STEPS: usize = 100_000;
/// Fourier coefficients that are kept for the figures.
const HARMONICS: usize = 13;

/// Which parts are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parts {
    /// The noise-free columns of the first table.
    pub table_1: bool,
    /// The noise-free columns of the second table.
    pub table_2: bool,
    /// The columns with noise.
    pub noise: bool,
    /// The figures.
    pub figures: bool,
}

impl Parts {
    /// All of them.
    pub const ALL: Parts = Parts { table_1: true, table_2: true, noise: true, figures: true };
}

/// What is computed, and how finely.
#[derive(Clone, Copy, Debug)]
pub struct ReproductionSettings {
    /// The parts.
    pub parts: Parts,
    /// The number of seeds: 1, ..., `seeds`.
    pub seeds: u64,
    /// Steps per period of the runs with noise.
    pub noise_steps: usize,
}

impl ReproductionSettings {
    /// The units of work that a [`Progress`] hears of.
    #[must_use]
    pub fn work(&self) -> u64 {
        let noise = if self.parts.noise { (jobs(self.seeds).len() as u64 + self.seeds) * 20 } else { 0 };
        2 * ROWS.len() as u64 + noise
    }
}

/// A noise-free cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// As printed.
    pub printed: &'static str,
    /// As computed.
    pub here: f64,
}

/// How many units in the last printed place a computed value is away from a printed one, after rounding to that place.
#[must_use]
pub fn units(printed: &str, here: f64) -> f64 {
    let place = last_place(printed);
    let printed: f64 = printed.parse().unwrap_or(f64::NAN);
    (here / place).round() - (printed / place).round()
}

/// The range of a cell with noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseRange {
    /// Where the noise enters.
    pub law: Noise,
    /// Smallest and largest of sup|e| over single periods.
    pub sup: [f64; 2],
    /// Smallest and largest of rms(e) over single periods.
    pub rms: [f64; 2],
}

/// A row for one n_0.
#[derive(Clone, Debug)]
pub struct ComputedRow {
    /// The printed row.
    pub row: &'static PrintedRow,
    /// n_0; `None` for the high-gain feedback.
    pub n_0: Option<f64>,
    /// The steady state, or why there is none: sup|e|, rms(e) and the Fourier coefficients.
    pub quiet: Option<Result<SteadyFigures, SteadyStateError>>,
    /// The largest Floquet multiplier of the steady state.
    pub multiplier: Option<f64>,
    /// The ranges with noise, by law.
    pub noisy: Vec<NoiseRange>,
}

impl ComputedRow {
    /// The two noise-free cells.
    #[must_use]
    pub fn cells(&self) -> Option<[Cell; 2]> {
        let figures = self.quiet.as_ref()?.as_ref().ok()?;
        let [sup, rms] = self.row.quiet;
        Some([Cell { printed: sup, here: figures.sup }, Cell { printed: rms, here: figures.rms }])
    }
}

/// Everything that was computed.
#[derive(Clone, Debug)]
pub struct Reproduction {
    /// What was asked for.
    pub settings: ReproductionSettings,
    /// The rows.
    pub rows: Vec<ComputedRow>,
    /// For each seed the largest |v| over 150 s at the paper's sampling time.
    pub largest_noise: Vec<f64>,
}

/// The paper's regulator of a row.
pub(super) fn regulator(row: &PrintedRow, n_0: f64) -> Regulator {
    match row.n_o {
        None => Regulator::high_gain(row.sigma),
        Some(n_o) => internal_model(row.sigma, n_0, n_o, row.base_frequency()),
    }
}

/// The paper's internal model: mu = 1, n_l = l^-(3/2) for l >= 1.
pub(super) fn internal_model(sigma: f64, n_0: f64, n_o: u32, base_frequency: f64) -> Regulator {
    let weight = |l: u32| if l == 0 { n_0 } else { f64::from(l).portable_pow(-1.0 - EPSILON) };
    Regulator::new(sigma, MU, base_frequency, (0..=n_o).map(weight).collect())
}

/// A run with noise: the index of the row, n_0, the law, the seed.
type Job = (usize, f64, Noise, u64);

fn jobs(seeds: u64) -> Vec<Job> {
    let mut jobs = Vec::new();
    for (index, row) in ROWS.iter().enumerate() {
        // For the high-gain feedback there is one law and no n_0.
        let (weights, laws) = match row.table {
            PrintedTable::HighGain => (&N_0[..1], &[Noise::Printed][..]),
            PrintedTable::InternalModel => (&N_0[..], &[Noise::Printed, Noise::Everywhere][..]),
        };
        for &n_0 in weights {
            for &law in laws {
                jobs.extend((1..=seeds).map(|seed| (index, n_0, law, seed)));
            }
        }
    }
    jobs
}

/// Computes the parts that are asked for of the plant of the paper's numerical example; rows run in parallel, and the figures do
/// not depend on how many at a time.
#[must_use]
pub fn reproduce(plant: &Plant, settings: ReproductionSettings, progress: &dyn Progress) -> Reproduction {
    let parts = settings.parts;
    let mut variants: Vec<(usize, Option<f64>)> = Vec::new();
    for (index, row) in ROWS.iter().enumerate() {
        match row.table {
            PrintedTable::HighGain => variants.push((index, None)),
            PrintedTable::InternalModel => variants.extend(N_0.iter().map(|&n_0| (index, Some(n_0)))),
        }
    }
    let noise: Vec<(Job, Option<NoiseRange>)> = match parts.noise {
        false => Vec::new(),
        true => jobs(settings.seeds)
            .into_par_iter()
            .map(|job| {
                let range = noise_range(plant, job, settings.noise_steps);
                (0..20).for_each(|_| progress.advance());
                (job, range)
            })
            .collect(),
    };
    let rows = variants
        .into_par_iter()
        .map(|(index, n_0)| {
            let row = &ROWS[index];
            let wanted = match row.table {
                PrintedTable::HighGain => parts.table_1,
                PrintedTable::InternalModel => parts.table_2,
            };
            let steady = wanted.then(|| figures_of(plant, regulator(row, n_0.unwrap_or(N_0[0]))));
            progress.advance();
            let (quiet, multiplier) = match steady {
                None => (None, None),
                Some(Ok((figures, multiplier))) => (Some(Ok(figures)), Some(multiplier)),
                Some(Err(error)) => (Some(Err(error)), None),
            };
            let of_row = |law: Noise| {
                let ranges = noise.iter().filter(|((at, weight, this, _), _)| {
                    *at == index && *this == law && n_0.is_none_or(|n_0| n_0 == *weight)
                });
                ranges.filter_map(|(_, range)| *range).reduce(|a, b| NoiseRange {
                    law,
                    sup: [a.sup[0].min(b.sup[0]), a.sup[1].max(b.sup[1])],
                    rms: [a.rms[0].min(b.rms[0]), a.rms[1].max(b.rms[1])],
                })
            };
            let noisy = [Noise::Printed, Noise::Everywhere].into_iter().filter_map(of_row).collect();
            ComputedRow { row, n_0, quiet, multiplier, noisy }
        })
        .collect();
    let largest_noise = match parts.noise {
        false => Vec::new(),
        true => (1..=settings.seeds)
            .into_par_iter()
            .map(|seed| {
                let step = 1.0 / PAPER_STEPS as f64;
                let mut noise = BandLimitedNoise::new(NoiseSettings { power: POWER, seed }, step);
                let largest = (0..PERIODS * PAPER_STEPS).fold(0.0_f64, |largest, _| largest.max(noise.sample().abs()));
                (0..20).for_each(|_| progress.advance());
                largest
            })
            .collect(),
    };
    Reproduction { settings, rows, largest_noise }
}

/// The steady figures of the paper's plant with a regulator, and the largest Floquet multiplier.
pub(super) fn figures_of(plant: &Plant, regulator: Regulator) -> Result<(SteadyFigures, f64), SteadyStateError> {
    let closed_loop = ClosedLoop::new(plant, regulator);
    let start = closed_loop.start(&plant.initial.x, plant.initial.e);
    let steady = steady_state(&closed_loop, &start, &Silent)?;
    let figures = SteadyFigures::new(&closed_loop, &steady, HARMONICS)?;
    Ok((figures, steady.multipliers.first().copied().unwrap_or(0.0)))
}

/// The range over the last periods of one run; `None` where the solution escaped.
fn noise_range(plant: &Plant, (index, n_0, law, seed): Job, steps: usize) -> Option<NoiseRange> {
    let closed_loop = ClosedLoop::new(plant, regulator(&ROWS[index], n_0));
    let start = closed_loop.start(&plant.initial.x, plant.initial.e);
    let settings = NoiseSettings { power: POWER, seed };
    let run = noisy_run(&closed_loop, &start, PERIODS, steps, settings, law, &Silent).ok()?;
    Some(NoiseRange { law, sup: last_range(&run.sup), rms: last_range(&run.rms) })
}

/// The smallest and the largest of the last periods.
fn last_range(values: &[f64]) -> [f64; 2] {
    let last = values.iter().rev().take(LAST_PERIODS);
    last.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(*value), high.max(*value)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_count_the_last_printed_place() {
        assert_eq!(units("0.3074", 0.30738), 0.0);
        assert_eq!(units("0.3074", 0.30751), 1.0);
        assert_eq!(units("3.04e-8", 3.0263e-8), -1.0);
        assert_eq!(units("0.400", 0.40002), 0.0);
    }

    #[test]
    fn ranges_are_over_the_last_periods() {
        let values: Vec<f64> = (0..PERIODS).map(|period| (period as f64 - 140.0).abs()).collect();
        assert_eq!(last_range(&values), [0.0, 20.0]);
    }

    #[test]
    fn every_row_runs_with_both_weights_and_laws() {
        let jobs = jobs(3);
        assert_eq!(jobs.len(), 5 * 3 + 14 * 2 * 2 * 3);
        assert!(
            jobs.iter().all(|(index, n_0, law, _)| {
                ROWS[*index].n_o.is_some() || (*n_0 == N_0[0] && *law == Noise::Printed)
            })
        );
    }
}
