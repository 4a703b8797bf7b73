//! An actuator that saturates (derivation, 13.5): bounds of what is put out, which the claim keeps to.

use super::constant::{any_constant_in, positive_constant_in};
use super::document::Value;
use super::error::{ErrorKind, Errors, Reported, SpecError, shown};
use super::parts::Constant;
use super::quantity::Quantity;
use crate::expr::Definitions;
use rug::Rational;
use sigmastar_exact::number::write_exact;

/// `actuator`: what is put out acts as it is between two limits, and as the nearer one beyond.
///
/// With `max` alone these are `-max` and `max`. With `min` and `max` the regulator puts out `(min + max)/2 + u`: u is measured from the middle, which acts on
/// the plant as a constant disturbance does, and is bounded by half of the range.
#[derive(Clone, Debug)]
pub struct Actuator {
    /// The greatest |u|, above 0, in the units of what is put out: with an input gain that is the control of the law over the nominal gain.
    pub max: Constant,
    /// The limits, where `min` is stated.
    pub range: Option<ActuatorRange>,
    /// Whether a claim keeps to it by its bounds for every number of oscillators, in the place of condition C6 (derivation, 14.5). No file says that.
    pub by_count: bool,
}

/// The limits of an actuator, rational numbers with min < max.
#[derive(Clone, Debug)]
pub struct ActuatorRange {
    /// The lower one.
    pub min: Constant,
    /// The upper one.
    pub max: Constant,
    /// What u is measured from, (min + max)/2.
    pub middle: Rational,
}

impl Actuator {
    /// The actuator with limits -max and max.
    #[must_use]
    pub fn symmetric(max: Constant) -> Actuator {
        Actuator { max, range: None, by_count: false }
    }

    /// What u is measured from, where that is not 0.
    #[must_use]
    pub fn middle(&self) -> Option<Rational> {
        self.range.as_ref().map(|range| range.middle.clone()).filter(|middle| *middle != 0)
    }

    /// Whether the other one certainly has the same limits, however they are written.
    #[must_use]
    pub fn is(&self, other: &Actuator) -> bool {
        let same = |a: &Constant, b: &Constant| {
            Quantity::constant(a).equals(&Quantity::constant(b)).is_true() || a.text == b.text
        };
        match (&self.range, &other.range) {
            (None, None) => same(&self.max, &other.max),
            (Some(own), Some(other)) => same(&own.min, &other.min) && same(&own.max, &other.max),
            _ => false,
        }
    }

    /// The least double that is not below `min` and the largest one that is not above `max`, where both are stated: what is put out is cut off there, so
    /// that it never leaves the range by rounding.
    #[must_use]
    pub fn ends(&self) -> Option<[f64; 2]> {
        let range = self.range.as_ref()?;
        Some([range.min.enclose(PRECISION).upper_f64(), range.max.enclose(PRECISION).lower_f64()])
    }

    /// A rational number up to which |u| certainly is taken as it is: `max` where that is rational.
    #[must_use]
    pub fn largest(&self) -> Option<Rational> {
        self.max.as_rational().cloned().or_else(|| self.max.enclose(PRECISION).lower_rational())
    }

    /// Its numbers as a document has them, by their names.
    #[must_use]
    pub fn written(&self) -> Vec<(&'static str, String)> {
        let number = |value: &Constant| value.as_rational().map_or_else(|| value.text.clone(), write_exact);
        match &self.range {
            Some(ActuatorRange { min, max, .. }) => vec![("min", number(min)), ("max", number(max))],
            None => vec![("max", number(&self.max))],
        }
    }

    /// The least double that is certainly not below `max`, where code clips: a control that is proved to stay within `max` it leaves as it is.
    /// Infinite where `max` is above all doubles.
    #[must_use]
    pub fn limit(&self) -> f64 {
        self.max.enclose(PRECISION).upper_f64()
    }
}

/// Bits of [`Actuator::limit`]: far more than a double has, so that the upper end lies above a double only where `max` does.
const PRECISION: u32 = 256;

/// Reads `actuator`: one positive constant, or two rational numbers in order, in which the names of a plant's constants may stand.
///
/// # Errors
/// Reports a field that is missing or unknown, limits that are not in order or not rational, and a number that is not positive where it stands alone.
pub fn read_actuator(value: &Value<'_>, names: &Definitions, errors: &mut Errors) -> Result<Actuator, Reported> {
    read(value, names, Place::Plant, errors)
}

/// Reads that of bounding functions, which know no middle.
///
/// # Errors
/// Those of [`read_actuator`], and limits to both sides.
pub(super) fn read_symmetric(value: &Value<'_>, errors: &mut Errors) -> Result<Actuator, Reported> {
    read(value, Definitions::none(), Place::Specification, errors)
}

/// Where an actuator is stated.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    Plant,
    Specification,
    Claim,
}

/// Reads that of a claim, which may have `kept_by`.
///
/// # Errors
/// Those of [`read_actuator`], and another value of that field than `by_n_o`.
pub fn read_claimed_actuator(
    value: &Value<'_>,
    names: &Definitions,
    errors: &mut Errors,
) -> Result<Actuator, Reported> {
    read(value, names, Place::Claim, errors)
}

/// The field of a claim that says by what it keeps to its actuator, and its one value.
pub const KEPT_BY: [&str; 2] = ["kept_by", "by_n_o"];

fn read(value: &Value<'_>, names: &Definitions, place: Place, errors: &mut Errors) -> Result<Actuator, Reported> {
    let max = value.text().or_else(|| value.numeral()).map_or("30".into(), shown);
    let both = match place {
        Place::Specification => "",
        _ => "; or both limits of a range, `{ \"min\": \"0\", \"max\": \"4\" }`",
    };
    let help = format!("write `{{ \"max\": \"{max}\" }}`: |u| up to it is put out as it is{both}");
    if let Some(error) = (place == Place::Plant).then(|| two_limits_meant(value)).flatten() {
        return Err(errors.report(error));
    }
    let mut object = value.object_or(&help, errors)?;
    let stated = value.member("min").filter(|_| place == Place::Specification);
    if let Some(min) = stated {
        let error = min.error(ErrorKind::Range, "limits to both sides are for plants by their formulas");
        let help = "let u be measured from the middle (min + max)/2: state the bounding functions of `q` plus the gain of the actuator times it, and \
                    `{ \"max\": ... }` with (max - min)/2";
        return Err(errors.report(error.expected("expected `max` alone").help(help)));
    }
    let min = if place == Place::Specification { None } else { object.optional("min") };
    let max = object.required("max", errors);
    let kept_by = if place == Place::Claim { object.optional(KEPT_BY[0]) } else { None };
    object.finish(errors);
    let by_count = kept_by.is_some();
    if let Some(value) = kept_by.filter(|value| value.text() != Some(KEPT_BY[1])) {
        return Err(errors.report(value.error(ErrorKind::Range, format!("expected `{}`", KEPT_BY[1]))));
    }
    let Some(min) = min else {
        let max = max.and_then(|value| positive_constant_in(&value, names, errors))?;
        return Ok(Actuator { by_count, ..Actuator::symmetric(max) });
    };
    let mut rational = |value: &Value<'_>| {
        let constant = any_constant_in(value, names, errors)?;
        let refused = || {
            let error = value.error(ErrorKind::Range, "with two limits each has to be a rational number");
            error.expected("expected a decimal or a fraction")
        };
        match constant.as_rational().cloned() {
            Some(number) => Ok((constant, number)),
            None => Err(errors.report(refused())),
        }
    };
    let (lower, upper) = (rational(&min), max.and_then(|value| rational(&value)));
    let ((lower, low), (upper, high)) = (lower?, upper?);
    if low >= high {
        let (min_text, max_text) = (write_exact(&low), write_exact(&high));
        let error = min.error(ErrorKind::Range, format!("min = {min_text} is not below max = {max_text}"));
        return Err(errors.report(error.expected(format!("expected less than {max_text}"))));
    }
    let (half, middle) = (Rational::from(&high - &low) / 2, (low + high) / 2);
    Ok(Actuator {
        max: Constant::rational(&half),
        range: Some(ActuatorRange { min: lower, max: upper, middle }),
        by_count,
    })
}

/// What is wrong where limits to both sides are meant and stated in another form: as a list, by the names of an interval, or by the lower one alone.
fn two_limits_meant(value: &Value<'_>) -> Option<SpecError> {
    let written = |limit: &Value<'_>| limit.text().or_else(|| limit.numeral()).map(shown);
    let both = |min: &str, max: &str| format!("`\"actuator\": {{ \"min\": \"{min}\", \"max\": \"{max}\" }}`");
    if let [low, high] = value.elements().as_slice() {
        let message = "the limits of an actuator are no list";
        let help = format!("write {}", both(&written(low)?, &written(high)?));
        let error = value.error(ErrorKind::Type, message).expected("expected an object with `min` and `max`");
        return Some(error.help(help));
    }
    let [min, max] = ["min", "max"].map(|name| value.member(name));
    if let (None, None, Some(low), Some(high)) = (&min, &max, value.member("low"), value.member("high")) {
        let message = "the limits of an actuator are called `min` and `max`, not `low` and `high`";
        let help = format!("write {}", both(&written(&low)?, &written(&high)?));
        return Some(value.error(ErrorKind::UnknownField, message).expected("expected `min` and `max`").help(help));
    }
    let min = min.filter(|_| max.is_none())?;
    let help = format!("state both limits, as {}; `max` alone stands for -max and max", both(&written(&min)?, "..."));
    let error = value.error(ErrorKind::MissingField, "the field `max`, the upper limit, is missing");
    Some(error.expected("expected `max` beside `min`").help(help))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::{Document, SpecErrors};

    fn read(text: &str) -> Result<Actuator, SpecErrors> {
        let document = Document::parse("actuator", text)?;
        let mut errors = Errors::new();
        let outcome = read_actuator(&document.root(), Definitions::none(), &mut errors);
        errors.conclude(&document, outcome)
    }

    #[test]
    fn u_is_measured_from_the_middle() {
        let actuator = read(r#"{ "min": 0, "max": "3.9" }"#).unwrap();
        assert_eq!((actuator.max.text.as_str(), actuator.middle()), ("1.95", Some((195, 100).into())));
        let written = actuator.written();
        assert_eq!(written, [("min", "0".to_owned()), ("max", "3.9".to_owned())]);
        // Below 0 as a whole.
        let braking = read(r#"{ "min": "-4", "max": "-1/2" }"#).unwrap();
        assert_eq!((braking.max.text.as_str(), braking.middle()), ("1.75", Some((-9, 4).into())));
        // The same limits to both sides leave u where it was, and are written as they were.
        let both = read(r#"{ "min": "-3", "max": 3 }"#).unwrap();
        assert_eq!((both.max.text.as_str(), both.middle(), both.written().len()), ("3", None, 2));
        let alone = read(r#"{ "max": "3" }"#).unwrap();
        assert!(alone.middle().is_none() && !alone.is(&both) && alone.is(&read(r#"{ "max": "6/2" }"#).unwrap()));
        assert!(both.is(&read(r#"{ "min": "-6/2", "max": "3.0" }"#).unwrap()));
        assert!(!both.is(&read(r#"{ "min": "-3", "max": "4" }"#).unwrap()));
    }

    #[test]
    fn limits_that_are_none() {
        for (text, said) in [
            (r#"{ "min": 2, "max": 2 }"#, "min = 2 is not below max = 2"),
            (r#"{ "min": 3.9, "max": 0 }"#, "min = 3.9 is not below max = 0"),
            (r#"{ "min": 0, "max": "pi" }"#, "with two limits each has to be a rational number"),
            (r#"{ "min": "sqrt(2)", "max": 2 }"#, "with two limits each has to be a rational number"),
            (r#"{ "min": 0 }"#, "the upper limit, is missing"),
            (r#"[0, "3.9"]"#, "the limits of an actuator are no list"),
            (r#"[1, 2, 3]"#, "is an array"),
            (r#"{ "low": 0, "high": 4 }"#, "are called `min` and `max`"),
            (r#"{ "low": 0, "max": 4 }"#, "unknown field `low`"),
            (r#"{ "max": -1 }"#, "must be positive"),
            (r#"{ "min": 0, "max": 1, "middle": 0 }"#, "middle"),
        ] {
            let errors = read(text).unwrap_err().to_string();
            assert!(errors.contains(said), "{text}: {errors}");
        }
    }
}
