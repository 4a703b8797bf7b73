//! Decided bounds against samples, and the paper's plant.

mod clocks;
mod directions;
mod existence;
mod families;
mod forms;
mod inequality;
mod input_gain;
mod joint;
mod narrow;
mod outside;
pub(crate) mod random_points;
mod sampled;
mod slopes;
mod splitting;

use super::{prove_existence, prove_inequality, prove_sampled_existence, prove_slopes, prove_value};
use random_points::random_points;
use rug::Rational;
use sigmastar_decide::bounds::*;
use sigmastar_exact::number::{Direction, round_f64};
use sigmastar_lang::expr::Evaluator;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Bound, PeriodicMatrix, TrigonometricVector};
use sigmastar_propose::bounds::*;
use sigmastar_theory::evidence::{Entry, Part, Slopes, TABLE};
use std::sync::Arc;
use std::time::Instant;

fn rational(text: &str) -> Rational {
    sigmastar_exact::number::parse_decimal(text).unwrap()
}

fn paper() -> Plant {
    Plant::from_json("paper-example", include_str!("../../../../specs/plants/paper-example.json")).unwrap()
}

/// The orbit by Runge and Kutta, and its Fourier coefficients to nine digits.
fn orbit_of(plant: &Plant, degree: usize) -> TrigonometricVector {
    let (n, steps) = (plant.states(), 512);
    let program = Arc::new(plant.program());
    let mut evaluator = Evaluator::new(program.clone());
    let h = plant.period.nominal().to_f64() / steps as f64;
    let mut slope = |t: f64, x: &[f64]| {
        let mut out = vec![0.0; program.outputs()];
        evaluator.set_time(t);
        evaluator.evaluate(x, 0.0, &mut out);
        out
    };
    let plus = |x: &[f64], k: &[f64], h: f64| -> Vec<f64> { x.iter().zip(k).map(|(x, k)| x + h * k).collect() };
    let mut x = vec![0.0; n];
    let mut samples = Vec::new();
    for step in 0..100 * steps {
        if step >= 99 * steps {
            samples.push(x.clone());
        }
        let t = step as f64 * h;
        let a = slope(t, &x);
        let b = slope(t + h / 2.0, &plus(&x, &a, h / 2.0));
        let c = slope(t + h / 2.0, &plus(&x, &b, h / 2.0));
        let d = slope(t + h, &plus(&x, &c, h));
        x = (0..n).map(|i| x[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i])).collect();
    }
    let short = |value: f64| Rational::from(((value * 1e9).round() as i64, 1_000_000_000));
    let coefficient = |wave: &dyn Fn(f64) -> f64| -> Vec<Rational> {
        (0..n)
            .map(|i| {
                let sum: f64 = samples.iter().enumerate().map(|(s, x)| x[i] * wave(s as f64 / steps as f64)).sum();
                short(sum / steps as f64)
            })
            .collect()
    };
    let turn = std::f64::consts::TAU;
    let harmonics = (1..=degree)
        .map(|k| {
            let k = k as f64;
            [coefficient(&|s| 2.0 * (turn * k * s).cos()), coefficient(&|s| 2.0 * (turn * k * s).sin())]
        })
        .collect();
    TrigonometricVector { mean: coefficient(&|_| 1.0), harmonics }
}

fn identity(order: usize) -> PeriodicMatrix {
    let row = |i: usize| (0..order).map(|j| Rational::from(u8::from(i == j))).collect();
    PeriodicMatrix { mean: (0..order).map(row).collect(), harmonics: Vec::new() }
}

struct Case {
    engine: Engine,
    samples: FloatSuprema,
}

fn case(plant: &Plant, matrix: &[Vec<f64>], orbit: TrigonometricVector, radius: &str) -> Case {
    let exact: Vec<Vec<Rational>> =
        matrix.iter().map(|row| row.iter().map(|v| round_f64(*v, 4, Direction::Nearest).unwrap()).collect()).collect();
    let doubles = exact.iter().map(|row| row.iter().map(Rational::to_f64).collect()).collect();
    let p = identity(plant.states());
    let samples = FloatSuprema::new(plant, FloatCurve::from(&orbit), doubles, [Some(&p), None]);
    let region = Region::new(exact, orbit, rational(radius)).unwrap();
    Case { engine: Engine::new(plant, region, Some(p), None).unwrap(), samples }
}

/// L with its second row of length 1 and the best rate on (X,E), by trial.
fn best_matrix(plant: &Plant, orbit: &TrigonometricVector, x: f64, e: f64) -> Vec<Vec<f64>> {
    let p = identity(2);
    let candidate = |b: f64, c: f64| {
        // L L^T = P^-1 scaled to a second diagonal entry 1: [[c, b], [b, 1]] with c > b^2.
        let root = (c - b * b).sqrt();
        vec![vec![root, b], vec![0.0, 1.0]]
    };
    let rate = |matrix: &Vec<Vec<f64>>| {
        let samples = FloatSuprema::new(plant, FloatCurve::from(orbit), matrix.clone(), [Some(&p), None]);
        samples.at(Bound::Rate, x, e)
    };
    let (mut best, mut at, mut step) = (f64::NEG_INFINITY, (0.0, 1.0), 0.2);
    while step > 1e-3 {
        let around = [(0.0, 0.0), (step, 0.0), (-step, 0.0), (0.0, step), (0.0, -step), (step, step), (-step, -step)];
        let found = around
            .iter()
            .map(|(b, c)| (at.0 + b, at.1 + c))
            .filter(|(b, c)| c - b * b > 0.05)
            .map(|(b, c)| (rate(&candidate(b, c)), (b, c)))
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .unwrap();
        if found.0 > best + 1e-9 {
            (best, at) = found;
        } else {
            step /= 2.0;
        }
    }
    candidate(at.0, at.1)
}

#[test]
fn the_papers_plant() {
    let plant = paper();
    let orbit = orbit_of(&plant, 12);
    // No rate exceeds half of the negative trace at any point: 1.2 - x_2/5 - e at the largest x_2 and e.
    for (x, e) in [("0.5", "0.1"), ("0.7", "0.15"), ("1", "0.2")] {
        let (x, e) = (rational(x), rational(e));
        let matrix = best_matrix(&plant, &orbit, x.to_f64(), e.to_f64());
        let case = case(&plant, &matrix, orbit.clone(), "1e-6");
        let proved = prove_value(&case.engine, &case.samples, Bound::Rate, &x, &e).unwrap();
        let second = sigmastar_propose::orbit::doubles(&orbit).samples(999).into_iter().map(|x| x[1]);
        let [low, high] = second.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
        let most = (1.2 - (high + x.to_f64()) / 5.0 - e.to_f64()) / 2.0;
        println!("rate on ({x}, {e}): {} of {most}; x_2 in [{low}, {high}]", proved.value.to_f64());
        assert!(proved.value.to_f64() < most && proved.value.to_f64() > 0.97 * most, "{proved:?}");
    }
    let matrix = best_matrix(&plant, &orbit, 0.5, 0.1);
    let case = case(&plant, &matrix, orbit, "1e-6");
    for e in ["0", "0.1", "1", "4"] {
        let (x, e) = (rational("0.5"), rational(e));
        let start = Instant::now();
        let all = case.samples.survey(0.5, e.to_f64(), &Places::Stride(1), Asked::ALL);
        println!("(0.5, {e}): all sampled in {:.2} ms: {all:.4?}", start.elapsed().as_secs_f64() * 1e3);
        for (index, kind) in TABLE.into_iter().enumerate().filter(|(_, kind)| *kind != Bound::RateExistence) {
            // What is asked for by itself is what all have.
            let alone = case.samples.survey(0.5, e.to_f64(), &Places::Stride(1), Asked::only(kind))[index];
            assert_eq!(alone.to_bits(), all[index].to_bits(), "{kind:?}: {alone}");
            let start = Instant::now();
            let sampled = case.samples.refined(kind, 0.5, e.to_f64());
            let refined = start.elapsed().as_secs_f64() * 1e3;
            let proved = prove_value(&case.engine, &case.samples, kind, &x, &e);
            let time = start.elapsed().as_secs_f64() * 1e3 - refined;
            let name = kind.field();
            println!("  {name:8} {:10.5} {refined:5.1} ms; {time:7.1} ms, {proved:?}", sampled.value);
        }
        assert_eq!(case.engine.smooth(&x, &e), Ok(()));
    }
}

/// A plant whose actuator has this nominal, smallest and largest gain.
fn with_input_gain(states: &[&str], f: &[&str], q: &str, [nominal, low, high]: [&str; 3]) -> Plant {
    let plain = plant(states, f, q).document.to_string();
    let gain = format!(r#"{{"input_gain": {{"nominal": {nominal:?}, "low": {low:?}, "high": {high:?}}}, "#);
    let document = plain.replacen('{', &gain, 1);
    Plant::from_json("test", &document).unwrap_or_else(|error| panic!("{error:?}"))
}

fn plant(states: &[&str], f: &[&str], q: &str) -> Plant {
    let quoted = |list: &[&str]| list.iter().map(|text| format!("{text:?}")).collect::<Vec<_>>().join(", ");
    let zeros = vec!["\"0\""; states.len()].join(", ");
    let text = format!(
        r#"{{"format": "sigmastar/plant", "version": 1, "name": "test", "period": "1", "states": [{}], "f": [{}],
        "q": {q:?}, "initial": {{"x": [{zeros}], "e": "0"}}, "internal_model": {{"mu": "1", "base_frequency": "2*pi",
        "matched": true, "weights": {{"family": "power", "n0": "2", "epsilon": "1/2"}}}}}}"#,
        quoted(states),
        quoted(f)
    );
    Plant::from_json("test", &text).unwrap_or_else(|error| panic!("{error:?}"))
}

/// A curve that need be no orbit: bounds are about the tube around it.
fn curve(mean: &[&str], first: &[[&str; 2]]) -> TrigonometricVector {
    let column = |k: usize| first.iter().map(|pair| rational(pair[k])).collect();
    TrigonometricVector {
        mean: mean.iter().map(|text| rational(text)).collect(),
        harmonics: vec![[column(0), column(1)]],
    }
}

fn cases() -> Vec<(&'static str, Case, &'static str, &'static str)> {
    let three = plant(
        &["x", "y", "z"],
        &["-x + y*e", "-2*y + sin(z)*x", "-z + x*cos(2*pi*t)"],
        "x*z + e*atan(y) + sin(2*pi*t)*z^2",
    );
    let scalar = plant(&["x"], &["-x - x^3/4 + e/(2 + cos(2*pi*t)) + cos(2*pi*t)"], "exp(x/2)*sin(2*pi*t) + tanh(e)*x");
    let smooth = plant(&["x", "y"], &["y", "-sin(x) - y + abs(3 + x)*e^2"], "sqrt(5 + x)*max(y - 9, e) + x*y/(4 + e)");
    let none = plant(&[], &[], "1 + tanh(3*sin(2*pi*t))*e + log(3 + e)");
    let general = [vec![1.0, 0.5, 0.0], vec![-0.25, 1.0, 0.125], vec![0.0, 0.5, 2.0]];
    vec![
        (
            "three",
            case(&three, &general, curve(&["0.1", "0", "-0.2"], &[["0.3", "0"], ["0", "0.2"], ["0.1", "0.1"]]), "0.01"),
            "0.3",
            "0.2",
        ),
        ("scalar", case(&scalar, &[vec![0.75]], curve(&["0.2"], &[["0.3", "0.1"]]), "0.001"), "0.5", "0.7"),
        (
            "two",
            case(
                &smooth,
                &[vec![1.0, 0.25], vec![-0.5, 1.0]],
                curve(&["0", "0"], &[["0.5", "0"], ["0", "0.5"]]),
                "0.001",
            ),
            "0.4",
            "0.5",
        ),
        ("none", case(&none, &[], TrigonometricVector { mean: Vec::new(), harmonics: Vec::new() }, "0"), "0.4", "0.5"),
    ]
}

/// 100000 random points lie below each proved bound, and nothing below the sampled supremum is proved.
#[test]
fn proved_bounds_hold_at_random_points() {
    for (name, Case { engine, samples }, x, e) in cases() {
        let (x, e) = (rational(x), rational(e));
        let reach = Rational::from(&x + engine.region().radius()).to_f64();
        assert_eq!(engine.smooth(&x, &e), Ok(()), "{name}");
        for kind in TABLE.into_iter().filter(|kind| *kind != Bound::RateExistence) {
            let what = kind.field();
            let start = Instant::now();
            if name == "none" && kind.is_rate() {
                continue;
            }
            let proved = prove_value(&engine, &samples, kind, &x, &e).unwrap_or_else(|| panic!("{name}: {what}"));
            let time = start.elapsed().as_secs_f64() * 1e3;
            println!(
                "{name}: {what:8} {:9.5} over {:9.5}: {} boxes, {time:.1} ms",
                proved.value.to_f64(),
                proved.sampled,
                proved.boxes
            );
            let bound = if kind.is_rate() { -proved.value.to_f64() } else { proved.value.to_f64() };
            let largest = samples.largest_at(kind, [reach, e.to_f64()], &random_points(engine.states(), 100_000));
            assert!(largest <= bound, "{name}: {what}: {largest} above {bound}");
            let sampled = samples.refined(kind, reach, e.to_f64()).value;
            assert!(
                largest <= if kind.is_rate() { -sampled } else { sampled } + 1e-3 * largest.abs(),
                "{name}: {what}"
            );
            if sampled == 0.0 {
                continue;
            }
            let below = if kind.is_rate() { sampled + 0.01 * sampled.abs() } else { sampled - 0.01 * sampled.abs() };
            let value = Rational::from_f64(below).unwrap();
            let entry = Entry { bound: kind, x: x.clone(), e: e.clone(), value };
            assert!(!engine.decide(&entry, 4000).truth.is_true(), "{name}: {what} below its supremum");
        }
    }
}

/// Polynomials in |y| and |e| above the derivatives of x' = -x - x^3 + x e^2, e' = x e + u, and a little below them.
#[test]
fn majorants_hold_at_every_point_or_are_refused() {
    let plant = plant(&["x"], &["-x - x^3 + x*e^2"], "x*e");
    let still = TrigonometricVector { mean: vec![Rational::new()], harmonics: Vec::new() };
    let Case { engine, .. } = case(&plant, &[vec![2.0]], still, "1e-6");
    let polynomial = |terms: &[(u32, u32, &str)]| Majorant {
        terms: terms.iter().map(|(x, e, c)| Term { x: *x, e: *e, coefficient: rational(c) }).collect(),
    };
    let decide = |kind: Bound, terms: &[(u32, u32, &str)]| {
        let domain = [rational("0.5"), rational("0.8")];
        engine.decide_majorant(kind, &polynomial(terms), domain.each_ref(), 20_000).truth
    };
    // x = 2 y: f_x = -1 - 12 y^2 + e^2, f_e = 4 y e in x and 2 y e in y, q_x L = 2 e, q_e = 2 y.
    for (kind, above, below) in [
        (Bound::Fx, vec![(0, 0, "1.001"), (2, 0, "12.01")], vec![(0, 0, "1.001"), (2, 0, "11.9")]),
        (Bound::Fe, vec![(0, 0, "0.001"), (1, 1, "2.01")], vec![(0, 0, "0.001"), (1, 1, "1.9")]),
        (Bound::Qx, vec![(0, 0, "0.001"), (0, 1, "2.01")], vec![(0, 0, "0.001"), (0, 1, "1.99")]),
        (Bound::QeMax, vec![(0, 0, "0.001"), (1, 0, "2.01")], vec![(0, 0, "-0.1"), (1, 0, "2.1")]),
        (Bound::Rate, vec![(0, 0, "0.999"), (0, 2, "-1.01")], vec![(0, 0, "0.999"), (0, 2, "-0.99")]),
        (Bound::Q, vec![(0, 0, "0.001"), (1, 1, "2.01")], vec![(0, 0, "0.001"), (1, 1, "1.98")]),
        (Bound::Fxx, vec![(0, 0, "0.001"), (1, 0, "24.1")], vec![(0, 0, "0.001"), (1, 0, "23.9")]),
        (Bound::Fex, vec![(0, 0, "0.001"), (0, 1, "2.01")], vec![(0, 0, "0.001"), (0, 1, "1.99")]),
    ] {
        assert!(decide(kind, &above).is_true(), "{}", kind.field());
        assert!(!decide(kind, &below).is_true(), "{}", kind.field());
    }
    // What is not monotone bounds nothing at larger arguments.
    assert!(!decide(Bound::Qe, &[(0, 0, "9"), (1, 0, "-1")]).is_true());
    assert!(!decide(Bound::Rate, &[(0, 0, "-9"), (1, 0, "1")]).is_true());
    assert!(!decide(Bound::RateExistence, &[(0, 0, "-9")]).is_true());
}

#[test]
fn spikes_are_seen() {
    let spike = "exp(-4000*(1 - cos(2*pi*t - 1)))";
    let plant = plant(&["x"], &[&format!("-x + x*{spike} + e*{spike}")], &format!("x*{spike} + e*{spike}"));
    let still = TrigonometricVector { mean: vec![Rational::new()], harmonics: Vec::new() };
    let Case { engine, .. } = case(&plant, &[vec![1.0]], still, "0");
    let (x, e) = (Rational::from(1), Rational::from(1));
    for (kind, below, above) in [
        (Bound::Fe, "0.99", "1.001"),
        (Bound::Qx, "0.99", "1.001"),
        (Bound::Qe, "0.99", "1.001"),
        (Bound::QeMax, "0.99", "1.001"),
        // The rate is 1 away from the spike and 0 on it.
        (Bound::Rate, "0.01", "-0.001"),
    ] {
        let decide = |value: &str| {
            engine.decide(&Entry { bound: kind, x: x.clone(), e: e.clone(), value: rational(value) }, 10_000).truth
        };
        assert!(!decide(below).is_true(), "{}", kind.field());
        assert!(decide(above).is_true(), "{}", kind.field());
    }
}

#[test]
fn corners_are_refused_with_their_reason() {
    let region = || {
        let still = TrigonometricVector { mean: vec![Rational::new()], harmonics: Vec::new() };
        Region::new(vec![vec![Rational::from(1)]], still, Rational::new()).unwrap()
    };
    let (x, e) = (Rational::from(1), Rational::from(1));
    for (text, part, reason) in [
        ("abs(x)", "abs(x)", "the argument of abs vanishes"),
        ("abs(x - 1)", "abs(x - 1)", "the argument of abs vanishes"),
        ("sqrt(1 + x)", "sqrt(1 + x)", "sqrt is not positive"),
        ("log(x)", "log(x)", "log is not positive"),
        ("2 + min(x, 1)", "min(x, 1)", "arguments are equal"),
        ("max(x, e)", "max(x, e)", "arguments are equal"),
        ("1/x", "1/x", "the divisor vanishes"),
        ("1/(2 - x - e)", "1/(2 - x - e)", "the divisor vanishes"),
        ("1/sin(2*pi*t)", "1/sin(2*pi*t)", "the divisor vanishes"),
        ("tan(2*x)", "tan(2*x)", "cosine that vanishes"),
        ("x^-2", "x^-2", "negative power vanishes"),
        ("(1 + x)^(3/2)", "(1 + x)^(3/2)", "power is not positive"),
    ] {
        let engine = Engine::new(&plant(&["x"], &["-x"], text), region(), None, None).unwrap();
        let failure = engine.smooth(&x, &e).unwrap_err();
        assert_eq!((failure.part.as_str(), failure.index), (part, 1), "{text}");
        let said = failure.to_string();
        assert!(said.contains(reason) && !said.contains("not true"), "{said}");
        let advice = failure.advice();
        // What changes the model is no way to write it.
        let is_quotient = reason == "the divisor vanishes";
        let expected =
            if is_quotient { advice.contains("the model is another one") } else { advice.contains("write ") };
        assert!(expected, "{text}: {advice}");
    }
    for text in [
        "abs(x - 1.01)",
        "sqrt(1.01 + x)",
        "min(x, 1.01)*max(e, -1.01)",
        "1/(2.01 - x - e)",
        "1/(1.01 + sin(2*pi*t))",
        "tan(x)",
        "(1.01 + x)^(3/2) + 2^x",
        "x^3 + log(2)",
    ] {
        let engine = Engine::new(&plant(&["x"], &["-x"], text), region(), None, None).unwrap();
        assert_eq!(engine.smooth(&x, &e), Ok(()), "{text}");
    }
}

/// x' = (-1 + 2 cos(2 pi t)) x has the rate -1 with P = 1, and 1 with `P = exp(-(2/pi) sin(2 pi t))` near its Fourier sum.
#[test]
fn a_periodic_matrix_proves_a_rate_that_no_constant_one_has() {
    let plant = plant(&["x"], &["(-1 + 2*cos(2*pi*t))*x"], "e");
    let region = || {
        let still = TrigonometricVector { mean: vec![Rational::new()], harmonics: Vec::new() };
        Region::new(vec![vec![Rational::from(1)]], still, Rational::new()).unwrap()
    };
    let steps = 256;
    let wave = |k: f64, phase: f64| {
        let sum: f64 = (0..steps)
            .map(|i| {
                let angle = std::f64::consts::TAU * f64::from(i) / f64::from(steps);
                (-2.0 / std::f64::consts::PI * angle.sin()).exp() * (k * angle - phase).cos()
            })
            .sum();
        vec![vec![Rational::from_f64(sum / f64::from(steps) * if k > 0.0 { 2.0 } else { 1.0 }).unwrap()]]
    };
    let quarter = std::f64::consts::FRAC_PI_2;
    let harmonics = (1..=8).map(|k| [wave(f64::from(k), 0.0), wave(f64::from(k), quarter)]).collect();
    let matrix = PeriodicMatrix { mean: wave(0.0, 0.0), harmonics };
    let engine = Engine::new(&plant, region(), Some(matrix), Some(identity(1))).unwrap();
    let decide = |bound: Bound, value: &str| {
        engine.decide(&Entry { bound, x: Rational::from(1), e: Rational::from(1), value: rational(value) }, 4000).truth
    };
    assert!(decide(Bound::Rate, "0.99").is_true());
    assert!(!decide(Bound::Rate, "1.01").is_true());
    assert!(decide(Bound::RateExistence, "-1.001").is_true());
    assert!(!decide(Bound::RateExistence, "-0.99").is_true());
}
