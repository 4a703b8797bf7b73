//! A smaller gain by metrics that join the states and the error (derivation, 13.7, (Jm)), where there is one: for existence and
//! stability at a gain that is given, semidefinite programs propose them, and the gain is lowered while they exist.

use super::entries::needed;
use super::proofs::{Proofs, Reduced};
use crate::certify::Alternatives;
use rug::Rational;
use sigmastar_exact::number::{Direction, Portable, round_f64};
use sigmastar_lang::spec::{JointInequality, JointStability, Level, Metric, ProvedValues};
use sigmastar_propose::bounds::{FloatLevel, FloatMetric, LevelAsked, LookedAt, Place};
use sigmastar_propose::search::{
    AtSigma, ByEnergy, ByMatrix, Descent, FloatModel, PeriodicSet, SharpProposal, active_level, at_sigma, minimise,
    search_sharp_near, start_distances,
};
use sigmastar_theory::derivation::harmonics::AtOrigin;
use std::cell::RefCell;
use std::sync::Arc;

/// Beyond so many states the programs take too long.
const MOST_STATES: usize = 4;

/// The share of a gain at which a smaller one is first looked for, and those of later ones while they exist; then how often the last
/// interval is halved.
const FIRST: f64 = 0.985;
const STEP: f64 = 0.8;
const HALVED: usize = 5;

/// How far above the least gain that is found metrics are proved, in turn, and with what margin: a larger one takes fewer boxes.
const ABOVE: [(f64, f64); 5] = [(1e-3, MARGIN), (1e-2, 4e-3), (3e-2, 8e-3), (6e-2, 1.5e-2), (0.1, 2.5e-2)];

/// How much further than the set they are for metrics of existence are sought, first and where the set turns out larger; and at last.
const FURTHER: f64 = 1.5;
const TRIES: usize = 8;
const AROUND: f64 = 1.05;

/// The share of the rates that stability keeps in a program, and of that in a proof.
const MARGIN: f64 = 2e-3;
const PROVED: f64 = 0.25;

/// The shares of the margins of existence that are given up until it is proved.
const GIVEN_UP: [f64; 4] = [0.02, 0.1, 0.3, 0.6];

/// Of the level, the share that the set may take.
const ROOM: f64 = 0.999;

/// The room in S1 and S2 of a set, and between a gain and the one at which it is looked at.
const NEAR: f64 = 1e-9;

/// How far above a threshold, which is rounded, a gain is.
const AFTER: f64 = 1e-7;

/// The descent over the shape of the error box.
const SHAPE: Descent = Descent { restarts: 0, iterations: 14, tolerance: 3e-3 };
const SHAPE_STEP: f64 = 0.2;

/// Digits of the numbers of a metric.
const DIGITS: u32 = 9;

/// Boxes of a proof; from three states on fewer, for the checker, which encloses less closely, needs hundreds of times as many then.
const EFFORT: usize = 30_000;
const MODEST_EFFORT: usize = 300;

/// The points at which metrics are sought, and the share of the rates that stability keeps there.
#[derive(Clone, Copy)]
struct Looked {
    at: LookedAt,
    margin: f64,
}

/// To find a gain.
const ROUGHLY: Looked = Looked { at: LookedAt::Grid, margin: MARGIN };

/// What is found at one gain.
#[derive(Clone)]
struct Found {
    sigma: f64,
    model: FloatModel,
    set: PeriodicSet,
    radii: [f64; 2],
    stability: JointStability,
}

/// A search at gains below a known one.
struct JointSearch<'a> {
    proofs: &'a Proofs<'a>,
    /// The model with sampled bounds.
    model: &'a FloatModel,
    known: &'a SharpProposal,
    /// Points of the programs of existence and of stability that the next ones begin with.
    places: [RefCell<Vec<Place>>; 2],
}

/// What is proved with a smaller gain than that of `reduced`, by joint metrics near the proposal that it was made of.
pub(super) fn with_joint_metrics(
    proofs: &Proofs<'_>,
    model: &FloatModel,
    known: &SharpProposal,
    reduced: &Reduced,
) -> Option<Reduced> {
    if !(1..=MOST_STATES).contains(&proofs.states()) {
        return None;
    }
    let search = JointSearch { proofs, model, known, places: Default::default() };
    let known = reduced.proposal.sigma;
    let found = search.least(known).and_then(|found| search.proved(&found, known));
    found.filter(|found| found.proposal.sigma < known)
}

impl JointSearch<'_> {
    /// The least gain below one that is known.
    fn least(&self, above: f64) -> Option<Found> {
        let (set, at) = at_sigma(self.model, &self.known.parameters, self.known.sigma * (1.0 + NEAR), NEAR).ok()?;
        let mut best = self.at(above * FIRST, [set.x_p, set.e_p], radii(&at), ROUGHLY)?;
        let mut low = loop {
            let next = best.sigma * STEP;
            match self.at(next, [best.set.x_p, best.set.e_p], best.radii, ROUGHLY) {
                Some(found) => best = found,
                None => break next,
            }
        };
        for _ in 0..HALVED {
            let middle = (low * best.sigma).sqrt();
            match self.at(middle, [best.set.x_p, best.set.e_p], best.radii, ROUGHLY) {
                Some(found) => best = found,
                None => low = middle,
            }
        }
        Some(best)
    }

    /// Metrics at a gain, near a set and an error box.
    fn at(&self, sigma: f64, sizes: [f64; 2], radii: [f64; 2], looked: Looked) -> Option<Found> {
        let by_norms = self.model.with_inequalities(None, None);
        let plain = self.set(&by_norms, sigma).map(|set| (by_norms.clone(), set));
        let joint = self.existence(&by_norms, sigma, sizes, looked.at);
        let (model, set) = [plain, joint].into_iter().flatten().min_by(|a, b| a.1.e_per.total_cmp(&b.1.e_per))?;
        let (radii, stability) = self.stability(&model, &set, sigma, (radii, looked))?;
        Some(Found { sigma, model, set, radii, stability })
    }

    /// The least set of a model at a gain.
    fn set(&self, model: &FloatModel, sigma: f64) -> Option<PeriodicSet> {
        let parameters = self.known.parameters;
        let at = (parameters.form, parameters.floors);
        PeriodicSet::least(model, &AtOrigin::new(model), sigma * (1.0 + AFTER), at, NEAR).ok()
    }

    /// The model with metrics of existence, and its set.
    fn existence(
        &self,
        model: &FloatModel,
        sigma: f64,
        sizes: [f64; 2],
        looked: LookedAt,
    ) -> Option<(FloatModel, PeriodicSet)> {
        let with = |region: [f64; 2]| {
            let metrics = self.proofs.suprema.propose_joint_existence(
                region,
                sigma,
                (looked, &mut self.places[0].borrow_mut()),
            )?;
            let joint = Arc::new(inequality(region, sigma, &metrics, 1.0)?);
            let model = model.with_inequalities(None, Some(ByEnergy::Joint(joint)));
            let set = self.set(&model, sigma);
            Some((model, set))
        };
        let mut region = sizes.map(|size| size * FURTHER);
        for _ in 0..TRIES {
            let (model, set) = with(region)?;
            if let Some(set) = set {
                let around = [set.x_p * AROUND, set.e_p * AROUND];
                let closer = with(around).and_then(|(model, set)| set.map(|set| (model, set)));
                return Some(closer.unwrap_or((model, set)));
            }
            region = region.map(|size| size * 2.0);
        }
        None
    }

    /// Metrics of stability around a set, with the shape of the error box that leaves most room.
    fn stability(
        &self,
        model: &FloatModel,
        set: &PeriodicSet,
        sigma: f64,
        (start, looked): ([f64; 2], Looked),
    ) -> Option<([f64; 2], JointStability)> {
        let distances = start_distances(model, set);
        let metrics = |radii: [f64; 2]| {
            let at = [set.x_per + radii[0], set.e_per + radii[1]];
            model.contains(at).ok()?;
            let asked = LevelAsked { radii, distances, mu: model.mu, rate: model.alpha, margin: looked.margin };
            let places = &mut self.places[1].borrow_mut();
            let (metrics, levels, share) =
                self.proofs.suprema.propose_joint_stability(at, sigma, &asked, (looked.at, places))?;
            Some((at, radii, metrics, levels, share))
        };
        let decode = |p: &[f64]| [p[0].portable_exp(), p[1].portable_exp()];
        let least = [0, 1].map(|i| start[i].max(distances[i] * 1.1).portable_ln());
        // The first shape with enough room is taken: the descent is at its end then, and what is looked at again is known.
        let (enough, known) = (RefCell::new(None), RefCell::new(Vec::new()));
        let cost = |p: &[f64]| {
            if enough.borrow().is_some() {
                return Some(ROOM.portable_ln());
            }
            let of_known = |(at, cost): &(Vec<f64>, Option<f64>)| (at == p).then_some(*cost);
            if let Some(cost) = known.borrow().iter().find_map(of_known) {
                return cost;
            }
            let found = metrics(decode(p));
            let cost = found.as_ref().map(|(.., share)| share.portable_ln());
            known.borrow_mut().push((p.to_vec(), cost));
            *enough.borrow_mut() = found.filter(|(.., share)| *share < ROOM);
            cost
        };
        cost(&least);
        if enough.borrow().is_none() {
            minimise(&cost, &least, &[SHAPE_STEP; 2], SHAPE)?;
        }
        let (at, radii, metrics, levels, _) = enough.into_inner()?;
        let inequality = inequality(at, sigma, &metrics, PROVED)?;
        let [near, far] = levels.map(level);
        Some((radii, JointStability { inequality, levels: [near?, far?] }))
    }

    /// The data of what was found, proved below a gain.
    fn proved(&self, found: &Found, known: f64) -> Option<Reduced> {
        let above = ABOVE.into_iter().map(|(above, margin)| (found.sigma * (1.0 + above), margin));
        above.filter(|(sigma, _)| *sigma < known).find_map(|(sigma, margin)| {
            let looked = Looked { at: LookedAt::Between, margin };
            let found = self.at(sigma, [found.set.x_p, found.set.e_p], found.radii, looked)?;
            self.decided(&found)
        })
    }

    fn decided(&self, Found { sigma, model, stability, .. }: &Found) -> Option<Reduced> {
        let Proofs { engine, .. } = self.proofs;
        let effort = if self.proofs.states() > 2 { MODEST_EFFORT } else { EFFORT };
        if !engine.decide_joint_stability(stability, effort).truth.is_true() {
            return None;
        }
        let by_matrix = ByMatrix::Joint(Arc::new(stability.clone()));
        let mut model = model.with_inequalities(Some(by_matrix), model.by_energy.clone());
        let mut existence = None;
        if let Some(ByEnergy::Joint(known)) = &model.by_energy {
            let proved = GIVEN_UP.into_iter().find_map(|share| {
                let weaker = weakened(known, 1.0 - share)?;
                engine.decide_joint(&weaker, effort).truth.is_true().then_some(weaker)
            })?;
            model.by_energy = Some(ByEnergy::Joint(Arc::new(proved.clone())));
            existence = Some(proved);
        }
        let proposal = SharpProposal { sigma: *sigma * (1.0 + AFTER), ..*self.known };
        let (set, at) = at_sigma(&model, &proposal.parameters, sigma * (1.0 + AFTER), NEAR).ok()?;
        let needed = needed(&model, &set, &at, 1e-3, (self.proofs.has_second(), *sigma))?;
        let joint_stability = Some(stability.clone());
        let joint = |values: ProvedValues| ProvedValues { joint_existence: existence, joint_stability, ..values };
        let (with_values, spec) = self.proofs.with_needed(&needed, joint).ok()?;
        let proposal = search_sharp_near(&with_values, &proposal).ok()?;
        Some(Reduced { spec, proposal, alternatives: Alternatives::default(), others: Vec::new(), near: None })
    }
}

/// D_x and D_e.
fn radii(at: &AtSigma) -> [f64; 2] {
    [at.d_x, active_level(at.eta, at.dist_e, at.rho).sqrt()]
}

/// The inequality with short numbers, and so much of the margins.
fn inequality([x, e]: [f64; 2], value: f64, metrics: &[FloatMetric; 2], share: f64) -> Option<JointInequality> {
    let up = |value: f64| round_f64(value, DIGITS, Direction::Up);
    let [near, far] = metrics.each_ref().map(|metric| rounded(metric, share));
    Some(JointInequality { x: up(x)?, e: up(e)?, value: up(value)?, near: near?, far: far? })
}

fn rounded(FloatMetric { p, cross, weight, k_p, margins }: &FloatMetric, share: f64) -> Option<Metric> {
    let short = |value: f64| round_f64(value, DIGITS, Direction::Nearest);
    let row = |row: &Vec<f64>| row.iter().map(|entry| short(*entry)).collect::<Option<Vec<Rational>>>();
    let [c_x, c_e, c_y] = margins.map(|margin| round_f64(margin * share, 4, Direction::Down));
    Some(Metric {
        matrix: p.iter().map(row).collect::<Option<_>>()?,
        cross: row(cross)?,
        weight: short(*weight)?,
        k_p: short(*k_p)?,
        c_x: c_x?,
        c_e: c_e?,
        c_y: c_y?,
    })
}

/// The joint inequality with this share of its margins c_x, c_e and c_y, rounded down.
fn weakened(inequality: &JointInequality, share: f64) -> Option<JointInequality> {
    let share = Rational::from_f64(share)?;
    let weaker = |metric: &Metric| {
        let [c_x, c_e, c_y] = [&metric.c_x, &metric.c_e, &metric.c_y]
            .map(|margin| round_f64(Rational::from(margin * &share).to_f64(), 4, Direction::Down));
        Some(Metric { c_x: c_x?, c_e: c_e?, c_y: c_y?, ..metric.clone() })
    };
    Some(JointInequality { near: weaker(&inequality.near)?, far: weaker(&inequality.far)?, ..inequality.clone() })
}

/// What solvers leave of a constraint.
const SOLVED: f64 = 1e-6;

fn level(FloatLevel { p_up, x_low, e_low }: FloatLevel) -> Option<Level> {
    let low = |value: f64| round_f64(value * (1.0 - SOLVED), DIGITS, Direction::Down);
    Some(Level {
        p_up: round_f64(p_up * (1.0 + SOLVED), DIGITS, Direction::Up)?,
        x_low: low(x_low)?,
        e_low: low(e_low)?,
    })
}
