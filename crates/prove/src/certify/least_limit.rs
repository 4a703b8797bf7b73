//! The least limit that is named where one is not kept: it is one for which a claim is proved (derivation, 13.5).

use super::limits::{FloatLimits, with_limit};
use super::options::Limits;
use rug::Rational;
use sigmastar_exact::number::{Direction, Portable, round_f64};
use sigmastar_lang::spec::Specification;
use sigmastar_propose::search::Failing;

/// By how much more than the least of a search in floating point a limit is asked for, in turn, until a claim keeps to it.
const MORE: [f64; 5] = [2e-4, 2e-3, 2e-2, 0.2, 1.0];

/// Steps of the bisection between what was asked for and what is kept, and what is not worth one.
const STEPS: usize = 6;
const CLOSE: f64 = 1.02;

/// Digits of a limit.
const DIGITS: u32 = 4;

/// The failure with a limit that is kept, where one is found: `proves` says at which gain a claim keeps to these limits, as one does that is
/// asked for.
///
/// Guarantee: what is called proved is kept by a claim that is proved. That no smaller limit is, is not said.
pub(super) fn with_least_kept(
    spec: &Specification,
    limits: &Limits,
    failing: Failing,
    proves: impl Fn(&Specification, &Limits, FloatLimits) -> Option<f64>,
) -> Failing {
    let Failing::Limit { which, asked, beside, least, .. } = failing else { return failing };
    let kept = |limit: f64| {
        let limit = round_f64(limit, DIGITS, Direction::Up)?;
        let (spec, limits) = with_limit(spec, limits, which, &limit);
        let float = FloatLimits::new(&spec, &limits)?;
        proves(&spec, &limits, float).map(|sigma| (limit, sigma))
    };
    let Some((mut limit, mut gain)) = MORE.iter().find_map(|more| kept(least.max(asked) * (1.0 + more))) else {
        return failing;
    };
    let mut below = asked;
    for _ in 0..STEPS {
        if limit.to_f64() <= below * CLOSE {
            break;
        }
        let middle = (0.5 * (below.portable_ln() + limit.to_f64().portable_ln())).portable_exp();
        match kept(middle) {
            Some(less) if less.0 < limit => (limit, gain) = less,
            _ => below = middle,
        }
    }
    Failing::Limit { which, asked, beside, least: Rational::to_f64(&limit), sigma: gain, proved: true }
}
