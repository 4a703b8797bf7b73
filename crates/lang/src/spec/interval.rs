//! What an interval is written like, for who wrote it as a list.

use super::constant::any_constant;
use super::document::{Document, Value};
use super::error::{ErrorKind, Errors, Reported};
use rug::Rational;
use sigmastar_exact::number::{parse_decimal, write_exact};

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

/// That an end of an interval is no percentage: `"low": "-10%"` in the place of nine tenths of `nominal`.
///
/// # Errors
/// Reports an end that is a number with a percent sign, with what to write for it.
pub(super) fn no_share(value: &Value<'_>, errors: &mut Errors) -> Result<(), Reported> {
    let nominal = value.member("nominal").and_then(|nominal| nominal.text().or(nominal.numeral()));
    let mut outcome = Ok(());
    for name in ["low", "high"] {
        let Some(end) = value.member(name) else { continue };
        let Some((said, share)) = end.text().and_then(|text| share(name, text)) else { continue };
        let text = nominal.map_or_else(|| "...".to_owned(), |nominal| times(&share, nominal));
        let error = end.error(ErrorKind::Range, format!("`{name}` is a percentage, and an interval has none"));
        let error = error.expected("expected a number in the unit of `nominal`");
        let help = format!(
            "`low` and `high` are the ends of the interval themselves: for {said} `nominal` write `\"{name}\": \"{text}\"`"
        );
        outcome = Err(errors.report(error.help(help)));
    }
    outcome
}

/// What an end that is a percentage means in words, and as a share of the nominal value: one with a sign is a difference from that, and so is one without
/// that would make `high` smaller than the nominal value.
fn share(name: &str, text: &str) -> Option<(String, Rational)> {
    let number = text.trim().strip_suffix('%')?.trim();
    let digits = number.trim_start_matches(['+', '-']).trim_start();
    let percent = parse_decimal(digits).ok()?;
    let share = percent / 100;
    Some(match number.chars().next() {
        Some('-') => (format!("{digits} % below"), 1 - share),
        Some('+') => (format!("{digits} % above"), 1 + share),
        _ if name == "high" && share < 1 => (format!("{digits} % above"), 1 + share),
        _ => (format!("{digits} % of"), share),
    })
}

/// A share of a number, or of what is an expression, as a text.
fn times(share: &Rational, nominal: &str) -> String {
    match number(nominal) {
        Some(nominal) => write_exact(&(nominal * share)),
        None => format!("{}*({nominal})", write_exact(share)),
    }
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
    fn a_percentage_is_told_as_the_end_that_it_means() {
        for (ends, said) in [
            (r#""nominal": "2", "low": "-10%", "high": "2.2""#, &[r#"10 % below `nominal` write `"low": "1.8"`"#][..]),
            (
                r#""nominal": "1/J", "low": "90%", "high": "+ 10 %""#,
                &[
                    r#"90 % of `nominal` write `"low": "0.9*(1/J)"`"#,
                    r#"10 % above `nominal` write `"high": "1.1*(1/J)"`"#,
                ],
            ),
            (r#""nominal": "5", "high": "20%""#, &[r#"20 % above `nominal` write `"high": "6"`"#]),
            (r#""nominal": "5", "high": "120%""#, &[r#"120 % of `nominal` write `"high": "6"`"#]),
            (r#""low": "-5%""#, &[r#"5 % below `nominal` write `"low": "..."`"#]),
            (r#""nominal": 1, "low": 0.9, "high": "1 + x%""#, &[]),
            (r#""nominal": 1, "low": "%", "high": 2"#, &[]),
        ] {
            let document = Document::parse("interval", &format!("{{ {ends} }}")).unwrap();
            let mut errors = Errors::new();
            let outcome = no_share(&document.root(), &mut errors);
            let told = errors.conclude(&document, outcome).err();
            let told: Vec<String> =
                told.iter().flat_map(|told| told.errors()).map(|error| error.help.clone().unwrap()).collect();
            assert_eq!(told.len(), said.len(), "{ends}: {told:?}");
            assert!(told.iter().zip(said).all(|(told, said)| told.ends_with(said)), "{ends}: {told:?}");
        }
    }

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
