//! The Lyapunov triple of a specification with a Jacobian (docs/mathematics.md, sections 1 and 7, L1).
//!
//! Guarantee: `P_low I <= P(t) <= P_up I` and `P' + P F + F'P <= -2 alpha P` for every t and every F(t) of the Jacobian, whose
//! interval entries may change with time; P has the period T by its form, and so have the functions in F, which is proved
//! first. The triple that the other rules use is the one proved here.
//!
//! `Q = P - P_low I`, `P_up I - P` or `-(P' + P F + F'P + 2 alpha P)`, the last at each vertex of the interval entries (it is
//! affine in them), is proved positive definite on cells [a, b] that cover a period. With R_ij the largest |Q_ij''| on the
//! cell, Q lies entrywise within (b-a)^2/8 R of the line between Q(a) and Q(b). A symmetric matrix with entries within E
//! of 0 is at most the diagonal matrix of the row sums of E. So it is enough that Q(a) and Q(b) less (b-a)^2/8 times the row
//! sums of R are positive definite: then so is everything on the line between. Time is s = t/T here; a cell that is not
//! proved is halved, up to a bounded effort.

use crate::exact::Exact;
use crate::expr::{Expr, Op, exact_op, interval_op};
use crate::interval::Interval;
use crate::json::Field;
use crate::matrix::positive_definite;
use crate::spec::{Constant, Entry, Jacobian};
use crate::verdict::{Outcome, Verdict, bad, demand, finding, invalid};
use rug::Rational;

/// The highest harmonic of P that is read.
const MAX_HARMONIC: usize = 64;
/// Up to this many interval entries every vertex is looked at; beyond, a ball that contains the box.
const MAX_VERTEX_ENTRIES: usize = 6;
/// The most cells, and the most cells times (order cubed plus order squared times harmonics), that are looked at.
const MAX_CELLS: usize = 20_000;
const MAX_WORK: usize = 2_000_000;
/// The precisions in bits, each tried where the one before does not decide.
const PRECISIONS: [u32; 3] = [96, 192, 512];
const RULE: &str = "Lyapunov triple";

type Matrix = Vec<Vec<Rational>>;

/// P(t) = mean + sum over k of cos(2 pi k t/T) A_k + sin(2 pi k t/T) B_k, and the triple.
#[derive(Clone, Debug)]
pub struct Witness {
    pointer: String,
    mean: Matrix,
    harmonics: Vec<[Matrix; 2]>,
    /// P_low, P_up, alpha.
    numbers: [Rational; 3],
}

/// Reads a symmetric matrix of the order of the Jacobian.
fn matrix(field: &Field<'_>, order: usize) -> Outcome<Matrix> {
    let row = |row: &Field<'_>| row.elements()?.iter().map(Field::rational).collect::<Outcome<Vec<_>>>();
    let rows = field.elements()?.iter().map(row).collect::<Outcome<Matrix>>()?;
    if rows.len() != order || rows.iter().any(|row| row.len() != order) {
        return bad(&field.pointer, format!("expected {order} rows of {order} numbers, as the Jacobian has"));
    }
    let symmetric = (0..order).all(|i| (0..i).all(|j| rows[i][j] == rows[j][i]));
    demand(Some(symmetric), RULE, &field.pointer, "P is symmetric")?;
    Ok(rows)
}

impl Witness {
    /// Reads the part `lyapunov` of a witness; its numbers are the triple p_low, p_up, alpha.
    pub fn read(field: &Field<'_>, order: usize) -> Outcome<(Witness, [Constant; 3])> {
        let mut fields = field.fields()?;
        let mean = matrix(&fields.required("P")?, order)?;
        let mut harmonics = Vec::new();
        if let Some(list) = fields.optional("harmonics") {
            for element in list.elements()? {
                let mut pair = element.fields()?;
                let [cos, sin] = [pair.required("cos")?, pair.required("sin")?];
                pair.finish()?;
                harmonics.push([matrix(&cos, order)?, matrix(&sin, order)?]);
            }
            if harmonics.len() > MAX_HARMONIC {
                return bad(&list.pointer, format!("expected at most {MAX_HARMONIC} harmonics"));
            }
        }
        let mut triple = Vec::new();
        let mut number = |name: &str| -> Outcome<Rational> {
            let field = fields.required(name)?;
            let value = field.rational()?;
            demand(Some(value > 0), RULE, &field.pointer, format!("{name} > 0"))?;
            triple.push(Constant::read(&field)?);
            Ok(value)
        };
        let numbers = [number("p_low")?, number("p_up")?, number("alpha")?];
        fields.finish()?;
        let [p_low, p_up, alpha] = &triple[..] else { return bad(&field.pointer, "expected a triple") };
        let triple = [p_low.clone(), p_up.clone(), alpha.clone()];
        Ok((Witness { pointer: field.pointer.clone(), mean, harmonics, numbers }, triple))
    }
}

/// A function of s = t/T on a cell: enclosures of its values and of its first two derivatives.
#[derive(Clone)]
struct Jet([Interval; 3]);

impl Jet {
    fn constant(value: Interval) -> Jet {
        let zero = || Interval::int(0, value.precision());
        Jet([value.clone(), zero(), zero()])
    }

    fn plus(&self, other: &Jet) -> Jet {
        Jet([0, 1, 2].map(|i| &self.0[i] + &other.0[i]))
    }

    fn times(&self, other: &Jet) -> Jet {
        let ([u, du, ddu], [v, dv, ddv]) = (&self.0, &other.0);
        Jet([u * v, du * v + u * dv, ddu * v + du * dv * 2 + u * ddv])
    }

    fn scaled(&self, factor: &Interval) -> Jet {
        Jet([0, 1, 2].map(|i| &self.0[i] * factor))
    }

    fn is_constant(&self) -> bool {
        self.0[1].is_zero() && self.0[2].is_zero()
    }

    /// f(u), by the values of f, f', f'' on the range of u.
    fn chain(&self, [f, df, ddf]: [Interval; 3]) -> Jet {
        let [_, du, ddu] = &self.0;
        Jet([f, &df * du, ddf * du.sqr() + df * ddu])
    }

    /// An operation of an expression in t; undefined where the operands vary and it is none of + - * / ^n sin cos.
    fn apply(op: &Op, time: &Jet, a: Option<Jet>, b: Option<Jet>) -> Jet {
        let none = Interval::undefined(time.0[0].precision());
        let [u, v] = [&a, &b].map(|jet| jet.as_ref().map_or(&none, |jet| &jet.0[0]));
        if *op == Op::X {
            return time.clone();
        }
        let varies = |jet: &Option<Jet>| jet.as_ref().is_some_and(|jet| !jet.is_constant());
        if !varies(&a) && !varies(&b) {
            return Jet::constant(interval_op(op, u, v));
        }
        let minus_one = Interval::int(-1, none.precision());
        match (op, &a, &b) {
            (Op::Add, Some(a), Some(b)) => a.plus(b),
            (Op::Sub, Some(a), Some(b)) => a.plus(&b.scaled(&minus_one)),
            (Op::Mul, Some(a), Some(b)) => a.times(b),
            (Op::Div, Some(a), Some(b)) if b.is_constant() => a.scaled(&v.recip()),
            (Op::Neg, Some(a), _) => a.scaled(&minus_one),
            (Op::Sin, Some(a), _) => a.chain([u.sin(), u.cos(), -u.sin()]),
            (Op::Cos, Some(a), _) => a.chain([u.cos(), -u.sin(), -u.cos()]),
            (Op::Power(n), Some(a), _) if *n >= 2 => {
                let m = i64::from(*n);
                a.chain([u.powi(*n), u.powi(n - 1) * m, u.powi(n - 2) * (m * (m - 1))])
            }
            (Op::Power(1), Some(a), _) => a.clone(),
            _ => Jet([none.clone(), none.clone(), none]),
        }
    }
}

/// The matrices as functions of s, at one precision.
struct Problem<'a> {
    w: &'a Witness,
    period: Interval,
    precision: u32,
}

/// An entry of one F: a function of t, or a number.
enum Value<'a> {
    Function(&'a Expr),
    Number(Interval),
}

impl Problem<'_> {
    /// P, and dP/dt if that is wanted, on a cell.
    fn p<const WANTED: usize>(&self, s: &Interval) -> [Vec<Vec<Jet>>; WANTED] {
        let p = self.precision;
        let number = |q: &Rational| Interval::rational(q, p);
        // (cos, sin) of each harmonic, and d/dt of them.
        let waves: Vec<[Jet; 4]> = (1..=self.w.harmonics.len() as i64)
            .map(|k| {
                let w = Interval::pi(p) * (2 * k);
                let angle = Jet([s * &w, w.clone(), Interval::int(0, p)]);
                let (c, s) = (angle.0[0].cos(), angle.0[0].sin());
                let cos = angle.chain([c.clone(), -&s, -&c]);
                let sin = angle.chain([s.clone(), c, -s]);
                let rate = w / &self.period;
                [cos.clone(), sin.clone(), sin.scaled(&-&rate), cos.scaled(&rate)]
            })
            .collect();
        let entry = |i: usize, j: usize, derivative: usize| {
            let mean = if derivative == 0 { number(&self.w.mean[i][j]) } else { Interval::int(0, p) };
            self.w.harmonics.iter().zip(&waves).fold(Jet::constant(mean), |sum, ([a, b], wave)| {
                let [cos, sin] = [&wave[2 * derivative], &wave[2 * derivative + 1]];
                sum.plus(&cos.scaled(&number(&a[i][j]))).plus(&sin.scaled(&number(&b[i][j])))
            })
        };
        let order = self.w.mean.len();
        std::array::from_fn(|derivative| {
            (0..order).map(|i| (0..order).map(|j| entry(i, j, derivative)).collect()).collect()
        })
    }

    /// `sign P + shift I`, its lower triangle.
    fn shifted(&self, s: &Interval, sign: i64, shift: &Rational) -> Vec<Vec<Jet>> {
        let (sign, shift) = (Interval::int(sign, self.precision), Interval::rational(shift, self.precision));
        let [p] = self.p(s);
        let mut rows: Vec<Vec<Jet>> =
            p.iter().map(|row| row.iter().map(|entry| entry.scaled(&sign)).collect()).collect();
        for (i, row) in rows.iter_mut().enumerate() {
            row[i] = row[i].plus(&Jet::constant(shift.clone()));
        }
        rows
    }

    /// `-(P' + P F + F'P + 2 alpha P) - taken I`.
    fn decay(&self, s: &Interval, f: &[Vec<Value<'_>>], taken: &Interval) -> Vec<Vec<Jet>> {
        let [p, rate] = self.p(s);
        let time = Jet([s * &self.period, self.period.clone(), Interval::int(0, self.precision)]);
        let value = |entry: &Value<'_>| match entry {
            Value::Number(value) => Jet::constant(value.clone()),
            Value::Function(expr) => expr
                .fold(|op, a, b| Jet::apply(op, &time, a, b))
                .unwrap_or_else(|| Jet::constant(Interval::undefined(self.precision))),
        };
        let f: Vec<Vec<Jet>> = f.iter().map(|row| row.iter().map(value).collect()).collect();
        let twice_alpha = Interval::rational(&self.w.numbers[2], self.precision) * 2;
        let minus_one = Interval::int(-1, self.precision);
        let order = p.len();
        let entry = |i: usize, j: usize| {
            let start = rate[i][j].plus(&p[i][j].scaled(&twice_alpha));
            let sum = (0..order)
                .fold(start, |sum, k| sum.plus(&p[i][k].times(&f[k][j])).plus(&f[k][i].times(&p[k][j])))
                .scaled(&minus_one);
            if i == j { sum.plus(&Jet::constant(-taken)) } else { sum }
        };
        (0..order).map(|i| (0..order).map(|j| entry(i, j)).collect()).collect()
    }

    /// Proves Q positive definite on [0, 1], in at most `cells` cells; `refutes`: where Q is not, the triple is not one.
    fn everywhere(
        &self,
        what: &str,
        refutes: bool,
        cells: &mut usize,
        q: impl Fn(&Interval) -> Vec<Vec<Jet>>,
    ) -> Outcome<()> {
        let pointer = &self.w.pointer;
        // Each end of a cell with Q there.
        let at = |s: Rational| {
            let q = q(&Interval::rational(&s, self.precision));
            (s, q.iter().map(|row| row.iter().map(|jet| jet.0[0].clone()).collect()).collect::<Vec<Vec<_>>>())
        };
        let mut queue = vec![[at(Rational::new()), at(Rational::from(1))]];
        while let Some([(a, at_a), (b, at_b)]) = queue.pop() {
            let over = q(&Interval::between(&a, &b, self.precision));
            let width = Rational::from(&b - &a);
            let factor = Interval::rational(&(Rational::from(width.square_ref()) / 8u32), self.precision);
            let sums: Vec<Interval> = over
                .iter()
                .map(|row| row.iter().fold(Interval::int(0, self.precision), |sum, jet| sum + jet.0[2].abs()) * &factor)
                .collect();
            let definite = |end: &[Vec<Interval>], less: bool| {
                let entry = |i: usize, j: usize| {
                    if less && i == j { &end[i][j] - &sums[i].ceiling() } else { end[i][j].clone() }
                };
                positive_definite((0..end.len()).map(|i| (0..=i).map(|j| entry(i, j)).collect()).collect())
            };
            if definite(&at_a, true) == Some(true) && definite(&at_b, true) == Some(true) {
                continue;
            }
            let truth = [&at_a, &at_b].map(|end| definite(end, false));
            let end = if truth[0] == Some(true) { &b } else { &a };
            let place = format!("{what} at t/T = {}", end.to_f64());
            if refutes && truth.contains(&Some(false)) {
                return invalid(RULE, pointer, format!("not satisfied: {place}"));
            }
            let constant = sums.iter().all(Interval::is_zero);
            if *cells == 0 || constant || truth.contains(&None) {
                let message = format!("can be neither proved nor refuted: {place}");
                return Err(finding(Verdict::Undecided, RULE, pointer, message));
            }
            *cells -= 1;
            let middle = at(Rational::from(&a + &b) / 2u32);
            queue.extend([[middle.clone(), (b, at_b)], [(a, at_a), middle]]);
        }
        Ok(())
    }
}

/// Proves the triple of a witness for a Jacobian; returns what was looked at, in words.
pub fn prove(jacobian: &Jacobian, period: &Constant, w: &Witness) -> Outcome<String> {
    periodic(jacobian, period)?;
    let mut last = attempt(jacobian, period, w, PRECISIONS[0]);
    for precision in &PRECISIONS[1..] {
        if last.as_ref().is_err_and(|finding| finding.verdict == Verdict::Undecided) {
            last = attempt(jacobian, period, w, *precision);
        }
    }
    last
}

/// How a part of an expression changes when t grows by the period T.
#[derive(Clone)]
enum Shift {
    /// It does not depend on t; its exact value, if it has one.
    Constant(Option<Exact>),
    /// It is this multiple of t, plus a constant.
    Line(Exact),
    /// It stays (false) or changes its sign (true).
    Sign(bool),
    /// Nothing is known.
    Unknown,
}

impl Shift {
    /// A line; one without a slope stays.
    fn line(slope: Option<Exact>) -> Shift {
        match slope {
            Some(slope) if slope.sign() == 0 => Shift::Sign(false),
            Some(slope) => Shift::Line(slope),
            None => Shift::Unknown,
        }
    }

    /// sin and cos of a line change their signs if `slope T/pi` is an odd integer, and stay if it is an even one.
    fn wave(slope: &Exact, period: Option<&Exact>) -> Shift {
        let half_turns = || slope.mul(period?)?.mul(&Exact::pi().recip()?)?.as_rational();
        match half_turns() {
            Some(count) if *count.denom() == 1 => Shift::Sign(count.numer().is_odd()),
            _ => Shift::Unknown,
        }
    }

    fn apply(op: &Op, period: Option<&Exact>, a: Option<Shift>, b: Option<Shift>) -> Shift {
        use Shift::{Constant, Line, Sign, Unknown};
        let operand = |shift: &Option<Shift>| match shift {
            Some(Constant(value)) => Ok(Some(value.clone())),
            None => Ok(None),
            _ => Err(()),
        };
        if let (Ok(a), Ok(b), true) = (operand(&a), operand(&b), *op != Op::X) {
            return Constant(exact_op(op, a, b));
        }
        match (op, a, b) {
            (Op::X, ..) => Shift::line(Exact::rational(&Rational::from(1))),
            (Op::Neg, Some(Line(slope)), _) => Line(slope.neg()),
            (Op::Neg, Some(Sign(odd)), _) => Sign(odd),
            (Op::Sin | Op::Cos, Some(Line(slope)), _) => Shift::wave(&slope, period),
            (Op::Sin | Op::Cos, Some(Sign(false)), _) => Sign(false),
            (Op::Power(n), Some(Sign(odd)), _) => Sign(odd && n % 2 != 0),
            (Op::Add | Op::Sub, Some(Line(slope)), Some(Constant(_)))
            | (Op::Add, Some(Constant(_)), Some(Line(slope))) => Line(slope),
            (Op::Sub, Some(Constant(_)), Some(Line(slope))) => Line(slope.neg()),
            (Op::Add, Some(Line(a)), Some(Line(b))) => Shift::line(a.add(&b)),
            (Op::Sub, Some(Line(a)), Some(Line(b))) => Shift::line(a.add(&b.neg())),
            (Op::Add | Op::Sub, Some(Sign(a)), Some(Sign(b))) if a == b => Sign(a),
            (Op::Add | Op::Sub, Some(Sign(false)), Some(Constant(_)))
            | (Op::Add | Op::Sub, Some(Constant(_)), Some(Sign(false))) => Sign(false),
            (Op::Mul, Some(Constant(Some(c))), Some(Line(slope)))
            | (Op::Mul, Some(Line(slope)), Some(Constant(Some(c)))) => Shift::line(slope.mul(&c)),
            (Op::Div, Some(Line(slope)), Some(Constant(Some(c)))) => Shift::line(c.recip().and_then(|c| slope.mul(&c))),
            (Op::Mul, Some(Sign(a)), Some(Sign(b))) => Sign(a != b),
            (Op::Mul, Some(Sign(odd)), Some(Constant(_)))
            | (Op::Mul, Some(Constant(_)), Some(Sign(odd)))
            | (Op::Div, Some(Sign(odd)), Some(Constant(_))) => Sign(odd),
            _ => Unknown,
        }
    }
}

/// Whether a function of t has the period: proved by its form, refuted by values at some times a period apart.
fn is_periodic(expr: &Expr, period: &Constant) -> Option<bool> {
    let shift = expr.fold(|op, a, b| Shift::apply(op, period.exact.as_ref(), a, b));
    if matches!(shift, Some(Shift::Constant(_) | Shift::Sign(false))) {
        return Some(true);
    }
    let period = period.enclose(PRECISIONS[0]);
    let at = |time: Interval| expr.enclose(&time, &Interval::undefined(PRECISIONS[0]));
    let apart = |k: i64| {
        let (now, later) = (at(&period * k / 7), at(&period * (k + 7) / 7));
        now.lt(&later) == Some(true) || later.lt(&now) == Some(true)
    };
    (0..7).any(apart).then_some(false)
}

/// Every function of t in the Jacobian has the period of the specification.
fn periodic(jacobian: &Jacobian, period: &Constant) -> Outcome<()> {
    for entry in jacobian.iter().flatten() {
        if let Entry::Function(expr) = entry {
            let what = "the Jacobian has the period of the specification";
            demand(is_periodic(expr, period), RULE, "/specification/lyapunov/jacobian", what)?;
        }
    }
    Ok(())
}

fn attempt<'e>(jacobian: &'e Jacobian, period: &Constant, w: &Witness, precision: u32) -> Outcome<String> {
    let problem = Problem { w, period: period.enclose(precision), precision };
    let (order, harmonics) = (jacobian.len(), w.harmonics.len());
    let most = MAX_CELLS.min(MAX_WORK / (order.pow(3) + order.pow(2) * harmonics));
    let mut left = most;
    let [p_low, p_up, _] = &w.numbers;
    problem.everywhere("P_low I <= P", true, &mut left, |s| problem.shifted(s, 1, &Rational::from(-p_low)))?;
    problem.everywhere("P <= P_up I", true, &mut left, |s| problem.shifted(s, -1, p_up))?;

    let ends = |entry: &Entry| match entry {
        Entry::Function(_) => None,
        Entry::Between(ends) => Some(ends.each_ref().map(|end| end.enclose(precision))),
    };
    let intervals: Vec<[Interval; 2]> = jacobian.iter().flatten().filter_map(ends).collect();
    // The entries of F, with numbers in place of the interval entries, in order.
    let member = |choose: &dyn Fn(usize) -> Interval| -> Vec<Vec<Value<'e>>> {
        let mut index = 0;
        let mut value = |entry: &'e Entry| match entry {
            Entry::Function(expr) => Value::Function(expr),
            Entry::Between(_) => {
                index += 1;
                Value::Number(choose(index - 1))
            }
        };
        jacobian.iter().map(|row| row.iter().map(&mut value).collect()).collect()
    };
    let what = "P' + P F + F'P <= -2 alpha P";
    let zero = Interval::int(0, precision);
    let count = if intervals.len() <= MAX_VERTEX_ENTRIES { 1 << intervals.len() } else { 0 };
    for vertex in 0..count {
        let f = member(&|index| intervals[index][vertex >> index & 1].clone());
        problem.everywhere(what, true, &mut left, |s| problem.decay(s, &f, &zero))?;
    }
    if count == 0 {
        // |P D + D'P| <= 2 P_up |D|, and |D| is at most the root of the sum of the squared radii.
        let f = member(&|index| (&intervals[index][0] + &intervals[index][1]) / 2);
        let squares = intervals.iter().fold(zero, |sum, [lo, hi]| sum + ((hi - lo) / 2).sqr());
        let taken = Interval::rational(p_up, precision) * squares.sqrt() * 2;
        problem.everywhere(what, false, &mut left, |s| problem.decay(s, &f, &taken))?;
    }
    let where_ =
        if count == 0 { "in a ball that contains the intervals".to_owned() } else { format!("at {count} vertices") };
    Ok(format!("P_low I <= P <= P_up I, and {what} {where_}, by {} cuts in t", most - left))
}
