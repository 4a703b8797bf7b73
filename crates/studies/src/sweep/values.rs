//! The values of a parameter: lists as they are written, ranges as exact numbers.

use super::MAX_CASES;
use rug::Rational;
use sigmastar_exact::number::{Direction, Portable, round_f64, write_exact};
use sigmastar_lang::spec::{Document, ErrorKind, Errors, Reported, Value, any_constant};
use std::collections::BTreeSet;

/// Significant digits of the values of a logarithmic range between its ends.
const DIGITS: u32 = 6;

/// The smallest and the largest end of a logarithmic range: its values are proposed in doubles.
const REACH: [f64; 2] = [1e-150, 1e150];

/// A value as it is put into a document: a string, a number or a Boolean.
#[derive(Clone, Debug, PartialEq)]
pub struct Scalar(pub(super) serde_json::Value);

impl Scalar {
    /// An exact number.
    pub(super) fn exact(value: &Rational) -> Scalar {
        Scalar(serde_json::Value::String(write_exact(value)))
    }

    /// The text, without the quotes of a string.
    #[must_use]
    pub fn text(&self) -> String {
        match &self.0 {
            serde_json::Value::String(text) => text.clone(),
            other => other.to_string(),
        }
    }
}

/// The number nearest to a constant that is written so; `None` for another text.
pub(super) fn number(text: &str) -> Option<f64> {
    let document = Document::flag("value", text);
    let value = document.at("/value")?;
    let mut errors = Errors::new();
    any_constant(&value, &mut errors).ok().map(|constant| constant.to_f64()).filter(|number| number.is_finite())
}

/// A range with both of its ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Range {
    pub(super) from: Rational,
    pub(super) to: Rational,
    /// How many values.
    pub(super) count: u32,
}

/// The values of one parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// As they are listed.
    List(Vec<Scalar>),
    /// `from + (to - from) t`, exactly.
    Linear(Range),
    /// `from (to/from)^t`, rounded to six digits between the ends.
    Logarithmic(Range),
}

impl Values {
    /// How many there are on a grid.
    #[must_use]
    pub fn count(&self) -> u64 {
        match self {
            Values::List(values) => values.len() as u64,
            Values::Linear(range) | Values::Logarithmic(range) => u64::from(range.count),
        }
    }

    /// The values of a grid; `None` where two of them would be the same number after rounding.
    pub(super) fn levels(&self) -> Option<Vec<Scalar>> {
        match self {
            Values::List(values) => Some(values.clone()),
            Values::Linear(range) | Values::Logarithmic(range) => {
                let last = range.count.saturating_sub(1).max(1);
                self.at((0..range.count).map(|k| Rational::from((k, last))))
            }
        }
    }

    /// The values at shares t of the way, which rise; `None` where two of them would be the same.
    pub(super) fn at(&self, shares: impl Iterator<Item = Rational>) -> Option<Vec<Scalar>> {
        let numbers: Vec<Rational> = match self {
            Values::List(values) => {
                let at = |share: Rational| {
                    let place = (share * values.len() as u64).floor().into_numer_denom().0;
                    values.get(place.to_usize()?).cloned()
                };
                return shares.map(at).collect();
            }
            Values::Linear(Range { from, to, .. }) => {
                let step = Rational::from(to - from);
                shares.map(|share| from + share * &step).collect()
            }
            Values::Logarithmic(range) => shares.map(|share| range.geometric(&share)).collect::<Option<_>>()?,
        };
        let apart = numbers.windows(2).all(|pair| pair[0] != pair[1]);
        apart.then(|| numbers.iter().map(Scalar::exact).collect())
    }
}

impl Range {
    /// `from (to/from)^t`: the ends themselves, a short decimal between them. The functions of doubles are the same on every
    /// machine, so the cases are too.
    fn geometric(&self, share: &Rational) -> Option<Rational> {
        if share.is_zero() {
            return Some(self.from.clone());
        }
        if *share == 1 {
            return Some(self.to.clone());
        }
        let (from, to) = (self.from.to_f64(), self.to.to_f64());
        let exponent = from.portable_ln() * (1.0 - share.to_f64()) + to.portable_ln() * share.to_f64();
        round_f64(exponent.portable_exp(), DIGITS, Direction::Nearest)
    }
}

/// Reads a list: strings, numbers and Booleans, none of them twice.
///
/// # Errors
/// Reports another type, an empty list and a repeated value.
pub(super) fn read_list(value: &Value<'_>, errors: &mut Errors) -> Result<Values, Reported> {
    let elements = value.array(errors)?;
    if elements.is_empty() {
        return Err(errors.report(value.error(ErrorKind::Range, "there are no values").expected("expected one value")));
    }
    let mut seen = BTreeSet::new();
    let scalar = |element: &Value<'_>, errors: &mut Errors| {
        let known = element.numeral().or_else(|| element.text()).is_some() || element.type_name() == "a boolean";
        if !known {
            return Err(element.wrong_type("a number, a string or a Boolean", errors));
        }
        let scalar = Scalar(element.to_json());
        if !seen.insert(scalar.text()) {
            let message = "this value is in the list already";
            return Err(errors.report(element.error(ErrorKind::Range, message).help("leave one of the two out")));
        }
        Ok(scalar)
    };
    value.each(errors, scalar).map(Values::List)
}

/// Reads a range; `count` is that of a Latin hypercube, or is read here.
///
/// # Errors
/// Reports ends that are no rational numbers or are the same; of a logarithmic range, ends that are not positive or too
/// far out; a count below 2 or above the limit on cases.
pub(super) fn read_range(
    value: &Value<'_>,
    logarithmic: bool,
    latin: Option<u32>,
    errors: &mut Errors,
) -> Result<Values, Reported> {
    let mut object = value.object(errors)?;
    let mut end = |name: &'static str, errors: &mut Errors| {
        let value = object.required(name, errors)?;
        let constant = any_constant(&value, errors)?;
        let Some(end) = constant.as_rational() else {
            let error = value.error(ErrorKind::Range, format!("`{name}` is not a rational number"));
            return Err(errors.report(error.help("write it as a decimal or a fraction, or list the values")));
        };
        let far = !(REACH[0]..=REACH[1]).contains(&end.to_f64());
        if logarithmic && (*end <= 0 || far) {
            let error = value.error(ErrorKind::Range, format!("`{name}` is no end of a logarithmic range"));
            return Err(errors.report(error.expected("expected a positive number from 1e-150 to 1e150")));
        }
        Ok((value, end.clone()))
    };
    let (from, to) = (end("from", errors), end("to", errors));
    let count = match latin {
        Some(count) => Ok(count),
        None => object.required("count", errors).and_then(|value| read_count(&value, errors)),
    };
    match latin {
        Some(_) => {
            object.finish_as("in a range of a Latin hypercube, whose number of values is the study's `count`,", errors)
        }
        None => object.finish(errors),
    }
    let ((_, from), (place, to)) = (from?, to?);
    if from == to {
        let message = "the two ends of the range are the same";
        return Err(errors.report(place.error(ErrorKind::Range, message).help("list the one value in `values`")));
    }
    let range = Range { from, to, count: count? };
    let values = if logarithmic { Values::Logarithmic(range) } else { Values::Linear(range) };
    // Of a Latin hypercube the values are drawn later, and looked at then.
    if latin.is_none() && values.levels().is_none() {
        return Err(errors.report(too_near(value)));
    }
    Ok(values)
}

/// Values that are the same number after rounding.
pub(super) fn too_near(value: &Value<'_>) -> sigmastar_lang::spec::SpecError {
    let message = format!("two values of this range are the same number at {DIGITS} digits");
    value.error(ErrorKind::Range, message).help("ask for fewer values, a wider range, or a linear one")
}

/// Reads how many values or cases there are.
///
/// # Errors
/// Reports what is no whole number from 2 to the limit on cases.
pub(super) fn read_count(value: &Value<'_>, errors: &mut Errors) -> Result<u32, Reported> {
    let count = value.integer(errors)?;
    match u32::try_from(count) {
        Ok(small) if (2..=MAX_CASES).contains(&count) => Ok(small),
        _ => {
            let error = value.error(ErrorKind::Range, format!("`count` is {count}"));
            Err(errors.report(error.expected(format!("expected a whole number from 2 to {MAX_CASES}"))))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range(from: (i32, i32), to: (i32, i32), count: u32) -> Range {
        Range { from: Rational::from(from), to: Rational::from(to), count }
    }

    fn texts(values: &Values) -> Vec<String> {
        values.levels().unwrap().iter().map(Scalar::text).collect()
    }

    #[test]
    fn linear_ranges_are_exact() {
        assert_eq!(texts(&Values::Linear(range((0, 1), (1, 1), 4))), ["0", "1/3", "2/3", "1"]);
        assert_eq!(texts(&Values::Linear(range((3, 10), (1, 10), 3))), ["0.3", "0.2", "0.1"]);
    }

    #[test]
    fn logarithmic_ranges_are_short_decimals_between_exact_ends() {
        assert_eq!(texts(&Values::Logarithmic(range((1, 100), (1, 1), 3))), ["0.01", "0.1", "1"]);
        assert_eq!(texts(&Values::Logarithmic(range((1, 3), (2, 1), 3))), ["1/3", "0.816497", "2"]);
        assert_eq!(Values::Logarithmic(range((1, 1), (1_000_001, 1_000_000), 9)).levels(), None);
    }

    #[test]
    fn only_constants_are_numbers() {
        assert_eq!(number("3/2"), Some(1.5));
        assert_eq!((number("2*X"), number("true"), number("1/0")), (None, None, None));
    }
}
