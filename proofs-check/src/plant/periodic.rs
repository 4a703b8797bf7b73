//! Periodicity in t, exactly, by the form of the formulas (docs/mathematics.md, section 11.1, P0).
//!
//! t occurs only in arguments `A t + B` of sin, cos and tan, with B free of t and `A T/(2 pi)` a whole number.

use crate::exact::Exact;
use crate::expr::{Expr, Op, exact_op};
use rug::Rational;

/// What a part of a formula is, as a function of t.
#[derive(Clone)]
enum Part {
    /// t does not occur; the exact value of a number, where it has one.
    Free(Option<Exact>),
    /// It has the period.
    Periodic,
    /// `A t + B`, with this A.
    Line(Exact),
    /// It has the form of none of these; whether that is certain.
    Other(bool),
}

impl Part {
    fn apply(op: &Op, period: Option<&Exact>, a: Option<Part>, b: Option<Part>) -> Part {
        use Part::{Free, Line, Other, Periodic};
        let known = |part: &Option<Part>| match part {
            Some(Free(value)) => value.clone(),
            _ => None,
        };
        if let Some(Other(certain)) = &a {
            return Other(*certain);
        }
        match (op, &a, &b) {
            (_, _, Some(Other(certain))) => Other(*certain),
            (Op::X, ..) => Exact::rational(&Rational::from(1)).map_or(Other(false), Line),
            (Op::E | Op::State(_), ..) => Free(None),
            (_, None | Some(Free(_)), None | Some(Free(_))) => {
                Free(exact_op(op, a.as_ref().map(|_| known(&a)), b.as_ref().map(|_| known(&b))))
            }
            (Op::Sin | Op::Cos | Op::Tan, Some(Line(slope)), _) => Part::wave(slope, period),
            (Op::Neg, Some(Line(slope)), _) => Line(slope.neg()),
            (Op::Add | Op::Sub, Some(Line(slope)), Some(Free(_))) | (Op::Add, Some(Free(_)), Some(Line(slope))) => {
                Line(slope.clone())
            }
            (Op::Sub, Some(Free(_)), Some(Line(slope))) => Line(slope.neg()),
            (Op::Add, Some(Line(a)), Some(Line(b))) => a.add(b).map_or(Other(false), Line),
            (Op::Sub, Some(Line(a)), Some(Line(b))) => a.add(&b.neg()).map_or(Other(false), Line),
            (Op::Mul, Some(Line(slope)), Some(Free(factor))) | (Op::Mul, Some(Free(factor)), Some(Line(slope))) => {
                factor.as_ref().and_then(|factor| slope.mul(factor)).map_or(Other(false), Line)
            }
            (Op::Div, Some(Line(slope)), Some(Free(divisor))) => {
                let quotient = divisor.as_ref().and_then(Exact::recip).and_then(|inverse| slope.mul(&inverse));
                quotient.map_or(Other(false), Line)
            }
            // t itself anywhere else, as in t^2 or exp(t).
            (_, Some(Line(_)), _) | (_, _, Some(Line(_))) => Other(true),
            _ => Periodic,
        }
    }

    fn wave(slope: &Exact, period: Option<&Exact>) -> Part {
        let two_pi = Exact::rational(&Rational::from(2)).and_then(|two| two.mul(&Exact::pi()));
        let turns = period.and_then(|period| slope.mul(period)?.mul(&two_pi?.recip()?));
        match turns {
            None => Part::Other(false),
            Some(turns) => match turns.as_rational() {
                Some(turns) if *turns.denom() == 1 => Part::Periodic,
                _ => Part::Other(true),
            },
        }
    }
}

/// Whether a formula of a plant has the form that gives it the period; the first variable is t.
pub fn is_periodic(expr: &Expr, period: Option<&Exact>) -> Option<bool> {
    match expr.fold(|op, a, b| Part::apply(op, period, a, b)) {
        Some(Part::Free(_) | Part::Periodic) => Some(true),
        // t remains, which is not periodic.
        Some(Part::Line(_) | Part::Other(true)) => Some(false),
        Some(Part::Other(false)) | None => None,
    }
}
