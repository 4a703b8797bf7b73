//! An orbit and its numbers, or a second P around it, decided (derivation, 11.2).

use super::around::Around;
use super::cells::PRECISION;
use super::not_proved::OrbitNotProved;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_rational};
use sigmastar_lang::plant::Plant;
use sigmastar_theory::evidence::{Coordinates, OrbitProof, ProvedTriple};

/// Significant digits of a radius.
const DIGITS: u32 = 6;

/// Decides such a triple again, in the coordinates L.
///
/// # Errors
/// The first inequality that is not proved.
pub fn decide_second(
    plant: &Plant,
    proof: &OrbitProof,
    l: &[Vec<Rational>],
    ProvedTriple { matrix, p_low, p_up, alpha }: &ProvedTriple,
) -> Result<(), OrbitNotProved> {
    if [alpha, p_low].iter().any(|number| **number <= 0) || p_up < p_low {
        return Err(OrbitNotProved::Shape("alpha or p_low of existence is not positive, or p_up is below p_low"));
    }
    let coordinates = Coordinates { l: l.to_vec(), p: matrix.clone() };
    let around = Around::new(plant, &proof.orbit, &coordinates)?;
    around.prove_bounds(p_low, p_up)?;
    around.prove_rate(alpha, &proof.tube)
}

/// A short r with `sqrt(p_up/p_low) eps/alpha <= r`.
#[must_use]
pub fn least_radius(defect: &Rational, alpha: &Rational, p_low: &Rational, p_up: &Rational) -> Option<Rational> {
    let ratio = Enclosure::from_rational(&Rational::from(p_up / p_low), PRECISION).sqrt();
    let least = ratio * Enclosure::from_rational(&Rational::from(defect / alpha), PRECISION);
    Some(round_rational(&least.upper_rational()?, DIGITS, Direction::Up))
}

/// Decides a proved orbit again, from its numbers alone.
///
/// # Errors
/// The first inequality of 11.2 that is not proved; nothing is said about its truth.
pub fn decide_orbit(plant: &Plant, coordinates: &Coordinates, proved: &OrbitProof) -> Result<(), OrbitNotProved> {
    let OrbitProof { orbit, defect, tube, radius, alpha, p_low, p_up } = proved;
    let around = Around::new(plant, orbit, coordinates)?;
    if plant.states() == 0 {
        return Ok(());
    }
    if [defect, tube, radius, alpha, p_low].iter().any(|number| **number <= 0) || p_up < p_low {
        return Err(OrbitNotProved::Shape("eps, rho, r, alpha or p_low is not positive, or p_up is below p_low"));
    }
    // p_up eps^2 <= p_low (alpha r)^2, exactly.
    let reached = Rational::from(alpha * radius);
    let too_large = Rational::from(defect.square_ref()) * p_up > reached.square() * p_low;
    if too_large || radius >= tube {
        return Err(OrbitNotProved::DefectTooLarge { defect: defect.to_f64(), radius: radius.to_f64() });
    }
    around.prove_bounds(p_low, p_up)?;
    let found = around.defect(defect.to_f64() * (1.0 - f64::EPSILON))?;
    if !found.le(&Enclosure::from_rational(defect, PRECISION)).is_true() {
        return Err(OrbitNotProved::Defect { found: found.upper_f64(), stated: defect.to_f64() });
    }
    around.prove_rate(alpha, tube)
}
