//! How a stored figure is compared with the one that is computed here.
//!
//! A stored enclosure must have its ends in order, meet the checker's own enclosure, and be no wider than its seventeen
//! digits make it: relatively 1e-15. So a stored figure that is off by more than that differs.

use proofs_core::interval::Interval;
use proofs_core::json::{Field, Fields};
use proofs_core::rules::claim::reads;
use proofs_core::verdict::{Condition, Finding, Outcome, Verdict, bad, finding, invalid, shown};
use rug::{Float, Integer, Rational};

/// The name of what is compared here.
pub const RULE: &str = "stored figures";

/// Differs from what is computed.
pub fn differs(field: &Field<'_>, stored: &str, computed: &Interval) -> Box<Finding> {
    let gap = number(stored).map_or("-".to_owned(), |theirs| shown(&(theirs - computed)));
    Box::new(Finding {
        verdict: Verdict::Invalid,
        rule: RULE,
        pointer: field.pointer.clone(),
        message: "the stored value is not the value that follows from the specification and the witness".to_owned(),
        sides: Some([stored.chars().take(60).collect(), shown(computed), gap]),
    })
}

/// The precision, in bits, of a stored number: far more than its digits have.
const PRECISION: u32 = 256;

/// A decimal, or `p/q`, of any size.
pub fn number(text: &str) -> Option<Interval> {
    let (numerator, denominator) = text.split_once('/').unwrap_or((text, "1"));
    let (numerator, denominator) =
        (Interval::decimal(numerator, PRECISION)?, Interval::decimal(denominator, PRECISION)?);
    Some(numerator / denominator)
}

/// The stored number of a field.
pub fn stored(field: &Field<'_>) -> Outcome<Interval> {
    match number(field.numeral()?) {
        Some(value) if value.is_bounded() => Ok(value),
        _ => bad(&field.pointer, "expected a decimal number"),
    }
}

/// A text that is fixed by the rest of the certificate.
pub fn text(field: &Field<'_>, expected: &str) -> Outcome<()> {
    reads(RULE, field, expected)
}

/// How far a stored figure of `digits` decimals may lie from the number: by its rounding, relatively 10^-digits, and by the
/// width of the checker's own enclosure.
pub fn tolerance(value: &Interval, digits: u32) -> Interval {
    let width = value.ceiling() - value.floor();
    let unit = Interval::rational(&Rational::from((1, Integer::from(Integer::u_pow_u(10, digits)))), PRECISION);
    (value.abs().ceiling() * unit + width * 4).ceiling()
}

/// The decimals to which a figure must be known here before a stored one is compared with it.
pub const PRECISE_DIGITS: u32 = 6;

/// At this precision, in bits, nothing more can be asked for.
const LAST_PRECISION: u32 = 1024;

/// Demands that a figure is known well enough to tell a right one from a wrong one: else more bits are needed.
pub fn precise(field: &Field<'_>, mine: &Interval) -> Outcome<()> {
    let width = mine.ceiling() - mine.floor();
    let unit = Interval::rational(&Rational::from((1, Integer::from(Integer::u_pow_u(10, PRECISE_DIGITS)))), PRECISION);
    let known = mine.is_bounded() && width.le(&(mine.abs().ceiling() * unit)) == Some(true);
    if known || mine.precision() >= LAST_PRECISION {
        return Ok(());
    }
    open(field)
}

fn open(field: &Field<'_>) -> Outcome<()> {
    let message = "this figure is not known well enough to compare with it";
    Err(finding(Verdict::Undecided, RULE, &field.pointer, message))
}

/// The decimals of an end of a stored enclosure that are certain.
const DIGITS: u32 = 15;

/// An end of a stored enclosure: a decimal, or `inf` where the checker finds no bound either.
fn end(field: &Field<'_>, mine: &Float) -> Outcome<Option<Interval>> {
    let text = field.text()?;
    let same_infinity = mine.is_infinite() && text.starts_with('-') == mine.is_sign_negative();
    match text {
        "inf" | "-inf" if same_infinity => Ok(None),
        "inf" | "-inf" | "undefined" => invalid(RULE, &field.pointer, "it has a finite value"),
        _ => stored(field).map(Some),
    }
}

/// A stored enclosure of one number, or from the lower end of one number to the upper end of another.
pub fn span(field: &Field<'_>, low: &Interval, high: &Interval) -> Outcome<()> {
    let ends = field.elements()?;
    let [lo, hi] = &ends[..] else { return bad(&field.pointer, "expected [lower end, upper end]") };
    if !low.is_defined() || !high.is_defined() {
        if low.precision().max(high.precision()) < LAST_PRECISION {
            return open(field);
        }
        return text(lo, "undefined").and_then(|()| text(hi, "undefined"));
    }
    // Each end lies on its side of the number, and no further from it than its digits make it.
    if let Some(value) = end(lo, &low.lo())? {
        let near = (low.floor() - &value).le(&tolerance(low, DIGITS)) == Some(true);
        if !near || low.ceiling().lt(&value) == Some(true) {
            return Err(differs(lo, lo.text()?, low));
        }
    }
    if let Some(value) = end(hi, &high.hi())? {
        let near = (&value - high.ceiling()).le(&tolerance(high, DIGITS)) == Some(true);
        if !near || value.lt(&high.floor()) == Some(true) {
            return Err(differs(hi, hi.text()?, high));
        }
    }
    Ok(())
}

/// The decimals of an upper bound in a claim.
const CLAIM_DIGITS: u32 = 11;

/// The least positive upper bound that a claim has to tell from another: a numeral has an exponent of moderate size.
const LEAST: &str = "1e-1000";

/// A stored upper bound lies no further above the number than its rounding, or both are at most [`LEAST`].
pub fn tight(field: &Field<'_>, mine: &Interval) -> Outcome<()> {
    let stored = stored(field)?;
    let vanishes =
        |value: &Interval| number(LEAST).is_some_and(|least| value.ceiling().le(&least.ceiling()) == Some(true));
    if vanishes(&stored) && vanishes(mine) && mine.hi() <= stored.hi() {
        return Ok(());
    }
    precise(field, mine)?;
    let above = stored - mine.ceiling();
    let near = above.le(&tolerance(mine, CLAIM_DIGITS)) == Some(true);
    if near { Ok(()) } else { Err(differs(field, field.numeral()?, mine)) }
}

/// One condition of the stored list.
pub fn condition(element: &Field<'_>, mine: &Condition) -> Outcome<()> {
    let mut fields: Fields<'_> = element.fields()?;
    text(&fields.required("id")?, mine.id)?;
    text(&fields.required("what")?, &mine.what)?;
    text(&fields.required("relation")?, mine.relation.symbol())?;
    span(&fields.required("lhs")?, &mine.lhs, &mine.lhs)?;
    span(&fields.required("rhs")?, &mine.rhs, &mine.rhs)?;
    let (field, margin) = (fields.required("margin")?, &mine.rhs - &mine.lhs);
    // The margin is rounded down, so it is the lower end of an enclosure.
    if let Some(value) = end(&field, &margin.lo())? {
        let apart = (value - margin.floor()).abs();
        if apart.le(&tolerance(&margin, DIGITS)) != Some(true) {
            return Err(differs(&field, field.text()?, &margin));
        }
    }
    fields.finish()
}
