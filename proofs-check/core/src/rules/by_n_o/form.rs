//! Parts of a trial that stand in more than one place of it: a box, and a form on it (docs/mathematics.md, section 14.4).

use super::claimed::RULE;
use crate::json::Fields;
use crate::rules::inequality::{Extent, Kind, Metric, number};
use crate::verdict::{Outcome, bad, demand};
use rug::Rational;

/// The most forms.
pub(super) const MOST_FORMS: usize = 3;

/// A number of a plant with states that is not negative, or above 0; else 0, and no such field.
pub(super) fn of_states(fields: &mut Fields<'_>, name: &str, positive: bool, states: usize) -> Outcome<Rational> {
    if states > 0 { number(fields, name, positive) } else { Ok(Rational::new()) }
}

/// D_x, 0 without states, and D_e of the part `box`.
pub(super) fn radii(fields: &mut Fields<'_>, states: usize) -> Outcome<[Rational; 2]> {
    let field = fields.required("box")?;
    field.object(|fields| Ok([of_states(fields, "x", true, states)?, number(fields, "e", true)?]))
}

/// A form, whose numbers have the names of a near metric; in continuous time, or at samples, where it has no p but zeros.
pub(super) fn form(fields: &mut Fields<'_>, (states, continuous): (usize, bool)) -> Outcome<(Metric, Extent)> {
    let pointer = fields.pointer.clone();
    let none = Rational::new();
    let metric = Metric::read(fields, (Kind::Joint, !continuous), Some(true), [&none; 2])?;
    if !continuous && metric.cross.iter().any(|entry| !entry.is_zero()) {
        return bad(&format!("{pointer}/p"), "expected zeros, of a form at samples");
    }
    if metric.cross.len() != states {
        return bad(&format!("{pointer}/P"), "expected a row for each state");
    }
    let Some(extent) = metric.extent.clone() else { return bad(&pointer, "expected its extent") };
    for (name, what, holds) in extent.is_of(&metric) {
        demand(Some(holds), RULE, &format!("{pointer}/{name}"), what)?;
    }
    Ok((metric, extent))
}
