//! Names that have a meaning, and which of them a writer may have meant.

use super::Variables;
use super::syntax::{Argument, Binary, Node, NodeKind, Unary};

/// The functions of one argument.
pub(super) const UNARY: [(&str, Unary); 11] = [
    ("sqrt", Unary::Sqrt),
    ("exp", Unary::Exp),
    ("log", Unary::Log),
    ("sin", Unary::Sin),
    ("cos", Unary::Cos),
    ("tan", Unary::Tan),
    ("atan", Unary::Atan),
    ("tanh", Unary::Tanh),
    ("abs", Unary::Abs),
    ("exprelr", Unary::Exprelr(0)),
    ("sinc", Unary::Sinc(0)),
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

/// Numbers in words, from 0 on.
const NUMBERS: [&str; 11] = ["zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten"];

/// What can stand where an operand is needed, in a bounding function and in a constant.
pub(super) const OPERAND: &str = "a number, X, E, pi, a function or an opening parenthesis";
const CONSTANT_OPERAND: &str = "a number, pi, a function or an opening parenthesis";
pub(super) const TIME_OPERAND: &str = "a number, t, pi, a function or an opening parenthesis";

/// Which names are variables, and how messages speak of them.
pub(super) trait Scope {
    /// A variable.
    type Variable: Copy;

    /// The variable of this name; an error with perhaps a suggestion where it is a variable elsewhere and forbidden
    /// here; `None` for any other name.
    fn variable(&self, name: &str) -> Option<Result<Self::Variable, Option<String>>>;

    /// The constant that a name stands for.
    fn definition(&self, name: &str) -> Option<&[Node]> {
        let _ = name;
        None
    }

    /// What `phase` stands for, where it stands for something.
    fn phase(&self) -> Option<Vec<NodeKind<Self::Variable>>> {
        None
    }

    /// What can stand where an operand is needed.
    fn operand(&self) -> &'static str;

    /// The names of the variables, and of constants.
    fn names(&self) -> impl Iterator<Item = &str>;

    /// What to write for a name that means something to a writer, but nothing here.
    fn instead_of(&self, name: &str) -> Option<&'static str> {
        let _ = name;
        None
    }

    /// Whether abs has a place here; where everything has to be smooth it has none.
    fn has_corners(&self) -> bool {
        true
    }

    /// How a name that is not known may be given a value, where that can be done.
    fn definable(&self, name: &str) -> Option<String> {
        let _ = name;
        None
    }

    /// A product of one-letter variables written without operators (`XE`), with them (`X*E`); any other name itself.
    fn spelled_out(&self, name: &str) -> String {
        let letters = || name.chars().map(String::from);
        if letters().all(|letter| self.names().any(|known| known == letter)) {
            letters().collect::<Vec<_>>().join("*")
        } else {
            name.to_owned()
        }
    }
}

impl Scope for Variables {
    type Variable = Argument;

    fn variable(&self, name: &str) -> Option<Result<Argument, Option<String>>> {
        let argument = match (name, self) {
            // The time takes the place of X.
            ("t", Variables::Time) => Argument::X,
            ("X", Variables::None | Variables::XAndE) => Argument::X,
            ("E", Variables::None | Variables::XAndE) => Argument::E,
            _ => return None,
        };
        Some(match self {
            Variables::XAndE | Variables::Time => Ok(argument),
            Variables::None => Err((argument == Argument::E).then(|| "Euler's number is exp(1)".to_owned())),
        })
    }

    fn instead_of(&self, name: &str) -> Option<&'static str> {
        let time = matches!(name, "t" | "time");
        match self {
            Variables::XAndE if time => Some(
                "a bounding function holds for every t: take the supremum over t, or give the plant itself \
                 (`sigmastar/plant`), whose formulas may have t",
            ),
            Variables::None if time => Some("a constant holds for every t: take its largest value over t"),
            _ => None,
        }
    }

    fn operand(&self) -> &'static str {
        match self {
            Variables::None => CONSTANT_OPERAND,
            Variables::XAndE => OPERAND,
            Variables::Time => TIME_OPERAND,
        }
    }

    fn names(&self) -> impl Iterator<Item = &str> {
        let names: &[&str] = match self {
            Variables::None => &[],
            Variables::XAndE => &["X", "E"],
            Variables::Time => &["t"],
        };
        names.iter().copied()
    }
}

/// Whether a name has a meaning of its own, so that no variable can have it.
pub(super) fn is_taken(name: &str) -> bool {
    name == "pi" || is_function(name)
}

fn is_function(name: &str) -> bool {
    UNARY.iter().any(|f| f.0 == name) || FOLDED.iter().any(|f| f.0 == name)
}

fn known<S: Scope>(scope: &S) -> impl Iterator<Item = &str> {
    scope.names().chain(UNARY.iter().map(|f| f.0)).chain(FOLDED.iter().map(|f| f.0)).chain(["pi"])
}

/// A suggestion for an unknown name, as a sentence; `called`: whether an argument stands behind it, as behind a function.
pub(super) fn suggest<S: Scope>(name: &str, called: bool, scope: &S) -> Option<String> {
    if let Some(advice) = scope.instead_of(name) {
        return Some(advice.to_owned());
    }
    let lower = name.to_lowercase();
    if let Some((_, meant)) = ALIASES.iter().find(|(alias, _)| *alias == lower) {
        return Some(format!("write {meant}"));
    }
    // Of a period where there is the time.
    if name == "T" {
        return Some("write the period as the number that it is".to_owned());
    }
    if let Some(meant) = known(scope).find(|known| known.to_lowercase() == lower) {
        return Some(format!("write {meant}"));
    }
    if let Some(number) = NUMBERS.iter().position(|word| *word == lower) {
        return Some(format!("write {number}"));
    }
    match lower.as_str() {
        "e" => return Some("Euler's number is exp(1)".to_owned()),
        "asin" | "arcsin" => return Some("write atan(u/sqrt(1 - u^2)) for the arcsine of u".to_owned()),
        "acos" | "arccos" => return Some("write pi/2 - atan(u/sqrt(1 - u^2)) for the arccosine of u".to_owned()),
        "sinh" | "cosh" => {
            let sign = if lower == "sinh" { '-' } else { '+' };
            return Some(format!("write (exp(u) {sign} exp(-u))/2"));
        }
        // Of Hodgkin and Huxley's rates, of the Scharfetter-Gummel scheme.
        "vtrap" => return Some("write v*exprelr(u/v) for u/(exp(u/v) - 1)".to_owned()),
        "bernoulli" => return Some("write exprelr(u) for u/(exp(u) - 1), which is 1 at 0".to_owned()),
        "exprel" => return Some("write 1/exprelr(u) for (exp(u) - 1)/u, which is 1 at 0".to_owned()),
        "expm1" => return Some("write exp(u) - 1, and exprelr(u) for u/(exp(u) - 1)".to_owned()),
        "pow" => return Some("write a power as u^v".to_owned()),
        "log10" => return Some("write log(u)/log(10)".to_owned()),
        "log2" => return Some("write log(u)/log(2)".to_owned()),
        "sign" | "sgn" | "signum" => {
            return Some("a jump is not smooth: write tanh(20*x) for sign(x), steeper with a larger number".to_owned());
        }
        _ => {}
    }
    for (sign, exponent) in [('\u{b2}', 2), ('\u{b3}', 3)] {
        if let Some(base) = name.strip_suffix(sign) {
            return Some(format!("write {base}^{exponent}"));
        }
    }
    let product = scope.spelled_out(name);
    if product != name {
        // A letter is more often struck twice than multiplied with itself without an operator.
        let letter = name.chars().next().filter(|first| name.chars().all(|c| c == *first));
        return Some(match letter {
            Some(letter) => format!("did you mean {letter}? The product is written {product}"),
            None => format!("write {product}"),
        });
    }
    known(scope)
        // A variable is one letter: every short name would be a misspelling of it.
        .filter(|known| known.len() > 1)
        // A number is no misspelling of a function.
        .filter(|known| called || !is_function(known))
        .map(|known| (strsim::osa_distance(&lower, &known.to_lowercase()), known))
        .filter(|(edits, known)| *edits <= MAX_EDITS && *edits < known.len() && *edits < name.chars().count())
        // Of two or three letters, two others are another word.
        .filter(|(edits, _)| *edits == 1 || name.chars().count() > 3)
        // A letter too many is likelier than another one: `sinn` is sin, not sinc.
        .min_by_key(|(edits, known)| (*edits, !lower.starts_with(known), known.len().abs_diff(lower.len())))
        .map(|(_, known)| format!("did you mean {known}?"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suggestions() {
        let suggest = |name| suggest(name, true, &Variables::XAndE);
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
            ("XX", "did you mean X? The product is written X*X"),
            ("pow", "write a power as u^v"),
            ("two", "write 2"),
            ("sync", "did you mean sinc?"),
            ("exprlr", "did you mean exprelr?"),
            ("vtrap", "write v*exprelr(u/v) for u/(exp(u/v) - 1)"),
            ("exprel", "write 1/exprelr(u) for (exp(u) - 1)/u, which is 1 at 0"),
            ("Bernoulli", "write exprelr(u) for u/(exp(u) - 1), which is 1 at 0"),
            ("X\u{b2}", "write X^2"),
            ("Ten", "write 10"),
        ] {
            assert_eq!(suggest(name).as_deref(), Some(meant), "{name}");
        }
        let advice = suggest("t").unwrap();
        assert!(advice.contains("take the supremum over t, or give the plant itself (`sigmastar/plant`)"), "{advice}");
        assert_eq!(super::suggest("t", false, &Variables::Time).as_deref(), Some("write t"));
        for name in ["sign", "sgn", "SIGNUM"] {
            assert!(suggest(name).unwrap().contains("write tanh(20*x) for sign(x)"), "{name}");
        }
        assert_eq!(
            super::suggest("T", false, &Variables::Time).as_deref(),
            Some("write the period as the number that it is")
        );
        assert_eq!(suggest("sinn").as_deref(), Some("did you mean sin?"));
        for (name, meant) in
            [("asin", "write atan(u/sqrt(1 - u^2)) for the arcsine of u"), ("cosh", "write (exp(u) + exp(-u))/2")]
        {
            assert_eq!(suggest(name).as_deref(), Some(meant));
        }
        // Nearly the arcsine.
        assert_eq!(suggest("asqrt").as_deref(), Some("did you mean sqrt?"));
        assert_eq!(suggest("twp"), None);
        assert_eq!(suggest("q"), None);
        // Without an argument it is no function.
        assert_eq!(super::suggest("Pmax", false, &Variables::XAndE), None);
        assert_eq!(super::suggest("sqr", false, &Variables::XAndE), None);
        assert_eq!(suggest("velocity"), None);
        assert_eq!(super::suggest("e", false, &Variables::None).as_deref(), Some("Euler's number is exp(1)"));
        assert_eq!(super::suggest("XE", false, &Variables::None), None);
    }
}
