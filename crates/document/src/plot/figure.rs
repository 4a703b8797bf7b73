//! Figures as SVG.

use super::canvas::{DETAIL, Size, alone, at_size, canvas};
use super::curve::Curve;
use super::legend::{Entry, heading};
use super::palette::{GRID, look};
use plotters::coord::ranged1d::{AsRangedCoord, Ranged, ValueFormatter};
use plotters::prelude::*;
use std::ops::Range;
use thiserror::Error;

/// Which axes are logarithmic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// None.
    Linear,
    /// The horizontal one.
    LogX,
    /// The vertical one.
    LogY,
    /// Both.
    LogLog,
}

impl Scale {
    fn is_log_x(self) -> bool {
        matches!(self, Scale::LogX | Scale::LogLog)
    }

    fn is_log_y(self) -> bool {
        matches!(self, Scale::LogY | Scale::LogLog)
    }
}

/// A figure.
#[derive(Clone, Debug)]
pub struct Figure {
    /// The title.
    pub title: String,
    /// What is on the horizontal axis.
    pub x: String,
    /// What is on the vertical axis.
    pub y: String,
    /// The scale.
    pub scale: Scale,
    /// The smallest value on a logarithmic vertical axis; what is below is drawn on it.
    pub floor: f64,
    /// The curves.
    pub curves: Vec<Curve>,
}

/// Why there is no figure.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum PlotError {
    /// No point can be drawn.
    #[error("the figure `{title}` has no finite points")]
    Empty {
        /// Its title.
        title: String,
    },
    /// The drawing library failed.
    #[error("the figure `{title}` cannot be drawn: {reason}")]
    Drawing {
        /// Its title.
        title: String,
        /// Why.
        reason: String,
    },
}

impl Figure {
    /// The figure as a file of SVG, for light and for dark pages. The same figure gives the same bytes.
    ///
    /// # Errors
    /// [`PlotError`].
    pub fn svg(&self) -> Result<String, PlotError> {
        self.drawn(Size::Wide).map(|svg| alone(&svg))
    }

    /// The figure as SVG for a page that has [`dark_style`](super::dark_style).
    ///
    /// # Errors
    /// [`PlotError`].
    pub fn drawn(&self, size: Size) -> Result<String, PlotError> {
        let curves: Vec<Curve> = self.curves.iter().map(|curve| self.drawable(curve)).collect();
        let all = || curves.iter().flat_map(|curve| curve.points.iter());
        if all().next().is_none() {
            return Err(PlotError::Empty { title: self.title.clone() });
        }
        let counts = counts(&curves);
        let x = match self.scale {
            Scale::LogX | Scale::LogLog => decades(all().map(|point| point.0)),
            // Marks keep off the frame.
            _ if counts => {
                let (first, last) = ends(all().map(|point| point.0));
                first - 0.5..last + 0.5
            }
            _ if curves.iter().any(Curve::has_marks) => range(all().map(|point| point.0), 0.03),
            _ => range(all().map(|point| point.0), 0.0),
        };
        let y = match self.scale {
            Scale::Linear | Scale::LogX => range(all().map(|point| point.1), 0.06),
            Scale::LogY | Scale::LogLog => decades(all().map(|point| point.1)),
        };
        // A tick near 0 of a linear axis is 0; a logarithmic axis has none.
        let span = |range: &Range<f64>, linear: bool| if linear { range.end - range.start } else { 0.0 };
        let spans = [span(&x, !self.scale.is_log_x()), span(&y, !self.scale.is_log_y())];
        let mut text = String::new();
        let drawn = match self.scale {
            Scale::Linear => self.draw(&mut text, size, x, y, spans, &curves),
            Scale::LogX => self.draw(&mut text, size, x.log_scale(), y, spans, &curves),
            Scale::LogY => self.draw(&mut text, size, x, y.log_scale(), spans, &curves),
            Scale::LogLog => self.draw(&mut text, size, x.log_scale(), y.log_scale(), spans, &curves),
        };
        drawn.map_err(|reason| PlotError::Drawing { title: self.title.clone(), reason })?;
        Ok(at_size(text, size.pixels()))
    }

    fn drawable(&self, curve: &Curve) -> Curve {
        let points = curve
            .points
            .iter()
            .filter(|(x, y)| x.is_finite() && y.is_finite() && (!self.scale.is_log_x() || *x > 0.0))
            .map(|&(x, y)| (x, if self.scale.is_log_y() { y.max(self.floor) } else { y }))
            .collect();
        Curve { points, ..curve.clone() }
    }

    fn draw<X, Y>(
        &self,
        text: &mut String,
        size: Size,
        x: X,
        y: Y,
        [x_span, y_span]: [f64; 2],
        curves: &[Curve],
    ) -> Result<(), String>
    where
        X: AsRangedCoord<Value = f64>,
        Y: AsRangedCoord<Value = f64>,
        X::CoordDescType: Ranged<ValueType = f64> + ValueFormatter<f64>,
        Y::CoordDescType: Ranged<ValueType = f64> + ValueFormatter<f64>,
    {
        let words = |error: &dyn std::fmt::Display| error.to_string();
        let area = canvas(text, size.pixels()).map_err(|error| words(&error))?;
        let mut looks = (0..).map(look).peekable();
        let entries: Vec<Entry> = curves.iter().map(|curve| Entry::new(curve, &mut looks)).collect();
        let counts = counts(curves);
        let area = heading(&area, &self.title, &entries, size).map_err(|error| words(&error))?;
        let mut chart = ChartBuilder::on(&area)
            .margin(size.choose(12, 4) * DETAIL)
            .margin_top(4 * DETAIL)
            .margin_right(size.choose(24, 16) * DETAIL)
            .x_label_area_size(size.choose(46, 42) * DETAIL)
            .y_label_area_size(size.choose(82, 68) * DETAIL)
            .build_cartesian_2d(x, y)
            .map_err(|error| words(&error))?;
        chart
            .configure_mesh()
            .x_desc(&self.x)
            .y_desc(&self.y)
            .x_labels(size.choose(11, 5))
            .max_light_lines(if x_span > 0.0 && y_span > 0.0 { size.choose(4, 1) } else { 10 })
            // Between counts there is nothing to name.
            .x_label_formatter(&|value| match counts && x_span > 0.0 && (value - value.round()).abs() > 1e-9 {
                true => String::new(),
                false => tick(*value, x_span),
            })
            .y_label_formatter(&|value| tick(*value, y_span))
            .label_style(("sans-serif", 13 * DETAIL))
            .axis_desc_style(("sans-serif", size.choose(15, 13) * DETAIL))
            .axis_style(BLACK.stroke_width(DETAIL))
            .set_all_tick_mark_size(5 * DETAIL)
            .light_line_style(GRID[1][0].stroke_width(DETAIL))
            .bold_line_style(GRID[0][0].stroke_width(DETAIL))
            .draw()
            .map_err(|error| words(&error))?;
        for (curve, entry) in curves.iter().zip(&entries) {
            entry.draw(chart.plotting_area(), &curve.points).map_err(|error| words(&error))?;
        }
        area.present().map_err(|error| words(&error))
    }
}

/// Whether curves have marks at whole numbers alone, which count something.
fn counts(curves: &[Curve]) -> bool {
    let mut marked = curves.iter().filter(|curve| curve.has_marks()).flat_map(|curve| &curve.points).peekable();
    marked.peek().is_some() && marked.all(|(x, _)| x.fract() == 0.0)
}

/// The range of some values, with a margin; never empty.
fn range(values: impl Iterator<Item = f64>, margin: f64) -> Range<f64> {
    let (low, high) = ends(values);
    let room = (high - low) * margin;
    if high - low > 1e-12 * low.abs().max(high.abs()) {
        return low - room..high + room;
    }
    // A constant is in the middle of a range of its own size.
    let size = if high == 0.0 { 1.0 } else { 0.5 * high.abs() };
    low - size..high + size
}

/// The decades that hold some positive values, two at least: a logarithmic axis has its ticks at their ends.
fn decades(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (low, high) = ends(values);
    // A power of ten is not exact. At the lower edge it belongs to the decade above, and at the upper edge there is
    // room, so that no curve lies on the frame.
    let (first, last) = ((libm::log10(low) + 1e-9).floor(), (libm::log10(high) + 0.05).ceil());
    let missing = (2.0 - (last - first)).max(0.0);
    let (first, last) = (first - (missing / 2.0).ceil(), last + (missing / 2.0).floor());
    // The ticks at both ends are within.
    libm::pow(10.0, first) * (1.0 - 1e-6)..libm::pow(10.0, last) * (1.0 + 1e-6)
}

fn ends(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), value| (a.min(value), b.max(value)))
}

/// A number at an axis; `span` is the length of a linear one.
fn tick(value: f64, span: f64) -> String {
    // Ticks are multiples of a step that is no double: what should be 0 is a rounding.
    if value.abs() <= 1e-9 * span {
        return "0".to_owned();
    }
    if value != 0.0 && !(1e-3..1e4).contains(&value.abs()) {
        // As many digits as tell neighbours apart.
        let digits =
            if span > 0.0 { (libm::log10(value.abs() / span).ceil() + 1.0).clamp(0.0, 6.0) as usize } else { 0 };
        let text = format!("{value:.digits$e}");
        let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        let mantissa =
            if mantissa.contains('.') { mantissa.trim_end_matches('0').trim_end_matches('.') } else { mantissa };
        return format!("{mantissa}e{exponent}");
    }
    let text = format!("{value:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::super::Style;
    use super::*;

    fn figure(scale: Scale, points: &[(f64, f64)]) -> Figure {
        let curve = Curve { label: "curve".to_owned(), points: points.to_vec(), style: Style::Marked };
        let name = |text: &str| text.to_owned();
        Figure { title: name("Title"), x: name("t"), y: name("e"), scale, floor: 1e-9, curves: vec![curve] }
    }

    #[test]
    fn every_scale_is_drawn() {
        for scale in [Scale::Linear, Scale::LogX, Scale::LogY, Scale::LogLog] {
            let figure = figure(scale, &[(0.5, 1.0), (1.0, 0.0), (2.0, 1e-3), (f64::NAN, 1.0)]);
            let svg = figure.svg().unwrap();
            // Three markers and one in the legend, and the figure is the same each time.
            assert_eq!(svg.matches("<circle").count(), 4, "{scale:?}");
            assert!(svg.contains("Title") && svg.contains("curve") && svg.ends_with("</svg>\n"), "{svg}");
            assert_eq!(svg, figure.svg().unwrap());
        }
        assert!(figure(Scale::Linear, &[(1.0, 2.0)]).svg().is_ok());
    }

    #[test]
    fn nothing_to_draw_is_an_error() {
        let empty = figure(Scale::LogLog, &[(0.0, 1.0), (1.0, f64::INFINITY)]);
        assert_eq!(empty.svg(), Err(PlotError::Empty { title: "Title".to_owned() }));
    }

    #[test]
    fn ticks_are_short() {
        for (value, span, text) in [
            (0.0, 1.0, "0"),
            (-1.1e-16, 5.0, "0"),
            (-1.1e-16, 1e-15, "-1.1e-16"),
            (0.5, 1.0, "0.5"),
            (-2.0, 5.0, "-2"),
            (1e-4, 0.0, "1e-4"),
            (9.999_999_999_999_999e197, 0.0, "1e198"),
            (1e5, 0.0, "1e5"),
            (0.001, 1.0, "0.001"),
            (1.5e-5, 3e-5, "1.5e-5"),
            (12_500.0, 1e4, "1.25e4"),
            (123_400.0, 400.0, "1.234e5"),
        ] {
            assert_eq!(tick(value, span), text);
        }
    }

    #[test]
    fn axes_have_ticks_whatever_the_values() {
        let decades = |values: &[f64]| decades(values.iter().copied());
        let close = |a: Range<f64>, b: Range<f64>| (a.start / b.start - 1.0).abs() + (a.end / b.end - 1.0).abs() < 1e-5;
        assert!(close(decades(&[0.5, 30.0]), 0.1..100.0));
        assert!(close(decades(&[1e-3, 1e3]), 1e-3..1e4));
        assert!(close(decades(&[0.5]), 0.01..1.0));
        assert!(close(decades(&[1e-4, 1e-4]), 1e-5..1e-3), "{:?}", decades(&[1e-4]));
        let range = |values: &[f64]| range(values.iter().copied(), 0.0);
        assert_eq!((range(&[0.0]), range(&[-2.0, -2.0]), range(&[1.0, 3.0])), (-1.0..1.0, -3.0..-1.0, 1.0..3.0));
        assert!(close(range(&[1e-9]), 0.5e-9..1.5e-9));
        // A flat spectrum has figures at its axis.
        let svg = figure(Scale::LogY, &[(0.0, 0.5), (1.0, 0.5)]).svg().unwrap();
        assert!([">\n0.01\n<", ">\n0.1\n<", ">\n1\n<"].iter().all(|tick| svg.contains(tick)), "{svg}");
        // Marks leave the names of both logarithmic axes as they are.
        let svg = figure(Scale::LogLog, &[(0.002, 50.0), (0.05, 60.0)]).svg().unwrap();
        assert!([">\n0.01\n<", ">\n0.1\n<", ">\n10\n<"].iter().all(|tick| svg.contains(tick)), "{svg}");
    }

    #[test]
    fn the_legend_is_above_the_curves() {
        let svg = figure(Scale::Linear, &[(0.0, 1.0), (1.0, 1.0)]).svg().unwrap();
        let lines: Vec<&str> = svg.lines().collect();
        let label = lines.iter().position(|line| *line == "curve").unwrap();
        let height =
            |line: &str| -> f64 { line.split_once(" y=\"").unwrap().1.split('"').next().unwrap().parse().unwrap() };
        // The first mark is that of the legend.
        let highest = lines
            .iter()
            .filter(|line| line.starts_with("<circle"))
            .skip(1)
            .map(|line| line.split_once("cy=\"").unwrap().1.split('"').next().unwrap().parse::<f64>().unwrap());
        assert!(height(lines[label - 1]) + 13.0 * f64::from(DETAIL) < highest.fold(f64::INFINITY, f64::min));
    }
}
