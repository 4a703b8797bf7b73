//! What a person, or a script, reads about a run: text, Markdown, HTML and JSON with the same content.
//!
//! A report implements [`Readable`](sigmastar_document::Readable): it makes the blocks of a document, which the renderers share,
//! and writes JSON from the same figures. No bound is computed here. Numbers that are claims are rounded outward; what is
//! only an estimate says so.

#![deny(missing_docs)]
// What tests compare with need not be the same on every machine.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

mod about;
mod brief;
mod by_count;
mod certification;
mod conditions;
mod consequences;
mod constants;
mod exact_regulation;
mod failures;
mod for_n_o;
mod gains;
mod json;
mod limits;
mod lyapunov;
mod matrix_checks;
mod obstacles;
mod of_plant;
mod orbit;
mod origin;
mod relative_degree;
mod remarks;
mod run;
mod sampled;
mod sensitivity;
mod sets;
mod transfer;
mod verdict;
mod words;

pub use constants::ConstantsReport;
pub use failures::{call_failure_json, failure_json};
pub use lyapunov::LyapunovReport;
pub use orbit::OrbitReport;
pub use origin::Origin;
pub use run::{ClaimInWords, run_in_words, run_remarks, run_report, run_sentence};
pub use transfer::{TransferReport, pair_failure_json, transfer_figure};
pub use words::{row_of, with as oscillators_in_words};
