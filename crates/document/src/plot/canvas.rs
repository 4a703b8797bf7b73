//! The ground of a figure, its sizes, and its title.

use super::palette::dark_style;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// The library puts points on whole pixels, which makes steps of smooth curves: figures are drawn this much larger and
/// shown at their size.
pub(super) const DETAIL: u32 = 4;

pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
pub(super) type AreaError = DrawingAreaErrorKind<std::io::Error>;

/// For what width a figure is drawn: its letters are as large in both.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// For a page on a desk.
    Wide,
    /// For a telephone.
    Narrow,
}

impl Size {
    /// Width and height in pixels.
    pub(super) fn pixels(self) -> (u32, u32) {
        match self {
            Size::Wide => (820, 500),
            Size::Narrow => (400, 440),
        }
    }

    /// One of two values, the first for wide figures.
    pub(super) fn choose<T>(self, wide: T, narrow: T) -> T {
        match self {
            Size::Wide => wide,
            Size::Narrow => narrow,
        }
    }
}

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

/// The figure by itself, as a file: it knows what its colours are where the reader prefers dark pages.
pub(super) fn alone(svg: &str) -> String {
    let style = format!("<style>\n@media (prefers-color-scheme: dark) {{\n{}}}\n</style>\n", dark_style(""));
    match svg.split_once('\n') {
        Some((start, rest)) => format!("{start}\n{style}{rest}"),
        None => svg.to_owned(),
    }
}

/// Draws the title in the middle, in as many lines as it needs, and returns how far down they reach.
pub(super) fn title(area: &Area<'_>, title: &str, size: Size) -> Result<i32, AreaError> {
    let unit = DETAIL as i32;
    let letters = size.choose(18, 15);
    let style = ("sans-serif", letters * DETAIL).into_font().color(&BLACK).pos(Pos::new(HPos::Center, VPos::Top));
    let width = area.dim_in_pixel().0 as i32;
    let mut y = size.choose(14, 8) * unit;
    for line in lines(area, title, &style, width - 16 * unit)? {
        area.draw(&Text::new(line, (width / 2, y), style.clone()))?;
        y += (letters as i32 + 4) * unit;
    }
    Ok(y)
}

/// A text in lines that are no wider than that, where words allow it.
pub(super) fn lines(area: &Area<'_>, text: &str, style: &TextStyle<'_>, width: i32) -> Result<Vec<String>, AreaError> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        let longer = lines.last().map(|line| format!("{line} {word}"));
        match longer {
            Some(longer) if area.estimate_text_size(&longer, style)?.0 as i32 <= width => {
                lines.pop();
                lines.push(longer);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    Ok(lines)
}
