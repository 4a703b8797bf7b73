//! The matrices of the regulator.

use super::error::{Error, ErrorKind};
use super::positive;
use super::specification::Specification;
use crate::regulator::{Design, MAX_EXPORTED_OSCILLATORS, Regulator, SampledLoop};

/// The regulator `z' = Phi z + Gamma e`, `u = -sigma e + mu M'N(z - M e)` in double precision. Each number is the exact one
/// of the specification, rounded once to nearest; no claim is made of them.
///
/// The state has the dimension `2 n_o + 1`: the integrator, then two numbers for each oscillator.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RegulatorMatrices {
    /// The gain sigma.
    pub sigma: f64,
    /// The gain mu.
    pub mu: f64,
    /// The rows of Phi.
    pub phi: Vec<Vec<f64>>,
    /// Gamma.
    pub gamma: Vec<f64>,
    /// M.
    pub m: Vec<f64>,
    /// The diagonal of N.
    pub n_diagonal: Vec<f64>,
}

impl RegulatorMatrices {
    /// The most oscillators for which matrices are made.
    pub const MAX_OSCILLATORS: u32 = MAX_EXPORTED_OSCILLATORS;

    /// The control u for a state z and a measured error e.
    ///
    /// `None` where z does not have the dimension of the regulator.
    #[must_use]
    pub fn control(&self, z: &[f64], e: f64) -> Option<f64> {
        let terms = z.iter().zip(&self.m).zip(&self.n_diagonal);
        let sum: f64 = terms.map(|((z, m), n)| m * n * (z - m * e)).sum();
        (z.len() == self.m.len()).then_some(self.mu * sum - self.sigma * e)
    }
}

/// The regulator at the samples of a computer, the error held over each sample: `z(k+1) = Phi z(k) + Gamma e(k)`. Each
/// number is the exact one, rounded once to nearest.
///
/// A certificate is about continuous time: it says nothing about a sampled regulator.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SampledRegulator {
    /// The sampling time.
    pub step: f64,
    /// The rows of the transition matrix.
    pub phi: Vec<Vec<f64>>,
    /// The input vector.
    pub gamma: Vec<f64>,
    /// The spectral radius of the sampled loop on the plant `e' = u`, in floating point: from 1 on it does not converge.
    pub spectral_radius: f64,
}

/// The matrices of the regulator of a specification with the gain sigma, an exact positive constant, and n_o oscillators.
///
/// The gain is taken as it is given; whether it is certified is for a [`Certificate`](crate::Certificate) to say.
///
/// # Errors
/// What is wrong with sigma; [`Range`](ErrorKind::Range) beyond [`RegulatorMatrices::MAX_OSCILLATORS`];
/// [`Overflow`](ErrorKind::Overflow) where a number is beyond double precision.
pub fn regulator_matrices(specification: &Specification, sigma: &str, n_o: u32) -> Result<RegulatorMatrices, Error> {
    let regulator = representable(&design(specification, sigma, n_o)?)?;
    Ok(RegulatorMatrices {
        sigma: regulator.sigma,
        mu: regulator.mu,
        phi: rows(&regulator.phi()),
        gamma: regulator.gamma(),
        m: regulator.m(),
        n_diagonal: regulator.n_diagonal(),
    })
}

/// The exact discretisation of the same regulator for a sampling time, an exact positive constant.
///
/// # Errors
/// Those of [`regulator_matrices`]; what is wrong with the sampling time; [`Range`](ErrorKind::Range) for one that cannot
/// work: `sigma step >= 2`, or the fastest oscillator turns by half a turn or more in a sample.
pub fn sampled_regulator(
    specification: &Specification,
    sigma: &str,
    n_o: u32,
    step: &str,
) -> Result<SampledRegulator, Error> {
    let design = design(specification, sigma, n_o)?;
    let regulator = representable(&design)?;
    let step = positive("step", step)?;
    design.check_sampling(&step).map_err(|error| Error::new(ErrorKind::Range, error.to_string(), &error.way_out()))?;
    let discrete = design.discretise(&step);
    let sampled = SampledLoop::new(&regulator, &discrete).filter(|_| discrete.is_representable());
    let spectral_radius = sampled.ok_or_else(overflow)?.spectral_radius();
    let phi = rows(&discrete.transition());
    Ok(SampledRegulator { step: discrete.step, phi, gamma: discrete.input, spectral_radius })
}

fn design<'s>(specification: &'s Specification, sigma: &str, n_o: u32) -> Result<Design<'s>, Error> {
    let sigma = positive("sigma", sigma)?;
    if n_o > MAX_EXPORTED_OSCILLATORS {
        let help = format!("choose at most {MAX_EXPORTED_OSCILLATORS}");
        return Err(Error::new(ErrorKind::Range, format!("n_o: {n_o} oscillators are too many"), &help));
    }
    Ok(Design::new(&specification.read.internal_model, &sigma, n_o))
}

fn representable(design: &Design<'_>) -> Result<Regulator, Error> {
    Some(design.regulator()).filter(Regulator::is_representable).ok_or_else(overflow)
}

fn overflow() -> Error {
    let help = "use units of time in which the gains, frequencies and sampling time have ordinary magnitudes";
    Error::new(ErrorKind::Overflow, "a number of this regulator is beyond double precision", help)
}

fn rows(matrix: &ndarray::Array2<f64>) -> Vec<Vec<f64>> {
    matrix.outer_iter().map(|row| row.to_vec()).collect()
}
