//! The discrete regulator as C99 without dependencies.

mod example;
mod header;
mod literal;
mod prefix;
mod source;

pub use prefix::{Prefix, PrefixError};

use super::Export;
use sha2::{Digest, Sha256};

/// A header, its source, and a program that runs them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CSources {
    /// The header.
    pub header: String,
    /// The source, which includes the header by the name that was given.
    pub source: String,
    /// A `main` with a small plant, which includes the header by the same name.
    pub example: String,
}

/// The names in C code.
#[derive(Clone, Debug)]
pub struct CNames {
    /// How the source includes the header.
    pub header: String,
    /// What the symbols begin with.
    pub prefix: Prefix,
}

/// The regulator as a C99 header and source with a step function, and an example of their use. `None` without a
/// discretisation: C code runs at samples.
///
/// The code allocates nothing, includes nothing from the standard library (the example prints), and performs the operations of
/// [`Stepper::step`](crate::Stepper::step) in the same order. Constants are hexadecimal floating-point
/// literals, so that no decimal is rounded again.
#[must_use]
pub fn c_sources(export: &Export<'_>, names: &CNames) -> Option<CSources> {
    let (discrete, sampled) = export.discrete?;
    let upper = names.prefix.upper();
    let source = source::source(export, discrete, &names.prefix);
    let id = identity(&source);
    let top = format!(
        "/* Regulator for: {} */\n#include \"{}\"\n\n#if {upper}_CONTROLLER_ID != 0x{id}UL\n\
         #error \"this source and its header are of different regulators\"\n#endif\n\n",
        harmless(export.name),
        names.header
    );
    Some(CSources {
        header: header::header(export, discrete, sampled, &names.prefix, &id),
        source: top + &source,
        example: example::example(export, discrete, names),
    })
}

/// A number that the header, the source and the linked names share, in hexadecimal digits: what does not belong together does not
/// build.
fn identity(source: &str) -> String {
    Sha256::digest(source).iter().take(4).map(|byte| format!("{byte:02x}")).collect()
}

/// Text as it may stand in a comment, which it could close, or end in a line splice.
fn harmless(text: &str) -> String {
    text.replace("*/", "* /").replace("/*", "/ *").replace(['\\', '?'], " ")
}
