//! What either program proves to be a bounding function is defined and nondecreasing at random pairs of points.

use super::{any, decimal, random};
use crate::support::cases;
use proofs_check::expr::ARGUMENTS;
use rand::RngExt;
use rand::rngs::StdRng;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::expr::{Expr, ProofSettings, Variables, prove_bounding};

/// Bits of the values that are compared.
const PRECISION: u32 = 300;

/// Points of a grid along an axis, and lines of each direction.
const GRID: u32 = 240;
const LINES: u32 = 3;

/// Steps of interval arithmetic that the checker may take.
const STEPS: u64 = 3_200_000;

/// Nondecreasing functions, and some that nearly are: a dip, an edge, a pole or an end of a domain at a random place.
fn leaf(random: &mut StdRng) -> String {
    let x = *any(random, &["X", "E", "X", "E", "X*E", "(X + E)"]);
    let [a, b] = [0, 1].map(|_| decimal(random, 2, 0.05, 3.0));
    let nearly = *any(random, &["3", "2.9999", "2.99", "3.01", "2.5"]);
    match random.random_range(0..25) {
        0..=5 => x.to_owned(),
        6 => a,
        7 => format!("{x}^2/({a} + {x})"),
        8 => format!("max({x}, {a})"),
        9 => format!("min({x}, {a})"),
        10 => format!("{a}*tanh({b}*{x})"),
        11 => format!("sqrt({x} + {a})"),
        12 => format!("({x} + tanh({a} - {x}))"),
        13 => format!("({x} - {b}*sin({x})/3)"),
        14 => format!("{x}^3 - 3*{a}*{x}^2 + {nearly}*{a}^2*{x}"),
        15 => format!("({x} - 0.01*tanh(60*({x} - {a})))"),
        16 => format!("(3*{x} - min({a}*{x}, {b}) - max({b}, {x}))"),
        17 => format!("abs({x} - {a}) + {b}*{x}"),
        18 => format!("{x}/(10*{a} - {x})"),
        19 => format!("({a} + {x})*log({a} + {x})"),
        20 => format!("({x} + {a})^({b}*E)"),
        21 => format!("{x}*exp(-{x}/{a})"),
        22 => format!("tan({x}/{})", decimal(random, 2, 1.0, 3.0)),
        23 => format!("{b}*exp({x}*{a})"),
        _ => format!("({x} - {a})^{}", random.random_range(0..6)),
    }
}

fn expression(random: &mut StdRng, depth: u32) -> String {
    if depth == 0 {
        return leaf(random);
    }
    let (a, b) = (expression(random, depth - 1), expression(random, depth - 1));
    match random.random_range(0..16) {
        0..=5 => format!("({a}) + ({b})"),
        6..=8 => format!("({a})*({b})"),
        9 => format!("max({a}, {b})"),
        10 => format!("min({a}, {b})"),
        11 => format!("({a})/(1 + ({b}))"),
        12 => format!("({a}) - ({b})/10"),
        13 => format!("{}({a})", any(random, &["sqrt", "exp", "log", "atan", "tanh", "abs", "tan", "exprelr", "sinc"])),
        14 => format!("({a})^{}", any(random, &["2", "3", "0.5", "(3/2)", "0", "-1", "(1 + E)"])),
        _ => format!("({a})*({b} - {})", decimal(random, 1, 0.0, 2.0)),
    }
}

/// A decrease along an axis or a point without a value: first on a grid in doubles, then by enclosures.
fn counterexample(expr: &Expr, ends: [&Rational; 2], random: &mut StdRng) -> Option<String> {
    let float = expr.to_float();
    let at = |point: &[Rational; 2]| {
        let [x, e] = point.each_ref().map(|value| Enclosure::from_rational(value, PRECISION));
        expr.enclose(&x, &e)
    };
    for line in 0..2 * LINES {
        let along = usize::from(line >= LINES);
        let part = Rational::from((random.random_range(0..=16), 16));
        let across = if line % LINES == 0 { Rational::new() } else { part * ends[1 - along] };
        let place = |step: u32| {
            let own = Rational::from((step, GRID)) * ends[along];
            if along == 0 { [own, across.clone()] } else { [across.clone(), own] }
        };
        let mut last: Option<(f64, u32)> = None;
        for step in 0..=GRID {
            let point = place(step);
            let value = float.eval(point[0].to_f64(), point[1].to_f64());
            if !value.is_finite() && !at(&point).is_defined() {
                return Some(format!("it is not defined at {point:?}"));
            }
            if let Some((before, from)) = last.filter(|(before, _)| value < *before) {
                let [low, high] = [place(from), point].map(|point| at(&point));
                if high.lt(&low).is_true() {
                    return Some(format!("it falls from {before} to {value} at {:?}", place(step)));
                }
            }
            last = Some((value, step));
        }
    }
    None
}

#[test]
fn fuzz_monotonicity_by_both_programs() {
    let settings = ProofSettings { max_boxes: 150, max_operations: 6000, ..ProofSettings::default() };
    let (mut proved, cases) = ([0, 0], cases(400, 40_000));
    for case in cases.clone() {
        let random = &mut random(4, case);
        let depth = random.random_range(0..3);
        let text = expression(random, depth);
        let ends = [0, 1].map(|_| Rational::from((random.random_range(1..40), 8)));
        let Ok(expr) = Expr::parse(&text, Variables::XAndE) else { continue };
        let producer = prove_bounding(&expr, &ends[0], &ends[1], &settings).is_ok();
        let checked = proofs_check::expr::Expr::parse(&text, ARGUMENTS).is_ok_and(|expr| {
            let prove = || proofs_check::rules::bounding::prove("q", &expr, &ends[0], &ends[1], 128).is_ok();
            // What an undefined interval made of a rule decides nothing.
            let (answer, steps) = proofs_check::effort::limited(STEPS, prove);
            answer && steps < STEPS
        });
        proved[0] += u64::from(producer);
        proved[1] += u64::from(checked);
        if (producer || checked)
            && let Some(why) = counterexample(&expr, ends.each_ref(), random)
        {
            panic!("case {case}: `{text}` on {ends:?}: {why}; producer {producer}, checker {checked}");
        }
    }
    println!("{proved:?} of {cases:?} proved");
    assert!(proved.iter().all(|proved| *proved * 10 > cases.end - cases.start) || cases.end - cases.start < 100);
}
