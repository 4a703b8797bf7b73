//! The forcing `q(t,x_0,0)` by its harmonics (docs/mathematics.md, section 11.4, P3).
//!
//! Guarantee: r_0 bounds the supremum of `q(t,x_0,0) - qb`, and r_1 that of its derivative.

use super::formula::{Axis, Formulas, Id};
use super::machine::{At, Curves, Machine};
use super::model::{Model, wave};
use super::path::{Expanded, Judged, Path, Polynomial, bound, bound_of_derivative, everywhere, roots, total};
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
    /// `D = q_t + q_x f(t,x,0)`, in the moving frame the derivative of q along it and `q_x (f - xb')`, `q_x = q_v L^-1`: in the plant's
    /// own coordinates, where a product of L and its inverse does not widen what f_x is for all parameters.
    pub fn new(plant: &Plant, model: &mut Model) -> Rest {
        let (states, q) = (model.states(), model.q);
        let formulas: &mut Formulas = &mut model.formulas;
        let approximation = wave(formulas, plant, states, 0);
        let row: Vec<Id> = (0..states).map(|j| formulas.derivative(q, Axis::State(j))).collect();
        let along = formulas.derivative(q, Axis::Time);
        let mut d = formulas.in_time(along);
        for (i, apart) in model.apart.iter().enumerate() {
            let column: Vec<Id> =
                plant.known.coordinates.inverse.iter().map(|line| formulas.number(&line[i])).collect();
            let slope = formulas.dot(row.iter().copied().zip(column));
            d = formulas.make(d + slope * *apart);
        }
        let rate = (0..states).map(|j| formulas.derivative(d, Axis::State(j))).collect();
        let apart = formulas.make(q - approximation);
        Rest { q: roots(formulas, &[apart], plant.family.len()), row, rate }
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
        let [r, eps] = [&plant.orbit.radius, &plant.orbit.defect].map(number);
        let most = [&plant.forcing.rest, &plant.forcing.rest_t].map(number);
        let (ball, zero) = (vec![around(&r); plant.states()], Interval::int(0, p));
        let origin = vec![zero.clone(); plant.states()];
        let judge = |piece: &Piece| {
            let (expanded, half) = (Expanded::new(&path, piece, &values), piece.cell.all.half_width());
            let polynomial = &expanded.at_middle[0];
            let (mut sides, middles) = (piece.sides.clone(), piece.middles());
            // The polynomials are of s: the second is in t by the clock, which stands after e and the parameters.
            let clock =
                |sides: &[Interval]| plant.clock().map_or_else(|| Interval::int(1, p), |i| sides[1 + i].clone());
            let fastest = [Interval::int(1, p), clock(&sides).ceiling()];
            let bounds: [&dyn Fn(&Polynomial) -> Interval; 2] =
                [&|g| bound(g, &half), &|g| &fastest[1] * bound_of_derivative(g, &half)];
            let moves = bounds.map(|bound| expanded.moves(bound).concat());
            let sizes = bounds.map(|bound| bound(polynomial));
            // What the distance from xb adds to both.
            let mut beside = |at: At, v: &[Interval], rest: &[Interval]| {
                machine.run(&program, at, &piece.cell, v, rest, &mut values);
                let value_of = |id: &Id| machine.get(*id, at, &piece.cell, &values);
                let norm = |row: &[Id]| row.iter().fold(zero.clone(), |sum, id| sum + value_of(id).sqr()).sqrt();
                let (row, rate) = (norm(&self.row), norm(&self.rate));
                [&r * &row, &r * rate + &eps * row]
            };
            let on_box = beside(At::Box, &ball, &sides);
            let open = |i: &usize| (&sizes[*i] + total(moves[*i].iter(), p) + &on_box[*i]).le(&most[*i]) != Some(true);
            let Some(open) = (0..2).find(open) else { return Judged::Proved };
            let in_middle = [Interval::int(1, p), clock(&middles)];
            let at =
                |k: usize, clock: &[Interval; 2]| polynomial.coefficients.get(k).unwrap_or(&zero).abs() * &clock[k];
            let beside_middle = beside(At::Middle, &origin, &middles);
            if (0..2).any(|i| most[i].lt(&(at(i, &in_middle) + &beside_middle[i])) == Some(true))
                && family.has_middle(piece)
            {
                return Judged::Refuted;
            }
            // What is gained with t, or a parameter, in its middle.
            let highest = on_box[open].ceiling();
            let mut without = |at: At, sides: &[Interval]| &highest - beside(at, &ball, sides)[open].ceiling();
            let mut gains = vec![&sizes[open] - at(open, &fastest) + without(At::Middle, &sides)];
            for (i, moved) in moves[open].iter().enumerate() {
                let side = std::mem::replace(&mut sides[1 + i], middles[1 + i].clone());
                gains.push(moved + without(At::Box, &sides));
                sides[1 + i] = side;
            }
            if let Some(i) = plant.clock() {
                gains[1 + i] = &gains[1 + i] + &sizes[open] * (1 - &in_middle[open] / &fastest[open]);
            }
            Judged::Halve(gains.iter().map(|gain| gain.hi().to_f64()).collect())
        };
        everywhere(family.whole(&machine, machine.period(period)), judge).or_else(|(t, refuted)| {
            let what =
                format!("q(t,x_0,0) - qb is at most `rest`, and its derivative at most `rest_t`, near t = {t:.6}");
            demand(refuted.then_some(false), RULE, &plant.forcing.pointer, what).map(|()| 0)
        })
    }
}
