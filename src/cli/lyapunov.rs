//! `sigmastar lyapunov`.

use super::args::LyapunovArgs;
use super::failure::Failure;
use super::output::Shortened;
use super::subject::{Asked, Subject, seeking_triple};
use sigmastar::program::lyapunov_of;

/// Runs the command and returns the exit code.
pub fn run(args: &LyapunovArgs) -> Result<u8, Failure> {
    let subject = Asked::read(&args.spec)?.subject()?;
    let working = match &subject {
        Subject::Specification(_) => seeking_triple("", false),
        Subject::Plant(_) => None,
    };
    let report = lyapunov_of(&subject)?;
    drop(working);
    Ok(Shortened::new(&report, args.format, args.full).show(false).err().unwrap_or(0))
}
