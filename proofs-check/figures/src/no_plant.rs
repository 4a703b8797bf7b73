//! The remark that no plant with a state x has the data of a specification (docs/mathematics.md, section 1).
//!
//! For |x| = X, |F(t) x| <= |f(t,x,0)| + b_fxx(X,0) X^2/2, so |F| <= b_f(X,0)/X + b_fxx(X,0) X/2, and where b_fx is
//! given |F| <= b_fx(X,0); and alpha <= sup |F|, since
//! a solution of x' = F x cannot shrink faster than |F| lets it, and no more does a given rate at (0,0) exceed it. Where one X of the domain breaks either, the data contradict
//! themselves and a claim about every plant within them, true as it is, is about none.

use crate::compare;
use proofs_core::bound::Bound;
use proofs_core::data::Data;
use proofs_core::interval::Interval;
use proofs_core::jacobian::Entry;
use proofs_core::json::Field;
use proofs_core::verdict::{Outcome, bad, demand};
use rug::Rational;

const RULE: &str = "no plant";

/// Demands that the remark is true: its X lies in the domain, and the bound there is certainly exceeded.
pub fn check(d: &Data<'_>, field: &Field<'_>) -> Outcome<()> {
    let mut fields = field.fields()?;
    let x = fields.required("X")?;
    let at = x.rational()?;
    demand(Some(at > 0), RULE, &x.pointer, "0 < X")?;
    let at = d.number(&at);
    if let Some([end, _]) = &d.spec.domain {
        demand(at.le(&end.enclose(d.precision)), RULE, &x.pointer, "X lies in the domain")?;
    }
    let zero = d.int(0);
    let taylor = d.bound(Bound::F, &at, &zero) / &at + d.bound(Bound::Fxx, &at, &zero) * &at / 2;
    let most = d.given(Bound::Fx, &at, &zero).map_or(taylor.clone(), |given| given.min(&taylor));
    compare::span(&fields.required("rate_at_most")?, &most, &most)?;
    let by = fields.required("exceeded_by")?;
    let least = match by.text()? {
        "alpha" => d.alpha.clone(),
        "rate" => match &d.spec.rate {
            Some(rate) => rate.enclose(&zero, &zero),
            None => return bad(&by.pointer, "the specification has no `rate`"),
        },
        "jacobian" => {
            let (t, column) = (fields.required("t")?.rational()?, fields.required("column")?);
            column_norm(d, &t, column.whole()? as usize, &column)?
        }
        _ => return bad(&by.pointer, "expected `alpha`, `rate` or `jacobian`"),
    };
    demand(most.lt(&least), RULE, &field.pointer, "the bound of |df/dx(t,0,0)| at X is exceeded")?;
    fields.finish()
}

/// At most the norm of a column of F(t T), whatever the interval entries are.
fn column_norm(d: &Data<'_>, t: &Rational, column: usize, field: &Field<'_>) -> Outcome<Interval> {
    let Some((jacobian, _)) = &d.spec.jacobian else { return bad(&field.pointer, "the specification has no Jacobian") };
    let time = d.number(t) * d.spec.period.nominal.enclose(d.precision);
    let mut squares = d.int(0);
    for row in jacobian {
        let Some(entry) = row.get(column) else { return bad(&field.pointer, "the Jacobian has no such column") };
        let value = match entry {
            Entry::Between(ends) => ends[0].enclose(d.precision).hull(&ends[1].enclose(d.precision)),
            Entry::Function(expr) => expr.enclose(&time, &time),
        };
        squares = squares + value.abs().sqr();
    }
    Ok(squares.sqrt())
}
