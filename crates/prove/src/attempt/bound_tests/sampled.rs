//! The matrix inequalities of the regulator at samples: F against loops that are simulated, by hand, and with numbers that are none.

use super::*;
use sigmastar_lang::spec::{SampledExistence, SampledGain, SampledInequality, SampledLoop};
use sigmastar_propose::bounds::PointSlopes;
use sigmastar_theory::derivation::sampled_form::{AtPoint, Corner, End, FormNumbers, Less, LoopNumbers, form};

/// Boxes that a decision may take.
const EFFORT: usize = 20_000;

/// Steps of a sample in the simulations.
const STEPS: usize = 200;

fn exact(value: f64) -> Rational {
    round_f64(value, 12, Direction::Nearest).unwrap()
}

fn random(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / 2f64.powi(23) - 1.0
    }
}

/// Weights 2 and 1 of two oscillators, the sum of which is all of Nb2.
const WEIGHT_SUM: f64 = 3.0;

fn about(sigma: f64, samples: u32, gain: f64) -> SampledLoop {
    let law = SampledGain { gain: exact(gain), weight_sum: exact(WEIGHT_SUM) };
    SampledLoop { sigma: exact(sigma), samples, law }
}

fn numbers(sigma: f64, samples: u32, gain: f64) -> LoopNumbers<f64> {
    with_gains(sigma, samples, gain, None)
}

/// With an input gain between two numbers.
fn with_gains(sigma: f64, samples: u32, gain: f64, ends: Option<[f64; 2]>) -> LoopNumbers<f64> {
    let moves = ends.map(|ends| ends.map(|b| 1.0 - b));
    LoopNumbers::new(sigma, f64::from(samples).recip(), [gain, WEIGHT_SUM], &std::f64::consts::PI, moves)
}

/// The state of a loop with one state of the plant; of the law with a delay with the last y.
#[derive(Clone, Copy)]
struct State {
    x: f64,
    e: f64,
    zeta: [f64; 3],
    past: Option<f64>,
}

/// M'N R M.
fn b_1(of: &LoopNumbers<f64>) -> f64 {
    2.0 + (std::f64::consts::TAU * of.step).cos()
}

/// What one sample does at the input gain b, for x' = j x + g e and q = r x + d e + q0(t).
struct Sample {
    y: f64,
    next: State,
    /// (x, e, q, G) in the middles of the steps.
    within: Vec<[f64; 4]>,
}

fn sample((of, b): (&LoopNumbers<f64>, f64), slopes: &PointSlopes, at: State, q0: &dyn Fn(f64) -> f64) -> Sample {
    let State { x, e, zeta, past } = at;
    let last = past.unwrap_or(0.0);
    let predicted = e - of.step * last;
    let angle = std::f64::consts::TAU * of.step;
    let turned =
        [zeta[0], angle.cos() * zeta[1] + angle.sin() * zeta[2], angle.cos() * zeta[2] - angle.sin() * zeta[1]];
    let v = 2.0 * turned[0] + turned[1] + of.step * b_1(of) * last;
    let u = b * (of.gain * v - of.sigma * predicted);
    let ds = of.step / STEPS as f64;
    let q = |s: f64, x: f64, e: f64| slopes.r[0] * x + slopes.d * e + q0(s);
    let field = |s: f64, x: f64, e: f64| [slopes.j[0] * x + slopes.g[0] * e, q(s, x, e) + u];
    let (mut xs, mut es) = (x, e);
    let mut middles = Vec::new();
    let mut mean = 0.0;
    for step in 0..STEPS {
        let s = ds * step as f64;
        let [a, b] = field(s, xs, es);
        let [c, d] = field(s + ds / 2.0, xs + ds / 2.0 * a, es + ds / 2.0 * b);
        let [k, l] = field(s + ds / 2.0, xs + ds / 2.0 * c, es + ds / 2.0 * d);
        let [m, n] = field(s + ds, xs + ds * k, es + ds * l);
        let (xm, em) = (xs + ds / 2.0 * c, es + ds / 2.0 * d);
        let qm = q(s + ds / 2.0, xm, em);
        (xs, es) = (xs + ds / 6.0 * (a + 2.0 * c + 2.0 * k + m), es + ds / 6.0 * (b + 2.0 * d + 2.0 * l + n));
        mean += qm / STEPS as f64;
        middles.push([xm, em, qm, s + ds / 2.0]);
    }
    let y = b * of.gain * v + (1.0 - b) * of.sigma * predicted + mean;
    let moves = y + of.step * of.sigma * last;
    let within =
        middles.into_iter().map(|[x, es, q, s]| [x, es, q, es - (1.0 - s * of.sigma) * e - s * moves]).collect();
    let moved = [turned[0] - of.step * y, turned[1] - of.step * y, turned[2]];
    Sample { y, next: State { x: xs, e: es, zeta: moved, past: past.map(|_| y) }, within }
}

/// x'P x + e^2 + eta |zeta|_N^2.
fn level(State { x, e, zeta, .. }: State, p: f64, eta: f64) -> f64 {
    p * x * x + e * e + eta * (2.0 * zeta[0] * zeta[0] + zeta[1] * zeta[1] + zeta[2] * zeta[2])
}

/// The form of these entries at a vector.
fn value(entries: &[(usize, usize, f64)], at: &[f64]) -> f64 {
    entries.iter().map(|(i, j, entry)| if i == j { 1.0 } else { 2.0 } * entry * at[*i] * at[*j]).sum()
}

/// -(U_{k+1} - U_k)/h is the mean of F, between its ends, but for what the mean squares of G and q differ: with w where F is least.
#[test]
fn the_fall_in_a_sample_is_the_mean_of_f() {
    let mut next = random(5);
    for trial in 0..400 {
        let b = if trial % 2 == 0 { 1.0 } else { 1.0 + 0.9 * next() };
        let of = with_gains((1.0 + next()) * 10.0, 20, 3.0 * (1.1 + next()), (trial % 2 == 1).then_some([b, b]));
        let slopes =
            PointSlopes { j: vec![5.0 * next()], g: vec![9.0 * next()], r: vec![9.0 * next()], d: 9.0 * next() };
        let (p, k_p, lambda) = (next(), 0.2 + 0.1 * next(), 30.0 + 20.0 * next());
        let eta = k_p * b * of.gain / 2.0;
        let past = (trial % 4 > 1).then(|| 5.0 * next());
        let at = State { x: next(), e: next(), zeta: [next(), next(), next()], past };
        let weight = 20.0 * next();
        let amplitude = next();
        let q0 = |s: f64| amplitude * (1.0 + s);
        let Sample { y, next: after, within } = sample((&of, b), &slopes, at, &q0);
        let entries = End::BOTH.map(|end| {
            // It is affine in b_1: this far from the middle to one with the sign -1.
            let share = b_1(&of) / WEIGHT_SUM;
            let of_sign = |sign: i64| {
                let less = Less { e_k: 0.0, e: 0.0, y: 0.0 };
                let past = past.map(|_| weight);
                let numbers = FormNumbers { of: &of, weight: 1.0, k_p, lambda, less, gamma: Some(0.0), past };
                form(
                    &AtPoint::default(),
                    numbers,
                    &Corner { end, moved: &of.moved[0], sign },
                    slopes.with(|_, _| p, 0.0),
                )
            };
            let both = of_sign(0).into_iter().zip(of_sign(-1));
            both.map(|((i, j, a), (.., b))| (i, j, (1.0 - share) * a + share * b)).collect::<Vec<_>>()
        });
        let (mut mean, mut squares) = (0.0, [0.0; 2]);
        for (step, [x, _, q, gap]) in within.iter().enumerate() {
            let part = (step as f64 + 0.5) / STEPS as f64;
            let vector: Vec<f64> =
                [*x, at.e, y, *gap, -of.across * q, q0(part * of.step)].into_iter().chain(past).collect();
            let [start, end] = entries.each_ref().map(|entries| value(entries, &vector));
            mean += ((1.0 - part) * start + part * end) / STEPS as f64;
            squares[0] += gap * gap / STEPS as f64;
            squares[1] += (of.across * q).powi(2) / STEPS as f64;
        }
        let stored = |at: State| level(at, p, eta) + weight * of.step * at.past.unwrap_or(0.0).powi(2);
        let fall = (stored(at) - stored(after)) / of.step;
        let left_out = lambda * (squares[1] - squares[0]);
        assert!(left_out > -1e-9);
        assert!(
            (fall - mean - left_out).abs() < 1e-3 * (1.0 + fall.abs() + lambda * squares[1]),
            "{fall} {mean} {left_out}"
        );
    }
}

fn linear(f: &str, q: &str) -> Case {
    of_plant(&plant(&["x"], &[f], q))
}

fn of_plant(plant: &Plant) -> Case {
    let at_rest = TrigonometricVector { mean: vec![Rational::new()], harmonics: Vec::new() };
    case(plant, &[vec![1.0]], at_rest, "0")
}

const WEIGHTS: [f64; 2] = [0.3, 0.4];

fn stability(samples: &FloatSuprema, sigma: f64) -> (SampledInequality, f64) {
    let [w_x, eta] = WEIGHTS;
    let ends = samples.moves().map(|moves| moves.map(|share| 1.0 - share));
    let weights = SampledWeights { w_x, eta, of: with_gains(sigma, 20, 2.0, ends) };
    let found = samples.sampled_radius([1.0, 1.0], &Places::Stride(1), &weights);
    let small = || exact(1e-9);
    let inequality = SampledInequality {
        x: exact(1.0),
        e: exact(1.0),
        w_x: exact(w_x),
        eta: exact(eta),
        lambda: exact(found.lambda),
        rate: small(),
        c_e: small(),
        c_y: small(),
        at: about(sigma, 20, 2.0),
    };
    (inequality, found.radius)
}

/// What the radius leaves of sigma (2 - h sigma) is the largest c_e; another gain, lambda or law is another question.
#[test]
fn stability_holds_as_far_as_the_radius_says() {
    let Case { engine, samples } = linear("-3*x + 2*e", "x - e/2 + cos(2*pi*t)");
    let truth = |inequality: &SampledInequality| engine.decide_sampled(inequality, EFFORT).truth;
    let (good, radius) = stability(&samples, 9.0);
    assert!(radius < 0.9, "{radius}");
    assert!(truth(&good).is_true());
    let left = (1.0 - radius) * 9.0 * (2.0 - 9.0 / 20.0);
    assert!(truth(&SampledInequality { c_e: exact(left * 0.999), ..good.clone() }).is_true());
    assert!(truth(&SampledInequality { c_e: exact(left * 1.001), ..good.clone() }).is_false());
    for factor in [1e-4, 1e4] {
        let lambda = exact(good.lambda.to_f64() * factor);
        assert!(truth(&SampledInequality { lambda, ..good.clone() }).is_false(), "{factor}");
    }
    assert!(truth(&SampledInequality { rate: exact(3.1), ..good.clone() }).is_false());
    assert!(truth(&SampledInequality { c_y: exact(0.4), ..good.clone() }).is_false());
    // A gain too small, one that asks too much of a sample, a law that is heavier.
    for (sigma, samples, gain) in [(0.3, 20, 2.0), (45.0, 20, 2.0), (9.0, 3, 2.0), (9.0, 20, 13.0)] {
        let other = SampledInequality { at: about(sigma, samples, gain), ..good.clone() };
        assert!(truth(&other).is_false(), "{sigma} {samples} {gain}");
    }
}

const F: &str = "-3*x + 2*e";
const Q: &str = "x - e/2 + cos(2*pi*t)";

/// With an input gain both of its ends count: the radius is the larger one of what they have, each with the theta of the largest gain, and
/// what is proved of a narrow interval is not of a wide one.
#[test]
fn both_ends_of_an_input_gain_count() {
    let interval = |low: &str, high: &str| of_plant(&with_input_gain(&["x"], &[F], Q, ["2", low, high]));
    let truth = |case: &Case, asked: &SampledInequality| case.engine.decide_sampled(asked, EFFORT).truth;
    let known = linear(F, Q);
    let (of_known, radius) = stability(&known.samples, 9.0);
    // Of one point it is the same question.
    let point = interval("2", "2");
    let (same, again) = stability(&point.samples, 9.0);
    assert!((same.lambda == of_known.lambda) && again == radius && truth(&point, &same).is_true());
    let mut radii = vec![radius];
    for (low, high) in [("1.8", "2"), ("2", "2.4"), ("1.6", "2.4")] {
        let case = interval(low, high);
        let (good, radius) = stability(&case.samples, 9.0);
        let left = (1.0 - radius) * 9.0 * (2.0 - 9.0 / 20.0);
        assert!(left > 0.0 && truth(&case, &good).is_true(), "{low} {high} {radius}");
        let of = |c_e: f64| SampledInequality { c_e: exact(c_e), ..good.clone() };
        assert!(truth(&case, &of(left * 0.999)).is_true() && truth(&case, &of(left * 1.001)).is_false());
        radii.push(radius);
    }
    assert!(radii[0] < radii[1] && radii[1] < radii[3] && radii[2] < radii[3] && radii[0] < radii[2], "{radii:?}");
    // (1-b) sigma of a gain of nearly 0, theta of a large one.
    assert!(truth(&interval("1/50", "2"), &of_known).is_false());
    assert!(truth(&interval("2", "14"), &of_known).is_false());
}

/// A number that is not positive, a region that is none.
#[test]
fn numbers_of_stability_that_are_none() {
    let Case { engine, samples } = linear("-3*x + 2*e", "x - e/2 + cos(2*pi*t)");
    let (good, _) = stability(&samples, 9.0);
    let truth = |inequality: &SampledInequality| engine.decide_sampled(inequality, EFFORT).truth;
    for bad in [Rational::new(), exact(-1.0)] {
        for other in [
            SampledInequality { w_x: bad.clone(), ..good.clone() },
            SampledInequality { eta: bad.clone(), ..good.clone() },
            SampledInequality { lambda: bad.clone(), ..good.clone() },
            SampledInequality { rate: bad.clone(), ..good.clone() },
            SampledInequality { c_e: bad.clone(), ..good.clone() },
            SampledInequality { c_y: bad.clone(), ..good.clone() },
        ] {
            assert!(truth(&other).is_false(), "{other:?}");
        }
    }
    assert!(!truth(&SampledInequality { x: exact(-1.0), ..good.clone() }).is_true());
    assert!(!truth(&SampledInequality { e: exact(-1.0), ..good }).is_true());
}

/// Samples of a period where a periodic solution is looked at.
const SAMPLES: u32 = 40;

fn existence(samples: &FloatSuprema, sigma: f64, share: f64) -> Option<SampledExistence> {
    let ends = samples.moves().map(|moves| moves.map(|share| 1.0 - share));
    let found = samples.propose_sampled_energy([1.0, 1.0], &with_gains(sigma, SAMPLES, 2.0, ends), share)?;
    let SampledEnergy { p, k_p, lambda, c_x, c_e, c_y } = found;
    Some(SampledExistence {
        x: exact(1.0),
        e: exact(1.0),
        matrix: vec![vec![exact(p[0][0])]],
        k_p: exact(k_p),
        c_x: exact(c_x),
        c_e: exact(c_e),
        c_y: exact(c_y),
        gamma: Rational::new(),
        lambda: exact(lambda),
        at: about(sigma, SAMPLES, 2.0),
    })
}

/// Periodic answers of linear loops to several q0 stay within the bounds of what is proved, and come near them.
#[test]
fn periodic_solutions_stay_within_the_bounds() {
    let (mut nearest, mut seen) = ([0.0_f64; 3], 0);
    for ([j, g, r, d], sigma, [low, high]) in [
        ([-3.0, 2.0, 1.0, -0.5], 9.0, ["1", "1"]),
        ([-1.0, 8.0, -5.0, 0.5], 10.0, ["1", "1"]),
        ([-2.0, 3.0, -4.0, 2.0], 18.0, ["1", "1"]),
        ([-3.0, 2.0, 1.0, -0.5], 9.0, ["0.7", "1.4"]),
        ([-2.0, 3.0, -4.0, 2.0], 24.0, ["0.8", "1.25"]),
    ] {
        let (f, q) = (format!("{j}*x + {g}*e"), format!("{r}*x + {d}*e + cos(2*pi*t)"));
        let Case { engine, samples } = of_plant(&with_input_gain(&["x"], &[&f], &q, ["1", low, high]));
        let slopes = PointSlopes { j: vec![j], g: vec![g], r: vec![r], d };
        let of = numbers(sigma, SAMPLES, 2.0);
        for share in [0.1, 1.0] {
            // Some loops have no inequality with so large a c_e.
            let Some(asked) = existence(&samples, sigma, share) else { continue };
            seen += 1;
            let proved = prove_sampled_existence(&engine, &samples, &asked).unwrap();
            assert!(engine.decide_sampled_existence(&proved, EFFORT).truth.is_true());
            let smaller = SampledExistence { gamma: exact(proved.gamma.to_f64() * 0.9), ..proved.clone() };
            assert!(!engine.decide_sampled_existence(&smaller, EFFORT).truth.is_true());
            let bound = |c: &Rational| (proved.gamma.to_f64() / c.to_f64()).sqrt();
            let bounds = [&proved.c_x, &proved.c_e, &proved.c_y].map(bound);
            let ends = [low, high].map(|end| end.parse::<f64>().unwrap());
            for (b, harmonic) in ends.into_iter().flat_map(|b| (1..9).map(move |harmonic| (b, harmonic))) {
                let frequency = std::f64::consts::TAU * f64::from(harmonic);
                let mut at = State { x: 0.0, e: 0.0, zeta: [0.0; 3], past: None };
                let mut squares = [0.0; 3];
                for k in 0..200 * SAMPLES {
                    let start = f64::from(k % SAMPLES) * of.step;
                    // The mean of q0 does not count.
                    let found = sample((&of, b), &slopes, at, &|s| 0.7 + (frequency * (start + s)).cos());
                    if k % SAMPLES == 0 {
                        squares = [0.0; 3];
                    }
                    squares[2] += found.y * found.y / f64::from(SAMPLES);
                    for [x, e, ..] in &found.within {
                        squares[0] += x * x / (f64::from(SAMPLES) * STEPS as f64);
                        squares[1] += e * e / (f64::from(SAMPLES) * STEPS as f64);
                    }
                    at = found.next;
                }
                for ((square, bound), nearest) in squares.iter().zip(bounds).zip(&mut nearest) {
                    let ratio = square.sqrt() / (bound * 0.5f64.sqrt());
                    assert!(ratio < 1.001, "{j} {g} {r} {d} {share} {b} {harmonic}: {ratio}");
                    *nearest = nearest.max(ratio);
                }
            }
        }
    }
    assert!(seen >= 6, "{seen}");
    // None of the bounds is idle; c_x is not what the programs make large.
    assert!(nearest.iter().zip([0.02, 0.2, 0.5]).all(|(ratio, least)| *ratio > least), "{nearest:?}");
}

/// A number that is not positive, a P that is not symmetric or of another order, a region that is none.
#[test]
fn numbers_of_existence_that_are_none() {
    let Case { engine, samples } = linear("-3*x + 2*e", "x - e/2 + cos(2*pi*t)");
    let truth = |inequality: &SampledExistence| engine.decide_sampled_existence(inequality, EFFORT).truth;
    let good = prove_sampled_existence(&engine, &samples, &existence(&samples, 9.0, 0.3).unwrap()).unwrap();
    assert!(truth(&good).is_true());
    for bad in [Rational::new(), exact(-1.0)] {
        for other in [
            SampledExistence { k_p: bad.clone(), ..good.clone() },
            SampledExistence { c_x: bad.clone(), ..good.clone() },
            SampledExistence { c_e: bad.clone(), ..good.clone() },
            SampledExistence { c_y: bad.clone(), ..good.clone() },
            SampledExistence { gamma: bad.clone(), ..good.clone() },
            SampledExistence { lambda: bad.clone(), ..good.clone() },
        ] {
            assert!(truth(&other).is_false(), "{other:?}");
        }
    }
    for matrix in [vec![], vec![vec![exact(1.0); 2]; 2], vec![vec![]], vec![vec![exact(-1.0)]]] {
        assert!(truth(&SampledExistence { matrix, ..good.clone() }).is_false());
    }
    assert!(!truth(&SampledExistence { x: exact(-1.0), ..good.clone() }).is_true());
    assert!(!truth(&SampledExistence { e: exact(-1.0), ..good }).is_true());
}
