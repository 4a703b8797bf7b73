//! P and the triple for random Jacobians: found and proved whenever the Floquet exponent leaves a margin.

use crate::support::count;
use proptest::prelude::*;
use sigmastar_lang::expr::{Expr, Variables};
use sigmastar_lang::spec::Period;
use sigmastar_lang::spec::model::{Constant, Jacobian, JacobianEntry};
use sigmastar_propose::lyapunov::{Candidates, LyapunovFailure, candidates, floquet_exponents};
use sigmastar_prove::attempt::prove_candidate;

fn constant(text: &str) -> Constant {
    let expr = Expr::parse(text, Variables::None).expect("a constant");
    Constant { text: text.to_owned(), exact: expr.exact(), expr }
}

/// The rows as text; an entry with a comma is an interval.
fn jacobian(rows: &[Vec<String>]) -> (Jacobian, Period) {
    let entry = |text: &String| match text.split_once(',') {
        Some((low, up)) => JacobianEntry::Interval(Box::new([constant(low), constant(up)])),
        None => JacobianEntry::Function(Expr::parse(text, Variables::Time).expect("an expression in t")),
    };
    let rows = rows.iter().map(|row| row.iter().map(entry).collect()).collect();
    let period = constant("1");
    (Jacobian { rows, period: period.exact.clone() }, period.into())
}

fn find(rows: &[Vec<String>]) -> Result<Candidates, LyapunovFailure> {
    let (jacobian, period) = jacobian(rows);
    candidates(&jacobian, &period)
}

/// The family with such a multiple of I added that the largest real part of the Floquet exponents is -1.
fn shifted(base: &dyn Fn(f64) -> Vec<Vec<String>>) -> Vec<Vec<String>> {
    let (plain, period) = jacobian(&base(0.0));
    let exponent = floquet_exponents(&plain, &period).expect("finite")[0][0];
    base(-exponent - 1.0)
}

fn lti(n: usize, numbers: &[i32]) -> impl Fn(f64) -> Vec<Vec<String>> {
    move |shift| {
        let entry = |i: usize, j: usize| {
            let value = f64::from(numbers[8 * i + j]) / 10.0 + if i == j { shift } else { 0.0 };
            format!("{value:.9}")
        };
        (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect()
    }
}

fn periodic(n: usize, numbers: &[i32]) -> impl Fn(f64) -> Vec<Vec<String>> {
    move |shift| {
        let number =
            |part: usize, i: usize, j: usize| f64::from(numbers[(64 * part + 8 * i + j) % numbers.len()]) / 10.0;
        let entry = |i: usize, j: usize| {
            let mean = number(0, i, j) + if i == j { shift } else { 0.0 };
            let (a, b) = (number(1, i, j), number(2, i, j));
            format!("{mean:.9} + {a:.1}*cos(2*pi*t) + {b:.1}*sin(2*pi*t)")
        };
        (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect()
    }
}

/// The largest proved rate, where the Floquet exponent is -1.
fn largest_rate(rows: &[Vec<String>]) -> f64 {
    let found = find(rows).unwrap_or_else(|failure| panic!("{rows:?}: {failure}"));
    assert!((found.floquet[0][0] + 1.0).abs() <= 1e-3, "{:?}", found.floquet);
    for pair in found.found.windows(2) {
        assert!(pair[0].alpha >= pair[1].alpha && pair[0].ratio > pair[1].ratio);
    }
    prove_candidate(&found, &found.found[0]).expect("proved").alpha.to_f64()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: count(6, 100), ..ProptestConfig::default() })]

    #[test]
    fn constant_jacobians_with_a_margin_of_5_percent(n in 1..=8usize, numbers in prop::collection::vec(-20..=20i32, 64)) {
        let rate = largest_rate(&shifted(&lti(n, &numbers)));
        prop_assert!((0.95..=1.0).contains(&rate), "{rate}");
    }
}

proptest! {
    // A case of order 8 takes many seconds.
    #![proptest_config(ProptestConfig { cases: count(1, 20), max_shrink_iters: 4, ..ProptestConfig::default() })]

    #[test]
    fn periodic_jacobians_with_a_margin_of_5_percent(
        n in 1..=8usize, numbers in prop::collection::vec(-20..=20i32, 192),
    ) {
        let rate = largest_rate(&shifted(&periodic(n, &numbers)));
        prop_assert!((0.95..=1.0).contains(&rate), "{n}: {rate}");
    }
}

/// Entries from 1e-300 to 1e308: a proved rate, or one of the failures, whatever overflows on the way.
#[test]
fn jacobians_of_any_size_have_an_answer() {
    for entry in ["-1e-300", "-1e150", "-1e200", "-1e308", "-1e400", "-1e300,-1", "-1e200 + cos(2*pi*t)"] {
        let rows = |off: &str| vec![vec![entry.to_owned(), off.to_owned()], vec!["0".to_owned(), entry.to_owned()]];
        for rows in [vec![vec![entry.to_owned()]], rows("0"), rows("1e200")] {
            if let Ok(found) = find(&rows)
                && let Some(proved) = prove_candidate(&found, &found.found[0])
            {
                assert!(proved.alpha > 0 && proved.alpha.to_f64() <= -found.floquet[0][0], "{rows:?}");
            }
        }
    }
    // The largest that a norm in doubles allows: the rate of a diagonal matrix.
    let found = find(&[vec!["-1e200".to_owned()]]).expect("a candidate");
    assert!(prove_candidate(&found, &found.found[0]).is_some_and(|proved| proved.alpha.to_f64() > 0.99e200));
}
