//! Figures as SVG: the canvas, its axes, bars, and how curves are told apart.

mod bars;
mod canvas;
mod figure;
mod legend;
mod palette;

pub use bars::Bars;
pub use figure::{Curve, Figure, PlotError, Scale, Style};
pub(crate) use palette::COLOURS;
