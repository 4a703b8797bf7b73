//! The picture: T_N(x) for several N under the envelope that holds for all of them.

use crate::data::Data;
use crate::number::Direction;
use crate::plot::{COLOURS, DETAIL, at_size, canvas, heading};
use crate::report::number::exact;
use crate::transfer::{CertifiedPair, OscillatorCount, transfer_graph};
use plotters::prelude::*;

/// Width and height in pixels.
const SIZE: (u32, u32) = (960, 640);
/// The most curves that stay legible: one of each colour.
const MOST: usize = COLOURS.len();
/// The x that are shown.
const RANGE: (f64, f64) = (0.05, 30.0);
/// Points of the envelope.
const ENVELOPE: u32 = 200;

/// At most [`MOST`] of the numbers asked for, evenly chosen, the last one among them.
fn chosen(counts: &[OscillatorCount]) -> Vec<OscillatorCount> {
    if counts.len() <= MOST {
        return counts.to_vec();
    }
    (0..MOST).map(|k| counts[k * (counts.len() - 1) / (MOST - 1)]).collect()
}

/// The picture as SVG. It is drawn from doubles and proves nothing.
///
/// # Errors
/// The plotting library's reason.
pub(super) fn svg(data: &Data<'_>, pair: &CertifiedPair, counts: &[OscillatorCount]) -> Result<String, String> {
    let mut svg = String::new();
    draw(&mut svg, data, pair, &chosen(counts)).map_err(|error| error.to_string())?;
    Ok(at_size(svg, SIZE))
}

fn draw(
    svg: &mut String,
    data: &Data<'_>,
    pair: &CertifiedPair,
    counts: &[OscillatorCount],
) -> Result<(), Box<dyn std::error::Error>> {
    let (k0, k1) = (pair.k0.to_f64(), pair.k1.to_f64());
    let (from, to) = RANGE;
    let envelope = |x: f64| k0 + k1 * x * x;
    let graphs: Vec<Vec<(f64, f64)>> = counts.iter().map(|n_o| transfer_graph(data, *n_o, from, to)).collect();
    let values = || graphs.iter().flatten().map(|(_, value)| *value).filter(|value| *value > 0.0);
    // Deep valleys would flatten everything else.
    let lowest = values().fold(k0, f64::min).max(k0 * 1e-5);
    let area = canvas(svg, SIZE)?;
    let [k0_text, k1_text] = [&pair.k0, &pair.k1].map(|k| exact(k, Direction::Up));
    let title = format!("T_N(x) under k0 + k1 x^2 with k0 = {k0_text}, k1 = {k1_text}");
    let bound = ("k0 + k1 x^2, every N".to_owned(), BLACK);
    let curves = counts.iter().zip(COLOURS).map(|(n_o, colour)| (format!("N = {n_o}"), colour));
    let entries: Vec<(String, RGBColor)> = [bound].into_iter().chain(curves).collect();
    let area = heading(&area, &title, &entries)?;
    let mut chart = ChartBuilder::on(&area)
        .margin(12 * DETAIL)
        .margin_top(4 * DETAIL)
        .margin_right(24 * DETAIL)
        .x_label_area_size(48 * DETAIL)
        .y_label_area_size(72 * DETAIL)
        .build_cartesian_2d((from..to).log_scale(), (lowest..2.0 * envelope(to)).log_scale())?;
    chart
        .configure_mesh()
        .x_desc("x = omega / base frequency [pure number]")
        .y_desc("T_N(x) [pure number]")
        .x_label_formatter(&|x| short(*x))
        .y_label_formatter(&|y| short(*y))
        .label_style(("sans-serif", 14 * DETAIL))
        .axis_desc_style(("sans-serif", 16 * DETAIL))
        .axis_style(BLACK.stroke_width(DETAIL))
        .set_all_tick_mark_size(5 * DETAIL)
        .light_line_style(RGBColor(238, 238, 238).stroke_width(DETAIL))
        .bold_line_style(RGBColor(205, 205, 205).stroke_width(DETAIL))
        .draw()?;
    // Few oscillators last: their curves leave the common one early and stay visible on top of it.
    for (graph, colour) in graphs.into_iter().zip(COLOURS).rev() {
        let shown = graph.into_iter().filter(|(_, value)| *value >= lowest);
        chart.draw_series(LineSeries::new(shown, colour.stroke_width(DETAIL + 1)))?;
    }
    let line = (0..=ENVELOPE).map(|k| {
        let x = from * (to / from).powf(f64::from(k) / f64::from(ENVELOPE));
        (x, envelope(x))
    });
    chart.draw_series(LineSeries::new(line, BLACK.stroke_width(2 * DETAIL)))?;
    area.present()?;
    Ok(())
}

/// A tick: plain where that is short.
fn short(value: f64) -> String {
    // The ticks are products of powers of ten, not exact ones.
    let value: f64 = format!("{value:.9e}").parse().unwrap_or(value);
    if (1e-3..1e5).contains(&value) { format!("{value}") } else { format!("{value:e}") }
}

#[cfg(test)]
mod tests {
    #[test]
    fn ticks_are_short() {
        let ticks =
            [9.999999999999999e197, 0.010000000000000002, 1000.0, 1e-300, 99_999.999_999_999_99].map(super::short);
        assert_eq!(ticks, ["1e198", "0.01", "1000", "1e-300", "1e5"]);
    }
}
