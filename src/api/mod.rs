//! The front door: what a program that depends on this library uses, re-exported at the crate root.
//!
//! No type of another crate appears in it, but for enums that it re-exports. Exact numbers are text, in the notation of specifications; doubles are
//! rounded to the safe side, which is stated with each.

mod bound;
mod certificate;
mod certify;
mod check;
mod claimed;
mod condition;
mod constants;
mod design;
#[cfg(feature = "lab")]
mod edge;
mod error;
#[cfg(feature = "lab")]
mod falsify;
mod lyapunov;
mod options;
#[cfg(feature = "lab")]
mod page;
pub mod program;
mod regulator;
mod report;
mod reread;
mod sampling;
#[cfg(feature = "lab")]
mod simulate;
mod specification;
mod study;
mod subject;
mod transfer;
mod tune;

pub use bound::{BoundedPlant, bounding_specification};
pub use certificate::{Certificate, Claim, InitialSet, PeriodicSolution, Samples};
pub use certify::{certify, certify_telling};
pub use check::{CheckReport, CheckVerdict, check, check_against};
pub use claimed::{ClaimedBounds, ClaimedRate};
pub use condition::Condition;
pub use design::{Design, DesignOptions, design, design_telling};
pub use error::{Diagnostic, Error, ErrorKind};
#[cfg(feature = "lab")]
pub use falsify::{Falsification, FalsificationOutcome, falsify};
pub use lyapunov::lyapunov;
pub use options::CertifyOptions;
pub use regulator::{RegulatorMatrices, SampledRegulator, regulator_matrices, sampled_regulator};
pub use report::{Report, ReportFormat};
pub use reread::reread;
pub use sampling::{SamplingPairs, sampling};
pub use sigmastar_lang::spec::Bound as BoundingFunction;
pub use sigmastar_prove::certify::{TransferChoice, Verdict};
#[cfg(feature = "lab")]
pub use simulate::{Simulation, SimulationOptions, simulate};
pub use specification::{JacobianEntry, Specification, SpecificationBuilder};
pub use study::{Study, StudyCase};
pub use subject::Subject;
pub use transfer::{OscillatorShare, TransferBound, TransferOptions, TransferStudy, transfer_bound, transfer_study};
pub use tune::{TuneGoal, TuneOptions, Tuned, tune};

/// The version of this library, which certificates and results name.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

use rug::Rational;
use sigmastar_exact::enclosure::{DEFAULT_PRECISION, Enclosure};
use sigmastar_lang::spec::{
    Constant, Document, ErrorKind as SpecErrorKind, Errors, Reported, SpecError, Value, any_constant, positive_constant,
};
use sigmastar_prove::reduction::{SAMPLING_PERIOD, Subject as Read, at_samples};

/// The smallest double that is not below an exact number.
fn rounded_up(value: &Rational) -> f64 {
    Enclosure::from_rational(value, 53).upper_f64()
}

/// The largest double that is not above an exact number.
fn rounded_down(value: &Rational) -> f64 {
    Enclosure::from_rational(value, 53).lower_f64()
}

/// The double nearest to an exact number.
fn nearest(value: &Rational) -> f64 {
    Enclosure::from_rational(value, DEFAULT_PRECISION).midpoint_f64()
}

/// What may be asked for in the place of an error of exactly 0.
const SMALL_ERROR: &str = "ask for a small positive bound, such as `1e-6`; where an error of exactly 0 is proved, as of a linear plant whose \
                           `q` has few harmonics, the table shows 0";

/// The largest error along the periodic solution that is asked for; `name` is what errors call it.
fn steady_error(name: &str, text: &str) -> Result<Rational, Error> {
    let constant = constant(name, text, |value, errors| {
        let stated = any_constant(value, &mut Errors::new()).ok();
        if stated.is_some_and(|stated| stated.as_rational().is_some_and(|number| *number == 0)) {
            let error = value.error(SpecErrorKind::Range, format!("`{name}` must be positive, but it is 0"));
            return Err(errors.report(error.expected("expected a positive number").help(SMALL_ERROR)));
        }
        positive_constant(value, errors)
    })?;
    known_rational(name, &constant)
}

/// An argument that is a positive rational number; `name` is what errors call it.
fn rational(name: &str, text: &str) -> Result<Rational, Error> {
    known_rational(name, &positive(name, text)?)
}

fn known_rational(name: &str, constant: &Constant) -> Result<Rational, Error> {
    let help = "write it as a decimal or a fraction";
    let refused = || Error::new(ErrorKind::Range, format!("{name} is not a rational number"), help);
    constant.as_rational().cloned().ok_or_else(refused)
}

/// An argument that is an exact positive constant, as in a specification; `name` is what errors call it.
fn positive(name: &str, text: &str) -> Result<Constant, Error> {
    constant(name, text, positive_constant)
}

/// The document with the sampling period of an argument in the place of its own, or itself where it has no internal model; `name` is what errors call the
/// argument.
///
/// # Errors
/// A sampling period that is no exact positive constant, or does not go with the document, at the argument; and a document that is too large with it.
fn with_sampling_period(document: &Document, name: &str, text: &str) -> Result<Document, Error> {
    let asked = at_samples(document, &positive(name, text)?)?;
    match Read::read(&asked) {
        Err(errors) if errors.errors().iter().all(|error| error.pointer == SAMPLING_PERIOD) => {
            let document = Document::flag(name, text);
            let place = document.at(&format!("/{name}")).unwrap_or_else(|| document.root());
            let at = |error: &SpecError| {
                let at = place.error_in(error.kind, &(0..text.len()), error.message.clone());
                SpecError { expected: error.expected.clone(), help: error.help.clone(), ..at }
            };
            Err(at_argument((name, &document), errors.errors().iter().map(at)))
        }
        // What is wrong with the rest is told when it is read.
        _ => Ok(asked),
    }
}

/// Errors in an argument, of which the document is made; at least one.
fn at_argument((name, document): (&str, &Document), errors: impl Iterator<Item = SpecError>) -> Error {
    let mut all = Errors::new();
    for error in errors {
        all.report(error);
    }
    Error::argument(name, &all.into_errors(document))
}

/// An argument that is an exact constant; `name` is what errors call it.
fn constant(
    name: &str,
    text: &str,
    read: impl Fn(&Value<'_>, &mut Errors) -> Result<Constant, Reported>,
) -> Result<Constant, Error> {
    let document = Document::flag(name, text);
    let place = document.at(&format!("/{name}")).unwrap_or_else(|| document.root());
    place.read(read).map_err(|errors| Error::argument(name, &errors))
}

/// That a whole number is in range; `name` is what errors call it.
fn in_range(name: &str, number: u32, range: std::ops::RangeInclusive<u32>) -> Result<(), Error> {
    if range.contains(&number) {
        return Ok(());
    }
    let help = format!("choose {} to {}", range.start(), range.end());
    Err(Error::new(ErrorKind::Range, format!("{name}: {number} is out of range"), &help))
}

/// JSON as it is written: indented, ending in a line feed.
fn json_text(value: &serde_json::Value) -> String {
    format!("{value:#}\n")
}
