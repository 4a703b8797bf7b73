//! From a document to a plant.

use super::{Initial, InitialRegulator, Plant, periodicity};
use crate::expr::{Definitions, Phase, PlantExpr, PlantNames, Program};
use crate::spec::{
    Actuator, Constant, Document, Domain, ErrorKind, Errors, InitialSet, InputGain, Parameters, Period, Reported,
    SpecErrors, Value, any_constant_in, positive_constant_in, read_actuator, read_disturbances, read_input_gain,
    read_internal_model, read_parameters, read_period, read_with_ball, rounded_from,
};
use rug::Rational;

/// The `format` of a plant file.
pub const FORMAT: &str = "sigmastar/plant";

/// The members in which a parameter may be used.
const WITH_PARAMETERS: [&str; 9] =
    ["period", "f", "q", "initial", "initial_set", "domain", "internal_model", "input_gain", "actuator"];

/// The versions of it that are read.
pub const VERSIONS: [u64; 1] = [1];

impl Plant {
    /// Reads a plant from the text of its file; `label` is what errors call it, usually its path.
    ///
    /// # Errors
    /// Everything that was found wrong, in file order: fields, expressions, lists of different lengths, a right side
    /// that is not periodic with the stated period.
    pub fn from_json(label: &str, text: &str) -> Result<Plant, SpecErrors> {
        Document::parse(label, text).and_then(|document| Plant::from_value(&document.root()))
    }

    /// Reads a plant that is a value of a document.
    ///
    /// # Errors
    /// Those of [`Plant::from_json`].
    pub fn from_value(value: &Value<'_>) -> Result<Plant, SpecErrors> {
        value.read(read)
    }
}

fn read(value: &Value<'_>, errors: &mut Errors) -> Result<Plant, Reported> {
    let mut object = value.object(errors)?;
    object.header(FORMAT, &VERSIONS, errors)?;
    let schema = object.schema_reference(errors);
    let name = object.required("name", errors).and_then(|value| value.string(errors).map(str::to_owned));
    let description = object.optional("description").map(|value| value.string(errors).map(str::to_owned)).transpose();
    let names = object.required("states", errors).and_then(|value| read_names(&value, errors));
    let states = names.as_ref().map(|names| names.states().to_vec()).unwrap_or_default();
    let parameters = object.optional("parameters").map(|value| read_parameters(&value, &states, errors)).transpose();
    // Without the parameters no number has a meaning to check.
    let parameters: Parameters = parameters?.unwrap_or_default();
    let constants = parameters.definitions();
    let period = object.required("period", errors).and_then(|value| read_period(&value, constants, errors));
    let f = object.required("f", errors);
    let q = object.required("q", errors);
    let initial = object.optional("initial");
    let stateless = names.as_ref().is_ok_and(|names| names.states().is_empty());
    let initial_set = object.optional("initial_set");
    let initial_set = initial_set.map(|value| read_with_ball(&value, constants, stateless, errors)).transpose();
    let domain = object.optional("domain").map(|value| read_domain(&value, constants, errors)).transpose();
    let internal_model = object.required("internal_model", errors);
    let input_gain =
        object.optional("input_gain").map(|value| read_input_gain(&value, &parameters, errors)).transpose();
    let actuator = object.optional("actuator").map(|value| read_actuator(&value, constants, errors)).transpose();
    let gain_of_middle = match (&input_gain, &actuator) {
        (Ok(gain), Ok(Some(actuator))) if actuator.middle().is_some() => {
            let member = |name| value.member(name);
            gain_of_middle(gain.as_ref(), (member("actuator"), member("input_gain")), constants, errors)
        }
        _ => Ok(None),
    };
    let disturbances = read_disturbances(&mut object, errors);
    object.finish(errors);
    // Without the names of the states the right sides have no meaning to check, and the rest has.
    let names = match names {
        Ok(names) => names.with_parameters(constants.clone()),
        Err(reported) => {
            let model = internal_model;
            drop(model.and_then(|value| read_internal_model(&value, period.as_ref().ok(), constants, errors)));
            return Err(reported);
        }
    };
    // Where the period is wrong that alone is told, and no division by it.
    let one = Constant::rational(&Rational::from(1));
    let names = names.with_phase(period.as_ref().map_or_else(|_| Phase::new(&one.expr, true), Period::phase));
    let f = f.and_then(|value| {
        let elements = of_length(&value, names.states().len(), "right sides", errors)?;
        Ok((elements, value.each(errors, |value, errors| expression(value, &names, errors))?))
    });
    let q = q.and_then(|value| expression(&value, &names, errors).map(|q| (value, q)));
    // A period that is not that of the formulas would be held against the base frequency, which may be right.
    let broken = match (&f, &q, &period) {
        (Ok((_, f)), Ok((_, q)), Ok(period)) => {
            let right_sides: Vec<&PlantExpr> = f.iter().chain([q]).collect();
            let nominal = parameters.clone().with_clock(period.clock()).nominal();
            let nominal: Vec<f64> = nominal.iter().map(Rational::to_f64).collect();
            let program = Program::values(&right_sides, f.len()).with_parameters(&nominal);
            periodicity::counterexample(program, f.len(), period.nominal())
        }
        _ => None,
    };
    let periodic = match (&broken, &f, &q) {
        (Some(broken), Ok((f_values, f)), Ok((q_value, q))) => {
            let (value, expr) = f_values.get(broken.index).zip(f.get(broken.index)).unwrap_or((q_value, q));
            let period = period.as_ref();
            let first = period.ok().and_then(|period| periodicity::decide(expr, broken.index, period.nominal()).err());
            let length = value.text().or_else(|| value.numeral()).map_or(0, str::len);
            let span = first.as_ref().map_or(0..length, |first| first.span.clone());
            let first = first
                .map_or_else(String::new, |first| format!("; the first part that is not seen to have it is {first}"));
            let message = format!("this is not periodic in t with the stated period: {broken}{first}");
            let error = value.error_in(ErrorKind::Range, &span, message);
            let help = "correct the expression, or state the period of all right sides together";
            let meant = period.ok().and_then(|period| Some((period, rounded_from(period)?)));
            let meant = meant.map_or_else(String::new, |(period, meant)| {
                let stated = &period.nominal().text;
                format!("state the period `\"{meant}\"`, if that is meant: {stated} is a rounded value of it; or ")
            });
            Err(errors.report(error.help(format!("{meant}{help}"))))
        }
        _ => Ok(()),
    };
    let known = period.as_ref().ok().filter(|_| broken.is_none());
    let internal_model = internal_model.and_then(|value| read_internal_model(&value, known, constants, errors));
    let states = names.states().len();
    let initial_set = initial_set.map(|set| set.unwrap_or((InitialSet::AtRest { x0: None, e0: None }, None)));
    let aligned = initial_set.as_ref().is_ok_and(|(set, _)| set.is_aligned());
    let initial = match initial {
        Some(value) => read_initial(&value, states, aligned, constants, errors),
        None => Ok(Initial { x: vec![0.0; states], e: 0.0, z: InitialRegulator::AtRest }),
    };
    periodic?;
    let ((_, f), (_, q)) = (f?, q?);
    let actuator = actuator?;
    let middle = actuator.as_ref().and_then(Actuator::middle).zip(gain_of_middle?);
    let q = middle.map_or(q.clone(), |(middle, gain)| q.plus(&middle, &gain));
    let (initial_set, ball) = initial_set?;
    schema?;
    let (document, sha256) = value.embedded();
    let members = WITH_PARAMETERS.map(|name| document.get(name));
    let period = period?;
    let parameters = parameters.used_in(&members.into_iter().flatten().collect::<Vec<_>>()).with_clock(period.clock());
    Ok(Plant {
        name: name?,
        description: description?,
        period,
        names,
        parameters,
        f,
        q,
        initial: initial?,
        initial_set,
        ball,
        domain: domain?,
        internal_model: internal_model?,
        input_gain: input_gain?,
        actuator,
        disturbances: disturbances?,
        document,
        sha256,
        source: value.document().clone(),
        pointer: value.pointer().to_owned(),
    })
}

/// The gain of the actuator as one expression, with which the middle of its range acts on the plant: 1 where none is stated. `None` where there is no value to
/// read it from.
///
/// # Errors
/// Reports a gain of which only ends are stated: which constant between them acts on the middle is the one that acts on u.
fn gain_of_middle(
    gain: Option<&InputGain>,
    (actuator, stated): (Option<Value<'_>>, Option<Value<'_>>),
    constants: &Definitions,
    errors: &mut Errors,
) -> Result<Option<PlantExpr>, Reported> {
    let text = |name| {
        let member = stated.as_ref().and_then(|stated| stated.member(name));
        member.and_then(|value| value.text().or_else(|| value.numeral()).map(|text| text.trim().to_owned()))
    };
    let one_for_all = match gain {
        None => Some("1".to_owned()),
        Some(gain) if gain.is_nominal() && !gain.of_parameters() => text("nominal"),
        Some(_) => text("low").filter(|low| text("high").as_ref() == Some(low)),
    };
    let (Some(actuator), Some(one_for_all)) = (&actuator, one_for_all) else {
        let Some(actuator) = actuator else { return Ok(None) };
        let message =
            "with `min` the gain of the actuator has to be one expression: it acts on the middle of the range, too";
        let help = "make the gain a parameter with an interval, `\"g\": { \"nominal\": ..., \"low\": ..., \"high\": ... }`, and state `\"input_gain\": { \"nominal\": \
                    \"g\", \"low\": \"g\", \"high\": \"g\" }`";
        return Err(errors.report(actuator.error(ErrorKind::Range, message).help(help)));
    };
    let read = PlantExpr::of_parameters(&one_for_all, constants);
    read.map(Some).map_err(|error| errors.report(actuator.expression_error(&error)))
}

fn read_names(value: &Value<'_>, errors: &mut Errors) -> Result<PlantNames, Reported> {
    let elements = value.array(errors)?;
    let read = value.each(errors, |value, errors| value.string(errors).map(str::to_owned))?;
    PlantNames::new(read).map_err(|error| {
        let place = error.index().and_then(|index| elements.get(index)).unwrap_or(value);
        let expected = "expected different names such as x1, other than t, e, pi and the functions";
        let reported = place.error(ErrorKind::UnknownName, error.to_string()).expected(expected);
        errors.report(match in_the_place_of(place.text().unwrap_or_default()) {
            Some(help) => reported.help(help),
            None => reported,
        })
    })
}

/// What to do about a state with the name of what every plant has.
fn in_the_place_of(name: &str) -> Option<String> {
    let meant = match name {
        "e" => {
            "`e` is the error and no state: its derivative is `q` plus the control, so leave it out of `states` and of `f`"
        }
        "t" => "`t` is the time and no state: formulas may have it without more",
        "phase" => "`phase` is 2 pi t / period and no state: formulas may have it without more",
        _ => return None,
    };
    Some(format!("{meant}; if this state is something else, give it another name, as `{name}1`"))
}

/// The elements of an array that has as many as there are states.
fn of_length<'d>(
    value: &Value<'d>,
    length: usize,
    what: &str,
    errors: &mut Errors,
) -> Result<Vec<Value<'d>>, Reported> {
    let elements = value.array(errors)?;
    if elements.len() == length {
        return Ok(elements);
    }
    let message = format!("{} {what} for {length} states", elements.len());
    Err(errors.report(value.error(ErrorKind::Range, message).expected("expected one for each state")))
}

fn expression(value: &Value<'_>, names: &PlantNames, errors: &mut Errors) -> Result<PlantExpr, Reported> {
    let Some(text) = value.numeral().or_else(|| value.text()) else {
        return Err(value.wrong_type("a number or a string with an expression in t, the states and e", errors));
    };
    PlantExpr::parse(text, names).map_err(|error| errors.report(value.expression_error(&error)))
}

/// Where the model holds: `x` and `e`.
fn read_domain(value: &Value<'_>, constants: &Definitions, errors: &mut Errors) -> Result<Domain, Reported> {
    let help = "write `{ \"x\": \"10\", \"e\": \"10\" }`: how far from the orbit, and from e = 0, the formulas hold";
    let mut object = value.object_or(help, errors)?;
    let mut end = |name, help| {
        object.required_or(name, help, errors).and_then(|value| positive_constant_in(&value, constants, errors))
    };
    let x = end("x", "`x` says how far from the orbit the formulas hold: |x - x_0| <= x");
    let e = end("e", "`e` says how far the formulas hold: |e| <= e");
    object.finish(errors);
    Ok(Domain { x: x?, e: e? })
}

/// Reads `initial`; `aligned` says that the regulator sets z = M e.
fn read_initial(
    value: &Value<'_>,
    states: usize,
    aligned: bool,
    constants: &Definitions,
    errors: &mut Errors,
) -> Result<Initial, Reported> {
    let mut object = value.object(errors)?;
    let x = object.required("x", errors).and_then(|value| {
        of_length(&value, states, "initial values", errors)?;
        value.each(errors, |value, errors| double(value, constants, errors))
    });
    let e = object.required("e", errors).and_then(|value| double(&value, constants, errors));
    let z = match object.optional("z") {
        None if aligned => Ok(InitialRegulator::Aligned),
        None => Ok(InitialRegulator::AtRest),
        Some(value) if aligned => {
            let message = "the regulator sets z itself: the kind of `initial_set` is `aligned`";
            let error = value.error(ErrorKind::UnknownField, message);
            Err(errors.report(error.help("leave `z` out, or ask for another kind of initial set")))
        }
        Some(value) => {
            value.each(errors, |value, errors| double(value, constants, errors)).map(InitialRegulator::Given)
        }
    };
    object.finish(errors);
    Ok(Initial { x: x?, e: e?, z: z? })
}

/// A constant that is a finite double.
fn double(value: &Value<'_>, constants: &Definitions, errors: &mut Errors) -> Result<f64, Reported> {
    let number =
        any_constant_in(value, constants, errors).as_ref().map(Constant::to_f64).map_err(|reported| *reported)?;
    if number.is_finite() {
        return Ok(number);
    }
    Err(errors.report(value.error(ErrorKind::Range, "this number is beyond double precision")))
}
