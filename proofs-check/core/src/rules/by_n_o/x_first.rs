//! What a trial may have for peaks along x first: the third corollary about peaks from a trial of docs/mathematics.md, section 14.5. Read, and of the
//! numbers that stand alone it is decided that they are right.
//!
//! Guarantee of [`XFirst`]: `0 <= eta <= D_e'`, and D_x' and D_e' are above 0. No form has a p; of each `x_low I <= P <= P_up I` with `x_low > 0`, `w > 0`
//! for e_low is, and S is symmetric with a row for each state and one for y. (14.5a) is proved by the crate `proofs-plants`.

use super::claimed::RULE;
use super::form::{MOST_FORMS, form, radii};
use crate::json::Fields;
use crate::matrix::Matrix;
use crate::rules::inequality::{Extent, Metric, number, symmetric};
use crate::verdict::{Outcome, bad, demand};
use rug::Rational;

/// The larger box, with its forms.
#[derive(Clone, Debug)]
pub struct XFirst {
    /// Where it stands in the file.
    pub pointer: String,
    /// D_x' and D_e'.
    pub radii: [Rational; 2],
    /// eta: so far from ehat J and r are asked about.
    pub slice: Rational,
    /// One or more.
    pub forms: Vec<Split>,
}

/// A form without p, with the S that stands between both inequalities of (14.5a).
#[derive(Clone, Debug)]
pub struct Split {
    /// P, w, k_p, c_x, c_e, c_y.
    pub metric: Metric,
    /// `x_low I <= P <= P_up I`, and `e_low <= w`.
    pub extent: Extent,
    /// S, in (x, y).
    pub matrix: Matrix,
}

impl XFirst {
    /// Takes it out of its object, of a plant with so many states.
    pub(super) fn take(fields: &mut Fields<'_>, states: usize) -> Outcome<XFirst> {
        let pointer = fields.pointer.clone();
        let radii = radii(fields, states)?;
        let slice = number(fields, "E", false)?;
        demand(Some(slice <= radii[1]), RULE, &format!("{pointer}/E"), "E <= e of the box")?;
        let list = fields.required("forms")?;
        let forms = list.list(|field| field.object(|fields| Split::take(fields, states)))?;
        if forms.is_empty() || forms.len() > MOST_FORMS {
            return bad(&list.pointer, format!("expected 1 to {MOST_FORMS} forms"));
        }
        Ok(XFirst { pointer, radii, slice, forms })
    }
}

impl Split {
    fn take(fields: &mut Fields<'_>, states: usize) -> Outcome<Split> {
        let field = fields.required("S")?;
        let matrix = symmetric(&field)?;
        if matrix.len() != states + 1 {
            return bad(&field.pointer, "expected a row for each state, and one more");
        }
        let (mut metric, extent) = form(fields, (states, true))?;
        if metric.cross.iter().any(|entry| !entry.is_zero()) {
            return bad(&format!("{}/p", fields.pointer), "expected zeros: there is no p along x first");
        }
        metric.cross.clear();
        Ok(Split { metric, extent, matrix })
    }
}
