//! What a person, or a script, reads about a simulation.

use super::figures::{figures, regulator_words};
use super::run::{Integrator, LongRun, NoisyRun, PeriodFigures, Simulation, SteadyFigures};
use super::{ClosedLoop, IntegrationFailure, SteadyState};
use serde_json::{Value, json};
use sigmastar_document::{Block, Readable, Table, clean, plain};
use sigmastar_exact::number::write_exact;
use sigmastar_lang::expr::quoted;
use sigmastar_lang::plant::{Initial, InitialRegulator, Plant};
use sigmastar_lang::spec::Actuator;

/// The report on a simulation.
pub struct SimulationReport<'r> {
    /// What was simulated.
    pub plant: &'r Plant,
    /// With which regulator.
    pub closed_loop: &'r ClosedLoop,
    /// What came of it.
    pub simulation: &'r Simulation,
}

/// "; u is measured from 4", the middle of the range of the actuator; nothing where that is 0.
pub(super) fn measured_from(plant: &Plant) -> String {
    let middle = plant.actuator.as_ref().and_then(Actuator::middle);
    middle.map_or_else(String::new, |middle| format!("; $`u`$ is measured from {}", write_exact(&middle)))
}

impl Readable for SimulationReport<'_> {
    fn blocks(&self) -> Vec<Block> {
        let SimulationReport { plant, closed_loop, simulation } = self;
        let mut blocks = vec![
            Block::Title(format!("{}: simulation", clean(&plant.name))),
            Block::says(format!(
                "Floating point, no claim. {}; period {}.{}",
                regulator_words(&closed_loop.regulator, closed_loop.period),
                number(closed_loop.period),
                closed_loop.limit().map_or_else(String::new, |limit| format!(
                    " The actuator limits u to $`|u| <= {}`${}.",
                    number(limit),
                    measured_from(plant)
                ))
            )),
            Block::heading("Steady state"),
        ];
        match &simulation.steady {
            Ok((steady, figures)) => blocks.extend(steady_blocks(plant, steady, figures)),
            Err(error) => blocks.push(Block::says(format!(
                "None was found: {error}; {}. The run starts at {}.",
                error.way_out("--fixed"),
                initial_words(plant)
            ))),
        }
        blocks.push(Block::heading("From the initial condition"));
        match &simulation.long {
            Ok(run) => blocks.push(Block::says(long_words(plant, run))),
            Err(error) => blocks.push(ended_early(error, "--fixed")),
        }
        let drawn = figures(plant, closed_loop, simulation);
        blocks.extend(drawn.into_iter().map(|(_, figure)| Block::Drawing(figure)));
        if let Some(noisy) = &simulation.noisy {
            blocks.push(Block::heading("With measurement noise"));
            match noisy {
                Ok(run) => blocks.push(Block::says(noisy_words(run))),
                Err(error) => blocks.push(ended_early(error, "--noise-steps")),
            }
        }
        blocks
    }

    /// As JSON: `{"format": "sigmastar/simulation", "version": 1, ...}`; floating-point numbers as such.
    fn json(&self) -> Value {
        let SimulationReport { plant, closed_loop, simulation } = self;
        let regulator = &closed_loop.regulator;
        let steady = match &simulation.steady {
            Ok((steady, figures)) => json!({
                "sup_e": figures.sup, "rms_e": figures.rms, "amplitudes": figures.amplitudes,
                "sup_u": figures.period.sup_u, "energy_u": figures.period.energy, "sup_x": figures.period.sup_x,
                "residual": steady.residual, "multipliers": steady.multipliers,
                "multipliers_uncertainty": steady.uncertainty, "method": steady.method(), "start": steady.start,
            }),
            Err(error) => json!({
                "error": error.to_string(), "help": error.way_out("--fixed"), "from": plain(&initial_words(plant)),
            }),
        };
        let failure =
            |error: &IntegrationFailure, flag| json!({ "error": error.to_string(), "help": error.way_out(flag) });
        let method = match simulation.settings.integrator {
            Integrator::Adaptive => json!({ "name": "dormand-prince-8", "where_stiff": "radau-13" }),
            Integrator::Fixed(asked) => json!({
                "name": "runge-kutta-4", "steps_per_period": simulation.settings.fixed_steps(), "asked": asked,
            }),
        };
        let long = match &simulation.long {
            Ok(run) => json!({
                "periods": run.return_distances.len(), "sup_e_last_period": run.sup, "rms_e_last_period": run.rms,
                "sup_u": run.peak_u, "sup_u_last_period": run.last_period.sup_u,
                "energy_u_last_period": run.last_period.energy, "sup_x_last_period": run.last_period.sup_x,
                "return_distances": run.return_distances, "settled_period": run.settled, "method": method,
            }),
            Err(error) => failure(error, "--fixed"),
        };
        let noisy = simulation.noisy.as_ref().map(|noisy| match noisy {
            Ok(run) => json!({ "sup_v": run.largest_noise, "sup_e": run.sup, "rms_e": run.rms }),
            Err(error) => failure(error, "--noise-steps"),
        });
        json!({
            "format": "sigmastar/simulation", "version": 1, "name": clean(&plant.name),
            "regulator": {
                "n_o": regulator.oscillators(), "sigma": regulator.sigma, "mu": regulator.mu,
                "frequencies": regulator.frequencies, "weights": regulator.weights,
            },
            "period": closed_loop.period,
            "steady_state": steady, "long_run": long, "noisy_run": noisy,
        })
    }
}

/// Four digits.
pub(super) fn number(value: f64) -> String {
    digits(value, 4)
}

/// A Floquet multiplier: six digits, for what is near 1 is told apart from 1.
pub(super) fn multiplier(value: f64) -> String {
    digits(value, 6)
}

fn digits(value: f64, count: usize) -> String {
    if value == 0.0 || (1e-3..1e5).contains(&value.abs()) {
        let before = libm::log10(value.abs().max(1e-300)).floor() as i32 + 1;
        let behind = (count as i32 - before).clamp(0, 12) as usize;
        return format!("{value:.behind$}");
    }
    format!("{value:.*e}", count - 1)
}

/// Amplitudes below this share of the largest |e| are rounding.
const NOISE: f64 = 1e-12;

/// The amplitude of a harmonic; what is rounding, against the largest |e| `scale`, is 0.
pub(super) fn amplitude(value: f64, scale: f64) -> String {
    if value.abs() <= NOISE * scale { "0".to_owned() } else { number(value) }
}

/// Why there are no figures, and what to try.
fn ended_early(error: &IntegrationFailure, flag: &str) -> Block {
    Block::says(format!("It has no figures: {error}; {}.", error.way_out(flag)))
}

/// The initial condition of a plant file.
fn initial_words(plant: &Plant) -> String {
    let Initial { x, e, z } = &plant.initial;
    let states = plant.names.states().iter().zip(x).map(|(name, value)| format!("{} = {value}", quoted(name)));
    let mut words: Vec<String> = states.chain([format!("$`e = {e}`$")]).collect();
    let of_regulator = match z {
        InitialRegulator::AtRest => "with the regulator at rest",
        InitialRegulator::Aligned => "with $`z = M e`$",
        InitialRegulator::Given(_) => "with the $`z`$ of the plant file",
    };
    words.push(of_regulator.to_owned());
    words.join(", ")
}

fn steady_blocks(plant: &Plant, steady: &SteadyState, figures: &SteadyFigures) -> Vec<Block> {
    let slowest = steady.multipliers.first().copied().unwrap_or(0.0);
    let verdict = if slowest < 1.0 { "it attracts its neighbours" } else { "it does not attract its neighbours" };
    // Six digits are shown.
    let doubt = match steady.uncertainty > 1e-6 {
        true => format!(" (uncertain: its derivative is known only to {:.0e})", steady.uncertainty),
        false => String::new(),
    };
    let scale = figures.sup;
    let mut table = Table::new(&["$`k`$", "$`|c_k|`$ of $`e`$"]);
    for (k, amplitude) in figures.amplitudes.iter().enumerate() {
        table.push([k.to_string(), self::amplitude(*amplitude, scale)]);
    }
    vec![
        Block::says(format!(
            "$`sup|e| = {}`$, $`rms(e) = {}`$. It is periodic to {:.1e}. Its largest Floquet multiplier is {}{doubt}: {verdict}.",
            number(figures.sup),
            number(figures.rms),
            steady.residual,
            multiplier(slowest),
        )),
        Block::says(format!("Over a period: {}.", period_words(plant, &figures.period))),
        Block::Table(table),
    ]
}

/// The control and the states over a period.
pub(super) fn period_words(plant: &Plant, figures: &PeriodFigures) -> String {
    let mut words =
        format!("largest $`|u| = {}`$, integral of $`u^2 = {}`$", number(figures.sup_u), number(figures.energy));
    for (name, sup) in plant.names.states().iter().zip(&figures.sup_x) {
        words.push_str(&format!(", largest |{}| = {}", quoted(name), number(*sup)));
    }
    words
}

fn long_words(plant: &Plant, run: &LongRun) -> String {
    let settled = match run.settled {
        Some(period) => format!("It is steady to 1e-6 from period {period} on"),
        None => "It is not steady to 1e-6 at the end".to_owned(),
    };
    format!(
        "The run has {} periods. {settled}. Over the last period: largest $`|e| = {}`$, $`rms(e) = {}`$, {}. Over all: largest $`|u| = {}`$.",
        run.return_distances.len(),
        number(run.sup),
        number(run.rms),
        period_words(plant, &run.last_period),
        number(run.peak_u)
    )
}

fn range(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(*value), high.max(*value)))
}

fn noisy_words(run: &NoisyRun) -> String {
    // The second half of the run: what is left of the initial condition is not noise.
    let half = run.sup.len() / 2;
    let (sup, rms) = (range(&run.sup[half..]), range(&run.rms[half..]));
    format!(
        "Largest $`|v| = {}`$. Over single periods of the second half: largest $`|e|`$ from {} to {}, $`rms(e)`$ from {} to {}.",
        number(run.largest_noise),
        number(sup.0),
        number(sup.1),
        number(rms.0),
        number(rms.1)
    )
}
