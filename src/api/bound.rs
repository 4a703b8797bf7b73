//! A bounding specification from the formulas of a plant.

use super::error::{Error, ErrorKind};
use super::subject::Subject;
use super::{json_text, rational};
use rug::Rational;
use sigmastar_exact::number::write_exact;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::Actuator;
use sigmastar_prove::reduction::{PlantRefusal, reduce_by_norms};

/// A bounding specification whose every number is proved of a plant.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct BoundedPlant {
    json: String,
    domain: [String; 2],
    limited: bool,
}

impl BoundedPlant {
    /// The specification (`docs/formats.md`); the bytes are those of `sigmastar bound`.
    #[must_use]
    pub fn to_json(&self) -> &str {
        &self.json
    }

    /// X and E, exactly: the bounds hold for `|y| <= X`, `|e| <= E`, in coordinates y relative to the orbit.
    #[must_use]
    pub fn domain(&self) -> [&str; 2] {
        self.domain.each_ref().map(String::as_str)
    }

    /// Whether the domain ends with that of the plant.
    #[must_use]
    pub fn is_limited(&self) -> bool {
        self.limited
    }
}

/// The bounding specification of a plant by its formulas, on the domain `|y| <= X`, `|e| <= E` of positive rational numbers, or on
/// one that is a quarter larger than what the claim of the plant needs.
///
/// Guarantee: every number in it is proved of the plant.
///
/// # Errors
/// A document that is no plant, a domain that is none, and what could not be proved of the plant.
pub fn bounding_specification(plant: impl Into<Subject>, domain: Option<[&str; 2]>) -> Result<BoundedPlant, Error> {
    let asked: Option<[Rational; 2]> = match domain {
        None => None,
        Some([x, e]) => Some([rational("domain", x)?, rational("domain", e)?]),
    };
    bounds_of(&plant.into().plant()?, asked)
}

/// [`bounding_specification`] of a plant that was read.
///
/// # Errors
/// What could not be proved of the plant.
pub fn bounds_of(plant: &Plant, domain: Option<[Rational; 2]>) -> Result<BoundedPlant, Error> {
    if let Some(middle) = plant.actuator.as_ref().and_then(Actuator::middle) {
        let message = format!(
            "the actuator has limits to both sides: u is measured from {}, and bounding functions know no such number",
            write_exact(&middle)
        );
        let help = "leave `actuator` out, and put the gain of the actuator times that number into `q`";
        return Err(Error::new(ErrorKind::Options, message, help));
    }
    let refused = |refusal: PlantRefusal| Error::documents(&refusal.errors(plant));
    let reduced = reduce_by_norms(plant).map_err(refused)?;
    let bounded = sigmastar_studies::bounding::bounding_specification(plant, &reduced.spec, domain).map_err(refused)?;
    Ok(BoundedPlant {
        json: json_text(&bounded.document),
        domain: bounded.domain.each_ref().map(write_exact),
        limited: bounded.limited,
    })
}
