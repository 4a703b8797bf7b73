//! Rule: an actuator that saturates (docs/mathematics.md, section 13.5), and what a claim says of it.
//!
//! Guarantee: `max > 0`. What is put out acts as it is up to `max` in size, and as `max` beyond. A claim with it is about one gain, names
//! the same `max`, and is proved with C6 ([`crate::rules::control`]).

use crate::constant::{Constant, positive_with};
use crate::expr::Named;
use crate::json::{Field, Fields};
use crate::range::{both, states};
use crate::verdict::Outcome;

/// The name of the rule.
pub const RULE: &str = "actuator";

/// The actuator of a file.
#[derive(Clone, Debug)]
pub struct Actuator {
    /// The greatest size of what is put out that it takes.
    pub max: Constant,
}

/// Takes `actuator` out of a file, if it is there. Names of a plant's constants may stand in its number.
pub fn read(file: &mut Fields<'_>, constants: &[Named]) -> Outcome<Option<Actuator>> {
    let max = |fields: &mut Fields<'_>| positive_with(&fields.required("max")?, "max", constants);
    file.part("actuator", |field| field.object(max).map(|max| Actuator { max }))
}

/// That a claim names the actuator of the file, and names none where the file has none.
pub fn agrees(asked: Option<&Actuator>, claimed: Option<&Field<'_>>, claim: &str) -> Outcome<()> {
    let Some((asked, field)) = both(RULE, "actuator", asked, claimed, claim)? else { return Ok(()) };
    field.object(|fields| states(fields, "max", &asked.max, RULE))
}

/// What a claim is about besides, where there is one.
pub fn in_words(actuator: Option<&Actuator>) -> String {
    actuator.map_or_else(String::new, |actuator| {
        let max = &actuator.max.words;
        let beyond = "and cuts off what is beyond (which nothing is from the set below)";
        format!(", with an actuator that takes what is put out up to {max} in size {beyond}")
    })
}
