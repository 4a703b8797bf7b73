//! Splitting a text into numerals, names and symbols.

use std::ops::Range;
use winnow::Parser;
use winnow::combinator::{alt, opt, repeat};
use winnow::error::EmptyError;
use winnow::stream::LocatingSlice;
use winnow::token::{any, one_of, take_while};

/// A piece of the text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TokenKind {
    /// Digits, points and perhaps a decimal exponent; not yet checked to be a number.
    Numeral,
    /// A letter or underscore followed by letters, digits and underscores.
    Name,
    /// Any other character.
    Symbol(char),
}

/// A token and the bytes it occupies.
#[derive(Clone, Debug)]
pub(super) struct Token {
    pub(super) kind: TokenKind,
    pub(super) span: Range<usize>,
}

type Input<'a> = LocatingSlice<&'a str>;
type Result<T> = winnow::Result<T, EmptyError>;

/// The letter of a decimal exponent belongs to the numeral only when digits follow: in `2E` the letter is the
/// variable, and the parser then says that an operator is missing.
fn numeral(input: &mut Input<'_>) -> Result<TokenKind> {
    let digits = || take_while(1.., |c: char| c.is_ascii_digit());
    let exponent = (one_of(['e', 'E']), opt(one_of(['+', '-'])), digits());
    (take_while(1.., |c: char| c.is_ascii_digit() || c == '.'), opt(exponent))
        .value(TokenKind::Numeral)
        .parse_next(input)
}

fn name(input: &mut Input<'_>) -> Result<TokenKind> {
    let first = one_of(|c: char| c.is_alphabetic() || c == '_');
    (first, take_while(0.., |c: char| c.is_alphanumeric() || c == '_')).value(TokenKind::Name).parse_next(input)
}

fn token(input: &mut Input<'_>) -> Result<Token> {
    let space = take_while(0.., |c: char| c.is_ascii_whitespace());
    let kind = alt((numeral, name, any.map(TokenKind::Symbol)));
    let (kind, span) = (space, kind.with_span()).map(|(_, token)| token).parse_next(input)?;
    Ok(Token { kind, span })
}

/// All tokens of a text; white space at the end, like everywhere else, is dropped. Every text has tokens: characters
/// without a meaning are symbols for the parser to refuse.
pub(super) fn tokens(text: &str) -> Vec<Token> {
    let trimmed = text.trim_end_matches(|c: char| c.is_ascii_whitespace());
    // `token` succeeds on any input with a character that is not white space left, so the repetition stops only at
    // the end and cannot fail.
    repeat(0.., token).parse_next(&mut LocatingSlice::new(trimmed)).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(text: &str) -> Vec<&str> {
        tokens(text).into_iter().map(|token| &text[token.span]).collect()
    }

    #[test]
    fn the_letter_e_is_an_exponent_only_before_digits() {
        assert_eq!(texts("2E3"), ["2E3"]);
        assert_eq!(texts("2E-3 "), ["2E-3"]);
        assert_eq!(texts("2E"), ["2", "E"]);
        assert_eq!(texts("2E+X"), ["2", "E", "+", "X"]);
        assert_eq!(texts("2*E3"), ["2", "*", "E3"]);
        assert_eq!(texts("1.5e-3X"), ["1.5e-3", "X"]);
        assert_eq!(texts(" \t\n "), Vec::<&str>::new());
        assert_eq!(texts("sin(π)\u{0}"), ["sin", "(", "π", ")", "\u{0}"]);
    }
}
