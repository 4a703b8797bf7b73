//! The search of the sharp derivation: the smallest sigma at which the smallest set with a periodic solution has an error box.

use super::binding::Binding;
use super::candidate::AtSigma;
use super::effort::ROOM;
use super::error_box::{best_shape, error_box, shape_near};
use super::floors::{ordinary, raised, tiny};
use super::model::{Datum, FloatModel, OptionalDatum};
use super::obstacle::{Closest, Failing, Obstacle};
use super::periodic::{ExistenceForm, Floors, PeriodicSet};
use super::reach::{Largest, Law, largest, start_distances, weighed};
use super::root::crossing;
use super::threshold::ByMatrix;
use sigmastar_exact::number::Portable;
use sigmastar_exact::parallel;
use sigmastar_theory::derivation::control::Answer;
use sigmastar_theory::derivation::harmonics::AtOrigin;

/// How existence is proved, and the shape of the error box: from these and sigma every other free number follows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SharpParameters {
    /// The form of S2.
    pub form: ExistenceForm,
    /// The smallest X_p and E_p.
    pub floors: Floors,
    /// rho > 1 with D_x = rho c dX.
    pub rho: f64,
    /// eta > 0 with h dZ^2 = eta dE^2.
    pub eta: f64,
}

/// The best candidate of a search.
#[derive(Clone, Copy, Debug)]
pub struct SharpProposal {
    /// The free numbers.
    pub parameters: SharpParameters,
    /// The smallest sigma found for them.
    pub sigma: f64,
    /// What sets sigma.
    pub binding: Binding,
}

/// Shares of (b_qe - m)/2 that are tried as kap.
const DAMPED: [f64; 2] = [1.0, 0.3];

/// The share of the smallest rate in the data below which a gain is as good as none.
const NEGLIGIBLE: f64 = 1e-20;

/// The largest gain that is tried.
const LARGEST: f64 = 1e250;

/// By what share a gain that is tried next lies beyond the threshold at the last one; after so many tries twice as much each time.
const BEYOND: f64 = 1e-6;
const NEAR_TRIES: u32 = 16;

/// The width of the last bracket of ln sigma, as a share of the tolerance of a refinement.
const BRACKET: f64 = 0.1;

/// One way to prove existence, for every sigma.
#[derive(Clone)]
struct Search<'a> {
    model: &'a FloatModel,
    origin: AtOrigin<f64>,
    form: ExistenceForm,
    floors: Floors,
    /// Where the shape of the error box is sought; everywhere without.
    near: Option<(f64, f64)>,
}

impl Search<'_> {
    /// The best error box at sigma.
    fn at(&self, sigma: f64, room: f64) -> Result<(PeriodicSet, AtSigma), Obstacle> {
        let set = PeriodicSet::least(self.model, &self.origin, sigma, (self.form, self.floors), room)?;
        let distances = start_distances(self.model, &set);
        let periodic = (set.x_per, set.e_per);
        let evaluate = |rho: f64, eta: f64| {
            let at = error_box(self.model, periodic, distances, ((rho, eta), sigma))?;
            weighed(self.model, at, distances, Law::continuous(sigma, self.model), sigma)
        };
        let at = match self.near {
            // A shape is sought together with the coordinates where it is dear.
            Some((rho, eta)) if self.model.by_matrix.is_some() => evaluate(rho, eta)?,
            near => {
                let near = near.and_then(|shape| shape_near(self.model, evaluate, shape));
                near.map_or_else(|| best_shape(self.model, evaluate), Ok)?
            }
        };
        Ok((set, at))
    }

    /// The proposal at sigma with X_p and E_p of an ordinary size where nothing asks for one, as far as `worth` takes it: it gives
    /// the gain with the floors of a search, or none.
    fn with_ordinary_floors(
        &self,
        sigma: f64,
        worth: impl Fn(&Search<'_>, f64) -> Option<f64>,
    ) -> Result<SharpProposal, Obstacle> {
        let with = |floors: Floors| Search { floors, ..self.clone() };
        let size = |floors: Floors, sigma: &f64| {
            with(floors).at(*sigma, self.model.effort().room).map(|(set, _)| [set.x_p, set.e_p])
        };
        let again = |floors: Floors, sigma: &f64| worth(&with(floors), *sigma);
        let (floors, sigma) = raised((self.floors, sigma), ordinary(self.model), size, again)?;
        proposal(&with(floors), sigma)
    }

    /// ln(threshold/sigma), to be at most 0.
    fn excess(&self, sigma: f64) -> Result<f64, Obstacle> {
        self.at(sigma, self.model.effort().room).map(|(_, at)| (at.threshold / sigma).portable_ln())
    }

    /// No sigma below this one is sought: it is negligible beside every rate in the data, and where nothing in them needs a
    /// gain the infimum is 0.
    fn least(&self) -> f64 {
        let model = self.model;
        let rates = [model.period.recip(), model.alpha, model.mu, model.base_frequency];
        NEGLIGIBLE * rates.into_iter().fold(f64::INFINITY, f64::min)
    }

    /// The smallest sigma; from `guess`, if that is known to be near.
    ///
    /// Feasibility is monotone: with sigma every right side of S1 and S2, so the set, the distances and the threshold fall.
    fn smallest(&self, guess: f64) -> Result<f64, Obstacle> {
        least_sigma(&|sigma| self.excess(sigma), [guess, self.least()], BRACKET * self.model.effort().tolerance)
    }
}

/// The smallest sigma, not below `least`, at which an excess is not above 0; from `guess`, if that is known to be near. The excess is the logarithm of the
/// threshold over sigma, and falls with sigma; the answer is to a width of ln sigma.
///
/// # Errors
/// The obstacle at the largest gain that is tried.
fn least_sigma(
    excess: &dyn Fn(f64) -> Result<f64, Obstacle>,
    [guess, least]: [f64; 2],
    width: f64,
) -> Result<f64, Obstacle> {
    let mut at = (guess.max(least), excess(guess.max(least)));
    // The last infeasible and the first feasible sigma.
    let mut low: Option<(f64, f64)> = None;
    let mut high: Option<(f64, f64)> = None;
    let mut factor: f64 = 4.0;
    let (mut tries, mut beyond) = (0, BEYOND);
    while low.is_none() || high.is_none() {
        // A threshold that follows sigma is missed by as little each time.
        if tries >= NEAR_TRIES {
            beyond *= 2.0;
        }
        tries += 1;
        let next = match at.1 {
            Ok(value) if value <= 0.0 => {
                high = Some((at.0, value));
                if at.0 <= least {
                    return Ok(least);
                }
                // The threshold hardly depends on sigma: it lies just above the smallest sigma.
                let below = at.0 * value.portable_exp() * (1.0 - beyond.min(0.5));
                if below > at.0 / factor { below } else { at.0 / factor }.max(least)
            }
            outcome => {
                low = Some((at.0, outcome.unwrap_or(f64::INFINITY)));
                match outcome {
                    Err(obstacle) if at.0 > LARGEST => return Err(obstacle),
                    // The threshold is as large as any gain.
                    _ if at.0 > LARGEST => return Err(Failing::NotFinite(None).into()),
                    _ => {}
                }
                let asked = outcome.map_or(0.0, |value| at.0 * value.portable_exp() * (1.0 + beyond));
                if asked > at.0 && asked < at.0 * factor { asked } else { at.0 * factor }
            }
        };
        if low.is_some() && high.is_some() {
            break;
        }
        factor = (factor * factor).min(1e12);
        at = (next, excess(next));
    }
    // The loop ends only with both; a gain that cannot be found has returned from within it.
    let (Some(low), Some(high)) = (low, high) else { return Err(Failing::NotFinite(None).into()) };
    let exponent = |sigma: f64| sigma.portable_ln();
    let of_exponent = |t: f64| excess(t.portable_exp()).unwrap_or(f64::INFINITY);
    let found = crossing(of_exponent, (exponent(low.0), low.1), (exponent(high.0), high.1), width).portable_exp();
    Ok(found.min(high.0))
}

/// Searches for the smallest sigma.
///
/// # Errors
/// The obstacle of the candidate that came closest, when none is feasible.
pub fn search_sharp(model: &FloatModel) -> Result<SharpProposal, Obstacle> {
    model.in_range()?;
    let tiny = tiny(model);
    let found = parallel::map(&forms(model), |form| {
        let search = Search { model, origin: AtOrigin::new(model), form: *form, floors: tiny, near: None };
        search.smallest(first_guess(model)).map(|sigma| (sigma, *form))
    });
    let (sigma, form) = Closest::least(found, |(sigma, _)| *sigma)?;
    let search = Search { model, origin: AtOrigin::new(model), form, floors: tiny, near: None };
    search.with_ordinary_floors(sigma, |search, sigma| {
        // One that costs nothing.
        search.smallest(sigma).ok().filter(|found| *found <= sigma * (1.0 + 1e-7))
    })
}

/// The best proposal at a given gain; near a known one where that is given.
///
/// # Errors
/// What stands in the way.
pub fn search_sharp_at(
    model: &FloatModel,
    sigma: f64,
    known: Option<&SharpProposal>,
) -> Result<SharpProposal, Obstacle> {
    model.in_range()?;
    let searches = match known {
        Some(SharpProposal { parameters: SharpParameters { form, floors, rho, eta }, .. }) => {
            vec![(*form, *floors, Some((*rho, *eta)))]
        }
        None => forms(model).into_iter().map(|form| (form, tiny(model), None)).collect(),
    };
    let found = searches.into_iter().map(|(form, floors, near)| {
        let search = Search { model, origin: AtOrigin::new(model), form, floors, near };
        search.excess(sigma).map(|excess| (excess, search))
    });
    let (excess, search) = Closest::least(found, |(excess, _)| *excess)?;
    if excess > 0.0 {
        return Err(Failing::Gain { given: sigma, smallest: None }.into());
    }
    if known.is_some() {
        return proposal(&search, sigma);
    }
    let allowed = (1.0 - COST) * excess;
    search.with_ordinary_floors(sigma, |search, sigma| {
        search.excess(sigma).is_ok_and(|excess| excess <= allowed).then_some(sigma)
    })
}

/// The share of the room below the threshold that a set of ordinary size may cost, at a given gain.
const COST: f64 = 0.1;

/// The forms of S2 worth trying: without a one-sided bound of dq/de, kap > 0 does not help.
fn forms(model: &FloatModel) -> Vec<ExistenceForm> {
    let damped = DAMPED.map(ExistenceForm::Damped);
    let one_sided = model.has_one_sided();
    std::iter::once(ExistenceForm::Plain).chain(damped.into_iter().filter(|_| one_sided)).collect()
}

/// A gain of the size of the rates in the data.
fn first_guess(model: &FloatModel) -> f64 {
    let slope = model.slope_at_origin();
    let guess = slope + model.period.recip();
    if guess.is_finite() && guess > 0.0 { guess } else { 1.0 }
}

/// The proposal that local steps reach from the free numbers of a neighbouring problem; with a matrix inequality that of its shape.
/// For many similar problems, of which only the first is worth a search.
///
/// # Errors
/// The obstacle, where they are not feasible here.
pub fn search_sharp_near(model: &FloatModel, known: &SharpProposal) -> Result<SharpProposal, Obstacle> {
    let SharpParameters { form, floors, rho, eta } = known.parameters;
    let search = Search { model, origin: AtOrigin::new(model), form, floors, near: Some((rho, eta)) };
    let sigma = search.smallest(known.sigma)?;
    proposal(&search, sigma)
}

/// Whether there is a candidate with some gain.
#[must_use]
pub fn any_candidate(model: &FloatModel) -> bool {
    let floors = tiny(model);
    // The sets only shrink with sigma, and kap > 0 gains nothing where that is large.
    let search = Search { model, origin: AtOrigin::new(model), form: ExistenceForm::Plain, floors, near: None };
    model.in_range().is_ok() && search.at(LARGEST.sqrt(), ROOM).is_ok()
}

fn proposal(search: &Search<'_>, sigma: f64) -> Result<SharpProposal, Obstacle> {
    let (set, at) = search.at(sigma, search.model.effort().room)?;
    let parameters = SharpParameters { form: search.form, floors: search.floors, rho: at.rho, eta: at.eta };
    let binding = match search.at(sigma * (1.0 - 1e-6), search.model.effort().room) {
        _ if matches!(search.model.by_matrix, Some(ByMatrix::Joint(_))) => Binding::JointMetrics,
        Err(Obstacle { failing: Failing::Existence, .. }) => Binding::Existence,
        _ if search.model.by_matrix.is_some() => Binding::MatrixInequality,
        _ => Binding::of_decay(search.model, &set, &at, sigma),
    };
    Ok(SharpProposal { parameters, sigma, binding })
}

/// The set and the error box of a proposal at a (slightly larger) sigma, with so much room in S1 and S2.
///
/// # Errors
/// The obstacle, when the candidate is not feasible there.
pub fn at_sigma(
    model: &FloatModel,
    parameters: &SharpParameters,
    sigma: f64,
    room: f64,
) -> Result<(PeriodicSet, AtSigma), Obstacle> {
    let SharpParameters { form, floors, rho, eta } = *parameters;
    Search { model, origin: AtOrigin::new(model), form, floors, near: Some((rho, eta)) }.at(sigma, room)
}

/// What is bounded at the gain of a proposal.
///
/// # Errors
/// The obstacle, when the candidate is not feasible there.
pub fn largest_at(
    model: &FloatModel,
    SharpProposal { parameters, sigma, .. }: &SharpProposal,
) -> Result<Largest, Obstacle> {
    let (set, at) = at_sigma(model, parameters, *sigma, ROOM)?;
    let answer = Answer::continuous(model);
    Ok(largest(model, &AtOrigin::new(model), &answer, Law::continuous(*sigma, model), (&set, &at)))
}

/// By how much (relatively) sigma* falls for each of these models, in which one datum is better; floating point, local steps
/// from the proposal, and against what such steps find without any better datum. None where the bounding functions are long.
#[must_use]
pub fn sensitivities(
    model: &FloatModel,
    proposal: &SharpProposal,
    improved: &[(Datum, FloatModel)],
) -> Vec<(Datum, f64)> {
    if !model.effort().sensitivities() {
        return Vec::new();
    }
    let as_it_is = search_sharp_near(model, proposal).map_or(proposal.sigma, |near| near.sigma.min(proposal.sigma));
    parallel::map(improved, |(datum, improved)| {
        let gain = search_sharp_near(improved, proposal).map_or(0.0, |near| 1.0 - near.sigma / as_it_is);
        (*datum, gain.max(0.0))
    })
}

/// For each optional datum that is given, sigma* without it, and none where there is no candidate then; floating point.
#[must_use]
pub fn without_optional_data(model: &FloatModel) -> Vec<(OptionalDatum, Option<f64>)> {
    parallel::map(&model.optional_data(), |&datum| {
        (datum, search_sharp(&model.without(datum)).ok().map(|found| found.sigma))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    /// The answer for an excess, and how often it was asked for.
    fn counted(excess: impl Fn(f64) -> f64, guess: f64) -> (Result<f64, Obstacle>, u32) {
        let calls = Cell::new(0);
        let found = least_sigma(
            &|sigma| {
                calls.set(calls.get() + 1);
                Ok(excess(sigma))
            },
            [guess, 1e-20],
            1e-6,
        );
        (found, calls.get())
    }

    #[test]
    fn a_threshold_is_found_from_both_sides() {
        for (threshold, guess) in [(3.0, 1.0), (3.0, 900.0), (2e-12, 5.0), (7e30, 1e-3)] {
            let (found, calls) = counted(|sigma| f64::ln(threshold / sigma), guess);
            let found = found.unwrap();
            assert!((found / threshold).ln().abs() < 1e-5 && calls < 40, "{threshold} {guess}: {found} {calls}");
        }
    }

    #[test]
    fn a_threshold_that_follows_sigma_ends_the_search() {
        // Each gain is missed, or kept to, by as little as the last one.
        let (found, calls) = counted(|_| 1e-9, 1.0);
        assert!(found.is_err() && calls < 200, "{calls}");
        let (found, calls) = counted(|_| -1e-9, 1.0);
        assert!(found.unwrap() == 1e-20 && calls < 200, "{calls}");
        // Until it does not follow any more.
        let (found, calls) = counted(|sigma| if sigma < 5e8 { 1e-3 } else { -1e-3 }, 1.0);
        let found = found.unwrap();
        assert!((found / 5e8).ln().abs() < 1e-5 && calls < 300, "{found} {calls}");
    }
}
