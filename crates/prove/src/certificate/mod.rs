//! The certificate file: the names of its numbers, reading its witness and its claim, writing it.

mod by_count;
mod fields;
mod json;
mod of_plant;
mod rates;
mod read;
mod read_joint;
mod read_plant;
mod read_sampled;
mod run;
mod sampled;
mod stated;
mod stated_words;
mod triple;
mod words;
mod write;

pub use fields::set_fields;
pub use json::{exact, object, rows};
pub use of_plant::{joint_existence_json, joint_stability_json, plant_parts};
pub use read::{embedded, read_lyapunov, read_witness};
pub use read_plant::read_plant_witness;
pub use read_sampled::{is_sampled, read_sampled_witness};
pub use run::{certificate_of, is_stated, read_for, read_numbers, stated_by_count, stated_counts, stated_with_noise};
pub use sampled::sampled_certificate_json;
pub use stated::{StatedBounds, StatedClaim, StatedNoise, read_claim};
pub use stated_words::claim_in_words;
pub use triple::{lyapunov_parts, matrix_json};
pub use words::{members, sampled_statement, statement};
pub use write::{FORMAT, VERSION, certificate_json, conditions_json, constants_json, no_plant_json};
