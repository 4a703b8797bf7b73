//! What a person, or a script, reads about a simulation.

use super::run::{LongRun, Method, NoisyRun, Simulation, SteadyFigures};
use super::{ClosedLoop, Disturbance, IntegrationFailure, SteadyState, frequencies, magnitude};
use crate::plant::Plant;
use crate::plot::{Curve, Figure, Scale};
use crate::regulator::Regulator;
use crate::report::blocks::{Block, Table, clean};
use serde_json::{Value, json as object};
use std::f64::consts::TAU;

/// The `format` of a simulation report.
pub const FORMAT: &str = "sigmastar/simulation";
/// Its version.
pub const VERSION: u64 = 1;

/// Amplitudes below this are rounding; it is the floor of spectra.
const SPECTRUM_FLOOR: f64 = 1e-16;

/// The regulator in words.
fn regulator_words(regulator: &Regulator) -> String {
    match regulator.oscillators() {
        None => format!("high-gain feedback, sigma = {}", regulator.sigma),
        Some(n_o) => format!("internal model, sigma = {}, mu = {}, n_o = {n_o}", regulator.sigma, regulator.mu),
    }
}

fn number(value: f64) -> String {
    if value == 0.0 || (1e-3..1e6).contains(&value.abs()) {
        let digits = (5 - libm::log10(value.abs().max(1e-300)).floor() as i32).clamp(0, 12) as usize;
        return format!("{value:.digits$}");
    }
    format!("{value:.5e}")
}

/// The report as a document.
#[must_use]
pub fn blocks(plant: &Plant, closed_loop: &ClosedLoop, simulation: &Simulation) -> Vec<Block> {
    let mut blocks = vec![
        Block::Title(format!("{}: simulation", clean(&plant.name))),
        Block::says(format!(
            "Floating point, no claim. {}; period {}.",
            regulator_words(&closed_loop.regulator),
            number(closed_loop.period)
        )),
        Block::Heading("Steady state".to_owned()),
    ];
    match &simulation.steady {
        Ok((steady, figures)) => blocks.extend(steady_blocks(steady, figures)),
        Err(error) => blocks.push(Block::says(format!("None was found: {error}{}.", advice(error.way_out("--fixed"))))),
    }
    blocks.push(Block::Heading("From the initial condition".to_owned()));
    match &simulation.long {
        Ok(run) => blocks.push(Block::says(long_words(run))),
        Err(error) => blocks.push(ended_early(error, "--fixed")),
    }
    if let Some(noisy) = &simulation.noisy {
        blocks.push(Block::Heading("With measurement noise".to_owned()));
        match noisy {
            Ok(run) => blocks.push(Block::says(noisy_words(run))),
            Err(error) => blocks.push(ended_early(error, "--noise-steps")),
        }
    }
    blocks
}

/// Why there are no figures, and what to try.
fn ended_early(error: &IntegrationFailure, flag: &str) -> Block {
    Block::says(format!("It has no figures: {error}{}.", advice(Some(error.way_out(flag)))))
}

fn advice(way_out: Option<String>) -> String {
    way_out.map_or_else(String::new, |help| format!("; {help}"))
}

fn steady_blocks(steady: &SteadyState, figures: &SteadyFigures) -> Vec<Block> {
    let slowest = steady.multipliers.first().copied().unwrap_or(0.0);
    let verdict = if slowest < 1.0 { "it attracts its neighbours" } else { "it does not attract its neighbours" };
    let mut table = Table::new(&["k", "|c_k| of e"]);
    for (k, amplitude) in figures.amplitudes.iter().enumerate() {
        table.push([k.to_string(), format!("{amplitude:.4e}")]);
    }
    vec![
        Block::says(format!(
            "sup|e| = {}, rms(e) = {}. Periodic to {:.1e}; largest Floquet multiplier {}: {verdict}.",
            number(figures.sup),
            number(figures.rms),
            steady.residual,
            number(slowest),
        )),
        Block::Table(table),
    ]
}

fn long_words(run: &LongRun) -> String {
    let settled = match run.settled {
        Some(period) => format!("Steady to 1e-6 from period {period} on"),
        None => "Not steady to 1e-6 at the end".to_owned(),
    };
    format!(
        "{} periods. {settled}. Over the last period: largest |e| = {}, rms(e) = {}.",
        run.return_distances.len(),
        number(run.sup),
        number(run.rms)
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
        "Largest |v| = {}. Over single periods of the second half: largest |e| from {} to {}, rms(e) from {} to {}.",
        number(run.largest_noise),
        number(sup.0),
        number(sup.1),
        number(rms.0),
        number(rms.1)
    )
}

/// The report as plain text.
#[must_use]
pub fn text(plant: &Plant, closed_loop: &ClosedLoop, simulation: &Simulation) -> String {
    crate::report::text(&blocks(plant, closed_loop, simulation))
}

/// The report as JSON; floating-point numbers as such.
#[must_use]
pub fn json(plant: &Plant, closed_loop: &ClosedLoop, simulation: &Simulation) -> Value {
    let regulator = &closed_loop.regulator;
    let steady = match &simulation.steady {
        Ok((steady, figures)) => object!({
            "sup_e": figures.sup, "rms_e": figures.rms, "amplitudes": figures.amplitudes,
            "residual": steady.residual, "multipliers": steady.multipliers, "start": steady.start,
        }),
        Err(error) => object!({ "error": error.to_string(), "help": error.way_out("--fixed") }),
    };
    let failure =
        |error: &IntegrationFailure, flag| object!({ "error": error.to_string(), "help": error.way_out(flag) });
    let method = match simulation.settings.method {
        Method::Adaptive => object!({ "name": "dormand-prince-8" }),
        Method::Fixed(asked) => object!({
            "name": "runge-kutta-4", "steps_per_period": simulation.settings.fixed_steps(), "asked": asked,
        }),
    };
    let long = match &simulation.long {
        Ok(run) => object!({
            "periods": run.return_distances.len(), "sup_e_last_period": run.sup, "rms_e_last_period": run.rms,
            "return_distances": run.return_distances, "settled_period": run.settled, "method": method,
        }),
        Err(error) => failure(error, "--fixed"),
    };
    let noisy = simulation.noisy.as_ref().map(|noisy| match noisy {
        Ok(run) => object!({ "sup_v": run.largest_noise, "sup_e": run.sup, "rms_e": run.rms }),
        Err(error) => failure(error, "--noise-steps"),
    });
    object!({
        "format": FORMAT, "version": VERSION, "name": clean(&plant.name),
        "regulator": {
            "n_o": regulator.oscillators(), "sigma": regulator.sigma, "mu": regulator.mu,
            "frequencies": regulator.frequencies, "weights": regulator.weights,
        },
        "period": closed_loop.period,
        "steady_state": steady, "long_run": long, "noisy_run": noisy,
    })
}

/// The samples of a long run as CSV: t, the states, e, u, and the components of z as z0, z1c, z1s, ...
#[must_use]
pub fn csv(plant: &Plant, closed_loop: &ClosedLoop, run: &LongRun) -> String {
    let mut header = vec!["t".to_owned()];
    header.extend(plant.names.states().iter().cloned());
    header.extend(["e", "u"].map(str::to_owned));
    for component in 0..closed_loop.regulator.dimension() {
        header.push(match component {
            0 => "z0".to_owned(),
            i => format!("z{}{}", i.div_ceil(2), if i % 2 == 1 { "c" } else { "s" }),
        });
    }
    let mut text = header.join(",") + "\n";
    let n = closed_loop.states();
    for (t, y) in run.times.iter().zip(&run.states) {
        let u = closed_loop.control(y, Disturbance::default());
        let values = [*t].into_iter().chain(y[..=n].iter().copied()).chain([u]).chain(y[n + 1..].iter().copied());
        text.push_str(&values.map(|value| format!("{value:?}")).collect::<Vec<_>>().join(","));
        text.push('\n');
    }
    text
}

/// The figures of a simulation, each with the name of its file: the time response, the spectrum of the steady state
/// and, of the linear example e' = u + q with this regulator and without its internal model, the Bode magnitude.
#[must_use]
pub fn figures(closed_loop: &ClosedLoop, simulation: &Simulation) -> Vec<(&'static str, Figure)> {
    let mut figures = Vec::new();
    if let Ok(run) = &simulation.long {
        figures.push(("response.svg", response(closed_loop, run)));
    }
    if let Ok((_, steady)) = &simulation.steady {
        let curve = spectrum_curve("e", &steady.amplitudes);
        figures.push(("spectrum.svg", spectrum("Fourier coefficients of the steady error", vec![curve])));
    }
    figures.push(("bode.svg", bode(&closed_loop.regulator)));
    figures
}

fn response(closed_loop: &ClosedLoop, run: &LongRun) -> Figure {
    let points = run.times.iter().zip(&run.states).map(|(t, y)| (*t, y[closed_loop.states()])).collect();
    Figure {
        title: "Regulated error".to_owned(),
        x: format!("time t [unit of time of the plant file; period {}]", number_short(closed_loop.period)),
        y: "e [unit of e]".to_owned(),
        scale: Scale::Linear,
        floor: 0.0,
        curves: vec![Curve { label: regulator_words(&closed_loop.regulator), points, marked: false }],
    }
}

/// A number in as few digits as it has, six at most.
fn number_short(value: f64) -> String {
    let text = format!("{value:.5e}");
    text.parse().map_or(text, |value: f64| format!("{value:?}").trim_end_matches(".0").to_owned())
}

/// |c_k| over k, for a spectrum.
#[must_use]
pub fn spectrum_curve(label: &str, amplitudes: &[f64]) -> Curve {
    let points = amplitudes.iter().enumerate().map(|(k, amplitude)| (k as f64, *amplitude)).collect();
    Curve { label: label.to_owned(), points, marked: true }
}

/// A figure of Fourier coefficients.
#[must_use]
pub fn spectrum(title: &str, curves: Vec<Curve>) -> Figure {
    Figure {
        title: title.to_owned(),
        x: "harmonic k, of frequency k/T".to_owned(),
        y: "|c_k| of e [unit of e]".to_owned(),
        scale: Scale::LogY,
        floor: SPECTRUM_FLOOR,
        curves,
    }
}

/// The Bode magnitude of e' = u + q from q to e, with the regulator and with the high-gain feedback of its sigma.
#[must_use]
pub fn bode(regulator: &Regulator) -> Figure {
    let last = regulator.frequencies.last().copied().unwrap_or(TAU).max(regulator.sigma);
    let first = regulator.frequencies.first().copied().unwrap_or(TAU).min(regulator.sigma);
    let mut omegas = frequencies(first / 100.0, last * 10.0, 1000);
    // The zeros are as deep as they are narrow: each is approached from both sides.
    for pole in &regulator.frequencies {
        let near = (2..20).map(|quarter| libm::pow(10.0, -0.5 - 0.25 * f64::from(quarter)));
        omegas.extend(near.flat_map(|offset| [pole * (1.0 - offset), pole * (1.0 + offset)]));
        omegas.push(*pole);
    }
    omegas.sort_by(f64::total_cmp);
    let curve = |label: &str, regulator: &Regulator| {
        let points = omegas.iter().map(|&omega| (omega, magnitude(regulator, omega))).collect();
        Curve { label: label.to_owned(), points, marked: false }
    };
    let high_gain = Regulator::high_gain(regulator.sigma);
    let mut curves = vec![curve("high-gain feedback", &high_gain)];
    let mut title = "From q to e, for e' = u + q".to_owned();
    if regulator.oscillators().is_some() {
        curves.push(curve("internal model", regulator));
        title.push_str(" (the zeros are cut at the lower edge)");
    }
    // Two decades below the feedback that has no zeros, wherever that is.
    let least = omegas.iter().map(|&omega| magnitude(&high_gain, omega)).fold(f64::INFINITY, f64::min);
    Figure {
        title,
        x: "angular frequency [rad per unit of time]".to_owned(),
        y: "|e/q| [unit of time]".to_owned(),
        scale: Scale::LogLog,
        floor: libm::pow(10.0, libm::log10(least).floor() - 2.0),
        curves,
    }
}
