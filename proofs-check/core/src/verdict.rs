//! What the checker answers.

use crate::interval::Interval;
use std::fmt;

/// The answer about a certificate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Verdict {
    /// Every rule is satisfied: the claim is proved again.
    Valid,
    /// A rule is certainly violated.
    Invalid,
    /// It is not a certificate that can be read.
    BadInput,
    /// A rule could be neither proved nor refuted; nothing is claimed.
    Undecided,
}

impl Verdict {
    /// The exit code: 0, 1, 2, 3.
    pub fn exit_code(self) -> u8 {
        self as u8
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Verdict::Valid => "valid",
            Verdict::Invalid => "invalid",
            Verdict::BadInput => "bad-input",
            Verdict::Undecided => "undecided",
        })
    }
}

/// Why a certificate is not valid.
#[derive(Clone, Debug)]
pub struct Finding {
    /// Which of the three other answers.
    pub verdict: Verdict,
    /// The rule.
    pub rule: &'static str,
    /// The field, as a JSON pointer.
    pub pointer: String,
    /// What is wrong, in a sentence.
    pub message: String,
    /// Left side, right side and by how much they fail, for comparisons.
    pub sides: Option<[String; 3]>,
}

/// A text of a file as it may stand in an answer: on its line, with every character that is not shown, or moves what is shown, as its number.
pub fn escaped(text: &str) -> String {
    let shown = |c: char| match c {
        c if !is_hidden(c) => c.to_string(),
        '\n' | '\r' | '\t' => c.escape_default().to_string(),
        c => c.escape_unicode().to_string(),
    };
    text.chars().map(shown).collect()
}

/// Ends of lines and paragraphs and other white space than a blank, control characters, marks of direction, and what has no width: the
/// categories Cc, Cf, Zl, Zp and Zs of Unicode, and what it calls ignorable by default.
#[rustfmt::skip]
fn is_hidden(c: char) -> bool {
    c.is_control() || (c.is_whitespace() && c != ' ') || matches!(
        c,
        '\u{ad}' | '\u{34f}' | '\u{600}'..='\u{605}' | '\u{61c}' | '\u{6dd}' | '\u{70f}' | '\u{890}' | '\u{891}' | '\u{8e2}'
        | '\u{115f}' | '\u{1160}' | '\u{17b4}' | '\u{17b5}' | '\u{180b}'..='\u{180f}' | '\u{200b}'..='\u{200f}'
        | '\u{202a}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{2800}' | '\u{3164}' | '\u{fe00}'..='\u{fe0f}' | '\u{feff}'
        | '\u{ffa0}' | '\u{fff0}'..='\u{fffb}' | '\u{110bd}' | '\u{110cd}' | '\u{13430}'..='\u{1343f}' | '\u{1bca0}'..='\u{1bca3}'
        | '\u{1d173}'..='\u{1d17a}' | '\u{e0000}'..='\u{e0fff}'
    )
}

/// The result of a rule.
pub type Outcome<T> = Result<T, Box<Finding>>;

/// A finding without sides.
pub fn finding(verdict: Verdict, rule: &'static str, pointer: &str, message: impl Into<String>) -> Box<Finding> {
    Box::new(Finding { verdict, rule, pointer: pointer.to_owned(), message: message.into(), sides: None })
}

/// A violated rule.
pub fn invalid<T>(rule: &'static str, pointer: &str, message: impl Into<String>) -> Outcome<T> {
    Err(finding(Verdict::Invalid, rule, pointer, message))
}

/// Something that cannot be read.
pub fn bad<T>(pointer: &str, message: impl Into<String>) -> Outcome<T> {
    Err(finding(Verdict::BadInput, "format", pointer, message))
}

/// Demands a decided truth: `Some(true)` passes, `Some(false)` is invalid, `None` undecided.
pub fn demand(truth: Option<bool>, rule: &'static str, pointer: &str, message: impl Into<String>) -> Outcome<()> {
    match truth {
        Some(true) => Ok(()),
        Some(false) => invalid(rule, pointer, format!("not satisfied: {}", message.into())),
        None => {
            let message = format!("can be neither proved nor refuted: {}", message.into());
            Err(finding(Verdict::Undecided, rule, pointer, message))
        }
    }
}

/// The relation of a condition.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// `<`
    Less,
    /// `<=`
    AtMost,
}

impl Relation {
    /// Its symbol.
    pub fn symbol(self) -> &'static str {
        if self == Relation::Less { "<" } else { "<=" }
    }
}

/// A condition of a derivation with both sides enclosed.
#[derive(Clone, Debug)]
pub struct Condition {
    /// C1, C2, ...
    pub id: &'static str,
    /// What it says.
    pub what: String,
    /// The left side.
    pub lhs: Interval,
    /// The relation.
    pub relation: Relation,
    /// The right side.
    pub rhs: Interval,
}

impl Condition {
    /// `lhs < rhs`.
    pub fn less(id: &'static str, what: impl Into<String>, lhs: Interval, rhs: Interval) -> Condition {
        Condition { id, what: what.into(), lhs, relation: Relation::Less, rhs }
    }

    /// `lhs <= rhs`.
    pub fn at_most(id: &'static str, what: impl Into<String>, lhs: Interval, rhs: Interval) -> Condition {
        Condition { id, what: what.into(), lhs, relation: Relation::AtMost, rhs }
    }

    /// Certain, certainly not, or unknown; a strict relation is decided strictly.
    pub fn truth(&self) -> Option<bool> {
        match self.relation {
            Relation::Less => self.lhs.lt(&self.rhs),
            Relation::AtMost => self.lhs.le(&self.rhs),
        }
    }

    /// Demands that the condition holds.
    pub fn demand(&self, rule: &'static str, pointer: &str) -> Outcome<()> {
        demand(self.truth(), rule, pointer, format!("{}, {}", self.id, self.what)).map_err(|mut finding| {
            finding.sides = Some([shown(&self.lhs), shown(&self.rhs), shown(&(&self.lhs - &self.rhs))]);
            finding
        })
    }

    /// One line for a reader.
    pub fn line(&self) -> String {
        let (lhs, rhs, margin) = (shown(&self.lhs), shown(&self.rhs), shown(&(&self.rhs - &self.lhs)));
        let holds = self.truth().map_or("undecided", |truth| if truth { "holds" } else { "FAILS" });
        format!("  {} {holds}: {}: {lhs} {} {rhs}, margin {margin}", self.id, self.what, self.relation.symbol())
    }
}

/// An interval for a reader; not used for any decision.
pub fn shown(value: &Interval) -> String {
    if !value.is_defined() {
        return "undefined".to_owned();
    }
    let digits = |end: &rug::Float| if *end == 0 { "0".to_owned() } else { format!("{:.9e}", end.to_f64()) };
    let (lo, hi) = (digits(&value.lo()), digits(&value.hi()));
    if lo == hi { lo } else { format!("[{lo}, {hi}]") }
}
