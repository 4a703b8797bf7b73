//! The curves as they are drawn, and the legend that shows the same lines and marks.

use super::canvas::{Area, AreaError, DETAIL, title};
use super::curve::{Curve, Style};
use super::palette::{Dash, Mark};
use plotters::coord::CoordTranslate;
use plotters::element::DashedPathElement;
use plotters::prelude::*;

/// How a curve is drawn, and its place in the legend.
pub(super) struct Entry {
    label: String,
    colour: RGBColor,
    width: u32,
    line: Option<Dash>,
    mark: Option<Mark>,
}

impl Entry {
    /// The entry of a curve, which takes the next look where it has none of its own.
    pub(super) fn new(curve: &Curve, looks: &mut impl Iterator<Item = (RGBColor, Dash, Mark)>) -> Entry {
        let label = curve.label.clone();
        let bound = Entry { label, colour: BLACK, width: 3, line: Some(None), mark: None };
        if curve.style == Style::Bound {
            return bound;
        }
        let Some((colour, dash, mark)) = looks.next() else { return bound };
        let (line, mark) = match curve.style {
            Style::Points => (None, Some(mark)),
            // Marks tell such curves apart; dashes between them would be cut.
            Style::Marked => (Some(None), Some(mark)),
            Style::Line | Style::Bound => (Some(dash), None),
        };
        Entry { colour, width: 2, line, mark, ..bound }
    }

    /// Draws the line and the marks through some points.
    pub(super) fn draw<C: CoordTranslate>(
        &self,
        area: &DrawingArea<SVGBackend<'_>, C>,
        points: &[C::From],
    ) -> Result<(), AreaError>
    where
        C::From: Clone,
    {
        let colour = self.colour;
        let stroke = colour.stroke_width(self.width * DETAIL);
        match self.line {
            Some(None) => area.draw(&PathElement::new(points.to_vec(), stroke))?,
            Some(Some((dash, gap))) => {
                let points = points.iter().cloned();
                area.draw(&DashedPathElement::new(points, dash * DETAIL, gap * DETAIL, stroke))?;
            }
            None => {}
        }
        for point in points.iter().filter(|_| self.mark.is_some()) {
            let point = point.clone();
            match self.mark {
                Some(Mark::Disc) => area.draw(&Circle::new(point, 4 * DETAIL, colour.filled()))?,
                Some(Mark::Triangle) => area.draw(&TriangleMarker::new(point, 6 * DETAIL, colour.filled()))?,
                Some(Mark::Ring) => area.draw(&Circle::new(point, 5 * DETAIL, stroke))?,
                Some(Mark::Cross) => area.draw(&Cross::new(point, 4 * DETAIL, stroke))?,
                None => {}
            }
        }
        Ok(())
    }
}

/// Draws the title and, below it, which curve is which; returns the area that is left, so that no legend lies on a curve.
pub(super) fn heading<'a>(area: &Area<'a>, words: &str, entries: &[Entry]) -> Result<Area<'a>, AreaError> {
    title(area, words)?;
    let unit = DETAIL as i32;
    let (width, _) = area.dim_in_pixel();
    let style = ("sans-serif", 13 * DETAIL).into_font().color(&BLACK);
    // Rows of entries: a line, a gap, the text, a gap.
    let left = 82 * unit + 12 * unit;
    let (mut x, mut y) = (left, 44 * unit);
    for entry in entries {
        let (label_width, _) = area.estimate_text_size(&entry.label, &style)?;
        let needed = 58 * unit + label_width as i32 + 22 * unit;
        if x > left && x + needed > width as i32 {
            (x, y) = (left, y + 20 * unit);
        }
        // The line with one mark.
        let level = y + 7 * unit;
        Entry { mark: None, label: String::new(), ..*entry }.draw(area, &[(x, level), (x + 52 * unit, level)])?;
        Entry { line: None, label: String::new(), ..*entry }.draw(area, &[(x + 26 * unit, level)])?;
        area.draw(&Text::new(entry.label.clone(), (x + 58 * unit, y), style.clone()))?;
        x += needed;
    }
    Ok(area.split_vertically(y + 22 * unit).1)
}
