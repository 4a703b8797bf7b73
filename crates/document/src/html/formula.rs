//! Formulas in sentences, as MathML: reports write them plainly, `|x - x_0| <= 1`, and a page typesets what is certainly one.
//!
//! A word is part of a formula if it is made of numbers, signs and names that are symbols; what stands together is one formula. What
//! is no such word stays as it is.

use crate::text::RELATIONS;
use maud::{Markup, PreEscaped, html};

/// Names of letters, and the letters.
const GREEK: [(&str, &str); 16] = [
    ("sigma", "σ"),
    ("mu", "μ"),
    ("zeta", "ζ"),
    ("psi", "ψ"),
    ("alpha", "α"),
    ("beta", "β"),
    ("gamma", "γ"),
    ("lambda", "λ"),
    ("theta", "θ"),
    ("rho", "ρ"),
    ("tau", "τ"),
    ("nu", "ν"),
    ("pi", "π"),
    ("Phi", "Φ"),
    ("eta", "η"),
    ("xi", "ξ"),
];

/// Functions, which are upright.
const FUNCTIONS: [&str; 13] =
    ["sqrt", "min", "max", "exp", "sup", "rms", "Nbar", "sin", "cos", "tan", "atan", "tanh", "log"];

/// Names that are one symbol although they have more than one letter.
const NAMES: [&str; 15] = ["xb", "X0", "E0", "Z0", "K2", "dX", "dE", "dZ", "df", "dq", "dx", "de", "sg", "Om", "Nz"];

/// Letters that are symbols when they stand alone; no word of English is among them.
const ALONE: &str = "xeuzyqfth";

/// Indices that are words.
const INDICES: [&str; 7] = ["up", "low", "per", "oo", "fe", "inf", "tx"];

/// The deepest parentheses of what is typeset.
const DEEPEST: usize = 20;

/// The longest formula that is not broken into pieces, in tokens: browsers do not break formulas.
const UNBROKEN: usize = 20;

#[derive(Clone, Debug, PartialEq)]
enum Token {
    Number(String),
    Name(String),
    Sign(char),
    Relation(&'static str),
    Space,
}

/// A sentence with its formulas typeset.
pub(super) fn typeset(text: &str) -> Markup {
    let mut pieces: Vec<(String, Option<Markup>)> = vec![(String::new(), None)];
    let mut rest: Vec<&str> = text.split(' ').collect();
    rest.reverse();
    let mut first = true;
    while let Some(word) = rest.pop() {
        let space = if first { "" } else { " " };
        first = false;
        let run = run(word, &rest);
        let Some((tokens, used, before, after)) = run else {
            if let Some(last) = pieces.last_mut() {
                last.0.push_str(space);
                last.0.push_str(word);
            }
            continue;
        };
        rest.truncate(rest.len() - used);
        if let Some(last) = pieces.last_mut() {
            last.0.push_str(space);
            last.0.push_str(&before);
            last.1 = Some(followed(&parts(&tokens), &after));
        }
        pieces.push((String::new(), None));
    }
    html! { @for (text, formula) in &pieces { (kept(text)) @if let Some(formula) = formula { (formula) } } }
}

/// A text whose relations are not parted from their sides at the end of a line.
fn kept(text: &str) -> String {
    RELATIONS.iter().fold(text.to_owned(), |text, relation| {
        // A line may end behind a bar even before such a space.
        let text = text.replace(&format!("| {relation} "), &format!("|\u{2060} {relation} "));
        text.replace(&format!(" {relation} "), &format!("\u{a0}{relation}\u{a0}"))
    })
}

/// A formula with the punctuation behind it, at which no line ends.
fn followed(parts: &[Markup], after: &str) -> Markup {
    match parts.split_last() {
        Some((last, parts)) if !after.is_empty() => html! {
            @for part in parts { (part) }
            span .whole { (last) (after) }
        },
        _ => html! { @for part in parts { (part) } },
    }
}

/// A formula, in pieces between which a line may end where it is long.
fn parts(tokens: &[Token]) -> Vec<Markup> {
    if tokens.len() <= UNBROKEN {
        return vec![math(tokens)];
    }
    let (mut parts, mut from) = (Vec::new(), 0);
    let (mut open, mut bars) = (0_usize, 0);
    for (at, token) in tokens.iter().enumerate() {
        match token {
            Token::Sign('(') => open += 1,
            Token::Sign(')') => open = open.saturating_sub(1),
            Token::Sign('|') => bars += 1,
            Token::Space if open == 0 && bars % 2 == 0 => {
                parts.push(math(&tokens[from..at]));
                // A relation stays with what is before it.
                let relation = matches!(tokens.get(at + 1), Some(Token::Relation(_)));
                parts.push(html! { (if relation { "\u{a0}" } else { " " }) });
                from = at + 1;
            }
            _ => {}
        }
    }
    parts.push(math(&tokens[from..]));
    parts
}

/// Tokens, how many further words they take, and the punctuation before and behind.
type Run = (Vec<Token>, usize, String, String);

/// The longest formula that starts with a word; `next` are those that follow, the next one last.
fn run(word: &str, next: &[&str]) -> Option<Run> {
    let open: String =
        word.chars().take_while(|c| *c == '(' && word.matches('(').count() > word.matches(')').count()).collect();
    let mut best: Option<Run> = None;
    let mut tokens: Vec<Token> = Vec::new();
    let words = std::iter::once(&word[open.len()..]).chain(next.iter().rev().copied());
    for (used, word) in words.enumerate() {
        let (whole, last) = (tokenise(word), cut(word));
        if let Some((inside, punctuation)) = last
            && let Some(more) = tokenise(inside)
        {
            let all: Vec<Token> = joined(&tokens, more);
            let closed = is_closed(&all);
            if is_formula(&all) {
                best = Some((all, used, open.clone(), punctuation.to_owned()));
            }
            if closed {
                break;
            }
        }
        let Some(more) = whole else { break };
        tokens = joined(&tokens, more);
        if is_formula(&tokens) {
            best = Some((tokens.clone(), used, open.clone(), String::new()));
        }
    }
    best
}

fn joined(before: &[Token], more: Vec<Token>) -> Vec<Token> {
    let space = (!before.is_empty()).then_some(Token::Space);
    before.iter().cloned().chain(space).chain(more).collect()
}

/// A word without the punctuation at its end.
fn cut(word: &str) -> Option<(&str, &str)> {
    let inside = word.trim_end_matches([',', '.', ';', ':', '?']);
    let surplus = inside.matches(')').count().saturating_sub(inside.matches('(').count());
    let inside = (0..surplus).try_fold(inside, |inside, _| inside.strip_suffix(')')).unwrap_or(inside);
    (inside.len() < word.len() && !inside.is_empty()).then(|| (inside, &word[inside.len()..]))
}

/// Whether every parenthesis and brace is closed.
fn is_closed(tokens: &[Token]) -> bool {
    let count = |sign: char| tokens.iter().filter(|token| **token == Token::Sign(sign)).count();
    count('(') == count(')') && count('{') == count('}') && count('(') <= DEEPEST
}

/// Whether tokens are certainly a formula: balanced, with a symbol, and with no sign that waits for something.
fn is_formula(tokens: &[Token]) -> bool {
    let bars = tokens.iter().filter(|token| **token == Token::Sign('|')).count();
    let balanced = is_closed(tokens) && bars % 2 == 0;
    let waits = |token: Option<&Token>| match token {
        None => true,
        Some(Token::Relation(_)) => true,
        Some(Token::Sign(sign)) => "+-/^_,".contains(*sign),
        Some(Token::Number(_) | Token::Name(_) | Token::Space) => false,
    };
    let starts = match tokens {
        [] | [Token::Relation(_), ..] | [Token::Sign('-'), Token::Space, ..] => false,
        [Token::Sign(sign), ..] => !"+/^_,*".contains(*sign),
        _ => true,
    };
    let related = tokens.iter().any(|token| matches!(token, Token::Relation(_) | Token::Sign('|' | '_' | '^')));
    let alone = tokens.len() == 1;
    let symbol = tokens.iter().any(|token| match token {
        Token::Name(name) => {
            is_greek(name)
                || (related && !FUNCTIONS.contains(&name.as_str()))
                || (alone && ALONE.contains(name.as_str()))
        }
        _ => false,
    });
    // `a = 1` is one; in `a sigma` the first word is an article.
    let article = matches!(tokens, [Token::Name(a), Token::Space, Token::Name(_), ..] if a == "a");
    balanced && starts && !waits(tokens.last()) && symbol && !article
}

fn is_greek(name: &str) -> bool {
    GREEK.iter().any(|(word, _)| *word == name)
}

/// The tokens of a word; none where it has a name that is no symbol.
fn tokenise(word: &str) -> Option<Vec<Token>> {
    if let Some(relation) = RELATIONS.iter().find(|relation| **relation == word) {
        return Some(vec![Token::Relation(relation)]);
    }
    let mut tokens = Vec::new();
    let mut rest = word;
    while let Some(c) = rest.chars().next() {
        let length = if c.is_ascii_digit() {
            let length = number(rest);
            tokens.push(Token::Number(rest[..length].to_owned()));
            length
        } else if c.is_ascii_alphabetic() {
            let length = rest.find(|c: char| !c.is_ascii_alphanumeric()).unwrap_or(rest.len());
            let name = &rest[..length];
            let index = tokens.last() == Some(&Token::Sign('_'));
            let known = name.len() == 1
                || is_greek(name)
                || FUNCTIONS.contains(&name)
                || NAMES.contains(&name)
                || (index && (INDICES.contains(&name) || name.len() <= 3));
            if !known {
                return None;
            }
            tokens.push(Token::Name(name.to_owned()));
            length
        } else if "+-*/^_|(){},'".contains(c) {
            tokens.push(Token::Sign(c));
            1
        } else {
            return None;
        };
        rest = &rest[length..];
    }
    (!tokens.is_empty()).then_some(tokens)
}

/// The length of the number that a text starts with.
fn number(text: &str) -> usize {
    let digits = |text: &str| text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
    let mut length = digits(text);
    if let Some(rest) = text[length..].strip_prefix('.') {
        length += if digits(rest) > 0 { 1 + digits(rest) } else { 0 };
    }
    if let Some(rest) = text[length..].strip_prefix('e') {
        let sign = usize::from(rest.starts_with('-'));
        let more = digits(&rest[sign..]);
        length += if more > 0 { 1 + sign + more } else { 0 };
    }
    length
}

fn math(tokens: &[Token]) -> Markup {
    html! { math { (row(tokens, &mut 0, None)) } }
}

/// What stands as far as a closing sign.
fn row(tokens: &[Token], at: &mut usize, end: Option<char>) -> Markup {
    let mut parts = Vec::new();
    while let Some(token) = tokens.get(*at) {
        if let (Token::Sign(sign), Some(end)) = (token, end)
            && *sign == end
        {
            break;
        }
        let binary = |token: Option<&Token>| matches!(token, Some(Token::Relation(_) | Token::Sign('+' | '-')));
        // Relations and sums have their own room.
        if *token == Token::Space && (binary(tokens.get(*at + 1)) || binary(tokens.get(at.wrapping_sub(1)))) {
            *at += 1;
            continue;
        }
        parts.push(scripted(tokens, at));
    }
    html! { mrow { @for part in &parts { (part) } } }
}

/// A piece with what stands below and above it.
fn scripted(tokens: &[Token], at: &mut usize) -> Markup {
    let mut piece = atom(tokens, at);
    loop {
        let sign = match tokens.get(*at) {
            Some(Token::Sign(sign @ ('_' | '^' | '\'' | '*'))) => *sign,
            _ => return piece,
        };
        let after = tokens.get(*at + 1);
        match sign {
            '\'' => {
                *at += 1;
                piece = html! { msup { (piece) mo { "′" } } };
            }
            // A star at the end of a name is a part of it.
            '*' => {
                let ends = match after {
                    None | Some(Token::Space | Token::Relation(_)) => true,
                    Some(Token::Sign(next)) => "/),}_".contains(*next),
                    Some(Token::Number(_) | Token::Name(_)) => false,
                };
                *at += 1;
                if !ends {
                    // The product of what is written without a space; two numbers side by side would be another number.
                    let shown = if matches!(after, Some(Token::Number(_))) { "\u{b7}" } else { "\u{2062}" };
                    let times = html! { mo { (shown) } };
                    return html! { (piece) (times) };
                }
                piece = html! { msup { (piece) mo { "*" } } };
            }
            _ => {
                *at += 1;
                let script = script(tokens, at);
                piece = if sign == '_' {
                    html! { msub { (piece) (script) } }
                } else {
                    html! { msup { (piece) (script) } }
                };
            }
        }
    }
}

/// What is written as an index or a power: a piece, with a sign before it.
fn script(tokens: &[Token], at: &mut usize) -> Markup {
    if tokens.get(*at) == Some(&Token::Sign('-')) {
        *at += 1;
        let piece = atom(tokens, at);
        return html! { mrow { mo { "-" } (piece) } };
    }
    atom(tokens, at)
}

fn atom(tokens: &[Token], at: &mut usize) -> Markup {
    let Some(token) = tokens.get(*at) else { return html! { mrow {} } };
    *at += 1;
    match token {
        Token::Number(digits) => html! { mn { (digits) } },
        Token::Space => html! { mspace width="0.2em" {} },
        Token::Relation(relation) => html! { mo { (match *relation { "<=" => "≤", ">=" => "≥", other => other }) } },
        Token::Name(name) if name == "sqrt" && tokens.get(*at) == Some(&Token::Sign('(')) => {
            *at += 1;
            let inside = row(tokens, at, Some(')'));
            *at += 1;
            html! { msqrt { (inside) } }
        }
        Token::Name(name) if name == "oo" => html! { mn { "∞" } },
        Token::Name(name) => {
            let letter = GREEK.iter().find(|(word, _)| word == name).map_or(name.as_str(), |(_, letter)| letter);
            match name.len() > 1 && letter == name {
                true => html! { mi mathvariant="normal" { (name) } },
                false => html! { mi { (letter) } },
            }
        }
        Token::Sign('(') => {
            let inside = row(tokens, at, Some(')'));
            *at += 1;
            html! { mrow { mo stretchy="false" { "(" } (inside) mo stretchy="false" { ")" } } }
        }
        Token::Sign('-') => html! { mo { "−" } },
        Token::Sign('|') => html! { mo stretchy="false" form="prefix" lspace="0" rspace="0" { "|" } },
        Token::Sign(sign) => html! { mo stretchy="false" { (PreEscaped(sign.to_string())) } },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The text of a sentence, with what is typeset in brackets and without tags.
    fn seen(text: &str) -> String {
        let markup = typeset(text).into_string().replace("<math>", "[").replace("</math>", "]");
        let mut shown = String::new();
        let mut tag = false;
        for c in markup.chars() {
            match c {
                '<' => tag = true,
                '>' => tag = false,
                c if !tag => shown.push(c),
                _ => {}
            }
        }
        shown.replace("&lt;", "<").replace(['\u{2062}', '\u{2060}'], "")
    }

    #[test]
    fn formulas_are_found_in_sentences() {
        for (text, expected) in [
            ("with sigma = 39.81 (or any larger), mu = 1 and 2*pi,", "with [σ=39.81] (or any larger), [μ=1] and [2π],"),
            ("n_o >= 0, from |x| <= 0.1042, |z|_N <= 1.4e-3 on", "[no≥0], from [|x|≤0.1042], [|z|N≤1.4e-3] on"),
            ("at 2*2*pi*t, 2*pi*3", "at [2·2πt], [2π·3]"),
            ("so from |x - x_0| <= 0.2262", "so from [|x−x0|≤0.2262]"),
            ("sigma* = 6.06 in 1/time; the same", "[σ*=6.06] in 1/time; the same"),
            ("min{w_x P_low D_x^2, D_e^2} < sigma", "[min{wx] [Plow] [Dx2,] [De2}]\u{a0}[<] [σ]"),
            ("(h/mu) k_x^2 < 4 w_x a_2", "[(h/μ)] [kx2]\u{a0}[<] [4] [wx] [a2]"),
            ("|z|_N = sqrt(z'Nz).", "[|z|N=z′Nz]."),
            ("(((((((((((((((((((((x_1)))))))))))))))))))))", "(((((((((((((((((((((x_1)))))))))))))))))))))"),
            ("a sigma* that", "a [σ*] that"),
            ("this is a set, T = 1.", "this is a set, [T=1]."),
            ("C5: dq/de against I", "C5: dq/de against I"),
            ("(with e and z alone)", "(with [e] and [z] alone)"),
            ("at most 0.1667 with 0 oscillators - none", "at most 0.1667 with 0 oscillators - none"),
            ("<b> & x_", "&lt;b> &amp; x_"),
            ("of |length| <= 1, width = b", "of |length|\u{a0}<=\u{a0}1, width\u{a0}=\u{a0}b"),
            ("", ""),
        ] {
            assert_eq!(seen(text).replace("&gt;", ">").replace("<b>", "&lt;b>"), expected, "{text}");
        }
    }

    #[test]
    fn formulas_are_markup_with_indices_and_roots() {
        let text = typeset("psi_1 <= sqrt(k_2) e^-1").into_string();
        assert!(text.contains("<msub><mi>ψ</mi><mn>1</mn></msub>"), "{text}");
        assert!(text.contains("<msqrt><mrow><msub><mi>k</mi><mn>2</mn></msub></mrow></msqrt>"), "{text}");
        assert!(text.contains("<msup><mi>e</mi><mrow><mo>-</mo><mn>1</mn></mrow></msup>"), "{text}");
    }
}
