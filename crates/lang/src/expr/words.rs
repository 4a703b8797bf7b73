//! Expressions and names of a document within a sentence, which has letters of its own: a parameter may be called T or L as well.

use super::definitions::is_reserved;
use super::lex::{TokenKind, tokens};
use sigmastar_exact::number::{parse_decimal, write_exact};

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

/// What to write for a percentage, of which `before` is all that stands in front of its sign.
pub(crate) fn percent(before: &str) -> String {
    let from = before
        .rfind(|c: char| !c.is_ascii_digit() && c != '.')
        .map_or(0, |at| at + before[at..].chars().next().map_or(1, char::len_utf8));
    let number = &before[from..];
    match parse_decimal(number) {
        Ok(value) => {
            let share = value / 100;
            let (decimal, fraction) = (write_exact(&share), share.to_string());
            let fraction = if share.is_integer() { String::new() } else { format!(" or {fraction}") };
            format!("there are no percentages: write {decimal}{fraction} for {number}%")
        }
        Err(_) => "there are no percentages: write 0.15 or 3/20 for 15%".to_owned(),
    }
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
