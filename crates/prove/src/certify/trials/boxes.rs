//! Boxes around a trial and forms that fall there, proposed (derivation, 14.5).

use super::around::{Around, Prepared};
use sigmastar_propose::bounds::{FallingForm, LookedAt, PeakBox, PeakOf, PeakProgram};

/// By what share of the diagonal the matrices of a form are to be definite.
pub(super) const MARGINS: [f64; 2] = [1e-3, 1e-5];
pub(super) const WIDE_MARGINS: [f64; 2] = [0.1, 1e-2];
pub(super) const FAMILY_MARGINS: [f64; 3] = [0.3, 0.1, 1e-2];

/// How far x may come from the periodic solution, in distances of the start, in turn; the first box of e in that of its start.
const REACHES: [f64; 5] = [1.5, 2.5, 4.0, 6.5, 12.0];
const FIRST: f64 = 1.2;

/// The share of a box up to which solutions may come, and how often the box is fitted to that.
const FILLED: f64 = 0.985;
const FITS: usize = 10;
const LARGER: f64 = 1.04;
const SMALLER: f64 = 1.002;
const SETTLED: f64 = 0.99;

/// Along x first the peak hardly depends on how far the box goes in e: the box of e in the search, in that of its start, and in peaks.
const FAR: f64 = 2.0;
const ROOMY: f64 = 1.08;

impl Around<'_> {
    fn program(&self, prepared: &Prepared, reach: Option<f64>) -> PeakProgram {
        let own = &prepared.own;
        PeakProgram {
            points: Vec::new(),
            gain: own.gain.each_ref().map(sigmastar_exact::enclosure::Enclosure::midpoint_f64),
            sigma: own.sigma.midpoint_f64(),
            mu: own.mu.midpoint_f64(),
            n_bar_squared: own.n_bar_squared.midpoint_f64(),
            start: prepared.distances,
            joint: true,
            reach,
        }
    }

    /// The box that solutions from the set do not leave, with the smallest peak that is found, and forms on it; along x first with that eta.
    pub(super) fn peak_box(
        &self,
        prepared: &Prepared,
        margin: f64,
        x_first: Option<f64>,
    ) -> Option<([f64; 2], Vec<FallingForm>)> {
        let [d_x, d_e, _] = prepared.distances;
        let has_states = self.asked.plant.states() > 0;
        let reaches = if has_states { &REACHES[..] } else { &REACHES[..1] };
        let mut best: Option<([f64; 2], FallingForm)> = None;
        let found_on = |at: [f64; 2], asked: (f64, LookedAt)| {
            let share = if x_first.is_some() { 1.0 / ROOMY } else { FILLED };
            let mut program = self.program(prepared, has_states.then_some(share * at[0]));
            let asked = (PeakOf::Error, asked.0, asked.1);
            prepared.samples.propose_peak(PeakBox { at, x_first }, &mut program, asked)
        };
        let fitted = |x: f64, mut e: f64, asked: (f64, LookedAt)| {
            if x_first.is_some() {
                let found = found_on([x, e], asked)?;
                return Some(([x, ROOMY * found.level.sqrt()], found));
            }
            let mut kept: Option<([f64; 2], FallingForm)> = None;
            for _ in 0..FITS {
                let Some(found) = found_on([x, e], asked) else { break };
                let peak = found.level.sqrt();
                let fits = peak <= FILLED * e;
                let settled = kept.as_ref().is_some_and(|(_, known)| !fits || found.level > SETTLED * known.level);
                if fits {
                    kept = Some(([x, e], found));
                }
                // A smaller box has a smaller peak.
                e = if kept.is_some() { SMALLER * peak / FILLED } else { LARGER * peak };
                if settled {
                    break;
                }
            }
            kept
        };
        let first = if x_first.is_some() { FAR } else { FIRST };
        for reach in reaches {
            let found = fitted(if has_states { reach * d_x } else { 0.0 }, first * d_e, (margin, LookedAt::Grid));
            let (known, found) = (best.take(), found);
            // Once they are worse, those further out are too.
            let worse = known.as_ref().zip(found.as_ref()).is_some_and(|(known, found)| found.1.level > known.1.level);
            best = if worse { known } else { found.or(known) };
            if worse {
                break;
            }
        }
        let ([x, e], _) = best?;
        let (radii, first) = fitted(x, e, (margin, LookedAt::Between))?;
        // On this box forms with small margins have smaller peaks.
        let [small, _] = MARGINS;
        let more = |of: PeakOf| {
            let asked = (of, margin.min(small), LookedAt::Between);
            prepared.samples.propose_peak(PeakBox { at: radii, x_first }, &mut self.program(prepared, None), asked)
        };
        let of_error = if margin > small { more(PeakOf::Error) } else { None };
        Some((radii, std::iter::once(first).chain(of_error).chain(more(PeakOf::Control)).collect()))
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
