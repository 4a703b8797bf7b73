//! The forcing `q(t,x_0,0)` by its harmonics (docs/mathematics.md, section 11.4, P3).
//!
//! Guarantee: r_0 bounds the supremum of `q(t,x_0,0) - qb`, and r_1 that of its derivative.

use super::formula::{Axis, Formulas, Id, Leaf};
use super::machine::{At, Cell, Curves, Machine};
use super::model::Model;
use super::path::{Judged, Path, bound, bound_of_derivative, everywhere};
use super::read::Plant;
use super::time::around;
use proofs_core::interval::Interval;
use proofs_core::verdict::{Outcome, demand};

/// The name of this rule.
pub const RULE: &str = "forcing";

/// The formulas of this rule.
pub struct Rest {
    /// q - qb.
    q: Id,
    /// q_x L.
    row: Vec<Id>,
    /// D_x L, with D = q_t + q_x f along solutions.
    rate: Vec<Id>,
}

impl Rest {
    /// `D = q_t + q_x f(t,x,0)`, in the moving frame the derivative of q along it and `q_v L^-1 (f - xb')`.
    pub fn new(model: &mut Model) -> Rest {
        let (states, q) = (model.states(), model.q);
        let defect = model.defect.clone();
        let formulas: &mut Formulas = &mut model.formulas;
        // qb is kept behind the components of xb.
        let approximation = formulas.leaf(Leaf::Orbit { state: states, order: 0 });
        let row: Vec<Id> = (0..states).map(|j| formulas.derivative(q, Axis::State(j))).collect();
        let along = formulas.derivative(q, Axis::Time);
        let moved = formulas.dot(row.iter().copied().zip(defect));
        let d = formulas.add(along, moved);
        let rate = (0..states).map(|j| formulas.derivative(d, Axis::State(j))).collect();
        Rest { q: formulas.sub(q, approximation), row, rate }
    }

    /// Decides `|q - qb| + r sup|q_x L| <= r_0` and `|(q - qb)'| + r sup|D_x L| + eps sup|q_x L| <= r_1` for all t; how many cells
    /// that took.
    pub fn prove(
        &self,
        plant: &Plant,
        model: &Model,
        curves: &Curves,
        om: &Interval,
        period: &Interval,
    ) -> Outcome<usize> {
        let p = om.precision();
        let machine = Machine::new(&model.formulas, curves, om);
        let mut values = machine.values();
        let path = Path::new(&machine, curves, om, &[self.q]);
        let program = machine.program(&[&self.row[..], &self.rate].concat());
        let number = |value: &rug::Rational| Interval::rational(value, p);
        let [r, eps, rest, rest_t] =
            [&plant.orbit.radius, &plant.orbit.defect, &plant.forcing.rest, &plant.forcing.rest_t].map(number);
        let (ball, zero) = (vec![around(&r); plant.states()], Interval::int(0, p));
        let origin = vec![zero.clone(); plant.states()];
        let judge = |cell: &Cell| {
            let polynomials = path.expand(cell, &values);
            let [polynomial] = &polynomials[..] else { return Judged::Halve };
            // For each place: the two sums that have to be small.
            let mut sums = |at: At, v: &[Interval], [value, slope]: [Interval; 2]| {
                machine.run(&program, at, cell, v, &zero, &mut values);
                let norm = |row: &[Id]| {
                    row.iter().fold(zero.clone(), |sum, id| sum + machine.get(*id, at, cell, &values).sqr()).sqrt()
                };
                let (row, rate) = (norm(&self.row), norm(&self.rate));
                [value + &r * &row, slope + &r * rate + &eps * row]
            };
            let half = cell.half_width();
            let on_cell = sums(At::Box, &ball, [bound(polynomial, &half), bound_of_derivative(polynomial, &half)]);
            if on_cell[0].le(&rest) == Some(true) && on_cell[1].le(&rest_t) == Some(true) {
                return Judged::Proved;
            }
            let at = |k: usize| polynomial.coefficients.get(k).unwrap_or(&zero).abs();
            let in_middle = sums(At::Middle, &origin, [at(0), at(1)]);
            let fails = rest.lt(&in_middle[0]) == Some(true) || rest_t.lt(&in_middle[1]) == Some(true);
            if fails { Judged::Refuted } else { Judged::Halve }
        };
        everywhere(&machine.period(period), judge).or_else(|(t, refuted)| {
            let what =
                format!("q(t,x_0,0) - qb is at most `rest`, and its derivative at most `rest_t`, near t = {t:.6}");
            demand(refuted.then_some(false), RULE, &plant.forcing.pointer, what).map(|()| 0)
        })
    }
}
