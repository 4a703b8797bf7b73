//! Plants of the tests, and the parts together.

use super::*;
use crate::plant::Plant;

/// A plant of some states; everything that the orbit does not need is the same.
pub(super) fn plant(period: &str, states: &[&str], f: &[&str], q: &str) -> Plant {
    let list = |items: &[&str]| items.iter().map(|item| format!("{item:?}")).collect::<Vec<_>>().join(", ");
    let zeros = vec!["0"; states.len()];
    let text = format!(
        r#"{{ "format": "sigmastar/plant", "version": 1, "name": "test", "period": "{period}", "states": [{}], "f": [{}],
        "q": "{q}", "initial": {{ "x": [{}], "e": "0" }}, "internal_model": {{ "mu": "1", "base_frequency": "2*pi/({period})",
        "matched": true, "weights": {{ "family": "power", "n0": "2", "epsilon": "1/2" }} }} }}"#,
        list(states),
        list(f),
        list(&zeros)
    );
    Plant::from_json("test", &text).unwrap()
}

pub(super) fn paper() -> Plant {
    Plant::from_json("paper", include_str!("../../specs/plants/paper-example.json")).unwrap()
}

#[test]
fn the_orbit_of_the_paper_in_doubles() {
    let orbit = find_orbit(&paper()).unwrap();
    let start = orbit.series.at(0.0).0;
    assert!((start[0] + 0.17869).abs() < 1e-5 && (start[1] - 0.073256).abs() < 1e-6, "{start:?}");
    let size = orbit.series.samples(999).iter().map(|x| x[0].hypot(x[1])).fold(0.0, f64::max);
    assert!((size - 0.21894).abs() < 1e-5, "{size}");
    assert!(orbit.defect < 1e-10, "{}", orbit.defect);
    let [first, second] = orbit.floquet[..] else { panic!("{:?}", orbit.floquet) };
    for exponent in [first, second] {
        assert!((exponent[0] + 0.59999).abs() < 1e-5 && (exponent[1].abs() - 1.7357).abs() < 1e-4, "{exponent:?}");
    }
}

#[test]
fn plants_of_other_sizes_in_doubles() {
    for (period, f, x0, exponent) in [
        ("1", "-x + cos(2*pi*t)", 1.0 / (1.0 + std::f64::consts::TAU.powi(2)), -1.0),
        ("1/50", "-x + cos(100*pi*t)", 1.0 / (1.0 + (100.0 * std::f64::consts::PI).powi(2)), -1.0),
        ("1000", "-x + cos(2*pi*t/1000)", 1.0 / (1.0 + (std::f64::consts::TAU / 1000.0).powi(2)), -1.0),
        ("1", "-2000*x + 2000*cos(2*pi*t)", 1.0 / (1.0 + (std::f64::consts::TAU / 2000.0).powi(2)), -2000.0),
        ("1", "-x + x*e", 0.0, -1.0),
    ] {
        let orbit = find_orbit(&plant(period, &["x"], &[f], "x")).unwrap();
        assert!((orbit.series.at(0.0).0[0] - x0).abs() < 1e-11, "{f}");
        assert!((orbit.floquet[0][0] - exponent).abs() < 1e-6 * exponent.abs(), "{f} {:?}", orbit.floquet);
        assert!(orbit.defect <= 1e-11, "{f} {}", orbit.defect);
    }
    let empty = find_orbit(&plant("1", &[], &[], "cos(2*pi*t)")).unwrap();
    assert_eq!(empty.series, FloatSeries { mean: Vec::new(), harmonics: Vec::new() });
}

#[test]
fn plants_without_a_stable_orbit_are_answered_with_exponents() {
    for (f, real) in [
        (vec!["x + cos(2*pi*t)", "-y"], 1.0),
        (vec!["y", "-x + cos(2*pi*t)"], 0.0),
        (vec!["sin(2*pi*t)", "-y"], 0.0),
        (vec!["x/10 + cos(2*pi*t)*x", "-2000*y"], 0.1),
    ] {
        let failure = find_orbit(&plant("1", &["x", "y"], &f, "x")).unwrap_err();
        let OrbitFailure::NotStable { floquet } = &failure else { panic!("{f:?} {failure}") };
        assert!((floquet[0][0] - real).abs() < 1e-6, "{f:?} {floquet:?}");
        assert!(failure.to_string().contains("no certificate of this kind"));
    }
    // x' = 1 has no periodic solution, nor has x' = x^2 + 1.
    for f in ["1", "x^2 + 1"] {
        let failure = find_orbit(&plant("1", &["x"], &[f], "x")).unwrap_err();
        assert!(matches!(failure, OrbitFailure::NotFound { .. }), "{f} {failure:?}");
    }
    // Around 0 there is an unstable orbit, and a simulation finds a stable one.
    let orbit = find_orbit(&plant("1", &["x"], &["x - x^3 + cos(2*pi*t)/10"], "x")).unwrap();
    assert!(orbit.series.mean[0].abs() > 0.9 && orbit.floquet[0][0] < -1.9);
}

/// Everything for a plant: the curve, the coordinates of the largest rate, the proof.
fn proved(plant: &Plant) -> (Coordinates, ProvedOrbit) {
    let found = find_orbit(plant).unwrap();
    let orbit = round_orbit(plant, &found).unwrap();
    let coordinates = propose_coordinates(plant, &found, 0.0, 0.0).unwrap().remove(0);
    let proof = prove_orbit(plant, &orbit, &coordinates).unwrap_or_else(|failure| panic!("{failure}"));
    (coordinates, proof)
}

#[test]
fn the_orbit_of_the_paper_is_proved() {
    let plant = paper();
    let clock = std::time::Instant::now();
    let found = find_orbit(&plant).unwrap();
    println!("found {:?} K {} defect {}", clock.elapsed(), found.series.harmonics.len(), found.defect);
    let clock = std::time::Instant::now();
    let orbit = round_orbit(&plant, &found).unwrap();
    println!("rounded {:?} K {}", clock.elapsed(), orbit.harmonics.len());
    let clock = std::time::Instant::now();
    let candidates = propose_coordinates(&plant, &found, 0.0, 0.0).unwrap();
    println!("coordinates {:?}", clock.elapsed());
    for candidate in &candidates {
        println!("{} {:?} {}", candidate.rate, candidate.l, candidate.p.harmonics.len());
    }
    let clock = std::time::Instant::now();
    let proof = prove_orbit(&plant, &orbit, &candidates[0]).unwrap();
    println!("proved {:?} {proof:?}", clock.elapsed());
    let clock = std::time::Instant::now();
    decide_orbit(&plant, &candidates[0], &proof).unwrap();
    println!("decided {:?}", clock.elapsed());
    assert!(proof.radius <= 1e-8);
}
