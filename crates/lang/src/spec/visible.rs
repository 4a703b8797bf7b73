//! Characters that make an editor show a text otherwise than it is read.

use super::error::{ErrorKind, SpecError};

/// Refuses what could hide a field in a comment, or a comment in a field: characters that some editors show as the end of a
/// line and others do not, and those that change the direction of the text. Where comments are allowed, what a reader sees
/// must be what is read.
///
/// # Errors
/// The first such character.
pub(super) fn check(text: &str) -> Result<(), SpecError> {
    let mut rest = text.char_indices().peekable();
    while let Some((at, c)) = rest.next() {
        let what = match c {
            '\r' if rest.peek().is_none_or(|(_, next)| *next != '\n') => "a carriage return without a line feed",
            '\u{b}' | '\u{c}' | '\u{85}' | '\u{2028}' | '\u{2029}' => "a line end that many editors do not show as one",
            '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => "a mark that changes the direction of the text",
            _ => continue,
        };
        let message = format!("U+{:04X} is {what}", u32::from(c));
        let error = SpecError::new(ErrorKind::Encoding, "", at..at + c.len_utf8(), message);
        return Err(error.help(format!("remove it; in a string, write `\\u{:04x}`", u32::from(c))));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_hides_text_is_refused_in_its_place() {
        for (text, at) in
            [("// a\rb", 4), ("a\r", 1), ("é\u{2028}", 2), ("\u{202e}", 0), ("\"\u{2067}\"", 1), ("\u{b}", 0)]
        {
            assert_eq!(check(text).expect_err(text).span.start, at, "{text:?}");
        }
        for text in ["", "a\r\nb\n\t", "\u{5e9}\u{5dc}\u{5d5}\u{5dd}", "\u{2026}"] {
            assert!(check(text).is_ok(), "{text:?}");
        }
    }
}
