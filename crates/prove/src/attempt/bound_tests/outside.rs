//! What is not smooth outside of the ball but inside of a box that protrudes from it: no such box may be proved for another
//! formula than that of its part in the ball (docs/mathematics.md, 11.6).
//!
//! All features depend on `y = 0.6 a + 0.8 b` alone. Beyond y = 1.045, which no point of the ball reaches, the slope of `edge` falls
//! from about 1000 to 0 or there is none; the box [1/2, 1]^2 has its middle there. The slope of `bump`, at most 900, is in this box
//! alone: with the slope at its middle the box would be proved for every value from 900 on.

use super::*;
use sigmastar_lang::spec::Bound;

const BUMP: &str = "0.6*(1 + tanh(1500*(Y - 0.9965)))";
const BUMP_SLOPE: &str = "900*(1 - tanh(1500*(Y - 0.9965))^2)";

/// Functions of Y with a kink, a pole or an end of their domain at 1.045, and of e with the same slope in e.
const EDGES: [[&str; 2]; 9] = [
    ["1000*min(Y - 1.045, 0)", "min(1000*e, 1e5*(1.045 - Y))"],
    ["-1000*max(1.045 - Y, 0)", "-max(-1000*e, 1e5*(Y - 1.045))"],
    ["500*(Y - abs(Y - 1.045))", "500*e + 5e4*(1.045 - Y) - abs(500*e - 5e4*(1.045 - Y))"],
    ["2/(1.045 - Y)", "40*e/(1.045 - Y)"],
    ["-400*sqrt(1.045 - Y)", "5000*e*sqrt(1.045 - Y)"],
    ["-40*log(1.045 - Y)", "-300*e*log(1.045 - Y)"],
    ["30*tan(1.503*Y)", "40*e*tan(1.503*Y)"],
    ["-3000*(1.045 - Y)^(3/2)", "5000*e*(1.045 - Y)^(1/2)"],
    ["2*(1.045 - Y)^-1", "2*e*(1.045 - Y)^-2"],
];

/// The right sides and q of the plant in which the edge is in this bound, and Y as it is there.
fn formulas(kind: Bound, [edge, edge_e]: [&str; 2], y: &str) -> ([String; 2], String) {
    let (of_y, of_e) = (format!("({edge} + {BUMP})"), format!("({edge_e} + e*{BUMP_SLOPE})"));
    let none = || "0".to_owned();
    let (decay, along, q) = match kind {
        Bound::Fx | Bound::Rate | Bound::RateExistence => (3000, of_y, none()),
        Bound::Fe => (1, of_e, none()),
        Bound::Qx => (1, none(), of_y),
        Bound::Qtx => (1, none(), format!("{of_y}*sin(2*pi*t)/6")),
        Bound::Qte => (1, none(), format!("{of_e}*sin(2*pi*t)/6")),
        _ => (1, none(), of_e),
    };
    let f = [("a", "0.6"), ("b", "0.8")].map(|(x, part)| format!("-{decay}*{x} + {part}*{along}"));
    (f.map(|f| f.replace('Y', y)), q.replace('Y', y))
}

/// Points on the ray that sees the bump, with e at its ends, at the times at which a wave has its extremes.
fn on_the_ray() -> Vec<(f64, Vec<f64>, f64)> {
    let reach = (0..=400).map(|i| 0.99 + 0.01 * f64::from(i) / 400.0);
    let at = |part: f64| [0.0, 0.25, 0.5].map(|t| [1.0, -1.0].map(|e| (t, vec![0.6 * part, 0.8 * part], e)));
    reach.flat_map(at).flatten().collect()
}

fn decide(engine: &Engine, kind: Bound, [x, e]: [&str; 2], value: f64, effort: usize) -> Decision {
    let value = Rational::from_f64(value).unwrap();
    engine.decide(&Entry { bound: kind, x: rational(x), e: rational(e), value }, effort)
}

/// One per mille below what is met in the ball is never proved; whether a little above it is, where that is asked for.
fn examine(plant: &Plant, orbit: TrigonometricVector, kind: Bound, what: &str, also_above: bool) -> bool {
    let unit = vec![vec![1.0, 0.0], vec![0.0, 1.0]];
    let p = identity(2);
    let samples = FloatSuprema::new(plant, FloatCurve::from(&orbit), unit, [Some(&p), Some(&p)]);
    let region = Region::new(p.mean.clone(), orbit, Rational::new()).unwrap();
    let engine = Engine::new(plant, region, Some(p.clone()), Some(p)).unwrap();
    let set = ["0.998", "1"];
    let [x, e] = set.map(rational);
    assert_eq!(engine.smooth(&x, &e), Ok(()), "{what}");
    let largest = samples.largest_at(kind, [0.998, 1.0], &on_the_ray());
    let [below, above] = [-0.001, 0.01].map(|part| {
        let moved = largest + part * largest.abs();
        if kind.is_rate() { -moved } else { moved }
    });
    let false_one = decide(&engine, kind, set, below, 500);
    assert!(!false_one.truth.is_true(), "{what}: {} at {below}, {largest} in the ball", kind.field());
    also_above && decide(&engine, kind, set, above, 4000).truth.is_true()
}

#[test]
fn an_edge_outside_of_the_ball_proves_nothing_false() {
    let still = || TrigonometricVector { mean: vec![Rational::new(); 2], harmonics: Vec::new() };
    let mut proved = 0;
    for edges in EDGES {
        for kind in TABLE {
            let ([f, g], q) = formulas(kind, edges, "(0.6*a + 0.8*b)");
            let also_above = kind == Bound::Qx;
            proved += u32::from(examine(&plant(&["a", "b"], &[&f, &g], &q), still(), kind, edges[0], also_above));
        }
    }
    println!("{proved} of {} true values proved", EDGES.len());
    assert!(proved >= 4, "{proved}");
}

#[test]
fn nor_does_one_that_moves_with_the_orbit() {
    let moving = || curve(&["0", "0"], &[["0.12", "0"], ["0.16", "0"]]);
    for edges in [EDGES[0], EDGES[2], EDGES[3]] {
        for kind in TABLE {
            let ([f, g], q) = formulas(kind, edges, "(0.6*a + 0.8*b - cos(2*pi*t)/5)");
            examine(&plant(&["a", "b"], &[&f, &g], &q), moving(), kind, edges[0], false);
        }
    }
}

/// A second equilibrium at |x| = 0.99703 with the eigenvalue +505, and a rate of 0.1 that a box beyond the kink would prove.
#[test]
fn a_rate_that_only_a_box_beyond_the_kink_has_is_refused() {
    let y = "(0.6*a + 0.8*b)";
    let m = format!("(99999999*(min({y} - 1.045, 0) + 1.045) + 0.6*(1 + tanh(1500*({y} - 0.9965))))");
    let f = [format!("-1e8*a + 0.6*{m}"), format!("-1e8*b + 0.8*{m}")];
    let plant = plant(&["a", "b"], &[&f[0], &f[1]], "e");
    let p = identity(2);
    let still = TrigonometricVector { mean: vec![Rational::new(); 2], harmonics: Vec::new() };
    let region = Region::new(p.mean.clone(), still, Rational::new()).unwrap();
    let engine = Engine::new(&plant, region, Some(p.clone()), Some(p)).unwrap();
    for kind in [Bound::Rate, Bound::RateExistence] {
        for x in ["0.998", "1"] {
            assert!(!decide(&engine, kind, [x, "0"], 0.1, 20_000).truth.is_true(), "{x}");
        }
        // Where the bump is not reached there is none but -1e8 + 99999999, and little of the bump.
        assert!(decide(&engine, kind, ["0.99", "0"], 0.1, 20_000).truth.is_true());
    }
}

/// Undefined whatever it is multiplied with: the zeros of L and of P leave nothing out.
#[test]
fn a_zero_factor_leaves_nothing_undefined_out() {
    let still = || TrigonometricVector { mean: vec![Rational::new(); 2], harmonics: Vec::new() };
    let p = identity(2);
    // 1/(e - 1/2) has a pole in the region, and smoothness, which would refuse it, is not asked for.
    let plant = plant(&["a", "b"], &["-a + b/(e - 1/2)", "-b"], "a/(e - 1/2)");
    let region = Region::new(p.mean.clone(), still(), Rational::new()).unwrap();
    let engine = Engine::new(&plant, region, Some(p.clone()), Some(p)).unwrap();
    for kind in [Bound::Fx, Bound::Fe, Bound::Qx, Bound::Qe, Bound::QeMax, Bound::Rate, Bound::RateExistence] {
        let value = if kind.is_rate() { -1e9 } else { 1e9 };
        assert!(!decide(&engine, kind, ["1", "1"], value, 2000).truth.is_true(), "{}", kind.field());
    }
}
