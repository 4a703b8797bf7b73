//! A splitting matrix: what is proved with one holds at random pairs of points, and what does not hold is not proved.

use super::*;
use sigmastar_lang::spec::{Constant, MatrixInequality, Splitting};
use sigmastar_propose::bounds::Root;

/// With (J, r) on (X, other E), and (g, d) on (other X, E).
fn split(at: [&str; 2], other: [&str; 2], s: Vec<Vec<Rational>>, value: f64) -> MatrixInequality {
    let [x, e] = at.map(rational);
    let [of_x, of_e] = other.map(rational);
    let [w_x, h, rate] = ["0.5", "0.4", "0.001"].map(rational);
    let value = round_f64(value, 12, Direction::Nearest).unwrap();
    let splitting = Some(Splitting { x: of_x, e: of_e, matrix: s });
    MatrixInequality { x, e, w_x, h, rate, value, splitting }
}

const WEIGHTS: FloatWeights = FloatWeights { w_x: 0.5, k_p: 0.8, rate: 0.001 };

fn one() -> Constant {
    Constant::rational(&Rational::from(1))
}

fn at_zero(f: &[&str], q: &str) -> Case {
    let n = f.len();
    let orbit = TrigonometricVector { mean: vec![Rational::new(); n], harmonics: Vec::new() };
    let unit: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| f64::from(i == j)).collect()).collect();
    case(&plant(&["x", "y", "z"][..n], f, q), &unit, orbit, "0")
}

/// Both conditions at random points of the one kind and of the other, and the threshold at their pairs.
#[test]
fn a_proved_splitting_holds_at_random_pairs() {
    let three = ["-x + y*e", "-2*y + sin(z)*x", "-z + x*cos(2*pi*t)/2"];
    for (f, q, at, other) in [
        (&["-2*x - x^3 + e*x/2"][..], "x/2 + e*atan(x)", ["0.5", "0.8"], ["0.5", "0.1"]),
        (&["-2*x - x^3 + e*x/2"], "x/2 + e*atan(x)", ["0.5", "0.8"], ["0.1", "0.8"]),
        (&three, "x*z + e*atan(y) + sin(2*pi*t)*z^2", ["0.3", "0.4"], ["0.3", "0.1"]),
        (&[], "e + sin(e + 2*pi*t)/4", ["0", "0.5"], ["0", "0.2"]),
    ] {
        let Case { engine, samples } = at_zero(f, q);
        let wanted = split(at, other, Vec::new(), 0.0);
        let proved = prove_inequality(&engine, &samples, &wanted, &one(), &mut 0).unwrap_or_else(|| panic!("{f:?}"));
        let [of_states, of_error] = proved.arguments().map(|ends| ends.map(Rational::to_f64));
        let points = random_points(f.len(), 4000);
        let (mut roots, mut columns) = (Vec::new(), Vec::new());
        samples.largest_of_derivatives_at(of_states, &points, |derivatives, matrix| {
            roots.push(Root::new(WEIGHTS.of_states(derivatives, matrix)).unwrap());
            0.0
        });
        samples.largest_of_derivatives_at(of_error, &points, |derivatives, _| {
            columns.push(WEIGHTS.of_error(derivatives, None));
            0.0
        });
        let pairs = roots.iter().zip(&columns).chain(roots.iter().rev().zip(&columns));
        let met = pairs.map(|(root, column)| root.threshold(column, &mut Vec::new())).fold(0.0, f64::max);
        let value = proved.value.to_f64();
        assert!(met <= value && value < 1.3 * met, "{f:?}: {value} over {met}");
        // Neither a smaller threshold nor a larger S, and no other region of either kind, is what was proved.
        let decide = |other: &MatrixInequality| engine.decide_inequality(other, &one(), 20_000).truth;
        assert!(decide(&proved).is_true());
        let below = round_f64(0.99 * met, 12, Direction::Nearest).unwrap();
        assert!(!decide(&MatrixInequality { value: below, ..proved.clone() }).is_true(), "{f:?}");
        let known = proved.splitting.clone().unwrap();
        let times = |factor: &str| {
            let factor = rational(factor);
            let matrix = known
                .matrix
                .iter()
                .map(|row| row.iter().map(|entry| Rational::from(entry * &factor)).collect())
                .collect();
            MatrixInequality { splitting: Some(Splitting { matrix, ..known.clone() }), ..proved.clone() }
        };
        for factor in ["1.05", "0.9", "-1"] {
            assert!(!decide(&times(factor)).is_true(), "{f:?}: S times {factor}");
        }
    }
}

/// J, g, r constant, and d = e/2: S may be all of F without e, and the worst e is at an end.
#[test]
fn against_a_threshold_by_hand() {
    let engine = at_zero(&["-2*x + 3*e/10"], "x/2 + e^2/4").engine;
    // [[0.5 * 2 * 1.999, -0.4/2], [., 0.8]], times a little less than 1.
    let s = |factor: f64| {
        let entry = |value: f64| round_f64(value * factor, 12, Direction::Nearest).unwrap();
        vec![vec![entry(1.999), entry(-0.2)], vec![entry(-0.2), entry(0.8)]]
    };
    let threshold = |d: f64| {
        let (a, b, c) = (1.999, -0.2, 0.8);
        let (g, k) = (-0.15, -1.0 - 0.4 * d);
        (c * g * g - 2.0 * b * g * k + a * k * k) / (a * c - b * b) / 2.0
    };
    let holds = |s: Vec<Vec<Rational>>, value: f64| {
        engine.decide_inequality(&split(["1", "1"], ["1", "0.5"], s, value), &one(), 10_000).truth
    };
    let largest = threshold(0.5);
    assert!(holds(s(1.0 - 1e-6), 1.0001 * largest).is_true() && holds(s(1.0 - 1e-6), 0.9999 * largest).is_false());
    // More than F without e is no S.
    assert!(holds(s(1.0001), 1.001 * largest).is_false());
    // An S that is not symmetric, or of another order, says nothing.
    let mut skew = s(0.99);
    skew[0][1] = rational("-0.1");
    assert!(!holds(skew, 2.0 * largest).is_true());
    for other in [vec![s(0.99)[0].clone()], Vec::new(), vec![vec![rational("0.1"); 3]; 3]] {
        assert!(!holds(other, 2.0 * largest).is_true());
    }
    // Nor is there a negative region.
    let asked = split(["1", "1"], ["1", "-1"], s(0.99), 2.0 * largest);
    assert!(!engine.decide_inequality(&asked, &one(), 100).truth.is_true());
}

/// df/dx is -2 at x = 0, at both ends and half way, where samples look, and larger between.
#[test]
fn what_holds_at_samples_alone_is_not_proved() {
    let engine = at_zero(&["-2*x + 3*e/10 + (1 - cos(2*pi*x))/(4*pi)"], "x/2 - e/4").engine;
    let s = |damping: f64| {
        let entry = |value: f64| round_f64(value, 12, Direction::Nearest).unwrap();
        vec![vec![entry(0.999 * (damping - 0.001)), entry(-0.2)], vec![entry(-0.2), entry(0.799)]]
    };
    let holds =
        |damping: f64| engine.decide_inequality(&split(["1", "1"], ["1", "1"], s(damping), 10.0), &one(), 10_000).truth;
    assert!(!holds(2.0).is_true() && holds(1.5).is_true());
}

/// At one place for both, pairs are at least what single points are; with derivatives that are constant there is one value.
#[test]
fn pairs_of_points() {
    let at = |apart| MatrixArguments { apart, states: [0.5, 0.4], error: [0.5, 0.4] };
    let grid = Focus { places: Places::Stride(2), corners: None };
    let value = |samples: &FloatSuprema, apart| samples.least_sigma(at(apart), &grid, WEIGHTS);
    let Case { samples, .. } = at_zero(&["-2*x - x^3 + e*x/2"], "x/2 + e*atan(x)");
    let [one, pairs] = [false, true].map(|apart| value(&samples, apart));
    assert!(pairs > one * 1.001 && pairs < 2.0 * one, "{one} {pairs}");
    let Case { samples, .. } = at_zero(&["-2*x + 3*e/10"], "x/2 - e/4");
    let [one, pairs] = [false, true].map(|apart| value(&samples, apart));
    assert!((pairs / one - 1.0).abs() < 1e-12, "{one} {pairs}");
    let Case { samples, .. } = at_zero(&["x + 3*e/10"], "x/2 - e/4");
    assert_eq!(value(&samples, true), f64::INFINITY);
}
