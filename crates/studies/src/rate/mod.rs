//! Rates of convergence for a given number of oscillators: they tend to 0 as n_o grows, while sigma* does not move.
//!
//! Those of the oscillators alone and of the closed loop are proved in `sigmastar_prove::rate`; [`by_kappa`] is a rate by the paper's
//! constants c and kappa, for comparison.

pub mod by_kappa;

use by_kappa::RateByKappa;
use rug::Rational;
use sigmastar_decide::conditions::{NoPlant, SharpProof};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_rational};
use sigmastar_prove::certify::{Certification, Verdict};
use sigmastar_prove::rate::inequality::{ErrorDynamics, LoopBounds};
use sigmastar_prove::rate::oscillators::{OscillatorMatrix, ProvedLyapunov};
use sigmastar_prove::rate::riccati;
use sigmastar_prove::rate::small_gain::SmallGain;
use sigmastar_theory::data::Data;
use std::fmt;

/// The largest number of oscillators for which rates are worked out: matrices of order up to 407.
pub const MAX_OSCILLATORS: u32 = 200;

/// Shares of the spectral abscissa that are tried for the oscillators alone.
const SHARES: [f64; 7] = [0.9999, 0.999, 0.99, 0.95, 0.9, 0.75, 0.5];

/// How a rate of the closed loop was proved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Method {
    /// By a Lyapunov function for this number of oscillators and gain, from a Riccati equation.
    Riccati,
    /// By the Lyapunov function of the certificate and the paper's constants c and kappa.
    Kappa,
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Method::Riccati => "riccati",
            Method::Kappa => "kappa",
        })
    }
}

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
    /// The best proved rate of exponential convergence of the closed loop's state to the periodic solution, at the given sigma.
    pub closed_loop: Option<(Rational, Method)>,
    /// The rate that the paper's c and kappa give, proved.
    pub by_kappa: Option<Enclosure>,
}

/// Why there are no rates.
#[derive(Clone, Debug)]
pub enum NoRates {
    /// Nothing is certified by the sharp derivation; the verdict.
    NotCertified(Verdict),
    /// No plant with a state satisfies the data: a rate of all of them would be one of a plant without x.
    NoPlant(Box<NoPlant>),
    /// The gain is below this sigma*.
    BelowSigmaStar(Rational),
    /// With an actuator that saturates the claim is about this gain alone.
    OtherGain(Rational),
    /// The input gain is uncertain: the inequalities of a rate are those of one gain.
    InputGain,
}

/// The [`rates`] of a certified run, with the gain they are for: sigma* where none is given.
///
/// # Errors
/// [`NoRates`].
pub fn certified_rates(
    run: &Certification<'_>,
    sigma: Option<Rational>,
    n_o: &[u32],
) -> Result<(Rational, Vec<Rates>), NoRates> {
    let (Some(sigma_star), Some(proof)) = (run.sigma_star(), run.sharp.proved()) else {
        return Err(NoRates::NotCertified(run.verdict));
    };
    if let Some(reason) = &run.no_plant {
        return Err(NoRates::NoPlant(Box::new(reason.clone())));
    }
    let data = Data::new(run.spec, proof.precision);
    if data.input_gain.is_some() {
        return Err(NoRates::InputGain);
    }
    let sigma = sigma.unwrap_or_else(|| sigma_star.clone());
    if sigma < *sigma_star {
        return Err(NoRates::BelowSigmaStar(sigma_star.clone()));
    }
    if run.spec.actuator.is_some() && sigma != *sigma_star {
        return Err(NoRates::OtherGain(sigma_star.clone()));
    }
    let found = rates(&data, proof, &sigma, n_o);
    Ok((sigma, found))
}

/// The rates for several n_o at a gain `sigma >= sigma*`.
///
/// Guarantee: every rate but `spectral` is proved; `None` says that nothing was proved, not that there is none. The rate of the
/// closed loop holds from the initial set of the proof.
#[must_use]
pub fn rates(data: &Data<'_>, proof: &SharpProof, sigma: &Rational, n_o: &[u32]) -> Vec<Rates> {
    // The error box is proved to be invariant from sigma* on.
    let bounds = LoopBounds::new(data, &proof.evaluation.error_box).filter(|_| *sigma >= proof.witness.sigma);
    let by_kappa = RateByKappa::new(data, proof, sigma);
    n_o.iter().map(|n_o| at(data, sigma, *n_o, bounds.as_ref(), by_kappa.as_ref())).collect()
}

fn at(
    data: &Data<'_>,
    sigma: &Rational,
    n_o: u32,
    bounds: Option<&LoopBounds>,
    by_kappa: Option<&RateByKappa>,
) -> Rates {
    let system = OscillatorMatrix::new(data, n_o);
    let eigen = system.eigen();
    let spectral = eigen.as_ref().map(|eigen| -eigen.abscissa());
    let prove = |rate: f64| eigen.as_ref().and_then(|eigen| system.prove(eigen, rate));
    let oscillators =
        spectral.and_then(|spectral| SHARES.iter().find_map(|share| prove(share * spectral)).map(|proved| proved.rate));
    let lemma: Option<ProvedLyapunov> = prove(0.0);
    let by_kappa = lemma.as_ref().zip(by_kappa).map(|(lemma, by_kappa)| by_kappa.rate(lemma));
    let own = bounds.and_then(|bounds| {
        let dynamics = ErrorDynamics { oscillators: &system, sigma: sigma.clone(), bounds, input_gain: None };
        let condition = SmallGain::new(&dynamics)?;
        riccati::propose_and_prove(&dynamics, &condition).map(|witness| (witness.rate, Method::Riccati))
    });
    let weaker = by_kappa.as_ref().and_then(Enclosure::lower_rational).filter(|rate| *rate > 0);
    let weaker = weaker.map(|rate| (round_rational(&rate, 6, Direction::Down), Method::Kappa));
    let closed_loop = match (own, weaker) {
        (Some(own), Some(weaker)) => Some(if own.0 >= weaker.0 { own } else { weaker }),
        (own, weaker) => own.or(weaker),
    };
    let lemma = lemma.map(|lemma| {
        let rate = Rational::from(1) / (lemma.largest.clone() * 2u32);
        (lemma.largest, round_rational(&rate, 6, Direction::Down))
    });
    Rates { n_o, spectral, oscillators, lemma, closed_loop, by_kappa }
}
