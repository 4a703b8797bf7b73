//! Figures as SVG: the canvas, its axes, and how curves are told apart.

mod canvas;
mod curve;
mod figure;
mod legend;
mod palette;

pub use canvas::Size;
pub use curve::{Curve, Style};
pub use figure::{Figure, PlotError, Scale};
pub use palette::{COLOURS, dark_style};
