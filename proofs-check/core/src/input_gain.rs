//! Rule: an input gain that is known to an interval (docs/guide.md), and its numbers b (docs/mathematics.md, section 13.1).
//!
//! The gain of the actuator signal is one constant in `[low, high]`, and the regulator puts out u/nominal. So what reaches the plant is
//! b u with a constant b in `[b_lo, b_hi] = [low/nominal, high/nominal]`.
//!
//! Guarantee: `0 < low <= nominal <= high`, so `0 < b_lo <= 1 <= b_hi`.

use crate::constant::{Constant, expression_with, positive_with};
use crate::expr::Named;
use crate::interval::Interval;
use crate::json::{Field, Fields};
use crate::plant::parameters::Parameter;
use crate::range::{Range, Span, both};
use crate::spread::ends;
use crate::verdict::{Outcome, bad};

/// The name of the rule.
pub const RULE: &str = "input gain";

/// Takes `input_gain` out of a file, if it is there. Names of a plant's constants may stand in its numbers, and those of parameters of which
/// intervals are given. In `nominal` these have their nominal values; of an expression `low` is a number below, and `high` one above, what
/// it is for all values of them.
pub fn read(file: &mut Fields<'_>, constants: &[Named], intervals: &[Parameter]) -> Outcome<Option<Range>> {
    let names: Vec<&str> = intervals.iter().map(|parameter| parameter.name.as_str()).collect();
    let family: Vec<Span> = intervals.iter().map(|parameter| parameter.span.clone()).collect();
    let nominal = intervals.iter().map(|Parameter { name, range, .. }| Named {
        name: name.clone(),
        text: range.nominal.text.clone(),
        value: range.nominal.expr().clone(),
    });
    let at_nominal: Vec<Named> = constants.iter().cloned().chain(nominal).collect();
    let positive = |fields: &mut Fields<'_>, name: &str| {
        let field = fields.required(name)?;
        let text = field.numeral()?;
        if name == "nominal" {
            return positive_with(&field, name, &at_nominal);
        }
        if !names.iter().any(|name| occurs(name, text)) {
            return positive_with(&field, name, constants);
        }
        let (expr, written) = expression_with(&field, &names, constants)?;
        let Some([low, high]) = ends(&expr, &family).filter(|[low, _]| *low > 0) else {
            return bad(&field.pointer, "this need not be positive for all values of its parameters");
        };
        Ok(Constant::standing_for(written, if name == "low" { low } else { high }))
    };
    file.part("input_gain", |field| Range::read(field, RULE, positive))
}

/// Whether a name occurs in the text of an expression.
fn occurs(name: &str, text: &str) -> bool {
    text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_' || c == '.')).any(|word| word == name)
}

/// b_lo and b_hi.
pub fn factors(gain: &Range, precision: u32) -> [Interval; 2] {
    let one = Interval::int(1, precision);
    let factor = |end: &Constant| match end.rational().zip(gain.nominal.rational()) {
        Some((end, nominal)) => Interval::rational(&(end / nominal), precision),
        None => end.enclose(precision) / gain.nominal.enclose(precision),
    };
    [factor(&gain.low).min(&one), factor(&gain.high).max(&one)]
}

/// That a claim names the gain of the file, and names none where the file has none.
pub fn agrees(asked: Option<&Range>, claimed: Option<&Field<'_>>, claim: &str) -> Outcome<()> {
    both(RULE, "input_gain", asked, claimed, claim)?.map_or(Ok(()), |(asked, field)| asked.agrees(field, RULE))
}

/// What a claim is about besides, where there is a gain.
pub fn in_words(gain: Option<&Range>) -> String {
    let Some(Range { nominal, low, high }) = gain else { return String::new() };
    format!(
        " and every input gain in [{}, {}] (one constant; the regulator divides by the nominal {})",
        low.words, high.words, nominal.words
    )
}
