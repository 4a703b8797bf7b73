//! The list of bounding functions.

use super::model::Specification;
use super::proved_values::ProvedValues;
use crate::enclosure::Enclosure;
use crate::expr::Expr;

/// A bounding function of `(X, E)`: an upper bound on `|x| <= X`, `|e| <= E`, for every t (P:LP1, P:LP2; derivation,
/// 10.1).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Bound {
    /// b_f, of `|f|`.
    F,
    /// b_fe, of `|df/de|`.
    Fe,
    /// b_fxx, of `|d2f/dxdx|` as a bilinear map.
    Fxx,
    /// b_fex, of `|d2f/dedx|`.
    Fex,
    /// b_q, of `|q|`.
    Q,
    /// b_qe, of `|dq/de|`.
    Qe,
    /// b_qx, of `|dq/dx|`.
    Qx,
    /// b_qt, of `|dq/dt|`.
    Qt,
    /// b_q_rms, of the root mean square over a period of `sup |q|`; optional, `Q` serves where it is absent or smaller.
    QRms,
    /// b_qt_rms, of the root mean square over a period of `sup |dq/dt|`; optional, `Qt` serves where it is absent or
    /// smaller.
    QtRms,
    /// m, of `dq/de` from above; optional, may be negative, `Qe` serves where it is absent or smaller.
    QeMax,
    /// b_fx, of `|df/dx|`; optional.
    Fx,
    /// b_qtx, of `|d2q/dtdx|`; optional.
    Qtx,
    /// b_qte, of `|d2q/dtde|`; optional.
    Qte,
    /// a, a contraction rate from below: `P' + P J + J'P <= -2 a P` for `J = df/dx` and the P of the triple; optional,
    /// nonincreasing, may be negative.
    Rate,
    /// The same for the P of existence, where a plant has two (derivation, 11.3); no specification gives it.
    RateExistence,
}

/// What a bounding function bounds, and what holds without it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    /// A norm; every specification has it.
    Required,
    /// The same as another one, more sharply; that one serves where it is absent.
    Sharper(Bound),
    /// A derivative from above, whose norm the other one bounds.
    OneSided(Bound),
    /// A norm; other formulas serve where it is absent.
    Optional,
    /// A rate from below.
    Rate,
    /// A rate from below that only a plant's formulas give.
    ProvedRate,
}

/// Everything that is the same wherever a bounding function is spoken of, in the order of [`Bound`]: its field in a
/// specification, and its role.
const TABLE: [(Bound, &str, Role); 16] = [
    (Bound::F, "f", Role::Required),
    (Bound::Fe, "f_e", Role::Required),
    (Bound::Fxx, "f_xx", Role::Required),
    (Bound::Fex, "f_ex", Role::Required),
    (Bound::Q, "q", Role::Required),
    (Bound::Qe, "q_e", Role::Required),
    (Bound::Qx, "q_x", Role::Required),
    (Bound::Qt, "q_t", Role::Required),
    (Bound::QRms, "q_rms", Role::Sharper(Bound::Q)),
    (Bound::QtRms, "q_t_rms", Role::Sharper(Bound::Qt)),
    (Bound::QeMax, "q_e_max", Role::OneSided(Bound::Qe)),
    (Bound::Fx, "f_x", Role::Optional),
    (Bound::Qtx, "q_tx", Role::Optional),
    (Bound::Qte, "q_te", Role::Optional),
    (Bound::Rate, "rate", Role::Rate),
    (Bound::RateExistence, "rate_existence", Role::ProvedRate),
];

impl Bound {
    /// All of them.
    pub const ALL: [Bound; TABLE.len()] = {
        let mut all = [Bound::F; TABLE.len()];
        let mut index = 0;
        while index < TABLE.len() {
            all[index] = TABLE[index].0;
            index += 1;
        }
        all
    };

    fn role(self) -> Role {
        TABLE[self as usize].2
    }

    /// The name of its field in a specification.
    #[must_use]
    pub fn field(self) -> &'static str {
        TABLE[self as usize].1
    }

    /// What it bounds, in the words of a report.
    #[must_use]
    pub fn of_what(self) -> &'static str {
        match self {
            Bound::F => "|f|",
            Bound::Fe => "|df/de|",
            Bound::Fxx => "|d2f/dxdx|",
            Bound::Fex => "|d2f/dedx|",
            Bound::Q => "|q|",
            Bound::Qe => "|dq/de|",
            Bound::Qx => "|dq/dx|",
            Bound::Qt => "|dq/dt|",
            Bound::QRms => "rms q",
            Bound::QtRms => "rms dq/dt",
            Bound::QeMax => "dq/de from above",
            Bound::Fx => "|df/dx|",
            Bound::Qtx => "|d2q/dtdx|",
            Bound::Qte => "|d2q/dtde|",
            Bound::Rate => "contraction of x, from below",
            Bound::RateExistence => "the same in the P of existence",
        }
    }

    /// Whether it is of f, or of a derivative by x: without a state there is nothing that it bounds.
    #[must_use]
    pub fn is_of_state(self) -> bool {
        match self {
            Bound::F | Bound::Fe | Bound::Fxx | Bound::Fex | Bound::Fx | Bound::Qx | Bound::Qtx => true,
            Bound::Rate | Bound::RateExistence => true,
            Bound::Q | Bound::Qe | Bound::Qt | Bound::QRms | Bound::QtRms | Bound::QeMax | Bound::Qte => false,
        }
    }

    /// The field of a specification in which its own field is.
    #[must_use]
    pub fn section(self) -> &'static str {
        if matches!(self.role(), Role::Rate | Role::ProvedRate) { "lyapunov" } else { "bounds" }
    }

    /// Whether every specification has it.
    #[must_use]
    pub fn is_required(self) -> bool {
        self.role() == Role::Required
    }

    /// Whether it may be negative: it does not bound a norm.
    #[must_use]
    pub fn is_signed(self) -> bool {
        matches!(self.role(), Role::OneSided(_) | Role::Rate | Role::ProvedRate)
    }

    /// Whether it must be nonincreasing; the others must be nondecreasing.
    #[must_use]
    pub fn is_nonincreasing(self) -> bool {
        matches!(self.role(), Role::Rate | Role::ProvedRate)
    }

    /// What serves where it is left out, and bounds what it bounds where it is not.
    #[must_use]
    pub fn replacement(self) -> Option<Bound> {
        match self.role() {
            Role::Sharper(other) | Role::OneSided(other) => Some(other),
            Role::Required | Role::Optional | Role::Rate | Role::ProvedRate => None,
        }
    }

    /// The expression that a specification has for it, or for its replacement.
    #[doc(hidden)]
    #[must_use]
    pub fn of(self, spec: &Specification) -> Option<&Expr> {
        spec.bounds.get(self)
    }

    /// Where it is given itself: the one that would serve without it, and bounds the same.
    #[doc(hidden)]
    #[must_use]
    pub fn supremum(self, spec: &Specification) -> Option<Bound> {
        self.replacement().filter(|_| spec.bounds.is_given(self))
    }
}

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

    /// Reads those of the section `bounds` one by one, all of them before an error is returned.
    ///
    /// # Errors
    /// The first of those that `required` and `optional` return.
    pub(super) fn read<C, E>(
        context: &mut C,
        required: impl Fn(&mut C, &'static str) -> Result<Expr, E>,
        optional: impl Fn(&mut C, &'static str) -> Result<Option<Expr>, E>,
    ) -> Result<Bounds, E> {
        let read = |bound: Bound| match bound.role() {
            Role::Required => required(context, bound.field()).map(Some),
            Role::Rate | Role::ProvedRate => Ok(None),
            Role::Sharper(_) | Role::OneSided(_) | Role::Optional => optional(context, bound.field()),
        };
        let all: Vec<_> = Bound::ALL.into_iter().map(read).collect();
        Ok(Bounds { given: all.into_iter().collect::<Result<_, _>>()?, proved: ProvedValues::default() })
    }

    /// The same with the contraction rate of the section `lyapunov`.
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
