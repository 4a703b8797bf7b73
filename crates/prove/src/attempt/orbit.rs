//! The orbit of a plant, the orbits of the cells of a family, and a second P around one, with numbers that are proved (derivation, 11.2).

use rug::Rational;
use sigmastar_decide::orbit::{Around, OrbitNotProved, least_radius};
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_exact::parallel;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::OrbitCurve;
use sigmastar_propose::orbit::{Sampled, doubles};
use sigmastar_theory::evidence::{Coordinates, OrbitProof, ProvedTriple};
use sigmastar_theory::{Undefined, undefined_along};

/// A bound at most this many times a sampled maximum is good enough.
pub(super) const CLOSE: f64 = 6.0;

/// Significant digits of the numbers of the proof.
const DIGITS: u32 = 6;

/// Radii of the tube, relative to the size of the orbit in the coordinates y (or to 1, where it is 0), tried in turn.
const TUBES: [f64; 5] = [1e-4, 1e-6, 1e-8, 1e-2, 1e-10];

/// Those of a family besides.
const WIDE_TUBES: [f64; 3] = [0.05, 0.2, 0.5];

/// What is given up of the sampled rate, tried in turn.
const GIVEN_UP: [f64; 4] = [1e-3, 1e-2, 0.1, 0.5];

/// What is given up of the sampled bounds of a P that varies.
const ROOM: [f64; 3] = [1e-6, 1e-4, 1e-2];

/// A defect that is proved to be so many times what it is at sampled times is not resolved.
const UNRESOLVED: f64 = 100.0;

/// The least defect that is stated, so that it is positive.
const LEAST_DEFECT: f64 = 1e-30;

/// Why a defect that is proved is too large, where that is not `sampled`, the one at sampled times.
fn too_large(around: &Around<'_>, proved: f64, sampled: f64, radius: f64) -> OrbitNotProved {
    if proved <= UNRESOLVED * sampled.max(LEAST_DEFECT) {
        return OrbitNotProved::DefectTooLarge { defect: proved, radius };
    }
    let (s, cells) = around.worst();
    OrbitNotProved::NotResolved { s, cells, sampled, proved }
}

/// p_low and p_up, proved.
fn bounds(around: &Around<'_>, sampled: &Sampled) -> Result<[Rational; 2], OrbitNotProved> {
    let one = || Rational::from(1);
    let unit = around.prove_bounds(&one(), &one());
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
        last = around.prove_bounds(&p_low, &p_up);
        if last.is_ok() {
            return Ok([p_low, p_up]);
        }
    }
    Err(last.err().unwrap_or(OrbitNotProved::Shape("P has no finite eigenvalues")))
}

/// The first operation that has no value along a curve, the nominal one of a family.
#[must_use]
pub fn without_value(plant: &Plant, curve: &OrbitCurve) -> Option<Box<Undefined>> {
    let curve = doubles(&curve.centre);
    undefined_along(plant, |s| curve.at(s).0).map(Box::new)
}

/// The failure, with the operation that has no value along the curve as its cause, where f is not smooth and doubles find one.
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

/// The proof of an orbit near the curve `orbit`, as [`prove_orbit`] gives it, with a rate of at most `most` where that is given. A smaller
/// rate is proved in wider tubes.
///
/// # Errors
/// [`OrbitNotProved`]; nothing is claimed then.
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
    let [p_low, p_up] = bounds(&around, &sampled)?;
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
        failure = failure.or_else(|| Some(too_large(&around, proved, sampled.defect, radius.to_f64())));
    }
    Err(failure.unwrap_or_else(|| too_large(&around, proved, sampled.defect, f64::INFINITY)))
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
    let [p_low, p_up] = bounds(&around, &sampled)?;
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
