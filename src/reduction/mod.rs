//! From a plant's formulas to a specification whose data are proved (derivation, 11).

mod coordinates;
mod grid;
mod specification;

pub use coordinates::{Chosen, CoordinateSearch, Density, Frame, Sampler};
pub use grid::{Grid, KINDS, Source, Values};
pub use specification::specification;
