//! From a specification to a decided claim: search, rounding, rigorous decision, certificate file.

mod best;
mod bounding;
mod consequences;
mod decide;
mod figures;
mod lyapunov;
mod matrix_checks;
mod no_plant;
mod produce;
mod read;
mod round;
mod run;
mod verdict;
mod write;

pub use bounding::{BoundingProblem, prove_on_domain, prove_up_to};
pub use decide::{Ladder, decide_exact, decide_repaired, decide_sharp};
pub use lyapunov::{MAX_SEARCHES, Resolution, lyapunov_json, matrix_json, resolve, resolve_with};
pub use matrix_checks::{ContractionCheck, MatrixChecks, SylvesterCheck};
pub use no_plant::{ExceededBy, NoPlant, has_states, no_plant};
pub use produce::{certify, recheck};
pub use read::{WitnessFile, read_lyapunov, read_witness};
pub use run::{
    Certification, Derivation, ExactClaim, Options, Outcome, PrintedFigure, RelativeDegreeGains, RepairedProof,
    SharpProof, TransferChoice,
};
pub use verdict::Verdict;
pub use write::{FORMAT, VERSION, certificate_json, conditions_json, constants_json, no_plant_json, statement};
