//! Difference quotients and growth of an expression on a piece.
//!
//! Two facts are carried for every part u of an expression, along each axis:
//! *slopes*: an interval that contains (u(b) - u(a))/(b - a) for all a != b of the side (mean value theorem, with
//! one-sided rules for min, max, abs and roots);
//! *growth*, for u >= 0 on a side in [0, oo): an interval [r, s] with (b/a)^r u(a) <= u(b) <= (b/a)^s u(a) for 0 < a < b
//! (so X^2/(1 + X) has growth 2 - [0, 1]); r >= 0 means nondecreasing, also where slopes cancel.

use super::polynomials::{Polynomials, Rest};
use crate::expr::{Expr, Op, interval_op, slope_op};
use crate::interval::Interval;

/// What is known of a part of an expression on a piece; the index is 0 along X, 1 along E.
#[derive(Clone)]
pub(super) struct Part {
    pub(super) value: Interval,
    pub(super) slope: [Interval; 2],
    pub(super) growth: [Interval; 2],
    /// The slopes of what is left of a sum without its polynomials.
    rest: [Interval; 2],
}

/// [lower end, +oo).
fn at_least(lower: &Interval) -> Interval {
    lower.hull(&Interval::entire(lower.precision())).max(lower)
}

/// The difference quotients of a function of one variable over the range u; `value` is the function there.
fn quotients(op: &Op, u: &Interval, value: &Interval) -> Interval {
    let one = Interval::int(1, u.precision());
    match op {
        // 1/(sqrt a + sqrt b); no upper bound where 0 is in the range.
        Op::Sqrt if value.is_positive() => (value * 2).recip(),
        Op::Sqrt if value.is_zero() => at_least(&Interval::int(0, u.precision())),
        Op::Sqrt => at_least(&(value.ceiling() * 2).recip()),
        Op::Abs if u.is_nonnegative() => one,
        Op::Abs if u.is_nonpositive() => -one,
        Op::Abs => (-&one).hull(&one),
        _ => slope_op(op, u, value).unwrap_or_else(|| Interval::undefined(u.precision())),
    }
}

/// The growth of a part from that of its operands, which are all nonnegative; undefined where no rule applies.
fn growth(op: &Op, a: &Interval, b: &Interval, exponent: Option<&Interval>) -> Interval {
    let zero = Interval::int(0, a.precision());
    match op {
        Op::Sqrt => a / 2,
        Op::Abs => a.clone(),
        Op::Power(n) => a * i64::from(*n),
        // u^c for a constant c.
        Op::Pow => exponent.map_or_else(|| Interval::undefined(a.precision()), |c| a * c),
        // Concave, nondecreasing, 0 at 0: f(m t) lies between f(t) and m f(t).
        Op::Atan | Op::Tanh => a.hull(&zero),
        Op::Add | Op::Min | Op::Max => a.hull(b),
        Op::Mul => a + b,
        Op::Div => a - b,
        _ => Interval::undefined(a.precision()),
    }
}

/// The rules for the operation at a position of the expression.
fn apply(
    (op, at): (&Op, usize),
    sides: [&Interval; 2],
    polynomials: &Polynomials,
    a: Option<Part>,
    b: Option<Part>,
) -> Part {
    let p = sides[0].precision();
    let none = Interval::undefined(p);
    let zero = Interval::int(0, p);
    let constant = |value: Interval| Part {
        growth: [(); 2].map(|()| if value.is_nonnegative() { zero.clone() } else { none.clone() }),
        slope: [zero.clone(), zero.clone()],
        rest: [zero.clone(), zero.clone()],
        value,
    };
    let Some(a) = a else {
        return match op {
            Op::Variable(along @ (0 | 1)) => {
                let unit = [0, 1].map(|side| Interval::int(i64::from(side == *along), p));
                Part { value: sides[*along].clone(), slope: unit.clone(), growth: unit, rest: [zero.clone(), zero] }
            }
            _ => constant(interval_op(op, &none, &none)),
        };
    };
    let b_value = b.as_ref().map_or(&none, |b| &b.value);
    let value = interval_op(op, &a.value, b_value);
    if !value.is_defined() || value.is_point() {
        return constant(value);
    }
    let nonnegative = value.is_nonnegative() && a.value.is_nonnegative();
    let mut part = constant(value.clone());
    for side in [0, 1] {
        let s = &a.slope[side];
        let (slope, rule) = match &b {
            None => {
                let slope = quotients(op, &a.value, &value) * s;
                (slope, growth(op, &a.growth[side], &none, None))
            }
            Some(b) => {
                let t = &b.slope[side];
                let fixed = b.slope.iter().all(Interval::is_zero);
                let slope = match op {
                    Op::Add => s + t,
                    Op::Sub => s - t,
                    // u(b) v(b) - u(a) v(a) = u(b) (v(b) - v(a)) + v(a) (u(b) - u(a))
                    Op::Mul => &a.value * t + &b.value * s,
                    // The same with u/v: ((u(b) - u(a)) - (u/v)(a) (v(b) - v(a)))/v(b)
                    Op::Div => (s - &value * t) / &b.value,
                    // The increment of an extreme lies between those of its two members.
                    Op::Min | Op::Max => s.hull(t),
                    // c u^(c-1), undefined where u may be 0 and c < 1: then only growth tells.
                    Op::Pow if fixed => &b.value * a.value.pow(&(&b.value - 1)) * s,
                    // First u changes, then v: v u^v/u s + u^v log u t, with u^v at two different places.
                    Op::Pow => &value * &b.value * s / &a.value + &value * a.value.log() * t,
                    _ => none.clone(),
                };
                let rule = growth(op, &a.growth[side], &b.growth[side], fixed.then_some(&b.value));
                (slope, if b.value.is_nonnegative() { rule } else { none.clone() })
            }
        };
        let mut slope = if slope.is_defined() { slope } else { Interval::entire(p) };
        let rest = match (polynomials.rest(at), op, &b) {
            (Rest::Nothing, ..) => zero.clone(),
            (Rest::Operands, Op::Neg, _) => -&a.rest[side],
            (Rest::Operands, Op::Add, Some(b)) => &a.rest[side] + &b.rest[side],
            (Rest::Operands, Op::Sub, Some(b)) => &a.rest[side] - &b.rest[side],
            _ => none.clone(),
        };
        if let Some(polynomial) = polynomials.slopes(at, side, sides[side]) {
            let both = slope.intersect(&(polynomial + &rest));
            // Nothing in common only where there are no slopes: on a side that is a point.
            slope = if both.is_defined() { both } else { slope };
        }
        let mut rule = match op {
            // x u' is a growth of e^u: log(b/a) lies between (b - a)/b and (b - a)/a.
            Op::Exp => sides[side] * s,
            _ if nonnegative => rule,
            _ => none.clone(),
        };
        if rule.is_nonnegative() {
            slope = slope.max(&zero);
        }
        if rule.is_nonpositive() {
            slope = slope.min(&zero);
        }
        if value.is_nonnegative() && !rule.is_defined() {
            // The sign of the slopes is a growth, and x u'/u is one where u > 0.
            let by_sign = match (slope.is_nonnegative(), slope.is_nonpositive()) {
                (true, true) => zero.clone(),
                (true, false) => at_least(&zero),
                (false, true) => -at_least(&zero),
                (false, false) => Interval::entire(p),
            };
            let by_ratio = if value.is_positive() { sides[side] * &slope / &value } else { none.clone() };
            let common = by_sign.intersect(&by_ratio);
            rule = if common.is_defined() { common } else { by_sign };
        }
        part.rest[side] = if polynomials.rest(at) == Rest::Everything { slope.clone() } else { rest };
        part.slope[side] = slope;
        part.growth[side] = rule;
    }
    part
}

/// Slopes and growth of the whole expression on a piece.
pub(super) fn part(expr: &Expr, polynomials: &Polynomials, sides: [&Interval; 2]) -> Option<Part> {
    let mut at = 0;
    expr.fold(|op, a, b| {
        at += 1;
        apply((op, at - 1), sides, polynomials, a, b)
    })
}
