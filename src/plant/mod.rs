//! Plants to simulate: x' = f(t, x, e), e' = q(t, x, e) + u, with f and q given as expressions.
//!
//! A plant file is to a simulation what a bounding specification is to a certificate. Nothing connects the two: that
//! a plant lies within some bounding functions is not checked here.

mod periodicity;
mod read;

pub use periodicity::PeriodicityFailure;
pub use read::{FORMAT, VERSIONS};

use crate::expr::{Formula, Formulas, PlantExpr, PlantNames, Program};
use crate::spec::{Constant, InternalModel};

/// A plant as read from its file.
#[derive(Clone, Debug)]
pub struct Plant {
    /// The name, for reports.
    pub name: String,
    /// Free text, for reports.
    pub description: Option<String>,
    /// The period T of f and q in t. It was checked at a few hundred points that f and q have it.
    pub period: Constant,
    /// The names of the states.
    pub names: PlantNames,
    /// f, one expression for each state.
    pub f: Vec<PlantExpr>,
    /// q.
    pub q: PlantExpr,
    /// Where simulations start.
    pub initial: Initial,
    /// The internal model of the regulator.
    pub internal_model: InternalModel,
}

/// An initial condition.
#[derive(Clone, Debug, PartialEq)]
pub struct Initial {
    /// x(0).
    pub x: Vec<f64>,
    /// e(0).
    pub e: f64,
    /// z(0); empty for a regulator at rest.
    pub z: Vec<f64>,
}

impl Plant {
    /// The number of states.
    #[must_use]
    pub fn states(&self) -> usize {
        self.f.len()
    }

    /// f and then q.
    fn right_sides(&self) -> Vec<&PlantExpr> {
        self.f.iter().chain([&self.q]).collect()
    }

    /// f and then q as exact formulas: n + 1 of them.
    #[must_use]
    pub fn formulas(&self) -> (Formulas, Vec<Formula>) {
        let mut formulas = Formulas::new();
        let all = self.right_sides().into_iter().map(|expr| formulas.insert(expr)).collect();
        (formulas, all)
    }

    /// f and q compiled: n + 1 outputs.
    #[must_use]
    pub fn program(&self) -> Program {
        Program::values(&self.right_sides(), self.states())
    }

    /// f and q with their derivatives with respect to x and e: (n + 2)(n + 1) outputs, as in
    /// [`Program::with_derivatives`].
    #[must_use]
    pub fn program_with_derivatives(&self) -> Program {
        Program::with_derivatives(&self.right_sides(), self.states())
    }
}
