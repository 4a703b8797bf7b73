//! Boxes around a trial and forms that fall there, of the law at samples (derivation, 14.6).

use super::around::{Around, Prepared, SHORT, up};
use super::boxes::{Fitted, Points};
use super::proved::{DIGITS, ROOM as OF_ENDS, rounded, short, short_row};
use super::{Forms, OWN, Proved, SMALL_BOXES};
use rug::Rational;
use sigmastar_decide::bounds::{StatesForm, WithinSample};
use sigmastar_decide::trial::TubeProof;
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_lang::spec::SampledLoop;
use sigmastar_matrix::doubles::largest;
use sigmastar_propose::bounds::{
    FallingForm, FloatSuprema, HeldForm, HeldGoal, HeldProgram, LookedAt, PeakBox, PeakOf, PeakProgram,
};
use sigmastar_theory::derivation::sampled_form::LoopNumbers;

/// By what share of the diagonal the matrices of the forms are to be definite, in turn; of the form that says how near to the trial the solution is the
/// larger, the nearer, for the ripple of a control that is held counts as a defect.
const MARGINS: [f64; 3] = [1e-2, 1e-3, 1e-5];
const NEAR_MARGINS: [f64; 4] = [1e-2, 3e-3, 1e-3, 1e-4];

/// By how much the box is larger than the one that serves in continuous time, in turn.
const GROWTHS: [f64; 5] = [1.02, 1.08, 1.25, 1.6, 2.5];

/// The share of the box up to which solutions may come by a form.
const FILLED: f64 = 0.99;

/// The share of the decay of the states that is met at points that is claimed of all.
const OF_DECAY: f64 = 0.8;

/// The room of gamma above what the margins ask for.
const ROOM: f64 = 1.5;

/// A form with what it has at samples.
type Held = (FallingForm, WithinSample);

impl Around<'_> {
    /// What is proved of the law at samples; `other`: what is proved for another number of oscillators.
    pub(super) fn at_samples(
        &self,
        prepared: &Prepared,
        law: &SampledLoop,
        other: Option<&TubeProof>,
    ) -> Option<Proved> {
        let known = || {
            let TubeProof { radii, forms, within, .. } = other?;
            self.with_peaks(prepared, radii.clone(), (forms.clone(), within.clone()))
        };
        let near = other.map(|other| &other.radii);
        let own = || MARGINS.into_iter().find_map(|margin| self.with_own_held_peaks(prepared, law, (margin, near)));
        let found = if self.oscillators.first_missing() <= OWN { own().or_else(known) } else { known().or_else(own) };
        found.or_else(|| SMALL_BOXES.into_iter().find_map(|share| self.in_small_box(prepared, law, share)))
    }

    /// What is proved on a box that is small beside the trial: how near to it the solution is.
    fn in_small_box(&self, prepared: &Prepared, law: &SampledLoop, share: f64) -> Option<Proved> {
        let radii = [0, 1].map(|i| share * prepared.distances[i]);
        let mut program = self.program(prepared, None);
        let place = PeakBox { at: radii, x_first: None };
        let points = |margin: &f64| {
            let asked = (PeakOf::Error, *margin, LookedAt::Grid);
            prepared.samples.propose_peak(place, &mut program, asked)
        };
        MARGINS.iter().find_map(points)?;
        let held = HeldProgram { of: of_law(&program, prepared, law)?, past: None };
        let (form, within) = self.near_trial(prepared, &program, &held)?;
        let promised = self.promised(prepared, short(radii)?, (vec![rounded(&form)?], vec![within]))?;
        let concluded = self.concluded(prepared, &promised)?;
        Some((self.decided(prepared, promised)?, concluded, None))
    }

    /// (14.4b), by the smallest Q for its decay or by the P of a form, whichever says more: the margins of a form at samples say far less of the decay than is met.
    pub(super) fn held_states_form(
        &self,
        samples: &FloatSuprema,
        of_form: &[Vec<Rational>],
        ([x, e], pushed): ([&Rational; 2], f64),
    ) -> Option<StatesForm> {
        let at = [x, e].map(Rational::to_f64);
        let doubles = |row: &Vec<Rational>| row.iter().map(Rational::to_f64).collect();
        let known: Vec<Vec<f64>> = of_form.iter().map(doubles).collect();
        let found = samples.propose_states(at).into_iter().chain([known]).filter_map(|q| {
            let minus = q.iter().map(|row| row.iter().map(|entry| -entry).collect()).collect();
            let (up, low) = (largest(q.clone()) * (1.0 + OF_ENDS), -largest(minus) * (1.0 - OF_ENDS));
            let decay = OF_DECAY * samples.least_decay(at, &q);
            let answer = (up / low).sqrt() * up * pushed / decay;
            (low > 0.0 && decay > 0.0).then_some((answer, q, [up, low, decay]))
        });
        let (_, q, [q_up, q_low, decay]) = found.min_by(|a, b| a.0.total_cmp(&b.0))?;
        Some(StatesForm {
            matrix: q.iter().map(|row| short_row(row)).collect::<Option<_>>()?,
            q_low: round_f64(q_low, DIGITS, Direction::Down)?,
            q_up: round_f64(q_up, DIGITS, Direction::Up)?,
            c: round_f64(decay / 4.0, DIGITS, Direction::Down)?,
            // |Q g|^2 <= gamma (decay - 2 c).
            gamma: up(2.2 * (q_up * pushed) * (q_up * pushed) / decay, SHORT)?,
        })
    }

    /// The form that says how near to the trial the solution is.
    fn near_trial(&self, prepared: &Prepared, program: &PeakProgram, held: &HeldProgram) -> Option<Held> {
        let goal = HeldGoal::NearTrial(self.disturbances(prepared));
        let of = |margin: f64| with_margins(&program.propose_at_samples(goal, margin, held)?, margin, &held.of);
        NEAR_MARGINS.into_iter().find_map(of)
    }

    fn with_own_held_peaks(
        &self,
        prepared: &Prepared,
        law: &SampledLoop,
        (margin, near): (f64, Option<&[Rational; 2]>),
    ) -> Option<Proved> {
        let Fitted { radii, points, .. } = self.fitted_box(prepared, margin, (None, near))?;
        GROWTHS.into_iter().find_map(|growth| {
            let radii = radii.map(|radius| growth * radius);
            let forms = self.held_forms(prepared, law, (radii, &points, margin))?;
            self.with_peaks(prepared, short(radii)?, forms)
        })
    }

    /// Forms on a box that solutions from the set do not leave by one of them, as far as is seen.
    fn held_forms(
        &self,
        prepared: &Prepared,
        law: &SampledLoop,
        (radii, points, margin): ([f64; 2], &Points, f64),
    ) -> Option<Forms> {
        let has_states = self.asked.plant.states() > 0;
        let mut program = self.program(prepared, has_states.then_some(FILLED * radii[0]));
        program.points.clone_from(points);
        // The points at which a form in continuous time needs them serve here.
        let place = PeakBox { at: radii, x_first: None };
        prepared.samples.propose_peak(place, &mut program, (PeakOf::Error, margin, LookedAt::Between))?;
        let held = HeldProgram { of: of_law(&program, prepared, law)?, past: None };
        let propose = |program: &PeakProgram, goal: HeldGoal, margin: f64| {
            with_margins(&program.propose_at_samples(goal, margin, &held)?, margin, &held.of)
        };
        let stays = |(form, _): &Held| {
            let [x, e, z] = prepared.distances;
            let of_zeta = form.k_p * program.gain[1] * program.mu / 2.0 * z * z;
            let level = form.p_up * x * x + form.weight * e * e + of_zeta;
            let reach = [form.x_low, form.e_low].map(|low| (level / low).sqrt());
            reach[1] <= FILLED * radii[1] && (!has_states || reach[0] <= radii[0])
        };
        let error = propose(&program, HeldGoal::Peak(PeakOf::Error), margin).filter(stays)?;
        let free = PeakProgram { reach: None, ..program.clone() };
        let near = self.near_trial(prepared, &free, &held);
        let of_control = propose(&free, HeldGoal::Peak(PeakOf::Control), margin);
        let all: Vec<Held> = near.into_iter().chain([error]).chain(of_control).collect();
        let forms = all.iter().map(|(form, _)| rounded(form)).collect::<Option<_>>()?;
        Some((forms, all.into_iter().map(|(_, within)| within).collect()))
    }

    /// d_q, and by how much the control may be off within a sample, for the part of the nominal member.
    fn disturbances(&self, prepared: &Prepared) -> [f64; 2] {
        let fundamental = prepared.own.fundamental.midpoint_f64();
        let step = prepared.own.held.as_ref().map_or(0.0, |held| held.step.midpoint_f64());
        let square = |(k, pair): (f64, &[Rational; 2])| {
            pair.iter().map(|part| (part.to_f64() * k * fundamental) * (part.to_f64() * k * fundamental)).sum::<f64>()
                / 2.0
        };
        let control = prepared.trial.terms.first().map(|term| &term.control.harmonics);
        let slope = (1..).map(f64::from).zip(control.into_iter().flatten()).map(square).sum::<f64>().sqrt();
        [prepared.defects[1].to_f64(), step / std::f64::consts::PI * slope]
    }
}

/// The numbers of the law, in the forms of a trial.
fn of_law(
    program: &PeakProgram,
    prepared: &Prepared,
    SampledLoop { law, .. }: &SampledLoop,
) -> Option<LoopNumbers<f64>> {
    let step = prepared.own.held.as_ref()?.step.midpoint_f64();
    let law = [law.gain.to_f64(), law.weight_sum.to_f64()];
    let moves = (program.gain[0] < program.gain[1]).then(|| program.gain.map(|b| 1.0 - b));
    Some(LoopNumbers::new(program.sigma, step, law, &std::f64::consts::PI, moves).with_ripple())
}

/// A form with what (14.6b) asks for of it, at points at which `F_s` is at least this share of `diag(sigma p_up, sigma w, k_p, lambda, lambda)`.
fn with_margins(form: &HeldForm, margin: f64, of: &LoopNumbers<f64>) -> Option<Held> {
    let HeldForm { matrix, weight, k_p, lambda, near, .. } = form;
    let LoopNumbers { sigma, step, across, .. } = of;
    let n = matrix.len();
    let minus: Vec<Vec<f64>> = matrix.iter().map(|row| row.iter().map(|entry| -entry).collect()).collect();
    let [p_up, x_low] = if n > 0 { [largest(matrix.clone()), -largest(minus)] } else { [1.0, 1.0] };
    // Half of these margins is claimed. (e_k + s y + G)^2 <= 3 (e_k^2 + h^2 y^2 + G^2); gamma takes half of what y and v have.
    let c_e = (sigma * weight).min(k_p / (2.0 * step * step)).min(*lambda) * margin / 3.0;
    let by_margins = (k_p / 2.0 + lambda * across * across) / margin;
    let [gamma, c_y] = near.map_or([by_margins, margin * k_p / 2.0], |[gamma, c_y]| [gamma, 2.0 * c_y]);
    let within =
        WithinSample { lambda: round_f64(*lambda, DIGITS, Direction::Nearest)?, gamma: up(ROOM * gamma, DIGITS)? };
    let form = FallingForm {
        matrix: matrix.clone(),
        cross: vec![0.0; n],
        weight: *weight,
        k_p: *k_p,
        p_up,
        x_low,
        e_low: *weight,
        splitting: None,
        margins: [margin * sigma * p_up, c_e, c_y],
        level: f64::NAN,
    };
    Some((form, within))
}
