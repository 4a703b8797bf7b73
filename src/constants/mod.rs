//! The constants of the paper in three derivations, each a small function of enclosures.
//!
//! *printed*: the paper's formulas to the letter, evaluated and compared, never certified; *repaired*: the paper's
//! architecture with the smallest sound repair of each formula; *sharp*: sections 2-6 of the derivation.

pub mod condition;
pub mod contraction;
pub mod data;
pub mod existence;
pub mod gains;
pub mod relative_degree;
pub mod sharp;
pub mod stability;

use crate::enclosure::Enclosure;
use crate::spec::model::InitialSet;
use condition::Condition;
use data::Data;

/// The initial set (X_0, E_0, Z_0) that the specification asks for, given X_p, E_p and Z.
///
/// `paper`: 2 X_p, 2 E_p, 2 (Z + Nbar E_p); `at-rest`: the user's X_0, E_0 or 2 X_p, 2 E_p, and Z_0 = 0; `box`: the
/// user's numbers.
#[must_use]
pub fn required_set(data: &Data<'_>, x_p: &Enclosure, e_p: &Enclosure, z: &Enclosure) -> [Enclosure; 3] {
    let user = |constant: &crate::spec::model::Constant| constant.enclose(data.precision);
    match &data.spec.initial_set {
        InitialSet::Paper => [2 * x_p, 2 * e_p, 2 * (z + &data.n_bar * e_p)],
        InitialSet::AtRest { x0, e0 } => {
            [x0.as_ref().map_or_else(|| 2 * x_p, user), e0.as_ref().map_or_else(|| 2 * e_p, user), data.zero()]
        }
        InitialSet::Box { x0, e0, z0 } => [user(x0), user(e0), user(z0)],
    }
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
