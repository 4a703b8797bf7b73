//! Taylor arithmetic in t and in the parameters together (docs/mathematics.md, sections 11.6 and 13.2).
//!
//! A jet at a point has, for each power of `delta = p - p^0` up to a degree, the series in t of its coefficient, as [`super::taylor`] has it: at a
//! middle, or at every point of a box. With `a = a_0 + h`, where h is what has a power of delta, `f(a) = sum_j (f^(j)(a_0)/j!) h^j`, of which the terms
//! beyond the degree vanish. Where a jet has an undefined coefficient nothing is known of the function, and every coefficient is undefined.

use super::formula::{Formulas, Id, Kind, Leaf};
use super::taylor::{self, Series};
use proofs_core::expr::{Op, interval_op};
use proofs_core::interval::Interval;
use rug::Rational;

/// The powers of so many numbers up to a degree, in rising degree: the first is 1.
pub struct Powers {
    /// The exponents.
    pub list: Vec<Vec<u32>>,
    /// The places of two powers and of their product, which is of no larger degree.
    products: Vec<[usize; 3]>,
}

impl Powers {
    /// All of them.
    pub fn new(numbers: usize, degree: u32) -> Powers {
        let mut list: Vec<Vec<u32>> = vec![vec![0; numbers]];
        let mut last = list.clone();
        for _ in 0..degree {
            let mut next: Vec<Vec<u32>> = Vec::new();
            for (power, i) in last.iter().flat_map(|power| (0..numbers).map(move |i| (power, i))) {
                let mut raised = power.clone();
                raised[i] += 1;
                if !next.contains(&raised) {
                    next.push(raised);
                }
            }
            list.extend(next.iter().cloned());
            last = next;
        }
        let mut products = Vec::new();
        for (i, a) in list.iter().enumerate() {
            for (j, b) in list.iter().enumerate() {
                let product: Vec<u32> = a.iter().zip(b).map(|(a, b)| a + b).collect();
                products.extend(list.iter().position(|power| *power == product).map(|k| [i, j, k]));
            }
        }
        Powers { list, products }
    }

    /// The degree.
    pub fn degree(&self) -> usize {
        self.list.last().map_or(0, |last| last.iter().sum::<u32>() as usize)
    }
}

/// The series in t of the coefficient of each power; an empty one is 0.
pub type Jet = Vec<Series>;

/// What jets have in common.
pub struct Jets<'p> {
    /// Their powers.
    pub powers: &'p Powers,
    /// The length of series.
    pub length: usize,
    /// Bits.
    pub precision: u32,
}

impl Jets<'_> {
    /// The jets of all nodes in `order`, which come from [`Formulas::below`], by id. `numbers` has the values of numbers; `leaf`, the series of leaves
    /// in t; parameters move with delta.
    pub fn expand(
        &self,
        formulas: &Formulas,
        order: &[Id],
        numbers: impl Fn(Id) -> Interval,
        leaf: impl Fn(Leaf) -> Series,
    ) -> Vec<Jet> {
        let size = order.last().map_or(0, |last| last.0 + 1);
        let mut all: Vec<Jet> = vec![Vec::new(); size];
        for id in order {
            let node = formulas.node(*id);
            let jet = match &node.kind {
                _ if node.depends == 0 => self.of_time(vec![numbers(*id)]),
                Kind::Leaf(kind) => {
                    let mut jet = self.of_time(leaf(*kind));
                    if let Leaf::Parameter(i) = kind {
                        // The powers of degree 1 stand after 1, in the order of the numbers.
                        if let Some(slope) = jet.get_mut(1 + i) {
                            *slope = self.number(1);
                        }
                    }
                    jet
                }
                Kind::Sign(a) => self.of_time(vec![self.value(&all[a.0]).sign()]),
                Kind::Apply(op, [a, b]) => self.apply(op, &all[a.0], all.get(b.0).map_or(&[], Vec::as_slice)),
            };
            all[id.0] = if is_defined(&jet) { jet } else { self.unknown() };
        }
        all
    }

    fn number(&self, value: i64) -> Series {
        vec![Interval::int(value, self.precision)]
    }

    /// What does not move with delta.
    fn of_time(&self, series: Series) -> Jet {
        let mut jet = vec![Vec::new(); self.powers.list.len()];
        jet[0] = series;
        jet
    }

    fn unknown(&self) -> Jet {
        vec![vec![Interval::undefined(self.precision); self.length.max(1)]; self.powers.list.len()]
    }

    /// The coefficient of 1.
    fn base(&self, a: &[Series]) -> Series {
        a.first().filter(|series| !series.is_empty()).cloned().unwrap_or_else(|| self.number(0))
    }

    /// The value.
    fn value(&self, a: &[Series]) -> Interval {
        self.base(a).swap_remove(0)
    }

    fn series(&self, op: &Op, a: &[Interval], b: &[Interval]) -> Series {
        taylor::apply(op, a, b, self.length)
    }

    fn sum(&self, op: &Op, a: &[Series], b: &[Series]) -> Jet {
        let of = |(a, b): (&Series, &Series)| match (a.is_empty(), b.is_empty()) {
            (_, true) => a.clone(),
            (true, false) if *op == Op::Sub => self.series(&Op::Neg, b, &[]),
            (true, false) => b.clone(),
            (false, false) => self.series(op, a, b),
        };
        a.iter().zip(b).map(of).collect()
    }

    /// Both are defined.
    fn product(&self, a: &[Series], b: &[Series]) -> Jet {
        let mut product: Jet = vec![Vec::new(); self.powers.list.len()];
        for [i, j, k] in &self.powers.products {
            if a[*i].is_empty() || b[*j].is_empty() {
                continue;
            }
            let part = self.series(&Op::Mul, &a[*i], &b[*j]);
            product[*k] = if product[*k].is_empty() { part } else { self.series(&Op::Add, &product[*k], &part) };
        }
        product
    }

    /// A function of a, by its derivatives over factorials at the coefficient of 1: so many as the degree asks for.
    fn composed(&self, a: &[Series], derivatives: impl FnOnce(&Series, usize) -> Vec<Series>) -> Jet {
        let mut h = a.to_vec();
        h[0] = Vec::new();
        let moves = h.iter().any(|series| !series.is_empty());
        let all = derivatives(&self.base(a), if moves { self.powers.degree() } else { 0 });
        let mut sum: Option<Jet> = None;
        for derivative in all.into_iter().rev() {
            let own = self.of_time(derivative);
            sum = Some(match sum {
                None => own,
                Some(sum) => self.sum(&Op::Add, &self.product(&sum, &h), &own),
            });
        }
        sum.unwrap_or_else(|| self.unknown())
    }

    /// An operation on jets; the second one is empty where there is none.
    fn apply(&self, op: &Op, a: &[Series], b: &[Series]) -> Jet {
        // 0 times what is not known is not known.
        if !is_defined(a) || !is_defined(b) {
            return self.unknown();
        }
        let (mul, div) = (
            |a: &[Interval], b: &[Interval]| self.series(&Op::Mul, a, b),
            |a: &[Interval], b: &[Interval]| self.series(&Op::Div, a, b),
        );
        let over = |a: &[Interval], k: usize| div(a, &self.number(k as i64));
        match op {
            Op::Neg => {
                let of = |a: &Series| if a.is_empty() { Vec::new() } else { self.series(op, a, &[]) };
                a.iter().map(of).collect()
            }
            Op::Add | Op::Sub => self.sum(op, a, b),
            Op::Mul => self.product(a, b),
            Op::Div => self.product(a, &self.reciprocal(b)),
            Op::Exp => self.composed(a, |a, most| {
                let first = self.series(op, a, &[]);
                following(first, most, |j, last| over(&last[j - 1], j))
            }),
            Op::Log => self.composed(a, |a, most| {
                let inverse = div(&self.number(1), a);
                let mut power = self.number(-1);
                let mut all = vec![self.series(op, a, &[])];
                for j in 1..=most {
                    power = self.series(&Op::Neg, &mul(&power, &inverse), &[]);
                    all.push(over(&power, j));
                }
                all
            }),
            // c_j = c_(j-1) (3/2 - j)/(j a).
            Op::Sqrt => self.composed(a, |a, most| {
                let half = |j: usize| vec![Interval::rational(&Rational::from((3 - 2 * j as i64, 2)), self.precision)];
                following(self.series(op, a, &[]), most, |j, all| over(&div(&mul(&all[j - 1], &half(j)), a), j))
            }),
            Op::Sin | Op::Cos => self.composed(a, |a, most| {
                let [own, other] = [op, if *op == Op::Sin { &Op::Cos } else { &Op::Sin }];
                let [own, other] = [own, other].map(|op| self.series(op, a, &[]));
                let mut factorial = self.number(1);
                let of = |j: usize| {
                    factorial = mul(&factorial, &self.number(j.max(1) as i64));
                    // The signs of sin, cos, -sin, -cos; of cos, -sin, -cos, sin.
                    let (turned, minus) = match (j % 4, *op == Op::Sin) {
                        (0, _) => (&own, false),
                        (1, is_sin) => (&other, !is_sin),
                        (2, _) => (&own, true),
                        (_, is_sin) => (&other, is_sin),
                    };
                    let value = div(turned, &factorial);
                    if minus { self.series(&Op::Neg, &value, &[]) } else { value }
                };
                (0..=most).map(of).collect()
            }),
            // j c_j is a coefficient of 1 + c^2, or of 1 - c^2.
            Op::Tan | Op::Tanh => self.composed(a, |a, most| {
                let sign = if *op == Op::Tan { Op::Add } else { Op::Sub };
                following(self.series(op, a, &[]), most, |j, all| {
                    let one = self.number(i64::from(j == 1));
                    let square = (0..j).map(|i| mul(&all[i], &all[j - 1 - i]));
                    over(&square.fold(one, |sum, part| self.series(&sign, &sum, &part)), j)
                })
            }),
            // j c_j is a coefficient of 1/w, w = 1 + a^2 + 2 a h + h^2.
            Op::Atan => self.composed(a, |a, most| {
                let one = self.number(1);
                let w = self.series(&Op::Add, &mul(a, a), &one);
                let twice = mul(a, &self.number(2));
                let inverse = following(div(&one, &w), most, |j, all| {
                    let before = mul(&twice, &all[j - 1]);
                    let both = if j > 1 { self.series(&Op::Add, &before, &all[j - 2]) } else { before };
                    self.series(&Op::Neg, &div(&both, &w), &[])
                });
                let first = self.series(op, a, &[]);
                following(first, most, |j, _| over(&inverse[j - 1], j))
            }),
            Op::Exprelr(order) => self.by_orders(a, |j| Op::Exprelr(order + j)),
            Op::Sinc(order) => self.by_orders(a, |j| Op::Sinc(order + j)),
            Op::Abs => self.product(a, &self.of_time(vec![self.value(a).sign()])),
            Op::Min | Op::Max => {
                let first_is_larger = (self.value(a) - self.value(b)).sign();
                let first = if *op == Op::Max { first_is_larger } else { -first_is_larger };
                match (first.is_positive(), first.is_defined()) {
                    (true, _) => a.to_vec(),
                    (false, true) => b.to_vec(),
                    _ => self.unknown(),
                }
            }
            Op::Power(n) => {
                let power = self.power(a, n.unsigned_abs());
                if *n < 0 { self.reciprocal(&power) } else { power }
            }
            Op::Pow => {
                let log = self.apply(&Op::Log, a, &[]);
                self.apply(&Op::Exp, &self.apply(&Op::Mul, b, &log), &[])
            }
            Op::Number(_) | Op::Pi | Op::Variable(_) => {
                let none = Interval::undefined(self.precision);
                self.of_time(vec![interval_op(op, &none, &none)])
            }
        }
    }

    /// 1/a: `c_j = -c_(j-1)/a`.
    fn reciprocal(&self, a: &[Series]) -> Jet {
        self.composed(a, |a, most| {
            let first = self.series(&Op::Div, &self.number(1), a);
            following(first, most, |j, all| self.series(&Op::Neg, &self.series(&Op::Div, &all[j - 1], a), &[]))
        })
    }

    /// A function whose derivatives are operations themselves.
    fn by_orders(&self, a: &[Series], derivative: impl Fn(u32) -> Op) -> Jet {
        self.composed(a, |a, most| {
            let mut factorial = self.number(1);
            let of = |j: usize| {
                factorial = self.series(&Op::Mul, &factorial, &self.number(j.max(1) as i64));
                self.series(&Op::Div, &self.series(&derivative(j as u32), a, &[]), &factorial)
            };
            (0..=most).map(of).collect()
        })
    }

    /// A whole power, by squares.
    fn power(&self, a: &[Series], n: u32) -> Jet {
        let (mut result, mut base, mut left) = (self.of_time(self.number(1)), a.to_vec(), n);
        while left > 0 {
            if left % 2 == 1 {
                result = self.product(&result, &base);
            }
            left /= 2;
            if left > 0 {
                base = self.product(&base, &base);
            }
        }
        result
    }
}

fn is_defined(a: &[Series]) -> bool {
    a.iter().flatten().all(Interval::is_defined)
}

/// The first and those up to `most`, each from those before.
fn following(first: Series, most: usize, next: impl Fn(usize, &[Series]) -> Series) -> Vec<Series> {
    let mut all = vec![first];
    for j in 1..=most {
        let value = next(j, &all);
        all.push(value);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use proofs_core::expr::Expr;

    const PRECISION: u32 = 320;
    const LENGTH: usize = 8;

    fn number(numerator: i64, denominator: i64) -> Interval {
        Interval::rational(&Rational::from((numerator, denominator)), PRECISION)
    }

    fn powers() -> Powers {
        Powers::new(2, 4)
    }

    /// The jet of an expression in t and the parameters a and b, at such a place.
    fn jet(text: &str, powers: &Powers, t: &Interval, place: [&Interval; 2]) -> Jet {
        let mut formulas = Formulas::default();
        let variables = [Leaf::Time, Leaf::Parameter(0), Leaf::Parameter(1)].map(|leaf| formulas.leaf(leaf));
        let root = formulas.read(&Expr::parse(text, &["t", "a", "b"]).unwrap(), &variables, &mut Vec::new());
        let order = formulas.below(&[root]);
        let mut numbers: Vec<Interval> = Vec::new();
        for id in 0..formulas.size() {
            let value = match &formulas.node(Id(id)).kind {
                Kind::Apply(op, [x, y]) if formulas.depends(Id(id)) == 0 => match op.operands() {
                    0 => interval_op(op, t, t),
                    1 => interval_op(op, &numbers[x.0], t),
                    _ => interval_op(op, &numbers[x.0], &numbers[y.0]),
                },
                _ => Interval::undefined(PRECISION),
            };
            numbers.push(value);
        }
        let leaf = |leaf: Leaf| match leaf {
            Leaf::Parameter(i) => vec![place[i].clone()],
            _ => vec![t.clone(), number(1, 1)],
        };
        let jets = Jets { powers, length: LENGTH, precision: PRECISION };
        jets.expand(&formulas, &order, |id| numbers[id.0].clone(), leaf)[root.0].clone()
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

    /// Near the place the polynomial of a function is what the function is, up to what is beyond its degrees.
    #[test]
    fn the_polynomial_is_that_of_the_function() {
        let powers = powers();
        let (t, a, b) = (number(3, 10), number(4, 5), number(7, 10));
        let step = number(1, 1000);
        for text in TEXTS {
            let found = jet(text, &powers, &t, [&a, &b]);
            for (of_t, of_a, of_b) in [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, -1, 1), (-1, 1, 1), (2, 1, -1)] {
                let apart = [of_t, of_a, of_b].map(|factor: i64| &step * factor);
                let mut sum = number(0, 1);
                for (alpha, series) in powers.list.iter().zip(&found) {
                    let power = (0..2).fold(number(1, 1), |power, i| power * apart[1 + i].powi(alpha[i] as i32));
                    let horner = series.iter().rev().fold(number(0, 1), |sum, value| value + &apart[0] * sum);
                    sum = sum + power * horner;
                }
                let there = [&t + &apart[0], &a + &apart[1], &b + &apart[2]];
                let direct = jet(text, &Powers::new(2, 0), &there[0], [&there[1], &there[2]])[0][0].clone();
                let off = (sum - direct).abs().hi().to_f64();
                // The fifth power of the step is 1e-15, and the fourth 1e-12.
                assert!(off < 2e-11 && (off < 1e-12 || (of_a, of_b) != (0, 0)), "{text}: {off:e}");
            }
            // Each power of degree 4 is right, too: by the same at half the step.
            let off = |step: &Interval| {
                let power = |alpha: &Vec<u32>| step.powi(alpha.iter().sum::<u32>() as i32);
                let value = |series: &Series| series.first().cloned().unwrap_or_else(|| number(0, 1));
                let sum = powers
                    .list
                    .iter()
                    .zip(&found)
                    .fold(number(0, 1), |sum, (alpha, series)| sum + power(alpha) * value(series));
                let direct = jet(text, &Powers::new(2, 0), &t, [&(&a + step), &(&b + step)])[0][0].clone();
                (sum - direct).abs().hi().to_f64()
            };
            let [first, second] = [off(&step), off(&(&step / 10))];
            assert!(second < first * 1.1e-5 || first < 1e-60, "{text}: {first:e} {second:e}");
        }
    }

    /// On a box each coefficient contains those at its points.
    #[test]
    fn a_box_contains_its_points() {
        let powers = powers();
        let t = number(3, 10);
        let wide = |middle: i64| number(middle - 1, 100).hull(&number(middle + 1, 100));
        for text in TEXTS {
            let on_box = jet(text, &powers, &t, [&wide(80), &wide(70)]);
            for place in [(79, 69), (81, 71), (80, 70), (81, 69)] {
                let at = jet(text, &powers, &t, [&number(place.0, 100), &number(place.1, 100)]);
                for (own, point) in on_box.iter().zip(&at) {
                    for k in 0..LENGTH {
                        let value = |series: &Series| series.get(k).cloned().unwrap_or_else(|| number(0, 1));
                        assert!(value(own).intersect(&value(point)).is_defined(), "{text}, {k}");
                    }
                }
            }
        }
    }

    #[test]
    fn what_is_not_smooth_on_the_box_is_not_known() {
        let powers = powers();
        let (t, b) = (number(3, 10), number(1, 1));
        let around = number(-1, 10).hull(&number(1, 10));
        for text in ["abs(a)", "1/a", "log(a)", "sqrt(a)", "min(a, 0)", "a^-2", "a^0.5"] {
            let found = jet(text, &powers, &t, [&around, &b]);
            assert!(found.iter().flatten().any(|value| !value.is_defined()), "{text}");
            assert_eq!(found.len(), powers.list.len());
        }
        // 0 times what is not known is not known.
        let jets = Jets { powers: &powers, length: LENGTH, precision: PRECISION };
        let (zero, none) = (jets.of_time(jets.number(0)), jets.unknown());
        for [a, b] in [[&zero, &none], [&none, &zero]] {
            assert!(jets.apply(&Op::Mul, a, b).iter().flatten().all(|value| !value.is_defined()));
        }
    }
}
