//! Periodicity in t, exactly, by the form of formulas (docs/mathematics.md, sections 1 and 11.1, P0).
//!
//! t occurs only in arguments `A t + B` of sin, cos and tan, with B free of t and `A T/(2 pi)` a whole number; in a Jacobian
//! also with `A T/pi` an odd one, where the changes of sign cancel.

use proofs_core::exact::Exact;
use proofs_core::expr::{Expr, Op, exact_op};
use proofs_core::interval::Interval;
use proofs_core::jacobian::{Entry, Jacobian, RULE};
use proofs_core::period::Period;
use proofs_core::verdict::{Outcome, demand};
use rug::Rational;

/// The precision, in bits, at which values refute a period.
const PRECISION: u32 = 96;

/// What becomes of a part of a formula when t grows by the period.
#[derive(Clone)]
enum Part {
    /// t does not occur; the exact value of a number, where it has one.
    Free(Option<Exact>),
    /// It stays (false) or changes its sign (true).
    Sign(bool),
    /// `A t + B`, with this A.
    Line(Exact),
    /// It has the form of none of these; whether that is certain.
    Other(bool),
}

/// The rules for a period, and whether changes of sign, and lines without a slope, are followed.
struct Rules<'a> {
    period: Option<&'a Exact>,
    signs: bool,
}

impl Rules<'_> {
    fn apply(&self, op: &Op, a: Option<Part>, b: Option<Part>) -> Part {
        use Part::{Free, Line, Other, Sign};
        let known = |part: &Option<Part>| match part {
            Some(Free(value)) => value.clone(),
            _ => None,
        };
        let line = |slope: Option<Exact>| match slope {
            Some(slope) if self.signs && slope.sign() == 0 => Sign(false),
            Some(slope) => Line(slope),
            None => Other(false),
        };
        if let Some(Other(certain)) = &a {
            return Other(*certain);
        }
        match (op, &a, &b) {
            (_, _, Some(Other(certain))) => Other(*certain),
            (Op::Variable(0), ..) => line(Exact::rational(&Rational::from(1))),
            (Op::Variable(_), ..) => Free(None),
            (_, None | Some(Free(_)), None | Some(Free(_))) => {
                Free(exact_op(op, a.as_ref().map(|_| known(&a)), b.as_ref().map(|_| known(&b))))
            }
            (Op::Sin | Op::Cos | Op::Tan, Some(Line(slope)), _) => self.wave(op, slope),
            (Op::Neg, Some(Line(slope)), _) => Line(slope.neg()),
            (Op::Add | Op::Sub, Some(Line(slope)), Some(Free(_))) | (Op::Add, Some(Free(_)), Some(Line(slope))) => {
                Line(slope.clone())
            }
            (Op::Sub, Some(Free(_)), Some(Line(slope))) => Line(slope.neg()),
            (Op::Add, Some(Line(a)), Some(Line(b))) => line(a.add(b)),
            (Op::Sub, Some(Line(a)), Some(Line(b))) => line(a.add(&b.neg())),
            (Op::Mul, Some(Line(slope)), Some(Free(factor))) | (Op::Mul, Some(Free(factor)), Some(Line(slope))) => {
                line(factor.as_ref().and_then(|factor| slope.mul(factor)))
            }
            (Op::Div, Some(Line(slope)), Some(Free(divisor))) => {
                line(divisor.as_ref().and_then(Exact::recip).and_then(|inverse| slope.mul(&inverse)))
            }
            // t itself anywhere else, as in t^2 or exp(t).
            (_, Some(Line(_)), _) | (_, _, Some(Line(_))) => Other(true),
            // What stays is as good as what is free of t.
            (_, None | Some(Free(_) | Sign(false)), None | Some(Free(_) | Sign(false))) => Sign(false),
            (Op::Neg, Some(Sign(odd)), _) => Sign(*odd),
            (Op::Power(n), Some(Sign(odd)), _) => Sign(*odd && n % 2 != 0),
            (Op::Add | Op::Sub, Some(Sign(true)), Some(Sign(true))) => Sign(true),
            (Op::Mul, Some(Sign(a)), Some(Sign(b))) => Sign(a != b),
            (Op::Mul | Op::Div, Some(Sign(true)), Some(Free(_))) | (Op::Mul, Some(Free(_)), Some(Sign(true))) => {
                Sign(true)
            }
            _ => Other(false),
        }
    }

    /// sin and cos of a line change their signs if `A T/pi` is an odd integer, and stay if it is an even one.
    fn wave(&self, op: &Op, slope: &Exact) -> Part {
        let half_turns = || slope.mul(self.period?)?.mul(&Exact::pi().recip()?);
        match half_turns().map(|count| count.as_rational()) {
            None => Part::Other(false),
            Some(Some(count)) if *count.denom() == 1 && !count.numer().is_odd() => Part::Sign(false),
            Some(Some(count)) if *count.denom() == 1 && self.signs && *op != Op::Tan => Part::Sign(true),
            Some(_) => Part::Other(true),
        }
    }
}

/// Whether a formula of a plant has the form that gives it the period; the first variable is t.
pub fn is_periodic(expr: &Expr, period: Option<&Exact>) -> Option<bool> {
    let rules = Rules { period, signs: false };
    match expr.fold(|op, a, b| rules.apply(op, a, b)) {
        Some(Part::Free(_) | Part::Sign(false)) => Some(true),
        // t remains, which is not periodic.
        Some(Part::Line(_) | Part::Sign(true) | Part::Other(true)) => Some(false),
        Some(Part::Other(false)) | None => None,
    }
}

/// Whether a function of t has the period: proved by its form, refuted by values at some times a period apart. The period is the nominal
/// one, and so is that of a function of the phase.
fn function_is_periodic(expr: &Expr, period: &Period) -> Option<bool> {
    let rules = Rules { period: period.nominal.exact.as_ref(), signs: true };
    if matches!(expr.fold(|op, a, b| rules.apply(op, a, b)), Some(Part::Free(_) | Part::Sign(false))) {
        return Some(true);
    }
    let period = period.nominal.enclose(PRECISION);
    let at = |time: Interval| expr.enclose(&time, &Interval::undefined(PRECISION));
    let apart = |k: i64| {
        let (now, later) = (at(&period * k / 7), at(&period * (k + 7) / 7));
        now.lt(&later) == Some(true) || later.lt(&now) == Some(true)
    };
    (0..7).any(apart).then_some(false)
}

/// Proves that every function of t in a Jacobian has the period of the specification.
///
/// # Errors
/// `invalid` where values refute it, else `undecided`.
pub fn jacobian_is_periodic(jacobian: &Jacobian, period: &Period) -> Outcome<()> {
    for entry in jacobian.iter().flatten() {
        if let Entry::Function(expr) = entry {
            let what = "the Jacobian has the period of the specification";
            demand(function_is_periodic(expr, period), RULE, "/specification/lyapunov/jacobian", what)?;
        }
    }
    Ok(())
}
