//! Closed-form constants, valid for every N >= 0, every x >= 0 and every nu > 0.

use super::{TransferStep, decide_steps};
use crate::data::Data;
use crate::enclosure::{Enclosure, Truth};
use rug::Rational;

/// `k0 = (pi^2 - 4)/2 n_1 + max{(1/nu^2 + n_1^2)/n_0, 4 n_0 - 2 n_1}` and
/// `k1 = (8/n_1)(1/nu^2 + (2 n_0 + n_1/3)^2)` (derivation, section 2, closed form), pure numbers.
///
/// Hypotheses: W1-W3 and n_0 > n_1 > ... Guarantee: T_N(x) <= k0 + k1 x^2 for every N >= 0 and x >= 0.
#[must_use]
pub fn closed_form_pair(data: &Data<'_>) -> (Enclosure, Enclosure) {
    let (n_0, n_1) = (&data.n_0, &data.n_1);
    let inverse_nu_squared = data.nu.sqr().recip();
    let pi_term = (Enclosure::pi(data.precision).sqr() - 4) / 2 * n_1;
    let at_zero = (&inverse_nu_squared + n_1.sqr()) / n_0;
    let k0 = pi_term + at_zero.max(&(4 * n_0 - 2 * n_1));
    let k1 = 8 / n_1 * (inverse_nu_squared + (2 * n_0 + n_1 / 3).sqr());
    (k0, k1)
}

/// Decides whether the pair dominates the closed form in both members.
pub(super) fn decide(data: &Data<'_>, k0: &Rational, k1: &Rational) -> (Truth, TransferStep) {
    let (least_k0, least_k1) = closed_form_pair(data);
    let step = |name: &str, least: Enclosure, given: &Rational| TransferStep {
        what: format!("closed form of {name}"),
        lhs: least,
        rhs: data.rational(given),
    };
    decide_steps([step("k0", least_k0.clone(), k0), step("k1", least_k1, k1)], step("k0", least_k0, k0))
}
