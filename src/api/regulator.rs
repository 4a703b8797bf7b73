//! The matrices of the regulator.

use super::error::{Error, ErrorKind};
use super::positive;
use super::subject::Subject;
use sigmastar_lang::spec::Constant;
use sigmastar_regulator::{Convergence, Design, Discrete, MAX_EXPORTED_OSCILLATORS, Regulator};

/// The regulator `z' = Phi z + Gamma e`, `u = -sigma e + mu M'N(z - M e)`, over the nominal gain where there is one, in double precision. Each number is the exact one
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
    /// The nominal gain of the actuator, by which the control is divided, where the document states one.
    pub nominal: Option<f64>,
}

impl RegulatorMatrices {
    /// The most oscillators for which matrices are made.
    pub const MAX_OSCILLATORS: u32 = MAX_EXPORTED_OSCILLATORS;

    /// The control u for a state z and a measured error e, as the actuator is given it.
    ///
    /// `None` where z does not have the dimension of the regulator.
    #[must_use]
    pub fn control(&self, z: &[f64], e: f64) -> Option<f64> {
        let terms = z.iter().zip(&self.m).zip(&self.n_diagonal);
        let sum: f64 = terms.map(|((z, m), n)| m * n * (z - m * e)).sum();
        (z.len() == self.m.len()).then_some((self.mu * sum - self.sigma * e) / self.nominal.unwrap_or(1.0))
    }
}

/// The regulator at samples, its control held between them: `u(k) = C z(k) + D e(k)`, `z(k+1) = Phi z(k) + Gamma e(k)`. Each
/// number is the exact one for the gain K, rounded once to nearest; K is the number itself.
///
/// This is `v = M'N R (z - M e)`, `u = -sigma e + K v`, `z(k+1) = R (z - M e) + (1 - step sigma) M e` with `R = e^(Phi step)` and
/// `K = mu/(1 + step mu Nbar^2/2)`, Nbar^2 the sum of all weights. On the plant `e' = u` it converges for every number of
/// oscillators that is not refused. A claim covers it only where it is about the
/// regulator at samples, with the same gain and sampling time ([`Claim::samples`](crate::Claim::samples)).
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SampledRegulator {
    /// The sampling time.
    pub step: f64,
    /// The gain K.
    pub gain: f64,
    /// The rows of the transition matrix.
    pub phi: Vec<Vec<f64>>,
    /// The input vector.
    pub gamma: Vec<f64>,
    /// The output vector C.
    pub c: Vec<f64>,
    /// D.
    pub d: f64,
    /// The spectral radius of the sampled loop on the plant `e' = u`, in floating point.
    pub spectral_radius: f64,
}

impl SampledRegulator {
    /// The control u of a sample for a state z and a measured error e.
    ///
    /// `None` where z does not have the dimension of the regulator.
    #[must_use]
    pub fn control(&self, z: &[f64], e: f64) -> Option<f64> {
        let sum: f64 = self.c.iter().zip(z).map(|(c, z)| c * z).sum();
        (z.len() == self.c.len()).then_some(sum + self.d * e)
    }
}

/// The matrices of the regulator of a specification or plant with the gain sigma, an exact positive constant, and n_o oscillators.
///
/// The gain is taken as it is given; whether it is certified is for a [`Certificate`](crate::Certificate) to say.
///
/// # Errors
/// What is wrong with sigma; [`Range`](ErrorKind::Range) beyond [`RegulatorMatrices::MAX_OSCILLATORS`];
/// [`Overflow`](ErrorKind::Overflow) where a number is beyond double precision.
pub fn regulator_matrices(subject: impl Into<Subject>, sigma: &str, n_o: u32) -> Result<RegulatorMatrices, Error> {
    let (subject, sigma) = (subject.into(), positive("sigma", sigma)?);
    let regulator = representable(&design(&subject, &sigma, n_o)?)?;
    Ok(RegulatorMatrices {
        sigma: regulator.sigma,
        mu: regulator.mu,
        phi: rows(&regulator.phi()),
        gamma: regulator.gamma(),
        m: regulator.m(),
        n_diagonal: regulator.n_diagonal(),
        nominal: regulator.nominal,
    })
}

/// The regulator at samples for a sampling time, an exact positive constant.
///
/// # Errors
/// Those of [`regulator_matrices`]; what is wrong with the sampling time; [`Range`](ErrorKind::Range) for one that works
/// badly or not at all: `sigma step > 1`, or the fastest oscillator turns by half a turn or more in a sample;
/// [`NotAvailable`](ErrorKind::NotAvailable) where the document has `delay_samples` 1, whose law has other matrices.
pub fn sampled_regulator(
    subject: impl Into<Subject>,
    sigma: &str,
    n_o: u32,
    step: &str,
) -> Result<SampledRegulator, Error> {
    let (subject, sigma) = (subject.into(), positive("sigma", sigma)?);
    let design = design(&subject, &sigma, n_o)?;
    if design.is_delayed() {
        let message = "the law with `delay_samples` 1 is not given as matrices here";
        let help = "export it with `sigmastar controller`, or leave `delay_samples` out";
        return Err(Error::new(ErrorKind::NotAvailable, message, help));
    }
    let regulator = representable(&design)?;
    let step = positive("step", step)?;
    if let Some(error) = design.sampling_errors(&step).first() {
        return Err(Error::new(ErrorKind::Range, error.to_string(), &error.way_out()));
    }
    let discrete = design.discretise(&step).filter(Discrete::is_representable).ok_or_else(overflow)?;
    let sampled = Convergence::new(&design, &step, &regulator, &discrete).ok_or_else(overflow)?;
    Ok(SampledRegulator {
        step: discrete.step,
        gain: discrete.gain,
        phi: rows(&discrete.transition()),
        gamma: discrete.input,
        c: discrete.output,
        d: discrete.feedthrough,
        spectral_radius: sampled.spectral_radius(),
    })
}

fn design<'s>(subject: &'s Subject, sigma: &'s Constant, n_o: u32) -> Result<Design<'s>, Error> {
    if n_o > MAX_EXPORTED_OSCILLATORS {
        let help = format!("choose at most {MAX_EXPORTED_OSCILLATORS}");
        return Err(Error::new(ErrorKind::Range, format!("n_o: {n_o} oscillators are too many"), &help));
    }
    Ok(Design::new(subject.read.internal_model(), sigma, n_o).for_actuator(subject.read.input_gain()))
}

fn representable(design: &Design<'_>) -> Result<Regulator, Error> {
    Some(design.regulator()).filter(Regulator::is_representable).ok_or_else(overflow)
}

fn overflow() -> Error {
    let help = "use units of time in which the gains, frequencies and sampling time have ordinary magnitudes";
    Error::new(ErrorKind::Overflow, "a number of this regulator is beyond double precision", help)
}

fn rows(matrix: &faer::Mat<f64>) -> Vec<Vec<f64>> {
    matrix.row_iter().map(|row| row.iter().copied().collect()).collect()
}
