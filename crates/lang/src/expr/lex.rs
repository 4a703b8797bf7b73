//! Splitting a text into numerals, names and symbols.

use std::ops::Range;

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

/// The bytes at the start of `text` of which the characters satisfy `taken`.
fn run(text: &str, taken: impl Fn(char) -> bool) -> usize {
    text.find(|c| !taken(c)).unwrap_or(text.len())
}

/// The length of the exponent at the start of `text`, 0 if there is none. Its letter belongs to the numeral only when digits
/// follow: in `2E` the letter is the variable, and the parser then says that an operator is missing.
fn exponent(text: &str) -> usize {
    let Some(power) = text.strip_prefix(['e', 'E']) else { return 0 };
    let digits = power.strip_prefix(['+', '-']).unwrap_or(power);
    match run(digits, |c| c.is_ascii_digit()) {
        0 => 0,
        count => text.len() - digits.len() + count,
    }
}

/// All tokens of a text; white space is dropped. Every text has tokens: characters without a meaning are symbols for the parser
/// to refuse.
pub(super) fn tokens(text: &str) -> Vec<Token> {
    let mut tokens = Vec::new();
    let mut start = 0;
    while let Some(first) = text[start..].chars().next() {
        let rest = &text[start..];
        let (kind, length) = match first {
            '0'..='9' | '.' => {
                let mantissa = run(rest, |c| c.is_ascii_digit() || c == '.');
                (Some(TokenKind::Numeral), mantissa + exponent(&rest[mantissa..]))
            }
            c if c.is_alphabetic() || c == '_' => {
                (Some(TokenKind::Name), run(rest, |c| c.is_alphanumeric() || c == '_'))
            }
            c if c.is_ascii_whitespace() => (None, 1),
            c => (Some(TokenKind::Symbol(c)), c.len_utf8()),
        };
        let span = start..start + length;
        start = span.end;
        tokens.extend(kind.map(|kind| Token { kind, span }));
    }
    tokens
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

    #[test]
    fn every_character_is_in_a_token_or_white_space() {
        let text = "\u{b}..1..2 e3_x\u{a0}é9²";
        assert_eq!(texts(text), ["\u{b}", "..1..2", "e3_x", "\u{a0}", "é9²"]);
        let kinds: Vec<TokenKind> = tokens(text).into_iter().map(|token| token.kind).collect();
        let symbol = TokenKind::Symbol;
        assert_eq!(kinds, [symbol('\u{b}'), TokenKind::Numeral, TokenKind::Name, symbol('\u{a0}'), TokenKind::Name]);
    }
}
