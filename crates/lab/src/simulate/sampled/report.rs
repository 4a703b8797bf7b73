//! What a person, or a script, reads about a simulation at samples.

use super::figures::sampled_figures;
use super::run::{PeriodSums, SampledLongRun, SampledSimulation};
use super::sampled_loop::SampledLoop;
use super::steady::{SampledSteady, run_way_out};
use super::words::{converter_words, loop_words};
use crate::simulate::report::{amplitude, multiplier, number, period_words};
use serde_json::{Value, json};
use sigmastar_document::{Block, Readable, Table, clean};
use sigmastar_lang::plant::Plant;

/// Why a run of an unstable loop has no figures.
const UNSTABLE: &str = "the loop is unstable: the run does not stay near a periodic solution";
const UNSTABLE_HELP: &str =
    "the samples (--csv) show how it leaves; take a shorter sampling time, a shorter delay, or other gains";

/// The report on a simulation at samples.
pub struct SampledSimulationReport<'r> {
    /// What was simulated.
    pub plant: &'r Plant,
    /// With which regulator.
    pub sampled: &'r SampledLoop,
    /// What came of it.
    pub simulation: &'r SampledSimulation,
}

impl Readable for SampledSimulationReport<'_> {
    fn blocks(&self) -> Vec<Block> {
        let SampledSimulationReport { plant, sampled, simulation } = self;
        let mut about =
            vec![format!("Floating point, no claim. {}; period {}", loop_words(sampled), number(sampled.period()))];
        about.push(match sampled.samples() {
            Some(samples) => format!("{samples} samples a period"),
            None => format!("{} samples a period", number(sampled.period() / sampled.step())),
        });
        if sampled.phase != 0.0 {
            about.push(format!("the first at $`t = {}`$", number(sampled.phase)));
        }
        about.extend(converter_words(sampled));
        let mut blocks = vec![
            Block::Title(format!("{}: simulation at samples", clean(&plant.name))),
            Block::says(format!("{}.", about.join("; "))),
            Block::heading("Steady state"),
        ];
        match &simulation.steady {
            Ok((steady, sums)) => blocks.extend(steady_blocks(plant, steady, sums)),
            Err(error) => blocks.push(Block::says(format!("None is shown: {error}; {}.", error.way_out()))),
        }
        blocks.push(Block::heading("From the initial condition"));
        blocks.push(Block::says(match &simulation.long {
            Ok(_) if simulation.is_unstable() => format!("It has no figures: {UNSTABLE}; {UNSTABLE_HELP}."),
            Ok(run) => long_words(plant, sampled, run),
            Err(error) => format!("It has no figures: {error}; {}.", run_way_out(error)),
        }));
        let drawn = sampled_figures(plant, sampled, simulation);
        blocks.extend(drawn.into_iter().map(|(_, figure)| Block::Drawing(figure)));
        blocks
    }

    /// As JSON: `{"format": "sigmastar/simulation", "version": 1, ...}` with `sampled`; floating-point numbers as such.
    fn json(&self) -> Value {
        let SampledSimulationReport { plant, sampled, simulation } = self;
        let regulator = &sampled.regulator;
        let steady = match &simulation.steady {
            Ok((steady, sums)) => json!({
                "sup_e": sums.sup, "sup_e_at_samples": sums.sup_at_samples, "rms_e": sums.rms,
                "amplitudes": sums.amplitudes, "amplitudes_at_samples": sums.amplitudes_at_samples,
                "sup_u": sums.period.sup_u, "energy_u": sums.period.energy, "sup_x": sums.period.sup_x,
                "residual": steady.residual, "multipliers": steady.multipliers,
                "multipliers_uncertainty": steady.multipliers.as_ref().map(|_| steady.uncertainty),
                "method": "samples", "start": steady.start,
            }),
            Err(error) => json!({ "error": error.to_string(), "help": error.way_out() }),
        };
        let long = match &simulation.long {
            Ok(_) if simulation.is_unstable() => json!({ "error": UNSTABLE, "help": UNSTABLE_HELP }),
            Ok(run) => json!({
                "periods": run.return_distances.len(),
                "sup_e_last_period": run.last_period.sup, "sup_e_at_samples_last_period": run.last_period.sup_at_samples,
                "rms_e_last_period": run.last_period.rms,
                "sup_u": run.peak_u, "sup_u_last_period": run.last_period.period.sup_u,
                "energy_u_last_period": run.last_period.period.energy, "sup_x_last_period": run.last_period.period.sup_x,
                "return_distances": run.return_distances, "settled_period": run.settled,
                "method": { "name": "samples" },
            }),
            Err(error) => json!({ "error": error.to_string(), "help": run_way_out(error) }),
        };
        json!({
            "format": "sigmastar/simulation", "version": 1, "name": clean(&plant.name),
            "regulator": {
                "n_o": regulator.oscillators(), "sigma": regulator.sigma, "mu": regulator.mu,
                "frequencies": regulator.frequencies, "weights": regulator.weights,
            },
            "period": sampled.period(),
            "sampled": {
                "step": sampled.discrete.step, "samples": sampled.samples(), "phase": sampled.phase,
                "K": sampled.discrete.gain, "weight_sum": sampled.discrete.weight_sum,
                "delay": sampled.delay(), "quantum_e": sampled.converters.measured,
                "quantum_u": sampled.converters.put_out, "saturation": sampled.discrete.saturation,
            },
            "steady_state": steady, "long_run": long, "noisy_run": null,
        })
    }
}

fn steady_blocks(plant: &Plant, steady: &SampledSteady, sums: &PeriodSums) -> Vec<Block> {
    let mut table = Table::new(&["$`k`$", "$`|c_k|`$ of $`e`$", "$`|c_k|`$ of $`e`$ at the samples"]);
    for (k, amplitude) in sums.amplitudes.iter().enumerate() {
        let sampled =
            sums.amplitudes_at_samples.get(k).map_or_else(String::new, |size| self::amplitude(*size, sums.sup));
        table.push([k.to_string(), self::amplitude(*amplitude, sums.sup), sampled]);
    }
    let stability = match steady.largest_multiplier() {
        // Six digits are shown.
        Some(largest) if 1.0 - largest <= steady.uncertainty => format!(
            " Its largest Floquet multiplier is {largest:.9}, known only to {:.0e}: it cannot be told whether it attracts its neighbours.",
            steady.uncertainty
        ),
        Some(largest) => {
            format!(" Its largest Floquet multiplier is {}: it attracts its neighbours.", multiplier(largest))
        }
        None => " A run settles on it. A loop that quantises has no multipliers.".to_owned(),
    };
    vec![
        Block::says(format!(
            "$`sup|e| = {}`$ ({} at the samples), $`rms(e) = {}`$. It is periodic to {:.1e}.{stability}",
            number(sums.sup),
            number(sums.sup_at_samples),
            number(sums.rms),
            steady.residual,
        )),
        Block::says(format!("Over a period: {}.", period_words(plant, &sums.period))),
        Block::Table(table),
    ]
}

fn long_words(plant: &Plant, sampled: &SampledLoop, run: &SampledLongRun) -> String {
    let last = run.return_distances.last().copied().unwrap_or_default();
    let settled = match (sampled.samples(), run.settled) {
        (None, _) => "The samples fall differently in every period, so nothing is periodic".to_owned(),
        (Some(_), Some(period)) => format!("It is steady to 1e-6 from period {period} on"),
        (Some(_), None) => {
            format!("It is not steady to 1e-6 at the end: the last period differs by {last:.1e} from the one before")
        }
    };
    format!(
        "The run has {} periods. {settled}. Over the last period: largest $`|e| = {}`$ ({} at the samples), $`rms(e) = {}`$, {}. Over all: largest $`|u| = {}`$.",
        run.return_distances.len(),
        number(run.last_period.sup),
        number(run.last_period.sup_at_samples),
        number(run.last_period.rms),
        period_words(plant, &run.last_period.period),
        number(run.peak_u)
    )
}
