//! TOML as it is written: the same tree as that of JSON, with the place of every key and value, numbers as text.
//!
//! Numbers never pass through a double: their text is taken from the file. What JSON cannot write is refused.

use super::error::{ErrorKind, SpecError, shown};
use super::json::{Content, Member, Node, escape_pointer};
use super::limits::{self, MAX_NESTING, MAX_VALUES};
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Reads a document.
///
/// # Errors
/// The first thing that is wrong with the document as TOML; a limit exceeded; a value that JSON does not have.
pub(super) fn parse(text: &str) -> Result<Node, SpecError> {
    if text.trim().is_empty() {
        return Err(SpecError::new(ErrorKind::Syntax, "", 0..0, "the document is empty").help("expected TOML fields"));
    }
    // The parser bounds brackets, and the parts of one key, at 80 each before it recurses.
    let table = DeTable::parse(text).map_err(|error| refused(text, &error))?;
    let mut reader = Reader { text, path: Vec::new(), values: 0 };
    reader.value(0..text.len(), Value::Table(table.get_ref()))
}

/// The parser's complaint, in its place.
fn refused(text: &str, error: &toml::de::Error) -> SpecError {
    let at = error.span().unwrap_or(0..0);
    if ["recursion limit", "cannot recurse further; max recursion depth met"].contains(&error.message()) {
        return limits::too_deep("tables", "", at);
    }
    if error.message() == "duplicate key" {
        let key = text.get(at.clone()).unwrap_or_default();
        let message = format!("the field `{}` is given twice", shown(key));
        return SpecError::new(ErrorKind::DuplicateKey, "", at, message)
            .expected("the second time")
            .help("TOML allows a field, and the header of a table, once; remove one");
    }
    SpecError::new(ErrorKind::TomlSyntax, "", at, format!("not valid TOML: {}", error.message())).help(
        otherwise_written(text, error).unwrap_or_else(|| {
            "the name of the file ends in `.toml`, so it is read as TOML; formulas stand in quotes".to_owned()
        }),
    )
}

/// What to write for a decimal with a comma, and for a text without quotes.
fn otherwise_written(text: &str, error: &toml::de::Error) -> Option<String> {
    let at = error.span()?.start;
    let line_start = text.get(..at)?.rfind('\n').map_or(0, |end| end + 1);
    let line = text.get(line_start..)?.lines().next()?;
    if let Some([whole, places]) = decimal_comma(line.get(..at - line_start + 1).unwrap_or(line), line) {
        return Some(format!("decimals have a point: write `{}.{}`", shown(whole), shown(places)));
    }
    let unquoted = error.message().starts_with("string values must be quoted");
    let rest = text.get(at..).filter(|_| unquoted)?.lines().next()?;
    let value = rest[..rest.find([',', '}', ']', '#']).unwrap_or(rest.len())].trim_end();
    Some(format!("texts, formulas and fractions stand in quotes: `\"{}\"`", shown(value)))
}

/// The digits before and behind one of the last two commas of what was read of a line, where they are those of one number.
fn decimal_comma<'t>(read: &str, line: &'t str) -> Option<[&'t str; 2]> {
    let is_digit = |c: char| c.is_ascii_digit();
    read.match_indices(',').rev().take(2).find_map(|(comma, _)| {
        let (before, behind) = (line.get(..comma)?, line.get(comma + 1..)?);
        let whole = &before[before.trim_end_matches(is_digit).len()..];
        let places = &behind[..behind.find(|c: char| !is_digit(c)).unwrap_or(behind.len())];
        let is_value = before[..before.len() - whole.len()].trim_end().ends_with(['=', '-', '+']);
        (is_value && !whole.is_empty() && !places.is_empty()).then_some([whole, places])
    })
}

/// A value of the parser; the root is a table without a place.
#[derive(Clone, Copy)]
enum Value<'v, 'i> {
    Table(&'v DeTable<'i>),
    Other(&'v DeValue<'i>),
}

struct Reader<'t> {
    text: &'t str,
    path: Vec<String>,
    values: usize,
}

impl Reader<'_> {
    fn value(&mut self, span: Range<usize>, value: Value<'_, '_>) -> Result<Node, SpecError> {
        self.values += 1;
        if self.values > MAX_VALUES {
            return Err(limits::too_many_values(span));
        }
        let content = match value {
            Value::Table(table) | Value::Other(DeValue::Table(table)) => {
                self.nested(&span)?;
                Content::Object(self.members(table)?)
            }
            Value::Other(DeValue::Array(array)) => {
                self.nested(&span)?;
                let mut elements = Vec::with_capacity(array.len());
                for (index, element) in array.iter().enumerate() {
                    elements.push(self.child(index.to_string(), element)?);
                }
                Content::Array(elements)
            }
            Value::Other(DeValue::String(text)) => Content::Text(text.clone().into_owned()),
            Value::Other(DeValue::Boolean(value)) => Content::Boolean(*value),
            Value::Other(DeValue::Integer(integer)) if integer.radix() != 10 => {
                let message = "this number is not in decimal notation";
                let error = self.error(ErrorKind::Type, span, message).expected("expected a decimal number");
                return Err(error.help("write it with the digits 0 to 9"));
            }
            Value::Other(DeValue::Integer(_)) => self.number(&span)?,
            Value::Other(DeValue::Float(float)) if float.as_str().contains(['i', 'n']) => {
                let message = "infinity and nan are no numbers here";
                let error = self.error(ErrorKind::Type, span, message).expected("expected a finite number");
                return Err(error.help("leave out what has no bound, such as `domain`"));
            }
            Value::Other(DeValue::Float(_)) => self.number(&span)?,
            Value::Other(DeValue::Datetime(_)) => {
                let error = self.error(ErrorKind::Type, span, "no field is a date or a time");
                return Err(error.help("put it in quotes if it is a text"));
            }
        };
        Ok(Node { span, content })
    }

    /// The text of a number as JSON writes it: without `_` between digits and without a leading `+`.
    fn number(&self, span: &Range<usize>) -> Result<Content, SpecError> {
        let written = self.text.get(span.clone()).unwrap_or_default();
        let numeral = written.strip_prefix('+').unwrap_or(written).replace('_', "");
        limits::numeral(&numeral, span.start).map_err(|error| error.at(self.pointer(), span.clone()))?;
        // Every decimal number of TOML is one of JSON then; what is none would be a mistake of the parser.
        if serde_json::from_str::<serde_json::Number>(&numeral).is_err() {
            return Err(self.error(ErrorKind::TomlSyntax, span.clone(), "this is no decimal number"));
        }
        Ok(Content::Number(numeral))
    }

    fn members(&mut self, table: &DeTable<'_>) -> Result<Vec<Member>, SpecError> {
        // In the order of the file: a table keeps the place of its first mention.
        let mut entries: Vec<_> = table.iter().collect();
        entries.sort_by_key(|(key, _)| key.span().start);
        let mut members = Vec::with_capacity(entries.len());
        for (key, value) in entries {
            let name = key.get_ref().clone().into_owned();
            let value = self.child(name.clone(), value)?;
            members.push(Member { key: name, key_span: key.span(), value });
        }
        Ok(members)
    }

    fn child(&mut self, step: String, value: &Spanned<DeValue<'_>>) -> Result<Node, SpecError> {
        self.path.push(step);
        let node = self.value(value.span(), Value::Other(value.get_ref()))?;
        self.path.pop();
        Ok(node)
    }

    /// Refuses an array or table that is nested too deep: it is in as many others as its path has steps.
    fn nested(&self, span: &Range<usize>) -> Result<(), SpecError> {
        if self.path.len() < MAX_NESTING {
            Ok(())
        } else {
            Err(limits::too_deep("tables", &self.pointer(), span.clone()))
        }
    }

    fn error(&self, kind: ErrorKind, span: Range<usize>, message: &str) -> SpecError {
        SpecError::new(kind, self.pointer(), span, message)
    }

    fn pointer(&self) -> String {
        self.path.iter().map(|step| format!("/{}", escape_pointer(step))).collect()
    }
}

/// Where the bytes `range` of a decoded string stand in the document, given the span of its literal (with quotes): in a
/// literal without escapes the bytes themselves, else the whole literal.
pub(super) fn locate(text: &str, literal: &Range<usize>, range: &Range<usize>) -> Range<usize> {
    let raw = text.get(literal.clone()).unwrap_or_default();
    let quote = if raw.starts_with("\"\"\"") || raw.starts_with("'''") { 3 } else { 1 };
    let inside = raw.get(quote..raw.len().saturating_sub(quote)).unwrap_or_default();
    // A line feed right behind three quotes is no part of the string.
    let skipped = usize::from(quote == 3 && inside.starts_with('\n'));
    let plain = raw.starts_with('\'') || !inside.contains('\\');
    // Line ends may be read otherwise than they are written.
    if !plain || inside.contains('\r') {
        return literal.clone();
    }
    let start = literal.start + quote + skipped;
    let within = |offset: usize| start.saturating_add(offset).min(literal.end.saturating_sub(quote));
    within(range.start)..within(range.end.max(range.start))
}
