//! Trigonometric polynomials of the period with enclosed coefficients: what a formula in t and parameters is, by its form (docs/mathematics.md,
//! section 14.3).
//!
//! `sin` and `cos` of `A t + B`, B free of t and `A T/(2 pi)` a whole number, are such; so are sums, products and whole powers of them, and their
//! quotients by what is free of t. A coefficient is a function of the parameters that is enclosed; the largest harmonic is read off the form.

use super::complex::Complex;
use super::jet::Number;
use crate::formula::{Axis, Formulas, Id, Kind, Leaf};
use proofs_core::exact::Exact;
use proofs_core::expr::Op;
use proofs_core::interval::Interval;
use rug::Rational;

/// The largest harmonic.
pub const MOST_HARMONICS: usize = 128;

/// c_0, c_1, ... of `sum over all k of c_k e^(i k Om t)`, `c_-k` the conjugate of c_k.
#[derive(Clone, Debug)]
pub struct Harmonics(Vec<Complex>);

/// What a part of a formula is.
#[derive(Clone, Debug)]
enum Part {
    /// `A t + B`.
    Line(Exact, Interval),
    Polynomial(Harmonics),
}

impl Harmonics {
    /// What is free of t.
    fn constant(value: Interval) -> Harmonics {
        Harmonics(vec![Complex::real(value)])
    }

    /// How many coefficients are written.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// c_k; 0 beyond what is written.
    pub fn at(&self, k: usize, precision: u32) -> Complex {
        self.0.get(k).cloned().unwrap_or_else(|| Complex::zero(precision))
    }

    /// Another value in the place of each part.
    pub fn fill(&mut self, value: &Interval) {
        self.0.iter_mut().for_each(|c| *c = Complex { re: value.clone(), im: value.clone() });
    }

    fn precision(&self) -> u32 {
        self.0.first().map_or(64, |c| c.re.precision())
    }

    fn mapped(&self, map: impl Fn(&Complex) -> Complex) -> Harmonics {
        Harmonics(self.0.iter().map(map).collect())
    }

    fn plus(&self, other: &Harmonics) -> Harmonics {
        let p = self.precision();
        Harmonics((0..self.len().max(other.len())).map(|k| self.at(k, p).plus(&other.at(k, p))).collect())
    }

    /// The coefficient of any k.
    fn of_sign(&self, k: isize) -> Option<Complex> {
        let c = self.0.get(k.unsigned_abs())?;
        Some(if k < 0 { c.conjugate() } else { c.clone() })
    }

    fn times(&self, other: &Harmonics) -> Option<Harmonics> {
        let most = (self.len() + other.len()).checked_sub(2).filter(|most| *most <= MOST_HARMONICS)?;
        let reach = self.len() as isize - 1;
        let zero = Complex::zero(self.precision());
        let product = |k: isize| {
            let terms = (-reach..=reach).filter_map(|l| Some(self.of_sign(l)?.times(&other.of_sign(k - l)?)));
            terms.fold(zero.clone(), |sum, term| sum.plus(&term))
        };
        Some(Harmonics((0..=most as isize).map(product).collect()))
    }

    fn power(&self, n: i32) -> Option<Harmonics> {
        let one = Harmonics::constant(Interval::int(1, self.precision()));
        (0..n).try_fold(one, |power, _| power.times(self))
    }

    fn is_constant(&self) -> bool {
        self.len() == 1
    }

    fn free_of_t(&self) -> Option<&Interval> {
        self.0.first().filter(|_| self.is_constant()).map(|c| &c.re)
    }
}

/// How formulas are read: what is free of t has a value, and T is known exactly.
pub struct Reading<'r, V: Fn(Id) -> Interval> {
    /// The formulas.
    pub formulas: &'r Formulas,
    /// The period.
    pub period: &'r Exact,
    /// The precision of the values.
    pub precision: u32,
    /// What a node is that depends on parameters alone.
    pub value: V,
}

impl<V: Fn(Id) -> Interval> Reading<'_, V> {
    /// What these nodes are, which depend on t and parameters alone; none where one is no such polynomial by its form.
    pub fn read(&self, roots: &[Id]) -> Option<Vec<Harmonics>> {
        let below = self.formulas.below(roots);
        let last = below.last().map_or(0, |id| id.0 + 1);
        let mut parts: Vec<Option<Part>> = vec![None; last];
        for id in below {
            let part = match self.depends_on_time(id) {
                true => self.part(id, &parts),
                false => Some(Part::Polynomial(Harmonics::constant((self.value)(id)))),
            };
            parts[id.0] = part;
        }
        let of = |id: &Id| match parts.get(id.0)?.as_ref()? {
            Part::Polynomial(harmonics) => Some(harmonics.clone()),
            Part::Line(..) => None,
        };
        roots.iter().map(of).collect()
    }

    fn depends_on_time(&self, id: Id) -> bool {
        self.formulas.depends(id) & Axis::Time.bit() != 0
    }

    fn part(&self, id: Id, parts: &[Option<Part>]) -> Option<Part> {
        use Part::{Line, Polynomial};
        let (op, [a, b]) = match &self.formulas.node(id).kind {
            // Those of numbers and parameters have been told apart before.
            Kind::Leaf(Leaf::Time) => {
                return Some(Line(Exact::rational(&Rational::from(1))?, Interval::int(0, self.precision)));
            }
            Kind::Leaf(_) | Kind::Sign(_) => return None,
            Kind::Apply(op, operands) => (op, operands),
        };
        let part = |id: &Id| parts.get(id.0)?.as_ref();
        let exact = |id: &Id| self.formulas.node(*id).exact.as_ref();
        let first = part(a)?;
        let second = if op.operands() == 2 { Some(part(b)?) } else { None };
        match (op, first, second) {
            (Op::Neg, Line(slope, rest), _) => Some(Line(slope.neg(), -rest)),
            (Op::Neg, Polynomial(a), _) => Some(Polynomial(a.mapped(Complex::opposite))),
            (Op::Add, Polynomial(a), Some(Polynomial(b))) => Some(Polynomial(a.plus(b))),
            (Op::Sub, Polynomial(a), Some(Polynomial(b))) => Some(Polynomial(a.plus(&b.mapped(Complex::opposite)))),
            (Op::Add, Line(slope, rest), Some(Line(other, shift))) => Some(Line(slope.add(other)?, rest + shift)),
            (Op::Sub, Line(slope, rest), Some(Line(other, shift))) => {
                Some(Line(slope.add(&other.neg())?, rest - shift))
            }
            (Op::Add, Line(slope, rest), Some(Polynomial(b))) => Some(Line(slope.clone(), rest + b.free_of_t()?)),
            (Op::Add, Polynomial(a), Some(Line(slope, rest))) => Some(Line(slope.clone(), a.free_of_t()? + rest)),
            (Op::Sub, Line(slope, rest), Some(Polynomial(b))) => Some(Line(slope.clone(), rest - b.free_of_t()?)),
            (Op::Sub, Polynomial(a), Some(Line(slope, rest))) => Some(Line(slope.neg(), a.free_of_t()? - rest)),
            (Op::Mul, Line(slope, rest), Some(Polynomial(by))) => {
                Some(Line(slope.mul(exact(b)?)?, rest * by.free_of_t()?))
            }
            (Op::Mul, Polynomial(by), Some(Line(slope, rest))) => {
                Some(Line(slope.mul(exact(a)?)?, by.free_of_t()? * rest))
            }
            (Op::Div, Line(slope, rest), Some(Polynomial(by))) => {
                Some(Line(slope.mul(&exact(b)?.recip()?)?, rest / by.free_of_t()?))
            }
            (Op::Mul, Polynomial(a), Some(Polynomial(b))) => a.times(b).map(Polynomial),
            (Op::Div, Polynomial(a), Some(Polynomial(b))) => {
                let divisor = Complex::real(b.free_of_t()?.clone());
                Some(Polynomial(a.mapped(|c| c.over(&divisor))))
            }
            (Op::Power(n), Polynomial(a), _) if *n >= 0 => a.power(*n).map(Polynomial),
            (Op::Sin | Op::Cos, Line(slope, rest), _) => self.wave(op, slope, rest).map(Polynomial),
            _ => None,
        }
    }

    /// `cos(m Om t + B)` has `c_m = e^(iB)/2`, and `sin(m Om t + B)` that over i; of a negative m the conjugate is c_|m|.
    fn wave(&self, op: &Op, slope: &Exact, rest: &Interval) -> Option<Harmonics> {
        let turns = slope.mul(self.period)?.mul(&Exact::pi().recip()?)?.as_rational()? / 2u32;
        let m = Some(turns).filter(|turns| *turns.denom() == 1)?.numer().to_i32()?;
        let place = usize::try_from(m.unsigned_abs()).ok().filter(|place| *place <= MOST_HARMONICS)?;
        let (cos, sin) = (rest.cos(), rest.sin());
        if m == 0 {
            return Some(Harmonics::constant(if *op == Op::Cos { cos } else { sin }));
        }
        let own = if *op == Op::Cos { Complex { re: cos, im: sin } } else { Complex { re: sin, im: -cos } };
        let half = Complex { re: own.re / 2, im: own.im / 2 };
        let mut all = vec![Complex::zero(rest.precision()); place];
        all.push(if m < 0 { half.conjugate() } else { half });
        Some(Harmonics(all))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::{At, Curves, Machine};
    use proofs_core::expr::Expr;

    const PRECISION: u32 = 128;

    fn number(value: (i64, i64)) -> Interval {
        Interval::rational(&Rational::from(value), PRECISION)
    }

    /// What a formula in t and one parameter, here 1/3, is with the period 1/2, and its values at two times.
    fn read(text: &str) -> Option<(Harmonics, [Interval; 2])> {
        let mut formulas = Formulas::default();
        let variables = [Leaf::Time, Leaf::Parameter(0)].map(|leaf| formulas.leaf(leaf));
        let root = formulas.read(&Expr::parse(text, &["t", "k"]).unwrap(), &variables, &mut Vec::new());
        let machine = Machine::new(&formulas, &Curves { orbit: Vec::new(), lyapunov: Vec::new() }, &number((1, 1)));
        let rest = [number((0, 1)), number((1, 3))];
        let value = |id: Id, time: (i64, i64)| {
            // The time is the middle of a cell.
            let (cell, mut values) = (machine.period(&(number(time) * 2)), machine.values());
            machine.run(&machine.program(&[id]), At::Middle, &cell, &[], &rest, &mut values);
            machine.get(id, At::Middle, &cell, &values)
        };
        let period = Exact::rational(&Rational::from((1, 2))).unwrap();
        let reading =
            Reading { formulas: &formulas, period: &period, precision: PRECISION, value: |id| value(id, (1, 1)) };
        let harmonics = reading.read(&[root])?.remove(0);
        Some((harmonics, TIMES.map(|time| value(root, time))))
    }

    const TIMES: [(i64, i64); 2] = [(1, 7), (5, 13)];

    #[test]
    fn polynomials_have_the_values_of_their_formulas() {
        for (text, most) in [
            ("3 - k", 0),
            ("cos(4*pi*t)", 1),
            ("sin(4*pi*t)", 1),
            ("cos(8*pi*t + k) - 2*sin(k - 4*pi*t)", 2),
            ("sin(4*(pi*t) + 8*pi*t)", 3),
            ("cos(-(t*4)*pi/k*(1/3 - 0*t)*0 + 2*t*(2*pi))", 1),
            ("sin(4*pi*t)^2*cos(4*pi*t)*k", 3),
            ("(1 + cos(4*pi*t)/k)^4", 4),
            ("sin(4*pi*t)*cos(8*pi*t) - (k - sin(4*pi*t))*exp(k)", 3),
            ("cos(t - t + 8*pi*t/(1 + 1))", 1),
            ("sin(4*pi*(t - 1/8)) + -cos(12*pi*(1/8 - t))", 3),
            ("sqrt(k)*sin(4*pi*t)/(1 + k^2)", 1),
            ("cos(4*pi*t + 2)^0 + sin(4*pi*t)*0", 0),
            ("cos(4*pi*t)^8*sin(480*pi*t)", 128),
        ] {
            let (harmonics, values) = read(text).unwrap_or_else(|| panic!("{text} is read"));
            assert_eq!(harmonics.len(), most + 1, "{text}");
            for (time, value) in TIMES.into_iter().zip(values) {
                let sum = (0..harmonics.len()).fold(number((0, 1)), |sum, k| {
                    let (c, angle) =
                        (harmonics.at(k, PRECISION), Interval::pi(PRECISION) * (4 * k as i64) * number(time));
                    sum + (c.re * angle.cos() - c.im * angle.sin()) * if k == 0 { 1 } else { 2 }
                });
                let apart = (&sum - &value).abs();
                assert!(sum.intersect(&value).is_defined() && apart.hi().to_f64() < 1e-25, "{text}: {sum:?} {value:?}");
            }
        }
    }

    /// What has another form or another period is none, and what has too many harmonics.
    #[test]
    fn what_is_no_polynomial_by_its_form() {
        for text in [
            "t",
            "t*cos(4*pi*t)",
            "cos(2*pi*t)",
            "cos(4*pi*t*k)",
            "cos(4*t)",
            "cos(4*pi*t)/(2 + cos(4*pi*t))",
            "sqrt(2 + sin(4*pi*t))",
            "exp(cos(4*pi*t))",
            "cos(sin(4*pi*t))",
            "tan(4*pi*t)",
            "abs(2 + cos(4*pi*t))",
            "sin(4*pi*t)^-1",
            "cos(4*pi*t + cos(4*pi*t))",
            "sin(516*pi*t)",
            "cos(4*pi*t)^129",
            "min(cos(4*pi*t), 0)",
        ] {
            assert!(read(text).is_none(), "{text}");
        }
        assert!(read("sin(512*pi*t) + cos(4*pi*t)^128").is_some());
    }
}
