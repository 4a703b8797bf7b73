//! From a specification to a decided claim: search, rounding, rigorous decision, certificate file.

mod bounding;
mod decide;
mod lyapunov;
mod matrix_checks;
mod produce;
mod read;
mod round;
mod run;
mod verdict;
mod write;

pub use bounding::{BoundingProblem, prove_on_domain, prove_up_to};
pub use decide::{Ladder, decide_exact, decide_repaired, decide_sharp};
pub use lyapunov::{Resolution, lyapunov_json, matrix_json, resolve, resolve_with};
pub use matrix_checks::{ContractionCheck, MatrixChecks, SylvesterCheck};
pub use produce::{certify, recheck};
pub use read::{WitnessFile, read_lyapunov, read_witness};
pub use run::{
    Certification, Derivation, ExactClaim, Options, Outcome, PrintedFigure, RelativeDegreeGains, RepairedProof,
    SharpProof, TransferChoice,
};
pub use verdict::Verdict;
pub use write::{FORMAT, VERSION, conditions_json, constants_json, statement};

/// The certificate of a run, with the witnesses of its matrix inequalities; `None` unless certified.
#[must_use]
pub fn certificate_json(run: &Certification<'_>) -> Option<serde_json::Value> {
    let mut certificate = write::certificate_json(run)?;
    if let Some(serde_json::Value::Object(witness)) = certificate.get_mut("witness") {
        witness.extend(lyapunov_json(run.spec).map(|value| ("lyapunov".to_owned(), value)));
        if run.options.derivation == Derivation::Sharp {
            let multipliers = run.checks.decay.iter().flatten().find_map(|check| check.multipliers.as_ref());
            witness.extend(multipliers.map(|[l_x, l_e, l_f]| {
                let [l_x, l_e, l_f] = [l_x, l_e, l_f].map(crate::number::write_exact);
                ("lmi".to_owned(), serde_json::json!({ "l_x": l_x, "l_e": l_e, "l_f": l_f }))
            }));
        }
    }
    Some(certificate)
}
