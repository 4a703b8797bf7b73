//! What either program takes for periodic in t is so: values one period apart meet, at random points.

use super::{any, random};
use crate::support::cases;
use proofs_check::constant::Constant;
use proofs_check::json::{Field, Json};
use rand::RngExt;
use rand::rngs::StdRng;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::expr::{Enclosing, Expr, Formulas, PlantExpr, PlantNames, Variables};

const PRECISION: u32 = 200;

/// Points of each expression.
const POINTS: usize = 8;

const PERIODS: [&str; 10] = ["1", "2", "1/50", "3/7", "pi", "2*pi", "sqrt(2)", "sqrt(3)*pi/2", "0.25", "exp(1)"];

/// A multiple of t: of a whole number of turns per period in most cases, and nearly or not at all in others.
fn line(random: &mut StdRng, period: &str) -> String {
    let k = random.random_range(-3..6);
    let turns = match random.random_range(0..12) {
        0 => format!("{k}.5"),
        1 => format!("({k} + 1e-9)"),
        2 => format!("{k}/3"),
        3 => format!("sqrt({})", k * k),
        _ => format!("({k})"),
    };
    let all = match random.random_range(0..8) {
        0 => format!("{turns}*t"),
        1 => format!("t*{turns}*3.14159265358979*2/({period})"),
        2 => format!("t*2/(({period})/{turns}/pi)"),
        3 => format!("(pi*t + t*pi)*{turns}/({period})"),
        4 => format!("({turns}*3*pi*t - {turns}*pi*t)/({period})"),
        _ => format!("2*pi*{turns}*t/({period})"),
    };
    let phase = *any(random, &["", " + 1", " - STATE", " + ERROR^2", " + pi/3", " - sqrt(2)*STATE"]);
    format!("{}{all}{phase}", if random.random_bool(0.2) { "-" } else { "" })
}

/// An expression of t, `STATE` and `ERROR`.
fn expression(random: &mut StdRng, period: &str, depth: u32) -> String {
    if depth == 0 || random.random_bool(0.15) {
        let wave = *any(random, &["sin", "cos", "sin", "cos", "tan", "exp", "abs"]);
        return match random.random_range(0..10) {
            0 => "STATE".to_owned(),
            1 => "ERROR".to_owned(),
            2 => random.random_range(-3..4).to_string(),
            3 => format!("({})", line(random, period)),
            _ => format!("{wave}({})", line(random, period)),
        };
    }
    let a = expression(random, period, depth - 1);
    match random.random_range(0..10) {
        0..=5 => {
            let b = expression(random, period, depth - 1);
            match random.random_range(0..7) {
                0 => format!("({a})/(2 + ({b})^2)"),
                1 => format!("min({a}, {b})"),
                2 => format!("({a})^({b})"),
                operation => format!("({a}) {} ({b})", ["*", "+", "-", "*"][operation - 3]),
            }
        }
        6 => format!("({a})^{}", random.random_range(-1..4)),
        _ => format!("{}({a})", any(random, &["tanh", "atan", "exp", "-", "abs", "sin", "sqrt", "cos"])),
    }
}

/// Whether the values at t and t + T may be the same; `true` where there are none.
fn repeats(expr: &PlantExpr, period: &Enclosure, random: &mut StdRng) -> bool {
    let mut formulas = Formulas::new();
    let formula = formulas.insert(expr);
    let walk = formulas.walk(&[formula]);
    (0..POINTS).all(|_| {
        let mut any = || Enclosure::from_rational(&Rational::from((random.random_range(-999..999), 250)), PRECISION);
        let (t, x, e) = (any(), [any()], any());
        let later = &t + period;
        let [now, then] = [&t, &later].map(|t| {
            let mut algebra = Enclosing { t, x: &x, e: &e, p: &[], precision: PRECISION };
            walk.evaluate(&mut algebra).remove(0)
        });
        // Defined at one and certainly not the same at the other.
        !now.is_defined() || !then.is_defined() || now.intersect(&then).is_defined()
    })
}

/// The checker's opinion.
fn checked(text: &str, period: &str) -> bool {
    let names = ["t", "e", "x"];
    let Ok(expr) = proofs_check::expr::Expr::parse(text, &names) else { return false };
    let json = Json::Text(period.to_owned());
    let constant = Constant::read(&Field { json: &json, pointer: String::new() }).expect("a constant");
    proofs_check::plants::periodic::is_periodic(&expr, constant.exact.as_ref()) == Some(true)
}

#[test]
fn fuzz_periodicity_of_plants() {
    let names = PlantNames::new(vec!["x".to_owned()]).unwrap();
    let (mut proved, cases) = (0, cases(1500, 150_000));
    for case in cases.clone() {
        let random = &mut random(2, case);
        let period = *any(random, &PERIODS);
        let depth = random.random_range(0..4);
        let text = expression(random, period, depth).replace("STATE", "x").replace("ERROR", "e");
        let Ok(expr) = PlantExpr::parse(&text, &names) else { continue };
        let constant = Expr::parse(period, Variables::None).unwrap();
        let answers = [expr.prove_periodic(constant.exact().as_ref()).is_ok(), checked(&text, period)];
        if answers.contains(&true) {
            proved += 1;
            let right = repeats(&expr, &constant.enclose_constant(PRECISION), random);
            assert!(right, "case {case}: `{text}` has not the period {period}: {answers:?}");
        }
    }
    assert!(proved * 10 > cases.end - cases.start || cases.end - cases.start < 100, "{proved} proved");
}

/// A function of t alone that is read as a trigonometric polynomial has its values, for all of its phases and products.
#[test]
fn fuzz_trigonometric_polynomials() {
    let mut read = 0;
    for case in cases(1000, 100_000) {
        let random = &mut random(3, case);
        let period = *any(random, &PERIODS);
        let depth = random.random_range(0..4);
        let text = expression(random, period, depth).replace("STATE", "0.3").replace("ERROR", "2");
        let constant = Expr::parse(period, Variables::None).unwrap();
        let (Ok(expr), Some(exact)) = (Expr::parse(&text, Variables::Time), constant.exact()) else { continue };
        let Ok(polynomial) = expr.trigonometric(&exact, PRECISION) else { continue };
        read += 1;
        let turn = Enclosure::pi(PRECISION) * 2 / constant.enclose_constant(PRECISION);
        for _ in 0..POINTS {
            let t = Rational::from((random.random_range(-999..999), 250));
            let at = Enclosure::from_rational(&t, PRECISION);
            let (value, sum) = (expr.enclose(&at, &Enclosure::undefined(PRECISION)), polynomial.at(&(&at * &turn)));
            let right = value.is_defined() && value.intersect(&sum).is_defined();
            assert!(right, "case {case}: `{text}` at {t} is {value:?}, not {sum:?}");
        }
    }
    println!("{read} read");
}
