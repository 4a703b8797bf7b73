//! A plant about curves that move with its parameters (derivation, 14.4).

use super::Plant;
use crate::expr::{MovedBy, Sum};
use crate::spec::{Interval, TrigonometricVector, Wave};
use rug::Rational;

/// Curves of the states, of e and of u, times powers of what a member differs by from the nominal one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CurveTerm {
    /// Of `p_i - p_i^0` for each parameter of which an interval is known, and then, if the gain of the actuator is an interval, of `b - 1`.
    pub powers: Vec<u32>,
    /// That of x, in the plant's own coordinates.
    pub states: TrigonometricVector,
    /// That of e.
    pub error: Wave,
    /// That of u.
    pub control: Wave,
}

impl CurveTerm {
    /// Whether it is about the nominal member.
    #[must_use]
    pub fn is_nominal(&self) -> bool {
        self.powers.iter().all(|power| *power == 0)
    }

    /// Component `index` of the states.
    #[must_use]
    pub fn state(&self, index: usize) -> Wave {
        self.states.map(|vector| vector.get(index).cloned().unwrap_or_default())
    }
}

impl Plant {
    /// The plant about the curves (xhat, ehat, uhat) that are the sums of these terms: with xhat less its nominal term and ehat added to the states and
    /// to e, and with the derivatives in time of both taken off. So at the curve of the nominal states and e = 0
    ///
    /// - f is `f(t,xhat,ehat) - xhat'`, and the derivative of the nominal states in time;
    /// - q is `q(t,xhat,ehat) + b uhat - ehat'`.
    ///
    /// `gain`: where b lies, if that is an interval; it is one more parameter then, after the others. Its document is that of this plant.
    ///
    /// Hypotheses: the period is known, and each term has a power for each of these parameters.
    #[must_use]
    pub fn about(&self, terms: &[CurveTerm], gain: Option<Interval>) -> Plant {
        let phase = self.period.phase();
        let parameters = match gain.clone() {
            Some(gain) => self.parameters.clone().and(gain),
            None => self.parameters.clone(),
        };
        let from = parameters.nominal();
        let by = MovedBy { phase: &phase, from: &from };
        let minus = |wave: &Wave| wave.map(|part| Rational::from(-part));
        let moving = || terms.iter().filter(|term| !term.is_nominal());
        let of_state = |i: usize| moving().fold(Sum::default(), |sum, term| sum.and(by, &term.state(i), &term.powers));
        let of_states: Vec<Sum> = (0..self.states()).map(of_state).collect();
        let of_error = terms.iter().fold(Sum::default(), |sum, term| sum.and(by, &term.error, &term.powers));
        let f = self.f.iter().enumerate().map(|(i, f)| {
            let velocity =
                moving().fold(Sum::default(), |sum, term| sum.and_slope(by, &minus(&term.state(i)), &term.powers));
            f.moved(&of_states, &of_error, &velocity)
        });
        let beside = terms.iter().fold(Sum::default(), |sum, CurveTerm { powers, error, control, .. }| {
            let sum = sum.and(by, control, powers).and_slope(by, &minus(error), powers);
            // b = 1 + (b - 1).
            let Some(index) = gain.as_ref().map(|_| from.len() - 1) else { return sum };
            let mut raised = powers.clone();
            raised.resize(from.len(), 0);
            raised[index] += 1;
            sum.and(by, control, &raised)
        });
        let q = self.q.moved(&of_states, &of_error, &beside);
        Plant { f: f.collect(), q, parameters, ..self.clone() }
    }
}
