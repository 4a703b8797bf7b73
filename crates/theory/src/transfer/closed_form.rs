//! Closed-form constants, valid for every N >= 0, every x >= 0 and every nu > 0.

use super::decide_steps;
use crate::condition::Condition;
use crate::data::Data;
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, Truth};

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
pub(super) fn decide(data: &Data<'_>, k0: &Rational, k1: &Rational) -> (Truth, Condition) {
    let (least_k0, least_k1) = closed_form_pair(data);
    let step = |name: &str, least: Enclosure, given: &Rational| {
        Condition::at_most("T", format!("closed form of {name}"), least, data.rational(given))
    };
    decide_steps([step("k0", least_k0.clone(), k0), step("k1", least_k1, k1)], step("k0", least_k0, k0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use sigmastar_lang::spec::Specification;

    /// The formulas in doubles, for both sides of the maximum.
    #[test]
    fn the_pair_is_the_one_of_the_derivation() {
        let text = include_str!("../../../../specs/paper-example.json");
        let family = r#"{ "family": "power", "n0": "2", "epsilon": "1/2" }"#;
        assert!(text.contains(family) && text.contains("\"mu\": \"1\""));
        for (n_0, n_1, mu) in [(2.0, 1.0, 1.0), (7.0, 3.0, 100.0)] {
            let weights = format!(
                r#"{{"family": "explicit", "values": ["{n_0}", "{n_1}"], "tail": {{"coefficient": "{n_1}", "exponent": "3/2"}}}}"#
            );
            let text = text.replace(family, &weights).replace("\"mu\": \"1\"", &format!("\"mu\": \"{mu}\""));
            let spec = Specification::from_json("closed form", &text).unwrap();
            let (k0, k1) = closed_form_pair(&Data::new(&spec, 128));
            let pi = std::f64::consts::PI;
            let inverse = (2.0 * pi / mu).powi(2);
            let expected_k0 =
                (pi * pi - 4.0) / 2.0 * n_1 + f64::max((inverse + n_1 * n_1) / n_0, 4.0 * n_0 - 2.0 * n_1);
            let sum: f64 = 2.0 * n_0 + n_1 / 3.0;
            let expected_k1 = 8.0 / n_1 * (inverse + sum * sum);
            assert!((k0.midpoint_f64() / expected_k0 - 1.0).abs() < 1e-12, "{expected_k0}");
            assert!((k1.midpoint_f64() / expected_k1 - 1.0).abs() < 1e-12, "{expected_k1}");
        }
    }
}
