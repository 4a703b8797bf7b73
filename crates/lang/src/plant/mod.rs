//! Plants by their formulas: x' = f(t, x, e), e' = q(t, x, e) + u, to certify and to simulate.

mod about;
mod periodicity;
mod read;

pub use about::CurveTerm;
pub use periodicity::PeriodicityFailure;
pub use read::{FORMAT, VERSIONS};

use crate::expr::{Formula, Formulas, PlantExpr, PlantNames, PlantVariable, Program};
use crate::spec::{
    Actuator, Constant, Disturbances, Document, Domain, ErrorKind, InitialSet, InputGain, InternalModel, Parameters,
    Period, SpecErrors,
};
use rug::Rational;
use std::ops::Range;

/// A plant as read from its file.
#[derive(Clone, Debug)]
pub struct Plant {
    /// The name, for reports.
    pub name: String,
    /// Free text, for reports.
    pub description: Option<String>,
    /// The period T of f and q in t. It was checked at a few hundred points that f and q have it.
    pub period: Period,
    /// The names of the states.
    pub names: PlantNames,
    /// Its named constants.
    pub parameters: Parameters,
    /// f, one expression for each state; parameters are their values there.
    pub f: Vec<PlantExpr>,
    /// q; with an actuator whose middle is not 0 that of the file plus the gain of the actuator times the middle, so that u is measured from there. Its text is
    /// that of the file.
    pub q: PlantExpr,
    /// Where simulations start.
    pub initial: Initial,
    /// The initial set to be covered; X0 is in the norm of the certificate.
    pub initial_set: InitialSet,
    /// The ball `|x - x_0|` that is asked for in the place of X0; X0 of the set then is its radius.
    pub ball: Option<Constant>,
    /// Where the model holds: |x - x_0(t)| and |e|; everywhere without it.
    pub domain: Option<Domain>,
    /// The internal model of the regulator.
    pub internal_model: InternalModel,
    /// The gain of the actuator, where it is not exactly 1.
    pub input_gain: Option<InputGain>,
    /// What the actuator takes, where the claim is to keep to it.
    pub actuator: Option<Actuator>,
    /// Noise of the measurement, a disturbance, and the rounding of the law: of what is said of given numbers of oscillators.
    pub disturbances: Disturbances,
    /// The document as it was read.
    pub document: serde_json::Value,
    /// SHA-256, in hexadecimal, of the canonical form of the document.
    pub sha256: String,
    /// The document with its places, for errors that are found after reading.
    pub source: Document,
    /// The JSON pointer of the plant in `source`; empty when it is the whole document.
    pub pointer: String,
}

/// An initial condition.
#[derive(Clone, Debug, PartialEq)]
pub struct Initial {
    /// x(0).
    pub x: Vec<f64>,
    /// e(0).
    pub e: f64,
    /// z(0).
    pub z: InitialRegulator,
}

/// How the regulator starts in a simulation.
#[derive(Clone, Debug, PartialEq)]
pub enum InitialRegulator {
    /// At rest, z = 0.
    AtRest,
    /// With z = M e, as the initial set says.
    Aligned,
    /// With these components.
    Given(Vec<f64>),
}

impl Plant {
    /// The number of states.
    #[must_use]
    pub fn states(&self) -> usize {
        self.f.len()
    }

    /// Errors found after reading, in a string of the plant: `field` is its pointer inside the plant (`/f/0`), `part` the
    /// bytes of the decoded text at fault.
    #[must_use]
    pub fn errors_at(
        &self,
        field: &str,
        part: &Range<usize>,
        kind: ErrorKind,
        message: impl Into<String>,
        help: Option<String>,
    ) -> SpecErrors {
        self.source.errors_at(&format!("{}{field}", self.pointer), part, kind, message, help)
    }

    /// Whether there are parameters of which only an interval is known, the clock among them: then it is a family of plants.
    #[must_use]
    pub fn is_family(&self) -> bool {
        self.parameters.intervals().next().is_some()
    }

    /// The member of the family with these values of the parameters with intervals. Its document is that of the family.
    ///
    /// With a clock v its time is its own, of which that of the formulas is v times: it has the period T_nom/v.
    #[must_use]
    pub fn member(&self, values: &[Rational]) -> Plant {
        let fixed = Plant {
            f: self.f.iter().map(|f| f.at(values)).collect(),
            q: self.q.at(values),
            parameters: self.parameters.fixed(values),
            ..self.clone()
        };
        let clock = self.parameters.clock().and_then(|clock| values.get(clock));
        let period = clock.and_then(|clock| self.period.nominal().over(clock));
        period.map_or(fixed.clone(), |period| fixed.at_period(&period))
    }

    /// The plant with another period, known exactly: what depends on the phase is the same at every phase. Its document is that of this
    /// one.
    #[must_use]
    pub fn at_period(&self, period: &Constant) -> Plant {
        let clock = self.period.clock_at(period).filter(|clock| *clock != 1);
        let moved = |expr: &PlantExpr| clock.as_ref().map_or_else(|| expr.clone(), |clock| expr.at_clock(clock));
        Plant {
            f: self.f.iter().map(moved).collect(),
            q: moved(&self.q),
            period: Period::from(period.clone()),
            parameters: self.parameters.clone().with_clock(None),
            ..self.clone()
        }
    }

    /// The plant of the same file with other values of some parameters, as exact constants by their names.
    ///
    /// # Errors
    /// Those of [`Plant::from_value`], as where a value makes a number of the file negative that has to be positive.
    pub fn with_parameters(&self, values: &[(String, Constant)]) -> Result<Plant, SpecErrors> {
        let mut document = self.document.clone();
        for (name, value) in values {
            document["parameters"][name] = value.text.clone().into();
        }
        let document = Document::parse("the plant with these parameters", &document.to_string())?;
        Plant::from_value(&document.root())
    }

    /// The nominal values of the parameters with intervals, in doubles.
    #[must_use]
    pub fn nominal(&self) -> Vec<f64> {
        self.parameters.nominal().iter().map(Rational::to_f64).collect()
    }

    /// The derivatives of formulas with respect to the time of the plant, at fixed x and e: with a clock the time of formulas runs v times
    /// as fast.
    pub fn derivatives_in_time(&self, formulas: &mut Formulas, of: &[Formula]) -> Vec<Formula> {
        let plain = formulas.derivatives(of, PlantVariable::Time);
        let Some(clock) = self.parameters.clock() else { return plain };
        let clock = formulas.variable(PlantVariable::Parameter(clock));
        plain.into_iter().map(|slope| formulas.product(clock, slope)).collect()
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
        Program::values(&self.right_sides(), self.states()).with_parameters(&self.nominal())
    }

    /// f and q with their derivatives with respect to x and e: (n + 2)(n + 1) outputs, as in
    /// [`Program::with_derivatives`].
    #[must_use]
    pub fn program_with_derivatives(&self) -> Program {
        Program::with_derivatives(&self.right_sides(), self.states()).with_parameters(&self.nominal())
    }
}
