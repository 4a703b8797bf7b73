//! Rule: the part `no_plant`, by which no plant with a state x has the data of a specification (docs/mathematics.md, section 1).
//!
//! For |x| = X, |F(t) x| <= |f(t,x,0)| + b_fxx(X,0) X^2/2, so |F| <= b_f(X,0)/X + b_fxx(X,0) X/2, and where b_fx is
//! given |F| <= b_fx(X,0); and alpha <= sup |F|, since
//! a solution of x' = F x cannot shrink faster than |F| lets it, and no more does a given rate at (0,0) exceed it. Where one X of the domain breaks either, the data contradict
//! themselves and a claim about every plant within them, true as it is, is about none.

use crate::bound::Bound;
use crate::data::Data;
use crate::interval::Interval;
use crate::jacobian::Entry;
use crate::json::{Field, Fields};
use crate::verdict::{Outcome, bad, demand};
use rug::Rational;

/// The name of the rule.
pub const RULE: &str = "no plant";

/// What a certificate says: at X the data allow less than they ask for.
#[derive(Clone, Debug)]
pub struct NoPlant {
    pointer: String,
    x: Rational,
    exceeded_by: ExceededBy,
}

/// A lower bound of sup |F|.
#[derive(Clone, Debug)]
enum ExceededBy {
    Alpha,
    /// a(0,0).
    Rate,
    /// The norm of a column of the Jacobian at t T.
    Column(Rational, usize),
}

impl NoPlant {
    /// Reads the part; `rate_at_most` is a figure, and X decides what it is.
    pub fn read(field: &Field<'_>) -> Outcome<NoPlant> {
        field.object(|fields| {
            let x = fields.number("X")?;
            fields.required("rate_at_most")?;
            Ok(NoPlant { pointer: field.pointer.clone(), x, exceeded_by: ExceededBy::read(fields)? })
        })
    }

    /// Demands that X lies in the domain, and that what the bounding functions allow there is certainly exceeded.
    pub fn prove(&self, d: &Data<'_>, lines: &mut Vec<String>) -> Outcome<()> {
        let place = format!("{}/X", self.pointer);
        demand(Some(self.x > 0), RULE, &place, "0 < X")?;
        let at = d.number(&self.x);
        if let Some([end, _]) = &d.spec.domain {
            demand(at.le(&end.enclose(d.precision)), RULE, &place, "X lies in the domain")?;
        }
        let zero = d.int(0);
        let taylor = d.bound(Bound::F, &at, &zero) / &at + d.bound(Bound::Fxx, &at, &zero) * &at / 2;
        let most = d.given(Bound::Fx, &at, &zero).map_or(taylor.clone(), |given| given.min(&taylor));
        let least = self.exceeded_by.enclose(d, &self.pointer)?;
        demand(most.lt(&least), RULE, &self.pointer, "the bound of |df/dx(t,0,0)| at X is exceeded")?;
        lines.push(format!("{RULE}: no plant with a state x has these data, by |df/dx(t,0,0)| at X = {}", self.x));
        Ok(())
    }
}

impl ExceededBy {
    fn read(fields: &mut Fields<'_>) -> Outcome<ExceededBy> {
        let by = fields.required("exceeded_by")?;
        match by.text()? {
            "alpha" => Ok(ExceededBy::Alpha),
            "rate" => Ok(ExceededBy::Rate),
            "jacobian" => Ok(ExceededBy::Column(fields.number("t")?, fields.required("column")?.whole()? as usize)),
            _ => bad(&by.pointer, "expected `alpha`, `rate` or `jacobian`"),
        }
    }

    fn enclose(&self, d: &Data<'_>, pointer: &str) -> Outcome<Interval> {
        let zero = d.int(0);
        let missing = |what: &str| bad(pointer, format!("the specification has no {what}"));
        match self {
            ExceededBy::Alpha => Ok(d.alpha.clone()),
            ExceededBy::Rate => match &d.spec.rate {
                Some(rate) => Ok(rate.enclose(&zero, &zero)),
                None => missing("`rate`"),
            },
            ExceededBy::Column(t, column) => {
                let Some((jacobian, _)) = &d.spec.jacobian else { return missing("Jacobian") };
                let time = d.number(t) * d.spec.period.nominal.enclose(d.precision);
                // At most the norm, whatever the entries that are intervals are.
                let mut squares = zero;
                for row in jacobian {
                    let Some(entry) = row.get(*column) else { return missing("such column of its Jacobian") };
                    let value = match entry {
                        Entry::Between(ends) => ends[0].enclose(d.precision).hull(&ends[1].enclose(d.precision)),
                        Entry::Function(expr) => expr.enclose(&time, &time),
                    };
                    squares = squares + value.abs().sqr();
                }
                Ok(squares.sqrt())
            }
        }
    }
}
