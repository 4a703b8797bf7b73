//! An actuator that saturates (derivation, 13.5): a bound of what is put out, which the claim keeps.

use super::constant::positive_constant_in;
use super::document::Value;
use super::error::{ErrorKind, Errors, Reported, shown};
use super::parts::Constant;
use super::quantity::Quantity;
use crate::expr::Definitions;

/// `actuator`: what is put out acts as it is up to `max` in size, and as `max` beyond.
#[derive(Clone, Debug)]
pub struct Actuator {
    /// The greatest |what is put out| that the actuator takes, above 0, in the units of that: with an input gain of the control of the
    /// law over the nominal gain.
    pub max: Constant,
}

impl Actuator {
    /// Whether the other one certainly has the same `max`, however it is written.
    #[must_use]
    pub fn is(&self, other: &Actuator) -> bool {
        Quantity::constant(&self.max).equals(&Quantity::constant(&other.max)).is_true()
            || self.max.text == other.max.text
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

/// Reads `actuator`: one positive constant, in which the names of a plant's constants may stand.
///
/// # Errors
/// Reports a field that is missing or unknown, limits that are not symmetric, and a number that is not positive.
pub fn read_actuator(value: &Value<'_>, names: &Definitions, errors: &mut Errors) -> Result<Actuator, Reported> {
    let max = value.text().or_else(|| value.numeral()).map_or("30".into(), shown);
    let help = format!("write `{{ \"max\": \"{max}\" }}`: |u| up to it is put out as it is");
    let mut object = value.object_or(&help, errors)?;
    if let Some(min) = value.member("min") {
        let error = min.error(ErrorKind::Range, "the limits of an actuator are symmetric here: |u| is at most `max`");
        let help = "for limits from LO to HI let u be measured from their middle: the middle (LO + HI)/2, times the gain of the actuator, goes into `q` \
                    (with an interval as a parameter that stands in `input_gain`, too), and `max` is (HI - LO)/2";
        return Err(errors.report(error.expected("expected `max` alone").help(help)));
    }
    let max = object.required("max", errors).and_then(|value| positive_constant_in(&value, names, errors));
    object.finish(errors);
    Ok(Actuator { max: max? })
}
