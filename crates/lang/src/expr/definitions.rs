//! Names that stand for constants in an expression.

use super::Expr;
use super::lex::{TokenKind, tokens};
use super::names::{Scope, is_taken};
use super::phase::PHASE;
use super::syntax::{Argument, Node};
use super::{ExprError, Variables, parse::parse};

/// The most names of variables that stand for a number in an interval.
pub const MAX_INTERVALS: usize = 4;

/// The most parameters of formulas that stand for a number in an interval: those, and the clock.
pub const MAX_VARIED: usize = MAX_INTERVALS + 1;

/// The longest name of a state or a parameter, in bytes.
pub(super) const MAX_NAME: usize = 40;

/// Whether a name can stand for a variable: a letter or underscore followed by letters, digits and underscores (ASCII, at most
/// 40 bytes).
pub(super) fn is_name(name: &str) -> bool {
    let starts = name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
    let continues = name.bytes().all(|c| c.is_ascii_alphanumeric() || c == b'_');
    starts && continues && name.len() <= MAX_NAME
}

/// Whether t, phase, e, pi or a function has the name.
pub(super) fn is_reserved(name: &str) -> bool {
    name == "t" || name == "e" || name == PHASE || is_taken(name)
}

/// Names of constants, each with its constant.
///
/// An expression with such a name is the expression with the constant in parentheses in its place: an exponent that is a name of
/// 2 is the integer power.
#[derive(Clone, Debug, Default)]
pub struct Definitions {
    list: Vec<(String, Expr)>,
    /// Names of which only an interval is known.
    intervals: Vec<String>,
}

/// Why a name cannot be given to a constant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DefinitionError {
    /// Not a name.
    #[error("this is no name that can be used in an expression")]
    Malformed,
    /// t, e, u, pi or a function.
    #[error("this name has another meaning in expressions")]
    Reserved,
    /// A constant of this name is there.
    #[error("another parameter has this name")]
    Duplicate,
}

impl Definitions {
    /// No names.
    #[must_use]
    pub fn none() -> &'static Definitions {
        static NONE: Definitions = Definitions { list: Vec::new(), intervals: Vec::new() };
        &NONE
    }

    /// Gives a name to a constant, an expression without variables.
    ///
    /// # Errors
    /// [`DefinitionError`]: names are as those of states, and not `u`, which is the input.
    pub fn define(&mut self, name: &str, value: Expr) -> Result<(), DefinitionError> {
        self.admits(name)?;
        self.list.push((name.to_owned(), value));
        Ok(())
    }

    /// Gives a name to a variable that stands for a number in an interval.
    ///
    /// # Errors
    /// Those of [`Definitions::define`].
    pub fn define_interval(&mut self, name: &str) -> Result<(), DefinitionError> {
        self.admits(name)?;
        self.intervals.push(name.to_owned());
        Ok(())
    }

    /// Whether a name of those of intervals occurs in the text of an expression.
    #[must_use]
    pub fn vary(&self, text: &str) -> bool {
        self.intervals.iter().any(|name| occurs(name, text))
    }

    /// The place of a name among those of intervals.
    pub(super) fn interval(&self, name: &str) -> Option<usize> {
        self.intervals.iter().position(|known| known == name)
    }

    /// Whether a constant could have this name.
    ///
    /// # Errors
    /// Those of [`Definitions::define`].
    pub fn admits(&self, name: &str) -> Result<(), DefinitionError> {
        if !is_name(name) {
            return Err(DefinitionError::Malformed);
        }
        if name == "u" || is_reserved(name) {
            return Err(DefinitionError::Reserved);
        }
        if self.names().any(|known| known == name) {
            return Err(DefinitionError::Duplicate);
        }
        Ok(())
    }

    /// The names, in their order.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.list.iter().map(|(name, _)| name.as_str()).chain(self.intervals.iter().map(String::as_str))
    }

    pub(super) fn nodes(&self, name: &str) -> Option<&[Node]> {
        self.list.iter().find(|(known, _)| known == name).map(|(_, value)| &*value.nodes)
    }

    /// A constant expression with the constants in the places of their names, in parentheses but for digits and a point: a text
    /// that stands for itself.
    ///
    /// # Errors
    /// That of the text as it is written, in its place.
    pub fn spelled_out(&self, text: &str) -> Result<String, ExprError> {
        parse(text, &Constants { definitions: self })?;
        Ok(self.written_out(text))
    }

    /// The text of an expression with the constants in the places of their names.
    pub(super) fn written_out(&self, text: &str) -> String {
        let value = |name: &str| self.list.iter().find(|(known, _)| known == name).map(|(_, value)| value.text());
        if let Some(value) = value(text.trim()) {
            return value.to_owned();
        }
        let (mut out, mut from) = (String::new(), 0);
        for token in tokens(text).into_iter().filter(|token| token.kind == TokenKind::Name) {
            let Some(value) = text.get(token.span.clone()).and_then(value) else { continue };
            out.push_str(text.get(from..token.span.start).unwrap_or_default());
            let is_numeral = value.bytes().all(|c| c.is_ascii_digit() || c == b'.');
            out.push_str(&if is_numeral { value.to_owned() } else { format!("({value})") });
            from = token.span.end;
        }
        out.push_str(text.get(from..).unwrap_or_default());
        out
    }
}

/// Whether a name occurs in the text of an expression.
#[must_use]
pub fn occurs(name: &str, text: &str) -> bool {
    tokens(text).iter().any(|token| token.kind == TokenKind::Name && text.get(token.span.clone()) == Some(name))
}

/// The scope of a constant in which names of other constants may stand.
struct Constants<'a> {
    definitions: &'a Definitions,
}

impl Scope for Constants<'_> {
    type Variable = Argument;

    fn variable(&self, name: &str) -> Option<Result<Argument, Option<String>>> {
        if self.definitions.interval(name).is_some() {
            let help = "of this parameter an interval is given, and one number is needed here";
            return Some(Err(Some(help.to_owned())));
        }
        Variables::None.variable(name)
    }

    fn definition(&self, name: &str) -> Option<&[Node]> {
        self.definitions.nodes(name)
    }

    fn operand(&self) -> &'static str {
        Variables::None.operand()
    }

    fn names(&self) -> impl Iterator<Item = &str> {
        self.definitions.names()
    }

    fn instead_of(&self, name: &str) -> Option<&'static str> {
        Variables::None.instead_of(name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn defined(list: &[(&str, &str)]) -> Definitions {
        let mut all = Definitions::default();
        for (name, value) in list {
            all.define(name, Expr::parse(value, Variables::None).unwrap()).unwrap();
        }
        all
    }

    #[test]
    fn constants_are_written_out_in_parentheses() {
        let all = defined(&[("J", "0.02"), ("k", "1 - 3"), ("Ts", "1/50")]);
        for (text, spelled) in [
            ("J", "0.02"),
            (" k ", "1 - 3"),
            ("k^2", "(1 - 3)^2"),
            ("2*pi/Ts", "2*pi/(1/50)"),
            ("-k*J + 1", "-(1 - 3)*0.02 + 1"),
            ("sqrt(3)", "sqrt(3)"),
        ] {
            assert_eq!(all.spelled_out(text).unwrap(), spelled);
            assert!(Expr::parse(spelled, Variables::None).is_ok());
        }
        let error = all.spelled_out("2*K").unwrap_err();
        assert_eq!((error.to_string().as_str(), error.help.as_deref()), ("`K` is not a known name", Some("write k")));
        assert_eq!(error.span, 2..3);
        assert!(Definitions::none().spelled_out("J").is_err());
    }

    #[test]
    fn names_of_something_else_are_refused() {
        let value = || Expr::parse("1", Variables::None).unwrap();
        let mut all = Definitions::default();
        for name in ["t", "e", "u", "pi", "sin", "max"] {
            assert_eq!(all.define(name, value()), Err(DefinitionError::Reserved), "{name}");
        }
        for name in ["", "2k", "k-1", "ä"] {
            assert_eq!(all.define(name, value()), Err(DefinitionError::Malformed), "{name}");
        }
        assert_eq!(all.define("k", value()), Ok(()));
        assert_eq!(all.define("k", value()), Err(DefinitionError::Duplicate));
        assert_eq!(all.names().collect::<Vec<_>>(), ["k"]);
    }

    #[test]
    fn a_name_occurs_as_a_word() {
        assert!(occurs("k", "-k*x1") && occurs("k", "2*(k)"));
        assert!(!occurs("k", "kk*x1") && !occurs("k", "tank(1)") && !occurs("e", "2e3"));
    }
}
