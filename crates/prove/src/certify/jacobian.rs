//! The Lyapunov triples of a specification with a Jacobian (one for stability, one for existence where it helps): chosen,
//! proved, or given and decided again.

use super::refusal::Refusal;
use crate::attempt::first_proved;
use rug::Rational;
use sigmastar_decide::lyapunov::{NotProved, prove};
use sigmastar_exact::enclosure::MAX_PRECISION;
use sigmastar_lang::spec::model::{Jacobian, LyapunovSource, Specification};
use sigmastar_propose::lyapunov::{Candidate, Candidates, LyapunovFailure, candidates};
use sigmastar_propose::search::{FloatModel, SharpProposal, search_sharp, search_sharp_near};
use sigmastar_theory::data::Data;
use sigmastar_theory::evidence::{ProvedTriple, ProvedTriples};
use sigmastar_theory::jacobian::Family;
use sigmastar_theory::transfer::TradeOff;
use std::borrow::Cow;

/// A specification whose triples were found and proved, and what else is known about its Jacobian.
pub struct Resolution {
    /// The specification with [`LyapunovSource::Proved`].
    pub spec: Specification,
    /// Every candidate, and the Floquet exponents.
    pub candidates: Candidates,
    /// sigma* of each candidate in floating point, where the search was run and found one; in the order of the candidates.
    pub sigmas: Vec<Option<f64>>,
    /// Full searches for a sigma*, of [`MAX_SEARCHES`].
    pub searches: usize,
}

/// So many candidates in a row without a smaller sigma* end the search for one.
const GIVE_UP: usize = 3;

/// Full searches for one Jacobian: from the first candidate that has a sigma*, the others are reached by local steps.
pub const MAX_SEARCHES: usize = 8;

/// 0, 1, ..., count - 1, the ends and middles first: 0, the last, the middle, the quarters, ...
fn spread(count: usize) -> Vec<usize> {
    let mut order: Vec<usize> = Vec::new();
    let last = count.saturating_sub(1);
    let mut parts = 1;
    while order.len() < count {
        for part in 0..=parts {
            let at = last * part / parts;
            if !order.contains(&at) {
                order.push(at);
            }
        }
        parts *= 2;
    }
    order
}

/// Finds and proves a triple for the Jacobian of a specification, of the candidates the one whose sigma* comes out smallest
/// in floating point, and a second one for existence where that gives a smaller sigma* still.
///
/// Guarantee: each triple is proved for every t and every matrix of the Jacobian. That no other gives a smaller sigma* is
/// not claimed. `None` if the specification has a triple already.
///
/// # Errors
/// No triple was found.
pub fn resolve(spec: &Specification) -> Option<Result<Resolution, LyapunovFailure>> {
    let LyapunovSource::Wanted(jacobian) = &spec.lyapunov else { return None };
    Some(candidates(jacobian, &spec.period).and_then(|mut candidates| {
        let data = Data::new(spec, 64);
        // The transfer constants hardly move the best triple: the cheap ones do.
        let trade_off =
            if spec.internal_model.matched { TradeOff::matched(&data) } else { TradeOff::closed_form(&data) };
        let model = FloatModel::new(&data, trade_off);
        let (mut searches, mut start): (usize, Option<SharpProposal>) = (0, None);
        let mut sigma = |candidate: &Candidate| {
            let model = model.with_triple(candidate.ratio, candidate.alpha);
            let near = start.and_then(|known| search_sharp_near(&model, &known).ok());
            let found = near.or_else(|| {
                let search = searches < MAX_SEARCHES;
                searches += usize::from(search);
                if search { search_sharp(&model).ok() } else { None }
            })?;
            if start.is_none_or(|known| found.sigma < known.sigma) {
                start = Some(found);
            }
            Some(found.sigma)
        };
        // A start for the others: the first candidate has a sigma*, or one spread over all of them.
        spread(candidates.found.len())
            .into_iter()
            .take(MAX_SEARCHES)
            .find(|at| sigma(&candidates.found[*at]).is_some());
        let mut sigmas: Vec<Option<f64>> = Vec::new();
        // From the largest rate down; past the best, sigma* grows with the loss of rate.
        let (mut best, mut worse) = (f64::INFINITY, 0);
        for candidate in &candidates.found {
            let found = if worse < GIVE_UP { sigma(candidate) } else { None };
            worse = if found.is_some_and(|sigma| sigma < best) || best.is_infinite() { 0 } else { worse + 1 };
            best = best.min(found.unwrap_or(f64::INFINITY));
            sigmas.push(found);
        }
        // Around the best one, a finer step.
        if let Some(at) = (0..sigmas.len()).rfind(|at| sigmas[*at].is_some_and(|sigma| sigma <= best)) {
            let more = candidates.beside(at);
            sigmas.extend(more.iter().map(&mut sigma));
            candidates.found.extend(more);
            let mut all: Vec<_> = std::mem::take(&mut candidates.found).into_iter().zip(sigmas).collect();
            all.sort_by(|a, b| b.0.alpha.total_cmp(&a.0.alpha));
            (candidates.found, sigmas) = all.into_iter().unzip();
        }
        let rank = |at: &usize| sigmas[*at].unwrap_or(f64::INFINITY);
        let mut order: Vec<usize> = (0..sigmas.len()).collect();
        // Stable: where no sigma* is found, the largest rate comes first.
        order.sort_by(|a, b| rank(a).total_cmp(&rank(b)));
        let stability = first_proved(&candidates, order.iter().map(|at| &candidates.found[*at]))?;
        let existence = start.and_then(|known| for_existence(&model, &candidates, &stability, &known));
        let triples = ProvedTriples { stability, existence };
        Ok(Resolution { spec: carrying(spec, &triples), candidates, sigmas, searches })
    }))
}

/// What a second matrix must take from sigma* to be worth its room in a certificate.
const WORTH: f64 = 1e-5;

/// A triple for the existence of the periodic solution beside that of stability, where one of the candidates is proved that
/// lowers sigma*, in floating point.
fn for_existence(
    model: &FloatModel,
    candidates: &Candidates,
    stability: &ProvedTriple,
    known: &SharpProposal,
) -> Option<ProvedTriple> {
    let ratio = Rational::from(&stability.p_up / &stability.p_low).to_f64();
    let model = model.with_triple(ratio, stability.alpha.to_f64());
    let alone = search_sharp_near(&model, known).or_else(|_| search_sharp(&model)).ok()?;
    let sigma = |candidate: &&Candidate| {
        let model = model.with_existence_triple(candidate.ratio, candidate.alpha);
        search_sharp_near(&model, &alone).map_or(f64::INFINITY, |found| found.sigma)
    };
    let mut better: Vec<(f64, &Candidate)> =
        candidates.found.iter().map(|candidate| (sigma(&candidate), candidate)).collect();
    better.retain(|(sigma, _)| *sigma < alone.sigma * (1.0 - WORTH));
    better.sort_by(|a, b| a.0.total_cmp(&b.0));
    first_proved(candidates, better.into_iter().map(|(_, candidate)| candidate)).ok()
}

/// A specification with a Lyapunov triple: as it is, or with those of its Jacobian, which are `given` or found, and proved.
///
/// # Errors
/// [`Refusal::Jacobian`]: no triple was found, or the given one is not proved.
pub fn with_triple<'s>(
    spec: &'s Specification,
    given: Option<&ProvedTriples>,
) -> Result<Cow<'s, Specification>, Refusal> {
    let proved = match given {
        Some(triple) => resolve_with(spec, triple).map(|proved| proved.map_err(|failure| failure.to_string())),
        None => resolve(spec).map(|found| found.map(|found| found.spec).map_err(|failure| failure.to_string())),
    };
    match proved {
        None => Ok(Cow::Borrowed(spec)),
        Some(proved) => proved.map(Cow::Owned).map_err(Refusal::Jacobian),
    }
}

/// Decides the triples of a certificate for the Jacobian of a specification again. `None` if the specification has no Jacobian
/// whose triple is wanted.
///
/// # Errors
/// The inequality that is not proved.
pub fn resolve_with(spec: &Specification, triples: &ProvedTriples) -> Option<Result<Specification, NotProved>> {
    let LyapunovSource::Wanted(jacobian) = &spec.lyapunov else { return None };
    let mut all = std::iter::once(&triples.stability).chain(&triples.existence);
    Some(all.try_for_each(|triple| decide_triple(spec, jacobian, triple)).map(|()| carrying(spec, triples)))
}

fn decide_triple(spec: &Specification, jacobian: &Jacobian, triple: &ProvedTriple) -> Result<(), NotProved> {
    let mut precision = 128;
    loop {
        // The reader has refused entries that are no polynomials of the period.
        let family = Family::new(jacobian, &spec.period, precision);
        match family.map_or(Err(NotProved::Shape), |family| prove(&family, triple)) {
            Err(NotProved::Inequality { .. }) if precision < MAX_PRECISION => precision *= 4,
            outcome => return outcome,
        }
    }
}

fn carrying(spec: &Specification, proved: &ProvedTriples) -> Specification {
    let mut spec = spec.clone();
    if let Some(jacobian) = spec.lyapunov.jacobian().cloned() {
        let (triple, matrix) = proved.stability.stated();
        let existence = proved.existence.as_ref().map(|other| Box::new(other.stated()));
        spec.lyapunov = LyapunovSource::Proved { jacobian, triple, matrix, existence };
    }
    spec
}
