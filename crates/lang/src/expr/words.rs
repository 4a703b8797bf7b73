//! Expressions and names of a document within a sentence, which has letters of its own: a parameter may be called T or L as well.

use super::definitions::is_reserved;
use super::lex::{TokenKind, tokens};

/// A name of a document within a sentence.
#[must_use]
pub fn quoted(name: &str) -> String {
    format!("'{name}'")
}

/// An expression within a sentence: without white space, which only spreads it, and with the names of parameters [`quoted`].
#[must_use]
pub fn in_words(text: &str) -> String {
    let word = |kind: TokenKind, part: &str| match kind {
        TokenKind::Name if !is_reserved(part) => quoted(part),
        _ => part.to_owned(),
    };
    tokens(text).into_iter().map(|token| word(token.kind, text.get(token.span).unwrap_or(""))).collect()
}

#[cfg(test)]
mod tests {
    use super::in_words;

    #[test]
    fn names_stand_apart_and_white_space_goes() {
        for (text, words) in [
            ("0.9/T", "0.9/'T'"),
            (" sqrt( L ) +\n max(mu, 1.5e-3 ) ", "sqrt('L')+max('mu',1.5e-3)"),
            ("2 * pi", "2*pi"),
            ("exp(exp_1)*E", "exp('exp_1')*'E'"),
            ("2e3*e3", "2e3*'e3'"),
            ("", ""),
        ] {
            assert_eq!(in_words(text), words);
        }
    }
}
