//! Expressions in the variables of a plant: t, the states and e.

use super::definitions::{Definitions, is_name, is_reserved};
use super::exact::{Constants, sign};
use super::names::Scope;
use super::parse::parse;
use super::phase::{INSTEAD_OF_TIME, PHASE, Phase};
use super::syntax::{Binary, Node, NodeKind, step};
use super::{ExprError, ExprErrorKind};
use rug::Rational;
use std::cmp::Ordering;
use std::fmt;
use std::sync::Arc;
use thiserror::Error;

/// The most states that a plant may have.
pub const MAX_STATES: usize = 100;

const OPERAND: &str = "a number, t, a state, e, pi, a function or an opening parenthesis";
const OPERAND_WITH_PARAMETERS: &str = "a number, t, a state, e, a parameter, pi, a function or an opening parenthesis";

/// A variable of a plant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PlantVariable {
    /// The time t.
    Time,
    /// A state, by its index from 0.
    State(usize),
    /// The regulated error e.
    Error,
    /// A parameter of which an interval is known, by its index among these from 0.
    Parameter(usize),
}

/// The names of a plant's states, and of constants; t and e are always there.
#[derive(Clone, Debug)]
pub struct PlantNames {
    states: Vec<String>,
    parameters: Definitions,
    phase: Option<Phase>,
}

/// Why a list of state names was refused.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum NameError {
    /// Too many states.
    #[error("{found} states; at most {MAX_STATES} are read")]
    TooMany {
        /// How many there are.
        found: usize,
    },
    /// Not a name.
    #[error("state {index} has no name that can be used in an expression")]
    Malformed {
        /// The index of the state, from 0.
        index: usize,
    },
    /// A name that has a meaning already.
    #[error("the name of state {index} has another meaning in expressions")]
    Reserved {
        /// The index of the state, from 0.
        index: usize,
    },
    /// Two states of one name.
    #[error("state {index} has the name of another state")]
    Duplicate {
        /// The index of the second state, from 0.
        index: usize,
    },
}

impl NameError {
    /// The index of the state at fault, where it is one.
    #[must_use]
    pub fn index(&self) -> Option<usize> {
        match self {
            NameError::TooMany { .. } => None,
            NameError::Malformed { index } | NameError::Reserved { index } | NameError::Duplicate { index } => {
                Some(*index)
            }
        }
    }
}

impl PlantNames {
    /// The states with these names, in their order.
    ///
    /// # Errors
    /// [`NameError`]: a name is a letter or underscore followed by letters, digits and underscores (ASCII, at most 40
    /// bytes); not `t`, `phase`, `e`, `pi` or a function; and no two are the same.
    pub fn new(states: Vec<String>) -> Result<PlantNames, NameError> {
        if states.len() > MAX_STATES {
            return Err(NameError::TooMany { found: states.len() });
        }
        for (index, name) in states.iter().enumerate() {
            if !is_name(name) {
                return Err(NameError::Malformed { index });
            }
            if is_reserved(name) {
                return Err(NameError::Reserved { index });
            }
            if states[..index].contains(name) {
                return Err(NameError::Duplicate { index });
            }
        }
        Ok(PlantNames { states, parameters: Definitions::default(), phase: None })
    }

    /// These states beside constants with names. A name of both is that of the state.
    #[must_use]
    pub fn with_parameters(self, parameters: Definitions) -> PlantNames {
        PlantNames { parameters, ..self }
    }

    /// These names and `phase`; without `t` where the period is not known exactly.
    #[must_use]
    pub fn with_phase(self, phase: Phase) -> PlantNames {
        PlantNames { phase: Some(phase), ..self }
    }

    /// Whether t itself may stand in formulas.
    fn knows_time(&self) -> bool {
        self.phase.as_ref().is_none_or(|phase| phase.exact)
    }

    /// The names of the states.
    #[must_use]
    pub fn states(&self) -> &[String] {
        &self.states
    }
}

impl Scope for PlantNames {
    type Variable = PlantVariable;

    fn variable(&self, name: &str) -> Option<Result<PlantVariable, Option<String>>> {
        match name {
            "t" => self.knows_time().then_some(Ok(PlantVariable::Time)),
            "e" => Some(Ok(PlantVariable::Error)),
            _ => {
                let state = self.states.iter().position(|state| state == name).map(PlantVariable::State);
                state.or_else(|| self.parameters.interval(name).map(PlantVariable::Parameter)).map(Ok)
            }
        }
    }

    fn definition(&self, name: &str) -> Option<&[Node]> {
        self.parameters.nodes(name)
    }

    fn phase(&self) -> Option<Vec<NodeKind<PlantVariable>>> {
        self.phase.as_ref().map(|phase| phase.nodes(PlantVariable::Time))
    }

    fn operand(&self) -> &'static str {
        if self.parameters.names().next().is_some() { OPERAND_WITH_PARAMETERS } else { OPERAND }
    }

    fn instead_of(&self, name: &str) -> Option<&'static str> {
        match name {
            "u" => Some(
                "u acts in e' = q + u alone and is not written: leave it out of q; a plant on which it acts elsewhere has a higher relative degree, \
                 and is stated with another e (the user guide, `Relative degree above 1`)",
            ),
            "t" => Some(INSTEAD_OF_TIME),
            _ => None,
        }
    }

    fn has_corners(&self) -> bool {
        false
    }

    fn definable(&self, name: &str) -> Option<String> {
        is_name(name).then(|| {
            format!(
                "give it a value in the field `parameters` of the file, as `\"parameters\": {{ \"{name}\": \"1\" }}`"
            )
        })
    }

    fn names(&self) -> impl Iterator<Item = &str> {
        let times = [self.knows_time().then_some("t"), self.phase.as_ref().map(|_| PHASE)];
        times
            .into_iter()
            .flatten()
            .chain(["e"])
            .chain(self.states.iter().map(String::as_str))
            .chain(self.parameters.names())
    }
}

/// The scope of an expression in parameters alone.
struct OfParameters<'a> {
    names: &'a Definitions,
}

impl Scope for OfParameters<'_> {
    type Variable = PlantVariable;

    fn variable(&self, name: &str) -> Option<Result<PlantVariable, Option<String>>> {
        self.names.interval(name).map(|index| Ok(PlantVariable::Parameter(index)))
    }

    fn definition(&self, name: &str) -> Option<&[Node]> {
        self.names.nodes(name)
    }

    fn operand(&self) -> &'static str {
        "a number, a parameter, pi, a function or an opening parenthesis"
    }

    fn names(&self) -> impl Iterator<Item = &str> {
        self.names.names()
    }
}

/// A right side of a plant: an expression in t, the states and e, with its text.
///
/// It is a type of its own: no proof about bounding functions can be asked of it, and no bounding function can contain
/// its variables.
#[derive(Clone, Debug)]
pub struct PlantExpr {
    text: Arc<str>,
    pub(super) nodes: Arc<[Node<PlantVariable>]>,
}

impl PlantExpr {
    /// Reads an expression, by the grammar of [`Expr::parse`](super::Expr::parse) with other variables.
    ///
    /// # Errors
    /// Those of [`Expr::parse`](super::Expr::parse), and a constant divisor that is 0.
    pub fn parse(text: &str, names: &PlantNames) -> Result<PlantExpr, ExprError> {
        let nodes = parse(text, names)?;
        no_zero_divisor(text, &nodes)?;
        Ok(PlantExpr { text: text.into(), nodes: nodes.into() })
    }

    /// Reads an expression in the parameters with intervals alone, with those that are constants written out in its text.
    ///
    /// # Errors
    /// Those of [`Expr::parse`](super::Expr::parse).
    pub fn of_parameters(text: &str, names: &Definitions) -> Result<PlantExpr, ExprError> {
        let nodes = parse(text, &OfParameters { names })?;
        Ok(PlantExpr { text: names.written_out(text).into(), nodes: nodes.into() })
    }

    /// The expression with numbers in the places of the parameters with intervals; those without a number stay.
    #[must_use]
    pub fn at(&self, parameters: &[Rational]) -> PlantExpr {
        let fixed = |node: &Node<PlantVariable>| match &node.kind {
            NodeKind::Variable(PlantVariable::Parameter(index)) => match parameters.get(*index) {
                Some(value) => Node { kind: NodeKind::Number(value.clone()), span: node.span.clone() },
                None => node.clone(),
            },
            _ => node.clone(),
        };
        PlantExpr { text: self.text.clone(), nodes: self.nodes.iter().map(fixed).collect() }
    }

    /// The expression at `clock` times the time, where that is the nominal time of a plant that runs `clock` times as fast.
    #[must_use]
    pub fn at_clock(&self, clock: &Rational) -> PlantExpr {
        let timed = |node: &Node<PlantVariable>| {
            let moved = matches!(node.kind, NodeKind::Variable(PlantVariable::Time));
            let factor = [NodeKind::Number(clock.clone()), NodeKind::Binary(Binary::Mul)];
            let factor = factor.map(|kind| Node { kind, span: node.span.clone() });
            std::iter::once(node.clone()).chain(factor.into_iter().filter(move |_| moved))
        };
        PlantExpr { text: self.text.clone(), nodes: self.nodes.iter().flat_map(timed).collect() }
    }

    /// The expression plus a number times another one, of the same names: its text stays, as the place of what is added.
    #[must_use]
    pub fn plus(&self, factor: &Rational, other: &PlantExpr) -> PlantExpr {
        let place = |kind| Node { kind, span: 0..self.text.len() };
        let added = other.nodes.iter().map(|node| place(node.kind.clone()));
        let after = [NodeKind::Number(factor.clone()), NodeKind::Binary(Binary::Mul), NodeKind::Binary(Binary::Add)];
        self.with_nodes(self.nodes.iter().cloned().chain(added).chain(after.map(place)).collect())
    }

    /// The expression with other operations: its text stays.
    pub(super) fn with_nodes(&self, nodes: Vec<Node<PlantVariable>>) -> PlantExpr {
        PlantExpr { text: self.text.clone(), nodes: nodes.into() }
    }

    /// The source text, exactly as it was parsed.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }
}

/// That no constant divides that is known to be 0, such as a parameter: everywhere else it would be told at a state.
fn no_zero_divisor(text: &str, nodes: &[Node<PlantVariable>]) -> Result<(), ExprError> {
    let mut stack = Vec::new();
    for node in nodes {
        let divides = matches!(node.kind, NodeKind::Binary(Binary::Div));
        if divides && matches!(stack.last(), Some(Some(divisor)) if sign(divisor) == Some(Ordering::Equal)) {
            let operation = text[node.span.clone()].to_owned();
            let help =
                Some("correct the numbers that make it 0; a parameter that divides has to be another one".to_owned());
            let kind = ExprErrorKind::ZeroDivisor { operation };
            return Err(ExprError { kind, span: node.span.clone(), expected: None, help });
        }
        step(node, &mut stack, &mut Constants);
    }
    Ok(())
}

impl fmt::Display for PlantExpr {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Expr, Variables};
    use super::*;

    fn names(states: &[&str]) -> Result<PlantNames, NameError> {
        PlantNames::new(states.iter().map(|name| (*name).to_owned()).collect())
    }

    #[test]
    fn names_that_cannot_be_used_are_refused() {
        assert!(names(&[]).is_ok() && names(&["x1", "X", "E", "_v", "theta_2"]).is_ok());
        for (states, error) in [
            (&["x1", "2x"][..], NameError::Malformed { index: 1 }),
            (&[""], NameError::Malformed { index: 0 }),
            (&["x-1"], NameError::Malformed { index: 0 }),
            (&["é"], NameError::Malformed { index: 0 }),
            (&["t"], NameError::Reserved { index: 0 }),
            (&["a", "e"], NameError::Reserved { index: 1 }),
            (&["sin"], NameError::Reserved { index: 0 }),
            (&["max"], NameError::Reserved { index: 0 }),
            (&["pi"], NameError::Reserved { index: 0 }),
            (&["x", "y", "x"], NameError::Duplicate { index: 2 }),
        ] {
            assert_eq!(names(states).unwrap_err(), error, "{states:?}");
        }
        let many = vec!["x"; MAX_STATES + 1];
        assert_eq!(names(&many).unwrap_err(), NameError::TooMany { found: MAX_STATES + 1 });
    }

    #[test]
    fn the_variables_of_a_plant_and_no_others() {
        let names = names(&["x1", "v"]).unwrap();
        assert!(PlantExpr::parse("-x1 + v*e*sin(2*pi*t)", &names).is_ok());
        for (text, message, help) in [
            (
                "X",
                "`X` is not a known name",
                Some("give it a value in the field `parameters` of the file, as `\"parameters\": { \"X\": \"1\" }`"),
            ),
            ("E + 1", "`E` is not a known name", Some("write e")),
            ("x2", "`x2` is not a known name", Some("did you mean x1?")),
            ("vt", "`vt` is not a known name", Some("write v*t")),
            ("2t", "an operator is missing between `2` and `t`", Some("write 2*t")),
            ("v(t)", "an operator is missing between `v` and `(`", Some("write v*(")),
            (
                "cos(pi.*t)",
                "the character '.' has no meaning in an expression",
                Some("write *, / and ^ for .*, ./ and .^"),
            ),
            (
                "v + e/(2 - 2)",
                "`e/(2 - 2)`: the divisor is 0",
                Some("correct the numbers that make it 0; a parameter that divides has to be another one"),
            ),
        ] {
            let error = PlantExpr::parse(text, &names).map(|_| ()).unwrap_err();
            assert_eq!((error.to_string().as_str(), error.help.as_deref()), (message, help), "{text}");
        }
        let mut parameters = Definitions::default();
        for (name, value) in [("k", "-3"), ("stiffness", "2*pi"), ("two", "2")] {
            parameters.define(name, Expr::parse(value, Variables::None).unwrap()).unwrap();
        }
        let with = names.clone().with_parameters(parameters);
        let nodes = |text: &str, names: &PlantNames| -> Vec<String> {
            PlantExpr::parse(text, names).unwrap().nodes.iter().map(|node| format!("{:?}", node.kind)).collect()
        };
        for (text, written) in
            [("k*x1", "(-3)*x1"), ("k^2 - sin(stiffness*t)", "(-3)^2 - sin((2*pi)*t)"), ("v^two", "v^(2)")]
        {
            assert_eq!(nodes(text, &with), nodes(written, &names), "{text}");
        }
        for (text, help) in [
            ("stifness*x1", "did you mean stiffness?"),
            ("Stifness*x1", "did you mean stiffness?"),
            ("2k", "write 2*k"),
            ("k(x1)", "write k*("),
            ("kv", "write k*v"),
        ] {
            let error = PlantExpr::parse(text, &with).map(|_| ()).unwrap_err();
            assert_eq!(error.help.as_deref(), Some(help), "{text}");
        }
        assert_eq!(PlantExpr::parse("2*", &with).map(|_| ()).unwrap_err().expected, Some(OPERAND_WITH_PARAMETERS));
        assert_eq!(PlantExpr::parse("2*", &names).map(|_| ()).unwrap_err().expected, Some(OPERAND));
    }
}
