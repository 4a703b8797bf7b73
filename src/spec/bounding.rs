//! The list of bounding functions.

use super::model::Specification;
use crate::expr::Expr;

/// A bounding function of `(X, E)`: an upper bound on `|x| <= X`, `|e| <= E`, for every t (P:LP1, P:LP2).
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
}

/// Everything that is the same wherever a bounding function is spoken of, in the order of [`Bound`]: its field in a
/// specification, and for one that may be left out the one that serves in its place and bounds the same.
const TABLE: [(Bound, &str, Option<Bound>); 10] = [
    (Bound::F, "f", None),
    (Bound::Fe, "f_e", None),
    (Bound::Fxx, "f_xx", None),
    (Bound::Fex, "f_ex", None),
    (Bound::Q, "q", None),
    (Bound::Qe, "q_e", None),
    (Bound::Qx, "q_x", None),
    (Bound::Qt, "q_t", None),
    (Bound::QRms, "q_rms", Some(Bound::Q)),
    (Bound::QtRms, "q_t_rms", Some(Bound::Qt)),
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

    /// The name of its field in a specification.
    #[must_use]
    pub fn field(self) -> &'static str {
        TABLE[self as usize].1
    }

    /// What serves where it is left out, and bounds the same where it is not; `None` for one that is required.
    #[must_use]
    pub fn replacement(self) -> Option<Bound> {
        TABLE[self as usize].2
    }

    /// The expression that a specification has for it.
    #[doc(hidden)]
    #[must_use]
    pub fn of(self, spec: &Specification) -> &Expr {
        spec.bounds.get(self)
    }

    /// Where it has an expression of its own: the one that would serve without it, and bounds the same.
    #[doc(hidden)]
    #[must_use]
    pub fn supremum(self, spec: &Specification) -> Option<Bound> {
        self.replacement().filter(|_| spec.bounds.own(self).is_some())
    }
}

/// The bounding functions of a specification.
#[derive(Clone, Debug)]
pub struct Bounds {
    /// Those without a replacement, which come first in [`TABLE`].
    required: Vec<Expr>,
    /// The others.
    optional: Vec<Option<Expr>>,
}

impl Bounds {
    /// Reads them one by one, all of them before an error is returned.
    ///
    /// # Errors
    /// The first of those that `required` and `optional` return.
    pub(super) fn read<C, E>(
        context: &mut C,
        required: impl Fn(&mut C, &'static str) -> Result<Expr, E>,
        optional: impl Fn(&mut C, &'static str) -> Result<Option<Expr>, E>,
    ) -> Result<Bounds, E> {
        let (first, rest): (Vec<Bound>, Vec<Bound>) =
            Bound::ALL.into_iter().partition(|bound| bound.replacement().is_none());
        let first: Vec<_> = first.into_iter().map(|bound| required(context, bound.field())).collect();
        let rest: Vec<_> = rest.into_iter().map(|bound| optional(context, bound.field())).collect();
        Ok(Bounds {
            required: first.into_iter().collect::<Result<_, _>>()?,
            optional: rest.into_iter().collect::<Result<_, _>>()?,
        })
    }

    /// The one that is given for an optional bounding function.
    fn own(&self, which: Bound) -> Option<&Expr> {
        (which as usize).checked_sub(self.required.len()).and_then(|index| self.optional[index].as_ref())
    }

    /// The expression for a bounding function.
    #[must_use]
    pub fn get(&self, which: Bound) -> &Expr {
        match which.replacement() {
            // There is one for each that has no replacement, and these come first.
            None => &self.required[which as usize],
            Some(other) => self.own(which).unwrap_or_else(|| self.get(other)),
        }
    }

    /// The bounding functions that are given, each with the name of its field.
    pub fn named(&self) -> impl Iterator<Item = (&'static str, &Expr)> {
        let given = self.required.iter().map(Some).chain(self.optional.iter().map(Option::as_ref));
        Bound::ALL.into_iter().zip(given).filter_map(|(bound, expr)| Some((bound.field(), expr?)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_in_the_order_of_declaration() {
        let required = TABLE.iter().filter(|(.., replacement)| replacement.is_none()).count();
        for (index, (bound, _, replacement)) in TABLE.into_iter().enumerate() {
            assert_eq!(bound as usize, index);
            assert_eq!(replacement.is_none(), index < required);
            assert!(replacement.is_none_or(|other| other.replacement().is_none()));
        }
    }
}
