//! The figure: T_N(x) for several N under the envelope that holds for all of them.

use sigmastar_document::number::exact;
use sigmastar_document::plot::{COLOURS, Curve, Figure, Scale, Style};
use sigmastar_exact::number::{Direction, Portable};
use sigmastar_theory::transfer::{OscillatorCount, TransferStudy, transfer_graph};

/// The most curves that stay legible: one of each colour.
const MOST: usize = COLOURS.len();
/// The x that are shown.
const RANGE: (f64, f64) = (0.1, 80.0);
/// Points of the envelope.
const ENVELOPE: u32 = 200;

/// At most [`MOST`] of the numbers asked for, evenly chosen, the last one among them.
fn chosen(counts: &[OscillatorCount]) -> Vec<OscillatorCount> {
    if counts.len() <= MOST {
        return counts.to_vec();
    }
    (0..MOST).map(|k| counts[k * (counts.len() - 1) / (MOST - 1)]).collect()
}

/// T_N under the envelope, for the n_o of the study. It is drawn from doubles and proves nothing.
#[must_use]
pub fn transfer_figure(study: &TransferStudy<'_>) -> Figure {
    let counts: Vec<OscillatorCount> = study.uniformity.iter().map(|entry| entry.sup.n_o).collect();
    let (from, to) = RANGE;
    let graph = |n_o: &OscillatorCount| Curve {
        label: format!("N = {n_o}"),
        points: transfer_graph(&study.data, *n_o, from, to),
        style: Style::Line,
    };
    let [k0, k1] = [&study.pair.k0, &study.pair.k1].map(rug::Rational::to_f64);
    let envelope = (0..=ENVELOPE).map(|k| {
        let x = from * (to / from).portable_pow(f64::from(k) / f64::from(ENVELOPE));
        (x, k0 + k1 * x * x)
    });
    let bound = Curve { label: "k0 + k1 x^2, every N".to_owned(), points: envelope.collect(), style: Style::Bound };
    // Few oscillators last: their curves leave the common one early and stay visible on top of it.
    let curves: Vec<Curve> = std::iter::once(bound).chain(chosen(&counts).iter().rev().map(graph)).collect();
    let values = curves.iter().flat_map(|curve| &curve.points).map(|(_, value)| *value);
    // Deep valleys would flatten everything else.
    let floor = values.filter(|value| *value > 0.0).fold(k0, f64::min).max(k0 * 1e-5);
    let [k0, k1] = [&study.pair.k0, &study.pair.k1].map(|k| exact(k, Direction::Up));
    Figure {
        title: format!("T_N(x) under k0 + k1 x^2 with k0 = {k0}, k1 = {k1}"),
        x: "x = omega / base frequency [pure number]".to_owned(),
        y: "T_N(x) [pure number]".to_owned(),
        scale: Scale::LogLog,
        floor,
        curves,
    }
}
