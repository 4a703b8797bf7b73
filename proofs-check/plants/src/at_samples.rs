//! The questions of the matrix inequalities of a sampled regulator (docs/mathematics.md, section 13.7, at samples).
//!
//! `G = e - (1 - s sigma) e_k - s y`, so the forms in (x, e_k, y, G, w) of the section are forms in (x, e, y, w, e_k) with e = e(s): the
//! derivatives then stand beside e, y and w alone, and both forms differ in numbers only. Numbers alone stand beside e_k, so its square is
//! completed, which takes numbers from the entries of e and y: fewer boxes are needed then. w stays: without it the entries would be
//! quadratic in the derivatives.

use super::form::{End, Said, constant, ends, factors, of_states};
use super::formula::{Axis, Formulas, Id};
use super::model::Model;
use super::question::Question;
use super::term::Term;
use proofs_core::expr::Op;
use proofs_core::rules::inequality::{Inequality, Kind, Metric, P};
use proofs_core::rules::sampled::law::Terms;
use proofs_core::spec::Specification;
use proofs_core::verdict::Outcome;
use rug::Rational;

/// Numbers of the law: h, sigma, and 1/(1 + theta) = 1 - K h weight_sum/2, with a gain of b_hi K.
struct Step {
    h: Id,
    sigma: Id,
    rest: Id,
    /// `k_p`: with the P of the triple `2 eta/K`.
    k_p: Id,
}

impl Step {
    fn new(formulas: &mut Formulas, metric: &Metric, law: &Terms, spec: &Specification) -> Outcome<Step> {
        let period = constant(formulas, spec.period.demand_exact("/plant/period", "a claim at samples")?);
        let share = formulas.number(&Rational::from((1, law.samples)));
        let h = formulas.make(period * share);
        let [sigma, half] = [law.sigma.clone(), Rational::from(&law.gain * &law.weight_sum) / 2u32]
            .map(|value| formulas.number(&value));
        let one = formulas.int(1);
        let high = factors(formulas, spec).map_or(one, |[_, high]| high);
        let rest = formulas.make(one - half * h * high);
        let twice = formulas.number(&Rational::from(&metric.half * 2u32));
        let unit = if matches!(metric.p, P::Own(_)) { one } else { formulas.number(&law.gain) };
        Ok(Step { h, sigma, rest, k_p: formulas.make(twice / unit) })
    }

    /// The rows of F_{h,s} of a metric for s = h, or for s = 0, less what is taken from the squares of x, y, and of e(s) (existence) or e_k. With a gain
    /// `-k_p (1-b) sigma e_k y` is in it, for y has `(1-b) sigma e_k` in it.
    fn rows(&self, model: &mut Model, part: &Inequality, gain: &End, at_end: bool) -> Vec<Vec<Id>> {
        let Metric { least: [c_x, c_e, c_y], lambda, gamma, .. } = &part.metric;
        let (mut rows, mut of_e) = of_states(model, &part.metric.p, c_x);
        let (q, row, order, formulas) = (model.q, model.row.clone(), rows.len(), &mut model.formulas);
        let Step { h, sigma, rest, k_p } = *self;
        let [zero, one, two] = [0, 1, 2].map(|value| formulas.int(value));
        let pi = formulas.apply(&Op::Pi, [zero; 2]);
        let [lambda, taken, c_y] = [lambda, c_e, c_y].map(|value| formulas.number(value));
        let (c_e, c_e_k) = if part.kind == Kind::Existence { (taken, zero) } else { (zero, taken) };
        let s = if at_end { h } else { zero };
        let (share, kept) = (formulas.make(h * sigma), formulas.make(one - s * sigma));
        let (reach, minus_half) = (formulas.make(lambda * h / pi), formulas.make(-(k_p / two)));
        let [of_s, of_kept] = [s, kept].map(|factor| formulas.make(lambda * factor));
        // Beside e_k: -lambda (1 - s sigma) for e, -(1 - h sigma) + lambda s (1 - s sigma) for y, and of its own square
        // sigma (2 - h sigma) + lambda (1 - s sigma)^2.
        let pulled = gain.shift.map_or(zero, |shift| formulas.make(minus_half * shift));
        let beside = [-of_kept, of_kept * s + share - one + pulled].map(|entry| formulas.make(entry));
        let own = formulas.make(sigma * (two - share) + of_kept * kept - c_e_k);
        let shares = beside.map(|entry| formulas.make(entry / own));
        let completed = |entry: Term, i: usize, j: usize| entry - shares[i] * beside[j];

        let slope = formulas.derivative(q, Axis::Output);
        of_e.push(formulas.make(completed(lambda - c_e, 0, 0)));
        rows.push(of_e);

        let mut of_y: Vec<Id> = row.iter().map(|slope| formulas.make(minus_half * *slope)).collect();
        of_y.push(formulas.make(completed(minus_half * slope - of_s, 0, 1)));
        of_y.push(formulas.make(completed(k_p * rest + of_s * s - h - c_y, 1, 1)));
        rows.push(of_y);

        let mut of_w: Vec<Id> = row.iter().map(|slope| formulas.make(reach * *slope)).collect();
        of_w.push(formulas.make(reach * slope));
        of_w.extend([zero, lambda]);
        rows.push(of_w);

        let mut of_e_k = vec![zero; order + 3];
        of_e_k.push(own);
        rows.push(of_e_k);

        if let Some(gamma) = gamma {
            let mut of_forcing = vec![zero; order + 1];
            let gamma = formulas.number(gamma);
            of_forcing.extend([minus_half, reach, zero, gamma]);
            rows.push(of_forcing);
        }
        rows
    }
}

/// The questions of one, with a gain at both of its ends.
pub fn questions(model: &mut Model, part: &Inequality, law: &Terms, spec: &Specification) -> Outcome<Vec<Said>> {
    let step = Step::new(&mut model.formulas, &part.metric, law, spec)?;
    let gains = ends(&mut model.formulas, spec, &law.sigma);
    let least = match part.kind {
        Kind::Existence => "c_x, c_e, c_y, less gamma q_0^2",
        Kind::Matrix | Kind::Joint => "diag(2 w_x rate P, c_e, c_y, 0, 0)",
    };
    let all = gains.iter().flat_map(|gain| [(gain, false), (gain, true)]).map(|(gain, at_end)| {
        let (rows, order) = (step.rows(model, part, gain, at_end), model.states());
        let what = format!("F_h,{} >= {least}{}", if at_end { "h" } else { "0" }, gain.at);
        Said::of(part, what, part.at.each_ref(), Question::new(&mut model.formulas, rows, order))
    });
    Ok(all.collect())
}
