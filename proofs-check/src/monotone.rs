//! Rule: bounding functions are finite, nonnegative and nondecreasing in X and in E (derivation, section 1).
//!
//! The box [0, X] x [0, E] is cut until, on every piece, the expression is defined and its difference quotients in X
//! and in E are proved nonnegative. The pieces are closed and cover the box, so a segment along an axis runs through
//! finitely many of them and the expression is nondecreasing along it. It then is least at (0, 0), where its sign is
//! checked. A function that is defined on every piece is bounded there, hence finite.
//!
//! Two facts are carried for every part u of an expression, along each axis:
//! *slopes*: an interval that contains (u(b) - u(a))/(b - a) for all a != b of the side (mean value theorem, with
//! one-sided rules for min, max, abs and roots);
//! *growth*, for u >= 0 on a side in [0, oo): an interval [r, s] with (b/a)^r u(a) <= u(b) <= (b/a)^s u(a) for 0 < a < b
//! (so X^2/(1 + X) has growth 2 - [0, 1]); r >= 0 means nondecreasing, also where slopes cancel.

use crate::expr::{Expr, Op, interval_op};
use crate::interval::Interval;
use crate::verdict::{Outcome, Verdict, finding};
use rug::Rational;
use std::collections::VecDeque;

/// The most pieces, and the most pieces times operations, that are looked at.
const MAX_PIECES: usize = 2000;
const MAX_WORK: usize = 60_000;

/// The name of this rule.
pub const RULE: &str = "bounding functions";

/// What is known of a part of an expression on a piece; the index is 0 along X, 1 along E.
#[derive(Clone)]
struct Part {
    value: Interval,
    slope: [Interval; 2],
    growth: [Interval; 2],
}

/// [lower end, +oo).
fn at_least(lower: &Interval) -> Interval {
    lower.hull(&Interval::entire(lower.precision())).max(lower)
}

/// The difference quotients of a function of one variable over the range u; `value` is the function there.
fn quotients(op: &Op, u: &Interval, value: &Interval) -> Interval {
    let one = Interval::int(1, u.precision());
    match op {
        Op::Neg => -one,
        // 1/(sqrt a + sqrt b); no upper bound where 0 is in the range.
        Op::Sqrt if value.is_positive() => (value * 2).recip(),
        Op::Sqrt if value.is_zero() => at_least(&Interval::int(0, u.precision())),
        Op::Sqrt => at_least(&(value.ceiling() * 2).recip()),
        Op::Exp => value.clone(),
        Op::Log => u.recip(),
        Op::Sin => u.cos(),
        Op::Cos => -u.sin(),
        Op::Tan => 1 + value.sqr(),
        Op::Atan => (1 + u.sqr()).recip(),
        Op::Tanh => 1 - value.sqr(),
        Op::Abs if u.is_nonnegative() => one,
        Op::Abs if u.is_nonpositive() => -one,
        Op::Abs => (-&one).hull(&one),
        Op::Power(0) => Interval::int(0, u.precision()),
        Op::Power(n) => u.powi(n - 1) * i64::from(*n),
        _ => Interval::undefined(u.precision()),
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
        // Of a nondecreasing function only the sign is known.
        Op::Exp if a.is_nonnegative() => at_least(&zero),
        Op::Add | Op::Min | Op::Max => a.hull(b),
        Op::Mul => a + b,
        Op::Div => a - b,
        _ => Interval::undefined(a.precision()),
    }
}

/// The rules for one operation.
fn apply(op: &Op, sides: [&Interval; 2], a: Option<Part>, b: Option<Part>) -> Part {
    let p = sides[0].precision();
    let none = Interval::undefined(p);
    let zero = Interval::int(0, p);
    let constant = |value: Interval| Part {
        growth: [(); 2].map(|()| if value.is_nonnegative() { zero.clone() } else { none.clone() }),
        slope: [zero.clone(), zero.clone()],
        value,
    };
    let Some(a) = a else {
        return match op {
            Op::X | Op::E => {
                let along = usize::from(*op == Op::E);
                let unit = [0, 1].map(|side| Interval::int(i64::from(side == along), p));
                Part { value: sides[along].clone(), slope: unit.clone(), growth: unit }
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
        let mut rule = if nonnegative { rule } else { none.clone() };
        if rule.is_nonnegative() {
            slope = slope.max(&zero);
        }
        if rule.is_nonpositive() {
            slope = slope.min(&zero);
        }
        if nonnegative && !rule.is_defined() {
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
        part.slope[side] = slope;
        part.growth[side] = rule;
    }
    part
}

/// Whether the expression is nondecreasing on the piece along both axes, and where to cut if not known.
fn examine(expr: &Expr, piece: &[[Rational; 2]; 2], precision: u32) -> (bool, bool) {
    let [x, e] = [0, 1].map(|side| Interval::between(&piece[side][0], &piece[side][1], precision));
    let Some(part) = expr.fold(|op, a, b| apply(op, [&x, &e], a, b)) else { return (false, false) };
    let monotone = |side: usize| {
        piece[side][0] == piece[side][1] || part.slope[side].is_nonnegative() || part.growth[side].is_nonnegative()
    };
    let defined = part.value.is_defined();
    (defined && part.value.is_bounded() && monotone(0) && monotone(1), defined && monotone(0))
}

/// Proves the expression finite, nonnegative and nondecreasing on [0, x] x [0, e].
///
/// # Errors
/// `invalid` with two points where it certainly decreases, or one where it is certainly negative; `undecided` with a
/// place, when the bounded effort does not settle it.
pub fn prove(name: &str, expr: &Expr, x: &Rational, e: &Rational, precision: u32) -> Outcome<()> {
    let pointer = format!("/specification/bounds/{name}");
    let at =
        |x: &Rational, e: &Rational| expr.enclose(&Interval::rational(x, precision), &Interval::rational(e, precision));
    let zero = Rational::new();
    let origin = at(&zero, &zero);
    if origin.lt(&Interval::int(0, precision)) == Some(true) {
        return Err(finding(Verdict::Invalid, RULE, &pointer, "it is negative at X = 0, E = 0"));
    }
    let mut queue = VecDeque::from([[[zero.clone(), x.clone()], [zero.clone(), e.clone()]]]);
    let limit = MAX_PIECES.min(MAX_WORK / expr.len().max(1));
    let mut looked_at = 0;
    while let Some(piece) = queue.pop_front() {
        let (proved, along_x) = examine(expr, &piece, precision);
        if proved {
            continue;
        }
        looked_at += 1;
        let [[x0, x1], [e0, e1]] = &piece;
        let shown = |q: &Rational| q.to_f64();
        let low = at(x0, e0);
        for (px, pe) in [(x1, e0), (x0, e1)] {
            if at(px, pe).lt(&low) == Some(true) {
                let (x0, e0, px, pe) = (shown(x0), shown(e0), shown(px), shown(pe));
                let message = format!("it decreases from X = {x0}, E = {e0} to X = {px}, E = {pe}");
                return Err(finding(Verdict::Invalid, RULE, &pointer, message));
            }
        }
        if looked_at >= limit {
            let [x0, x1, e0, e1] = [x0, x1, e0, e1].map(shown);
            let message = format!(
                "that it is finite, nonnegative and nondecreasing is not proved on [{x0}, {x1}] x [{e0}, {e1}]"
            );
            return Err(finding(Verdict::Undecided, RULE, &pointer, message));
        }
        // The longer side relative to the box, or the only one that is not proved.
        let width = |side: &[Rational; 2], whole: &Rational| {
            let ends: Rational = (&side[1] - &side[0]).into();
            if *whole == 0 { ends } else { ends / whole }
        };
        let cut_e = along_x || width(&piece[1], e) > width(&piece[0], x);
        let along = usize::from(cut_e && e0 != e1 || x0 == x1);
        let middle = Rational::from(&piece[along][0] + &piece[along][1]) / 2u32;
        for (index, end) in [(1, &middle), (0, &middle)] {
            let mut half = piece.clone();
            half[along][index] = end.clone();
            queue.push_back(half);
        }
    }
    let nonnegative = origin.is_nonnegative() || expr.exact_at_origin().is_some_and(|value| value.sign() >= 0);
    if nonnegative {
        return Ok(());
    }
    Err(finding(Verdict::Undecided, RULE, &pointer, "its sign at X = 0, E = 0 is not decided"))
}
