//! The ball in which all first derivatives lie together: what is proved holds at random points, and what does not hold is not proved.

use super::*;
use sigmastar_exact::enclosure::Truth;
use sigmastar_matrix::doubles::largest;
use sigmastar_propose::bounds::matrix_of;

/// The least eigenvalue of `Q - G D - D'G' - D'H D`, D a part with some of the columns.
fn least(slopes: &Slopes, d: &[Vec<f64>]) -> f64 {
    let (order, columns) = (d.len(), slopes.q.len());
    let double = |of: &[Vec<Rational>], i: usize, j: usize| of[i][j].to_f64();
    let times = |of: &[Vec<Rational>], i: usize, j: usize| (0..order).map(|k| double(of, i, k) * d[k][j]).sum::<f64>();
    let square = |i: usize, j: usize| (0..order).map(|k| d[k][i] * times(&slopes.h, k, j)).sum::<f64>();
    let entry =
        |i: usize, j: usize| times(&slopes.g, i, j) + times(&slopes.g, j, i) + square(i, j) - double(&slopes.q, i, j);
    -largest((0..columns).map(|i| (0..columns).map(|j| entry(i, j)).collect()).collect())
}

/// H is not diagonal, and the ball is about the middle of the derivatives on the orbit.
fn ball(samples: &FloatSuprema, part: Part, at: [f64; 2]) -> FloatSlopes {
    let met = samples.derivatives_at(part, at, &samples.extreme_places(at));
    let (order, columns) = (met[0].len(), met[0][0].len());
    let mean = |i: usize, j: usize| met.iter().map(|d| d[i][j]).sum::<f64>() / met.len() as f64;
    let rows = |rows: usize, columns: usize, of: &dyn Fn(usize, usize) -> f64| {
        (0..rows).map(|i| (0..columns).map(|j| of(i, j)).collect()).collect()
    };
    let weight = |i: usize, j: usize| if i == j { 1.0 + i as f64 } else { 0.25 };
    let size = rows(columns, columns, &|i, j| weight(j, i) * 0.1);
    FloatSlopes { part, centre: rows(order, columns, &mean), size, h: rows(order, order, &weight) }
}

#[test]
fn a_proved_ball_holds_at_random_points() {
    for (name, Case { engine, samples }, x, e) in cases() {
        for part in Part::EACH.into_iter().filter(|part| !part.columns(engine.states()).is_empty()) {
            let (x, e) = (rational(x), rational(e));
            let at = engine.float_arguments([&x, &e]);
            let fitted = samples.fitted(&ball(&samples, part, at), at).expect("finite");
            let proved = prove_slopes(&engine, &fitted, [&x, &e]).unwrap_or_else(|| panic!("{name}"));
            let points = random_points(engine.states(), 20_000);
            let below = samples.largest_of_derivatives_at(at, &points, |derivatives, _| {
                -least(&proved, &matrix_of(derivatives, part))
            });
            let size = proved.q.iter().enumerate().map(|(i, row)| row[i].to_f64().abs()).fold(0.0, f64::max);
            assert!(below < 0.0 && below > -size, "{name}: {below} {size}");
            // Q less what is left at the points fails there.
            let less = |share: f64| {
                let taken = round_f64(-below * share, 12, Direction::Nearest).unwrap();
                let mut other = proved.clone();
                other.q.iter_mut().enumerate().for_each(|(i, row)| row[i] -= &taken);
                engine.decide_slopes(&other, [&x, &e], 50_000).truth
            };
            assert!(!less(1.05).is_true(), "{name}");
            assert_eq!(engine.decide_slopes(&proved, [&x, &e], 20_000).truth, Truth::True, "{name}");
            // H of a sign, and what is no matrix of this order.
            let negated =
                |of: &[Vec<Rational>]| of.iter().map(|row| row.iter().map(|entry| -entry.clone()).collect()).collect();
            let mut crooked = proved.clone();
            crooked.q.push(Vec::new());
            for other in [
                Slopes { h: negated(&proved.h), ..proved.clone() },
                Slopes { g: Vec::new(), ..proved.clone() },
                crooked,
            ] {
                assert_eq!(engine.decide_slopes(&other, [&x, &e], 1000).truth, Truth::False, "{name}");
            }
            let outside = engine.decide_slopes(&proved, [&-Rational::from(1), &e], 1000);
            assert_eq!(outside.truth, Truth::Undecided, "{name}");
        }
    }
}

/// D = d = 3 + tanh(e) with Q = -8, G = -3, H = 1: `-8 + 6 d - d^2 = 1 - (d - 3)^2`, which is positive for |tanh(e)| < 1.
#[test]
fn by_hand() {
    let none = plant(&[], &[], "3*e + log(cosh_of_e)".replace("cosh_of_e", "exp(e) + exp(-e)").as_str());
    let orbit = TrigonometricVector { mean: Vec::new(), harmonics: Vec::new() };
    let Case { engine, .. } = case(&none, &[], orbit, "0");
    let slopes = |q: &str| {
        let one = |text: &str| vec![vec![rational(text)]];
        Slopes { part: Part::All, q: one(q), g: one("-3"), h: one("1") }
    };
    let zero = Rational::new();
    // (d - 3)^2 <= tanh(1)^2 = 0.58002...
    for (q, truth) in [("-8", Truth::True), ("-8.4199", Truth::True), ("-8.42", Truth::False)] {
        let found = engine.decide_slopes(&slopes(q), [&zero, &rational("1")], 10_000).truth;
        assert!(found == truth || (truth == Truth::False && !found.is_true()), "{q}: {found:?}");
    }
}
