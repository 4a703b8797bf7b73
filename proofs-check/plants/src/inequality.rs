//! The questions of the matrix inequalities of stability and of existence of a regulator in continuous time (docs/mathematics.md,
//! section 13.7).

use super::bounds::rate;
use super::formula::{Axis, Id};
use super::model::Model;
use super::question::Question;
use proofs_core::constant::Constant;
use proofs_core::rules::existence::Existence;
use proofs_core::rules::inequality::Inequality;
use proofs_core::verdict::{Outcome, bad};
use rug::Rational;

/// The name of the rule of stability.
pub const RULE: &str = "matrix inequality";
/// The name of the rule of existence.
pub const EXISTENCE_RULE: &str = "existence inequality";

/// A question, and what it is about.
pub struct Said<'i> {
    pub rule: &'static str,
    pub pointer: &'i str,
    pub what: &'static str,
    /// X and E.
    pub at: [&'i Rational; 2],
    pub question: Question,
}

/// The numbers of a matrix F, in (x, y/unit, e). Its rows are `-weight (P' + P J_+ + J_+'P), -half r', -weight P g`;
/// `2 half unit, -(unit + half d)`; `2 sigma`, with `J_+ = J + rate I`.
struct Form<'i> {
    p: Vec<Vec<Id>>,
    weight: &'i Rational,
    rate: Rational,
    half: Rational,
    unit: Id,
    sigma: &'i Rational,
}

/// The rows of x, `-weight (P' + P J_+ + J_+'P)` with `J_+ = J + value I`, and what stands beside e, `-weight P g`.
pub fn of_states(model: &mut Model, p: &[Vec<Id>], weight: &Rational, value: &Rational) -> (Vec<Vec<Id>>, Vec<Id>) {
    let formulas = &mut model.formulas;
    let mut block = rate(formulas, value, p, &model.jacobian);
    let minus_weight = formulas.number(&Rational::from(-weight));
    let weight = formulas.number(weight);
    for entry in block.iter_mut().flatten() {
        *entry = formulas.mul(weight, *entry);
    }
    let column: Vec<Id> = model.f.iter().map(|f| formulas.derivative(*f, Axis::Output)).collect();
    let beside = |line: &Vec<Id>| {
        let moved = formulas.dot(line.iter().copied().zip(column.iter().copied()));
        formulas.mul(minus_weight, moved)
    };
    let beside = p.iter().map(beside).collect();
    (block, beside)
}

impl Form<'_> {
    /// The rows of x and y, and that of e.
    fn rows(&self, model: &mut Model) -> (Vec<Vec<Id>>, Vec<Id>) {
        let (mut block, mut of_e) = of_states(model, &self.p, self.weight, &self.rate);
        let (q, row, formulas) = (model.q, model.row.clone(), &mut model.formulas);
        let minus_half = formulas.number(&Rational::from(-&self.half));
        let mut of_y: Vec<Id> = row.iter().map(|slope| formulas.mul(minus_half, *slope)).collect();
        let twice = formulas.number(&(self.half.clone() * 2u32));
        of_y.push(formulas.mul(twice, self.unit));
        block.push(of_y);

        let slope = formulas.derivative(q, Axis::Output);
        let weighted = formulas.mul(minus_half, slope);
        of_e.push(formulas.sub(weighted, self.unit));
        of_e.push(formulas.number(&(self.sigma.clone() * 2u32)));
        (block, of_e)
    }
}

/// With the P of stability, w_x, h, the threshold of sigma, and y/mu, which divides by nothing. Without a splitting the question is
/// `F >= 0`; with one, S in the place of its first rows, there are two: that F without the last row is not below S, and that S with
/// the last row is not below 0.
pub fn of_stability<'i>(model: &mut Model, inequality: &'i Inequality, mu: &Constant) -> Outcome<Vec<Said<'i>>> {
    let order = model.states();
    // A constant asks for nothing on the region: it has a value, or nothing is proved with it.
    let mu = model.formulas.read(mu.expr(), &[], &mut Vec::new());
    let form = Form {
        p: model.lyapunov[0].clone(),
        weight: &inequality.w_x,
        rate: inequality.rate.clone(),
        half: inequality.h.clone(),
        unit: mu,
        sigma: &inequality.sigma,
    };
    let (mut block, of_e) = form.rows(model);
    let formulas = &mut model.formulas;
    let said = |what, at, question| Said { rule: RULE, pointer: &inequality.pointer, what, at, question };
    let [of_states, of_error] = inequality.arguments();
    let Some(splitting) = &inequality.splitting else {
        block.push(of_e);
        return Ok(vec![said("F >= 0", of_states, Question::new(formulas, block, order))]);
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
        said("F without e >= S", of_states, Question::new(formulas, block, order)),
        said("S with e >= 0", of_error, Question::new(formulas, s, order)),
    ])
}

/// With a constant P of its own, `half = k_p/2` and y itself: `F >= diag(c_x I, 0, c_y)` with the threshold of sigma.
pub fn of_existence<'i>(model: &mut Model, inequality: &'i Existence) -> Outcome<Said<'i>> {
    let order = model.states();
    if inequality.p.len() != order {
        return bad(&format!("{}/P", inequality.pointer), "expected a row for each state");
    }
    let formulas = &mut model.formulas;
    let of_row = |row: &Vec<Rational>| row.iter().map(|value| formulas.number(value)).collect();
    let form = Form {
        p: inequality.p.iter().map(of_row).collect(),
        weight: &Rational::from(1),
        rate: Rational::new(),
        half: Rational::from(&inequality.k_p / 2u32),
        unit: model.formulas.int(1),
        sigma: &inequality.threshold,
    };
    let (mut rows, of_e) = form.rows(model);
    let formulas = &mut model.formulas;
    for (i, row) in rows.iter_mut().enumerate() {
        let taken = formulas.number(if i < order { &inequality.c_x } else { &inequality.c_y });
        row[i] = formulas.sub(row[i], taken);
    }
    rows.push(of_e);
    let at = [&inequality.x, &inequality.e];
    let (rule, pointer) = (EXISTENCE_RULE, inequality.pointer.as_str());
    Ok(Said { rule, pointer, what: "F >= diag(c_x, 0, c_y)", at, question: Question::new(formulas, rows, order) })
}
