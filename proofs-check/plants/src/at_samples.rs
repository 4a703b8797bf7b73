//! The questions of the matrix inequalities of a sampled regulator (docs/mathematics.md, section 13.7, at samples).
//!
//! `G = e - (1 - s sigma) e_k - s y`, so the forms in (x, e_k, y, G, w) of the section are forms in (x, e, y, w, e_k) with e = e(s): the
//! derivatives then stand beside e, y and w alone, and both forms differ in numbers only. Numbers alone stand beside e_k, so its square is
//! completed, which takes numbers from the entries of e and y: fewer boxes are needed then. w stays: without it the entries would be
//! quadratic in the derivatives.

use super::form::{numbers, of_states};
use super::formula::{Axis, Formulas, Id};
use super::inequality::{End, Said, constant, ends, factors};
use super::model::Model;
use super::question::Question;
use super::term::Term;
use proofs_core::expr::Op;
use proofs_core::rules::sampled::inequality::{Existence, Inequalities, Stability};
use proofs_core::rules::sampled::law::Terms;
use proofs_core::rules::{existence, inequality};
use proofs_core::spec::Specification;
use proofs_core::verdict::{Outcome, bad};
use rug::Rational;

/// The numbers of F_{h,s}.
struct Form<'i> {
    p: Vec<Vec<Id>>,
    weight: Rational,
    rate: Rational,
    k_p: Id,
    lambda: &'i Rational,
    /// What is taken from the squares of x, e(s), y and e_k.
    taken: [Rational; 4],
    /// gamma, where `q_0` stands beside q.
    forcing: Option<&'i Rational>,
}

/// Numbers of the law: h, sigma, and 1/(1 + theta) = 1 - K h weight_sum/2, with a gain of b_hi K.
struct Step {
    h: Id,
    sigma: Id,
    rest: Id,
}

impl Step {
    fn new(formulas: &mut Formulas, law: &Terms, spec: &Specification) -> Outcome<Step> {
        let period = constant(formulas, spec.period.demand_exact("/plant/period", "a claim at samples")?);
        let share = formulas.number(&Rational::from((1, law.samples)));
        let h = formulas.make(period * share);
        let [sigma, half] = [law.sigma.clone(), Rational::from(&law.gain * &law.weight_sum) / 2u32]
            .map(|value| formulas.number(&value));
        let one = formulas.int(1);
        let high = factors(formulas, spec).map_or(one, |[_, high]| high);
        Ok(Step { h, sigma, rest: formulas.make(one - half * h * high) })
    }
}

impl Form<'_> {
    /// The rows of F_{h,s} for s = h, or for s = 0. With a gain `-k_p (1-b) sigma e_k y` is in it, for y has `(1-b) sigma e_k` in it.
    fn rows(&self, model: &mut Model, step: &Step, gain: &End, at_end: bool) -> Vec<Vec<Id>> {
        let (mut rows, mut of_e) = of_states(model, &self.p, &self.weight, &self.rate);
        let (q, row, order, formulas) = (model.q, model.row.clone(), rows.len(), &mut model.formulas);
        let Step { h, sigma, rest } = *step;
        let [zero, one, two] = [0, 1, 2].map(|value| formulas.int(value));
        let pi = formulas.apply(&Op::Pi, [zero; 2]);
        let lambda = formulas.number(self.lambda);
        let [taken_x, taken_e, taken_y, taken_e_k] = self.taken.each_ref().map(|value| formulas.number(value));
        let s = if at_end { h } else { zero };
        let (share, kept) = (formulas.make(h * sigma), formulas.make(one - s * sigma));
        let (reach, minus_half) = (formulas.make(lambda * h / pi), formulas.make(-(self.k_p / two)));
        let [of_s, of_kept] = [s, kept].map(|factor| formulas.make(lambda * factor));
        // Beside e_k: -lambda (1 - s sigma) for e, -(1 - h sigma) + lambda s (1 - s sigma) for y, and of its own square
        // sigma (2 - h sigma) + lambda (1 - s sigma)^2.
        let pulled = gain.shift.map_or(zero, |shift| formulas.make(minus_half * shift));
        let beside = [-of_kept, of_kept * s + share - one + pulled].map(|entry| formulas.make(entry));
        let own = formulas.make(sigma * (two - share) + of_kept * kept - taken_e_k);
        let shares = beside.map(|entry| formulas.make(entry / own));
        let completed = |entry: Term, i: usize, j: usize| entry - shares[i] * beside[j];

        for (i, line) in rows.iter_mut().enumerate() {
            line[i] = formulas.make(line[i] - taken_x);
        }
        let slope = formulas.derivative(q, Axis::Output);
        of_e.push(formulas.make(completed(lambda - taken_e, 0, 0)));
        rows.push(of_e);

        let mut of_y: Vec<Id> = row.iter().map(|slope| formulas.make(minus_half * *slope)).collect();
        of_y.push(formulas.make(completed(minus_half * slope - of_s, 0, 1)));
        of_y.push(formulas.make(completed(self.k_p * rest + of_s * s - h - taken_y, 1, 1)));
        rows.push(of_y);

        let mut of_w: Vec<Id> = row.iter().map(|slope| formulas.make(reach * *slope)).collect();
        of_w.push(formulas.make(reach * slope));
        of_w.extend([zero, lambda]);
        rows.push(of_w);

        let mut of_e_k = vec![zero; order + 3];
        of_e_k.push(own);
        rows.push(of_e_k);

        if let Some(gamma) = self.forcing {
            let mut of_forcing = vec![zero; order + 1];
            let gamma = formulas.number(gamma);
            of_forcing.extend([minus_half, reach, zero, gamma]);
            rows.push(of_forcing);
        }
        rows
    }
}

/// The questions of those that there are, with a gain at both of its ends.
pub fn questions(model: &mut Model, inequalities: Inequalities<'_>, spec: &Specification) -> Outcome<Vec<Said>> {
    let Inequalities { law, stability, existence } = inequalities;
    let step = Step::new(&mut model.formulas, law, spec)?;
    let gains = ends(&mut model.formulas, spec, &law.sigma);
    let mut all = Vec::new();
    let mut ask = |model: &mut Model, form: Form<'_>, rule, pointer: &str, at, least| {
        for (gain, at_end) in gains.iter().flat_map(|gain| [(gain, false), (gain, true)]) {
            let (rows, order) = (form.rows(model, &step, gain, at_end), model.states());
            let question = Question::new(&mut model.formulas, rows, order);
            let what = format!("F_h,{} >= {least}{}", if at_end { "h" } else { "0" }, gain.at);
            all.push(Said::new(rule, pointer, what, at, question));
        }
    };
    if let Some(part) = stability {
        let form = of_stability(model, part, law);
        ask(model, form, inequality::RULE, &part.pointer, [&part.x, &part.e], "diag(2 w_x rate P, c_e, c_y, 0, 0)");
    }
    if let Some(part) = existence {
        let form = of_existence(model, part)?;
        ask(model, form, existence::RULE, &part.pointer, [&part.x, &part.e], "c_x, c_e, c_y, less gamma q_0^2");
    }
    Ok(all)
}

/// With the P of stability, and k_p = 2 eta/K.
fn of_stability<'i>(model: &mut Model, part: &'i Stability, law: &Terms) -> Form<'i> {
    let twice = model.formulas.number(&Rational::from(&part.eta * 2u32));
    let gain = model.formulas.number(&law.gain);
    Form {
        p: model.lyapunov[0].clone(),
        weight: part.w_x.clone(),
        rate: part.rate.clone(),
        k_p: model.formulas.make(twice / gain),
        lambda: &part.lambda,
        taken: [Rational::new(), Rational::new(), part.c_y.clone(), part.c_e.clone()],
        forcing: None,
    }
}

/// With a constant P of its own.
fn of_existence<'i>(model: &mut Model, part: &'i Existence) -> Outcome<Form<'i>> {
    if part.p.len() != model.states() {
        return bad(&format!("{}/P", part.pointer), "expected a row for each state");
    }
    Ok(Form {
        p: part.p.iter().map(|row| numbers(&mut model.formulas, row)).collect(),
        weight: Rational::from(1),
        rate: Rational::new(),
        k_p: model.formulas.number(&part.k_p),
        lambda: &part.lambda,
        taken: [part.c_x.clone(), part.c_e.clone(), part.c_y.clone(), Rational::new()],
        forcing: Some(&part.gamma),
    })
}
