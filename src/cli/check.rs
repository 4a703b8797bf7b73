//! `sigmastar check`.

use super::args::CheckArgs;
use super::failure::Failure;
use super::output::{self, reason, shown};
use sigmastar::report::document::{Block, Readable};
use sigmastar::spec::Notation;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// The checker's report, whose words are its own.
struct Answer<'r> {
    report: &'r proofs_check::Report,
    verbose: bool,
}

impl Readable for Answer<'_> {
    fn blocks(&self) -> Vec<Block> {
        vec![Block::Code(self.report.text(self.verbose))]
    }

    fn json(&self) -> serde_json::Value {
        self.report.json()
    }
}

/// Runs the command and returns the exit code: that of the independent checker.
pub fn run(args: &CheckArgs) -> u8 {
    match answer(args) {
        Ok(report) => {
            let text = output::report(&Answer { report: &report, verbose: args.verbose }, args.format);
            output::data(&text).map_or_else(|code| code, |()| report.verdict.exit_code())
        }
        Err(failure) => failure.tell(args.format, false),
    }
}

fn answer(args: &CheckArgs) -> Result<proofs_check::Report, Failure> {
    if let Some(path) = args.spec.as_deref().filter(|path| Notation::of(path) != Notation::Json) {
        let name = shown(path);
        let message = format!("the independent checker reads JSON alone, and `{name}` is not JSON");
        let help =
            format!("`sigmastar convert {name} -o FILE.json` writes it as JSON; look at that file, and name it here");
        return Err(Failure::call(message, help));
    }
    let mut certificate = open(&args.certificate, "name a certificate that was written with `certify -o`")?;
    let mut specification =
        args.spec.as_deref().map(|path| open(path, "name the specification that you have")).transpose()?;
    proofs_check::check_reader(&mut certificate, specification.as_mut().map(|file| file as &mut dyn Read)).map_err(
        |error| {
            let message = format!("cannot read `{}`: {}", shown(&args.certificate), reason(&error));
            Failure::call(message, "name files, not folders")
        },
    )
}

fn open(path: &Path, help: &'static str) -> Result<Box<dyn Read>, Failure> {
    if path == Path::new("-") {
        return Ok(Box::new(std::io::stdin().lock()));
    }
    let file = File::open(path)
        .map_err(|error| Failure::call(format!("cannot read `{}`: {}", shown(path), reason(&error)), help))?;
    Ok(Box::new(file))
}
