//! The questions that decide the entries of `bounds` (docs/mathematics.md, section 11.3, P2), and the same bounds around a trial (section 14.4).

use super::formula::{Axis, Formulas, Id, Leaf};
use super::model::Model;
use super::question::Question;
use proofs_core::plant::entries::Name;
use rug::Rational;

/// `value^2 - |row|^2 >= 0`.
pub fn norm(formulas: &mut Formulas, value: &Rational, row: &[Id]) -> Vec<Vec<Id>> {
    let square = formulas.number(&Rational::from(value.square_ref()));
    let sum = formulas.dot(row.iter().map(|id| (*id, *id)));
    vec![vec![formulas.make(square - sum)]]
}

/// `value^2 I - J'J >= 0`.
fn spectral_norm(formulas: &mut Formulas, value: &Rational, rows: &[Vec<Id>]) -> Vec<Vec<Id>> {
    let square = formulas.number(&Rational::from(value.square_ref()));
    let zero = formulas.int(0);
    let order = rows.len();
    let entry = |i: usize, j: usize, formulas: &mut Formulas| {
        let product = formulas.dot((0..order).map(|k| (rows[k][i], rows[k][j])));
        let own = if i == j { square } else { zero };
        formulas.make(own - product)
    };
    (0..order).map(|i| (0..=i).map(|j| entry(i, j, formulas)).collect()).collect()
}

/// `-(P' + P J + J'P) - 2 value P >= 0`.
pub fn rate(formulas: &mut Formulas, value: &Rational, p: &[Vec<Id>], jacobian: &[Vec<Id>]) -> Vec<Vec<Id>> {
    let twice = formulas.number(&Rational::from(value * 2u32));
    let order = p.len();
    let entry = |i: usize, j: usize, formulas: &mut Formulas| {
        let slope = formulas.derivative(p[i][j], Axis::Time);
        let slope = formulas.in_time(slope);
        let both = formulas.dot((0..order).flat_map(|k| [(p[i][k], jacobian[k][j]), (jacobian[k][i], p[k][j])]));
        formulas.make(-(slope + both + twice * p[i][j]))
    };
    (0..order).map(|i| (0..=i).map(|j| entry(i, j, formulas)).collect()).collect()
}

/// The question that decides whether this value bounds it. Those of states are of a plant that has some.
pub fn question(model: &mut Model, name: Name, value: &Rational) -> Question {
    let (states, q) = (model.states(), model.q);
    let (formulas, row) = (&mut model.formulas, &model.row);
    let rows = match name {
        Name::Fx => spectral_norm(formulas, value, &model.jacobian),
        Name::Fe => {
            let column: Vec<Id> = model.f.iter().map(|f| formulas.derivative(*f, Axis::Output)).collect();
            norm(formulas, value, &column)
        }
        Name::Qx => norm(formulas, value, row),
        Name::Qe => {
            let slope = formulas.derivative(q, Axis::Output);
            norm(formulas, value, &[slope])
        }
        Name::QeMax => {
            let (most, slope) = (formulas.number(value), formulas.derivative(q, Axis::Output));
            vec![vec![formulas.make(most - slope)]]
        }
        // The derivative of q at a fixed y: q_t + q_x x_0', where the frame moves with xb, and x_0' = xb' + L drift.
        Name::Qtx | Name::Qte => {
            let along = formulas.derivative(q, Axis::Time);
            let along = formulas.in_time(along);
            let drift: Vec<Id> = (0..states).map(|j| formulas.leaf(Leaf::Drift(j))).collect();
            let moved = formulas.dot(row.iter().copied().zip(drift));
            let rate = formulas.make(along + moved);
            let slopes: Vec<Id> = match name {
                Name::Qte => vec![formulas.derivative(rate, Axis::Output)],
                _ => (0..states).map(|j| formulas.derivative(rate, Axis::State(j))).collect(),
            };
            norm(formulas, value, &slopes)
        }
        Name::Rate => rate(formulas, value, &model.lyapunov[0], &model.jacobian),
        Name::RateExistence => {
            let last = model.lyapunov.len() - 1;
            rate(formulas, value, &model.lyapunov[last], &model.jacobian)
        }
    };
    Question::new(formulas, rows, states)
}
