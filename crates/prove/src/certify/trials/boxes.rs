//! Boxes around a trial and forms that fall there, proposed (derivation, 14.5).

use super::around::{Around, Prepared};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_propose::bounds::{FallingForm, LookedAt, PeakBox, PeakOf, PeakProgram, PointSlopes};
use sigmastar_theory::evidence::Part;

/// By what share of the diagonal the matrices of a form are to be definite. Of a family, whose boxes cost the check more, they are wider at first: the proof
/// takes a fraction of the boxes, and the peaks of the machines in `specs` are larger by half a hundredth at most.
const MARGINS: [f64; 2] = [1e-3, 1e-5];
const MARGINS_OF_FAMILY: [f64; 2] = [1e-2, 1e-5];
const WIDE_MARGINS: [f64; 5] = [0.1, 0.07, 0.05, 0.02, 1e-2];
/// Of the form that says how near to the trial the solution is, where its defects are more than rounding.
const NEAR_MARGINS: [f64; 5] = [0.5, 0.3, 0.2, 0.1, 1e-2];

/// How far x may come from the periodic solution, in distances of the start, in turn; the first box of e in that of its start.
const REACHES: [f64; 5] = [1.5, 2.5, 4.0, 6.5, 12.0];
const FIRST: f64 = 1.2;

/// The share of a box up to which solutions may come, and how often the box is fitted to that.
const FILLED: f64 = 0.985;
const FITS: usize = 10;
const LARGER: f64 = 1.04;
const SMALLER: f64 = 1.002;
const SETTLED: f64 = 0.99;

/// What is found on a box serves one that is smaller by up to this share.
const ALIKE: f64 = 0.9;

/// Along x first the peak hardly depends on how far the box goes in e: the box of e in the search, in that of its start, and in peaks.
const FAR: f64 = 2.0;
const ROOMY: f64 = 1.08;

/// The points of a program.
pub(super) type Points = Vec<(Part, PointSlopes)>;

/// A box that solutions from the set do not leave, as far as is seen.
pub(super) struct Fit {
    pub(super) radii: [f64; 2],
    /// Forms on it: the first is to say how near to the trial the solution is.
    pub(super) forms: Vec<FallingForm>,
    /// How far e comes from the periodic solution by them.
    pub(super) peak: f64,
}

/// A form that was found.
pub(super) struct Fitted {
    /// The box on which it was sought.
    at: [f64; 2],
    /// The one that solutions do not leave by it.
    pub(super) radii: [f64; 2],
    form: FallingForm,
    /// Where it was looked at.
    pub(super) points: Points,
}

impl Around<'_> {
    /// The margins of forms, in turn.
    pub(super) fn margins(&self) -> [f64; 2] {
        if self.is_family() { MARGINS_OF_FAMILY } else { MARGINS }
    }

    pub(super) fn program(&self, prepared: &Prepared, reach: Option<f64>) -> PeakProgram {
        let own = &prepared.own;
        PeakProgram {
            points: Vec::new(),
            gain: own.gain.each_ref().map(Enclosure::midpoint_f64),
            sigma: own.sigma.midpoint_f64(),
            mu: own.mu.midpoint_f64(),
            n_bar_squared: own.n_bar_squared.midpoint_f64(),
            start: prepared.distances,
            joint: self.asked.law().is_none(),
            reach,
        }
    }

    /// The box that solutions from the set do not leave, with the smallest peak that is found; along x first with that eta. `near`: the box
    /// that serves another number of oscillators.
    pub(super) fn fitted_box(
        &self,
        prepared: &Prepared,
        margin: f64,
        (x_first, near): (Option<f64>, Option<&[Rational; 2]>),
    ) -> Option<Fitted> {
        let [d_x, d_e, _] = prepared.distances;
        let has_states = self.asked.plant.states() > 0;
        let found_on = |at: [f64; 2], looked: LookedAt, points: Points| {
            let share = if x_first.is_some() { 1.0 / ROOMY } else { FILLED };
            let mut program = self.program(prepared, has_states.then_some(share * at[0]));
            program.points = points;
            let asked = (PeakOf::Error, margin, looked);
            let form = prepared.samples.propose_peak(PeakBox { at, x_first }, &mut program, asked)?;
            Some((form, program.points))
        };
        let fitted = |[x, mut e]: [f64; 2], looked: LookedAt, mut points: Points| {
            if x_first.is_some() {
                let (form, points) = found_on([x, e], looked, points)?;
                return Some(Fitted { at: [x, e], radii: [x, ROOMY * form.level.sqrt()], form, points });
            }
            let mut kept: Option<Fitted> = None;
            for _ in 0..FITS {
                let Some((form, needed)) = found_on([x, e], looked, points) else { break };
                let peak = form.level.sqrt();
                let fits = peak <= FILLED * e;
                // A smaller box has a smaller peak, and what falls on the larger one falls there.
                let next = if fits || kept.is_some() { SMALLER * peak / FILLED } else { LARGER * peak };
                let settled = match &kept {
                    Some(known) if !fits || form.level > SETTLED * known.form.level => true,
                    _ => fits && next >= ALIKE * e,
                };
                points = if next >= ALIKE * e { needed.clone() } else { Vec::new() };
                if fits {
                    kept = Some(Fitted { at: [x, e], radii: [x, next.min(e)], form, points: needed });
                }
                e = next;
                if settled {
                    break;
                }
            }
            kept
        };
        let first = if x_first.is_some() { FAR * d_e } else { FIRST * d_e };
        let search = |reaches: &[f64], first: f64| {
            let mut best: Option<Fitted> = None;
            for reach in reaches {
                let x = if has_states { reach * d_x } else { 0.0 };
                let from = |e: f64| fitted([x, e], LookedAt::Grid, Vec::new());
                let like_known = best.as_ref().filter(|_| x_first.is_none()).and_then(|known| from(known.at[1]));
                let (known, found) = (best.take(), like_known.or_else(|| from(first)));
                // Once they are worse, those further out are too.
                let worse = known
                    .as_ref()
                    .zip(found.as_ref())
                    .is_some_and(|(known, found)| found.form.level > known.form.level);
                best = if worse { known } else { found.or(known) };
                if worse {
                    break;
                }
            }
            best
        };
        let reaches = if has_states { &REACHES[..] } else { &REACHES[..1] };
        let like_other = || {
            let [x, e] = near?.each_ref().map(Rational::to_f64);
            let apart = |reach: &f64| (reach * d_x / x).max(x / (reach * d_x));
            let reach = reaches.iter().min_by(|a, b| apart(a).total_cmp(&apart(b)))?;
            search(&[*reach], e)
        };
        let Fitted { at, radii, points, .. } = like_other().or_else(|| search(reaches, first))?;
        let (at, points) = match x_first {
            None => (at, points),
            Some(_) if radii[1] < ALIKE * at[1] => (radii, Vec::new()),
            Some(_) => (radii, points),
        };
        fitted(at, LookedAt::Between, points)
    }

    /// That box, and forms on it.
    pub(super) fn peak_box(
        &self,
        prepared: &Prepared,
        margin: f64,
        (x_first, near): (Option<f64>, Option<&[Rational; 2]>),
    ) -> Option<Fit> {
        let Fitted { radii, form, points, .. } = self.fitted_box(prepared, margin, (x_first, near))?;
        let peak = form.level.sqrt();
        let more = |of: PeakOf, margin: f64| {
            let mut program = self.program(prepared, None);
            program.points = points.clone();
            let asked = (of, margin, LookedAt::Between);
            prepared.samples.propose_peak(PeakBox { at: radii, x_first }, &mut program, asked)
        };
        // What a family leaves, or many oscillators, is far more than rounding: the wider the margins, the nearer is the solution to the trial.
        let is_far = (self.is_family() || self.or_more) && x_first.is_none();
        let near_trial = NEAR_MARGINS.into_iter().filter(|_| is_far).find_map(|margin| more(PeakOf::Error, margin));
        let forms = near_trial.into_iter().chain([form]).chain(more(PeakOf::Control, margin)).collect();
        Some(Fit { radii, forms, peak })
    }

    /// A box that is small beside the trial, and a form on it.
    pub(super) fn small_box(&self, prepared: &Prepared, share: f64) -> Option<([f64; 2], FallingForm)> {
        let radii = [0, 1].map(|i| share * prepared.distances[i]);
        let place = PeakBox { at: radii, x_first: None };
        // The larger the margins are, the nearer is the solution to the trial.
        let found = |margin: f64| {
            let asked = (PeakOf::Error, margin, LookedAt::Grid);
            prepared.samples.propose_peak(place, &mut self.program(prepared, None), asked)
        };
        Some((radii, WIDE_MARGINS.into_iter().chain(MARGINS).find_map(found)?))
    }
}
