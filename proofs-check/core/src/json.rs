//! JSON as it is written: numbers as text, no repeated keys, bounded before anything is parsed.

use crate::verdict::{Outcome, bad};
use rug::{Integer, Rational};
use serde::de::{Deserialize, Deserializer, Error, MapAccess, Visitor};
use serde_json::value::RawValue;
use std::fmt;

/// The largest file that is read, in bytes.
pub const MAX_BYTES: usize = 4 << 20;
/// The deepest nesting that is read: twice that of a certificate.
const MAX_NESTING: usize = 16;
/// The longest key of an object, in bytes.
const MAX_KEY: usize = 100;
/// The most values that are read.
const MAX_VALUES: usize = 200_000;
/// The longest text for people, in bytes: the constants of a claim have up to 10,000 each.
const MAX_WORDS: usize = 500_000;
/// The longest numeral in characters, and the largest decimal exponent, from which a rational is formed.
const MAX_NUMERAL: usize = 1000;
const MAX_EXPONENT: u32 = 4000;

/// A JSON value.
#[derive(Clone, Debug)]
pub enum Json {
    /// null
    Null,
    /// true, false
    Bool(bool),
    /// A number, as written.
    Number(String),
    /// A string.
    Text(String),
    /// An array.
    Array(Vec<Json>),
    /// An object, in the order of the file.
    Object(Vec<(String, Json)>),
}

/// Reads a document. Its size, nesting and number of values are bounded in one pass before anything is parsed.
pub fn parse(bytes: &[u8]) -> Outcome<Json> {
    if bytes.len() > MAX_BYTES {
        return bad("", format!("the file has more than {MAX_BYTES} bytes"));
    }
    let Ok(text) = std::str::from_utf8(bytes) else { return bad("", "the file is not UTF-8") };
    limits(bytes)?;
    value(parsed::<&RawValue>(text, "")?.get(), "")
}

fn parsed<'t, T: Deserialize<'t>>(text: &'t str, pointer: &str) -> Outcome<T> {
    serde_json::from_str(text).or_else(|error| bad(pointer, format!("not JSON: {error}")))
}

fn limits(bytes: &[u8]) -> Outcome<()> {
    let (mut depth, mut values, mut in_string, mut escaped) = (0_usize, 1_usize, false, false);
    // Where the last string begins and how long it is: before a colon it is a key.
    let (mut begin, mut length) = (0, 0);
    for (at, byte) in bytes.iter().enumerate() {
        match byte {
            _ if escaped => escaped = false,
            b'\\' if in_string => escaped = true,
            b'"' => {
                in_string = !in_string;
                (begin, length) = if in_string { (at, length) } else { (begin, at - begin - 1) };
            }
            _ if in_string => {}
            b':' if length > MAX_KEY => return bad("", format!("a key of an object has more than {MAX_KEY} bytes")),
            b'[' | b'{' => (depth, values) = (depth + 1, values + 1),
            b']' | b'}' => depth = depth.saturating_sub(1),
            b',' => values += 1,
            _ => {}
        }
        if depth > MAX_NESTING {
            return bad("", format!("arrays and objects are nested more than {MAX_NESTING} deep"));
        }
        if values > MAX_VALUES {
            return bad("", format!("the file has more than {MAX_VALUES} values"));
        }
    }
    Ok(())
}

/// The members of an object, raw; a repeated key is an error.
struct Members<'a>(Vec<(String, &'a RawValue)>);

impl<'de: 'a, 'a> Deserialize<'de> for Members<'a> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Each;
        impl<'de> Visitor<'de> for Each {
            type Value = Vec<(String, &'de RawValue)>;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an object")
            }
            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
                let mut members: Self::Value = Vec::new();
                let mut seen = std::collections::HashSet::new();
                while let Some((key, value)) = map.next_entry::<String, &RawValue>()? {
                    if !seen.insert(key.clone()) {
                        let start: String = key.chars().take(40).collect();
                        return Err(A::Error::custom(format!("the field `{start}` is given twice")));
                    }
                    members.push((key, value));
                }
                Ok(members)
            }
        }
        deserializer.deserialize_map(Each).map(Members)
    }
}

/// One value from its text. The recursion is as deep as the nesting, which is bounded.
fn value(raw: &str, pointer: &str) -> Outcome<Json> {
    match raw.as_bytes().first() {
        Some(b'{') => {
            let read = |(key, raw): (String, &RawValue)| Ok((key.clone(), value(raw.get(), &join(pointer, &key))?));
            let members: Members<'_> = parsed(raw, pointer)?;
            members.0.into_iter().map(read).collect::<Outcome<_>>().map(Json::Object)
        }
        Some(b'[') => {
            let read = |(index, raw): (usize, &RawValue)| value(raw.get(), &join(pointer, &index.to_string()));
            let list: Vec<&RawValue> = parsed(raw, pointer)?;
            list.into_iter().enumerate().map(read).collect::<Outcome<_>>().map(Json::Array)
        }
        Some(b'"') => parsed(raw, pointer).map(Json::Text),
        Some(b't' | b'f') => Ok(Json::Bool(raw == "true")),
        Some(b'n') => Ok(Json::Null),
        _ => Ok(Json::Number(raw.to_owned())),
    }
}

/// The pointer of a member (RFC 6901).
pub fn join(pointer: &str, key: &str) -> String {
    format!("{pointer}/{}", key.replace('~', "~0").replace('/', "~1"))
}

impl Json {
    /// The canonical form: keys sorted by bytes, no white space, numbers as written, strings as serde_json writes them.
    pub fn canonical(&self, output: &mut String) {
        let quoted = |text: &str| serde_json::Value::String(text.to_owned()).to_string();
        match self {
            Json::Null => output.push_str("null"),
            Json::Bool(value) => output.push_str(if *value { "true" } else { "false" }),
            Json::Number(text) => output.push_str(text),
            Json::Text(text) => output.push_str(&quoted(text)),
            Json::Array(list) => {
                output.push('[');
                for (index, element) in list.iter().enumerate() {
                    output.push_str(if index == 0 { "" } else { "," });
                    element.canonical(output);
                }
                output.push(']');
            }
            Json::Object(members) => {
                let mut sorted: Vec<_> = members.iter().collect();
                sorted.sort_by(|a, b| a.0.cmp(&b.0));
                output.push('{');
                for (index, (key, value)) in sorted.into_iter().enumerate() {
                    output.push_str(if index == 0 { "" } else { "," });
                    output.push_str(&(quoted(key) + ":"));
                    value.canonical(output);
                }
                output.push('}');
            }
        }
    }
}

/// A value with its place.
#[derive(Clone, Debug)]
pub struct Field<'a> {
    /// The value.
    pub json: &'a Json,
    /// Its JSON pointer.
    pub pointer: String,
}

/// An object whose fields are taken one by one; what is left in the end is unknown.
pub struct Fields<'a> {
    members: Vec<&'a (String, Json)>,
    /// The pointer of the object.
    pub pointer: String,
}

impl<'a> Field<'a> {
    /// The fields of an object.
    pub fn fields(&self) -> Outcome<Fields<'a>> {
        match self.json {
            Json::Object(members) => Ok(Fields { members: members.iter().collect(), pointer: self.pointer.clone() }),
            _ => bad(&self.pointer, "expected an object"),
        }
    }

    /// What is read out of an object, in which nothing may be left.
    pub fn object<T>(&self, read: impl FnOnce(&mut Fields<'a>) -> Outcome<T>) -> Outcome<T> {
        let mut fields = self.fields()?;
        let value = read(&mut fields)?;
        fields.finish().map(|()| value)
    }

    /// What is read of each element of an array.
    pub fn list<T>(&self, read: impl FnMut(&Field<'a>) -> Outcome<T>) -> Outcome<Vec<T>> {
        self.elements()?.iter().map(read).collect()
    }

    /// The rows of a matrix of this order, `what` they are.
    pub fn matrix(&self, [rows, columns]: [usize; 2], what: &str) -> Outcome<Vec<Vec<Rational>>> {
        let matrix = self.list(|row| row.list(Field::rational))?;
        if matrix.len() == rows && matrix.iter().all(|row| row.len() == columns) {
            return Ok(matrix);
        }
        bad(&self.pointer, format!("expected {rows} rows of {columns} numbers, {what}"))
    }

    /// The elements of an array.
    pub fn elements(&self) -> Outcome<Vec<Field<'a>>> {
        let Json::Array(list) = self.json else { return bad(&self.pointer, "expected an array") };
        let element = |(index, json)| Field { json, pointer: join(&self.pointer, &usize::to_string(&index)) };
        Ok(list.iter().enumerate().map(element).collect())
    }

    /// A string.
    pub fn text(&self) -> Outcome<&'a str> {
        match self.json {
            Json::Text(text) => Ok(text),
            _ => bad(&self.pointer, "expected a string"),
        }
    }

    /// A string of bounded length that is for people: nothing depends on it.
    pub fn words(&self) -> Outcome<()> {
        match self.text()?.len() {
            0..=MAX_WORDS => Ok(()),
            _ => bad(&self.pointer, format!("a text of more than {MAX_WORDS} bytes")),
        }
    }

    /// `true` or `false`.
    pub fn truth(&self) -> Outcome<bool> {
        match self.json {
            Json::Bool(value) => Ok(*value),
            _ => bad(&self.pointer, "expected true or false"),
        }
    }

    /// A whole number of up to nine digits.
    pub fn whole(&self) -> Outcome<u32> {
        match self.json {
            Json::Number(text) if text.len() <= 9 && text.bytes().all(|b| b.is_ascii_digit()) => {
                Ok(text.bytes().fold(0, |n, digit| 10 * n + u32::from(digit - b'0')))
            }
            _ => bad(&self.pointer, "expected a small whole number"),
        }
    }

    /// A number, or a string that may hold one.
    pub fn numeral(&self) -> Outcome<&'a str> {
        match self.json {
            Json::Text(text) | Json::Number(text) => Ok(text),
            _ => bad(&self.pointer, "expected a number or a string"),
        }
    }

    /// An exact rational: `p/q` or a decimal, in a string or as a JSON number.
    pub fn rational(&self) -> Outcome<Rational> {
        let message = "expected an exact rational of moderate size, as \"3/7\", \"0.25\" or \"1e-3\", with a sign in front at most";
        rational(self.numeral()?).map_or_else(|| bad(&self.pointer, message), Ok)
    }
}

impl<'a> Fields<'a> {
    /// Takes a field that may be absent.
    pub fn optional(&mut self, name: &str) -> Option<Field<'a>> {
        let index = self.members.iter().position(|member| member.0 == name)?;
        let (key, json) = self.members.remove(index);
        Some(Field { json, pointer: join(&self.pointer, key) })
    }

    /// Whether a field is there.
    pub fn has(&self, name: &str) -> bool {
        self.members.iter().any(|member| member.0 == name)
    }

    /// Takes a field that must be there.
    pub fn required(&mut self, name: &str) -> Outcome<Field<'a>> {
        self.optional(name).map_or_else(|| bad(&self.pointer, format!("the field `{name}` is missing")), Ok)
    }

    /// What is read of a field that may be absent.
    pub fn part<T>(&mut self, name: &str, read: impl FnOnce(&Field<'a>) -> Outcome<T>) -> Outcome<Option<T>> {
        self.optional(name).map(|field| read(&field)).transpose()
    }

    /// An exact rational.
    pub fn number(&mut self, name: &str) -> Outcome<Rational> {
        self.required(name)?.rational()
    }

    /// One after the other.
    pub fn numbers<const N: usize>(&mut self, names: [&str; N]) -> Outcome<[Rational; N]> {
        self.each(names, Fields::number)
    }

    /// What is read of one field after the other.
    pub fn each<T: Default, const N: usize>(
        &mut self,
        names: [&str; N],
        read: impl Fn(&mut Self, &str) -> Outcome<T>,
    ) -> Outcome<[T; N]> {
        let mut all = [(); N].map(|()| T::default());
        for (value, name) in all.iter_mut().zip(names) {
            *value = read(self, name)?;
        }
        Ok(all)
    }

    /// Numbers of these names, of which all are there or none.
    pub fn together<const N: usize>(&mut self, names: [&str; N]) -> Outcome<Option<[Rational; N]>> {
        match names.iter().filter(|name| self.has(name)).count() {
            0 => Ok(None),
            all if all == N => self.numbers(names).map(Some),
            _ => {
                let named = names.map(|name| format!("`{name}`")).join(", ");
                let (before, last) = named.rsplit_once(", ").unwrap_or((&named, ""));
                bad(&self.pointer, format!("{before} and {last} go together"))
            }
        }
    }

    /// All that is left, with the keys.
    pub fn rest(self) -> impl Iterator<Item = (&'a str, Field<'a>)> {
        let pointer = self.pointer;
        self.members.into_iter().map(move |(key, json)| (key.as_str(), Field { json, pointer: join(&pointer, key) }))
    }

    /// Nothing may be left.
    pub fn finish(self) -> Outcome<()> {
        match self.members.first() {
            None => Ok(()),
            Some((key, _)) => bad(&join(&self.pointer, key), "this field is unknown here"),
        }
    }
}

/// A number as JSON writes one (`-12`, `0.5`, `1.5e-3`), or a fraction `p/q` of whole numbers, of which p alone may have a sign, exactly;
/// `None` if it is neither, or too large to be formed. A claim repeats these texts, so that none is taken which may be read in two ways.
pub fn rational(text: &str) -> Option<Rational> {
    let Some((numerator, denominator)) = text.split_once('/') else {
        return decimal(text).filter(|_| is_number(text));
    };
    let written = is_whole(numerator.strip_prefix('-').unwrap_or(numerator)) && is_whole(denominator);
    let denominator = decimal(denominator).filter(|denominator| written && *denominator != 0)?;
    decimal(numerator).map(|numerator| numerator / denominator)
}

/// Digits, the first of which is not 0 where there are more.
fn is_whole(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit()) && (text == "0" || !text.starts_with('0'))
}

/// Whether a numeral that [`decimal`] reads is one of JSON: digits before a point, and after it.
fn is_number(text: &str) -> bool {
    let mantissa = text.split(['e', 'E']).next().unwrap_or(text);
    let unsigned = mantissa.strip_prefix('-').unwrap_or(mantissa);
    match unsigned.split_once('.') {
        None => is_whole(unsigned),
        Some((whole, fraction)) => is_whole(whole) && !fraction.is_empty(),
    }
}

/// A decimal numeral (`-12`, `0.5`, `.5`, `1.5e-3`) exactly; `None` if it is none, or too large to be formed.
pub fn decimal(text: &str) -> Option<Rational> {
    if text.len() > MAX_NUMERAL {
        return None;
    }
    let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
    let unsigned = mantissa.strip_prefix('-').unwrap_or(mantissa);
    let (whole, fraction) = unsigned.split_once('.').unwrap_or((unsigned, ""));
    let digits = format!("{whole}{fraction}");
    let exponent_digits = exponent.strip_prefix(['+', '-']).unwrap_or(exponent);
    let all_digits = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    if !all_digits(&digits) || !all_digits(exponent_digits) {
        return None;
    }
    // The exponent is bounded before a power of ten is formed.
    let exponent: i64 = exponent.parse().ok().filter(|e: &i64| e.unsigned_abs() <= u64::from(MAX_EXPONENT))?;
    let scale = exponent - fraction.len() as i64;
    let power = Integer::u_pow_u(10, scale.unsigned_abs() as u32);
    let value = Rational::from(digits.parse::<Integer>().ok()?);
    let value = if scale < 0 { value / Integer::from(power) } else { value * Integer::from(power) };
    Some(if mantissa.starts_with('-') { -value } else { value })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read<T>(text: &str, read: impl FnOnce(&Field<'_>) -> Outcome<T>) -> Result<T, String> {
        let json = parse(text.as_bytes()).map_err(|finding| finding.pointer)?;
        read(&Field { json: &json, pointer: String::new() }).map_err(|finding| finding.pointer)
    }

    #[test]
    fn the_canonical_form_has_one_text() {
        let text = r#" { "b" : [1, "x", [ ], {"~" :null}], "a": { }, "B": [[2.0,3E1]] } "#;
        let canonical = r#"{"B":[[2.0,3E1]],"a":{},"b":[1,"x",[],{"~":null}]}"#;
        let mut found = String::new();
        parse(text.as_bytes()).unwrap().canonical(&mut found);
        assert_eq!(found, canonical);
    }

    #[test]
    fn nothing_is_left_in_an_object() {
        let number = |fields: &mut Fields<'_>| fields.number("a");
        assert_eq!(read(r#"{"a":"1/2"}"#, |field| field.object(number)), Ok(Rational::from((1, 2))));
        for (text, place) in [
            (r#"{"a":1,"b":1}"#, "/b"),
            (r#"{"a":1,"a":1}"#, ""),
            (r#"{"a":null}"#, "/a"),
            (r#"{"a":[1]}"#, "/a"),
            (r#"{"a":"1/0"}"#, "/a"),
            (r#"{"a":"inf"}"#, "/a"),
            ("{}", ""),
            ("[1]", ""),
            ("null", ""),
        ] {
            assert_eq!(read(text, |field| field.object(number)), Err(place.to_owned()), "{text}");
        }
    }

    #[test]
    fn a_matrix_has_its_order() {
        let of_two = |text| read(text, |field| field.matrix([2, 2], ""));
        let [one, two] = [1, 2].map(Rational::from);
        assert_eq!(of_two(r#"[[1,"2"],["2",1]]"#), Ok(vec![vec![one.clone(), two.clone()], vec![two, one]]));
        for (text, place) in [
            ("[[1,2]]", ""),
            ("[[1,2],[2,1],[0,0]]", ""),
            ("[[1,2],[2]]", ""),
            ("[[1,2],[2,1,0]]", ""),
            ("[]", ""),
            ("[[],[]]", ""),
            ("[[1,2],2]", "/1"),
            ("[[1,2],[2,null]]", "/1/1"),
            (r#"{"0":[1,2]}"#, ""),
        ] {
            assert_eq!(of_two(text), Err(place.to_owned()), "{text}");
        }
        assert_eq!(read("[[1,2,3]]", |field| field.matrix([1, 3], "")).map(|rows| rows[0].len()), Ok(3));
        assert_eq!(read("[]", |field| field.matrix([0, 0], "")), Ok(Vec::new()));
    }

    #[test]
    fn numbers_go_together_in_their_order() {
        let both = |text| read(text, |field| field.object(|fields| fields.together(["a", "b"])));
        assert_eq!(both("{}"), Ok(None));
        assert_eq!(both(r#"{"b":2,"a":1}"#), Ok(Some([1, 2].map(Rational::from))));
        for (text, place) in
            [(r#"{"a":1}"#, ""), (r#"{"b":2}"#, ""), (r#"{"a":1,"b":null}"#, "/b"), (r#"{"c":1}"#, "/c")]
        {
            assert_eq!(both(text), Err(place.to_owned()), "{text}");
        }
        let all = |text| read(text, |field| field.object(|fields| fields.numbers(["a", "b"])));
        assert_eq!(all(r#"{"b":2,"a":1}"#), Ok([1, 2].map(Rational::from)));
        assert_eq!(all(r#"{"a":1}"#), Err(String::new()));
    }

    #[test]
    fn a_part_is_read_where_it_is_there() {
        let part = |text| read(text, |field| field.object(|fields| fields.part("a", Field::rational)));
        assert_eq!(part("{}"), Ok(None));
        assert_eq!(part(r#"{"a":3}"#), Ok(Some(Rational::from(3))));
        assert_eq!(part(r#"{"a":null}"#), Err("/a".to_owned()));
        assert_eq!(part(r#"{"b":3}"#), Err("/b".to_owned()));
    }
}
