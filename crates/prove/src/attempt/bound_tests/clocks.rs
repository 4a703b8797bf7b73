//! Bounds of a plant whose period is known to an interval (derivation, 13.3): derivatives by time are those of the clock.

use super::*;

/// `x' = -x + x P'/..` as [`crate::orbit`] tests it: with P = 2 + cos(phase) its rate is 1 - |v - 1| pi/sqrt(3); q_t = x cos(phase) 2 pi v.
fn engine(period: &str) -> Engine {
    let text = r#"{ "format": "sigmastar/plant", "version": 1, "name": "clock", "period": PERIOD, "states": ["x"],
        "f": ["-x + pi*sin(phase)/(2 + cos(phase))*x"], "q": "x*sin(phase)", "internal_model": { "mu": "1",
        "base_frequency": "2*pi", "weights": { "family": "power", "n0": "2", "epsilon": "1/2" } } }"#;
    let plant = Plant::from_json("clock", &text.replacen("PERIOD", period, 1)).unwrap();
    let still = || TrigonometricVector { mean: vec![Rational::new()], harmonics: Vec::new() };
    let sensitivities = plant.parameters.clock().map(|_| still()).into_iter().collect();
    let orbit = sigmastar_lang::spec::OrbitCurve { centre: still(), sensitivities };
    let region = Region::new(vec![vec![rational("1")]], orbit, rational("0")).unwrap();
    let [one, zero] = [1, 0].map(|value| vec![vec![Rational::from(value)]]);
    let matrix = PeriodicMatrix { mean: vec![vec![Rational::from(2)]], harmonics: vec![[one, zero]] };
    Engine::new(&plant, region, Some(matrix), None).unwrap()
}

#[test]
fn derivatives_by_time_are_those_of_every_clock() {
    let decide = |period: &str, bound: Bound, value: &str| {
        let [x, e] = [rational("1"), rational("1")];
        engine(period).decide(&Entry { bound, x, e, value: rational(value) }, 8000).truth.is_true()
    };
    // v in [10/12, 1.1]; |q_tx| reaches 2 pi v = 6.9115, and 6.2832 at v = 1.
    let interval = r#"{ "nominal": 1, "low": "10/11", "high": "1.2" }"#;
    for (period, bound, holds, fails) in [
        ("1", Bound::Rate, "0.99", "1.01"),
        (interval, Bound::Rate, "0.69", "0.71"),
        ("1", Bound::Qtx, "6.3", "6.28"),
        (interval, Bound::Qtx, "6.93", "6.9"),
    ] {
        assert!(decide(period, bound, holds), "{period}, {bound:?}");
        assert!(!decide(period, bound, fails), "{period}, {bound:?}");
    }
}
