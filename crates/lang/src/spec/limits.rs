//! Limits that hold before anything recursive or costly looks at a document.

use super::error::{ErrorKind, SpecError};
use sigmastar_exact::number::{MAX_EXPONENT, MAX_LENGTH};
use std::ops::Range;

/// The largest document that is read, in bytes.
pub const MAX_BYTES: usize = 1 << 20;

/// The deepest nesting of arrays and objects that is read.
pub const MAX_NESTING: usize = 64;

/// The most values (scalars, arrays and objects together) that are read.
pub const MAX_VALUES: usize = 100_000;

pub(super) fn too_large() -> SpecError {
    SpecError::new(ErrorKind::Limit, "", 0..0, format!("the document has more than {MAX_BYTES} bytes"))
        .expected(format!("at most {MAX_BYTES} bytes are read"))
}

/// `objects` is what the notation calls them.
pub(super) fn too_deep(objects: &str, pointer: &str, span: Range<usize>) -> SpecError {
    let message = format!("arrays and {objects} are nested more than {MAX_NESTING} deep");
    SpecError::new(ErrorKind::Limit, pointer, span, message).expected(format!("at most {MAX_NESTING} levels are read"))
}

pub(super) fn too_many_values(span: Range<usize>) -> SpecError {
    SpecError::new(ErrorKind::Limit, "", span, format!("the document has more than {MAX_VALUES} values"))
        .expected(format!("at most {MAX_VALUES} values are read"))
}

/// One pass over the bytes, without recursion and before any parser: nesting, number of values, numerals.
///
/// On text that is not JSON the counts mean little, but they are bounded all the same; the parser comes next.
///
/// # Errors
/// The first limit that is exceeded.
pub(super) fn check(text: &str) -> Result<(), SpecError> {
    let bytes = text.as_bytes();
    let mut depth = 0_usize;
    let mut values = 1_usize;
    let mut previous = 0_u8;
    let mut at = 0;
    while at < bytes.len() {
        let byte = bytes[at];
        let start = at;
        at += 1;
        // An array or object has one value more than it has commas, unless it is empty.
        if matches!(previous, b'[' | b'{') && !byte.is_ascii_whitespace() && !matches!(byte, b']' | b'}') {
            values += 1;
        }
        match byte {
            b'"' => {
                while at < bytes.len() && bytes[at] != b'"' {
                    at += if bytes[at] == b'\\' { 2 } else { 1 };
                }
                at = (at + 1).min(bytes.len());
            }
            b'[' | b'{' => {
                depth += 1;
                if depth > MAX_NESTING {
                    return Err(too_deep("objects", "", start..at));
                }
            }
            b']' | b'}' => depth = depth.saturating_sub(1),
            b',' => values += 1,
            b'-' | b'0'..=b'9' => {
                while at < bytes.len() && matches!(bytes[at], b'0'..=b'9' | b'+' | b'-' | b'.' | b'e' | b'E') {
                    at += 1;
                }
                numeral(&text[start..at], start)?;
            }
            _ => {}
        }
        if values > MAX_VALUES {
            return Err(too_many_values(start..at));
        }
        if !byte.is_ascii_whitespace() {
            previous = byte;
        }
    }
    Ok(())
}

/// Refuses numerals that `number::parse_decimal` would refuse for their size, without computing their value.
///
/// # Errors
/// A numeral that is too long, or has too large an exponent.
pub(super) fn numeral(text: &str, start: usize) -> Result<(), SpecError> {
    let error = |message: String| Err(SpecError::new(ErrorKind::Limit, "", start..start + text.len(), message));
    if text.len() > MAX_LENGTH {
        return error(format!("a number of {} characters; at most {MAX_LENGTH} are read", text.len()));
    }
    let Some((_, exponent)) = text.split_once(['e', 'E']) else { return Ok(()) };
    let digits = exponent.trim_start_matches(['+', '-']).trim_start_matches('0');
    // More digits than fit u32 are certainly beyond the limit; anything else that does not parse is left to the
    // JSON parser to refuse.
    let beyond = digits.len() > 9 || digits.parse::<u32>().is_ok_and(|magnitude| magnitude > MAX_EXPONENT);
    if beyond {
        return error(format!("the exponent of this number exceeds {MAX_EXPONENT} in magnitude"));
    }
    Ok(())
}
