//! The loop with the regulator at samples: the law as it is exported, one call of its stepper for a sample, and between
//! samples the plant with the control held, integrated as accurately as in continuous time.

mod derivative;
mod figures;
mod report;
mod run;
mod sampled_loop;
mod steady;
mod words;

pub use derivative::period_derivative;
pub use figures::{sampled_csv, sampled_figures};
pub use report::SampledSimulationReport;
pub use run::{PeriodSums, SampledLongRun, SampledSettings, SampledSimulation, simulate_sampled};
pub use sampled_loop::{Converters, Piece, SampledLoop, SampledRun};
pub(crate) use steady::pass_period;
pub use steady::{SampledSteady, SampledSteadyError, sampled_periodic_solution, sampled_steady_state};
