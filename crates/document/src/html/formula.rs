//! Formulas in sentences, as MathML: reports write them plainly, `|x - x_0| <= 1`, and a page typesets what is certainly one.
//!
//! A word is part of a formula if it is made of numbers, signs and names that are symbols; what stands together is one formula. What
//! is no such word stays as it is.

use crate::text::RELATIONS;
use maud::{Markup, PreEscaped, html};

/// Names of letters, and the letters.
const GREEK: [(&str, &str); 18] = [
    ("sigma", "σ"),
    ("mu", "μ"),
    ("zeta", "ζ"),
    ("psi", "ψ"),
    ("alpha", "α"),
    ("beta", "β"),
    ("gamma", "γ"),
    ("lambda", "λ"),
    ("theta", "θ"),
    ("kappa", "κ"),
    ("rho", "ρ"),
    ("tau", "τ"),
    ("nu", "ν"),
    ("pi", "π"),
    ("Phi", "Φ"),
    ("Upsilon", "Υ"),
    ("eta", "η"),
    ("xi", "ξ"),
];

/// Functions, which are upright.
const FUNCTIONS: [&str; 15] =
    ["sqrt", "min", "max", "exp", "sup", "rms", "Nbar", "sin", "cos", "tan", "atan", "tanh", "log", "exprelr", "sinc"];

/// Names that are one symbol although they have more than one letter.
const NAMES: [&str; 21] = [
    "xb", "X0", "E0", "Z0", "K2", "k0", "k1", "bt", "dX", "dE", "dZ", "df", "dq", "dx", "de", "d2q", "dtdx", "dtde",
    "sg", "Om", "Nz",
];

/// Letters that are symbols when they stand alone; no word of English is among them.
const ALONE: &str = "xeuzyqfth";

/// Indices that are words.
const INDICES: [&str; 8] = ["up", "low", "per", "oo", "fe", "inf", "tx", "alpha2"];

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

/// A text whose relations look as in formulas, and are not parted from their sides at the end of a line.
fn kept(text: &str) -> String {
    RELATIONS.iter().fold(text.to_owned(), |text, relation| {
        let shown = sign_of(relation);
        if text == *relation {
            return shown.to_owned();
        }
        // A line may end behind a bar even before such a space.
        let text = text.replace(&format!("| {relation} "), &format!("|\u{2060} {relation} "));
        text.replace(&format!(" {relation} "), &format!("\u{a0}{shown}\u{a0}"))
    })
}

/// A relation as it is shown.
fn sign_of(relation: &str) -> &str {
    match relation {
        "<=" => "≤",
        ">=" => "≥",
        other => other,
    }
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

/// A formula, in pieces between which a line may end where it is long, but not before a relation or a sum.
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
            Token::Space if open == 0 && bars % 2 == 0 && !is_between(tokens, at + 1) => {
                // A space of a product is a part of what is before it.
                let spaced = !is_between(tokens, at - 1) && tokens[at - 1] != Token::Sign(',');
                parts.push(math(&tokens[from..at + usize::from(spaced)]));
                // A line may end there, and nothing is seen otherwise.
                parts.push(html! { "\u{200b}" });
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
        let (whole, last) = (tokenise(word), cut(word, unclosed(&tokens)));
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

/// How many parentheses wait for their end.
fn unclosed(tokens: &[Token]) -> usize {
    let count = |sign: char| tokens.iter().filter(|token| **token == Token::Sign(sign)).count();
    count('(').saturating_sub(count(')'))
}

/// A word without the punctuation at its end, where so many parentheses were opened before it.
fn cut(word: &str, unclosed: usize) -> Option<(&str, &str)> {
    let inside = word.trim_end_matches([',', '.', ';', ':', '?']);
    let surplus = inside.matches(')').count().saturating_sub(inside.matches('(').count() + unclosed);
    let inside = (0..surplus).try_fold(inside, |inside, _| inside.strip_suffix(')')).unwrap_or(inside);
    (inside.len() < word.len() && !inside.is_empty()).then(|| (inside, &word[inside.len()..]))
}

/// Whether every parenthesis and brace is closed, and none before it is opened.
fn is_closed(tokens: &[Token]) -> bool {
    let count = |sign: char| tokens.iter().filter(|token| **token == Token::Sign(sign)).count();
    let mut open = 0_usize;
    let in_order = tokens.iter().all(|token| match token {
        Token::Sign('(') => {
            open += 1;
            true
        }
        Token::Sign(')') if open == 0 => false,
        Token::Sign(')') => {
            open -= 1;
            true
        }
        _ => true,
    });
    in_order && open == 0 && count('{') == count('}') && count('(') <= DEEPEST
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

/// The tokens of a word; none where it is a flag, or has a name that is no symbol.
fn tokenise(word: &str) -> Option<Vec<Token>> {
    if word.contains("--") {
        return None;
    }
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
    let bar = tokens.get(*at) == Some(&Token::Sign('|'));
    let mut piece = atom(tokens, at);
    let (mut below, mut above, mut times) = (Vec::new(), Vec::new(), None);
    while let Some(Token::Sign(sign @ ('_' | '^' | '\'' | '*'))) = tokens.get(*at) {
        *at += 1;
        match sign {
            '_' => below.push(script(tokens, at)),
            '^' => above.push(script(tokens, at)),
            // It is raised in every font.
            '\'' => piece = html! { mrow { (piece) mo form="postfix" lspace="0" rspace="0" { "′" } } },
            // A star at the end of a name is a part of it.
            _ if ends_a_name(tokens.get(*at)) => above.push(html! { mo { "*" } }),
            _ => {
                // The product of what is written without a space; two numbers side by side would be another number.
                let number = matches!(tokens.get(*at), Some(Token::Number(_)));
                times = Some(html! { mo { (if number { "\u{b7}" } else { "\u{2062}" }) } });
                break;
            }
        }
    }
    // A bar reaches below the line, and what is below it would be lower than below a letter.
    let (before, base) = if bar { (Some(piece), html! { mrow {} }) } else { (None, piece) };
    html! {
        @if let Some(bar) = &before { (bar) }
        @match (one_script(&below), one_script(&above)) {
            (None, None) => { @if before.is_none() { (base) } }
            (Some(below), None) => { msub { (base) (below) } }
            (None, Some(above)) => { msup { (base) (above) } }
            (Some(below), Some(above)) => { msubsup { (base) (below) (above) } }
        }
        @if let Some(times) = &times { (times) }
    }
}

/// Whether a star ends a name, by what follows.
fn ends_a_name(after: Option<&Token>) -> bool {
    match after {
        None | Some(Token::Space | Token::Relation(_)) => true,
        Some(Token::Sign(next)) => "/),}_".contains(*next),
        Some(Token::Number(_) | Token::Name(_)) => false,
    }
}

/// What stands at one place beside a piece.
fn one_script(all: &[Markup]) -> Option<Markup> {
    match all {
        [] => None,
        [one] => Some(html! { (one) }),
        [first, rest @ ..] => Some(html! { mrow { (first) @for next in rest { mspace width="0.2em" {} (next) } } }),
    }
}

/// What is written as an index or a power: a piece, with a sign before it.
fn script(tokens: &[Token], at: &mut usize) -> Markup {
    if tokens.get(*at) == Some(&Token::Sign('-')) {
        *at += 1;
        let piece = atom(tokens, at);
        return html! { mrow { mo form="prefix" { "−" } (piece) } };
    }
    atom(tokens, at)
}

/// Whether a relation or a sum stands there.
fn is_between(tokens: &[Token], at: usize) -> bool {
    match tokens.get(at) {
        Some(Token::Relation(_)) => true,
        Some(Token::Sign('+' | '-')) => is_binary(tokens, at),
        _ => false,
    }
}

/// Whether a sum stands there, and no sign of a number.
fn is_binary(tokens: &[Token], at: usize) -> bool {
    match at.checked_sub(1).and_then(|before| tokens.get(before)) {
        None | Some(Token::Relation(_)) => false,
        Some(Token::Space) => tokens.get(at + 1).is_none_or(|after| *after == Token::Space),
        Some(Token::Sign(before)) => !"(+-*/^_{,".contains(*before),
        Some(Token::Number(_) | Token::Name(_)) => true,
    }
}

/// A name: a letter, a letter with a digit, which is its index, a product, or a word, which is upright.
fn named(name: &str) -> Markup {
    if name == "Nz" {
        return html! { mi { "N" } mi { "z" } };
    }
    if name == "xb" {
        return html! { mover { mi { "x" } mo stretchy="false" { "¯" } } };
    }
    if name == "Om" {
        return html! { mi { "Ω" } };
    }
    let (word, index) = name.split_at(name.len() - usize::from(name.ends_with(|c: char| c.is_ascii_digit())));
    let letter = match GREEK.iter().find(|(known, _)| *known == word) {
        Some((_, letter)) => html! { mi { (letter) } },
        None if word.len() > 1 => html! { mi mathvariant="normal" { (word) } },
        None => html! { mi { (word) } },
    };
    if index.is_empty() {
        letter
    } else {
        html! { msub { (letter) mn { (index) } } }
    }
}

fn atom(tokens: &[Token], at: &mut usize) -> Markup {
    let Some(token) = tokens.get(*at) else { return html! { mrow {} } };
    *at += 1;
    match token {
        Token::Number(digits) => html! { mn { (digits) } },
        Token::Space => html! { mspace width="0.2em" {} },
        Token::Relation(relation) => html! { mo form="infix" { (sign_of(relation)) } },
        Token::Name(name) if name == "sqrt" && tokens.get(*at) == Some(&Token::Sign('(')) => {
            *at += 1;
            let inside = row(tokens, at, Some(')'));
            *at += 1;
            html! { msqrt { (inside) } }
        }
        Token::Name(name) if name == "oo" => html! { mn { "∞" } },
        Token::Name(name) => named(name),
        Token::Sign('(') => {
            let inside = row(tokens, at, Some(')'));
            *at += 1;
            html! { mrow { mo stretchy="false" { "(" } (inside) mo stretchy="false" { ")" } } }
        }
        Token::Sign(sign @ ('+' | '-')) => {
            // At the end of a piece too.
            let form = if is_binary(tokens, *at - 1) { "infix" } else { "prefix" };
            html! { mo form=(form) { (if *sign == '-' { '−' } else { '+' }) } }
        }
        Token::Sign('|') => html! { mo stretchy="false" form="prefix" lspace="0" rspace="0" { "|" } },
        Token::Sign(sign) => html! { mo stretchy="false" { (PreEscaped(sign.to_string())) } },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The text of a sentence, with what is typeset in brackets, without tags, and with a tilde where a line may end in a formula.
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
        shown.replace("&lt;", "<").replace(['\u{2062}', '\u{2060}'], "").replace('\u{200b}', "~")
    }

    #[test]
    fn formulas_are_found_in_sentences() {
        for (text, expected) in [
            ("with sigma = 39.81 (or any larger), mu = 1 and 2*pi,", "with [σ=39.81] (or any larger), [μ=1] and [2π],"),
            ("n_o >= 0, from |x| <= 0.1042, |z|_N <= 1.4e-3 on", "[no≥0], from [|x|≤0.1042], [|z|N≤1.4e-3] on"),
            ("at 2*2*pi*t, 2*pi*3", "at [2·2πt], [2π·3]"),
            ("so from |x - x_0| <= 0.2262", "so from [|x−x0|≤0.2262]"),
            ("sigma* = 6.06 in 1/time; the same", "[σ*=6.06] in 1/time; the same"),
            ("min{w_x P_low D_x^2, D_e^2} < sigma", "[min{wx]~[Plow]~[Dx2,]~[De2}<]~[σ]"),
            ("(h/mu) k_x^2 < 4 w_x a_2", "[(h/μ)]~[kx2<]~[4]~[wx]~[a2]"),
            ("|z|_N = sqrt(z'Nz).", "[|z|N=z′Nz]."),
            ("(((((((((((((((((((((x_1)))))))))))))))))))))", "(((((((((((((((((((((x_1)))))))))))))))))))))"),
            ("a sigma* that", "a [σ*] that"),
            ("this is a set, T = 1.", "this is a set, [T=1]."),
            ("none: without --sigma one, or -sigma", "none: without --sigma one, or [−σ]"),
            ("C5: dq/de against I", "C5: dq/de against I"),
            ("(with e and z alone)", "(with [e] and [z] alone)"),
            ("at most 0.1667 with 0 oscillators - none", "at most 0.1667 with 0 oscillators - none"),
            ("<b> & x_", "&lt;b> &amp; x_"),
            ("of |length| <= 1, width = b", "of |length|\u{a0}≤\u{a0}1, width\u{a0}=\u{a0}b"),
            (
                "n_o = 0: 10.2 exp(-0.5 (t - t_0)); n_o = 2: 6 exp(-t))",
                "[no=0]: [10.2exp(−0.5(t−t0))]; [no=2]: 6 exp(-t))",
            ),
            ("", ""),
        ] {
            assert_eq!(seen(text).replace("&gt;", ">").replace("<b>", "&lt;b>"), expected, "{text}");
        }
    }

    #[test]
    fn what_is_closed_before_it_is_opened_is_no_formula() {
        let closed = |text: &str| tokenise(text).is_some_and(|tokens| is_closed(&tokens));
        for text in ["(x_1)", "(x_1)+(x_2)", "((x_1))", "x_1"] {
            assert!(closed(text), "{text}");
        }
        for text in ["x_1)+(x_2", "(x_1))+((x_2)", ")x_1(", "(x_1", "x_1)"] {
            assert!(!closed(text), "{text}");
        }
    }

    #[test]
    fn formulas_are_markup_with_indices_and_roots() {
        let text = typeset("psi_1 <= sqrt(k_2) e^-1").into_string();
        assert!(text.contains("<msub><mi>ψ</mi><mn>1</mn></msub>"), "{text}");
        // What is beside a bar is as low as beside a letter, and what has an index and a power has them one above the other.
        let text = typeset("|z|_N <= K2 a_2^2 - q_e_max, -1").into_string() + &text;
        assert!(text.contains("|</mo><msub><mrow></mrow><mi>N</mi></msub>"), "{text}");
        assert!(text.contains("<msub><mi>K</mi><mn>2</mn></msub>"), "{text}");
        assert!(text.contains("<msubsup><mi>a</mi><mn>2</mn><mn>2</mn></msubsup><mo form=\"infix\">−</mo>"), "{text}");
        let both = "<msub><mi>q</mi><mrow><mi>e</mi><mspace width=\"0.2em\"></mspace><mi mathvariant=\"normal\">max";
        assert!(text.contains(both), "{text}");
        assert!(text.contains("<msqrt><mrow><msub><mi>k</mi><mn>2</mn></msub></mrow></msqrt>"), "{text}");
        assert!(text.contains("<msup><mi>e</mi><mrow><mo form=\"prefix\">−</mo><mn>1</mn></mrow></msup>"), "{text}");
    }
}
