//! Simulation of the closed loop: steady states, long runs, spectra, measurement noise.
//!
//! Everything here is floating point and claims nothing: it shows what a certificate speaks of, and it is what
//! the reproduction of the paper's figures and [`crate::falsify`] are made of. The same input gives the same figures on every machine.

mod adaptive;
mod bode;
mod closed_loop;
mod collocation;
mod effort;
pub(crate) mod figures;
mod fixed;
mod implicit;
mod integration;
mod limits;
mod newton;
mod noise;
mod orbit;
mod period;
mod radau;
mod report;
mod run;
mod sampled;
mod steady;
mod stiffness;

pub use adaptive::{flow, trajectory};
pub use bode::{frequencies, magnitude};
pub use closed_loop::{ClosedLoop, Disturbance, Noise};
pub use figures::{FIGURE_FILES, bode, csv, figures, spectrum, spectrum_curve};
pub use fixed::FixedStep;
pub use integration::{IntegrationFailure, Tolerance};
pub use limits::{MAX_FIXED_STEPS, MAX_NUMBERS, MAX_OPERATIONS};
pub use newton::NewtonFailure;
pub use noise::{BandLimitedNoise, NoiseSettings};
pub use orbit::{Orbit, amplitudes, rms, sup};
pub use report::SimulationReport;
pub use run::{
    Integrator, LongRun, NoisyRun, PeriodFigures, Simulation, SimulationSettings, SteadyFigures, noisy_run, simulate,
};
pub(crate) use sampled::pass_period;
pub use sampled::{
    Converters, PeriodSums, Piece, SampledLongRun, SampledLoop, SampledRun, SampledSettings, SampledSimulation,
    SampledSimulationReport, SampledSteady, SampledSteadyError, period_derivative, sampled_csv, sampled_figures,
    sampled_periodic_solution, sampled_steady_state, simulate_sampled,
};
pub use steady::{SteadyState, SteadyStateError, steady_state};
pub use stiffness::{enough_steps, is_stable};
