//! Functions of t in a Jacobian have the period of the specification: by the form of each, exactly.

use crate::constant::Constant;
use crate::exact::Exact;
use crate::expr::{Expr, Op, exact_op};
use crate::interval::Interval;
use crate::jacobian::{Entry, Jacobian, RULE};
use crate::verdict::{Outcome, demand};
use rug::Rational;

/// The precision, in bits, at which values refute a period.
const PRECISION: u32 = 96;

/// How a part of an expression changes when t grows by the period T.
#[derive(Clone)]
enum Shift {
    /// It does not depend on t; its exact value, if it has one.
    Constant(Option<Exact>),
    /// It is this multiple of t, plus a constant.
    Line(Exact),
    /// It stays (false) or changes its sign (true).
    Sign(bool),
    /// Nothing is known.
    Unknown,
}

impl Shift {
    /// A line; one without a slope stays.
    fn line(slope: Option<Exact>) -> Shift {
        match slope {
            Some(slope) if slope.sign() == 0 => Shift::Sign(false),
            Some(slope) => Shift::Line(slope),
            None => Shift::Unknown,
        }
    }

    /// sin and cos of a line change their signs if `slope T/pi` is an odd integer, and stay if it is an even one.
    fn wave(slope: &Exact, period: Option<&Exact>) -> Shift {
        let half_turns = || slope.mul(period?)?.mul(&Exact::pi().recip()?)?.as_rational();
        match half_turns() {
            Some(count) if *count.denom() == 1 => Shift::Sign(count.numer().is_odd()),
            _ => Shift::Unknown,
        }
    }

    fn apply(op: &Op, period: Option<&Exact>, a: Option<Shift>, b: Option<Shift>) -> Shift {
        use Shift::{Constant, Line, Sign, Unknown};
        let operand = |shift: &Option<Shift>| match shift {
            Some(Constant(value)) => Ok(Some(value.clone())),
            None => Ok(None),
            _ => Err(()),
        };
        if let (Ok(a), Ok(b), true) = (operand(&a), operand(&b), *op != Op::X) {
            return Constant(exact_op(op, a, b));
        }
        match (op, a, b) {
            (Op::X, ..) => Shift::line(Exact::rational(&Rational::from(1))),
            (Op::Neg, Some(Line(slope)), _) => Line(slope.neg()),
            (Op::Neg, Some(Sign(odd)), _) => Sign(odd),
            (Op::Sin | Op::Cos, Some(Line(slope)), _) => Shift::wave(&slope, period),
            (Op::Sin | Op::Cos, Some(Sign(false)), _) => Sign(false),
            (Op::Power(n), Some(Sign(odd)), _) => Sign(odd && n % 2 != 0),
            (Op::Add | Op::Sub, Some(Line(slope)), Some(Constant(_)))
            | (Op::Add, Some(Constant(_)), Some(Line(slope))) => Line(slope),
            (Op::Sub, Some(Constant(_)), Some(Line(slope))) => Line(slope.neg()),
            (Op::Add, Some(Line(a)), Some(Line(b))) => Shift::line(a.add(&b)),
            (Op::Sub, Some(Line(a)), Some(Line(b))) => Shift::line(a.add(&b.neg())),
            (Op::Add | Op::Sub, Some(Sign(a)), Some(Sign(b))) if a == b => Sign(a),
            (Op::Add | Op::Sub, Some(Sign(false)), Some(Constant(_)))
            | (Op::Add | Op::Sub, Some(Constant(_)), Some(Sign(false))) => Sign(false),
            (Op::Mul, Some(Constant(Some(c))), Some(Line(slope)))
            | (Op::Mul, Some(Line(slope)), Some(Constant(Some(c)))) => Shift::line(slope.mul(&c)),
            (Op::Div, Some(Line(slope)), Some(Constant(Some(c)))) => Shift::line(c.recip().and_then(|c| slope.mul(&c))),
            (Op::Mul, Some(Sign(a)), Some(Sign(b))) => Sign(a != b),
            (Op::Mul, Some(Sign(odd)), Some(Constant(_)))
            | (Op::Mul, Some(Constant(_)), Some(Sign(odd)))
            | (Op::Div, Some(Sign(odd)), Some(Constant(_))) => Sign(odd),
            _ => Unknown,
        }
    }
}

/// Whether a function of t has the period: proved by its form, refuted by values at some times a period apart.
fn is_periodic(expr: &Expr, period: &Constant) -> Option<bool> {
    let shift = expr.fold(|op, a, b| Shift::apply(op, period.exact.as_ref(), a, b));
    if matches!(shift, Some(Shift::Constant(_) | Shift::Sign(false))) {
        return Some(true);
    }
    let period = period.enclose(PRECISION);
    let at = |time: Interval| expr.enclose(&time, &Interval::undefined(PRECISION));
    let apart = |k: i64| {
        let (now, later) = (at(&period * k / 7), at(&period * (k + 7) / 7));
        now.lt(&later) == Some(true) || later.lt(&now) == Some(true)
    };
    (0..7).any(apart).then_some(false)
}

/// Proves that every function of t in the Jacobian has the period of the specification.
pub fn periodic(jacobian: &Jacobian, period: &Constant) -> Outcome<()> {
    for entry in jacobian.iter().flatten() {
        if let Entry::Function(expr) = entry {
            let what = "the Jacobian has the period of the specification";
            demand(is_periodic(expr, period), RULE, "/specification/lyapunov/jacobian", what)?;
        }
    }
    Ok(())
}
