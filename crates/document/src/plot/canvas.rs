//! The white ground of a figure, and its title.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// The library puts points on whole pixels, which makes steps of smooth curves: figures are drawn this much larger and
/// shown at their size.
pub(super) const DETAIL: u32 = 4;

pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
pub(super) type AreaError = DrawingAreaErrorKind<std::io::Error>;

/// An empty figure of a size in pixels, drawn [`DETAIL`] times larger.
pub(super) fn canvas(text: &mut String, (width, height): (u32, u32)) -> Result<Area<'_>, AreaError> {
    let area = SVGBackend::with_string(text, (width * DETAIL, height * DETAIL)).into_drawing_area();
    area.fill(&WHITE)?;
    Ok(area)
}

/// The figure of [`canvas`] shown at its size.
pub(super) fn at_size(text: String, (width, height): (u32, u32)) -> String {
    let drawn = format!("width=\"{}\" height=\"{}\"", width * DETAIL, height * DETAIL);
    text.replacen(&drawn, &format!("width=\"{width}\" height=\"{height}\""), 1)
}

/// Draws the title in the middle.
pub(super) fn title(area: &Area<'_>, title: &str) -> Result<(), AreaError> {
    let style = ("sans-serif", 18 * DETAIL).into_font().color(&BLACK).pos(Pos::new(HPos::Center, VPos::Top));
    let middle = area.dim_in_pixel().0 as i32 / 2;
    area.draw(&Text::new(title.to_owned(), (middle, 14 * DETAIL as i32), style))
}
