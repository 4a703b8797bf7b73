//! A few numbers side by side, as bars that start at 0.

use super::canvas::{Area, AreaError, DETAIL, at_size, canvas, title};
use super::figure::PlotError;
use super::palette::COLOURS;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// The width of the figure in pixels.
const WIDTH: u32 = 820;
/// The height of a row.
const ROW: u32 = 28;
/// What is above the rows and below them.
const EDGES: [u32; 2] = [48, 14];
/// The room for a number behind its bar.
const NUMBER: i32 = 100;
/// The longest name, in characters.
const LONGEST: usize = 46;

/// Named numbers, drawn as horizontal bars with the number behind each.
#[derive(Clone, Debug)]
pub struct Bars {
    /// The title.
    pub title: String,
    /// Names, lengths, and the lengths as they are written; what is not finite or not positive has no bar.
    pub entries: Vec<(String, f64, String)>,
}

impl Bars {
    /// The figure as SVG. The same bars give the same bytes.
    ///
    /// # Errors
    /// [`PlotError`].
    pub fn svg(&self) -> Result<String, PlotError> {
        let entries: Vec<(String, f64, &str)> = self
            .entries
            .iter()
            .filter(|(_, length, _)| length.is_finite() && *length > 0.0)
            .map(|(name, length, text)| (short(name), *length, text.as_str()))
            .collect();
        if entries.is_empty() {
            return Err(PlotError::Empty { title: self.title.clone() });
        }
        let size = (WIDTH, EDGES[0] + EDGES[1] + ROW * entries.len() as u32);
        let mut text = String::new();
        self.draw(&mut text, size, &entries)
            .map_err(|reason| PlotError::Drawing { title: self.title.clone(), reason: reason.to_string() })?;
        Ok(at_size(text, size))
    }

    fn draw(&self, text: &mut String, size: (u32, u32), entries: &[(String, f64, &str)]) -> Result<(), AreaError> {
        let area: Area<'_> = canvas(text, size)?;
        title(&area, &self.title)?;
        let unit = DETAIL as i32;
        let style = ("sans-serif", 13 * DETAIL).into_font().color(&BLACK);
        let mut widest = 0;
        for (name, ..) in entries {
            widest = widest.max(area.estimate_text_size(name, &style)?.0 as i32);
        }
        let left = widest + 24 * unit;
        let room = f64::from(size.0 as i32 * unit - left - NUMBER * unit).max(0.0);
        let longest = entries.iter().map(|entry| entry.1).fold(0.0, f64::max);
        for (row, (name, length, number)) in (0..).zip(entries) {
            let top = (EDGES[0] as i32 + ROW as i32 * row) * unit;
            let text = |text: &str, x: i32, side: HPos| {
                let style = style.pos(Pos::new(side, VPos::Center));
                Text::new(text.to_owned(), (x, top + (ROW as i32 / 2) * unit), style)
            };
            area.draw(&text(name, left - 10 * unit, HPos::Right))?;
            let right = left + (room * length / longest) as i32;
            let corners = [(left, top + 4 * unit), (right, top + (ROW as i32 - 5) * unit)];
            area.draw(&Rectangle::new(corners, COLOURS[0].filled()))?;
            area.draw(&text(number, right + 8 * unit, HPos::Left))?;
        }
        // Where the bars start.
        let [top, bottom] = [EDGES[0] as i32 * unit, (size.1 - EDGES[1]) as i32 * unit];
        area.draw(&PathElement::new(vec![(left, top), (left, bottom)], BLACK.stroke_width(DETAIL)))?;
        area.present()
    }
}

/// A name that leaves room for its bar.
fn short(name: &str) -> String {
    if name.chars().count() <= LONGEST {
        return name.to_owned();
    }
    name.chars().take(LONGEST - 3).chain("...".chars()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bars(lengths: &[f64]) -> Bars {
        let entry = |(index, length): (usize, &f64)| (format!("<name {index}>"), *length, format!("{length} %"));
        Bars { title: "Title".to_owned(), entries: lengths.iter().enumerate().map(entry).collect() }
    }

    #[test]
    fn bars_are_as_long_as_their_numbers() {
        let svg = bars(&[1.0, 0.5, f64::NAN, 0.0, 0.25]).svg().unwrap();
        assert_eq!(svg, bars(&[1.0, 0.5, f64::NAN, 0.0, 0.25]).svg().unwrap());
        let widths: Vec<f64> = svg
            .split("<rect ")
            .skip(2)
            .filter_map(|rest| rest.split_once(" width=\"")?.1.split_once('"')?.0.parse().ok())
            .collect();
        assert_eq!(widths.len(), 3, "{svg}");
        assert!(
            (widths[1] / widths[0] - 0.5).abs() < 0.01 && (widths[2] / widths[0] - 0.25).abs() < 0.01,
            "{widths:?}"
        );
        assert!(svg.contains("&lt;name 4&gt;") && svg.contains("0.25 %") && !svg.contains("<name"), "{svg}");
        assert!(svg.starts_with("<svg width=\"820\" height=\"146\""), "{svg}");
    }

    #[test]
    fn nothing_to_draw_is_an_error() {
        assert_eq!(bars(&[0.0, -1.0]).svg(), Err(PlotError::Empty { title: "Title".to_owned() }));
        assert_eq!(short(&"n".repeat(60)).len(), LONGEST);
    }
}
