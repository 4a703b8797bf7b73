//! Rule: an actuator that saturates (docs/mathematics.md, section 13.5), and what a claim says of it.
//!
//! Guarantee: `max > 0`. What is put out acts as it is up to `max` in size, and as `max` beyond. A claim with it is about one gain, names
//! the same `max`, and is proved with C6 ([`crate::rules::control`]).

use crate::constant::{Constant, positive_with};
use crate::expr::Named;
use crate::json::{Field, Fields};
use crate::range::{both, is_same};
use crate::verdict::{Outcome, demand};

/// The name of the rule.
pub const RULE: &str = "actuator";

/// The actuator of a file.
#[derive(Clone, Debug)]
pub struct Actuator {
    /// The greatest size of what is put out that it takes.
    pub max: Constant,
}

impl Actuator {
    fn read_part(field: &Field<'_>, constants: &[Named]) -> Outcome<Actuator> {
        let mut fields = field.fields()?;
        let max = positive_with(&fields.required("max")?, "max", constants)?;
        fields.finish().map(|()| Actuator { max })
    }
}

/// Takes `actuator` out of a file, if it is there. Names of a plant's constants may stand in its number.
pub fn read(file: &mut Fields<'_>, constants: &[Named]) -> Outcome<Option<Actuator>> {
    file.optional("actuator").map(|field| Actuator::read_part(&field, constants)).transpose()
}

/// That a claim names the actuator of the file, and names none where the file has none.
pub fn agrees(asked: Option<&Actuator>, claimed: Option<&Field<'_>>, claim: &str) -> Outcome<()> {
    let Some((asked, field)) = both(RULE, "actuator", asked, claimed, claim)? else { return Ok(()) };
    let mut fields = field.fields()?;
    let stated = fields.required("max")?;
    let same = is_same(&Constant::read(&stated)?, &asked.max);
    demand(Some(same), RULE, &stated.pointer, format!("it is that of the file, {}", asked.max.text))?;
    fields.finish()
}

/// What a claim is about besides, where there is one.
pub fn in_words(actuator: Option<&Actuator>) -> String {
    actuator.map_or_else(String::new, |actuator| {
        format!(
            ", with an actuator that takes what is put out up to {} in size and cuts off what is beyond (which nothing is from the set below)",
            actuator.max.text
        )
    })
}
