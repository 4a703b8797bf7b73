//! Growth exponents: how fast a nonnegative function grows relative to its argument.
//!
//! A function u >= 0 of X >= 0 has growth in `[alpha, beta]` on a box when
//! `(b/a)^alpha u(a) <= u(b) <= (b/a)^beta u(a)` for all 0 < a < b in the X side and every E; likewise in E. If
//! alpha >= 0 then u is nondecreasing (down to X = 0 by continuity), if beta <= 0 nonincreasing. Growth is exact where
//! slopes lose the most: X/(1 + X) has growth `1 - [0, 1]`, X^2/(1 + X) has `2 - [0, 1]`, on boxes of any size and
//! also where the function or its derivative vanishes.
//!
//! A growth is an [`Enclosure`] of exponents, undefined where nothing is known, in particular where u may be negative.

use super::syntax::{Binary, Unary};
use rug::Float;
use rug::float::Special;
use sigmastar_exact::enclosure::Enclosure;

/// What monotonicity alone says, in the direction of a sign: of f(u) for a nondecreasing f if `sign` is the growth of
/// u, of u itself if `sign` is its slope.
fn monotone(sign: &Enclosure) -> Enclosure {
    let p = sign.precision();
    if !sign.is_defined() {
        return Enclosure::undefined(p);
    }
    let end = |bounded: bool, otherwise| if bounded { Float::new(p) } else { Float::with_val(p, otherwise) };
    Enclosure::new(
        end(sign.is_nonnegative().is_true(), Special::NegInfinity),
        end(sign.negate().is_nonnegative().is_true(), Special::Infinity),
    )
}

/// The growth of f(u) from that of u >= 0.
pub(super) fn unary(operation: Unary, growth: &Enclosure) -> Enclosure {
    match operation {
        Unary::Sqrt => growth / 2,
        Unary::Abs => growth.clone(),
        // Concave, nondecreasing and 0 at 0: f(m t) lies between f(t) and m f(t) for every m > 0.
        Unary::Atan | Unary::Tanh => growth.hull(&Enclosure::zero(growth.precision())),
        Unary::Exp | Unary::Log => monotone(growth),
        // It decreases.
        Unary::Exprelr(0) => monotone(&growth.negate()),
        Unary::Neg | Unary::Sin | Unary::Cos | Unary::Tan | Unary::Exprelr(_) | Unary::Sinc(_) => {
            Enclosure::undefined(growth.precision())
        }
    }
}

/// The growth of a sum, product, quotient, minimum or maximum from those of its operands, both nonnegative. For a
/// sum, minimum and maximum the smaller exponent serves both operands from below and the larger from above.
pub(super) fn binary(operation: Binary, a: &Enclosure, b: &Enclosure) -> Enclosure {
    match operation {
        Binary::Add | Binary::Min | Binary::Max => a.hull(b),
        Binary::Mul => a + b,
        Binary::Div => a - b,
        Binary::Sub | Binary::Pow => Enclosure::undefined(a.precision()),
    }
}

/// The growth of u >= 0 from its range and its slopes along a side of the box.
///
/// Where u > 0 the lower Dini derivative of log u is at least `m/X` with m the least value of `X slope / u`, so that
/// `log u - m log X` is nondecreasing; and correspondingly from above. Elsewhere only the sign of the slope tells.
pub(super) fn from_slope(side: &Enclosure, value: &Enclosure, slope: &Enclosure) -> Enclosure {
    if value.is_positive().is_true() {
        let exponent = side * slope / value;
        either(&monotone(slope), &exponent)
    } else {
        monotone(slope)
    }
}

/// Two growths of the same function, combined. They may be disjoint only where every exponent serves (u = 0, or a
/// side that is a single point); then the first is as good as any.
pub(super) fn either(first: &Enclosure, second: &Enclosure) -> Enclosure {
    let common = first.intersect(second);
    match (common.is_defined(), first.is_defined()) {
        (true, _) => common,
        (false, true) => first.clone(),
        (false, false) => second.clone(),
    }
}

/// Slopes of a function with a known growth: nonnegative ones if it is nondecreasing, nonpositive ones if
/// nonincreasing.
pub(super) fn tightened(slope: Enclosure, growth: &Enclosure) -> Enclosure {
    let zero = Enclosure::zero(slope.precision());
    let slope = if growth.is_nonnegative().is_true() { slope.max(&zero) } else { slope };
    if growth.negate().is_nonnegative().is_true() { slope.min(&zero) } else { slope }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rug::Rational;

    fn interval(lower: i32, upper: i32) -> Enclosure {
        Enclosure::between(&Rational::from(lower), &Rational::from(upper), 64)
    }

    #[test]
    fn rules() {
        let (a, b) = (interval(-1, 2), interval(1, 3));
        assert_eq!(binary(Binary::Add, &a, &b), interval(-1, 3));
        assert_eq!(binary(Binary::Max, &a, &b), interval(-1, 3));
        assert_eq!(binary(Binary::Mul, &a, &b), interval(0, 5));
        assert_eq!(binary(Binary::Div, &a, &b), interval(-4, 1));
        assert_eq!(unary(Unary::Sqrt, &interval(-2, 4)), interval(-1, 2));
        assert_eq!(unary(Unary::Atan, &b), interval(0, 3));
        assert_eq!(unary(Unary::Tanh, &interval(-3, -1)), interval(-3, 0));
        assert_eq!(unary(Unary::Log, &a), Enclosure::entire(64));
        let rising = unary(Unary::Exp, &b);
        assert!(rising.lower() == 0 && rising.upper().is_infinite());
        let falling = unary(Unary::Exprelr(0), &b);
        assert!(falling.upper() == 0 && falling.lower().is_infinite());
    }

    #[test]
    fn nothing_is_known_where_nothing_can_be() {
        let b = interval(1, 3);
        assert!(!binary(Binary::Sub, &b, &b).is_defined());
        assert!(!binary(Binary::Add, &b, &Enclosure::undefined(64)).is_defined());
        for operation in [Unary::Neg, Unary::Sin, Unary::Cos, Unary::Tan, Unary::Sinc(0), Unary::Exprelr(1)] {
            assert!(!unary(operation, &b).is_defined());
        }
    }

    #[test]
    fn slopes_bound_growth_where_the_value_is_positive() {
        let side = interval(0, 2);
        assert_eq!(from_slope(&side, &interval(1, 4), &interval(-1, 3)), interval(-2, 6));
        assert_eq!(from_slope(&side, &interval(1, 4), &interval(1, 3)), interval(0, 6));
        let touching = from_slope(&side, &interval(0, 4), &interval(1, 3));
        assert!(touching.lower() == 0 && touching.upper().is_infinite());
        assert_eq!(from_slope(&side, &interval(0, 4), &interval(-1, 3)), Enclosure::entire(64));
    }

    #[test]
    fn signs_tighten_slopes() {
        assert_eq!(tightened(interval(-1, 3), &interval(0, 5)), interval(0, 3));
        assert_eq!(tightened(interval(-1, 3), &interval(-5, 0)), interval(-1, 0));
        assert_eq!(tightened(interval(-1, 3), &interval(-5, 5)), interval(-1, 3));
        assert_eq!(tightened(interval(-1, 3), &Enclosure::undefined(64)), interval(-1, 3));
    }
}
