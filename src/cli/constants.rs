//! `sigmastar constants` and `errata`: what the paper prints.

use super::args::{ConstantsArgs, ErrataArgs};
use super::failure::Failure;
use super::output;
use super::subject::{Asked, Subject, proving};
use sigmastar::program::constants_of;
use sigmastar_document::Made;
use sigmastar_lang::spec::Specification;
use sigmastar_paper::errata::ErrataReport;

/// Runs `constants` and returns the exit code.
pub fn run(args: &ConstantsArgs) -> Result<u8, Failure> {
    let subject = Asked::read(&args.spec)?.subject()?;
    let working = proving(&subject, "", args.quiet);
    let (report, verdict) = constants_of(subject, || drop(working))?;
    Ok(output::data(&output::report(&report, args.format)).err().unwrap_or(verdict.exit_code()))
}

/// The report on a specification, as a part of another one; none where there is none.
pub fn beside(spec: &Specification) -> Option<Made> {
    constants_of(Subject::Specification(Box::new(spec.clone())), || {}).ok().map(|(report, _)| report.into_made())
}

/// Runs `errata` and returns the exit code.
pub fn errata(args: &ErrataArgs) -> Result<u8, Failure> {
    let spec = match &args.spec {
        Some(path) => Some(Asked::read(path)?.specification("`errata`")?),
        None => None,
    };
    let report = ErrataReport::new(spec.as_ref(), spec.as_ref().and_then(beside));
    let text = output::report(&report, args.format);
    Ok(output::data(&text).err().unwrap_or(0))
}
