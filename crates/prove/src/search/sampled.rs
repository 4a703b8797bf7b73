//! The search for the law at samples: a witness at one sigma and h, and the smallest sigma with one (derivation, 12).
//!
//! Nothing is monotone here: too small a sigma does not hold the plant, too large a one asks too much of a sample. So sigma is
//! scanned from below up to 1/h, and refined where the scan changes its mind.

use super::box_at_samples::error_box_at_samples;
use super::candidate::{AtSigma, PastShare, Shape};
use super::effort::ROOM;
use super::error_box::{best_shape, shape_near};
use super::floors::{ordinary, raised, tiny};
use super::model::FloatModel;
use super::obstacle::{Closest, Failing, Obstacle};
use super::periodic::{Floors, PeriodicSet};
use super::reach::{Largest, Law, largest, start_distances, weighed};
use super::scan;
use super::sharp::search_sharp;
use rug::Rational;
use sigmastar_exact::number::Portable;
use sigmastar_theory::derivation::harmonics::AtOrigin;
use sigmastar_theory::derivation::sampled::{DecayForms, DecayNumbers, Form, Part, Past, SampledGains, SampledLaw};

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
const LARGEST: f64 = 1.0 - 1e-8;

/// By what share a gain would have to be smaller without what the sampling does, for a part of that to limit it; how far down gains
/// without a part are sought, and in how many steps.
const WORTH_SAYING: f64 = 0.05;
const LEAST_SHARE: f64 = 0.1;
const SHARE_STEPS: usize = 10;

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

/// What keeps the sampling period, or the gain, from being better.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SampledLimit {
    /// S2.
    Existence,
    /// Q_0, which the continuous-time law has too.
    Continuous,
    /// theta in Q_h.
    Theta,
    /// h sigma in Q_h.
    Hold,
    /// h k_e and h k_x in Q_h.
    Motion,
    /// The matrix inequality, which is in the place of Q_0 and Q_h.
    Matrix,
}

impl SampledLimit {
    /// Its name in JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            SampledLimit::Existence => "existence",
            SampledLimit::Continuous => "gain",
            SampledLimit::Theta => "theta",
            SampledLimit::Hold => "hold",
            SampledLimit::Motion => "motion",
            SampledLimit::Matrix => "matrix",
        }
    }

    /// What it is, and what helps.
    #[must_use]
    pub fn describe(self) -> &'static str {
        match self {
            SampledLimit::Existence => "S2: the periodic solution; a shorter sampling period or a larger gain helps",
            SampledLimit::Continuous => {
                "Q_0: the gain itself, as norms have it in continuous time; a larger one, where h sigma <= 1 allows it, or sharper data help"
            }
            SampledLimit::Theta => {
                "theta = h mu Nbar^2/2 in Q_h: what the oscillators lose to the sampling; a smaller mu or a shorter sampling \
                 period helps"
            }
            SampledLimit::Hold => {
                "h sigma in Q_h: e is held over a sample; a shorter sampling period or a smaller gain helps"
            }
            SampledLimit::Motion => {
                "h dq/de and h dq/dx in Q_h: what moves within a sample; a shorter sampling period or a smaller initial set helps"
            }
            SampledLimit::Matrix => {
                "the matrix inequality over the derivatives: a larger gain, a shorter sampling period or a smaller initial set helps"
            }
        }
    }
}

/// The search for one law.
pub struct SampledSearch<'m> {
    model: &'m FloatModel,
    law: SampledLaw<f64>,
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

    /// The same near a shape alone; at it alone where it is not `refined`.
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
        let [_, dist_e, dist_z] = distances;
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
            Ok(AtSigma {
                rho,
                eta,
                d_x: shape.d_x,
                dist_e,
                dist_z,
                paths: shape.paths,
                past,
                threshold,
                cost: threshold,
            })
        })
    }

    /// The forms of a shape, with the weight gm of the last y where there is a delay.
    fn forms(&self, sigma: f64, (shape, gm): (&Shape, f64), without: Option<Part>) -> DecayForms<f64> {
        let Shape { w_x, weight, error_box, .. } = shape;
        let numbers = DecayNumbers { law: &self.law, sigma: &sigma, w_x, eta: weight, gm: &gm };
        DecayForms::without(self.model, error_box, &numbers, without)
    }

    fn proposal(&self, sigma: f64, floors: Floors, near: Option<(f64, f64)>) -> Result<SampledProposal, Obstacle> {
        let (_, at) = self.at(sigma, floors, near, ROOM)?;
        Ok(SampledProposal { sigma, floors, rho: at.rho, eta: at.eta, radius: at.threshold })
    }

    /// The best witness at sigma.
    ///
    /// # Errors
    /// What stands in the way.
    pub fn at_gain(&self, sigma: f64) -> Result<SampledProposal, Obstacle> {
        self.model.in_range()?;
        let found = self.proposal(sigma, tiny(self.model), None)?;
        if found.radius > LARGEST {
            return Err(Failing::Sampling.into());
        }
        Ok(self.with_ordinary_floors(found))
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

    /// The same shape as a known one, where the bounding functions are known near it alone: at the gain that is given, or at
    /// one that is hardly larger than the known one.
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
        let start = search_sharp(self.model)?.sigma * below;
        let end = self.law.step.recip();
        if start >= end {
            return Err(Failing::Hold { sigma: start, largest: end, given: false }.into());
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
        scan::evaluate_all(&gains, |&sigma| ScanPoint {
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

    /// What limits a witness: the part of the forms without which the smallest gain would be least. Where a gain that is smaller by a share
    /// that matters would not do in continuous time either, it is the gain itself; where it has no periodic solution, that; where the given
    /// one does with room, the part without which there would be most.
    #[must_use]
    pub fn limit(&self, proposal: &SampledProposal) -> SampledLimit {
        const PARTS: [(Part, SampledLimit); 3] = [
            (Part::Theta, SampledLimit::Theta),
            (Part::Hold, SampledLimit::Hold),
            (Part::Motion, SampledLimit::Motion),
        ];
        if self.model.at_samples.stability.is_some() {
            return SampledLimit::Matrix;
        }
        let given = proposal.sigma;
        let smaller = given * (1.0 - WORTH_SAYING);
        if search_sharp(self.model).is_ok_and(|found| smaller < found.sigma) {
            return SampledLimit::Continuous;
        }
        let Some([_, end]) = self.radii(smaller, proposal, None) else { return SampledLimit::Existence };
        // No gain is above 1/h.
        if end <= LARGEST && given * self.law.step > 1.0 - 1e-6 {
            return SampledLimit::Hold;
        }
        let cost = |part: Part| {
            if end <= LARGEST {
                return self.radii(given, proposal, Some(part)).map_or(f64::INFINITY, |[_, end]| end);
            }
            let does = |sigma: f64| {
                let radii = self.radii(sigma, proposal, Some(part));
                radii.is_some_and(|radii| radii.iter().all(|radius| *radius <= LARGEST))
            };
            let (mut below, mut above) = (given * LEAST_SHARE, given);
            for _ in 0..SHARE_STEPS {
                let middle = (below * above).sqrt();
                if does(middle) { above = middle } else { below = middle }
            }
            above
        };
        let costs = PARTS.map(|(part, limit)| (cost(part), limit));
        costs.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).map_or(SampledLimit::Continuous, |(_, limit)| limit)
    }

    /// The radii of the forms near the shape of a proposal, at another gain and without a part; `None` where that gain has no periodic
    /// solution.
    fn radii(&self, sigma: f64, near: &SampledProposal, without: Option<Part>) -> Option<[f64; 2]> {
        let (set, at) = self.at(sigma, near.floors, Some((near.rho, near.eta)), ROOM).ok()?;
        let shape = Shape::of(self.model, (set.x_per, set.e_per), &at);
        let gm = at.past.map_or(0.0, |past| past.weight(at.eta, at.dist_e));
        let forms = self.forms(sigma, (&shape, gm), without);
        Some([&forms.start, &forms.end].map(|form| radius(form).unwrap_or(f64::INFINITY)))
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

/// The spectral radius of what is off the diagonal of a form that is scaled to 1 on it: below 1 if and only if the form is
/// positive definite. `None` where the diagonal is not positive.
fn radius(form: &Form<f64>) -> Option<f64> {
    let Form { xx, ee, yy, xe, xy, ey, past } = form;
    if let Some(Past { pp, xp, ep, yp }) = past {
        return radius_of_four([xx, ee, yy, pp], [[xe, yp], [xy, ep], [ey, xp]]);
    }
    if ![xx, ee, yy].iter().all(|value| **value > 0.0 && value.is_finite()) {
        return None;
    }
    let [a, b, c] = [xe / (2.0 * (xx * ee).sqrt()), xy / (2.0 * (xx * yy).sqrt()), ey / (2.0 * (ee * yy).sqrt())];
    let squares = a * a + b * b + c * c;
    if squares == 0.0 {
        return Some(0.0);
    }
    // The largest root of r^3 - squares r - 2abc, by Newton's method from above.
    let mut r = 2.0 * (squares / 3.0).sqrt();
    for _ in 0..60 {
        let step = (r * r * r - squares * r - 2.0 * a * b * c) / (3.0 * r * r - squares);
        r -= step;
        if step.is_nan() || step.abs() <= 1e-15 * r {
            break;
        }
    }
    r.is_finite().then_some(r)
}

/// The same in four variables. `pairs` are what is off the diagonal, each with the one that shares no variable with it.
fn radius_of_four(diagonal: [&f64; 4], pairs: [[&f64; 2]; 3]) -> Option<f64> {
    if !diagonal.iter().all(|value| **value > 0.0 && value.is_finite()) {
        return None;
    }
    let [x, e, y, p] = diagonal.map(|value| value.sqrt());
    let scaled = |value: &f64, scale: f64| value / (2.0 * scale);
    let [[xe, yp], [xy, ep], [ey, xp]] = pairs;
    let [xe, yp, xy] = [scaled(xe, x * e), scaled(yp, y * p), scaled(xy, x * y)];
    let [ep, ey, xp] = [scaled(ep, e * p), scaled(ey, e * y), scaled(xp, x * p)];
    let squares: f64 = [xe, yp, xy, ep, ey, xp].iter().map(|value| value * value).sum();
    if squares == 0.0 {
        return Some(0.0);
    }
    let triangles = xe * ey * xy + xe * ep * xp + xy * yp * xp + ey * yp * ep;
    let [a, b, c] = [xe * yp, xy * ep, ey * xp];
    let determinant = a * a + b * b + c * c - 2.0 * (a * b + a * c + b * c);
    // The largest root of r^4 - squares r^2 - 2 triangles r + determinant, by Newton's method from above: the squares of all four add up
    // to 2 squares, and their sum is 0.
    let mut r = (1.5 * squares).sqrt();
    for _ in 0..60 {
        let value = ((r * r - squares) * r - 2.0 * triangles) * r + determinant;
        let step = value / ((4.0 * r * r - 2.0 * squares) * r - 2.0 * triangles);
        r -= step;
        if step.is_nan() || step.abs() <= 1e-15 * r {
            break;
        }
    }
    r.is_finite().then_some(r)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers in [0, 1), the same ones each time.
    fn numbers(mut state: u64) -> impl FnMut() -> f64 {
        move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / 2f64.powi(24)
        }
    }

    /// In four variables too.
    #[test]
    fn the_radius_of_four_tells_definite_forms_apart() {
        let mut next = numbers(9);
        let mut seen = [0; 2];
        for _ in 0..4000 {
            let scale = 0.2 + next();
            let past = Past { pp: next() + 0.1, xp: scale * next(), ep: scale * next(), yp: scale * next() };
            let [xe, xy, ey] = [0; 3].map(|_| scale * next());
            let [xx, ee, yy] = [0; 3].map(|_| next() + 0.1);
            let form = Form { xx, ee, yy, xe, xy, ey, past: Some(past) };
            let definite = form.minors().iter().all(|minor| *minor > 0.0);
            let radius = radius(&form).unwrap();
            if (radius - 1.0).abs() > 1e-9 {
                assert_eq!(radius < 1.0, definite, "{form:?} {radius}");
                seen[usize::from(definite)] += 1;
            }
        }
        assert!(seen.iter().all(|count| *count > 500), "{seen:?}");
    }

    #[test]
    fn the_radius_tells_definite_forms_apart() {
        let mut next = numbers(7);
        let mut seen = [0; 2];
        for _ in 0..4000 {
            let form = Form {
                xx: next() + 0.1,
                ee: next() + 0.1,
                yy: next() + 0.1,
                xe: next(),
                xy: next(),
                ey: next(),
                past: None,
            };
            let definite = form.minors().iter().all(|minor| *minor > 0.0);
            let radius = radius(&form).unwrap();
            if (radius - 1.0).abs() > 1e-9 {
                assert_eq!(radius < 1.0, definite, "{form:?} {radius}");
                seen[usize::from(definite)] += 1;
            }
        }
        assert!(seen.iter().all(|count| *count > 500), "{seen:?}");
        let free = Form { xx: 1.0, ee: 2.0, yy: 3.0, xe: 0.0, xy: 0.0, ey: 0.0, past: None };
        assert_eq!(radius(&free), Some(0.0));
        assert_eq!(radius(&Form { yy: -1.0, ..free }), None);
    }
}
