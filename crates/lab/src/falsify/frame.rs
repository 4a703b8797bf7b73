//! The norm of a claim about one plant: deviations `y = L^-1 (x - x_0(t))` (derivation, 11).

use nalgebra::{DMatrix, DVector};
use rug::Rational;
use sigmastar_exact::number::Portable;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{OfPlant, ProvedCell, TrigonometricVector};
use std::f64::consts::TAU;

/// How far above sigma* a trial is.
pub(super) const ABOVE: f64 = 1.0 + 1e-6;

/// A plant of its own, and the coordinates of the claim about it.
#[derive(Clone, Debug)]
pub struct OwnPlant {
    /// The plant.
    pub plant: Plant,
    coordinates: DMatrix<f64>,
    inverse: DMatrix<f64>,
    cells: Vec<ProvedCell>,
    mean: DVector<f64>,
    harmonics: Vec<[DVector<f64>; 2]>,
    /// How far x_0 may be from the approximation, in the norm of y.
    radius: f64,
}

impl OwnPlant {
    /// The plant of a certificate; `None` where its L is singular in floating point.
    #[must_use]
    pub fn new(plant: Plant, proved: &OfPlant) -> Option<OwnPlant> {
        let n = proved.states();
        let coordinates = DMatrix::from_fn(n, n, |i, j| proved.coordinates[i][j].to_f64());
        let inverse = if n == 0 { coordinates.clone() } else { coordinates.clone().try_inverse()? };
        let (mean, harmonics, radius) = of_member(&proved.cells, &plant.parameters.nominal())?;
        Some(OwnPlant { plant, coordinates, inverse, cells: proved.cells.clone(), mean, harmonics, radius })
    }

    /// The member of its family with these values of the parameters with intervals.
    pub(super) fn member(&self, values: &[Rational]) -> OwnPlant {
        let plant = self.plant.member(values);
        match of_member(&self.cells, values) {
            Some((mean, harmonics, radius)) => OwnPlant { plant, mean, harmonics, radius, ..self.clone() },
            // Outside of the box nothing is claimed.
            None => OwnPlant { plant, ..self.clone() },
        }
    }

    /// xb at t = s T.
    fn orbit(&self, s: f64) -> DVector<f64> {
        let mut x = self.mean.clone();
        for (k, [cos, sin]) in (1..).zip(&self.harmonics) {
            let (sine, cosine) = libm::sincos(TAU * (f64::from(k) * s).fract());
            x += cos * cosine + sin * sine;
        }
        x
    }

    /// The state with this deviation at t = s T.
    pub(super) fn state(&self, s: f64, y: &[f64]) -> Vec<f64> {
        (self.orbit(s) + &self.coordinates * DVector::from_column_slice(y)).as_slice().to_vec()
    }

    /// A state at t = s T whose deviation from x_0 is no larger than this one, wherever within its radius x_0 is.
    fn state_within(&self, s: f64, y: &[f64]) -> Vec<f64> {
        let size = DVector::from_column_slice(y).norm();
        let share = if size > 0.0 { (1.0 - self.radius / size).max(0.0) } else { 1.0 };
        self.state(s, &y.iter().map(|part| share * part).collect::<Vec<_>>())
    }

    /// Moves the x that a start begins with so that its deviation from x_0 is no larger than it says, wherever within its radius x_0 is.
    pub(super) fn bring_within(&self, s: f64, start: &mut [f64]) {
        let x = &mut start[..self.plant.states()];
        x.copy_from_slice(&self.state_within(s, x));
    }

    /// |y| of a state at t = s T, at least: the approximation of the orbit is taken, and what it may be away from x_0 left out.
    pub(super) fn distance(&self, s: f64, x: &[f64]) -> f64 {
        (self.norm((DVector::from_column_slice(x) - self.orbit(s)).as_slice()) - self.radius).max(0.0)
    }

    /// The largest |y| of a difference of two states whose components are at most 1.
    pub(super) fn spread(&self) -> f64 {
        self.inverse.row_iter().map(|row| row.abs().sum().portable_powi(2)).sum::<f64>().sqrt()
    }

    /// |y| of a difference of two states.
    pub(super) fn norm(&self, difference: &[f64]) -> f64 {
        (&self.inverse * DVector::from_column_slice(difference)).norm()
    }

    /// y of a difference of two states.
    pub(super) fn deviation(&self, difference: &[f64]) -> Vec<f64> {
        (&self.inverse * DVector::from_column_slice(difference)).as_slice().to_vec()
    }

    /// Gains of the trials, as multiples of sigma*: just above it, and well above it.
    pub(super) fn gain(trial: u64) -> f64 {
        match trial % 3 {
            1 => ABOVE,
            2 => 1.5,
            _ => 10f64.portable_pow(0.75),
        }
    }
}

/// xb of a member in doubles, that of the first cell that it lies in, and how far x_0 may be from it.
fn of_member(cells: &[ProvedCell], values: &[Rational]) -> Option<Curve> {
    let ProvedCell { parameters, orbit, .. } = cells.iter().find(|cell| cell.parameters.contain(values))?;
    let (mean, harmonics) = doubles(&orbit.approximation.at(&parameters.deviations(values)));
    Some((mean, harmonics, orbit.radius.to_f64()))
}

/// Mean, harmonics and r.
type Curve = (DVector<f64>, Vec<[DVector<f64>; 2]>, f64);

/// The mean and the harmonics of a curve in doubles.
fn doubles(TrigonometricVector { mean, harmonics }: &TrigonometricVector) -> (DVector<f64>, Vec<[DVector<f64>; 2]>) {
    let vector = |values: &Vec<Rational>| DVector::from_iterator(values.len(), values.iter().map(Rational::to_f64));
    (vector(mean), harmonics.iter().map(|pair| pair.each_ref().map(vector)).collect())
}
