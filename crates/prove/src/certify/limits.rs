//! The smallest gain that is found with which bounds are kept (derivation, 13.5): of |e| and of what is put out.

use super::options::Limits;
use super::round::rounded_sigma;
use rug::Rational;
use sigmastar_exact::number::Portable;
use sigmastar_lang::spec::{Actuator, Constant, Specification};
use sigmastar_propose::search::{Failing, Goal, Largest, Limited, Obstacle};

/// What a claim is to keep to in floating point, with what the actuator takes.
#[derive(Clone, Copy, Debug)]
pub(super) struct FloatLimits {
    limits: [(Limited, Option<f64>); 4],
    /// What the control of the law is divided by.
    nominal: f64,
    /// The limit of |e| on the way and E0, where the set has |e| above that limit at the start.
    beyond: Option<[f64; 2]>,
}

/// The gains of a search, over the smallest one.
const SHARES: [f64; 15] = [1.0, 1.02, 1.05, 1.1, 1.2, 1.35, 1.5, 1.75, 2.0, 2.5, 3.0, 4.0, 5.0, 7.0, 10.0];

/// So many doublings more: all of them where only bounds are asked for that fall with the gain, else while what is missed falls.
const DOUBLINGS: i32 = 40;

/// Steps of the bisection between a gain that does not do and one that does.
const STEPS: usize = 12;

/// By how much more rounding may make a gain.
pub(super) const NEAR: f64 = 1.0 + 1e-4;

/// What a proof may need more than a candidate, in turn.
pub(super) const ROOMS: [f64; 4] = [1e-4, 1e-3, 1e-2, 0.1];

impl FloatLimits {
    /// None where nothing is to be kept.
    pub(super) fn new(spec: &Specification, limits: &Limits) -> Option<FloatLimits> {
        let [steady, peak, control] = limits.of_conditions().map(|(_, limit)| limit);
        let float = |limit: Option<&Rational>| limit.map(Rational::to_f64);
        let actuator = spec.actuator.as_ref().filter(|actuator| !actuator.by_count);
        let actuator = actuator.map(|actuator| actuator.max.to_f64());
        let limits = [
            (Limited::SteadyError, float(steady)),
            (Limited::PeakError, float(peak)),
            (Limited::Control, float(control)),
            (Limited::Actuator, actuator),
        ];
        let nominal = spec.input_gain.as_ref().map_or(1.0, |gain| gain.nominal.to_f64());
        let start = float(peak).zip(spec.initial_set.given()[1].map(Constant::to_f64));
        let beyond = start.filter(|(asked, e0)| asked < e0).map(|(asked, e0)| [asked, e0]);
        limits.iter().any(|(_, limit)| limit.is_some()).then_some(FloatLimits { limits, nominal, beyond })
    }

    fn has(&self, which: Limited) -> bool {
        self.limits.iter().any(|(limited, limit)| *limited == which && limit.is_some())
    }

    /// What error boxes are chosen for, in turn.
    fn goals(&self) -> Vec<Goal> {
        let control = self.has(Limited::Control) || self.has(Limited::Actuator);
        let goals = [(Goal::Control, control), (Goal::Peak, self.has(Limited::PeakError))];
        let goals: Vec<Goal> = goals.into_iter().filter(|(_, asked)| *asked).map(|(goal, _)| goal).collect();
        if goals.is_empty() { vec![Goal::Threshold] } else { goals }
    }

    /// The largest share of a limit, with which one that is.
    fn share(&self, largest: &Largest) -> Missed {
        let of = |which| match which {
            Limited::SteadyError => largest.steady_error,
            Limited::PeakError => largest.peak_error,
            Limited::Control | Limited::Actuator => largest.control / self.nominal,
        };
        let shares = self.limits.iter().filter_map(|(which, limit)| {
            let (asked, least) = ((*limit)?, of(*which));
            Some(Missed { which: *which, asked, beside: None, least, sigma: f64::NAN })
        });
        // There is one at least.
        let none = Missed { which: Limited::Control, asked: 1.0, beside: None, least: f64::INFINITY, sigma: f64::NAN };
        let worse = |worst: Missed, next: Missed| if next.share() > worst.share() { next } else { worst };
        let worst = shares.clone().reduce(worse).unwrap_or(none);
        let second = shares.filter(|one| one.which != worst.which).reduce(worse);
        Missed { beside: second.map(|one| (one.which, one.asked)), ..worst }
    }

    /// The best proposal at a gain, for whichever goal.
    fn best<P>(
        &self,
        sigma: f64,
        at: &impl Fn(Goal, f64) -> Result<(P, Largest), Obstacle>,
    ) -> Result<Found<P>, Obstacle> {
        let mut outcome = Err(Failing::NotFinite(None).into());
        for goal in self.goals() {
            match (at(goal, sigma), &outcome) {
                (Ok((proposal, largest)), known) => {
                    let missed = Missed { sigma, ..self.share(&largest) };
                    let better = |known: &Found<P>| missed.share() < known.missed.share();
                    if known.as_ref().map_or(true, better) {
                        outcome = Ok(Found { proposal, goal, missed });
                    }
                }
                (Err(obstacle), Err(_)) => outcome = Err(obstacle),
                (Err(_), Ok(_)) => {}
            }
        }
        outcome
    }

    /// The proposal at the smallest gain from `least` up to `largest` that is found with which all limits are kept with so much room; at
    /// `least` alone where that is given.
    ///
    /// # Errors
    /// By how much they are missed where that is least; or what stands in the way of every gain.
    pub(super) fn smallest<P>(
        &self,
        [least, largest]: [f64; 2],
        (given, room): (bool, f64),
        at: impl Fn(Goal, f64) -> Result<(P, Largest), Obstacle>,
    ) -> Result<Found<P>, Obstacle> {
        if let Some([asked, e0]) = self.beyond {
            return Err(Failing::Start { asked, e0 }.into());
        }
        let rounded = |sigma: f64| rounded_sigma(sigma, 0.0).map_or(sigma, |sigma| sigma.to_f64()).min(largest);
        let falls = !self.has(Limited::Control) && !self.has(Limited::Actuator);
        let further = (1..=DOUBLINGS).map(|k| 10.0 * 2f64.portable_powi(k));
        let gains: Vec<f64> = match given {
            true => vec![least],
            false => SHARES.into_iter().chain(further).map(|share| rounded(least * share)).collect(),
        };
        let mut closest: Option<Missed> = None;
        let mut obstacle = None;
        let mut below = None;
        for (tried, sigma) in gains.into_iter().enumerate() {
            match self.best(sigma, &at) {
                Ok(found) if found.missed.share() <= 1.0 - room => {
                    let Some(below) = below else { return Ok(found) };
                    return Ok(self.between(below, found, room, rounded, &at));
                }
                Ok(found) => {
                    let closer = closest.is_none_or(|known| found.missed.share() < known.share());
                    if closer {
                        closest = Some(found.missed);
                    } else if tried >= SHARES.len() && !falls {
                        break;
                    }
                }
                Err(reason) => obstacle = obstacle.or(Some(reason)),
            }
            if sigma >= largest {
                break;
            }
            below = Some(sigma);
        }
        match (closest, obstacle) {
            (Some(missed), _) => Err(missed.failing().into()),
            (None, Some(obstacle)) => Err(obstacle),
            (None, None) => Err(Failing::NotFinite(None).into()),
        }
    }

    /// A smaller gain between one that does not do and one that does.
    fn between<P>(
        &self,
        mut below: f64,
        mut found: Found<P>,
        room: f64,
        rounded: impl Fn(f64) -> f64,
        at: &impl Fn(Goal, f64) -> Result<(P, Largest), Obstacle>,
    ) -> Found<P> {
        for _ in 0..STEPS {
            let middle = rounded((below * found.missed.sigma).sqrt());
            if middle <= below || middle >= found.missed.sigma {
                break;
            }
            match self.best(middle, at) {
                Ok(better) if better.missed.share() <= 1.0 - room => found = better,
                _ => below = middle,
            }
        }
        found
    }
}

/// The same question with another value of one limit.
pub(super) fn with_limit(
    spec: &Specification,
    limits: &Limits,
    which: Limited,
    value: &Rational,
) -> (Specification, Limits) {
    let (mut spec, mut limits) = (spec.clone(), limits.clone());
    match which {
        Limited::SteadyError => limits.steady_error = Some(value.clone()),
        Limited::PeakError => limits.peak_error = Some(value.clone()),
        Limited::Control => limits.control = Some(value.clone()),
        Limited::Actuator => spec.actuator = Some(Actuator::symmetric(Constant::rational(value))),
    }
    (spec, limits)
}

/// A proposal, what its error box is chosen for, and the limit that it comes closest to.
pub(super) struct Found<P> {
    pub(super) proposal: P,
    pub(super) goal: Goal,
    missed: Missed,
}

impl<P> Found<P> {
    /// What is said where a proof needs more than the candidate.
    pub(super) fn failing(&self) -> Failing {
        self.missed.failing()
    }

    /// The gain.
    pub(super) fn sigma(&self) -> Option<Rational> {
        Rational::from_f64(self.missed.sigma).and_then(|sigma| {
            // The short number that this double was made of.
            let short = rounded_sigma(self.missed.sigma, -1e-12)?;
            Some(if short.to_f64() == self.missed.sigma { short } else { sigma })
        })
    }
}

/// A limit, and what is found.
#[derive(Clone, Copy, Debug)]
struct Missed {
    which: Limited,
    asked: f64,
    /// The other limit that comes closest to being missed.
    beside: Option<(Limited, f64)>,
    least: f64,
    sigma: f64,
}

impl Missed {
    fn share(&self) -> f64 {
        let share = self.least / self.asked;
        if share.is_nan() { f64::INFINITY } else { share }
    }

    fn failing(self) -> Failing {
        let Missed { which, asked, beside, least, sigma } = self;
        Failing::Limit { which, asked, beside, least, sigma, proved: false }
    }
}
