//! The questions of the rates of a claim by a matrix inequality or by joint metrics, (D) of docs/mathematics.md, section 13.6: that
//! `Q - G D - D'G' - D'H D` is positive semidefinite, `D = [J, g; r, d]` the derivatives of (f, q) in (x, e), or its columns `[J; r]` or `[g; d]`, each
//! where the inequality of the claim has them, in the coordinates of the claim.

use super::form::{numbers, of_output};
use super::formula::{Axis, Id};
use super::inequality::Said;
use super::model::Model;
use super::question::Question;
use proofs_core::rules::rates::Asked;
use proofs_core::rules::rates::claimed::RULE;
use proofs_core::rules::rates::slopes::Slopes;

/// One for each part of each n_o whose Q, G and H are not those of one before.
pub fn questions(model: &mut Model, asked: Asked<'_>) -> Vec<Said> {
    let mut all: Vec<Said> = Vec::new();
    for (place, (n_o, slopes)) in asked.slopes().enumerate() {
        if asked.slopes().take(place).any(|(_, before)| before.are(slopes)) {
            continue;
        }
        let question = of_slopes(model, slopes);
        let [_, name] = slopes.columns.words();
        let what = format!("{name}, Q - G D - D'G' - D'H D >= 0 for n_o = {n_o}");
        all.push(Said::new(RULE, &slopes.pointer, what, asked.region(slopes.columns), question));
    }
    all
}

fn of_slopes(model: &mut Model, Slopes { columns, q, g, h, .. }: &Slopes) -> Question {
    let states = model.states();
    // D, its last row that of q and its last column that of e; of that the columns that are asked about.
    let column = of_output(model);
    let slope = model.formulas.derivative(model.q, Axis::Output);
    let of_f = model.jacobian.iter().zip(column).map(|(row, last)| [row.as_slice(), &[last]].concat());
    let rows = of_f.chain([[model.row.as_slice(), &[slope]].concat()]);
    let derivatives: Vec<Vec<Id>> = rows.map(|row| row[columns.places(states)].to_vec()).collect();

    let formulas = &mut model.formulas;
    let (order, count) = (states + 1, q.len());
    let [q, g, h] = [q, g, h].map(|rows| rows.iter().map(|row| numbers(formulas, row)).collect::<Vec<_>>());
    let mut image = |row: &dyn Fn(usize) -> Id, j: usize| formulas.dot((0..order).map(|k| (row(k), derivatives[k][j])));
    let of_h: Vec<Vec<Id>> =
        (0..order).map(|i| (0..count).map(|j| image(&|k| h[i.max(k)][i.min(k)], j)).collect()).collect();
    let of_g: Vec<Vec<Id>> = g.iter().map(|row| (0..count).map(|j| image(&|k| row[k], j)).collect()).collect();
    let mut rows = Vec::new();
    for (i, line) in q.into_iter().enumerate() {
        let own: Vec<Id> = line
            .into_iter()
            .enumerate()
            .map(|(j, entry)| {
                let square = formulas.dot((0..order).map(|k| (derivatives[k][i], of_h[k][j])));
                formulas.make(entry - (of_g[i][j] + of_g[j][i]) - square)
            })
            .collect();
        rows.push(own);
    }
    Question::new(formulas, rows, states)
}
