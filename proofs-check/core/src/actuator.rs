//! Rule: an actuator that saturates (docs/mathematics.md, section 13.5), and what a claim says of it.
//!
//! Guarantee: `max > 0`, and what is put out acts as it is up to `max` in size, and as `max` beyond; or `min < max`, and it does so from `min` to `max`. In the
//! second case the regulator puts out `m + u`, `m = (min + max)/2`, and `|u| <= (max - min)/2`: with the gain g of the actuator the plant is `e' = q + g (m + u)`,
//! that of `q + g m` ([`from_middle`]). A claim with it is about one gain, names the same limits, and is proved with C6 ([`crate::rules::control`]).

use crate::constant::{Constant, expression_with, positive_with};
use crate::expr::{Expr, Named, Written};
use crate::json::{Field, Fields};
use crate::range::{Range, both, states};
use crate::verdict::{Outcome, bad, demand};
use rug::Rational;

/// The name of the rule.
pub const RULE: &str = "actuator";

/// The actuator of a file.
#[derive(Clone, Debug)]
pub struct Actuator {
    /// The greatest size of u that it takes.
    pub max: Constant,
    /// Its limits, where `min` is stated.
    limits: Option<Limits>,
    /// Whether the claim keeps to it by what it says by the number of oscillators ([`crate::rules::by_n_o::kept`]), in the place of C6. No file says that.
    pub by_n_o: bool,
}

/// min < max, both rational.
#[derive(Clone, Debug)]
struct Limits {
    min: Constant,
    max: Constant,
    middle: Rational,
}

impl Actuator {
    /// What u is measured from, `(min + max)/2`, where limits to both sides are stated.
    pub fn middle_in_words(&self) -> Option<String> {
        let Limits { min, max, .. } = self.limits.as_ref()?;
        Some(format!("({} + {})/2", min.words, max.words))
    }
}

/// Takes `actuator` out of a file, if it is there. Names of a plant's constants may stand in its numbers. Bounding functions know no middle (`of_plant`).
pub fn read(file: &mut Fields<'_>, constants: &[Named], of_plant: bool) -> Outcome<Option<Actuator>> {
    file.part("actuator", |field| {
        field.object(|fields| {
            if !of_plant || !fields.has("min") {
                let max = positive_with(&fields.required("max")?, "max", constants)?;
                return Ok(Actuator { max, limits: None, by_n_o: false });
            }
            let mut limit = |name| {
                let field = fields.required(name)?;
                let constant = Constant::read_with(&field, constants)?;
                match constant.rational() {
                    Some(value) => Ok((constant, value)),
                    None => bad(&field.pointer, "with two limits each has to be a rational number"),
                }
            };
            let ((min, low), (max, high)) = (limit("min")?, limit("max")?);
            demand(Some(low < high), RULE, &field.pointer, "min < max")?;
            let half: Rational = Rational::from(&high - &low) / 2;
            let text = half.to_string();
            let half = Constant::standing_for(Written { text: text.clone(), words: text }, half);
            let middle = (low + high) / 2;
            Ok(Actuator { max: half, limits: Some(Limits { min, max, middle }), by_n_o: false })
        })
    })
}

/// The q of a plant from whose u the middle of the range is taken: `q + g m`, with the gain g of the actuator, 1 where `gain` is none. Of a gain that is not its
/// nominal one both ends are to be the same expression, which then is g for every member; `stated` is where they stand.
pub fn from_middle(
    q: Expr,
    actuator: Option<&Actuator>,
    (gain, stated): (Option<&Range>, Option<&Field<'_>>),
    variables: &[&str],
    constants: &[Named],
) -> Outcome<Expr> {
    let limits = actuator.and_then(|actuator| actuator.limits.as_ref()).filter(|limits| limits.middle != 0);
    let Some(limits) = limits else { return Ok(q) };
    let factor = match (gain, stated) {
        (None, _) => Expr::number(Rational::from(1)),
        (Some(gain), _) if gain.is_nominal() => gain.nominal.expr().clone(),
        (Some(_), None) => return bad("", "an input gain that stands nowhere"),
        (Some(_), Some(stated)) => {
            let mut fields = stated.fields()?;
            let [low, high] = ["low", "high"].map(|name| fields.required(name));
            let (low, high) = (low?, high?);
            if low.numeral()?.trim() != high.numeral()?.trim() {
                return bad(
                    &stated.pointer,
                    "with `min` of the actuator both ends of its gain have to be one expression",
                );
            }
            expression_with(&low, variables, constants)?.0
        }
    };
    Ok(q.plus(&limits.middle, &factor))
}

/// That a claim names the actuator of the file, and names none where the file has none.
pub fn agrees(asked: Option<&Actuator>, claimed: Option<&Field<'_>>, claim: &str) -> Outcome<()> {
    let Some((asked, field)) = both(RULE, "actuator", asked, claimed, claim)? else { return Ok(()) };
    field.object(|fields| {
        fields.optional(KEPT_BY);
        agree(fields, asked)
    })
}

fn agree(fields: &mut Fields<'_>, asked: &Actuator) -> Outcome<()> {
    match &asked.limits {
        None => states(fields, "max", &asked.max, RULE),
        Some(limits) => {
            states(fields, "min", &limits.min, RULE)?;
            states(fields, "max", &limits.max, RULE)
        }
    }
}

/// The field of a claim that says by what it keeps to its actuator.
pub const KEPT_BY: &str = "kept_by";

/// Whether a claim says that it keeps to its actuator by what it says by the number of oscillators.
pub fn says_by_n_o(claimed: Option<&Field<'_>>) -> Outcome<bool> {
    let Some(field) = claimed else { return Ok(false) };
    match field.fields()?.optional(KEPT_BY) {
        None => Ok(false),
        Some(kept_by) if kept_by.text()? == "by_n_o" => Ok(true),
        Some(kept_by) => bad(&kept_by.pointer, "expected `by_n_o`"),
    }
}

/// What a claim is about besides, where there is one.
pub fn in_words(actuator: Option<&Actuator>) -> String {
    let Some(Actuator { max, limits, .. }) = actuator else { return String::new() };
    match limits {
        None => format!(", with an actuator that limits what is put out to {} in size", max.words),
        Some(Limits { min, max, .. }) => {
            let [min, max] = [&min.words, &max.words];
            format!(
                ", with an actuator that limits what is put out to the range from {min} to {max} (u is measured from its middle)"
            )
        }
    }
}

/// What the solutions of the claim do not ask of the actuator, where there is one.
pub fn never_cut_off(actuator: Option<&Actuator>) -> &'static str {
    if actuator.is_some() { " For these solutions the actuator cuts nothing off." } else { "" }
}
