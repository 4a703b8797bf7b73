//! Exact regulation with infinitely many oscillators.

use super::words;
use sigmastar_document::Block;
use sigmastar_document::number::exact;
use sigmastar_exact::number::{Direction, write_exact};
use sigmastar_prove::certify::{Certification, Verdict};

/// sigma*_oo and what it means; why there is none where there is none.
pub(super) fn section(run: &Certification<'_>, rechecked: bool) -> Vec<Block> {
    if run.verdict != Verdict::Certified {
        return Vec::new();
    }
    let said = match (&run.exact, run.sharp.proved()) {
        (Some(claim), Some(proof)) => {
            let set = &proof.witness.set;
            format!(
                "$`sigma*_oo = {}`$: with infinitely many oscillators and any $`sigma >= sigma*_oo`$, every solution from {} is \
                 bounded, and {}. Nothing is claimed about a rate or about $`z`$. This uses the bounding functions up to {}.",
                write_exact(&claim.witness.sigma),
                words::set(run.spec, set),
                words::limit(run.spec),
                words::arguments(run.spec, [&claim.witness.d_x, &claim.witness.d_e].map(|d| exact(d, Direction::Up)))
            )
        }
        _ if !run.spec.internal_model.matched => {
            "Not claimed: it needs a base frequency of exactly $`2 pi / period`$ (`\"matched\": true`).".to_owned()
        }
        _ if run.spec.actuator.is_some() => {
            "Not claimed with an actuator that saturates: it is about other gains.".to_owned()
        }
        _ if rechecked => "Not part of the certificate whose witness was decided again.".to_owned(),
        _ if run.sharp.proved().is_none() => "Not worked out: it belongs to the sharp derivation.".to_owned(),
        _ => "Nothing was proved about exact regulation.".to_owned(),
    };
    vec![Block::heading("Exact regulation (n_o infinite)"), Block::says(said)]
}
