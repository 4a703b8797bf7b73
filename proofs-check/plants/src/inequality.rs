//! The questions of all matrix inequalities that a claim rests on (docs/mathematics.md, section 13.7), with those of its rates (13.6).

use super::at_samples;
use super::form::{Form, Said, constant, ends, numbers, of_output, split};
use super::formula::{Axis, Id};
use super::model::Model;
use super::question::Question;
use proofs_core::rules::derivation::Inequalities;
use proofs_core::rules::inequality::{Inequality, Kind, P};
use proofs_core::rules::rates::Asked;
use proofs_core::rules::rates::claimed::RULE;
use proofs_core::rules::rates::slopes::Slopes;
use proofs_core::spec::Specification;
use proofs_core::verdict::Outcome;
use rug::Rational;

/// The questions of all that there are, about the mu and the period of the specification.
pub fn questions(model: &mut Model, inequalities: Inequalities<'_>, spec: &Specification) -> Outcome<Vec<Said>> {
    let Inequalities { list, law, slopes } = inequalities;
    let mut all = Vec::new();
    for part in list.iter().flat_map(|list| list.all()) {
        part.demand_order(model.states())?;
        all.extend(match law {
            None => in_continuous_time(model, part, spec),
            Some(law) => at_samples::questions(model, part, law, spec)?,
        });
    }
    all.extend(slopes.into_iter().flat_map(|asked| of_rates(model, asked)));
    Ok(all)
}

/// That F of each metric, with `2 sigma` times the sum of the w up to it in the place of e, is not below its diagonal matrix: of a far one there is
/// only sigma p of the near one in it. With a splitting, S in the place of its first rows, there are two: that F without the last row is not below
/// S, and that S with the last row is not below 0. What has the last row is asked at both ends of an input gain.
fn in_continuous_time(model: &mut Model, part: &Inequality, spec: &Specification) -> Vec<Said> {
    let (order, mut all) = (model.states(), Vec::new());
    let unit = match part.metric.p {
        P::Triple { .. } => constant(&mut model.formulas, &spec.regulator.mu),
        P::Own(_) => model.formulas.int(1),
    };
    let twice = Rational::from(&part.sigma * 2u32);
    let pull: Vec<Rational> = part.metric.cross.iter().map(|entry| Rational::from(entry * &part.sigma)).collect();
    let [of_states, of_error] = part.arguments();
    for end in ends(&mut model.formulas, spec, &part.sigma) {
        let mut corner = Rational::new();
        for (metric, is_near) in part.metrics().zip([true, false]) {
            corner += Rational::from(&twice * &metric.w);
            let form = Form { metric, unit, corner: &corner, shift: end.shift, pull: &pull };
            let (mut block, of_e) = form.rows(model);
            let formulas = &mut model.formulas;
            let said = |what, at, question| Said::of(part, format!("{what}{}", end.at), at, question);
            if let Some(splitting) = &part.splitting {
                // y = mu (y/mu).
                let [block, s] = split(formulas, (block, of_e), &splitting.matrix, unit);
                // S is asked for once: b has no part in it.
                if all.is_empty() {
                    all.push(said("F without e >= S", of_states, Question::new(formulas, block, order)));
                }
                all.push(said("S with e >= 0", of_error, Question::new(formulas, s, order)));
                continue;
            }
            block.push(of_e);
            let what = match (part.kind, &part.far, is_near) {
                (Kind::Matrix, ..) => "F >= 0",
                (_, None, _) => "F >= diag(c_x, 0, c_y)",
                (_, Some(_), true) => "F of the near metric >= diag(c_x, c_e, c_y)",
                (_, Some(_), false) => "G of the far metric >= diag(c_x, c_e, c_y)",
            };
            all.push(said(what, of_states, Question::new(formulas, block, order)));
        }
    }
    all
}

/// (D) of the rates of a claim by a matrix inequality or by joint metrics (section 13.6): that `Q - G D - D'G' - D'H D` is positive semidefinite,
/// `D = [J, g; r, d]` the derivatives of (f, q) in (x, e), or its columns `[J; r]` or `[g; d]`, each where the inequality of the claim has them, in the
/// coordinates of the claim. One for each part of each n_o or set whose Q, G and H are not those of one before.
fn of_rates(model: &mut Model, asked: Asked<'_>) -> Vec<Said> {
    let mut all: Vec<Said> = Vec::new();
    for (place, (oscillators, slopes)) in asked.slopes().enumerate() {
        if asked.slopes().take(place).any(|(_, before)| before.are(slopes)) {
            continue;
        }
        let question = of_slopes(model, slopes);
        let [_, name] = slopes.columns.words();
        let what = format!("{name}, Q - G D - D'G' - D'H D >= 0 for {}", oscillators.about());
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
