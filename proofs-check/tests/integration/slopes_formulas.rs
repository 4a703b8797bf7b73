//! (D) of the rates of claims by a matrix inequality: its question about formulas against matrices by hand.

use super::matrix_inequality::at_rest;
use super::plant_support::Parts;
use crate::common::drawn;
use proofs_check::verdict::Verdict;
use serde_json::{Value, json};

const PLACE: &str = "/witness/for_n_o/0/slopes";
/// How far from the border of what holds.
const STEP: f64 = 1e-9;

type Matrix = Vec<Vec<f64>>;

/// `G D + D'G' + D'H D`, D all of its columns or some.
fn taken(g: &Matrix, h: &Matrix, d: &Matrix) -> Matrix {
    let all = 0..d[0].len();
    let dot = |value: &dyn Fn(usize) -> f64| (0..d.len()).map(value).sum::<f64>();
    let g_d = |i: usize, j: usize| dot(&|k| g[i][k] * d[k][j]);
    let h_d = |i: usize, j: usize| dot(&|k| h[i.max(k)][i.min(k)] * d[k][j]);
    let entry = |i: usize, j: usize| g_d(i, j) + g_d(j, i) + dot(&|k| d[k][i] * h_d(k, j));
    all.clone().map(|i| all.clone().map(|j| entry(i, j)).collect()).collect()
}

fn text(value: f64) -> Value {
    json!(format!("{value:.15}"))
}

fn triangle(value: &dyn Fn(usize, usize) -> f64, order: usize) -> Value {
    (0..order).map(|i| (0..=i).map(|j| text(value(i, j))).collect::<Value>()).collect()
}

/// `Q + shift I`, G and H of so many columns.
fn slopes(q: &Matrix, shift: f64, g: &Matrix, h: &Matrix) -> Value {
    json!({
        "Q": triangle(&|i, j| q[i][j] + if i == j { shift } else { 0.0 }, g.len()),
        "G": g.iter().map(|row| row.iter().map(|value| text(*value)).collect::<Value>()).collect::<Value>(),
        "H": triangle(&|i, j| h[i][j], h.len()),
    })
}

/// The part for n_o = 0 with slopes of a plant with so many states; of Pi and the rest of it (D) has nothing.
fn of_none(states: usize, slopes: &Value, [x, e]: [&str; 2]) -> Value {
    let pi = triangle(&|i, j| f64::from(u8::from(i == j)), states + 2);
    let witness = json!({ "n_o": 0, "Pi": pi, "slopes": slopes, "x_up": "1", "e_low": "1", "e_up": "1", "z_up": "1" });
    json!({ "X": x, "E": e, "list": [witness] })
}

/// The part for n_o = 0 with `Q + shift I`, G and H of all columns.
fn part(q: &Matrix, shift: f64, g: &Matrix, h: &Matrix, at: [&str; 2]) -> Value {
    of_none(h.len() - 1, &slopes(q, shift, g, h), at)
}

#[track_caller]
fn decided(parts: &Parts, q: &Matrix, g: &Matrix, h: &Matrix, at: [&str; 2], shifts: [f64; 2]) {
    parts.clone().with("/slopes", part(q, shifts[0], g, h, at)).accepted();
    parts.clone().with("/slopes", part(q, shifts[1], g, h, at)).refused(Verdict::Invalid, "rates", PLACE);
}

fn matrix(rows: &[&[f64]]) -> Matrix {
    rows.iter().map(|row| row.to_vec()).collect()
}

/// One for `[J; r]` and one for `[g; d]`, in `|y| <= X`, `|e| <= E` with a splitting.
fn parts_of([of_states, of_error]: [&Value; 2], at: [&str; 2], [x, e]: [&str; 2]) -> Value {
    let states = of_states["H"].as_array().unwrap().len() - 1;
    let mut part = of_none(states, &json!({ "states": of_states, "error": of_error }), at);
    part["splitting"] = json!({ "X": x, "E": e });
    part
}

/// Every number of Q, G, H, of the derivatives and of the coordinates is where it belongs.
#[test]
fn against_what_is_left_by_hand() {
    let mut draw = drawn(29);
    for _ in 0..20 {
        let mut number = || (draw() * 256.0).round() / 128.0 - 1.0;
        // f = A (x, z) + v e, q = r (x, z) + d e, and L.
        let numbers: Vec<f64> = (0..9).map(|_| number()).collect();
        let [a, b, c, m, v, u, r, s, d] = numbers.try_into().unwrap();
        let l = [[2.0, 0.0], [number(), 0.5]];
        let (slope, other) = (a - 40.0, m - 40.0);
        // L^-1 = [1/2, 0; -l_10, 2].
        let inverse = |[p, q]: [f64; 2]| [p / 2.0, 2.0 * q - l[1][0] * p];
        let columns =
            [[slope * l[0][0] + b * l[1][0], c * l[0][0] + other * l[1][0]], [b * l[1][1], other * l[1][1]], [v, u]];
        let columns = columns.map(inverse);
        let last = [r * l[0][0] + s * l[1][0], s * l[1][1], d];
        let derivatives: Matrix =
            vec![columns.map(|column| column[0]).to_vec(), columns.map(|column| column[1]).to_vec(), last.to_vec()];
        let g: Matrix = (0..3).map(|_| (0..3).map(|_| number()).collect()).collect();
        let mut h: Matrix = (0..3).map(|i| (0..=i).map(|_| number()).collect()).collect();
        (0..3).for_each(|i| h[i][i] = 4.0 + number());
        let parts = at_rest("x", "x").with("/plant/states", json!(["x", "z"]));
        let parts = parts
            .with("/plant/f", json!([format!("{slope}*x + {b}*z + {v}*e"), format!("{c}*x + {other}*z + {u}*e")]))
            .with("/plant/q", json!(format!("{r}*x + {s}*z + {d}*e")))
            .with("/witness/coordinates", json!([["2", "0"], [l[1][0].to_string(), "1/2"]]))
            .with("/witness/orbit/mean", json!(["0", "0"]))
            .with("/witness/lyapunov/P", json!([["1", "0"], ["0", "1"]]));
        decided(&parts, &taken(&g, &h, &derivatives), &g, &h, ["1", "1"], [STEP, -STEP]);

        // The same of the first two columns, with the first two rows of G, and of the last one, with the last row.
        let own = |columns: std::ops::Range<usize>| {
            let d: Matrix = derivatives.iter().map(|row| row[columns.clone()].to_vec()).collect();
            let g = g[columns].to_vec();
            let q = taken(&g, &h, &d);
            [STEP, -STEP].map(|shift| slopes(&q, shift, &g, &h))
        };
        let ([of_states, less], [of_error, less_of_error]) = (own(0..2), own(2..3));
        let with = |both| parts.clone().with("/slopes", parts_of(both, ["1", "1"], ["1", "1"]));
        with([&of_states, &of_error]).accepted();
        let at = |part: &str| format!("{PLACE}/{part}");
        with([&less, &of_error]).refused(Verdict::Invalid, "rates", &at("states"));
        with([&of_states, &less_of_error]).refused(Verdict::Invalid, "rates", &at("error"));
    }
}

/// Each part has its own region: [J; r] of `|y| <= X` and the E of the splitting, [g; d] of the X of the splitting and `|e| <= E`.
#[test]
fn parts_over_their_regions() {
    // J = -2 - 3 x^2 + e/2, r = 1/2 + e/4, g = 3/10 + x/2, d = x/4 + e/2.
    let plant = at_rest("-2*x - x^3 + 3*e/10 + x*e/2", "x/2 + x*e/4 + e^2/4");
    let h = matrix(&[&[0.5], &[0.1, 0.7]]);
    let (of_x, of_e) = (matrix(&[&[0.3, -0.2]]), matrix(&[&[0.1, 0.4]]));
    // What Q has to be at least, to within what a fine grid of the whole region misses; the extremes are at its ends.
    let largest = |g: &Matrix, column: &dyn Fn(f64, f64) -> [f64; 2], [x, e]: [f64; 2]| {
        let grid = |end: f64| (0..=200).map(move |k| end * (f64::from(k) / 100.0 - 1.0));
        let value = |x: f64, e: f64| taken(g, &h, &column(x, e).map(|entry| vec![entry]).to_vec())[0][0];
        grid(x).flat_map(|x| grid(e).map(move |e| (x, e))).map(|(x, e)| value(x, e)).fold(f64::MIN, f64::max)
    };
    let in_x = |x: f64, e: f64| [-2.0 - 3.0 * x * x + e / 2.0, 0.5 + e / 4.0];
    let in_e = |x: f64, e: f64| [0.3 + x / 2.0, x / 4.0 + e / 2.0];
    let made = |of_states: [f64; 2], of_error: [f64; 2], shift: f64| {
        let of = |g: &Matrix, least: f64| slopes(&vec![vec![least]], shift, g, &h);
        let [x, e] = [of(&of_x, largest(&of_x, &in_x, of_states)), of(&of_e, largest(&of_e, &in_e, of_error))];
        [x, e]
    };
    // X, E and those of the splitting.
    let (at, split) = (["0.9", "0.8"], ["0.3", "0.2"]);
    let with = |[of_states, of_error]: &[Value; 2], at, split| {
        plant.clone().with("/slopes", parts_of([of_states, of_error], at, split))
    };
    let right = made([0.9, 0.2], [0.3, 0.8], 1e-4);
    with(&right, at, split).accepted();
    // Where the inequality reaches farther in either, they do not hold.
    for (at, split, part) in [
        (["0.95", "0.8"], split, "states"),
        (at, ["0.3", "0.25"], "states"),
        (at, ["0.35", "0.2"], "error"),
        (["0.9", "0.85"], split, "error"),
    ] {
        with(&right, at, split).refused(Verdict::Invalid, "rates", &format!("{PLACE}/{part}"));
    }
    // What holds in a smaller region alone, of x or of e.
    for (of_states, of_error, part) in [
        ([0.85, 0.2], [0.3, 0.8], "states"),
        ([0.9, 0.15], [0.3, 0.8], "states"),
        ([0.9, 0.2], [0.25, 0.8], "error"),
        ([0.9, 0.2], [0.3, 0.75], "error"),
    ] {
        let made = with(&made(of_states, of_error, 1e-4), at, split);
        made.refused(Verdict::Invalid, "rates", &format!("{PLACE}/{part}"));
    }
    // With one state either has the shape of the other.
    let [of_states, of_error] = right;
    with(&[of_error, of_states], at, split).refused(Verdict::Invalid, "rates", &format!("{PLACE}/states"));
    // The same numbers for both: of [J; r] they hold by far, of [g; d] they do not.
    let same = slopes(&matrix(&[&[0.0]]), 0.0, &matrix(&[&[2.0, 0.0]]), &matrix(&[&[0.1], &[0.0, 0.1]]));
    with(&[same.clone(), same], at, split).refused(Verdict::Invalid, "rates", &format!("{PLACE}/error"));
}

/// The border is that of the worst derivatives on the whole region, of x and of e.
#[test]
fn over_the_region() {
    let (g, h) = (matrix(&[&[0.3, -0.2], &[0.1, 0.4]]), matrix(&[&[0.5], &[0.1, 0.7]]));
    let at = |j: f64, r: f64, d: f64| taken(&g, &h, &matrix(&[&[j, 0.3], &[r, d]]));
    // A number that nothing but the ends of the region asks for.
    let largest = |one: &Matrix, other: &Matrix| -> Matrix {
        // The larger of two matrices that differ in one entry of the diagonal alone.
        (0..2).map(|i| (0..2).map(|j| one[i][j].max(other[i][j])).collect()).collect()
    };
    for (f, q, worst) in [
        // d = e/2 within E.
        ("-2*x + 3*e/10", "x/2 + e^2/4", [(-2.0, 0.5, 0.25), (-2.0, 0.5, -0.25)]),
    ] {
        let parts = at_rest(f, q);
        let [one, other] = worst.map(|(j, r, d)| at(j, r, d));
        // In e alone, with what stands beside it left out by a large entry of x.
        let mut both = largest(&one, &other);
        both[0][0] += 1e6;
        let beside = (one[0][1] - other[0][1]).powi(2) / 1e6;
        both[0][1] = f64::midpoint(one[0][1], other[0][1]);
        both[1][0] = both[0][1];
        both[1][1] += beside;
        let below = |drop: f64| {
            let mut q = both.clone();
            q[1][1] -= drop;
            q
        };
        parts.clone().with("/slopes", part(&both, 0.0, &g, &h, ["1", "0.5"])).accepted();
        for (drop, at) in [(0.01, ["1", "0.5"]), (0.0, ["1", "0.6"])] {
            let made = parts.clone().with("/slopes", part(&below(drop), 0.0, &g, &h, at));
            made.refused(Verdict::Invalid, "rates", PLACE);
        }
        // In a smaller region the same number does, but not where that is the one of a splitting.
        parts.clone().with("/slopes", part(&below(0.01), 0.0, &g, &h, ["1", "0.4"])).accepted();
        let made = parts.with("/slopes", part(&below(0.01), 0.0, &g, &h, ["1", "0.5"]));
        made.with("/slopes/splitting", json!({ "X": "1", "E": "0.4" })).refused(Verdict::Invalid, "rates", PLACE);
    }
    // j = -2 - 3 x^2: at the end of the ball.
    let steep = at_rest("-2*x - x^3 + 3*e/10", "x/2");
    let mut worst = at(-2.75, 0.5, 0.0);
    let (middle, beside) = (at(-2.0, 0.5, 0.0), worst[0][1]);
    assert!(worst[0][0] > middle[0][0]);
    worst[1][1] += 1e6;
    worst[0][1] = f64::midpoint(beside, middle[0][1]);
    worst[1][0] = worst[0][1];
    decided(&steep, &worst, &g, &h, ["0.5", "1"], [1e-4, -0.01]);
    let mut small = worst.clone();
    small[0][0] -= 0.01;
    steep.clone().with("/slopes", part(&small, 0.0, &g, &h, ["0.49", "1"])).accepted();
    let made = steep.with("/slopes", part(&small, 0.0, &g, &h, ["0.5", "1"]));
    made.with("/slopes/splitting", json!({ "X": "0.49", "E": "1" })).refused(Verdict::Invalid, "rates", PLACE);
}

/// dq/de is -1/4 at e = 0, half way and at both ends, where samples look, and larger between.
#[test]
fn what_holds_at_samples_alone_is_refused() {
    let wave = at_rest("-2*x + 3*e/10", "x/2 - e/4 + (1 - cos(2*pi*e))/(4*pi)");
    let (g, h) = (matrix(&[&[0.0, 0.0], &[0.0, 1.0]]), matrix(&[&[0.1], &[0.0, 0.1]]));
    let at = |d: f64| {
        let mut q = taken(&g, &h, &matrix(&[&[-2.0, 0.3], &[0.5, d]]));
        q[0][0] += 1e3;
        q
    };
    let (sampled, true_) = (at(-0.25), at(0.25));
    assert!(sampled[1][1] < true_[1][1]);
    decided(&wave, &true_, &g, &h, ["1", "1"], [0.001, -0.001]);
    let made = wave.with("/slopes", part(&sampled, 0.01, &g, &h, ["1", "1"]));
    made.refused(Verdict::Invalid, "rates", PLACE);
}

/// Every member of a family, not the nominal one.
#[test]
fn of_every_member() {
    let (g, h) = (matrix(&[&[0.0, 0.0], &[0.0, 1.0]]), matrix(&[&[0.1], &[0.0, 0.1]]));
    let at = |d: f64| {
        let mut q = taken(&g, &h, &matrix(&[&[-2.0, 0.3], &[0.5, d]]));
        q[0][0] += 1e3;
        q
    };
    let family = |low: &str, high: &str| {
        let range = json!({ "nominal": "1/4", "low": low, "high": high });
        at_rest("-2*x + 3*e/10", "x/2 + k*e")
            .with("/plant/parameters", json!({ "k": range }))
            .with("/witness/orbit/sensitivities", json!([{ "mean": ["0"] }]))
            .with("/witness/forcing/sensitivities", json!([{ "mean": "0" }]))
    };
    decided(&family("0", "1/2"), &at(0.5), &g, &h, ["1", "1"], [1e-3, -1e-3]);
    let nominal = part(&at(0.25), 1e-3, &g, &h, ["1", "1"]);
    family("0", "1/4").with("/slopes", nominal.clone()).accepted();
    family("0", "1/2").with("/slopes", nominal).refused(Verdict::Invalid, "rates", PLACE);
}

/// Three matrices that are equal are asked about once.
#[test]
fn equal_ones_are_proved_once() {
    let (g, h) = (matrix(&[&[0.3, -0.2], &[0.1, 0.4]]), matrix(&[&[0.5], &[0.1, 0.7]]));
    let q = taken(&g, &h, &matrix(&[&[-2.0, 0.3], &[0.5, -0.25]]));
    let linear = at_rest("-2*x + 3*e/10", "x/2 - e/4");
    let mut both = part(&q, STEP, &g, &h, ["1", "1"]);
    let first = both["list"][0].clone();
    both["list"] = json!([first, first]);
    let lines = |part: &Value| {
        let lines = super::plant_support::judged(&linear.clone().with("/slopes", part.clone()).0).unwrap();
        lines.iter().filter(|line| line.contains("(D)")).count()
    };
    assert_eq!(lines(&both), 1);
    both["list"][1]["slopes"]["G"][0][1] = json!("-0.2000001");
    both["list"][1]["slopes"]["Q"][0][0] = json!("9");
    both["list"][1]["slopes"]["Q"][1][1] = json!("9");
    assert_eq!(lines(&both), 2);
    both["list"][1] = part(&q, -STEP, &g, &h, ["1", "1"])["list"][0].clone();
    let made = linear.with("/slopes", both);
    made.refused(Verdict::Invalid, "rates", "/witness/for_n_o/1/slopes");
}
