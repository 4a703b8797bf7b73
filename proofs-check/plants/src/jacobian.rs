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
//! sums of R are positive definite: then so is everything on the line between. Time is s = t/T here. The cells are proposed, up to
//! a bounded effort; that they cover a period, and each of them, is verified.

use super::periodic::jacobian_is_periodic;
use crate::break_points::{Judgement, break_points};
use proofs_core::constant::Constant;
use proofs_core::effort;
use proofs_core::expr::{Expr, Op, interval_op};
use proofs_core::interval::Interval;
use proofs_core::jacobian::{Entry, Jacobian, RULE, Witness};
use proofs_core::matrix::positive_definite;
use proofs_core::verdict::{Outcome, Verdict, demand};
use rug::Rational;

/// Up to this many interval entries every vertex is looked at; beyond, a ball that contains the box.
const MAX_VERTEX_ENTRIES: usize = 6;
/// The most cells, and the most cells times (order cubed plus order squared times harmonics), that are looked at.
const MAX_CELLS: usize = 20_000;
const MAX_WORK: usize = 2_000_000;
/// The precisions in bits, each tried where the one before does not decide.
const PRECISIONS: [u32; 3] = [96, 192, 512];

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

    /// Proves Q positive definite on [0, 1] by cells that are proposed, of which at most `left` may be halved; `refutes`: where
    /// Q is not, the triple is not one.
    fn everywhere(
        &self,
        what: &str,
        refutes: bool,
        left: &mut usize,
        q: impl Fn(&Interval) -> Vec<Vec<Jet>>,
    ) -> Outcome<()> {
        let at = |s: &Rational| -> Vec<Vec<Interval>> {
            let value = |row: &Vec<Jet>| row.iter().map(|jet| jet.0[0].clone()).collect();
            q(&Interval::rational(s, self.precision)).iter().map(value).collect()
        };
        let judge = |[a, b]: [&Rational; 2], ends: [&Vec<Vec<Interval>>; 2]| {
            let sums = self.distance(a, b, &q);
            if ends.iter().all(|end| definite(end, &sums) == Some(true)) {
                return Judgement::Proved;
            }
            // A distance of 0 is not made smaller by halves.
            let truth = ends.map(|end| definite(end, &[]));
            let halve = truth == [Some(true); 2] && !sums.iter().all(Interval::is_zero);
            if halve { Judgement::Halve } else { Judgement::Stop(usize::from(truth[0] == Some(true))) }
        };
        let place = match effort::aside(|| break_points(left, at, judge)) {
            Ok(points) => match self.first_open(&points, at, &q) {
                None => return Ok(()),
                Some(place) => place,
            },
            Err(place) => place,
        };
        let truth = if refutes && definite(&at(&place), &[]) == Some(false) { Some(false) } else { None };
        demand(truth, RULE, &self.w.pointer, format!("{what} at t/T = {}", place.to_f64()))
    }

    /// Verifies that the points increase from 0 to 1 and that Q is positive definite between neighbours; else where that is
    /// not shown.
    fn first_open(
        &self,
        points: &[Rational],
        at: impl Fn(&Rational) -> Vec<Vec<Interval>>,
        q: impl Fn(&Interval) -> Vec<Vec<Jet>>,
    ) -> Option<Rational> {
        if points.first().is_none_or(|first| *first != 0) || points.last().is_none_or(|last| *last != 1) {
            return Some(Rational::new());
        }
        let mut left = at(&points[0]);
        points.windows(2).find_map(|ends| {
            let right = at(&ends[1]);
            let sums = self.distance(&ends[0], &ends[1], &q);
            let proved = ends[0] < ends[1] && [&left, &right].iter().all(|end| definite(end, &sums) == Some(true));
            left = right;
            (!proved).then(|| ends[1].clone())
        })
    }

    /// (b-a)^2/8 times the row sums of R: how far Q is from the line between Q(a) and Q(b).
    fn distance(&self, a: &Rational, b: &Rational, q: impl Fn(&Interval) -> Vec<Vec<Jet>>) -> Vec<Interval> {
        let width = Rational::from(b - a);
        let factor = Interval::rational(&(Rational::from(width.square_ref()) / 8u32), self.precision);
        let zero = || Interval::int(0, self.precision);
        let sum = |row: &Vec<Jet>| row.iter().fold(zero(), |sum, jet| sum + jet.0[2].abs()) * &factor;
        q(&Interval::between(a, b, self.precision)).iter().map(sum).collect()
    }
}

/// Whether a symmetric matrix less a diagonal one (none: 0) is positive definite.
fn definite(matrix: &[Vec<Interval>], less: &[Interval]) -> Option<bool> {
    let entry = |i: usize, j: usize| match less.get(i).filter(|_| i == j) {
        Some(less) => &matrix[i][j] - less.ceiling(),
        None => matrix[i][j].clone(),
    };
    positive_definite((0..matrix.len()).map(|i| (0..=i).map(|j| entry(i, j)).collect()).collect())
}

/// Proves the triple of a witness for a Jacobian; returns what was looked at, in words.
pub fn prove(jacobian: &Jacobian, period: &Constant, w: &Witness) -> Outcome<String> {
    jacobian_is_periodic(jacobian, period)?;
    let mut last = attempt(jacobian, period, w, PRECISIONS[0]);
    for precision in &PRECISIONS[1..] {
        if last.as_ref().is_err_and(|finding| finding.verdict == Verdict::Undecided) {
            last = attempt(jacobian, period, w, *precision);
        }
    }
    last
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

#[cfg(test)]
mod tests {
    use super::*;
    use proofs_core::json::{Field, parse};

    #[test]
    fn cells_must_cover_a_period_and_be_proved_one_by_one() {
        let text = r#"{ "P": [["1"]], "harmonics": [{ "cos": [["1/4"]], "sin": [["0"]] }],
            "p_low": "0.7", "p_up": "1.3", "alpha": "1" }"#;
        let json = parse(text.as_bytes()).unwrap();
        let (w, _) = Witness::read(&Field { json: &json, pointer: String::new() }, 1).unwrap();
        let problem = Problem { w: &w, period: Interval::int(1, 96), precision: 96 };
        let proved = |p_low: (i32, i32), points: &[(i32, i32)]| {
            let shift = -Rational::from(p_low);
            let q = |s: &Interval| problem.shifted(s, 1, &shift);
            let at = |s: &Rational| vec![vec![q(&Interval::rational(s, 96))[0][0].0[0].clone()]];
            let points: Vec<Rational> = points.iter().map(|point| Rational::from(*point)).collect();
            problem.first_open(&points, at, q).is_none()
        };
        let quarters = [(0, 1), (1, 4), (1, 2), (3, 4), (1, 1)];
        assert!(proved((1, 3), &quarters));
        // 1 + cos(2 pi s)/4 - 4/5 is positive at both ends, and -1/20 in the middle.
        assert!(!proved((4, 5), &[(0, 1), (1, 1)]) && !proved((4, 5), &quarters));
        for points in [&[][..], &[(0, 1)], &quarters[1..], &quarters[..4], &[(0, 1), (3, 4), (1, 4), (1, 1)]] {
            assert!(!proved((1, 3), points), "{points:?}");
        }
        assert!(!proved((1, 3), &[(0, 1), (1, 1)]), "too wide");
    }
}
