//! Rule: the period, one number or an interval (docs/mathematics.md, section 13.3), and which of its ends a bound takes.
//!
//! With an interval T is one constant in `[low, high]`, and a claim is about each. The functions of time of a file are functions of the
//! phase `2 pi t/T` then. They are read as functions of `s = T_nom t/T`, the time of the nominal period, so that
//! d/dt is v d/ds with the clock `v = T_nom/T`.
//!
//! Guarantee: `0 < low <= nominal <= high`. Of an interval a rule has no T but those of [`Ends`], which it has to choose between.

use crate::constant::{Constant, PRECISIONS, expression_with, positive_with};
use crate::exact::Exact;
use crate::expr::{Expr, Named, TIME};
use crate::interval::Interval;
use crate::json::{Field, Fields, Json};
use crate::range::{Range, Span, both};
use crate::verdict::{Outcome, bad};
use rug::Rational;

/// The name of the rule.
pub const RULE: &str = "period";

/// The name of the phase in expressions.
pub const PHASE: &str = "phase";
/// The time where it has no name: no text has such a one.
const NAMELESS: &[&str] = &["(t)"];

/// The period of a file.
#[derive(Clone, Debug)]
pub struct Period {
    /// The period itself, or the nominal one of an interval.
    pub nominal: Constant,
    range: Option<Range>,
}

/// What a rule may take of it.
pub struct Ends {
    shortest: Interval,
    longest: Interval,
    is_exact: bool,
}

impl Period {
    /// Takes `period` out of a file. An interval of one point is that number.
    pub fn read(file: &mut Fields<'_>, constants: &[Named]) -> Outcome<Period> {
        let field = file.required("period")?;
        if !matches!(field.json, Json::Object(_)) {
            return Ok(Period { nominal: positive_with(&field, "period", constants)?, range: None });
        }
        let range = Range::read(&field, RULE, |fields, name| positive_with(&fields.required(name)?, name, constants))?;
        Ok(Period { nominal: range.nominal.clone(), range: Some(range).filter(|range| !range.is_nominal()) })
    }

    /// The interval, where it is more than one number.
    pub fn range(&self) -> Option<&Range> {
        self.range.as_ref()
    }

    /// The period, where it is one number.
    pub fn exact(&self) -> Option<&Constant> {
        if self.range.is_some() { None } else { Some(&self.nominal) }
    }

    /// The period for what needs one number; bad input where it is an interval.
    pub fn demand_exact(&self, pointer: &str, what: &str) -> Outcome<&Constant> {
        self.exact().map_or_else(|| bad(pointer, format!("{what} needs a period that is one number")), Ok)
    }

    /// At a precision.
    pub fn ends(&self, precision: u32) -> Ends {
        let [shortest, longest] = match &self.range {
            Some(range) => [&range.low, &range.high].map(|end| end.enclose(precision)),
            None => [(); 2].map(|()| self.nominal.enclose(precision)),
        };
        Ends { shortest, longest, is_exact: self.range.is_none() }
    }

    /// The clock `v = T_nom/T` of an interval, with 1 in it; its ends are rounded outward where they are not known to be rational.
    pub fn clock(&self, pointer: &str) -> Outcome<Option<Span>> {
        let Some(range) = &self.range else { return Ok(None) };
        let ratio = |end: &Constant, side: fn(&Interval) -> Option<Rational>| {
            let exact = self.nominal.exact.as_ref().zip(end.exact.as_ref().and_then(Exact::recip));
            let exact =
                exact.and_then(|(nominal, inverse)| nominal.mul(&inverse)).and_then(|ratio| ratio.as_rational());
            let enclosed = |p: &u32| side(&(self.nominal.enclose(*p) / end.enclose(*p)));
            exact.or_else(|| PRECISIONS.iter().find_map(enclosed))
        };
        match (ratio(&range.high, Interval::lower), ratio(&range.low, Interval::upper)) {
            (Some(low), Some(high)) => Ok(Some(Span { nominal: Rational::from(1), ends: [low, high] })),
            _ => bad(pointer, "the quotient of its numbers cannot be enclosed"),
        }
    }

    /// Reads an expression in the time, or the phase, and other variables. It has the period by its form alone: whoever reads it decides
    /// that with the nominal period.
    pub fn expression(&self, field: &Field<'_>, others: &[&str], constants: &[Named]) -> Outcome<Expr> {
        let value = Expr::phase(self.nominal.expr());
        let phase = Named { name: PHASE.to_owned(), text: PHASE.to_owned(), value };
        let constants: Vec<Named> = constants.iter().cloned().chain([phase]).collect();
        let read = |time: &[&str]| expression_with(field, &[time, others].concat(), &constants).map(|(expr, _)| expr);
        let timed = read(TIME)?;
        match &self.range {
            None => Ok(timed),
            Some(_) => read(NAMELESS).or_else(|_| {
                bad(
                    &field.pointer,
                    "with a period that is an interval, `t` says nothing: write `phase`, which is 2 pi t/T",
                )
            }),
        }
    }
}

impl Ends {
    /// T_hi: for what grows with the period.
    pub fn longest(&self) -> &Interval {
        &self.longest
    }

    /// `Om = 2 pi/T_hi`: for what falls as the frequency rises.
    pub fn slowest(&self) -> Interval {
        Interval::pi(self.longest.precision()) * 2 / &self.longest
    }

    /// `Om = 2 pi/T_lo`: for what rises with the frequency.
    pub fn fastest(&self) -> Interval {
        Interval::pi(self.shortest.precision()) * 2 / &self.shortest
    }

    /// T of what is about one number: undefined for an interval, so that nothing is proved with it.
    pub fn only(&self) -> Interval {
        if self.is_exact { self.longest.clone() } else { Interval::undefined(self.longest.precision()) }
    }
}

/// That a claim names the interval of the file, and none where the period is one number.
pub fn agrees(asked: &Period, claimed: Option<&Field<'_>>, claim: &str) -> Outcome<()> {
    both(RULE, "period", asked.range(), claimed, claim)?.map_or(Ok(()), |(asked, field)| asked.agrees(field, RULE))
}

/// What a claim says of it, after `with`.
pub fn in_words(period: &Period) -> String {
    match period.range() {
        None => format!("period T = {}", period.nominal.words),
        Some(Range { nominal, low, high }) => {
            format!("every period in [{}, {}] (one constant T; nominal {})", low.words, high.words, nominal.words)
        }
    }
}
