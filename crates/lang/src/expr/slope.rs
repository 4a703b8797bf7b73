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
use super::growth;
use super::polynomial::{Kind, Role};
use super::syntax::{Algebra, Argument, Binary, Unary, evaluate};
use rug::float::Special;
use rug::{Float, Rational};
use sigmastar_exact::enclosure::Enclosure;

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
    Enclosure::new(lower.lower(), Float::with_val(lower.precision(), Special::Infinity))
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
        Unary::Exprelr(order) => range.exprelr(order + 1),
        Unary::Sinc(order) => range.sinc(order + 1),
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

/// Slopes of the smaller or larger of u and v.
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

/// Slopes with the growth exponents in X and in E, which decide signs that the slope rules lose.
struct Item {
    slopes: Slopes,
    growth: [Enclosure; 2],
    /// The slopes of what is left of a sum without its polynomial parts; the sum of the two contains the slopes.
    rest: Option<[Enclosure; 2]>,
}

struct SlopeAlgebra<'a> {
    sides: [&'a Enclosure; 2],
    precision: u32,
    /// What the nodes are as polynomials, where that helps, and the next node.
    roles: &'a [Role],
    at: usize,
}

impl SlopeAlgebra<'_> {
    /// Joins what the rules say about slopes with what they say about growth and, at the end of a sum, about the
    /// derivative of its polynomial parts. Called once for each node, in their order.
    fn close(&mut self, mut slopes: Slopes, rule: [Enclosure; 2], rest: Option<[Enclosure; 2]>) -> Item {
        let role = self.roles.get(self.at);
        self.at += 1;
        if let Some(role) = role.filter(|_| slopes.value.is_defined()) {
            for (along, derivative) in role.derivatives.iter().enumerate() {
                let (Some(derivative), Some(rest)) = (derivative, &rest) else { continue };
                let collected = derivative.enclose(self.sides[along]) + &rest[along];
                let slope = if along == 0 { &mut slopes.slope_x } else { &mut slopes.slope_e };
                // On a side that is a single point there are no slopes, and nothing that two enclosures had in common.
                let both = slope.intersect(&collected);
                if both.is_defined() {
                    *slope = both;
                }
            }
        }
        let nonnegative = slopes.value.is_nonnegative().is_true();
        let mut growth = rule;
        for (along, growth) in growth.iter_mut().enumerate() {
            let side = self.sides[along];
            if !nonnegative || !side.is_nonnegative().is_true() {
                *growth = Enclosure::undefined(self.precision);
                continue;
            }
            let slope = if along == 0 { &mut slopes.slope_x } else { &mut slopes.slope_e };
            *growth = growth::either(growth, &growth::from_slope(side, &slopes.value, slope));
            *slope = growth::tightened(slope.clone(), growth);
        }
        // What is no sum and no polynomial is a rest as a whole.
        let whole = || [slopes.slope_x.clone(), slopes.slope_e.clone()];
        let rest = role.map(|role| if matches!(role.kind, Kind::Rest) { whole() } else { rest.unwrap_or_else(whole) });
        Item { slopes, growth, rest }
    }

    fn zeros(&self) -> [Enclosure; 2] {
        [Enclosure::zero(self.precision), Enclosure::zero(self.precision)]
    }

    /// The rest of a node: nothing for a polynomial, that of the operands for a sum.
    fn rest(&self, of_operands: impl FnOnce() -> Option<[Enclosure; 2]>) -> Option<[Enclosure; 2]> {
        match self.roles.get(self.at)?.kind {
            Kind::Polynomial => Some(self.zeros()),
            Kind::Sum => of_operands(),
            Kind::Rest => None,
        }
    }

    fn constant(&mut self, value: Enclosure) -> Item {
        let rest = self.rest(|| None);
        self.close(Slopes::constant(value), self.zeros(), rest)
    }

    fn seed(&mut self, along: usize) -> Item {
        let mut unit = self.zeros();
        unit[along] = Enclosure::one(self.precision);
        let [slope_x, slope_e] = unit.clone();
        let rest = self.rest(|| None);
        self.close(Slopes::new(self.sides[along].clone(), slope_x, slope_e), unit, rest)
    }
}

impl Algebra for SlopeAlgebra<'_> {
    type Value = Item;

    fn number(&mut self, value: &Rational) -> Item {
        self.constant(Enclosure::from_rational(value, self.precision))
    }

    fn pi(&mut self) -> Item {
        self.constant(Enclosure::pi(self.precision))
    }

    fn variable(&mut self, variable: Argument) -> Item {
        match variable {
            Argument::X => self.seed(0),
            Argument::E => self.seed(1),
        }
    }

    fn unary(&mut self, operation: Unary, a: Item) -> Item {
        let value = unary(operation, &a.slopes.value);
        if !value.is_defined() {
            return self.constant(value);
        }
        let quotients = quotients(operation, &a.slopes.value, &value);
        let growth = a.growth.map(|growth| growth::unary(operation, &growth));
        // Of functions of one argument only the negative is a sum.
        let rest = self.rest(|| a.rest.map(|rest| rest.map(|slope| slope.negate())));
        self.close(Slopes::chain(value, &quotients, &a.slopes), growth, rest)
    }

    fn binary(&mut self, operation: Binary, a: Item, b: Item) -> Item {
        let mut growth = [0, 1].map(|along| growth::binary(operation, &a.growth[along], &b.growth[along]));
        let rest = self.rest(|| {
            let (a, b) = a.rest.as_ref().zip(b.rest.as_ref())?;
            Some([0, 1].map(|along| binary(operation, &a[along], &b[along])))
        });
        let (a_growth, a, b) = (a.growth, a.slopes, b.slopes);
        let value = binary(operation, &a.value, &b.value);
        if !value.is_defined() {
            return self.constant(value);
        }
        let slopes = match operation {
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
                if is_zero(&b.slope_x) && is_zero(&b.slope_e) {
                    growth = a_growth.map(|growth| growth * &b.value);
                }
                let by_base = base_quotients(&a.value, &b.value);
                let by_exponent = exponent_quotients(&a.value, &b.value, &value);
                let rule = |s: &Enclosure, t: &Enclosure| &by_base * s + &by_exponent * t;
                Slopes::new(value, rule(&a.slope_x, &b.slope_x), rule(&a.slope_e, &b.slope_e))
            }
            Binary::Min | Binary::Max => extreme(operation, value, &a, &b),
        };
        self.close(slopes, growth, rest)
    }

    fn power(&mut self, base: Item, exponent: i32) -> Item {
        let value = power(&base.slopes.value, exponent);
        if !value.is_defined() {
            return self.constant(value);
        }
        let quotients = power_quotients(&base.slopes.value, exponent);
        let growth = base.growth.map(|growth| growth * i64::from(exponent));
        let rest = self.rest(|| None);
        self.close(Slopes::chain(value, &quotients, &base.slopes), growth, rest)
    }
}

/// Whether an enclosure is exactly 0.
pub(super) fn is_zero(value: &Enclosure) -> bool {
    value.is_exact() && value.contains_zero()
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
        let precision = x.precision().max(e.precision());
        let mut algebra = SlopeAlgebra { sides: [x, e], precision, roles: self.roles(), at: 0 };
        evaluate(&self.nodes, &mut algebra).slopes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::Variables;
    use sigmastar_exact::number::parse_decimal;

    fn slopes(text: &str, x: [&str; 2], e: [&str; 2]) -> Slopes {
        let side = |[lower, upper]: [&str; 2]| {
            Enclosure::between(&parse_decimal(lower).unwrap(), &parse_decimal(upper).unwrap(), 96)
        };
        Expr::parse(text, Variables::XAndE).unwrap().enclose_slopes(&side(x), &side(e))
    }

    #[test]
    fn slopes_in_x_over_a_box() {
        let inf = f64::INFINITY;
        for (text, x, lower, upper) in [
            ("X", ["0", "1"], 1.0, 1.0),
            ("3*X - X", ["0", "1"], 2.0, 2.0),
            ("-X^2", ["1", "2"], -4.0, -2.0),
            ("X^3", ["-1", "2"], 0.0, 12.0),
            ("X^0", ["-1", "2"], 0.0, 0.0),
            ("X^-2", ["1", "2"], -2.0, -0.25),
            ("sqrt(X)", ["0", "4"], 0.25, inf),
            ("sqrt(X)", ["1", "4"], 0.25, 0.5),
            ("1 - sqrt(X)", ["0", "4"], -inf, -0.25),
            ("sqrt(X)*0", ["0", "4"], 0.0, 0.0),
            ("sqrt(X^2)", ["0", "4"], 0.0, inf),
            ("abs(X)", ["-1", "2"], -1.0, 1.0),
            ("abs(X)", ["-2", "-1"], -1.0, -1.0),
            ("max(X, 1)", ["0", "2"], 0.0, 1.0),
            ("max(X, 1)", ["2", "3"], 1.0, 1.0),
            ("min(X, 1)", ["2", "3"], 0.0, 0.0),
            ("min(X, 1)", ["0", "1"], 1.0, 1.0),
            ("1/X", ["1", "2"], -1.0, -0.25),
            ("X^(1/2)", ["0", "4"], 0.25, inf),
            ("X^(3/2)", ["0", "4"], 0.0, 3.0),
            ("X^E", ["1", "4"], 1.0, 8.0),
            ("X^(E/2)", ["0", "4"], 0.25, inf),
            ("X^(E - 1/2)", ["0", "4"], 0.0, inf),
            ("1 - cos(X)", ["0", "0.5"], 0.0, 0.4794255386042031),
            ("X - sin(X)", ["0", "0.5"], 0.0, 0.1224174381096273),
            ("exp(X)", ["0", "1"], 1.0, std::f64::consts::E),
            ("log(X)", ["1", "2"], 0.5, 1.0),
            ("atan(X)", ["-1", "2"], 0.2, 1.0),
            ("tan(X)", ["-0.5", "0.5"], 1.0, 1.298446410409525),
            ("tanh(X)", ["0", "0.5"], 0.7864477329659274, 1.0),
        ] {
            let slope = slopes(text, x, ["1", "2"]).slope_x;
            let close = |a: f64, b: f64| a == b || (a - b).abs() < 1e-12;
            let found = (slope.lower_f64(), slope.upper_f64());
            assert!(close(found.0, lower) && close(found.1, upper), "{text}: {found:?}");
        }
    }

    #[test]
    fn slopes_in_e_follow_the_same_rules() {
        for (text, lower, upper) in
            [("X*E^2", 2.0, 16.0), ("X - 2*E", -2.0, -2.0), ("3^E", 3.2958, 9.8876), ("0^E", 0.0, 0.0)]
        {
            let slope = slopes(text, ["1", "4"], ["1", "2"]).slope_e;
            assert!((slope.lower_f64() - lower).abs() < 1e-4 && (slope.upper_f64() - upper).abs() < 1e-4, "{text}");
        }
        // X^E log X has its least value -1/(e E) inside, and X log X -> 0 at 0.
        let slope = slopes("X^E", ["0", "2"], ["1", "2"]).slope_e;
        assert!(slope.lower_f64() <= -0.3678 && slope.lower_f64() > -0.37);
        assert!(slope.upper_f64() >= 4.0 * 2_f64.ln() && slope.upper_f64() < 2.8);
    }

    #[test]
    fn an_undefined_value_leaves_nothing_defined() {
        for text in ["1/X", "sqrt(X)", "log(X)", "X^(1/2)", "0*(1/X)", "X^-1", "max(5, log(X))", "tan(2*X)"] {
            let slopes = slopes(text, ["-1", "1"], ["0", "1"]);
            assert!(
                !slopes.value.is_defined() && !slopes.slope_x.is_defined() && !slopes.slope_e.is_defined(),
                "{text}"
            );
        }
    }

    #[test]
    fn growth_decides_where_slopes_lose() {
        for text in
            ["X/(1 + X)", "X^2/(1 + X)", "E*X^2/(1 + X)", "X/sqrt(1 + X^2)", "sqrt(X)/(1 + sqrt(X))", "X*E/(1 + X + E)"]
        {
            let slopes = slopes(text, ["0", "1e12"], ["0", "1e12"]);
            assert!(slopes.slope_x.is_nonnegative().is_true() && slopes.slope_e.negate().upper_f64() >= 0.0, "{text}");
        }
        for text in [
            "X/(1 + X^2)",
            "X^2/(1 + X^3)",
            "1/(1 + X)",
            "(1 + X)/(1 + 2*X)",
            "X*exp(-X)",
            "X/exp(X)",
            "X/log(2 + X)^9",
        ] {
            let slopes = slopes(text, ["0", "1e12"], ["0", "1e12"]);
            assert!(!slopes.slope_x.is_nonnegative().is_true(), "{text}");
        }
    }
}
