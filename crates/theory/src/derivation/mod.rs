//! The constants of the paper in three derivations, each formula once, generic over [`sigmastar_exact::real::Real`].
//!
//! *printed*: the paper's formulas to the letter, evaluated and compared, never certified; *repaired*: the paper's
//! architecture with the smallest sound repair of each formula; *sharp*: sections 2, 3, 5, 6 and 10 of the
//! derivation.

pub mod consequences;
pub mod contraction;
pub mod control;
pub mod energy;
pub mod exact_regulation;
pub mod existence;
pub mod gains;
pub mod harmonics;
pub mod initial_set;
pub mod joint;
pub mod lyapunov_matrix;
pub mod matrix_inequality;
pub mod mean_squares;
pub mod mistuned;
pub mod paths;
pub mod printed;
pub mod relative_degree;
pub mod repaired;
pub mod sampled;
pub mod sampled_form;
pub mod sharp;
pub mod stability;
pub mod table;
pub mod targets;
pub mod uniqueness;

pub use crate::condition;

use crate::data::Data;
use condition::Condition;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;

/// (X, E) <= the domain of the specification; none where the bounding functions hold everywhere.
#[must_use]
pub fn domain_conditions(data: &Data<'_>, x: Enclosure, e: Enclosure) -> Vec<Condition> {
    data.spec.domain.as_ref().map_or_else(Vec::new, |domain| {
        vec![
            Condition::at_most("domain", "largest X used <= domain X", x, domain.x.enclose(data.precision)),
            Condition::at_most("domain", "largest E used <= domain E", e, domain.e.enclose(data.precision)),
        ]
    })
}

/// The signs that a derivation needs of its witness: one condition "0 < number" for each that is not positive.
#[must_use]
pub fn sign_conditions(data: &Data<'_>, named: &[(&str, &Rational)]) -> Vec<Condition> {
    named
        .iter()
        .filter(|(_, value)| **value <= 0)
        .map(|(name, value)| Condition::less("sign", format!("0 < {name}"), data.zero(), data.rational(value)))
        .collect()
}
