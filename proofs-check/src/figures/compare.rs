//! How a stored figure is compared with the one that is computed here.
//!
//! A stored enclosure must have its ends in order, meet the checker's own enclosure, and be no wider than its seventeen
//! digits make it: relatively 1e-15. So a stored figure that is off by more than that differs.

use crate::interval::Interval;
use crate::json::{Field, Fields, decimal};
use crate::verdict::{Condition, Finding, Outcome, Verdict, bad, invalid, shown};
use rug::{Float, Rational};

/// The name of what is compared here.
pub const RULE: &str = "stored figures";

/// Differs from what is computed.
pub fn differs(field: &Field<'_>, stored: &str, computed: &Interval) -> Box<Finding> {
    let gap = computed.lower().zip(decimal(stored)).map(|(mine, theirs)| (theirs - mine).to_f64());
    Box::new(Finding {
        verdict: Verdict::Invalid,
        rule: RULE,
        pointer: field.pointer.clone(),
        message: "the stored value is not the value that follows from the specification and the witness".to_owned(),
        sides: Some([
            stored.chars().take(60).collect(),
            shown(computed),
            gap.map_or("-".to_owned(), |g| format!("{g:e}")),
        ]),
    })
}

/// A text that is fixed by the rest of the certificate.
pub fn text(field: &Field<'_>, expected: &str) -> Outcome<()> {
    if field.text()? == expected {
        Ok(())
    } else {
        invalid(RULE, &field.pointer, format!("it should read: {expected}"))
    }
}

/// How far two figures for the same number may lie apart: `digits` decimals, and the width of the checker's own.
pub fn tolerance(value: &Interval, relative: f64) -> Rational {
    let (Some(lo), Some(hi)) = (value.lower(), value.upper()) else { return Rational::new() };
    let size = lo.clone().abs().max(hi.clone().abs());
    let relative = Rational::from_f64(relative).unwrap_or_default();
    size * relative + (hi - lo) * 4u32
}

/// An end of a stored enclosure: a decimal, or `inf` where the checker finds no bound either.
fn end(field: &Field<'_>, mine: &Float) -> Outcome<Option<Rational>> {
    let text = field.text()?;
    match decimal(text) {
        Some(value) => Ok(Some(value)),
        None if matches!(text, "inf" | "-inf")
            && mine.is_infinite()
            && text.starts_with('-') == mine.is_sign_negative() =>
        {
            Ok(None)
        }
        None if matches!(text, "inf" | "-inf" | "undefined") => invalid(RULE, &field.pointer, "it has a finite value"),
        None => bad(&field.pointer, "expected a decimal number of moderate size"),
    }
}

/// A stored enclosure of one number, or from the lower end of one number to the upper end of another.
pub fn span(field: &Field<'_>, low: &Interval, high: &Interval) -> Outcome<()> {
    let ends = field.elements()?;
    let [lo, hi] = &ends[..] else { return bad(&field.pointer, "expected [lower end, upper end]") };
    if !low.is_defined() || !high.is_defined() {
        return text(lo, "undefined").and_then(|()| text(hi, "undefined"));
    }
    if let Some(value) = end(lo, low.lo())? {
        let near = low.lower().is_some_and(|mine| Rational::from(&mine - &value) <= tolerance(low, 1e-15));
        if !near || low.upper().is_some_and(|mine| value > mine) {
            return Err(differs(lo, lo.text()?, low));
        }
    }
    if let Some(value) = end(hi, high.hi())? {
        let near = high.upper().is_some_and(|mine| Rational::from(&value - &mine) <= tolerance(high, 1e-15));
        if !near || high.lower().is_some_and(|mine| value < mine) {
            return Err(differs(hi, hi.text()?, high));
        }
    }
    Ok(())
}

/// A stored upper bound of twelve digits lies no further above the number than its rounding.
pub fn tight(field: &Field<'_>, mine: &Interval) -> Outcome<()> {
    let value = field.rational()?;
    let near = mine.upper().is_some_and(|upper| value - upper <= tolerance(mine, 1e-11));
    if near { Ok(()) } else { Err(differs(field, field.numeral()?, mine)) }
}

/// One condition of the stored list.
pub fn condition(element: &Field<'_>, mine: &Condition) -> Outcome<()> {
    let mut fields: Fields<'_> = element.fields()?;
    text(&fields.required("id")?, mine.id)?;
    text(&fields.required("what")?, &mine.what)?;
    text(&fields.required("relation")?, mine.symbol())?;
    span(&fields.required("lhs")?, &mine.lhs, &mine.lhs)?;
    span(&fields.required("rhs")?, &mine.rhs, &mine.rhs)?;
    let (field, margin) = (fields.required("margin")?, &mine.rhs - &mine.lhs);
    // The margin is rounded down, so it is the lower end of an enclosure.
    if let (Some(value), Some(lower)) = (end(&field, margin.lo())?, margin.lower()) {
        let apart = Rational::from(&value - &lower).abs();
        if apart > tolerance(&margin, 1e-15) {
            return Err(differs(&field, field.text()?, &margin));
        }
    }
    fields.finish()
}
