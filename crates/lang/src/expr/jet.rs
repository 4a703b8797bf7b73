//! First and second partial derivatives over a box.
//!
//! Slopes decide monotonicity except where a derivative touches 0 inside terms of both signs, as that of X^2/(1 + X)
//! does at X = 0. There the second derivatives help: they bound the first ones by their values on a face.

use super::Expr;
use super::enclose::{binary, power, unary};
use super::slope::quotients;
use super::syntax::{Algebra, Argument, Binary, Unary, evaluate};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;

/// A value with its derivatives over a box. An undefined derivative says that it may fail to exist somewhere in the
/// box, and is contagious; defined ones prove that the function is twice continuously differentiable on the box
/// (one-sidedly on its boundary) and contain the derivatives at each of its points.
#[derive(Clone, Debug)]
pub(super) struct Jet {
    pub(super) value: Enclosure,
    /// In X and in E.
    pub(super) first: [Enclosure; 2],
    /// In XX, XE and EE.
    pub(super) second: [Enclosure; 3],
}

/// The two first derivatives that belong to each second one.
const PAIRS: [(usize, usize); 3] = [(0, 0), (0, 1), (1, 1)];

impl Jet {
    fn constant(value: Enclosure) -> Jet {
        let zero = Enclosure::zero(value.precision());
        Jet { value, first: [zero.clone(), zero.clone()], second: [zero.clone(), zero.clone(), zero] }
    }

    fn variable(value: &Enclosure, index: usize) -> Jet {
        let mut jet = Jet::constant(value.clone());
        jet.first[index] = Enclosure::one(value.precision());
        jet
    }

    /// The value without usable derivatives.
    fn rough(value: Enclosure) -> Jet {
        let none = Enclosure::undefined(value.precision());
        Jet { value, first: [none.clone(), none.clone()], second: [none.clone(), none.clone(), none] }
    }

    /// f(u) from f' and f'' on the range of u.
    fn chain(value: Enclosure, once: &Enclosure, twice: &Enclosure, u: &Jet) -> Jet {
        let first = [0, 1].map(|i| once * &u.first[i]);
        let second = [0, 1, 2].map(|k| {
            let (i, j) = PAIRS[k];
            let product = if i == j { u.first[i].sqr() } else { &u.first[i] * &u.first[j] };
            twice * product + once * &u.second[k]
        });
        Jet { value, first, second }
    }

    fn combine(value: Enclosure, a: &Jet, b: &Jet, rule: impl Fn(&Enclosure, &Enclosure) -> Enclosure) -> Jet {
        Jet {
            value,
            first: [0, 1].map(|i| rule(&a.first[i], &b.first[i])),
            second: [0, 1, 2].map(|k| rule(&a.second[k], &b.second[k])),
        }
    }

    fn product(value: Enclosure, u: &Jet, v: &Jet) -> Jet {
        let first = [0, 1].map(|i| &u.first[i] * &v.value + &u.value * &v.first[i]);
        let second = [0, 1, 2].map(|k| {
            let (i, j) = PAIRS[k];
            let crossed = &u.first[i] * &v.first[j] + &u.first[j] * &v.first[i];
            &u.second[k] * &v.value + crossed + &u.value * &v.second[k]
        });
        Jet { value, first, second }
    }

    /// q = u/v, by differentiating q v = u.
    fn quotient(q: Enclosure, u: &Jet, v: &Jet) -> Jet {
        let first = [0, 1].map(|i| (&u.first[i] - &q * &v.first[i]) / &v.value);
        let second = [0, 1, 2].map(|k| {
            let (i, j) = PAIRS[k];
            let crossed = &first[i] * &v.first[j] + &first[j] * &v.first[i];
            (&u.second[k] - crossed - &q * &v.second[k]) / &v.value
        });
        Jet { value: q, first, second }
    }

    fn is_constant(&self) -> bool {
        self.first.iter().chain(&self.second).all(|derivative| derivative.is_exact() && derivative.contains_zero())
    }
}

/// f'' on U, given f(U) and f'(U).
fn second_derivative(operation: Unary, range: &Enclosure, value: &Enclosure, once: &Enclosure) -> Enclosure {
    match operation {
        Unary::Neg | Unary::Abs => Enclosure::zero(range.precision()),
        Unary::Sqrt => once.negate() / (range * 2),
        Unary::Exp => value.clone(),
        Unary::Log => once.sqr().negate(),
        Unary::Sin | Unary::Cos => value.negate(),
        Unary::Tan => value * once * 2,
        Unary::Atan => range * once.sqr() * -2,
        Unary::Tanh => value * once * -2,
        Unary::Exprelr(order) => range.exprelr(order + 2),
        Unary::Sinc(order) => range.sinc(order + 2),
    }
}

struct JetAlgebra<'a> {
    x: &'a Enclosure,
    e: &'a Enclosure,
    precision: u32,
}

impl Algebra for JetAlgebra<'_> {
    type Value = Jet;

    fn number(&mut self, value: &Rational) -> Jet {
        Jet::constant(Enclosure::from_rational(value, self.precision))
    }

    fn pi(&mut self) -> Jet {
        Jet::constant(Enclosure::pi(self.precision))
    }

    fn variable(&mut self, variable: Argument) -> Jet {
        match variable {
            Argument::X => Jet::variable(self.x, 0),
            Argument::E => Jet::variable(self.e, 1),
        }
    }

    fn unary(&mut self, operation: Unary, a: Jet) -> Jet {
        let value = unary(operation, &a.value);
        // abs has a derivative only away from 0, and so does sqrt, whose quotients reach infinity at 0.
        let smooth = match operation {
            Unary::Abs | Unary::Sqrt => !a.value.contains_zero(),
            _ => true,
        };
        if !value.is_defined() || !smooth {
            return Jet::rough(value);
        }
        // On a differentiable function the enclosure of its difference quotients is one of its derivative on U.
        let once = quotients(operation, &a.value, &value);
        let twice = second_derivative(operation, &a.value, &value, &once);
        Jet::chain(value, &once, &twice, &a)
    }

    fn binary(&mut self, operation: Binary, a: Jet, b: Jet) -> Jet {
        let value = binary(operation, &a.value, &b.value);
        if !value.is_defined() {
            return Jet::rough(value);
        }
        match operation {
            Binary::Add => Jet::combine(value, &a, &b, |s, t| s + t),
            Binary::Sub => Jet::combine(value, &a, &b, |s, t| s - t),
            Binary::Mul => Jet::product(value, &a, &b),
            Binary::Div => Jet::quotient(value, &a, &b),
            Binary::Pow if b.is_constant() => {
                let less = &b.value - 1;
                let once = &b.value * a.value.pow(&less);
                let twice = &b.value * &less * a.value.pow(&(&less - 1));
                Jet::chain(value, &once, &twice, &a)
            }
            // u^v = exp(v log u)
            Binary::Pow => {
                let log = self.unary(Unary::Log, a);
                let exponent = Jet::product(&b.value * &log.value, &b, &log);
                let mut power = self.unary(Unary::Exp, exponent);
                power.value = value;
                power
            }
            Binary::Min | Binary::Max => {
                let (above, below) = if operation == Binary::Max { (a, b) } else { (b, a) };
                // Strict dominance leaves one branch, in a neighbourhood too. Equality does not: on a face of a box the
                // branches may meet although the other one prevails beside it.
                if above.value.gt(&below.value).is_true() {
                    if operation == Binary::Max { above } else { below }
                } else if below.value.gt(&above.value).is_true() {
                    if operation == Binary::Max { below } else { above }
                } else {
                    Jet::rough(value)
                }
            }
        }
    }

    fn power(&mut self, base: Jet, exponent: i32) -> Jet {
        let value = power(&base.value, exponent);
        let n = i64::from(exponent);
        let derivative = |order: i32, factor: i64| {
            if factor == 0 {
                Enclosure::zero(base.value.precision())
            } else {
                power(&base.value, exponent - order) * factor
            }
        };
        Jet::chain(value, &derivative(1, n), &derivative(2, n * (n - 1)), &base)
    }
}

impl Expr {
    /// The value and the first and second derivatives over the box `x` times `e`.
    pub(super) fn enclose_jet(&self, x: &Enclosure, e: &Enclosure) -> Jet {
        evaluate(&self.nodes, &mut JetAlgebra { x, e, precision: x.precision().max(e.precision()) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::Variables;

    fn jet(text: &str, x: [i32; 2], e: [i32; 2]) -> Jet {
        let side = |[lower, upper]: [i32; 2]| {
            Enclosure::between(&Rational::from((lower, 8)), &Rational::from((upper, 8)), 128)
        };
        Expr::parse(text, Variables::XAndE).unwrap().enclose_jet(&side(x), &side(e))
    }

    /// Central differences at a high precision come as close as their error term, far from any confusion of rules.
    #[test]
    fn derivatives_agree_with_differences() {
        for text in [
            "X*E",
            "X/E",
            "X^3*E^2",
            "X^-2*E",
            "sqrt(X + E)",
            "exp(X*E)",
            "log(X + 2*E)",
            "sin(X*E)",
            "cos(X + E^2)",
            "tan(X/2 - E/3)",
            "atan(X*E)",
            "tanh(X - E^2)",
            "exprelr(X - E^2)",
            "exprelr(8*X - 9)*E",
            "sinc(8*X - 9)*E",
            "sinc(3*X*E)",
            "abs(E - X)*X",
            "min(X^2, 9)*E",
            "max(X*E, X - 9)",
            "X^E",
            "(X + E)^(5/2)",
            "-X^2/E",
        ] {
            let expr = Expr::parse(text, Variables::XAndE).unwrap();
            let h = Rational::from((1, 1 << 20));
            let at = |i: i32, k: i32| {
                let x = Rational::from((9, 8)) + (&h * Rational::from(i));
                let e = Rational::from((13, 8)) + (&h * Rational::from(k));
                expr.at_point(&x, &e, 256).0.value
            };
            let h = Enclosure::from_rational(&h, 256);
            let differences = [
                (at(1, 0) - at(-1, 0)) / &h / 2,
                (at(0, 1) - at(0, -1)) / &h / 2,
                (at(1, 0) + at(-1, 0) - at(0, 0) * 2) / h.sqr(),
                (at(1, 1) + at(-1, -1) - at(1, -1) - at(-1, 1)) / h.sqr() / 4,
                (at(0, 1) + at(0, -1) - at(0, 0) * 2) / h.sqr(),
            ];
            let jet = jet(text, [9, 9], [13, 13]);
            for (k, derivative) in jet.first.iter().chain(&jet.second).enumerate() {
                let error = (derivative - &differences[k]).abs();
                assert!(
                    error.upper_f64() < 1e-8,
                    "{text}: derivative {k}: {derivative:?} against {:?}",
                    differences[k]
                );
            }
            let wide = self::jet(text, [8, 10], [12, 14]);
            for (wide, point) in wide.first.iter().chain(&wide.second).zip(jet.first.iter().chain(&jet.second)) {
                assert!(wide.lower() <= point.upper() && wide.upper() >= point.lower(), "{text}");
            }
        }
    }

    #[test]
    fn no_derivatives_at_edges() {
        for text in ["abs(X - 1)", "max(X, 1)", "min(X, E)", "sqrt(X - 1/2)", "0*abs(X - 1)", "(X - 1/2)^(1/2)"] {
            let jet = jet(text, [4, 12], [4, 12]);
            assert!(jet.value.is_defined() && !jet.first[0].is_defined() && !jet.second[0].is_defined(), "{text}");
        }
        // Where the branches meet on a face, neither has the derivative.
        for text in ["min(X - 1, 1 - X)", "max(X, 1)"] {
            assert!(!jet(text, [8, 8], [4, 12]).first[0].is_defined(), "{text}");
        }
        assert!(!jet("1/(X - 1)", [4, 12], [4, 12]).value.is_defined());
    }
}
