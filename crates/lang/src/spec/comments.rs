//! Comments of JSON, taken away.

use jsonc_parser::Scanner;
use jsonc_parser::ScannerOptions;
use jsonc_parser::tokens::Token;

/// A text with blanks in the place of its comments: every other byte stays where it is, so places are those of the file,
/// and what is left is read as strict JSON.
///
/// The scanner finds where strings and comments begin and end. From what it cannot read on the text is left as it is: that
/// is no JSON, and the strict reader says so.
pub(super) fn blanked(text: &str) -> String {
    let strict = ScannerOptions {
        allow_single_quoted_strings: false,
        allow_hexadecimal_numbers: false,
        allow_unary_plus_numbers: false,
        ..ScannerOptions::default()
    };
    let mut scanner = Scanner::new(text, &strict);
    let mut output = String::with_capacity(text.len());
    while let Ok(Some(token)) = scanner.scan() {
        if matches!(token, Token::CommentLine(_) | Token::CommentBlock(_)) {
            let (start, end) = (scanner.token_start(), scanner.token_end());
            output.push_str(text.get(output.len()..start).unwrap_or_default());
            let comment = text.get(start..end).unwrap_or_default();
            output
                .extend(comment.bytes().map(|byte| if matches!(byte, b'\n' | b'\r') { char::from(byte) } else { ' ' }));
        }
    }
    output.push_str(text.get(output.len()..).unwrap_or_default());
    output
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_comments_are_blanked() {
        for (text, expected) in [
            ("{} // a\n", "{}     \n"),
            ("/* a\n b */ 1", "    \n      1"),
            (r#"{ "a": "//b /* c */" }"#, r#"{ "a": "//b /* c */" }"#),
            (r#"["\"// a", /* b */ "\\"/*/ */]"#, r#"["\"// a",         "\\"      ]"#),
            ("1/**/2", "1    2"),
            ("// é\n1", "     \n1"),
            ("1 /* not closed", "1 /* not closed"),
        ] {
            assert_eq!(blanked(text), expected, "{text}");
            assert_eq!(blanked(text).len(), text.len());
        }
    }
}
