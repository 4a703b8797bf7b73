//! The rate that a drawn F(t) is to have.

use super::claim::TriedClaim;
use super::family::Family;
use super::membership::respects;
use rug::Rational;
use sigmastar_exact::enclosure::DEFAULT_PRECISION;
use sigmastar_lang::expr::{Expr, Variables};
use sigmastar_lang::spec::model::Lyapunov;
use sigmastar_theory::data::Bound;

/// A rate in 1/time.
#[derive(Clone, Debug)]
pub(super) struct WantedRate {
    /// As an expression.
    pub text: String,
    /// As a double.
    pub value: f64,
    /// At least the value of the expression.
    pub above: Rational,
}

/// What a rate that is no double is raised by, relatively, so that the proof that it is enough is short.
const RAISED: u32 = 40;

/// The larger one of alpha and the contraction rate at the origin: with it, F(t) = df/dx has both with the same P, as the
/// contraction rate is nonincreasing. `None` where there is no finite one.
pub(super) fn wanted(claim: &TriedClaim, triple: &Lyapunov) -> Option<WantedRate> {
    let above = triple.alpha.enclose(DEFAULT_PRECISION).upper_rational()?;
    let alpha = WantedRate { text: triple.alpha.text.clone(), value: triple.alpha.to_f64(), above };
    let Some(rate) = claim.spec.bounds.own(Bound::Rate) else { return Some(alpha) };
    let zero = Rational::new();
    let rate = rate.enclose_at(&zero, &zero, DEFAULT_PRECISION);
    let above = rate.upper_rational()?;
    if above <= alpha.above {
        return Some(alpha);
    }
    let exact = rate.lower_rational().is_some_and(|below| below == above);
    let above = if exact { above } else { &above * (Rational::from(1) + (Rational::from(1) >> RAISED)) };
    Some(WantedRate { text: above.to_string(), value: above.to_f64(), above })
}

/// Whether the contraction rate of a claim is proved to be at most the [`wanted`] one, up to its reach. Only for families
/// whose df/dx is F(t).
pub(super) fn is_met(family: &Family, claim: &TriedClaim, left: &mut u64) -> bool {
    let Some(rate) = claim.spec.bounds.own(Bound::Rate) else { return true };
    if family.states() == 0 {
        return true;
    }
    let Some(wanted) = claim.spec.lyapunov.triple().and_then(|triple| wanted(claim, triple)) else { return false };
    let is_enough = |left: &mut u64| {
        let parsed = Expr::parse(&wanted.text, Variables::XAndE);
        rate.text() == wanted.text
            || parsed.is_ok_and(|parsed| respects(Bound::Rate, rate.text(), &parsed, &claim.reach, left))
    };
    family.g_1.value() == 0.0 && family.kappa.value() == 0.0 && is_enough(left)
}
