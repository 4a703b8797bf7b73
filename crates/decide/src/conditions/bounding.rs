//! The proof that the bounding functions are what the derivation needs: finite, nonnegative, nondecreasing.

use rug::Rational;
use sigmastar_lang::expr::{BoundingFailure, Expr, ProofSettings, Reason, prove_bounding};
use sigmastar_lang::spec::model::Specification;
use sigmastar_lang::spec::{Bound, ErrorKind, SpecErrors};

/// A bounding function that could not be proved.
#[derive(Clone, Debug)]
pub struct BoundingProblem {
    /// Which.
    pub which: Bound,
    /// Why.
    pub failure: BoundingFailure,
}

impl BoundingProblem {
    /// The problem as an error at its place in the specification, to be rendered in context.
    #[must_use]
    pub fn errors(&self, spec: &Specification) -> SpecErrors {
        let field = format!("/{}/{}", self.which.section(), self.which.field());
        let text = spec.bounds.own(self.which).map_or("", |expr| expr.text());
        let whole = 0..text.len();
        let (span, kind, help) = match &self.failure {
            BoundingFailure::Refuted { span, .. } => (
                span,
                ErrorKind::Range,
                "correct the expression, or give a `domain` on which it is finite, nonnegative and nondecreasing in X and \
                 in E",
            ),
            BoundingFailure::Undecided { span, .. } => (
                span,
                ErrorKind::Undecided,
                "rewrite it as sums, products and compositions of nondecreasing functions, or give a smaller `domain`",
            ),
        };
        let span = span.clone().unwrap_or(whole);
        spec.errors_at(&field, &span, kind, self.sentence(), Some(help.to_owned()))
            .with_sentence_in_full(self.failure.in_full())
    }

    /// The sentence of the failure; of a rate that must not increase it speaks of the negative.
    #[must_use]
    pub fn sentence(&self) -> String {
        if self.which.is_rate() {
            format!("it must be nonincreasing, so its negative nondecreasing; of the negative: {}", self.failure)
        } else {
            self.failure.to_string()
        }
    }
}

/// Proves every bounding function on the domain of the specification; where there is none, nothing is to be proved here
/// and [`prove_up_to`] is due for the arguments that are used.
///
/// Guarantee: with a domain, `Ok` means that each is finite, nonnegative (its positive part counts) and nondecreasing in X and
/// in E on it, so that its value at (X, E) bounds its values at smaller arguments; one from above may be negative, and a
/// rate from below is nonincreasing.
///
/// # Errors
/// All bounding functions that fail, in the order of the fields.
pub fn prove_on_domain(spec: &Specification) -> Result<(), Vec<BoundingProblem>> {
    const PRECISION: u32 = 128;
    let Some(domain) = &spec.domain else { return Ok(()) };
    let edge = |constant: &sigmastar_lang::spec::model::Constant| constant.enclose(PRECISION).upper_rational();
    // The reader has refused constants without a bounded enclosure; were one to slip through, nothing is proved.
    let ends = edge(&domain.x).zip(edge(&domain.e));
    all(spec, |expr, settings| match &ends {
        Some((x, e)) => prove_bounding(expr, x, e, settings),
        None => Err(BoundingFailure::without_domain()),
    })
}

/// What every bounding function may take of [`ProofSettings::max_operations`] at first: nearly all need far less.
const FIRST_OPERATIONS: u64 = 30_000;

/// What those that need more share, each up to its default: so ten hostile ones take no longer than two.
const SHARED_OPERATIONS: u64 = 1_200_000;

/// Proves every bounding function on [0, x] x [0, e], with the guarantee of [`prove_on_domain`]. What one of them may take
/// depends on how many of them are hard, and not on their order.
///
/// # Errors
/// All bounding functions that fail, in the order of the fields; all of them where x or e is negative.
pub fn prove_up_to(spec: &Specification, x: &Rational, e: &Rational) -> Result<(), Vec<BoundingProblem>> {
    all(spec, |expr, settings| prove_bounding(expr, x, e, settings))
}

/// One proof for each bounding function that is given; those that need more than most share what is left for them.
fn all(
    spec: &Specification,
    proof: impl Fn(&Expr, &ProofSettings) -> Result<(), BoundingFailure>,
) -> Result<(), Vec<BoundingProblem>> {
    let attempt = |which: Bound, expr: &Expr, max_operations: u64| {
        let settings = ProofSettings { max_operations, signed: which.is_signed(), ..ProofSettings::default() };
        if which.is_rate() { proof(&expr.negated(), &settings) } else { proof(expr, &settings) }.err()
    };
    let unfinished =
        |failure: &BoundingFailure| matches!(failure, BoundingFailure::Undecided { reason: Reason::Operations(_), .. });
    let first: Vec<(Bound, &Expr, BoundingFailure)> = spec
        .bounds
        .named()
        .filter_map(|(which, expr)| Some((which, expr, attempt(which, expr, FIRST_OPERATIONS)?)))
        .collect();
    let hard = first.iter().filter(|(.., failure)| unfinished(failure)).count() as u64;
    let share = (SHARED_OPERATIONS / hard.max(1)).min(ProofSettings::default().max_operations);
    let problems: Vec<BoundingProblem> = first
        .into_iter()
        .filter_map(|(which, expr, failure)| {
            let failure = if unfinished(&failure) { attempt(which, expr, share)? } else { failure };
            Some(BoundingProblem { which, failure })
        })
        .collect();
    if problems.is_empty() { Ok(()) } else { Err(problems) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sigmastar_lang::expr::Variables;
    use sigmastar_lang::spec::model::Constant;

    #[test]
    fn a_domain_without_an_end_proves_nothing() {
        let mut spec = Specification::from_json("linear", include_str!("../../../../specs/linear.json")).unwrap();
        let mut domain = spec.domain.clone().unwrap_or_else(|| sigmastar_lang::spec::model::Domain {
            x: Constant::rational(&Rational::from(1)),
            e: Constant::rational(&Rational::from(1)),
        });
        spec.domain = Some(domain.clone());
        assert!(prove_on_domain(&spec).is_ok());
        let text = "1/0".to_owned();
        domain.e = Constant { expr: Expr::parse(&text, Variables::None).unwrap(), text, exact: None };
        spec.domain = Some(domain);
        let problems = prove_on_domain(&spec).unwrap_err();
        assert_eq!(problems.len(), spec.bounds.named().count());
        for problem in problems {
            assert_eq!(problem.failure, BoundingFailure::without_domain(), "{}", problem.which.field());
        }
    }
}
