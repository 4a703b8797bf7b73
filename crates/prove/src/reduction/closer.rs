//! A smaller gain with which a plant's loop keeps to limits, by bounds that are proved for the sets of that gain (derivation, 13.5).

use super::coordinates::Chosen;
use super::proofs::{Proofs, ProvedData, Reduced};
use super::reduce::reduce_to;
use super::watch::{Searches, Stage, Watch};
use sigmastar_exact::number::Portable;
use sigmastar_lang::plant::Plant;
use sigmastar_theory::derivation::paths::Path;

/// Gains that are tried between the least one and what is found.
const STEPS: usize = 4;

/// What is not smaller by this share is not worth a proof of its own.
const WORTH: f64 = 0.02;

/// The data of the plant for a gain between `least` and `found` with which a smaller gain than `found` keeps to what is asked for; `within` says
/// which gain that is for given data, if there is one. `None` where none is found.
pub(super) fn closer(
    plant: &Plant,
    [least, found]: [f64; 2],
    within: impl Fn(&ProvedData) -> Option<f64>,
    watch: &dyn Watch,
) -> Option<ProvedData> {
    watch.enter(Stage::Limits);
    let searches = Searches::new(1, watch);
    // The coordinates are the same for all gains.
    let last = |proofs: &Proofs<'_>, (chosen, _): (&Chosen, Option<Path>), proved: Reduced| {
        let (mut least, mut found, mut best) = (least, found, None);
        for _ in 0..STEPS {
            if found < least * (1.0 + WORTH) {
                break;
            }
            searches.tried(0);
            let middle = (0.5 * (least.portable_ln() + found.portable_ln())).portable_exp();
            let data = proofs.for_gain(chosen, &proved, middle).map(|there| (there.spec, there.proposal));
            match data.and_then(|data| within(&data).map(|sigma| (data, sigma))) {
                Some((data, sigma)) if sigma < found => (best, found) = (Some(data), sigma),
                _ => least = middle,
            }
        }
        match best {
            Some((spec, proposal)) => Reduced { spec, proposal, ..proved },
            None => proved,
        }
    };
    let reduced = reduce_to(plant, &last, &searches).ok()?;
    let data = (reduced.spec, reduced.proposal);
    within(&data).is_some_and(|sigma| sigma < found).then_some(data)
}
