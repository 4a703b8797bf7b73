//! Kind (a): plants that are linear in x and e (docs/mathematics.md, section 14.3).

use crate::read::Plant;
use proofs_core::rules::by_n_o::claimed::{Entry, RULE};
use proofs_core::rules::by_n_o::linear::Linear;
use proofs_core::spec::Specification;
use proofs_core::verdict::{Outcome, Verdict, finding};
use rug::Rational;

/// Proves (14.3a) of each form, and `steady` and the sizes of each entry.
pub fn prove(
    _spec: &Specification,
    _plant: &Plant,
    _sigma: &Rational,
    (claimed, _witness): (&[Entry<'_>], &Linear),
    _lines: &mut Vec<String>,
) -> Outcome<()> {
    let pointer = claimed.first().map_or("/claim/by_n_o", |entry| &entry.pointer);
    Err(finding(Verdict::Undecided, RULE, pointer, "the numbers by n_o are not decided yet"))
}
