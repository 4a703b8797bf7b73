//! Joint metrics: what is proposed is decided, holds at every larger gain by a second evaluation, and no altered number passes.

use super::*;
use sigmastar_lang::spec::{JointInequality, JointStability, Level, Metric};

/// Boxes that a decision may take.
const EFFORT: usize = 20_000;

const VALUE: f64 = 3.0;

/// A capacitor between x and e: what norms add a metric cancels.
fn filter() -> Case {
    let plant = plant(&["x"], &["-x/2 + 4*e + cos(2*pi*t)"], "-4*x - e/2 + tanh(e)");
    case(&plant, &[vec![1.0]], curve(&["0"], &[["0.1", "0"]]), "0.01")
}

fn asked() -> LevelAsked {
    LevelAsked { radii: [4.0, 3.0], distances: [0.5, 0.4, 0.3], mu: 1.0, rate: 0.5, margin: 2e-3 }
}

fn exact(value: f64) -> Rational {
    round_f64(value, 9, Direction::Nearest).unwrap()
}

fn metric(FloatMetric { p, cross, weight, k_p, margins }: &FloatMetric) -> Metric {
    let row = |row: &Vec<f64>| row.iter().map(|entry| exact(*entry)).collect();
    let [c_x, c_e, c_y] = margins.map(|margin| exact(0.3 * margin));
    let (matrix, cross) = (p.iter().map(row).collect(), row(cross));
    Metric { matrix, cross, weight: exact(*weight), k_p: exact(*k_p), c_x, c_e, c_y }
}

fn level(FloatLevel { p_up, x_low, e_low }: FloatLevel) -> Level {
    Level { p_up: exact(1.001 * p_up), x_low: exact(0.999 * x_low), e_low: exact(0.999 * e_low) }
}

fn inequality([x, e]: [f64; 2], metrics: &[FloatMetric; 2]) -> JointInequality {
    let [near, far] = metrics.each_ref().map(metric);
    JointInequality { x: exact(x), e: exact(e), value: exact(VALUE), near, far }
}

fn stability(samples: &FloatSuprema) -> JointStability {
    stability_for(samples, LookedAt::Grid)
}

fn stability_for(samples: &FloatSuprema, looked: LookedAt) -> JointStability {
    let at = [4.3, 3.2];
    let (metrics, levels, share) =
        samples.propose_joint_stability(at, VALUE, &asked(), (looked, &mut Vec::new())).expect("metrics at this gain");
    assert!(share < 1.0, "{share}");
    JointStability { inequality: inequality(at, &metrics), levels: levels.map(level) }
}

/// The form of a metric at a gain, for J = -1/2, g = 4, r = -4 and a d, by its definition: minus the derivative of V.
fn minus_derivative([p, cross, w, k_p]: [f64; 4], sigma: f64, d: f64, [x, e, y]: [f64; 3]) -> f64 {
    let (x_rate, e_rate) = (-0.5 * x + 4.0 * e, y - sigma * e);
    let of_metric = 2.0 * (p * x * x_rate + cross * (x_rate * e + x * e_rate) + w * e * e_rate);
    // The internal model takes k_p y (y - q) from what it has.
    k_p * y * (y - (-4.0 * x + d * e)) - of_metric
}

/// At gains from the threshold on, of the metrics between the two, at random points and in random directions.
#[test]
fn it_holds_at_every_larger_gain() {
    let Case { engine, samples } = filter();
    let joint = stability(&samples);
    assert!(engine.decide_joint_stability(&joint, EFFORT).truth.is_true());
    let numbers = |metric: &Metric| {
        let Metric { matrix, cross, weight, k_p, .. } = metric;
        [&matrix[0][0], &cross[0], weight, k_p].map(Rational::to_f64)
    };
    let [near, far] = joint.inequality.metrics().map(numbers);
    assert!(near[1].abs() > 0.0 && far[1] == 0.0);
    for share in [1.0, 0.9, 0.5, 0.1, 1e-3] {
        let between: [f64; 4] = std::array::from_fn(|i| share * near[i] + (1.0 - share) * far[i]);
        for (_, direction, e) in random_points(3, 400) {
            let [x, e_of, y]: [f64; 3] = direction.try_into().unwrap();
            let d = -0.5 + 1.0 / (3.2 * e).cosh().powi(2);
            let least = minus_derivative(between, VALUE / share, d, [x, e_of, y * VALUE]);
            assert!(least > 0.0, "{share} {x} {e_of} {y}: {least}");
        }
    }
}

/// What is proposed for the points of a grid alone does not hold between them where derivatives are largest there.
#[test]
fn metrics_for_a_proof_hold_between_the_points_of_the_grid() {
    for bump in ["exp(-4*(e - 8/5)^2)/20", "exp(-(e - 8/5)^2)/10"] {
        let q = format!("-4*x - e/2 + tanh(e) + x*{bump}");
        let plant = plant(&["x"], &["-x/2 + 4*e + cos(2*pi*t)"], &q);
        let Case { engine, samples } = case(&plant, &[vec![1.0]], curve(&["0"], &[["0.1", "0"]]), "0.01");
        let decided = |looked: LookedAt| engine.decide_joint_stability(&stability_for(&samples, looked), EFFORT).truth;
        assert!(!decided(LookedAt::Grid).is_true(), "{bump}");
        assert!(decided(LookedAt::Between).is_true(), "{bump}");
    }
}

/// Metrics of existence, too.
#[test]
fn existence_is_proposed_and_decided() {
    let Case { engine, samples } = filter();
    let at = [1.0, 1.0];
    let metrics = samples.propose_joint_existence(at, VALUE, (LookedAt::Grid, &mut Vec::new())).unwrap();
    let joint = inequality(at, &metrics);
    assert!(engine.decide_joint(&joint, EFFORT).truth.is_true());
    let mut more = joint.clone();
    more.near.c_y *= 5;
    assert!(!engine.decide_joint(&more, EFFORT).truth.is_true());
}

/// Each number altered by itself.
#[test]
fn altered_numbers_are_refused() {
    let Case { engine, samples } = filter();
    let good = stability(&samples);
    type Alter = fn(&mut JointStability);
    let alterations: [(&str, Alter); 17] = [
        ("a smaller threshold", |joint| joint.inequality.value /= 4),
        ("no threshold", |joint| joint.inequality.value = Rational::new()),
        ("k_p of the near one", |joint| joint.inequality.near.k_p = Rational::new()),
        ("k_p of the far one", |joint| joint.inequality.far.k_p *= -1),
        ("c_x", |joint| joint.inequality.near.c_x = Rational::new()),
        ("c_e", |joint| joint.inequality.far.c_e *= -1),
        ("c_y", |joint| joint.inequality.near.c_y *= 10_000),
        ("w of the far one", |joint| joint.inequality.far.weight *= -1),
        ("p of the near one", |joint| joint.inequality.near.cross[0] *= 20),
        ("no p", |joint| joint.inequality.near.cross.clear()),
        ("a p of the far one", |joint| joint.inequality.far.cross[0] = Rational::from((1, 1000))),
        ("P of the near one", |joint| joint.inequality.near.matrix[0][0] *= -1),
        ("a row more", |joint| joint.inequality.far.matrix.push(vec![Rational::from(1)])),
        ("P_up", |joint| joint.levels[0].p_up /= 2),
        ("x_low", |joint| joint.levels[1].x_low *= 100),
        ("e_low", |joint| joint.levels[0].e_low *= 100),
        ("e_low below 0", |joint| joint.levels[1].e_low *= -1),
    ];
    for (what, alter) in alterations {
        let mut bad = good.clone();
        alter(&mut bad);
        assert!(!engine.decide_joint_stability(&bad, EFFORT).truth.is_true(), "{what}");
    }
    let mut nowhere = good;
    nowhere.inequality.x = Rational::from(-1);
    assert!(!engine.decide_joint_stability(&nowhere, EFFORT).truth.is_true());
}

/// Of an uncertain input gain nothing is decided; of one that is known it is the same.
#[test]
fn no_uncertain_input_gain() {
    let Case { samples, .. } = filter();
    let joint = stability(&samples);
    for (ends, proved) in [(["2", "2"], true), (["1.999", "2"], false)] {
        let text = ["2", ends[0], ends[1]];
        let plant = with_input_gain(&["x"], &["-x/2 + 4*e + cos(2*pi*t)"], "-4*x - e/2 + tanh(e)", text);
        let Case { engine, .. } = case(&plant, &[vec![1.0]], curve(&["0"], &[["0.1", "0"]]), "0.01");
        assert_eq!(engine.decide_joint_stability(&joint, EFFORT).truth.is_true(), proved, "{ends:?}");
        assert_eq!(engine.decide_joint(&joint.inequality, EFFORT).truth.is_true(), proved, "{ends:?}");
    }
}

/// Without states nothing but its sign is asked of P_up, which C4 multiplies with dX^2.
#[test]
fn without_states_the_numbers_of_a_level_are_positive() {
    let engine = case(&plant(&[], &[], "cos(2*pi*t) - e/2"), &[], curve(&[], &[]), "0").engine;
    let one = || Rational::from(1);
    let metric = |weight: i32| Metric {
        matrix: Vec::new(),
        cross: Vec::new(),
        weight: Rational::from(weight),
        k_p: one(),
        c_x: one(),
        c_e: Rational::from((1, 10)),
        c_y: Rational::from((1, 10)),
    };
    let joint = |p_up: i32| {
        let level = || Level { p_up: Rational::from(p_up), x_low: one(), e_low: Rational::from((1, 2)) };
        let inequality =
            JointInequality { x: Rational::new(), e: one(), value: one(), near: metric(1), far: metric(1) };
        JointStability { inequality, levels: [level(), level()] }
    };
    let truth = |p_up: i32| engine.decide_joint_stability(&joint(p_up), EFFORT).truth;
    assert!(truth(1).is_true());
    assert!(truth(0).is_false());
    assert!(truth(-1).is_false());
}
