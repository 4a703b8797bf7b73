//! The coarse scan that precedes local minimisation: many orders of magnitude in X and E.

use super::root::crossing;
use sigmastar_exact::number::Portable;

/// Steps of the scanned logarithm of X: a third of a decade over 80 decades.
const X_EXPONENTS: std::ops::RangeInclusive<i32> = -120..=120;

/// How far E_p is below the largest value that C1 and C3 allow, as a natural logarithm.
const E_DEPTHS: [f64; 30] = [
    1e-3, 0.05, 0.15, 0.35, 0.7, 1.2, 2.0, 3.0, 4.5, 6.5, 9.0, 12.0, 16.0, 20.0, 25.0, 30.0, 36.0, 42.0, 50.0, 58.0,
    66.0, 75.0, 85.0, 95.0, 105.0, 115.0, 125.0, 135.0, 145.0, 155.0,
];

/// Every so many of the scanned values of X that lie inside the domain, the domain's own scale included.
pub fn x_values(limit: f64, step: usize) -> Vec<f64> {
    let mut values: Vec<f64> =
        X_EXPONENTS.step_by(step).map(|k| 10f64.portable_pow(f64::from(k) / 3.0)).filter(|x| *x < limit).collect();
    if limit.is_finite() {
        values.extend([0.003, 0.01, 0.03, 0.1, 0.2, 0.4].map(|share| share * limit));
    }
    values.sort_by(f64::total_cmp);
    values
}

/// The value itself, if it lies in the scanned range of X.
pub fn in_range(x: f64) -> Option<f64> {
    (1e-40..=1e40).contains(&x).then_some(x)
}

/// A cost too small to matter where an argument does (it moves ln sigma by at most 1e-7), which keeps the argument near
/// 1 where it does not.
pub fn preference(argument: f64) -> f64 {
    1e-11 * argument.portable_ln().portable_powi(2)
}

/// Every so many of the E depths of the scan.
pub fn e_depths(step: usize) -> impl Iterator<Item = &'static f64> + Clone {
    E_DEPTHS.iter().step_by(step)
}

/// The largest E <= limit with `demand(E) <= 1`, for a function that increases: to rounding, over 80 decades; `None` if the
/// smallest is too large.
pub fn largest(demand: impl Fn(f64) -> f64, limit: f64) -> Option<f64> {
    let cap = limit.min(1e40);
    // From the largest E downwards, so that the excess decreases.
    let excess = |depth: f64| demand(cap * (-depth).portable_exp()).portable_ln();
    let (first, last) = (demand(cap).portable_ln(), excess(DEPTH));
    if first <= 0.0 {
        return Some(cap);
    }
    let first = if first.is_nan() { f64::INFINITY } else { first };
    (last <= 0.0).then(|| cap * (-crossing(excess, (0.0, first), (DEPTH, last), 1e-13)).portable_exp())
}

/// 80 decades.
const DEPTH: f64 = 184.2;
