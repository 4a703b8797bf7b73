//! The Lyapunov triple of a specification with a Jacobian (docs/mathematics.md, sections 1 and 7, L1).
//!
//! Guarantee: `P_low I <= P(t) <= P_up I` and `P' + P F + F'P <= -2 alpha P` for every t and every F(t) of the Jacobian, whose
//! interval entries may change with time; P has the period T by its form, and so have the functions in F, which is proved
//! first. The triple that the other rules use is the one proved here.
//!
//! Each inequality is a question ([`super::question`]) in t alone; the last one at each vertex of the interval entries, for it
//! is affine in them, or, with many of them, in the ball around their middle. With a period that is an interval P' is v dP/ds, for every
//! clock v (section 13.3).

use super::bounds::rate;
use super::formula::{Demand, Formulas, Id, Leaf};
use super::machine::{Curves, Machine};
use super::model::{matrix, polynomials};
use super::orbit::shifted;
use super::periodic::jacobian_is_periodic;
use super::question::{Answer, MAX_PIECES, Question};
use super::region::{Region, Shape};
use super::{at_rising_precision, smooth, too_large};
use proofs_core::interval::Interval;
use proofs_core::jacobian::{Entry, Jacobian, RULE, Witness};
use proofs_core::period::Period;
use proofs_core::range::Span;
use proofs_core::verdict::{Outcome, bad, demand};
use rug::Rational;

/// Up to this many interval entries every vertex is looked at; beyond, a ball that contains the box.
const MAX_VERTEX_ENTRIES: usize = 6;

/// Proves the triple of a witness for a Jacobian; returns what was looked at, in words.
pub fn prove(jacobian: &Jacobian, period: &Period, w: &Witness) -> Outcome<String> {
    jacobian_is_periodic(jacobian, period)?;
    let clock = period.clock("/specification/period")?;
    at_rising_precision(|precision| attempt(jacobian, (&period.nominal.enclose(precision), clock.as_ref()), w))
}

/// An inequality on matrices of formulas in t, which holds at every t where it is proved.
struct Problem<'a> {
    /// The nominal one.
    period: &'a Interval,
    clock: Option<&'a Span>,
    w: &'a Witness,
    boxes: usize,
}

/// The formulas of a problem, with what their operations ask for, and the entries of P.
struct Parts {
    formulas: Formulas,
    demands: Vec<(Id, Demand)>,
    p: Vec<Vec<Id>>,
}

impl Parts {
    /// One F of the Jacobian: the bits of a vertex say of each interval entry whether its upper end stands for it; without one the middle does.
    fn member(&mut self, jacobian: &Jacobian, vertex: Option<usize>) -> Vec<Vec<Id>> {
        let mut index = 0;
        let Parts { formulas, demands, .. } = self;
        let time = formulas.leaf(Leaf::Time);
        let mut entry = |entry: &Entry| match entry {
            Entry::Function(expr) => formulas.read(expr, &[time], demands),
            Entry::Between(ends) => {
                index += 1;
                let [lo, hi] = ends.each_ref().map(|end| formulas.read(end.expr(), &[], demands));
                match vertex {
                    Some(vertex) if vertex >> (index - 1) & 1 == 1 => hi,
                    Some(_) => lo,
                    None => {
                        let half = formulas.number(&Rational::from((1, 2)));
                        formulas.make(half * (lo + hi))
                    }
                }
            }
        };
        jacobian.iter().map(|row| row.iter().map(&mut entry).collect()).collect()
    }
}

impl Problem<'_> {
    /// Proves a matrix positive semidefinite at every t; `refutes`: where it is not, the triple is not one.
    fn everywhere(&mut self, what: &str, refutes: bool, rows: impl Fn(&mut Parts) -> Vec<Vec<Id>>) -> Outcome<()> {
        let mut parts = Parts { formulas: Formulas::default(), demands: Vec::new(), p: Vec::new() };
        parts.formulas.clock = self.clock.map(|_| parts.formulas.leaf(Leaf::Parameter(0)));
        parts.p = matrix(&mut parts.formulas, 0, self.w);
        let rows = rows(&mut parts);
        let question = Question::new(&mut parts.formulas, rows, 0);
        let Parts { formulas, demands, .. } = &parts;
        if formulas.is_too_large() {
            return too_large(RULE, &self.w.pointer);
        }
        let curves = Curves { orbit: Vec::new(), lyapunov: vec![polynomials(self.w)] };
        let precision = self.period.precision();
        let machine = Machine::new(formulas, &curves, &(Interval::pi(precision) * 2 / self.period));
        let (root, mut values) = (machine.period(self.period), machine.values());
        let zero = Interval::int(0, precision);
        let parameters = self.clock.iter().map(|clock| clock.ends.clone()).collect();
        let region = Region { states: 0, shape: Shape::Ball(zero.clone()), output: zero, parameters };
        let place = "/specification/lyapunov/jacobian";
        smooth::prove(formulas, demands, place, &machine, &root, &region, &mut values)?;
        let (truth, near) = match question.decide(&machine, &root, &region, MAX_PIECES, &mut values) {
            Answer::Proved(count) => {
                self.boxes += count;
                return Ok(());
            }
            Answer::Refuted(near) => (refutes.then_some(false), near),
            Answer::Open(near) => (None, near),
        };
        demand(truth, RULE, &self.w.pointer, format!("{what} at {near}"))
    }
}

fn attempt(jacobian: &Jacobian, (period, clock): (&Interval, Option<&Span>), w: &Witness) -> Outcome<String> {
    let precision = period.precision();
    let ends = |entry: &Entry| match entry {
        Entry::Function(_) => None,
        Entry::Between(ends) => Some(ends.each_ref().map(|end| end.enclose(precision))),
    };
    let intervals: Vec<[Interval; 2]> = jacobian.iter().flatten().filter_map(ends).collect();
    let [p_low, p_up, alpha] = &w.numbers;
    let mut problem = Problem { period, clock, w, boxes: 0 };
    problem.everywhere("P_low I <= P", true, |parts| shifted(&mut parts.formulas, &parts.p, p_low, 1))?;
    problem.everywhere("P <= P_up I", true, |parts| shifted(&mut parts.formulas, &parts.p, p_up, -1))?;

    let what = "P' + P F + F'P <= -2 alpha P";
    let count = if intervals.len() <= MAX_VERTEX_ENTRIES { 1 << intervals.len() } else { 0 };
    for vertex in 0..count {
        problem.everywhere(what, true, |parts| {
            let f = parts.member(jacobian, Some(vertex));
            rate(&mut parts.formulas, alpha, &parts.p, &f)
        })?;
    }
    if count == 0 {
        // |P D + D'P| <= 2 P_up |D|, and |D| is at most the root of the sum of the squared radii.
        let squares = intervals.iter().fold(Interval::int(0, precision), |sum, [lo, hi]| sum + ((hi - lo) / 2).sqr());
        let taken = (Interval::rational(p_up, precision) * squares.sqrt() * 2).upper();
        let taken = taken.map_or_else(|| bad(&w.pointer, "the interval entries are not bounded"), Ok)?;
        problem.everywhere(what, false, |parts| {
            let f = parts.member(jacobian, None);
            let mut rows = rate(&mut parts.formulas, alpha, &parts.p, &f);
            let taken = parts.formulas.number(&taken);
            rows.iter_mut().enumerate().for_each(|(i, row)| row[i] = parts.formulas.make(row[i] - taken));
            rows
        })?;
    }
    let where_ =
        if count == 0 { "in a ball that contains the intervals".to_owned() } else { format!("at {count} vertices") };
    Ok(format!("P_low I <= P <= P_up I, and {what} {where_}, by {} boxes in t", problem.boxes))
}
