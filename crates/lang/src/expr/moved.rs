//! Expressions of a plant about curves that move with its parameters: sums of a wave of the time times powers of what the parameters differ by from
//! given numbers, put in the places of the states and of e (derivation, 14.4).

use super::Fourier;
use super::phase::Phase;
use super::plant::{PlantExpr, PlantVariable};
use super::syntax::{Binary, Node, NodeKind, Unary, carried};
use rug::Rational;

type Kinds = Vec<NodeKind<PlantVariable>>;

/// A sum that is put into expressions: its operations after a value, to which they add it. Without operations it is 0.
#[derive(Clone, Debug, Default)]
pub struct Sum(Kinds);

/// What the variables of a sum are.
#[derive(Clone, Copy, Debug)]
pub struct MovedBy<'a> {
    /// The phase of the waves.
    pub phase: &'a Phase,
    /// The numbers from which parameter i is measured.
    pub from: &'a [Rational],
}

impl Sum {
    /// With the wave times these powers of `p_i - p_i^0`, parameter i with the power at place i; a power that is left out is 0.
    #[must_use]
    pub fn and(mut self, variables: MovedBy<'_>, wave: &Fourier<Rational>, powers: &[u32]) -> Sum {
        let terms = variables.terms(wave);
        if powers.iter().all(|power| *power == 0) {
            self.0.extend(terms);
        } else if !terms.is_empty() {
            self.add(std::iter::once(NodeKind::Number(Rational::new())).chain(terms), variables.monomial(powers));
        }
        self
    }

    /// With the derivative of the wave in time, times these powers.
    #[must_use]
    pub fn and_slope(mut self, variables: MovedBy<'_>, wave: &Fourier<Rational>, powers: &[u32]) -> Sum {
        // That of the wave in the phase, times 2 pi/T.
        let turned = wave
            .harmonics
            .iter()
            .zip(1_u32..)
            .map(|([cos, sin], k)| [Rational::from(sin * k), Rational::from(cos * k) * -1]);
        let turned = Fourier { mean: Rational::new(), harmonics: turned.collect() };
        let terms = variables.terms(&turned);
        if !terms.is_empty() {
            let turn = variables.phase.turn().iter().filter_map(carried);
            let times = turn.chain([NodeKind::Binary(Binary::Mul)]).chain(variables.monomial(powers));
            self.add(std::iter::once(NodeKind::Number(Rational::new())).chain(terms), times);
        }
        self
    }

    /// With the value of the first operations, on which the second ones go on.
    fn add(
        &mut self,
        value: impl Iterator<Item = NodeKind<PlantVariable>>,
        times: impl IntoIterator<Item = NodeKind<PlantVariable>>,
    ) {
        self.0.extend(value.chain(times).chain([NodeKind::Binary(Binary::Add)]));
    }
}

impl MovedBy<'_> {
    /// The operations that add a wave to a value.
    fn terms(&self, wave: &Fourier<Rational>) -> Kinds {
        let term = |factor: &Rational, k: usize, function: Unary| {
            let angle = self.phase.nodes(PlantVariable::Time).into_iter();
            let angle = angle.chain([NodeKind::Number(k.into()), NodeKind::Binary(Binary::Mul)]);
            let value = [NodeKind::Unary(function), NodeKind::Number(factor.clone()), NodeKind::Binary(Binary::Mul)];
            angle.chain(value).chain([NodeKind::Binary(Binary::Add)])
        };
        let mean = [NodeKind::Number(wave.mean.clone()), NodeKind::Binary(Binary::Add)];
        let mut terms: Kinds = mean.into_iter().filter(|_| wave.mean != 0).collect();
        for ([cos, sin], k) in wave.harmonics.iter().zip(1..) {
            for (factor, function) in [(cos, Unary::Cos), (sin, Unary::Sin)] {
                terms.extend(term(factor, k, function).filter(|_| *factor != 0));
            }
        }
        terms
    }

    /// The operations that multiply a value by powers.
    fn monomial(&self, powers: &[u32]) -> Kinds {
        let factor = |(index, (power, from)): (usize, (&u32, &Rational))| {
            let difference = [
                NodeKind::Variable(PlantVariable::Parameter(index)),
                NodeKind::Number(from.clone()),
                NodeKind::Binary(Binary::Sub),
            ];
            let factor: Kinds = difference.into_iter().chain([NodeKind::Binary(Binary::Mul)]).collect();
            std::iter::repeat_n(factor, *power as usize).flatten().collect::<Kinds>()
        };
        powers.iter().zip(self.from).enumerate().flat_map(factor).collect()
    }
}

impl PlantExpr {
    /// The expression with sums added to the states (those that are left out stay) and to e, and another one to its value: its text stays.
    #[must_use]
    pub fn moved(&self, states: &[Sum], error: &Sum, more: &Sum) -> PlantExpr {
        let nothing = Sum::default();
        let moved = |node: &Node<PlantVariable>| {
            let Sum(after) = match node.kind {
                NodeKind::Variable(PlantVariable::Error) => error,
                NodeKind::Variable(PlantVariable::State(index)) => states.get(index).unwrap_or(&nothing),
                _ => &nothing,
            };
            let after = after.iter().map(|kind| Node { kind: kind.clone(), span: node.span.clone() });
            std::iter::once(node.clone()).chain(after).collect::<Vec<_>>()
        };
        let all = 0..self.text().len();
        let more = more.0.iter().map(|kind| Node { kind: kind.clone(), span: all.clone() });
        self.with_nodes(self.nodes.iter().flat_map(moved).chain(more).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Definitions, Evaluator, Expr, PlantNames, Program, Variables};
    use super::*;
    use std::sync::Arc;

    fn number(a: i32, b: i32) -> Rational {
        Rational::from((a, b))
    }

    #[test]
    fn sums_stand_in_the_places_of_the_variables() {
        let period = Expr::parse("3", Variables::None).unwrap();
        let phase = Phase::new(&period, true);
        let mut parameters = Definitions::default();
        for name in ["a", "b"] {
            parameters.define_interval(name).unwrap();
        }
        let names = PlantNames::new(vec!["v".to_owned()]).unwrap();
        let names = names.with_parameters(parameters).with_phase(phase.clone());
        let from = [number(1, 2), number(2, 1)];
        let variables = MovedBy { phase: &phase, from: &from };
        let own = Fourier {
            mean: number(1, 4),
            harmonics: vec![[number(2, 1), Rational::new()], [Rational::new(), number(-1, 3)]],
        };
        let cubic = Fourier { mean: number(1, 5), harmonics: vec![[number(-1, 1), number(3, 2)]] };
        let of_e = Sum::default().and(variables, &own, &[]).and(variables, &cubic, &[2, 1]);
        let of_v = Sum::default().and(variables, &cubic, &[0, 1]);
        let more = Sum::default().and_slope(variables, &own, &[0]).and_slope(variables, &cubic, &[1]);
        let moved = PlantExpr::parse("v*e - e^2 + a", &names).unwrap().moved(&[of_v], &of_e, &more);
        let cubic = "(1/5 - cos(phase) + 3/2*sin(phase))";
        let e = format!("(e + 1/4 + 2*cos(phase) - 1/3*sin(2*phase) + (a - 1/2)^2*(b - 2)*{cubic})");
        let v = format!("(v + (b - 2)*{cubic})");
        let slopes = "2*pi/3*(-2*sin(phase) - 2/3*cos(2*phase) + (a - 1/2)*(sin(phase) + 3/2*cos(phase)))";
        let by_hand = PlantExpr::parse(&format!("{v}*{e} - {e}^2 + a + {slopes}"), &names).unwrap();
        let programs = [moved, by_hand].map(|expr| Program::values(&[&expr], 1));
        for (t, v, e, p) in [(0.0, 1.0, 0.5, [0.5, 2.0]), (0.7, -2.0, 0.1, [1.0, 3.0]), (2.9, 3.0, -4.0, [-0.5, 1.5])] {
            let values = programs.each_ref().map(|program| {
                let mut evaluator = Evaluator::new(Arc::new(program.clone().with_parameters(&p)));
                let mut out = [0.0];
                evaluator.set_time(t);
                evaluator.evaluate(&[v], e, &mut out);
                out[0]
            });
            assert!((values[0] - values[1]).abs() < 1e-12 * (1.0 + values[1].abs()), "{t}: {values:?}");
        }
    }
}
