//! The proof of the orbit (derivation, 11.2).

use super::cells::{Wave, enclose};
use super::coordinates::Coordinates;
use super::curve::{Curve, MAX_HARMONICS, PRECISION};
use super::defect::{CELLS, CLOSE, ORDER, bound, first_exponent, worst};
use super::failure::OrbitNotProved;
use super::linear::enclosed;
use super::members::Members;
use super::rate::Contraction;
use super::sampled::{Sampled, doubles};
use super::undefined::{Undefined, undefined_along};
use crate::lyapunov::{ProvedTriple, prove_bounds};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_f64, round_rational};
use sigmastar_exact::parallel;
use sigmastar_lang::expr::{Formula, Formulas, PlantVariable, Walk};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{OrbitCurve, PeriodicMatrix};
use sigmastar_matrix::{Symmetric, inverse, is_symmetric};

/// Radii of the tube, relative to the size of the orbit in the coordinates y (or to 1, where it is 0), tried in turn.
const TUBES: [f64; 5] = [1e-4, 1e-6, 1e-8, 1e-2, 1e-10];

/// Those of a family besides.
const WIDE_TUBES: [f64; 3] = [0.05, 0.2, 0.5];

/// What is given up of the sampled rate, tried in turn.
const GIVEN_UP: [f64; 4] = [1e-3, 1e-2, 0.1, 0.5];

/// What is given up of the sampled bounds of a P that varies.
const ROOM: [f64; 3] = [1e-6, 1e-4, 1e-2];

/// Significant digits of the numbers of the proof.
const DIGITS: u32 = 6;

/// A defect that is proved to be so many times what it is at sampled times is not resolved.
const UNRESOLVED: f64 = 100.0;

/// The least defect that is stated, so that it is positive.
const LEAST_DEFECT: f64 = 1e-30;

/// An orbit, proved: x' = f(t,x,0) has exactly one T-periodic solution x_0 with `|L^-1 (x_0 - xb)| <= tube` for all t; it has
/// `|L^-1 (x_0 - xb)| <= radius`; along it P has the rate `alpha` (derivation, 11.2).
///
/// Without states `defect` and `radius` are 0, the others 1 and without meaning.
#[derive(Clone, Debug, PartialEq)]
pub struct OrbitProof {
    /// xb(t).
    pub orbit: OrbitCurve,
    /// eps.
    pub defect: Rational,
    /// rho.
    pub tube: Rational,
    /// r.
    pub radius: Rational,
    /// The rate of P in the tube, in 1/time.
    pub alpha: Rational,
    /// `p_low I <= P(t)`.
    pub p_low: Rational,
    /// `P(t) <= p_up I`.
    pub p_up: Rational,
}

/// A plant, a curve, and coordinates around it, prepared for the proofs.
pub(super) struct Around<'a> {
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
    pub(super) fn new(
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
    fn defect(&self, enough: f64) -> Result<Enclosure, OrbitNotProved> {
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

    /// Why a defect that is proved is too large, where that is not `sampled`, the one at sampled times.
    fn too_large(&self, proved: f64, sampled: f64, radius: f64) -> OrbitNotProved {
        if proved <= UNRESOLVED * sampled.max(LEAST_DEFECT) {
            return OrbitNotProved::DefectTooLarge { defect: proved, radius };
        }
        let curve = self.curve(*CELLS.end(), std::iter::empty());
        let s = worst(&curve, &self.f, &self.slopes, &self.inverse);
        OrbitNotProved::NotResolved { s, cells: curve.cells.count, sampled, proved }
    }

    fn prove_rate(&self, alpha: &Rational, tube: &Rational) -> Result<(), OrbitNotProved> {
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

    fn prove_bounds(&self, p_low: &Rational, p_up: &Rational) -> Result<(), OrbitNotProved> {
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

    /// p_low and p_up, proved.
    fn bounds(&self, sampled: &Sampled) -> Result<[Rational; 2], OrbitNotProved> {
        let one = || Rational::from(1);
        let unit = self.prove_bounds(&one(), &one());
        if unit.is_ok() {
            return Ok([one(), one()]);
        }
        let [least, largest] = sampled.eigenvalues;
        let mut last = unit;
        for room in ROOM {
            let (Some(p_low), Some(p_up)) = (
                round_f64(least * (1.0 - room), DIGITS + 2, Direction::Down),
                round_f64(largest * (1.0 + room), DIGITS + 2, Direction::Up),
            ) else {
                break;
            };
            last = self.prove_bounds(&p_low, &p_up);
            if last.is_ok() {
                return Ok([p_low, p_up]);
            }
        }
        Err(last.err().unwrap_or(OrbitNotProved::Shape("P has no finite eigenvalues")))
    }
}

/// The first operation that has no value along a curve, the nominal one of a family.
#[must_use]
pub fn without_value(plant: &Plant, curve: &OrbitCurve) -> Option<Box<Undefined>> {
    let curve = doubles(&curve.centre);
    undefined_along(plant, |s| curve.at(s).0).map(Box::new)
}

/// The same failure with the operation that has no value along the curve, where doubles find one.
pub(super) fn with_cause(failure: OrbitNotProved, plant: &Plant, orbit: &OrbitCurve) -> OrbitNotProved {
    let OrbitNotProved::NotSmooth { s, .. } = failure else { return failure };
    let cause = without_value(plant, orbit);
    OrbitNotProved::NotSmooth { s: cause.as_ref().map_or(s, |cause| cause.s), cause }
}

/// The proof of an orbit near the curve `orbit`, in these coordinates and with their P.
///
/// # Errors
/// [`OrbitNotProved`]; nothing is claimed then.
pub fn prove_orbit(plant: &Plant, orbit: &OrbitCurve, coordinates: &Coordinates) -> Result<OrbitProof, OrbitNotProved> {
    prove_orbit_at(plant, orbit, coordinates, None)
}

/// The same with a rate that is at most this: a smaller one is proved in wider tubes.
///
/// # Errors
/// As above.
pub fn prove_orbit_at(
    plant: &Plant,
    orbit: &OrbitCurve,
    coordinates: &Coordinates,
    most: Option<&Rational>,
) -> Result<OrbitProof, OrbitNotProved> {
    let around = Around::new(plant, orbit, coordinates)?;
    if plant.states() == 0 {
        let one = || Rational::from(1);
        let none = Rational::new;
        let orbit = orbit.clone();
        return Ok(OrbitProof {
            orbit,
            defect: none(),
            tube: one(),
            radius: none(),
            alpha: one(),
            p_low: one(),
            p_up: one(),
        });
    }
    let sampled = Sampled::new(plant, orbit, coordinates).ok_or(OrbitNotProved::Shape("a number is beyond doubles"))?;
    let proved = around
        .defect(CLOSE * sampled.defect)
        .map_err(|failure| with_cause(failure, plant, orbit))?
        .upper_f64()
        .max(LEAST_DEFECT);
    let defect = round_f64(proved, DIGITS, Direction::Up).ok_or(OrbitNotProved::NotSmooth { s: 0.0, cause: None })?;
    let [p_low, p_up] = around.bounds(&sampled)?;
    let size = if sampled.size > 0.0 { sampled.size } else { 1.0 };
    let mut failure = None;
    for given_up in GIVEN_UP {
        let alpha = round_f64(sampled.rate * (1.0 - given_up), DIGITS, Direction::Down).filter(|alpha| *alpha > 0);
        let Some(alpha) = alpha else {
            let reason = "floating point finds none along the curve".to_owned();
            return Err(OrbitNotProved::Rate { alpha: sampled.rate, tube: 0.0, reason });
        };
        let alpha = most.map_or(alpha.clone(), |most| alpha.min(most.clone()));
        let Some(radius) = least_radius(&defect, &alpha, &p_low, &p_up) else { continue };
        let wide = WIDE_TUBES.iter().filter(|_| plant.is_family());
        let tubes = TUBES.iter().chain(wide).filter_map(|share| round_f64(share * size, 1, Direction::Up));
        for tube in tubes.filter(|tube| *tube > radius) {
            match around.prove_rate(&alpha, &tube) {
                Ok(()) => {
                    let orbit = orbit.clone();
                    return Ok(OrbitProof { orbit, defect, tube, radius, alpha, p_low, p_up });
                }
                Err(reason) => failure = Some(reason),
            }
        }
        failure = failure.or_else(|| Some(around.too_large(proved, sampled.defect, radius.to_f64())));
    }
    Err(failure.unwrap_or_else(|| around.too_large(proved, sampled.defect, f64::INFINITY)))
}

/// The proofs of the orbits of cells of a family, with one alpha, p_low and p_up, which serve in each of them (derivation, 13.2).
///
/// # Errors
/// What is not proved of one of them.
pub fn prove_orbits(
    cells: &[(&Plant, &OrbitCurve)],
    coordinates: &Coordinates,
) -> Result<Vec<OrbitProof>, OrbitNotProved> {
    let proved = |most: Option<&Rational>| -> Result<Vec<OrbitProof>, OrbitNotProved> {
        parallel::map(cells, |(plant, orbit)| prove_orbit_at(plant, orbit, coordinates, most)).into_iter().collect()
    };
    let proofs = proved(None)?;
    let least = proofs.iter().map(|proof| &proof.alpha).min().cloned();
    in_common(proofs).or_else(|_| in_common(proved(least.as_ref())?))
}

/// The smallest rate and the widest bounds are true of each, with a radius in return, which may be too large for its tube.
fn in_common(proofs: Vec<OrbitProof>) -> Result<Vec<OrbitProof>, OrbitNotProved> {
    let alpha = proofs.iter().map(|proof| &proof.alpha).min().cloned().unwrap_or_default();
    let p_low = proofs.iter().map(|proof| &proof.p_low).min().cloned().unwrap_or_default();
    let p_up = proofs.iter().map(|proof| &proof.p_up).max().cloned().unwrap_or_default();
    let of_one = |proof: OrbitProof| {
        let too_large = |radius: f64| OrbitNotProved::DefectTooLarge { defect: proof.defect.to_f64(), radius };
        let radius = least_radius(&proof.defect, &alpha, &p_low, &p_up).ok_or_else(|| too_large(f64::INFINITY))?;
        if radius >= proof.tube {
            return Err(too_large(radius.to_f64()));
        }
        let [alpha, p_low, p_up] = [&alpha, &p_low, &p_up].map(Rational::clone);
        Ok(OrbitProof { radius, alpha, p_low, p_up, ..proof })
    };
    proofs.into_iter().map(of_one).collect()
}

/// The triple of another P in the same coordinates, for a proved orbit: `P' + P J + J^T P <= -2 alpha P` in the same tube.
///
/// # Errors
/// [`OrbitNotProved`]; nothing is claimed of this P then.
pub fn prove_second(
    plant: &Plant,
    proof: &OrbitProof,
    coordinates: &Coordinates,
) -> Result<ProvedTriple, OrbitNotProved> {
    let around = Around::new(plant, &proof.orbit, coordinates)?;
    let sampled = Sampled::new(plant, &proof.orbit, coordinates);
    let sampled = sampled.ok_or(OrbitNotProved::Shape("a number is beyond doubles"))?;
    let [p_low, p_up] = around.bounds(&sampled)?;
    let mut failure = OrbitNotProved::Rate { alpha: sampled.rate, tube: 0.0, reason: "there is none".to_owned() };
    for given_up in GIVEN_UP {
        let alpha = round_f64(sampled.rate * (1.0 - given_up), DIGITS, Direction::Down).filter(|alpha| *alpha > 0);
        let Some(alpha) = alpha else { break };
        match around.prove_rate(&alpha, &proof.tube) {
            Ok(()) => return Ok(ProvedTriple { matrix: coordinates.p.clone(), p_low, p_up, alpha }),
            Err(reason) => failure = reason,
        }
    }
    Err(failure)
}

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
    let coordinates = Coordinates { l: l.to_vec(), p: matrix.clone(), rate: f64::NAN };
    let around = Around::new(plant, &proof.orbit, &coordinates)?;
    around.prove_bounds(p_low, p_up)?;
    around.prove_rate(alpha, &proof.tube)
}

/// A short r with `sqrt(p_up/p_low) eps/alpha <= r`.
fn least_radius(defect: &Rational, alpha: &Rational, p_low: &Rational, p_up: &Rational) -> Option<Rational> {
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
