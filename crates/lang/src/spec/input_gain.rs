//! An actuator whose gain is known to an interval (derivation, 13.1): e' = q(t,x,e) + b u with a constant b.

use super::constant::{positive_constant_in, whole};
use super::document::Value;
use super::error::{ErrorKind, Errors, Reported};
use super::parts::Constant;
use super::quantity::Quantity;
use crate::expr::Definitions;
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, MAX_PRECISION, Truth};

/// `input_gain`: the gain of the actuator signal, 0 < low <= nominal <= high. The true gain is one constant in `[low, high]`; the
/// regulator puts out u/nominal, so that what reaches the plant is b u with b = gain/nominal.
#[derive(Clone, Debug)]
pub struct InputGain {
    /// What the regulator divides by.
    pub nominal: Constant,
    /// The smallest gain.
    pub low: Constant,
    /// The largest gain.
    pub high: Constant,
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

    /// The same nominal gain, known exactly.
    #[must_use]
    pub fn closed(&self) -> InputGain {
        InputGain { low: self.nominal.clone(), high: self.nominal.clone(), nominal: self.nominal.clone() }
    }
}

/// Reads `input_gain`: three positive constants, proved to be in order; the names of a plant's constants may stand in them.
///
/// # Errors
/// Reports fields that are missing or unknown, numbers that are not positive, and an order that fails or is not decided.
pub fn read_input_gain(value: &Value<'_>, names: &Definitions, errors: &mut Errors) -> Result<InputGain, Reported> {
    let help = "the true gain lies in [low, high], and the regulator divides by `nominal`";
    let [nominal, low, high] = read_ordered(value, names, help, errors)?;
    Ok(InputGain { nominal, low, high })
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
    let mut object = value.object(errors)?;
    let nominal = object.required("nominal", errors).and_then(|value| positive_constant_in(&value, names, errors));
    let mut end = |name: &'static str, in_order: fn(&Constant, &Constant) -> Truth, relation: &str| {
        object.required(name, errors).and_then(|value| {
            let end = positive_constant_in(&value, names, errors)?;
            match &nominal {
                Ok(nominal) => ordered(&value, (name, relation, help), end, nominal, in_order, errors),
                Err(_) => Ok(end),
            }
        })
    };
    let low = end("low", |low, nominal| Quantity::constant(low).le(&Quantity::constant(nominal)), "<=");
    let high = end("high", |high, nominal| Quantity::constant(nominal).le(&Quantity::constant(high)), ">=");
    object.finish(errors);
    Ok([nominal?, low?, high?])
}

/// The end of the interval, if it is on its side of the nominal value.
fn ordered(
    value: &Value<'_>,
    (name, relation, help): (&str, &str, &str),
    end: Constant,
    nominal: &Constant,
    in_order: fn(&Constant, &Constant) -> Truth,
    errors: &mut Errors,
) -> Result<Constant, Reported> {
    let (kind, message) = match in_order(&end, nominal) {
        Truth::True => return Ok(end),
        Truth::False => {
            let (end, nominal) = Quantity::constant(&end).shown_apart(&Quantity::constant(nominal));
            (ErrorKind::Range, format!("{name} {relation} nominal fails: {name} = {end} and nominal = {nominal}"))
        }
        Truth::Undecided => {
            let message = format!("cannot be decided at {MAX_PRECISION} bits whether {name} {relation} nominal");
            (ErrorKind::Undecided, message)
        }
    };
    let side = if relation == "<=" { "at most" } else { "at least" };
    let error =
        whole(value, kind, message).expected(format!("expected {side} {}", Quantity::constant(nominal).shown()));
    Err(errors.report(error.help(help)))
}
