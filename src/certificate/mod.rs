//! The certificate file: the names of its numbers, reading its witness and its claim, writing it.

mod digital;
mod fields;
mod of_plant;
mod read;
mod read_digital;
mod read_plant;
mod stated;
mod triple;
mod write;

pub use digital::{digital_certificate_json, digital_statement};
pub use of_plant::plant_parts;
pub use read::{read_lyapunov, read_witness};
pub use read_digital::{is_digital, read_digital_witness};
pub use read_plant::read_plant_witness;
pub use stated::{StatedClaim, read_claim, read_digital_claim};
pub use triple::{lyapunov_parts, matrix_json};
pub use write::{FORMAT, VERSION, certificate_json, conditions_json, constants_json, no_plant_json, statement};
