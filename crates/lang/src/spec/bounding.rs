//! The bounding functions of a specification.

use super::bound::{Bound, TABLE};
use super::proved_values::ProvedValues;
use crate::expr::Expr;
use sigmastar_exact::enclosure::Enclosure;

/// The bounding functions of a specification: expressions, or values that were proved from a plant's formulas.
#[derive(Clone, Debug)]
pub struct Bounds {
    /// In the order of [`TABLE`]; every required one is there, or none.
    given: Vec<Option<Expr>>,
    /// Those of a plant.
    proved: ProvedValues,
}

impl Bounds {
    /// Those of a plant, known at the arguments where they were proved.
    #[must_use]
    pub fn proved(values: ProvedValues) -> Bounds {
        Bounds { given: vec![None; TABLE.len()], proved: values }
    }

    /// The values that were proved from a plant's formulas; empty where the bounding functions are expressions.
    #[must_use]
    pub fn proved_values(&self) -> &ProvedValues {
        &self.proved
    }

    /// Whether a bounding function itself is known, as an expression or by proved values.
    #[must_use]
    pub fn is_given(&self, which: Bound) -> bool {
        self.own(which).is_some() || self.proved.has(which)
    }

    /// A bounding function, or what serves in its place, at (X, E); undefined where it is not known.
    #[must_use]
    pub fn at(&self, which: Bound, x: &Enclosure, e: &Enclosure) -> Enclosure {
        if let Some(expr) = self.own(which) {
            return expr.enclose(x, e);
        }
        if self.proved.has(which) {
            return self.proved.at(which, x, e);
        }
        match which.replacement() {
            Some(other) => self.at(other, x, e),
            None => Enclosure::undefined(x.precision().max(e.precision())),
        }
    }

    /// Those of the section `bounds`, in the order of [`Bound::ALL`].
    pub(super) fn given(given: Vec<Option<Expr>>) -> Bounds {
        Bounds { given, proved: ProvedValues::default() }
    }

    /// These bounds with the contraction rate of the section `lyapunov`.
    pub(super) fn with_rate(mut self, rate: Option<Expr>) -> Bounds {
        self.given[Bound::Rate as usize] = rate;
        self
    }

    /// The one that is given for a bounding function itself.
    #[must_use]
    pub fn own(&self, which: Bound) -> Option<&Expr> {
        self.given[which as usize].as_ref()
    }

    /// The expression for a bounding function, or for what serves in its place.
    #[must_use]
    pub fn get(&self, which: Bound) -> Option<&Expr> {
        self.own(which).or_else(|| which.replacement().and_then(|other| self.own(other)))
    }

    /// The bounding functions that are given.
    pub fn named(&self) -> impl Iterator<Item = (Bound, &Expr)> {
        Bound::ALL.into_iter().zip(&self.given).filter_map(|(bound, expr)| Some((bound, expr.as_ref()?)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_in_the_order_of_declaration() {
        for (index, (bound, ..)) in TABLE.into_iter().enumerate() {
            assert_eq!(bound as usize, index);
            assert!(bound.replacement().is_none_or(Bound::is_required));
        }
    }
}
