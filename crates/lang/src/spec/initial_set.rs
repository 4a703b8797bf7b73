//! The initial set in a document.

use super::constant::nonnegative_constant_in;
use super::document::Value;
use super::error::{ErrorKind, Errors, Reported, shown};
use super::object::{Object, choose};
use super::parts::{Constant, InitialSet};
use crate::expr::Definitions;
use rug::Rational;

/// What a box of a plant needs for its states, and for the regulator.
const BALL: &str = "`ball` bounds the distance of x from its orbit at the start: `\"ball\": \"1/10\"` is |x - x_0| <= 1/10 in the units of the file; `X0` \
                    may stand in its place, for the norm of the coordinates that the program chooses";
const Z_0: &str = "`Z0` bounds sqrt(z'Nz) at the start: `\"Z0\": \"0\"` is a regulator at rest";

/// Reads `initial_set`: `paper` has no other field, `at-rest` and `aligned` may have X0 and E0, `box` has X0, E0 and Z0.
///
/// # Errors
/// Reports an unknown kind, fields that are missing or do not belong to the kind, and numbers that are negative.
pub(super) fn read(value: &Value<'_>, errors: &mut Errors) -> Result<InitialSet, Reported> {
    read_kinds(value, (false, false), Definitions::none(), errors).map(|(set, _)| set)
}

/// Reads `initial_set` of a plant, where `ball` may stand for X0: the radius of a ball that the set contains. Then X0 of the
/// set is that radius until the norm in which X0 is meant is known. Names of the plant's constants may stand in its numbers. Without states
/// a box needs no X0: it is 0.
///
/// # Errors
/// Those of a specification's; and both of `X0` and `ball`.
pub fn read_with_ball(
    value: &Value<'_>,
    names: &Definitions,
    stateless: bool,
    errors: &mut Errors,
) -> Result<(InitialSet, Option<Constant>), Reported> {
    read_kinds(value, (true, stateless), names, errors)
}

fn read_kinds(
    value: &Value<'_>,
    (balls, stateless): (bool, bool),
    names: &Definitions,
    errors: &mut Errors,
) -> Result<(InitialSet, Option<Constant>), Reported> {
    let help = format!("write `{{ \"kind\": \"{}\" }}`", value.text().map_or("aligned".into(), shown));
    let mut object = value.object_or(&help, errors)?;
    let kind = object.required("kind", errors);
    // Without a kind the other fields have no meaning to check.
    let kind =
        kind.and_then(|value| choose(&value, "kind of initial set", &["paper", "at-rest", "aligned", "box"], errors))?;
    let ball = if balls && kind != "paper" { optional(&mut object, "ball", names, errors)? } else { None };
    if let (Some(_), Some(x0)) = (&ball, value.member("X0")) {
        let error = x0.error(ErrorKind::UnknownField, "`X0` and `ball` both say how far x may be from its orbit");
        return Err(errors.report(error.help("leave one of them out")));
    }
    if kind == "aligned"
        && let Some(z0) = value.member("Z0")
    {
        let error =
            z0.error(ErrorKind::UnknownField, "an aligned start has no `Z0`: the regulator sets z = M e itself");
        return Err(errors.report(error.help("leave it out, or ask for the kind `box`")));
    }
    let set = match kind {
        "paper" => {
            object.finish_as("for the kind `paper`", errors);
            InitialSet::Paper
        }
        "at-rest" | "aligned" => {
            let x0 = optional(&mut object, "X0", names, errors);
            let e0 = optional(&mut object, "E0", names, errors);
            object.finish_as(&format!("for the kind `{kind}`"), errors);
            let (x0, e0) = (ball.clone().or(x0?), e0?);
            if kind == "aligned" { InitialSet::Aligned { x0, e0 } } else { InitialSet::AtRest { x0, e0 } }
        }
        _ => {
            // Without states there is no x to bound.
            let none = if stateless && ball.is_none() { optional(&mut object, "X0", names, errors) } else { Ok(None) };
            let x0 = match &ball {
                Some(ball) => Ok(ball.clone()),
                None if stateless => none.map(|x0| x0.unwrap_or_else(|| Constant::rational(&Rational::new()))),
                None if balls => match object.optional("X0") {
                    Some(x0) => nonnegative_constant_in(&x0, names, errors),
                    None => Err(errors.report(object.missing("ball").help(BALL))),
                },
                None => required(&mut object, ("X0", "`X0` bounds |x| at the start"), names, errors),
            };
            let e0 = required(&mut object, ("E0", "`E0` bounds |e| at the start"), names, errors);
            let z0 = required(&mut object, ("Z0", Z_0), names, errors);
            object.finish_as("for the kind `box`", errors);
            InitialSet::Box { x0: x0?, e0: e0?, z0: z0? }
        }
    };
    Ok((set, ball))
}

fn required(
    object: &mut Object<'_>,
    (name, help): (&'static str, &str),
    names: &Definitions,
    errors: &mut Errors,
) -> Result<Constant, Reported> {
    object.required_or(name, help, errors).and_then(|value| nonnegative_constant_in(&value, names, errors))
}

fn optional(
    object: &mut Object<'_>,
    name: &'static str,
    names: &Definitions,
    errors: &mut Errors,
) -> Result<Option<Constant>, Reported> {
    object.optional(name).map(|value| nonnegative_constant_in(&value, names, errors)).transpose()
}
