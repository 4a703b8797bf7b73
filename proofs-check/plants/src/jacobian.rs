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

/// One F of the Jacobian: the bits of a vertex say of each interval entry whether its upper end stands for it; without one the middle does.
fn member(
    formulas: &mut Formulas,
    demands: &mut Vec<(Id, Demand)>,
    jacobian: &Jacobian,
    vertex: Option<usize>,
) -> Vec<Vec<Id>> {
    let (mut index, time) = (0, formulas.leaf(Leaf::Time));
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

fn attempt(jacobian: &Jacobian, (period, clock): (&Interval, Option<&Span>), w: &Witness) -> Outcome<String> {
    let precision = period.precision();
    let ends = |entry: &Entry| match entry {
        Entry::Function(_) => None,
        Entry::Between(ends) => Some(ends.each_ref().map(|end| end.enclose(precision))),
    };
    let intervals: Vec<[Interval; 2]> = jacobian.iter().flatten().filter_map(ends).collect();
    let by_vertices = intervals.len() <= MAX_VERTEX_ENTRIES;
    let count = if by_vertices { 1 << intervals.len() } else { 1 };
    let [p_low, p_up, alpha] = &w.numbers;
    // In a ball |P D + D'P| <= 2 P_up |D|, and |D| is at most the root of the sum of the squared radii.
    let squares = intervals.iter().fold(Interval::int(0, precision), |sum, [lo, hi]| sum + ((hi - lo) / 2).sqr());
    let taken = (Interval::rational(p_up, precision) * squares.sqrt() * 2).upper().filter(|_| !by_vertices);
    if !by_vertices && taken.is_none() {
        return bad(&w.pointer, "the interval entries are not bounded");
    }

    let curves = Curves { orbit: Vec::new(), lyapunov: vec![polynomials(w)] };
    let zero = || Interval::int(0, precision);
    let parameters = clock.iter().map(|clock| clock.ends.clone()).collect();
    let region = Region { states: 0, shape: Shape::Ball(zero()), output: zero(), parameters };
    let falls = "P' + P F + F'P <= -2 alpha P";
    let mut boxes = 0;
    for vertex in 0..count {
        let (mut formulas, mut demands) = (Formulas::default(), Vec::new());
        formulas.clock = clock.map(|_| formulas.leaf(Leaf::Parameter(0)));
        let p = matrix(&mut formulas, 0, w);
        let mut asked = Vec::new();
        if vertex == 0 {
            asked.push(("P_low I <= P", shifted(&mut formulas, &p, p_low, 1)));
            asked.push(("P <= P_up I", shifted(&mut formulas, &p, p_up, -1)));
        }
        let f = member(&mut formulas, &mut demands, jacobian, by_vertices.then_some(vertex));
        let mut rows = rate(&mut formulas, alpha, &p, &f);
        if let Some(taken) = &taken {
            let taken = formulas.number(taken);
            rows.iter_mut().enumerate().for_each(|(i, row)| row[i] = formulas.make(row[i] - taken));
        }
        asked.push((falls, rows));
        let asked: Vec<_> =
            asked.into_iter().map(|(what, rows)| (what, Question::new(&mut formulas, rows, 0))).collect();
        if formulas.is_too_large() {
            return too_large(RULE, &w.pointer);
        }
        let machine = Machine::new(&formulas, &curves, &(Interval::pi(precision) * 2 / period));
        let (root, mut values) = (machine.period(period), machine.values());
        let place = "/specification/lyapunov/jacobian";
        smooth::prove(&formulas, &demands, place, &machine, &root, &region, &mut values)?;
        for (what, question) in asked {
            let (truth, near) = match question.decide(&machine, &root, &region, MAX_PIECES, &mut values) {
                Answer::Proved(count) => {
                    boxes += count;
                    continue;
                }
                // The ball is larger than the Jacobian.
                Answer::Refuted(near) => ((by_vertices || what != falls).then_some(false), near),
                Answer::Open(near) => (None, near),
            };
            demand(truth, RULE, &w.pointer, format!("{what} at {near}"))?;
        }
    }
    let where_ = match by_vertices {
        false => "in a ball that contains the intervals".to_owned(),
        true => format!("at {count} vertices"),
    };
    Ok(format!("P_low I <= P <= P_up I, and {falls} {where_}, by {boxes} boxes in t"))
}
