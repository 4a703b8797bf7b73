//! The forcing `q(t,x_0,0)` by its harmonics (docs/mathematics.md, section 11.4, P3).
//!
//! Guarantee: r_0 bounds the supremum of `q(t,x_0,0) - qb`, and r_1 that of its derivative.

use super::formula::{Axis, Formulas, Id};
use super::machine::{At, Curves, Machine};
use super::members::{Expanded, roots, total};
use super::model::{Model, wave};
use super::path::{Judged, Path, Polynomial, bound, bound_of_derivative, everywhere};
use super::read::Plant;
use super::region::{Piece, Region};
use super::time::around;
use proofs_core::interval::Interval;
use proofs_core::verdict::{Outcome, demand};

/// The name of this rule.
pub const RULE: &str = "forcing";

/// The formulas of this rule.
pub struct Rest {
    /// q - qb, and its derivatives in the parameters.
    q: Vec<Vec<Id>>,
    /// q_x L.
    row: Vec<Id>,
    /// D_x L, with D = q_t + q_x f along solutions.
    rate: Vec<Id>,
}

impl Rest {
    /// `D = q_t + q_x f(t,x,0)`, in the moving frame the derivative of q along it and `q_v L^-1 (f - xb')`.
    pub fn new(plant: &Plant, model: &mut Model) -> Rest {
        let (states, q) = (model.states(), model.q);
        let defect = model.defect.clone();
        let formulas: &mut Formulas = &mut model.formulas;
        let approximation = wave(formulas, plant, states, 0);
        let row: Vec<Id> = (0..states).map(|j| formulas.derivative(q, Axis::State(j))).collect();
        let along = formulas.derivative(q, Axis::Time);
        let moved = formulas.dot(row.iter().copied().zip(defect));
        let d = formulas.add(along, moved);
        let rate = (0..states).map(|j| formulas.derivative(d, Axis::State(j))).collect();
        let apart = formulas.sub(q, approximation);
        Rest { q: roots(formulas, &[apart], plant.known.parameters.len()), row, rate }
    }

    /// Decides `|q - qb| + r sup|q_x L| <= r_0` and `|(q - qb)'| + r sup|D_x L| + eps sup|q_x L| <= r_1` for all t and all parameters;
    /// how many boxes that took.
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
        let path = Path::new(&machine, curves, om, &self.q);
        let family = Region::of_family(plant, p);
        let program = machine.program(&[&self.row[..], &self.rate].concat());
        let number = |value: &rug::Rational| Interval::rational(value, p);
        let [r, eps, rest, rest_t] =
            [&plant.orbit.radius, &plant.orbit.defect, &plant.forcing.rest, &plant.forcing.rest_t].map(number);
        let (ball, zero) = (vec![around(&r); plant.states()], Interval::int(0, p));
        let origin = vec![zero.clone(); plant.states()];
        let judge = |piece: &Piece| {
            let (expanded, half) = (Expanded::new(&path, piece, &values), piece.cell.half_width());
            let polynomial = &expanded.at_middle[0];
            // For each place: the two sums that have to be small.
            let mut sums = |at: At, v: &[Interval], rest: &[Interval], [value, slope]: [Interval; 2]| {
                machine.run(&program, at, &piece.cell, v, rest, &mut values);
                let value_of = |id: &Id| machine.get(*id, at, &piece.cell, &values);
                let norm = |row: &[Id]| row.iter().fold(zero.clone(), |sum, id| sum + value_of(id).sqr()).sqrt();
                let (row, rate) = (norm(&self.row), norm(&self.rate));
                [value + &r * &row, slope + &r * rate + &eps * row]
            };
            let bounds: [&dyn Fn(&Polynomial) -> Interval; 2] =
                [&|g| bound(g, &half), &|g| bound_of_derivative(g, &half)];
            let at_middle = bounds.map(|bound| bound(polynomial));
            let moves = bounds.map(|bound| expanded.moves(bound).concat());
            let [on_box, of_slope] = [0, 1].map(|i| &at_middle[i] + total(moves[i].iter(), p));
            let on_box = sums(At::Box, &ball, &piece.intervals(), [on_box, of_slope]);
            if on_box[0].le(&rest) == Some(true) && on_box[1].le(&rest_t) == Some(true) {
                return Judged::Proved;
            }
            let at = |k: usize| polynomial.coefficients.get(k).unwrap_or(&zero).abs();
            let in_middle = sums(At::Middle, &origin, &piece.middles(), [at(0), at(1)]);
            let fails = rest.lt(&in_middle[0]) == Some(true) || rest_t.lt(&in_middle[1]) == Some(true);
            if fails && family.has_middle(piece) {
                return Judged::Refuted;
            }
            let which = usize::from(on_box[0].le(&rest) == Some(true));
            let in_t = &on_box[which] - &in_middle[which] - total(moves[which].iter(), p);
            Judged::Halve([in_t].iter().chain(&moves[which]).map(|share| share.hi().to_f64()).collect())
        };
        everywhere(family.whole(&machine, machine.period(period)), judge).or_else(|(t, refuted)| {
            let what =
                format!("q(t,x_0,0) - qb is at most `rest`, and its derivative at most `rest_t`, near t = {t:.6}");
            demand(refuted.then_some(false), RULE, &plant.forcing.pointer, what).map(|()| 0)
        })
    }
}
