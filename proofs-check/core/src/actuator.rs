//! Rule: an actuator that saturates (docs/mathematics.md, section 13.5), and what a claim says of it.
//!
//! Guarantee: `max > 0`, and what is put out acts as it is up to `max` in size, and as `max` beyond; or `min < max`, and it does so from `min` to `max`. In the
//! second case the regulator puts out `m + u`, `m = (min + max)/2`, and `|u| <= (max - min)/2`: with the gain g of the actuator the plant is `e' = q + g (m + u)`,
//! that of `q + g m` ([`from_middle`]). A claim with it is about one gain, names the same limits, and is proved with C6 ([`crate::rules::control`]).

use crate::constant::{Constant, Number, expression_with, positive_with};
use crate::expr::{Expr, Named, Written};
use crate::json::{Field, Fields};
use crate::range::{Range, both, states};
use crate::rules::by_n_o::claimed::Entry;
use crate::verdict::{Outcome, bad, demand, invalid};
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
    /// Whether the claim keeps to it by what it says by the number of oscillators ([`kept_by_n_o`]), in the place of C6. No file says that.
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
    let Some(limits) = actuator.and_then(|actuator| actuator.limits.as_ref()) else { return Ok(q) };
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
const KEPT_BY: &str = "kept_by";

/// Whether a claim says that it keeps to its actuator by what it says by the number of oscillators.
pub fn says_by_n_o(claimed: Option<&Field<'_>>) -> Outcome<bool> {
    let Some(field) = claimed else { return Ok(false) };
    match field.fields()?.optional(KEPT_BY) {
        None => Ok(false),
        Some(kept_by) if kept_by.text()? == "by_n_o" => Ok(true),
        Some(kept_by) => bad(&kept_by.pointer, "expected `by_n_o`"),
    }
}

/// That a claim keeps to its actuator by what it says by the number of oscillators (docs/mathematics.md, section 14.5): of every number of them, from 0 on, it
/// says how large what is put out is at all times, and that is not above `max`. Hypothesis: what it says by n_o is proved of the loop without the saturation.
///
/// Guarantee: for every n_o no solution from the claimed set saturates, so it is one of the loop with the saturation, too, whose solutions are unique. Of
/// oscillators at other harmonics nothing follows: `every_set` is refused.
pub fn kept_by_n_o(actuator: &Actuator, entries: &[Entry<'_>], every_set: bool, claim: &str) -> Outcome<()> {
    let pointer = format!("{claim}/actuator/{KEPT_BY}");
    if every_set {
        return invalid(
            RULE,
            &pointer,
            "what is said by n_o is about the first harmonics, and the claim is about every set",
        );
    }
    let first: Vec<&Entry<'_>> = entries.iter().filter(|entry| entry.oscillators.n_o().is_some()).collect();
    for (n_o, entry) in (0_u32..).zip(&first) {
        let is_next = entry.oscillators.n_o() == Some(n_o);
        demand(Some(is_next), RULE, &entry.pointer, format!("something is said of n_o = {n_o}"))?;
    }
    let all = first.last().is_some_and(|last| last.or_more);
    demand(Some(all), RULE, &pointer, "something is said of every n_o")?;
    for entry in first {
        let Some([_, u]) = &entry.largest else {
            return invalid(RULE, &entry.pointer, "it says nothing of what is put out at all times");
        };
        let kept = Number::rational(u.clone()).le(&actuator.max.number());
        demand(kept, RULE, &entry.pointer, "what is put out <= max of the actuator")?;
    }
    Ok(())
}

/// What a claim is about besides, where there is one.
pub fn in_words(actuator: Option<&Actuator>) -> String {
    let Some(Actuator { max, limits, .. }) = actuator else { return String::new() };
    let beyond = "and cuts off what is beyond (which nothing is from the set below)";
    match limits {
        None => format!(", with an actuator that takes what is put out up to {} in size {beyond}", max.words),
        Some(Limits { min, max, .. }) => {
            let [min, max] = [&min.words, &max.words];
            format!(
                ", with an actuator that takes what is put out from {min} to {max} (u is measured from the middle of these) {beyond}"
            )
        }
    }
}
