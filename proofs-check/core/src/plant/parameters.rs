//! Rule: the parameters of a plant of which intervals are given (docs/mathematics.md, section 13.2), rational numbers all.
//!
//! Guarantee: a claim names exactly these, with the numbers of the file. An interval of one point is that number, and none of them.

use crate::constant::Constant;
use crate::expr::quoted;
use crate::json::Field;
use crate::range::{Range, Span, both};
use crate::verdict::{Outcome, bad};

/// The name of the rule.
pub const RULE: &str = "parameters";

/// A constant that may be any number of an interval.
#[derive(Clone, Debug)]
pub struct Parameter {
    pub name: String,
    pub range: Range,
    pub span: Span,
}

impl Parameter {
    /// Reads the interval under this name.
    pub fn read(name: &str, field: &Field<'_>) -> Outcome<Parameter> {
        let range = Range::read(field, RULE, |fields, name| Constant::read(&fields.required(name)?))?;
        let [nominal, low, high] = [&range.nominal, &range.low, &range.high].map(|end| end.rational());
        match (nominal, low, high) {
            (Some(nominal), Some(low), Some(high)) => {
                Ok(Parameter { name: name.to_owned(), range, span: Span { nominal, ends: [low, high] } })
            }
            _ => bad(&field.pointer, "expected rational numbers"),
        }
    }

    /// Whether it is one number.
    pub fn is_constant(&self) -> bool {
        self.range.is_nominal()
    }

    /// Its interval, for a reader.
    pub fn in_words(&self) -> String {
        words(&self.name, [&self.range.low.words, &self.range.high.words])
    }
}

fn words(name: &str, [low, high]: [&str; 2]) -> String {
    format!("a constant {} of the file in [{low}, {high}]", quoted(name))
}

/// That a claim names the parameters of the file, and none where the file has none; which they are in words, with the texts of the
/// claim.
pub fn agree(asked: &[Parameter], claimed: Option<&Field<'_>>, claim: &str) -> Outcome<Option<String>> {
    let asked = Some(asked).filter(|asked| !asked.is_empty());
    let Some((asked, field)) = both(RULE, "parameters", asked, claimed, claim)? else { return Ok(None) };
    let (mut fields, mut all) = (field.fields()?, Vec::new());
    for parameter in asked {
        let stated = fields.required(&parameter.name)?;
        parameter.range.agrees(&stated, RULE)?;
        let mut ends = stated.fields()?;
        let mut text = |name| {
            let end = ends.required(name)?;
            end.rational()?;
            end.numeral()
        };
        text("nominal")?;
        all.push(words(&parameter.name, [text("low")?, text("high")?]));
    }
    fields.finish().map(|()| Some(all.join(" and ")))
}
