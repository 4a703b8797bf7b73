//! The curves as they are drawn, and the legend that shows the same lines and marks.

use super::canvas::{Area, AreaError, DETAIL, Size, lines, title};
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
    band: bool,
    line: Option<Dash>,
    mark: Option<Mark>,
}

impl Entry {
    /// The entry of a curve, which takes the next look where it has none of its own.
    pub(super) fn new<L>(curve: &Curve, looks: &mut std::iter::Peekable<L>) -> Entry
    where
        L: Iterator<Item = (RGBColor, Dash, Mark)>,
    {
        let label = curve.label.clone();
        let bound = Entry { label, colour: BLACK, width: 3, band: false, line: Some(None), mark: None };
        if let (Style::Band | Style::Limit, Some((colour, ..))) = (curve.style, looks.peek()) {
            return Entry { colour: *colour, width: 1, band: curve.style == Style::Band, ..bound };
        }
        if curve.style == Style::Bound {
            return bound;
        }
        let Some((colour, dash, mark)) = looks.next() else { return bound };
        let (line, mark) = match curve.style {
            Style::Points => (None, Some(mark)),
            // Marks tell such curves apart; dashes between them would be cut.
            Style::Marked => (Some(None), Some(mark)),
            Style::Line | Style::Bound | Style::Band | Style::Limit => (Some(dash), None),
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
        if self.band {
            area.draw(&Polygon::new(points.to_vec(), colour.mix(0.2).filled()))?;
        }
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

/// Draws the title and, below it, which curve is which; returns the area that is left, so that no legend lies on a curve. No label
/// is cut: one that is wider than the figure is in lines.
pub(super) fn heading<'a>(area: &Area<'a>, words: &str, entries: &[Entry], size: Size) -> Result<Area<'a>, AreaError> {
    let unit = DETAIL as i32;
    let below = title(area, words, size)? + size.choose(8, 4) * unit;
    let width = area.dim_in_pixel().0 as i32;
    let style = ("sans-serif", 13 * DETAIL).into_font().color(&BLACK);
    // Rows of entries: a line, a gap, the text, a gap.
    let left = size.choose(82 + 12, 12) * unit;
    let sample = size.choose(52, 34) * unit;
    let (mut x, mut y) = (left, below);
    let mut last = 1;
    for entry in entries.iter().filter(|entry| !entry.label.is_empty()) {
        let text = lines(area, &entry.label, &style, width - left - sample - 12 * unit)?;
        let mut label_width = 0;
        for line in &text {
            label_width = label_width.max(area.estimate_text_size(line, &style)?.0 as i32);
        }
        let needed = sample + 6 * unit + label_width;
        if x > left && x + needed > width {
            (x, y) = (left, y + (4 + 16 * last) * unit);
            last = 1;
        }
        // The line with one mark, or an area.
        let level = y + 7 * unit;
        let plain = |line: Option<Dash>, mark, band| Entry { label: String::new(), line, mark, band, ..*entry };
        if entry.band {
            let corners = [(x, y), (x + sample, y), (x + sample, y + 13 * unit), (x, y + 13 * unit), (x, y)];
            plain(entry.line, None, true).draw(area, &corners)?;
        } else {
            plain(entry.line, None, false).draw(area, &[(x, level), (x + sample, level)])?;
        }
        plain(None, entry.mark, false).draw(area, &[(x + sample / 2, level)])?;
        for (row, line) in (0..).zip(&text) {
            let place = (x + sample + 6 * unit, y + row * 16 * unit);
            area.draw(&Text::new(line.clone(), place, style.clone()))?;
        }
        last = last.max(text.len() as i32);
        x += needed + 22 * unit;
    }
    Ok(area.split_vertically(y + (6 + 16 * last) * unit).1)
}
