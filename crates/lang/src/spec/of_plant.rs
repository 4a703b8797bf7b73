//! What was proved of a plant that is known by its formulas (derivation, 11): all that a certificate has to repeat.

use super::parameters::Parameters;
use super::parts::{Constant, Domain, Lyapunov, OrbitCurve, PeriodicMatrix};
use crate::expr::Fourier;
use rug::Rational;

/// `|x_0 - xb|` is at most `radius` in the norm of y (derivation, 11.2).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ProvedOrbit {
    /// xb, in the plant's own coordinates.
    pub approximation: OrbitCurve,
    /// eps.
    pub defect: Rational,
    /// rho.
    pub tube: Rational,
    /// r.
    pub radius: Rational,
}

/// `mean + sum_k (a_k cos(k w t) + b_k sin(k w t))`, w = 2 pi / period.
pub type Wave = Fourier<Rational>;

/// `qb(t)`, and what is proved of it: `|q(t,x_0,0) - qb| <= rest`, and its derivative in t at most `rest_t`, for all t
/// (derivation, 11.4).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ProvedForcing {
    /// m_0.
    pub mean: Rational,
    /// (a_k, b_k) for k = 1, 2, ...
    pub harmonics: Vec<[Rational; 2]>,
    /// What is added to these times `p_i - p_i^0`, for each parameter of which an interval is known (derivation, 13.2).
    pub sensitivities: Vec<Wave>,
    /// r_0.
    pub rest: Rational,
    /// r_1, per time.
    pub rest_t: Rational,
}

impl ProvedForcing {
    /// `qb(t)` of the nominal plant.
    #[must_use]
    pub fn nominal(&self) -> Wave {
        Wave { mean: self.mean.clone(), harmonics: self.harmonics.clone() }
    }

    /// `qb(t)` at these `p_i - p_i^0`.
    #[must_use]
    pub fn at(&self, deviations: &[Rational]) -> Wave {
        self.sensitivities.iter().zip(deviations).fold(self.nominal(), |wave, (part, deviation)| {
            wave.with(part, &Rational::new(), |own, more| own + Rational::from(more * deviation))
        })
    }
}

/// What was proved of the members of a family whose parameters lie in one box (derivation, 13.2); of a plant without intervals all of it.
#[derive(Clone, Debug)]
pub struct ProvedCell {
    /// The constants, with the intervals of the box; orbit and forcing are about their nominal values.
    pub parameters: Parameters,
    /// The orbit.
    pub orbit: ProvedOrbit,
    /// q along the orbit.
    pub forcing: ProvedForcing,
}

/// The plant behind the data of a specification.
#[derive(Clone, Debug)]
pub struct OfPlant {
    /// Its named constants.
    pub parameters: Parameters,
    /// The rows of L: `x = x_0 + L y`.
    pub coordinates: Vec<Vec<Rational>>,
    /// The orbit and q along it, in cells that cover the box of the parameters: one where it is not cut.
    pub cells: Vec<ProvedCell>,
    /// Why the box is cut, where a search did that.
    pub why_cut: Option<String>,
    /// The triple of stability, and of the orbit, in the coordinates y.
    pub triple: Lyapunov,
    /// Its P(t).
    pub matrix: PeriodicMatrix,
    /// Another triple with its P(t), for the existence of the periodic solution; without, the first one serves.
    pub existence: Option<Box<(Lyapunov, PeriodicMatrix)>>,
    /// Where the model holds, as it was given: `|x - x_0|` and `|e|`.
    pub domain: Option<Domain>,
    /// The radius of the ball `|x - x_0|` that the initial set has to contain, where one was asked for.
    pub ball: Option<Constant>,
}

impl OfPlant {
    /// The number of states.
    #[must_use]
    pub fn states(&self) -> usize {
        self.coordinates.len()
    }

    /// The only cell, where that is the box of the parameters as it stands in the plant.
    #[must_use]
    pub fn undivided(&self) -> Option<&ProvedCell> {
        match &self.cells[..] {
            [cell] if cell.parameters.intervals().eq(self.parameters.intervals()) => Some(cell),
            _ => None,
        }
    }

    /// The largest of a number of the cells; 0 without any.
    #[must_use]
    pub fn largest(&self, of: impl Fn(&ProvedCell) -> &Rational) -> Rational {
        self.cells.iter().map(of).max().cloned().unwrap_or_default()
    }

    /// The smallest of a number of the cells; 0 without any.
    #[must_use]
    pub fn smallest(&self, of: impl Fn(&ProvedCell) -> &Rational) -> Rational {
        self.cells.iter().map(of).min().cloned().unwrap_or_default()
    }
}
