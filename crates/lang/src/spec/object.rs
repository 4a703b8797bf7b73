//! Strict objects: every field is known, required ones are there, and the header says what the file is.

use super::document::Value;
use super::error::{ErrorKind, Errors, Reported, SpecError, list, nearest, shown};
use super::json::Content;

/// The most unknown fields of one object that are reported one by one: a suggestion compares a name with every known
/// one, and nobody reads thousands.
pub const MAX_UNKNOWN: usize = 5;

/// An object that is read field by field. Every field that is asked for counts as known; [`Object::finish`] refuses
/// the others, so a misspelt field can never be silently ignored.
///
/// ```
/// use sigmastar_lang::spec::{Document, Errors, SpecErrors, positive_constant};
///
/// let text = r#"{ "format": "sigmastar/witness", "version": 1, "sigma_star": "97/2" }"#;
/// let document = Document::parse("witness.json", text)?;
/// let mut errors = Errors::new();
/// let outcome = document.root().object(&mut errors).and_then(|mut object| {
///     object.header("sigmastar/witness", &[1], &mut errors)?;
///     let sigma = object.required("sigma_star", &mut errors).and_then(|value| positive_constant(&value, &mut errors));
///     object.finish(&mut errors);
///     sigma
/// });
/// assert_eq!(errors.conclude(&document, outcome)?.to_f64(), 48.5);
/// # Ok::<(), SpecErrors>(())
/// ```
#[derive(Debug)]
#[must_use = "`finish` refuses unknown fields"]
pub struct Object<'d> {
    value: Value<'d>,
    known: Vec<&'static str>,
}

impl<'d> Value<'d> {
    /// The members of an object, to be read field by field.
    ///
    /// # Errors
    /// Reports a value that is not an object.
    pub fn object(&self, errors: &mut Errors) -> Result<Object<'d>, Reported> {
        match self.node.content {
            Content::Object(_) => Ok(Object::new(self.clone())),
            _ => Err(self.wrong_type("an object", errors)),
        }
    }

    /// The same where something else often stands in its place: `help` says what to write.
    ///
    /// # Errors
    /// Reports a value that is not an object.
    pub fn object_or(&self, help: &str, errors: &mut Errors) -> Result<Object<'d>, Reported> {
        match self.node.content {
            Content::Object(_) => Ok(Object::new(self.clone())),
            _ => {
                let error = self.error(ErrorKind::Type, format!("{} is {}", self.name(), self.type_name()));
                Err(errors.report(error.expected("expected an object").help(help)))
            }
        }
    }
}

impl<'d> Object<'d> {
    fn new(value: Value<'d>) -> Object<'d> {
        Object { value, known: Vec::new() }
    }

    /// A field that may be absent.
    pub fn optional(&mut self, name: &'static str) -> Option<Value<'d>> {
        self.known.push(name);
        self.value.member(name)
    }

    /// A field that must be there.
    ///
    /// # Errors
    /// Reports a missing field.
    pub fn required(&mut self, name: &'static str, errors: &mut Errors) -> Result<Value<'d>, Reported> {
        self.optional(name).ok_or_else(|| errors.report(self.missing(name)))
    }

    /// The same with what the field says, for one whose name does not.
    ///
    /// # Errors
    /// Reports a missing field, with this help.
    pub fn required_or(&mut self, name: &'static str, help: &str, errors: &mut Errors) -> Result<Value<'d>, Reported> {
        self.optional(name).ok_or_else(|| errors.report(self.missing(name).help(help)))
    }

    /// That a field is missing.
    pub(super) fn missing(&self, name: &str) -> SpecError {
        SpecError::new(
            ErrorKind::MissingField,
            format!("{}/{name}", self.value.pointer()),
            self.value.key_span(),
            format!("the field `{name}` is missing"),
        )
        .expected(format!("expected `{name}` in this object"))
    }

    /// Reads `$schema`, by which the editor of a whole document knows its fields: a text that is ignored.
    ///
    /// # Errors
    /// Reports a value that is no text.
    pub fn schema_reference(&mut self, errors: &mut Errors) -> Result<(), Reported> {
        // Inside of another document it is unknown: nobody would look at it there.
        if !self.value.pointer().is_empty() {
            return Ok(());
        }
        self.optional("$schema").map_or(Ok(()), |value| value.string(errors).map(drop))
    }

    /// Reads `format` and `version`, which open every file of the tool.
    ///
    /// # Errors
    /// Reports a missing field, another format, and a version that is not in `versions`. A caller stops at that:
    /// what follows in a file of another kind means something else.
    pub fn header(&mut self, format: &str, versions: &[u64], errors: &mut Errors) -> Result<u64, Reported> {
        let found = self.required("format", errors).and_then(|value| {
            let found = value.string(errors)?;
            if found == format {
                return self.fields_of(format, &value, errors);
            }
            let message = format!("this is a file of format `{}`", shown(found));
            let error = value.error(ErrorKind::Format, message).expected(format!("expected `{format}`"));
            Err(errors.report(match way_out(found, format) {
                Some(help) => error.help(help),
                None => error,
            }))
        });
        let version = self.required("version", errors).and_then(|value| {
            let version = value.integer(errors)?;
            if versions.contains(&version) {
                return Ok(version);
            }
            let read: Vec<String> = versions.iter().map(u64::to_string).collect();
            let read: Vec<&str> = read.iter().map(String::as_str).collect();
            let plural = if read.len() == 1 { "version" } else { "versions" };
            let error = value
                .error(ErrorKind::Version, format!("version {version} of `{format}` is not read"))
                .expected(format!("{plural} {} can be read", list(&read)));
            Err(errors.report(error))
        });
        found.and(version)
    }

    /// That the fields are not those of a plant under the format of a specification, or the reverse.
    fn fields_of(&self, format: &str, place: &Value<'_>, errors: &mut Errors) -> Result<(), Reported> {
        const SPECIFICATION: (&str, [&str; 2]) = ("sigmastar/bounding-spec", ["lyapunov", "bounds"]);
        const PLANT: (&str, [&str; 2]) = ("sigmastar/plant", ["f", "q"]);
        let (own, (other, others)) = match format {
            "sigmastar/bounding-spec" => (SPECIFICATION.1, PLANT),
            "sigmastar/plant" => (PLANT.1, SPECIFICATION),
            _ => return Ok(()),
        };
        let has = |name: &&str| self.value.member(name).is_some();
        if own.iter().any(has) || !others.iter().all(has) {
            return Ok(());
        }
        let message = format!("the fields are those of a file of the format `{other}`");
        Err(errors.report(place.error(ErrorKind::Format, message).expected(format!("expected `{other}`"))))
    }

    /// Refuses the fields that were not asked for: the first [`MAX_UNKNOWN`] each with its nearest known neighbour, the
    /// others by their number.
    pub fn finish(self, errors: &mut Errors) {
        self.finish_as("here", errors);
    }

    /// Refuses the fields that were not asked for, where the known fields depend on something: `place` completes "the fields known ...".
    pub fn finish_as(self, place: &str, errors: &mut Errors) {
        let mut unknown = self.value.members().filter(|(key, _)| !self.known.contains(key));
        // A field that is there already is less likely to be what was meant.
        let absent: Vec<&str> = self.known.iter().copied().filter(|name| self.value.member(name).is_none()).collect();
        for (key, value) in unknown.by_ref().take(MAX_UNKNOWN) {
            let error = SpecError::new(
                ErrorKind::UnknownField,
                value.pointer(),
                value.key_span(),
                format!("unknown field `{}`", shown(key)),
            );
            let near = nearest(key, absent.iter().copied()).or_else(|| nearest(key, self.known.iter().copied()));
            let of_model = self.known.contains(&"internal_model") && OF_INTERNAL_MODEL.contains(&key);
            let of_file = !self.value.pointer().is_empty() && OF_FILE.contains(&key);
            errors.report(match near {
                _ if of_model => error.help(format!("`{key}` stands in `internal_model`")),
                _ if of_file => error.help(belongs_above(key)),
                Some(name) => error.expected(format!("did you mean `{name}`?")),
                None => error.help(format!("the fields known {place} are {}", list(&self.known))),
            });
        }
        errors.count(unknown.count());
    }
}

/// Fields of the regulator, which some write beside it.
const OF_INTERNAL_MODEL: [&str; 7] =
    ["mu", "base_frequency", "matched", "weights", "harmonics", "sampling_period", "delay_samples"];

/// Fields of a file itself, which in TOML belong to a table once one has begun.
pub(super) const OF_FILE: [&str; 13] = [
    "format",
    "version",
    "period",
    "states",
    "initial",
    "initial_set",
    "domain",
    "parameters",
    "internal_model",
    "input_gain",
    "actuator",
    "measurement",
    "disturbance",
];

/// Where such a field belongs.
pub(super) fn belongs_above(name: &str) -> String {
    format!(
        "`{name}` is a field of the file itself; what stands below a line in brackets belongs to that table in TOML: put `{name}` above the first one"
    )
}

/// The formats that people name in a file of their own.
const FORMATS: [&str; 5] =
    ["sigmastar/plant", "sigmastar/bounding-spec", "sigmastar/study", "sigmastar/certificate", "sigmastar/controller"];

/// What commands tell as JSON.
const REPORTS: [(&str, &str); 11] = [
    ("sigmastar/report", "a report of `certify --format json`"),
    ("sigmastar/design", "a table of `design --format json`"),
    ("sigmastar/sampling", "a report of `sampling --format json`"),
    ("sigmastar/tune", "a report of `tune --format json`"),
    ("sigmastar/transfer", "a report of `transfer --format json`"),
    ("sigmastar/simulation", "a report of `simulate --format json`"),
    ("sigmastar/falsification", "a report of `falsify --format json`"),
    ("sigmastar/lyapunov", "a report of `lyapunov --format json`"),
    ("sigmastar/constants", "a table of `constants --format json`"),
    ("sigmastar/errata", "a list of `errata --format json`"),
    ("sigmastar/reproduction", "a report of `reproduce`"),
];

/// What a file of this format is, where it is what a command told.
#[must_use]
pub fn report(format: &str) -> Option<&'static str> {
    REPORTS.iter().find(|(known, _)| *known == format).map(|(_, what)| *what)
}

/// What to do with a file of the format `found` where one of `wanted` is read.
fn way_out(found: &str, wanted: &str) -> Option<String> {
    let first = |what: &str| {
        format!(
            "{what} is to be certified first: `sigmastar certify FILE -o CERTIFICATE`; this command reads the CERTIFICATE"
        )
    };
    if let Some(report) = report(found) {
        let what = match wanted {
            "sigmastar/certificate" => "the certificate, which `sigmastar certify FILE -o CERTIFICATE` writes",
            "sigmastar/study" => "the study",
            "sigmastar/bounding-spec" => "the plant or the specification that it is about",
            _ => "the plant that it is about",
        };
        return Some(format!("this is {report}, which no command reads again: name {what}"));
    }
    Some(match (found, wanted) {
        // What is to be certified, in the place of what was.
        ("sigmastar/plant", "sigmastar/certificate") => first("a plant"),
        ("sigmastar/bounding-spec", "sigmastar/certificate") => first("a specification"),
        ("sigmastar/plant", "sigmastar/bounding-spec") => {
            "this command needs bounding functions: `sigmastar bound FILE -o SPEC` writes those of a plant; it reads the SPEC".to_owned()
        }
        ("sigmastar/bounding-spec", "sigmastar/plant") => {
            "this command needs formulas, and a specification has bounds alone: `sigmastar new plant` writes a plant to begin with".to_owned()
        }
        ("sigmastar/study", _) => "`sigmastar sweep` is for studies".to_owned(),
        ("sigmastar/controller", _) => "`sigmastar simulate PLANT --controller FILE` takes it".to_owned(),
        _ => {
            let near = nearest(found, FORMATS).filter(|near| *near != found)?;
            format!("did you mean `{near}`?")
        }
    })
}

/// The name of a kind or family, out of those that are known.
///
/// # Errors
/// Reports any other name with the nearest that is known.
pub fn choose(
    value: &Value<'_>,
    what: &str,
    known: &[&'static str],
    errors: &mut Errors,
) -> Result<&'static str, Reported> {
    let name = value.string(errors)?;
    known.iter().copied().find(|candidate| *candidate == name).ok_or_else(|| {
        let error = value.error(ErrorKind::UnknownName, format!("unknown {what} `{}`", shown(name)));
        errors.report(match nearest(name, known.iter().copied()) {
            Some(near) => error.expected(format!("did you mean `{near}`?")),
            None => error.help(format!("the known ones are {}", list(known))),
        })
    })
}
