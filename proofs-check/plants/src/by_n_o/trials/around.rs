//! The formulas around a trial (docs/mathematics.md, section 14.4): on the box of all `x = xhat(t) + L v`, `e = ehat(t) + h` with `|v| <= D_x`,
//! `|h| <= D_e`, of every member, and on the larger one of `x_first` (14.5). They are those of a plant whose orbit is xhat and whose error is measured
//! from ehat, and which has the gain b of the actuator for one more parameter, if that is an interval. Where d_b stands it is asked about at both ends of
//! b, in which the inequalities are affine; that is more than is needed, for the curves move with b besides.

use crate::at_samples;
use crate::bounds;
use crate::form::{End, Form, ends, numbers, of_states, split};
use crate::formula::{Axis, Id, Leaf};
use crate::machine::{Curves, Machine};
use crate::model::{self, Frame, Model, wave};
use crate::question::{Answer, MAX_PIECES, Question};
use crate::read::Plant;
use crate::region::{Region, Shape};
use crate::still::Still;
use crate::time::around;
use crate::{ARGUMENT_PRECISION, PRECISION, smooth, too_large};
use proofs_core::constant::Constant;
use proofs_core::input_gain;
use proofs_core::interval::Interval;
use proofs_core::plant::entries::Name;
use proofs_core::range::{Range, Span};
use proofs_core::rules::by_n_o::claimed::RULE;
use proofs_core::rules::by_n_o::curves::moves;
use proofs_core::rules::by_n_o::trials::{OrMore, Trial};
use proofs_core::rules::by_n_o::x_first::{Split, XFirst};
use proofs_core::rules::sampled::law::Terms;
use proofs_core::spec::Specification;
use proofs_core::verdict::{Outcome, bad, demand};
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
    pub(super) trial: &'t Trial,
    pub(super) plant: Plant,
    pub(super) model: Model,
    pub(super) curves: Curves,
    asked: Vec<Asked<'t>>,
    /// The same questions in x and e.
    still: Still,
    /// The components of `L^-1 (f - xhat')`, and `q + b uhat - ehat'`, and the derivative of that in t where it is asked for.
    pub(super) defects: Vec<Id>,
}

impl<'t> Around<'t> {
    /// From a plant; the gain of the claim, and its law at samples.
    pub fn new(
        spec: &Specification,
        plant: &Plant,
        law: (&Rational, Option<&Terms>),
        trial: &'t Trial,
    ) -> Outcome<Around<'t>> {
        let mut near = plant.clone();
        near.orbit.waves = trial.curves.iter().map(|curves| curves.x.clone()).collect();
        near.forcing.waves = trial.curves.iter().map(|curves| curves.u.clone()).collect();
        near.error = trial.curves.iter().map(|curves| curves.e.clone()).collect();
        near.powers = trial.curves.iter().skip(1).map(|curves| curves.powers.clone()).collect();
        near.lyapunov.clear();
        let gain = spec.input_gain.as_ref().filter(|_| moves(spec)).map(factor).transpose()?;
        let place = near.family.len();
        near.family.extend(gain);
        let mut model = Model::new(&near, Frame::Moving);
        let states = near.states();
        let mut input = wave(&mut model.formulas, &near, states, 0);
        if near.family.len() > place {
            let b = model.formulas.leaf(Leaf::Parameter(place));
            input = model.formulas.make(b * input);
        }
        let velocity = wave(&mut model.formulas, &near, states + 1, 1);
        let apart = model.formulas.make(model.q + input - velocity);
        // Of an entry about so many oscillators or more ehat = 0.
        let rate = trial.or_more.as_ref().map(|_| model.formulas.derivative(apart, Axis::Time));
        let defects = model.defect.iter().copied().chain([apart]).chain(rate).collect();
        let asked = questions(&mut model, spec, law, trial)?;
        if model.formulas.is_too_large() {
            return too_large(RULE, "/plant");
        }
        let in_states = |model: &mut Model| {
            let all = questions(model, spec, law, trial)?.into_iter();
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
}

/// b between its ends, which are exact where they and the nominal gain are rational, and else a little apart.
fn factor(gain: &Range) -> Outcome<Span> {
    let exact = |end: &Constant| Some(end.rational()? / gain.nominal.rational()?);
    let [low, high] = input_gain::factors(gain, ARGUMENT_PRECISION);
    let ends = exact(&gain.low).or_else(|| low.lower()).zip(exact(&gain.high).or_else(|| high.upper()));
    match ends {
        Some((low, high)) => Ok(Span { nominal: Rational::from(1), ends: [low, high] }),
        None => bad("/plant/input_gain", "expected moderate numbers"),
    }
}

/// (14.4a) of each form, at samples (14.6b), (14.4b), and the bounds of r and d, and of the derivatives that the corollary asks for; then (14.5a).
fn questions<'t>(
    model: &mut Model,
    spec: &Specification,
    (sigma, law): (&Rational, Option<&Terms>),
    trial: &'t Trial,
) -> Outcome<Vec<Asked<'t>>> {
    let states = model.states();
    let mut asked = Vec::new();
    let (unit, radii) = (model.formulas.int(1), trial.radii.each_ref());
    let ends = ends(&mut model.formulas, spec, sigma);
    for (place, (metric, _)) in trial.forms.iter().enumerate() {
        let pointer = || format!("{}/forms/{place}", trial.pointer);
        if let Some(law) = law {
            let of_form = at_samples::near_trial(model, metric, law, spec)?.into_iter();
            asked.extend(of_form.map(|(what, question)| Asked {
                question,
                pointer: pointer(),
                what,
                is_of_motion: false,
                radii,
            }));
            continue;
        }
        let corner = Rational::from(sigma * &metric.w) * 2u32;
        let pull: Vec<Rational> = metric.cross.iter().map(|entry| Rational::from(entry * sigma)).collect();
        for End { at, shift } in &ends {
            let form = Form { metric, unit, corner: &corner, shift: *shift, pull: &pull };
            let (mut rows, of_e) = form.rows(model);
            rows.push(of_e);
            asked.push(Asked {
                question: Question::new(&mut model.formulas, rows, states),
                pointer: pointer(),
                what: format!("F >= diag(c_x I, c_e, c_y){at}"),
                is_of_motion: false,
                radii,
            });
        }
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
    asked.extend(trial.x_first.iter().flat_map(|first| along_x_first(model, &ends, sigma, first)));
    Ok(asked)
}

/// (14.5a) of each form: that F without e is not below S where e is within eta of ehat, which is asked once, as b has no part in it, and that S with e
/// is not below 0.
fn along_x_first<'t>(model: &mut Model, ends: &[End], sigma: &Rational, first: &'t XFirst) -> Vec<Asked<'t>> {
    let (states, unit) = (model.states(), model.formulas.int(1));
    let XFirst { pointer, radii: [d_x, d_e], slice, forms } = first;
    let mut asked = Vec::new();
    for (place, Split { metric, matrix, .. }) in forms.iter().enumerate() {
        let corner = Rational::from(sigma * &metric.w) * 2u32;
        for (which, End { at, shift }) in ends.iter().enumerate() {
            let rows = Form { metric, unit, corner: &corner, shift: *shift, pull: &[] }.rows(model);
            let both = split(&mut model.formulas, rows, matrix, unit);
            let kinds = [
                ("F without e >= S, along x first up to E,", "", [d_x, slice]),
                ("S with e >= 0, along x first,", *at, [d_x, d_e]),
            ];
            let kinds = both.into_iter().zip(kinds).skip(usize::from(which > 0));
            asked.extend(kinds.map(|(rows, (what, at, radii))| Asked {
                question: Question::new(&mut model.formulas, rows, states),
                pointer: format!("{pointer}/forms/{place}"),
                what: format!("{what}{at}"),
                is_of_motion: false,
                radii,
            }));
        }
    }
    asked
}
