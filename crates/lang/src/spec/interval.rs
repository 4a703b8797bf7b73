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

/// Names of fields by which an interval is stated elsewhere: how far it reaches to both sides.
const REACHES: [&str; 9] =
    ["tolerance", "tol", "plus_minus", "uncertainty", "deviation", "delta", "error", "spread", "accuracy"];

/// That an interval is not stated by how far it reaches: `"nominal": "5", "tolerance": "1/10"` in the place of its ends.
///
/// # Errors
/// Reports such a field where both ends are missing, with the ends that it means: as a number in the unit of `nominal`, and as a share of that.
pub(super) fn no_reach(value: &Value<'_>, errors: &mut Errors) -> Result<(), Reported> {
    let states_an_end = ["low", "high"].iter().any(|end| value.member(end).is_some());
    let found = REACHES.iter().find_map(|name| value.member(name).map(|reach| (*name, reach)));
    let Some((name, reach)) = found.filter(|_| !states_an_end) else { return Ok(()) };
    let written = |value: &Value<'_>| value.text().or_else(|| value.numeral()).map(|text| text.trim().to_owned());
    let meant = value.member("nominal").as_ref().and_then(written).zip(written(&reach));
    let meant = meant.and_then(|(middle, reach)| reached(&middle, &reach));
    let meant = meant.unwrap_or_else(|| "write `\"low\": \"0.9\", \"high\": \"1.1\"` for 1 to within 10 %".to_owned());
    let error = reach.error_at_key(ErrorKind::UnknownField, format!("an interval has no `{name}`"));
    Err(errors.report(error.expected("expected `low` and `high`, the ends themselves").help(meant)))
}

/// The ends of an interval around a number, in words: of a percentage those, of a number both that it may mean.
fn reached(middle: &str, reach: &str) -> Option<String> {
    let ends = |around: Vec<Rational>| {
        let mut ends = [around.first()?.clone(), around.last()?.clone()];
        ends.sort();
        Some(format!("`\"low\": \"{}\", \"high\": \"{}\"`", write_exact(&ends[0]), write_exact(&ends[1])))
    };
    let absolute = ends(around(middle, reach)?)?;
    if reach.ends_with('%') {
        return Some(format!("write {absolute} for {middle} to within {reach}"));
    }
    let percent = write_exact(&(number(reach)? * 100));
    let share = ends(around(middle, &format!("{percent}%"))?)?;
    Some(format!("write {absolute} for {middle} to within {reach}, or {share} for {middle} to within {percent} %"))
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

/// The ends of an interval around a number, and that number between them; a reach with a percent sign is a share of it.
fn around(middle: &str, reach: &str) -> Option<Vec<Rational>> {
    let middle = number(middle)?;
    let reach = match reach.trim().strip_suffix('%') {
        Some(percent) => &middle * number(percent)? / 100,
        None => number(reach)?,
    };
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
    fn a_reach_is_told_as_the_ends_that_it_means() {
        for (interval, said) in [
            (
                r#""nominal": "5", "tolerance": 1"#,
                Some(
                    r#"`"low": "4", "high": "6"` for 5 to within 1, or `"low": "0", "high": "10"` for 5 to within 100 %"#,
                ),
            ),
            (
                r#""nominal": 5, "tolerance": "10 %""#,
                Some(r#"write `"low": "4.5", "high": "5.5"` for 5 to within 10 %"#),
            ),
            (r#""nominal": "-2", "tol": "0.1""#, Some(r#"or `"low": "-2.2", "high": "-1.8"` for -2 to within 10 %"#)),
            (
                r#""nominal": "1/J", "uncertainty": "0.1""#,
                Some(r#"`"low": "0.9", "high": "1.1"` for 1 to within 10 %"#),
            ),
            // What has its ends has another field too many; and another word may mean anything.
            (r#""nominal": 5, "low": 4, "high": 6, "tolerance": 1"#, None),
            (r#""nominal": 5, "width": 1"#, None),
        ] {
            let document = Document::parse("interval", &format!("{{ {interval} }}")).unwrap();
            let mut errors = Errors::new();
            let outcome = no_reach(&document.root(), &mut errors);
            let told = errors.conclude(&document, outcome).err();
            let help = told.map(|told| told.errors()[0].help.clone().unwrap());
            assert_eq!(help.is_some(), said.is_some(), "{interval}");
            assert!(help.clone().zip(said).is_none_or(|(help, said)| help.ends_with(said)), "{interval}: {help:?}");
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
            ("\"5 +- 10 %\"", Some("{ \"nominal\": \"5\", \"low\": \"4.5\", \"high\": \"5.5\" }")),
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
