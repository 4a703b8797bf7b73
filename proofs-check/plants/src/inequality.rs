//! The questions of the matrix inequalities of stability and of existence of a regulator in continuous time, with one metric or two
//! (docs/mathematics.md, section 13.7).

use super::ARGUMENT_PRECISION;
use super::form::{Form, numbers};
use super::formula::{Formulas, Id};
use super::model::Model;
use super::question::Question;
use proofs_core::constant::Constant;
use proofs_core::interval::above;
use proofs_core::rules::existence::{self, Existence};
use proofs_core::rules::inequality::{Inequality, RULE};
use proofs_core::rules::joint::{self, Joint};
use proofs_core::rules::metric::{Metric, Metrics};
use proofs_core::spec::Specification;
use proofs_core::verdict::{Outcome, bad};
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

/// With the P of stability, w_x, h, the threshold of sigma, and y/mu, which divides by nothing. Without a splitting the question is
/// `F >= 0`; with one, S in the place of its first rows, there are two: that F without the last row is not below S, and that S with
/// the last row is not below 0. What has the last row is asked at both ends of an input gain.
pub fn of_stability(model: &mut Model, inequality: &Inequality, spec: &Specification) -> Outcome<Vec<Said>> {
    let ends = ends(&mut model.formulas, spec, &inequality.sigma);
    let mut all: Vec<Said> = Vec::new();
    for end in ends {
        // S is asked for once: b has no part in it.
        let mut said = of_stability_at(model, inequality, spec, &end)?;
        let known = if all.is_empty() { 0 } else { said.len() - 1 };
        all.extend(said.drain(known..));
    }
    Ok(all)
}

/// Those of one end; the last one alone has the row of e.
fn of_stability_at(model: &mut Model, inequality: &Inequality, spec: &Specification, end: &End) -> Outcome<Vec<Said>> {
    let order = model.states();
    let mu = constant(&mut model.formulas, &spec.regulator.mu);
    let form = Form {
        shift: end.shift,
        p: model.lyapunov[0].clone(),
        weight: &inequality.w_x,
        rate: inequality.rate.clone(),
        half: inequality.h.clone(),
        unit: mu,
        w: &Rational::from(1),
        corner: inequality.sigma.clone() * 2u32,
        cross: &[],
        pull: &[],
    };
    let (mut block, of_e) = form.rows(model);
    let formulas = &mut model.formulas;
    let said = |what, at, question| Said::new(RULE, &inequality.pointer, format!("{what}{}", end.at), at, question);
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
            entries.push(formulas.make(units[j] * (units[i] * value)));
        }
        s.push(entries);
    }
    for (entry, least) in block.iter_mut().flatten().zip(s.iter().flatten()) {
        *entry = formulas.make(*entry - *least);
    }
    s.push(of_e);
    Ok(vec![
        said("F without e >= S", of_states, Question::new(formulas, block, order)),
        said("S with e >= 0", of_error, Question::new(formulas, s, order)),
    ])
}

/// The questions of two metrics.
pub fn of_joint(model: &mut Model, joint: &Joint) -> Outcome<[Said; 2]> {
    let asked = Asked { rule: joint::RULE, pointer: &joint.pointer, at: [&joint.x, &joint.e], sigma: &joint.threshold };
    asked.of_metrics(model, &joint.metrics)
}

/// Those of one metric of existence, at both ends of an input gain, or those of two.
pub fn of_existence(model: &mut Model, inequality: &Existence, spec: &Specification) -> Outcome<Vec<Said>> {
    let Existence { pointer, x, e, threshold, form } = inequality;
    let asked = Asked { rule: existence::RULE, pointer, at: [x, e], sigma: threshold };
    match form {
        existence::Form::Block(metric) => {
            let ends = ends(&mut model.formulas, spec, threshold);
            ends.iter().map(|end| asked.of_block(model, metric, end)).collect()
        }
        existence::Form::Joint(metrics) => asked.of_metrics(model, metrics).map(Vec::from),
    }
}

/// What a question about metrics is about: the rule and the part, X and E, and the threshold of sigma.
struct Asked<'i> {
    rule: &'static str,
    pointer: &'i str,
    at: [&'i Rational; 2],
    sigma: &'i Rational,
}

impl Asked<'_> {
    /// That the matrix of a metric with `corner` in the place of e, and these p and sigma p, is not below its diagonal one.
    fn of_metric(
        &self,
        model: &mut Model,
        metric: &Metric,
        corner: Rational,
        [cross, pull]: [&[Rational]; 2],
        (what, end): (&str, &End),
    ) -> Said {
        let order = model.states();
        let [c_x, c_e, c_y] = &metric.least;
        let form = Form {
            p: metric.p.iter().map(|row| numbers(&mut model.formulas, row)).collect(),
            weight: &Rational::from(1),
            rate: Rational::new(),
            half: Rational::from(&metric.k_p / 2u32),
            unit: model.formulas.int(1),
            w: &metric.w,
            corner: corner - c_e,
            shift: end.shift,
            cross,
            pull,
        };
        let (mut rows, of_e) = form.rows(model);
        let formulas = &mut model.formulas;
        for (i, row) in rows.iter_mut().enumerate() {
            let taken = formulas.number(if i < order { c_x } else { c_y });
            row[i] = formulas.make(row[i] - taken);
        }
        rows.push(of_e);
        let question = Question::new(formulas, rows, order);
        Said::new(self.rule, self.pointer, format!("{what}{}", end.at), self.at, question)
    }

    /// The one matrix of the block form, whose c_e is 0.
    fn of_block(&self, model: &mut Model, metric: &Metric, end: &End) -> Outcome<Said> {
        metric.demand_order(model.states(), self.pointer)?;
        let corner = Rational::from(self.sigma * &metric.w) * 2u32;
        Ok(self.of_metric(model, metric, corner, [&[], &[]], ("F >= diag(c_x, 0, c_y)", end)))
    }

    /// F of the near metric, with `2 sigma w_1` in the place of e, and G of the far one, with `2 sigma (w_1 + w_2)`: of the near one's p
    /// there is sigma p alone in it.
    fn of_metrics(&self, model: &mut Model, metrics: &Metrics) -> Outcome<[Said; 2]> {
        metrics.demand_order(model.states(), self.pointer)?;
        let Metrics { near, far, cross } = metrics;
        let pull: Vec<Rational> = cross.iter().map(|entry| Rational::from(entry * self.sigma)).collect();
        let twice = Rational::from(self.sigma * 2u32);
        let none = End { at: "", shift: None };
        let (own, both) = (Rational::from(&twice * &near.w), twice * Rational::from(&near.w + &far.w));
        Ok([
            self.of_metric(model, near, own, [cross, &pull], ("F of the near metric >= diag(c_x, c_e, c_y)", &none)),
            self.of_metric(model, far, both, [&[], &pull], ("G of the far metric >= diag(c_x, c_e, c_y)", &none)),
        ])
    }
}
