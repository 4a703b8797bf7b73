//! What a text of a report is made of: words, formulas and code.
//!
//! A formula stands between ``$` `` and `` `$ ``, as in the documents of this repository, and code between backticks. Strangers' texts have no
//! backticks (see [`clean`](super::clean)), so none of them opens or closes either.

/// A piece of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Span<'t> {
    /// Words.
    Text(&'t str),
    /// A formula, as it is written in plain text.
    Math(&'t str),
    /// Code.
    Code(&'t str),
}

/// The pieces of a text in their order. A mark that is not closed is a character as any other.
pub(super) fn spans(text: &str) -> Vec<Span<'_>> {
    let mut spans = Vec::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('`') {
        let formula = before.strip_suffix('$').and_then(|before| Some((before, after.split_once("`$")?)));
        let (before, piece, after) = match (formula, after.split_once('`')) {
            (Some((before, (formula, after))), _) => (before, Span::Math(formula), after),
            (None, Some((code, after))) => (before, Span::Code(code), after),
            (None, None) => break,
        };
        spans.extend([Span::Text(before), piece]);
        rest = after;
    }
    spans.push(Span::Text(rest));
    spans
}

/// A text without the marks of its formulas.
#[must_use]
pub fn plain(text: &str) -> String {
    let one = |span: Span<'_>| match span {
        Span::Text(text) | Span::Math(text) => text.to_owned(),
        Span::Code(code) => format!("`{code}`"),
    };
    spans(text).into_iter().map(one).collect()
}

/// Texts without the marks of their formulas.
#[must_use]
pub fn plain_all(texts: Vec<String>) -> Vec<String> {
    texts.iter().map(|text| plain(text)).collect()
}

#[cfg(test)]
mod tests {
    use super::Span::{Code, Math, Text};
    use super::*;
    use crate::clean;

    #[test]
    fn formulas_and_code_are_told_from_words() {
        assert_eq!(
            spans("with $`n_o = 1`$, `a$` b"),
            [Text("with "), Math("n_o = 1"), Text(", "), Code("a$"), Text(" b")]
        );
        assert_eq!(spans("`$`$`x`$"), [Text(""), Code("$"), Text(""), Math("x"), Text("")]);
        assert_eq!(plain("with $`n_o = 1`$, `a$` b$"), "with n_o = 1, `a$` b$");
    }

    #[test]
    fn a_mark_that_is_not_closed_is_text() {
        for text in ["", "a ` b", "costs 5$", "a $` b", "$", "`"] {
            assert_eq!(spans(text), [Text(text)], "{text}");
            assert_eq!(plain(text), text);
        }
        assert_eq!(spans("$`a`"), [Text("$"), Code("a"), Text("")]);
    }

    #[test]
    fn strangers_texts_open_and_close_no_formula() {
        for name in ["$", "$`", "`$", "$`x`$", "a`$ b $`c"] {
            let name = clean(name);
            assert_eq!(spans(&name), [Text(&name)]);
            let (quoted, bounded) = (format!("`{name}` of $`x`$"), format!("$`|u| <= {name}`$ of {name}"));
            assert_eq!(spans(&quoted), [Text(""), Code(&name), Text(" of "), Math("x"), Text("")]);
            let (formula, words) = (format!("|u| <= {name}"), format!(" of {name}"));
            assert_eq!(spans(&bounded), [Text(""), Math(&formula), Text(&words)]);
        }
    }
}
