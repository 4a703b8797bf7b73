//! Rates of convergence for a given number of oscillators: they tend to 0 as n_o grows, while sigma* does not move.
//!
//! - [`oscillators`]: P_zeta and the decay rate of `Phi - mu M M'N` (Lemma 1 of the paper, P:lemma:hurwitzPhiM);
//! - [`closed_loop`]: a rate for the closed loop of derivation section 5.

pub mod closed_loop;
pub mod oscillators;

use crate::certificate::SharpProof;
use crate::data::Data;
use crate::enclosure::Enclosure;
use crate::number::{Direction, round_rational};
use closed_loop::ClosedLoop;
use oscillators::{Oscillators, ProvedLyapunov};
use rug::Rational;

/// The largest number of oscillators for which rates are worked out: matrices of order 401.
pub const MAX_OSCILLATORS: u32 = 200;

/// What was found for one n_o; rates in 1/time.
#[derive(Clone, Debug)]
pub struct Rates {
    /// n_o.
    pub n_o: u32,
    /// Minus the spectral abscissa of `Phi - mu M M'N`, in floating point.
    pub spectral: Option<f64>,
    /// A proved decay rate of `zeta' = (Phi - mu M M'N) zeta`.
    pub oscillators: Option<Rational>,
    /// P_zeta of Lemma 1, as its largest eigenvalue relative to N, with the proved rate 1/(2 p) that the lemma gives: every
    /// kappa > 0 is admissible, and the rate of N + kappa P_zeta tends to it as kappa grows.
    pub lemma: Option<(Rational, Rational)>,
    /// A proved rate of exponential convergence of the closed loop's state to the periodic solution, at the given sigma.
    pub closed_loop: Option<Enclosure>,
}

/// The rates for one n_o at a gain `sigma >= sigma*`.
///
/// Guarantee: every rate but `spectral` is proved; `None` says that nothing was proved, not that there is none. The rate of the
/// closed loop holds from the initial set of the proof.
#[must_use]
pub fn rates(data: &Data<'_>, proof: &SharpProof, sigma: &Rational, n_o: u32) -> Rates {
    let system = Oscillators::new(data, n_o);
    let eigen = system.eigen();
    let spectral = eigen.as_ref().map(|eigen| -eigen.abscissa());
    let at = |rate: f64| eigen.as_ref().and_then(|eigen| system.prove(eigen, rate));
    let oscillators = spectral.and_then(|spectral| {
        [0.99, 0.95, 0.9, 0.75, 0.5].iter().find_map(|share| at(share * spectral)).map(|proved| proved.rate)
    });
    let lemma: Option<ProvedLyapunov> = at(0.0);
    let closed_loop =
        lemma.as_ref().and_then(|lemma| ClosedLoop::new(data, proof, sigma).map(|closed_loop| closed_loop.rate(lemma)));
    let lemma = lemma.map(|lemma| {
        let rate = Rational::from(1) / (lemma.largest.clone() * 2u32);
        (lemma.largest, round_rational(&rate, 6, Direction::Down))
    });
    Rates { n_o, spectral, oscillators, lemma, closed_loop }
}
