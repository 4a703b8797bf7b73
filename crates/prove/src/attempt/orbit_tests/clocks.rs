//! The period known to an interval (derivation, 13.3): the clock is one more parameter.

use super::families::{is_followed, proved};
use rug::Rational;
use sigmastar_decide::orbit::*;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{OrbitCurve, PeriodicMatrix, ProvedForcing, TrigonometricVector};
use sigmastar_theory::evidence::*;

const PAPER: &str = include_str!("../../../../../specs/plants/paper-example.json");

/// The paper's example with a period in an interval around 1, and with k in another one.
fn clocked(period: [&str; 2], k: &str) -> Plant {
    let [low, high] = period;
    let text = PAPER
        .replacen(
            "\"period\": \"1\"",
            &format!(r#""period": {{ "nominal": "1", "low": "{low}", "high": "{high}" }}"#),
            1,
        )
        .replacen("\"matched\": true", "\"matched\": false", 1)
        .replacen("\"states\"", &format!(r#""parameters": {{ "k": {k} }}, "states""#), 1)
        .replacen("x1/5", "k*x1", 1)
        .replace("2*pi*t", "phase")
        .replace("4*pi*t", "2*phase");
    Plant::from_json("clocked", &text).unwrap()
}

const K: &str = r#"{ "nominal": "1/5", "low": "0.19", "high": "0.21" }"#;

#[test]
fn the_orbits_at_other_periods_are_followed() {
    for (k, inside) in [(K, vec![(197, 1000), (399, 400)]), ("0.2", vec![(399, 400)])] {
        let plant = clocked(["0.99", "1.01"], k);
        assert_eq!(plant.parameters.clock(), Some(inside.len() - 1));
        let (coordinates, proof, forcing) = proved(&plant);
        // Second order in the width.
        assert!(proof.defect < Rational::from((1, 500)), "{}", proof.defect.to_f64());
        assert_eq!([proof.orbit.sensitivities.len(), forcing.sensitivities.len()], [inside.len(); 2]);
        decide_orbit(&plant, &coordinates, &proof).unwrap();
        decide_forcing(&plant, &coordinates, &proof, &forcing).unwrap();
        is_followed(&plant, &coordinates, &proof, [inside.into_iter().map(Rational::from).collect()]);
    }
}

#[test]
fn an_orbit_or_a_forcing_without_the_clock_is_refused() {
    let plant = clocked(["0.99", "1.01"], K);
    let (coordinates, proof, forcing) = proved(&plant);
    let zero = TrigonometricVector { mean: vec![Rational::new(); 2], harmonics: Vec::new() };
    let with = |sensitivities: Vec<TrigonometricVector>| OrbitProof {
        orbit: OrbitCurve { sensitivities, ..proof.orbit.clone() },
        ..proof.clone()
    };
    let own = &proof.orbit.sensitivities;
    for forged in
        [with(vec![own[0].clone()]), with(vec![own[0].clone(), zero]), with(vec![own[1].clone(), own[0].clone()])]
    {
        assert!(decide_orbit(&plant, &coordinates, &forged).is_err());
    }
    let parts = &forcing.sensitivities;
    for sensitivities in [vec![parts[0].clone()], vec![parts[0].clone(); 2], vec![parts[1].clone(), parts[0].clone()]] {
        let forged = ProvedForcing { sensitivities, ..forcing.clone() };
        assert!(decide_forcing(&plant, &coordinates, &proof, &forged).is_err());
    }
    // A proof for a narrower interval is none for a wider one.
    assert!(decide_orbit(&clocked(["0.95", "1.05"], K), &coordinates, &proof).is_err());
    // A single period has no clock.
    assert_eq!(clocked(["1", "1"], K).parameters.clock(), None);
    assert!(decide_orbit(&clocked(["1", "1"], K), &coordinates, &proof).is_err());
}

/// With P = 2 + cos(phase) the rate of `x' = -x - x P'/(2 P)`, P' by the nominal time, is 1 at the nominal period, and falls to
/// `1 - |v - 1| pi/sqrt(3)` where the clock is v: 0.8186 at v = 1.1.
#[test]
fn a_matrix_that_varies_moves_with_the_clock() {
    let text = |low: &str, high: &str| {
        format!(
            r#"{{ "format": "sigmastar/plant", "version": 1, "name": "moving",
            "period": {{ "nominal": "1", "low": "{low}", "high": "{high}" }}, "states": ["x"],
            "f": ["-x + pi*sin(phase)/(2 + cos(phase))*x"], "q": "e + sin(phase)", "internal_model": {{ "mu": "1",
            "base_frequency": "2*pi", "weights": {{ "family": "power", "n0": "2", "epsilon": "1/2" }} }} }}"#
        )
    };
    let [one, zero] = [1, 0].map(|value| vec![vec![Rational::from(value)]]);
    let p = PeriodicMatrix { mean: vec![vec![Rational::from(2)]], harmonics: vec![[one.clone(), zero]] };
    let coordinates = Coordinates { l: one, p };
    let still = || TrigonometricVector { mean: vec![Rational::new()], harmonics: Vec::new() };
    let decide = |ends: [&str; 2], alpha: (u32, u32)| {
        let plant = Plant::from_json("moving", &text(ends[0], ends[1])).unwrap();
        let sensitivities = plant.parameters.clock().map(|_| still()).into_iter().collect();
        let small = |value: u32| Rational::from((value, 1_000_000));
        let proof = OrbitProof {
            orbit: OrbitCurve { centre: still(), sensitivities },
            defect: small(1),
            tube: small(10),
            radius: small(4),
            alpha: Rational::from(alpha),
            p_low: Rational::from((99, 100)),
            p_up: Rational::from((301, 100)),
        };
        decide_orbit(&plant, &coordinates, &proof)
    };
    assert_eq!(decide(["1", "1"], (99, 100)), Ok(()));
    assert_eq!(decide(["10/11", "1"], (81, 100)), Ok(()));
    assert!(decide(["10/11", "1"], (83, 100)).is_err());
    // At v = 10/12 the rate is 0.6977.
    assert_eq!(decide(["1", "1.2"], (69, 100)), Ok(()));
    assert!(decide(["1", "1.2"], (71, 100)).is_err());
}

/// What is left of q = sin(phase) with no harmonic taken out: 1, and its derivative by the time of every clock, 2 pi v up to v = 1.1.
#[test]
fn the_rest_moves_with_the_clock() {
    let text = r#"{ "format": "sigmastar/plant", "version": 1, "name": "rest", "period": { "nominal": "1", "low": "10/11", "high": "1.2" },
        "states": ["x"], "f": ["-x + e"], "q": "sin(phase)", "internal_model": { "mu": "1", "base_frequency": "2*pi",
        "weights": { "family": "power", "n0": "2", "epsilon": "1/2" } } }"#;
    let plant = Plant::from_json("rest", text).unwrap();
    let (coordinates, proof, _) = proved(&plant);
    let decide = |rest_t: (u32, u32)| {
        let none = sigmastar_lang::spec::Wave { mean: Rational::new(), harmonics: Vec::new() };
        let forcing = ProvedForcing {
            mean: Rational::new(),
            harmonics: Vec::new(),
            sensitivities: vec![none],
            rest: Rational::from((101, 100)),
            rest_t: Rational::from(rest_t),
        };
        decide_forcing(&plant, &coordinates, &proof, &forcing)
    };
    assert_eq!(decide((693, 100)), Ok(()));
    assert!(decide((690, 100)).is_err());
}
