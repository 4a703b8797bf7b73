//! The questions of the matrix inequality of stability (docs/mathematics.md, section 13.7).

use super::bounds::rate;
use super::formula::{Axis, Id};
use super::model::Model;
use super::question::Question;
use proofs_core::constant::Constant;
use proofs_core::rules::inequality::Inequality;
use proofs_core::verdict::{Outcome, bad};
use rug::Rational;

/// The name of this rule.
pub const RULE: &str = "matrix inequality";

/// What a question says, X and E, and the question.
type Said<'i> = (&'static str, [&'i Rational; 2], Question);

/// In (x, y/mu, e), which divides by nothing, with the P of stability, `J_+ = J + rate I` and the threshold of sigma the rows of F are
/// `-w_x (P' + P J_+ + J_+'P), -h r', -w_x P g`; `2 h mu, -(mu + h d)`; `2 sigma`. Without a splitting the question is `F >= 0`;
/// with one, S in the place of its first rows, there are two: that F without the last row is not below S, and that S with the
/// last row is not below 0.
pub fn questions<'i>(model: &mut Model, inequality: &'i Inequality, mu: &Constant) -> Outcome<Vec<Said<'i>>> {
    let order = model.states();
    let (p, jacobian) = (model.lyapunov[0].clone(), model.jacobian.clone());
    let (f, q, row) = (model.f.clone(), model.q, model.row.clone());
    let formulas = &mut model.formulas;
    let [minus_w_x, minus_h] = [&inequality.w_x, &inequality.h].map(|value| formulas.number(&Rational::from(-value)));
    // A constant asks for nothing on the region: it has a value, or nothing is proved with it.
    let mu = formulas.read(mu.expr(), &[], &mut Vec::new());

    let mut block = rate(formulas, &inequality.rate, &p, &jacobian);
    let w_x = formulas.number(&inequality.w_x);
    for entry in block.iter_mut().flatten() {
        *entry = formulas.mul(w_x, *entry);
    }
    let mut of_y: Vec<Id> = row.iter().map(|slope| formulas.mul(minus_h, *slope)).collect();
    let twice = formulas.number(&(inequality.h.clone() * 2u32));
    of_y.push(formulas.mul(twice, mu));
    block.push(of_y);

    let column: Vec<Id> = f.iter().map(|f| formulas.derivative(*f, Axis::Output)).collect();
    let mut of_e: Vec<Id> = Vec::new();
    for line in p.iter().take(order) {
        let moved = formulas.dot(line.iter().copied().zip(column.iter().copied()));
        of_e.push(formulas.mul(minus_w_x, moved));
    }
    let slope = formulas.derivative(q, Axis::Output);
    let weighted = formulas.mul(minus_h, slope);
    of_e.push(formulas.sub(weighted, mu));
    of_e.push(formulas.number(&(inequality.sigma.clone() * 2u32)));

    let [of_states, of_error] = inequality.arguments();
    let Some(splitting) = &inequality.splitting else {
        block.push(of_e);
        return Ok(vec![("F >= 0", of_states, Question::new(formulas, block, order))]);
    };
    if splitting.matrix.len() != order + 1 {
        return bad(&format!("{}/splitting/S", inequality.pointer), "expected a row for each state, and one more");
    }
    // y = mu (y/mu).
    let units: Vec<Id> = (0..=order).map(|i| if i < order { formulas.int(1) } else { mu }).collect();
    let mut s = Vec::new();
    for (i, line) in splitting.matrix.iter().enumerate() {
        let mut entries = Vec::new();
        for (j, value) in line[..=i].iter().enumerate() {
            let value = formulas.number(value);
            let moved = formulas.mul(units[i], value);
            entries.push(formulas.mul(units[j], moved));
        }
        s.push(entries);
    }
    for (entry, least) in block.iter_mut().flatten().zip(s.iter().flatten()) {
        *entry = formulas.sub(*entry, *least);
    }
    s.push(of_e);
    Ok(vec![
        ("F without e >= S", of_states, Question::new(formulas, block, order)),
        ("S with e >= 0", of_error, Question::new(formulas, s, order)),
    ])
}
