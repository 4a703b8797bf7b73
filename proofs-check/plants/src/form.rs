//! The matrix F of the inequalities of section 13.7 of docs/mathematics.md, from the derivatives of the formulas: of (M), of (E) and of
//! (Jm), with and without what joins x and e.

use super::bounds::rate;
use super::formula::{Axis, Formulas, Id};
use super::model::Model;
use rug::Rational;

/// The numbers of a matrix F, in (x, y/unit, e). Its rows are `-weight (P' + P J_+ + J_+'P)`, `-unit p - half r'`,
/// `-weight P g + pull - J'p`; `2 half unit`, `-(unit w + half (d + shift))`; `corner - 2 p'g`, with `J_+ = J + rate I`.
pub struct Form<'i> {
    pub p: Vec<Vec<Id>>,
    pub weight: &'i Rational,
    pub rate: Rational,
    pub half: Rational,
    pub unit: Id,
    pub w: &'i Rational,
    pub corner: Rational,
    /// `(1-b) sigma`, which stands beside d where there is an input gain.
    pub shift: Option<Id>,
    /// p, and sigma p: empty, where there is none.
    pub cross: &'i [Rational],
    pub pull: &'i [Rational],
}

impl Form<'_> {
    /// The rows of x and y, and that of e.
    pub fn rows(&self, model: &mut Model) -> (Vec<Vec<Id>>, Vec<Id>) {
        let (mut block, mut of_e) = of_states(model, &self.p, self.weight, &self.rate);
        let (q, row, jacobian, column) = (model.q, model.row.clone(), model.jacobian.clone(), of_output(model));
        let formulas = &mut model.formulas;
        let minus_half = formulas.number(&Rational::from(-&self.half));
        let [cross, pull] = [self.cross, self.pull].map(|values| numbers(formulas, values));
        let mut of_y: Vec<Id> = row.iter().map(|slope| formulas.make(minus_half * *slope)).collect();
        for (entry, p) in of_y.iter_mut().zip(&cross) {
            *entry = formulas.make(*entry - self.unit * *p);
        }
        let twice = formulas.number(&(self.half.clone() * 2u32));
        of_y.push(formulas.make(twice * self.unit));
        block.push(of_y);

        for (entry, pulled) in of_e.iter_mut().zip(pull) {
            *entry = formulas.make(*entry + pulled);
        }
        for (j, entry) in of_e.iter_mut().enumerate() {
            let turned = formulas.dot(cross.iter().copied().zip(jacobian.iter().map(|line| line[j])));
            *entry = formulas.make(*entry - turned);
        }
        let slope = formulas.derivative(q, Axis::Output);
        let slope = self.shift.map_or(slope, |shift| formulas.make(slope + shift));
        let (w, corner) = (formulas.number(self.w), formulas.number(&self.corner));
        of_e.push(formulas.make(minus_half * slope - w * self.unit));
        let pushed = formulas.dot(cross.iter().copied().zip(column.iter().copied()));
        of_e.push(formulas.make(corner - (pushed + pushed)));
        (block, of_e)
    }
}

/// The rows of x, `-weight (P' + P J_+ + J_+'P)` with `J_+ = J + value I`, and what stands beside e, `-weight P g`.
pub fn of_states(model: &mut Model, p: &[Vec<Id>], weight: &Rational, value: &Rational) -> (Vec<Vec<Id>>, Vec<Id>) {
    let column = of_output(model);
    let formulas = &mut model.formulas;
    let mut block = rate(formulas, value, p, &model.jacobian);
    let minus_weight = formulas.number(&Rational::from(-weight));
    let weight = formulas.number(weight);
    for entry in block.iter_mut().flatten() {
        *entry = formulas.make(weight * *entry);
    }
    let beside = |line: &Vec<Id>| {
        let moved = formulas.dot(line.iter().copied().zip(column.iter().copied()));
        formulas.make(minus_weight * moved)
    };
    let beside = p.iter().take(column.len()).map(beside).collect();
    (block, beside)
}

/// g = df/de.
pub fn of_output(model: &mut Model) -> Vec<Id> {
    let Model { f, formulas, .. } = model;
    f.iter().map(|f| formulas.derivative(*f, Axis::Output)).collect()
}

/// Numbers as formulas.
pub fn numbers(formulas: &mut Formulas, values: &[Rational]) -> Vec<Id> {
    values.iter().map(|value| formulas.number(value)).collect()
}
