//! The search for the law at samples: a witness at one sigma and h, and the smallest sigma with one (derivation, 12).
//!
//! Nothing is monotone here: too small a sigma does not hold the plant, too large a one asks too much of a sample. So sigma is
//! scanned from below up to 1/h, and refined where the scan changes its mind.

use super::box_at_samples::error_box_at_samples;
use super::candidate::{AtSigma, PastShare, Shape};
use super::effort::ROOM;
use super::error_box::{best_shape, shape_near};
use super::floors::{ordinary, raised, tiny};
use super::form_radius::radius;
use super::model::FloatModel;
use super::obstacle::{Closest, Failing, Obstacle};
use super::periodic::{Floors, PeriodicSet};
use super::reach::{Largest, Law, largest, start_distances, weighed};
use super::sharp::search_sharp;
use rug::Rational;
use sigmastar_exact::number::Portable;
use sigmastar_exact::parallel;
use sigmastar_theory::derivation::harmonics::AtOrigin;
use sigmastar_theory::derivation::sampled::{DecayForms, DecayNumbers, Part, SampledGains, SampledLaw};

/// Where an error box is open although a distance is 0.
const FLOOR: f64 = 1e-6;

/// The odds of the share of eta that serves the last y: so many, a factor exp(2) apart, up to exp(4); then a section.
const ODDS: u32 = 10;
const ODDS_STEP: f64 = 2.0;
const HALVINGS: u32 = 5;

/// Points of the scan of sigma.
const POINTS: u32 = 48;

/// How far below the gain of the continuous-time law the scan begins: its sets are smaller; with an uncertain input gain that has to serve
/// every larger one, too, and bounds all harmonics by one number.
const BELOW: f64 = 0.98;
const BELOW_UNCERTAIN: f64 = 0.8;

/// Steps of a bisection of ln sigma.
const STEPS: u32 = 34;

/// The radius of the forms has to be below 1 by this much, for rounding.
pub(super) const LARGEST: f64 = 1.0 - 1e-8;

/// By how much more a gain near a known one is tried.
const LARGER: [f64; 8] = [0.0, 1e-5, 1e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1];

/// The share of the room below 1 that a set of ordinary size may cost.
const COST: f64 = 0.1;

/// The free numbers at one sigma, from which all others follow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampledProposal {
    /// sigma.
    pub sigma: f64,
    /// The smallest X_p and E_p.
    pub floors: Floors,
    /// rho > 1 with D_x = rho c dX.
    pub rho: f64,
    /// eta > 0: the weight of zeta is so many times dE^2/dZ^2.
    pub eta: f64,
    /// The larger radius of the two forms, below 1; the margin is what is left.
    pub radius: f64,
}

impl SampledProposal {
    /// Whether the gain is smaller, or the same with more room.
    #[must_use]
    pub fn better_than(&self, other: &SampledProposal) -> bool {
        self.sigma < other.sigma || (self.sigma == other.sigma && self.radius < other.radius)
    }
}

/// What came of one gain of a scan.
#[derive(Clone, Copy, Debug)]
pub struct ScanPoint {
    /// sigma.
    pub sigma: f64,
    /// The radius, or what stands in the way.
    pub outcome: Result<f64, Obstacle>,
}

/// The search for one law.
pub struct SampledSearch<'m> {
    pub(super) model: &'m FloatModel,
    pub(super) law: SampledLaw<f64>,
    origin: AtOrigin<f64>,
}

impl<'m> SampledSearch<'m> {
    /// Of a model whose pairs (k0, k1) are those of the law.
    #[must_use]
    pub fn new(model: &'m FloatModel, law: SampledLaw<f64>) -> SampledSearch<'m> {
        SampledSearch { model, law, origin: AtOrigin::new(model) }
    }

    /// The smallest set and the best error box at sigma, with so much room in S1 and S2; near a shape where one is given.
    ///
    /// # Errors
    /// The obstacle where there is none; the radius may still be 1 or larger.
    pub fn at(
        &self,
        sigma: f64,
        floors: Floors,
        near: Option<(f64, f64)>,
        room: f64,
    ) -> Result<(PeriodicSet, AtSigma), Obstacle> {
        let share = 3.0 * self.law.lost();
        if self.law.delayed && (share.is_nan() || share >= 1.0) {
            return Err(Failing::Delay { share }.into());
        }
        let set = PeriodicSet::least_sampled(self.model, &self.origin, (&self.law, sigma), floors, room)?;
        let distances = self.distances(&set);
        let evaluate = |rho: f64, eta: f64| self.evaluate(sigma, &set, distances, (rho, eta));
        let near = near.and_then(|shape| shape_near(self.model, evaluate, shape));
        let at = match near {
            Some(at) => at,
            None => best_shape(self.model, evaluate)?,
        };
        Ok((set, at))
    }

    /// The smallest set at sigma with so much room in S1 and S2, and the best error box near the shape (rho, eta), or at that shape alone
    /// where it is not `refined`. `None` where there is none; the radius may still be 1 or larger.
    #[must_use]
    pub fn near_shape(
        &self,
        (sigma, floors): (f64, Floors),
        (rho, eta): (f64, f64),
        room: f64,
        refined: bool,
    ) -> Option<(PeriodicSet, AtSigma)> {
        let set = PeriodicSet::least_sampled(self.model, &self.origin, (&self.law, sigma), floors, room).ok()?;
        let distances = self.distances(&set);
        let evaluate = |rho: f64, eta: f64| self.evaluate(sigma, &set, distances, (rho, eta));
        let at = if refined { shape_near(self.model, evaluate, (rho, eta)) } else { evaluate(rho, eta).ok() };
        Some((set, at?))
    }

    /// dX, dE, dZ, and with a delay sqrt(h) (Y_0 + y_per) for Y_0 = E_0/h: at rest nothing is predicted.
    fn distances(&self, set: &PeriodicSet) -> ([f64; 3], Option<f64>) {
        let distances = start_distances(self.model, set);
        let past = self.law.delayed.then(|| {
            let e_0 = self.model.required_set(set.x_p, set.e_p, set.z).e0;
            let step = self.law.step;
            ((e_0 + step * set.y_per) / step.sqrt()).max(FLOOR * distances[1] / step.sqrt())
        });
        (distances, past)
    }

    fn evaluate(
        &self,
        sigma: f64,
        set: &PeriodicSet,
        (distances, past): ([f64; 3], Option<f64>),
        shape: (f64, f64),
    ) -> Result<AtSigma, Obstacle> {
        let at = self.error_box(sigma, set, (distances, past), shape)?;
        weighed(self.model, at, distances, self.gains(sigma), LARGEST)
    }

    /// What multiplies what in the control.
    fn gains(&self, sigma: f64) -> Law {
        let past = self.law.delayed.then_some([self.law.step, self.law.weight_sum]);
        Law { gains: [sigma, self.law.gain], past }
    }

    fn error_box(
        &self,
        sigma: f64,
        set: &PeriodicSet,
        (distances, past): ([f64; 3], Option<f64>),
        (rho, eta): (f64, f64),
    ) -> Result<AtSigma, Obstacle> {
        if let Some(known) = &self.model.at_samples.stability {
            let shape = ((rho, eta), sigma);
            return error_box_at_samples(known, self.model, (set.x_per, set.e_per), distances, shape);
        }
        let [_, dist_e, _] = distances;
        Shape::best(self.model, (set.x_per, set.e_per), distances, (rho, eta), |shape| {
            let radius_with = |shape: &Shape, gm: f64| {
                let forms = self.forms(sigma, (shape, gm), None);
                if forms.within.is_nan() || forms.within <= 0.0 {
                    return Err(Failing::Sampling.at(shape.error_box.x_b, shape.error_box.e_b));
                }
                let coupled = Failing::Coupling.at(shape.error_box.x_b, shape.error_box.e_b);
                let radius = radius(&forms.start).zip(radius(&forms.end)).ok_or(coupled)?;
                // Where nothing is coupled the radius is 0, which has no logarithm.
                Ok(radius.0.max(radius.1).max(1e-300))
            };
            let (past, threshold) = match past {
                None => (None, radius_with(&shape, 0.0)?),
                Some(distance) => {
                    let (past, threshold) = best_share(distance, |past| {
                        let weight = shape.weight * (1.0 - past.share);
                        radius_with(&Shape { weight, ..shape.clone() }, past.weight(eta, dist_e))
                    })?;
                    (Some(past), threshold)
                }
            };
            Ok(AtSigma { past, ..AtSigma::new((rho, eta), shape.d_x, distances, shape.paths, threshold) })
        })
    }

    /// The forms of a shape, with the weight gm of the last y where there is a delay.
    pub(super) fn forms(&self, sigma: f64, (shape, gm): (&Shape, f64), without: Option<Part>) -> DecayForms<f64> {
        let Shape { w_x, weight, error_box, .. } = shape;
        let numbers = DecayNumbers { law: &self.law, sigma: &sigma, w_x, eta: weight, gm: &gm };
        DecayForms::without(self.model, error_box, &numbers, without)
    }

    fn proposal(&self, sigma: f64, floors: Floors, near: Option<(f64, f64)>) -> Result<SampledProposal, Obstacle> {
        let (_, at) = self.at(sigma, floors, near, ROOM)?;
        Ok(SampledProposal { sigma, floors, rho: at.rho, eta: at.eta, radius: at.threshold })
    }

    /// The best witness at sigma; where the shapes of a scan have none, one near that of the smallest sigma.
    ///
    /// # Errors
    /// What stands in the way.
    pub fn at_gain(&self, sigma: f64) -> Result<SampledProposal, Obstacle> {
        self.model.in_range()?;
        let refused = match self.proposal(sigma, tiny(self.model), None) {
            Ok(found) if found.radius <= LARGEST => return Ok(self.with_ordinary_floors(found)),
            Ok(_) => Failing::Sampling.into(),
            Err(obstacle) => obstacle,
        };
        let smallest = self.smallest().ok().filter(|smallest| smallest.sigma <= sigma).ok_or(refused)?;
        self.near(&smallest, Some(sigma)).map_err(|_| refused)
    }

    /// What is bounded at the gain of a proposal.
    ///
    /// # Errors
    /// What stands in the way.
    pub fn largest_at(
        &self,
        SampledProposal { sigma, floors, rho, eta, .. }: &SampledProposal,
    ) -> Result<Largest, Obstacle> {
        let (set, at) = self.at(*sigma, *floors, Some((*rho, *eta)), ROOM)?;
        let gains = SampledGains::new(&self.law, sigma, &self.model.period);
        let answer = self.law.answer(sigma, &self.model.period, &gains.means);
        Ok(largest(self.model, &self.origin, &answer, self.gains(*sigma), (&set, &at)))
    }

    /// A proposal near the shape of a known one, at the gain that is given, or at one that is hardly larger than the known one. It serves
    /// where the bounding functions are known near that shape alone.
    ///
    /// # Errors
    /// What stands in the way.
    pub fn near(&self, known: &SampledProposal, gain: Option<f64>) -> Result<SampledProposal, Obstacle> {
        let SampledProposal { sigma, floors, rho, eta, .. } = *known;
        let largest = self.law.step.recip();
        // A matrix inequality is proved at one gain.
        let gains: Vec<f64> = match gain.or_else(|| self.model.at_samples.gain().map(Rational::to_f64)) {
            Some(gain) => vec![gain],
            None => LARGER.map(|share| (sigma * (1.0 + share)).min(largest)).to_vec(),
        };
        let mut closest = Closest::default();
        for sigma in gains {
            match self.proposal(sigma, floors, Some((rho, eta))) {
                Ok(found) if found.radius <= LARGEST => return Ok(found),
                Ok(_) => closest.record(Failing::Sampling.into()),
                Err(obstacle) => closest.record(obstacle),
            }
        }
        closest.or(None)
    }

    /// The smallest sigma up to 1/h that is found.
    ///
    /// # Errors
    /// What stands in the way of the gain that came closest.
    pub fn smallest(&self) -> Result<SampledProposal, Obstacle> {
        let below = if self.model.input_gain.is_some() { BELOW_UNCERTAIN } else { BELOW };
        let continuous = search_sharp(self.model)?.sigma;
        let (start, end) = (continuous * below, self.law.step.recip());
        if start >= end {
            return Err(Failing::Hold { sigma: continuous, largest: end, given: false }.into());
        }
        let points = self.scan(start, end);
        let feasible = |point: &ScanPoint| point.outcome.is_ok_and(|radius| radius <= LARGEST);
        let Some(index) = points.iter().position(feasible) else {
            return self.between_points(&points);
        };
        let mut best = self.proposal(points[index].sigma, tiny(self.model), None)?;
        if index > 0 {
            best = self.bisect(points[index - 1].sigma, best);
        }
        Ok(self.with_ordinary_floors(best))
    }

    /// The gains of a scan, from `start` to `end`.
    #[must_use]
    pub fn scan(&self, start: f64, end: f64) -> Vec<ScanPoint> {
        let ratio = (end / start).portable_ln() / f64::from(POINTS - 1);
        // The last one exactly, where h sigma = 1.
        let at = |k: u32| if k == POINTS - 1 { end } else { start * (ratio * f64::from(k)).portable_exp() };
        let gains: Vec<f64> = (0..POINTS).map(at).collect();
        parallel::map(&gains, |&sigma| ScanPoint {
            sigma,
            outcome: self.proposal(sigma, tiny(self.model), None).map(|found| found.radius),
        })
    }

    /// The smallest sigma between one that is not feasible and one that is.
    fn bisect(&self, below: f64, found: SampledProposal) -> SampledProposal {
        let (mut low, mut best) = (below, found);
        for _ in 0..STEPS {
            let middle = (low * best.sigma).sqrt();
            let near = Some((best.rho, best.eta));
            match self.proposal(middle, tiny(self.model), near) {
                Ok(found) if found.radius <= LARGEST => best = found,
                _ => low = middle,
            }
        }
        best
    }

    /// Where no point of the scan is feasible: the best of them, refined.
    fn between_points(&self, points: &[ScanPoint]) -> Result<SampledProposal, Obstacle> {
        let radius = |point: &ScanPoint| point.outcome.unwrap_or(f64::INFINITY);
        let best = points.iter().enumerate().min_by(|a, b| radius(a.1).total_cmp(&radius(b.1)));
        let Some((index, best)) = best.filter(|(_, point)| point.outcome.is_ok()) else {
            let mut closest = Closest::default();
            points.iter().filter_map(|point| point.outcome.err()).for_each(|obstacle| closest.record(obstacle));
            return closest.or(None);
        };
        let low = points.get(index.wrapping_sub(1)).map_or(best.sigma, |point| point.sigma);
        let high = points.get(index + 1).map_or(best.sigma, |point| point.sigma);
        let fine = self.scan(low, high);
        let feasible = |point: &&ScanPoint| point.outcome.is_ok_and(|radius| radius <= LARGEST);
        let found = fine.iter().find(feasible).ok_or(Failing::Sampling)?;
        Ok(self.with_ordinary_floors(self.bisect(low, self.proposal(found.sigma, tiny(self.model), None)?)))
    }

    /// With X_p and E_p of an ordinary size where nothing asks for one, as far as that costs little.
    fn with_ordinary_floors(&self, found: SampledProposal) -> SampledProposal {
        let allowed = (1.0 - (1.0 - COST) * (1.0 - found.radius)).min(LARGEST);
        let size = |floors: Floors, best: &SampledProposal| {
            self.at(best.sigma, floors, Some((best.rho, best.eta)), ROOM).map(|(set, _)| [set.x_p, set.e_p])
        };
        let again = |floors: Floors, best: &SampledProposal| {
            self.proposal(best.sigma, floors, None).ok().filter(|larger| larger.radius <= allowed)
        };
        // Without a size at all it is taken as it is.
        raised((found.floors, found), ordinary(self.model), size, again).map_or(found, |(_, best)| best)
    }
}

/// The share of eta that serves the last y best, for which `radius` is least: a scan over its odds, then a section.
///
/// # Errors
/// What stands in the way of every share.
fn best_share(
    distance: f64,
    radius: impl Fn(PastShare) -> Result<f64, Obstacle>,
) -> Result<(PastShare, f64), Obstacle> {
    // Odds exp(t).
    let share_at = |t: f64| PastShare { share: 1.0 / (1.0 + (-t).portable_exp()), distance };
    let mut closest = Closest::default();
    let mut best: Option<(f64, f64)> = None;
    let mut look = |t: f64, best: &mut Option<(f64, f64)>| match radius(share_at(t)) {
        Ok(found) if best.is_none_or(|(_, least)| found < least) => *best = Some((t, found)),
        Ok(_) => {}
        Err(obstacle) => closest.record(obstacle),
    };
    for k in 0..ODDS {
        look(ODDS_STEP * (f64::from(k) - f64::from(ODDS - 3)), &mut best);
    }
    let mut step = ODDS_STEP;
    for _ in 0..HALVINGS {
        step /= 2.0;
        let Some((middle, _)) = best else { break };
        look(middle - step, &mut best);
        look(middle + step, &mut best);
    }
    closest.or(best).map(|(t, radius)| (share_at(t), radius))
}
