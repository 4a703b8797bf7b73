//! The question of the matrix inequality of stability (docs/mathematics.md, section 13.7).

use super::bounds::rate;
use super::formula::{Axis, Id};
use super::model::Model;
use super::question::Question;
use proofs_core::constant::Constant;
use proofs_core::rules::inequality::Inequality;

/// The name of this rule.
pub const RULE: &str = "matrix inequality";

/// `F >= 0` in (x, e, y/mu), which divides by nothing: with the P of stability, `J_+ = J + rate I` and the threshold of sigma the
/// rows are `-w_x (P' + P J_+ + J_+'P), -w_x P g, -h r'`; `2 sigma, -(mu + h d)`; `2 h mu`.
pub fn question(model: &mut Model, inequality: &Inequality, mu: &Constant) -> Question {
    let order = model.states();
    let (p, jacobian) = (model.lyapunov[0].clone(), model.jacobian.clone());
    let (f, q, row) = (model.f.clone(), model.q, model.row.clone());
    let formulas = &mut model.formulas;
    let [w_x, h] = [&inequality.w_x, &inequality.h].map(|value| formulas.number(value));
    // A constant asks for nothing on the region: it has a value, or nothing is proved with it.
    let mu = formulas.read(mu.expr(), &[], &mut Vec::new());
    let zero = formulas.int(0);
    let mut rows = rate(formulas, &inequality.rate, &p, &jacobian);
    for entry in rows.iter_mut().flatten() {
        *entry = formulas.mul(w_x, *entry);
    }
    let column: Vec<Id> = f.iter().map(|f| formulas.derivative(*f, Axis::Output)).collect();
    let mut of_e: Vec<Id> = Vec::new();
    for line in p.iter().take(order) {
        let moved = formulas.dot(line.iter().copied().zip(column.iter().copied()));
        let weighted = formulas.mul(w_x, moved);
        of_e.push(formulas.sub(zero, weighted));
    }
    of_e.push(formulas.number(&(inequality.sigma.clone() * 2u32)));
    rows.push(of_e);
    let mut of_y: Vec<Id> = Vec::new();
    for slope in &row {
        let weighted = formulas.mul(h, *slope);
        of_y.push(formulas.sub(zero, weighted));
    }
    let slope = formulas.derivative(q, Axis::Output);
    let weighted = formulas.mul(h, slope);
    let sum = formulas.add(mu, weighted);
    of_y.push(formulas.sub(zero, sum));
    let twice = formulas.number(&(inequality.h.clone() * 2u32));
    of_y.push(formulas.mul(twice, mu));
    rows.push(of_y);
    Question::new(formulas, rows, order)
}
