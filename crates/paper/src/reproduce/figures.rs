//! The five figures.

use super::run::{figures_of, internal_model};
use rayon::prelude::*;
use sigmastar_document::plot::{Curve, Figure};
use sigmastar_lab::simulate::{bode, spectrum, spectrum_curve};
use sigmastar_lang::plant::Plant;
use sigmastar_regulator::Regulator;
use std::f64::consts::TAU;

/// The names of the files of the figures.
pub const FIGURE_FILES: [&str; 5] = [
    "figure-1-bode.svg",
    "figure-2-high-gain.svg",
    "figure-3-nominal.svg",
    "figure-4-1-percent.svg",
    "figure-5-5-percent.svg",
];

/// sigma of the paper's figures.
const SIGMA: f64 = 2.0;
/// n_0 as the text says.
const N_0: f64 = 2.0;

/// The figures of the paper with the names of their files: the Bode magnitude of the linear example, and the Fourier
/// coefficients of the steady error with the high-gain feedback and with the internal model at the base frequencies
/// 1, 0.99 and 0.95 times 2 pi/T. n_0 = 2, as the text says. `plant` is that of the paper's numerical example.
#[must_use]
pub fn figures(plant: &Plant) -> Vec<(&'static str, Figure)> {
    let curve = |label: String, regulator: Regulator| -> Option<Curve> {
        figures_of(plant, regulator).ok().map(|(figures, _)| spectrum_curve(&label, &figures.amplitudes))
    };
    let with_oscillators = |ratio: f64, numbers: &[u32]| -> Vec<Curve> {
        numbers
            .par_iter()
            .filter_map(|&n_o| curve(format!("n_o = {n_o}"), internal_model(SIGMA, N_0, n_o, ratio * TAU)))
            .collect()
    };
    let high_gain: Vec<Curve> = curve("high gain".to_owned(), Regulator::high_gain(SIGMA)).into_iter().collect();
    let title = |what: &str| format!("Fourier coefficients of e_p, sigma = 2, {what}");
    vec![
        (FIGURE_FILES[0], bode(&internal_model(SIGMA, N_0, 10, TAU))),
        (FIGURE_FILES[1], spectrum(&title("high-gain feedback"), high_gain)),
        (FIGURE_FILES[2], spectrum(&title("base frequency 2 pi/T"), with_oscillators(1.0, &[0, 1, 2, 3, 4]))),
        (FIGURE_FILES[3], spectrum(&title("base frequency 0.99 * 2 pi/T"), with_oscillators(0.99, &[0, 1, 2, 3]))),
        (FIGURE_FILES[4], spectrum(&title("base frequency 0.95 * 2 pi/T"), with_oscillators(0.95, &[0, 1, 2, 3]))),
    ]
}
