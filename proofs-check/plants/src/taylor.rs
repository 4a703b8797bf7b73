//! Taylor arithmetic in t: the coefficients of formulas along the approximate orbit, at a time and around it
//! (docs/mathematics.md, section 11.6).
//!
//! A series `a_0, a_1, ..., a_m` at a point c contains `g^(k)(c)/k!`; on a cell, those at every point of it. So
//! `g(c + d) = sum_{k<m} a_k(c) d^k + a_m d^m` with a_m from the cell. What a series does not list is 0, unless it has an undefined
//! coefficient: then nothing is known of the function, and every coefficient is undefined.

use super::formula::{Formulas, Id, Kind, Leaf};
use proofs_core::expr::{Op, interval_op};
use proofs_core::interval::Interval;
use proofs_core::interval::removable::derivatives;

/// Coefficients from the first on.
pub type Series = Vec<Interval>;

/// Computes the series of all nodes in `order`, which come from [`Formulas::below`]; by id. `numbers` has the values of numbers;
/// `leaf`, the series of leaves.
pub fn expand(
    formulas: &Formulas,
    order: &[Id],
    numbers: impl Fn(Id) -> Interval,
    leaf: impl Fn(Leaf) -> Series,
    length: usize,
) -> Vec<Series> {
    let size = order.last().map_or(0, |last| last.0 + 1);
    let mut all: Vec<Series> = vec![Vec::new(); size];
    for id in order {
        let node = formulas.node(*id);
        let series = match &node.kind {
            _ if node.depends == 0 => vec![numbers(*id)],
            Kind::Leaf(kind) => leaf(*kind),
            Kind::Sign(a) => vec![first(&all[a.0]).sign()],
            Kind::Apply(op, [a, b]) => apply(op, &all[a.0], all.get(b.0).map_or(&[], Vec::as_slice), length),
        };
        all[id.0] = if is_defined(&series) { series } else { unknown(&series, length) };
    }
    all
}

fn is_defined(a: &[Interval]) -> bool {
    a.iter().all(Interval::is_defined)
}

/// Nothing known, of a function with this series.
fn unknown(a: &[Interval], length: usize) -> Series {
    vec![Interval::undefined(first(a).precision()); length.max(1)]
}

/// The value.
fn first(a: &[Interval]) -> Interval {
    a.first().cloned().unwrap_or_else(|| Interval::undefined(64))
}

fn is_zero(a: &[Interval]) -> bool {
    a.iter().all(Interval::is_zero)
}

/// An operation on series; the second one is empty where there is none.
pub fn apply(op: &Op, a: &[Interval], b: &[Interval], length: usize) -> Series {
    let (u, v) = (first(a), first(b));
    if a.len() <= 1 && b.len() <= 1 {
        return vec![interval_op(op, &u, &v)];
    }
    let zero = Interval::int(0, u.precision());
    match op {
        Op::Neg => a.iter().map(|x| -x).collect(),
        Op::Add | Op::Sub => (0..a.len().max(b.len()))
            .map(|k| match (a.get(k), b.get(k), *op == Op::Add) {
                (Some(x), Some(y), true) => x + y,
                (Some(x), Some(y), false) => x - y,
                (Some(x), None, _) => x.clone(),
                (None, Some(y), false) => -y,
                (None, y, _) => y.cloned().unwrap_or_else(|| zero.clone()),
            })
            .collect(),
        Op::Mul => product(a, b, length),
        Op::Div => solve(length, |c, k| (at(a, k, &zero) - terms(b, c, k, 1, k, &zero)) / &v),
        Op::Sqrt => {
            let root = u.sqrt();
            solve(length, |c, k| match k {
                0 => root.clone(),
                _ => (at(a, k, &zero) - terms(c, c, k, 1, k - 1, &zero)) / (&root * 2),
            })
        }
        Op::Exp => solve(length, |c, k| match k {
            0 => u.exp(),
            _ => weighted(a, c, k, k, &zero) / k as i64,
        }),
        Op::Log => solve(length, |c, k| match k {
            0 => u.log(),
            _ => (at(a, k, &zero) - weighted(c, a, k, k - 1, &zero) / k as i64) / &u,
        }),
        Op::Sin => waves(a, length)[0].clone(),
        Op::Cos => waves(a, length)[1].clone(),
        // y' = w a' with w = 1 + y^2, 1 - y^2; and w y' = a' with w = 1 + a^2.
        Op::Tan => by_square(a, u.tan(), 1, length),
        Op::Tanh => by_square(a, u.tanh(), -1, length),
        Op::Atan => {
            let mut w = product(a, a, length);
            w[0] = &w[0] + 1;
            solve(length, |c, k| match k {
                0 => u.atan(),
                _ => (at(a, k, &zero) - weighted(c, &w, k, k - 1, &zero) / k as i64) / &w[0],
            })
        }
        Op::Exprelr(order) => exprelr(a, *order, length),
        Op::Sinc(order) => composed(a, |k| u.sinc(order + k), length),
        Op::Abs => scaled(a, &u.sign()),
        Op::Min | Op::Max => {
            let first_is_larger = (&u - &v).sign();
            let first = if *op == Op::Max { first_is_larger } else { -first_is_larger };
            match (first.is_positive(), first.is_defined()) {
                (true, _) => a.to_vec(),
                (false, true) => b.to_vec(),
                _ => vec![Interval::undefined(u.precision()); length],
            }
        }
        Op::Power(n) => power(a, *n, length),
        Op::Pow => {
            let log = apply(&Op::Log, a, &[], length);
            apply(&Op::Exp, &product(b, &log, length), &[], length)
        }
        Op::Number(_) | Op::Pi | Op::Variable(_) => vec![Interval::undefined(u.precision()); length],
    }
}

fn at(a: &[Interval], k: usize, zero: &Interval) -> Interval {
    a.get(k).unwrap_or(zero).clone()
}

/// Coefficients one after the other, from those before.
fn solve(length: usize, next: impl Fn(&[Interval], usize) -> Interval) -> Series {
    let mut series = Vec::with_capacity(length);
    for k in 0..length {
        let value = next(&series, k);
        series.push(value);
    }
    series
}

/// `sum over j from .. to of a_j b_(k-j)`.
fn terms(a: &[Interval], b: &[Interval], k: usize, from: usize, to: usize, zero: &Interval) -> Interval {
    let pairs = (from..=to).filter_map(|j| a.get(j).zip(b.get(k.checked_sub(j)?)));
    pairs.fold(zero.clone(), |sum, (x, y)| sum + x * y)
}

/// `sum over j = 1, ..., to of j a_j b_(k-j)`.
fn weighted(a: &[Interval], b: &[Interval], k: usize, to: usize, zero: &Interval) -> Interval {
    let pairs = (1..=to).filter_map(|j| Some((j, a.get(j).zip(b.get(k.checked_sub(j)?))?)));
    pairs.fold(zero.clone(), |sum, (j, (x, y))| sum + x * y * (j as i64))
}

fn scaled(a: &[Interval], factor: &Interval) -> Series {
    a.iter().map(|x| x * factor).collect()
}

fn product(a: &[Interval], b: &[Interval], length: usize) -> Series {
    let zero = Interval::int(0, first(a).precision());
    // 0 times what is not known is not known.
    if !is_defined(a) || !is_defined(b) {
        return unknown(a, length);
    }
    if is_zero(a) || is_zero(b) {
        return vec![zero];
    }
    if let [factor] = a {
        return scaled(b, factor);
    }
    if let [factor] = b {
        return scaled(a, factor);
    }
    let full = (a.len() + b.len() - 1).min(length);
    (0..full).map(|k| terms(a, b, k, 0, k, &zero)).collect()
}

/// sin and cos together.
fn waves(a: &[Interval], length: usize) -> [Series; 2] {
    let u = first(a);
    let zero = Interval::int(0, u.precision());
    let (mut sin, mut cos) = (vec![u.sin()], vec![u.cos()]);
    for k in 1..length {
        let (s, c) = (weighted(a, &cos, k, k, &zero), weighted(a, &sin, k, k, &zero));
        sin.push(s / k as i64);
        cos.push(-(c / k as i64));
    }
    [sin, cos]
}

/// y with `y' = (1 + factor y^2) a'`.
fn by_square(a: &[Interval], value: Interval, factor: i64, length: usize) -> Series {
    let zero = Interval::int(0, value.precision());
    let (mut y, mut w) = (vec![value], Vec::new());
    for k in 1..length {
        let square = terms(&y, &y, k - 1, 0, k - 1, &zero) * factor;
        w.push(if k == 1 { square + 1 } else { square });
        let next = weighted(a, &w, k, k, &zero) / k as i64;
        y.push(next);
    }
    y
}

/// A function of a, of which the derivative of each order at its value is given: the powers of `a - a_0` begin with as many zeros.
fn composed(a: &[Interval], derivative: impl Fn(u32) -> Interval, length: usize) -> Series {
    let zero = Interval::int(0, first(a).precision());
    let change: Series = std::iter::once(zero.clone()).chain(a.iter().skip(1).cloned()).collect();
    let (mut power, mut factorial) = (vec![Interval::int(1, zero.precision())], Interval::int(1, zero.precision()));
    let mut series = vec![zero; length];
    for k in 0..length {
        if k > 0 {
            factorial = factorial * k as i64;
            power = product(&power, &change, length);
        }
        let factor = derivative(k as u32) / &factorial;
        for (entry, part) in series.iter_mut().zip(&power) {
            *entry = &*entry + &factor * part;
        }
    }
    series
}

/// A derivative of `x/(e^x - 1)`: away from 0 by the quotient, from which the derivatives follow by division by x.
fn exprelr(a: &[Interval], order: u32, length: usize) -> Series {
    let u = first(a);
    if u.abs().floor().lt(&Interval::int(1, u.precision())) != Some(false) {
        return composed(a, |k| u.exprelr(order + k), length);
    }
    let one = vec![Interval::int(1, u.precision())];
    let two = |op: &Op, a: &[Interval], b: &[Interval]| apply(op, a, b, length);
    let less = two(&Op::Sub, &apply(&Op::Exp, a, &[], length), &one);
    let step = |whole: i64, top: &Series, rest: Series| {
        let factor = two(&Op::Sub, &[Interval::int(whole, u.precision())], a);
        two(&Op::Div, &two(&Op::Sub, &two(&Op::Mul, &factor, top), &rest), a)
    };
    let times = |factor: i64| vec![Interval::int(factor, u.precision())];
    let sum = |all: Series, one: Series, factor: i64| two(&Op::Add, &all, &two(&Op::Mul, &one, &times(factor)));
    let product = |a: &Series, b: &Series| two(&Op::Mul, a, b);
    let all = derivatives(two(&Op::Div, a, &less), order as usize, product, sum, step);
    let mut last = all.last().cloned().unwrap_or_default();
    // The value itself, at which nothing is divided.
    if let Some(value) = last.first_mut() {
        *value = u.exprelr(order);
    }
    last
}

/// A whole power, by squares.
fn power(a: &[Interval], n: i32, length: usize) -> Series {
    let one = vec![Interval::int(1, first(a).precision())];
    if n < 0 {
        return apply(&Op::Div, &one, &power(a, -n, length), length);
    }
    let (mut result, mut base, mut left) = (one, a.to_vec(), n);
    while left > 0 {
        if left % 2 == 1 {
            result = product(&result, &base, length);
        }
        left /= 2;
        if left > 0 {
            base = product(&base, &base, length);
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;
    use proofs_core::expr::{Expr, TIME};
    use rug::Rational;

    const ORDER: usize = 8;

    fn number(numerator: i64, denominator: i64) -> Interval {
        Interval::rational(&Rational::from((numerator, denominator)), 256)
    }

    /// The series of an expression in t, where t is as given.
    fn series(formulas: &Formulas, root: Id, t: &Interval, length: usize) -> Series {
        let numbers = |id: Id| {
            let value = |id: Id, find: &dyn Fn(Id) -> Interval| match &formulas.node(id).kind {
                Kind::Apply(op, [a, b]) => match formulas.operands(id).len() {
                    0 => interval_op(op, t, t),
                    1 => interval_op(op, &find(*a), t),
                    _ => interval_op(op, &find(*a), &find(*b)),
                },
                _ => Interval::undefined(256),
            };
            // Constants of constants do not occur here.
            value(id, &|id| value(id, &|_| Interval::undefined(256)))
        };
        let leaf = |_: Leaf| vec![t.clone(), Interval::int(1, 256)];
        expand(formulas, &formulas.below(&[root]), numbers, leaf, length)[root.0].clone()
    }

    #[test]
    fn the_polynomial_and_its_remainder_contain_the_function() {
        let (middle, half) = (number(3, 10), number(1, 20));
        let cell = (&middle - &half).hull(&(&middle + &half));
        for text in [
            "t*t*t - 2*t",
            "sin(7*t)*cos(3*t)",
            "exp(t)*log(1 + t)",
            "sqrt(t)/(1 + t)",
            "tan(t) + tanh(3*t)",
            "atan(5*t)",
            "t^7 - (1 + t)^-3",
            "t^1.5",
            "(1 + t)^t",
            "abs(t - 1)*t",
            "min(t, 2)*max(t, sin(t) - 1)",
            "1/(t - 2) + 1/cos(t)",
            "exp(-4*sin(t)^2)",
            "-t/3",
            "exprelr(t)*exprelr(t - 0.31)",
            "exprelr(5*t) + exprelr(2 + t) + exprelr(t - 9)",
            "sinc(t)*sinc(t - 0.31)",
            "sinc(9*t - 2) + sinc(20*t)",
        ] {
            let expr = Expr::parse(text, TIME).unwrap();
            let mut formulas = Formulas::default();
            let t = formulas.leaf(Leaf::Time);
            let root = formulas.read(&expr, &[t, t], &mut Vec::new());
            let (thin, thick) = (series(&formulas, root, &middle, ORDER), series(&formulas, root, &cell, ORDER + 1));
            for part in -4..=4 {
                let apart = &half * part / 4;
                let last = thick.get(ORDER).cloned().unwrap_or_else(|| number(0, 1));
                let polynomial = (0..ORDER)
                    .rev()
                    .fold(last, |sum, k| thin.get(k).cloned().unwrap_or_else(|| number(0, 1)) + &apart * sum);
                let direct = expr.enclose(&(&middle + &apart), &middle);
                assert!(polynomial.intersect(&direct).is_defined(), "{text} at {part}: {polynomial:?}, {direct:?}");
                assert!(polynomial.upper().unwrap() - polynomial.lower().unwrap() < 1, "{text}");
            }
            // The k-th coefficient on the cell contains that at the middle.
            for (k, coefficient) in thin.iter().enumerate() {
                let on_cell = thick.get(k).cloned().unwrap_or_else(|| number(0, 1));
                assert!(on_cell.intersect(coefficient).is_defined(), "{text}, {k}");
            }
        }
    }

    #[test]
    fn nothing_times_what_is_not_known_is_not_known() {
        let (zero, none) = (vec![number(0, 1)], vec![Interval::undefined(256)]);
        let long = vec![number(1, 1), Interval::undefined(256), number(0, 1)];
        for other in [&none, &long] {
            for product in [product(&zero, other, 4), product(other, &zero, 4)] {
                assert!(product.len() == 4 && product.iter().all(|a| !a.is_defined()), "{product:?}");
            }
        }
        // A series that lists less than is asked for is not 0 beyond, where it is not known.
        let mut formulas = Formulas::default();
        let t = formulas.leaf(Leaf::Time);
        let sign = formulas.sign(t);
        let cell = number(-1, 10).hull(&number(1, 10));
        let on_cell = series(&formulas, sign, &cell, 4);
        assert!(on_cell.len() == 4 && on_cell.iter().all(|a| !a.is_defined()));
        assert!(is_defined(&series(&formulas, sign, &number(1, 10), 4)));
    }

    #[test]
    fn what_is_not_smooth_on_the_cell_is_not_known() {
        let cell = number(-1, 10).hull(&number(1, 10));
        for text in ["abs(t)", "sqrt(t)", "1/t", "log(t)", "min(t, 0)", "t^0.5", "t^-2"] {
            let mut formulas = Formulas::default();
            let t = formulas.leaf(Leaf::Time);
            let root = formulas.read(&Expr::parse(text, TIME).unwrap(), &[t, t], &mut Vec::new());
            assert!(!series(&formulas, root, &cell, 4).iter().all(Interval::is_defined), "{text}");
        }
    }
}
