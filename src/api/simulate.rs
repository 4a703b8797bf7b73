//! Simulations: floating point, no claim.

use super::error::{Error, ErrorKind};
use super::report::Report;
use super::subject::Subject;
use super::{in_range, positive};
use sigmastar_document::plot::Figure;
use sigmastar_document::progress::{Progress, Silent};
use sigmastar_lab::simulate::{
    ClosedLoop, Integrator, SampledLoop, SampledSettings, SampledSimulationReport, SimulationReport,
    SimulationSettings, csv, figures, sampled_csv, sampled_figures, simulate_sampled,
};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Actuator, Constant};
use sigmastar_regulator::{Design, Regulator, WrongDimension};

/// The most oscillators of a simulation.
const MAX_OSCILLATORS: u32 = 200;

/// What is simulated. The defaults are those of `sigmastar simulate`.
///
/// ```
/// use sigmastar::SimulationOptions;
/// let options = SimulationOptions::new("2").n_o(4).periods(50);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct SimulationOptions {
    sigma: String,
    n_o: Option<u32>,
    periods: u32,
    samples: u32,
    harmonics: u32,
    sampling_period: Option<String>,
    input_gain: Option<String>,
}

impl SimulationOptions {
    /// With the gain sigma, an exact positive constant, and without an internal model: `u = -sigma e`.
    #[must_use]
    pub fn new(sigma: impl Into<String>) -> SimulationOptions {
        SimulationOptions {
            sigma: sigma.into(),
            n_o: None,
            periods: 30,
            samples: 200,
            harmonics: 12,
            sampling_period: None,
            input_gain: None,
        }
    }

    /// The internal model of the plant file with this many oscillators, at most 200.
    #[must_use]
    pub fn n_o(mut self, n_o: u32) -> SimulationOptions {
        self.n_o = Some(n_o);
        self
    }

    /// The length of the run from the initial condition, in periods (default 30, at most 100000).
    #[must_use]
    pub fn periods(mut self, periods: u32) -> SimulationOptions {
        self.periods = periods;
        self
    }

    /// Samples per period of the run (default 200, at most 100000).
    #[must_use]
    pub fn samples(mut self, samples: u32) -> SimulationOptions {
        self.samples = samples;
        self
    }

    /// Fourier coefficients of the error in the report (default 12, at most 1000).
    #[must_use]
    pub fn harmonics(mut self, harmonics: u32) -> SimulationOptions {
        self.harmonics = harmonics;
        self
    }

    /// The regulator at samples this far apart, an exact positive constant; with the delay that the plant file states.
    #[must_use]
    pub fn sampling_period(mut self, period: impl Into<String>) -> SimulationOptions {
        self.sampling_period = Some(period.into());
        self
    }

    /// The true gain of the actuator, an exact positive constant; the nominal one of the plant file without it.
    #[must_use]
    pub fn input_gain(mut self, gain: impl Into<String>) -> SimulationOptions {
        self.input_gain = Some(gain.into());
        self
    }

    /// # Errors
    /// A number that is out of range.
    fn in_range(&self) -> Result<(), Error> {
        in_range("n_o", self.n_o.unwrap_or(0), 0..=MAX_OSCILLATORS)?;
        in_range("periods", self.periods, 1..=100_000)?;
        in_range("samples", self.samples, 1..=100_000)?;
        in_range("harmonics", self.harmonics, 1..=1000)
    }
}

/// A simulation: the steady state with its figures, and a run from the initial condition. It claims nothing.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Simulation {
    complete: bool,
    csv: Option<String>,
    figures: Vec<(&'static str, Figure)>,
    report: Report,
}

/// What is made of a simulation beside its report.
#[derive(Clone, Copy, Debug)]
pub struct Wanted {
    /// The run as a table.
    pub csv: bool,
    /// The figures.
    pub figures: bool,
}

impl Wanted {
    const TABLE: Wanted = Wanted { csv: true, figures: false };
}

impl Simulation {
    /// Whether the steady state was found and the run reached its end.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.complete
    }

    /// The run, as the file that `sigmastar simulate --csv` writes: t, the states, e, u, z; `None` where it ended early.
    #[must_use]
    pub fn csv(&self) -> Option<&str> {
        self.csv.as_deref()
    }

    /// The figures with the names of their files, for the program; none where none are wanted.
    #[doc(hidden)]
    #[must_use]
    pub fn figures(&self) -> &[(&'static str, Figure)] {
        &self.figures
    }

    /// The report of `sigmastar simulate`.
    #[must_use]
    pub fn report(&self) -> &Report {
        &self.report
    }
}

/// Simulates a plant with a regulator, from the initial condition of its file.
///
/// # Errors
/// A document that is no plant; numbers out of range; [`Options`](ErrorKind::Options) for samples without a number of oscillators;
/// [`Overflow`](ErrorKind::Overflow) where a number is beyond double precision.
pub fn simulate(plant: impl Into<Subject>, options: &SimulationOptions) -> Result<Simulation, Error> {
    options.in_range()?;
    let sigma = positive("sigma", &options.sigma)?;
    let optional = |name, text: &Option<String>| text.as_ref().map(|text| positive(name, text)).transpose();
    let step = optional("sampling_period", &options.sampling_period)?;
    let gain = match optional("input_gain", &options.input_gain)?.map(|gain| gain.to_f64()) {
        Some(gain) if !(gain > 0.0 && gain.is_finite()) => return Err(beyond()),
        gain => gain,
    };
    let plant = plant.into().plant()?;
    if !plant.period.nominal().to_f64().is_normal() {
        return Err(beyond());
    }
    match (options.n_o, step) {
        (Some(n_o), Some(step)) => at_samples(&plant, options, &design(&plant, &sigma, n_o), &step, gain),
        (Some(n_o), None) => in_continuous_time(&plant, options, design(&plant, &sigma, n_o).regulator(), gain),
        (None, None) => {
            let nominal = plant.input_gain.as_ref().map(|gain| gain.nominal.to_f64());
            in_continuous_time(&plant, options, Regulator::high_gain(sigma.to_f64()).for_actuator(nominal), gain)
        }
        (None, Some(_)) => {
            let message = "`sampling_period` is for a regulator with an internal model";
            Err(Error::new(ErrorKind::Options, message, "give `n_o`, or leave `sampling_period` out"))
        }
    }
}

fn design<'p>(plant: &'p Plant, sigma: &'p Constant, n_o: u32) -> Design<'p> {
    Design::new(&plant.internal_model, sigma, n_o).for_actuator(plant.input_gain.as_ref())
}

fn in_continuous_time(
    plant: &Plant,
    options: &SimulationOptions,
    regulator: Regulator,
    gain: Option<f64>,
) -> Result<Simulation, Error> {
    if !regulator.is_representable() {
        return Err(beyond());
    }
    let closed_loop = ClosedLoop::new(plant, regulator);
    let closed_loop = gain.into_iter().fold(closed_loop, ClosedLoop::with_input_gain);
    let settings = SimulationSettings {
        periods: options.periods as usize,
        integrator: Integrator::Adaptive,
        samples: options.samples as usize,
        noise: None,
        noise_steps: 1,
        harmonics: options.harmonics as usize,
    };
    run_loop(plant, &closed_loop, &settings, Wanted::TABLE, &Silent)
}

/// Simulates a loop in continuous time from the initial condition of its plant.
///
/// # Errors
/// An initial z that is for another number of oscillators.
pub fn run_loop(
    plant: &Plant,
    closed_loop: &ClosedLoop,
    settings: &SimulationSettings,
    wanted: Wanted,
    progress: &dyn Progress,
) -> Result<Simulation, Error> {
    let start = closed_loop.start_of(&plant.initial).map_err(wrong_dimension)?;
    let simulation = sigmastar_lab::simulate::simulate(closed_loop, &start, settings, progress);
    let noisy = simulation.noisy.as_ref().is_none_or(Result::is_ok);
    let table = simulation.long.as_ref().ok().filter(|_| wanted.csv);
    Ok(Simulation {
        complete: simulation.steady.is_ok() && simulation.long.is_ok() && noisy,
        csv: table.map(|run| csv(plant, closed_loop, run)),
        figures: if wanted.figures { figures(plant, closed_loop, &simulation) } else { Vec::new() },
        report: Report::of(&SimulationReport { plant, closed_loop, simulation: &simulation }),
    })
}

fn at_samples(
    plant: &Plant,
    options: &SimulationOptions,
    design: &Design<'_>,
    step: &Constant,
    gain: Option<f64>,
) -> Result<Simulation, Error> {
    let (regulator, discrete) = (design.regulator(), design.discretise(step).ok_or_else(beyond)?);
    // What is cut off by the actuator the law is told, as its export is.
    let limit = plant.actuator.as_ref().map(Actuator::limit).or(discrete.saturation);
    let sampled = SampledLoop::new(plant, regulator, discrete.saturated(limit));
    let sampled = gain.into_iter().fold(sampled, SampledLoop::with_input_gain);
    if !sampled.regulator.is_representable() || !sampled.discrete.is_representable() {
        return Err(beyond());
    }
    let settings = SampledSettings {
        periods: options.periods as usize,
        samples: options.samples as usize,
        harmonics: options.harmonics as usize,
    };
    run_sampled_loop(plant, &sampled, &settings, Wanted::TABLE, &Silent)
}

/// Simulates a loop with the law at samples from the initial condition of its plant.
///
/// # Errors
/// An initial z that is for another number of oscillators.
pub fn run_sampled_loop(
    plant: &Plant,
    sampled: &SampledLoop,
    settings: &SampledSettings,
    wanted: Wanted,
    progress: &dyn Progress,
) -> Result<Simulation, Error> {
    let start = sampled.start_of(&plant.initial).map_err(wrong_dimension)?;
    let simulation = simulate_sampled(sampled, &start, settings, progress);
    let table = simulation.long.as_ref().ok().filter(|_| wanted.csv);
    Ok(Simulation {
        complete: simulation.steady.is_ok() && simulation.long.is_ok() && !simulation.is_unstable(),
        csv: table.map(|run| sampled_csv(plant, sampled, run)),
        figures: if wanted.figures { sampled_figures(plant, sampled, &simulation) } else { Vec::new() },
        report: Report::of(&SampledSimulationReport { plant, sampled, simulation: &simulation }),
    })
}

fn beyond() -> Error {
    let help = "use units of time in which the gains, frequencies and the period have ordinary magnitudes";
    Error::new(ErrorKind::Overflow, "a number of this simulation is beyond double precision", help)
}

fn wrong_dimension(error: WrongDimension) -> Error {
    let help = "give the number of oscillators that it is for, or remove z for a start at rest";
    Error::new(ErrorKind::Range, error.to_string(), help)
}
