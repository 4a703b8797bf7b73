//! A bounding function enters by its positive part: a sign that rounding hides is no obstacle, a negative value is one.

use sigmastar_lang::expr::{BoundingFailure, Property};
use sigmastar_lang::spec::Specification;
use sigmastar_propose::search::FloatModel;
use sigmastar_prove::certify::{Options, Refusal, Verdict, certify};
use sigmastar_theory::data::{Bound, Data, Problem};
use sigmastar_theory::transfer::TradeOff;

fn spec(f: &str, f_e: &str) -> Specification {
    let text = format!(
        r#"{{ "format": "sigmastar/bounding-spec", "version": 1, "name": "positive part", "period": "1",
        "lyapunov": {{ "p_low": "1", "p_up": "1.5", "alpha": "1/2" }},
        "bounds": {{ "f": "{f}", "f_e": "{f_e}", "f_xx": "0.2", "f_ex": "0.1", "q": "1 + X", "q_e": "0.1", "q_x": "1",
          "q_t": "1" }}, "domain": {{ "X": "100", "E": "100" }},
        "internal_model": {{ "mu": "1", "base_frequency": "2*pi", "matched": true,
          "weights": {{ "family": "power", "n0": "2", "epsilon": "1/2" }} }}, "initial_set": {{ "kind": "paper" }} }}"#
    );
    Specification::from_json("positive part", &text).unwrap()
}

#[test]
fn a_value_of_zero_that_rounding_hides_is_used_as_zero() {
    // The first is 0 at the origin by exp(0) = 1, the second by an identity that nothing here knows.
    let (f, f_e) = ("X + 0.1*exp(X) - 0.1 + E", "log(exp(2)) - 2 + 0.1*X");
    let spec = spec(f, f_e);
    let run = certify(&spec, Options::default()).unwrap();
    assert_eq!(run.verdict, Verdict::Certified, "{:?}", run.unproved_bounds);
    for precision in [53, 128, 300] {
        let data = Data::new(&spec, precision);
        for bound in [Bound::F, Bound::Fe] {
            let value = data.bound(bound, &data.zero(), &data.zero());
            assert!(value.is_nonnegative().is_true() && value.contains_zero(), "{bound:?} {value:?}");
            let expr = bound.of(&spec).unwrap();
            assert!(!expr.enclose(&data.zero(), &data.zero()).is_nonnegative().is_true(), "{bound:?}");
        }
        let model = FloatModel::new(&data, TradeOff::closed_form(&data));
        assert!(model.bound(Bound::Fe, &0.0, &0.0) >= 0.0);
    }
}

#[test]
fn the_search_uses_the_positive_part_too() {
    let spec = spec("X", "X - 1");
    let data = Data::new(&spec, 128);
    let model = FloatModel::new(&data, TradeOff::closed_form(&data));
    assert_eq!((model.bound(Bound::Fe, &0.5, &0.0), model.bound(Bound::Fe, &3.0, &0.0)), (0.0, 2.0));
}

#[test]
fn a_certainly_negative_value_is_bad_input() {
    let spec = spec("X", "0.1*X - 1e-40");
    let Err(Refusal::Bounds(problems)) = certify(&spec, Options::default()) else { panic!("it is refuted") };
    assert_eq!(problems.len(), 1);
    assert_eq!(problems[0].which, Bound::Fe);
    let refuted = matches!(problems[0].failure, BoundingFailure::Refuted { property: Property::Nonnegative, .. });
    assert!(refuted, "{:?}", problems[0].failure);
}
