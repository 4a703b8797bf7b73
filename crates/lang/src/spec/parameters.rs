//! The named constants of a plant.

use super::constant::any_constant;
use super::document::Value;
use super::error::{ErrorKind, Errors, Reported};
use super::parts::Constant;
use crate::expr::{DefinitionError, Definitions, occurs};

/// The most parameters that are read.
pub const MAX_PARAMETERS: usize = 12;

/// A named constant.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Its name in formulas.
    pub name: String,
    /// Its value.
    pub value: Constant,
}

/// The named constants of a plant, in the order of the document.
#[derive(Clone, Debug, Default)]
pub struct Parameters {
    list: Vec<Parameter>,
    definitions: Definitions,
    unused: Vec<String>,
}

impl Parameters {
    /// The constants.
    #[must_use]
    pub fn list(&self) -> &[Parameter] {
        &self.list
    }

    /// What their names stand for.
    #[must_use]
    pub fn definitions(&self) -> &Definitions {
        &self.definitions
    }

    /// The names that occur nowhere.
    #[must_use]
    pub fn unused(&self) -> &[String] {
        &self.unused
    }

    /// The same with those marked that occur in none of the texts of these members of the plant.
    #[must_use]
    pub fn used_in(mut self, members: &[&serde_json::Value]) -> Parameters {
        let used = |name: &str| members.iter().any(|member| mentions(name, member));
        self.unused = self.list.iter().map(|one| one.name.clone()).filter(|name| !used(name)).collect();
        self
    }
}

fn mentions(name: &str, value: &serde_json::Value) -> bool {
    match value {
        serde_json::Value::String(text) => occurs(name, text),
        serde_json::Value::Array(list) => list.iter().any(|value| mentions(name, value)),
        serde_json::Value::Object(members) => members.values().any(|value| mentions(name, value)),
        _ => false,
    }
}

/// Reads `parameters`: an object of at most [`MAX_PARAMETERS`] constants, none of which refers to another.
///
/// # Errors
/// Reports names that cannot be used or are those of `states`, and values that are no constants.
pub fn read_parameters(value: &Value<'_>, states: &[String], errors: &mut Errors) -> Result<Parameters, Reported> {
    // The names are the user's: there is none to ask for, and none is unknown.
    drop(value.object(errors)?);
    let members: Vec<(&str, Value<'_>)> = value.members().collect();
    if members.len() > MAX_PARAMETERS {
        let message = format!("{} parameters", members.len());
        return Err(errors
            .report(value.error(ErrorKind::Range, message).expected(format!("expected at most {MAX_PARAMETERS}"))));
    }
    let mut parameters = Parameters::default();
    let mut outcome = Ok(());
    for (name, value) in &members {
        match read_one(name, value, states, &members, errors).and_then(|constant| {
            let defined = parameters.definitions.define(name, constant.expr.clone());
            defined.map(|()| constant).map_err(|error| refused(value, name, &error, errors))
        }) {
            Ok(constant) => parameters.list.push(Parameter { name: (*name).to_owned(), value: constant }),
            Err(reported) => outcome = Err(reported),
        }
    }
    outcome.map(|()| parameters)
}

fn read_one(
    name: &str,
    value: &Value<'_>,
    states: &[String],
    members: &[(&str, Value<'_>)],
    errors: &mut Errors,
) -> Result<Constant, Reported> {
    if states.iter().any(|state| state == name) {
        let message = format!("the parameter `{name}` has the name of a state");
        let error = value.error_at_key(ErrorKind::UnknownName, message);
        return Err(errors.report(error.help("rename one of the two")));
    }
    let refers = value.text().and_then(|text| members.iter().map(|member| member.0).find(|name| occurs(name, text)));
    // A name of the language's own is refused for that below.
    if let Some(other) = refers.filter(|other| Definitions::none().admits(other).is_ok()) {
        let message = format!("the value of `{name}` refers to the parameter `{other}`");
        let error = value.error(ErrorKind::Expression, message);
        return Err(errors.report(error.help("write its number: values of parameters do not depend on each other")));
    }
    any_constant(value, errors)
}

fn refused(value: &Value<'_>, name: &str, error: &DefinitionError, errors: &mut Errors) -> Reported {
    let message = format!("the parameter `{}`: {error}", super::error::shown(name));
    let expected = "expected different names such as k or J_1, other than t, e, u, pi and the functions";
    errors.report(value.error_at_key(ErrorKind::UnknownName, message).expected(expected))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::{Document, SpecErrors};

    fn read(text: &str) -> Result<Parameters, SpecErrors> {
        let document = Document::parse("plant", text)?;
        let mut errors = Errors::new();
        let outcome = read_parameters(&document.root(), &["x1".to_owned()], &mut errors);
        errors.conclude(&document, outcome)
    }

    #[test]
    fn constants_under_their_names() {
        let all = read(r#"{ "J": "0.02", "k": 4, "w": "2*pi/3" }"#).unwrap();
        let written: Vec<(&str, &str)> =
            all.list().iter().map(|one| (one.name.as_str(), one.value.text.as_str())).collect();
        assert_eq!(written, [("J", "0.02"), ("k", "4"), ("w", "2*pi/3")]);
        assert!(read("{}").unwrap().list().is_empty());
        let members = [serde_json::json!(["-k*x1"]), serde_json::json!({ "kind": "box", "X0": "w/2" })];
        assert!(all.unused().is_empty());
        assert_eq!(all.used_in(&members.each_ref()).unused(), ["J"]);
    }

    #[test]
    fn what_cannot_be_a_parameter_is_told_in_its_place() {
        let many: Vec<String> = (0..=MAX_PARAMETERS).map(|i| format!("\"k{i}\": 1")).collect();
        let most = many[..MAX_PARAMETERS].join(", ");
        assert_eq!(read(&format!("{{ {most} }}")).unwrap().list().len(), MAX_PARAMETERS);
        for (text, told) in [
            (format!("{{ {} }}", many.join(", ")), "13 parameters"),
            ("[1]".to_owned(), "is an array"),
            (r#"{ "t": 1 }"#.to_owned(), "another meaning"),
            (r#"{ "u": 1 }"#.to_owned(), "another meaning"),
            (r#"{ "sin": "sin(1)" }"#.to_owned(), "another meaning"),
            (r#"{ "2k": 1 }"#.to_owned(), "no name"),
            (r#"{ "x1": 1 }"#.to_owned(), "the name of a state"),
            (r#"{ "k": 1, "k": 2 }"#.to_owned(), "twice"),
            (r#"{ "k": 1, "m": "2*k" }"#.to_owned(), "refers to the parameter `k`"),
            (r#"{ "k": "2*k" }"#.to_owned(), "refers to the parameter `k`"),
            (r#"{ "k": "1/0" }"#.to_owned(), "no value that can be enclosed"),
            (r#"{ "k": "x1" }"#.to_owned(), "not a known name"),
            (r#"{ "k": true }"#.to_owned(), "a boolean"),
        ] {
            let error = read(&text).map(|_| ()).unwrap_err().to_string();
            assert!(error.contains(told), "{text}: {error}");
        }
    }
}
