//! What sampled times say of a rational curve and its coordinates, in doubles: from where the numbers to be decided are taken.

use super::field::Field;
use super::series::FloatSeries;
use super::shape::decay;
use nalgebra::{DMatrix, DVector};
use rug::Rational;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Interval, OrbitCurve, PeriodicMatrix, TrigonometricVector};
use sigmastar_theory::evidence::Coordinates;

/// Times for each harmonic, and besides.
const PER_HARMONIC: usize = 8;
const LEAST: usize = 64;

/// For each named parameter of a family the larger sampled defect of the two members at its ends, the others at their nominal values: what
/// it adds to the defect; infinite where that is not finite. Floating point.
#[must_use]
pub fn defects_by_parameter(plant: &Plant, orbit: &OrbitCurve, coordinates: &Coordinates) -> Vec<f64> {
    let defect = |values: &[Rational]| {
        let curve = orbit.at(&plant.parameters.deviations(values));
        let sampled = Sampled::of_one(&plant.member(values), &curve, coordinates);
        sampled.map_or(f64::INFINITY, |sampled| sampled.defect)
    };
    let nominal = plant.parameters.nominal();
    let of_one = |(i, (_, interval)): (usize, (&str, &Interval))| {
        let at = |end: &Rational| {
            let mut values = nominal.clone();
            values[i] = end.clone();
            defect(&values)
        };
        at(&interval.low).max(at(&interval.high))
    };
    plant.parameters.named_intervals().enumerate().map(of_one).collect()
}

/// Sizes at sampled times, in the coordinates y.
#[derive(Clone, Debug)]
pub struct Sampled {
    /// The largest `|L^-1 (f(t,xb,0) - xb')|`.
    pub defect: f64,
    /// The largest `|L^-1 xb|`.
    pub size: f64,
    /// The least rate of P.
    pub rate: f64,
    /// The least and the largest eigenvalue of P.
    pub eigenvalues: [f64; 2],
}

/// The curve in doubles.
#[must_use]
pub fn doubles(vector: &TrigonometricVector) -> FloatSeries {
    let double = |values: &Vec<Rational>| values.iter().map(Rational::to_f64).collect();
    let harmonics = vector.harmonics.iter().map(|pair| pair.each_ref().map(double)).collect();
    FloatSeries { mean: double(&vector.mean), harmonics }
}

/// A matrix that varies, with its entries as the components of a series, column by column.
fn entries(matrix: &PeriodicMatrix) -> FloatSeries {
    let n = matrix.mean.len();
    let flat = |rows: &Vec<Vec<Rational>>| (0..n * n).map(|at| rows[at % n][at / n].to_f64()).collect();
    let harmonics = matrix.harmonics.iter().map(|pair| pair.each_ref().map(flat)).collect();
    FloatSeries { mean: flat(&matrix.mean), harmonics }
}

impl Sampled {
    /// The sizes of all members that are looked at. `None` where numbers are not finite, or P is not positive definite. The parts fit
    /// together.
    #[must_use]
    pub fn new(plant: &Plant, orbit: &OrbitCurve, coordinates: &Coordinates) -> Option<Sampled> {
        let members = plant.parameters.looked_at();
        let of_member = |values: &Vec<Rational>| {
            let curve = orbit.at(&plant.parameters.deviations(values));
            Sampled::of_one(&plant.member(values), &curve, coordinates)
        };
        members.iter().map(of_member).reduce(|one, other| {
            let (one, other) = (one?, other?);
            Some(Sampled {
                defect: one.defect.max(other.defect),
                size: one.size.max(other.size),
                rate: one.rate.min(other.rate),
                eigenvalues: one.eigenvalues,
            })
        })?
    }

    fn of_one(plant: &Plant, orbit: &TrigonometricVector, coordinates: &Coordinates) -> Option<Sampled> {
        let mut field = Field::new(plant);
        let n = field.states();
        let units = field.units().to_vec();
        let l = DMatrix::from_fn(n, n, |i, j| coordinates.l[i][j].to_f64() / units[i]);
        let inverse = l.clone().try_inverse()?;
        let (series, p) = (field.own(&doubles(orbit)), entries(&coordinates.p));
        let count = LEAST + PER_HARMONIC * (series.harmonics.len() + p.harmonics.len());
        let mut sampled = Sampled { defect: 0.0, size: 0.0, rate: f64::INFINITY, eigenvalues: [f64::INFINITY, 0.0] };
        for j in 0..count {
            let s = j as f64 / count as f64;
            let ((x, slope), (p, p_slope)) = (series.at(s), p.at(s));
            field.set(s, &x, 0.0);
            let difference = field.f() - DVector::from_vec(slope) / field.period;
            sampled.defect = sampled.defect.max((&inverse * difference).norm());
            sampled.size = sampled.size.max((&inverse * DVector::from_vec(x)).norm());
            let [p, p_slope] = [p, p_slope].map(|values| DMatrix::from_vec(n, n, values));
            let root = p.clone().cholesky()?.l();
            let root_inverse = root.clone().try_inverse()?;
            // With P = R R^T: R^-1 (P' + P J + J^T P) R^-T is twice the symmetric part of R^-1 (P'/2 + P J) R^-T.
            let jacobian = &inverse * field.jacobian() * &l;
            let half = p_slope / (2.0 * field.period) + &p * jacobian;
            sampled.rate = sampled.rate.min(decay(&(&root_inverse * half * root_inverse.transpose()))?);
            let values = p.symmetric_eigenvalues();
            sampled.eigenvalues = [sampled.eigenvalues[0].min(values.min()), sampled.eigenvalues[1].max(values.max())];
        }
        let finite = [sampled.defect, sampled.size, sampled.rate].iter().all(|value| value.is_finite());
        finite.then_some(sampled)
    }
}
