//! What a claim says by the number of oscillators, decided of the formulas (docs/mathematics.md, section 14): one kind of proof a folder.

mod linear;
mod trials;

use super::read::Plant;
use proofs_core::rules::by_n_o::claimed::Entry;
use proofs_core::rules::by_n_o::{About, Witness};
use proofs_core::spec::Specification;
use proofs_core::verdict::Outcome;

/// Proves of the formulas what `proofs_core::rules::by_n_o` takes as true of the periodic solution, and `steady` of each entry; the formulas are
/// proved to be periodic and smooth before ([`super::prove`]). `about`: what the claim says besides.
pub fn prove(
    spec: &Specification,
    cells: &[Plant],
    about: &About<'_>,
    (claimed, witness): (&[Entry<'_>], &Witness),
    lines: &mut Vec<String>,
) -> Outcome<()> {
    match witness {
        Witness::Linear(witness) => {
            let law = (about.sigma, about.at_samples.map(|law| law.terms));
            cells.iter().try_for_each(|plant| linear::prove(spec, plant, law, (claimed, witness), lines))
        }
        Witness::Trials(witness) => {
            cells.iter().try_for_each(|plant| trials::prove(spec, plant, about, (claimed, witness), lines))
        }
    }
}
