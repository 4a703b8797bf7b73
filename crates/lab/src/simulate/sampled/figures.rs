//! What a simulation at samples leaves in files.

use super::run::{SampledLongRun, SampledSimulation};
use super::sampled_loop::{Piece, SampledLoop};
use super::words::loop_words;
use crate::simulate::figures::{control_axis, over_time, spectrum, spectrum_curve, table, transient};
use sigmastar_document::plain;
use sigmastar_document::plot::{Curve, Figure, Style};
use sigmastar_lang::plant::Plant;

/// The run as CSV: t, the states, e, u, and z as z0, z1c, z1s, ... At a sample u is what acts from then on (with a delay a row
/// for that time follows); z is that of the last sample.
#[must_use]
pub fn sampled_csv(plant: &Plant, sampled: &SampledLoop, run: &SampledLongRun) -> String {
    let row = |z: &[f64], piece: &Piece, at: usize| {
        [&[piece.t + piece.unit * at as f64], &piece.states[at][..], &[piece.u], z].concat()
    };
    let pieces =
        || run.intervals.iter().flat_map(|interval| interval.pieces.iter().map(|piece| (&interval.z[..], piece)));
    // What is at the end of a piece is the start of the next.
    let starts = pieces().flat_map(|(z, piece)| (0..piece.states.len() - 1).map(move |at| row(z, piece, at)));
    let end = pieces().last().map(|(z, piece)| row(z, piece, piece.states.len() - 1));
    table(plant, sampled.regulator.dimension(), starts.chain(end))
}

/// The figures of a simulation, each with the name of its file: the error, the states of the plant, the control over the last
/// period, and the spectra of the steady error in time and at the samples.
#[must_use]
pub fn sampled_figures(
    plant: &Plant,
    sampled: &SampledLoop,
    simulation: &SampledSimulation,
) -> Vec<(&'static str, Figure)> {
    let mut figures = Vec::new();
    if let Ok(run) = &simulation.long {
        let pieces = || run.intervals.iter().flat_map(|interval| &interval.pieces);
        let curve = |component: usize, label: String| {
            let points = pieces().flat_map(|piece| {
                let value = move |(at, state): (usize, &Vec<f64>)| {
                    (piece.t + piece.unit * at as f64, state.get(component).copied().unwrap_or_default())
                };
                piece.states.iter().enumerate().map(value)
            });
            Curve { label, points: points.collect(), style: Style::Line }
        };
        let period = sampled.period();
        let error = vec![curve(sampled.states(), plain(&loop_words(sampled)))];
        let response = over_time(period, "Regulated error", "e [unit of e]", error);
        let start = transient(&response, run.last_period.sup);
        figures.push(("response.svg", response));
        figures.extend(start.map(|start| ("transient.svg", start)));
        if sampled.states() > 0 {
            let names = plant.names.states().iter().enumerate();
            let curves = names.map(|(index, name)| curve(index, name.clone())).collect();
            figures.push(("states.svg", over_time(period, "States of the plant", "x [units of the states]", curves)));
        }
        let last = run.intervals.len().saturating_sub(sampled.samples_rounded_up());
        let held = run.intervals.iter().skip(last).flat_map(|interval| &interval.pieces).flat_map(|piece| {
            let length = piece.unit * (piece.states.len() - 1) as f64;
            [(piece.t, piece.u), (piece.t + length, piece.u)]
        });
        let curves = vec![Curve { label: plain(&loop_words(sampled)), points: held.collect(), style: Style::Line }];
        let axis = control_axis("u", sampled.regulator.nominal);
        figures.push(("control.svg", over_time(period, "Control over the last period", &axis, curves)));
    }
    if let Ok((_, sums)) = &simulation.steady {
        let curves = vec![
            spectrum_curve("e", &sums.amplitudes),
            spectrum_curve("e at the samples", &sums.amplitudes_at_samples),
        ];
        figures.push(("spectrum.svg", spectrum("Fourier coefficients of the steady error", curves)));
    }
    figures
}
