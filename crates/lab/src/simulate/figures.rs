//! What a simulation leaves in files: figures, and the samples of a run.

use super::run::{LongRun, Simulation};
use super::{ClosedLoop, Disturbance, frequencies, magnitude};
use sigmastar_document::plain;
use sigmastar_document::plot::{Curve, Figure, Scale, Style};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::Oscillators;
use sigmastar_regulator::Regulator;
use std::f64::consts::TAU;

/// Amplitudes below this share of the largest one are rounding: the floor of spectra. It is no higher than this either.
const SPECTRUM_FLOOR: f64 = 1e-16;

/// The regulator in words, in a loop of this period.
pub(super) fn regulator_words(regulator: &Regulator, period: f64) -> String {
    match regulator.oscillators() {
        None => format!("high-gain feedback, $`sigma = {}`$", regulator.sigma),
        Some(_) => {
            let Regulator { sigma, mu, .. } = regulator;
            format!("internal model, $`sigma = {sigma}`$, $`mu = {mu}`$, {}", oscillator_words(regulator, period))
        }
    }
}

/// `n_o = 3`, or the harmonics of the period at which the oscillators are; how many there are, where they are at none.
fn oscillator_words(Regulator { frequencies, .. }: &Regulator, period: f64) -> String {
    let harmonic = |frequency: &f64| {
        let ratio = frequency * period / TAU;
        ((ratio - ratio.round()).abs() <= 1e-9 * ratio).then_some(ratio.round() as u32)
    };
    let harmonics: Option<Vec<u32>> = std::iter::once(Some(0)).chain(frequencies.iter().map(harmonic)).collect();
    match harmonics.and_then(|harmonics| Oscillators::at(&harmonics).ok()) {
        Some(oscillators) if oscillators.n_o().is_none() => oscillators.to_string(),
        _ => format!("$`n_o = {}`$", frequencies.len()),
    }
}

/// The samples of a long run as CSV: t, the states, e, u, and the components of z as z0, z1c, z1s, ...
#[must_use]
pub fn csv(plant: &Plant, closed_loop: &ClosedLoop, run: &LongRun) -> String {
    let n = closed_loop.states();
    let rows = run.times.iter().zip(&run.states).map(|(t, y)| {
        let u = closed_loop.control(y, Disturbance::default());
        [&[*t], &y[..=n], &[u], &y[n + 1..]].concat()
    });
    table(plant, closed_loop.regulator.dimension(), rows)
}

/// Rows of t, the states, e, u, and the components of z, below their names.
pub(super) fn table(plant: &Plant, dimension: usize, rows: impl Iterator<Item = Vec<f64>>) -> String {
    let of_regulator = (0..dimension).map(|component| match component {
        0 => "z0".to_owned(),
        i => format!("z{}{}", i.div_ceil(2), if i % 2 == 1 { "c" } else { "s" }),
    });
    let mut header = vec!["t".to_owned()];
    header.extend(plant.names.states().iter().cloned());
    header.extend(["e", "u"].map(str::to_owned));
    header.extend(of_regulator);
    let mut text = header.join(",") + "\n";
    for row in rows {
        text.push_str(&row.iter().map(|value| format!("{value:?}")).collect::<Vec<_>>().join(","));
        text.push('\n');
    }
    text
}

/// The names of the files of a simulation's figures.
pub const FIGURE_FILES: [&str; 6] =
    ["response.svg", "transient.svg", "states.svg", "control.svg", "spectrum.svg", "bode.svg"];

/// A start that takes no more than this share of a run is drawn by itself too.
const SHORT: f64 = 0.4;
/// |e| is settled below so many times what it is at the end, or this share of its largest value.
const SETTLED: [f64; 2] = [1.2, 0.03];
/// How much longer than it takes to settle the start is drawn.
const LONGER: f64 = 1.3;

/// The figures of a simulation, each with the name of its file: the time response, its start where that is short, the states of the plant and the control
/// beside it, the spectrum of the steady state and, of the linear example e' = u + q with this regulator and without its internal model, the Bode magnitude.
#[must_use]
pub fn figures(plant: &Plant, closed_loop: &ClosedLoop, simulation: &Simulation) -> Vec<(&'static str, Figure)> {
    let mut figures = Vec::new();
    if let Ok(run) = &simulation.long {
        let response = response(closed_loop, run);
        let start = transient(&response, run.sup);
        figures.push(("response.svg", response));
        figures.extend(start.map(|start| ("transient.svg", start)));
        // A plant without states has no curve to draw.
        if closed_loop.states() > 0 {
            figures.push(("states.svg", states(plant, closed_loop, run)));
        }
        figures.push(("control.svg", control(closed_loop, run)));
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
    let curves = vec![Curve {
        label: plain(&regulator_words(&closed_loop.regulator, closed_loop.period)),
        points,
        style: Style::Line,
    }];
    over_time(closed_loop.period, "Regulated error", "e [unit of e]", curves)
}

/// The start of a response by itself, where it is short beside the whole; `sup` is the largest |e| of the last period.
pub(super) fn transient(response: &Figure, sup: f64) -> Option<Figure> {
    let points = &response.curves.first()?.points;
    let largest = points.iter().fold(0.0_f64, |most, (_, e)| most.max(e.abs()));
    let level = (SETTLED[0] * sup).max(SETTLED[1] * largest);
    let (first, last) = (points.first()?.0, points.last()?.0);
    let settled = points.iter().rev().find(|(_, e)| e.abs() > level)?.0;
    let end = first + LONGER * (settled - first);
    (settled > first && end - first <= SHORT * (last - first)).then(|| {
        let mut start = response.clone();
        start.title = format!("{}: the start", response.title);
        start.curves.iter_mut().for_each(|curve| curve.points.retain(|(t, _)| *t <= end));
        start
    })
}

fn states(plant: &Plant, closed_loop: &ClosedLoop, run: &LongRun) -> Figure {
    let curve = |(index, name): (usize, &String)| {
        let points = run.times.iter().zip(&run.states).map(|(t, y)| (*t, y[index])).collect();
        Curve { label: name.clone(), points, style: Style::Line }
    };
    let curves = plant.names.states().iter().enumerate().map(curve).collect();
    over_time(closed_loop.period, "States of the plant", "x [units of the states]", curves)
}

/// The last period alone: at the start u is as large as the gain, and nothing else would be seen.
fn control(closed_loop: &ClosedLoop, run: &LongRun) -> Figure {
    let samples = (run.times.len() - 1) / run.return_distances.len().max(1);
    let last = run.times.iter().zip(&run.states).skip(run.times.len() - 1 - samples);
    let points = last.map(|(t, y)| (*t, closed_loop.control(y, Disturbance::default()))).collect();
    let curves = vec![Curve {
        label: plain(&regulator_words(&closed_loop.regulator, closed_loop.period)),
        points,
        style: Style::Line,
    }];
    over_time(
        closed_loop.period,
        "Control over the last period",
        &control_axis("u", closed_loop.regulator.nominal),
        curves,
    )
}

/// The axis of the control: what an actuator is given, whose unit is its own, or what is added to e'.
pub(crate) fn control_axis(name: &str, nominal: Option<f64>) -> String {
    let unit = if nominal.is_some() { "unit of the actuator" } else { "unit of e per unit of time" };
    format!("{name} [{unit}]")
}

pub(super) fn over_time(period: f64, title: &str, y: &str, curves: Vec<Curve>) -> Figure {
    Figure {
        title: title.to_owned(),
        x: format!("time t [unit of time of the plant file; period {}]", number_short(period)),
        y: y.to_owned(),
        scale: Scale::Linear,
        floor: 0.0,
        curves,
    }
}

/// A number in as few digits as it has, six at most.
pub(crate) fn number_short(value: f64) -> String {
    let text = format!("{value:.5e}");
    text.parse().map_or(text, |value: f64| format!("{value:?}").trim_end_matches(".0").to_owned())
}

/// |c_k| over k, for a spectrum.
#[must_use]
pub fn spectrum_curve(label: &str, amplitudes: &[f64]) -> Curve {
    let points = amplitudes.iter().enumerate().map(|(k, amplitude)| (k as f64, *amplitude)).collect();
    Curve { label: label.to_owned(), points, style: Style::Marked }
}

/// A figure of Fourier coefficients.
#[must_use]
pub fn spectrum(title: &str, curves: Vec<Curve>) -> Figure {
    let amplitudes = curves.iter().flat_map(|curve| curve.points.iter());
    let largest = amplitudes.fold(0.0, |largest: f64, (_, amplitude)| largest.max(*amplitude));
    Figure {
        title: title.to_owned(),
        x: "harmonic k, of frequency k/T".to_owned(),
        y: "|c_k| of e [unit of e]".to_owned(),
        scale: Scale::LogY,
        floor: SPECTRUM_FLOOR * if largest > 0.0 { largest.min(1.0) } else { 1.0 },
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
        Curve { label: label.to_owned(), points, style: Style::Line }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_start_that_is_short_is_drawn_by_itself() {
        let run = |decay: f64| {
            let points = (0..=1000).map(|k| (0.01 * f64::from(k), libm::exp(-0.01 * decay * f64::from(k)))).collect();
            let curves = vec![Curve { label: String::new(), points, style: Style::Line }];
            transient(&over_time(1.0, "e", "e", curves), 0.0)
        };
        let start = run(5.0).unwrap();
        let last = start.curves[0].points.last().unwrap().0;
        // exp(-5 t) is 0.03 at t = 0.7.
        assert!((0.85..0.95).contains(&last), "{last}");
        assert_eq!(start.title, "e: the start");
        assert!(run(0.5).is_none() && run(0.0).is_none());
    }
}
