//! What disturbs the loop beside the plant (derivation, 13.6): noise and steps of the measured e, a disturbance added to q, and the rounding of
//! the arithmetic of the law at samples.

use super::constant::{nonnegative_constant, whole};
use super::document::Value;
use super::error::{ErrorKind, Errors, Reported};
use super::object::{Object, choose};
use super::parts::Constant;
use rug::Rational;
use sigmastar_exact::number::parse_rational;

/// `measurement` and `disturbance`: any measurable signals within these bounds. A bound that is absent is 0. And `arithmetic`.
///
/// They count only in what is said of given numbers of oscillators.
#[derive(Clone, Debug, Default)]
pub struct Disturbances {
    /// The greatest size of the noise on the measurement of e, in the unit of e.
    pub noise: Option<Constant>,
    /// The step of the converter that measures e and rounds to nearest, in the unit of e.
    pub quantum: Option<Constant>,
    /// The greatest size of what is added to q, in the unit of e'.
    pub disturbance: Option<Constant>,
    /// In what the law at samples is computed.
    pub arithmetic: Arithmetic,
}

/// In what the law at samples is computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Arithmetic {
    /// In real numbers: a claim does not count rounding.
    #[default]
    Exact,
    /// In doubles, by the operations of the exported C code.
    Double,
}

/// What words say of a law in doubles.
const IN_DOUBLES: &str = "computed in double precision as exported";

impl Disturbances {
    /// v_bar, `noise + quantum/2`: what is measured is e + v with |v| <= v_bar.
    #[must_use]
    pub fn v_bar(&self) -> Rational {
        exact(self.noise.as_ref()) + exact(self.quantum.as_ref()) / 2
    }

    /// d_bar, the `disturbance`: e' = q + d + u with |d| <= d_bar.
    #[must_use]
    pub fn d_bar(&self) -> Rational {
        exact(self.disturbance.as_ref())
    }

    /// Whether something disturbs the loop in continuous time: v_bar + d_bar > 0.
    #[must_use]
    pub fn any(&self) -> bool {
        self.v_bar() + self.d_bar() > 0
    }

    /// Whether something disturbs the loop at samples, whose arithmetic may round: v_bar + d_bar > 0, or it computes in doubles.
    #[must_use]
    pub fn any_at_samples(&self) -> bool {
        self.any() || self.in_doubles()
    }

    /// Whether something disturbs the regulator that a claim is about: at samples, or in continuous time, where none computes.
    #[must_use]
    pub fn disturb(&self, at_samples: bool) -> bool {
        if at_samples { self.any_at_samples() } else { self.any() }
    }

    /// Whether the law at samples is computed in doubles.
    #[must_use]
    pub fn in_doubles(&self) -> bool {
        self.arithmetic == Arithmetic::Double
    }

    /// What disturbs the loop at samples, in words.
    #[must_use]
    pub fn in_words_at_samples(&self) -> String {
        let parts =
            [Some(self.in_words()).filter(|words| !words.is_empty()), self.in_doubles().then(|| IN_DOUBLES.to_owned())];
        parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
    }

    /// What disturbs the loop in continuous time, in words; those that are not 0, joined by commas.
    #[must_use]
    pub fn in_words(&self) -> String {
        let some = |constant: &Option<Constant>, before: &str, after: &str| {
            let constant = constant.as_ref().filter(|constant| exact(Some(constant)) != 0)?;
            // A fraction stands apart from what follows.
            let number =
                if constant.text.contains('/') { format!("({})", constant.text) } else { constant.text.clone() };
            Some(format!("{before}{number}{after}"))
        };
        let parts = [
            some(&self.noise, "noise of at most ", " on the measurement of e"),
            some(&self.quantum, "a measurement of e in steps of ", ""),
            some(&self.disturbance, "a disturbance of at most ", " added to q"),
        ];
        parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
    }
}

/// The value of a bound; 0 without one.
fn exact(constant: Option<&Constant>) -> Rational {
    // It was read as a rational number.
    constant.and_then(Constant::as_rational).cloned().unwrap_or_default()
}

/// Takes `measurement`, `disturbance` and `arithmetic` out of a document: rational numbers, not negative, written as a decimal or a fraction,
/// and a word.
///
/// # Errors
/// Reports fields that are unknown, a `measurement` that says nothing, numbers that are of another kind or negative, and an arithmetic that is
/// not the one of the exported code.
pub fn read_disturbances(object: &mut Object<'_>, errors: &mut Errors) -> Result<Disturbances, Reported> {
    let measurement = object.optional("measurement").map(|value| read_measurement(&value, errors)).transpose();
    let disturbance = object.optional("disturbance").map(|value| bound(&value, errors)).transpose();
    let arithmetic = object.optional("arithmetic").map(|value| read_arithmetic(&value, errors)).transpose();
    let (noise, quantum) = measurement?.unwrap_or_default();
    Ok(Disturbances { noise, quantum, disturbance: disturbance?, arithmetic: arithmetic?.unwrap_or_default() })
}

fn read_arithmetic(value: &Value<'_>, errors: &mut Errors) -> Result<Arithmetic, Reported> {
    if value.text() == Some("single") {
        let error =
            value.error(ErrorKind::UnknownName, "the exported code computes in double precision, and so does a claim");
        return Err(errors.report(error.expected("expected `double` or `exact`")));
    }
    Ok(match choose(value, "arithmetic", &["exact", "double"], errors)? {
        "double" => Arithmetic::Double,
        _ => Arithmetic::Exact,
    })
}

fn read_measurement(value: &Value<'_>, errors: &mut Errors) -> Result<(Option<Constant>, Option<Constant>), Reported> {
    let help = "write `{ \"noise\": \"1/100\" }`, `{ \"quantum\": \"1/100\" }`, or both in one object";
    let mut object = value.object_or(help, errors)?;
    let mut field = |name| object.optional(name).map(|value| bound(&value, errors)).transpose();
    let (noise, quantum) = (field("noise"), field("quantum"));
    object.finish(errors);
    match (noise?, quantum?) {
        (None, None) => {
            let message = "`measurement` says nothing of the measurement of e";
            let error = value.error(ErrorKind::MissingField, message);
            Err(errors.report(error.expected("expected `noise`, `quantum` or both in this object")))
        }
        both => Ok(both),
    }
}

/// A rational number that is not negative, as it is written: the words of a claim repeat it.
fn bound(value: &Value<'_>, errors: &mut Errors) -> Result<Constant, Reported> {
    let constant = nonnegative_constant(value, errors)?;
    if parse_rational(&constant.text).is_some() {
        return Ok(constant);
    }
    let error = whole(value, ErrorKind::Range, format!("{} is not written as a rational number", value.name()));
    Err(errors.report(error.expected("expected a decimal or a fraction of whole numbers, as in 0.01 or \"1/300\"")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::Document;

    fn read(text: &str) -> Result<Disturbances, Vec<(ErrorKind, String)>> {
        let document = Document::parse("document", text).unwrap();
        let mut errors = Errors::new();
        let outcome = document.root().object(&mut errors).and_then(|mut object| {
            let read = read_disturbances(&mut object, &mut errors);
            object.finish(&mut errors);
            read
        });
        errors
            .conclude(&document, outcome)
            .map_err(|errors| errors.errors().iter().map(|error| (error.kind, error.pointer.clone())).collect())
    }

    #[test]
    fn bounds_of_the_signals() {
        let all = read(r#"{ "measurement": { "noise": 0.010, "quantum": "1/100" }, "disturbance": "3" }"#).unwrap();
        assert_eq!((all.v_bar(), all.d_bar()), (Rational::from((3, 200)), Rational::from(3)));
        assert!(all.any());
        assert_eq!(
            all.in_words(),
            "noise of at most 0.010 on the measurement of e, a measurement of e in steps of (1/100), a disturbance of at most 3 added to q"
        );
        let quantum = read(r#"{ "measurement": { "noise": 0, "quantum": "1e-3" } }"#).unwrap();
        assert_eq!((quantum.v_bar(), quantum.d_bar()), (Rational::from((1, 2000)), Rational::new()));
        assert_eq!(quantum.in_words(), "a measurement of e in steps of 1e-3");
        for nothing in ["{}", r#"{ "measurement": { "noise": "0" }, "disturbance": 0 }"#] {
            let nothing = read(nothing).unwrap();
            assert!(!nothing.any() && nothing.in_words().is_empty());
        }
    }

    #[test]
    fn rounding_counts_at_samples() {
        let double = read(r#"{ "arithmetic": "double" }"#).unwrap();
        assert!(double.any_at_samples() && !double.any() && double.in_words().is_empty());
        assert_eq!(double.in_words_at_samples(), "computed in double precision as exported");
        let both = read(r#"{ "arithmetic": "double", "disturbance": "3" }"#).unwrap();
        assert_eq!(
            both.in_words_at_samples(),
            "a disturbance of at most 3 added to q, computed in double precision as exported"
        );
        let exact = read(r#"{ "arithmetic": "exact" }"#).unwrap();
        assert!(!exact.any_at_samples() && exact.in_words_at_samples().is_empty());
    }

    #[test]
    fn what_is_no_bound_is_refused() {
        for (wrong, kind, place) in [
            (r#"{ "measurement": {} }"#, ErrorKind::MissingField, "/measurement"),
            (r#"{ "measurement": "1" }"#, ErrorKind::Type, "/measurement"),
            (r#"{ "measurement": { "noise": "1", "v": "1" } }"#, ErrorKind::UnknownField, "/measurement/v"),
            (r#"{ "measurement": { "noise": "-1" } }"#, ErrorKind::Range, "/measurement/noise"),
            (r#"{ "measurement": { "quantum": "1/0" } }"#, ErrorKind::Expression, "/measurement/quantum"),
            (r#"{ "disturbance": "-1/7" }"#, ErrorKind::Range, "/disturbance"),
            (r#"{ "disturbance": "sqrt(4)" }"#, ErrorKind::Range, "/disturbance"),
            (r#"{ "disturbance": "2*3" }"#, ErrorKind::Range, "/disturbance"),
            (r#"{ "disturbance": "+1" }"#, ErrorKind::Range, "/disturbance"),
            (r#"{ "disturbance": "1/2/3" }"#, ErrorKind::Range, "/disturbance"),
            (r#"{ "disturbance": "-1/-2" }"#, ErrorKind::Range, "/disturbance"),
            (r#"{ "disturbance": ".5" }"#, ErrorKind::Range, "/disturbance"),
            (r#"{ "disturbance": "1/3e2" }"#, ErrorKind::Range, "/disturbance"),
            (r#"{ "disturbance": "pi" }"#, ErrorKind::Range, "/disturbance"),
            (r#"{ "disturbance": "x" }"#, ErrorKind::Expression, "/disturbance"),
            (r#"{ "disturbance": null }"#, ErrorKind::Type, "/disturbance"),
            (r#"{ "disturbance": { "max": "1" } }"#, ErrorKind::Type, "/disturbance"),
            (r#"{ "arithmetic": "single" }"#, ErrorKind::UnknownName, "/arithmetic"),
            (r#"{ "arithmetic": "Double" }"#, ErrorKind::UnknownName, "/arithmetic"),
            (r#"{ "arithmetic": true }"#, ErrorKind::Type, "/arithmetic"),
            (r#"{ "arithmetic": null }"#, ErrorKind::Type, "/arithmetic"),
        ] {
            assert_eq!(read(wrong).unwrap_err(), [(kind, place.to_owned())], "{wrong}");
        }
    }
}
