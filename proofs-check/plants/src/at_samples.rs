//! The questions of the matrix inequalities of a sampled regulator (docs/mathematics.md, section 13.7, at samples), and of the forms that fall of a
//! plant that is linear in x and e (section 14.6).
//!
//! `G = e - (1 - s sigma) e_k - s y`, so the forms in (x, e_k, y, G, w) of the section are forms in (x, e, y, w, e_k) with e = e(s): the
//! derivatives then stand beside e, y and w alone, and both forms differ in numbers only. Numbers alone stand beside e_k, so its square is
//! completed, which takes numbers from the entries of e and y: fewer boxes are needed then. w stays: without it the entries would be
//! quadratic in the derivatives.
//!
//! With a delay y has `h sigma p` beside it, p the last y, in all that comes from the way of e: `G = e - (1 - s sigma) e_k - s (y + h sigma p)`.

use super::form::{End, Said, constant, ends, factors, of_states};
use super::formula::{Axis, Formulas, Id};
use super::model::Model;
use super::question::Question;
use super::term::Term;
use proofs_core::expr::Op;
use proofs_core::rules::by_n_o::linear;
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

/// What is taken from the diagonal of a form, besides c_x and c_y.
struct Taken {
    /// From the squares of e(s) and of e_k.
    of_e: [Rational; 2],
    /// This share of those of e(s), of w and of p.
    share: Rational,
    /// What h/pi is multiplied by: 1, or 3/2 where the control moves within a sample, for `(a + b)^2 <= 9/4 a^2 + 9/5 b^2`.
    stretch: Rational,
}

/// What a form has in p with a delay.
struct Past {
    g_m: Rational,
    /// Whether `2 theta/(1 + theta) k_p y p` counts as it is: else with the other sign.
    as_it_is: bool,
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

    /// The rows of F_{h,s} of a metric for s = h, or for s = 0, less what is taken from its diagonal. With a gain `-k_p (1-b) sigma e_k y` is in it, for y
    /// has `(1-b) sigma e_k` in it, with a delay `(1-b) sigma (e_k - h p)`.
    fn rows(
        &self,
        model: &mut Model,
        (metric, taken): (&Metric, &Taken),
        (gain, past): (&End, Option<&Past>),
        at_end: bool,
    ) -> Vec<Vec<Id>> {
        let Metric { least: [c_x, _, c_y], lambda, gamma, w, .. } = metric;
        let (mut rows, mut of_e) = of_states(model, &metric.p, c_x);
        let (q, row, order, formulas) = (model.q, model.row.clone(), rows.len(), &mut model.formulas);
        let Step { h, sigma, rest, k_p } = *self;
        let [zero, one, two] = [0, 1, 2].map(|value| formulas.int(value));
        let pi = formulas.apply(&Op::Pi, [zero; 2]);
        let left = Rational::from(1 - &taken.share);
        let [lambda, weight, c_e, c_e_k, c_y, left] =
            [lambda, w, &taken.of_e[0], &taken.of_e[1], c_y, &left].map(|value| formulas.number(value));
        let s = if at_end { h } else { zero };
        let (share, kept) = (formulas.make(h * sigma), formulas.make(one - s * sigma));
        let stretch = formulas.number(&taken.stretch);
        let (reach, minus_half) = (formulas.make(lambda * stretch * h / pi), formulas.make(-(k_p / two)));
        let [of_s, of_kept] = [s, kept].map(|factor| formulas.make(lambda * factor));
        // Beside e_k: -lambda (1 - s sigma) for e, -w (1 - h sigma) + lambda s (1 - s sigma) for y, and of its own square
        // w sigma (2 - h sigma) + lambda (1 - s sigma)^2. For p h sigma times what y has, but for the gain.
        let pulled = gain.shift.map_or(zero, |shift| formulas.make(minus_half * shift));
        let of_way = formulas.make(of_kept * s + weight * (share - one));
        let beside = [-of_kept, of_way + pulled, of_way * share].map(|entry| formulas.make(entry));
        let own = formulas.make(weight * (sigma * (two - share)) + of_kept * kept - c_e_k);
        let shares = beside.map(|entry| formulas.make(entry / own));
        let completed = |entry: Term, i: usize, j: usize| entry - shares[i] * beside[j];

        let slope = formulas.derivative(q, Axis::Output);
        of_e.push(formulas.make(completed(lambda * left - c_e, 0, 0)));
        rows.push(of_e);

        let mut of_y: Vec<Id> = row.iter().map(|slope| formulas.make(minus_half * *slope)).collect();
        of_y.push(formulas.make(completed(minus_half * slope - of_s, 0, 1)));
        let of_square = formulas.make(of_s * s - weight * h);
        let past = past.map(|Past { g_m, as_it_is }| (formulas.number(g_m), *as_it_is));
        let stored = past.map_or(zero, |(g_m, _)| g_m);
        of_y.push(formulas.make(completed(k_p * rest + of_square - c_y - stored, 1, 1)));
        rows.push(of_y);

        let mut of_w: Vec<Id> = row.iter().map(|slope| formulas.make(reach * *slope)).collect();
        of_w.push(formulas.make(reach * slope));
        of_w.extend([zero, formulas.make(lambda * left)]);
        rows.push(of_w);

        if let Some((g_m, as_it_is)) = past {
            let turned = if as_it_is { k_p * (one - rest) } else { k_p * (rest - one) };
            let mut of_p = vec![zero; order];
            of_p.push(formulas.make(completed(-(of_s * share), 0, 2)));
            of_p.push(formulas.make(completed(of_square * share - pulled * h + turned, 1, 2)));
            of_p.extend([zero, formulas.make(completed(g_m * left + of_square * share * share, 2, 2))]);
            rows.push(of_p);
        }

        let mut of_e_k = vec![zero; rows.len()];
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
    let (least, of_e) = match part.kind {
        Kind::Existence => ("c_x, c_e, c_y, less gamma q_0^2", [part.metric.least[1].clone(), Rational::new()]),
        Kind::Matrix | Kind::Joint => {
            ("diag(2 w_x rate P, c_e, c_y, 0, 0)", [Rational::new(), part.metric.least[1].clone()])
        }
    };
    let taken = Taken { of_e, share: Rational::new(), stretch: Rational::from(1) };
    let all = gains.iter().flat_map(|gain| [(gain, false), (gain, true)]).map(|(gain, at_end)| {
        let (rows, order) = (step.rows(model, (&part.metric, &taken), (gain, None), at_end), model.states());
        let what = format!("F_h,{} >= {least}{}", if at_end { "h" } else { "0" }, gain.at);
        Said::of(part, what, part.at.each_ref(), Question::new(&mut model.formulas, rows, order))
    });
    Ok(all.collect())
}

/// The questions of a form around a trial (14.6b), with what they are about: for s = 0 and s = h, at both ends of b.
pub fn near_trial(
    model: &mut Model,
    metric: &Metric,
    law: &Terms,
    spec: &Specification,
) -> Outcome<Vec<(String, Question)>> {
    let step = Step::new(&mut model.formulas, metric, law, spec)?;
    let gains = ends(&mut model.formulas, spec, &law.sigma);
    let of_e = [metric.least[1].clone(), Rational::new()];
    let taken = Taken { of_e, share: Rational::new(), stretch: Rational::from((3, 2)) };
    let order = model.states();
    let all = gains.iter().flat_map(|gain| [(gain, false), (gain, true)]).map(|(gain, at_end)| {
        let rows = step.rows(model, (metric, &taken), (gain, None), at_end);
        let place = if at_end { "h" } else { "0" };
        let what = format!("F_s >= c_x |x|^2 + c_e e_s^2 + c_y y^2 - gamma q_0^2 for s = {place}{}", gain.at);
        (what, Question::new(&mut model.formulas, rows, order))
    });
    Ok(all.collect())
}

/// The questions of a form that falls (14.6a), with what they are about: for s = 0 and s = h, at both ends of b, with a delay for both signs. The metric is
/// that of the form; `share` of each square is taken from the diagonal, and c_e from that of e_k.
pub fn falls(
    model: &mut Model,
    (metric, within, share): (&Metric, &linear::Within, Rational),
    law: &Terms,
    spec: &Specification,
) -> Outcome<Vec<(String, Question)>> {
    let step = Step::new(&mut model.formulas, metric, law, spec)?;
    let gains = ends(&mut model.formulas, spec, &law.sigma);
    let taken = Taken { of_e: [Rational::new(), metric.least[1].clone()], share, stretch: Rational::from(1) };
    let pasts: Vec<(&str, Option<Past>)> = match &within.g_m {
        None => vec![("", None)],
        Some(g_m) => [(", with +", true), (", with -", false)]
            .map(|(sign, as_it_is)| (sign, Some(Past { g_m: g_m.clone(), as_it_is })))
            .into(),
    };
    let mut questions = Vec::new();
    for (gain, at_end, (sign, past)) in gains
        .iter()
        .flat_map(|gain| [(gain, false), (gain, true)])
        .flat_map(|(gain, at_end)| pasts.iter().map(move |past| (gain, at_end, past)))
    {
        let rows = step.rows(model, (metric, &taken), (gain, past.as_ref()), at_end);
        let what = format!("F_s > 0 for s = {}{}{sign}", if at_end { "h" } else { "0" }, gain.at);
        questions.push((what, Question::new(&mut model.formulas, rows, 0)));
    }
    Ok(questions)
}
