//! The paper's numerical section again: both tables and the five figures, each cell as printed and as computed here.
//!
//! Floating point: a comparison, not a proof. The tables were made with n_0 = 1 while the text says n_0 = 2 (erratum
//! E20), so both are computed; their second column is the root mean square, not its square (E19); the columns with
//! noise are shown as ranges over seeds for both readings of the law (E22), and nothing is tuned to meet them.

mod figures;
mod printed;
mod report;
mod run;

pub use figures::{FIGURE_FILES, figures};
pub use printed::{PrintedRow, PrintedTable, ROWS, last_place};
pub use report::ReproductionReport;
pub use run::{Cell, ComputedRow, NoiseRange, Parts, Reproduction, ReproductionSettings, reproduce, units};
