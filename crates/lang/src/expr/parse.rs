//! The grammar.
//!
//! ```text
//! sum     = product (("+" | "-") product)*
//! product = signed (("*" | "/") signed)*
//! signed  = ("-" | "+")* power
//! power   = primary ("^" signed)?
//! primary = numeral | "pi" | variable | name "(" sum ("," sum)* ")" | "(" sum ")"
//! ```
//!
//! Which names are variables is the [`Scope`]'s to say.

use super::exact::Constants;
use super::lex::{Token, TokenKind, tokens};
use super::monomial::Monomial;
use super::names::{FOLDED, Scope, UNARY, is_taken, suggest};
use super::percent::percent;
use super::phase::PHASE;
use super::syntax::{Binary, Node, NodeKind, Unary, carried, step};
use super::units;
use super::{ExprError, ExprErrorKind, MAX_EXPONENT, MAX_NESTING, MAX_NODES, MAX_TEXT};
use sigmastar_exact::number::parse_decimal;
use std::ops::Range;

const OPERATOR: &str = "an operator or the end";

/// The nodes of the expression, in postfix order.
pub(super) fn parse<S: Scope>(text: &str, scope: &S) -> Result<Vec<Node<S::Variable>>, ExprError> {
    if text.len() > MAX_TEXT {
        // The limit may fall inside a character; the span must not.
        let start = (0..=MAX_TEXT).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0);
        let kind = ExprErrorKind::TooLong { length: text.len() };
        return Err(ExprError { kind, span: start..text.len(), expected: None, help: None });
    }
    let tokens = tokens(text);
    if tokens.is_empty() {
        let expected = Some(scope.operand());
        return Err(ExprError { kind: ExprErrorKind::Empty, span: text.len()..text.len(), expected, help: None });
    }
    let mut parser = Parser { text, tokens, at: 0, depth: 0, scope, nodes: Vec::new(), exact: Vec::new() };
    parser.sum()?;
    match parser.peek() {
        None => Ok(parser.nodes),
        Some(token) => Err(parser.unexpected_after_operand(&token)),
    }
}

struct Parser<'a, S: Scope> {
    text: &'a str,
    tokens: Vec<Token>,
    at: usize,
    depth: usize,
    scope: &'a S,
    nodes: Vec<Node<S::Variable>>,
    /// The exact values of the operands that wait for their operation, to recognise constant integer exponents.
    exact: Vec<Option<Monomial>>,
}

impl<S: Scope> Parser<'_, S> {
    fn peek(&self) -> Option<Token> {
        self.tokens.get(self.at).cloned()
    }

    fn peek_symbol(&self) -> Option<char> {
        match self.tokens.get(self.at)?.kind {
            TokenKind::Symbol(symbol) => Some(symbol),
            _ => None,
        }
    }

    /// Consumes the symbol if it comes next.
    fn accept(&mut self, symbol: char) -> bool {
        let found = self.peek_symbol() == Some(symbol);
        self.at += usize::from(found);
        found
    }

    /// Where the token before the current one ends.
    fn end(&self) -> usize {
        self.at.checked_sub(1).and_then(|at| self.tokens.get(at)).map_or(0, |token| token.span.end)
    }

    /// Where the current token starts.
    fn start(&self) -> usize {
        self.tokens.get(self.at).map_or(self.text.len(), |token| token.span.start)
    }

    fn push(&mut self, kind: NodeKind<S::Variable>, span: Range<usize>) -> Result<(), ExprError> {
        if self.nodes.len() >= MAX_NODES {
            return Err(ExprError { kind: ExprErrorKind::TooManyNodes, span, expected: None, help: None });
        }
        let node = Node { kind, span };
        step(&node, &mut self.exact, &mut Constants);
        self.nodes.push(node);
        Ok(())
    }

    /// Runs a part of the grammar one level deeper.
    fn nested(&mut self, part: fn(&mut Self) -> Result<(), ExprError>) -> Result<(), ExprError> {
        if self.depth >= MAX_NESTING {
            let span = self.tokens.get(self.at).map_or(self.text.len()..self.text.len(), |token| token.span.clone());
            return Err(ExprError { kind: ExprErrorKind::TooDeep, span, expected: None, help: None });
        }
        self.depth += 1;
        let result = part(self);
        self.depth -= 1;
        result
    }

    fn left_associative(
        &mut self,
        operators: [(char, Binary); 2],
        operand: fn(&mut Self) -> Result<(), ExprError>,
    ) -> Result<(), ExprError> {
        let start = self.start();
        operand(self)?;
        while let Some(symbol) = self.peek_symbol() {
            let Some((_, operation)) = operators.iter().find(|(operator, _)| *operator == symbol) else { break };
            self.at += 1;
            operand(self)?;
            self.push(NodeKind::Binary(*operation), start..self.end())?;
        }
        Ok(())
    }

    fn sum(&mut self) -> Result<(), ExprError> {
        self.left_associative([('+', Binary::Add), ('-', Binary::Sub)], Self::product)
    }

    fn product(&mut self) -> Result<(), ExprError> {
        self.left_associative([('*', Binary::Mul), ('/', Binary::Div)], Self::signed)
    }

    fn signed(&mut self) -> Result<(), ExprError> {
        let mut minuses = Vec::new();
        while let Some(symbol @ ('+' | '-')) = self.peek_symbol() {
            if symbol == '-' {
                minuses.push(self.start());
            }
            self.at += 1;
        }
        self.power()?;
        for start in minuses.into_iter().rev() {
            self.push(NodeKind::Unary(Unary::Neg), start..self.end())?;
        }
        Ok(())
    }

    fn power(&mut self) -> Result<(), ExprError> {
        let start = self.start();
        self.primary()?;
        if !self.accept('^') {
            return Ok(());
        }
        let (exponent_node, exponent_start) = (self.nodes.len(), self.start());
        self.nested(Self::signed)?;
        let integer = match self.exact.last() {
            Some(Some(value)) => {
                value.as_rational().filter(|value| value.is_integer()).map(|value| value.numer().clone())
            }
            _ => None,
        };
        let span = start..self.end();
        let Some(integer) = integer else {
            return self.push(NodeKind::Binary(Binary::Pow), span);
        };
        let Some(exponent) = integer.to_i32().filter(|n| n.unsigned_abs() <= MAX_EXPONENT.unsigned_abs()) else {
            let span = exponent_start..self.end();
            return Err(ExprError { kind: ExprErrorKind::ExponentTooLarge, span, expected: None, help: None });
        };
        // The exponent's nodes are the last ones, and its value the last one: the power replaces both.
        self.nodes.truncate(exponent_node);
        self.exact.pop();
        self.push(NodeKind::Power(exponent), span)
    }

    fn primary(&mut self) -> Result<(), ExprError> {
        let Some(token) = self.peek() else {
            return Err(self.end_of_text(self.scope.operand()));
        };
        self.at += 1;
        match token.kind {
            TokenKind::Numeral => {
                let value = parse_decimal(&self.text[token.span.clone()]).map_err(|error| ExprError {
                    kind: error.into(),
                    span: token.span.clone(),
                    expected: None,
                    help: None,
                })?;
                self.push(NodeKind::Number(value), token.span)
            }
            TokenKind::Name => self.name(&token.span),
            TokenKind::Symbol('(') => {
                self.nested(Self::sum)?;
                self.close(&token.span)
            }
            TokenKind::Symbol(symbol) => {
                self.at -= 1;
                Err(self.misplaced(symbol, token.span, self.scope.operand()))
            }
        }
    }

    fn name(&mut self, span: &Range<usize>) -> Result<(), ExprError> {
        let name = &self.text[span.clone()];
        if name == "pi" {
            return self.push(NodeKind::Pi, span.clone());
        }
        match self.scope.variable(name) {
            Some(Ok(variable)) => return self.push(NodeKind::Variable(variable), span.clone()),
            Some(Err(help)) => {
                let kind = ExprErrorKind::VariableInConstant { name: name.to_owned() };
                return Err(ExprError { kind, span: span.clone(), expected: Some(self.scope.operand()), help });
            }
            None => {}
        }
        if let Some(nodes) = self.scope.definition(name) {
            return nodes.iter().filter_map(carried).try_for_each(|kind| self.push(kind, span.clone()));
        }
        if let Some(nodes) = self.scope.phase().filter(|_| name == PHASE) {
            return nodes.into_iter().try_for_each(|kind| self.push(kind, span.clone()));
        }
        let unary = UNARY.iter().find(|f| f.0 == name).map(|f| f.1);
        let folded = FOLDED.iter().find(|f| f.0 == name).map(|f| f.1);
        if unary.is_none() && folded.is_none() {
            let kind = ExprErrorKind::UnknownName { name: shortened(name) };
            let called = self.peek_symbol() == Some('(');
            let define = || if called { None } else { self.scope.definable(name).or_else(|| self.without_factor()) };
            let (expected, help) = (Some(self.scope.operand()), suggest(name, called, self.scope).or_else(define));
            return Err(ExprError { kind, span: span.clone(), expected, help });
        }
        let open = self.start()..self.start() + 1;
        if !self.accept('(') {
            let kind = ExprErrorKind::FunctionWithoutArgument { name: name.to_owned() };
            let power = self.peek_symbol() == Some('^');
            let help =
                Some(format!("write {name}(...){}", if power { "^2, the power behind the parentheses" } else { "" }));
            return Err(ExprError { kind, span: span.clone(), expected: Some("an opening parenthesis"), help });
        }
        let mut arguments = 0;
        if self.peek_symbol() != Some(')') {
            loop {
                self.nested(Self::sum)?;
                arguments += 1;
                if let Some(operation) = folded
                    && arguments > 1
                {
                    self.push(NodeKind::Binary(operation), span.start..self.end())?;
                }
                if !self.accept(',') {
                    break;
                }
            }
        }
        self.close(&open)?;
        let whole = span.start..self.end();
        let wrong_count = |needed| {
            let kind = ExprErrorKind::ArgumentCount { name: name.to_owned(), needed, found: arguments };
            Err(ExprError { kind, span: whole.clone(), expected: None, help: None })
        };
        match unary {
            Some(operation) if arguments == 1 => self.push(NodeKind::Unary(operation), whole),
            Some(_) => wrong_count("one argument"),
            None if arguments < 2 => wrong_count("at least two arguments"),
            None => {
                // The last fold is the value of the call: let it be shown as the whole call.
                if let Some(node) = self.nodes.last_mut() {
                    node.span = whole;
                }
                Ok(())
            }
        }
    }

    /// The closing parenthesis that belongs to the opening one.
    fn close(&mut self, open: &Range<usize>) -> Result<(), ExprError> {
        if self.accept(')') {
            return Ok(());
        }
        match self.peek() {
            None => Err(ExprError {
                kind: ExprErrorKind::Unclosed,
                span: open.clone(),
                expected: Some("an operator or a closing parenthesis"),
                help: Some("add the missing `)`".to_owned()),
            }),
            Some(token) => Err(self.unexpected_after_operand(&token)),
        }
    }

    fn end_of_text(&self, expected: &'static str) -> ExprError {
        let end = self.text.len();
        ExprError { kind: ExprErrorKind::UnexpectedEnd, span: end..end, expected: Some(expected), help: None }
    }

    /// A symbol that cannot stand here; characters that never can are told apart.
    fn misplaced(&self, symbol: char, span: Range<usize>, expected: &'static str) -> ExprError {
        let help = match symbol {
            '×' | '·' | '⋅' => Some("write *"),
            '÷' => Some("write /"),
            '−' | '–' => Some("write - (the ASCII minus)"),
            '*' if self.at > 0 && self.tokens[self.at - 1].kind == TokenKind::Symbol('*') => {
                Some("write a power as u^v")
            }
            '[' | '{' => Some("write ("),
            ']' | '}' => Some("write )"),
            '|' if self.scope.has_corners() => Some("write abs(...)"),
            '|' => Some("|v| has a corner, and formulas are smooth: write sqrt(v^2 + 1/100) for it"),
            '√' => Some("write sqrt(...)"),
            '<' | '>' | '=' | '?' => {
                Some("there are no comparisons: min, max and abs have corners, tanh is a smooth step")
            }
            '\\' if self.text[span.end..].starts_with(|next: char| next.is_ascii_alphabetic()) => {
                Some("this is no LaTeX: write (...)/(...), sqrt(...), pi")
            }
            '.' if self.text[span.end..].starts_with(['*', '/', '^']) => Some("write *, / and ^ for .*, ./ and .^"),
            '²' => Some("write ^2"),
            '³' => Some("write ^3"),
            ',' if expected == OPERATOR
                && self.at.checked_sub(1).is_some_and(|at| self.tokens[at].kind == TokenKind::Numeral) =>
            {
                Some("decimals have a point, as in 1.5")
            }
            _ => None,
        };
        let percent = (symbol == '%').then(|| percent(&self.text[..span.start]));
        let known = matches!(symbol, '+' | '-' | '*' | '/' | '^' | '(' | ')' | ',');
        let kind = if known {
            ExprErrorKind::Unexpected { found: symbol.to_string() }
        } else {
            ExprErrorKind::UnexpectedCharacter { character: symbol }
        };
        ExprError { kind, span, expected: Some(expected), help: help.map(str::to_owned).or(percent) }
    }

    /// What to write where `right` follows the operand `left` without an operator.
    fn between(&self, left: &str, right: &str, kind: TokenKind) -> String {
        let product = |factor: &str| format!("write {left}*{factor}");
        let number = self.at.checked_sub(1).is_some_and(|at| self.tokens[at].kind == TokenKind::Numeral);
        let called = self.tokens.get(self.at + 1).is_some_and(|next| next.kind == TokenKind::Symbol('('));
        if kind != TokenKind::Name || is_taken(right) {
            // `12 1/s`, and minutes in the place of the smallest of some.
            let is_unit = number && !called && self.unit_from(self.at).is_some();
            return if is_unit { self.without_unit(left, right) } else { product(right) };
        }
        match self.scope.variable(right) {
            Some(Err(Some(advice))) => return advice,
            Some(_) => return product(right),
            None => {}
        }
        if self.scope.definition(right).is_some() || (right == PHASE && self.scope.phase().is_some()) {
            return product(right);
        }
        let spelled_out = self.scope.spelled_out(right);
        if spelled_out != right {
            return product(&spelled_out);
        }
        match suggest(right, called, self.scope) {
            // A name with a well-known meaning, under another name here.
            Some(advice) => match advice.strip_prefix("write ") {
                Some(meant) => product(meant),
                None if called || !number || !advice.starts_with("did you mean") => advice,
                None => self.without_unit(left, right),
            },
            None if called || !number => product(right),
            None => self.without_unit(left, right),
        }
    }

    /// The advice on a unit behind a number: on all of it, such as `1/s`, where nothing else follows.
    fn without_unit(&self, number: &str, unit: &str) -> String {
        units::without(number, self.unit_from(self.at).unwrap_or(unit), self.at == 1)
    }

    /// The rest of the text from a token on, where it is a unit and has no name in it that is known here.
    fn unit_from(&self, at: usize) -> Option<&str> {
        let rest = self.tokens.get(at..)?;
        let is_part = |token: &Token| match token.kind {
            TokenKind::Name => {
                let name = &self.text[token.span.clone()];
                let known = self.scope.variable(name).is_some() || self.scope.definition(name).is_some();
                units::is_unit(name) && !known
            }
            TokenKind::Numeral => true,
            TokenKind::Symbol(symbol) => "*/^-()".contains(symbol),
        };
        let has_name = rest.iter().any(|token| token.kind == TokenKind::Name);
        (has_name && rest.iter().all(is_part)).then(|| self.text[rest[0].span.start..].trim_end())
    }

    /// The advice on a unit that a number is multiplied with or divided by, of which the name was read last.
    fn without_factor(&self) -> Option<String> {
        let operator = self.at.checked_sub(2)?;
        let number = operator.checked_sub(1).and_then(|at| self.tokens.get(at))?;
        let multiplies = matches!(self.tokens[operator].kind, TokenKind::Symbol('*' | '/'));
        let unit = self.unit_from(operator).filter(|_| multiplies && number.kind == TokenKind::Numeral)?;
        Some(units::without(&self.text[number.span.clone()], unit, false))
    }

    /// What follows a complete operand and is neither an operator nor the end.
    fn unexpected_after_operand(&self, token: &Token) -> ExprError {
        let text = |span: &Range<usize>| shortened(&self.text[span.clone()]);
        let right = text(&token.span);
        if right == "." {
            return self.misplaced('.', token.span.clone(), OPERATOR);
        }
        match token.kind {
            TokenKind::Numeral | TokenKind::Name | TokenKind::Symbol('(') => {
                let left = self.at.checked_sub(1).map_or_else(String::new, |at| text(&self.tokens[at].span));
                let help = Some(self.between(&left, &right, token.kind));
                let kind = ExprErrorKind::MissingOperator { left, right };
                ExprError { kind, span: token.span.clone(), expected: Some(OPERATOR), help }
            }
            TokenKind::Symbol(symbol) => self.misplaced(symbol, token.span.clone(), OPERATOR),
        }
    }
}

/// A piece of a stranger's text, short enough for a message.
fn shortened(text: &str) -> String {
    if text.chars().count() <= 40 { text.to_owned() } else { text.chars().take(37).collect::<String>() + "..." }
}

#[cfg(test)]
mod tests {
    use super::super::names::OPERAND;
    use super::super::{Expr, Variables};
    use super::*;
    use rug::Rational;

    fn value(text: &str) -> Rational {
        let exact = Expr::parse(text, Variables::None).unwrap_or_else(|error| panic!("{text}: {error}")).exact();
        exact.and_then(|exact| exact.as_rational().cloned()).unwrap_or_else(|| panic!("{text} is not rational"))
    }

    fn error(text: &str) -> ExprError {
        Expr::parse(text, Variables::XAndE).map(|_| ()).expect_err(text)
    }

    #[test]
    fn precedence_and_associativity() {
        for (text, expected) in [
            ("1 + 2*3", (7, 1)),
            ("(1 + 2)*3", (9, 1)),
            ("7 - 2 - 1", (4, 1)),
            ("8/4/2", (1, 1)),
            ("8/4*2", (4, 1)),
            ("2*3^2", (18, 1)),
            ("-2^2", (-4, 1)),
            ("(-2)^2", (4, 1)),
            ("2^3^2", (512, 1)),
            ("(2^3)^2", (64, 1)),
            ("2^-1", (1, 2)),
            ("2^-2^2", (1, 16)),
            ("2^+3", (8, 1)),
            ("2^--3", (8, 1)),
            ("2*-3", (-6, 1)),
            ("2--3", (5, 1)),
            ("2-+-3", (5, 1)),
            ("-3-2", (-5, 1)),
            ("-2*-3", (6, 1)),
            ("+4", (4, 1)),
            ("2E3", (2000, 1)),
            ("2e-1*5", (1, 1)),
            (" 1\t+\n2 ", (3, 1)),
            ("min(5, 3+1, 2*4)", (4, 1)),
            ("max(1,2)-1", (1, 1)),
            ("sqrt(4)^2", (4, 1)),
            ("3^(1-1)", (1, 1)),
            ("2^1000/2^999", (2, 1)),
        ] {
            assert_eq!(value(text), Rational::from(expected), "{text}");
        }
    }

    #[test]
    fn errors_say_what_where_and_what_to_do() {
        use ExprErrorKind as Kind;
        let missing = |left: &str, right: &str| Kind::MissingOperator { left: left.into(), right: right.into() };
        let unexpected = |found: &str| Kind::Unexpected { found: found.into() };
        let unknown = |name: &str| Kind::UnknownName { name: name.into() };
        const HERTZ: &str = "numbers have no units: with the second as the unit of time, 2 Hz is 1/2 as a period or sampling period, and 2*pi*2 as an angular \
                             frequency such as `base_frequency`, or as a gain or a rate in 1/s";
        const MILLI: &str = "numbers have no units: with the second as the unit of time, write 2/1000";
        const OTHER: &str =
            "numbers have no units: leave `ms` out, and take the same units of time, x and e in all data";
        const UNIT: &str = "numbers have no units: leave `s` out, and take the same units of time, x and e in all data";
        const ANGLE: &str =
            "numbers have no units: leave `rad/s` out, and take the same units of time, x and e in all data";
        const RATE: &str =
            "numbers have no units: leave `1/s` out, and take the same units of time, x and e in all data";
        const SQUARE: &str =
            "numbers have no units: leave `s^-2` out, and take the same units of time, x and e in all data";
        const MINUTES: &str =
            "numbers have no units: leave `min` out, and take the same units of time, x and e in all data";
        const OVER: &str =
            "numbers have no units: leave `/s` out, and take the same units of time, x and e in all data";
        const SUPREMUM: &str = "a bounding function holds for every t: take the supremum over t, or give the plant itself \
                                (`sigmastar/plant`), whose formulas may have t";
        for (text, kind, span, help) in [
            ("2X", missing("2", "X"), 1..2, Some("write 2*X")),
            ("2E", missing("2", "E"), 1..2, Some("write 2*E")),
            ("2XE", missing("2", "XE"), 1..3, Some("write 2*X*E")),
            ("2E3X", missing("2E3", "X"), 3..4, Some("write 2E3*X")),
            ("X E", missing("X", "E"), 2..3, Some("write X*E")),
            ("X(E)", missing("X", "("), 1..2, Some("write X*(")),
            ("(X)E", missing(")", "E"), 3..4, Some("write )*E")),
            ("(2 3)", missing("2", "3"), 3..4, Some("write 2*3")),
            ("2 s", missing("2", "s"), 2..3, Some(UNIT)),
            ("2 rad/s", missing("2", "rad"), 2..5, Some(ANGLE)),
            ("1/2 s", missing("2", "s"), 4..5, Some(UNIT)),
            ("2 Hz", missing("2", "Hz"), 2..4, Some(HERTZ)),
            ("2 ms", missing("2", "ms"), 2..4, Some(MILLI)),
            ("1/2 ms", missing("2", "ms"), 4..6, Some(OTHER)),
            ("2 1/s", missing("2", "1"), 2..3, Some(RATE)),
            ("2 1/X", missing("2", "1"), 2..3, Some("write 2*1")),
            ("2 s^-2", missing("2", "s"), 2..3, Some(SQUARE)),
            ("2 min", missing("2", "min"), 2..5, Some(MINUTES)),
            ("2 min(1, 2)", missing("2", "min"), 2..5, Some("write 2*min")),
            ("2/s", unknown("s"), 2..3, Some(OVER)),
            ("2/gain", unknown("gain"), 2..6, None),
            ("X/s", unknown("s"), 2..3, None),
            ("2 x", missing("2", "x"), 2..3, Some("write 2*X")),
            ("2 ln(X)", missing("2", "ln"), 2..4, Some("write 2*log")),
            ("2 sqr(X)", missing("2", "sqr"), 2..5, Some("did you mean sqrt?")),
            ("(2) s", missing(")", "s"), 4..5, Some("write )*s")),
            ("2 t", missing("2", "t"), 2..3, Some(SUPREMUM)),
            ("3*cos(2*pi*t)", unknown("t"), 11..12, Some(SUPREMUM)),
            ("sqr(X)", unknown("sqr"), 0..3, Some("did you mean sqrt?")),
            ("1 + x", unknown("x"), 4..5, Some("write X")),
            ("ln(X)", unknown("ln"), 0..2, Some("write log")),
            ("arctan(X)", unknown("arctan"), 0..6, Some("write atan")),
            ("π", unknown("π"), 0..2, Some("write pi")),
            ("", Kind::Empty, 0..0, None),
            (" \n", Kind::Empty, 2..2, None),
            ("1 +", Kind::UnexpectedEnd, 3..3, None),
            ("-", Kind::UnexpectedEnd, 1..1, None),
            ("2^", Kind::UnexpectedEnd, 2..2, None),
            ("(1", Kind::Unclosed, 0..1, Some("add the missing `)`")),
            ("max(1, 2", Kind::Unclosed, 3..4, Some("add the missing `)`")),
            ("1)", unexpected(")"), 1..2, None),
            ("()", unexpected(")"), 1..2, None),
            ("(1, 2)", unexpected(","), 2..3, Some("decimals have a point, as in 1.5")),
            ("(X, 2)", unexpected(","), 2..3, None),
            ("1 * / 2", unexpected("/"), 4..5, None),
            ("X**2", unexpected("*"), 2..3, Some("write a power as u^v")),
            ("X×E", Kind::UnexpectedCharacter { character: '×' }, 1..3, Some("write *")),
            ("|X|", Kind::UnexpectedCharacter { character: '|' }, 0..1, Some("write abs(...)")),
            ("1\u{0}", Kind::UnexpectedCharacter { character: '\u{0}' }, 1..2, None),
            ("1 + sin X", Kind::FunctionWithoutArgument { name: "sin".into() }, 4..7, Some("write sin(...)")),
            ("max", Kind::FunctionWithoutArgument { name: "max".into() }, 0..3, Some("write max(...)")),
            (
                "sin^2(X)",
                Kind::FunctionWithoutArgument { name: "sin".into() },
                0..3,
                Some("write sin(...)^2, the power behind the parentheses"),
            ),
            (
                "X > 1",
                Kind::UnexpectedCharacter { character: '>' },
                2..3,
                Some("there are no comparisons: min, max and abs have corners, tanh is a smooth step"),
            ),
            (
                "\\frac{X}{2}",
                Kind::UnexpectedCharacter { character: '\\' },
                0..1,
                Some("this is no LaTeX: write (...)/(...), sqrt(...), pi"),
            ),
            ("X \\ 2", Kind::UnexpectedCharacter { character: '\\' }, 2..3, None),
            ("X ! 1", Kind::UnexpectedCharacter { character: '!' }, 2..3, None),
            ("X^1001", Kind::ExponentTooLarge, 2..6, None),
            ("X^-(2000/2+1)", Kind::ExponentTooLarge, 2..13, None),
            ("2^2^2^2^2", Kind::ExponentTooLarge, 2..9, None),
        ] {
            let found = error(text);
            assert_eq!((found.kind, found.span, found.help.as_deref()), (kind, span, help), "{text}");
        }
        for (text, needed, found) in
            [("sin()", "one argument", 0), ("sin(1, 2)", "one argument", 2), ("max(1)", "at least two arguments", 1)]
        {
            let name = text[..3].to_owned();
            assert_eq!(error(text).kind, Kind::ArgumentCount { name, needed, found }, "{text}");
        }
        assert!(matches!(error("1.2.3").kind, Kind::Number(_)));
        assert!(matches!(error("1e5000").kind, Kind::Number(_)));
        assert_eq!(error("2X").to_string(), "an operator is missing between `2` and `X`");
        assert_eq!(error("2X").expected, Some(OPERATOR));
        assert_eq!(error("2+").expected, Some(OPERAND));
    }

    #[test]
    fn constants_have_no_variables() {
        for text in ["X", "1 + E"] {
            let error = Expr::parse(text, Variables::None).map(|_| ()).unwrap_err();
            assert!(matches!(error.kind, ExprErrorKind::VariableInConstant { .. }), "{text}");
        }
        for (text, help) in
            [("2 s", "numbers have no units"), ("2e", "Euler's number is exp(1)"), ("t", "its largest value")]
        {
            let error = Expr::parse(text, Variables::None).map(|_| ()).unwrap_err();
            assert!(error.help.is_some_and(|found| found.contains(help)), "{text}");
        }
        assert!(Expr::parse("2*pi", Variables::None).is_ok());
    }

    #[test]
    fn limits() {
        let parse = |text: String| Expr::parse(&text, Variables::XAndE).map(|_| ()).map_err(|error| error.kind);
        let nested = |n: usize, open: &str, close: &str| parse(open.repeat(n) + "X" + &close.repeat(n));
        for (open, close) in [("(", ")"), ("sin(", ")"), ("max(1,", ")"), ("2^", "")] {
            assert_eq!(nested(MAX_NESTING, open, close), Ok(()), "{open}");
            assert_eq!(nested(MAX_NESTING + 1, open, close), Err(ExprErrorKind::TooDeep), "{open}");
        }
        assert_eq!(parse("-".repeat(MAX_NODES - 1) + "X"), Ok(()));
        assert_eq!(parse("-".repeat(MAX_NODES) + "X"), Err(ExprErrorKind::TooManyNodes));
        assert_eq!(parse("X+".repeat(MAX_NODES / 2 - 1) + "X"), Ok(()));
        assert_eq!(parse("(".repeat(MAX_TEXT)), Err(ExprErrorKind::TooDeep));
        assert_eq!(parse(" ".repeat(MAX_TEXT - 1) + "X"), Ok(()));
        assert_eq!(parse(" ".repeat(MAX_TEXT) + "X"), Err(ExprErrorKind::TooLong { length: MAX_TEXT + 1 }));
        let wide = Expr::parse(&("x".to_owned() + &"×".repeat(MAX_TEXT)), Variables::XAndE).map(|_| ()).unwrap_err();
        assert_eq!(wide.span.start, MAX_TEXT - 1);
        assert_eq!(parse("X^1000 + X^-1000".to_owned()), Ok(()));
    }

    #[test]
    fn spans_cover_the_operation() {
        let text = "1 + -max(X, E, 2)^(1/3)";
        let nodes = parse(text, &Variables::XAndE).unwrap();
        let spans: Vec<&str> = nodes.iter().map(|node| &text[node.span.clone()]).collect();
        let expected = ["1", "X", "E", "max(X, E", "2", "max(X, E, 2)", "1", "3", "1/3", "max(X, E, 2)^(1/3)"];
        assert_eq!(spans[..10], expected);
        assert_eq!(spans[10..], ["-max(X, E, 2)^(1/3)", text]);
    }
}
