//! Enclosures of difference quotients.
//!
//! For a function u on a box, S encloses the slopes of u in X when it contains `(u(b, e) - u(a, e)) / (b - a)` for
//! all a != b in the X side and all e in the E side. Unlike a derivative this needs no differentiability, and
//! nonnegative slopes are exactly monotonicity. If the X side is a single point the set is empty, and every S will
//! do.
//!
//! The rules below are stated for X; those for E are the same. U is the range of u, Su its slopes, and s, t, ... are
//! the difference quotients of u, v, ... between a and b.
//!
//! All slopes are real numbers, so an infinite end is a bound and never a member, and the product of a slope with a
//! factor that is 0 is 0. This is what [`Enclosure`] multiplication computes: for a set of reals S within `[c, +inf]`
//! and W = {0}, the set of products is {0}; and for an end point 0 of a wider W the bound contributed by that end
//! point is the limit of `0 * s` over finite s, again 0.

use super::Expr;
use super::enclose::{binary, power, unary};
use super::syntax::{Algebra, Binary, Unary, evaluate};
use crate::enclosure::Enclosure;
use rug::float::Special;
use rug::{Float, Rational};

/// The value of an expression and its difference quotients over a box.
#[derive(Clone, Debug)]
pub struct Slopes {
    /// Contains the values on the box.
    pub value: Enclosure,
    /// Contains `(u(b, e) - u(a, e)) / (b - a)` for all a != b in the X side and e in the E side.
    pub slope_x: Enclosure,
    /// Contains `(u(x, b) - u(x, a)) / (b - a)` for all a != b in the E side and x in the X side.
    pub slope_e: Enclosure,
}

impl Slopes {
    /// Closes a rule: an undefined value makes everything undefined; a value known exactly is constant on the box and
    /// has slope 0; a slope rule that failed on a defined value bounds nothing.
    fn new(value: Enclosure, slope_x: Enclosure, slope_e: Enclosure) -> Slopes {
        let p = value.precision();
        if !value.is_defined() {
            return Slopes { slope_x: value.clone(), slope_e: value.clone(), value };
        }
        if value.is_exact() {
            return Slopes::constant(value);
        }
        let settle = |slope: Enclosure| if slope.is_defined() { slope } else { Enclosure::entire(p) };
        Slopes { value, slope_x: settle(slope_x), slope_e: settle(slope_e) }
    }

    fn constant(value: Enclosure) -> Slopes {
        let slope = if value.is_defined() { Enclosure::zero(value.precision()) } else { value.clone() };
        Slopes { value, slope_x: slope.clone(), slope_e: slope }
    }

    /// The chain rule: `f(u(b)) - f(u(a)) = q (u(b) - u(a))` where q is a difference quotient of f on U, or any
    /// number if u(a) = u(b).
    fn chain(value: Enclosure, quotients: &Enclosure, inner: &Slopes) -> Slopes {
        Slopes::new(value, quotients * &inner.slope_x, quotients * &inner.slope_e)
    }
}

/// `[lower, +inf]`, with the lower end taken from an enclosure.
fn at_least(lower: &Enclosure) -> Enclosure {
    Enclosure::new(lower.lower().clone(), Float::with_val(lower.precision(), Special::Infinity))
}

/// The upper end of an interval as a point; `None` when it is infinite.
fn top(range: &Enclosure) -> Option<Enclosure> {
    range.upper().is_finite().then(|| range.ceiling())
}

/// Difference quotients of a function of one variable on U, given its value f(U) there (which is defined).
///
/// For differentiable f they are values of f' on U by the mean value theorem, U being an interval.
pub(super) fn quotients(operation: Unary, range: &Enclosure, value: &Enclosure) -> Enclosure {
    let p = range.precision();
    match operation {
        Unary::Neg => Enclosure::from_integer(-1, p),
        // (sqrt b - sqrt a)/(b - a) = 1/(sqrt a + sqrt b) lies in [1/(2 sqrt h), 1/(2 sqrt l)] for U = [l, h]; it has
        // no upper bound when l = 0, and no lower bound but 0 when h is unbounded.
        Unary::Sqrt => {
            let twice = value * 2;
            if value.is_positive().is_true() {
                twice.recip()
            } else {
                match top(&twice).filter(|top| top.is_positive().is_true()) {
                    Some(top) => at_least(&top.recip()),
                    None => at_least(&Enclosure::zero(p)),
                }
            }
        }
        Unary::Exp => value.clone(),
        Unary::Log => range.recip(),
        Unary::Sin => range.cos(),
        Unary::Cos => range.sin().negate(),
        Unary::Tan => value.sqr() + 1,
        Unary::Atan => (range.sqr() + 1).recip(),
        Unary::Tanh => 1 - value.sqr(),
        // abs u = max(u, -u): see `extreme`.
        Unary::Abs => {
            if range.is_nonnegative().is_true() {
                Enclosure::one(p)
            } else if range.negate().is_nonnegative().is_true() {
                Enclosure::from_integer(-1, p)
            } else {
                Enclosure::one(p).hull(&Enclosure::from_integer(-1, p))
            }
        }
    }
}

/// Difference quotients of `t -> t^n` on U.
fn power_quotients(range: &Enclosure, exponent: i32) -> Enclosure {
    match exponent {
        0 => Enclosure::zero(range.precision()),
        // For n < 0 the value is defined, so 0 is not in the interval U, and t^n is differentiable on it.
        _ => power(range, exponent - 1) * i64::from(exponent),
    }
}

/// Difference quotients of `t -> t^c` on U for every c in C, where U^C is defined.
///
/// By the mean value theorem between a and b they are `c t^(c-1)` for some t strictly between a and b; so t is
/// positive even if 0 lies in U, and then c > 0 for every c in C because U^C is defined.
fn base_quotients(range: &Enclosure, exponent: &Enclosure) -> Enclosure {
    let p = range.precision().max(exponent.precision());
    let less = exponent - 1;
    let direct = range.pow(&less);
    if direct.is_defined() {
        return exponent * direct;
    }
    // Here 0 lies in U and c - 1 may be 0 or less: t^(c-1) has no upper bound on (0, h], and where c - 1 <= 0 it is
    // decreasing and thus at least h^(c-1).
    let decreasing = less.negate().is_nonnegative().is_true();
    let least = top(range).filter(|top| decreasing && top.is_positive().is_true()).map(|top| top.pow(&less));
    exponent * at_least(&least.filter(Enclosure::is_defined).unwrap_or_else(|| Enclosure::zero(p)))
}

/// Difference quotients of `c -> t^c` on C for every t in U, where `value` = U^C is defined.
///
/// They are `t^c log t` for some c between, if t > 0, and 0 if t = 0.
fn exponent_quotients(range: &Enclosure, exponent: &Enclosure, value: &Enclosure) -> Enclosure {
    if range.is_positive().is_true() {
        return value * range.log();
    }
    // Now every c is positive. For fixed c the least value of t^c log t over t > 0 is at log t = -1/c, namely
    // -1/(e c); and where it is positive, t > 1, it is at most (the greatest power) * (log h).
    let zero = Enclosure::zero(value.precision());
    let least = Enclosure::from_integer(-1, value.precision()).exp().negate() / exponent;
    let greatest = match top(range).filter(|top| top.is_positive().is_true()) {
        Some(top) => value * top.log().max(&zero),
        None => at_least(&zero),
    };
    least.hull(&zero).hull(&greatest)
}

/// The quotient u/v on a range of v without 0:
/// `u(b)/v(b) - u(a)/v(a) = ((u(b) - u(a)) - (u(a)/v(a)) (v(b) - v(a))) / v(b)`.
fn quotient_rule(value: &Enclosure, a: &Enclosure, b: &Enclosure, denominator: &Enclosure) -> Enclosure {
    (a - value * b) / denominator
}

/// Slopes of the smaller (`sign` = -1) or larger (`sign` = 1) of u and v.
///
/// Say max(u, v) is u at b and v at a. Then v(b) - v(a) <= u(b) - v(a) <= u(b) - u(a); so the increment of the
/// maximum lies between those of u and v, in this and in every other case, and the hull of the slopes contains it.
/// Where one of the two certainly dominates, its slopes suffice. The minimum is -max(-u, -v).
fn extreme(operation: Binary, value: Enclosure, a: &Slopes, b: &Slopes) -> Slopes {
    let (above, below) = if operation == Binary::Max { (a, b) } else { (b, a) };
    if above.value.ge(&below.value).is_true() {
        return Slopes::new(value, a.slope_x.clone(), a.slope_e.clone());
    }
    if below.value.ge(&above.value).is_true() {
        return Slopes::new(value, b.slope_x.clone(), b.slope_e.clone());
    }
    Slopes::new(value, a.slope_x.hull(&b.slope_x), a.slope_e.hull(&b.slope_e))
}

struct SlopeAlgebra<'a> {
    x: &'a Enclosure,
    e: &'a Enclosure,
    precision: u32,
}

impl Algebra for SlopeAlgebra<'_> {
    type Value = Slopes;

    fn number(&mut self, value: &Rational) -> Slopes {
        Slopes::constant(Enclosure::from_rational(value, self.precision))
    }

    fn pi(&mut self) -> Slopes {
        Slopes::constant(Enclosure::pi(self.precision))
    }

    fn x(&mut self) -> Slopes {
        Slopes::new(self.x.clone(), Enclosure::one(self.precision), Enclosure::zero(self.precision))
    }

    fn e(&mut self) -> Slopes {
        Slopes::new(self.e.clone(), Enclosure::zero(self.precision), Enclosure::one(self.precision))
    }

    fn unary(&mut self, operation: Unary, a: Slopes) -> Slopes {
        let value = unary(operation, &a.value);
        if !value.is_defined() {
            return Slopes::constant(value);
        }
        let quotients = quotients(operation, &a.value, &value);
        Slopes::chain(value, &quotients, &a)
    }

    fn binary(&mut self, operation: Binary, a: Slopes, b: Slopes) -> Slopes {
        let value = binary(operation, &a.value, &b.value);
        if !value.is_defined() {
            return Slopes::constant(value);
        }
        match operation {
            Binary::Add => Slopes::new(value, a.slope_x + &b.slope_x, a.slope_e + &b.slope_e),
            Binary::Sub => Slopes::new(value, a.slope_x - &b.slope_x, a.slope_e - &b.slope_e),
            // u(b) v(b) - u(a) v(a) = u(b) (v(b) - v(a)) + v(a) (u(b) - u(a))
            Binary::Mul => {
                let rule = |s: &Enclosure, t: &Enclosure| &a.value * t + &b.value * s;
                Slopes::new(value, rule(&a.slope_x, &b.slope_x), rule(&a.slope_e, &b.slope_e))
            }
            Binary::Div => {
                let slope_x = quotient_rule(&value, &a.slope_x, &b.slope_x, &b.value);
                let slope_e = quotient_rule(&value, &a.slope_e, &b.slope_e, &b.value);
                Slopes::new(value, slope_x, slope_e)
            }
            // u(b)^v(b) - u(a)^v(a) = (u(b)^v(b) - u(a)^v(b)) + (u(a)^v(b) - u(a)^v(a))
            Binary::Pow => {
                let by_base = base_quotients(&a.value, &b.value);
                let by_exponent = exponent_quotients(&a.value, &b.value, &value);
                let rule = |s: &Enclosure, t: &Enclosure| &by_base * s + &by_exponent * t;
                Slopes::new(value, rule(&a.slope_x, &b.slope_x), rule(&a.slope_e, &b.slope_e))
            }
            Binary::Min | Binary::Max => extreme(operation, value, &a, &b),
        }
    }

    fn power(&mut self, base: Slopes, exponent: i32) -> Slopes {
        let value = power(&base.value, exponent);
        if !value.is_defined() {
            return Slopes::constant(value);
        }
        let quotients = power_quotients(&base.value, exponent);
        Slopes::chain(value, &quotients, &base)
    }
}

impl Expr {
    /// The value and all difference quotients in X and in E over the box `x` times `e`.
    ///
    /// Everything is undefined if the expression may be undefined somewhere in the box (in the sense of
    /// [`Expr::enclose`]). Otherwise all three are defined; slopes without a known bound, such as those of a square
    /// root at 0, have infinite ends on the side concerned. Where the expression is differentiable the slopes contain
    /// the partial derivatives; a side that is a single point has no difference quotients, and nothing is claimed
    /// about the slope along it.
    #[must_use]
    pub fn enclose_slopes(&self, x: &Enclosure, e: &Enclosure) -> Slopes {
        evaluate(&self.nodes, &mut SlopeAlgebra { x, e, precision: x.precision().max(e.precision()) })
    }
}
