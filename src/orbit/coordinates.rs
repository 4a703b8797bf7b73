//! Proposals for coordinates y with x = x_0 + L y in which the zero dynamics contract, in floating point (derivation, 11.5).
//!
//! For a constant P nothing is lost with P = I: L L^T = P^-1. L is taken lower triangular, which is the shortest of them: the
//! norm of y does not depend on the choice. A P(t) of the periodic Lyapunov equation stands by for plants that contract in no
//! constant one.

use super::failure::OrbitFailure;
use super::field::Field;
use super::find::FloatOrbit;
use super::series::{FloatSeries, Turn};
use super::shape::{decay, most_matrices, shapes};
use crate::enclosure::{DEFAULT_PRECISION, Enclosure};
use crate::expr::TrigonometricPolynomial;
use crate::lyapunov::{Deviation, Family, candidates_of};
use crate::number::{Direction, round_f64};
use crate::plant::Plant;
use crate::spec::PeriodicMatrix;
use nalgebra::DMatrix;
use rug::Rational;

/// Significant digits of L, tried in turn.
const DIGITS: [u32; 4] = [3, 4, 5, 7];

/// What rounding L may take from the rate.
const KEPT: f64 = 0.999;

/// Where no constant P has this share of the Floquet rate, P(t) are looked for as well.
const ENOUGH: f64 = 0.2;

/// The P(t) that are offered.
const MAX_PERIODIC: usize = 8;

/// Harmonics of the Jacobian that a P(t) is sought for, and the share of its size below which they are left out.
const JACOBIAN_HARMONICS: usize = 8;
const NEGLIGIBLE: f64 = 1e-5;

/// Sweeps over the states that bring them to a common size.
const SWEEPS: usize = 10;

/// Coordinates and the P in them.
#[derive(Clone, Debug, PartialEq)]
pub struct Coordinates {
    /// L, row by row.
    pub l: Vec<Vec<Rational>>,
    /// P(t) in the coordinates y; the identity where it is constant.
    pub p: PeriodicMatrix,
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
) -> Result<Vec<Coordinates>, OrbitFailure> {
    let mut field = Field::new(plant);
    let n = field.states();
    if n == 0 {
        let p = PeriodicMatrix { mean: Vec::new(), harmonics: Vec::new() };
        return Ok(vec![Coordinates { l: Vec::new(), p, rate: f64::INFINITY }]);
    }
    let along = sample(&mut field, &orbit.series, &[vec![0.0; n]], &[0.0], most_matrices(n));
    let scale = balance(&along);
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
        matrices.extend(sample(&mut field, &orbit.series, &shifts, &errors, times));
    }
    if !matrices.iter().all(|matrix| matrix.iter().all(|entry| entry.is_finite())) {
        return Err(OrbitFailure::NotFinite);
    }
    let matrices: Vec<DMatrix<f64>> = matrices.iter().map(balanced).collect();
    let limit = orbit.floquet.first().map_or(f64::NAN, |first| -first[0]);
    let mut found: Vec<Coordinates> = Vec::new();
    for p in shapes(&matrices, limit) {
        if let Some(candidate) = constant(&matrices, &p, &scale)
            && !found.iter().any(|other| other.l == candidate.l)
        {
            found.push(candidate);
        }
    }
    if found.first().is_none_or(|best| best.rate < ENOUGH * limit) {
        found.extend(periodic(&mut field, orbit, &balanced, &scale));
    }
    Ok(found)
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

/// Powers of two by which the states are to be divided, so that rows and columns of the matrices have similar sizes (Osborne,
/// On pre-conditioning of matrices, 1960).
fn balance(matrices: &[DMatrix<f64>]) -> Vec<f64> {
    let n = matrices.first().map_or(0, DMatrix::nrows);
    let mut scale = vec![1.0_f64; n];
    for _ in 0..SWEEPS {
        for i in 0..n {
            let (mut row, mut column) = (0.0, 0.0);
            for matrix in matrices {
                for j in (0..n).filter(|j| *j != i) {
                    row += matrix[(i, j)].abs() * scale[j] / scale[i];
                    column += matrix[(j, i)].abs() * scale[i] / scale[j];
                }
            }
            if row > 0.0 && column > 0.0 && row.is_finite() && column.is_finite() {
                // The nearest power of two to the root of the quotient.
                let (fraction, exponent) = libm::frexp((row / column).sqrt());
                let exponent = if fraction < std::f64::consts::FRAC_1_SQRT_2 { exponent - 1 } else { exponent };
                scale[i] *= libm::ldexp(1.0, exponent);
            }
        }
    }
    scale
}

/// L with `L L^T = P^-1` in the plant's own units, rounded to few digits; with singular values of at least about 1, so that
/// |y| is at most about |x - x_0|.
fn coordinates_of(p: &DMatrix<f64>, scale: &[f64], digits: u32) -> Option<Vec<Vec<Rational>>> {
    let n = p.nrows();
    let own = p.clone().try_inverse()?.cholesky()?.l();
    let own = DMatrix::from_fn(n, n, |i, j| scale[i] * own[(i, j)]);
    let least = own.clone().singular_values().min();
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

/// The coordinates of a constant P.
fn constant(matrices: &[DMatrix<f64>], p: &DMatrix<f64>, scale: &[f64]) -> Option<Coordinates> {
    let exact = super::shape::rate(matrices, p)?;
    let mut last = None;
    for digits in DIGITS {
        let Some(l) = coordinates_of(p, scale, digits) else { continue };
        let Some([own, inverse]) = doubles(&l, scale) else { continue };
        let rates: Option<Vec<f64>> = matrices.iter().map(|matrix| decay(&(&inverse * matrix * &own))).collect();
        let rate = rates?.into_iter().fold(f64::INFINITY, f64::min);
        if rate > 0.0 {
            last = Some(Coordinates { p: identity(l.len()), l, rate });
        }
        if rate >= KEPT * exact {
            break;
        }
    }
    last
}

fn identity(order: usize) -> PeriodicMatrix {
    let entry = |i: usize, j: usize| Rational::from(u8::from(i == j));
    let mean = (0..order).map(|i| (0..order).map(|j| entry(i, j)).collect()).collect();
    PeriodicMatrix { mean, harmonics: Vec::new() }
}

/// Coordinates of P(t), from the periodic Lyapunov equation and semidefinite programs for the Jacobian along the orbit.
fn periodic(
    field: &mut Field,
    orbit: &FloatOrbit,
    balanced: &dyn Fn(&DMatrix<f64>) -> DMatrix<f64>,
    scale: &[f64],
) -> Vec<Coordinates> {
    let n = field.states();
    let times = 8 * (orbit.series.harmonics.len() + JACOBIAN_HARMONICS);
    let samples = sample(field, &orbit.series, &[vec![0.0; n]], &[0.0], times);
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
fn in_coordinates(matrix: &PeriodicMatrix, rate: f64, scale: &[f64]) -> Option<Coordinates> {
    let double = |rows: &Vec<Vec<Rational>>| DMatrix::from_fn(rows.len(), rows.len(), |i, j| rows[i][j].to_f64());
    let l = coordinates_of(&double(&matrix.mean), scale, DIGITS[1])?;
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
    Some(Coordinates { l, p, rate })
}
