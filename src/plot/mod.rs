//! Figures as SVG: the canvas, its axes and colours.

mod figure;
mod palette;

pub use figure::{Curve, Figure, PlotError, Scale, Style};
pub(crate) use palette::COLOURS;
