//! An actuator whose gain is known to an interval (derivation, 13.1): e' = q(t,x,e) + b u with a constant b.

use super::constant::{any_constant, exchanged, not_in_order, positive_constant_in, whole};
use super::document::Value;
use super::error::{ErrorKind, Errors, Reported, SpecError, shown};
use super::interval::{no_list, no_reach, no_share};
use super::parameters::Parameters;
use super::parts::Constant;
use super::quantity::Quantity;
use super::range::{range, standing_for};
use crate::expr::{Definitions, PlantExpr};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::write_exact;

/// `input_gain`: the gain of the actuator signal, 0 < low <= nominal <= high. The true gain is one constant in `[low, high]`; the
/// regulator puts out u/nominal, so that what reaches the plant is b u with b = gain/nominal.
#[derive(Clone, Debug)]
pub struct InputGain {
    /// What the regulator divides by.
    pub nominal: Constant,
    /// The smallest gain, or a number below every value of `low` where that is an expression of parameters: its text is that.
    pub low: Constant,
    /// The largest gain, or a number above every value of `high`.
    pub high: Constant,
    /// `low` and `high` where they are expressions of parameters of which intervals are known.
    formulas: [Option<PlantExpr>; 2],
}

impl InputGain {
    /// b_lo = low/nominal and b_hi = high/nominal, exactly; `None` where one of the three is not known to be rational.
    #[must_use]
    pub fn exact_factors(&self) -> Option<[Rational; 2]> {
        let nominal = self.nominal.as_rational()?;
        let over = |end: &Constant| Some(Rational::from(end.as_rational()? / nominal));
        Some([over(&self.low)?, over(&self.high)?])
    }

    /// Enclosures of b_lo and b_hi; `None` where the gain is the nominal one, so that both are 1.
    ///
    /// Guarantee: b_lo > 0, and as far as enclosures say so b_lo <= 1 <= b_hi.
    #[must_use]
    pub fn factors(&self, precision: u32) -> Option<[Enclosure; 2]> {
        if self.is_nominal() {
            return None;
        }
        if let Some(factors) = self.exact_factors() {
            return Some(factors.map(|factor| Enclosure::from_rational(&factor, precision)));
        }
        let nominal = self.nominal.enclose(precision);
        let one = Enclosure::one(precision);
        // That they are in order was proved when they were read.
        let low = (self.low.enclose(precision) / &nominal).min(&one);
        Some([low, (self.high.enclose(precision) / nominal).max(&one)])
    }

    /// Whether the interval is its nominal gain, so that nothing is uncertain.
    #[must_use]
    pub fn is_nominal(&self) -> bool {
        let same = |end: &Constant| Quantity::constant(end).equals(&Quantity::constant(&self.nominal)).is_true();
        same(&self.low) && same(&self.high)
    }

    /// Whether the other one is certainly the same in all three numbers, however they are written.
    #[must_use]
    pub fn is(&self, other: &InputGain) -> bool {
        let same = |a: &Constant, b: &Constant| {
            let exactly = Quantity::constant(a).equals(&Quantity::constant(b)).is_true();
            exactly || a.text == b.text
        };
        same(&self.nominal, &other.nominal) && same(&self.low, &other.low) && same(&self.high, &other.high)
    }

    /// Whether an end is an expression of parameters, so that its number is outside of what that is.
    #[must_use]
    pub fn of_parameters(&self) -> bool {
        self.formulas.iter().any(Option::is_some)
    }

    /// The three as a document of the plant has them, with constants written out: numbers, or expressions of parameters.
    #[must_use]
    pub fn written(&self) -> [(&'static str, String); 3] {
        let number = |value: &Constant| value.as_rational().map_or_else(|| value.text.clone(), write_exact);
        let [low, high] = &self.formulas;
        let end =
            |formula: &Option<PlantExpr>, number: String| formula.as_ref().map_or(number, |it| it.text().to_owned());
        let (low, high) = (end(low, number(&self.low)), end(high, number(&self.high)));
        [("nominal", number(&self.nominal)), ("low", low), ("high", high)]
    }

    /// The nominal gain of this one, known exactly.
    #[must_use]
    pub fn closed(&self) -> InputGain {
        let [nominal, low, high] = [(); 3].map(|()| self.nominal.clone());
        InputGain { nominal, low, high, formulas: [None, None] }
    }

    /// `low` and `high` with these values of the parameters with intervals: numbers around what an expression is there. The nominal gain stays,
    /// which need not be between them.
    #[must_use]
    pub fn ends_at(&self, values: &[Rational]) -> [Constant; 2] {
        let [low, high] = &self.formulas;
        [(low, 0, &self.low), (high, 1, &self.high)].map(|(formula, end, of_family)| {
            let at = formula.as_ref().and_then(|formula| range(&formula.at(values), &Parameters::default()));
            at.map_or_else(|| of_family.clone(), |ends| Constant::rational(&ends[end]))
        })
    }
}

/// Reads `input_gain`: three positive constants, proved to be in order; the names of a plant's parameters may stand in them. In `nominal`
/// they have their nominal values, and `low` and `high` are a number below and one above all that an expression is on the box of the intervals.
///
/// # Errors
/// Reports fields that are missing or unknown, numbers that are not positive, expressions that may have no value somewhere, and an order
/// that fails or is not decided.
pub fn read_input_gain(value: &Value<'_>, parameters: &Parameters, errors: &mut Errors) -> Result<InputGain, Reported> {
    let help = "the gain of the actuator is one constant from `low` to `high`, and the regulator divides its control by `nominal`";
    if let Some(error) = one_number(value) {
        return Err(errors.report(error));
    }
    if let Some(error) = contains_zero(value) {
        return Err(errors.report(error));
    }
    let mut formulas = [None, None];
    let [nominal, low, high] = ordered_by(value, help, errors, |name, value, errors| {
        let text = value.text().filter(|text| parameters.definitions().vary(text));
        match (text, name) {
            (Some(text), "low") => end_of(value, text, (parameters, 0), &mut formulas, errors),
            (Some(text), "high") => end_of(value, text, (parameters, 1), &mut formulas, errors),
            (Some(_), _) => positive_constant_in(value, &parameters.nominal_definitions(), errors),
            (None, _) => positive_constant_in(value, parameters.definitions(), errors),
        }
    })?;
    Ok(InputGain { nominal, low, high, formulas })
}

/// What is wrong where one number stands in the place of the interval.
fn one_number(value: &Value<'_>) -> Option<SpecError> {
    let written = value.text().or_else(|| value.numeral())?;
    // What is meant as an interval is told as one.
    no_list(value, &mut Errors::new()).ok()?;
    let message = format!("`input_gain` is {}, and an interval is expected", value.type_name());
    let error = value.error(ErrorKind::Type, message).expected("expected an object with `nominal`, `low` and `high`");
    let gain = shown(written);
    Some(error.help(format!(
        "for a gain that is known exactly write `\"input_gain\": {{ \"nominal\": \"{gain}\", \"low\": \"{gain}\", \"high\": \"{gain}\" }}`; else write as \
         `low` and `high` the smallest and the largest gain that the actuator may have"
    )))
}

/// What is wrong where the interval contains 0, as far as its ends are numbers.
fn contains_zero(value: &Value<'_>) -> Option<SpecError> {
    // What is wrong in a number is told where it is read.
    let number = |end: &Value<'_>| any_constant(end, &mut Errors::new()).ok()?.as_rational().cloned();
    let ends = match (value.member("low"), value.member("high")) {
        (Some(low), Some(high)) => vec![low, high],
        _ => value.elements(),
    };
    let numbers: Vec<Rational> = ends.iter().map(number).collect::<Option<_>>()?;
    let (low, high) = (numbers.iter().min()?, numbers.iter().max()?);
    if numbers.len() < 2 || *low > 0 || *high < 0 {
        return None;
    }
    let [low, high] = [low, high].map(write_exact);
    let message = format!("the input gain may be 0: its interval is from {low} to {high}");
    let help = "with the gain 0 the control does nothing, and with a negative gain it acts the wrong way, so one regulator cannot serve the whole interval; \
                write as `low` the smallest positive gain that the actuator may have, as `\"low\": \"1/2\"`";
    Some(whole(value, ErrorKind::Range, message).expected("expected only positive gains").help(help))
}

/// The number of an end that is an expression of parameters: below (`end` 0) or above (1) what it is on the box.
fn end_of(
    value: &Value<'_>,
    text: &str,
    (parameters, end): (&Parameters, usize),
    formulas: &mut [Option<PlantExpr>; 2],
    errors: &mut Errors,
) -> Result<Constant, Reported> {
    let read = PlantExpr::of_parameters(text, parameters.definitions());
    let formula = read.map_err(|error| errors.report(value.expression_error(&error)))?;
    let Some(ends) = range(&formula, parameters) else {
        let message = "this expression has no value that can be enclosed for some values of its parameters";
        let help =
            "a division by 0, or the root or logarithm of a negative number, comes too close: narrow the intervals";
        return Err(errors.report(whole(value, ErrorKind::Expression, message).help(help)));
    };
    if ends[0] <= 0 {
        let message = format!(
            "{} must be positive, but for some values of its parameters it may be down to {}",
            value.name(),
            ends[0].to_f64()
        );
        return Err(errors.report(whole(value, ErrorKind::Range, message)));
    }
    let number = standing_for(&formula, &ends[end]);
    formulas[end] = Some(formula);
    Ok(number)
}

/// Reads `nominal`, `low` and `high`, positive constants in which the names may stand, proved to be in order.
///
/// # Errors
/// Those of [`read_input_gain`]; of an order that fails `help` says what it means.
pub(super) fn read_ordered(
    value: &Value<'_>,
    names: &Definitions,
    help: &str,
    errors: &mut Errors,
) -> Result<[Constant; 3], Reported> {
    ordered_by(value, help, errors, |_, value, errors| positive_constant_in(value, names, errors))
}

/// Reads `nominal`, `low` and `high` with the reader that is given, proved to be in order: low <= nominal <= high.
fn ordered_by(
    value: &Value<'_>,
    help: &str,
    errors: &mut Errors,
    mut read: impl FnMut(&'static str, &Value<'_>, &mut Errors) -> Result<Constant, Reported>,
) -> Result<[Constant; 3], Reported> {
    no_list(value, errors)?;
    no_share(value, errors)?;
    no_reach(value, errors)?;
    let mut object = value.object(errors)?;
    let nominal = object.required("nominal", errors).and_then(|value| read("nominal", &value, errors));
    let [low, high] = ["low", "high"]
        .map(|name| object.required(name, errors).and_then(|value| read(name, &value, errors).map(|end| (value, end))));
    object.finish(errors);
    if let (Ok((value, low)), Ok((_, high))) = (&low, &high)
        && let Some(error) = exchanged(value, low, high)
    {
        return Err(errors.report(error));
    }
    let mut in_order = |name: &str, end: Result<(Value<'_>, Constant), Reported>, relation: &str, side: &str| {
        let (value, end) = end?;
        if let Ok(nominal) = &nominal
            && let Some(error) = not_in_order(&value, (name, &end), relation, ("nominal", nominal))
        {
            let expected = format!("expected {side} {}", Quantity::constant(nominal).shown());
            return Err(errors.report(error.expected(expected).help(help)));
        }
        Ok(end)
    };
    let low = in_order("low", low, "<=", "at most");
    let high = in_order("high", high, ">=", "at least");
    Ok([nominal?, low?, high?])
}
