//! The matrix F of the inequalities of section 13.7 of docs/mathematics.md in continuous time, from the derivatives of the formulas, and what it
//! has in common with that at samples.

use super::ARGUMENT_PRECISION;
use super::bounds::rate;
use super::formula::{Axis, Formulas, Id};
use super::model::Model;
use super::question::Question;
use proofs_core::constant::Constant;
use proofs_core::interval::above;
use proofs_core::matrix::Matrix;
use proofs_core::rules::inequality::{Inequality, Metric, P};
use proofs_core::spec::Specification;
use rug::{Float, Rational};

/// A question, and what it is about.
pub struct Said {
    pub rule: &'static str,
    pub pointer: String,
    pub what: String,
    /// X and E, rounded up.
    pub at: [Float; 2],
    pub question: Question,
}

impl Said {
    pub fn new(rule: &'static str, pointer: &str, what: String, at: [&Rational; 2], question: Question) -> Said {
        Said { rule, pointer: pointer.to_owned(), what, at: at.map(|end| above(end, ARGUMENT_PRECISION)), question }
    }

    /// Of an inequality.
    pub fn of(part: &Inequality, what: String, at: [&Rational; 2], question: Question) -> Said {
        Said::new(part.kind.rule(), &part.pointer, what, at, question)
    }
}

/// A constant of a file as a formula. It asks for nothing on the region: it has a value, or nothing is proved with it.
pub fn constant(formulas: &mut Formulas, constant: &Constant) -> Id {
    formulas.read(constant.expr(), &[], &mut Vec::new())
}

/// An end of b, and `(1-b) sigma` there.
pub struct End {
    pub at: &'static str,
    pub shift: Option<Id>,
}

/// b_lo and b_hi, where they are not both 1.
pub fn factors(formulas: &mut Formulas, spec: &Specification) -> Option<[Id; 2]> {
    let gain = spec.input_gain.as_ref().filter(|gain| !gain.is_nominal())?;
    let nominal = constant(formulas, &gain.nominal);
    Some(gain.ends().map(|(_, end)| {
        let end = constant(formulas, end);
        formulas.make(end / nominal)
    }))
}

/// Both ends of the input gain, in which F is affine, or that there is none.
pub fn ends(formulas: &mut Formulas, spec: &Specification, sigma: &Rational) -> Vec<End> {
    let Some(factors) = factors(formulas, spec) else { return vec![End { at: "", shift: None }] };
    let (one, sigma) = (formulas.int(1), formulas.number(sigma));
    let end = |(at, b): (_, Id)| End { at, shift: Some(formulas.make((one - b) * sigma)) };
    [", at b_lo", ", at b_hi"].into_iter().zip(factors).map(end).collect()
}

/// The matrix F of a metric less its diagonal one, in (x, y/unit, e). Its rows are `-w_x (P' + P J_+ + J_+'P) - c_x I`,
/// `-unit p - half r'`, `-w_x P g + pull - J'p`; `2 half unit - c_y`, `-(unit w + half (d + shift))`; `corner - c_e - 2 p'g`, with
/// `J_+ = J + rate I`.
pub struct Form<'i> {
    pub metric: &'i Metric,
    pub unit: Id,
    pub corner: &'i Rational,
    /// `(1-b) sigma`, which stands beside d where there is an input gain.
    pub shift: Option<Id>,
    /// sigma p, of the near metric.
    pub pull: &'i [Rational],
}

impl Form<'_> {
    /// The rows of x and y, and that of e.
    pub fn rows(&self, model: &mut Model) -> (Vec<Vec<Id>>, Vec<Id>) {
        let Metric { w, half, cross, least: [c_x, c_e, c_y], .. } = self.metric;
        let (mut block, mut of_e) = of_states(model, &self.metric.p, c_x);
        let (q, row, jacobian, column) = (model.q, model.row.clone(), model.jacobian.clone(), of_output(model));
        let formulas = &mut model.formulas;
        let minus_half = formulas.number(&Rational::from(-half));
        let [cross, pull] = [&cross[..], self.pull].map(|values| numbers(formulas, values));
        let mut of_y: Vec<Id> = row.iter().map(|slope| formulas.make(minus_half * *slope)).collect();
        for (entry, p) in of_y.iter_mut().zip(&cross) {
            *entry = formulas.make(*entry - self.unit * *p);
        }
        let [twice, c_y] = [&Rational::from(half * 2u32), c_y].map(|value| formulas.number(value));
        of_y.push(formulas.make(twice * self.unit - c_y));
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
        let [w, corner] = [w, &Rational::from(self.corner - c_e)].map(|value| formulas.number(value));
        of_e.push(formulas.make(minus_half * slope - w * self.unit));
        let pushed = formulas.dot(cross.iter().copied().zip(column.iter().copied()));
        of_e.push(formulas.make(corner - (pushed + pushed)));
        (block, of_e)
    }
}

/// The rows of x, `-w_x (P' + P J_+ + J_+'P) - c_x I` with `J_+ = J + rate I`, and what stands beside e, `-w_x P g`; of a P of its own w_x is 1 and the
/// rate 0.
pub fn of_states(model: &mut Model, p: &P, c_x: &Rational) -> (Vec<Vec<Id>>, Vec<Id>) {
    let column = of_output(model);
    let (one, zero) = (Rational::from(1), Rational::new());
    let formulas = &mut model.formulas;
    let (p, weight, value): (Vec<Vec<Id>>, _, _) = match p {
        P::Triple { w_x, rate } => (model.lyapunov[0].clone(), w_x, rate),
        P::Own(rows) => (rows.iter().map(|row| numbers(formulas, row)).collect(), &one, &zero),
    };
    let mut block = rate(formulas, value, &p, &model.jacobian);
    let minus_weight = formulas.number(&Rational::from(-weight));
    let [weight, c_x] = [weight, c_x].map(|value| formulas.number(value));
    for (i, line) in block.iter_mut().enumerate() {
        line.iter_mut().for_each(|entry| *entry = formulas.make(weight * *entry));
        line[i] = formulas.make(line[i] - c_x);
    }
    let beside = |line: &Vec<Id>| {
        let moved = formulas.dot(line.iter().copied().zip(column.iter().copied()));
        formulas.make(minus_weight * moved)
    };
    let beside = p.iter().take(column.len()).map(beside).collect();
    (block, beside)
}

/// Both matrices of a splitting by S in (x, y), of the rows of x and y and of that of e: the first without S, and S with the row of e. The rows are in
/// (x, y/unit, e).
pub fn split(
    formulas: &mut Formulas,
    (mut block, of_e): (Vec<Vec<Id>>, Vec<Id>),
    matrix: &Matrix,
    unit: Id,
) -> [Vec<Vec<Id>>; 2] {
    let last = matrix.len().saturating_sub(1);
    let units: Vec<Id> = (0..matrix.len()).map(|i| if i < last { formulas.int(1) } else { unit }).collect();
    let mut s = Vec::new();
    for (i, line) in matrix.iter().enumerate() {
        let line = numbers(formulas, &line[..=i]).into_iter().zip(&units);
        s.push(line.map(|(value, of)| formulas.make(*of * (units[i] * value))).collect::<Vec<_>>());
    }
    for (entry, least) in block.iter_mut().flatten().zip(s.iter().flatten()) {
        *entry = formulas.make(*entry - *least);
    }
    s.push(of_e);
    [block, s]
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
