//! Figures as SVG: the canvas, its axes and colours.

mod figure;
mod palette;

pub use figure::{Curve, Figure, PlotError, Scale};
pub(crate) use figure::{DETAIL, at_size, canvas, heading};
pub(crate) use palette::COLOURS;
