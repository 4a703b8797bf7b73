//! The precision at which what is reported of a proof is known well.

use super::outcome::Outcome;
use rug::Rational;
use sigmastar_decide::conditions::{Decided, Ladder, Proof, SharpProof, Witness, decide};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::model::Specification;

/// Binary digits that a reported number has, where the precision allows it.
const DIGITS: u32 = 56;

/// The most bits that are spent on that: a number that is 0, and not exactly so, is never known to any digit.
const FINEST: u32 = 512;

/// A proof at a precision at which its sides and its periodic solution are known to [`DIGITS`], and that precision.
pub(super) fn refined(
    mut sharp: Outcome<SharpProof>,
    spec: &Specification,
    ladder: Ladder,
) -> (Outcome<SharpProof>, u32) {
    let precision = known_well(ladder.start.max(53), ladder, |ladder| {
        raise(&mut sharp, spec, ladder);
        !sharp.proved().map(Proof::decided).is_some_and(|proof| is_rough(&proof))
    });
    (sharp, precision)
}

/// The first precision from `start` on, doubled up to [`FINEST`], at which things are known well, or the last one.
pub(super) fn known_well(start: u32, ladder: Ladder, mut is_known: impl FnMut(Ladder) -> bool) -> u32 {
    let finest = FINEST.min(ladder.limit);
    let mut precision = start;
    while !is_known(Ladder { start: precision, ..ladder }) && precision < finest {
        precision = (2 * precision).min(finest);
    }
    precision
}

/// Whether a side or a bound of the periodic solution is known to less than [`DIGITS`].
pub(super) fn is_rough(proof: &Decided<'_>) -> bool {
    let [x_per, e_per, _] = proof.periodic;
    rough(x_per) || rough(e_per) || proof.conditions.iter().any(|c| rough(&c.lhs) || rough(&c.rhs))
}

/// Decides a proof again where it was decided with fewer bits; it gives way only to one that is proved too.
pub(super) fn raise<W: Witness + Clone>(outcome: &mut Outcome<Proof<W>>, spec: &Specification, ladder: Ladder) {
    if let Outcome::Proved(proof) = outcome
        && proof.precision < ladder.start
    {
        let again = decide(spec, proof.witness.clone(), ladder);
        if again.truth().is_true() {
            **proof = again;
        }
    }
}

/// Whether a number that has bounds is known to less than [`DIGITS`].
pub(super) fn rough(value: &Enclosure) -> bool {
    if !value.is_bounded() {
        return false;
    }
    let width = Enclosure::point(&value.upper()) - Enclosure::point(&value.lower());
    let unit = Enclosure::from_rational(&(Rational::from(1) >> DIGITS), DIGITS);
    !width.le(&(value.abs().ceiling() * unit)).is_true()
}
