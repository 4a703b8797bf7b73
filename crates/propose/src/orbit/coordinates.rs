//! Proposals for coordinates y with x = x_0 + L y in which the zero dynamics contract, in floating point (derivation, 11.5).
//!
//! For a constant P nothing is lost with P = I: L L^T = P^-1. L is taken lower triangular, which is the shortest of them: the
//! norm of y does not depend on the choice. Everything is sought in the axes of the modes along the orbit (`modes`), so that it
//! does not depend on the units of the states. A P(t) of the periodic Lyapunov equation stands by for plants that contract in
//! no constant one.

use super::balance::balance;
use super::failure::OrbitFailure;
use super::field::Field;
use super::find::FloatOrbit;
use super::least_gain::least_gain_shapes;
use super::modes::modes;
use super::series::{FloatSeries, Turn};
use super::shape::{Channel, decay, largest_rate, most_matrices, narrow_shapes, round_shapes};
use crate::lyapunov::candidates_of;
use nalgebra::{DMatrix, DVector};
use rug::Rational;
use sigmastar_exact::enclosure::{DEFAULT_PRECISION, Enclosure};
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_lang::expr::TrigonometricPolynomial;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::PeriodicMatrix;
use sigmastar_theory::evidence::Coordinates;
use sigmastar_theory::jacobian::{Deviation, Family};

/// Significant digits of L, tried in turn.
const DIGITS: [u32; 6] = [3, 4, 5, 7, 10, 14];

/// By what share rounding L may change the rate, and the product of |f_e| and |q_x|.
const KEPT: f64 = 0.999;

/// Where no constant P has this share of the Floquet rate, P(t) are looked for as well.
const ENOUGH: f64 = 0.2;

/// The P(t) that are offered.
const MAX_PERIODIC: usize = 8;

/// Harmonics of the Jacobian that a P(t) is sought for, and the share of its size below which they are left out.
const JACOBIAN_HARMONICS: usize = 8;
const NEGLIGIBLE: f64 = 1e-5;

/// Matrices that differ by less, relative to the size of all, are one.
const SAME: f64 = 1e-10;

/// Times of f_e, q_x and q_e for which coordinates are sought.
const CHANNELS: usize = 6;

/// The least singular value of L that doubles tell from 0, relative to the largest.
const LEAST_SINGULAR: f64 = 1e-14;

/// Coordinates with what samples say of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Rated {
    /// L and P.
    pub coordinates: Coordinates,
    /// The rate at the sampled matrices, in floating point, in 1/time.
    pub rate: f64,
}

/// Candidates along an orbit, the largest rate first as they were found.
///
/// The Jacobians are sampled along the orbit at e = 0, and, where `states` or `error` is not 0, as well at states that are
/// `states` away from it along each axis of the coordinates that bring all states to a common size, with errors `-error` and
/// `error`. Guarantee: none; L is invertible.
///
/// # Errors
/// [`OrbitFailure::NotFinite`]; an empty list says that nothing contracts in what was tried.
pub fn propose_coordinates(
    plant: &Plant,
    orbit: &FloatOrbit,
    states: f64,
    error: f64,
) -> Result<Vec<Rated>, OrbitFailure> {
    let mut field = Field::new(plant);
    let n = field.states();
    if n == 0 {
        let p = PeriodicMatrix { mean: Vec::new(), harmonics: Vec::new() };
        return Ok(vec![Rated { coordinates: Coordinates { l: Vec::new(), p }, rate: f64::INFINITY }]);
    }
    let series = field.own(&orbit.series);
    let along = sample(&mut field, &series, &[vec![0.0; n]], &[0.0], most_matrices(n));
    let scale = balance(&along);
    let balanced_channel = channel(&mut field, &series, &scale);
    let Channel { inputs: f_e, outputs: q_x, slopes } = &balanced_channel;
    let balanced = |matrix: &DMatrix<f64>| DMatrix::from_fn(n, n, |i, j| matrix[(i, j)] * (scale[j] / scale[i]));
    let mut matrices = along;
    if states > 0.0 || error > 0.0 {
        let axes = (0..n).flat_map(|i| [1.0, -1.0].map(|sign| (i, sign)));
        let shift = |(at, sign): (usize, f64)| -> Vec<f64> {
            (0..n).map(|i| if i == at { sign * states * scale[i] } else { 0.0 }).collect()
        };
        let shifts: Vec<Vec<f64>> = axes.map(shift).collect();
        let errors = if error > 0.0 { vec![-error, error] } else { vec![0.0] };
        let times = (most_matrices(n) / (shifts.len() * errors.len())).max(2);
        matrices.extend(sample(&mut field, &series, &shifts, &errors, times));
    }
    if !matrices.iter().all(|matrix| matrix.iter().all(|entry| entry.is_finite())) {
        return Err(OrbitFailure::NotFinite);
    }
    let matrices = distinct(matrices.iter().map(balanced).collect());
    let mean = |vectors: &[DVector<f64>]| vectors.iter().fold(DVector::zeros(n), |sum, vector| sum + vector);
    let middle = matrices.iter().fold(DMatrix::zeros(n, n), |sum, matrix| sum + matrix) / matrices.len() as f64;
    let basis = modes(&middle, &mean(f_e), &mean(q_x)).unwrap_or_else(|| DMatrix::identity(n, n));
    let inverse = basis.clone().try_inverse().ok_or(OrbitFailure::NotFinite)?;
    let own: Vec<DMatrix<f64>> = matrices.iter().map(|matrix| &inverse * matrix * &basis).collect();
    let channel = Channel {
        inputs: f_e.iter().map(|vector| &inverse * vector).collect(),
        outputs: q_x.iter().map(|vector| basis.transpose() * vector).collect(),
        slopes: slopes.clone(),
    };
    let limit = orbit.floquet.first().map_or(f64::NAN, |first| -first[0]);
    let units: Vec<f64> = scale.iter().zip(field.units()).map(|(scale, unit)| scale * unit).collect();
    let mut found: Vec<Rated> = Vec::new();
    let largest = largest_rate(&own, limit);
    // A linear plant is sought in its modes alone, which units do not touch. Where the matrix moves, the roundest P in units of
    // one size comes first, and the modes stand by.
    let round = if own.len() == 1 { Vec::new() } else { round_shapes(&matrices, largest) };
    let in_modes = match round.is_empty() {
        true => narrow_shapes(&own, &channel, largest).into_iter().chain(round_shapes(&own, largest)).collect(),
        false => Vec::new(),
    };
    let identity = DMatrix::identity(n, n);
    let in_modes = in_modes.into_iter().chain(least_gain_shapes(&own, &channel, largest));
    let shapes = round.into_iter().map(|p| (p, &identity)).chain(in_modes.map(|p| (p, &basis)));
    for (p, axes) in shapes {
        let root = p.try_inverse().and_then(|inverse| inverse.cholesky());
        if let Some(candidate) =
            root.and_then(|root| constant(&matrices, &balanced_channel, &(axes * root.l()), &units))
            && !found.iter().any(|other| other.coordinates.l == candidate.coordinates.l)
        {
            found.push(candidate);
        }
    }
    if found.iter().map(|candidate| candidate.rate).fold(0.0, f64::max) < ENOUGH * limit {
        found.extend(periodic(&mut field, &series, &balanced, &units));
    }
    Ok(found)
}

/// The matrices without those that repeat one before them.
fn distinct(matrices: Vec<DMatrix<f64>>) -> Vec<DMatrix<f64>> {
    let size = matrices.iter().map(DMatrix::amax).fold(0.0, f64::max);
    let mut kept: Vec<DMatrix<f64>> = Vec::new();
    for matrix in matrices {
        if !kept.iter().any(|other| (other - &matrix).amax() <= SAME * size) {
            kept.push(matrix);
        }
    }
    kept
}

/// f_e, q_x and q_e at a few times, with the states in units of `scale`.
fn channel(field: &mut Field, series: &FloatSeries, scale: &[f64]) -> Channel {
    let turn = Turn::new(CHANNELS);
    let mut channel = Channel { inputs: Vec::new(), outputs: Vec::new(), slopes: Vec::new() };
    for j in 0..CHANNELS {
        field.set(j as f64 / CHANNELS as f64, &series.at_part(&turn, j).0, 0.0);
        let (mut f_e, mut q_x) = (field.f_e(), field.q_x());
        for (i, scale) in scale.iter().enumerate() {
            f_e[i] /= scale;
            q_x[i] *= scale;
        }
        channel.inputs.push(f_e);
        channel.outputs.push(q_x);
        channel.slopes.push(field.q_e());
    }
    channel
}

/// Jacobians at so many times, with each shift of the state and each error.
fn sample(
    field: &mut Field,
    series: &FloatSeries,
    shifts: &[Vec<f64>],
    errors: &[f64],
    times: usize,
) -> Vec<DMatrix<f64>> {
    let turn = Turn::new(times);
    let mut matrices = Vec::new();
    for j in 0..times {
        let x = series.at_part(&turn, j).0;
        for shift in shifts {
            let moved: Vec<f64> = x.iter().zip(shift).map(|(x, shift)| x + shift).collect();
            for e in errors {
                field.set(j as f64 / times as f64, &moved, *e);
                matrices.push(field.jacobian());
            }
        }
    }
    matrices
}

/// The lower triangular matrix that is this one but for a rotation on its right; nothing is squared, so that no digit is lost.
pub fn lower_triangular(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let mut lower = matrix.transpose().qr().r().transpose();
    for (j, mut column) in lower.column_iter_mut().enumerate() {
        if column[j] < 0.0 {
            column.neg_mut();
        }
    }
    lower
}

/// L in the plant's own units, of which the states of `own` are the multiples `scale`, rounded to few digits; with singular
/// values of at least about 1, so that |y| is at most about |x - x_0|.
fn coordinates_of(own: &DMatrix<f64>, scale: &[f64], digits: u32) -> Option<Vec<Vec<Rational>>> {
    let n = own.nrows();
    let own = lower_triangular(own);
    let own = DMatrix::from_fn(n, n, |i, j| scale[i] * own[(i, j)]);
    let values = own.clone().singular_values();
    let least = values.min().max(LEAST_SINGULAR * values.max());
    if !(least.is_finite() && least > 0.0) {
        return None;
    }
    let own = own / least;
    let entry = |i: usize, j: usize| {
        let (value, row) = (own[(i, j)], own.row(i).amax());
        // Digits that do not matter beside the largest entry of the row are dropped.
        let lost = if value == 0.0 { digits } else { libm::log10(row / value.abs()).floor().clamp(0.0, 99.0) as u32 };
        match j > i || lost >= digits {
            true => Some(Rational::new()),
            false => round_f64(value, digits - lost, Direction::Nearest),
        }
    };
    let l: Option<Vec<Vec<Rational>>> = (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect();
    // Triangular: invertible exactly if the diagonal has no 0.
    l.filter(|l| (0..n).all(|i| !l[i][i].is_zero()))
}

/// L in floating point, for coordinates in which the states have been brought to a common size, and its inverse.
fn doubles(l: &[Vec<Rational>], scale: &[f64]) -> Option<[DMatrix<f64>; 2]> {
    let n = l.len();
    let own = DMatrix::from_fn(n, n, |i, j| l[i][j].to_f64() / scale[i]);
    let inverse = own.clone().try_inverse()?;
    Some([own, inverse])
}

/// The coordinates of a constant P, from those before they are rounded, in the units of the matrices and of the channel.
fn constant(matrices: &[DMatrix<f64>], channel: &Channel, own: &DMatrix<f64>, scale: &[f64]) -> Option<Rated> {
    let inverse = own.clone().try_inverse()?;
    let [exact, narrow] = [rate_in(matrices, own, &inverse)?, channel.product_in(own, &inverse)];
    let mut last = None;
    for digits in DIGITS {
        let Some(l) = coordinates_of(own, scale, digits) else { continue };
        let Some([rounded, inverse]) = doubles(&l, scale) else { continue };
        let rate = rate_in(matrices, &rounded, &inverse)?;
        if rate > 0.0 {
            last = Some(Rated { coordinates: Coordinates { p: identity(l.len()), l }, rate });
        }
        // A rate that is larger by chance would not be in other units.
        let is_kept = |value: f64, of: f64| value >= KEPT * of && KEPT * value <= of;
        if is_kept(rate, exact) && is_kept(channel.product_in(&rounded, &inverse), narrow) {
            break;
        }
    }
    last
}

/// The rate in coordinates L.
fn rate_in(matrices: &[DMatrix<f64>], l: &DMatrix<f64>, inverse: &DMatrix<f64>) -> Option<f64> {
    let rates: Option<Vec<f64>> = matrices.iter().map(|matrix| decay(&(inverse * matrix * l))).collect();
    rates.map(|rates| rates.into_iter().fold(f64::INFINITY, f64::min))
}

fn identity(order: usize) -> PeriodicMatrix {
    let entry = |i: usize, j: usize| Rational::from(u8::from(i == j));
    let mean = (0..order).map(|i| (0..order).map(|j| entry(i, j)).collect()).collect();
    PeriodicMatrix { mean, harmonics: Vec::new() }
}

/// Coordinates of P(t), from the periodic Lyapunov equation and semidefinite programs for the Jacobian along the orbit.
fn periodic(
    field: &mut Field,
    curve: &FloatSeries,
    balanced: &dyn Fn(&DMatrix<f64>) -> DMatrix<f64>,
    scale: &[f64],
) -> Vec<Rated> {
    let n = field.states();
    let times = 8 * (curve.harmonics.len() + JACOBIAN_HARMONICS);
    let samples = sample(field, curve, &[vec![0.0; n]], &[0.0], times);
    let rows: Vec<Vec<f64>> = samples.iter().map(|matrix| balanced(matrix).as_slice().to_vec()).collect();
    let mut series = FloatSeries::from_samples(&rows, JACOBIAN_HARMONICS);
    let size = rows.iter().flatten().fold(0.0_f64, |size, entry| size.max(entry.abs()));
    while series.harmonics.last().is_some_and(|pair| pair.iter().flatten().all(|c| c.abs() <= NEGLIGIBLE * size)) {
        series.harmonics.pop();
    }
    let number =
        |value: f64| Rational::from_f64(value).map(|value| Enclosure::from_rational(&value, DEFAULT_PRECISION));
    let entry = |i: usize, j: usize| -> Option<TrigonometricPolynomial> {
        // Column by column.
        let at = |values: &Vec<f64>| number(values[j * n + i]);
        let harmonics = series.harmonics.iter().map(|[a, b]| Some([at(a)?, at(b)?])).collect::<Option<Vec<_>>>()?;
        Some(TrigonometricPolynomial { mean: at(&series.mean)?, harmonics })
    };
    let centre: Option<Vec<Vec<TrigonometricPolynomial>>> =
        (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect();
    let (Some(centre), Some(frequency)) = (centre, number(std::f64::consts::TAU / field.period)) else {
        return Vec::new();
    };
    let family = Family { frequency, centre, deviation: Deviation::Vertices(vec![Vec::new()]) };
    let Ok(candidates) = candidates_of(family) else { return Vec::new() };
    let periodic = candidates.found.iter().filter(|candidate| !candidate.matrix.harmonics.is_empty());
    periodic
        .take(MAX_PERIODIC)
        .filter_map(|candidate| in_coordinates(&candidate.matrix, candidate.alpha, scale))
        .collect()
}

/// A P(t) in coordinates in which its mean is nearly the identity.
fn in_coordinates(matrix: &PeriodicMatrix, rate: f64, scale: &[f64]) -> Option<Rated> {
    let double = |rows: &Vec<Vec<Rational>>| DMatrix::from_fn(rows.len(), rows.len(), |i, j| rows[i][j].to_f64());
    let root = double(&matrix.mean).try_inverse()?.cholesky()?.l();
    let l = coordinates_of(&root, scale, DIGITS[1])?;
    let own = doubles(&l, scale)?[0].clone();
    let size = (own.transpose() * double(&matrix.mean) * &own).amax();
    // Nine decimals beside entries of about 1.
    const DECIMALS: f64 = 1e9;
    let exact = |rows: &Vec<Vec<Rational>>| -> Option<Vec<Vec<Rational>>> {
        let value = own.transpose() * double(rows) * &own / size;
        let entry = |i: usize, j: usize| {
            let value = value[(i.min(j), i.max(j))];
            round_f64((value * DECIMALS).round() / DECIMALS, 12, Direction::Nearest)
        };
        (0..rows.len()).map(|i| (0..rows.len()).map(|j| entry(i, j)).collect()).collect()
    };
    let harmonics: Option<Vec<[Vec<Vec<Rational>>; 2]>> =
        matrix.harmonics.iter().map(|[a, b]| Some([exact(a)?, exact(b)?])).collect();
    let p = PeriodicMatrix { mean: exact(&matrix.mean)?, harmonics: harmonics? };
    Some(Rated { coordinates: Coordinates { l, p }, rate })
}
