//! How far e and u go from the initial set, and what an error box costs by that, in floating point (derivation, 13.5).

use super::candidate::{AtSigma, active_level, weight_h};
use super::goal::Goal;
use super::model::FloatModel;
use super::obstacle::{Failing, Obstacle};
use super::periodic::PeriodicSet;
use super::threshold::ByMatrix;
use rug::Rational;
use sigmastar_exact::number::Portable;
use sigmastar_theory::derivation::control::{self, Answer};
use sigmastar_theory::derivation::harmonics::AtOrigin;
use sigmastar_theory::derivation::initial_set::distances;
use sigmastar_theory::derivation::mean_squares::{Forcing, SetBounds};

/// The smallest distance of the initial set from the periodic solution, as a share of the latter's size.
const FLOOR: f64 = 1e-6;

/// dX, dE, dZ of the required set from a periodic solution, kept away from 0: a larger distance only strengthens C4. dZ is that of
/// [`FloatModel::weighed`].
#[must_use]
pub fn start_distances(model: &FloatModel, set: &PeriodicSet) -> [f64; 3] {
    let start = model.required_set(set.x_p, set.e_p, set.z);
    let [x, e, z] = distances(model, &start, [&set.x_per, &set.e_per, &set.z]);
    let e = e.max(FLOOR * set.e_p);
    [x.max(FLOOR * set.x_p), e, model.weighed(z.max(FLOOR * model.n_bar * e))]
}

/// How far the threshold stays below the gain where it is not what is made small, for rounding; what is proved with its weights is not moved.
const BELOW: f64 = 1.0 - 1e-6;

/// What e and u may go further for x to go e times less far, as a share.
const OF_STATES: f64 = 1e-3;

/// What multiplies what in the control.
#[derive(Clone, Copy, Debug)]
pub(super) struct Law {
    /// The gain that multiplies e, and the one that multiplies M'N zeta: mu, or at samples K.
    pub gains: [f64; 2],
    /// h and Nb2, where the last y is in the control: with a delay (derivation, 13.4).
    pub past: Option<[f64; 2]>,
}

impl Law {
    /// That of the regulator in continuous time.
    pub fn continuous(sigma: f64, model: &FloatModel) -> Law {
        Law { gains: [sigma, model.mu], past: None }
    }
}

/// The candidate with what it costs; `least` is what its threshold has to be below.
///
/// # Errors
/// That the threshold is not below.
pub(super) fn weighed(
    model: &FloatModel,
    at: AtSigma,
    distances: [f64; 3],
    law: Law,
    least: f64,
) -> Result<AtSigma, Obstacle> {
    let moves = model.by_matrix.is_none() && model.at_samples.stability.is_none();
    let largest = if moves { least * BELOW } else { least };
    let cost = match model.goal {
        Goal::Threshold => return Ok(at),
        _ if at.threshold.is_nan() || at.threshold > largest => {
            return Err(Failing::Gain { given: law.gains[0], smallest: None }.into());
        }
        Goal::Control => reach(model, &at, distances, law).transient,
        Goal::Peak => reach(model, &at, distances, law).error,
    };
    // Where x hardly acts on e any box of x serves, and it shall not be larger than it needs to be.
    let cost = cost * (1.0 + OF_STATES * at.rho.portable_ln());
    if cost.is_finite() { Ok(AtSigma { cost, ..at }) } else { Err(Failing::NotFinite(None).into()) }
}

/// How far e and u go from those of the periodic solution, from the initial set.
pub(super) fn reach(model: &FloatModel, at: &AtSigma, distances: [f64; 3], law: Law) -> control::Reach<f64> {
    let [sigma, gain] = law.gains;
    if let (Some(ByMatrix::Joint(joint)), Some(sigma)) = (&model.by_matrix, Rational::from_f64(sigma)) {
        let [x, e, z] = &distances;
        return control::joint_reach(model, joint, Rational::to_f64, &sigma, [x, e, z]);
    }
    let of_zeta = at.past.map_or(at.eta, |past| at.eta * (1.0 - past.share));
    let (level, h) = (active_level(at.eta, at.dist_e, at.rho), weight_h(of_zeta, at.dist_e, at.dist_z));
    let past = law
        .past
        .zip(at.past)
        .map(|([step, sum], past)| control::of_past([&sigma, &gain], [&step, &sum], &past.weight(at.eta, at.dist_e)));
    // At the gain b the weight of zeta is b h, by a matrix inequality below its threshold less.
    let share = if model.by_matrix.is_some() { at.threshold / sigma } else { 1.0 };
    let least = model.input_gain.as_ref().map_or(h, |known| known.low * h * share);
    control::reach(model, [&sigma, &gain], &least, (&level, past.as_ref()))
}

/// The largest |u| of the law and the largest |e| on the way from the initial set, of a candidate.
pub(super) fn largest(
    model: &FloatModel,
    origin: &AtOrigin<f64>,
    answer: &Answer<f64>,
    law: Law,
    (set, at): (&PeriodicSet, &AtSigma),
) -> Largest {
    let bounds = SetBounds::new(model, set.x_p, set.e_p);
    let forcing = Forcing::new(&bounds, origin, set.refined.as_ref().unwrap_or(&set.squares));
    let by_parts = control::by_parts(model, law.gains.each_ref(), [&set.e_per, &set.z]);
    let reach = reach(model, at, start_distances(model, set), law);
    let control = answer.steady(origin, &forcing, &by_parts) + reach.transient;
    Largest { control, steady_error: set.e_per, peak_error: set.e_per + reach.error }
}

/// What is bounded at one gain, in floating point.
#[derive(Clone, Copy, Debug)]
pub struct Largest {
    /// |u| of the law, at all times.
    pub control: f64,
    /// |e| along the periodic solution.
    pub steady_error: f64,
    /// |e| at all times.
    pub peak_error: f64,
}
