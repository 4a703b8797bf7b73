//! Taylor series of formulas along a curve, over enclosures: automatic differentiation in t by the classical recurrences
//! (Moore, Interval Analysis, 1966), for the rule of 11.6.
//!
//! The variable is `d`, with `t = t_0 + T d`: the unit of time is the period, so that no coefficient overflows for the unit
//! that somebody measures time in.

use super::recurrences as series;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::expr::{Binary, Operations, PlantVariable, Unary, enclosed_step};

/// The coefficients of 1, d, d^2, ...; what is not there is 0.
///
/// Guarantee of [`TaylorAlgebra`]: where the coefficients of the variables contain those of smooth functions of t at every
/// `t_0` of an interval (or at one `t_0`), and all coefficients of the result are defined, the formula along them is smooth near
/// each of these `t_0`, and its coefficients there lie in those of the result.
pub(super) type Taylor = Vec<Enclosure>;

/// The algebra of Taylor series up to an order; an operation that may not be smooth is undefined, in its first coefficient.
pub(super) struct TaylorAlgebra<'a> {
    /// t as a function of d.
    pub(super) time: &'a Taylor,
    /// The states.
    pub(super) states: &'a [Taylor],
    /// The parameters of which intervals are known.
    pub(super) parameters: &'a [Enclosure],
    /// The highest power of d that is kept.
    pub(super) order: usize,
    /// Of constants, in bits.
    pub(super) precision: u32,
}

impl Operations for TaylorAlgebra<'_> {
    type Value = Taylor;

    fn number(&mut self, value: &Rational) -> Taylor {
        vec![Enclosure::from_rational(value, self.precision)]
    }

    fn pi(&mut self) -> Taylor {
        vec![Enclosure::pi(self.precision)]
    }

    fn variable(&mut self, variable: PlantVariable) -> Taylor {
        match variable {
            PlantVariable::Time => self.time.clone(),
            PlantVariable::Error => vec![Enclosure::zero(self.precision)],
            PlantVariable::State(index) => {
                self.states.get(index).cloned().unwrap_or_else(|| vec![Enclosure::undefined(self.precision)])
            }
            PlantVariable::Parameter(index) => {
                vec![self.parameters.get(index).cloned().unwrap_or_else(|| Enclosure::undefined(self.precision))]
            }
        }
    }

    fn unary(&mut self, operation: Unary, a: &Taylor) -> Taylor {
        let order = self.order;
        match operation {
            Unary::Neg => a.iter().map(Enclosure::negate).collect(),
            Unary::Sqrt => series::sqrt(a, order),
            Unary::Exp => series::exp(a, order),
            Unary::Log => series::log(a, order),
            Unary::Sin => series::sin_cos(a, order)[0].clone(),
            Unary::Cos => series::sin_cos(a, order)[1].clone(),
            Unary::Tan => series::tangent(a, order, 1),
            Unary::Tanh => series::tangent(a, order, -1),
            Unary::Atan => series::atan(a, order),
            Unary::Exprelr(order_of) => series::exprelr(a, order_of, order),
            Unary::Sinc(order_of) => series::sinc(a, order_of, order),
            Unary::Abs => {
                if a[0].is_positive().is_true() {
                    a.clone()
                } else if a[0].negate().is_positive().is_true() {
                    a.iter().map(Enclosure::negate).collect()
                } else {
                    vec![Enclosure::undefined(self.precision)]
                }
            }
        }
    }

    fn binary(&mut self, operation: Binary, a: &Taylor, b: &Taylor) -> Taylor {
        let order = self.order;
        match operation {
            Binary::Add => series::combine(a, b, 1),
            Binary::Sub => series::combine(a, b, -1),
            Binary::Mul => series::mul(a, b, order),
            Binary::Div => series::div(a, b, order),
            // For a base that is not positive the real power need not be smooth: the logarithm is undefined there.
            Binary::Pow => series::exp(&series::mul(b, &series::log(a, order), order), order),
            Binary::Min | Binary::Max => {
                let first = match operation {
                    Binary::Min => a[0].lt(&b[0]),
                    _ => a[0].gt(&b[0]),
                };
                let second = match operation {
                    Binary::Min => b[0].lt(&a[0]),
                    _ => b[0].gt(&a[0]),
                };
                // What is not chosen must exist as well.
                let defined = a.iter().chain(b).all(Enclosure::is_defined);
                match defined {
                    true if first.is_true() => a.clone(),
                    true if second.is_true() => b.clone(),
                    _ => vec![Enclosure::undefined(self.precision)],
                }
            }
        }
    }

    fn power(&mut self, base: &Taylor, exponent: i32) -> Taylor {
        series::power(base, exponent, self.order)
    }

    /// A constant where it is known: the sign does not change near the points.
    fn step(&mut self, a: &Taylor) -> Taylor {
        vec![enclosed_step(&a[0])]
    }
}

/// A function of t on a cell: its Taylor polynomial about the middle, and its rest.
///
/// Guarantee: `g(t_0 + T d) = sum_{j<N} c_j d^j + R d^N` for `|d| <= half`, with some number in each of the enclosures; R may
/// depend on d (Lagrange's form: R is the coefficient of d^N at a point of the cell).
pub(super) struct Expansion {
    /// c_0, ..., c_{N-1}.
    pub(super) polynomial: Taylor,
    /// The coefficient of d^N at every point of the cell.
    pub(super) rest: Enclosure,
    /// The order N, at least 1.
    pub(super) order: usize,
}

impl Expansion {
    /// From the series about the middle of the cell and the series over the cell, both of order N at least.
    pub(super) fn new(middle: &[Enclosure], cell: &[Enclosure], order: usize, precision: u32) -> Expansion {
        let zero = Enclosure::zero(precision);
        // A rest that is proved over the cell says something only where the function is smooth all over it.
        let smooth = cell.iter().all(Enclosure::is_defined);
        let rest = if smooth { cell.get(order).cloned().unwrap_or(zero) } else { Enclosure::undefined(precision) };
        Expansion { polynomial: middle.iter().take(order).cloned().collect(), rest, order }
    }

    /// An upper bound of |g| on the cell of half-width `half` in periods.
    pub(super) fn bound(&self, half: &Enclosure) -> Enclosure {
        horner(self.polynomial.iter().map(Enclosure::abs), self.rest.abs(), self.order, half)
    }

    /// An upper bound of |dg/dd| on the cell; per time it is 1/T of that. The rest of g' is, again by Lagrange's form for g',
    /// of order N - 1 with the coefficient N R'.
    pub(super) fn slope_bound(&self, half: &Enclosure) -> Enclosure {
        let slopes: Taylor = self.polynomial.iter().zip(0_i64..).skip(1).map(|(c, j)| c.abs() * j).collect();
        horner(slopes.into_iter(), self.rest.abs() * self.order as i64, self.order - 1, half)
    }
}

/// `sum_j c_j half^j + rest half^order` with nonnegative terms, rounded up.
fn horner(
    coefficients: impl DoubleEndedIterator<Item = Enclosure> + ExactSizeIterator,
    rest: Enclosure,
    order: usize,
    half: &Enclosure,
) -> Enclosure {
    let gap = order.saturating_sub(coefficients.len());
    let start = (0..gap).fold(rest, |value, _| value * half);
    coefficients.rev().fold(start, |value, c| value * half + c).ceiling()
}

#[cfg(test)]
mod tests {
    use super::*;
    use sigmastar_lang::expr::{Formulas, PlantExpr, PlantNames};

    fn taylor(text: &str, t: &Enclosure, order: usize) -> Taylor {
        let names = PlantNames::new(vec!["x".to_owned()]).unwrap();
        let mut formulas = Formulas::new();
        let formula = formulas.insert(&PlantExpr::parse(text, &names).unwrap());
        let time = vec![t.clone(), Enclosure::one(128)];
        // x = 2 + t^2.
        let x = vec![Enclosure::from_integer(2, 128) + t.sqr(), t * 2, Enclosure::one(128)];
        let mut algebra = TaylorAlgebra { time: &time, states: &[x], parameters: &[], order, precision: 128 };
        let mut values = formulas.walk(&[formula]).evaluate(&mut algebra);
        values.remove(0)
    }

    const SMOOTH: [&str; 18] = [
        "x*t - t/x + 3",
        "sin(x*t) + cos(x)^3",
        "exp(-t^2) + log(1 + x)",
        "sqrt(1 + x^2)",
        "tan(x/3) + tanh(t*x)",
        "atan(t*x)*abs(x) + abs(-x)",
        "max(x, t) + min(t, x + 1)",
        "x^(t/2)",
        "x^-3 + 2^t",
        "cos(2*pi*t)^4 - x^7",
        "1/(1 + sin(t)^2)",
        "0*t + x^0",
        "(3 - x)^3 - (-x)^-1",
        "exp(sin(exp(cos(t))))",
        "exprelr(t)*exprelr(t - 0.31)",
        "exprelr(x*t) + exprelr(0)*x",
        "sinc(t)*sinc(t - 0.31) - sinc(0)",
        "sinc(5*x*(t - 0.29)) + sinc(t - 20)",
    ];

    /// At another point of the cell the polynomial with its rest is the value, and the coefficients over the cell contain
    /// those about that point.
    #[test]
    fn expansions_contain_what_they_expand() {
        let order = 9;
        for text in SMOOTH {
            let (centre, half) = (Rational::from((3, 10)), Rational::from((1, 32)));
            let [middle, cell] = [Rational::new(), half.clone()].map(|width| {
                let ends = [Rational::from(&centre - &width), Rational::from(&centre + &width)];
                taylor(text, &Enclosure::between(&ends[0], &ends[1], 128), order)
            });
            let expansion = Expansion::new(&middle, &cell, order, 128);
            for numerator in [-4, -3, 1, 2, 4] {
                let d = Rational::from(&half * numerator) / 4_u32;
                let at = taylor(text, &Enclosure::from_rational(&Rational::from(&centre + &d), 128), order);
                let zero = Enclosure::zero(128);
                for (j, coefficient) in at.iter().enumerate() {
                    let over = cell.get(j).unwrap_or(&zero);
                    assert!(over.lower() <= coefficient.upper() && coefficient.lower() <= over.upper(), "{text} {j}");
                }
                let power = Enclosure::from_rational(&d, 128);
                let rest = &expansion.rest * power.pow_integer(&order.into());
                let terms = expansion.polynomial.iter().enumerate();
                let sum = terms.fold(rest, |sum, (j, c)| sum + c * power.pow_integer(&j.into()));
                assert!(sum.lower() <= at[0].upper() && at[0].lower() <= sum.upper(), "{text} {d}");
                assert!((sum.upper() - sum.lower()) < 1e-6, "{text}: {sum:?}");
                let half = Enclosure::from_rational(&half, 128);
                assert!(at[0].abs().le(&expansion.bound(&half)).is_true(), "{text}");
                let slope = at.get(1).unwrap_or(&zero).abs();
                assert!(slope.le(&expansion.slope_bound(&half)).is_true(), "{text}");
            }
        }
    }

    #[test]
    fn what_is_not_smooth_is_undefined() {
        let cell = Enclosure::between(&Rational::from((-1, 8)), &Rational::from((1, 8)), 128);
        for text in [
            "1/t",
            "sqrt(t)",
            "log(t)",
            "abs(t)",
            "max(t, 0)",
            "min(x, 2 + t)",
            "t^(1/2)",
            "tan(pi/2 + t)",
            "t^-2",
            "0*abs(t)",
            "max(x, sqrt(t))",
            "sqrt(0)",
        ] {
            let value = taylor(text, &cell, 6);
            assert!(!Expansion::new(&value, &value, 6, 128).bound(&Enclosure::one(128)).is_defined(), "{text}");
        }
    }
}
