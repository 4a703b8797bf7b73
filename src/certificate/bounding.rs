//! The proof that the bounding functions are what the derivation needs: finite, nonnegative, nondecreasing.

use crate::expr::{BoundingFailure, ProofSettings, prove_bounding};
use crate::spec::model::Specification;
use rug::Rational;

/// A bounding function that could not be proved.
#[derive(Clone, Debug)]
pub struct BoundingProblem {
    /// The field under `bounds`.
    pub field: &'static str,
    /// Why.
    pub failure: BoundingFailure,
}

/// Proves every bounding function on the domain, or, in a direction without a domain, up to `used`.
///
/// Guarantee: `Ok` means that each is finite, nonnegative and nondecreasing in X and in E on the closed box, so that its
/// value at (X, E) bounds its values at smaller arguments.
///
/// # Errors
/// All bounding functions that fail, in the order of the fields.
pub fn prove_bounds(spec: &Specification, used: Option<(&Rational, &Rational)>) -> Result<(), Vec<BoundingProblem>> {
    const PRECISION: u32 = 128;
    let edge = |constant: &crate::spec::model::Constant| constant.enclose(PRECISION).upper_rational();
    let from_domain = spec.domain.as_ref().and_then(|domain| edge(&domain.x).zip(edge(&domain.e)));
    let Some((x, e)) = from_domain.or_else(|| used.map(|(x, e)| (x.clone(), e.clone()))) else {
        return Ok(());
    };
    let problems: Vec<BoundingProblem> = spec
        .bounds
        .named()
        .filter_map(|(field, expr)| {
            let failure = prove_bounding(expr, &x, &e, &ProofSettings::default()).err()?;
            Some(BoundingProblem { field, failure })
        })
        .collect();
    if problems.is_empty() { Ok(()) } else { Err(problems) }
}
