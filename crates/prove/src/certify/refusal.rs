//! What keeps a specification from being decided, as errors at their places in it.

use sigmastar_decide::conditions::BoundingProblem;
use sigmastar_lang::spec::{ErrorKind, SpecErrors, Specification};
use sigmastar_theory::derivation::relative_degree::RelativeDegreeError;

/// Why a specification comes to no run.
#[derive(Clone, Debug)]
pub enum Refusal {
    /// Bounding functions that are refuted, with their counterexamples; not empty.
    Bounds(Vec<BoundingProblem>),
    /// The filter of a relative degree is not stable: the plant is not what the specification says.
    Filter(RelativeDegreeError),
    /// The specification asks for the regulator at samples, and this is about the one in continuous time.
    Sampled,
    /// No Lyapunov triple of the Jacobian is proved: undecided, for no search proves that there is none.
    Jacobian(String),
}

impl Refusal {
    /// The errors at their places in the specification; not empty.
    #[must_use]
    pub fn errors(&self, spec: &Specification) -> Vec<SpecErrors> {
        let at = |field: &str, kind: ErrorKind, message: String, help: &str| {
            vec![spec.errors_at(field, &(0..0), kind, message, Some(help.to_owned()))]
        };
        match self {
            Refusal::Bounds(problems) => problems.iter().map(|problem| problem.errors(spec)).collect(),
            Refusal::Filter(error) => at(
                "/relative_degree/a",
                ErrorKind::Range,
                error.to_string(),
                "the coefficients a_1, ..., a_(r-1) must make s^(r-1) + a_(r-1) s^(r-2) + ... + a_1 stable; mind their \
                 order",
            ),
            Refusal::Sampled => at(
                "/internal_model/sampling_period",
                ErrorKind::Range,
                "the regulator at samples is asked for, and this is about the one in continuous time".to_owned(),
                "leave `sampling_period` out; `sigmastar certify`, `sampling` and `controller` take it",
            ),
            Refusal::Jacobian(message) => at(
                "/lyapunov/jacobian",
                ErrorKind::Undecided,
                message.clone(),
                "check the signs, narrow the intervals or give them as functions of t, or give the triple p_low, p_up, \
                 alpha",
            ),
        }
    }
}
