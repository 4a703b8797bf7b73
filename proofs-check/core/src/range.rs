//! A constant of a file that is known to an interval: a nominal value, and the ends.

use crate::constant::Constant;
use crate::json::{Field, Fields};
use crate::verdict::{Outcome, demand, invalid};
use rug::Rational;

/// `low <= nominal <= high`, as rational numbers.
#[derive(Clone, Debug)]
pub struct Span {
    pub nominal: Rational,
    /// low and high.
    pub ends: [Rational; 2],
}

/// `low <= nominal <= high`.
#[derive(Clone, Debug)]
pub struct Range {
    pub nominal: Constant,
    pub low: Constant,
    pub high: Constant,
}

impl Range {
    /// Reads the three by their names.
    pub fn read(
        field: &Field<'_>,
        rule: &'static str,
        read: impl Fn(&mut Fields<'_>, &str) -> Outcome<Constant>,
    ) -> Outcome<Range> {
        let range = field.object(|fields| {
            let [nominal, low, high] = ["nominal", "low", "high"].map(|name| read(fields, name));
            Ok(Range { nominal: nominal?, low: low?, high: high? })
        })?;
        let in_order =
            |a: &Constant, b: &Constant, what| demand(a.number().le(&b.number()), rule, &field.pointer, what);
        in_order(&range.low, &range.nominal, "low <= nominal")?;
        in_order(&range.nominal, &range.high, "nominal <= high")?;
        Ok(range)
    }

    /// The ends with their names in a file.
    pub fn ends(&self) -> [(&'static str, &Constant); 2] {
        [("low", &self.low), ("high", &self.high)]
    }

    /// Whether both ends are certainly the nominal value.
    pub fn is_nominal(&self) -> bool {
        self.ends().iter().all(|(_, end)| is_same(end, &self.nominal))
    }

    /// That a part of a claim names these numbers.
    pub fn agrees(&self, field: &Field<'_>, rule: &'static str) -> Outcome<()> {
        field.object(|fields| {
            let mut all = [("nominal", &self.nominal)].into_iter().chain(self.ends());
            all.try_for_each(|(name, end)| states(fields, name, end, rule))
        })
    }
}

/// That a part of a claim has a number of the file under this name.
pub fn states(fields: &mut Fields<'_>, name: &str, number: &Constant, rule: &'static str) -> Outcome<()> {
    let stated = fields.required(name)?;
    // Of an expression of parameters the text says what it is.
    let same = stated.numeral()? == number.text || is_same(&Constant::read(&stated)?, number);
    demand(Some(same), rule, &stated.pointer, format!("it is that of the file, {}", number.text))
}

/// That a claim has a part, `field`, exactly if the file has it; nothing to compare if neither has.
pub fn both<'c, A>(
    rule: &'static str,
    name: &str,
    asked: Option<A>,
    claimed: Option<&'c Field<'c>>,
    claim: &str,
) -> Outcome<Option<(A, &'c Field<'c>)>> {
    match (asked, claimed) {
        (None, None) => Ok(None),
        (Some(asked), Some(field)) => Ok(Some((asked, field))),
        (Some(_), None) => invalid(rule, claim, format!("`{name}` of the file is not in the claim")),
        (None, Some(field)) => invalid(rule, &field.pointer, format!("the file has no `{name}`")),
    }
}

/// Whether two constants are the same by their texts or by their exact forms.
pub fn is_same(a: &Constant, b: &Constant) -> bool {
    a.text == b.text || a.exact.as_ref().zip(b.exact.as_ref()).is_some_and(|(a, b)| a.equals(b))
}
