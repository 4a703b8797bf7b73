//! Formulas as MathML, from how they are written in plain text: `|x - x_0| <= 1`.
//!
//! Any text gives MathML: what is no number, name or sign is shown as it is.

use maud::{Markup, html};

/// Names of letters, and the letters.
const GREEK: [(&str, &str); 23] = [
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
    ("phi", "φ"),
    ("Phi", "Φ"),
    ("Upsilon", "Υ"),
    ("eta", "η"),
    ("xi", "ξ"),
    ("omega", "ω"),
    ("Om", "Ω"),
    ("upsilon", "υ"),
    ("varpi", "ϖ"),
];

/// Relations of two characters, and how they are shown.
const RELATIONS: [(&str, char); 3] = [("<=", '≤'), (">=", '≥'), ("!=", '≠')];

/// The deepest parentheses of what is typeset.
const DEEPEST: usize = 20;

/// The longest formula that is not broken into pieces, in tokens: browsers do not break formulas.
const UNBROKEN: usize = 20;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Token<'t> {
    Number(&'t str),
    Name(&'t str),
    Sign(char),
    Relation(char),
    Space,
}

/// A formula with the punctuation behind it, at which no line ends.
pub(super) fn typeset(formula: &str, after: &str) -> Markup {
    if formula.matches('(').count() > DEEPEST {
        return html! { (formula) (after) };
    }
    let mut parts = parts(&tokens(formula.trim()));
    let last = parts.pop();
    html! {
        @for part in parts { (part) }
        @if let Some(last) = last { @if after.is_empty() { (last) } @else { span .whole { (last) (after) } } }
    }
}

/// A formula, in pieces between which a line may end where it is long, but not before a relation or a sum.
fn parts(tokens: &[Token<'_>]) -> Vec<Markup> {
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
                let spaced = at > 0 && !is_between(tokens, at - 1) && tokens[at - 1] != Token::Sign(',');
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

/// The tokens of a formula.
fn tokens(formula: &str) -> Vec<Token<'_>> {
    let mut tokens = Vec::new();
    let mut rest = formula;
    while let Some(c) = rest.chars().next() {
        let until = |end: fn(char) -> bool| rest.find(end).unwrap_or(rest.len());
        let relation = RELATIONS.iter().find(|(written, _)| rest.starts_with(written));
        let (token, length) = if c.is_ascii_digit() {
            let length = number(rest);
            (Token::Number(&rest[..length]), length)
        } else if c.is_alphabetic() {
            let length = until(|c| !c.is_alphanumeric());
            (Token::Name(&rest[..length]), length)
        } else if c.is_whitespace() {
            (Token::Space, until(|c| !c.is_whitespace()))
        } else if let Some((written, shown)) = relation {
            (Token::Relation(*shown), written.len())
        } else if "<>=".contains(c) {
            (Token::Relation(c), 1)
        } else {
            (Token::Sign(c), c.len_utf8())
        };
        tokens.push(token);
        rest = &rest[length..];
    }
    tokens
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

fn math(tokens: &[Token<'_>]) -> Markup {
    html! { math { (row(tokens, &mut 0, None)) } }
}

/// What stands as far as a closing sign.
fn row(tokens: &[Token<'_>], at: &mut usize, end: Option<Token<'_>>) -> Markup {
    let mut parts = Vec::new();
    while let Some(token) = tokens.get(*at).filter(|token| Some(**token) != end) {
        let binary = |token: Option<&Token<'_>>| matches!(token, Some(Token::Relation(_) | Token::Sign('+' | '-')));
        // Relations and sums have their own room.
        if *token == Token::Space && (binary(tokens.get(*at + 1)) || binary(tokens.get(at.wrapping_sub(1)))) {
            *at += 1;
            continue;
        }
        parts.push(scripted(tokens, at));
    }
    html! { mrow { @for part in &parts { (part) } } }
}

/// What stands as far as a closing parenthesis, which is taken too, and whether there is one.
fn inside(tokens: &[Token<'_>], at: &mut usize) -> (Markup, bool) {
    let close = Token::Sign(')');
    let row = row(tokens, at, Some(close));
    let closed = tokens.get(*at) == Some(&close);
    *at += usize::from(closed);
    (row, closed)
}

/// A piece with what stands below and above it.
fn scripted(tokens: &[Token<'_>], at: &mut usize) -> Markup {
    let bar = tokens.get(*at) == Some(&Token::Sign('|'));
    let spaced = tokens.get(*at) == Some(&Token::Space);
    let mut piece = atom(tokens, at);
    let (mut below, mut above, mut times) = (Vec::new(), Vec::new(), None);
    while let Some(Token::Sign(sign @ ('_' | '^' | '\'' | '*'))) = tokens.get(*at).filter(|_| !spaced) {
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
fn ends_a_name(after: Option<&Token<'_>>) -> bool {
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
fn script(tokens: &[Token<'_>], at: &mut usize) -> Markup {
    if tokens.get(*at) == Some(&Token::Sign('-')) {
        *at += 1;
        let piece = atom(tokens, at);
        return html! { mrow { mo form="prefix" { "−" } (piece) } };
    }
    atom(tokens, at)
}

/// Whether a relation or a sum stands there.
fn is_between(tokens: &[Token<'_>], at: usize) -> bool {
    match tokens.get(at) {
        Some(Token::Relation(_)) => true,
        Some(Token::Sign('+' | '-')) => is_binary(tokens, at),
        _ => false,
    }
}

/// Whether a sum stands there, and no sign of a number.
fn is_binary(tokens: &[Token<'_>], at: usize) -> bool {
    match at.checked_sub(1).and_then(|before| tokens.get(before)) {
        None | Some(Token::Relation(_)) => false,
        Some(Token::Space) => tokens.get(at + 1).is_none_or(|after| *after == Token::Space),
        Some(Token::Sign(before)) => !"(+-*/^_{,".contains(*before),
        Some(Token::Number(_) | Token::Name(_)) => true,
    }
}

/// A name: a letter, a product, or a word, which is upright; digits at its end are its index.
fn named(name: &str) -> Markup {
    match name {
        "oo" => return html! { mn { "∞" } },
        "int" => return html! { mo { "∫" } },
        "Nz" => return html! { mi { "N" } mi { "z" } },
        "xb" => return html! { mover { mi { "x" } mo stretchy="false" { "¯" } } },
        _ => {}
    }
    let (word, index) = name.split_at(name.trim_end_matches(|c: char| c.is_ascii_digit()).len());
    let letter = match GREEK.iter().find(|(known, _)| *known == word) {
        Some((_, letter)) => html! { mi { (letter) } },
        None if word.chars().nth(1).is_some() => html! { mi mathvariant="normal" { (word) } },
        None => html! { mi { (word) } },
    };
    if index.is_empty() {
        letter
    } else {
        html! { msub { (letter) mn { (index) } } }
    }
}

/// Whether it is a word, which has the room of words around it.
fn is_word(token: Token<'_>) -> bool {
    matches!(token, Token::Name(name) if name.len() > 3 && !GREEK.iter().any(|(known, _)| *known == name))
}

fn atom(tokens: &[Token<'_>], at: &mut usize) -> Markup {
    let Some(token) = tokens.get(*at) else { return html! { mrow {} } };
    *at += 1;
    match *token {
        Token::Number(digits) => html! { mn { (digits) } },
        Token::Space => {
            let beside = [at.checked_sub(2).and_then(|before| tokens.get(before)), tokens.get(*at)];
            let words = beside.into_iter().flatten().any(|token| is_word(*token));
            html! { mspace width=(if words { "0.3em" } else { "0.2em" }) {} }
        }
        Token::Relation(shown) => html! { mo form="infix" { (shown) } },
        Token::Name("sqrt") if tokens.get(*at) == Some(&Token::Sign('(')) => {
            *at += 1;
            let (inside, _) = inside(tokens, at);
            html! { msqrt { (inside) } }
        }
        Token::Name(name) => named(name),
        Token::Sign('(') => {
            let (inside, closed) = inside(tokens, at);
            html! { mrow { mo stretchy="false" { "(" } (inside) @if closed { mo stretchy="false" { ")" } } } }
        }
        Token::Sign(sign @ ('+' | '-')) => {
            // At the end of a piece too.
            let form = if is_binary(tokens, *at - 1) { "infix" } else { "prefix" };
            html! { mo form=(form) { (if sign == '-' { '−' } else { '+' }) } }
        }
        Token::Sign('|') => html! { mo stretchy="false" form="prefix" lspace="0" rspace="0" { "|" } },
        Token::Sign('*') => html! { mo { "\u{b7}" } },
        Token::Sign(sign) => html! { mo stretchy="false" { (sign) } },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The text of a formula, in brackets, without tags, and with a tilde where a line may end in it.
    fn seen(formula: &str) -> String {
        let markup = typeset(formula, "").into_string().replace("<math>", "[").replace("</math>", "]");
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
        shown.replace("&lt;", "<").replace("&gt;", ">").replace('\u{2062}', "").replace('\u{200b}', "~")
    }

    #[test]
    fn formulas_are_shown_by_their_signs() {
        for (formula, expected) in [
            ("sigma* = 39.81", "[σ*=39.81]"),
            ("2*2*pi*t", "[2·2πt]"),
            ("0.95 * 2 pi", "[0.95·2π]"),
            ("|x - x_0| <= 0.2262", "[|x−x0|≤0.2262]"),
            ("min{w_x P_low D_x^2, D_e^2} < sigma", "[min{wx]~[Plow]~[Dx2,]~[De2}<]~[σ]"),
            ("(h/mu) k_x^2 < 4 w_x a_2", "[(h/μ)]~[kx2<]~[4]~[wx]~[a2]"),
            ("|z|_N = sqrt(z'Nz)", "[|z|N=z′Nz]"),
            ("10.2 exp(-0.5 (t - t_0))", "[10.2exp(−0.5(t−t0))]"),
            ("<b> & |length|", "[<b>&amp;|length|]"),
            ("", "[]"),
        ] {
            assert_eq!(seen(formula), expected, "{formula}");
        }
        assert_eq!(
            typeset("x", ").").into_string(),
            "<span class=\"whole\"><math><mrow><mi>x</mi></mrow></math>).</span>"
        );
    }

    #[test]
    fn what_is_not_balanced_is_shown_as_it_is() {
        for (formula, expected) in
            [("(x_1", "[(x1]"), ("x_1) + (", "[x1)+(]"), ("sqrt(x", "[x]"), ("x_", "[x]"), ("^", "[^]")]
        {
            assert_eq!(seen(formula), expected, "{formula}");
        }
        let deep = format!("{}x_1{}", "(".repeat(1000), ")".repeat(1000));
        assert_eq!(seen(&deep), deep);
    }

    #[test]
    fn formulas_are_markup_with_indices_and_roots() {
        let text = typeset("psi_1 <= sqrt(k_2) e^-1", "").into_string();
        assert!(text.contains("<msub><mi>ψ</mi><mn>1</mn></msub>"), "{text}");
        // What is beside a bar is as low as beside a letter, and what has an index and a power has them one above the other.
        let text = typeset("|z|_N <= K2 a_2^2 - q_e_max, -1", "").into_string() + &text;
        assert!(text.contains("|</mo><msub><mrow></mrow><mi>N</mi></msub>"), "{text}");
        assert!(text.contains("<msub><mi>K</mi><mn>2</mn></msub>"), "{text}");
        assert!(text.contains("<msubsup><mi>a</mi><mn>2</mn><mn>2</mn></msubsup><mo form=\"infix\">−</mo>"), "{text}");
        let both = "<msub><mi>q</mi><mrow><mi>e</mi><mspace width=\"0.2em\"></mspace><mi mathvariant=\"normal\">max";
        assert!(text.contains(both), "{text}");
        assert!(text.contains("<msqrt><mrow><msub><mi>k</mi><mn>2</mn></msub></mrow></msqrt>"), "{text}");
        assert!(text.contains("<msup><mi>e</mi><mrow><mo form=\"prefix\">−</mo><mn>1</mn></mrow></msup>"), "{text}");
    }
}
