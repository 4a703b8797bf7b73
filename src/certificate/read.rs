//! Reading the witness of a certificate.

use crate::constants::exact_regulation::ExactWitness;
use crate::constants::repaired::RepairedWitness;
use crate::constants::sharp::SharpWitness;

/// A witness as read from a certificate.
#[derive(Clone, Debug)]
pub enum WitnessFile {
    /// Of the sharp derivation, with the exact-regulation part where it is there.
    Sharp {
        /// The free numbers.
        witness: SharpWitness,
        /// Exact regulation.
        exact: Option<ExactWitness>,
    },
    /// Of the repaired derivation.
    Repaired {
        /// The free numbers.
        witness: RepairedWitness,
    },
}
