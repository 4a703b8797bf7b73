//! From a document to a specification.

use super::actuator::read_symmetric;
use super::bound::{Bound, Role};
use super::bounding::Bounds;
use super::constant::{
    any_constant, expression, nonnegative_constant, not_in_order, positive_constant, positive_constant_in, whole,
};
use super::disturbances::read_disturbances;
use super::document::{Document, Value};
use super::error::{ErrorKind, Errors, Reported, SpecError, SpecErrors};
use super::initial_set;
use super::input_gain::read_input_gain;
use super::meant::{in_another_unit, matched_frequency, rounded_from};
use super::model::{InternalModel, LyapunovSource, Specification};
use super::object::Object;
use super::parameters::Parameters;
use super::parts::{Constant, Domain, KnownForcing, Lyapunov, RelativeDegree};
use super::period::{Period, needs_exact_period, read_period};
use super::quantity::Quantity;
use super::sampling::read_delay;
use super::{oscillators, sampling, weights_read};
use crate::expr::{Definitions, Expr, Monomial, Variables};
use rug::Rational;
use sigmastar_exact::enclosure::Truth;
use sigmastar_exact::number::write_exact;
use std::ops::Range;

/// The `format` of a specification.
pub const FORMAT: &str = "sigmastar/bounding-spec";

/// The versions of it that are read.
pub const VERSIONS: [u64; 1] = [1];

/// The most coefficients that `relative_degree` may list: up to relative degree 4 the gains from e to xi_1 have formulas.
pub const MAX_RELATIVE_DEGREE_COEFFICIENTS: usize = 3;

/// The most harmonics that `q_0` may list.
pub const MAX_HARMONICS: usize = 200;

impl Specification {
    /// Reads a specification from the text of its file; `label` is what errors call it, usually its path.
    ///
    /// Guarantee: every number is exact or can be enclosed, and is proved to lie in its range; the weights are proved
    /// to satisfy W1-W3; `matched`, where asserted, is proved. Nothing is said about the bounding functions beyond
    /// that they can be read. Never panics, whatever the text.
    ///
    /// # Errors
    /// Everything that was found wrong, in file order. Where nothing is wrong but something could not be decided,
    /// [`SpecErrors::is_undecided`] holds.
    pub fn from_json(label: &str, text: &str) -> Result<Specification, SpecErrors> {
        Document::parse(label, text).and_then(|document| Specification::from_value(&document.root()))
    }

    /// Reads a specification that is a value of a document, such as the copy in a certificate; pointers and places
    /// are those of the whole document, the digest is that of the value.
    ///
    /// # Errors
    /// Those of [`Specification::from_json`].
    pub fn from_value(value: &Value<'_>) -> Result<Specification, SpecErrors> {
        value.read(read)
    }

    /// Errors found after reading, in a string of the specification: `field` is its pointer inside the specification
    /// (`/bounds/q`), `part` the bytes of the decoded text at fault.
    #[must_use]
    pub fn errors_at(
        &self,
        field: &str,
        part: &Range<usize>,
        kind: ErrorKind,
        message: impl Into<String>,
        help: Option<String>,
    ) -> SpecErrors {
        self.source.errors_at(&format!("{}{field}", self.pointer), part, kind, message, help)
    }
}

fn read(value: &Value<'_>, errors: &mut Errors) -> Result<Specification, Reported> {
    let mut object = value.object(errors)?;
    object.header(FORMAT, &VERSIONS, errors)?;
    let schema = object.schema_reference(errors);
    let name = object.required("name", errors).and_then(|value| value.string(errors).map(str::to_owned));
    let description = object.optional("description").map(|value| value.string(errors).map(str::to_owned)).transpose();
    let period = object.required("period", errors).and_then(|value| read_period(&value, Definitions::none(), errors));
    let lyapunov =
        object.required("lyapunov", errors).and_then(|value| read_lyapunov(&value, period.as_ref().ok(), errors));
    let bounds = object.required("bounds", errors).and_then(|value| read_bounds(&value, errors));
    let q_0 = object.optional("q_0").map(|value| read_forcing(&value, errors)).transpose();
    let domain = object.optional("domain").map(|value| read_domain(&value, errors)).transpose();
    let internal_model = object
        .required("internal_model", errors)
        .and_then(|value| read_internal_model(&value, period.as_ref().ok(), Definitions::none(), errors));
    let initial_set = object.required("initial_set", errors).and_then(|value| initial_set::read(&value, errors));
    let input_gain =
        object.optional("input_gain").map(|value| read_input_gain(&value, &Parameters::default(), errors)).transpose();
    let actuator = object.optional("actuator").map(|value| read_symmetric(&value, errors)).transpose();
    let disturbances = read_disturbances(&mut object, errors);
    let relative_degree =
        object.optional("relative_degree").map(|value| read_relative_degree(&value, errors)).transpose();
    object.finish(errors);
    schema?;
    let (lyapunov, rate) = lyapunov?;
    let (document, sha256) = value.embedded();
    Ok(Specification {
        name: name?,
        description: description?,
        period: period?,
        lyapunov,
        bounds: bounds?.with_rate(rate),
        q_0: q_0?,
        domain: domain?,
        internal_model: internal_model?,
        initial_set: initial_set?,
        input_gain: input_gain?,
        actuator: actuator?,
        disturbances: disturbances?,
        relative_degree: relative_degree?,
        document,
        sha256,
        source: value.document().clone(),
        pointer: value.pointer().to_owned(),
    })
}

/// The triple or the Jacobian, and the contraction rate that may stand next to a triple.
fn read_lyapunov(
    value: &Value<'_>,
    period: Option<&Period>,
    errors: &mut Errors,
) -> Result<(LyapunovSource, Option<Expr>), Reported> {
    let mut object = value.object(errors)?;
    if value.member("jacobian").is_some() {
        let jacobian =
            object.required("jacobian", errors).and_then(|value| super::jacobian::read(&value, period, errors));
        object.finish_as("next to a Jacobian", errors);
        return jacobian.map(|jacobian| (LyapunovSource::Wanted(jacobian), None));
    }
    let p_low = positive_field(&mut object, "p_low", errors);
    let p_up = object.required("p_up", errors).and_then(|value| {
        let p_up = positive_constant(&value, errors)?;
        if let Ok(p_low) = &p_low
            && let Some(error) = not_in_order(&value, ("p_low", p_low), "<=", ("p_up", &p_up))
        {
            let expected = format!("expected at least {}", Quantity::constant(p_low).shown());
            return Err(errors.report(error.expected(expected)));
        }
        Ok(p_up)
    });
    let alpha = positive_field(&mut object, "alpha", errors);
    let rate = object.optional(Bound::Rate.field()).map(|value| bounding_function(&value, errors)).transpose();
    object.finish(errors);
    Ok((LyapunovSource::Given(Lyapunov { p_low: p_low?, p_up: p_up?, alpha: alpha? }), rate?))
}

fn read_bounds(value: &Value<'_>, errors: &mut Errors) -> Result<Bounds, Reported> {
    let mut object = value.object(errors)?;
    let read = |bound: Bound| match bound.role() {
        Role::Required => {
            object.required(bound.field(), errors).and_then(|value| bounding_function(&value, errors)).map(Some)
        }
        Role::Rate | Role::ProvedRate => Ok(None),
        Role::Sharper(_) | Role::OneSided(_) | Role::Optional => {
            object.optional(bound.field()).map(|value| bounding_function(&value, errors)).transpose()
        }
    };
    // All of them are read before the first error ends it.
    let all: Vec<Result<_, Reported>> = Bound::ALL.into_iter().map(read).collect();
    object.finish(errors);
    Ok(Bounds::given(all.into_iter().collect::<Result<_, _>>()?))
}

fn bounding_function(value: &Value<'_>, errors: &mut Errors) -> Result<Expr, Reported> {
    expression(value, Variables::XAndE, "a number or a string with an expression in X and E", errors)
}

fn read_forcing(value: &Value<'_>, errors: &mut Errors) -> Result<KnownForcing, Reported> {
    let mut object = value.object(errors)?;
    let harmonics = object.required("harmonics", errors).and_then(|value| {
        let elements = value.array(errors)?;
        if elements.is_empty() || elements.len() > MAX_HARMONICS {
            let message = format!("`harmonics` lists {} bounds", elements.len());
            let expected = format!("expected 1 to {MAX_HARMONICS} bounds of |c_0|, |c_1|, ...");
            return Err(errors.report(value.error(ErrorKind::Range, message).expected(expected)));
        }
        value.each(errors, nonnegative_constant)
    });
    let rest_rms = object.required("rest_rms", errors).and_then(|value| nonnegative_constant(&value, errors));
    let rest_t_rms = object.optional("rest_t_rms").map(|value| nonnegative_constant(&value, errors)).transpose();
    object.finish(errors);
    Ok(KnownForcing { harmonics: harmonics?, rest_rms: rest_rms?, rest_t_rms: rest_t_rms? })
}

fn read_domain(value: &Value<'_>, errors: &mut Errors) -> Result<Domain, Reported> {
    let help =
        "write `{ \"X\": \"10\", \"E\": \"10\" }`: how far from 0 the norm of x and |e| may be where the bounds hold";
    let mut object = value.object_or(help, errors)?;
    let x = positive_field(&mut object, "X", errors);
    let e = positive_field(&mut object, "E", errors);
    object.finish(errors);
    Ok(Domain { x: x?, e: e? })
}

/// The regulator's part of a specification or a plant; `period`, where it was read, is held against the base frequency. In mu, the
/// base frequency and the sampling period the names may stand.
///
/// # Errors
/// Reports fields that are missing or unknown and numbers that are out of range.
pub fn read_internal_model(
    value: &Value<'_>,
    period: Option<&Period>,
    names: &Definitions,
    errors: &mut Errors,
) -> Result<InternalModel, Reported> {
    let mut object = value.object(errors)?;
    let mu = object.required("mu", errors).and_then(|value| positive_constant_in(&value, names, errors));
    let frequency_value = object.required("base_frequency", errors);
    let base_frequency = frequency_value.clone().and_then(|value| positive_constant_in(&value, names, errors));
    let matched = match object.optional("matched") {
        Some(value) => value.boolean(errors),
        None => Ok(false),
    };
    let weights = object.required("weights", errors).and_then(|value| weights_read::read(&value, errors));
    let harmonics =
        object.optional("harmonics").map(|value| oscillators::read_asked(&value, period, errors)).transpose();
    let step = object.optional("sampling_period");
    let delay = object.optional("delay_samples");
    let delayed = delay.as_ref().map_or(Ok(false), |value| read_delay(value, errors));
    if let (None, Some(delay)) = (&step, &delay) {
        let error = delay.error(ErrorKind::MissingField, "`delay_samples` is of the regulator at samples");
        let help = "give `sampling_period` beside it, or leave it out";
        errors.report(error.expected("expected `sampling_period` beside it").help(help));
    }
    object.finish(errors);
    if let (Ok(true), Some(period), Ok(value), Ok(frequency)) = (matched, period, &frequency_value, &base_frequency) {
        let help = "set `matched` to false: the claim then has what the mistuned oscillators still do";
        needs_exact_period(period, value, "`matched` asserts base_frequency = 2 pi / period", help, errors)?;
        prove_matched(period, frequency, value, errors)?;
    }
    let sampling = match (step, period) {
        (Some(step), Some(period)) => {
            let help = "leave `sampling_period` out, or state a period that is known exactly";
            needs_exact_period(
                period,
                &step,
                "the regulator at samples has a whole number of them in a period",
                help,
                errors,
            )?;
            Some(sampling::read((&step, delayed?), period.nominal(), matched, names, errors)?)
        }
        _ => None,
    };
    Ok(InternalModel {
        mu: mu?,
        base_frequency: base_frequency?,
        matched: matched?,
        weights: weights?,
        harmonics: harmonics?,
        sampling,
    })
}

/// Proves base_frequency * period = 2 pi. Close is not enough: the consequences of a matched frequency (vanishing
/// harmonics, exact regulation) fail for every other one.
fn prove_matched(
    stated: &Period,
    frequency: &Constant,
    value: &Value<'_>,
    errors: &mut Errors,
) -> Result<(), Reported> {
    let period = stated.nominal();
    let product = Quantity::constant(frequency).times(Quantity::constant(period));
    let two_pi = Quantity::exact(Monomial::pi()).times(Quantity::rational(2));
    let right = matched_frequency(period);
    let error = match product.equals(&two_pi) {
        Truth::True => return Ok(()),
        Truth::False => {
            let (product, two_pi) = product.shown_apart(&two_pi);
            let message = format!(
                "`matched` asserts base_frequency = 2 pi / period, but base_frequency * period = {product} and \
                 2 pi = {two_pi}"
            );
            whole(value, ErrorKind::Matched, message).expected(format!("`{right}` would be right"))
        }
        Truth::Undecided => {
            let message = "`matched` asserts base_frequency = 2 pi / period, which cannot be proved exactly";
            whole(value, ErrorKind::Undecided, message).expected(format!("write it in multiples of pi, as `{right}`"))
        }
    };
    if let Some(unit) = in_another_unit(frequency, period) {
        let help = format!(
            "this is about {unit}; the base frequency is in radians per unit of time, 2*pi/period, which is `{right}`"
        );
        return Err(errors.report(error.help(help)));
    }
    let own = frequency.exact.as_ref().and_then(|frequency| Monomial::pi().div(frequency));
    let own = own.and_then(|half| half.as_rational().map(|half| write_exact(&Rational::from(half * 2))));
    // The base frequency has the exact number: it is the period that is to be corrected.
    if let Some(own) = own.as_ref().filter(|own| rounded_from(stated).as_ref() == Some(own)) {
        return Err(errors.report(of_rounded_period(error, period, (own, &right))));
    }
    let own = own.map_or_else(String::new, |own| format!("state the period of this base frequency, {own}, or "));
    Err(errors.report(error.help(format!("or {own}set `matched` to false: the gain does not need it"))))
}

/// What to do about a base frequency that is matched to the fraction of which the period is a rounded value.
fn of_rounded_period(error: SpecError, period: &Constant, (own, right): (&str, &str)) -> SpecError {
    error.expected("expected 2 pi / period").help(format!(
        "state the period `{own}`, of which {} is a rounded value; or keep this period, with the base frequency `{right}`; or set `matched` to false: the \
         gain does not need it",
        period.text
    ))
}

fn read_relative_degree(value: &Value<'_>, errors: &mut Errors) -> Result<RelativeDegree, Reported> {
    let mut object = value.object(errors)?;
    let a = object.required("a", errors).and_then(|value| {
        let elements = value.array(errors)?;
        if elements.is_empty() || elements.len() > MAX_RELATIVE_DEGREE_COEFFICIENTS {
            let message = format!("`a` lists {} coefficients", elements.len());
            let expected = format!("expected 1 to {MAX_RELATIVE_DEGREE_COEFFICIENTS} coefficients a_1, ..., a_(r-1): relative degree 2 to 4");
            return Err(errors.report(value.error(ErrorKind::Range, message).expected(expected)));
        }
        value.each(errors, rational)
    });
    object.finish(errors);
    Ok(RelativeDegree { a: a? })
}

fn rational(value: &Value<'_>, errors: &mut Errors) -> Result<Constant, Reported> {
    let constant = any_constant(value, errors)?;
    if constant.as_rational().is_some() {
        return Ok(constant);
    }
    let error = whole(value, ErrorKind::Range, "this coefficient is not known to be rational")
        .expected("expected a rational number, as in \"3/7\" or 0.5");
    Err(errors.report(error))
}

fn positive_field(object: &mut Object<'_>, name: &'static str, errors: &mut Errors) -> Result<Constant, Reported> {
    object.required(name, errors).and_then(|value| positive_constant(&value, errors))
}
