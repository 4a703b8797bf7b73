//! What is decided around a given curve in given coordinates: the defect, the contraction in a tube, and the bounds of P (derivation, 11.2).

use super::cells::{Wave, enclose};
use super::curve::{Curve, PRECISION};
use super::defect::{CELLS, ORDER, bound, first_exponent, worst};
use super::linear::enclosed;
use super::members::Members;
use super::not_proved::OrbitNotProved;
use super::rate::Contraction;
use crate::lyapunov::prove_bounds;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::expr::{Formula, Formulas, PlantVariable, Walk};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{OrbitCurve, PeriodicMatrix};
use sigmastar_matrix::{Symmetric, inverse, is_symmetric};
use sigmastar_theory::evidence::{Coordinates, MAX_HARMONICS};

/// A plant, a curve, and coordinates around it, prepared for the proofs.
pub struct Around<'a> {
    pub(super) plant: &'a Plant,
    pub(super) members: Members,
    f: Walk,
    f_and_jacobian: Walk,
    /// The rows of df/dx, and then df/dp for each parameter.
    slopes: Walk,
    pub(super) l: Vec<Vec<Enclosure>>,
    inverse: Vec<Vec<Enclosure>>,
    matrix: &'a PeriodicMatrix,
    p: Symmetric<Wave>,
}

impl<'a> Around<'a> {
    /// Nothing is believed of the parts but their types.
    pub fn new(
        plant: &'a Plant,
        orbit: &OrbitCurve,
        coordinates: &'a Coordinates,
    ) -> Result<Around<'a>, OrbitNotProved> {
        let n = plant.states();
        if orbit.sensitivities.len() != plant.parameters.intervals().count() {
            return Err(OrbitNotProved::Shape("the orbit has not one sensitivity for each parameter with an interval"));
        }
        if orbit.parts().flat_map(|curve| curve.parts()).any(|vector| vector.len() != n) {
            return Err(OrbitNotProved::Shape("a vector of the orbit has another length"));
        }
        let matrix = &coordinates.p;
        if orbit.harmonics().max(matrix.harmonics.len()) > MAX_HARMONICS {
            return Err(OrbitNotProved::Shape("too many harmonics"));
        }
        if !matrix.parts().all(|rows| is_symmetric(rows, n)) {
            return Err(OrbitNotProved::Shape("P is not symmetric of the order of the plant"));
        }
        if coordinates.l.len() != n || coordinates.l.iter().any(|row| row.len() != n) {
            return Err(OrbitNotProved::Shape("L is not a square matrix of the order of the plant"));
        }
        let inverted = inverse(&coordinates.l).ok_or(OrbitNotProved::Shape("L is singular"))?;
        let mut formulas = Formulas::new();
        let f: Vec<Formula> = plant.f.iter().map(|f| formulas.insert(f)).collect();
        let columns: Vec<Vec<Formula>> = (0..n).map(|j| formulas.derivatives(&f, PlantVariable::State(j))).collect();
        let jacobian = (0..n).flat_map(|i| columns.iter().map(move |column| column[i]));
        let jacobian: Vec<Formula> = jacobian.collect();
        let all: Vec<Formula> = f.iter().chain(&jacobian).copied().collect();
        let mut slopes = jacobian;
        for i in 0..orbit.sensitivities.len() {
            slopes.extend(formulas.derivatives(&f, PlantVariable::Parameter(i)));
        }
        Ok(Around {
            plant,
            members: Members::new(plant, orbit),
            f: formulas.walk(&f),
            f_and_jacobian: formulas.walk(&all),
            slopes: formulas.walk(&slopes),
            l: enclosed(&coordinates.l, PRECISION),
            inverse: enclosed(&inverted, PRECISION),
            matrix,
            p: Symmetric::from_fn(n, |i, j| matrix.map(|rows| enclose(&rows[i][j]))),
        })
    }

    /// The curve over `2^exponent` cells, where other waves may be expanded as well.
    pub(super) fn curve<'w>(&'w self, exponent: u32, others: impl Iterator<Item = &'w Wave>) -> Curve {
        Curve::new(&self.members, others, self.plant.period.nominal(), exponent, ORDER + 1)
    }

    pub(super) fn harmonics(&self) -> usize {
        self.members.harmonics()
    }

    /// A bound of the defect, with more cells while it is above `enough`: that of the first number of cells that gives at most
    /// this, or the least.
    pub fn defect(&self, enough: f64) -> Result<Enclosure, OrbitNotProved> {
        let mut best: Result<Enclosure, OrbitNotProved> = Err(OrbitNotProved::NotSmooth { s: 0.0, cause: None });
        for exponent in first_exponent(self.harmonics())..=*CELLS.end() {
            let found = bound(&self.curve(exponent, std::iter::empty()), &self.f, &self.slopes, &self.inverse);
            let done = found.as_ref().is_ok_and(|bound| bound.upper_f64() <= enough);
            best = match (best, found) {
                (Ok(best), Ok(found)) => Ok(if found.upper() < best.upper() { found } else { best }),
                (Ok(best), Err(_)) => Ok(best),
                (Err(_), found) => found,
            };
            if done {
                break;
            }
        }
        best
    }

    /// The middle of the cell with the largest bound of the defect, in periods, and the number of cells.
    #[must_use]
    pub fn worst(&self) -> (f64, usize) {
        let curve = self.curve(*CELLS.end(), std::iter::empty());
        (worst(&curve, &self.f, &self.slopes, &self.inverse), curve.cells.count)
    }

    /// Proves the rate `alpha` of P in the tube of radius `tube` (derivation, 11.2).
    ///
    /// # Errors
    /// It is not proved; nothing is said about its truth.
    pub fn prove_rate(&self, alpha: &Rational, tube: &Rational) -> Result<(), OrbitNotProved> {
        let contraction = Contraction {
            period: self.plant.period.nominal(),
            members: &self.members,
            walk: &self.f_and_jacobian,
            l: &self.l,
            inverse: &self.inverse,
            p: &self.p,
        };
        let [rate, rho] = [alpha, tube].map(|value| Enclosure::from_rational(value, PRECISION));
        contraction.prove(&rate, &rho).map_err(|reason| OrbitNotProved::Rate {
            alpha: alpha.to_f64(),
            tube: tube.to_f64(),
            reason,
        })
    }

    /// Proves `p_low I <= P(t) <= p_up I` for every t.
    ///
    /// # Errors
    /// It is not proved; nothing is said about its truth.
    pub fn prove_bounds(&self, p_low: &Rational, p_up: &Rational) -> Result<(), OrbitNotProved> {
        if *p_low <= 0 {
            return Err(OrbitNotProved::Shape("p_low is not positive"));
        }
        // Exactly, as no enclosure can where the two are equal.
        if p_low == p_up && self.matrix.harmonics.is_empty() {
            let multiple = self.matrix.mean.iter().enumerate().all(|(i, row)| {
                row.iter().enumerate().all(|(j, entry)| if i == j { entry == p_low } else { entry.is_zero() })
            });
            if multiple {
                return Ok(());
            }
        }
        prove_bounds(self.matrix, p_low, p_up, PRECISION).map_err(|reason| OrbitNotProved::Bounds(reason.to_string()))
    }
}
