//! What a claim keeps to at its gain: limits that were asked for, and what the actuator takes.

use serde_json::{Map, Value, json};
use sigmastar_document::clean;
use sigmastar_document::number::{full, upper};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::write_exact;
use sigmastar_lang::spec::Specification;
use sigmastar_prove::certify::Limits;
use sigmastar_theory::derivation::control::Control;

/// What is bounded at the gain of a claim.
pub(super) struct Bounds<'r> {
    /// |e| along the periodic solution.
    pub(super) steady: &'r Enclosure,
    /// |e| on the way.
    pub(super) peak: &'r Enclosure,
    /// What is put out.
    pub(super) control: &'r Control<Enclosure>,
}

/// "|e| <= 0.1 on the way (proved: 0.0997), ..."; nothing where nothing was asked for.
pub(super) fn kept(limits: &Limits, bounds: &Bounds<'_>) -> Option<String> {
    let named = named(limits, bounds).into_iter().filter_map(|(_, of, limit, bound)| {
        limit.map(|limit| of.replace("VALUE", &format!("{limit} (proved: {})", upper(&bound))))
    });
    let all: Vec<String> = named.collect();
    (!all.is_empty()).then(|| all.join(", "))
}

fn named(limits: &Limits, bounds: &Bounds<'_>) -> [(&'static str, &'static str, Option<String>, Enclosure); 3] {
    let text = |limit: &Option<rug::Rational>| limit.as_ref().map(write_exact);
    let largest = &bounds.control.steady + &bounds.control.transient;
    [
        ("steady_error", "|e| <= VALUE along the periodic solution", text(&limits.steady_error), bounds.steady.clone()),
        ("peak_error", "|e| <= VALUE on the way", text(&limits.peak_error), bounds.peak.clone()),
        ("control", "|u| <= VALUE on the way", text(&limits.control), largest),
    ]
}

/// The same as JSON: what was asked for, and what is proved.
pub(super) fn kept_json(limits: &Limits, bounds: &Bounds<'_>) -> Value {
    let named = named(limits, bounds).into_iter();
    let fields: Map<String, Value> = named
        .filter_map(|(name, _, limit, bound)| {
            Some((name.to_owned(), json!({ "asked": limit?, "proved": full(&bound) })))
        })
        .collect();
    if fields.is_empty() { Value::Null } else { fields.into() }
}

/// " and an actuator that takes |u| <= 50 (u does not exceed it from the set)"; nothing where there is none.
pub(super) fn of_actuator(spec: &Specification) -> String {
    spec.actuator.as_ref().map_or_else(String::new, |actuator| {
        format!(" and an actuator that takes |u| <= {} (u does not exceed it from the set)", clean(&actuator.max.text))
    })
}
