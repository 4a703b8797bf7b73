//! The numbers that may be tuned: what they are called, where they stand, and between which ends they are sought.

use super::ranges::{given, usual};
use rug::Rational;
use sigmastar_exact::number::Portable;
use sigmastar_lang::spec::{Document, Errors, InternalModel, SpecErrors, Weights, any_constant, nearest};
use thiserror::Error;

/// The most numbers that are tuned together.
const MAX_PARAMETERS: usize = 8;

/// A number that is tuned.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// What flags and reports call it.
    pub name: String,
    /// The JSON pointer (RFC 6901) of its value.
    pub pointer: String,
    /// The value as it is written.
    pub written: String,
    /// The ends between which it is sought, both positive.
    pub range: [Rational; 2],
    /// The logarithm of a double near the value, brought into the range.
    pub(super) start: f64,
}

impl Parameter {
    /// The logarithms of the ends.
    pub(crate) fn logarithms(&self) -> [f64; 2] {
        self.range.each_ref().map(|end| end.to_f64().portable_ln())
    }
}

/// Why numbers cannot be tuned.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum TuneError {
    /// No number of this name is free.
    #[error("`{name}` is no number that can be tuned here")]
    Unknown {
        /// What was written.
        name: String,
        /// The nearest that is known.
        near: Option<String>,
        /// All that are.
        known: Vec<String>,
    },
    /// The base frequency is fixed by the period.
    #[error("the base frequency is not free: `matched` says that it is 2 pi/period")]
    Matched,
    /// A number without a range of its own needs one.
    #[error("`{name}` has no usual range")]
    NoRange {
        /// The number.
        name: String,
    },
    /// What stands behind `=` is no range.
    #[error("`{text}` is no range for `{name}`")]
    Range {
        /// The number.
        name: String,
        /// What was written.
        text: String,
    },
    /// A number is named twice.
    #[error("`{name}` is named twice")]
    Twice {
        /// The number.
        name: String,
    },
    /// More numbers than are tuned together.
    #[error("more than {MAX_PARAMETERS} numbers are to be tuned together")]
    TooMany,
    /// A parameter of which an interval is given.
    #[error("`{name}` is no single number: an interval of it is given")]
    Interval {
        /// The number.
        name: String,
    },
    /// A value that is no number between the ends that doubles reach.
    #[error("the value {written} of `{name}` is too large or too small to be tuned")]
    Magnitude {
        /// The number.
        name: String,
        /// Its value as it is written.
        written: String,
    },
    /// What is to be smallest is not known of the regulator at samples.
    #[error("of the regulator at samples only the gain itself is tuned")]
    Sampled,
    /// Bounds of the error by the number of oscillators need a matched base frequency.
    #[error("no error is certified for a number of oscillators: the base frequency is not asserted to be 2 pi/period")]
    NotMatched,
}

impl TuneError {
    /// What to do.
    #[must_use]
    pub fn way_out(&self) -> String {
        match self {
            TuneError::Unknown { near: Some(near), .. } => format!("did you mean `{near}`?"),
            TuneError::Unknown { known, .. } => format!("the free numbers are {}", known.join(", ")),
            TuneError::Matched => "leave it out, or set `matched` to false".to_owned(),
            TuneError::NoRange { name } => format!("give one, as in `{name}=5..8`"),
            TuneError::Range { name, .. } => {
                format!("write two positive rational numbers, the smaller one first, as in `{name}=1/10..10`")
            }
            TuneError::Twice { .. } => "leave one of the two out".to_owned(),
            TuneError::TooMany => "name those that matter most".to_owned(),
            TuneError::Interval { name } => format!("state one value of `{name}` to tune it, or leave it out"),
            TuneError::Magnitude { .. } => "use units of time in which it is of ordinary size".to_owned(),
            TuneError::Sampled => "leave --minimise and --error-at out, or the sampling period".to_owned(),
            TuneError::NotMatched => "leave --error-at out".to_owned(),
        }
    }
}

/// The names and pointers of the numbers that are free: of the internal model, and the parameters of a plant. One that has a name
/// of the first goes by `parameters.NAME`.
fn free(document: &Document, model: &InternalModel) -> Vec<(String, String)> {
    let at = |name: &str, place: &str| (name.to_owned(), format!("/internal_model/{place}"));
    let mut all = vec![at("mu", "mu")];
    match &model.weights {
        Weights::Power { .. } => all.extend(["n0", "epsilon"].map(|name| at(name, &format!("weights/{name}")))),
        Weights::Explicit { values, .. } => {
            all.extend((0..values.len()).map(|l| at(&format!("n{l}"), &format!("weights/values/{l}"))));
            all.extend(["coefficient", "exponent"].map(|name| at(name, &format!("weights/tail/{name}"))));
        }
    }
    if !model.matched {
        all.push(at("base_frequency", "base_frequency"));
    }
    let parameters = document.at("/parameters").map(|value| value.to_json());
    for name in parameters.as_ref().and_then(serde_json::Value::as_object).into_iter().flat_map(|all| all.keys()) {
        let taken = name == "base_frequency" || all.iter().any(|(known, _)| known == name);
        let shown = if taken { format!("parameters.{name}") } else { name.clone() };
        all.push((shown, format!("/parameters/{name}")));
    }
    all
}

/// Reads what is to be tuned: names separated by commas, each with a range behind `=` or with its usual one.
///
/// # Errors
/// The first name or range that is wrong.
pub fn parameters(text: &str, document: &Document, model: &InternalModel) -> Result<Vec<Parameter>, TuneError> {
    let free = free(document, model);
    let mut all: Vec<Parameter> = Vec::new();
    for part in text.split(',').map(str::trim) {
        let (name, range) =
            part.split_once('=').map_or((part, None), |(name, range)| (name.trim(), Some(range.trim())));
        let parameter = parameter(name, range, document, &free)?;
        if all.iter().any(|other| other.name == parameter.name) {
            return Err(TuneError::Twice { name: parameter.name });
        }
        all.push(parameter);
        if all.len() > MAX_PARAMETERS {
            return Err(TuneError::TooMany);
        }
    }
    Ok(all)
}

/// The document with these values of the parameters, in their order, and nothing else changed.
///
/// # Errors
/// A document that is too large with them.
pub fn with_values(document: &Document, parameters: &[Parameter], values: &[String]) -> Result<Document, SpecErrors> {
    let mut places: Vec<_> = parameters
        .iter()
        .zip(values)
        // What stays as it is keeps its notation.
        .filter(|(parameter, value)| **value != parameter.written)
        .filter_map(|(parameter, value)| Some((document.at(&parameter.pointer)?.span(), value)))
        .collect();
    places.sort_by_key(|(span, _)| span.start);
    let mut text = document.text().to_owned();
    // From the end, so that what comes before stays where it is.
    for (span, value) in places.into_iter().rev() {
        // A string in every notation.
        text.replace_range(span, &format!("\"{value}\""));
    }
    Document::parse_as(document.label(), &text, document.notation())
}

fn parameter(
    name: &str,
    range: Option<&str>,
    document: &Document,
    free: &[(String, String)],
) -> Result<Parameter, TuneError> {
    let known = || free.iter().map(|(name, _)| name.as_str());
    let Some((_, pointer)) = free.iter().find(|(known, _)| known == name) else {
        if name == "base_frequency" {
            return Err(TuneError::Matched);
        }
        let near = nearest(name, known()).map(str::to_owned);
        return Err(TuneError::Unknown { name: name.to_owned(), near, known: known().map(str::to_owned).collect() });
    };
    let name = name.to_owned();
    // The reader has read a constant there.
    let value = document.at(pointer).unwrap_or_else(|| document.root());
    if value.type_name() == "an object" {
        return Err(TuneError::Interval { name });
    }
    let written = value.text().or_else(|| value.numeral()).unwrap_or_default().to_owned();
    let constant = any_constant(&value, &mut Errors::new()).ok().map_or(f64::NAN, |constant| constant.to_f64());
    if !(1e-100..=1e100).contains(&constant) {
        return Err(TuneError::Magnitude { name, written });
    }
    let range = match range {
        Some(text) => given(text).ok_or_else(|| TuneError::Range { name: name.clone(), text: text.to_owned() })?,
        // What a parameter of a plant may be, its owner knows.
        None => Some(pointer)
            .filter(|pointer| !pointer.starts_with("/parameters/"))
            .and_then(|_| usual(&name, constant))
            .ok_or_else(|| TuneError::NoRange { name: name.clone() })?,
    };
    let [low, high] = range.each_ref().map(|end| end.to_f64().portable_ln());
    let start = constant.portable_ln().clamp(low, high);
    Ok(Parameter { name, pointer: pointer.clone(), written, range, start })
}

#[cfg(test)]
mod tests {
    use super::*;
    use sigmastar_exact::number::write_exact;
    use sigmastar_lang::plant::Plant;
    use sigmastar_lang::spec::Specification;

    const POWER: &str = include_str!("../../../../specs/paper-example.json");
    const EXPLICIT: &str = include_str!("../../../../specs/explicit-weights.json");

    fn read(spec: &str, over: &str) -> Result<Vec<Parameter>, TuneError> {
        let document = Document::parse("spec", spec).unwrap();
        let model = match Specification::from_value(&document.root()) {
            Ok(spec) => spec.internal_model,
            Err(_) => Plant::from_value(&document.root()).unwrap().internal_model,
        };
        parameters(over, &document, &model)
    }

    fn told(spec: &str, over: &str) -> String {
        read(spec, over).map_err(|error| format!("{error}; {}", error.way_out())).unwrap_err()
    }

    #[test]
    fn names_ranges_and_places() {
        let all = read(POWER, "mu, n0 = 3/2..4, epsilon").unwrap();
        let ends: Vec<[String; 2]> = all.iter().map(|one| one.range.each_ref().map(write_exact)).collect();
        assert_eq!(ends, [["0.1", "10"], ["1.5", "4"], ["0.05", "1"]]);
        assert_eq!(all[1].pointer, "/internal_model/weights/n0");
        assert_eq!((all[0].written.as_str(), all[0].start), ("1", 0.0));
        let explicit = read(EXPLICIT, "n0,n3,exponent=5/4..2").unwrap();
        assert_eq!(explicit[1].pointer, "/internal_model/weights/values/3");
        let free = POWER.replace("\"matched\": true", "\"matched\": false");
        assert_eq!(read(&free, "base_frequency=6..7").unwrap().len(), 1);
    }

    #[test]
    fn parameters_of_a_plant_go_by_their_names() {
        let plant = include_str!("../../../../specs/plants/linear.json").replacen(
            "\"states\"",
            "\"parameters\": { \"a\": \"3\", \"mu\": 2, \"b\": { \"nominal\": 2, \"low\": 1, \"high\": 3 } }, \"states\"",
            1,
        );
        assert!(told(&plant, "b=1..3").contains("an interval of it is given; state one value"));
        let all = read(&plant, "a=1..5, parameters.mu=1/2..3, mu").unwrap();
        let places: Vec<&str> = all.iter().map(|one| one.pointer.as_str()).collect();
        assert_eq!(places, ["/parameters/a", "/parameters/mu", "/internal_model/mu"]);
        assert_eq!(all[0].written, "3");
        assert!(told(&plant, "a").contains("`a=5..8`"));
        assert!(told(&plant, "friction").contains("the free numbers are mu, n0, epsilon, a, parameters.mu, b"));
    }

    #[test]
    fn what_is_wrong_is_told_with_what_would_be_right() {
        for (spec, over, said) in [
            (POWER, "nu", "`nu` is no number that can be tuned here; did you mean `mu`?"),
            (POWER, "epsilom", "did you mean `epsilon`?"),
            (POWER, "alpha", "the free numbers are mu, n0, epsilon"),
            (POWER, "", "the free numbers are mu, n0, epsilon"),
            (POWER, "exponent", "the free numbers are"),
            (EXPLICIT, "n4", "did you mean"),
            (POWER, "base_frequency=1..2", "`matched` says that it is 2 pi/period"),
            (POWER, "mu,mu", "named twice"),
            (POWER, "mu=", "`mu=1/10..10`"),
            (POWER, "mu=1", "`mu=1/10..10`"),
            (POWER, "mu=2..1", "the smaller one first"),
            (POWER, "mu=0..1", "two positive"),
            (POWER, "mu=1..pi", "rational"),
        ] {
            let told = told(spec, over);
            assert!(told.contains(said), "{over}: {told}");
        }
        let free = POWER.replace("\"matched\": true", "\"matched\": false");
        assert!(told(&free, "base_frequency").contains("`base_frequency=5..8`"));
        let many = EXPLICIT
            .replace(r#"["2", "1", "0.4", "0.22"]"#, r#"["2", "1", "1/4", "1/9", "1/16", "1/25", "1/36"]"#)
            .replace("\"exponent\": \"3/2\"", "\"exponent\": \"2\"");
        let all = "mu,n0,n1,n2,n3,n4,n5,n6";
        assert_eq!(read(&many, all).unwrap().len(), MAX_PARAMETERS);
        assert!(told(&many, &format!("{all},coefficient")).contains("more than 8 numbers"));
        let huge = POWER.replace("\"mu\": \"1\"", "\"mu\": \"1e200\"");
        assert!(told(&huge, "mu").contains("too large or too small"));
    }
}
