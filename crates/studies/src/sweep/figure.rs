//! sigma* over one parameter, one curve for each value of a second.

use super::cases::Sweep;
use super::design::Design;
use super::results::Results;
use super::values::{Scalar, Values, number};
use sigmastar_document::plot::{Curve, Figure, Scale, Style};
use thiserror::Error;

/// The most curves of a figure.
const MAX_CURVES: usize = 24;

/// Why a study has no figure.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum FigureError {
    /// Neither one nor two parameters.
    #[error("a plot needs a grid of one or two parameters")]
    Parameters,
    /// The first parameter is no number.
    #[error("`{value}` is no number, so `{name}` has no axis")]
    NoNumber {
        /// The parameter.
        name: String,
        /// Its value.
        value: String,
    },
    /// The second parameter has too many values.
    #[error("{curves} values of the second parameter are more curves than a plot shows; at most {MAX_CURVES}")]
    Curves {
        /// How many.
        curves: usize,
    },
}

/// The figure of a study with the gains of its results: drawn from doubles, and proving nothing. Between its points nothing is
/// claimed; a curve with cases that are not certified is drawn as marks.
///
/// # Errors
/// A study that has no figure.
pub fn sweep_figure(sweep: &Sweep, results: &Results) -> Result<Figure, FigureError> {
    let study = &sweep.study;
    let (first, second) = match study.parameters.as_slice() {
        [first] if study.design == Design::Grid => (first, None),
        [first, second] if study.design == Design::Grid => (first, Some(second)),
        _ => return Err(FigureError::Parameters),
    };
    // The reader of the study has made the same values.
    let texts =
        |values: &Values| -> Vec<String> { values.levels().unwrap_or_default().iter().map(Scalar::text).collect() };
    let abscissae: Vec<f64> = texts(&first.values)
        .into_iter()
        .map(|value| number(&value).ok_or(FigureError::NoNumber { name: first.name.clone(), value }))
        .collect::<Result<_, _>>()?;
    let labels = second.map_or_else(
        || vec!["sigma_star".to_owned()],
        |second| texts(&second.values).iter().map(|value| format!("{} = {value}", second.name)).collect(),
    );
    if labels.len() > MAX_CURVES {
        return Err(FigureError::Curves { curves: labels.len() });
    }
    let gain = |index: usize| {
        let row = results.rows.get(&(index as u64))?;
        number(&row.claim.as_ref()?.sigma_star)
    };
    let curve = |(at, label): (usize, &String)| {
        // On a grid the last parameter changes fastest.
        let points = abscissae.iter().enumerate().map(|(k, x)| Some((*x, gain(k * labels.len() + at)?)));
        let points: Vec<Option<(f64, f64)>> = points.collect();
        let style = if points.iter().all(Option::is_some) { Style::Marked } else { Style::Points };
        let mut points: Vec<(f64, f64)> = points.into_iter().flatten().collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        Curve { label: label.clone(), points, style }
    };
    Ok(Figure {
        title: study.name.clone(),
        x: first.name.clone(),
        y: "sigma_star [1/time]".to_owned(),
        scale: if matches!(first.values, Values::Logarithmic(_)) { Scale::LogX } else { Scale::Linear },
        floor: 0.0,
        curves: labels.iter().enumerate().map(curve).filter(|curve| !curve.points.is_empty()).collect(),
    })
}
