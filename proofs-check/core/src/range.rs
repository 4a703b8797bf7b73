//! A constant of a file that is known to an interval: a nominal value, and the ends; and the range of an expression of such constants
//! (docs/mathematics.md, section 13.2).

use crate::constant::Constant;
use crate::expr::{Expr, Op};
use crate::interval::Interval;
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

/// Into so many parts the interval of one, two, three or four parameters that occur is cut.
const PARTS: [u32; 4] = [1024, 32, 10, 5];

/// Bits.
const PRECISION: u32 = 160;

/// Bits of the ends, and 2 to minus how many of themselves they are moved by.
const ENDS: [u32; 2] = [40, 36];

/// A number below and one above every value of an expression in these variables on the box of their intervals, rounded outward so that it does not
/// matter how they were enclosed.
pub fn ends(expr: &Expr, family: &[Span]) -> Option<[Rational; 2]> {
    let all = spread(expr, family);
    let [bits, moved] = ENDS;
    let slack = |end: &Rational| Rational::from(end.abs_ref()) >> moved;
    let (low, high) = (all.lower()?, all.upper()?);
    let (low, high) = (&low - slack(&low), &high + slack(&high));
    Some([Interval::rational(&low, bits).lower()?, Interval::rational(&high, bits).upper()?])
}

/// Contains every value of an expression in these variables on the box of their intervals: natural interval evaluation on each of the
/// parts. Undefined if it may have no value somewhere.
fn spread(expr: &Expr, family: &[Span]) -> Interval {
    let variables = occurring(expr, family.len());
    let parts = variables.len().checked_sub(1).map_or(1, |last| PARTS[last.min(PARTS.len() - 1)]);
    let cells = (0..variables.len()).fold(1, |cells, _| cells * parts);
    let mut whole: Option<Interval> = None;
    for cell in 0..cells {
        let mut values = vec![Interval::undefined(PRECISION); family.len()];
        let mut rest = cell;
        for variable in &variables {
            let [low, high] = &family[*variable].ends;
            let corner = |number: u32| low + Rational::from(high - low) * Rational::from((number, parts));
            values[*variable] = Interval::between(&corner(rest % parts), &corner(rest % parts + 1), PRECISION);
            rest /= parts;
        }
        let value = expr.at(|variable| values.get(variable), PRECISION);
        whole = Some(whole.map_or_else(|| value.clone(), |whole| whole.hull(&value)));
    }
    whole.unwrap_or_else(|| Interval::undefined(PRECISION))
}

/// Which of so many variables occur.
fn occurring(expr: &Expr, count: usize) -> Vec<usize> {
    let mut found = vec![false; count];
    expr.fold(|op, _: Option<()>, _| {
        if let Op::Variable(index) = op
            && let Some(found) = found.get_mut(*index)
        {
            *found = true;
        }
    });
    (0..count).filter(|variable| found[*variable]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spread_of(text: &str, ends: [[(i32, i32); 2]; 2]) -> Interval {
        let family = ends.map(|[low, high]| {
            let [low, high] = [Rational::from(low), Rational::from(high)];
            Span { nominal: low.clone(), ends: [low, high] }
        });
        spread(&Expr::parse(text, &["J", "k"]).unwrap(), &family)
    }

    #[test]
    fn contains_what_the_expression_is_and_little_more() {
        let ends = [[(9, 50), (11, 50)], [(1, 1), (2, 1)]];
        for (text, low, high) in [
            ("1/J", 1.0 / 0.22, 1.0 / 0.18),
            ("k", 1.0, 2.0),
            ("k/J", 1.0 / 0.22, 2.0 / 0.18),
            // k occurs twice, so its parts are seen, which are 1/32 wide.
            ("k/(J + k)", 1.0 / 1.22, 2.0 / 2.18),
            ("max(J, 3)", 3.0, 3.0),
        ] {
            let found = spread_of(text, ends);
            let (lower, upper) = (found.lower().unwrap().to_f64(), found.upper().unwrap().to_f64());
            assert!(lower <= low + 1e-12 && upper >= high - 1e-12, "{text}: {lower} to {upper}");
            assert!(lower >= low - 0.032 && upper <= high + 0.032, "{text}: {lower} to {upper}");
        }
    }

    #[test]
    fn is_undefined_where_the_expression_may_be() {
        let ends = [[(-1, 10), (1, 1)], [(1, 1), (2, 1)]];
        for text in ["1/J", "sqrt(J)", "log(J)"] {
            assert!(!spread_of(text, ends).is_bounded(), "{text}");
        }
    }
}
