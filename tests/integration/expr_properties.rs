//! Properties of expressions on random texts, trees and boxes.

use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::expr::{
    BoundingFailure, Counterexample, Expr, ExprErrorKind, ProofSettings, Variables, prove_bounding,
};

/// A random expression; `None` where it has a constant exponent beyond the limit.
fn parse(text: &str) -> Option<Expr> {
    match Expr::parse(text, Variables::XAndE) {
        Ok(expr) => Some(expr),
        Err(error) if error.kind == ExprErrorKind::ExponentTooLarge => None,
        Err(error) => panic!("{text}: {error}"),
    }
}

/// Random expressions as texts, with many zeros, edges and constants that make functions meet.
fn expression() -> impl Strategy<Value = String> {
    let leaf = prop_oneof![
        6 => Just("X".to_owned()),
        6 => Just("E".to_owned()),
        1 => Just("pi".to_owned()),
        4 => prop::sample::select(vec!["0", "1", "2", "0.5", "3", "0.189", "1e-9", "1e9", ".1"]).prop_map(str::to_owned),
    ];
    leaf.prop_recursive(5, 24, 3, |inner| {
        let binary = prop::sample::select(vec!["+", "-", "*", "/"]);
        let unary = prop::sample::select(vec![
            "sqrt", "exp", "log", "sin", "cos", "tan", "atan", "tanh", "abs", "exprelr", "sinc", "-",
        ]);
        let exponent = prop::sample::select(vec!["2", "3", "-1", "-2", "0", "1", "(1/2)", "(3/2)", "(-1/2)", "(5/2)"]);
        let extreme = prop::sample::select(vec!["min", "max"]);
        prop_oneof![
            5 => (inner.clone(), binary, inner.clone()).prop_map(|(a, op, b)| format!("({a}) {op} ({b})")),
            3 => (unary, inner.clone()).prop_map(|(f, a)| format!("{f}({a})")),
            2 => (inner.clone(), exponent).prop_map(|(a, n)| format!("({a})^{n}")),
            1 => (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("({a})^({b})")),
            2 => (extreme, inner.clone(), inner).prop_map(|(f, a, b)| format!("{f}({a}, {b})")),
        ]
    })
}

/// Coordinates biased to 0, to small numbers and to both signs.
fn coordinate() -> impl Strategy<Value = Rational> {
    prop_oneof![
        2 => Just(Rational::new()),
        2 => (-8_i32..9).prop_map(|n| Rational::from((n, 4))),
        2 => (0_i32..1000).prop_map(|n| Rational::from((n, 300))),
        1 => (0_i32..10, -20_i32..20).prop_map(|(n, shift)| Rational::from(n) << shift),
    ]
}

/// A side with two points in it: lower end, two ordered points, upper end.
fn side() -> impl Strategy<Value = [Rational; 4]> {
    prop::array::uniform4(coordinate()).prop_map(|mut ends| {
        ends.sort();
        ends
    })
}

fn range(side: &[Rational; 4], precision: u32) -> Enclosure {
    Enclosure::between(&side[0], &side[3], precision)
}

fn at(expr: &Expr, x: &Rational, e: &Rational) -> Enclosure {
    expr.enclose(&Enclosure::from_rational(x, 300), &Enclosure::from_rational(e, 300))
}

/// Whether two enclosures may hold the same number, as enclosures of the same number must.
fn meet(a: &Enclosure, b: &Enclosure) -> bool {
    a.intersect(b).is_defined()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn any_text_is_answered(text in any::<String>()) {
        if let Err(error) = Expr::parse(&text, Variables::XAndE) {
            prop_assert!(text.get(error.span.clone()).is_some());
            prop_assert!(!error.to_string().is_empty());
            prop_assert!(!error.span.is_empty() || error.span.start == text.len());
        }
    }

    #[test]
    fn token_soup_is_answered(tokens in prop::collection::vec(prop::sample::select(vec![
        "X", "E", "2", "1e3", "2E", "1e", ".", "1.5", "+", "-", "*", "/", "^", "(", ")", ",", " ", "sqrt", "max(", "sin(", "abs",
        "pi", "é", "\u{0}", "(((((((", ")))))))", "^^", "-1", "^-", "1/0", "0^",
    ]), 0..60)) {
        let text = tokens.concat();
        for variables in [Variables::None, Variables::XAndE] {
            match Expr::parse(&text, variables) {
                Ok(expr) => {
                    prop_assert_eq!(expr.text(), &text);
                    let again = Expr::parse(&expr.to_string(), variables).unwrap();
                    let x = Enclosure::from_integer(2, 64);
                    prop_assert_eq!(again.enclose(&x, &x), expr.enclose(&x, &x));
                    let _ = (expr.exact(), expr.enclose_constant(64), expr.to_float().eval(0.0, -1.0));
                }
                Err(error) => prop_assert!(text.get(error.span).is_some()),
            }
        }
    }

    #[test]
    fn enclosures_contain_values_and_slopes_difference_quotients(text in expression(), x in side(), e in side()) {
        let Some(expr) = parse(&text) else { return Ok(()) };
        let (box_x, box_e) = (range(&x, 64), range(&e, 64));
        let value = expr.enclose(&box_x, &box_e);
        let slopes = expr.enclose_slopes(&box_x, &box_e);
        prop_assert_eq!(slopes.value.is_defined(), value.is_defined());
        prop_assert_eq!(slopes.slope_x.is_defined(), value.is_defined());
        prop_assert_eq!(slopes.slope_e.is_defined(), value.is_defined());
        if !value.is_defined() {
            return Ok(());
        }
        let corners = [at(&expr, &x[1], &e[1]), at(&expr, &x[2], &e[1]), at(&expr, &x[1], &e[2])];
        for corner in &corners {
            prop_assert!(corner.is_defined() && meet(&value, corner) && meet(&slopes.value, corner));
        }
        for (ends, to, slope) in [(&x, &corners[1], &slopes.slope_x), (&e, &corners[2], &slopes.slope_e)] {
            if ends[1] < ends[2] {
                let quotient = (to - &corners[0]) / Enclosure::from_rational(&Rational::from(&ends[2] - &ends[1]), 300);
                prop_assert!(meet(slope, &quotient), "{:?} is not in {:?}", quotient, slope);
            }
        }
    }

    #[test]
    fn doubles_are_close(text in expression(), x in coordinate(), e in coordinate()) {
        let Some(expr) = parse(&text) else { return Ok(()) };
        let (x, e) = (x.to_f64(), e.to_f64());
        // The small constant forgives overflow in between. Each operation at 46 bits may be off by more than its counterpart in double precision, so the width of the
        // enclosure gives ill-conditioned expressions their due.
        let coarse = |value: f64| Enclosure::from_rational(&Rational::from_f64(value).unwrap(), 46);
        let value = expr.enclose(&coarse(x), &coarse(e));
        let double = expr.to_float().eval(x, e);
        if value.is_bounded() && double.is_finite() {
            let width = value.upper_f64() - value.lower_f64();
            let distance = (double - value.midpoint_f64()).abs();
            prop_assert!(distance <= width + 1e-100, "{} is not in {:?}", double, value);
        }
    }

    #[test]
    fn exact_values_lie_in_enclosures(text in expression()) {
        let constant = text.replace('X', "(2/3)").replace('E', "sqrt(2)");
        if let Ok(expr) = Expr::parse(&constant, Variables::None)
            && let Some(exact) = expr.exact()
        {
            let value = expr.enclose_constant(200);
            prop_assert!(!value.is_defined() || meet(&value, &exact.enclose(300)));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn proofs_and_refutations_are_true(text in expression(), x in side(), e in side()) {
        let Some(expr) = parse(&text) else { return Ok(()) };
        let (x, e) = (x.map(Rational::abs), e.map(Rational::abs));
        let (x_max, e_max) = (x.iter().max().unwrap(), e.iter().max().unwrap());
        let settings = ProofSettings { max_boxes: 200, ..ProofSettings::default() };
        match prove_bounding(&expr, x_max, e_max, &settings) {
            Ok(()) => {
                for a in &x {
                    for b in &e {
                        let value = at(&expr, a, b);
                        prop_assert!(value.is_defined() || expr.exact().is_some());
                        prop_assert!(!value.is_nonnegative().is_false());
                        for (c, d) in x.iter().flat_map(|c| e.iter().map(move |d| (c, d))) {
                            if c >= a && d >= b {
                                prop_assert!(!at(&expr, c, d).lt(&value).is_true());
                            }
                        }
                    }
                }
            }
            Err(BoundingFailure::Refuted { counterexample, .. }) => match *counterexample {
                Counterexample::Undefined { x, e } => prop_assert!(!at(&expr, &x, &e).is_defined()),
                Counterexample::Negative(found) => {
                    let value = at(&expr, &found.x, &found.e);
                    prop_assert!(meet(&value, &found.value) && value.is_nonnegative().is_false());
                }
                Counterexample::Decrease { from, to } => {
                    prop_assert!((from.x < to.x) != (from.e < to.e) && from.x <= to.x && from.e <= to.e);
                    prop_assert!(at(&expr, &to.x, &to.e).lt(&at(&expr, &from.x, &from.e)).is_true());
                }
            },
            Err(BoundingFailure::Undecided { .. }) => {}
        }
    }
}
