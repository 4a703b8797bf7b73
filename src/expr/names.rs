//! Names that have a meaning, and which of them a writer may have meant.

use super::Variables;
use super::syntax::{Binary, Unary};

/// The functions of one argument.
pub(super) const UNARY: [(&str, Unary); 9] = [
    ("sqrt", Unary::Sqrt),
    ("exp", Unary::Exp),
    ("log", Unary::Log),
    ("sin", Unary::Sin),
    ("cos", Unary::Cos),
    ("tan", Unary::Tan),
    ("atan", Unary::Atan),
    ("tanh", Unary::Tanh),
    ("abs", Unary::Abs),
];

/// The functions of two or more arguments.
pub(super) const FOLDED: [(&str, Binary); 2] = [("min", Binary::Min), ("max", Binary::Max)];

/// Names used elsewhere for what we have under another name.
const ALIASES: [(&str, &str); 12] = [
    ("ln", "log"),
    ("loge", "log"),
    ("arctan", "atan"),
    ("arctg", "atan"),
    ("tg", "tan"),
    ("th", "tanh"),
    ("root", "sqrt"),
    ("fabs", "abs"),
    ("norm", "abs"),
    ("maximum", "max"),
    ("minimum", "min"),
    ("π", "pi"),
];

/// Edits beyond which a name is not taken for a misspelling.
const MAX_EDITS: usize = 2;

fn known(variables: Variables) -> impl Iterator<Item = &'static str> {
    let variables: &[&str] = match variables {
        Variables::None => &[],
        Variables::XAndE => &["X", "E"],
        Variables::Time => &["t"],
    };
    variables.iter().copied().chain(UNARY.iter().map(|f| f.0)).chain(FOLDED.iter().map(|f| f.0)).chain(["pi"])
}

/// A suggestion for an unknown name, as a sentence.
pub(super) fn suggest(name: &str, variables: Variables) -> Option<String> {
    let lower = name.to_lowercase();
    if let Some((_, meant)) = ALIASES.iter().find(|(alias, _)| *alias == lower) {
        return Some(format!("write {meant}"));
    }
    if let Some(meant) = known(variables).find(|known| known.to_lowercase() == lower) {
        return Some(format!("write {meant}"));
    }
    match lower.as_str() {
        "e" => return Some("Euler's number is exp(1)".to_owned()),
        "pow" => return Some("write a power as u^v".to_owned()),
        "log10" => return Some("write log(u)/log(10)".to_owned()),
        "log2" => return Some("write log(u)/log(2)".to_owned()),
        _ => {}
    }
    if variables == Variables::XAndE && name.chars().all(|c| matches!(c, 'X' | 'E')) {
        return Some(format!("write {}", spelled_out(name)));
    }
    known(variables)
        // A variable is one letter: every short name would be a misspelling of it.
        .filter(|known| known.len() > 1)
        .map(|known| (strsim::osa_distance(&lower, known), known))
        .filter(|(edits, known)| *edits <= MAX_EDITS && *edits < known.len() && *edits < name.chars().count())
        .min_by_key(|(edits, known)| (*edits, known.len().abs_diff(lower.len())))
        .map(|(_, known)| format!("did you mean {known}?"))
}

/// A product of variables written without operators (`XE`), with them (`X*E`).
pub(super) fn spelled_out(name: &str) -> String {
    if name.chars().all(|c| matches!(c, 'X' | 'E')) {
        name.chars().map(String::from).collect::<Vec<_>>().join("*")
    } else {
        name.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suggestions() {
        let suggest = |name| suggest(name, Variables::XAndE);
        for (name, meant) in [
            ("sqr", "did you mean sqrt?"),
            ("x", "write X"),
            ("e", "write E"),
            ("ln", "write log"),
            ("arctan", "write atan"),
            ("Sin", "write sin"),
            ("PI", "write pi"),
            ("XE", "write X*E"),
            ("tahn", "did you mean tanh?"),
            ("pow", "write a power as u^v"),
        ] {
            assert_eq!(suggest(name).as_deref(), Some(meant), "{name}");
        }
        assert_eq!(suggest("q"), None);
        assert_eq!(suggest("velocity"), None);
        assert_eq!(super::suggest("e", Variables::None).as_deref(), Some("Euler's number is exp(1)"));
        assert_eq!(super::suggest("XE", Variables::None), None);
    }
}
