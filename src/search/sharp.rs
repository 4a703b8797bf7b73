//! The search of the sharp derivation: X_p, E_p, rho, eta that make sigma* small.

use super::candidate::{AtSigma, Existence, Obstacle, SharpParameters, largest_e};
use super::minimise::{Descent, minimise};
use super::model::{Datum, FloatModel};
use super::scan;
use crate::number::Portable;

/// The best candidate of a search.
#[derive(Clone, Copy, Debug)]
pub struct SharpProposal {
    /// The four free numbers.
    pub parameters: SharpParameters,
    /// The smallest sigma found for them.
    pub sigma: f64,
    /// Which condition sets sigma.
    pub binding: &'static str,
}

/// Starting values of (rho, eta) for the scan.
const SHAPES: [(f64, f64); 6] = [(1.4, 1.0), (1.08, 0.05), (1.08, 20.0), (4.0, 0.05), (4.0, 20.0), (1.005, 1e-4)];

/// Logarithms of sigma that are no further apart belong to one minimum, found to the tolerance of a rough refinement.
const SAME: f64 = 1e-5;

/// Searches for the smallest sigma; `known` are candidates from elsewhere, from which it is searched too.
///
/// # Errors
/// The obstacle of the candidate that came closest, when none is feasible.
pub fn search_sharp(model: &FloatModel, known: &[SharpParameters]) -> Result<SharpProposal, Obstacle> {
    if !model.is_in_range() {
        return Err(Obstacle::Magnitude);
    }
    let effort = model.effort();
    let xs = scan::x_values(model.domain.0, effort.x_step);
    let columns = scan::evaluate_all(&xs, |&x_p| scan_column(model, x_p));
    let mut closest = Obstacle::NotFinite;
    let mut found: Vec<(f64, SharpParameters)> = Vec::new();
    for column in columns {
        match column {
            Ok(candidates) => found.extend(candidates),
            Err(obstacle) => closest = closest.max(obstacle),
        }
    }
    // Where X does not matter, prefer ordinary numbers.
    let unusual = |p: &SharpParameters| p.x_p.portable_ln().abs();
    found.sort_by(|a, b| a.0.total_cmp(&b.0).then(unusual(&a.1).total_cmp(&unusual(&b.1))));
    let mut starts = spread(&found, effort.refined);
    starts.extend(known);
    let rough = scan::evaluate_all(&starts, |start| refine(model, start, effort.rough_descent()));
    let mut rough: Vec<_> = rough.into_iter().flatten().collect();
    rough.sort_by(|a, b| a.1.total_cmp(&b.1));
    // Those that came to the same place are one.
    rough.dedup_by(|a, b| a.1 - b.1 < SAME);
    rough.truncate(effort.finished);
    let refined = scan::evaluate_all(&rough, |(start, _)| refine(model, start, effort.descent(6)));
    let best = refined.into_iter().flatten().min_by(|a, b| a.1.total_cmp(&b.1)).ok_or(closest)?;
    let best = refine(model, &best.0, effort.descent(12)).filter(|again| again.1 < best.1).unwrap_or(best);
    proposal(model, best.0)
}

/// Whether the scan of the search finds a candidate.
#[must_use]
pub fn any_candidate(model: &FloatModel) -> bool {
    let xs = scan::x_values(model.domain.0, model.effort().x_step);
    model.is_in_range() && scan::evaluate_all(&xs, |&x_p| scan_column(model, x_p).is_ok()).contains(&true)
}

/// The proposal that local minimisation reaches from the free numbers of a neighbouring problem; `None` where they are not
/// feasible here. For many similar problems, of which only the first is worth a search.
#[must_use]
pub fn search_sharp_near(model: &FloatModel, start: &SharpParameters) -> Option<SharpProposal> {
    let (best, _) = refine(model, start, model.effort().descent(6))?;
    proposal(model, best).ok()
}

/// Good candidates that differ from each other, best first.
fn spread(found: &[(f64, SharpParameters)], count: usize) -> Vec<SharpParameters> {
    let mut starts: Vec<SharpParameters> = Vec::new();
    for (_, candidate) in found {
        let near = |other: &SharpParameters| {
            (candidate.x_p / other.x_p).portable_ln().abs() < 0.1
                && (candidate.e_p / other.e_p).portable_ln().abs() < 0.3
                && candidate.rho == other.rho
                && candidate.eta == other.eta
        };
        if !starts.iter().any(near) {
            starts.push(*candidate);
        }
        if starts.len() == count {
            break;
        }
    }
    starts
}

/// The largest E_p with C1 and A < 1 at X_p.
#[must_use]
pub fn largest_e_sharp(model: &FloatModel, x_p: f64) -> Option<f64> {
    largest_e(model, x_p, model.c, 1)
}

/// The best candidates for one X_p, or the closest obstacle.
fn scan_column(model: &FloatModel, x_p: f64) -> Result<Vec<(f64, SharpParameters)>, Obstacle> {
    let e_max = largest_e_sharp(model, x_p).ok_or(Obstacle::Existence)?;
    let effort = model.effort();
    let mut closest = Obstacle::Existence;
    let mut found = Vec::new();
    for depth in scan::e_depths(effort.e_step) {
        let existence = match Existence::new(model, x_p, e_max * (-depth).portable_exp()) {
            Ok(existence) => existence,
            Err(obstacle) => {
                closest = closest.max(obstacle);
                continue;
            }
        };
        let mut best: Option<(f64, SharpParameters)> = None;
        for (rho, eta) in SHAPES.into_iter().take(effort.shapes) {
            if best.is_some_and(|(sigma, _)| existence.least(model, eta) >= sigma) {
                continue;
            }
            match existence.sigma(model, rho, eta, 1e-2) {
                Ok(sigma) => {
                    if best.is_none_or(|(least, _)| sigma < least) {
                        best = Some((sigma, SharpParameters { x_p, e_p: existence.e_p(), rho, eta }));
                    }
                }
                Err(obstacle) => closest = closest.max(obstacle),
            }
        }
        found.extend(best);
    }
    if found.is_empty() { Err(closest) } else { Ok(found) }
}

/// A depth below the largest E_p from an unbounded parameter: logarithmic near 0, linear beyond 1.
pub(super) fn depth_of(parameter: f64) -> f64 {
    if parameter < 0.0 { parameter.portable_exp() } else { 1.0 + parameter }
}

/// The inverse of [`depth_of`].
pub(super) fn parameter_of(depth: f64) -> f64 {
    if depth < 1.0 { depth.portable_ln() } else { depth - 1.0 }
}

/// Minimises ln sigma over (ln X_p, ln of E_p's depth, ln(rho - 1), ln eta) from a start.
fn refine(model: &FloatModel, start: &SharpParameters, descent: Descent) -> Option<(SharpParameters, f64)> {
    let decode = |p: &[f64]| {
        let x_p = scan::in_range(p[0].portable_exp())?;
        let e_p = largest_e_sharp(model, x_p)? * (-depth_of(p[1])).portable_exp();
        // rho too close to 1 would leave no room between the two members of C4.
        let excess = p[2].portable_exp().max(1e-6);
        Some(SharpParameters { x_p, e_p, rho: 1.0 + excess, eta: p[3].portable_exp() })
    };
    let cost = |p: &[f64]| {
        let parameters = decode(p)?;
        let existence = Existence::new(model, parameters.x_p, parameters.e_p).ok()?;
        let sigma = existence.sigma(model, parameters.rho, parameters.eta, 1e-12).ok()?;
        Some(sigma.portable_ln() + scan::preference(parameters.x_p) + scan::preference(parameters.e_p))
    };
    let depth = (largest_e_sharp(model, start.x_p)? / start.e_p).portable_ln().max(1e-9);
    let first =
        [start.x_p.portable_ln(), parameter_of(depth), (start.rho - 1.0).portable_ln(), start.eta.portable_ln()];
    let (best, value) = minimise(cost, &first, &[0.3, 0.5, 0.5, 0.5], descent)?;
    Some((decode(&best)?, value))
}

fn proposal(model: &FloatModel, parameters: SharpParameters) -> Result<SharpProposal, Obstacle> {
    let existence = Existence::new(model, parameters.x_p, parameters.e_p)?;
    let sigma = existence.sigma(model, parameters.rho, parameters.eta, 1e-13)?;
    let binding = if sigma > existence.sigma_least * (1.0 + 1e-6) {
        "C5 (decay in the error box)"
    } else if existence.bound_by_size() {
        "C2 and C5 (size of the periodic error, decay in the error box)"
    } else {
        "C3 and C5 (contraction, decay in the error box)"
    };
    Ok(SharpProposal { parameters, sigma, binding })
}

/// The error box of a proposal at a (slightly larger) sigma.
///
/// # Errors
/// The obstacle, when the candidate is not feasible there.
pub fn at_sigma(
    model: &FloatModel,
    parameters: &SharpParameters,
    sigma: f64,
) -> Result<(Existence, AtSigma), Obstacle> {
    let existence = Existence::new(model, parameters.x_p, parameters.e_p)?;
    existence.at_sigma(model, parameters.rho, parameters.eta, sigma).map(|at| (existence, at))
}

/// By how much (relatively) sigma* falls when one datum improves by 1 %, for every datum, in the order of
/// [`Datum::ALL`]; floating point, a local re-optimisation from the proposal. None where the bounding functions are long.
#[must_use]
pub fn sensitivities(model: &FloatModel, proposal: &SharpProposal) -> Vec<(Datum, f64)> {
    if !model.effort().sensitivities() {
        return Vec::new();
    }
    scan::evaluate_all(&Datum::ALL, |&datum| {
        let improved = model.improved(datum, 0.01);
        let gain = refine(&improved, &proposal.parameters, model.effort().descent(2))
            .map_or(0.0, |(_, ln)| 1.0 - ln.portable_exp() / proposal.sigma);
        (datum, gain.max(0.0))
    })
}
