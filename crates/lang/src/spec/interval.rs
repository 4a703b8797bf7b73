//! What an interval is written like, for who wrote it as a list.

use super::constant::any_constant;
use super::document::Value;
use super::error::{ErrorKind, Errors, Reported};
use rug::Rational;
use sigmastar_exact::number::write_exact;

/// That an interval, or a number, is not written as a list: `[2, 4]` in the place of `{ "nominal": "3", "low": "2", "high": "4" }`.
///
/// # Errors
/// Reports an array, with what to write where it has two or three elements.
pub(super) fn no_list(value: &Value<'_>, errors: &mut Errors) -> Result<(), Reported> {
    if value.type_name() != "an array" {
        return Ok(());
    }
    let message = format!("{} is an array", value.name());
    let error = value.error(ErrorKind::Type, message).expected("expected a number, or an object for an interval");
    let example = as_object(value).map_or_else(String::new, |object| format!(": {object}"));
    Err(errors.report(error.help(format!("an interval is an object with `nominal`, `low` and `high`{example}"))))
}

/// The object that a list of two or three numbers may mean; the nominal value is the one in the middle.
fn as_object(value: &Value<'_>) -> Option<String> {
    // What is wrong in the list is not told: it is to go anyway.
    let number = |value: &Value<'_>| any_constant(value, &mut Errors::new()).ok()?.as_rational().cloned();
    let mut ends = value.array(&mut Errors::new()).ok()?.iter().map(number).collect::<Option<Vec<Rational>>>()?;
    ends.sort();
    let (nominal, low, high) = match ends.as_slice() {
        [low, high] => (Rational::from(low + high) / 2, low, high),
        [low, nominal, high] => (nominal.clone(), low, high),
        _ => return None,
    };
    let [nominal, low, high] = [&nominal, low, high].map(write_exact);
    Some(format!("{{ \"nominal\": \"{nominal}\", \"low\": \"{low}\", \"high\": \"{high}\" }}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::Document;

    #[test]
    fn a_list_is_told_as_the_object_that_it_means() {
        for (text, said) in [
            ("[2, 4]", Some("`nominal`, `low` and `high`: { \"nominal\": \"3\", \"low\": \"2\", \"high\": \"4\" }")),
            ("[\"1/3\", 1, 0]", Some("{ \"nominal\": \"1/3\", \"low\": \"0\", \"high\": \"1\" }")),
            ("[1, \"pi\"]", Some("`high`")),
            ("[1]", Some("`high`")),
            ("2", None),
            ("{ }", None),
        ] {
            let document = Document::parse("interval", text).unwrap();
            let mut errors = Errors::new();
            let outcome = no_list(&document.root(), &mut errors);
            let told = errors.conclude(&document, outcome).err();
            let help = told.map(|told| told.errors()[0].help.clone().unwrap());
            assert_eq!(help.is_some(), said.is_some(), "{text}");
            assert!(help.zip(said).is_none_or(|(help, said)| help.ends_with(said)), "{text}");
        }
    }
}
