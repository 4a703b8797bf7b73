//! Random valid specifications over many orders of magnitude: every one with the paper's set, or at rest without the
//! user's X_0, E_0, certifies.

use crate::support::count;
use proptest::prelude::*;
use sigmastar_lang::spec::Specification;
use sigmastar_prove::certificate::certificate_json;
use sigmastar_prove::certify::{Options, Outcome, Verdict, certify};
use sigmastar_prove::lmi::{CrossCheck, CrossCheckError};

/// A decimal with a random exponent: the orders of magnitude are what is tested.
fn magnitude(span: i32) -> impl Strategy<Value = String> {
    (1..10_u32, 0..100_u32, -span..=span).prop_map(|(a, b, exponent)| format!("{a}.{b:02}e{exponent}"))
}

/// Zero now and then: bounding functions that vanish are corners of every formula.
fn coefficient() -> impl Strategy<Value = String> {
    prop_oneof![1 => Just("0".to_owned()), 5 => magnitude(6)]
}

prop_compose! {
    fn specification()(
        period in magnitude(6),
        p_low in magnitude(3),
        ratio in prop_oneof![Just("1".to_owned()), Just("1e4".to_owned()), (10..900_u32).prop_map(|r| format!("{}.{:02}", r / 10, r))],
        alpha in magnitude(6),
        mu in magnitude(6),
        f in [coefficient(), coefficient(), coefficient(), coefficient()],
        q in [coefficient(), coefficient(), coefficient(), coefficient(), coefficient()],
        epsilon in prop_oneof![Just("1/1000"), Just("1/2"), Just("1")],
        n0 in prop_oneof![Just("1.001"), Just("2"), Just("1000")],
        frequency in prop_oneof![Just(None), magnitude(6).prop_map(Some)],
        kind in prop_oneof![Just("paper"), Just("at-rest")],
        one_sided in prop_oneof![2 => Just(None), 1 => prop_oneof![Just("0"), Just("-0.99"), Just("1/3"), Just("-0.9")].prop_map(Some)],
    ) -> String {
        let [fx, fe, fxx, fex] = f;
        let [q0, qx, qe, qt, curved] = q;
        let matched = frequency.is_none();
        let frequency = frequency.unwrap_or_else(|| format!("2*pi/({period})"));
        // A bound of dq/de from above that is a share of its norm where that is least, so that it never falls.
        let one_sided = one_sided.map_or_else(String::new, |share| format!(r#""q_e_max": "({share})*({qe})","#));
        format!(
            r#"{{"format": "sigmastar/bounding-spec", "version": 1, "name": "random", "period": "{period}",
            "lyapunov": {{"p_low": "{p_low}", "p_up": "{p_low}*{ratio}", "alpha": "{alpha}"}},
            "bounds": {{"f": "({fx})*X + ({fxx})*X^2/2 + (({fe}) + ({fex})*X)*E", "f_e": "({fe}) + ({fex})*X",
              "f_xx": "{fxx}", "f_ex": "{fex}", "q": "({q0}) + ({qx})*X + ({qe})*E + ({curved})*E*X^2",
              "q_e": "({qe}) + ({curved})*X^2", {one_sided} "q_x": "({qx}) + 2*({curved})*E*X", "q_t": "{qt}"}},
            "internal_model": {{"mu": "{mu}", "base_frequency": "{frequency}", "matched": {matched},
              "weights": {{"family": "power", "n0": "{n0}", "epsilon": "{epsilon}"}}}},
            "initial_set": {{"kind": "{kind}"}}}}"#
        )
    }
}

fn verdict(text: &str) -> Result<Verdict, TestCaseError> {
    let spec = Specification::from_json("random", text).map_err(|e| TestCaseError::fail(format!("{e:?}\n{text}")))?;
    let run = certify(&spec, Options::default()).map_err(|e| TestCaseError::fail(format!("{e:?}\n{text}")))?;
    if let Some(certificate) = certificate_json(&run) {
        let report = proofs_check::check(certificate.to_string().as_bytes());
        prop_assert_eq!(report.verdict, proofs_check::verdict::Verdict::Valid, "{}\n{}", report.text(false), text);
    }
    let repaired = run.constants().repaired.as_ref().and_then(Outcome::proved);
    prop_assert!(repaired.is_some(), "{}", text);
    if let Some(proof) = run.sharp.proved() {
        no_better_weights(proof.witness.sigma.to_f64(), run.checks.decay.as_ref(), text)?;
    }
    Ok(run.verdict)
}

/// Where C5 sets sigma*, the semidefinite program with C4 finds no w_x and h in the error box that lower its threshold by
/// more than rounding gave away: the search is at the optimum.
fn no_better_weights(
    sigma: f64,
    check: Option<&Result<CrossCheck, CrossCheckError>>,
    text: &str,
) -> Result<(), TestCaseError> {
    let Some(Ok(CrossCheck { fixed, free: Ok(free), .. })) = check else { return Ok(()) };
    let threshold = fixed.closed_form.midpoint_f64();
    if sigma <= threshold * (1.0 + 1e-4) {
        let room = 1.0 - free.solver_sigma / threshold;
        prop_assert!(room <= 1e-4, "{room:e} {text}");
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: count(2, 100), max_shrink_iters: 40, ..ProptestConfig::default() })]

    #[test]
    fn every_one_is_certified(text in specification()) {
        prop_assert_eq!(verdict(&text)?, Verdict::Certified, "{}", text);
    }
}
