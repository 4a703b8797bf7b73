//! The loop with the regulator at samples: the law as it is exported, one call of its stepper for a sample, and between
//! samples the plant with the control held, integrated as accurately as in continuous time.

mod derivative;
mod digital_loop;
mod figures;
mod report;
mod run;
mod steady;
mod words;

pub use derivative::period_derivative;
pub use digital_loop::{Converters, DigitalLoop, DigitalRun, Piece};
pub use figures::{digital_csv, digital_figures};
pub use report::DigitalReport;
pub use run::{DigitalLongRun, DigitalSettings, DigitalSimulation, PeriodSums, simulate_digital};
pub use steady::{DigitalSteady, DigitalSteadyError, digital_periodic_solution, digital_steady_state};
