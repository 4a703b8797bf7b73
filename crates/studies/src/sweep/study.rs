//! The study file: what is varied, and how.

use super::design::{Combinations, Design};
use super::parameter::Parameter;
use super::values::{read_count, too_near};
use super::{MAX_CASES, MAX_PARAMETERS};
use sigmastar_lang::spec::{
    Document, ErrorKind, Errors, Object, Reported, SpecErrors, Value, choose, positive_constant,
};

/// The format of a study.
pub const FORMAT: &str = "sigmastar/study";

/// The versions that are read.
pub const VERSIONS: [u64; 1] = [1];

/// What is varied.
#[derive(Clone, Debug)]
pub enum SubjectSource {
    /// The path of a specification or plant, relative to the study.
    Path(String),
    /// A specification or plant inside the study.
    Embedded(serde_json::Value),
}

/// A study as it is read.
#[derive(Clone, Debug)]
pub struct Study {
    /// The name, free text.
    pub name: String,
    /// What is varied.
    pub subject: SubjectSource,
    /// The parameters, at least one.
    pub parameters: Vec<Parameter>,
    /// How their values are combined.
    pub design: Design,
    /// The sampling period of every case, where the regulator at samples is asked for: an exact constant as it is written.
    pub sampling_period: Option<String>,
    /// The document, for errors that are found later.
    pub source: Document,
    pub(super) combinations: Combinations,
}

impl Study {
    /// Reads a study. The cases are counted before any value is made.
    ///
    /// # Errors
    /// Everything that is wrong with it, in its place.
    pub fn read(document: &Document) -> Result<Study, SpecErrors> {
        document.root().read(|root, errors| read(root.object(errors)?, document, errors))
    }
}

fn read(mut object: Object<'_>, document: &Document, errors: &mut Errors) -> Result<Study, Reported> {
    object.header(FORMAT, &VERSIONS, errors)?;
    let schema = object.schema_reference(errors);
    let name = object.required("name", errors).and_then(|value| value.string(errors));
    let description = object.optional("description").map(|value| value.string(errors)).transpose();
    let subject = object.required("subject", errors).and_then(|value| subject(&value, errors));
    let derivation =
        object.optional("derivation").map(|value| choose(&value, "derivation", &["sharp"], errors)).transpose();
    let sampling_period = object.optional("sampling_period").map(|value| positive_constant(&value, errors)).transpose();
    let design = design(&mut object, errors);
    let parameters = object.required("parameters", errors);
    object.finish_as("in a study of this design", errors);
    let (design, parameters) = (design?, parameters?);
    let list = self::parameters(&parameters, design, errors)?;
    counted(&parameters, design, &list, errors)?;
    let values: Vec<_> = list.iter().map(|parameter| &parameter.values).collect();
    let combinations = Combinations::new(design, &values).map_err(|index| {
        let place = document.at(&format!("/parameters/{index}"));
        errors.report(too_near(&place.unwrap_or_else(|| document.root())))
    })?;
    description?;
    schema?;
    derivation?;
    Ok(Study {
        name: name?.to_owned(),
        subject: subject?,
        parameters: list,
        design,
        sampling_period: sampling_period?.map(|constant| constant.text),
        source: document.clone(),
        combinations,
    })
}

/// A path, or a document in place.
fn subject(value: &Value<'_>, errors: &mut Errors) -> Result<SubjectSource, Reported> {
    match (value.text(), value.type_name()) {
        (Some(""), _) => Err(errors.report(value.error(ErrorKind::Range, "the path of the subject is empty"))),
        (Some(path), _) => Ok(SubjectSource::Path(path.to_owned())),
        (None, "an object") => Ok(SubjectSource::Embedded(value.to_json())),
        _ => Err(value.wrong_type("the path of a specification or plant, or one in place", errors)),
    }
}

fn design(object: &mut Object<'_>, errors: &mut Errors) -> Result<Design, Reported> {
    let design = object.required("design", errors)?;
    if choose(&design, "design", &["grid", "latin"], errors)? == "grid" {
        return Ok(Design::Grid);
    }
    let count = object.required("count", errors).and_then(|value| read_count(&value, errors));
    let seed = object.required("seed", errors).and_then(|value| value.integer(errors));
    Ok(Design::Latin { count: count?, seed: seed? })
}

fn parameters(value: &Value<'_>, design: Design, errors: &mut Errors) -> Result<Vec<Parameter>, Reported> {
    let elements = value.array(errors)?;
    if elements.is_empty() || elements.len() > MAX_PARAMETERS {
        let error = value.error(ErrorKind::Range, format!("there are {} parameters", elements.len()));
        return Err(errors.report(error.expected(format!("expected 1 to {MAX_PARAMETERS}"))));
    }
    let latin = match design {
        Design::Grid => None,
        Design::Latin { count, .. } => Some(count),
    };
    let list = value.each(errors, |element, errors| Parameter::read(element, latin, errors))?;
    for (index, parameter) in list.iter().enumerate() {
        if list[..index].iter().any(|earlier| earlier.steps() == parameter.steps()) {
            let message = format!("`{}` is the place of another parameter already", parameter.pointer);
            return Err(errors.report(elements[index].error(ErrorKind::Range, message)));
        }
    }
    Ok(list)
}

/// Refuses a grid of too many cases.
fn counted(value: &Value<'_>, design: Design, list: &[Parameter], errors: &mut Errors) -> Result<(), Reported> {
    let cases = list.iter().fold(1_u64, |cases, parameter| cases.saturating_mul(parameter.values.count()));
    if design != Design::Grid || cases <= MAX_CASES {
        return Ok(());
    }
    let shown = if cases == u64::MAX { "too many".to_owned() } else { cases.to_string() };
    let error = value.error(ErrorKind::Limit, format!("the grid has {shown} cases"));
    let error = error.expected(format!("at most {MAX_CASES} cases are run"));
    Err(errors.report(error.help("take fewer values, or the design `latin` with a `count`")))
}
