//! Figures as SVG: the canvas, its axes, bars, and how curves are told apart.

mod bars;
mod canvas;
mod curve;
mod figure;
mod legend;
mod palette;

pub use bars::Bars;
pub use curve::{Curve, Style};
pub use figure::{Figure, PlotError, Scale};
pub use palette::COLOURS;
