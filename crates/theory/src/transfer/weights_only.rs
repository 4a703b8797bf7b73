//! A specification for tests of this stage, which uses its period and its internal model only.

use sigmastar_lang::spec::Specification;

/// A power family of weights with these numbers; the plant is as simple as it can be.
pub(crate) fn weights_only(n0: &str, epsilon: &str, mu: &str, frequency: &str) -> Specification {
    let text = format!(
        r#"{{"format": "sigmastar/bounding-spec", "version": 1, "name": "weights only", "period": "1",
        "lyapunov": {{"p_low": "1", "p_up": "1", "alpha": "1"}},
        "bounds": {{"f": "0", "f_e": "0", "f_xx": "0", "f_ex": "0", "q": "1", "q_e": "0", "q_x": "0", "q_t": "1"}},
        "internal_model": {{"mu": "{mu}", "base_frequency": "{frequency}",
          "weights": {{"family": "power", "n0": "{n0}", "epsilon": "{epsilon}"}}}},
        "initial_set": {{"kind": "paper"}}}}"#
    );
    Specification::from_json("test", &text).unwrap()
}
