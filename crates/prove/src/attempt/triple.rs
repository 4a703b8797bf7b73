//! A P(t) with numbers that are proved (derivation, 11.2).

use sigmastar_decide::lyapunov::prove;
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_propose::lyapunov::{Candidate, Candidates, LyapunovFailure};
use sigmastar_theory::evidence::ProvedTriple;
use sigmastar_theory::jacobian::Deviation;

/// What is given up of rate and ratio for the proof, tried in turn: rounding only, and room for cells.
const ROOM: [f64; 4] = [1e-6, 1e-4, 1e-3, 1e-2];

/// The proved triple of a candidate: with as little given up of its rate and ratio as the proof needs, at most about 1 %.
///
/// `None` if it is not proved; nothing is claimed then.
#[must_use]
pub fn prove_candidate(candidates: &Candidates, candidate: &Candidate) -> Option<ProvedTriple> {
    // A larger p_up takes more for a ball of deviations, and so from the rate.
    let ball = match &candidates.family().deviation {
        Deviation::Vertices(_) => 0.0,
        Deviation::Ball(radius) => radius.midpoint_f64(),
    };
    let given_up = candidate.alpha + 2.0 * candidate.ratio * ball;
    ROOM.iter().find_map(|room| {
        let triple = ProvedTriple {
            matrix: candidate.matrix.clone(),
            p_low: round_f64(1.0 - room, 8, Direction::Down)?,
            p_up: round_f64(candidate.ratio * (1.0 + room), 8, Direction::Up)?,
            alpha: round_f64(candidate.alpha - room * given_up, 8, Direction::Down)?,
        };
        prove(candidates.family(), &triple).is_ok().then_some(triple)
    })
}

/// The first candidate that is proved, in the given order.
///
/// # Errors
/// None of them is.
pub fn first_proved<'c>(
    candidates: &Candidates,
    order: impl IntoIterator<Item = &'c Candidate>,
) -> Result<ProvedTriple, LyapunovFailure> {
    let rate = -candidates.floquet.first().map_or(f64::NAN, |first| first[0]);
    order
        .into_iter()
        .find_map(|candidate| prove_candidate(candidates, candidate))
        .ok_or(LyapunovFailure::NotFound { rate })
}
