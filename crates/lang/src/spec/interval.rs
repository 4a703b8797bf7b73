//! What an interval is written like, for who wrote it as a list.

use super::constant::any_constant;
use super::document::{Document, Value};
use super::error::{ErrorKind, Errors, Reported};
use rug::Rational;
use sigmastar_exact::number::write_exact;

/// What stands between two numbers that are meant as an interval: around a value, or from end to end. As an expression `3 +- 1` would be 2.
const AROUND: [&str; 3] = ["+/-", "+-", "\u{b1}"];
const FROM_TO: &str = "..";

/// That an interval, or a number, is not written as a list or a text of its own: `[2, 4]`, `"3 +- 1"` or `"2..4"` in the place of
/// `{ "nominal": "3", "low": "2", "high": "4" }`.
///
/// # Errors
/// Reports an array, and a text of that kind, with what to write where it is of numbers.
pub(super) fn no_list(value: &Value<'_>, errors: &mut Errors) -> Result<(), Reported> {
    let (message, meant) = match value.text() {
        _ if value.type_name() == "an array" => (format!("{} is an array", value.name()), of_list(value)),
        Some(text) => match AROUND.iter().find_map(|sign| text.split_once(sign)) {
            Some((middle, reach)) => (format!("{} is no single number", value.name()), around(middle, reach)),
            None => match text.split_once(FROM_TO) {
                Some((low, high)) => {
                    (format!("{} is no single number", value.name()), [low, high].map(number).into_iter().collect())
                }
                None => return Ok(()),
            },
        },
        None => return Ok(()),
    };
    let example = meant.and_then(as_object).map_or_else(String::new, |object| format!(": {object}"));
    let error = value.error(ErrorKind::Type, message).expected("expected a number, or an object for an interval");
    Err(errors.report(error.help(format!("an interval is an object with `nominal`, `low` and `high`{example}"))))
}

/// What is wrong in a number is not told: it is to go anyway.
fn rational(value: &Value<'_>) -> Option<Rational> {
    any_constant(value, &mut Errors::new()).ok()?.as_rational().cloned()
}

fn number(text: &str) -> Option<Rational> {
    let document = Document::flag("number", text.trim());
    rational(&document.at("/number")?)
}

fn of_list(value: &Value<'_>) -> Option<Vec<Rational>> {
    value.array(&mut Errors::new()).ok()?.iter().map(rational).collect()
}

fn around(middle: &str, reach: &str) -> Option<Vec<Rational>> {
    let (middle, reach) = (number(middle)?, number(reach)?);
    Some(vec![Rational::from(&middle - &reach), middle.clone(), middle + reach])
}

/// The object that two or three numbers mean; the nominal value is the one in the middle.
fn as_object(mut ends: Vec<Rational>) -> Option<String> {
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

    #[test]
    fn a_list_is_told_as_the_object_that_it_means() {
        for (text, said) in [
            ("[2, 4]", Some("`nominal`, `low` and `high`: { \"nominal\": \"3\", \"low\": \"2\", \"high\": \"4\" }")),
            ("[\"1/3\", 1, 0]", Some("{ \"nominal\": \"1/3\", \"low\": \"0\", \"high\": \"1\" }")),
            ("[1, \"pi\"]", Some("`high`")),
            ("[1]", Some("`high`")),
            ("\"3 +- 1\"", Some("{ \"nominal\": \"3\", \"low\": \"2\", \"high\": \"4\" }")),
            ("\"1/2 +/- 0.1\"", Some("{ \"nominal\": \"0.5\", \"low\": \"0.4\", \"high\": \"0.6\" }")),
            ("\"2..4\"", Some("{ \"nominal\": \"3\", \"low\": \"2\", \"high\": \"4\" }")),
            ("\"a \u{b1} b\"", Some("`high`")),
            ("\"3 + 1\"", None),
            ("\"3 - -1\"", None),
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
