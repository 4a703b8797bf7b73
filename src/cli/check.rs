//! `sigmastar check`.

use super::args::{CheckArgs, CheckFormat, Format};
use super::failure::Failure;
use super::output::{self, reason, shown};
use std::fs::File;
use std::path::Path;

/// Runs the command and returns the exit code: that of the independent checker.
pub fn run(args: &CheckArgs) -> u8 {
    let json = args.format == CheckFormat::Json;
    let read = if args.certificate == Path::new("-") {
        proofs_check::check_reader(std::io::stdin().lock())
    } else {
        File::open(&args.certificate).and_then(proofs_check::check_reader)
    };
    match read {
        Ok(report) => {
            let text = if json { output::json_text(&report.json()) } else { report.text(args.verbose) };
            output::data(&text).map_or_else(|code| code, |()| report.verdict.exit_code())
        }
        Err(error) => {
            let message = format!("cannot read `{}`: {}", shown(&args.certificate), reason(&error));
            let failure = Failure::call(message, "name a certificate that was written with `certify -o`");
            failure.tell(if json { Format::Json } else { Format::Text }, false)
        }
    }
}
