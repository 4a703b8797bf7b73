//! First and second derivatives of an expression on a piece, for derivatives that vanish at its edge.
//!
//! Where a derivative is defined here the expression is twice continuously differentiable on the piece, and the interval
//! contains the derivative at each of its points; everywhere else it is undefined, which spreads.

use crate::expr::{Expr, Op, interval_op, slope_op};
use crate::interval::Interval;

/// The value, its derivatives in X and E, and those in XX, XE, EE.
#[derive(Clone)]
pub(super) struct Jet {
    value: Interval,
    first: [Interval; 2],
    second: [Interval; 3],
}

/// The axes of each second derivative.
const AXES: [[usize; 2]; 3] = [[0, 0], [0, 1], [1, 1]];

impl Jet {
    /// A constant, where it is one: of what is not defined no derivative is known.
    fn constant(value: Interval) -> Jet {
        if !value.is_defined() {
            return Jet::without_derivatives(value);
        }
        let zero = Interval::int(0, value.precision());
        Jet { first: [zero.clone(), zero.clone()], second: [zero.clone(), zero.clone(), zero], value }
    }

    fn without_derivatives(value: Interval) -> Jet {
        let none = Interval::undefined(value.precision());
        Jet { first: [none.clone(), none.clone()], second: [none.clone(), none.clone(), none], value }
    }

    /// f(u), from f'(u) and f''(u).
    fn chain(value: Interval, once: &Interval, twice: &Interval, u: &Jet) -> Jet {
        Jet {
            value,
            first: [0, 1].map(|i| once * &u.first[i]),
            second: [0, 1, 2].map(|k| twice * u.product(k, u) + once * &u.second[k]),
        }
    }

    /// The product of the first derivatives that belong to the k-th second one: u_i v_j.
    fn product(&self, k: usize, other: &Jet) -> Interval {
        let [i, j] = AXES[k];
        if std::ptr::eq(self, other) && i == j { self.first[i].sqr() } else { &self.first[i] * &other.first[j] }
    }

    fn linear(value: Interval, u: &Jet, v: &Jet, rule: impl Fn(&Interval, &Interval) -> Interval) -> Jet {
        Jet {
            value,
            first: [0, 1].map(|i| rule(&u.first[i], &v.first[i])),
            second: [0, 1, 2].map(|k| rule(&u.second[k], &v.second[k])),
        }
    }

    fn times(value: Interval, u: &Jet, v: &Jet) -> Jet {
        Jet {
            value,
            first: [0, 1].map(|i| &u.first[i] * &v.value + &u.value * &v.first[i]),
            second: [0, 1, 2].map(|k| {
                let crossed = u.product(k, v) + v.product(k, u);
                &u.second[k] * &v.value + crossed + &u.value * &v.second[k]
            }),
        }
    }

    fn is_constant(&self) -> bool {
        self.first.iter().chain(&self.second).all(Interval::is_zero)
    }
}

/// f' and f'' on the range u of an operation with one operand; `value` is f there.
fn derivatives(op: &Op, u: &Interval, value: &Interval) -> Option<[Interval; 2]> {
    let zero = || Interval::int(0, u.precision());
    let once = match op {
        Op::Sqrt => (value * 2).recip(),
        Op::Abs if u.sign().is_defined() => u.sign(),
        _ => slope_op(op, u, value)?,
    };
    let twice = match op {
        Op::Sqrt => -(&once / (u * 2)),
        Op::Exp => value.clone(),
        Op::Log => -u.sqr().recip(),
        Op::Sin | Op::Cos => -value,
        Op::Tan => value * &once * 2,
        Op::Atan => -(u * once.sqr() * 2),
        Op::Tanh => -(value * &once * 2),
        Op::Exprelr(order) => u.exprelr(order + 2),
        Op::Sinc(order) => u.sinc(order + 2),
        Op::Power(0 | 1) => zero(),
        Op::Power(n) => u.powi(n - 2) * (i64::from(*n) * i64::from(n - 1)),
        _ => zero(),
    };
    Some([once, twice])
}

fn apply(op: &Op, sides: [&Interval; 2], a: Option<Jet>, b: Option<Jet>) -> Jet {
    let none = Interval::undefined(sides[0].precision());
    if let Op::Variable(along @ (0 | 1)) = *op {
        let mut jet = Jet::constant(sides[along].clone());
        jet.first[along] = Interval::int(1, none.precision());
        return jet;
    }
    let [u, v] = [&a, &b].map(|jet| jet.as_ref().map_or(&none, |jet| &jet.value));
    let value = interval_op(op, u, v);
    if [&a, &b].into_iter().flatten().all(Jet::is_constant) {
        return Jet::constant(value);
    }
    let jet = match (op, &a, &b) {
        (Op::Add, Some(a), Some(b)) => Jet::linear(value.clone(), a, b, |a, b| a + b),
        (Op::Sub, Some(a), Some(b)) => Jet::linear(value.clone(), a, b, |a, b| a - b),
        (Op::Mul, Some(a), Some(b)) => Jet::times(value.clone(), a, b),
        (Op::Div, Some(a), Some(b)) => {
            let inverse = v.recip();
            let once = -inverse.sqr();
            let twice = &inverse * inverse.sqr() * 2;
            Jet::times(value.clone(), a, &Jet::chain(inverse, &once, &twice, b))
        }
        // Only where it is certain which one it is.
        (Op::Min, Some(a), Some(b)) if u.lt(v) == Some(true) => a.clone(),
        (Op::Min, Some(_), Some(b)) if v.lt(u) == Some(true) => b.clone(),
        (Op::Max, Some(a), Some(b)) if v.lt(u) == Some(true) => a.clone(),
        (Op::Max, Some(_), Some(b)) if u.lt(v) == Some(true) => b.clone(),
        (Op::Pow, Some(a), Some(b)) if b.is_constant() => {
            let [below, least] = [v - 1, v - 2].map(|exponent| u.pow(&exponent));
            Jet::chain(value.clone(), &(v * below), &(v * (v - 1) * least), a)
        }
        // u^v = exp(v log u).
        (Op::Pow, Some(a), Some(b)) => {
            let log = Jet::chain(u.log(), &u.recip(), &-u.sqr().recip(), a);
            let exponent = Jet::times(v * &log.value, b, &log);
            Jet::chain(value.clone(), &value, &value, &exponent)
        }
        (_, Some(a), None) => match derivatives(op, u, &value) {
            Some([once, twice]) => Jet::chain(value.clone(), &once, &twice, a),
            None => Jet::without_derivatives(value.clone()),
        },
        _ => Jet::without_derivatives(value.clone()),
    };
    if value.is_defined() { jet } else { Jet::without_derivatives(value) }
}

/// The jet on the piece.
pub(super) fn jet(expr: &Expr, sides: [&Interval; 2]) -> Option<Jet> {
    expr.fold(|op, a, b| apply(op, sides, a, b))
}

/// Whether the derivative along an axis is proved nonnegative on the piece: by its enclosure on a face, an edge or the middle of
/// the piece (on the whole of it, where nothing is `moved`) and its own derivatives from there on. `whole` is the jet of the piece.
pub(super) fn is_nondecreasing(
    expr: &Expr,
    whole: &Jet,
    sides: [&Interval; 2],
    along: usize,
    moved: [bool; 2],
) -> bool {
    if moved == [false; 2] {
        return whole.first[along].is_nonnegative();
    }
    let changes = [&whole.second[along], &whole.second[along + 1]];
    let from = [0, 1].map(|axis| {
        let side = sides[axis];
        let ends = [side.floor(), side.ceiling()];
        match (changes[axis].is_nonnegative(), changes[axis].is_nonpositive()) {
            (true, _) => ends[0].clone(),
            (_, true) => ends[1].clone(),
            _ => ((&ends[0] + &ends[1]) / 2).ceiling(),
        }
    });
    let place = [0, 1].map(|axis| if moved[axis] { &from[axis] } else { sides[axis] });
    let Some(there) = jet(expr, place) else { return false };
    let start = there.first[along].clone();
    let derivative = [0, 1]
        .into_iter()
        .filter(|axis| moved[*axis])
        .fold(start, |derivative, axis| derivative + changes[axis] * (sides[axis] - &from[axis]));
    derivative.is_nonnegative()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::ARGUMENTS;
    use rug::Rational;

    fn at(text: &str, x: &Rational) -> [Interval; 3] {
        let (x, zero) = (Interval::rational(x, 256), Interval::int(0, 256));
        let Jet { value, first: [once, _], second: [twice, ..] } =
            jet(&Expr::parse(text, ARGUMENTS).unwrap(), [&x, &zero]).unwrap();
        [value, once, twice]
    }

    #[test]
    fn derivatives_are_the_limits_of_difference_quotients() {
        let step = Rational::from((1, 1 << 30));
        for text in [
            "-X",
            "sqrt(X)",
            "exp(X)",
            "log(X)",
            "sin(X)",
            "cos(X)",
            "tan(X)",
            "atan(X)",
            "tanh(X)",
            "abs(X)",
            "abs(-X)",
            "exprelr(X)",
            "exprelr(X - 0.3)",
            "sinc(X)",
            "sinc(X - 1.1)",
            "X^0",
            "X^1",
            "X^2",
            "X^5",
            "X^(-3)",
            "X^1.5",
            "1/X",
        ] {
            for x in [(3, 10), (11, 10)].map(Rational::from) {
                let found = at(text, &x);
                let [before, after] = [at(text, &(x.clone() - &step)), at(text, &(x.clone() + &step))];
                for order in [1, 2] {
                    let quotient = (&after[order - 1] - &before[order - 1]) / 2 / Interval::rational(&step, 256);
                    let apart = (quotient - &found[order]).abs();
                    let small = Interval::rational(&Rational::from((1, 1_000_000)), 256);
                    assert_eq!(apart.lt(&small), Some(true), "{text} at {x}, order {order}: {:?}", found[order]);
                }
            }
        }
    }
}
