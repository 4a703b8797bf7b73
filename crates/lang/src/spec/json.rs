//! JSON as it is written: strict, with the place of every key and value, numbers as text.

use super::error::{ErrorKind, SpecError, shown};
use super::limits;
use crate::expr::percent;
use jsonc_parser::ast;
use jsonc_parser::common::Ranged;
use jsonc_parser::{CollectOptions, ParseOptions, parse_to_ast};
use std::collections::HashSet;
use std::ops::Range;

/// A value and where it stands, in bytes.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub(super) span: Range<usize>,
    pub(super) content: Content,
}

/// What a value is; numbers keep the text that is written.
#[derive(Clone, Debug)]
pub(super) enum Content {
    Null,
    Boolean(bool),
    Number(String),
    Text(String),
    Array(Vec<Node>),
    Object(Vec<Member>),
}

/// A member of an object, in the order of the document.
#[derive(Clone, Debug)]
pub(super) struct Member {
    pub(super) key: String,
    pub(super) key_span: Range<usize>,
    pub(super) value: Node,
}

/// Reads a document: first the limits, then strict validation, then the tree with its places.
///
/// Two libraries share the work: `serde_json` decides what is JSON (RFC 8259, nothing more), `jsonc-parser` says
/// where everything is. Neither sees a document before its nesting is known to be small, since both recurse.
///
/// # Errors
/// The first thing that is wrong with the document as JSON.
pub(super) fn parse(text: &str) -> Result<Node, SpecError> {
    if text.trim().is_empty() {
        return Err(SpecError::new(ErrorKind::Syntax, "", 0..0, "the document is empty").help("expected a JSON object"));
    }
    limits::check(text)?;
    if let Err(error) = serde_json::from_str::<serde::de::IgnoredAny>(text) {
        return Err(syntax_error(text, &error));
    }
    let strict = ParseOptions {
        allow_comments: false,
        allow_loose_object_property_names: false,
        allow_trailing_commas: false,
        allow_missing_commas: false,
        allow_single_quoted_strings: false,
        allow_hexadecimal_numbers: false,
        allow_unary_plus_numbers: false,
        allow_bare_decimal_point_numbers: false,
        allow_non_finite_numbers: false,
        allow_extended_string_escapes: false,
    };
    // What the first reader lets pass and the second refuses is the escape of half a surrogate pair.
    let tree = parse_to_ast(text, &CollectOptions::default(), &strict).map_err(|error| {
        let range = error.range();
        SpecError::new(ErrorKind::Syntax, "", range.start..range.end, format!("not valid JSON: {}", error.kind()))
    })?;
    match tree.value {
        Some(value) => node(value, &mut Vec::new()),
        None => {
            Err(SpecError::new(ErrorKind::Syntax, "", 0..0, "the document is empty").help("expected a JSON object"))
        }
    }
}

/// Whether a text has a line that C code has and JSON, TOML and YAML have not.
fn is_c(text: &str) -> bool {
    let types = ["void ", "double ", "float ", "int ", "static ", "typedef ", "struct ", "extern "];
    text.lines().map(str::trim).any(|line| {
        let included = line.strip_prefix("#include").map(str::trim_start);
        let declares = types.iter().any(|start| line.starts_with(start)) && line.ends_with([';', '{', '}', ')', ',']);
        included.is_some_and(|what| what.starts_with(['<', '"'])) || declares
    })
}

/// What to do with a document that starts as one of another notation.
fn other_notation(text: &str) -> Option<&'static str> {
    const C: &str = "this looks like C code, which is not read: a plant is its formulas in JSON or TOML; `sigmastar new plant -o plant.jsonc` \
                     writes one to start from";
    const TOML: &str = "this looks like TOML: name the file `.toml`, which is read";
    const YAML: &str = "this looks like YAML, which is not read: write it as JSON, or as TOML in a file named `.toml`";
    if is_c(text) {
        return Some(C);
    }
    let first = text.lines().map(str::trim).find(|line| !line.is_empty() && !line.starts_with('#'))?;
    let is_key = |key: &str| {
        let bare = key.trim().trim_matches(['"', '\'']);
        !bare.is_empty() && bare.chars().all(|c| c.is_alphanumeric() || matches!(c, '_' | '-' | '.' | '$'))
    };
    let is_table = first.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')).is_some_and(is_key);
    if first.split_once('=').is_some_and(|(key, _)| is_key(key)) || is_table {
        return Some(TOML);
    }
    let yaml_key =
        first.split_once(':').is_some_and(|(key, rest)| is_key(key) && (rest.is_empty() || rest.starts_with(' ')));
    (first.starts_with("---") || first.starts_with("%YAML") || yaml_key).then_some(YAML)
}

/// The parser's complaint, in its place.
fn syntax_error(text: &str, error: &serde_json::Error) -> SpecError {
    let line_start = match error.line() {
        0 | 1 => 0,
        line => text.match_indices('\n').nth(line - 2).map_or(text.len(), |(position, _)| position + 1),
    };
    // The column counts bytes from 1; at the end of the document it points past the last one.
    let at = floor_boundary(text, line_start + error.column().saturating_sub(1));
    let end = text[at..].chars().next().map_or(at, |c| at + c.len_utf8());
    let full = error.to_string();
    let suffix = format!(" at line {} column {}", error.line(), error.column());
    let message = full.strip_suffix(&suffix).unwrap_or(&full);
    let located = SpecError::new(ErrorKind::Syntax, "", at..end, format!("not valid JSON: {message}"));
    if let Some(help) = other_notation(text) {
        return located.help(help);
    }
    if let Some(help) = missing_quotes(text, at, message) {
        return located.help(help);
    }
    if message.starts_with("EOF") {
        return located.help("the text ends before its value does: a closing brace, bracket or quote is missing");
    }
    match &text[at..end] {
        "%" => located.help(percent(&text[..at])),
        "/" | "#" => located.help("JSON has no comments; name the file `.jsonc`, or put remarks in `description`"),
        "'" => located.help("strings stand in double quotes"),
        "}" | "]" if text[..at].trim_end().ends_with(',') => located.help("remove the comma in front of it"),
        _ => located,
    }
}

/// What to write where the parser meets at `at` a text without quotes, or what goes on behind a number.
fn missing_quotes(text: &str, at: usize, message: &str) -> Option<String> {
    let is_name = |c: char| c.is_alphanumeric() || matches!(c, '_' | '$' | '(' | '-');
    let until = |start: usize, ends: &[char]| {
        let rest = text[start..].lines().next().unwrap_or_default();
        rest[..rest.find(ends).unwrap_or(rest.len())].trim_end().to_owned()
    };
    let starts_a_name = text[at..].starts_with(is_name);
    match message {
        "key must be a string" if text[at..].starts_with(|c: char| c.is_ascii_digit()) => {
            Some("decimals have a point, as in 1.5".to_owned())
        }
        "key must be a string" if starts_a_name => {
            let key = until(at, &[':', ',', '}']);
            Some(format!("the names of fields stand in double quotes: `\"{}\"`", shown(&key)))
        }
        "expected value" if starts_a_name => {
            let value = until(at, &[',', '}', ']', '"']);
            Some(match value.to_lowercase().as_str() {
                word @ ("true" | "false" | "null") => format!("write `{word}`"),
                _ => format!("texts and formulas stand in double quotes: `\"{}\"`", shown(&value)),
            })
        }
        "expected `,` or `}`" | "expected `,` or `]`" => {
            let before = text[..at].trim_end();
            let start =
                before.trim_end_matches(|c: char| c.is_ascii_digit() || matches!(c, '.' | '-' | '+' | 'e' | 'E')).len();
            let (number, rest) = (&before[start..], &text[at..]);
            let is_comment = ["//", "/*"].iter().any(|start| rest.starts_with(start));
            let goes_on =
                rest.starts_with(|c: char| c.is_alphabetic() || matches!(c, '_' | '*' | '/' | '^' | '+' | '-' | '('));
            if number.starts_with(|c: char| c.is_ascii_digit() || c == '-') && goes_on && !is_comment {
                let value = until(start, &[',', '}', ']', '"']);
                return Some(format!("formulas and fractions stand in double quotes: `\"{}\"`", shown(&value)));
            }
            text[at..].starts_with(['"', '{', '[']).then(|| "put a comma in front of it".to_owned())
        }
        _ => None,
    }
}

/// Takes over a value; `path` leads to it and is spelled out only for an error, since keys may be long.
fn node(value: ast::Value<'_>, path: &mut Vec<String>) -> Result<Node, SpecError> {
    let range = value.range();
    let content = match value {
        ast::Value::NullKeyword(_) => Content::Null,
        ast::Value::BooleanLit(literal) => Content::Boolean(literal.value),
        ast::Value::NumberLit(literal) => Content::Number(literal.value.to_owned()),
        ast::Value::StringLit(literal) => Content::Text(literal.value.into_owned()),
        ast::Value::Array(array) => {
            let mut elements = Vec::with_capacity(array.elements.len());
            for (index, element) in array.elements.into_iter().enumerate() {
                path.push(index.to_string());
                elements.push(node(element, path)?);
                path.pop();
            }
            Content::Array(elements)
        }
        ast::Value::Object(object) => Content::Object(members(object, path)?),
    };
    Ok(Node { span: range.start..range.end, content })
}

fn members(object: ast::Object<'_>, path: &mut Vec<String>) -> Result<Vec<Member>, SpecError> {
    let mut members = Vec::with_capacity(object.properties.len());
    let mut seen = HashSet::with_capacity(object.properties.len());
    for property in object.properties {
        let range = property.name.range();
        let key_span = range.start..range.end;
        let key = match property.name {
            ast::ObjectPropName::String(literal) => literal.value.into_owned(),
            ast::ObjectPropName::Word(word) => word.value.to_owned(),
        };
        path.push(key.clone());
        if !seen.insert(key.clone()) {
            let pointer: String = path.iter().map(|step| format!("/{}", escape_pointer(step))).collect();
            let message = format!("the field `{}` is given twice", shown(&key));
            return Err(SpecError::new(ErrorKind::DuplicateKey, pointer, key_span, message)
                .expected("the second time")
                .help("readers disagree on which of the two counts; remove one"));
        }
        members.push(Member { value: node(property.value, path)?, key, key_span });
        path.pop();
    }
    Ok(members)
}

/// A key as a part of a JSON pointer (RFC 6901).
pub(super) fn escape_pointer(key: &str) -> String {
    key.replace('~', "~0").replace('/', "~1")
}

impl Node {
    /// The members of the object at a pointer.
    pub(super) fn members_at(&mut self, pointer: &str) -> Option<&mut Vec<Member>> {
        let steps = pointer.split('/').skip(1).map(|step| step.replace("~1", "/").replace("~0", "~"));
        let mut node = self;
        for step in steps {
            let Content::Object(members) = &mut node.content else { return None };
            node = &mut members.iter_mut().find(|member| member.key == step)?.value;
        }
        match &mut node.content {
            Content::Object(members) => Some(members),
            _ => None,
        }
    }

    /// This value for `serde_json`: key order and the text of numbers as in the document.
    pub(super) fn to_json(&self) -> serde_json::Value {
        match &self.content {
            Content::Null => serde_json::Value::Null,
            Content::Boolean(value) => serde_json::Value::Bool(*value),
            // Parsing would rewrite exponents (1E2 as 1e+2), and the digest is over numbers as written. The text is
            // a JSON number: both readers took it as one.
            Content::Number(text) => serde_json::Value::Number(serde_json::Number::from_string_unchecked(text.clone())),
            Content::Text(text) => serde_json::Value::String(text.clone()),
            Content::Array(elements) => serde_json::Value::Array(elements.iter().map(Node::to_json).collect()),
            Content::Object(members) => serde_json::Value::Object(
                members.iter().map(|member| (member.key.clone(), member.value.to_json())).collect(),
            ),
        }
    }
}

/// Where the bytes `range` of a decoded string stand in the document, given the span of its literal (with quotes).
pub(super) fn locate(text: &str, literal: &Range<usize>, range: &Range<usize>) -> Range<usize> {
    let inside = literal.start + 1..literal.end.saturating_sub(1).max(literal.start + 1);
    let Some(raw) = text.get(inside.clone()) else { return literal.clone() };
    let mut decoded = 0;
    let mut start = None;
    let mut at = 0;
    while let Some(c) = raw[at..].chars().next() {
        let (raw_length, decoded_length) =
            if c == '\\' { escape_lengths(&raw[at..]) } else { (c.len_utf8(), c.len_utf8()) };
        let next = decoded + decoded_length;
        if start.is_none() && range.start < next {
            start = Some(inside.start + at);
        }
        if range.end <= next && (range.end > range.start || start.is_some()) {
            let begin = start.unwrap_or(inside.start + at);
            // An empty range is a place between two characters.
            let end = if range.is_empty() { begin } else { inside.start + at + raw_length };
            return begin..end;
        }
        decoded = next;
        at += raw_length;
    }
    start.unwrap_or(inside.end)..inside.end
}

/// How many bytes an escape takes in the document, and how many its character takes in the string.
fn escape_lengths(raw: &str) -> (usize, usize) {
    let unit = |at: usize| raw.get(at + 2..at + 6).and_then(|digits| u32::from_str_radix(digits, 16).ok());
    if !raw.starts_with("\\u") {
        return (2.min(raw.len()), 1);
    }
    match unit(0) {
        // A surrogate pair: two escapes for one character of four bytes.
        Some(0xD800..=0xDBFF) => (12.min(raw.len()), 4),
        Some(code) => (6, char::from_u32(code).map_or(1, char::len_utf8)),
        None => (raw.len(), 1),
    }
}

/// The largest character boundary of the text that is not beyond `index`.
pub(super) fn floor_boundary(text: &str, index: usize) -> usize {
    let mut index = index.min(text.len());
    // 0 is a boundary.
    while !text.is_char_boundary(index) {
        index -= 1;
    }
    index
}
