//! The orbit from the proposal in doubles to the decision, and what is refused; the plants of these tests.

mod clocks;
mod families;
mod precise;

use super::*;
use rug::Rational;
use sigmastar_decide::orbit::*;
use sigmastar_exact::number::Direction;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{PeriodicMatrix, ProvedForcing};
use sigmastar_propose::orbit::*;
use sigmastar_theory::evidence::*;

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
    Plant::from_json("paper", include_str!("../../../../../specs/plants/paper-example.json")).unwrap()
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
fn what_only_adds_up_is_told_as_that() {
    let adds_up = |states: &[&str], f: &[&str]| match find_orbit(&plant("1", states, f, "cos(2*pi*t)")).unwrap_err() {
        OrbitFailure::AddsUp { sum, largest, mean } => (sum, largest, mean),
        other => panic!("{f:?} {other:?}"),
    };
    let one = |sum: &str, largest: usize| (sum.to_owned(), largest, None);
    assert_eq!(adds_up(&["x"], &["cos(2*pi*t)"]), one("'x'", 0));
    assert_eq!(adds_up(&["x", "y"], &["sin(2*pi*t)", "-y"]), one("'x'", 0));
    assert_eq!(adds_up(&["x", "y"], &["x*y - x", "x - x*y"]).0, "'x' + 'y'");
    let (sum, _, mean) = adds_up(&["x", "y", "z"], &["0", "2 - z", "z - 1"]);
    assert_eq!(sum, "'y' + 'z'");
    assert!((mean.unwrap() - 1.0).abs() < 1e-12, "{mean:?}");
    // Beside what is very fast a slow state is none of these: there is no orbit because y has none.
    let fast = ["-x/20 + 100", "10^10*y^2 + 1000"];
    let failure = find_orbit(&plant("1", &["x", "y"], &fast, "cos(2*pi*t)")).unwrap_err();
    assert!(!matches!(failure, OrbitFailure::AddsUp { .. }), "{failure:?}");
}

#[test]
fn plants_without_a_stable_orbit_are_answered_with_exponents() {
    for (f, real) in [
        (vec!["x + cos(2*pi*t)", "-y"], 1.0),
        (vec!["y", "-x + cos(2*pi*t)"], 0.0),
        (vec!["x/10 + cos(2*pi*t)*x", "-2000*y"], 0.1),
    ] {
        let failure = find_orbit(&plant("1", &["x", "y"], &f, "x")).unwrap_err();
        let OrbitFailure::NotStable { floquet } = &failure else { panic!("{f:?} {failure}") };
        assert!((floquet[0][0] - real).abs() < 1e-6, "{f:?} {floquet:?}");
        assert!(failure.to_string().contains("no certificate of this kind"));
    }
    // x' = x^2 + 1 has no periodic solution.
    let failure = find_orbit(&plant("1", &["x"], &["x^2 + 1"], "x")).unwrap_err();
    assert!(matches!(failure, OrbitFailure::NotFound { .. }), "{failure:?}");
    // Around 0 there is an unstable orbit, and a simulation finds a stable one.
    let orbit = find_orbit(&plant("1", &["x"], &["x - x^3 + cos(2*pi*t)/10"], "x")).unwrap();
    assert!(orbit.series.mean[0].abs() > 0.9 && orbit.floquet[0][0] < -1.9);
    // From the top of the hill a simulation goes nowhere: which of the wells is meant is for the user to say.
    let failure = find_orbit(&plant("1", &["x"], &["x - x^3 + e^2"], "x")).unwrap_err();
    assert!(failure.way_out().is_some_and(|help| help.contains("state an `initial`")));
    let failure = find_orbit(&plant("1", &["x"], &["x + x^3 + e^2"], "x")).unwrap_err();
    assert!(matches!(failure, OrbitFailure::NotStable { .. }), "{failure:?}");
    assert!(failure.way_out().is_some_and(|help| help.contains("state an `initial`")));
}

/// Everything for a plant: the curve, the coordinates of the largest rate, the proof.
fn proved(plant: &Plant) -> (Coordinates, OrbitProof) {
    let found = find_orbit(plant).unwrap();
    let orbit = round_orbit(plant, &found).unwrap();
    let coordinates = propose_coordinates(plant, &found, 0.0, 0.0).unwrap().remove(0).coordinates;
    let proof = prove_orbit(plant, &orbit, &coordinates).unwrap_or_else(|failure| panic!("{failure}"));
    (coordinates, proof)
}

#[test]
fn the_orbit_of_the_paper_is_proved_and_decided_again() {
    let plant = paper();
    let (coordinates, proof) = proved(&plant);
    assert!(proof.radius <= Rational::from((1, 100_000_000)), "{}", proof.radius.to_f64());
    assert!(proof.alpha > Rational::from((57, 100)) && proof.p_low == 1 && proof.p_up == 1);
    decide_orbit(&plant, &coordinates, &proof).unwrap();
    let forcing = prove_forcing(&plant, &coordinates, &proof).unwrap();
    decide_forcing(&plant, &coordinates, &proof, &forcing).unwrap();
    let magnitudes: Vec<f64> = std::iter::once(forcing.mean.to_f64().abs())
        .chain(forcing.harmonics.iter().map(|[a, b]| libm::hypot(a.to_f64(), b.to_f64()) / 2.0))
        .collect();
    for (found, expected) in magnitudes.iter().zip([1.8755, 0.79155, 0.49413, 0.12492, 0.062501, 3.6e-7]) {
        assert!((found / expected - 1.0).abs() < 1e-2 && (found - expected).abs() < 6e-5, "{found} {expected}");
    }
    assert!(forcing.rest < Rational::from((1, 1_000_000)) && forcing.rest_t < Rational::from((1, 100_000)));
    let smaller = |value: &Rational| Rational::from(value / 100_u32);
    for moved in [
        ProvedForcing { rest: smaller(&forcing.rest), ..forcing.clone() },
        ProvedForcing { rest_t: smaller(&forcing.rest_t), ..forcing.clone() },
        ProvedForcing { mean: forcing.mean.clone() + Rational::from((1, 1000)), ..forcing.clone() },
    ] {
        let refused = decide_forcing(&plant, &coordinates, &proof, &moved);
        assert!(matches!(refused, Err(OrbitNotProved::Rest { .. })), "{refused:?}");
    }
}

#[test]
fn forged_orbits_are_refused() {
    let plant = paper();
    let (coordinates, proof) = proved(&plant);
    let sampled = Sampled::new(&plant, &proof.orbit, &coordinates).unwrap();
    let refused = |moved: &OrbitProof| decide_orbit(&plant, &coordinates, moved).unwrap_err();
    // Below the largest value that was seen: no proof can reach it.
    let exact = |value: f64| sigmastar_exact::number::round_f64(value, 9, Direction::Down).unwrap();
    let small = OrbitProof { defect: exact(0.99 * sampled.defect), ..proof.clone() };
    assert!(matches!(refused(&small), OrbitNotProved::Defect { .. }));
    let fast = exact(1.001 * sampled.rate);
    assert!(matches!(refused(&OrbitProof { alpha: fast, ..proof.clone() }), OrbitNotProved::Rate { .. }));
    let near = OrbitProof { radius: &proof.radius * Rational::from((99, 100)), ..proof.clone() };
    assert!(matches!(refused(&near), OrbitNotProved::DefectTooLarge { .. }));
    let wide = OrbitProof { radius: proof.tube.clone(), ..proof.clone() };
    assert!(matches!(refused(&wide), OrbitNotProved::DefectTooLarge { .. }));
    // A tube in which the rate falls.
    let large = OrbitProof { tube: Rational::from(2), ..proof.clone() };
    assert!(matches!(refused(&large), OrbitNotProved::Rate { .. }));
    let mut forged = proof.clone();
    forged.orbit.centre.harmonics[0][1][0] += Rational::from((1, 1_000_000));
    assert!(matches!(refused(&forged), OrbitNotProved::Defect { .. }));
    forged.orbit.centre.harmonics[0][1][0] += Rational::from((1, 10));
    let failure = prove_orbit(&plant, &forged.orbit, &coordinates).unwrap_err();
    assert!(matches!(failure, OrbitNotProved::DefectTooLarge { .. }), "{failure:?}");
    for zero in [
        OrbitProof { alpha: Rational::new(), ..proof.clone() },
        OrbitProof { p_low: Rational::from(-1), ..proof.clone() },
        OrbitProof { p_up: Rational::from((1, 2)), ..proof.clone() },
    ] {
        assert!(matches!(refused(&zero), OrbitNotProved::Shape(_)));
    }
    // P = 1.21 I, written otherwise, has the bounds 1.21 and no others.
    let mut scaled = coordinates.clone();
    for i in 0..2 {
        scaled.p.mean[i][i] = Rational::from((121, 100));
    }
    assert!(matches!(decide_orbit(&plant, &scaled, &proof), Err(OrbitNotProved::Bounds(_))));
    let own = Rational::from((121, 100));
    decide_orbit(&plant, &scaled, &OrbitProof { p_low: own.clone(), p_up: own, ..proof.clone() }).unwrap();
    let mut singular = coordinates;
    singular.l[0] = singular.l[1].clone();
    assert!(matches!(decide_orbit(&plant, &singular, &proof), Err(OrbitNotProved::Shape(_))));
}

#[test]
fn plants_of_other_sizes_are_proved() {
    for (period, states, f, q) in [
        ("1", vec!["x"], vec!["-x + cos(2*pi*t)"], "x + x^2"),
        ("1/50", vec!["x"], vec!["-x + cos(100*pi*t)"], "sin(x) + sin(100*pi*t)"),
        ("1000", vec!["x"], vec!["-x - x^3 + cos(2*pi*t/1000)"], "atan(x)"),
        ("1", vec!["x"], vec!["-2000*x + 2000*cos(2*pi*t)"], "x"),
        ("1", vec!["x", "y"], vec!["-2000*x + y + cos(2*pi*t)", "-y + tanh(x) + sin(2*pi*t)"], "x*y"),
        ("1", vec!["x", "y"], vec!["-x + 1000*y", "-x/1000 - y/2 + cos(2*pi*t)/1000"], "x/(2 + y)"),
        ("2*pi", vec!["x"], vec!["-x + x*e"], "1 + cos(t)^3"),
        ("1", vec!["x"], vec!["1 - x"], "x"),
        ("1", vec!["x"], vec!["x - x^3 + cos(2*pi*t)/10"], "x"),
        ("1", vec!["x", "y", "z"], vec!["y", "z", "-x - 3*y - 3*z + cos(2*pi*t) - x^3/10"], "sqrt(2 + x)"),
    ] {
        let plant = plant(period, &states, &f, q);
        let (coordinates, proof) = proved(&plant);
        decide_orbit(&plant, &coordinates, &proof).unwrap();
        let forcing = prove_forcing(&plant, &coordinates, &proof).unwrap_or_else(|failure| panic!("{f:?} {failure}"));
        decide_forcing(&plant, &coordinates, &proof, &forcing).unwrap();
        println!(
            "{f:?}: K {} r {:.2e} rho {:.0e} alpha {:.4}; K {} r_0 {:.2e} r_1 {:.2e}",
            proof.orbit.harmonics(),
            proof.radius.to_f64(),
            proof.tube.to_f64(),
            proof.alpha.to_f64(),
            forcing.harmonics.len(),
            forcing.rest.to_f64(),
            forcing.rest_t.to_f64()
        );
        assert!(proof.radius.to_f64() < 1e-6, "{f:?}");
    }
}

#[test]
fn a_plant_without_states_has_harmonics() {
    let plant = Plant::from_json("linear", include_str!("../../../../../specs/plants/linear.json")).unwrap();
    let (coordinates, proof) = proved(&plant);
    assert!(proof.defect.is_zero() && proof.radius.is_zero() && coordinates.l.is_empty());
    decide_orbit(&plant, &coordinates, &proof).unwrap();
    let forcing = prove_forcing(&plant, &coordinates, &proof).unwrap();
    decide_forcing(&plant, &coordinates, &proof, &forcing).unwrap();
    assert!(forcing.mean == 1 && forcing.rest < Rational::from((1, 1_000_000)), "{}", forcing.rest.to_f64());
    assert!(forcing.harmonics.iter().all(|[a, _]| a.is_zero()) && forcing.harmonics[1][1].is_zero());
}

/// x' = (-1 + 2 cos(2 pi t)) x and a second state: no constant P contracts.
#[test]
fn a_periodic_matrix_stands_by() {
    let f = ["(-1 + 2*cos(2*pi*t))*x + y/4", "(-1 - 2*cos(2*pi*t))*y + sin(2*pi*t)"];
    let plant = plant("1", &["x", "y"], &f, "x");
    let found = find_orbit(&plant).unwrap();
    let orbit = round_orbit(&plant, &found).unwrap();
    let candidates = propose_coordinates(&plant, &found, 0.0, 0.0).unwrap();
    let candidates: Vec<Coordinates> = candidates.into_iter().map(|rated| rated.coordinates).collect();
    assert!(!candidates.is_empty() && candidates.iter().all(|candidate| !candidate.p.harmonics.is_empty()));
    let proof = candidates.iter().find_map(|candidate| prove_orbit(&plant, &orbit, candidate).ok()).unwrap();
    assert!(proof.p_low < proof.p_up && proof.alpha.to_f64() > 0.5, "{}", proof.alpha.to_f64());
    let constant = PeriodicMatrix { mean: candidates[0].p.mean.clone(), harmonics: Vec::new() };
    let frozen = Coordinates { p: constant, ..candidates[0].clone() };
    assert!(matches!(prove_orbit(&plant, &orbit, &frozen), Err(OrbitNotProved::Rate { .. })));
}

#[test]
fn what_is_not_smooth_on_the_orbit_is_told() {
    let plant = plant("1", &["x"], &["-x + abs(sin(2*pi*t))"], "x");
    let found = find_orbit(&plant).unwrap();
    let orbit = round_orbit(&plant, &found).unwrap();
    let coordinates = propose_coordinates(&plant, &found, 0.0, 0.0).unwrap().remove(0).coordinates;
    let failure = prove_orbit(&plant, &orbit, &coordinates).unwrap_err();
    assert!(matches!(failure, OrbitNotProved::NotSmooth { .. }), "{failure}");
}

/// A quotient that is 0/0 at an instant: at one that the search looks at, and at another, where doubles see nothing.
#[test]
fn a_quotient_without_a_value_is_the_cause() {
    let of = |shift: &str| {
        let u = format!("cos(2*pi*t - {shift})");
        plant("1", &["x"], &[&format!("-x + {u}/(exp({u}) - 1)")], "x")
    };
    let failure = find_orbit(&of("0")).unwrap_err();
    let OrbitFailure::Undefined(cause) = &failure else { panic!("{failure}") };
    assert!(cause.zero_over_zero && cause.index == 0 && (cause.s - 0.25).abs() < 1e-9, "{failure}");
    assert!(failure.way_out().is_some_and(|help| help.contains("exprelr(u)") && !help.contains("initial")));
    let plant = of("1");
    let found = find_orbit(&plant).unwrap();
    let orbit = round_orbit(&plant, &found).unwrap();
    let coordinates = propose_coordinates(&plant, &found, 0.0, 0.0).unwrap().remove(0).coordinates;
    let failure = prove_orbit(&plant, &orbit, &coordinates).unwrap_err();
    let OrbitNotProved::NotSmooth { s, cause: Some(cause) } = &failure else { panic!("{failure}") };
    assert!(cause.zero_over_zero && (s - 0.409_154_943).abs() < 1e-6, "{failure}");
    assert!(failure.way_out().contains("exprelr(u)") && !failure.way_out().contains("units"));
}

#[test]
fn what_is_too_large_is_refused() {
    let states: Vec<String> = (0..=MAX_STATES).map(|i| format!("x{i}")).collect();
    let f: Vec<String> = states.iter().map(|x| format!("-{x}")).collect();
    let [states, f] = [&states, &f].map(|list| list.iter().map(String::as_str).collect::<Vec<_>>());
    let failure = find_orbit(&plant("1", &states, &f, "x0")).unwrap_err();
    assert_eq!(failure, OrbitFailure::TooLarge { states: MAX_STATES + 1 });
    let plant = plant("1", &["x"], &["-x"], "x");
    let (coordinates, mut proof) = proved(&plant);
    let none = || vec![Rational::new()];
    proof.orbit.centre.harmonics = (0..=MAX_HARMONICS).map(|_| [none(), none()]).collect();
    assert!(matches!(decide_orbit(&plant, &coordinates, &proof), Err(OrbitNotProved::Shape(_))));
}
