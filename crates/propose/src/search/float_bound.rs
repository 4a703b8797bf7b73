//! A bounding function in doubles, for searches only.

use super::obstacle::Known;
use sigmastar_lang::expr::FloatExpr;
use sigmastar_lang::spec::{Bound, Specification};
use std::sync::Arc;

/// What a search evaluates.
#[derive(Clone)]
pub enum FloatBound {
    /// An expression.
    Expression(FloatExpr),
    /// Proved values: (X, E, value); the best of those that reach, NaN beyond them.
    Values {
        /// The entries.
        entries: Vec<[f64; 3]>,
        /// Whether the largest value is the best one.
        from_below: bool,
    },
    /// Any function of (X, E).
    Function {
        /// NaN where it has no value, and from `ends` on.
        of: Arc<dyn Fn(f64, f64) -> f64 + Send + Sync>,
        /// The first X and the first E at which nothing is known of it.
        ends: [f64; 2],
    },
}

/// Proved values end where they end: a search stays so far inside that rounding does not lead beyond.
const EDGE: f64 = 1.0 + 1e-6;

impl FloatBound {
    /// That of a specification, or what serves in its place.
    #[must_use]
    pub fn of(spec: &Specification, which: Bound) -> Option<FloatBound> {
        if let Some(expr) = spec.bounds.own(which) {
            return Some(FloatBound::Expression(expr.to_float()));
        }
        let proved = spec.bounds.proved_values();
        if !proved.has(which) {
            return which.replacement().and_then(|other| FloatBound::of(spec, other));
        }
        let there = proved.entries.iter().filter(|entry| entry.bound == which);
        let entries = there.map(|entry| [&entry.x, &entry.e, &entry.value].map(rug::Rational::to_f64)).collect();
        Some(FloatBound::Values { entries, from_below: which.is_rate() })
    }

    /// The value at (X, E); NaN where it is undefined.
    #[must_use]
    pub fn at(&self, x: f64, e: f64) -> f64 {
        match self {
            FloatBound::Expression(expr) => expr.eval(x, e),
            FloatBound::Values { entries, from_below } => {
                let reaches = |entry: &&[f64; 3]| x * EDGE <= entry[0] && e * EDGE <= entry[1];
                let reaching = entries.iter().filter(reaches).map(|entry| entry[2]);
                let best = if *from_below { reaching.reduce(f64::max) } else { reaching.reduce(f64::min) };
                best.unwrap_or(f64::NAN)
            }
            FloatBound::Function { of, .. } => of(x, e),
        }
    }

    /// How much work an evaluation is.
    #[must_use]
    pub fn operations(&self) -> usize {
        match self {
            FloatBound::Expression(expr) => expr.operations(),
            FloatBound::Values { entries, .. } => entries.len(),
            FloatBound::Function { .. } => 1,
        }
    }

    /// How far it is known, where (X, E) is beyond: there the function of the plant may well have a value.
    #[must_use]
    pub(super) fn ends_before(&self, x: f64, e: f64) -> Option<Known> {
        match self {
            FloatBound::Expression(_) => None,
            FloatBound::Values { .. } => self.at(x, e).is_nan().then_some(Known::Proofs),
            FloatBound::Function { ends, .. } => (x >= ends[0] || e >= ends[1]).then_some(Known::Samples),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Beyond its last arguments nothing is known; within them a function without a value has none.
    #[test]
    fn where_it_ends_and_where_it_has_no_value() {
        let function = FloatBound::Function { of: Arc::new(|_, _| f64::NAN), ends: [2.0, 3.0] };
        let values = FloatBound::Values { entries: vec![[2.0, 3.0, 1.0]], from_below: false };
        for (at, beyond) in [([1.0, 1.0], false), ([2.0, 1.0], true), ([1.0, 3.0], true)] {
            assert_eq!(function.ends_before(at[0], at[1]), beyond.then_some(Known::Samples), "{at:?}");
            assert_eq!(values.ends_before(at[0], at[1]), beyond.then_some(Known::Proofs), "{at:?}");
        }
    }
}
