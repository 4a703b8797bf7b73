//! A document and its values, each with its place.

use super::error::{ErrorKind, Errors, Reported, SpecError, SpecErrors};
use super::json::{self, Content, Member, Node};
use super::limits::{self, MAX_BYTES};
use super::notation::Notation;
use super::source::Source;
use crate::expr::ExprError;
use sha2::{Digest, Sha256};
use std::ops::Range;
use std::sync::Arc;

/// The name of the document that a flag of the command line is.
pub(super) const COMMAND_LINE: &str = "<command line>";

/// The field with which a document names its schema for editors.
const SCHEMA: &str = "$schema";

/// A document that was read strictly: RFC 8259, or another [`Notation`] of the same values, no duplicate keys, within the
/// limits of this module ([`MAX_BYTES`], [`MAX_NESTING`](super::MAX_NESTING), [`MAX_VALUES`](super::MAX_VALUES)), with
/// numbers kept as written. Specifications, certificates and witness files are all read through it. Cheap to clone.
#[derive(Clone, Debug)]
pub struct Document {
    source: Arc<Source>,
    notation: Notation,
    root: Arc<Node>,
    /// The pointers of what is not in the text.
    put_in: Vec<String>,
}

impl Document {
    /// Reads a document from its text in JSON; `label` is what errors call it, usually its path. A byte order mark in front
    /// is no part of the text (RFC 8259, section 8.1): places are counted, and digests formed, without it.
    ///
    /// # Errors
    /// What is wrong with the text as JSON: a limit exceeded, a syntax error, a duplicate key.
    pub fn parse(label: &str, text: &str) -> Result<Document, SpecErrors> {
        Document::parse_as(label, text, Notation::Json)
    }

    /// Reads a document as [`Document::parse`] does, from its text in another notation.
    ///
    /// # Errors
    /// What is wrong with the text in this notation.
    pub fn parse_as(label: &str, text: &str, notation: Notation) -> Result<Document, SpecErrors> {
        if text.len() > MAX_BYTES {
            return Err(SpecErrors::single(source(label, ""), limits::too_large()));
        }
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let source = source(label, text);
        match notation.parse(text) {
            Ok(root) => Ok(Document { source, notation, root: Arc::new(root), put_in: Vec::new() }),
            Err(error) => Err(SpecErrors::single(source, error)),
        }
    }

    /// The value of a command-line flag, as an object whose only field has the name of the flag. Errors show the flag and
    /// its value as they are typed.
    #[must_use]
    pub fn flag(flag: &str, value: &str) -> Document {
        let text = format!("{flag} {value}");
        // The text of a number is taken as it is, unlike that of a string, which has quotes and escapes.
        let number = Node { span: text.len() - value.len()..text.len(), content: Content::Number(value.to_owned()) };
        let member = json::Member { key: flag.to_owned(), key_span: 0..flag.len(), value: number };
        let root = Node { span: 0..text.len(), content: Content::Object(vec![member]) };
        let source = source(COMMAND_LINE, &text);
        Document { source, notation: Notation::Json, root: Arc::new(root), put_in: Vec::new() }
    }

    /// Reads a document in JSON from bytes.
    ///
    /// # Errors
    /// Those of [`Document::from_bytes_as`].
    pub fn from_bytes(label: &str, bytes: &[u8]) -> Result<Document, SpecErrors> {
        Document::from_bytes_as(label, bytes, Notation::Json)
    }

    /// Reads a document from bytes.
    ///
    /// # Errors
    /// Bytes that are not UTF-8, and those of [`Document::parse_as`].
    pub fn from_bytes_as(label: &str, bytes: &[u8], notation: Notation) -> Result<Document, SpecErrors> {
        if bytes.len() > MAX_BYTES {
            return Err(SpecErrors::single(source(label, ""), limits::too_large()));
        }
        match std::str::from_utf8(bytes) {
            Ok(text) => Document::parse_as(label, text, notation),
            Err(error) => {
                let at = error.valid_up_to();
                // The valid part serves to show where the trouble starts.
                let valid = String::from_utf8_lossy(&bytes[..at]);
                let utf_16 = bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]);
                let (message, help) = if utf_16 {
                    (
                        "the file is UTF-16, not UTF-8".to_owned(),
                        "save it as UTF-8; in PowerShell: `Set-Content -Encoding utf8`",
                    )
                } else {
                    (format!("byte {at} (0x{:02x}) is not UTF-8", bytes[at]), "save the file as UTF-8")
                };
                let error = SpecError::new(ErrorKind::Encoding, "", at..at, message).help(help);
                Err(SpecErrors::single(source(label, &valid), error))
            }
        }
    }

    /// The name under which errors show the document.
    #[must_use]
    pub fn label(&self) -> &str {
        &self.source.label
    }

    /// The text that the document was read from.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.source.text
    }

    /// How the text is written.
    #[must_use]
    pub fn notation(&self) -> Notation {
        self.notation
    }

    /// The value that is the whole document.
    #[must_use]
    pub fn root(&self) -> Value<'_> {
        Value { document: self, node: &self.root, pointer: String::new(), key: None }
    }

    /// The value at a JSON pointer (RFC 6901), if there is one.
    #[must_use]
    pub fn at(&self, pointer: &str) -> Option<Value<'_>> {
        let mut value = self.root();
        if pointer.is_empty() {
            return Some(value);
        }
        for step in pointer.strip_prefix('/')?.split('/') {
            let step = step.replace("~1", "/").replace("~0", "~");
            value = match &value.node.content {
                Content::Object(_) => value.member(&step)?,
                Content::Array(_) => value.element(step.parse().ok()?)?,
                _ => return None,
            };
        }
        Some(value)
    }

    /// This document with a text as the field `name` of the object at a pointer, in the place of its own where it has one; itself where there is no
    /// such object. Its [text](Document::text) stays what was read: an error about the field is told at the field that it replaces, or at the object.
    ///
    /// # Errors
    /// A document that would be too large with it.
    pub fn with_field(&self, object: &str, name: &str, text: &str) -> Result<Document, SpecErrors> {
        if self.text().len() + name.len() + text.len() > MAX_BYTES {
            return Err(SpecErrors::single(self.source.clone(), limits::too_large()));
        }
        let Some(place) = self.at(object).map(|object| object.key_span()) else { return Ok(self.clone()) };
        let mut root = Node::clone(&self.root);
        let Some(members) = root.members_at(object) else { return Ok(self.clone()) };
        let value = |span: &Range<usize>| Node { span: span.clone(), content: Content::Text(text.to_owned()) };
        match members.iter_mut().find(|member| member.key == name) {
            Some(member) => member.value = value(&member.value.span),
            None => members.push(Member { key: name.to_owned(), key_span: place.clone(), value: value(&place) }),
        }
        let put_in = self.put_in.iter().cloned().chain([format!("{object}/{}", json::escape_pointer(name))]).collect();
        Ok(Document { root: Arc::new(root), put_in, ..self.clone() })
    }

    pub(super) fn source(&self) -> &Arc<Source> {
        &self.source
    }

    /// An error that is found after reading, in the string at a pointer; `part` are the bytes of the decoded text at fault.
    #[must_use]
    pub fn errors_at(
        &self,
        pointer: &str,
        part: &Range<usize>,
        kind: ErrorKind,
        message: impl Into<String>,
        help: Option<String>,
    ) -> SpecErrors {
        let value = self.at(pointer).unwrap_or_else(|| self.root());
        let mut error = value.error_in(kind, part, message);
        error.help = help;
        SpecErrors::single(self.source.clone(), error)
    }
}

fn source(label: &str, text: &str) -> Arc<Source> {
    Arc::new(Source { label: label.to_owned(), text: text.to_owned() })
}

/// The text with sorted keys and without white space; it cannot fail, since every key is a text.
fn canonical(mut value: serde_json::Value) -> String {
    value.sort_all_objects();
    value.to_string()
}

fn sha256(value: serde_json::Value) -> String {
    Sha256::digest(canonical(value)).iter().map(|byte| format!("{byte:02x}")).collect()
}

impl Errors {
    /// The outcome of reading `document`: the value if nothing was reported.
    ///
    /// # Errors
    /// Everything that was reported, in file order.
    pub fn conclude<T>(self, document: &Document, outcome: Result<T, Reported>) -> Result<T, SpecErrors> {
        match outcome {
            Ok(value) if self.list.is_empty() => Ok(value),
            // `Err` carries a `Reported`, so the list is not empty here either.
            _ => Err(self.into_errors(document)),
        }
    }

    /// What was reported of a document, in file order. Hypothesis: something was.
    #[must_use]
    pub fn into_errors(mut self, document: &Document) -> SpecErrors {
        self.list.sort_by_key(|error| (error.span.start, error.span.end));
        SpecErrors { origin: document.source().clone(), errors: self.list, omitted: self.omitted, in_full: None }
    }
}

/// A value in a document: it knows its JSON pointer and its place.
#[derive(Clone, Debug)]
pub struct Value<'d> {
    document: &'d Document,
    pub(super) node: &'d Node,
    pointer: String,
    key: Option<Range<usize>>,
}

impl<'d> Value<'d> {
    /// What is read of the value, if nothing is wrong with it.
    ///
    /// # Errors
    /// Everything that `read` reports, in file order.
    pub fn read<T>(&self, read: impl FnOnce(&Value<'d>, &mut Errors) -> Result<T, Reported>) -> Result<T, SpecErrors> {
        let mut errors = Errors::new();
        let outcome = read(self, &mut errors);
        errors.conclude(self.document, outcome)
    }

    /// The JSON pointer (RFC 6901) of the value.
    #[must_use]
    pub fn pointer(&self) -> &str {
        &self.pointer
    }

    /// The bytes of the document that the value takes, quotes and brackets included.
    #[must_use]
    pub fn span(&self) -> Range<usize> {
        self.node.span.clone()
    }

    /// The document that the value stands in.
    #[must_use]
    pub fn document(&self) -> &'d Document {
        self.document
    }

    /// The text of a JSON number, as written; `None` for other values.
    #[must_use]
    pub fn numeral(&self) -> Option<&'d str> {
        match &self.node.content {
            Content::Number(text) => Some(text),
            _ => None,
        }
    }

    /// The decoded text of a JSON string; `None` for other values.
    #[must_use]
    pub fn text(&self) -> Option<&'d str> {
        match &self.node.content {
            Content::Text(text) => Some(text),
            _ => None,
        }
    }

    /// An error about this value; it points at the value, or at the opening bracket of an array or object.
    #[must_use]
    pub fn error(&self, kind: ErrorKind, message: impl Into<String>) -> SpecError {
        SpecError::new(kind, self.pointer.clone(), self.anchor(), message)
    }

    /// An error about the key under which this value stands.
    #[must_use]
    pub(super) fn error_at_key(&self, kind: ErrorKind, message: impl Into<String>) -> SpecError {
        SpecError::new(kind, self.pointer.clone(), self.key_span(), message)
    }

    /// An error about a part of the text in this value: `part` is in bytes of the decoded string or of the numeral,
    /// and is mapped back through the escapes of the literal.
    #[must_use]
    pub fn error_in(&self, kind: ErrorKind, part: &Range<usize>, message: impl Into<String>) -> SpecError {
        let span = match &self.node.content {
            // What was put in is not what stands there.
            Content::Text(_) if self.document.put_in.contains(&self.pointer) => self.anchor(),
            Content::Text(_) => self.document.notation.locate(&self.document.source.text, &self.node.span, part),
            Content::Number(_) => {
                let within = |offset: usize| self.node.span.start.saturating_add(offset).min(self.node.span.end);
                within(part.start)..within(part.end.max(part.start))
            }
            _ => self.anchor(),
        };
        SpecError::new(kind, self.pointer.clone(), span, message)
    }

    /// The error of an expression in this value, in its place.
    #[must_use]
    pub fn expression_error(&self, error: &ExprError) -> SpecError {
        let located = self.error_in(ErrorKind::Expression, &error.span, error.to_string());
        let located = match &error.expected {
            Some(expected) => located.expected(format!("expected {expected}")),
            None => located,
        };
        match &error.help {
            Some(help) => located.help(help),
            None => located,
        }
    }

    /// What the value is, for messages.
    #[must_use]
    pub fn type_name(&self) -> &'static str {
        match self.node.content {
            Content::Null => "null",
            Content::Boolean(_) => "a boolean",
            Content::Number(_) => "a number",
            Content::Text(_) => "a string",
            Content::Array(_) => "an array",
            Content::Object(_) => "an object",
        }
    }

    /// Reports that the value has the wrong JSON type.
    pub fn wrong_type(&self, expected: &str, errors: &mut Errors) -> Reported {
        let message = format!("{} is {}", self.name(), self.type_name());
        let error = self.error(ErrorKind::Type, message).expected(format!("expected {expected}"));
        errors.report(match self.otherwise_quoted(expected) {
            Some(help) => error.help(help),
            None => error,
        })
    }

    /// What to write where quotes are missing, or stand around a number or a word that has none.
    fn otherwise_quoted(&self, expected: &str) -> Option<String> {
        match (&self.node.content, expected) {
            (Content::Number(numeral), "a string") => Some(format!("a text stands in quotes: write `\"{numeral}\"`")),
            (Content::Text(text), "true or false") if matches!(text.as_str(), "true" | "false") => {
                Some(format!("write `{text}`, without quotes"))
            }
            (Content::Text(text), "a whole number") if text.parse::<u64>().is_ok() => {
                Some(format!("write `{text}`, without quotes"))
            }
            _ => None,
        }
    }

    /// The elements of an array.
    ///
    /// # Errors
    /// Reports a value that is not an array.
    pub fn array(&self, errors: &mut Errors) -> Result<Vec<Value<'d>>, Reported> {
        match self.node.content {
            Content::Array(_) => Ok(self.elements()),
            Content::Text(_) => {
                let message = format!("{} is {}", self.name(), self.type_name());
                let error = self.error(ErrorKind::Type, message).expected("expected an array");
                Err(errors.report(error.help("a list stands in brackets, also one of a single text: `[\"...\"]`")))
            }
            _ => Err(self.wrong_type("an array", errors)),
        }
    }

    /// What is read of each element of an array; all of them are read before the first error ends it.
    ///
    /// # Errors
    /// Reports a value that is not an array, and the first error of `read`.
    pub fn each<T>(
        &self,
        errors: &mut Errors,
        mut read: impl FnMut(&Value<'d>, &mut Errors) -> Result<T, Reported>,
    ) -> Result<Vec<T>, Reported> {
        let read: Vec<Result<T, Reported>> = self.array(errors)?.iter().map(|value| read(value, errors)).collect();
        read.into_iter().collect()
    }

    /// The text of a string.
    ///
    /// # Errors
    /// Reports a value that is not a string.
    pub fn string(&self, errors: &mut Errors) -> Result<&'d str, Reported> {
        self.text().ok_or_else(|| self.wrong_type("a string", errors))
    }

    /// A boolean.
    ///
    /// # Errors
    /// Reports a value that is neither `true` nor `false`.
    pub fn boolean(&self, errors: &mut Errors) -> Result<bool, Reported> {
        match self.node.content {
            Content::Boolean(value) => Ok(value),
            _ => Err(self.wrong_type("true or false", errors)),
        }
    }

    /// A whole number of at least 0 that is written with digits only.
    ///
    /// # Errors
    /// Reports anything else, and numbers beyond `u64`.
    pub fn integer(&self, errors: &mut Errors) -> Result<u64, Reported> {
        self.numeral().and_then(|numeral| numeral.parse().ok()).ok_or_else(|| self.wrong_type("a whole number", errors))
    }

    /// The canonical form: keys sorted by their UTF-8 bytes, no white space, numbers as written, strings with the
    /// escapes `\"`, `\\`, `\b`, `\t`, `\n`, `\f`, `\r` and lower-case `\u00xx` for the other characters below
    /// U+0020 and nothing else escaped (as `serde_json` writes them).
    #[must_use]
    pub fn canonical(&self) -> String {
        canonical(self.to_json())
    }

    /// SHA-256 of the [canonical form](Value::canonical), in lower-case hexadecimal.
    #[must_use]
    pub fn sha256(&self) -> String {
        sha256(self.to_json())
    }

    /// The value for `serde_json`, with key order and the text of numbers as in the document.
    ///
    /// Writing it gives the numbers as written. Converting it once more (`serde_json::to_value`, `json!`) does not:
    /// `serde_json` then rewrites exponents, and the digest of what comes out may differ. Move it instead.
    #[must_use]
    pub fn to_json(&self) -> serde_json::Value {
        self.node.to_json()
    }

    /// The value as a certificate embeds it, and the digest of that: without the `$schema` that a whole document may have,
    /// which is for editors and holds no data.
    #[must_use]
    pub fn embedded(&self) -> (serde_json::Value, String) {
        let mut data = self.to_json();
        if let (true, Some(fields)) = (self.pointer.is_empty(), data.as_object_mut()) {
            fields.shift_remove(SCHEMA);
        }
        let digest = sha256(data.clone());
        (data, digest)
    }

    /// The member of an object, if the value is one and has it.
    pub fn member(&self, name: &str) -> Option<Value<'d>> {
        self.raw_members().iter().find(|member| member.key == name).map(|member| self.of_member(member))
    }

    /// The element of an array, if the value is one and has it.
    pub(super) fn element(&self, index: usize) -> Option<Value<'d>> {
        self.elements().into_iter().nth(index)
    }

    /// The members of an object in the order of the document; none for other values.
    pub(super) fn members(&self) -> impl Iterator<Item = (&'d str, Value<'d>)> + '_ {
        self.raw_members().iter().map(|member| (member.key.as_str(), self.of_member(member)))
    }

    fn raw_members(&self) -> &'d [Member] {
        match &self.node.content {
            Content::Object(members) => members.as_slice(),
            _ => &[],
        }
    }

    fn of_member(&self, member: &'d Member) -> Value<'d> {
        Value {
            document: self.document,
            node: &member.value,
            pointer: format!("{}/{}", self.pointer, json::escape_pointer(&member.key)),
            key: Some(member.key_span.clone()),
        }
    }

    /// Where an error about a field that this object lacks should point: at its key, or its opening bracket.
    pub(super) fn key_span(&self) -> Range<usize> {
        self.key.clone().unwrap_or_else(|| self.anchor())
    }

    /// What messages call the value: its last key or index, or "the document".
    pub(super) fn name(&self) -> String {
        match self.pointer.rsplit('/').next() {
            None | Some("") => "the document".to_owned(),
            Some(name) => format!("`{}`", super::error::shown(name)),
        }
    }

    /// The elements of an array; none of any other value.
    pub(super) fn elements(&self) -> Vec<Value<'d>> {
        let elements = match &self.node.content {
            Content::Array(elements) => elements.as_slice(),
            _ => &[],
        };
        elements
            .iter()
            .enumerate()
            .map(|(index, node)| Value {
                document: self.document,
                node,
                pointer: format!("{}/{index}", self.pointer),
                key: None,
            })
            .collect()
    }

    fn anchor(&self) -> Range<usize> {
        match self.node.content {
            // A document in TOML has no bracket, and may have no byte.
            Content::Array(_) | Content::Object(_) => {
                self.node.span.start..self.node.span.end.min(self.node.span.start + 1)
            }
            _ => self.node.span.clone(),
        }
    }
}
