//! The formulas around a trial (docs/mathematics.md, section 14.4): on the box of all `x = xhat(t) + L v`, `e = ehat(t) + h` with `|v| <= D_x`,
//! `|h| <= D_e`, and on the larger one of `x_first` (14.5). They are those of a plant whose orbit is xhat and whose error is measured from ehat.

use crate::bounds;
use crate::form::{Form, numbers, of_states, split};
use crate::formula::Id;
use crate::machine::{Curves, Machine};
use crate::model::{self, Frame, Model, wave};
use crate::path::{Expanded, Judged, Path, Polynomial, bound, bound_of_derivative, bound_of_norm, everywhere};
use crate::question::{Answer, MAX_PIECES, Question};
use crate::read::Plant;
use crate::region::{Piece, Region, Shape};
use crate::still::Still;
use crate::time::around;
use crate::{PRECISION, smooth, too_large};
use proofs_core::interval::Interval;
use proofs_core::plant::entries::Name;
use proofs_core::rules::by_n_o::claimed::RULE;
use proofs_core::rules::by_n_o::trials::{OrMore, Trial};
use proofs_core::rules::by_n_o::x_first::{Split, XFirst};
use proofs_core::verdict::{Outcome, demand};
use rug::Rational;

/// By so many boxes each question is tried at first.
const FEW_PIECES: usize = 1_000;

/// A question about a box, with its place and what it is about.
struct Asked<'t> {
    question: Question,
    pointer: String,
    what: String,
    /// Whether it has the velocity of the frame, so that it is asked in the moving one alone.
    is_of_motion: bool,
    /// Those of the box.
    radii: [&'t Rational; 2],
}

/// The formulas around a trial.
pub struct Around<'t> {
    trial: &'t Trial,
    plant: Plant,
    model: Model,
    curves: Curves,
    asked: Vec<Asked<'t>>,
    /// The same questions in x and e.
    still: Still,
    /// The components of `L^-1 (f - xhat')`, and `q - qhat`.
    defects: Vec<Id>,
}

impl<'t> Around<'t> {
    /// From a plant; `sigma`: the gain of the claim.
    pub fn new(plant: &Plant, sigma: &Rational, trial: &'t Trial) -> Outcome<Around<'t>> {
        let mut near = plant.clone();
        near.orbit.waves = vec![trial.x.clone()];
        near.forcing.waves = vec![trial.q.clone()];
        near.error = Some(trial.e.clone());
        near.lyapunov.clear();
        let mut model = Model::new(&near, Frame::Moving);
        let input = wave(&mut model.formulas, &near, near.states(), 0);
        let apart = model.formulas.make(model.q - input);
        let defects = model.defect.iter().copied().chain([apart]).collect();
        let asked = questions(&mut model, sigma, trial);
        if model.formulas.is_too_large() {
            return too_large(RULE, "/plant");
        }
        let in_states = |model: &mut Model| {
            let all = questions(model, sigma, trial).into_iter();
            Ok(all.map(|asked| (!asked.is_of_motion).then_some(asked.question)).collect())
        };
        let still = Still::new(&near, in_states)?;
        Ok(Around { trial, curves: model::curves(&near), plant: near, model, asked, still, defects })
    }

    /// Proves on the box that the formulas are smooth, (14.4a) of each form, (14.4b), and the bounds of r and d, and of an entry about so many
    /// oscillators or more those of the other derivatives, with the defects as they are ([`Around::defects`]); and on that of `x_first`, where it is
    /// there, that they are smooth, and (14.5a). By how many boxes. `error`: sup|ehat|.
    pub fn on_box(&self, [om, period]: [&Interval; 2], error: &Interval, about: &str) -> Outcome<usize> {
        let mut machine = Machine::new(&self.model.formulas, &self.curves, om);
        // `|L^-1 (fhat - xhat')| <= d_x`, for ehat is 0 where fhat is asked for.
        machine.drift = around(&Interval::rational(&self.trial.defects[0], PRECISION));
        let (root, mut values) = (machine.period(period), machine.values());
        let family = Region::of_family(&self.plant, PRECISION);
        let region = |radii: [&Rational; 2]| {
            let [d_x, output] = radii.map(|radius| Interval::rational(radius, PRECISION));
            Region { states: self.plant.states(), shape: Shape::Ball(d_x), output, ..family.clone() }
        };
        let larger = self.trial.x_first.iter().map(|first| (&first.pointer, &first.radii));
        let mut boxes = 0;
        for (pointer, radii) in [(&self.trial.pointer, &self.trial.radii)].into_iter().chain(larger) {
            let (demands, place) = (&self.model.demands, format!("{pointer}/box"));
            let region = region(radii.each_ref());
            boxes += smooth::prove(&self.model.formulas, demands, &place, &machine, &root, &region, &mut values)?;
        }
        let mut still = None;
        for (which, Asked { question, pointer, what, radii, .. }) in self.asked.iter().enumerate() {
            let region = region(*radii);
            // A wide box may be one of the states themselves, which has fewer sides.
            let farthest = (error.round(PRECISION) + &region.output).ceiling();
            let wide = Region { output: farthest, ..region.clone() };
            let mut decide = |most: usize| question.decide(&machine, &root, &region, most, &mut values);
            let mut answer = decide(FEW_PIECES);
            if matches!(answer, Answer::Open(_)) {
                let still = still.get_or_insert_with(|| self.still.prepared(&self.plant, &self.curves, om, period));
                let proved = still.proves(&self.plant, which, &wide);
                answer = proved.map_or_else(|| decide(MAX_PIECES), Answer::Proved);
            }
            let what = |place| {
                format!("{what} on the box of the trial for {about}, with xhat for xb and e - ehat for e at {place}")
            };
            match answer {
                Answer::Proved(count) => boxes += count,
                Answer::Refuted(place) => demand(Some(false), RULE, pointer, what(place))?,
                Answer::Open(place) => demand(None, RULE, pointer, what(place))?,
            }
        }
        Ok(boxes)
    }

    /// Proves `|L^-1 (f(t,xhat,ehat) - xhat')| <= d_x` and `|q(t,xhat,ehat) - qhat| + kappa <= d_q` at every t, and of an entry about so many
    /// oscillators or more `|(q(t,xhat,0) - qhat)'| <= d_t`, at the precision of Om; by how many cells of t.
    pub fn defects(&self, [om, period]: [&Interval; 2], kappa: &Interval, about: &str) -> Outcome<usize> {
        let p = om.precision();
        let machine = Machine::new(&self.model.formulas, &self.curves, om);
        let values = machine.values();
        let path = Path::new(&machine, &self.curves, om, std::slice::from_ref(&self.defects));
        let number = |defect: &Rational| Interval::rational(defect, p);
        let [d_x, d_q] = self.trial.defects.each_ref().map(number);
        let of_rate = self.trial.or_more.as_ref().map(|more| number(&more.defect));
        let most: Vec<Interval> = [d_x, d_q - kappa].into_iter().chain(of_rate).collect();
        let states = self.plant.states();
        // Which of them is open on the last cell.
        let mut open = 0;
        let judge = |piece: &Piece| {
            let (expanded, half) = (Expanded::new(&path, piece, &values), piece.cell.all.half_width());
            let (of_f, q) = expanded.at_middle.split_at(states);
            let zero = Interval::int(0, p);
            let of_q = |bound: fn(&Polynomial, &Interval) -> Interval| {
                q.iter().fold(zero.clone(), |sum, q| sum + bound(q, &half))
            };
            let sizes = [bound_of_norm(of_f, &half), of_q(bound), of_q(bound_of_derivative)];
            let wrong = |(size, most): (&Interval, &Interval)| size.le(most) != Some(true);
            let Some(which) = sizes.iter().zip(&most).position(wrong) else { return Judged::Proved };
            open = which;
            // The value, or the slope, at the middle.
            let (parts, order) = [(of_f, 0), (q, 0), (q, 1)][which];
            let square = |part: &Polynomial| part.coefficients.get(order).unwrap_or(&zero).sqr();
            let at_middle = parts.iter().fold(zero.clone(), |sum, part| sum + square(part)).sqrt();
            match most[which].lt(&at_middle) {
                Some(true) => Judged::Refuted,
                _ => Judged::Halve(vec![1.0]),
            }
        };
        let whole = Region::of_family(&self.plant, p).whole(&machine, machine.period(period));
        everywhere(whole, judge).or_else(|(t, refuted)| {
            let (name, what) = [
                ("defect_x", "|L^-1 (f(t,xhat,ehat) - xhat')| <= defect_x"),
                ("defect_q", "|q(t,xhat,ehat) - qhat| + kappa <= defect_q"),
                ("defect_q_t", "|(q(t,xhat,0) - qhat)'| <= defect_q_t"),
            ][open];
            let what = format!("{what} for {about}, near t = {t:.6}");
            demand(refuted.then_some(false), RULE, &format!("{}/{name}", self.trial.pointer), what).map(|()| 0)
        })
    }
}

/// (14.4a) of each form, (14.4b), and the bounds of r and d, and of the derivatives that the corollary asks for; then (14.5a).
fn questions<'t>(model: &mut Model, sigma: &Rational, trial: &'t Trial) -> Vec<Asked<'t>> {
    let states = model.states();
    let mut asked = Vec::new();
    let (unit, radii) = (model.formulas.int(1), trial.radii.each_ref());
    for (place, (metric, _)) in trial.forms.iter().enumerate() {
        let corner = Rational::from(sigma * &metric.w) * 2u32;
        let pull: Vec<Rational> = metric.cross.iter().map(|entry| Rational::from(entry * sigma)).collect();
        let (mut rows, of_e) = Form { metric, unit, corner: &corner, shift: None, pull: &pull }.rows(model);
        rows.push(of_e);
        asked.push(Asked {
            question: Question::new(&mut model.formulas, rows, states),
            pointer: format!("{}/forms/{place}", trial.pointer),
            what: "F >= diag(c_x I, c_e, c_y)".to_owned(),
            is_of_motion: false,
            radii,
        });
    }
    if let Some(of) = &trial.states {
        let [c, gamma] = &of.decay;
        let (mut rows, mut last) = of_states(model, &of.matrix, &Rational::from(c * 2u32));
        last.extend(numbers(&mut model.formulas, std::slice::from_ref(gamma)));
        rows.push(last);
        asked.push(Asked {
            question: Question::new(&mut model.formulas, rows, states),
            pointer: format!("{}/states", trial.pointer),
            what: "[[-(Q J + J'Q) - 2 c I, -Q g], [., gamma]] >= 0".to_owned(),
            is_of_motion: false,
            radii,
        });
    }
    let [q_x, q_e] = &trial.slopes;
    let mut of_states = vec![(Name::Qx, q_x, "q_x", "|q_x L| <= q_x")];
    let mut of_output = vec![(Name::Qe, q_e, "q_e", "|q_e| <= q_e")];
    if let Some(OrMore { rates: [q_tx, q_te], slopes: [f_x, f_e], .. }) = &trial.or_more {
        of_states.extend([
            (Name::Fx, f_x, "f_x", "|L^-1 f_x L| <= f_x"),
            (Name::Fe, f_e, "f_e", "|L^-1 f_e| <= f_e"),
            (Name::Qtx, q_tx, "q_tx", "|(q_tx + q_xx fhat) L| <= q_tx"),
        ]);
        of_output.push((Name::Qte, q_te, "q_te", "|q_te + q_xe fhat| <= q_te"));
    }
    if states == 0 {
        of_states.clear();
    }
    let bound = |(name, value, label, what): (Name, &Rational, &str, &str)| Asked {
        question: bounds::question(model, name, value),
        pointer: format!("{}/{label}", trial.pointer),
        what: what.to_owned(),
        is_of_motion: name.is_of_motion(),
        radii,
    };
    asked.extend(of_states.into_iter().chain(of_output).map(bound));
    asked.extend(trial.x_first.iter().flat_map(|first| along_x_first(model, sigma, first)));
    asked
}

/// (14.5a) of each form: that F without e is not below S where e is within eta of ehat, and that S with e is not below 0.
fn along_x_first<'t>(model: &mut Model, sigma: &Rational, first: &'t XFirst) -> Vec<Asked<'t>> {
    let (states, unit) = (model.states(), model.formulas.int(1));
    let XFirst { pointer, radii: [d_x, d_e], slice, forms } = first;
    let mut asked = Vec::new();
    for (place, Split { metric, matrix, .. }) in forms.iter().enumerate() {
        let corner = Rational::from(sigma * &metric.w) * 2u32;
        let rows = Form { metric, unit, corner: &corner, shift: None, pull: &[] }.rows(model);
        let both = split(&mut model.formulas, rows, matrix, unit);
        let kinds =
            [("F without e >= S, along x first up to E,", [d_x, slice]), ("S with e >= 0, along x first,", [d_x, d_e])];
        asked.extend(both.into_iter().zip(kinds).map(|(rows, (what, radii))| Asked {
            question: Question::new(&mut model.formulas, rows, states),
            pointer: format!("{pointer}/forms/{place}"),
            what: what.to_owned(),
            is_of_motion: false,
            radii,
        }));
    }
    asked
}
