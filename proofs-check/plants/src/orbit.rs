//! The periodic solution x_0 of `x' = f(t,x,0)` near xb (docs/mathematics.md, section 11.2, P1).
//!
//! Guarantee: exactly one T-periodic solution has `|L^-1 (x_0 - xb)| <= rho` for all t, and it has at most r there; each P is
//! between its p_low and p_up, and has its rate alpha in the tube.

use super::formula::{Formulas, Id};
use super::machine::Curves;
use super::model::Model;
use super::path::{Judged, Path, bound_of_norm, everywhere};
use super::question::Question;
use super::read::{Orbit, Plant};
use proofs_core::interval::Interval;
use proofs_core::jacobian::Witness;
use proofs_core::plant::coordinates::semidefinite;
use proofs_core::verdict::{Outcome, demand};
use rug::Rational;

/// The name of this rule.
pub const RULE: &str = "orbit";

/// `(c/alpha) eps <= r < rho` with `c^2 = p_up/p_low`, exactly.
pub fn radii(orbit: &Orbit, stability: &Witness) -> Outcome<()> {
    let [p_low, p_up, alpha] = &stability.numbers;
    let square = |value: &Rational| Rational::from(value.square_ref());
    let (needed, given) = (square(&orbit.defect) * p_up, square(&Rational::from(&orbit.radius * alpha)) * p_low);
    let pointer = |name: &str| format!("{}/{name}", orbit.pointer);
    demand(Some(needed <= given), RULE, &pointer("radius"), "(c/alpha) defect <= radius")?;
    demand(Some(orbit.radius < orbit.tube), RULE, &pointer("tube"), "radius < tube")
}

/// `P - p_low I` and `p_up I - P` as questions; nothing where P is constant and that is decided exactly.
pub fn sizes(plant: &Plant, model: &mut Model) -> Outcome<Vec<(usize, &'static str, Question)>> {
    let states = model.states();
    let mut questions = Vec::new();
    for (which, w) in plant.lyapunov.iter().enumerate() {
        let [p_low, p_up, _] = &w.numbers;
        let constant = w.harmonics.iter().flatten().flatten().flatten().all(Rational::is_zero);
        for (sign, end, what) in [(1, p_low, "p_low I <= P"), (-1, p_up, "P <= p_up I")] {
            if constant {
                let shifted = |i: usize, j: usize, value: &Rational| {
                    let moved = if i == j { Rational::from(value - end) } else { value.clone() };
                    moved * sign
                };
                let row = |(i, row): (usize, &Vec<Rational>)| {
                    row.iter().enumerate().map(|(j, value)| shifted(i, j, value)).collect()
                };
                let rows = w.mean.iter().enumerate().map(row).collect();
                demand(Some(semidefinite(rows)), RULE, &w.pointer, what)?;
                continue;
            }
            let p = model.lyapunov[which].clone();
            let rows = shifted(&mut model.formulas, &p, end, sign);
            questions.push((which, what, Question::new(&mut model.formulas, rows, states)));
        }
    }
    Ok(questions)
}

/// `sign (P - end I)`, its lower triangle.
pub fn shifted(formulas: &mut Formulas, p: &[Vec<Id>], end: &Rational, sign: i32) -> Vec<Vec<Id>> {
    let (end, zero) = (formulas.number(end), formulas.int(0));
    let entry = |i: usize, j: usize, formulas: &mut Formulas| {
        let taken = if i == j { end } else { zero };
        if sign > 0 { formulas.sub(p[i][j], taken) } else { formulas.sub(taken, p[i][j]) }
    };
    (0..p.len()).map(|i| (0..=i).map(|j| entry(i, j, formulas)).collect()).collect()
}

/// `|L^-1 (f(t,xb,0) - xb')| <= eps` for all t; how many cells that took.
pub fn defect(plant: &Plant, model: &Model, curves: &Curves, om: &Interval, period: &Interval) -> Outcome<usize> {
    let p = om.precision();
    let machine = super::machine::Machine::new(&model.formulas, curves, om);
    let values = machine.values();
    let path = Path::new(&machine, curves, om, &model.defect);
    let most = Interval::rational(&plant.orbit.defect, p);
    let judge = |cell: &super::machine::Cell| {
        let polynomials = path.expand(cell, &values);
        if bound_of_norm(&polynomials, &cell.half_width()).le(&most) == Some(true) {
            return Judged::Proved;
        }
        let zero = Interval::int(0, p);
        let at_middle = polynomials.iter().fold(zero, |sum, part| sum + part.coefficients[0].sqr()).sqrt();
        if most.lt(&at_middle) == Some(true) { Judged::Refuted } else { Judged::Halve }
    };
    everywhere(&machine.period(period), judge).or_else(|(t, refuted)| {
        let pointer = format!("{}/defect", plant.orbit.pointer);
        let what = format!("|L^-1 (f(t,xb,0) - xb')| <= defect near t = {t:.6}");
        demand(refuted.then_some(false), RULE, &pointer, what).map(|()| 0)
    })
}
