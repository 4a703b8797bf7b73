//! A smaller gain with which a plant's loop keeps to limits, by bounds that are proved for the sets of that gain (derivation, 13.5).

use super::proofs::WithoutJoint;
use super::reduce::reduce;
use super::watch::Unwatched;
use rug::Rational;
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_lang::plant::Plant;

/// Gains that are tried between the least one and what is found.
const STEPS: usize = 4;

/// What is not smaller by this share is not worth a proof of its own.
const WORTH: f64 = 0.02;

/// The data of the plant for a gain between `least` and `found` with which a smaller gain than `found` keeps to what is asked for; `within` says
/// which gain that is for given data, if there is one. `None` where none is found.
pub(super) fn closer(
    plant: &Plant,
    [mut least, mut found]: [f64; 2],
    within: impl Fn(&WithoutJoint) -> Option<f64>,
) -> Option<WithoutJoint> {
    let mut best = None;
    for _ in 0..STEPS {
        if found < least * (1.0 + WORTH) {
            break;
        }
        let middle = round_f64((least * found).sqrt(), 6, Direction::Nearest)?;
        let data = at_gain(plant, &middle);
        match data.and_then(|data| within(&data).map(|sigma| (data, sigma))) {
            Some((data, sigma)) if sigma < found => (best, found) = (Some(data), sigma),
            _ => least = middle.to_f64(),
        }
    }
    best
}

/// The data proved at the sets of this gain.
fn at_gain(plant: &Plant, sigma: &Rational) -> Option<WithoutJoint> {
    let reduced = reduce(plant, Some(sigma), &Unwatched).ok()?;
    (reduced.proposal.sigma <= *sigma).then_some((reduced.spec, reduced.proposal))
}
