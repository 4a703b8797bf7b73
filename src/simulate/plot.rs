//! Figures as SVG.

use crate::palette::COLOURS;
use plotters::coord::ranged1d::{AsRangedCoord, Ranged, ValueFormatter};
use plotters::prelude::*;
use std::ops::Range;
use thiserror::Error;

/// The size of a figure in pixels.
const SIZE: (u32, u32) = (820, 480);

/// Which axes are logarithmic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// None.
    Linear,
    /// The vertical one.
    LogY,
    /// Both.
    LogLog,
}

/// One curve.
#[derive(Clone, Debug)]
pub struct Curve {
    /// What the legend says.
    pub label: String,
    /// Its points; those that are not finite, or not positive on a logarithmic axis, are left out.
    pub points: Vec<(f64, f64)>,
    /// Whether the points are marked, for values at separate places.
    pub marked: bool,
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
    /// The figure as SVG. The same figure gives the same bytes.
    ///
    /// # Errors
    /// [`PlotError`].
    pub fn svg(&self) -> Result<String, PlotError> {
        let curves: Vec<Curve> = self.curves.iter().map(|curve| self.drawable(curve)).collect();
        let all = || curves.iter().flat_map(|curve| curve.points.iter());
        if all().next().is_none() {
            return Err(PlotError::Empty { title: self.title.clone() });
        }
        let x = range(all().map(|point| point.0), self.scale == Scale::LogLog, 0.0);
        let y = range(all().map(|point| point.1), self.scale != Scale::Linear, 0.06);
        let mut text = String::new();
        let drawn = match self.scale {
            Scale::Linear => self.draw(&mut text, x, y, &curves),
            Scale::LogY => self.draw(&mut text, x, y.log_scale(), &curves),
            Scale::LogLog => self.draw(&mut text, x.log_scale(), y.log_scale(), &curves),
        };
        drawn.map_err(|reason| PlotError::Drawing { title: self.title.clone(), reason })?;
        Ok(text)
    }

    fn drawable(&self, curve: &Curve) -> Curve {
        let points = curve
            .points
            .iter()
            .filter(|(x, y)| x.is_finite() && y.is_finite() && (self.scale != Scale::LogLog || *x > 0.0))
            .map(|&(x, y)| (x, if self.scale == Scale::Linear { y } else { y.max(self.floor) }))
            .collect();
        Curve { points, ..curve.clone() }
    }

    fn draw<X, Y>(&self, text: &mut String, x: X, y: Y, curves: &[Curve]) -> Result<(), String>
    where
        X: AsRangedCoord<Value = f64>,
        Y: AsRangedCoord<Value = f64>,
        X::CoordDescType: Ranged<ValueType = f64> + ValueFormatter<f64>,
        Y::CoordDescType: Ranged<ValueType = f64> + ValueFormatter<f64>,
    {
        let words = |error: &dyn std::fmt::Display| error.to_string();
        let area = SVGBackend::with_string(text, SIZE).into_drawing_area();
        area.fill(&WHITE).map_err(|error| words(&error))?;
        let mut chart = ChartBuilder::on(&area)
            .caption(&self.title, ("sans-serif", 18))
            .margin(12)
            .x_label_area_size(46)
            .y_label_area_size(78)
            .build_cartesian_2d(x, y)
            .map_err(|error| words(&error))?;
        chart
            .configure_mesh()
            .x_desc(&self.x)
            .y_desc(&self.y)
            .x_label_formatter(&|value| tick(*value))
            .y_label_formatter(&|value| tick(*value))
            .label_style(("sans-serif", 13))
            .axis_desc_style(("sans-serif", 15))
            .light_line_style(RGBColor(242, 242, 242))
            .bold_line_style(RGBColor(220, 220, 220))
            .draw()
            .map_err(|error| words(&error))?;
        for (index, curve) in curves.iter().enumerate() {
            let colour = COLOURS[index % COLOURS.len()];
            let style = colour.stroke_width(2);
            chart
                .draw_series(LineSeries::new(curve.points.iter().copied(), style))
                .map_err(|error| words(&error))?
                .label(&curve.label)
                .legend(move |(x, y)| PathElement::new(vec![(x, y), (x + 18, y)], style));
            if curve.marked {
                let markers = curve.points.iter().map(|&point| Circle::new(point, 4, colour.filled()));
                chart.draw_series(markers).map_err(|error| words(&error))?;
            }
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperRight)
            .background_style(WHITE.mix(0.85))
            .border_style(RGBColor(200, 200, 200))
            .label_font(("sans-serif", 13))
            .draw()
            .map_err(|error| words(&error))?;
        area.present().map_err(|error| words(&error))
    }
}

/// The range of some values, with a margin; never empty.
fn range(values: impl Iterator<Item = f64>, logarithmic: bool, margin: f64) -> Range<f64> {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), value| (a.min(value), b.max(value)));
    if logarithmic {
        let factor = libm::pow(high / low, margin).max(1.0 + margin);
        return low / factor..high * factor;
    }
    let room = ((high - low) * margin).max(1e-300);
    if high > low { low - room..high + room } else { low - 1.0..high + 1.0 }
}

/// A number at an axis.
fn tick(value: f64) -> String {
    if value != 0.0 && !(1e-3..1e4).contains(&value.abs()) {
        return format!("{value:.0e}");
    }
    let text = format!("{value:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figure(scale: Scale, points: &[(f64, f64)]) -> Figure {
        let curve = Curve { label: "curve".to_owned(), points: points.to_vec(), marked: true };
        let name = |text: &str| text.to_owned();
        Figure { title: name("Title"), x: name("t"), y: name("e"), scale, floor: 1e-9, curves: vec![curve] }
    }

    #[test]
    fn every_scale_is_drawn() {
        for scale in [Scale::Linear, Scale::LogY, Scale::LogLog] {
            let figure = figure(scale, &[(0.5, 1.0), (1.0, 0.0), (2.0, 1e-3), (f64::NAN, 1.0)]);
            let svg = figure.svg().unwrap();
            // Three markers, and the figure is the same each time.
            assert_eq!(svg.matches("<circle").count(), 3, "{scale:?}");
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
        for (value, text) in [(0.0, "0"), (0.5, "0.5"), (-2.0, "-2"), (1e-4, "1e-4"), (1e5, "1e5"), (0.001, "0.001")] {
            assert_eq!(tick(value), text);
        }
    }
}
