//! What a bounding specification says, with every number exact.

use super::actuator::Actuator;
use super::bound::Bound;
use super::bounding::Bounds;
use super::disturbances::Disturbances;
use super::document::Document;
use super::input_gain::InputGain;
use super::of_plant::OfPlant;
use super::oscillators::AskedHarmonics;
pub use super::parts::{
    Constant, Domain, InitialSet, Jacobian, JacobianEntry, KnownForcing, Lyapunov, OrbitCurve, PeriodicMatrix,
    RelativeDegree, SIZES, StartSizes, TrigonometricVector,
};
use super::period::Period;
use super::sampling::{PRECISION, SampledGain, Sampling};
use super::weights::Weights;
use crate::expr::Expr;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;

/// A checked specification: fields present, numbers exact and in range, weights proved to satisfy W1-W3.
///
/// What is *not* checked here, because it depends on the arguments that a certificate uses: that the bounding
/// functions are finite, nonnegative and nondecreasing (see [`crate::expr::prove_bounding`]), and the rate nonincreasing.
#[derive(Clone, Debug)]
pub struct Specification {
    /// The name of the plant, for reports.
    pub name: String,
    /// Free text, for reports.
    pub description: Option<String>,
    /// The period T > 0 of f and q, in units of time.
    pub period: Period,
    /// The Lyapunov data of the zero dynamics, or where they come from.
    pub lyapunov: LyapunovSource,
    /// The bounding functions.
    pub bounds: Bounds,
    /// What is known of q(t,0,0), if anything.
    pub q_0: Option<KnownForcing>,
    /// Where the bounding functions hold; everywhere when absent.
    pub domain: Option<Domain>,
    /// The internal model of the regulator.
    pub internal_model: InternalModel,
    /// The initial conditions to be covered.
    pub initial_set: InitialSet,
    /// The gain of the actuator, where it is not exactly 1.
    pub input_gain: Option<InputGain>,
    /// What the actuator takes, where the claim is to keep to it.
    pub actuator: Option<Actuator>,
    /// Noise of the measurement, a disturbance, and the rounding of the law: of what is said of given numbers of oscillators.
    pub disturbances: Disturbances,
    /// The relative-degree filter, when e is a combination of xi_1, ..., xi_r.
    pub relative_degree: Option<RelativeDegree>,
    /// The document as it was read, without `$schema`: key order and the text of numbers as written.
    ///
    /// Move it where it is needed. Converting it once more (`serde_json::to_value`, `json!`) rewrites exponents, after
    /// which the digest below need not fit.
    pub document: serde_json::Value,
    /// SHA-256, in hexadecimal, of the canonical form of the document (keys sorted, no white space, numbers as
    /// written).
    pub sha256: String,
    /// The document with its places, for errors that are found after reading.
    pub source: Document,
    /// The JSON pointer of the specification in `source`; empty when it is the whole document.
    pub pointer: String,
}

/// Where the Lyapunov triple comes from.
#[derive(Clone, Debug)]
pub enum LyapunovSource {
    /// The user vouches for it.
    Given(Lyapunov),
    /// It is to be found and proved for this Jacobian (`certify::resolve`). Until then there is no triple, and nothing
    /// that needs one is decided.
    Wanted(Jacobian),
    /// It was proved for this Jacobian, with this P_x(t).
    Proved {
        /// F(t) = df/dx(t,0,0).
        jacobian: Jacobian,
        /// The triple.
        triple: Lyapunov,
        /// P_x(t).
        matrix: PeriodicMatrix,
        /// Another triple, with its P(t), for the existence of the periodic solution; without, the first one serves.
        existence: Option<Box<(Lyapunov, PeriodicMatrix)>>,
    },
    /// It was proved from the formulas of this plant, like all other data.
    Plant(Box<OfPlant>),
}

impl LyapunovSource {
    /// The triple, given or proved.
    #[must_use]
    pub fn triple(&self) -> Option<&Lyapunov> {
        match self {
            LyapunovSource::Given(triple) | LyapunovSource::Proved { triple, .. } => Some(triple),
            LyapunovSource::Plant(plant) => Some(&plant.triple),
            LyapunovSource::Wanted(_) => None,
        }
    }

    /// Whether the existence of the periodic solution has a triple of its own.
    #[must_use]
    pub fn has_second_triple(&self) -> bool {
        match self {
            LyapunovSource::Proved { existence, .. } => existence.is_some(),
            LyapunovSource::Plant(plant) => plant.existence.is_some(),
            LyapunovSource::Given(_) | LyapunovSource::Wanted(_) => false,
        }
    }

    /// The triple for the existence of the periodic solution.
    #[must_use]
    pub fn existence_triple(&self) -> Option<&Lyapunov> {
        match self {
            LyapunovSource::Proved { existence: Some(other), .. } => Some(&other.0),
            LyapunovSource::Plant(plant) => Some(plant.existence.as_ref().map_or(&plant.triple, |other| &other.0)),
            _ => self.triple(),
        }
    }

    /// The Jacobian, where the specification has one.
    #[must_use]
    pub fn jacobian(&self) -> Option<&Jacobian> {
        match self {
            LyapunovSource::Wanted(jacobian) | LyapunovSource::Proved { jacobian, .. } => Some(jacobian),
            LyapunovSource::Given(_) | LyapunovSource::Plant(_) => None,
        }
    }
}

impl Specification {
    /// v_bar, in the unit of e: what is measured is e + v with |v| <= v_bar.
    #[must_use]
    pub fn v_bar(&self) -> Rational {
        self.disturbances.v_bar()
    }

    /// d_bar, in the unit of e': |d| <= d_bar is added to q.
    #[must_use]
    pub fn d_bar(&self) -> Rational {
        self.disturbances.d_bar()
    }

    /// What was proved of the plant, where the data come from its formulas.
    #[must_use]
    pub fn plant(&self) -> Option<&OfPlant> {
        match &self.lyapunov {
            LyapunovSource::Plant(plant) => Some(plant),
            _ => None,
        }
    }

    /// The name of the deviation that the norms are of, in reports: x, or y in the coordinates of a plant's formulas; `None` for a
    /// plant without states, of which there is nothing to say.
    #[must_use]
    pub fn state_name(&self) -> Option<&'static str> {
        match self.plant() {
            None => Some("x"),
            Some(plant) => (plant.states() > 0).then_some("y"),
        }
    }
}

/// The regulator's internal model: mu > 0 and w > 0 in 1/time.
#[derive(Clone, Debug)]
pub struct InternalModel {
    /// The gain mu.
    pub mu: Constant,
    /// The base frequency w (omega-hat).
    pub base_frequency: Constant,
    /// Whether base_frequency = 2 pi / period, proved exactly.
    pub matched: bool,
    /// The weights n_0, n_1, ...
    pub weights: Weights,
    /// Of which oscillators the claim is to be; of every set where that costs nothing, if nothing is asked.
    pub harmonics: Option<AskedHarmonics>,
    /// The samples of a computer, where the regulator runs on one.
    pub sampling: Option<Sampling>,
}

impl InternalModel {
    /// Whether the claim is to be about every finite set of harmonics that contains 0 (derivation, 14.7).
    #[must_use]
    pub fn asks_every_set(&self) -> bool {
        self.harmonics == Some(AskedHarmonics::EverySet)
    }

    /// K and Nb2 for a sampling time h > 0.
    ///
    /// Guarantee: both are doubles, K > 0, Nb2 is not below the sum of all weights, and K h Nb2 < 2. `None` where that is not
    /// to be had in double precision: h mu times the sum of the weights is beyond 2^50.
    #[must_use]
    pub fn sampled_gain(&self, step: &Constant) -> Option<SampledGain> {
        let step = step.enclose(PRECISION);
        let mu = self.mu.enclose(PRECISION);
        let total = self.weights.total(PRECISION);
        let theta = &step * &mu * &total / 2;
        let gain = Rational::from_f64((mu / (theta + 1)).midpoint_f64())?;
        let weight_sum = Rational::from_f64(total.upper_f64())?;
        let exact = |value: &Rational| Enclosure::from_rational(value, PRECISION);
        let proved = (exact(&gain) * step * exact(&weight_sum)).lt(&Enclosure::from_integer(2, PRECISION)).is_true();
        (proved && gain > 0).then_some(SampledGain { gain, weight_sum })
    }
}

impl Bound {
    /// The expression that a specification has for it, or for its replacement.
    #[doc(hidden)]
    #[must_use]
    pub fn of(self, spec: &Specification) -> Option<&Expr> {
        spec.bounds.get(self)
    }

    /// Where it is given itself: the one that would serve without it, and bounds the same.
    #[doc(hidden)]
    #[must_use]
    pub fn supremum(self, spec: &Specification) -> Option<Bound> {
        self.replacement().filter(|_| spec.bounds.is_given(self))
    }
}
