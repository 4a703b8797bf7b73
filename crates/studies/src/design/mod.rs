//! The design table: what is proved at several gains with several numbers of oscillators, beside what is required of a loop; and the pair to take.

mod choice;
mod gains;
mod period;
mod report;
mod requirements;
mod row;
mod tried;
mod values;

pub use choice::{Choice, choose};
pub use gains::{Claims, design_table};
pub use period::LongestPeriod;
pub use report::DesignReport;
pub use requirements::{Compared, Requirement, Requirements};
pub use row::{Cell, Noise, Row, Simulated};
pub use values::{Merit, TriedValues, ValuesTried, best_values, mu_by_the_period};
