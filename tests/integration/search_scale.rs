//! The search knows no scale of its own, and no transfer proof beats the one it may choose.

use crate::mutants;
use crate::support::{EXAMPLE_TEXT, every};
use rug::Rational;
use sigmastar_lang::spec::Specification;
use sigmastar_prove::certify::{Options, TransferChoice, certify};

/// A specification with a matched base frequency, or with the one given.
fn spec(period: &str, mu: &str, q: &str, frequency: Option<&str>) -> Specification {
    let matched = frequency.is_none();
    let frequency = frequency.map_or_else(|| format!("2*pi/({period})"), str::to_owned);
    let text = format!(
        r#"{{ "format": "sigmastar/bounding-spec", "version": 1, "name": "scale", "period": "{period}",
        "lyapunov": {{ "p_low": "1", "p_up": "1.5", "alpha": "1/2" }},
        "bounds": {{ "f": "X + E/10", "f_e": "1/10", "f_xx": "0", "f_ex": "0", "q": "{q}", "q_e": "0", "q_x": "0",
          "q_t": "{q}" }},
        "internal_model": {{ "mu": "{mu}", "base_frequency": "{frequency}", "matched": {matched},
          "weights": {{ "family": "power", "n0": "2", "epsilon": "1/2" }} }},
        "initial_set": {{ "kind": "paper" }} }}"#
    );
    Specification::from_json("scale", &text).unwrap()
}

fn sigma(spec: &Specification, transfer: TransferChoice) -> Rational {
    let run = certify(spec, Options { transfer, compare: false, ..Options::default() }).unwrap();
    run.sigma_star().unwrap_or_else(|| panic!("{transfer:?}: {:?}", run.conditions())).clone()
}

/// sigma T far below 1e-12, by a small mu and by a small period.
#[test]
fn tiny_gains_are_found() {
    for (period, mu) in [("1", "1e-16"), ("1e-30", "1"), ("1", "1e-40"), ("1e20", "1e-30")] {
        let spec = spec(period, mu, "0", None);
        let sharp = sigma(&spec, TransferChoice::Best);
        let run = certify(&spec, Options::default()).unwrap();
        let repaired = run.constants().repaired.as_ref().unwrap().proved().expect("proved").witness.sigma.clone();
        assert!(sharp <= repaired, "T = {period}, mu = {mu}: {} {}", sharp.to_f64(), repaired.to_f64());
        // C5 alone sets sigma here, and it contains mu and no time but 1/alpha: about mu Nbar^2 times a number.
        let mu: f64 = mu.parse().unwrap();
        assert!(sharp.to_f64() < 100.0 * mu, "T = {period}, mu = {mu}: {}", sharp.to_f64());
    }
}

/// A bound of the root mean square that is larger than that of the supremum does no harm.
#[test]
fn a_needless_rms_bound_changes_nothing() {
    let (q, rms) = ("\"q\": \"4.822 + X + atan(E*(X + 0.189))\"", "\"q_rms\": \"1e4*(4.822 + X + E)\"");
    assert!(EXAMPLE_TEXT.contains(q));
    let with = EXAMPLE_TEXT.replace(q, &format!("{q}, {rms}, \"q_t_rms\": \"1e4 + 1e4*E\""));
    let [plain, with] = [EXAMPLE_TEXT, &with].map(|text| {
        let spec = Specification::from_json("rms", text).unwrap();
        sigma(&spec, TransferChoice::Best)
    });
    assert_eq!(plain, with);
}

/// Each transfer proof by itself gives no smaller gain than the choice among them.
#[test]
fn the_best_is_not_above_any_other() {
    for (period, mu, q, frequency) in [
        ("1", "1", "1", None),
        ("2.5e-3", "40", "0.3", Some("800")),
        ("7e4", "3e-3", "20", Some("1.7e-6")),
        ("31", "6e5", "1e-4", Some("5e-2")),
    ]
    .into_iter()
    .step_by(every(4))
    {
        let spec = spec(period, mu, q, frequency);
        let best = sigma(&spec, TransferChoice::Best);
        for other in [TransferChoice::ClosedForm, TransferChoice::Boxes].map(|transfer| sigma(&spec, transfer)) {
            assert!(best <= other, "T = {period}: {} {}", best.to_f64(), other.to_f64());
        }
    }
}

/// Candidates at the edge of what is possible: short X_p and E_p leave it (150, 223), and so would an X_p beyond the domain
/// where nothing depends on x (182). A larger sigma was the answer to each: 1.2e28, 1.706e8 and 6.15.
#[test]
fn the_edge_of_the_possible_costs_no_gain() {
    for (seed, largest) in [(150, 1.2e23), (182, 4.03), (223, 1.69e8)] {
        let spec = Specification::from_json("mutant", &mutants::specification(seed).to_string()).unwrap();
        let sigma = sigma(&spec, TransferChoice::Best);
        assert!(sigma <= largest, "seed {seed}: {}", sigma.to_f64());
    }
}
