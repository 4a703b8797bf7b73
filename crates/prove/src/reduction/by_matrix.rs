//! The search for coordinates in which the matrix inequality (M) asks for the least gain (derivation, 13.7): where it starts, and its
//! descents.

use super::coordinates::{Chosen, CoordinateSearch, MOST_STATES, Rough, SHAPE_STEP, Start, TURNS, Varied, alone};
use super::energy::{FIRST_THRESHOLDS, THRESHOLDS};
use super::estimates::Density;
use super::grid::RATE;
use nalgebra::DMatrix;
use sigmastar_exact::number::Portable;
use sigmastar_exact::parallel;
use sigmastar_lang::spec::Bound;
use sigmastar_propose::bounds::{Asked, FloatWeights, MatrixArguments};
use sigmastar_propose::search::{Binding, Descent, Failing, Obstacle, minimise};
use sigmastar_theory::evidence::TABLE;

/// How many descents there are at most, and by what share one has to lower the gain for another one.
const MOST_TURNS: usize = 10;
const WORTH_A_TURN: f64 = 0.02;

/// One over the weights on the orbit, and the share by which a candidate has to be better there to be worth a look.
const ON_ORBIT: Descent = Descent { restarts: 1, iterations: 60, tolerance: 1e-3 };
const WORTH_ANOTHER_START: f64 = 0.05;

/// A gain by a matrix inequality is at most this share of what is known, to be worth its proof.
const WORTH_A_MATRIX: f64 = 0.99;

/// A gain that is so many times that of norms is not sought further; one that existence sets if it is so near.
const FAR: f64 = 1.3;
const NEARLY: f64 = 0.98;

/// The room between both sides of S1 and S2 of the last descent.
const CLOSE: f64 = 1e-3;

/// By what share the gain has to be larger at many samples for another inequality of existence to be sought.
const WORTH_AN_INEQUALITY: f64 = 0.05;

impl CoordinateSearch<'_> {
    /// From where a search by a matrix inequality starts: all candidates where L is not varied, else one of two, the best by norms and the
    /// one whose inequality asks for the least gain on the orbit, whichever does better with its own shape of the error box.
    #[must_use]
    pub fn for_matrix(&self, rough: &Rough) -> Vec<Start> {
        if rough.best.l.nrows() > MOST_STATES {
            return rough.starts.clone();
        }
        let on_orbit: Vec<f64> = parallel::map(&rough.all, |start| self.least_on_orbit(&start.l));
        let least = on_orbit.iter().zip(&rough.all).min_by(|(a, _), (b, _)| a.total_cmp(b));
        let own = self.least_on_orbit(&rough.best.l);
        let other = least.filter(|(least, _)| **least < own * (1.0 - WORTH_ANOTHER_START)).map(|(_, start)| start);
        let Some(other) = other else { return vec![rough.best.clone()] };
        let gain = |start: &Start| {
            let at = if self.energy_helps(start) { self.with_energy(start, &FIRST_THRESHOLDS) } else { start.clone() };
            self.descend(&at, Varied::Shape).map_or(f64::INFINITY, |found| found.proposal.sigma)
        };
        let (by_norms, by_orbit) = rayon::join(|| gain(&rough.best), || gain(other));
        let better = by_orbit < by_norms * (1.0 - WORTH_ANOTHER_START);
        vec![if better { other.clone() } else { rough.best.clone() }]
    }

    /// The least gain of the matrix inequality for the derivatives on the orbit, with any weights.
    fn least_on_orbit(&self, l: &DMatrix<f64>) -> f64 {
        let estimates = self.estimates(alone(l), &Density::Coarse);
        let values = estimates.bounds(0.0, 0.0, Asked::ALL);
        let of = |bound: Bound| TABLE.iter().position(|kind| *kind == bound).map_or(f64::NAN, |at| values[at]);
        let [f_e, q_x, q_e] = [Bound::Fe, Bound::Qx, Bound::Qe].map(of);
        let gain = q_e + f_e * q_x / values[RATE];
        // So large that the inequality holds without e, or as large as norms have it.
        let least = 0.25 * q_x * q_x / values[RATE];
        let balance = if f_e > 0.0 && q_x > 0.0 { least.max(0.5 * q_x / f_e) } else { 1.0 };
        let at = MatrixArguments { apart: false, states: [0.0; 2], error: [0.0; 2] };
        let cost = |p: &[f64]| {
            let k_p = p[0].portable_exp() / gain;
            let weights = FloatWeights { w_x: p[1].portable_exp() * balance * k_p, k_p, rate: 0.0 };
            Some(estimates.threshold(at, weights)).filter(|value| value.is_finite()).map(Portable::portable_ln)
        };
        let best = minimise(&cost, &[0.0; 2], &[SHAPE_STEP; 2], ON_ORBIT);
        best.map_or(f64::INFINITY, |(_, least)| least.portable_exp())
    }

    /// The best choice near a known one, of another search for the same plant. A search that is at a gain above `limit` before it looks at
    /// many samples is given up; so is one that is not smaller than `by_norms` by what is worth it.
    ///
    /// # Errors
    /// The obstacle, where no such gain is found.
    pub fn choose_near(&self, known: &Start, by_norms: f64, limit: f64) -> Result<Chosen, Obstacle> {
        let too_large = || Obstacle::from(Failing::Gain { given: known.proposal.sigma, smallest: None });
        let mut at = known.clone();
        // Where L is not varied, the third descent would repeat the second.
        let descents = if at.l.nrows() > MOST_STATES { TURNS } else { TURNS + 1 };
        let mut best: Option<Start> = None;
        let mut helps = self.energy_helps(&at);
        for turn in 0..MOST_TURNS {
            let before = at.proposal.sigma;
            if helps {
                at = self.with_energy(&at, if turn == 0 { &FIRST_THRESHOLDS } else { &THRESHOLDS });
            }
            let varied = if turn == 0 { Varied::Shape } else { Varied::Coordinates };
            at = self.descend(&at, varied).ok_or_else(too_large)?;
            let hopeless = at.proposal.binding == Binding::Existence && at.proposal.sigma > NEARLY * by_norms;
            if hopeless || at.proposal.sigma > FAR * by_norms {
                return Err(too_large());
            }
            if best.as_ref().is_none_or(|best| at.proposal.sigma < best.proposal.sigma) {
                best = Some(at.clone());
            }
            if turn + 1 >= descents && at.proposal.sigma > before * (1.0 - WORTH_A_TURN) {
                break;
            }
            helps = helps || self.energy_helps(&at);
        }
        let at = best.ok_or_else(too_large)?;
        let closer = self.descend(&Start { room: CLOSE, ..at.clone() }, Varied::Coordinates);
        let at = closer.filter(|closer| closer.proposal.sigma < at.proposal.sigma).unwrap_or(at);
        if at.proposal.sigma > limit.min(WORTH_A_MATRIX * by_norms) {
            return Err(too_large());
        }
        let found = self.at_many_samples(&at)?;
        Ok(self.with_second(found))
    }

    /// The choice at a start; where it asks for far more at many samples than at few, near other inequalities of existence for it.
    fn at_many_samples(&self, start: &Start) -> Result<Chosen, Obstacle> {
        let mut few = start.proposal.sigma;
        let mut found = self.with(start.shape(), Some(&start.proposal))?;
        for _ in 0..MOST_TURNS {
            if found.proposal.sigma < few * (1.0 + WORTH_AN_INEQUALITY) {
                break;
            }
            let again = self.with_energy(&Start::from(&found), &THRESHOLDS);
            let again = self.descend(&Start { room: CLOSE, ..again }, Varied::Coordinates);
            let Some(again) = again else { break };
            let next = self.with(again.shape(), Some(&again.proposal))?;
            if next.proposal.sigma > found.proposal.sigma * (1.0 - WORTH_A_TURN) {
                break;
            }
            (few, found) = (again.proposal.sigma, next);
        }
        Ok(found)
    }

    /// The gain near a choice in coordinates near it, of another search for a plant near it; an estimate, at few samples.
    #[must_use]
    pub fn estimate_around(&self, known: &Start) -> Option<f64> {
        let close = Start { room: CLOSE, ..known.clone() };
        let found = self.descend(&close, Varied::Shape)?;
        let found = if self.energy_helps(&found) { self.with_energy(&found, &THRESHOLDS) } else { found };
        self.descend(&found, Varied::Coordinates).map(|found| found.proposal.sigma)
    }

    /// The gain near a choice in its coordinates, of another search for the same plant; an estimate, at few samples.
    #[must_use]
    pub fn estimate_near(&self, known: &Start) -> Option<f64> {
        self.descend(&Start { room: CLOSE, ..known.clone() }, Varied::Shape).map(|found| found.proposal.sigma)
    }
}
