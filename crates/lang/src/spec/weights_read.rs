//! Weights in a document.

use super::constant::{any_constant, whole};
use super::document::Value;
use super::error::{ErrorKind, Errors, Reported};
use super::object::choose;
use super::weights::Weights;
use super::weights_proof::Culprit;

/// The most weights that may be listed.
pub const MAX_WEIGHTS: usize = 1000;

/// Reads `weights` and proves the conditions that [`Weights`] states.
///
/// # Errors
/// Reports what cannot be read, an explicit list without a tail, and the first condition that fails (naming its l and
/// the numbers) or cannot be decided.
pub(super) fn read(value: &Value<'_>, errors: &mut Errors) -> Result<Weights, Reported> {
    let help = "write `{ \"family\": \"power\", \"n0\": \"2\", \"epsilon\": \"1/2\" }`, or `{ \"family\": \"explicit\", \"values\": [...], \"tail\": ... }`";
    let mut object = value.object_or(help, errors)?;
    let family = object.required("family", errors);
    let family = family.and_then(|value| choose(&value, "family of weights", &["power", "explicit"], errors));
    // Without a family the other fields have no meaning to check.
    let weights = match family? {
        "power" => {
            let n0 = object.required("n0", errors).and_then(|value| any_constant(&value, errors));
            let epsilon = object.required("epsilon", errors).and_then(|value| any_constant(&value, errors));
            object.finish_as("for the power family", errors);
            Weights::Power { n0: n0?, epsilon: epsilon? }
        }
        _ => {
            let values = object.required("values", errors).and_then(|value| list(&value, errors));
            let tail = match object.optional("tail") {
                Some(tail) => Ok(tail),
                None => Err(errors.report(
                    value
                        .error(ErrorKind::MissingField, "explicit weights without a tail say nothing about large l")
                        .expected("expected `tail` in this object")
                        .help(
                            "a claim is for every number of oscillators; add \
                             \"tail\": { \"coefficient\": \"1\", \"exponent\": \"3/2\" }",
                        )
                        .at(format!("{}/tail", value.pointer()), value.key_span()),
                )),
            };
            object.finish_as("for the explicit family", errors);
            let tail = tail.and_then(|tail| {
                let mut tail = tail.object(errors)?;
                let coefficient = tail.required("coefficient", errors).and_then(|value| any_constant(&value, errors));
                let exponent = tail.required("exponent", errors).and_then(|value| any_constant(&value, errors));
                tail.finish(errors);
                Ok((coefficient?, exponent?))
            });
            let (values, (coefficient, exponent)) = (values?, tail?);
            Weights::Explicit { values, coefficient, exponent }
        }
    };
    prove(value, weights, errors)
}

fn list(value: &Value<'_>, errors: &mut Errors) -> Result<Vec<super::Constant>, Reported> {
    let elements = value.array(errors)?;
    if elements.is_empty() || elements.len() > MAX_WEIGHTS {
        let message = format!("`values` lists {} weights", elements.len());
        let error = value.error(ErrorKind::Range, message).expected(format!("expected 1 to {MAX_WEIGHTS} weights"));
        return Err(errors.report(error));
    }
    value.each(errors, any_constant)
}

fn prove(value: &Value<'_>, weights: Weights, errors: &mut Errors) -> Result<Weights, Reported> {
    let Err(failure) = weights.prove() else { return Ok(weights) };
    let place = match failure.culprit {
        Culprit::Listed(l) => value.member("values").and_then(|values| values.element(l)),
        Culprit::Field(name) => value.member(name).or_else(|| value.member("tail").and_then(|tail| tail.member(name))),
    };
    let kind = if failure.refuted { ErrorKind::Weights } else { ErrorKind::Undecided };
    let error = whole(&place.unwrap_or_else(|| value.clone()), kind, failure.message);
    Err(errors.report(error.help(failure.help)))
}
