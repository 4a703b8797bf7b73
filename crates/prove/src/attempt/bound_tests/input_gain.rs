//! The matrix inequalities with an input gain: by hand at both of its ends, which are the worst.

use super::*;
use sigmastar_lang::spec::{Constant, ExistenceInequality, MatrixInequality, Splitting};

/// Boxes that a decision may take.
const EFFORT: usize = 20_000;

const ENDS: [f64; 2] = [0.8, 1.25];

/// x' = -2 x + 3 e/10, q = x/2 - e/4: J, g, r, d.
const LINEAR: [f64; 4] = [-2.0, 0.3, 0.5, -0.25];

fn exact(value: f64) -> Rational {
    round_f64(value, 12, Direction::Nearest).unwrap()
}

fn linear(ends: [&str; 2]) -> Case {
    let plant = with_input_gain(&["x"], &["-2*x + 3*e/10"], "x/2 - e/4", ["2", ends[0], ends[1]]);
    let at_rest = TrigonometricVector { mean: vec![Rational::new()], harmonics: Vec::new() };
    case(&plant, &[vec![1.0]], at_rest, "0")
}

fn uncertain() -> Case {
    linear(["1.6", "2.5"])
}

fn one() -> Constant {
    Constant::rational(&Rational::from(1))
}

/// w_x = 1/2, h = 2/5, so that k_p = 4/5.
fn inequality(value: f64, splitting: Option<Splitting>) -> MatrixInequality {
    let [x, e, w_x, h, rate] = ["0.5", "0.5", "0.5", "0.4", "0.001"].map(rational);
    MatrixInequality { x, e, w_x, h, rate, value: exact(value), splitting }
}

/// The determinant of `[[a, b, c], [., 2 tau, d], [., ., k_p]]` over that of its minor in x and y, at the worse end of b.
fn least_eigen(tau: f64) -> f64 {
    let [j, g, r, d] = LINEAR;
    let (w, k_p) = (0.5, 0.8);
    let at = |b: f64| {
        let [a, x_e, x_y] = [-2.0 * w * (j + 0.001), -w * g, -0.5 * k_p * r];
        let e_y = -1.0 - 0.5 * k_p * (d + (1.0 - b) * tau);
        let minor = a * k_p - x_y * x_y;
        2.0 * tau - (k_p * x_e * x_e - 2.0 * x_e * x_y * e_y + a * e_y * e_y) / minor
    };
    at(ENDS[0]).min(at(ENDS[1]))
}

/// The least threshold of both ends, and the largest: from where on the inequality fails again.
fn thresholds() -> [f64; 2] {
    let crossing = |mut low: f64, mut high: f64| {
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if least_eigen(middle) > 0.0 { high = middle } else { low = middle }
        }
        high
    };
    [crossing(0.0, 2.0), crossing(1e3, 2.0)]
}

/// The least sigma of (B) by bisection, at the end b = 4/5, which asks for more: ht = 2/5.
fn any_larger() -> f64 {
    let lacks = |sigma: f64| ENDS.into_iter().any(|b| (1.0 + 0.4 * (1.0 - b) * sigma).powi(2) > 1.6 * sigma);
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if lacks(middle) { low = middle } else { high = middle }
    }
    high
}

#[test]
fn stability_at_both_ends() {
    let Case { engine, samples } = uncertain();
    let [least, largest] = thresholds();
    let truth = |value: f64| engine.decide_inequality(&inequality(value, None), &one(), EFFORT).truth;
    assert!(least > 0.5 && largest > 5.0 * least, "{least} {largest}");
    assert!(truth(1.0001 * least).is_true() && truth(0.9999 * least).is_false());
    assert!(truth(0.9999 * largest).is_true() && truth(1.0001 * largest).is_false());
    // At the nominal gain less is enough: both ends count.
    let nominal = linear(["2", "2"]).engine;
    let known = |value: f64| nominal.decide_inequality(&inequality(value, None), &one(), EFFORT).truth;
    assert!(known(0.97 * least).is_true() && known(1.5 * largest).is_true());
    let proved = prove_inequality(&engine, &samples, &inequality(0.0, None), &one(), &mut 0).unwrap();
    // What is found serves every larger gain too, (B): 4 ht sigma >= (1 + ht (1-b) sigma)^2.
    assert!(least < any_larger() && any_larger() < largest);
    assert!((proved.value.to_f64() / any_larger() - 1.0).abs() < 1e-3, "{}", proved.value.to_f64());
}

#[test]
fn stability_with_a_corner() {
    let Case { engine, samples } = uncertain();
    let [x, e] = ["0.2", "0.5"].map(rational);
    let asked = inequality(0.0, Some(Splitting { x, e, matrix: Vec::new() }));
    let proved = prove_inequality(&engine, &samples, &asked, &one(), &mut 0).unwrap();
    let [least, _] = thresholds();
    let value = proved.value.to_f64();
    assert!(value >= any_larger() && value < 1.05 * any_larger(), "{value} {least}");
    let below = MatrixInequality { value: exact(0.99 * least), ..proved.clone() };
    assert!(!engine.decide_inequality(&below, &one(), EFFORT).truth.is_true());
    assert!(linear(["2", "2"]).engine.decide_inequality(&proved, &one(), EFFORT).truth.is_true());
}

/// k_p = 2, c_x = 1/10 and the threshold 1, P = 3/5.
#[test]
fn existence_at_both_ends() {
    let Case { engine, samples } = uncertain();
    let asked = |c_y: f64| {
        let [x, e, k_p, c_x, value, p] = ["1", "1", "2", "0.1", "1", "0.6"].map(rational);
        ExistenceInequality { x, e, matrix: vec![vec![p]], k_p, c_x, c_y: exact(c_y), value }
    };
    let [j, g, r, d] = LINEAR;
    let at = |b: f64| {
        let [a, b, c, d] = [-1.2 * j - 0.1, -0.6 * g, -r, -1.0 - (d + 1.0 - b)];
        2.0 - (2.0 * c * c - 2.0 * b * c * d + a * d * d) / (2.0 * a - b * b)
    };
    let c_y = at(ENDS[0]).min(at(ENDS[1]));
    let truth = |c_y: f64| engine.decide_existence(&asked(c_y), EFFORT).truth;
    assert!(c_y < at(1.0) && truth(0.9999 * c_y).is_true() && truth(1.0001 * c_y).is_false(), "{c_y}");
    // What is found serves every larger gain too: k_p - c_y >= (1 + (1 - b))^2/2.
    let any_larger = 2.0 - 1.2_f64.powi(2) / 2.0;
    let found = prove_existence(&engine, &samples, &asked(0.0)).unwrap().c_y.to_f64();
    let least = c_y.min(any_larger);
    assert!(found < least && found > 0.99 * least, "{found} {least}");
    // The program that proposes the weights has both in it.
    let weights = samples.propose_energy([1.0, 1.0], 4.0).unwrap();
    let margins = samples.energy_at([1.0, 1.0], &Places::Stride(1), &weights);
    assert!(margins.iter().all(|at| at.margin(weights.k_p, 4.0) > 0.0));
}
