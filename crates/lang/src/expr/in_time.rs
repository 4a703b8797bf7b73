//! Functions of time alone, in `t` and in the phase of a period.

use super::names::{Scope, TIME_OPERAND};
use super::parse::parse;
use super::phase::{INSTEAD_OF_TIME, PHASE, Phase};
use super::syntax::{Argument, NodeKind};
use super::{Expr, ExprError, Variables};
use std::sync::Arc;

/// Functions of time alone.
struct InTime<'a>(&'a Phase);

impl Scope for InTime<'_> {
    type Variable = Argument;

    fn variable(&self, name: &str) -> Option<Result<Argument, Option<String>>> {
        if self.0.exact { Variables::Time.variable(name) } else { None }
    }

    fn phase(&self) -> Option<Vec<NodeKind<Argument>>> {
        Some(self.0.nodes(Argument::X))
    }

    fn operand(&self) -> &'static str {
        if self.0.exact { TIME_OPERAND } else { "a number, phase, pi, a function or an opening parenthesis" }
    }

    fn names(&self) -> impl Iterator<Item = &str> {
        self.0.exact.then_some("t").into_iter().chain([PHASE])
    }

    fn instead_of(&self, name: &str) -> Option<&'static str> {
        (name == "t" && !self.0.exact).then_some(INSTEAD_OF_TIME)
    }
}

impl Expr {
    /// Reads a function of time, as [`Expr::parse`] with [`Variables::Time`], in which `phase` may stand for 2 pi t/T.
    ///
    /// # Errors
    /// Those of [`Expr::parse`]; `t` where the period is not known exactly.
    pub fn parse_in_time(text: &str, phase: &Phase) -> Result<Expr, ExprError> {
        let nodes = parse(text, &InTime(phase))?;
        Ok(Expr { text: text.into(), nodes: nodes.into(), roles: Arc::default() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{PlantExpr, PlantNames};

    fn phase(period: &str, exact: bool) -> Phase {
        Phase::new(&Expr::parse(period, Variables::None).unwrap(), exact)
    }

    #[test]
    fn the_phase_is_a_turn_in_a_period() {
        for (period, text, written) in [
            ("1/50", "sin(phase)", "sin((2*pi/(1/50))*t)"),
            ("2*pi", "cos(3*phase - 1)", "cos(3*((2*pi/(2*pi))*t) - 1)"),
        ] {
            let phase = phase(period, true);
            let nodes = |expr: Expr| -> Vec<String> { expr.nodes.iter().map(|n| format!("{:?}", n.kind)).collect() };
            let read = Expr::parse_in_time(text, &phase).unwrap();
            assert_eq!(nodes(read.clone()), nodes(Expr::parse(written, Variables::Time).unwrap()), "{text}");
            let exact = Expr::parse(period, Variables::None).unwrap().exact().unwrap();
            assert!(read.trigonometric(&exact, 64).is_ok());
            let names = PlantNames::new(vec!["x".to_owned()]).unwrap().with_phase(phase);
            let plant = PlantExpr::parse(&format!("x*{text} + sin(phase - 2*x)"), &names).unwrap();
            assert_eq!(plant.prove_periodic(Some(&exact)), Ok(()));
        }
    }

    #[test]
    fn time_stands_only_beside_an_exact_period() {
        let (exact, interval) = (phase("2", true), phase("2", false));
        assert!(Expr::parse_in_time("cos(pi*t) + sin(phase)", &exact).is_ok());
        let error = Expr::parse_in_time("cos(pi*t)", &interval).unwrap_err();
        assert_eq!(
            (error.to_string().as_str(), error.help.as_deref()),
            ("`t` is not a known name", Some(INSTEAD_OF_TIME))
        );
        let names = PlantNames::new(vec!["x".to_owned()]).unwrap();
        let with = names.clone().with_phase(interval);
        assert!(PlantExpr::parse("x + sin(phase)", &with).is_ok());
        assert_eq!(PlantExpr::parse("x + sin(pi*t)", &with).unwrap_err().help.as_deref(), Some(INSTEAD_OF_TIME));
        assert!(PlantExpr::parse("x + sin(phase)", &names).is_err());
        assert!(PlantNames::new(vec!["phase".to_owned()]).is_err());
    }
}
