//! Functions on a box as polynomials with a bound of the rest (docs/mathematics.md, sections 11.6 and 14.4).
//!
//! A box is `middle +- half width` in each of its numbers, which are `middle + half width * xi` with `|xi| <= 1`. A function on it is
//! `sum over alpha of a_alpha xi^alpha + r`, `|r| <= rest`, with alpha up to a degree N in all numbers together. What a product has beyond N goes to the
//! rest. With `a = a_0 + h`, where a_0 is the coefficient of 1, `f(a) = sum_(j <= N) (f^(j)(a_0)/j!) h^j + (f^(N+1)(z)/(N+1)!) h^(N+1)` with z in the
//! range of a (Lagrange): f has to be smooth on that range, which its enclosures there say. A function of which anything is undefined is not known at all.

use super::formula::{Formulas, Id, Kind, Leaf};
use super::path::coefficient;
use super::powers::Powers;
use super::taylor::{self, Series};
use super::time::around;
use proofs_core::expr::Op;
use proofs_core::interval::Interval;

/// A function on a box.
#[derive(Clone)]
pub struct Expansion {
    /// By the places of powers; those that are not listed are 0.
    pub coefficients: Vec<Interval>,
    /// 0 or more, or undefined: then nothing is known.
    pub rest: Interval,
}

impl Expansion {
    /// Known exactly as far as the coefficients are.
    pub fn exact(coefficients: Vec<Interval>, precision: u32) -> Expansion {
        Expansion { coefficients, rest: Interval::int(0, precision) }
    }

    /// Whether anything is known.
    pub fn is_defined(&self) -> bool {
        self.rest.is_defined() && self.coefficients.iter().all(Interval::is_defined)
    }

    /// The coefficient of 1.
    pub fn first(&self) -> Interval {
        self.coefficients.first().cloned().unwrap_or_else(|| Interval::int(0, self.rest.precision()))
    }

    /// A bound of the magnitude of what is not that: sums of sizes.
    pub fn apart(&self) -> Interval {
        self.coefficients.iter().skip(1).fold(self.rest.clone(), |sum, a| sum + a.abs()).ceiling()
    }

    /// All of its values.
    fn range(&self) -> Interval {
        self.first() + around(&self.apart())
    }
}

/// What expansions on a box have in common.
pub struct Expansions<'p> {
    /// Their powers.
    pub powers: &'p Powers,
    /// Bits.
    pub precision: u32,
}

impl Expansions<'_> {
    /// Those of all nodes in `order`, which come from [`Formulas::below`], by id. `numbers` has the values of numbers; `leaf`, the leaves.
    pub fn expand(
        &self,
        formulas: &Formulas,
        order: &[Id],
        numbers: impl Fn(Id) -> Interval,
        leaf: impl Fn(Leaf) -> Expansion,
    ) -> Vec<Expansion> {
        let size = order.last().map_or(0, |last| last.0 + 1);
        let none = self.constant(Interval::undefined(self.precision));
        let mut all: Vec<Expansion> = vec![none.clone(); size];
        for id in order {
            let node = formulas.node(*id);
            let expansion = match &node.kind {
                _ if node.depends == 0 => self.constant(numbers(*id)),
                Kind::Leaf(kind) => leaf(*kind),
                Kind::Sign(a) => self.constant(all[a.0].range().sign()),
                Kind::Apply(op, [a, b]) => self.apply(op, &all[a.0], all.get(b.0).unwrap_or(&none)),
            };
            all[id.0] = if expansion.is_defined() { expansion } else { none.clone() };
        }
        all
    }

    /// The same everywhere.
    pub fn constant(&self, value: Interval) -> Expansion {
        Expansion::exact(vec![value], self.precision)
    }

    /// An operation; the second operand counts where there is one.
    fn apply(&self, op: &Op, a: &Expansion, b: &Expansion) -> Expansion {
        // 0 times what is not known is not known.
        if !a.is_defined() || op.operands() == 2 && !b.is_defined() {
            return self.constant(Interval::undefined(self.precision));
        }
        match op {
            Op::Neg => Expansion { coefficients: a.coefficients.iter().map(|x| -x).collect(), rest: a.rest.clone() },
            Op::Add => self.sum(a, b),
            Op::Sub => self.sum(a, &self.apply(&Op::Neg, b, b)),
            Op::Mul => self.product(a, b, self.powers.degree()),
            Op::Div => {
                let one = [Interval::int(1, self.precision)];
                let inverse = self.composed(b, |b, length| taylor::apply(&Op::Div, &one, b, length));
                self.apply(&Op::Mul, a, &inverse)
            }
            Op::Min | Op::Max => {
                let first_is_larger = self.apply(&Op::Sub, a, b).range().sign();
                let first = if *op == Op::Max { first_is_larger } else { -first_is_larger };
                match (first.is_positive(), first.is_defined()) {
                    (true, _) => a.clone(),
                    (false, true) => b.clone(),
                    _ => self.constant(first),
                }
            }
            Op::Pow => {
                let log = self.apply(&Op::Log, a, a);
                let exponent = self.apply(&Op::Mul, b, &log);
                self.apply(&Op::Exp, &exponent, &exponent)
            }
            _ => self.composed(a, |a, length| taylor::apply(op, a, &[], length)),
        }
    }

    fn sum(&self, a: &Expansion, b: &Expansion) -> Expansion {
        let of = |k: usize| match (a.coefficients.get(k), b.coefficients.get(k)) {
            (Some(x), Some(y)) => x + y,
            (x, y) => x.or(y).cloned().unwrap_or_else(|| Interval::int(0, self.precision)),
        };
        let coefficients = (0..a.coefficients.len().max(b.coefficients.len())).map(of).collect();
        Expansion { coefficients, rest: &a.rest + &b.rest }
    }

    /// By degree the sum of the sizes of the coefficients.
    fn sizes(&self, a: &Expansion) -> Vec<Interval> {
        let mut sizes = vec![Interval::int(0, self.precision); self.powers.degree() + 1];
        for (place, value) in a.coefficients.iter().enumerate().filter(|(_, value)| !value.is_zero()) {
            let size = &mut sizes[self.powers.degree_of(place)];
            *size = &*size + value.abs();
        }
        sizes
    }

    /// Up to this degree, with the others in the rest. Both are defined.
    fn product(&self, a: &Expansion, b: &Expansion, degree: usize) -> Expansion {
        let zero = || Interval::int(0, self.precision);
        let mut coefficients = Vec::new();
        for (place, x) in a.coefficients.iter().enumerate().filter(|(_, x)| !x.is_zero()) {
            for (y, to) in b.coefficients.iter().zip(self.powers.products(place, degree)) {
                if y.is_zero() {
                    continue;
                }
                if coefficients.len() <= *to {
                    coefficients.resize_with(to + 1, zero);
                }
                coefficients[*to] = &coefficients[*to] + x * y;
            }
        }
        let [of_a, of_b] = [self.sizes(a), self.sizes(b)];
        let total = |sizes: &[Interval]| sizes.iter().fold(zero(), |sum, size| sum + size);
        let mut rest = &a.rest * (total(&of_b) + &b.rest) + total(&of_a) * &b.rest;
        for (own, size) in of_a.iter().enumerate().filter(|(_, size)| !size.is_zero()) {
            let beyond = of_b.get((degree + 1).saturating_sub(own)..).unwrap_or_default();
            rest = rest + size * total(beyond);
        }
        Expansion { coefficients, rest: rest.ceiling() }
    }

    /// A function of a, by its series at a value, or at all values, of its operand, which is given as a series of this length.
    fn composed(&self, a: &Expansion, series: impl Fn(&[Interval], usize) -> Series) -> Expansion {
        let (first, size) = (a.first(), a.apart());
        if size.is_zero() {
            return self.constant(coefficient(&series(&[first], 1), 0, self.precision));
        }
        let (degree, one) = (self.powers.degree(), Interval::int(1, self.precision));
        let mut h = a.clone();
        if let Some(value) = h.coefficients.first_mut() {
            *value = Interval::int(0, self.precision);
        }
        let at_first = series(&[first.clone(), one.clone()], degree + 1);
        let on_all = series(&[first + around(&size), one], degree + 2);
        let last = coefficient(&on_all, degree + 1, self.precision).abs() * size.powi(degree as i32 + 1);
        let of = |j: usize| self.constant(coefficient(&at_first, j, self.precision));
        // Of what will be multiplied by h^j the degrees up to degree - j count.
        let next = |sum: Expansion, j: usize| self.sum(&self.product(&sum, &h, degree - j), &of(j));
        let mut sum = (0..degree).rev().fold(of(degree), next);
        sum.rest = (sum.rest + last).ceiling();
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proofs_core::expr::{Expr, interval_op};
    use rug::Rational;

    const PRECISION: u32 = 160;

    fn number(numerator: i64, denominator: i64) -> Interval {
        Interval::rational(&Rational::from((numerator, denominator)), PRECISION)
    }

    /// An expression in t and the parameters a and b, around such a place, with such half widths.
    fn expansion(text: &str, powers: &Powers, place: [&Interval; 3], widths: [&Interval; 3]) -> Expansion {
        let mut formulas = Formulas::default();
        let variables = [Leaf::Time, Leaf::Parameter(0), Leaf::Parameter(1)].map(|leaf| formulas.leaf(leaf));
        let root = formulas.read(&Expr::parse(text, &["t", "a", "b"]).unwrap(), &variables, &mut Vec::new());
        let order = formulas.below(&[root]);
        let mut numbers: Vec<Interval> = Vec::new();
        for id in 0..formulas.size() {
            let none = Interval::undefined(PRECISION);
            let value = match &formulas.node(Id(id)).kind {
                Kind::Apply(op, [x, y]) if formulas.depends(Id(id)) == 0 => match op.operands() {
                    0 => interval_op(op, &none, &none),
                    1 => interval_op(op, &numbers[x.0], &none),
                    _ => interval_op(op, &numbers[x.0], &numbers[y.0]),
                },
                _ => none,
            };
            numbers.push(value);
        }
        let leaf = |leaf: Leaf| {
            let which = if let Leaf::Parameter(i) = leaf { 1 + i } else { 0 };
            let mut coefficients = vec![number(0, 1); 4];
            (coefficients[0], coefficients[1 + which]) = (place[which].clone(), widths[which].clone());
            Expansion::exact(coefficients, PRECISION)
        };
        let expansions = Expansions { powers, precision: PRECISION };
        expansions.expand(&formulas, &order, |id| numbers[id.0].clone(), leaf)[root.0].clone()
    }

    const TEXTS: [&str; 18] = [
        "a*b*t - 2*t^3*a + b",
        "sin(7*t*a)*cos(3*b)",
        "exp(t*a - b)*log(1 + t + b)",
        "sqrt(t + a*b)/(1 + t*a)",
        "tan(t*a) + tanh(3*b*a)",
        "atan(5*a*b + t)",
        "(a - b*t)^7 - (1 + t + a)^-3",
        "(t*a*b)^1.5",
        "(1 + t)^(a*b)",
        "abs(t - a - 1)*b",
        "min(t*a, 2 + b)*max(t, sin(b) - 1)",
        "max(t*a, 2 + b)",
        "1/(t - 2*a) + 1/cos(b)",
        "exp(-4*sin(t*b)^2)",
        "-t/3/a",
        "exprelr(a*b)*exprelr(t - 0.31*a)",
        "sinc(a*b)*sinc(t - 0.31*a)",
        "a/a + b - b*2",
    ];

    /// What is known of a function contains its values, whatever is truncated, and closely.
    #[test]
    fn a_function_is_its_polynomial_up_to_the_rest() {
        let place = [number(3, 10), number(4, 5), number(7, 10)];
        let zero = number(0, 1);
        for (degree, width, most) in [(2, 20, 2e-1), (6, 20, 2e-3), (6, 2000, 1e-15)] {
            let powers = Powers::new(3, degree);
            let widths = [number(1, width), number(1, width + 3), number(2, width)];
            for text in TEXTS {
                let found = expansion(text, &powers, place.each_ref(), widths.each_ref());
                assert!(found.is_defined() && found.rest.hi().to_f64() < most, "{text}: {}", found.rest.hi());
                for xi in
                    [[1, 1, 1], [-1, 1, 1], [1, -1, 1], [1, 1, -1], [-1, -1, -1], [0, 1, 0], [0, 0, -1], [0, 0, 0]]
                {
                    let xi = xi.map(|xi| number(xi, 1));
                    let polynomial =
                        powers.list.iter().zip(&found.coefficients).fold(zero.clone(), |sum, (alpha, a)| {
                            sum + alpha.iter().zip(&xi).fold(a.clone(), |term, (n, xi)| term * xi.powi(*n as i32))
                        });
                    let at: Vec<Interval> = (0..3).map(|i| &place[i] + &widths[i] * &xi[i]).collect();
                    let direct = expansion(text, &powers, [&at[0], &at[1], &at[2]], [&zero; 3]).first();
                    assert!((polynomial - direct).abs().floor().le(&found.rest) == Some(true), "{text} at {xi:?}");
                }
            }
        }
    }

    /// The rest is not larger than it has to be: of these the function is as far from the polynomial.
    #[test]
    fn what_is_truncated_is_in_the_rest() {
        let powers = Powers::new(3, 2);
        let (zero, one) = (number(0, 1), number(1, 1));
        let rest = |text: &str| expansion(text, &powers, [&zero; 3], [&one; 3]).rest.hi().to_f64();
        assert_eq!([rest("t*a"), rest("t*a*b"), rest("t*a*(1 + 3*b)"), rest("(t + 2*a)*a*b")], [0.0, 1.0, 3.0, 3.0]);
        // Lagrange: e^xi is at most e.
        let [found, e] = [rest("exp(t)"), std::f64::consts::E];
        assert!((e - 2.5..e / 6.0 * 1.000001).contains(&found), "{found}");
    }

    /// What is apart from the coefficient of 1 has the rest, too: of a function of it the range is as wide.
    #[test]
    fn the_rest_is_a_part_of_the_range() {
        let one = Expansion { coefficients: vec![number(3, 1), number(-2, 1)], rest: number(1, 2) };
        assert_eq!(one.apart().hi().to_f64(), 2.5);
        let range = one.range();
        assert!(range.contains(&number(11, 2)) && range.contains(&number(1, 2)) && !range.contains(&number(12, 2)));
    }

    #[test]
    fn what_is_not_smooth_on_the_box_is_not_known() {
        let powers = Powers::new(3, 3);
        let (t, zero, b, width) = (number(3, 10), number(1, 100), number(1, 1), number(1, 10));
        for text in ["abs(a)", "1/a", "log(a)", "sqrt(a)", "min(a, 0)", "a^-2", "a^0.5", "tan(20*a)"] {
            let around = |width| expansion(text, &powers, [&t, &zero, &b], [&width; 3]);
            assert!(!around(width.clone()).is_defined(), "{text}");
            assert!(around(number(1, 1000)).is_defined(), "{text}");
        }
        // 0 times what is not known is not known.
        let expansions = Expansions { powers: &powers, precision: PRECISION };
        let [zero, none] = [number(0, 1), Interval::undefined(PRECISION)].map(|value| expansions.constant(value));
        for [a, b] in [[&zero, &none], [&none, &zero]] {
            assert!(!expansions.apply(&Op::Mul, a, b).is_defined());
        }
    }
}
