//! The constants of the paper in three derivations, each a small function of enclosures.
//!
//! *printed*: the paper's formulas to the letter, evaluated and compared, never certified; *repaired*: the paper's
//! architecture with the smallest sound repair of each formula; *sharp*: sections 2-6 of the derivation.

pub mod condition;
pub mod consequences;
pub mod contraction;
pub mod exact_regulation;
pub mod existence;
pub mod gains;
pub mod printed;
pub mod relative_degree;
pub mod repaired;
pub mod sharp;
pub mod stability;
pub mod table;

use crate::data::Data;
use crate::enclosure::Enclosure;
use crate::spec::model::{Constant, InitialSet};
use condition::Condition;
use rug::Rational;
use sharp::ClaimedSet;

/// The claimed set must cover what the specification asks for: X_0, E_0, Z_0 at least
/// `paper`: 2 X_p, 2 E_p, 2 (Z + Nbar E_p); `at-rest`: the user's X_0, E_0 or 2 X_p, 2 E_p, and 0; `box`: the user's.
///
/// Each condition is written "required - claimed <= 0", with the difference of rationals taken exactly, so that
/// equality is decided.
#[must_use]
pub fn set_conditions(
    data: &Data<'_>,
    set: &ClaimedSet,
    x_p: &Rational,
    e_p: &Rational,
    z: &Enclosure,
) -> Vec<Condition> {
    let exact = |required: &Rational, claimed: &Rational| data.rational(&Rational::from(required - claimed));
    let user = |constant: &Constant, claimed: &Rational| match constant.as_rational() {
        Some(required) => exact(required, claimed),
        None => constant.enclose(data.precision) - data.rational(claimed),
    };
    let twice = |value: &Rational| Rational::from(value * 2u32);
    let excess = match &data.spec.initial_set {
        InitialSet::Paper => {
            let z0 = 2 * (z + &data.n_bar * data.rational(e_p));
            [exact(&twice(x_p), &set.x0), exact(&twice(e_p), &set.e0), z0 - data.rational(&set.z0)]
        }
        InitialSet::AtRest { x0, e0 } => [
            x0.as_ref().map_or_else(|| exact(&twice(x_p), &set.x0), |x0| user(x0, &set.x0)),
            e0.as_ref().map_or_else(|| exact(&twice(e_p), &set.e0), |e0| user(e0, &set.e0)),
            exact(&Rational::new(), &set.z0),
        ],
        InitialSet::Box { x0, e0, z0 } => [user(x0, &set.x0), user(e0, &set.e0), user(z0, &set.z0)],
    };
    ["X0", "E0", "Z0"]
        .iter()
        .zip(excess)
        .map(|(name, excess)| {
            Condition::at_most("set", format!("the required {name} - the claimed {name} <= 0"), excess, data.zero())
        })
        .collect()
}

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
