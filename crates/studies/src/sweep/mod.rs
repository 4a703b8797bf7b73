//! Parameter studies: one specification or plant with many values put in, each case certified by itself.
//!
//! A [`Study`] says which values go where; [`Sweep`] makes the cases; [`run`](run::run) certifies them in parallel and hands over a
//! [`Row`] each; [`Results`] are the rows of all cases, and [`csv`] is their table. Nothing is claimed between the cases.

mod cases;
mod design;
mod figure;
mod parameter;
mod places;
mod results;
mod row;
mod run;
mod study;
mod table;
mod values;

pub use cases::{Case, Sweep};
pub use design::Design;
pub use figure::{FigureError, sweep_figure};
pub use parameter::Parameter;
pub use results::{Results, ResultsError};
pub use row::{Row, RowClaim, RowError, X0_BOUNDS};
pub use run::{run, solve};
pub use study::{FORMAT, Study, SubjectSource, VERSIONS};
pub use table::{best, csv, summary};
pub use values::{Range, Scalar, Values};

/// The most cases of a study.
pub const MAX_CASES: u64 = 100_000;

/// The most parameters of a study.
pub const MAX_PARAMETERS: usize = 16;
