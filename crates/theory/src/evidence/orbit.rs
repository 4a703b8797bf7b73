//! The periodic orbit of a plant, and coordinates around it (derivation, 11.2, 11.5).

use rug::Rational;
use sigmastar_lang::spec::{OrbitCurve, PeriodicMatrix};

/// The most states of a plant whose orbit is sought, as for a Jacobian of a specification: semidefinite programs and proofs of
/// a rate grow with a high power of their number.
pub const MAX_STATES: usize = 12;

/// The most harmonics of a curve, of a P and of q that are expanded.
pub const MAX_HARMONICS: usize = 1_000;

/// Coordinates and the P in them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Coordinates {
    /// L, row by row.
    pub l: Vec<Vec<Rational>>,
    /// P(t) in the coordinates y; the identity where it is constant.
    pub p: PeriodicMatrix,
}

/// An orbit, proved: x' = f(t,x,0) has exactly one T-periodic solution x_0 with `|L^-1 (x_0 - xb)| <= tube` for all t; it has
/// `|L^-1 (x_0 - xb)| <= radius`; along it P has the rate `alpha` (derivation, 11.2).
///
/// Without states `defect` and `radius` are 0, the others 1 and without meaning.
#[derive(Clone, Debug, PartialEq)]
pub struct OrbitProof {
    /// xb(t).
    pub orbit: OrbitCurve,
    /// eps.
    pub defect: Rational,
    /// rho.
    pub tube: Rational,
    /// r.
    pub radius: Rational,
    /// The rate of P in the tube, in 1/time.
    pub alpha: Rational,
    /// `p_low I <= P(t)`.
    pub p_low: Rational,
    /// `P(t) <= p_up I`.
    pub p_up: Rational,
}
