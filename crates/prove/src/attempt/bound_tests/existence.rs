//! The matrix inequality of existence: by hand, with numbers that are none, and where it holds at samples alone.

use super::*;
use sigmastar_lang::spec::ExistenceInequality;

/// Boxes that a decision may take.
const EFFORT: usize = 20_000;

fn exact(value: f64) -> Rational {
    round_f64(value, 12, Direction::Nearest).unwrap()
}

/// k_p = 2, c_x = 1/10 and the threshold 1.
fn inequality(x: &str, e: &str, p: &[&[&str]], c_y: f64) -> ExistenceInequality {
    let [x, e, k_p, c_x, value] = [x, e, "2", "0.1", "1"].map(rational);
    let matrix = p.iter().map(|row| row.iter().map(|entry| rational(entry)).collect()).collect();
    ExistenceInequality { x, e, matrix, k_p, c_x, c_y: exact(c_y), value }
}

fn at_rest(states: usize) -> TrigonometricVector {
    TrigonometricVector { mean: vec![Rational::new(); states], harmonics: Vec::new() }
}

/// The largest c_y of one state: what is left of k_p in `[[a, b, c], [., 2, d], [., ., 2]]`.
fn by_hand([j, g, r, d]: [f64; 4], p: f64) -> f64 {
    let [a, b, c, d] = [-2.0 * p * j - 0.1, -p * g, -r, -1.0 - d];
    2.0 - (2.0 * c * c - 2.0 * b * c * d + a * d * d) / (2.0 * a - b * b)
}

fn holds_up_to(engine: &Engine, asked: impl Fn(f64) -> ExistenceInequality, c_y: f64) {
    let truth = |c_y: f64| engine.decide_existence(&asked(c_y), EFFORT).truth;
    assert!(truth(0.9999 * c_y).is_true() && truth(1.0001 * c_y).is_false(), "{c_y}");
}

/// dq/de = -1/2: 2 - (1 - 1/2)^2/2.
#[test]
fn without_states() {
    let engine = case(&plant(&[], &[], "cos(2*pi*t) - e/2"), &[], at_rest(0), "0").engine;
    holds_up_to(&engine, |c_y| inequality("0", "1", &[], c_y), 1.875);
    // The largest slope of -e + 2 e^2/3 on |e| <= E is -1 + 4 E/3, the least one -1 - 4 E/3.
    let engine = case(&plant(&[], &[], "-e + 2*e^2/3"), &[], at_rest(0), "0").engine;
    holds_up_to(&engine, |c_y| inequality("0", "0.75", &[], c_y), 1.5);
}

/// In coordinates x = 2 y, of a state that decays and of one that grows, for which P is negative.
#[test]
fn with_one_state() {
    for (sign, p) in [(-1.0, 0.6), (1.0, -0.6)] {
        let text = format!("{}*x + 3*e/10 + cos(2*pi*t)", 2.0 * sign);
        let engine = case(&plant(&["x"], &[&text], "x/2 - e/4"), &[vec![2.0]], at_rest(1), "0").engine;
        let asked = |c_y: f64| inequality("1", "1", &[&[&p.to_string()]], c_y);
        holds_up_to(&engine, asked, by_hand([2.0 * sign, 0.15, 1.0, -0.25], p));
        let other = inequality("1", "1", &[&[&(-p).to_string()]], 0.1);
        assert!(engine.decide_existence(&other, EFFORT).truth.is_false());
    }
}

/// A P(t) of stability has no part in it.
#[test]
fn with_a_p_of_stability_that_moves() {
    let entry = |value: &str| vec![vec![rational(value)]];
    let p = PeriodicMatrix { mean: entry("1"), harmonics: vec![[entry("0.2"), entry("0")]] };
    let region = Region::new(entry("2"), at_rest(1), Rational::new()).unwrap();
    let engine = Engine::new(&plant(&["x"], &["-2*x + 3*e/10"], "x/2 - e/4"), region, Some(p), None).unwrap();
    holds_up_to(&engine, |c_y| inequality("1", "1", &[&["0.6"]], c_y), by_hand([-2.0, 0.15, 1.0, -0.25], 0.6));
}

/// dq/dx = x reaches 1/4 + X + r on the tube around cos(2 pi t)/4.
#[test]
fn on_the_whole_tube() {
    let plant = plant(&["x"], &["-2*x + 3*e/10"], "x^2/2 - e/4");
    let engine = case(&plant, &[vec![1.0]], curve(&["0"], &[["0.25", "0"]]), "0.125").engine;
    let asked = |c_y: f64| inequality("0.25", "1", &[&["0.6"]], c_y);
    let c_y = by_hand([-2.0, 0.3, 0.625, -0.25], 0.6);
    let truth = |c_y: f64| engine.decide_existence(&asked(c_y), EFFORT).truth;
    // A point of the tube need not be within X of the orbit, so that what fails there is not refuted.
    assert!(truth(0.9999 * c_y).is_true() && !truth(1.0001 * c_y).is_true(), "{c_y}");
}

/// dq/de is -1/4, but for 1/4 within some thousandths of a point that no sample is near.
#[test]
fn a_narrow_bump_between_samples_is_not_proved() {
    let bump = "0.0005*atan((e - 0.37)/0.001)/(1 + ((x - 0.29)/0.01)^2)";
    let plant = plant(&["x"], &["-2*x + 3*e/10"], &format!("x/2 - e/4 + {bump}"));
    let Case { engine, samples } = case(&plant, &[vec![1.0]], at_rest(1), "0");
    let asked = |c_y: f64| inequality("1", "1", &[&["0.6"]], c_y);
    let weights = EnergyWeights::from(&asked(1.0));
    let sampled = samples.energy_at([1.0, 1.0], &Places::Stride(1), &weights);
    let sampled = sampled.into_iter().map(|at| at.margin(2.0, 1.0)).fold(f64::INFINITY, f64::min);
    let without = by_hand([-2.0, 0.3, 0.5, -0.25], 0.6);
    assert!((sampled / without - 1.0).abs() < 1e-3, "{sampled} {without}");
    let proved = prove_existence(&engine, &samples, &asked(1.0));
    assert!(proved.is_none_or(|proved| proved.c_y.to_f64() < by_hand([-2.0, 0.3, 0.5, 0.25], 0.6)));
}

/// What is found is proved again, and is near what samples say.
#[test]
fn the_largest_c_y_is_found() {
    let plant = plant(&["x", "y"], &["-x + y + e/5", "-x - y + sin(x)/5 + cos(2*pi*t)*e/10"], "x/4 - e/2 + tanh(y)/4");
    let unit = [vec![1.0, 0.0], vec![0.0, 1.0]];
    let Case { engine, samples } = case(&plant, &unit, curve(&["0", "0"], &[["0.1", "0"], ["0", "0.1"]]), "0.01");
    let asked = inequality("0.5", "0.5", &[&["0.5", "0.05"], &["0.05", "0.4"]], 0.0);
    let proved = prove_existence(&engine, &samples, &asked).unwrap();
    let weights = EnergyWeights::from(&proved);
    let met = samples.energy_at([0.51, 0.5], &Places::Stride(1), &weights);
    let met = met.into_iter().map(|at| at.margin(2.0, 1.0)).fold(f64::INFINITY, f64::min);
    let c_y = proved.c_y.to_f64();
    assert!(0.95 * met < c_y && c_y < met, "{c_y} {met}");
    assert!(engine.decide_existence(&proved, EFFORT).truth.is_true());
    assert!(
        !engine.decide_existence(&ExistenceInequality { c_y: exact(1.01 * met), ..proved }, EFFORT).truth.is_true()
    );
}

/// A P that is not symmetric or of another order, weights that are not positive, a region that is none.
#[test]
fn numbers_that_are_none() {
    let unit = [vec![1.0, 0.0], vec![0.0, 1.0]];
    let engine = case(&plant(&["x", "y"], &["-x", "-y"], "-e/2"), &unit, at_rest(2), "0").engine;
    let truth = |inequality: &ExistenceInequality| engine.decide_existence(inequality, EFFORT).truth;
    let good = inequality("1", "1", &[&["1", "0"], &["0", "1"]], 1.8);
    assert!(truth(&good).is_true());
    let with = |p: &[&[&str]]| inequality("1", "1", p, 1.8);
    let ragged: [&[&str]; 2] = [&["1", "0"], &["0"]];
    for p in [&[&["1", "0.1"][..], &["0", "1"]][..], &[&["1"]], &[], &ragged, &[&["1", "0"], &["0", "1"], &["0", "0"]]]
    {
        assert!(truth(&with(p)).is_false(), "{p:?}");
    }
    let zero = Rational::new;
    for bad in [
        ExistenceInequality { k_p: zero(), ..good.clone() },
        ExistenceInequality { k_p: -good.k_p.clone(), ..good.clone() },
        ExistenceInequality { c_x: zero(), ..good.clone() },
        ExistenceInequality { c_x: -good.c_x.clone(), ..good.clone() },
        ExistenceInequality { c_y: zero(), ..good.clone() },
        ExistenceInequality { c_y: -good.c_y.clone(), ..good.clone() },
        ExistenceInequality { value: zero(), ..good.clone() },
        ExistenceInequality { value: -good.value.clone(), ..good.clone() },
    ] {
        assert!(truth(&bad).is_false(), "{bad:?}");
    }
    for none in [
        ExistenceInequality { x: Rational::from(-1), ..good.clone() },
        ExistenceInequality { e: Rational::from(-1), ..good.clone() },
    ] {
        assert!(!truth(&none).is_true(), "{none:?}");
    }
}
