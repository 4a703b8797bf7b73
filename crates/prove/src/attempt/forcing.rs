//! The harmonics of q(t, x_0, 0) with their rest proved (derivation, 11.4).

use super::orbit::{CLOSE, with_cause};
use rug::Rational;
use sigmastar_decide::orbit::{Around, OrbitNotProved, rests};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{ProvedForcing, Wave};
use sigmastar_propose::orbit::{propose_forcing, sampled_rests};
use sigmastar_theory::evidence::{Coordinates, OrbitProof};

/// Significant digits of the bounds of the rest.
const DIGITS: u32 = 6;

/// The harmonics of q(t, x_0, 0) for a proved orbit, with the rest proved.
///
/// # Errors
/// [`OrbitNotProved`]; nothing is claimed then.
pub fn prove_forcing(
    plant: &Plant,
    coordinates: &Coordinates,
    proved: &OrbitProof,
) -> Result<ProvedForcing, OrbitNotProved> {
    let around = Around::new(plant, &proved.orbit, coordinates)?;
    let none = OrbitNotProved::Shape("q(t,xb,0) is not finite in floating point");
    let (Wave { mean, harmonics }, sensitivities) =
        propose_forcing(plant, &proved.orbit).ok_or_else(|| none.clone())?;
    let mut forcing = ProvedForcing { mean, harmonics, sensitivities, rest: Rational::new(), rest_t: Rational::new() };
    let sizes = sampled_rests(plant, &proved.orbit, &forcing);
    let found = rests(&around, &forcing, proved, sizes.map(|size| CLOSE * size));
    let [rest, rest_t] = found.map_err(|failure| with_cause(failure, plant, &proved.orbit))?;
    let up = |bound: &Enclosure| round_f64(bound.upper_f64(), DIGITS, Direction::Up).ok_or_else(|| none.clone());
    forcing.rest = up(&rest)?;
    forcing.rest_t = up(&rest_t)?;
    Ok(forcing)
}
