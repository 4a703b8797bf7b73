//! `sigmastar errata`.

use super::args::ErrataArgs;
use super::constants;
use super::failure::Failure;
use super::output;
use super::subject::Asked;
use sigmastar_paper::errata::ErrataReport;

/// Runs the command and returns the exit code.
pub fn run(args: &ErrataArgs) -> Result<u8, Failure> {
    let spec = match &args.spec {
        Some(path) => Some(Asked::read(path)?.specification("`errata`")?),
        None => None,
    };
    let report = ErrataReport::new(spec.as_ref(), spec.as_ref().and_then(constants::beside));
    let text = output::report(&report, args.format);
    Ok(output::data(&text).err().unwrap_or(0))
}
